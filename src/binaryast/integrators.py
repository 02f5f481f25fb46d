"""How a motion is followed: each integrator is a frozen value that says what it can do.

Those that step by compiled code name their step; `RungeKutta` goes through SciPy, `Taylor` through heyoka.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, inf, log, sqrt
from typing import Any, ClassVar

import numpy as np
from astropy.units import Quantity

from binaryast import schemes
from binaryast.errors import InputError, did_you_mean
from binaryast.schemes import Scheme
from binaryast.state import State
from binaryast.system import System
from binaryast.units import brief, numbers, quantity, to_si
from binaryast.values import Value

FRAMES = ("relative", "inertial")
LEAST_TOLERANCE = 2.3e-14  # SciPy raises anything below to a hundred roundings
FINEST_TAYLOR, COARSEST_TAYLOR = 1e-18, 1e-3  # what a tolerance of heyoka's can be


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
    title : str
        What it is, in a line.
    """

    title: ClassVar[str]
    several: ClassVar[bool] = True
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

    def check_start(self, system: System, state: State) -> None:
        """Raise an `InputError` where it cannot follow this system from here."""
        self.is_inertial(len(system.bodies))

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

    @property
    def order(self) -> int:
        """Order of the error in the step."""
        return self.shares.order

    @abstractmethod
    def kernel(self, *, inertial: bool) -> Callable[..., Any]:
        """Return the compiled step of a pair in the relative frame, or of any number of bodies in the inertial one."""

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


@dataclass(frozen=True, eq=False)
class LGVI(Stepping):
    """The Lie group variational integrator of Lee, Leok and McClamroch (2007): (118)-(127), and (93)-(97) for n bodies.

    Symplectic, momentum-preserving, reversible, and on SE(3) by construction; its energy error stays bounded. It
    follows from Hamilton's principle for a discrete Lagrangian. At order 2 its attitudes run ahead by Omega t (h
    Omega)^2/6, which energy does not show: choose the step by the fastest spin. A higher order is a symmetric
    composition of such steps of different lengths, some of them backwards. It follows from the same principle for the
    sum of their discrete Lagrangians, and the attitudes' lead falls with its order.

    Parameters
    ----------
    step : Quantity
        The largest step h (time), of the whole composition. A run uses the largest step below it that divides its
        segments. A step is refused where its longest part turns a body by h Omega >= 1, for about a principal axis
        (128) then has no solution: h Omega itself must stay below 1 at order 2, 1.52 at order 4 (0.59 with Yoshida's),
        1.25 at 6, 1.65 at 8, 2.43 at 10.
    order : {2, 4, 6, 8, 10}, optional
        2 by default. The orders take 1, 5, 9, 17 and 35 evaluations of gravity a step.
    frame : {"relative", "inertial"}, optional
        The map (118)-(127) of a pair in the relative frame, or (93)-(97) of any number of bodies in the inertial one.
        For a pair both give the same motion; the relative frame is the default, for it is faster.
    scheme : str, optional
        The composition by its name, in the place of the order: ``"suzuki4"``, the default at order 4; ``"yoshida4"``,
        the paper's, with 3 evaluations but, step for step, an error some fifty times larger; ``"kl6"``, ``"kl8"``,
        ``"ss10"``.

    Raises
    ------
    InputError
        For a step that is not a positive time, another order, scheme or frame.

    References
    ----------
    T. Lee, M. Leok, N. H. McClamroch, Lie group variational integrators for the full body problem, CMAME 196 (2007)
    2907-2924, doi:10.1016/j.cma.2007.01.017. H. Yoshida, Phys. Lett. A 150 (1990) 262; M. Suzuki, Phys. Lett. A 146
    (1990) 319; W. Kahan, R.-C. Li, Math. Comp. 66 (1997) 1089; M. Sofroniou, G. Spaletta, Optim. Methods Softw. 20
    (2005) 597.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> ba.LGVI(step=40 * u.s)
    LGVI(step=<Quantity 40. s>, order=2, frame=None, scheme=None)
    >>> ba.LGVI(step=120 * u.s, scheme="yoshida4").order
    4
    """

    step: Quantity
    order: int | None = None  # type: ignore[assignment]
    frame: str | None = None
    scheme: str | None = None

    title: ClassVar[str] = "the Lie group variational integrator and its compositions"
    schemes: ClassVar[dict[str, Scheme]] = schemes.COMPOSITIONS
    exact_rotation: ClassVar[bool] = False
    by_order: ClassVar[dict[int, str]] = {2: "leapfrog", 4: "suzuki4", 6: "kl6", 8: "kl8", 10: "ss10"}

    def __post_init__(self) -> None:
        self._check()
        of_scheme = 2 if self.scheme is None else self.schemes[self.scheme].order
        order = of_scheme if self.order is None else self.order
        if not isinstance(order, int) or order not in self.by_order:
            raise InputError(f"LGVI: order={brief(order)}: there are {', '.join(map(str, self.by_order))}")
        if self.scheme is not None and order != of_scheme:
            raise InputError(f"LGVI: scheme={self.scheme!r} has order {of_scheme}, got order={order}: leave one out")
        self._set(order=order)

    @property
    def shares(self) -> Scheme:  # type: ignore[override]
        """The shares of a step that its kicks and drifts have."""
        return self.schemes[self.scheme or self.by_order[self.order]]  # type: ignore[index]

    @property
    def largest_turn(self) -> float:  # type: ignore[override]
        """The turn h Omega [rad] at and above which a step is refused: (128) says sin(theta) = h Omega."""
        return 1.0 / self.shares.longest

    def kernel(self, *, inertial: bool) -> Callable[..., Any]:
        """Return the compiled step of a pair in the relative frame, or of any number of bodies in the inertial one."""
        if inertial:
            from binaryast.kernels.bodies.lgvi import step as bodies_step

            return bodies_step
        from binaryast.kernels.pair.lgvi import step as pair_step

        return pair_step


@dataclass(frozen=True, eq=False)
class Splitting(Stepping):
    """Free motion with exact rotation, and kicks by gravity: the kinetic and the potential energy take turns.

    A free rigid body is turned as Euler's equations say, to the last digits and however long the step is, so a fast
    spin costs nothing: the step is chosen by the orbit, the libration, and how uneven the spinning body is. Symplectic,
    reversible, momentum-preserving and on SE(3): it is made of exact flows of Hamiltonian systems that are all of this.
    It is variational too: its discrete Lagrangian is the exact one of the free motion between kicks, less the
    potential's quadrature with the kicks as weights (as long as no drift turns a body by more than half a turn).

    Parameters
    ----------
    step : Quantity
        The largest step h (time). A run uses the largest step below it that divides its segments.
    scheme : {"rkn6a", "rkn4", "ss10", "leapfrog"}
        Orders 6, 4, 10 and 2, with 14, 6, 35 and 1 evaluations of gravity a step (and one more at the end of each step
        of ``rkn6a``, which begins with a drift, to look at the energy).
    frame : {"relative", "inertial"}, optional
        Whose variables are stepped, as for `LGVI`.

    Raises
    ------
    InputError
        For a step that is not a positive time, another scheme or frame.

    References
    ----------
    S. Blanes, P. C. Moan, J. Comput. Appl. Math. 142 (2002) 313; M. Sofroniou, G. Spaletta, Optim. Methods Softw. 20
    (2005) 597; J. Touma, J. Wisdom, Astron. J. 107 (1994) 1189. J. E. Marsden, M. West, Acta Numerica 10 (2001) 357, on
    compositions as variational integrators.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> ba.Splitting(step=30 * u.min)
    Splitting(step=<Quantity 1800. s>, scheme='rkn6a', frame=None)
    """

    step: Quantity
    scheme: str = "rkn6a"
    frame: str | None = None

    title: ClassVar[str] = "free motion with exact rotation, and kicks by gravity"
    schemes: ClassVar[dict[str, Scheme]] = schemes.SPLITTINGS
    largest_turn: ClassVar[float] = inf  # type: ignore[misc]

    def __post_init__(self) -> None:
        self._check()

    @property
    def shares(self) -> Scheme:  # type: ignore[override]
        """The shares of a step that its kicks and drifts have."""
        return self.schemes[self.scheme]

    def kernel(self, *, inertial: bool) -> Callable[..., Any]:
        """Return the compiled step of a pair in the relative frame, or of any number of bodies in the inertial one."""
        if inertial:
            from binaryast.kernels.bodies.splitting import step as bodies_step

            return bodies_step
        from binaryast.kernels.pair.splitting import step as pair_step

        return pair_step


@dataclass(frozen=True, eq=False)
class KeplerSplitting(Stepping):
    """Kepler motion with exact rotation, and kicks by what gravity has beyond that of points: for bound pairs.

    As `Splitting`, with the two bodies moving as points do between kicks, so that a step may be a good part of an orbit
    (Wisdom and Holman; Touma and Wisdom for rigid bodies). Symplectic, reversible, momentum-preserving, on SE(3), and
    variational in the same sense: its discrete Lagrangian is the exact one of the Kepler motion and free rotation
    between kicks, less the quadrature of the rest.

    The schemes are made for what is small beside the Kepler motion: the error of ABA(10, 4) is of order eps h^10 +
    eps^2 h^4 of the strength eps of the rest. Torques turn a body as fast as they like, however, for its own motion is
    as slow as they are: libration is no small perturbation. So the order in the step, as it goes to zero, is 4 for all
    of them, and what distinguishes them is the error that is left.

    Parameters
    ----------
    step : Quantity
        The largest step h (time). A run uses the largest step below it that divides its segments.
    scheme : {"aba864", "aba104", "aba1064"}
        ABA(8, 6, 4), ABA(10, 4), ABA(10, 6, 4), with 7, 7 and 8 evaluations of gravity a step (and one more at its end,
        to look at the energy).
    corrector : bool
        Whether to follow the motion in variables in which the errors of ABA(10, 4) of order eps^2 h^4 are twenty times
        smaller, for that scheme only. The change of variables is symplectic, and made at the start and for each saved
        row, so it costs next to nothing; the figure of the energy is then that of the rows. It lowers the energy's
        error up to 25 times and that of the position 2 to 6 times; a tumbling body's attitude, whose error is of order
        eps^3, gains nothing.

    Raises
    ------
    InputError
        For a step that is not a positive time, another scheme or one without a corrector; when a run begins, for a
        system that is no bound pair.

    References
    ----------
    S. Blanes, F. Casas, A. Farres, J. Laskar, J. Makazaga, A. Murua, Appl. Numer. Math. 68 (2013) 58; J. Wisdom, M.
    Holman, Astron. J. 102 (1991) 1528; J. Touma, J. Wisdom, Astron. J. 107 (1994) 1189; R. I. McLachlan, ANZIAM J. 38
    (1996) 84, on correctors.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> ba.KeplerSplitting(step=30 * u.min)
    KeplerSplitting(step=<Quantity 1800. s>, scheme='aba864', corrector=False)
    """

    step: Quantity
    scheme: str = "aba864"
    corrector: bool = False

    title: ClassVar[str] = "Kepler motion with exact rotation, and kicks by the rest of gravity, for bound pairs"
    several: ClassVar[bool] = False
    frame: ClassVar[str] = "relative"  # type: ignore[misc]
    schemes: ClassVar[dict[str, Scheme]] = schemes.KEPLER_SPLITTINGS
    largest_turn: ClassVar[float] = inf  # type: ignore[misc]

    def __post_init__(self) -> None:
        self._check()
        if not isinstance(self.corrector, bool):
            raise InputError(f"KeplerSplitting: corrector={brief(repr(self.corrector))}: expected True or False")
        if self.corrector and self.scheme not in schemes.CORRECTORS:
            known = ", ".join(schemes.CORRECTORS)
            raise InputError(
                f"KeplerSplitting: corrector=True: scheme={self.scheme!r} has none; there is one of {known}"
            )

    @property
    def changed(self) -> Scheme | None:  # type: ignore[override]
        """The change of variables at the start of a run, None without a corrector."""
        return schemes.CORRECTORS[self.scheme] if self.corrector else None

    @property
    def shares(self) -> Scheme:  # type: ignore[override]
        """The shares of a step that its kicks and drifts have."""
        return self.schemes[self.scheme]

    def check_start(self, system: System, state: State) -> None:
        """Raise where it cannot follow this system from here.

        Raises
        ------
        InputError
            For several bodies, or a pair that is not bound as two points would be.
        """
        if len(system.bodies) > 2:
            raise InputError(f"KeplerSplitting: it is for a pair, got {len(system.bodies)} bodies: take ba.Splitting")
        if not self.is_bound(system, state):
            position, velocity, _, _ = state.si
            distance, speed = (float(np.linalg.norm(array[1] - array[0])) for array in (position, velocity))
            escape = sqrt(2 * sum(body.si.gm for body in system.bodies) / distance)
            raise InputError(
                f"KeplerSplitting: it is for a bound pair, got {speed:.4g} m/s at {distance:.4g} m, where {escape:.4g} "
                "m/s is the speed of escape: take ba.Splitting"
            )

    @staticmethod
    def is_bound(system: System, state: State) -> bool:
        """Whether a pair is bound as two points would be."""
        position, velocity, _, _ = state.si
        x, v = position[1] - position[0], velocity[1] - velocity[0]
        return bool(v @ v / 2 * np.linalg.norm(x) < sum(body.si.gm for body in system.bodies))

    def kernel(self, *, inertial: bool) -> Callable[..., Any]:
        """Return the compiled step of a pair."""
        from binaryast.kernels.pair.kepler_splitting import step

        return step


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


def check_frame(frame: Any, name: str) -> None:
    """Raise for a frame that there is not."""
    if frame is not None and (not isinstance(frame, str) or frame not in FRAMES):
        raise InputError(f"{name}: frame={brief(repr(frame))}: expected one of {', '.join(FRAMES)}")


KINDS: dict[str, type[Integrator]] = {
    kind.__name__: kind for kind in (LGVI, Splitting, KeplerSplitting, RungeKutta, Taylor)
}
