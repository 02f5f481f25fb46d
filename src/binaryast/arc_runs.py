"""What runs of solvers that know their arcs have in common, whoever's they are."""

from collections.abc import Sequence
from typing import Any

from binaryast.arcs import ArcLookout, Walked
from binaryast.outcome import Happening, Watch, contact_message, event_message
from binaryast.system import System
from binaryast.units import Floats

CHECKPOINT = ("y", "saved", "steps", "elapsed", "closest_time", "wall_time")


class ArcRun:
    """A run of such a solver: the rows in memory, how it ends, and what of it is in a checkpoint.

    Attributes
    ----------
    rows, saved, taken : list of ndarray, int, int
        The rows in memory; how many there were, and how many of them have left it.
    y, steps, elapsed, closest_time, wall_time
        The variables now; steps and time so far, and when the bodies were closest [s].
    ended, message : str, str
        How it ends.
    """

    system: System
    begin: float
    lookout: ArcLookout
    watch: Watch

    def _set_out(self, y: Floats, row: Floats) -> None:
        """Begin at some variables, of which a row is made."""
        self.y = y
        self.rows, self.saved, self.taken = [row], 1, 0
        self.ended, self.message = "completed", ""
        self.pressed: list[int] = []
        self.steps, self.elapsed, self.wall_time, self.closest_time = 0, 0.0, 0.0, 0.0

    def _end_by(self, walked: Walked) -> None:
        """Say how the run ends where an arc ended it."""
        after = self.begin + walked.end
        if walked.pair is not None:
            self.ended, self.message = "contact", contact_message(self.system, walked.pair, after)
        if walked.event is not None:
            self.ended, self.message = walked.event.status, event_message(walked.event, self.system, after)

    @property
    def happened(self) -> list[Happening]:
        """What has happened so far."""
        return self.lookout.happened

    @property
    def pending(self) -> int:
        """How many rows are in memory."""
        return len(self.rows)

    @property
    def can_go_on(self) -> bool:
        """Whether nothing has ended it but the end of its time, or Ctrl-C."""
        return self.ended in ("completed", "interrupted")

    def checkpoint(self) -> dict[str, Any]:
        """Return what the rest of the run depends on, after its rows were taken."""
        return {
            "watch": self.watch.array.copy(),
            "lookout": self.lookout.checkpoint(),
            **{name: getattr(self, name) for name in CHECKPOINT},
        }

    def restore(self, checkpoint: dict[str, Any], happened: Sequence[Happening]) -> None:
        """Go on from a checkpoint of a run with the same beginning; the rows before it are not made again."""
        self.watch.array[:] = checkpoint["watch"]
        self.lookout.restore(checkpoint["lookout"], happened)
        for name in CHECKPOINT:
            setattr(self, name, checkpoint[name])
        self.rows, self.taken = [], self.saved
