"""The exact rotor: free bodies of all kinds by the compiled code, beside Taylor's series of Euler's equations."""

from typing import NamedTuple

import numpy as np
from numba import types

from binaryast.kernels.arrays import put_quaternion, put_vector
from binaryast.kernels.free_rotation import Attitude, turn_both_exactly, turn_exactly
from binaryast.kernels.jit import ARRAY, ROWS, Array, Quaternion, Vector, jit, reference
from validation import drawing
from validation.case import Case, Check, Effort, Findings, Picture
from validation.oracles import rotors
from validation.oracles.nbody import EXTENDED

COUNT = 1000  # of bodies in a kind
ROUNDING = float(np.finfo(float).eps) / 2
NO_REST = (0.0, 0.0, 0.0)  # nothing that rounding took
NEEDLES, LONG = "needles and plates", "h Omega from 1 to 30, cut into parts"


@jit()
def at_rest(x: float, y: float, z: float) -> Attitude:
    """Return the attitude of the inertial axes with a momentum, nothing lost to rounding so far."""
    return (0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.0, 0.0), (x, y, z), NO_REST


@jit()
def put(row: Array, q: Quaternion, rq: Quaternion, p: Vector, rp: Vector) -> None:
    """Put an attitude and a momentum with their remainders into a row."""
    put_quaternion(row, 0, q)
    put_quaternion(row, 4, rq)
    put_vector(row, 8, p)
    put_vector(row, 11, rp)


class Tops(NamedTuple):
    """Free bodies (n, 3): the inverses of their moments, momenta in the body's frame, times; and how near to what."""

    inverse: np.ndarray
    momentum: np.ndarray
    time: np.ndarray
    distance: np.ndarray


class Errors(NamedTuple):
    """Of each body (n,): of the attitude [rad], of the momentum, relative, and of the momentum in space, relative."""

    attitude: np.ndarray
    momentum: np.ndarray
    in_space: np.ndarray


@reference(types.void(ROWS, ROWS, ROWS, ARRAY))
def turn_each(result, momentum, inverse, time):  # type: ignore[no-untyped-def]
    """Put q, its remainder, P and its remainder of each body, turned alone, into rows of 14."""
    for i in range(time.size):
        p, j = momentum[i], inverse[i]
        (q, rq, p_end, rp), _ = turn_exactly(at_rest(p[0], p[1], p[2]), ((j[0], j[1], j[2]), NO_REST), time[i])
        put(result[i], q, rq, p_end, rp)


@reference(types.void(ROWS, ROWS, ROWS, ARRAY))
def turn_pairs(result, momentum, inverse, time):  # type: ignore[no-untyped-def]
    """Put the same, each body turned side by side with the one after it, which spins so that its own turn is kept."""
    n = time.size
    for i in range(n):
        k = (i + 1) % n
        p, j, o, m = momentum[i], inverse[i], momentum[k], inverse[k]
        share = time[k] / time[i]
        start, other = at_rest(p[0], p[1], p[2]), at_rest(o[0] * share, o[1] * share, o[2] * share)
        body, beside = ((j[0], j[1], j[2]), NO_REST), ((m[0], m[1], m[2]), NO_REST)
        if i % 2 == 0:
            (q, rq, p_end, rp), _, _, _ = turn_both_exactly(start, body, other, beside, time[i])
        else:
            _, (q, rq, p_end, rp), _, _ = turn_both_exactly(other, beside, start, body, time[i])
        put(result[i], q, rq, p_end, rp)


def sizes(random: np.random.Generator, least: float, count: int = COUNT) -> np.ndarray:
    """Return numbers from a least one to one, evenly spread in their logarithms."""
    return 10 ** random.uniform(np.log10(least), 0, count)


def moments_of_masses(random: np.random.Generator, flattest: float) -> np.ndarray:
    """Return the principal moments (n, 3) of clouds of points, each stretched along its axes at random."""
    points = random.normal(size=(COUNT, 8, 3)) * sizes(random, flattest, 3 * COUNT).reshape(COUNT, 1, 3)
    squares = np.linalg.eigvalsh(np.einsum("npi,npj->nij", points, points))
    moments = squares.sum(axis=1, keepdims=True) - squares
    return random.permuted(moments, axis=1)


def spinning(
    random: np.random.Generator,
    moments: np.ndarray,
    momentum: np.ndarray,
    distance: np.ndarray | None = None,
    turns: np.ndarray | None = None,
) -> Tops:
    """Return bodies with momenta of any length, and times such that h Omega is from 1e-6 to 1, or as given."""
    inverse = 1 / moments
    turns = sizes(random, 1e-6) if turns is None else turns
    time = turns / np.linalg.norm(momentum * inverse, axis=1) * random.choice([-1, 1], COUNT)
    return Tops(inverse, momentum, time, turns if distance is None else distance)


def anyhow(random: np.random.Generator, moments: np.ndarray) -> np.ndarray:
    """Return momenta in any direction, some along diagonals or in a plane of axes, or those of such spins."""
    direction = random.normal(size=(COUNT, 3))
    direction[::20] = random.choice([-1, 1], (COUNT // 20, 3))
    direction[5::20, 1] = 0.0
    return np.where(random.random((COUNT, 1)) < 0.5, direction, direction * moments)


def about_axis(random: np.random.Generator, axis: np.ndarray, away: np.ndarray) -> np.ndarray:
    """Return momenta about an axis of each body, but for a part of them across it; every tenth exactly about it."""
    across = random.normal(size=(COUNT, 3))
    result = across * away[:, None]
    result[::10] = 0.0
    result[np.arange(COUNT), axis] = random.choice([-1, 1], COUNT)
    return result


def kinds() -> dict[str, Tops]:
    """Return the bodies of each kind."""
    random = np.random.default_rng(20260101)
    result = {}
    general = moments_of_masses(random, 0.1)
    result["random masses"] = spinning(random, general, anyhow(random, general))
    extreme = moments_of_masses(random, 1e-3)
    result[NEEDLES] = spinning(random, extreme, anyhow(random, extreme))

    near = general.copy()
    apart = 10 ** random.uniform(-14, -3, COUNT)
    near[:, 1] = near[:, 0] * (1 + apart)
    near[:, 2] = near[:, 0] * random.uniform(0.01, 1.99, COUNT)
    near = random.permuted(near, axis=1)
    result["moments nearly equal"] = spinning(random, near, anyhow(random, near), apart)
    equal = near.copy()
    equal[:, 1] = equal[:, 0]
    equal[::4, 2] = equal[::4, 0]  # every fourth a sphere
    equal = random.permuted(equal, axis=1)
    result["symmetric tops and spheres"] = spinning(random, equal, anyhow(random, equal))

    away = 10 ** random.uniform(-15, -2, COUNT)
    middle = np.argsort(general, axis=1)[:, 1]
    result["about the middle axis"] = spinning(random, general, about_axis(random, middle, away), away)
    axis = random.integers(0, 3, COUNT)
    result["about a principal axis"] = spinning(random, general, about_axis(random, axis, away), away)
    long = spinning(random, general, anyhow(random, general), turns=random.uniform(1, 30, COUNT))
    result[LONG] = Tops(*(values[: COUNT // 10] for values in long))
    return result


def errors_of(tops: Tops, p: np.ndarray, q: np.ndarray, exact: tuple[np.ndarray, np.ndarray]) -> Errors:
    """Return the errors of momenta (n, 3) and turns (n, 4) against exact ones."""
    momentum, attitude = exact
    length = np.linalg.norm(tops.momentum, axis=1)
    x, y = q[:, :3], attitude[:, :3]
    part = attitude[:, 3:] * x - q[:, 3:] * y - np.cross(y, x)  # half of the turn from one to the other
    turned_back = p + 2 * np.cross(x, np.cross(x, p) + q[:, 3:] * p)
    vectors = ((2 * part, 1.0), (p - momentum, length), (turned_back - tops.momentum, length))
    return Errors(*(np.linalg.norm(vector.astype(float), axis=1) / scale for vector, scale in vectors))


def growth(tops: Tops, exact: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """Return what a rounding of the momentum at the start makes of the attitude (n,) [rad]."""
    random = np.random.default_rng(1)
    other = random.normal(size=tops.momentum.shape)
    other *= ROUNDING * (np.linalg.norm(tops.momentum, axis=1) / np.linalg.norm(other, axis=1))[:, None]
    rounded = rotors.turn(tops.momentum.astype(rotors.REAL) + other, tops.inverse, tops.time)
    return errors_of(tops, *rounded, exact).attitude


def of_kernel(tops: Tops, exact: tuple[np.ndarray, np.ndarray]) -> Errors:
    """Return the errors of the compiled code: the larger of those of bodies turned alone and in pairs."""
    both = []
    for turn in (turn_each, turn_pairs):
        numbers = np.empty((len(tops.time), 14))
        turn(numbers, tops.momentum, tops.inverse, tops.time)
        numbers = numbers.astype(rotors.REAL)
        q, p = numbers[:, :4] + numbers[:, 4:8], numbers[:, 8:11] + numbers[:, 11:]
        both.append(errors_of(tops, p, q, exact))
    return Errors(*(np.maximum(one, two) for one, two in zip(*both, strict=True)))


def turns_of(tops: Tops) -> np.ndarray:
    """Return h Omega (n,) at the start."""
    return np.abs(tops.time) * np.linalg.norm(tops.momentum * tops.inverse, axis=1)


def checks_of(name: str, tops: Tops, found: Errors, exact: tuple[np.ndarray, np.ndarray]) -> list[Check]:
    """Return the checks of a kind."""
    worst = float(max(found.attitude.max(), found.momentum.max()))
    in_space = Check(
        f"{name}: angular momentum in space, relative",
        float(found.in_space.max()),
        1e-14 if name == LONG else 1e-15,
        "rounding",
        roundoff=True,
    )
    if name in (NEEDLES, LONG):
        rounded = growth(tops, exact) + ROUNDING * turns_of(tops)
        return [
            Check(
                f"{name}: attitude and momentum over what a rounding of the momentum does",
                float((found.attitude / rounded).max()),
                {NEEDLES: 25, LONG: 200}[name],
                "roundings, one and more in each part; the motion itself magnifies them",
                shown=f"at most {worst:.1e} rad",
                roundoff=True,
            ),
            in_space,
        ]
    return [
        Check(f"{name}: attitude [rad] and momentum, relative", worst, 2e-15, "rounding", headline=True, roundoff=True),
        Check(
            f"{name}: attitude over h Omega",
            float((found.attitude / turns_of(tops)).max()),
            5e-15,
            "rounding: that of a short turn is in proportion to it",
            roundoff=True,
        ),
        in_space,
    ]


def draw(found: dict[str, tuple[Tops, Errors]]) -> Picture:
    """Draw the errors of the attitude against h Omega, and against how near a body is to what might be singular."""
    figure, (left, right) = drawing.axes(2)
    for k, (name, (tops, error)) in enumerate(found.items()):
        turns, style = turns_of(tops), {"color": drawing.COLOURS[k], "ms": 1.5, "label": name}
        seen = error.attitude > 0
        left.loglog(turns[seen], error.attitude[seen], ".", **style)
        if not np.allclose(tops.distance, turns):
            right.loglog(tops.distance[seen], (error.attitude / turns)[seen], ".", **style)
    ends = np.array([1e-6, 30])
    left.loglog(ends, ROUNDING * ends, "k--", lw=0.9, label="half a unit in the last place of h Omega")
    left.set(xlabel="h Omega [rad]", ylabel="error of the attitude [rad]", ylim=(1e-25, 1e-7))
    right.set(
        xlabel="relative difference of moments, or tilt from the axis [rad]",
        ylabel="error of the attitude over h Omega",
        ylim=(1e-20, 1e-14),
    )
    for ax in (left, right):
        drawing.legend(ax, markerscale=4, loc="upper left" if ax is left else "lower right")
    caption = (
        "Errors of the exact rotor for thousands of free bodies of all kinds. Left: in proportion to the turn, so that "
        "short steps lose nothing. Right: nothing happens where two moments meet, on the separatrix, or on the axes."
    )
    return Picture("exact-rotor", figure, caption)


def run(effort: Effort) -> Findings:
    """Turn all kinds."""
    checks, found = [], {}
    for name, tops in kinds().items():
        exact = rotors.turn(tops.momentum, tops.inverse, tops.time)
        found[name] = tops, of_kernel(tops, exact)
        checks += checks_of(name, *found[name], exact)
    note = (
        "Two kinds are told apart by what a rounding of the momentum at the start would do: in a needle that nearly "
        "spins about its long axis the momentum along it is small beside the whole, and a rounding of the whole is a "
        "large part of it; near the separatrix a long turn magnifies every rounding. What is found there is some "
        "roundings of the momentum, one or more for each part that the time is cut into."
    )
    return Findings(checks, [draw(found)], [note])


CASE = Case(
    "exact-rotor",
    "Does the exact rotor turn free bodies of any moments and any spin as Euler's equations say?",
    "Taylor's series of Euler's equations and of the quaternion's, in extended precision",
    run,
    needs=() if EXTENDED else ("extended_precision",),  # no package: on such a machine the case is not run, and says so
)
