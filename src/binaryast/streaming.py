"""Where the rows of a run go while it is under way: into memory, or into a run file that the run can go on from."""

import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any, Protocol

from binaryast import run_file, storage
from binaryast.errors import BinaryastError, StorageError
from binaryast.outcome import Outcome
from binaryast.run_file import ROWS_AT_ONCE, Column, RunFile, Stretch, pieces_of
from binaryast.schedule import Leg
from binaryast.trajectory import Trajectory, TrajectoryFloats
from binaryast.units import Floats
from binaryast.working import Motion

OFTEN = 0.5  # s between two marks, at the beginning of a run
SELDOM = 30.0  # s, when it has lasted for an hour
PART = OFTEN / 60  # of the time that a run has lasted: the marks of a week are some thousands


class Run(Protocol):
    """What a run under way offers, by whatever method."""

    pressed: list[int]

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

    def restore(self, checkpoint: dict[str, Any]) -> None:
        """Go on from a checkpoint."""

    def outcome(self, rows: tuple[Floats, Motion] | None = None) -> Outcome:
        """Return what has been computed."""


class Memory:
    """Rows stay in memory, and nothing is written.

    Attributes
    ----------
    report : callable
        Gives the run so far, from the outcome of the leg under way.
    """

    report: Callable[[Outcome], Trajectory]

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
        values = self.file.content.values | {"integrator": said["integrator"], "impulses": ()}
        rows = self.file.layout.parts(self.file.rows(end - 1, end))
        return Trajectory.of_content(self.file.content._replace(datasets=rows, attributes=said["leg"], values=values))

    def planned(self, number: int) -> dict[str, Any]:
        """Return what was planned for a leg that has begun already, nothing where it has not."""
        return next((stretch.about for stretch in self.known if stretch.number == number), {})

    def begin(self, number: int, leg: Leg, about: dict[str, Any]) -> None:
        """Begin a leg; or begin it again, as something else is planned for it now."""
        if not (self.known and self.known[-1].number == number):
            self.file.begin(number, leg.begin, about)

    def go(self, run: Run, show: Callable[[float], None]) -> Outcome:
        """Have a run followed as far as it goes, on from the last mark of its leg where there is one."""
        if self.known and self.known[-1].mark is not None and self.known[-1].over is None:
            self._restore(run, self.file.said(self.known[-1].mark)["run"])
        self.known = []

        def look(elapsed: float) -> None:
            show(elapsed)
            self._look(run)

        run.go(look)
        self._add(run)
        outcome = run.outcome(self._columns())
        if outcome.status == "completed":
            self._mark(run)
        return outcome

    def _restore(self, run: Run, checkpoint: dict[str, Any]) -> None:
        """Have a run go on from a mark, where it is one of this version."""
        try:
            run.restore(checkpoint)
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
            self.file.add([when, *motion])

    def _mark(self, run: Run) -> None:
        """Write from where the run can go on, and what would be said of it if it ended here."""
        when, motion = self._columns()
        ends = [0, len(when) - 1]
        outcome = run.outcome((when[ends], Motion(*(column[ends] for column in motion))))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            so_far = self.report(replace(outcome, status="interrupted"))
        values = {"attributes": so_far.attributes(), "integrator": so_far.integrator}
        self.file.mark({"run": run.checkpoint()} | values)

    def _columns(self) -> tuple[Any, Motion]:
        """Return the rows of the leg under way, which are in the file."""
        names = self.file.layout.names
        when, *motion = (Column(self.file, self.file.stretches[-1], name) for name in names)
        return when, Motion(*motion)  # type: ignore[arg-type]

    def over(self, number: int, leg: Leg, runs: Sequence[Trajectory], so_far: Trajectory) -> None:
        """Keep how a leg ended: the last of the runs; one that was stopped by Ctrl-C is not over."""
        ended = runs[-1]
        if ended.status == "interrupted":
            return
        if not self.file.stretches or self.file.stretches[-1].number != number:  # a row that did not move
            self.file.begin(number, leg.begin, {})
            self.file.add(list(ended.si))
        values = {"attributes": so_far.attributes(), "integrator": so_far.integrator}
        self.file.mark({"leg": ended.attributes()} | values)

    def finished(self, whole: Trajectory) -> Trajectory:
        """Make the final file and return the run with all its rows; of one that was stopped the run file stays."""
        path, rows = self.file.path, len(self.file)
        if whole.status == "interrupted":
            self.file.file.close()
            return Trajectory.read(path)
        begun = self.file.content.provenance.get("date", "")
        whole = replace(whole, provenance=whole.provenance | {"begun": begun})
        small = rows * sum(self.file.layout.sizes) * 8 < storage.IN_MEMORY
        si = TrajectoryFloats(**self.file.layout.parts(self.file.rows(0, rows))) if small else None
        try:
            storage.write(path, whole.content(), rows, self._pieces(whole, rows), force=True)
        except StorageError as error:
            raise StorageError(
                f"{error}: all rows are there: make room, and have the file completed: binaryast resume {path}"
            ) from None
        remove(self.before or set_aside(path))
        if si is None:
            si = TrajectoryFloats(**storage.stored(path, self.file.layout.names))
        return replace(whole, si=si)

    def _pieces(self, whole: Trajectory, rows: int) -> Iterator[dict[str, Any]]:
        """Yield what the final file has a row of for each time, in pieces; then the run file is closed."""
        for begin, end in pieces_of(rows):
            parts = self.file.layout.parts(self.file.rows(begin, end))
            yield replace(whole, si=TrajectoryFloats(**parts)).datasets()
        self.file.file.close()  # a file that is open cannot be replaced everywhere


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
