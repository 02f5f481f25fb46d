"""The motion between two rows, by a polynomial through four of them."""

from dataclasses import replace

import numpy as np

from binaryast.trajectory import Trajectory, TrajectoryFloats
from binaryast.units import Floats

NODES = 4  # rows, whose values and rates make a polynomial of degree 7: the order is 8


def interpolated(run: Trajectory, times: Floats) -> Trajectory:
    """Return rows at other times (K,) [s] within a run without impulses.

    Positions and attitudes are of order 8: the polynomial through the values and the rates, which are velocities and
    R S(Omega), of the four nearest rows; attitudes are then brought to the nearest rotation. Velocities and spins, its
    derivative, are of order 7, potential energies, through the values alone, of order 4. Figures remain the run's.
    """
    si = run.si
    nodes = min(NODES, len(si.time))
    first = np.clip(np.searchsorted(si.time, times) - nodes // 2, 0, len(si.time) - nodes)
    rows = first[:, None] + np.arange(nodes)
    scale = float(np.diff(si.time).max())
    value, slope, value_rate, slope_rate, plain = _weights((si.time[rows] - times[:, None]) / scale)

    def blend(of_values: Floats, of_rates: Floats, values: Floats, rates: Floats) -> Floats:
        return np.asarray(
            np.einsum("kn,kn...->k...", of_values, values[rows])
            + scale * np.einsum("kn,kn...->k...", of_rates, rates[rows])
        )

    turning = np.einsum("nbij,nbjk->nbik", si.attitude, _hat(si.spin))
    attitude = _nearest_rotation(blend(value, slope, si.attitude, turning))
    rate = blend(value_rate, slope_rate, si.attitude, turning) / scale
    body_rate = np.swapaxes(attitude, -1, -2) @ rate
    spin = 0.5 * np.stack(
        [
            body_rate[..., 2, 1] - body_rate[..., 1, 2],
            body_rate[..., 0, 2] - body_rate[..., 2, 0],
            body_rate[..., 1, 0] - body_rate[..., 0, 1],
        ],
        axis=-1,
    )
    return replace(
        run,
        si=TrajectoryFloats(
            np.array(times),
            blend(value, slope, si.position, si.velocity),
            blend(value_rate, slope_rate, si.position, si.velocity) / scale,
            attitude,
            spin,
            np.einsum("kn,kn->k", plain, si.potential_energy[rows]),
        ),
    )


def _weights(nodes: Floats) -> tuple[Floats, Floats, Floats, Floats, Floats]:
    """Return what values and rates at nodes (K, n) count for at zero: in the value, in its rate; and values alone.

    With Lagrange's polynomials l_j, Hermite's are (1 - 2 (t - t_j) l_j'(t_j)) l_j^2 and (t - t_j) l_j^2.
    """
    count = nodes.shape[1]
    apart = nodes[:, :, None] - nodes[:, None, :] + np.eye(count)  # t_j - t_k, 1 where they are the same
    factors = np.where(np.eye(count, dtype=bool), 1.0, -nodes[:, None, :] / apart)
    lagrange = factors.prod(axis=2)
    at_node = (1 / apart - np.eye(count)).sum(axis=2)
    rate = np.zeros_like(lagrange)
    for k in range(count):
        others = np.delete(factors, k, axis=2).prod(axis=2)
        rate += np.where(np.arange(count) == k, 0.0, others / apart[:, :, k])
    before = -nodes  # t - t_j at t = 0
    value = (1 - 2 * before * at_node) * lagrange**2
    value_rate = -2 * at_node * lagrange**2 + (1 - 2 * before * at_node) * 2 * lagrange * rate
    return value, before * lagrange**2, value_rate, lagrange**2 + 2 * before * lagrange * rate, lagrange


def _hat(x: Floats) -> Floats:
    """Return S(x) (..., 3, 3)."""
    zero = np.zeros_like(x[..., 0])
    a, b, c = x[..., 0], x[..., 1], x[..., 2]
    rows = [np.stack(row, axis=-1) for row in ((zero, -c, b), (c, zero, -a), (-b, a, zero))]
    return np.stack(rows, axis=-2)


def _nearest_rotation(matrices: Floats) -> Floats:
    """Return the rotations nearest to matrices that are nearly such."""
    left, _, right = np.linalg.svd(matrices)
    return np.asarray(left @ right)
