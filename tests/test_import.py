"""Importing the package is cheap, complete, and its names clash with nothing."""

import pickle
import subprocess
import sys
from pathlib import Path

import astropy.units as u
import numpy as np
import pytest

import binaryast as ba


def test_import_loads_nothing_heavy() -> None:
    code = (
        "import sys, binaryast; binaryast.__version__; dir(binaryast);"
        "print([name for name in ('numba', 'scipy', 'h5py', 'heyoka', 'matplotlib', 'astropy', 'tqdm', 'trimesh')"
        " if name in sys.modules])"
    )
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert result.stdout.strip() == "[]"


def test_every_public_name_is_there() -> None:
    for name in ba.__all__:
        assert getattr(ba, name) is not None
    assert set(ba.__all__) <= set(dir(ba))


def test_every_public_name_is_documented_with_an_example() -> None:
    for name in (
        "Ellipsoid",
        "Sphere",
        "Dumbbell",
        "PointCloud",
        "RigidBody",
        "System",
        "State",
        "RelativeState",
        "LGVI",
        "RungeKutta",
        "Taylor",
        "Point",
        "Orbit",
        "propagate",
        "pair_potential",
        "PairPotential",
        "Multipole",
        "EllipsoidPair",
        "Adaptive",
        "Union",
        "Part",
        "InertiaIntegrals",
        "StokesCoefficients",
        "Polyhedron",
        "PolyhedronPair",
        "Layered",
        "mascons",
        "Impulse",
        "Impact",
        "retrace",
    ):
        assert ">>>" in getattr(ba, name).__doc__
    for function in (ba.equations.continuous, ba.equations.discrete, ba.State.from_orbits, ba.State.circular_orbit):
        assert ">>>" in function.__doc__


def test_values_pickle() -> None:
    system, state = ba.catalogue.load("dumbbells")
    scenario = ba.catalogue.entry("moshup")
    for value in (
        system,
        state,
        scenario,
        system.gravity,
        ba.SecondDegree(),
        ba.Multipole(4),
        ba.PolyhedronPair(1e-4),
        ba.Adaptive(accuracy=1e-6, far=ba.Multipole(4)),
        ba.PointMass(),
        scenario.integrator,
    ):
        again = pickle.loads(pickle.dumps(value))
        assert type(again) is type(value)
    for value in (
        ba.RungeKutta(rtol=1e-9),
        ba.Taylor(1e-12, compact=False),
        ba.Point(),
        ba.Orbit(1 * u.km),
        *ba.catalogue.load("sn263"),
    ):
        assert type(pickle.loads(pickle.dumps(value))) is type(value)
    run = ba.propagate(system, state, duration=0.1 * u.s, integrator=ba.LGVI(0.01 * u.s))
    again = pickle.loads(pickle.dumps(run))
    np.testing.assert_array_equal(again.si.position, run.si.position)
    gravity = system.mutual_gravity(state.relative().X)
    assert pickle.loads(pickle.dumps(gravity)).energy == gravity.energy


def test_equations_pickle_to_another_process(tmp_path: Path) -> None:
    """They hold addresses of compiled functions, which are others there."""
    system, state = ba.catalogue.load("dumbbells")
    forms = [
        ba.equations.continuous(system, frame="relative"),
        ba.equations.discrete(system, step=1e-3 * u.s, form="lagrangian", summed=True),
    ]
    (tmp_path / "forms").write_bytes(pickle.dumps([(form, form.from_state(state)) for form in forms]))
    code = (
        "import pickle, sys; (one, y), (two, z) = pickle.load(open(sys.argv[1], 'rb'));"
        "print(one.rhs(0.0, y)[0], two.advance(z, 3)[0])"
    )
    arguments = [sys.executable, "-c", code, str(tmp_path / "forms")]
    result = subprocess.run(arguments, capture_output=True, text=True, check=True)
    expected = forms[0].rhs(0.0, forms[0].from_state(state))[0], forms[1].advance(forms[1].from_state(state), 3)[0]
    assert [float(word) for word in result.stdout.split()] == pytest.approx(expected, rel=1e-13)


def test_an_unknown_name_is_an_attribute_error() -> None:
    assert not hasattr(ba, "Asteroid")
