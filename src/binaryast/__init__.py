"""Rigid bodies under mutual gravity: the full two-body problem, integrated on SE(3).

Everything public is here; what needs compiled code, plots or files is imported when it is first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from binaryast import constants as _constants

if TYPE_CHECKING:
    from binaryast import analysis, catalogue, constants, equations, errors, plotting, scenario
    from binaryast.adaptive import Adaptive
    from binaryast.bodies import RigidBody
    from binaryast.coefficients import InertiaIntegrals, StokesCoefficients
    from binaryast.errors import BinaryastError
    from binaryast.fields import GravityField, polyhedron_field
    from binaryast.filling import mascons
    from binaryast.gravity import (
        EllipsoidPair,
        Multipole,
        PairPotential,
        PointMass,
        PointPairs,
        SecondDegree,
        pair_potential,
    )
    from binaryast.impulses import Impact, Impulse
    from binaryast.integrators import LGVI, KeplerSplitting, RungeKutta, Splitting, Taylor
    from binaryast.layered import Layered
    from binaryast.orbits import Orbit
    from binaryast.polyhedron import Polyhedron
    from binaryast.polyhedron_pair import PolyhedronPair
    from binaryast.polyhedron_point import PolyhedronPoint
    from binaryast.propagation import propagate
    from binaryast.resuming import resume
    from binaryast.shapes import Dumbbell, Ellipsoid, Point, PointCloud, Shape, Sphere
    from binaryast.state import RelativeState, State
    from binaryast.surfaces import Surface, surface
    from binaryast.system import MutualGravity, System
    from binaryast.trajectory import Trajectory
    from binaryast.unions import Part, Union

__version__ = _constants.VERSION

_HOMES = {
    "Adaptive": "adaptive",
    "BinaryastError": "errors",
    "Dumbbell": "shapes",
    "Ellipsoid": "shapes",
    "EllipsoidPair": "gravity",
    "GravityField": "fields",
    "Impact": "impulses",
    "Impulse": "impulses",
    "InertiaIntegrals": "coefficients",
    "KeplerSplitting": "integrators",
    "LGVI": "integrators",
    "Layered": "layered",
    "Multipole": "gravity",
    "MutualGravity": "system",
    "Orbit": "orbits",
    "PairPotential": "gravity",
    "Part": "unions",
    "Point": "shapes",
    "PointCloud": "shapes",
    "PointMass": "gravity",
    "PointPairs": "gravity",
    "Polyhedron": "polyhedron",
    "PolyhedronPair": "polyhedron_pair",
    "PolyhedronPoint": "polyhedron_point",
    "RelativeState": "state",
    "RigidBody": "bodies",
    "RungeKutta": "integrators",
    "SecondDegree": "gravity",
    "Shape": "shapes",
    "Sphere": "shapes",
    "Splitting": "integrators",
    "State": "state",
    "StokesCoefficients": "coefficients",
    "Surface": "surfaces",
    "System": "system",
    "Taylor": "integrators",
    "Trajectory": "trajectory",
    "Union": "unions",
    "mascons": "filling",
    "pair_potential": "gravity",
    "polyhedron_field": "fields",
    "propagate": "propagation",
    "resume": "resuming",
    "surface": "surfaces",
}
_MODULES = ("analysis", "catalogue", "constants", "equations", "errors", "plotting", "scenario")

__all__ = [
    "LGVI",
    "Adaptive",
    "BinaryastError",
    "Dumbbell",
    "Ellipsoid",
    "EllipsoidPair",
    "GravityField",
    "Impact",
    "Impulse",
    "InertiaIntegrals",
    "KeplerSplitting",
    "Layered",
    "Multipole",
    "MutualGravity",
    "Orbit",
    "PairPotential",
    "Part",
    "Point",
    "PointCloud",
    "PointMass",
    "PointPairs",
    "Polyhedron",
    "PolyhedronPair",
    "PolyhedronPoint",
    "RelativeState",
    "RigidBody",
    "RungeKutta",
    "SecondDegree",
    "Shape",
    "Sphere",
    "Splitting",
    "State",
    "StokesCoefficients",
    "Surface",
    "System",
    "Taylor",
    "Trajectory",
    "Union",
    "__version__",
    "analysis",
    "catalogue",
    "constants",
    "equations",
    "errors",
    "mascons",
    "pair_potential",
    "plotting",
    "polyhedron_field",
    "propagate",
    "resume",
    "scenario",
    "surface",
]


def __getattr__(name: str) -> Any:
    if name in _MODULES:
        return import_module(f"binaryast.{name}")
    if name in _HOMES:
        value = getattr(import_module(f"binaryast.{_HOMES[name]}"), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module 'binaryast' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
