"""The Lie group variational integrator and its compositions."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

from astropy.units import Quantity

from binaryast import schemes
from binaryast.errors import InputError
from binaryast.integrators.base import Stepping
from binaryast.schemes import Scheme
from binaryast.units import brief


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

    def kernel(self, *, inertial: bool, disturbed: bool = False) -> Callable[..., Any]:
        """Return the compiled step of a pair in the relative frame, or of any number of bodies in the inertial one."""
        if disturbed:
            from binaryast.kernels.bodies import disturbed_steps as of_bodies
            from binaryast.kernels.pair import disturbed_steps as of_pair

            return of_bodies.lgvi() if inertial else of_pair.lgvi()
        if inertial:
            from binaryast.kernels.bodies.lgvi import step as bodies_step

            return bodies_step
        from binaryast.kernels.pair.lgvi import step as pair_step

        return pair_step
