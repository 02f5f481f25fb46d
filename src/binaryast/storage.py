"""HDF5 files: datasets and attributes by name, and the objects that they came from.

Every dataset carries its unit, one of SI; attributes are in s, m and J. A file is made under another name, piece by
piece so that no more than a piece is in memory, and appears under its own in one move, so there is never half of one.
``format_version`` is raised when a reader of the previous version would misread the file.
"""

import contextlib
import errno
import glob
import hashlib
import inspect
import io
import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import chain
from pathlib import Path
from typing import Any, NamedTuple

import h5py
import numpy as np
from astropy.time import Time
from astropy.units import Quantity, Unit

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
    state,
    system,
    unions,
)
from binaryast.errors import BinaryastError, StorageError
from binaryast.units import brief
from binaryast.values import Value

FORMAT = "binaryast trajectory"
FORMAT_VERSION = 1
RUN_VERSION = 1  # of what is appended to a run file
NEWER = "a newer binaryast wrote it; install that one"
SEAL_SIZE = 512  # bytes: the smallest block that HDF5 leaves free at the start of a file
AT_ONCE = 1 << 20  # bytes that are read in one go
SPARE = 1 << 14  # bytes that HDF5 may need beside the rows
IN_MEMORY = 1 << 26  # bytes: a larger dataset stays in its file, of which only what is looked at is read
MODULES = (  # whose classes a file can bring back
    *(adaptive, bodies, coefficients, elements, events, gravity, impulses, integrators, layered, perturbations),
    *(polyhedron, polyhedron_pair, polyhedron_point, shapes, state, system, unions),
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
            stopped = path.is_file() and _first_words(path)[:2] == ["binaryast", "run"]
            on = f"; it is a run that was stopped: go on with binaryast resume {path}" if stopped else ""
            raise StorageError(
                f"{path} exists already: choose another name, or allow it to be replaced (--force, force=True){on}"
            )
        if not path.parent.is_dir():
            raise StorageError(f"{path}: there is no folder {path.parent}: make it first")
        with tempfile.TemporaryFile(dir=path.parent):
            pass
    except StorageError:
        raise
    except OSError as error:
        raise StorageError(f"{path}: nothing can be written in {path.parent.absolute()}: {reason(error)}") from None


@contextlib.contextmanager
def appearing(path: Path, *, force: bool) -> Iterator[Path]:
    """Give a temporary name beside a file, to write to; what is written there becomes the file when all went well.

    Raises
    ------
    StorageError
        Where it cannot be written; what was there before is untouched.
    """
    refuse(path, force=force)
    temporary = None
    try:
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", suffix=".part")
        os.close(handle)
        temporary = Path(name)
        yield temporary
        with temporary.open("rb+") as file:
            os.fsync(file.fileno())
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(path)
    except StorageError:
        raise
    except OSError as error:
        raise StorageError(f"{path}: could not be written: {reason(error)}; nothing was changed") from None
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def remove_parts(path: Path) -> None:
    """Remove what processes that were killed left of files that were to appear under a name."""
    for part in path.parent.glob(f".{glob.escape(path.name)}.*.part"):
        part.unlink(missing_ok=True)


def replace_whole(path: Path, data: bytes, *, force: bool) -> Path:
    """Write a file that is there whole or not at all; see `appearing` for what it raises."""
    with appearing(path, force=force) as temporary:
        temporary.write_bytes(data)
    return path


def _umask() -> int:
    """Return the process's file mode mask, which can only be read by setting it."""
    mask = os.umask(0)
    os.umask(mask)
    return mask


def reason(error: OSError) -> str:
    """Return what the system says of an error."""
    return (error.strerror or str(error)).lower()


def write(path: Path, content: Content, rows: int, pieces: Iterable[dict[str, Any]], *, force: bool = False) -> Path:
    """Write an HDF5 file, whole or not at all; see `appearing` for what it raises.

    Parameters
    ----------
    path : Path
        The file.
    content : Content
        What it holds beside the datasets with a row for each time.
    rows : int
        How many rows those have.
    pieces : iterable of dict
        Their pieces, by name: what follows one another in the file.
    force : bool
        Whether a file of that name may be replaced.
    """
    pieces = iter(pieces)
    first = next(pieces)
    with appearing(path, force=force) as temporary:
        temporary.write_bytes(_image(content, lambda file: _define(file, rows, first)))
        _make_room(temporary, rows, first)
        at = 0
        with h5py.File(temporary, "r+") as file:
            for piece in chain([first], pieces):
                _put_rows(file, piece, at)
                at += len(next(iter(piece.values())))
        _seal(temporary)
    return path


def image(content: Content, inputs: dict[str, Any]) -> bytes:
    """Return what the file of a content would hold, with the inputs of its run, in bytes without a seal."""
    return _image(content, lambda file: _put(file, "inputs", inputs))


def _image(content: Content, more: Callable[[h5py.File], None]) -> bytes:
    """Return a file as bytes: HDF5 ends the process where it cannot write, so it is let write in memory alone."""
    memory = io.BytesIO()
    with h5py.File(memory, "w", userblock_size=SEAL_SIZE) as file:
        _put_content(file, content)
        more(file)
    return memory.getvalue()


def pack(values: dict[str, Any]) -> bytes:
    """Return named values as a small HDF5 file in bytes: whatever a file can hold, and nothing that runs on reading."""
    memory = io.BytesIO()
    with h5py.File(memory, "w") as file:
        for name, value in values.items():
            _put(file, name, value)
    return memory.getvalue()


def unpack(data: bytes) -> dict[str, Any]:
    """Return what `pack` put into bytes."""
    with h5py.File(io.BytesIO(data), "r") as file:
        return _items(file)


def _put_content(file: h5py.File, content: Content) -> None:
    """Put everything into a new file but the rows that come in pieces."""
    file.attrs["format"] = FORMAT
    file.attrs["format_version"] = FORMAT_VERSION
    for name, data in content.datasets.items():
        _put(file, name, data)
    for name, attribute in content.attributes.items():
        file.attrs[name] = attribute
    for name, value in content.values.items():
        _put(file, name, value)
    _put(file, "provenance", content.provenance)


def _define(file: h5py.File, rows: int, piece: dict[str, Any]) -> None:
    """Define datasets for so many rows like those of a piece; they take no room yet."""
    for name, data in piece.items():
        dataset = file.create_dataset(name, shape=(rows, *data.shape[1:]), dtype=data.dtype)
        dataset.attrs["unit"] = data.unit.to_string() if isinstance(data, Quantity) else ""


def _make_room(path: Path, rows: int, piece: dict[str, Any]) -> None:
    """Raise where there is no room for datasets, before HDF5 comes to write them."""
    size = sum(np.asarray(data).nbytes // len(data) for data in piece.values()) * rows + SPARE
    if size > shutil.disk_usage(path.parent).free:
        raise OSError(errno.ENOSPC, f"no room for {size / 1e6:.3g} MB")
    with path.open("rb+") as file:
        end = file.seek(0, os.SEEK_END)
        file.seek(end + size)
        file.write(b"\0")
        file.flush()
        file.truncate(end)


def _put_rows(file: h5py.File, piece: dict[str, Any], at: int) -> None:
    """Put some rows into the datasets, from one on."""
    for name, data in piece.items():
        file[name][at : at + len(data)] = getattr(data, "value", data)


def digest(path: Path, begin: int, end: int | None = None) -> str:
    """Return the hash of a part of a file."""
    result = hashlib.blake2b()
    with path.open("rb") as file:
        file.seek(begin)
        left = (path.stat().st_size if end is None else end) - begin
        while left > 0 and (data := file.read(min(left, AT_ONCE))):
            result.update(data)
            left -= len(data)
    return result.hexdigest()


def _seal(path: Path) -> None:
    """Fill the block before the HDF5 part of a file: its hash, which tells damage that HDF5 itself would not see."""
    text = f"binaryast blake2b {digest(path, SEAL_SIZE)}\n"
    with path.open("rb+") as file:
        file.write(text.encode().ljust(SEAL_SIZE, b"\0"))


def seal_of_run(data: bytes) -> bytes:
    """Return the block before the HDF5 part of a run file, to which rows are appended: a hash of that part alone."""
    hashed = hashlib.blake2b(data[SEAL_SIZE:]).hexdigest()
    return f"binaryast run {RUN_VERSION} {len(data)} blake2b {hashed}\n".encode().ljust(SEAL_SIZE, b"\0")


def end_of_header(path: Path) -> int | None:
    """Return where the HDF5 part of a run file ends and what was appended begins; None of a run that is over."""
    words = _first_words(path)
    if words[:2] != ["binaryast", "run"]:
        return None
    try:
        version, size = int(words[2]), int(words[3])
    except (IndexError, ValueError):
        raise broken(path, "its first line is damaged") from None
    if not 1 <= version <= RUN_VERSION:
        raise StorageError(f"{path}: a run file of version {version}, expected 1 to {RUN_VERSION}: {NEWER}")
    return size


def _first_words(path: Path) -> list[str]:
    with path.open("rb") as file:
        return file.read(SEAL_SIZE).rstrip(b"\0").decode("ascii", "replace").split()


def _verify(path: Path, end: int | None) -> None:
    """Raise where a file is not what was written, up to an end: damaged HDF5 can also make its library hang."""
    words = _first_words(path)
    if not words or words[0] != "binaryast":
        raise broken(path, "it is not a file that binaryast wrote")
    if words[-1] != digest(path, SEAL_SIZE, end):
        raise broken(path, "it is damaged or was changed (read a file that you changed with verify=False)")


def read(path: Path, *, verify: bool = True) -> Content:
    """Read an HDF5 file; of a run file, what is there before the rows that were appended.

    Raises
    ------
    StorageError
        Where it is missing, broken, or not one of ours.
    """
    if not path.is_file():
        raise StorageError(f"{path}: {'a folder, not a file' if path.is_dir() else 'no such file'}")
    try:
        end = end_of_header(path)
        if verify or end is not None:
            _verify(path, end)
        with h5py.File(path, "r") as file:
            if file.attrs.get("format") != FORMAT:
                raise StorageError(f"{path}: an HDF5 file, but not one that binaryast wrote")
            if not 1 <= file.attrs["format_version"] <= FORMAT_VERSION:
                raise StorageError(
                    f"{path}: format version {file.attrs['format_version']}, expected 1 to {FORMAT_VERSION}: {NEWER}"
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
    kind, items = str(group.attrs["class"]), _items(group)
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


def _items(group: h5py.Group) -> dict[str, Any]:
    """Return what is in a group, by name."""
    items: dict[str, Any] = {key: _plain(value) for key, value in group.attrs.items() if key != "class"}
    for key, item in group.items():
        items[key] = _get(item) if isinstance(item, h5py.Group) else _array(item)
    return items


def _in_si(dataset: h5py.Dataset) -> Any:
    """Return a dataset in SI."""
    scale = Unit(dataset.attrs["unit"]).decompose().scale
    return _stored(dataset) if scale == 1 else _stored(dataset) * scale


def _array(dataset: h5py.Dataset) -> Any:
    unit = dataset.attrs["unit"]
    value = _stored(dataset)
    return Quantity(value, unit) if unit else value


def _stored(dataset: h5py.Dataset) -> Any:
    """Return an array as it is in its file, in memory where it is small, else mapped."""
    if dataset.nbytes < IN_MEMORY or dataset.chunks or dataset.id.get_offset() is None:
        return dataset[()]
    return np.memmap(dataset.file.filename, dataset.dtype, "r", dataset.id.get_offset(), dataset.shape)


def stored(path: Path, names: Iterable[str]) -> dict[str, Any]:
    """Return datasets of a file that was just written, as they are in it."""
    with h5py.File(path, "r") as file:
        return {name: _stored(file[name]) for name in names}


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
