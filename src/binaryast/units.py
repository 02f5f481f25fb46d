"""The one place where quantities become plain SI floats, and texts become quantities."""

import json
from collections.abc import Sequence
from typing import Any, Literal, TypeAlias

import astropy.units as u
import numpy as np
from astropy.units import Quantity
from numpy.typing import NDArray

from binaryast.errors import InputError, UnitError

Floats: TypeAlias = NDArray[np.floating[Any]]
Sign = Literal["any", "positive", "non-negative"]

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
    if isinstance(value, str):
        value = parse(value, unit, name)
    if not isinstance(value, Quantity):
        value = _from_list(value, name, kind, example)
    if np.iscomplexobj(value.value):
        raise InputError(f"{name}: expected a real value, got {value}")
    try:
        floats = np.array(value.to_value(u.Unit(unit)), dtype=np.float64)
    except u.UnitConversionError:
        found = value.unit or "no unit"
        raise UnitError(f"{name}: {value} is not {kind}: expected a unit such as {example}, got {found}") from None
    except (TypeError, ValueError) as error:
        raise InputError(f"{name}: {value!r} is not a real number ({error})") from None
    return checked(floats, name, shape, sign, value)


def _from_list(value: Any, name: str, kind: str, example: str) -> Quantity:
    """Join a list of quantities, or say how a bare number is written."""
    if isinstance(value, Sequence) and len(value) and all(isinstance(item, Quantity) for item in value):
        try:
            return Quantity(value)
        except u.UnitConversionError:
            raise UnitError(f"{name}: the elements have units of different kinds; expected {kind} in each") from None
    shown = repr(value) if len(repr(value)) < 40 else "..."
    short = name.rsplit(": ")[-1]
    raise UnitError(f"{name}={shown} has no unit: expected {kind}, write {short}={shown} * u.{u_expression(example)}")


def u_expression(unit: str) -> str:
    """Return how a unit is written in Python after ``u.``."""
    return {
        "m / s": "m / u.s",
        "rad / s": "rad / u.s",
        "kg / m3": "kg / u.m**3",
        "m3 / s2": "m**3 / u.s**2",
        "kg m2": "kg * u.m**2",
    }.get(unit, unit)


def checked(floats: Floats, name: str, shape: tuple[int, ...], sign: Sign = "any", shown: Any = None) -> Floats:
    """Return an array that has been looked at: shape, finite, sign; read-only."""
    shown = floats if shown is None else shown
    if floats.shape != shape:
        expected = "a single value" if shape == () else f"an array of shape {shape}"
        raise InputError(f"{name}: expected {expected}, got shape {floats.shape}")
    if not np.all(np.isfinite(floats)):
        raise InputError(f"{name}: expected finite values, got {shown}")
    if sign == "positive" and not np.all(floats > 0):
        raise InputError(f"{name}: expected a positive value, got {shown}")
    if sign == "non-negative" and not np.all(floats >= 0):
        raise InputError(f"{name}: expected a value of zero or more, got {shown}")
    floats.flags.writeable = False
    return floats


def numbers(value: Any, name: str, shape: tuple[int, ...]) -> Floats:
    """Return dimensionless values as a read-only array of floats of that shape."""
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{name}: expected an array of numbers of shape {shape}, got {value!r}") from None
    return checked(array, name, shape)


def parse(text: str, unit: str, name: str) -> Quantity:
    """Return the quantity that a text such as ``"40 s"`` or ``"[1, 0, 0.3] m"`` says.

    Examples
    --------
    >>> from binaryast.units import parse
    >>> parse("60d", "s", "duration").unit
    Unit("d")
    """
    kind, example = KINDS[unit]
    try:
        if text.lstrip().startswith("["):
            values, _, tail = text.rpartition("]")
            quantity = Quantity(np.array(json.loads(values + "]"), dtype=float), tail.strip())
        else:
            quantity = Quantity(text)
    except (TypeError, ValueError):
        raise UnitError(f"{name}: {text!r} is not {kind}: write a number and a unit, such as '1 {example}'") from None
    if quantity.unit == u.dimensionless_unscaled:
        raise UnitError(f"{name}: {text!r} has no unit: expected {kind}, such as '{text.strip()} {example}'")
    return quantity


def quantity(floats: Any, unit: str) -> Quantity:
    """Return floats in SI as a quantity, without a copy."""
    return np.asarray(floats) << u.Unit(unit)
