"""Few nodes that do for many: rows of a table that span it best, and weights of them for the same sums.

It is the QR decomposition with pivoting, by Gram and Schmidt's method in its modified form, in which the sums are one
more row; so their round-off is that of a backward stable method (A. Bjorck, BIT 7 (1967) 1). A library's would do as
well, but share itself out to all cores for tables as small as these, which makes it slow where others use them.
"""

from math import sqrt

import numpy as np
from numba import types

from binaryast.kernels.jit import ROWS, Array, Indices, jit

CHOSEN = types.Array(types.int64, 1, "C")


@jit(fastmath={"reassoc", "nsz", "contract"})
def take_off(row: Array, unit: Array) -> float:
    """Take its part along a unit vector off a row, and return how much that was."""
    part = 0.0
    for i in range(len(unit)):
        part += row[i] * unit[i]
    for i in range(len(unit)):
        row[i] -= part * unit[i]
    return part


@jit(fastmath={"reassoc", "nsz", "contract"})
def square(row: Array) -> float:
    """Return the square of a row's length."""
    total = 0.0
    for i in range(len(row)):
        total += row[i] * row[i]
    return total


@jit(types.int64(CHOSEN, ROWS, ROWS, ROWS, types.float64), allocates=True)
def select(chosen: Indices, weights: Array, table: Array, sums: Array, smallest: float) -> int:
    """Choose rows of a table (n, m), each the one that is longest off those before it, and return how many.

    ``chosen`` (m,) takes the rows, ``weights`` (m, k) what they are to be multiplied by so that they add up to the sums
    (k, m). A row shorter than the first one by ``smallest`` tells nothing new. Table and sums are used up.
    """
    n, m = table.shape
    parts, of_sums = np.zeros((n, m)), np.zeros((len(sums), m))
    free = np.ones(n, dtype=np.bool_)
    unit, first, count = np.zeros(m), 0.0, 0
    while count < min(n, m):
        longest, best = 0.0, -1
        for i in range(n):
            if free[i] and square(table[i]) > longest:
                longest, best = square(table[i]), i
        first = max(first, longest)
        if longest <= smallest * smallest * first:
            break
        unit[:] = table[best] / sqrt(longest)
        for i in range(n):
            if free[i]:
                parts[i, count] = take_off(table[i], unit)
        for k in range(len(sums)):
            of_sums[k, count] = take_off(sums[k], unit)
        free[best] = False
        chosen[count] = best
        count += 1
    for k in range(len(sums)):
        for j in range(count - 1, -1, -1):
            left = of_sums[k, j]
            for i in range(j + 1, count):
                left -= parts[chosen[i], j] * weights[i, k]
            weights[j, k] = left / parts[chosen[j], j]
    return count
