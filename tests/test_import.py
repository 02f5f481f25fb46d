"""Importing the package is cheap, complete, and its names clash with nothing."""

import pickle
import subprocess
import sys

import binaryast as ba


def test_import_loads_nothing_heavy() -> None:
    code = (
        "import sys, binaryast; binaryast.__version__; dir(binaryast);"
        "print([name for name in ('numba', 'scipy', 'h5py', 'matplotlib', 'astropy', 'tqdm') if name in sys.modules])"
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
    ):
        assert ">>>" in getattr(ba, name).__doc__
    assert ">>>" in ba.propagate.__doc__


def test_values_pickle() -> None:
    system, state = ba.catalogue.load("dumbbells")
    scenario = ba.catalogue.entry("moshup")
    for value in (system, state, scenario, system.gravity, ba.SecondDegree(), ba.PointMass(), scenario.integrator):
        again = pickle.loads(pickle.dumps(value))
        assert type(again) is type(value)
    gravity = system.mutual_gravity(state.relative().X)
    assert pickle.loads(pickle.dumps(gravity)).energy == gravity.energy


def test_an_unknown_name_is_an_attribute_error() -> None:
    assert not hasattr(ba, "Asteroid")
