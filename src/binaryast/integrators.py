"""How a motion is followed: each integrator is a frozen value that says what it can do.

Those that step by compiled code name their step; `RungeKutta` goes through SciPy.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

from astropy.units import Quantity

from binaryast.errors import InputError, did_you_mean
from binaryast.units import brief, numbers, quantity, to_si
from binaryast.values import Value

FRAMES = ("relative", "inertial")
LEAST_TOLERANCE = 2.3e-14  # SciPy raises anything below to a hundred roundings


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
    """

    frame: str | None
    symplectic: ClassVar[bool]
    reversible: ClassVar[bool]
    adaptive: bool

    @property
    @abstractmethod
    def order(self) -> int:
        """Order of the error in the step."""

    def is_inertial(self, count: int) -> bool:
        """Return whether a system of that many bodies is stepped in the inertial frame.

        Raises
        ------
        InputError
            Where the relative frame is asked for several bodies.
        """
        if self.frame == "relative" and count > 2:
            raise InputError(
                f"{type(self).__name__}: frame='relative' is for a pair, got {count} bodies: take 'inertial'"
            )
        return count > 2 or self.frame == "inertial"


class Stepping(Integrator):
    """An integrator whose equal steps are compiled.

    Attributes
    ----------
    step : Quantity
        The largest step that the run may use [s].
    """

    step: Quantity

    @abstractmethod
    def kernel(self, *, inertial: bool) -> Callable[..., Any]:
        """Return the compiled step of a pair in the relative frame, or of any number of bodies in the inertial one."""

    @property
    @abstractmethod
    def largest_turn(self) -> float:
        """The turn h Omega [rad] at and above which a step has no solution."""


@dataclass(frozen=True, eq=False)
class LGVI(Stepping):
    """The Lie group variational integrator of Lee, Leok and McClamroch (2007): (118)-(127), and (93)-(97) for n bodies.

    Symplectic, momentum-preserving, reversible, and on SE(3) by construction; its energy error stays bounded. Its
    attitudes run ahead by Omega t (h Omega)^2/6, which energy does not show: choose the step by the fastest spin.

    Parameters
    ----------
    step : Quantity
        The largest step h (time). A run uses the largest step below it that divides its segments. A step with
        h Omega >= 1 is refused: about a principal axis (128) then has no solution.
    order : int
        2; higher orders by composition are not in this version.
    frame : {"relative", "inertial"}, optional
        The map (118)-(127) of a pair in the relative frame, or (93)-(97) of any number of bodies in the inertial one.
        For a pair both give the same motion; the relative frame is the default, for it is faster.

    Raises
    ------
    InputError
        For a step that is not a positive time, another order or another frame.

    References
    ----------
    T. Lee, M. Leok, N. H. McClamroch, Lie group variational integrators for the full body problem, CMAME 196 (2007)
    2907-2924, doi:10.1016/j.cma.2007.01.017.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> ba.LGVI(step=40 * u.s)
    LGVI(step=<Quantity 40. s>, order=2, frame=None)
    """

    step: Quantity
    order: int = 2
    frame: str | None = None

    symplectic: ClassVar[bool] = True
    reversible: ClassVar[bool] = True
    adaptive: ClassVar[bool] = False  # type: ignore[misc]

    def __post_init__(self) -> None:
        self._set(step=quantity(float(to_si(self.step, "s", "step", sign="positive")), "s"))
        if not isinstance(self.order, int) or self.order != 2:
            raise InputError(f"LGVI: order={brief(self.order)}: this version has order 2")
        check_frame(self.frame, "LGVI")

    def kernel(self, *, inertial: bool) -> Callable[..., Any]:
        """Return the compiled step of a pair in the relative frame, or of any number of bodies in the inertial one."""
        if inertial:
            from binaryast.kernels.bodies.lgvi import step as bodies_step

            return bodies_step
        from binaryast.kernels.pair.lgvi import step as pair_step

        return pair_step

    @property
    def largest_turn(self) -> float:
        """The turn h Omega [rad] at and above which a step is refused: (128) says sin(theta) = h Omega."""
        return 1.0


@dataclass(frozen=True, eq=False)
class RungeKutta(Integrator):
    """SciPy's explicit Runge-Kutta methods on the continuous equations: what the paper compares with (Fig. 6).

    It is a reference, not a recommendation. It adds to the elements of a rotation matrix as to any numbers, so its
    attitudes leave SO(3), and ||I - R^T R|| grows; energy and momenta drift; it is neither symplectic nor reversible.
    Over short arcs at a tight tolerance it is accurate, which is what it is good for. Rows between adaptive steps are
    SciPy's interpolation, a little less accurate than the steps. Its loop is Python: a step takes about a millisecond.

    Parameters
    ----------
    rtol, atol : float
        Tolerances of the local error, relative and absolute; the absolute one in units of the system, as the paper
        normalises: length, the distance of the bodies at the start; mass, the reduced one (of several bodies, the
        whole); time, so that G times the whole mass is 1. At least 2.3e-14.
    step : Quantity, optional
        A fixed step (time) instead of tolerances: the largest up to this that divides ``save_every``.
    method : {"DOP853", "RK45", "RK23"}
        Of `scipy.integrate`: orders 8, 5 and 3.
    frame : {"relative", "inertial"}, optional
        Equations (63)-(70) of a pair, the default, or (29)-(32) of any number of bodies.

    Raises
    ------
    InputError
        For an unknown method or frame, or tolerances outside of 0 < tolerance < 1.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> run = ba.propagate(system, state, duration=6 * u.h, integrator=ba.RungeKutta(rtol=1e-10, atol=1e-10))
    >>> run.status
    'completed'
    """

    rtol: float = 1e-12
    atol: float = 1e-12
    step: Quantity | None = None
    method: str = "DOP853"
    frame: str | None = None

    symplectic: ClassVar[bool] = False
    reversible: ClassVar[bool] = False
    orders: ClassVar[dict[str, int]] = {"DOP853": 8, "RK45": 5, "RK23": 3}

    def __post_init__(self) -> None:
        if self.step is not None:
            self._set(step=quantity(float(to_si(self.step, "s", "step", sign="positive")), "s"))
        for name in ("rtol", "atol"):
            value = float(numbers(getattr(self, name), f"RungeKutta: {name}", ()))
            if not LEAST_TOLERANCE <= value < 1:
                raise InputError(f"RungeKutta: {name}={value:g}: expected {LEAST_TOLERANCE:g} <= {name} < 1")
            self._set(**{name: value})
        if not isinstance(self.method, str) or self.method not in self.orders:
            near = did_you_mean(str(self.method), self.orders)
            raise InputError(
                f"RungeKutta: method={brief(repr(self.method))} is not known{near}; there are {', '.join(self.orders)}"
            )
        check_frame(self.frame, "RungeKutta")

    @property
    def order(self) -> int:
        """Order of the error in the step."""
        return self.orders[self.method]

    @property
    def adaptive(self) -> bool:  # type: ignore[override]
        """Whether the step follows the tolerances."""
        return self.step is None


def check_frame(frame: Any, name: str) -> None:
    """Raise for a frame that there is not."""
    if frame is not None and (not isinstance(frame, str) or frame not in FRAMES):
        raise InputError(f"{name}: frame={brief(repr(frame))}: expected one of {', '.join(FRAMES)}")
