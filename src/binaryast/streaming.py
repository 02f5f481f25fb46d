"""Where the rows of a run go while it is under way: into memory, or into a run file that the run can go on from."""

import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from binaryast import run_file, storage
from binaryast.errors import BinaryastError, StorageError
from binaryast.occurrences import OccurrenceFloats
from binaryast.outcome import Happening, Outcome
from binaryast.rows import TrajectoryFloats
from binaryast.run_file import ROWS_AT_ONCE, Column, RunFile, Stretch, joined_datasets, pieces_of
from binaryast.schedule import Leg
from binaryast.trajectory import Trajectory
from binaryast.units import Floats
from binaryast.working import Motion
from binaryast.working.base import nothing_given

OFTEN = 0.5  # s between two marks, at the beginning of a run
SELDOM = 30.0  # s, when it has lasted for an hour
PART = OFTEN / 60  # of the time that a run has lasted: the marks of a week are some thousands
HAPPENED = ("events_event", "events_time", "events_direction", "variables")  # what a run needs of it to go on


class Run(Protocol):
    """What a run under way offers, by whatever method."""

    pressed: list[int]

    @property
    def happened(self) -> Sequence[Happening]:
        """What has happened so far."""

    @property
    def pending(self) -> int:
        """About how many rows are in memory."""

    @property
    def can_go_on(self) -> bool:
        """Whether nothing has ended it but the end of its time, or Ctrl-C."""

    def go(self, show: Callable[[float], None]) -> None:
        """Follow the motion as far as it goes."""

    def take_rows(self) -> tuple[Floats, Motion]:
        """Return the rows since the last call, with their times."""

    def checkpoint(self) -> dict[str, Any]:
        """Return what the rest of the run depends on."""

    def restore(self, checkpoint: dict[str, Any], happened: Sequence[Happening]) -> None:
        """Go on from a checkpoint, and from what had happened by then."""

    def outcome(self, rows: tuple[Floats, Motion] | None = None) -> Outcome:
        """Return what has been computed."""


class Memory:
    """Rows stay in memory, and nothing is written.

    Attributes
    ----------
    report : callable
        Gives the run so far, from the outcome of the leg under way.
    refine : callable
        Looks closer at what happened within steps, when a run is over.
    """

    report: Callable[[Outcome], Trajectory]
    refine: Callable[[Run], None]

    def runs(self) -> list[Trajectory]:
        """Return the legs that are over already."""
        return []

    def planned(self, number: int) -> dict[str, Any]:  # noqa: ARG002
        """Return what was planned for a leg that has begun already, nothing where it has not."""
        return {}

    def begin(self, number: int, leg: Leg, about: dict[str, Any]) -> None:
        """Begin a leg; or begin it again, as something else is planned for it now."""

    def go(self, run: Run, show: Callable[[float], None]) -> Outcome:
        """Have a run followed as far as it goes."""
        run.go(show)
        self.refine(run)
        return run.outcome()

    def over(self, number: int, leg: Leg, runs: Sequence[Trajectory], so_far: Trajectory) -> None:
        """Keep how a leg ended: the last of the runs."""

    def finished(self, whole: Trajectory) -> Trajectory:
        """Return the run with all its rows."""
        return whole


class Stream(Memory):
    """Rows go to a run file, with marks between them; what it held before is not done again."""

    def __init__(self, file: RunFile, before: Path | None = None) -> None:
        self.file, self.before = file, before
        self.known = list(file.stretches)
        self.began = self.marked = time.monotonic()

    def runs(self) -> list[Trajectory]:
        """Return the legs that are over already, each with its last row."""
        return [self._leg(stretch) for stretch in self.known if stretch.over is not None]

    def _leg(self, stretch: Stretch) -> Trajectory:
        assert stretch.over is not None
        said, end = self.file.said(stretch.over), self.file.first_row(stretch) + len(stretch)
        values = self.file.content.values | {"impulses": ()}
        values |= {"integrator": said["integrator"], "watched": said["watched"]}
        datasets: dict[str, Any] = self.file.layout.parts(self.file.rows_of_legs(end - 1, end))
        datasets |= joined_datasets(self.file.told(stretch))
        content = self.file.content._replace(datasets=datasets, attributes=said["leg"], values=values)
        return Trajectory.of_content(content)

    def planned(self, number: int) -> dict[str, Any]:
        """Return what was planned for a leg that has begun already, nothing where it has not."""
        return next((stretch.about for stretch in self.known if stretch.number == number), {})

    def begin(self, number: int, leg: Leg, about: dict[str, Any]) -> None:
        """Begin a leg; or begin it again, as something else is planned for it now."""
        if not (self.known and self.known[-1].number == number):
            self.file.begin(number, leg.begin, about)

    def go(self, run: Run, show: Callable[[float], None]) -> Outcome:
        """Have a run followed as far as it goes, on from the last mark of its leg where there is one."""
        self.told = 0
        if self.known and self.known[-1].mark is not None and self.known[-1].over is None:
            self._restore(run, self.known[-1])
        self.known = []

        def look(elapsed: float) -> None:
            show(elapsed)
            self._look(run)

        run.go(look)
        self._add(run)
        if run.outcome(self._ends()).status == "completed":
            self._mark(run)
        self.refine(run)
        return run.outcome(self._columns())

    def _restore(self, run: Run, stretch: Stretch) -> None:
        """Have a run go on from the last mark of its leg, where it is one of this version."""
        assert stretch.mark is not None
        try:
            happened = [
                Happening(int(event), float(when), int(direction), variables)
                for told in self.file.told(stretch)
                for event, when, direction, variables in zip(*(told[name] for name in HAPPENED), strict=True)
            ]
            run.restore(self.file.said(stretch.mark)["run"], happened)
            self.told = len(happened)
        except (KeyError, ValueError):
            raise StorageError(
                f"{self.file.path}: this version does not know the marks of binaryast "
                f"{self.file.content.provenance.get('binaryast')}: install that one, or go on from the last row: "
                f"binaryast run {self.file.path} --duration TIME"
            ) from None

    def _look(self, run: Run) -> None:
        """Write rows where there are many, or some time has gone by; then also a mark."""
        now = time.monotonic()
        due = now - self.marked > max(OFTEN, min(SELDOM, PART * (now - self.began)))
        due = (due or bool(run.pressed)) and run.can_go_on
        if due or run.pending >= ROWS_AT_ONCE:
            self._add(run)
        if due:
            self._mark(run)
            self.marked = time.monotonic()

    def _add(self, run: Run) -> None:
        """Write the rows that are in memory."""
        when, motion = run.take_rows()
        if len(when):
            self.file.add(_parts(self.file, [when, *motion]))
        if len(run.happened) > self.told:
            self._tell(run)

    def _tell(self, run: Run) -> None:
        """Write what has happened since the last time."""
        new = slice(self.told, None)
        found = OccurrenceFloats(*(array[new] for array in run.outcome(self._ends()).occurrences))
        self.file.tell(found.datasets() | {"variables": np.array([one.variables for one in run.happened[new]])})
        self.told = len(run.happened)

    def _ends(self) -> tuple[Floats, Motion]:
        """Return the first and the last row of the leg under way."""
        when, motion = self._columns()
        ends = [0, len(when) - 1]
        return when[ends], Motion(*(column[ends] for column in motion))

    def _mark(self, run: Run) -> None:
        """Write from where the run can go on, and what would be said of it if it ended here."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            so_far = self.report(replace(run.outcome(self._ends()), status="interrupted"))
        self.file.mark({"run": run.checkpoint()} | _said(so_far))

    def _columns(self) -> tuple[Any, Motion]:
        """Return the rows of the leg under way, which are in the file."""
        stretch, names = self.file.stretches[-1], self.file.layout.names
        columns: dict[str, Any] = nothing_given(len(stretch))
        columns |= {name: Column(self.file, stretch, name) for name in names}
        return columns["time"], Motion(*(columns[name] for name in Motion._fields))

    def over(self, number: int, leg: Leg, runs: Sequence[Trajectory], so_far: Trajectory) -> None:
        """Keep how a leg ended: the last of the runs; one that was stopped by Ctrl-C is not over."""
        ended = runs[-1]
        if ended.status == "interrupted":
            return
        if not self.file.stretches or self.file.stretches[-1].number != number:  # a row that did not move
            self.file.begin(number, leg.begin, {})
            self.file.add(_parts(self.file, list(ended.si)))
        self.file.mark({"leg": ended.attributes()} | _said(so_far))

    def finished(self, whole: Trajectory) -> Trajectory:
        """Make the final file and return the run with all its rows; of one that was stopped the run file stays."""
        path, rows = self.file.path, len(self.file)
        if whole.status == "interrupted":
            self.file.file.close()
            return Trajectory.read(path)
        begun = self.file.content.provenance.get("date", "")
        whole = replace(whole, provenance=whole.provenance | {"begun": begun})
        small = rows * sum(self.file.layout.sizes) * 8 < storage.IN_MEMORY
        si = _floats(self.file.layout.parts(self.file.rows(0, rows))) if small else None
        try:
            storage.write(path, whole.content(), rows, self._pieces(whole, rows), force=True)
        except StorageError as error:
            raise StorageError(
                f"{error}: all rows are there: make room, and have the file completed: binaryast resume {path}"
            ) from None
        remove(self.before or set_aside(path))
        if si is None:
            si = _floats(storage.stored(path, self.file.layout.names))
        return replace(whole, si=si)

    def _pieces(self, whole: Trajectory, rows: int) -> Iterator[dict[str, Any]]:
        """Yield what the final file has a row of for each time, in pieces; then the run file is closed."""
        for begin, end in pieces_of(rows):
            parts = self.file.layout.parts(self.file.rows(begin, end))
            yield replace(whole, si=_floats(parts)).datasets()
        self.file.file.close()  # a file that is open cannot be replaced everywhere


def _parts(file: RunFile, arrays: Sequence[Floats]) -> list[Floats]:
    """Return those of the arrays of a trajectory that the rows of a file consist of."""
    named = dict(zip(TrajectoryFloats._fields, arrays, strict=True))
    return [named[name] for name in file.layout.names]


def _floats(parts: dict[str, Any]) -> TrajectoryFloats:
    """Return the arrays of a trajectory, of the parts of rows."""
    return TrajectoryFloats(**nothing_given(len(parts["time"])) | parts)


def _said(so_far: Trajectory) -> dict[str, Any]:
    """Return what is said of a run so far."""
    return {"attributes": so_far.attributes(), "integrator": so_far.integrator, "watched": so_far.watched}


def set_aside(path: Path) -> Path:
    """Return under which name a file that a run replaces is kept until the run is over."""
    return path.with_name(f"{path.name}.before")


def remove(path: Path) -> None:
    """Remove a file, if it is there."""
    path.unlink(missing_ok=True)


@contextmanager
def begun(path: Path, start: Trajectory, inputs: dict[str, Any], *, force: bool) -> Iterator[Stream]:
    """Give the stream of a run that begins, with its file under its final name.

    A file that it replaces is kept beside it until the run is over, and comes back where the run is refused.
    """
    data = bytearray(storage.image(start.content()._replace(datasets=start.datasets()), inputs))
    data[: storage.SEAL_SIZE] = storage.seal_of_run(bytes(data))
    before = None
    with storage.appearing(path, force=force) as temporary:
        temporary.write_bytes(data)
        if path.exists():
            before = path.replace(set_aside(path))
    with run_file.opened(path) as file:
        try:
            yield Stream(file, before)
        except (BinaryastError, KeyboardInterrupt) as error:
            if isinstance(error, StorageError) or any(stretch.over for stretch in file.stretches):
                raise
            if isinstance(error, KeyboardInterrupt) and file.last is not None:
                raise
            file.file.close()
            remove(path)
            if before is not None:
                before.replace(path)
            raise
