"""The only term of two homogeneous ellipsoids up to degree 4 in which both have a part, in closed form.

It is c_1^2 D1 D2 (1/r). With X1, X2 and Y1, Y2 the first two coordinates of the secondary's place in the primary's axes
and in its own, and c the cosines between those axes, it is a function of them and of r alone:

    105 p q/r^9 - 15 (tr P q + tr Q p + 4 s)/r^7 + 3 (tr P tr Q + 2 t)/r^5,

p = sum b_j X_j^2, q = sum a_i Y_i^2, s = sum a_i b_j X_j Y_i c_ij, t = sum a_i b_j c_ij^2; i and j are 1 and 2, the
squares of the third semi-axis being taken off those of the others, for 1/r is harmonic.
"""

import numpy as np

from validation.benchmark.expressions import Constant, Exerted, Number, Place, mean_factor, total

TWO = range(2)


def exerted(squares1: list[Number], squares2: list[Number], at: Place, constant: Constant) -> Exerted:
    """Return what this term exerts, over G m1 m2; the squares are those of the semi-axes."""
    factor = constant(mean_factor(1) ** 2)
    a, b = ([squares[0] - squares[2], squares[1] - squares[2]] for squares in (squares1, squares2))
    trace_a, trace_b = a[0] + a[1], b[0] + b[1]
    x, y, r, c = at.x, at.y, at.r, at.R.T  # c[i, j] between the axis i of the secondary and j of the primary
    p, q = total([b[j] * at.x2[j] for j in TWO]), total([a[i] * at.y2[i] for i in TWO])
    by_x = [total([a[i] * (y[i] * c[i, j]) for i in TWO]) for j in TWO]
    by_y = [total([b[j] * (x[j] * c[i, j]) for j in TWO]) for i in TWO]
    s = total([b[j] * (x[j] * by_x[j]) for j in TWO])
    t = total([a[i] * b[j] * (c[i, j] * c[i, j]) for i in TWO for j in TWO])
    p9, q9 = p * r[9], q * r[9]
    s7 = total([trace_b * q, trace_a * p, 4.0 * s])
    radial = total([-945.0 * (p9 * (q * r[2])), 105.0 * (s7 * r[9]), -15.0 * ((trace_a * trace_b + 2.0 * t) * r[7])])
    slope_x = [
        b[j] * total([x[j] * total([210.0 * q9, -30.0 * trace_a * r[7]]), -60.0 * (r[7] * by_x[j])]) for j in TWO
    ]
    slope_y = [
        a[i] * total([y[i] * total([210.0 * p9, -30.0 * trace_b * r[7]]), -60.0 * (r[7] * by_y[i])]) for i in TWO
    ]
    x7 = [r[7] * x[j] for j in TWO]
    slope_c = [[a[i] * b[j] * total([-60.0 * (y[i] * x7[j]), 12.0 * (r[5] * c[i, j])]) for j in TWO] for i in TWO]
    transposed = [[slope_c[i][j] for i in TWO] for j in TWO]
    return Exerted(
        factor * radial,
        factor * np.array([*slope_x, constant(0)]),
        factor * np.array([*slope_y, constant(0)]),
        factor * torque(slope_x, x, c.T, transposed),
        factor * torque(slope_y, y, c, slope_c),
    )


def torque(slope: list[Number], place: np.ndarray, along: np.ndarray, by_c: list[list[Number]]) -> np.ndarray:
    """Return sum of e_i x (slope_i place + sum of by_c_ij f_j), in the axes e."""
    w = [[total([slope[i] * place[n], *(by_c[i][j] * along[n][j] for j in TWO)]) for n in range(3)] for i in TWO]
    return np.array([w[1][2], -w[0][2], w[0][1] - w[1][0]])
