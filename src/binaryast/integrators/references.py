"""What goes through other libraries, to compare with: SciPy's Runge-Kutta methods and heyoka's Taylor series."""

from dataclasses import dataclass
from math import ceil, log
from typing import ClassVar

import numpy as np
from astropy.units import Quantity

from binaryast.errors import InputError, did_you_mean
from binaryast.integrators.base import Integrator, check_frame
from binaryast.units import brief, numbers, quantity, to_si

LEAST_TOLERANCE = 2.3e-14  # SciPy raises anything below to a hundred roundings
FINEST_TAYLOR, COARSEST_TAYLOR = 1e-18, 1e-3  # what a tolerance of heyoka's can be


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

    title: ClassVar[str] = "SciPy's Runge-Kutta methods on the equations as printed, to compare with"
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

    @classmethod
    def variants(cls) -> list[str]:
        """Return its methods, a line each."""
        return [
            f"method={name:10} order {order:2}, steps by tolerances or of a fixed size"
            for name, order in cls.orders.items()
        ]

    @property
    def adaptive(self) -> bool:  # type: ignore[override]
        """Whether the step follows the tolerances."""
        return self.step is None


@dataclass(frozen=True, eq=False)
class Taylor(Integrator):
    """Taylor series of the motion, by heyoka, for whoever needs round-off over short arcs.

    heyoka (F. Biscani, D. Izzo, 2021) writes out the derivatives of the equations of motion by time to a high order, at
    the smallest tolerances some 20, and compiles them. A step goes as far as the series is good for; rows between steps
    are values of the series, as accurate as the steps. Attitudes are quaternions. The method is neither symplectic nor
    reversible: what it conserves, it conserves because its error is round-off.

    Gravity must be a formula: `PointMass`, `SecondDegree`, `Multipole` of any degree, and `PointPairs` of up to 4096
    pairs of points, between bodies of any kind and number. For long runs, `LGVI` and the splittings cost less; for
    gravity that is no formula there is `RungeKutta`.

    Parameters
    ----------
    tolerance : float
        Of the error of a step, in units of the system: length, about the distance of the first two bodies at the start;
        time, about that in which they go round each other, over 2 pi. From 1e-18 to 1e-3; 1e-16 by default, below
        which there is only round-off.
    compact : bool
        Whether to compile loops, the default, or everything written out. For two ellipsoids at degree 2, 4, 8 and 16
        loops take 0.8, 1.2, 1.9 and 3.6 s to compile, for 64 and 64 points 3.5 s. What is written out takes 18, 40 and
        72 s at degree 2, 4 and 6; its steps then take two thirds of the time, 18 in the place of 28 us at degree 2,
        beside some 40 us for what is watched at each. heyoka keeps what is compiled on disk, for all systems of one
        kind.

    Attributes
    ----------
    order : int
        That of the series, which heyoka chooses by the tolerance.

    Raises
    ------
    InputError
        For a tolerance outside of these limits; from a run, where heyoka is not installed (``pip install
        'binaryast[taylor]'``, or from conda-forge), or gravity is no formula.

    References
    ----------
    F. Biscani, D. Izzo, Revisiting high-order Taylor methods for astrodynamics and celestial mechanics, MNRAS 504
    (2021) 2614-2628, doi:10.1093/mnras/stab1032.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> ba.Taylor().order
    20
    >>> run = ba.propagate(system, state, duration=6 * u.h, integrator=ba.Taylor())  # doctest: +SKIP
    >>> run.status  # doctest: +SKIP
    'completed'
    """

    tolerance: float = 1e-16
    compact: bool = True

    title: ClassVar[str] = "Taylor series by heyoka, to round-off over short arcs"
    frame: ClassVar[str] = "inertial"  # type: ignore[misc]
    symplectic: ClassVar[bool] = False
    reversible: ClassVar[bool] = False
    adaptive: ClassVar[bool] = True  # type: ignore[misc]

    def __post_init__(self) -> None:
        tolerance = float(numbers(self.tolerance, "Taylor: tolerance", ()))
        if not FINEST_TAYLOR <= tolerance <= COARSEST_TAYLOR:
            raise InputError(
                f"Taylor: tolerance={tolerance:g}: expected {FINEST_TAYLOR:g} <= tolerance <= {COARSEST_TAYLOR:g}"
            )
        if not isinstance(self.compact, (bool, np.bool_)):
            raise InputError(f"Taylor: compact={brief(self.compact)}: expected True or False")
        self._set(tolerance=tolerance, compact=bool(self.compact))

    @property
    def order(self) -> int:
        """Order of the series, as heyoka chooses it."""
        return max(2, ceil(1 - log(self.tolerance) / 2))

    @classmethod
    def variants(cls) -> list[str]:
        """Return what there is to choose, a line each."""
        return [f"order {cls().order} at tolerance={cls().tolerance:g}, steps by the tolerance"]
