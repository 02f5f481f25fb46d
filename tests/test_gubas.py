"""GUBAS's inertia integrals, where they lie beside the project; its runs are a case of the validation."""

from pathlib import Path

import astropy.units as u
import numpy as np
import pytest
from validation.oracles.gubas import KM, system

import binaryast as ba
from binaryast.kernels.moments import exponents

FOLDER = Path(__file__).parents[2] / "shared" / "gubas"


@pytest.mark.skipif(not FOLDER.is_dir(), reason="the inertia integrals of GUBAS are not here")
@pytest.mark.parametrize("which", ["primary", "secondary"])
def test_inertia_integrals(which: str) -> None:
    """T_ijk of our ellipsoids, and a body made of GUBAS's."""
    table = np.loadtxt(FOLDER / f"inertia_integrals_ellipsoids_{which}_N4.csv", delimiter=",")
    body = getattr(system(ba.SecondDegree()), which)
    i, j, k = exponents(4).T
    ours = body.si.mass * body.moments(4) / KM ** (i + j + k)
    np.testing.assert_allclose(ours, table[k * 5 + i, j], rtol=1e-13, atol=0)
    given = ba.RigidBody("given", ba.InertiaIntegrals(table, 1 * u.km), mass=table[0, 0] * u.kg)
    np.testing.assert_allclose(given.moments(4), body.moments(4), rtol=1e-13)
    np.testing.assert_allclose(given.si.moments, body.si.moments, rtol=1e-13)
