"""Splittings, in which a free body turns exactly."""

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, sqrt
from typing import Any, ClassVar

import numpy as np
from astropy.units import Quantity

from binaryast import schemes
from binaryast.errors import InputError
from binaryast.integrators.base import Stepping
from binaryast.schemes import Scheme
from binaryast.state import State
from binaryast.system import System
from binaryast.units import brief


class ExactRotation(Stepping):
    """What splittings have in common: a scheme by its name, and a solution for every step."""

    scheme: str
    largest_turn: ClassVar[float] = inf  # type: ignore[misc]

    @property
    def shares(self) -> Scheme:  # type: ignore[override]
        """The shares of a step that its kicks and drifts have."""
        return self.schemes[self.scheme]


@dataclass(frozen=True, eq=False)
class Splitting(ExactRotation):
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

    def __post_init__(self) -> None:
        self._check()

    def kernel(self, *, inertial: bool, disturbed: bool = False) -> Callable[..., Any]:
        """Return the compiled step of a pair in the relative frame, or of any number of bodies in the inertial one."""
        if disturbed:
            from binaryast.kernels.bodies import disturbed_steps as of_bodies
            from binaryast.kernels.pair import disturbed_steps as of_pair

            return of_bodies.splitting() if inertial else of_pair.splitting()
        if inertial:
            from binaryast.kernels.bodies.splitting import step as bodies_step

            return bodies_step
        from binaryast.kernels.pair.splitting import step as pair_step

        return pair_step


@dataclass(frozen=True, eq=False)
class KeplerSplitting(ExactRotation):
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
        row, so it costs next to nothing; the figure of the energy is then that of the rows. Errors of the position
        about halve (``python -m validation.benchmark`` has both side by side), those of the energy fall more; a
        tumbling body's attitude, whose error is of order eps^3, gains nothing.

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

    def check_start(self, system: System, state: State) -> None:
        """Raise where it cannot follow this system from here.

        Raises
        ------
        InputError
            For several bodies, or a pair that is not bound as two points would be.
        """
        if len(system.bodies) > 2:
            raise InputError(f"KeplerSplitting: it is for a pair, got {len(system.bodies)} bodies: take ba.Splitting")
        if not all(body.pulls for body in system.bodies):
            raise InputError("KeplerSplitting: it takes no body that does not pull: take ba.Splitting")
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

    def kernel(self, *, inertial: bool, disturbed: bool = False) -> Callable[..., Any]:
        """Return the compiled step of a pair."""
        if disturbed:
            from binaryast.kernels.pair import disturbed_steps

            return disturbed_steps.kepler_splitting()
        from binaryast.kernels.pair.kepler_splitting import step

        return step
