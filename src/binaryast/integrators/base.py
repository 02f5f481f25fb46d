"""What every integrator declares, and what those have in common whose equal steps are compiled."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, ClassVar

from astropy.units import Quantity

from binaryast.errors import InputError, did_you_mean
from binaryast.schemes import Scheme
from binaryast.state import State
from binaryast.system import System
from binaryast.units import brief, quantity, to_si
from binaryast.values import Value

FRAMES = ("relative", "inertial")


class Integrator(Value, ABC):
    """What every integrator declares.

    Attributes
    ----------
    order : int
        Order of the error in the step.
    frame : {"relative", "inertial"} or None
        Whose variables are stepped: the paper's relative frame, for a pair only, or its inertial frame; None is the
        relative frame for a pair and the inertial one for several bodies.
    symplectic, reversible, adaptive : bool
        Its properties.
    several : bool
        Whether it takes more than two bodies.
    disturbed : bool
        Whether it takes perturbations, and bodies that do not pull.
    title : str
        What it is, in a line.
    """

    title: ClassVar[str]
    several: ClassVar[bool] = True
    disturbed: ClassVar[bool] = False
    frame: str | None
    symplectic: ClassVar[bool]
    reversible: ClassVar[bool]
    adaptive: bool

    @property
    @abstractmethod
    def order(self) -> int:
        """Order of the error in the step."""

    def is_inertial(self, system: System) -> bool:
        """Return whether a system is stepped in the inertial frame: of several bodies, and where one does not pull.

        Raises
        ------
        InputError
            Where the relative frame is asked for these.
        """
        count = len(system.bodies)
        needed = count > 2 or not all(body.pulls for body in system.bodies)
        if self.frame == "relative" and needed:
            found = f"{count} bodies" if count > 2 else "a body that does not pull"
            raise InputError(f"{type(self).__name__}: frame='relative' is for a pair, got {found}: take 'inertial'")
        return needed or self.frame == "inertial"

    def check_start(self, system: System, state: State) -> None:
        """Raise an `InputError` where it cannot follow this system from here."""
        self.is_inertial(system)
        others = "take ba.LGVI or ba.Splitting"
        if system.perturbations and not self.disturbed:
            raise InputError(f"{type(self).__name__}: it takes no perturbations: {others}")
        still = [body.name for body in system.bodies if not body.pulls]
        if still and not self.disturbed:
            raise InputError(
                f"{type(self).__name__}: it takes no bodies that do not pull, such as {still[0]}: {others}"
            )

    @classmethod
    def variants(cls) -> list[str]:
        """Return what there is to choose, a line each."""
        return []


class Stepping(Integrator):
    """An integrator whose equal steps are compiled: kicks by gravity and drifts without it, in turn.

    Attributes
    ----------
    step : Quantity
        The largest step that the run may use [s].
    shares : Scheme
        The shares of a step that its kicks and drifts have.
    largest_turn : float
        The turn h Omega [rad] at and above which a step has no solution; infinite where there always is one.
    changed : Scheme or None
        The change of variables in which the steps are taken, undone for each saved row.
    """

    step: Quantity
    shares: Scheme
    largest_turn: float
    changed: Scheme | None = None

    symplectic: ClassVar[bool] = True
    reversible: ClassVar[bool] = True
    adaptive: ClassVar[bool] = False  # type: ignore[misc]
    schemes: ClassVar[dict[str, Scheme]]
    exact_rotation: ClassVar[bool] = True
    disturbed: ClassVar[bool] = True

    @property
    def order(self) -> int:
        """Order of the error in the step."""
        return self.shares.order

    @abstractmethod
    def kernel(self, *, inertial: bool, disturbed: bool = False) -> Callable[..., Any]:
        """Return the compiled step of a pair in the relative frame, or of any number of bodies in the inertial one.

        ``disturbed`` tells whether anything acts from outside.
        """

    @classmethod
    def variants(cls) -> list[str]:
        """Return its schemes, a line each."""
        return [
            f"scheme={name:10} order {scheme.order:2}, {scheme.evaluations:2} evaluations of gravity a step"
            + ("" if cls.exact_rotation else f", h Omega < {1 / scheme.longest:.3g}")
            + f"   {scheme.source}"
            for name, scheme in cls.schemes.items()
        ]

    def _check(self) -> None:
        """Take the unit off the step, and raise for a scheme or a frame that there is not."""
        name = type(self).__name__
        self._set(step=quantity(float(to_si(self.step, "s", "step", sign="positive")), "s"))
        check_frame(self.frame, name)
        scheme = getattr(self, "scheme", None)
        if scheme is not None and (not isinstance(scheme, str) or scheme not in self.schemes):
            near = did_you_mean(str(scheme), self.schemes)
            raise InputError(
                f"{name}: scheme={brief(repr(scheme))} is not known{near}; there are {', '.join(self.schemes)}"
            )


def check_frame(frame: Any, name: str) -> None:
    """Raise for a frame that there is not."""
    if frame is not None and (not isinstance(frame, str) or frame not in FRAMES):
        raise InputError(f"{name}: frame={brief(repr(frame))}: expected one of {', '.join(FRAMES)}")
