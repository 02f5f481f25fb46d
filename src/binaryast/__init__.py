"""Rigid bodies under mutual gravity: the full two-body problem, integrated on SE(3).

Everything public is here; what needs compiled code, plots or files is imported when it is first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from binaryast import constants as _constants

if TYPE_CHECKING:
    from binaryast import analysis, catalogue, constants, equations, errors, events, plotting, scenario
    from binaryast.adaptive import Adaptive
    from binaryast.bodies import RigidBody
    from binaryast.citations import cite
    from binaryast.coefficients import InertiaIntegrals, StokesCoefficients
    from binaryast.elements import Orbit
    from binaryast.errors import BinaryastError
    from binaryast.events import event
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
    from binaryast.perturbations import (
        Byorp,
        ExternalPotential,
        Flyby,
        Force,
        Planet,
        RadiationPressure,
        Sun,
        ThirdBody,
        TidalTorque,
        Yorp,
        external_potential,
        force,
    )
    from binaryast.polyhedron import Polyhedron
    from binaryast.polyhedron_pair import PolyhedronPair
    from binaryast.polyhedron_point import PolyhedronPoint
    from binaryast.propagation import propagate
    from binaryast.resuming import resume
    from binaryast.retracing import retrace
    from binaryast.shapes import Dumbbell, Ellipsoid, Point, PointCloud, Shape, Sphere
    from binaryast.state import RelativeState, State
    from binaryast.surfaces import Surface, surface
    from binaryast.system import MutualGravity, System
    from binaryast.trajectory import Trajectory
    from binaryast.unions import Part, Union
    from binaryast.viewer import animate, view

__version__ = _constants.VERSION

_HOMES = {
    "Adaptive": "adaptive",
    "BinaryastError": "errors",
    "Byorp": "perturbations",
    "Dumbbell": "shapes",
    "Ellipsoid": "shapes",
    "EllipsoidPair": "gravity",
    "ExternalPotential": "perturbations",
    "Flyby": "perturbations",
    "Force": "perturbations",
    "GravityField": "fields",
    "Impact": "impulses",
    "Impulse": "impulses",
    "InertiaIntegrals": "coefficients",
    "KeplerSplitting": "integrators",
    "LGVI": "integrators",
    "Layered": "layered",
    "Multipole": "gravity",
    "MutualGravity": "system",
    "Orbit": "elements",
    "PairPotential": "gravity",
    "Part": "unions",
    "Planet": "perturbations",
    "Point": "shapes",
    "PointCloud": "shapes",
    "PointMass": "gravity",
    "PointPairs": "gravity",
    "Polyhedron": "polyhedron",
    "PolyhedronPair": "polyhedron_pair",
    "PolyhedronPoint": "polyhedron_point",
    "RadiationPressure": "perturbations",
    "RelativeState": "state",
    "RigidBody": "bodies",
    "RungeKutta": "integrators",
    "SecondDegree": "gravity",
    "Shape": "shapes",
    "Sphere": "shapes",
    "Splitting": "integrators",
    "State": "state",
    "StokesCoefficients": "coefficients",
    "Sun": "perturbations",
    "Surface": "surfaces",
    "System": "system",
    "Taylor": "integrators",
    "ThirdBody": "perturbations",
    "TidalTorque": "perturbations",
    "Trajectory": "trajectory",
    "Union": "unions",
    "Yorp": "perturbations",
    "animate": "viewer",
    "cite": "citations",
    "event": "events",
    "external_potential": "perturbations",
    "force": "perturbations",
    "mascons": "filling",
    "pair_potential": "gravity",
    "polyhedron_field": "fields",
    "propagate": "propagation",
    "resume": "resuming",
    "retrace": "retracing",
    "surface": "surfaces",
    "view": "viewer",
}
_MODULES = ("analysis", "catalogue", "constants", "equations", "errors", "events", "plotting", "scenario")

__all__ = [
    "LGVI",
    "Adaptive",
    "BinaryastError",
    "Byorp",
    "Dumbbell",
    "Ellipsoid",
    "EllipsoidPair",
    "ExternalPotential",
    "Flyby",
    "Force",
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
    "Planet",
    "Point",
    "PointCloud",
    "PointMass",
    "PointPairs",
    "Polyhedron",
    "PolyhedronPair",
    "PolyhedronPoint",
    "RadiationPressure",
    "RelativeState",
    "RigidBody",
    "RungeKutta",
    "SecondDegree",
    "Shape",
    "Sphere",
    "Splitting",
    "State",
    "StokesCoefficients",
    "Sun",
    "Surface",
    "System",
    "Taylor",
    "ThirdBody",
    "TidalTorque",
    "Trajectory",
    "Union",
    "Yorp",
    "__version__",
    "analysis",
    "animate",
    "catalogue",
    "cite",
    "constants",
    "equations",
    "errors",
    "event",
    "events",
    "external_potential",
    "force",
    "mascons",
    "pair_potential",
    "plotting",
    "polyhedron_field",
    "propagate",
    "resume",
    "retrace",
    "scenario",
    "surface",
    "view",
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
