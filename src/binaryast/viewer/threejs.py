"""three.js, as trimesh brings it along for its own pages: one script that defines ``THREE``."""

import io
import re
from importlib.metadata import version
from importlib.resources import files
from zipfile import BadZipFile, ZipFile

from binaryast.errors import BinaryastError

TEMPLATE, MEMBER = "resources/templates/viewer.zip", "viewer.html.template"
LIBRARY = re.compile(  # from its licence to the end of its module; what follows are add-ons and trimesh's own
    r'/\*\*\s+\* @license\s+\* Copyright [\d-]+ Three\.js Authors.*?"__esModule",\{value:!0\}\)\}\)+;', re.DOTALL
)


def library() -> str:
    """Return the script.

    Raises
    ------
    BinaryastError
        Where this version of trimesh does not hold it as those before did.
    """
    try:
        with ZipFile(io.BytesIO((files("trimesh") / TEMPLATE).read_bytes())) as archive:
            found = LIBRARY.search(archive.read(MEMBER).decode())
    except (OSError, KeyError, ValueError, BadZipFile):
        found = None
    if found is None or "</script" in found.group():
        raise BinaryastError(
            f"trimesh {version('trimesh')} does not hold three.js where it was looked for: "
            "pip install 'trimesh>=4.9,<6' and try again"
        )
    return found.group()
