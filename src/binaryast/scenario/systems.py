"""The tables of a scenario that say what there is: bodies, their gravity, what acts from outside."""

from pathlib import Path
from typing import Any

from astropy.units import Quantity

from binaryast import coefficients, gravity, perturbations, shapes, unions
from binaryast.adaptive import Adaptive
from binaryast.bodies import RigidBody
from binaryast.elements import Orbit
from binaryast.errors import InputError
from binaryast.layered import Layered
from binaryast.polyhedron import Polyhedron
from binaryast.polyhedron_pair import PolyhedronPair
from binaryast.polyhedron_point import PolyhedronPoint
from binaryast.system import OTHERS, System
from binaryast.tables import Found, call, check_keys, choice, epoch, table_of, text_of, typed
from binaryast.units import brief, parse

SHAPES = {
    kind.__name__: kind
    for kind in (
        shapes.Ellipsoid,
        shapes.Sphere,
        shapes.Dumbbell,
        shapes.PointCloud,
        shapes.Point,
        Polyhedron,
        Layered,
        unions.Union,
        coefficients.InertiaIntegrals,
        coefficients.StokesCoefficients,
    )
}
GRAVITIES = {
    kind.__name__: kind
    for kind in (
        gravity.SecondDegree,
        gravity.Multipole,
        gravity.PointPairs,
        gravity.PointMass,
        gravity.EllipsoidPair,
        PolyhedronPair,
        PolyhedronPoint,
        Adaptive,
    )
}


def system_of(tables: dict[str, Any], folder: Path) -> System | None:
    """Return the bodies and their gravity; None where there are no bodies, which is said elsewhere."""
    found = Found()
    models = found.attempt(_gravity, tables)
    outside = found.attempt(_perturbations_of, tables)
    if "bodies" not in tables:
        found.said()
        return None
    bodies = tables["bodies"]
    if not isinstance(bodies, list) or not all(isinstance(body, dict) for body in bodies):
        found.mistakes.append("bodies: expected a table [[bodies]] for each body, the primary first")
        found.said()
    made = [found.attempt(_body, body, f"bodies[{i}]", folder) for i, body in enumerate(bodies)]
    found.said()
    return System(made, models, outside or ())


def _body(table: dict[str, Any], where: str, folder: Path) -> RigidBody:
    """Return a body."""
    found = Found()
    units = {"mass": "kg", "density": "kg / m3", "gm": "m3 / s2", "inertia": "kg m2"}
    found.attempt(check_keys, table, ("name", "shape", *units, "pulls"), ("name", "shape"), f"{where}.")
    quantities = {
        key: found.attempt(_with_unit, table[key], f"{where}.{key}", unit)
        for key, unit in units.items()
        if key in table
    }
    shape: Any = found.attempt(_shape_of, table, where, folder) if "shape" in table else None
    found.said()
    try:
        return RigidBody(table["name"], shape, **quantities, pulls=table.get("pulls", True))
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def _with_unit(value: Any, where: str, unit: str) -> Quantity:
    return parse(text_of(value, where, unit), where, f"1 {unit}")


def _shape_of(table: dict[str, Any], where: str, folder: Path) -> Any:
    return _shape(table_of(table, "shape", f"{where}."), f"{where}.shape", folder)


def _shape(table: dict[str, Any], where: str, folder: Path) -> Any:
    """Return a shape, with the shapes inside it and what it needs from files."""
    kind = choice(table, SHAPES, where)
    table = {
        key: _shape(value, f"{where}.{key}", folder) if isinstance(value, dict) else value
        for key, value in table.items()
    }
    if kind == "Union" and "parts" in table:
        table["parts"] = _parts(table["parts"], f"{where}.parts", folder)
    if kind != "Polyhedron":
        return typed(table, SHAPES, where)
    arguments = {key: value for key, value in table.items() if key != "type"}
    return call(_polyhedron, {"folder": folder}, arguments, where)


def _polyhedron(folder: Path, file: Any, unit: Any, facets: Any = None, mend: Any = False) -> Polyhedron:
    """Return the polyhedron of a file."""
    if not isinstance(mend, bool):
        raise InputError(f"mend: expected true or false, got {brief(mend)}")
    faces = None if facets is None else folder / text_of(facets, "facets")
    return Polyhedron.read(folder / text_of(file, "file"), unit, facets=faces, mend=mend)


def _parts(tables: Any, where: str, folder: Path) -> list[unions.Part]:
    """Return the parts of a union."""
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise InputError(f"{where}: expected tables, each with a shape and a mass, got {brief(tables)}")
    parts = []
    for i, table in enumerate(tables):
        check_keys(table, table, ("shape",), f"{where}[{i}].")
        shape = _shape(table_of(table, "shape", f"{where}[{i}]."), f"{where}[{i}].shape", folder)
        others = {key: value for key, value in table.items() if key != "shape"}
        parts.append(call(unions.Part, {"shape": shape}, others, f"{where}[{i}]"))
    return parts


def _gravity(tables: dict[str, Any]) -> Any:
    """Return the model, second degree where the file says nothing; or models by pairs, the first one for the others."""
    table = table_of(tables, "gravity")
    pairs = table.get("pairs")
    others = {key: value for key, value in table.items() if key != "pairs"} or {"type": "SecondDegree"}
    model = _model(others, "gravity")
    if pairs is None:
        return model
    if not isinstance(pairs, list) or not all(isinstance(pair, dict) for pair in pairs):
        raise InputError(f"gravity.pairs: expected tables [[gravity.pairs]], got {brief(pairs)}")
    models: dict[Any, Any] = {OTHERS: model}
    for i, pair in enumerate(pairs):
        where = f"gravity.pairs[{i}]"
        check_keys(pair, pair, ("bodies",), f"{where}.")
        names = pair["bodies"]
        if not isinstance(names, list) or len(names) != 2 or not all(isinstance(name, str) for name in names):
            raise InputError(f"{where}.bodies: expected the names of two bodies, got {brief(names)}")
        if tuple(names) in models:
            raise InputError(f"{where}.bodies: the pair of {names[0]} and {names[1]} is given twice")
        models[tuple(names)] = _model({k: v for k, v in pair.items() if k != "bodies"}, where)
    return models


def _model(table: dict[str, Any], where: str) -> Any:
    """Return a model of gravity, with the models inside it."""
    table = {key: _model(value, f"{where}.{key}") if isinstance(value, dict) else value for key, value in table.items()}
    return typed(table, GRAVITIES, where)


def _perturbations_of(tables: dict[str, Any]) -> list[perturbations.Perturbation]:
    """Return what acts from outside."""
    outside = tables.get("perturbations", [])
    if not isinstance(outside, list) or not all(isinstance(table, dict) for table in outside):
        raise InputError(f"perturbations: expected tables [[perturbations]], got {brief(outside)}")
    found = Found()
    made = [found.attempt(_perturbation, table, f"perturbations[{i}]") for i, table in enumerate(outside)]
    found.said()
    return made


def _perturbation(table: dict[str, Any], where: str) -> perturbations.Perturbation:
    """Return a perturbation, with the orbit, the Sun and the epoch in it."""
    table = dict(table)
    if "orbit" in table:
        orbit = table_of(table, "orbit", f"{where}.")
        table["orbit"] = call(Orbit, {}, orbit, f"{where}.orbit")
    if "sun" in table:
        table["sun"] = _perturbation(table_of(table, "sun", f"{where}."), f"{where}.sun")
    if "epoch" in table:
        table["epoch"] = epoch(table["epoch"], f"{where}.epoch")
    return typed(table, perturbations.KINDS, where)  # type: ignore[no-any-return]
