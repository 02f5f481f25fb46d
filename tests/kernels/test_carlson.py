"""Carlson's integrals against SciPy's."""

import numpy as np
from scipy.special import elliprd, elliprf

from binaryast.kernels.carlson import rf_and_rd


def test_they_are_those_of_scipy() -> None:
    random = np.random.default_rng(5)
    for x, y, z in 10.0 ** random.uniform(-6, 6, (2000, 3)):
        expected = elliprf(x, y, z), elliprd(y, z, x), elliprd(z, x, y), elliprd(x, y, z)
        np.testing.assert_allclose(rf_and_rd(x, y, z), expected, rtol=1.5e-15)


def test_nearly_equal_and_equal_arguments() -> None:
    for spread in (0.0, 1e-12, 1e-6, 0.005, 0.0099, 0.0101, 0.1):
        x, y, z = 2.0, 2.0 * (1 + spread), 2.0 * (1 + spread / 3)
        expected = elliprf(x, y, z), elliprd(y, z, x), elliprd(z, x, y), elliprd(x, y, z)
        np.testing.assert_allclose(rf_and_rd(x, y, z), expected, rtol=1e-15)
