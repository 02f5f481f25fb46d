"""The file of a run under way: what it began with, as HDF5, and blocks appended to it.

The first part is a file as of a run of one row, with the inputs of the run in the group ``inputs``: any reader of HDF5
opens it, and the package needs nothing else to go on. The blocks are

``leg``
    a leg begins, or is begun again with a shorter step: its number, its time, what was planned for it;
``rows``
    saved rows of it: time, position, velocity, ... of each, little-endian floats;
``happened``
    events that have happened since the last block of this kind: what a file holds of them, and the variables then;
``mark``
    from where the run can go on: the working state and where in the schedule it is; and the figures so far;
``over``
    the leg is over: how it ended, and its figures.

What follows the last ``mark`` or ``over`` is read, but is done again when the run goes on.
"""

import contextlib
import os
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import zip_longest
from math import prod
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

import numpy as np

from binaryast import blocks, storage
from binaryast.blocks import Block, block
from binaryast.errors import StorageError
from binaryast.units import Floats, span
from binaryast.working.base import GIVEN, Motion

ROWS_AT_ONCE = 4096  # in memory
ROW_PARTS = ("time", *Motion._fields)  # those of GIVEN of a run with perturbations


def pieces_of(rows: int) -> Iterator[tuple[int, int]]:
    """Yield where pieces of so many rows begin and end, the same for each number of rows."""
    for begin in range(0, rows, ROWS_AT_ONCE):
        yield begin, min(begin + ROWS_AT_ONCE, rows)


class Layout(NamedTuple):
    """What a row consists of: the names of its parts, the time first, and their shapes."""

    names: tuple[str, ...]
    shapes: tuple[tuple[int, ...], ...]

    @classmethod
    def of(cls, arrays: dict[str, Floats]) -> "Layout":
        """Return that of arrays with time first."""
        return cls(tuple(arrays), tuple(array.shape[1:] for array in arrays.values()))

    @property
    def sizes(self) -> list[int]:
        """How many numbers each part has."""
        return [prod(shape) for shape in self.shapes]

    def columns(self, names: Sequence[str]) -> list[int]:
        """Return in which columns of a row some parts are."""
        owners = [name for name, size in zip(self.names, self.sizes, strict=True) for _ in range(size)]
        return [k for k, owner in enumerate(owners) if owner in names]

    def joined(self, arrays: list[Floats]) -> Floats:
        """Return arrays, one of each part, as rows (k, width)."""
        return np.concatenate([array.reshape(len(array), -1) for array in arrays], axis=1)

    def parts(self, rows: Floats) -> dict[str, Floats]:
        """Return the parts of rows (k, width), by name."""
        cuts = np.cumsum(self.sizes)[:-1]
        split = zip(self.names, self.shapes, np.split(rows, cuts, axis=1), strict=True)
        return {name: np.ascontiguousarray(part).reshape(len(rows), *shape) for name, shape, part in split}


@dataclass
class Stretch:
    """The rows of one leg.

    Attributes
    ----------
    number, begin : int, float
        Which leg it is, and when it begins [s].
    about : dict
        What was planned for it.
    pieces : list of tuple
        For each block of rows: where in the file it is, and how many there are.
    happened : list of Block
        What says which events have happened.
    mark, over : Block or None
        What says from where it can go on, and how it ended.
    """

    number: int
    begin: float
    about: dict[str, Any]
    pieces: list[tuple[int, int]] = field(default_factory=list)
    happened: list[Block] = field(default_factory=list)
    mark: Block | None = None
    over: Block | None = None

    def __len__(self) -> int:
        return sum(rows for _, rows in self.pieces)


class RunFile:
    """A run file, open for reading or, with its end known, for more blocks."""

    def __init__(self, path: Path, content: storage.Content, *, writing: bool) -> None:
        self.path, self.content = path, content
        self.inputs: dict[str, Any] = content.values.get("inputs", {})
        names = [name for name in ROW_PARTS if name in content.datasets]
        self.layout = Layout.of({name: content.datasets[name] for name in names})
        begin = storage.end_of_header(path) or 0  # before the lock, which is lost when a file is closed anywhere else
        self.file: BinaryIO = path.open("rb+" if writing else "rb", buffering=0)
        if writing:
            _lock(self.file, path)
        self.stretches: list[Stretch] = []
        self.last: Block | None = None  # with figures
        self.found, self.end, self.link, self.damaged = blocks.chain(self.file, begin)
        if writing:
            self._forget_the_rest(begin)
        for one in self.found:
            self._take_in(one)

    def __enter__(self) -> "RunFile":
        return self

    def __exit__(self, *_: object) -> None:
        self.file.close()

    def __len__(self) -> int:
        return sum(len(stretch) for stretch in self.stretches)

    def _take_in(self, one: Block) -> None:
        """Take note of a block that is there."""
        if one.kind == "leg":
            values = self.said(one)
            self.stretches = [stretch for stretch in self.stretches if stretch.number < values["number"]]
            self.stretches.append(Stretch(**values))
        elif one.kind == "rows":
            self.stretches[-1].pieces.append((one.begin, one.size // (8 * sum(self.layout.sizes))))
        elif one.kind == "happened":
            self.stretches[-1].happened.append(one)
        else:
            self.last = one
            setattr(self.stretches[-1], one.kind, one)

    def _forget_the_rest(self, begin: int) -> None:
        """Forget, also on disk, what follows the last block from which the run can go on."""
        while self.found and self.found[-1].kind in ("rows", "happened"):
            self.found.pop()
        self.end = self.found[-1].end if self.found else begin
        self.file.truncate(self.end)
        self.file.seek(self.end - blocks.HASH_SIZE)
        self.link = self.file.read() if self.found else b""

    def said(self, one: Block) -> dict[str, Any]:
        """Return what a block other than rows says."""
        self.file.seek(one.begin)
        return storage.unpack(self.file.read(one.size))

    def begin(self, number: int, begin: float, about: dict[str, Any]) -> None:
        """Begin a leg, or begin it again."""
        self._append("leg", storage.pack({"number": number, "begin": begin, "about": about}))

    def add(self, arrays: list[Floats]) -> None:
        """Append rows, given by their parts."""
        self._append("rows", self.layout.joined(arrays).astype("<f8").tobytes())

    def tell(self, happened: dict[str, Any]) -> None:
        """Append what has happened."""
        self._append("happened", storage.pack(happened))

    def told(self, stretch: Stretch) -> list[dict[str, Any]]:
        """Return what has happened in a leg, in SI."""
        blocks = [self.said(one) for one in stretch.happened]
        return [{name: getattr(value, "value", value) for name, value in one.items()} for one in blocks]

    def mark(self, values: dict[str, Any]) -> None:
        """Append from where the run can go on, or how it ended, and see to it that it is on the disk."""
        self._append("over" if "leg" in values else "mark", storage.pack(values))
        with contextlib.suppress(OSError):  # not every file system can
            os.fsync(self.file.fileno())

    def _append(self, kind: str, content: bytes) -> None:
        """Append a block; where that fails, what was there is left as it was."""
        data = block(kind, content, self.link)
        try:
            self.file.seek(self.end)
            if self.file.write(data) != len(data):  # the disk is full: the next attempt says so
                self.file.write(data)
                raise OSError("the disk is full")
        except OSError as error:
            with contextlib.suppress(OSError):
                self.file.truncate(self.end)
            raise StorageError(
                f"{self.path}: no more could be written: {storage.reason(error)}; what was computed before is there: "
                f"make room, and go on with: binaryast resume {self.path}"
            ) from None
        self._take_in(Block(kind, self.end + blocks.HEAD.size, len(content)))
        self.end += len(data)
        self.link = data[-blocks.HASH_SIZE :]

    def rows(self, begin: int, end: int) -> Floats:
        """Return rows (end - begin, width) of all legs; each leg ends exactly when the next begins.

        What came from outside adds up over the legs.
        """
        result, at = self.rows_of_legs(begin, end), 0
        given = np.zeros(result.shape[1])
        columns = self.layout.columns(GIVEN)
        for stretch, after in zip_longest(self.stretches, self.stretches[1:]):
            low, high = max(begin, at), min(end, at + len(stretch))
            at += len(stretch)
            if low < high:
                result[low - begin : high - begin, columns] += given[columns]
                if after is not None and high == at:
                    result[high - 1 - begin, 0] = after.begin
            if len(stretch) and len(columns):
                given[columns] += self.rows_of_legs(at - 1, at)[0, columns]
        return result

    def rows_of_legs(self, begin: int, end: int) -> Floats:
        """Return rows (end - begin, width) as they were appended, each leg by itself."""
        result = np.empty((end - begin, sum(self.layout.sizes)))
        at = 0
        for stretch in self.stretches:
            for place, count in stretch.pieces:
                low, high = max(begin, at), min(end, at + count)
                if low < high:
                    result[low - begin : high - begin] = self._floats(place, low - at, high - at)
                at += count
        return result

    def _floats(self, place: int, low: int, high: int) -> Floats:
        """Return some rows of a block."""
        width = sum(self.layout.sizes)
        self.file.seek(place + 8 * width * low)
        data = self.file.read(8 * width * (high - low))
        return np.frombuffer(data, "<f8").reshape(high - low, width)

    def first_row(self, stretch: Stretch) -> int:
        """Return which row of all is the first of a leg."""
        return sum(len(one) for one in self.stretches[: self.stretches.index(stretch)])

    def so_far(self) -> storage.Content:
        """Return what is there as the content of a file: all rows, and the figures of the last mark."""
        values = {name: value for name, value in self.content.values.items() if name != "inputs"}
        if not len(self):
            return self.content._replace(values=values)
        parts = [_room((len(self), *shape)) for shape in self.layout.shapes]
        for begin, end in pieces_of(len(self)):
            for array, part in zip(parts, self.layout.parts(self.rows(begin, end)).values(), strict=True):
                array[begin:end] = part
        attributes, datasets = dict(self.content.attributes), dict(zip(self.layout.names, parts, strict=True))
        if self.last is not None:
            said = self.said(self.last)
            attributes |= said["attributes"]
            values |= {"integrator": said["integrator"]}
            values |= {"watched": said["watched"]} if said["watched"] else {}
        happened = [one for stretch in self.stretches for one in self.told(stretch)]
        datasets |= joined_datasets(happened) or {
            name: self.content.datasets[name] for name in self.content.datasets if name.startswith("events_")
        }
        if attributes["status"] in ("completed", "interrupted"):  # there is more to come, or to be made of it
            attributes["status"] = "interrupted"
            attributes["message"] = f"stopped after {span(float(parts[0][-1]))}; binaryast resume goes on with it"
        return self.content._replace(datasets=datasets, attributes=attributes, values=values)


def joined_datasets(happened: list[dict[str, Any]]) -> dict[str, Any]:
    """Return what a file holds of events that were told one block after the other."""
    names = [name for name in (happened[0] if happened else {}) if name != "variables"]
    return {name: np.concatenate([one[name] for one in happened]) for name in names}


class Column:
    """A part of the rows of one leg, which are in a run file: of an array as much as is needed of it."""

    def __init__(self, run: RunFile, stretch: Stretch, name: str) -> None:
        self.run, self.stretch, self.name = run, stretch, name
        self.shape = (len(stretch), *run.layout.shapes[run.layout.names.index(name)])

    def __len__(self) -> int:
        return self.shape[0]

    def __getitem__(self, index: Any) -> Any:
        first = self.run.first_row(self.stretch)
        if isinstance(index, slice):
            begin, end, _ = index.indices(len(self))
            return self.run.layout.parts(self.run.rows_of_legs(first + begin, first + end))[self.name]
        chosen = np.arange(len(self))[index]
        if chosen.ndim == 0:
            return self[int(chosen) : int(chosen) + 1][0]
        return np.concatenate([self[int(i) : int(i) + 1] for i in chosen])


def with_rows(path: Path, content: storage.Content, *, verify: bool = True) -> storage.Content:
    """Return the content of a file; that of a run file with the rows that were appended to it.

    Raises
    ------
    StorageError
        Where a block of it is damaged.
    """
    if storage.end_of_header(path) is None:
        return content
    with _said(path), RunFile(path, content, writing=False) as run:
        if run.damaged and verify:
            raise StorageError(
                f"{path}: damaged after {run.end} bytes; {len(run)} rows before are sound: read them with "
                f"verify=False, or have the rest computed again: binaryast resume {path}"
            )
        return run.so_far()


@contextlib.contextmanager
def _said(path: Path) -> Iterator[None]:
    """Say in one line what is wrong with a run file."""
    try:
        yield
    except StorageError:
        raise
    except OSError as error:
        raise StorageError(f"{path}: cannot be opened to go on with: {storage.reason(error)}") from None
    except Exception as error:  # a file that was made by somebody else can hold anything
        raise storage.broken(path, f"its blocks are not those of a run ({type(error).__name__})") from None


def opened(path: Path) -> RunFile:
    """Return a run file, to go on with the run from its last mark.

    Raises
    ------
    StorageError
        Where it is none, is damaged at its start, or another process is writing it.
    """
    content = storage.read(path)
    if storage.end_of_header(path) is None:
        raise StorageError(
            f"{path}: the run is over ({content.attributes.get('status')}): to follow the motion further, "
            f"binaryast run {path} --duration TIME"
        )
    storage.refuse(path, force=True)
    with _said(path):
        return RunFile(path, content, writing=True)


def _room(shape: tuple[int, ...]) -> Floats:
    """Return an array to be filled, on disk where it is large."""
    if 8 * prod(shape) < storage.IN_MEMORY:
        return np.empty(shape)
    return np.memmap(tempfile.TemporaryFile(), np.float64, "w+", shape=shape)  # gone with it


def _lock(file: BinaryIO, path: Path) -> None:
    """Keep other processes from writing to the same file, where the system can; not by HDF5's kind of lock."""
    try:
        import fcntl
    except ImportError:
        return
    try:
        fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (BlockingIOError, PermissionError):
        file.close()
        raise StorageError(f"{path}: another process is writing it: wait for that run, or stop it") from None
    except OSError:  # a file system without locks
        return
