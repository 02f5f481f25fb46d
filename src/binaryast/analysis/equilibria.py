"""Relative equilibria of a pair: where both bodies and the orbit turn as one, and how it moves near there."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import permutations
from typing import Any

import numpy as np
from astropy.units import Quantity
from scipy.spatial.transform import Rotation

from binaryast.analysis.reduced import Reduced
from binaryast.errors import InputError
from binaryast.state import RelativeState
from binaryast.system import System
from binaryast.units import Floats, brief, quantity, to_si
from binaryast.values import Value

AXES = {"x": 0, "y": 1, "z": 2}
ROUNDS = 30
BALANCED = 1e-12  # of force and torques left, in numbers of order one
NUDGE = 1e-5  # of what is sought, for differences: good enough to converge by
NEUTRAL = 1e-5  # of the rate: slower motions are taken for none at all
SAME = 1e-10


@dataclass(frozen=True, eq=False)
class Equilibrium(Value):
    """A relative equilibrium of a pair.

    Attributes
    ----------
    state : RelativeState
        X, V, R, Omega and Omega2, at the start and for ever.
    primary_axes, secondary_axes : tuple of str
        Which axis of each lies along the line of centres, and which along the pole; without symmetry, nearly.
    separation, rate : Quantity
        Of the mass centres [m], and at which all turns [rad/s].
    energy : Quantity
        Kinetic and potential [J].
    frequencies : Quantity
        Of the small oscillations [rad/s], from the lowest; neutral motions, such as the turn of a body of revolution
        about its axis, are left out.
    growth : Quantity
        The largest rate at which a small motion grows [rad/s]; zero where none does.
    stable : bool
        Whether none grows, to first order.
    residual : float
        What is left of forces and torques, the largest, over m n^2 r and over the moments of inertia times n^2.
    """

    state: RelativeState
    primary_axes: tuple[str, str]
    secondary_axes: tuple[str, str]
    separation: Quantity
    rate: Quantity
    energy: Quantity
    frequencies: Quantity
    growth: Quantity
    stable: bool
    residual: float

    @property
    def period(self) -> Quantity:
        """Of the turn [h]."""
        return quantity(2 * np.pi / self.rate.value, "s").to("h")


def relative_equilibrium(
    system: System,
    *,
    separation: Quantity | None = None,
    period: Quantity | None = None,
    primary: Sequence[str] = ("x", "z"),
    secondary: Sequence[str] = ("x", "z"),
) -> Equilibrium:
    """Return the relative equilibrium near that in which given axes are aligned, for any gravity of the pair.

    Both bodies turn with the orbit. It is found by Newton's method, in the sense of least squares, for round bodies
    leave attitudes free, on force and torques; for bodies without symmetry the axes end up a little beside. The small
    motions about it are those of the paper's reduced equations (63)-(67), linearised by differences of order 8.

    Parameters
    ----------
    system : System
        The pair.
    separation, period : Quantity
        Exactly one: distance of the mass centres (length), or time of a turn (time).
    primary, secondary : sequence of two of {"x", "y", "z"}
        Which axis of each body lies along the line of centres, and which along the pole. Both long axes aligned, and
        the short ones upright, by default, for bodies whose x axis is the long one.

    Returns
    -------
    Equilibrium
        A round body, such as a sphere, is carried along, and its turn counts neither for stability nor as oscillation.

    Raises
    ------
    InputError
        For two round bodies, whose orbit is Kepler's; where there is no equilibrium; for both or neither of separation
        and period.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> sphere = ba.RigidBody("sphere", ba.Sphere(400 * u.m), mass=5.4e11 * u.kg)
    >>> stone = ba.RigidBody("stone", ba.Ellipsoid(85 * u.m, 73 * u.m, 63 * u.m), mass=3.93e9 * u.kg)
    >>> found = ba.analysis.relative_equilibrium(ba.System([sphere, stone]), separation=1195 * u.m)
    >>> found.stable, (found.frequencies / found.rate).value.round(5)
    (True, array([0.30521, 0.66661, 1.00179, 1.34764]))
    """
    axes = _axes(primary, "primary"), _axes(secondary, "secondary")
    if not isinstance(system, System) or len(system.bodies) != 2:
        raise InputError(f"relative_equilibrium: expected a ba.System of two bodies, got {brief(system)}")
    if (separation is None) == (period is None):
        raise InputError("relative_equilibrium: give exactly one of separation= and period=")
    gm = float(system.primary.si.gm + system.secondary.si.gm)
    if separation is not None:
        r = float(to_si(separation, "m", "separation", sign="positive"))
        n = float(np.sqrt(gm / r**3))
    else:
        n = 2 * np.pi / float(to_si(period, "s", "period", sign="positive"))
        r = float(np.cbrt(gm / n**2))
    return _solved(system, axes, r, n, by_period=separation is None)


def relative_equilibria(
    system: System, *, separation: Quantity | None = None, period: Quantity | None = None
) -> tuple[Equilibrium, ...]:
    """Return all relative equilibria in which axes of both bodies are aligned, or nearly, from the lowest energy.

    Parameters
    ----------
    system, separation, period
        As for `relative_equilibrium`.

    Returns
    -------
    tuple of Equilibrium
        Up to 36: those that differ by what a body of revolution does not show are given once.

    Raises
    ------
    InputError
        As for `relative_equilibrium`, where none is found.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> sphere = ba.RigidBody("sphere", ba.Sphere(400 * u.m), mass=5.4e11 * u.kg)
    >>> stone = ba.RigidBody("stone", ba.Ellipsoid(85 * u.m, 73 * u.m, 63 * u.m), mass=3.93e9 * u.kg)
    >>> found = ba.analysis.relative_equilibria(ba.System([sphere, stone]), separation=1195 * u.m)
    >>> [(*one.secondary_axes, one.stable) for one in found if one.stable]
    [('x', 'z', True)]
    >>> len(found)
    6
    """
    found: list[Equilibrium] = []
    reason: InputError | None = None
    for primary in permutations(AXES, 2):
        for secondary in permutations(AXES, 2):
            try:
                one = relative_equilibrium(
                    system, separation=separation, period=period, primary=primary, secondary=secondary
                )
            except InputError as error:
                reason = error
                continue
            if not any(_same(one, other) for other in found):
                found.append(one)
    if not found:
        raise reason or InputError("relative_equilibria: there is none")
    return tuple(sorted(found, key=lambda one: float(one.energy.value)))


def _axes(names: Any, what: str) -> tuple[str, str]:
    """Return the names of two axes of a body."""
    good = isinstance(names, (str, list, tuple)) and len(names) == 2 and all(name in AXES for name in names)
    if not good or names[0] == names[1]:
        raise InputError(
            f"{what}: expected two different axes, along the line of centres and along the pole, "
            f'such as ("x", "z"), got {brief(names)}'
        )
    return str(names[0]), str(names[1])


def _attitude(names: tuple[str, str]) -> Floats:
    """Return a body's attitude (3, 3) in the orbit frame when the named axes lie along x and z of it."""
    along, up = np.eye(3)[AXES[names[0]]], np.eye(3)[AXES[names[1]]]
    return np.array([along, np.cross(up, along), up])


def _solved(
    system: System, axes: tuple[tuple[str, str], tuple[str, str]], r: float, n: float, *, by_period: bool
) -> Equilibrium:
    """Return the equilibrium, from the aligned one as a first guess."""
    x: Floats
    turn: Floats
    rate: Floats
    primary, secondary = (_attitude(names) for names in axes)
    plain = Reduced(system, False, r, n)
    x, turn = primary.T[:, 0], primary.T @ secondary
    whole = [plain.is_round(seen, x, turn) for seen in (False, True)]
    if all(whole):
        raise InputError(
            f"relative_equilibrium: {' and '.join(system.names)} attract like points: every circle is one, and its "
            "only frequency is Kepler's: expected a body that is not round"
        )
    swapped = whole[0]  # a round body has no frame of its own
    reduced = Reduced(system, swapped, r, n)
    if swapped:
        x, turn, rate = -secondary.T[:, 0], secondary.T @ primary, secondary.T[:, 2]
    else:
        rate = primary.T[:, 2]
    x, turn, rate, residual = _newton(reduced, x, turn, rate, by_period=by_period)
    matrix = reduced.matrix(x, turn, rate, seen_turns=not (whole[0] or whole[1]))
    size = float(np.linalg.norm(rate))
    values = np.linalg.eigvals(matrix) / size
    oscillating = values[(values.imag > NEUTRAL)]
    growth = float(values.real.max(initial=0.0))
    growth = growth if growth > NEUTRAL else 0.0
    potential = reduced.pull(x, turn).energy
    seen, own = reduced.moments
    spins = np.sum(seen * (turn.T @ rate) ** 2) + np.sum(own * rate**2)
    kinetic = 0.5 * (np.sum(np.cross(rate, x) ** 2) + spins)
    unit = system.reduced_mass * (r * n) ** 2
    return Equilibrium(
        state=_state(reduced, x, turn, rate),
        primary_axes=axes[0],
        secondary_axes=axes[1],
        separation=quantity(r * np.linalg.norm(x), "m"),
        rate=quantity(n * size, "rad / s"),
        energy=quantity(unit * (kinetic + potential), "J"),
        frequencies=quantity(np.sort(oscillating.imag) * n * size, "rad / s"),
        growth=quantity(growth * n * size, "rad / s"),
        stable=growth == 0.0,
        residual=residual,
    )


def _newton(
    reduced: Reduced, x: Floats, turn: Floats, rate: Floats, *, by_period: bool
) -> tuple[Floats, Floats, Floats, float]:
    """Return X, R and the rate of the equilibrium nearest to a guess, and what is left of forces and torques."""

    def left(z: Floats, at: tuple[Floats, Floats, Floats]) -> Floats:
        place, turned, spin = at[0] + z[:3], Rotation.from_rotvec(z[3:6]).as_matrix() @ at[1], at[2] + z[6:]
        kept = spin @ spin - 1 if by_period else place @ place - 1
        return np.append(reduced.imbalance(place, turned, spin), kept)

    at = x, turn, rate
    best, size = at, np.inf
    for _ in range(ROUNDS):
        values = left(np.zeros(9), at)
        now = float(np.abs(values).max())
        if now < size:
            best, size = at, now
        elif size < BALANCED:
            break
        columns = [(left(one, at) - left(-one, at)) / (2 * NUDGE) for one in NUDGE * np.eye(9)]
        step = -np.linalg.lstsq(np.column_stack(columns), values, rcond=1e-7)[0]
        at = at[0] + step[:3], Rotation.from_rotvec(step[3:6]).as_matrix() @ at[1], at[2] + step[6:]
    if not size < BALANCED:
        raise InputError(
            f"relative_equilibrium: none is found near these axes: of forces and torques {size:.2g} is left, expected "
            f"{BALANCED:g}: try other axes, or a larger separation"
        )
    return *best, size


def _state(reduced: Reduced, x: Floats, turn: Floats, rate: Floats) -> RelativeState:
    """Return an equilibrium as the paper's variables, in the primary's frame."""
    if reduced.swapped:
        x, turn, rate = -turn.T @ x, turn.T, turn.T @ rate
    x, rate = reduced.separation * x, reduced.rate * rate
    return RelativeState(
        X=quantity(x, "m"),
        V=quantity(np.cross(rate, x), "m / s"),
        R=turn,
        Omega=quantity(rate, "rad / s"),
        Omega2=quantity(rate, "rad / s"),
    )


def _same(one: Equilibrium, other: Equilibrium) -> bool:
    """Whether two are the same but for what a round body or one of revolution does not show."""
    a, b = ([e.energy.value, e.separation.value, e.rate.value, (e.growth + e.rate).value] for e in (one, other))
    return bool(np.allclose(a, b, rtol=SAME, atol=0)) and len(one.frequencies) == len(other.frequencies)
