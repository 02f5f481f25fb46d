"""Free rigid bodies by Taylor's series of Euler's equations in extended precision: any moments, any spin, many at once.

With P' = P x Omega, Omega = J^-1 P, and q' = q (Omega, 0)/2, each coefficient of the series of P and q follows from
those before it. There are no elliptic functions here, no cases, and nothing that is singular.
"""

import numpy as np

ORDER = 26
PART = 0.2  # rad of the fastest motion in one series: it then leaves less than 1e-19
REAL = np.longdouble


def advance(p: np.ndarray, q: np.ndarray, inverse: np.ndarray, h: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return P (3, n) and q (4, n), scalar last, after times h (n,), by one series; ``inverse`` is 1/J (3, n)."""
    i1, i2, i3 = inverse
    e1, e2, e3 = i3 - i2, i1 - i3, i2 - i1
    P = np.zeros((ORDER + 1, *p.shape), dtype=REAL)
    Q = np.zeros((ORDER + 1, *q.shape), dtype=REAL)
    P[0], Q[0] = p, q
    for k in range(ORDER):  # products of series: sums over j of the coefficients j and k - j
        back = P[k::-1]
        P[k + 1, 0] = e1 * (P[: k + 1, 1] * back[:, 2]).sum(axis=0) * h / (k + 1)
        P[k + 1, 1] = e2 * (P[: k + 1, 2] * back[:, 0]).sum(axis=0) * h / (k + 1)
        P[k + 1, 2] = e3 * (P[: k + 1, 0] * back[:, 1]).sum(axis=0) * h / (k + 1)
        x, y, z, w = np.moveaxis(Q[: k + 1], 1, 0)
        u, v, s = (back[:, axis] * inverse[axis] for axis in range(3))
        half = h / (2 * REAL(k + 1))
        Q[k + 1, 0] = (w * u + y * s - z * v).sum(axis=0) * half
        Q[k + 1, 1] = (w * v + z * u - x * s).sum(axis=0) * half
        Q[k + 1, 2] = (w * s + x * v - y * u).sum(axis=0) * half
        Q[k + 1, 3] = -(x * u + y * v + z * s).sum(axis=0) * half
    return P[::-1].sum(axis=0), Q[::-1].sum(axis=0)  # small terms first


def parts(p: np.ndarray, inverse: np.ndarray, h: np.ndarray) -> np.ndarray:
    """Return into how many series the time of each body is cut: by its spin and by its nutation."""
    differences = inverse[:, [2, 0, 1]] - inverse[:, [1, 2, 0]]
    products = differences[:, [1, 2, 0]] * differences[:, [2, 0, 1]] * p**2
    fastest = np.maximum(np.linalg.norm(p * inverse, axis=1), np.sqrt(np.abs(products).max(axis=1)))
    return np.ceil(np.abs(h) * fastest / PART).astype(int)


def turn(p: np.ndarray, inverse: np.ndarray, h: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the momenta (n, 3) in the body's frame and the turns (n, 4), scalar last, after times h (n,)."""
    counts = np.maximum(parts(p.astype(float), inverse, h), 1)
    momentum, inverses, time = p.T.astype(REAL), inverse.T.astype(REAL), h.astype(REAL) / counts
    attitude = np.zeros((4, len(h)), dtype=REAL)
    attitude[3] = 1
    for k in range(counts.max()):
        on = counts > k
        momentum[:, on], attitude[:, on] = advance(momentum[:, on], attitude[:, on], inverses[:, on], time[on])
    return momentum.T, attitude.T
