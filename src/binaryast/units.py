"""The one place where quantities become plain SI floats, and texts become quantities."""

import json
from typing import Any, Literal, TypeAlias

import astropy.units as u
import numpy as np
from astropy.units import Quantity
from numpy.typing import NDArray

from binaryast.errors import InputError, UnitError

Floats: TypeAlias = NDArray[np.floating[Any]]
Indices: TypeAlias = NDArray[np.int64]
Sign = Literal["any", "positive", "non-negative"]
LARGEST = 1e90  # in SI: three factors of it still are a number

KINDS = {  # what a unit is called in a message, and one that users write
    "m": ("a length", "m"),
    "kg": ("a mass", "kg"),
    "s": ("a time", "s"),
    "m / s": ("a speed", "m / s"),
    "rad / s": ("an angular rate", "rad / s"),
    "rad": ("an angle", "deg"),
    "kg / m3": ("a density", "kg / m3"),
    "m3 / s2": ("a gravitational parameter G m", "m3 / s2"),
    "kg m2": ("a moment of inertia", "kg m2"),
    "J": ("an energy", "J"),
    "N": ("a force", "N"),
    "N m": ("a torque", "N m"),
    "m2": ("an area", "m2"),
    "rad / s2": ("an angular acceleration", "rad / s2"),
}


def to_si(value: Any, unit: str, name: str, shape: tuple[int, ...] = (), sign: Sign = "any") -> Floats:
    """Return a quantity as floats in SI.

    Parameters
    ----------
    value : Quantity
        What the user gave.
    unit : str
        The SI unit, a key of `KINDS`.
    name : str
        What the value is called in an error message.
    shape : tuple of int
        The expected shape.
    sign : {"any", "positive", "non-negative"}
        What the elements may be.

    Returns
    -------
    ndarray
        Read-only array of float64 of that shape.

    Raises
    ------
    UnitError
        For a bare number or another kind of unit.
    InputError
        For another shape, a value that is not finite, or one of the wrong sign.

    Examples
    --------
    >>> import astropy.units as u
    >>> from binaryast.units import to_si
    >>> float(to_si(1.5 * u.km, "m", "radius"))
    1500.0
    """
    kind, example = KINDS[unit]
    value = as_quantity(value, unit, name)
    try:
        floats = np.array(value.to_value(u.Unit(unit)), dtype=np.float64)
    except u.UnitConversionError:
        found = "no unit" if value.unit == u.dimensionless_unscaled else str(value.unit)
        raise UnitError(
            f"{name}: {brief(value)} is not {kind}: expected a unit such as {example}, got {found}"
        ) from None
    except Exception as error:  # whatever an array of objects raises
        raise InputError(f"{name}: {brief(value)} is not a real number ({brief(error)})") from None
    return checked(floats, name, shape, sign)


def as_quantity(value: Any, unit: str, name: str) -> Quantity:
    """Return a real quantity of any shape and unit; a list of quantities is joined, a bare number is an error."""
    kind, example = KINDS[unit]
    if isinstance(value, (list, tuple)) and _holds_quantities(value):
        try:
            value = Quantity(value)
        except u.UnitConversionError:
            raise UnitError(f"{name}: its elements have units of different kinds; expected {kind} in each") from None
        except (TypeError, ValueError):
            raise InputError(f"{name}: its elements have different shapes: {brief(value)}") from None
    if not isinstance(value, Quantity):
        short = name.rsplit(": ")[-1]
        unit_text = u_expression(example)
        if isinstance(value, (int, float, list, tuple, np.ndarray, np.number)) and len(repr(value)) < 40:
            raise UnitError(f"{name}={value!r} has no unit: expected {kind}, write {short}={value!r} * u.{unit_text}")
        raise UnitError(f"{name}: expected {kind} such as 1 * u.{unit_text}, got {brief(value)}")
    if value.dtype.kind not in "iuf":
        raise InputError(f"{name}: expected real numbers, got {brief(value)}")
    return value


def _holds_quantities(value: Any) -> bool:
    """Whether the innermost elements of nested lists are quantities."""
    while isinstance(value, (list, tuple)) and len(value):
        value = value[0]
    return isinstance(value, Quantity)


def brief(value: Any) -> str:
    """Return a value on one short line."""
    text = " ".join(str(value).split())
    return text if len(text) <= 80 else text[:77] + "..."


def u_expression(unit: str) -> str:
    """Return how a unit is written in Python after ``u.``."""
    return {
        "m / s": "m / u.s",
        "rad / s": "rad / u.s",
        "kg / m3": "kg / u.m**3",
        "m3 / s2": "m**3 / u.s**2",
        "kg m2": "kg * u.m**2",
    }.get(unit, unit)


def checked(floats: Floats, name: str, shape: tuple[int, ...], sign: Sign = "any") -> Floats:
    """Return an array that has been looked at: shape, finite, sign, size; read-only."""
    if floats.shape != shape:
        expected = "a single value" if shape == () else f"an array of shape {shape}"
        raise InputError(f"{name}: expected {expected}, got shape {floats.shape}")
    if not np.all(np.isfinite(floats)):
        raise InputError(f"{name}: expected finite values, got {brief(floats)}")
    if sign == "positive" and not np.all(floats > 0):
        raise InputError(f"{name}: expected a positive value, got {brief(floats)}")
    if sign == "non-negative" and not np.all(floats >= 0):
        raise InputError(f"{name}: expected a value of zero or more, got {brief(floats)}")
    if np.any(np.abs(floats) > LARGEST) or (sign == "positive" and np.any(floats < 1 / LARGEST)):
        raise InputError(
            f"{name}: {brief(floats)} in SI is beyond what can be computed with: {1 / LARGEST:g} to {LARGEST:g}"
        )
    floats.flags.writeable = False
    return floats


def numbers(value: Any, name: str, shape: tuple[int, ...]) -> Floats:
    """Return dimensionless values as a read-only array of floats of that shape."""
    if isinstance(value, Quantity):
        if value.unit != u.dimensionless_unscaled:
            raise UnitError(f"{name}: expected numbers without a unit, got {brief(value)}")
        value = value.value
    try:
        array = np.asarray(value)
        if array.dtype.kind not in "iuf":
            raise TypeError
        array = array.astype(np.float64)
    except (TypeError, ValueError, RecursionError):
        expected = "a number" if shape == () else f"an array of numbers of shape {shape}"
        raise InputError(f"{name}: expected {expected}, got {brief(repr(value))}") from None
    return checked(array, name, shape)


def whole_number(value: Any, name: str, least: int, most: int | None = None) -> int:
    """Return a whole number within bounds."""
    within = isinstance(value, (int, np.integer)) and not isinstance(value, bool) and value >= least
    if not within or (most is not None and value > most):
        expected = f"{least} or more" if most is None else f"{least} to {most}"
        raise InputError(f"{name}: expected a whole number, {expected}, got {brief(repr(value))}")
    return int(value)


def parse(text: str, name: str, example: str = "1 m") -> Quantity:
    """Return the quantity that a text such as ``"40 s"`` or ``"[1, 0, 0.3] m"`` says.

    Examples
    --------
    >>> from binaryast.units import parse
    >>> parse("60d", "duration").unit
    Unit("d")
    """
    try:
        if text.lstrip().startswith("["):
            values, _, tail = text.rpartition("]")
            result = Quantity(np.array(json.loads(values + "]"), dtype=float), tail.strip())
        else:
            result = Quantity(text)
    except (TypeError, ValueError, RecursionError):
        raise UnitError(
            f"{name}: {brief(text)!r} is not understood: write a number and a unit, such as '{example}'"
        ) from None
    if result.unit == u.dimensionless_unscaled:
        raise UnitError(f"{name}: {brief(text)!r} has no unit: write a number and a unit, such as '{example}'")
    return result


def quantity(floats: Any, unit: str) -> Quantity:
    """Return floats in SI as a quantity, without a copy."""
    return np.asarray(floats) << u.Unit(unit)


def as_unit(value: Any, unit: str, name: str) -> u.UnitBase:
    """Return a unit of the same kind as ``unit``, from one or from its name; a number is an error."""
    kind, example = KINDS[unit]
    try:
        if isinstance(value, (str, u.UnitBase)) and u.Unit(value).is_equivalent(u.Unit(unit)):
            return u.Unit(value)
    except (ValueError, TypeError):
        pass
    raise UnitError(f"{name}: expected the unit of {kind} such as u.{u_expression(example)}, got {brief(repr(value))}")


def span(seconds: float) -> str:
    """Return a time in the unit that reads best."""
    for unit, size in (("d", 86400.0), ("h", 3600.0)):
        if abs(seconds) >= 2 * size:
            return f"{seconds / size:.6g} {unit}"
    return f"{seconds:.6g} s"
