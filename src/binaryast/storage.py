"""HDF5 files: datasets and attributes by name, and the objects that they came from.

Every dataset carries its unit, one of SI; attributes are in s, m and J. A file is made in memory first and appears
under its name in one move, so there is never half of one. ``format_version`` is raised when a reader of the previous
version would misread the file.
"""

import contextlib
import hashlib
import inspect
import io
import os
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np
from astropy.time import Time
from astropy.units import Quantity

from binaryast import (
    adaptive,
    bodies,
    coefficients,
    elements,
    events,
    gravity,
    impulses,
    integrators,
    layered,
    perturbations,
    polyhedron,
    polyhedron_pair,
    polyhedron_point,
    shapes,
    system,
    unions,
)
from binaryast.errors import BinaryastError, StorageError
from binaryast.units import brief
from binaryast.values import Value

FORMAT = "binaryast trajectory"
FORMAT_VERSION = 1
SEAL_SIZE = 512  # bytes: the smallest block that HDF5 leaves free at the start of a file
MODULES = (  # whose classes a file can bring back
    *(adaptive, bodies, coefficients, elements, events, gravity, impulses, integrators, layered, perturbations),
    *(polyhedron, polyhedron_pair, polyhedron_point, shapes, system, unions),
)
CLASSES: dict[str, type[Value]] = {
    kind.__name__: kind
    for module in MODULES
    for kind in vars(module).values()
    if isinstance(kind, type) and issubclass(kind, Value)
}


class Content(NamedTuple):
    """What a file holds."""

    datasets: dict[str, Any]
    attributes: dict[str, Any]
    values: dict[str, Any]
    provenance: dict[str, str]


def as_path(path: Any) -> Path:
    """Return a path, from whatever a user gives for one."""
    if not isinstance(path, (str, os.PathLike)) or "\0" in str(path):
        raise StorageError(f"{path!r} is not the name of a file")
    return Path(path)


def refuse(path: Path, *, force: bool) -> None:
    """Raise, before any work is done, where a file could not be written under this name.

    Raises
    ------
    StorageError
        Where it exists and ``force`` is not set, is a folder, or its folder is missing or cannot be written.
    """
    try:
        if path.is_dir():
            raise StorageError(f"{path} is a folder: give the name of a file")
        if path.exists() and not force:
            raise StorageError(
                f"{path} exists already: choose another name, or allow it to be replaced (--force, force=True)"
            )
        if not path.parent.is_dir():
            raise StorageError(f"{path}: there is no folder {path.parent}: make it first")
        with tempfile.TemporaryFile(dir=path.parent):
            pass
    except StorageError:
        raise
    except OSError as error:
        raise StorageError(f"{path}: nothing can be written in {path.parent.absolute()}: {_reason(error)}") from None


def replace_whole(path: Path, data: bytes, *, force: bool) -> Path:
    """Write a file under a temporary name, and move it to its own only when it is complete.

    Raises
    ------
    StorageError
        Where it cannot be written; what was there before is untouched.
    """
    refuse(path, force=force)
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", suffix=".part")
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(path)
    except OSError as error:
        raise StorageError(
            f"{path}: could not be written ({len(data) / 1e6:.3g} MB): {_reason(error)}; nothing was changed"
        ) from None
    finally:
        with contextlib.suppress(FileNotFoundError):
            temporary.unlink()
    return path


def _umask() -> int:
    """Return the process's file mode mask, which can only be read by setting it."""
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _reason(error: OSError) -> str:
    return (error.strerror or str(error)).lower()


def write(path: Path, content: Content, *, force: bool = False) -> Path:
    """Write an HDF5 file, whole or not at all; see `replace_whole` for what it raises."""
    refuse(path, force=force)
    memory = io.BytesIO()
    with h5py.File(memory, "w", userblock_size=SEAL_SIZE) as file:
        file.attrs["format"] = FORMAT
        file.attrs["format_version"] = FORMAT_VERSION
        for name, data in content.datasets.items():
            _put(file, name, data)
        for name, attribute in content.attributes.items():
            file.attrs[name] = attribute
        for name, value in content.values.items():
            _put(file, name, value)
        _put(file, "provenance", content.provenance)
    body = memory.getvalue()[SEAL_SIZE:]
    return replace_whole(path, _seal(body) + body, force=force)


def _seal(body: bytes) -> bytes:
    """Return the block before the HDF5 part of a file: its hash, which tells damage that HDF5 itself would not see."""
    return f"binaryast blake2b {hashlib.blake2b(body).hexdigest()}\n".encode().ljust(SEAL_SIZE, b"\0")


def _verify(path: Path) -> None:
    """Raise where a file is not what was written: damaged HDF5 can also make its library hang."""
    with path.open("rb") as file:
        seal, body = file.read(SEAL_SIZE), file.read()
    if not seal.startswith(b"binaryast"):
        raise broken(path, "it is not a file that binaryast wrote")
    if seal != _seal(body):
        raise broken(path, "it is damaged or was changed (read a file that you changed with verify=False)")


def read(path: Path, *, verify: bool = True) -> Content:
    """Read an HDF5 file.

    Raises
    ------
    StorageError
        Where it is missing, broken, or not one of ours.
    """
    if not path.is_file():
        raise StorageError(f"{path}: {'a folder, not a file' if path.is_dir() else 'no such file'}")
    try:
        if verify:
            _verify(path)
        with h5py.File(path, "r") as file:
            if file.attrs.get("format") != FORMAT:
                raise StorageError(f"{path}: an HDF5 file, but not one that binaryast wrote")
            if not 1 <= file.attrs["format_version"] <= FORMAT_VERSION:
                raise StorageError(
                    f"{path}: format version {file.attrs['format_version']}, expected 1 to {FORMAT_VERSION}: "
                    "a newer binaryast wrote it; install that one"
                )
            datasets = {name: _in_si(item) for name, item in file.items() if isinstance(item, h5py.Dataset)}
            values = {name: _get(item) for name, item in file.items() if isinstance(item, h5py.Group)}
            attributes = dict(file.attrs)
    except StorageError:
        raise
    except BinaryastError as error:
        raise broken(path, str(error)) from None
    except Exception as error:  # a broken file makes the HDF5 library say anything
        raise broken(path, brief(error)) from None
    return Content(datasets, attributes, values, values.pop("provenance", {}))


def broken(path: Path, reason: str) -> StorageError:
    """Return the error of a file that cannot be read."""
    return StorageError(f"{path}: not a readable HDF5 file of binaryast: {reason}; run again to make it anew")


def _put(group: h5py.Group, name: str, value: Any) -> None:
    """Put one value under a name: an attribute, a dataset, or a group for a `Value`, an epoch, a sequence or a dict."""
    if value is None:
        return
    if isinstance(value, Quantity):
        dataset = group.create_dataset(name, data=value.value)
        dataset.attrs["unit"] = value.unit.to_string()
    elif isinstance(value, np.ndarray):
        group.create_dataset(name, data=value).attrs["unit"] = ""
    elif isinstance(value, Time):
        _put_group(group, name, "Time", {"jd1": value.tdb.jd1, "jd2": value.tdb.jd2})
    elif isinstance(value, gravity.Gravity) and type(value).__name__ not in CLASSES:
        _put(group, name, gravity.PairPotential(f"{type(value).__module__}.{type(value).__qualname__}"))
    elif isinstance(value, Value):
        if type(value).__name__ not in CLASSES:
            raise StorageError(f"{type(value).__name__}: an object of a class of yours cannot be kept in a file")
        _put_group(group, name, type(value).__name__, value.arguments())
    elif isinstance(value, dict):
        _put_group(group, name, "dict", value)
    elif isinstance(value, Sequence) and not isinstance(value, str):
        _put_group(group, name, "tuple", {str(i): item for i, item in enumerate(value)})
    elif callable(value):
        function = getattr(value, "py_func", value)
        names = {"module": function.__module__, "name": function.__qualname__, "source": _source_hash(function)}
        _put_group(group, name, "function", names)
    else:
        group.attrs[name] = value


def _put_group(group: h5py.Group, name: str, kind: str, items: dict[str, Any]) -> None:
    inner = group.create_group(name)
    inner.attrs["class"] = kind
    for key, item in items.items():
        _put(inner, key, item)


def _get(group: h5py.Group) -> Any:
    """Return what `_put_group` put into a group."""
    kind = str(group.attrs["class"])
    items: dict[str, Any] = {key: _plain(value) for key, value in group.attrs.items() if key != "class"}
    for key, item in group.items():
        items[key] = _get(item) if isinstance(item, h5py.Group) else _array(item)
    if kind == "dict":
        return items
    if kind == "tuple":
        return tuple(items[str(i)] for i in range(len(items)))
    if kind == "Time":
        return Time(items["jd1"], items["jd2"], format="jd", scale="tdb")
    if kind == "function":
        return _function(**items)
    if kind not in CLASSES:
        raise KeyError(f"it holds a {kind}, which this version does not know")
    return CLASSES[kind](**items)


def _in_si(dataset: h5py.Dataset) -> Any:
    """Return a dataset in SI."""
    value = _array(dataset)
    return value.si.value if isinstance(value, Quantity) else value


def _array(dataset: h5py.Dataset) -> Any:
    unit = dataset.attrs["unit"]
    return Quantity(dataset[()], unit) if unit else dataset[()]


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


def _source_hash(function: Callable[..., Any]) -> str:
    """Return a hash of a function's source, nothing where there is none to see."""
    try:
        return hashlib.blake2b(inspect.getsource(function).encode(), digest_size=8).hexdigest()
    except (OSError, TypeError):
        return ""


def _function(module: str, name: str, source: str) -> Callable[..., Any] | str:
    """Return a user's function if its module is loaded and it is still the same, else its name.

    Nothing is imported because a file says so, and a script's own functions are never taken for those of another.
    """
    function = getattr(sys.modules.get(module), name, None)
    if module == "__main__" or function is None or not source:
        return f"{module}.{name}"
    return function if _source_hash(getattr(function, "py_func", function)) == source else f"{module}.{name}"
