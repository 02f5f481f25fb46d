"""Between the rows of a run: Hermite interpolation of positions and of attitudes, which stay rotations.

Through the positions and velocities of the four rows about a moment there is one polynomial of degree 7. Attitudes have
no such thing, for rotations cannot be added. So they are counted from a body that turns uniformly, R = Q(t) exp S(xi),
Q(t) = R0 exp S(W (t - t0)), with the mean W of the spins about: of the rotation vector xi, which is small, and its rate

    xi' = Jr(xi)^-1 (Omega - exp(-S(xi)) W),

where Jr is the right Jacobian of the exponential map, there again is one polynomial of degree 7. Both have errors of
order 8 in the distance of the rows, velocities and spins, which are the derivatives, of order 7.
"""

from typing import Any, NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from binaryast.units import Floats, Indices

ROWS = 4  # about a moment; fewer where there are no more
NEAR = 0.25  # of an interval: a row nearer than this is no further row
MARGIN, ROUNDING = 4.0, 1e-15  # of an estimated error


class Rows(NamedTuple):
    """Saved rows, time first: (N,), (N, n, 3), (N, n, 3), (N, n, 3, 3), (N, n, 3)."""

    time: Floats
    position: Floats
    velocity: Floats
    attitude: Floats
    spin: Floats


def between(rows: Rows, times: Floats) -> Rows:
    """Return the motion at times within the rows, which grow.

    Parameters
    ----------
    rows : Rows
        At least two, without an impulse between.
    times : ndarray
        (M,), none outside of the rows [s].
    """
    left = np.clip(np.searchsorted(rows.time, times, side="right") - 1, 0, len(rows.time) - 2)
    found = _through(rows, _about_interval(rows.time, left), left, times)
    for row, chosen in ((left, rows.time[left] == times), (left + 1, rows.time[-1] == times)):  # bit for bit
        for array, values in zip(found[1:], rows[1:], strict=True):
            array[chosen] = values[row[chosen]]
    return found


def errors(rows: Rows) -> Floats:
    """Return the estimated error of `between` in each of the N - 1 intervals; infinite where nothing tells.

    Each row is interpolated from its neighbours without itself. What that is off is known, and by how much less an
    interpolation is off that does not leave rows out follows from the remainder of Hermite's formula; `MARGIN` is for
    what that formula does not know. The error is that of `difference`.
    """
    time, count = rows.time, len(rows.time)
    if count < 3:
        return np.full(count - 1, np.inf)
    inner, left = np.arange(1, count - 1), np.arange(count - 1)
    others = _about_row(time, inner)
    found = _through(rows, others, inner, time[inner])
    apart = difference(found, Rows(*(array[inner] for array in rows))) / _products(time, others, time[inner])
    sizes = np.count_nonzero(others >= 0, axis=1)
    middles = 0.5 * (time[:-1] + time[1:])
    result = np.zeros(count - 1)
    for size in np.unique(sizes):  # what is compared goes through as many rows
        within = _products(time, _about_interval(time, left, size), middles)
        of_row = np.zeros(count)
        of_row[inner] = np.where(sizes == size, apart, 0.0)
        result = np.maximum(result, np.maximum(of_row[:-1], of_row[1:]) * within)
    return np.asarray(ROUNDING + MARGIN * result)


def difference(one: Any, other: Any) -> Floats:
    """Return how far two motions are apart at their rows (N,): the largest of all bodies.

    Positions count from the primary's and relative to the distance from it, attitudes as angles [rad].
    """
    x, y = (motion.position[:, 1:] - motion.position[:, :1] for motion in (one, other))
    position = np.linalg.norm(x - y, axis=-1) / np.linalg.norm(y, axis=-1)
    chord = np.linalg.norm(one.attitude - other.attitude, axis=(-2, -1)) / np.sqrt(8)  # sin of half of the angle
    return np.asarray(np.maximum(position.max(axis=1), 2 * np.arcsin(np.minimum(chord, 1.0)).max(axis=1)))


def _about_interval(time: Floats, left: Indices, size: int = ROWS) -> Indices:
    """Return the rows (M, 4) about the intervals that begin with ``left``, -1 in the place of those that there are not.

    Rows that are much nearer to others than the interval is long tell nothing new but round-off: they are left out.
    """
    least = NEAR * (time[left + 1] - time[left])
    before, after = _next(time, left, -least), _next(time, left + 1, least)
    wanted = [left, left + 1, before, after, _next(time, after, least), _next(time, before, -least)]
    return _first(wanted, size)


def _about_row(time: Floats, row: Indices) -> Indices:
    """Return the rows (M, 4) nearest to others without these themselves, as `_about_interval` does."""
    least = NEAR * np.maximum(time[row + 1] - time[row], time[row] - time[row - 1])
    before, after = [row], [row]
    for _ in range(ROWS):
        before.append(_next(time, before[-1], -least))
        after.append(_next(time, after[-1], least))
    return _first([one for both in zip(before[1:], after[1:], strict=True) for one in both])


def _next(time: Floats, row: Indices, distance: Floats) -> Indices:
    """Return the next rows that are further away than a distance in time, before these rows where it is negative."""
    limit = time[row] + distance
    later = np.searchsorted(time, limit, side="left")
    earlier = np.searchsorted(time, limit, side="right") - 1
    found = np.where(distance > 0, np.where(later < len(time), later, -1), earlier)
    return np.asarray(np.where(row < 0, -1, found))


def _first(wanted: list[Indices], size: int = ROWS) -> Indices:
    """Return the first rows of those wanted that there are, four or less, in order of time, -1 first."""
    table = np.stack(wanted, axis=1)
    order = np.argsort(table < 0, axis=1, kind="stable")[:, :size]
    return np.asarray(np.sort(np.take_along_axis(table, order, axis=1), axis=1))


def _products(time: Floats, stencil: Indices, at: Floats) -> Floats:
    """Return the product of the squared distances in time from rows: how the remainder of Hermite's formula grows."""
    squares = np.where(stencil < 0, 1.0, (at[:, None] - time[stencil]) ** 2)
    return np.asarray(np.prod(squares, axis=1))


def _through(rows: Rows, stencil: Indices, about: Indices, times: Floats) -> Rows:
    """Return the motion at times (M,) by the rows of a stencil (M, 4), attitudes counted from the rows ``about``."""
    shape = (len(times), *rows.position.shape[1:])
    found = Rows(times.copy(), np.empty(shape), np.empty(shape), np.empty((*shape, 3)), np.empty(shape))
    for size in range(1, ROWS + 1):  # near the ends of a short run there are fewer
        chosen = np.count_nonzero(stencil >= 0, axis=1) == size
        if np.any(chosen):
            part = _by_as_many(rows, stencil[chosen, ROWS - size :], about[chosen], times[chosen])
            for array, values in zip(found, part, strict=True):
                array[chosen] = values
    return found


def _by_as_many(rows: Rows, stencil: Indices, about: Indices, times: Floats) -> Rows:
    """Return the same where each moment has as many rows (M, k)."""
    start = rows.time[about]
    unit = np.abs(rows.time[stencil] - start[:, None]).max(axis=1)
    nodes = (rows.time[stencil] - start[:, None]) / unit[:, None]
    at = (times - start) / unit
    position, velocity = _hermite(nodes, rows.position[stencil], rows.velocity[stencil] * _over(unit, 4), at)
    attitude, spin = _attitudes(rows, stencil, about, nodes, unit, at)
    return Rows(times, position, velocity / _over(unit, 3), attitude, spin)


def _attitudes(
    rows: Rows, stencil: Indices, about: Indices, nodes: Floats, unit: Floats, at: Floats
) -> tuple[Floats, Floats]:
    """Return attitudes (M, n, 3, 3) and spins (M, n, 3), by rotation vectors from a uniform turn."""
    mean = rows.spin[stencil].mean(axis=1) * _over(unit, 3)  # W, in the unit of time
    first = rows.attitude[about]
    turns = _exp(nodes[:, :, None, None] * mean[:, None])
    xi = _log(np.swapaxes(first[:, None] @ turns, -1, -2) @ rows.attitude[stencil])
    left = rows.spin[stencil] * _over(unit, 4) - _turned_back(xi, mean[:, None])
    now, rate = _hermite(nodes, xi, np.einsum("...ij,...j->...i", _inverse_jacobian(xi), left), at)
    attitude = first @ _exp(at[:, None, None] * mean) @ _exp(now)
    spin = _turned_back(now, mean) + np.einsum("...ij,...j->...i", _jacobian(now), rate)
    return _nearest(attitude), spin / _over(unit, 3)


def _over(unit: Floats, dimensions: int) -> Floats:
    """Return one number for each moment, ready to be multiplied with an array of more dimensions."""
    return unit.reshape(-1, *[1] * (dimensions - 1))


def _hermite(nodes: Floats, values: Floats, rates: Floats, at: Floats) -> tuple[Floats, Floats]:
    """Return a polynomial through values (M, k, n, 3) and rates at nodes (M, k), and its rate: Newton's form."""
    z = np.repeat(nodes, 2, axis=1)
    table = np.repeat(values, 2, axis=1)
    coefficients = [table[:, 0]]
    for order in range(1, z.shape[1]):
        apart = (z[:, order:] - z[:, :-order])[:, :, None, None]
        if order == 1:  # nodes come twice: there the difference is the rate
            apart[:, ::2] = 1.0
        table = np.diff(table, axis=1) / apart
        if order == 1:
            table[:, ::2] = rates
        coefficients.append(table[:, 0])
    value, rate = coefficients[-1].copy(), np.zeros_like(coefficients[-1])
    for order in range(z.shape[1] - 2, -1, -1):
        distance = _over(at - z[:, order], 3)
        rate = rate * distance + value
        value = value * distance + coefficients[order]
    return value, rate


def _hat(x: Floats) -> Floats:
    """Return S(x) of vectors (..., 3)."""
    zero = np.zeros_like(x[..., 0])
    rows = [[zero, -x[..., 2], x[..., 1]], [x[..., 2], zero, -x[..., 0]], [-x[..., 1], x[..., 0], zero]]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def _exp(x: Floats) -> Floats:
    """Return exp S(x)."""
    return np.asarray(Rotation.from_rotvec(x.reshape(-1, 3)).as_matrix().reshape(*x.shape, 3))


def _log(r: Floats) -> Floats:
    """Return the rotation vectors of matrices (..., 3, 3)."""
    return np.asarray(Rotation.from_matrix(r.reshape(-1, 3, 3)).as_rotvec().reshape(r.shape[:-1]))


def _turned_back(xi: Floats, vector: Floats) -> Floats:
    """Return exp(-S(xi)) v."""
    return np.asarray(np.einsum("...ji,...j->...i", _exp(xi), np.broadcast_to(vector, xi.shape)))


def _jacobian(xi: Floats) -> Floats:
    """Return Jr(xi): the spin, in the body's frame, is Jr xi'."""
    angle, s = np.linalg.norm(xi, axis=-1)[..., None, None], _hat(xi)
    small = angle < 0.1
    t = np.where(small, 1.0, angle)
    first = np.where(small, 0.5 - angle**2 / 24 + angle**4 / 720 - angle**6 / 40320, (1 - np.cos(t)) / t**2)
    second = np.where(small, 1 / 6 - angle**2 / 120 + angle**4 / 5040 - angle**6 / 362880, (t - np.sin(t)) / t**3)
    return np.asarray(np.eye(3) - first * s + second * (s @ s))


def _inverse_jacobian(xi: Floats) -> Floats:
    """Return Jr(xi)^-1, of angles below 2 pi."""
    angle, s = np.linalg.norm(xi, axis=-1)[..., None, None], _hat(xi)
    small = angle < 0.1
    t = np.where(small, 1.0, angle)
    series = 1 / 12 + angle**2 / 720 + angle**4 / 30240 + angle**6 / 1209600
    factor = np.where(small, series, (1 - 0.5 * t / np.tan(0.5 * t)) / t**2)
    return np.asarray(np.eye(3) + 0.5 * s + factor * (s @ s))


def _nearest(r: Floats) -> Floats:
    """Return the rotations nearest to matrices that are some but for round-off: Newton's step for the polar factor."""
    return np.asarray(r + 0.5 * r @ (np.eye(3) - np.swapaxes(r, -1, -2) @ r))
