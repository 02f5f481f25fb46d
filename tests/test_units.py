"""Quantities to floats and texts to quantities."""

import astropy.units as u
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from binaryast.errors import InputError, UnitError
from binaryast.units import parse, to_si


@given(st.floats(1e-6, 1e6), st.sampled_from(["s", "min", "h", "d", "yr", "ms"]))
def test_times_in_any_unit(value: float, unit: str) -> None:
    expected = value * u.Unit(unit).to(u.s)
    assert to_si(value * u.Unit(unit), "s", "time") == pytest.approx(expected, rel=1e-15)
    assert to_si(parse(f"{value!r} {unit}", "time"), "s", "time") == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "unit", "expected"),
    [("60d", "s", 5184000), ("0.0002s", "s", 2e-4), ("1e-3 h", "s", 3.6), ("[1, 0, 0.3] km", "m", [1000, 0, 300])],
)
def test_texts(text: str, unit: str, expected: object) -> None:
    value = parse(text, "x")
    np.testing.assert_allclose(to_si(value, unit, "x", shape=np.shape(expected)), expected)


@pytest.mark.parametrize("text", ["", "40", "s", "forty s", "[1, 2 m", "[1, x] m", "1 m 2", "nan"])
def test_texts_that_are_none(text: str) -> None:
    with pytest.raises(UnitError, match="x: "):
        to_si(parse(text, "x"), "s", "x")


@pytest.mark.parametrize("value", [1, 1.0, np.ones(3), None, [1, 2], object(), True, {}, "1 m"])
def test_bare_values_show_the_fix(value: object) -> None:
    with pytest.raises(UnitError, match=r"\* u\.m / u\.s"):
        to_si(value, "m / s", "velocity")


def test_complex_and_shaped_values_are_refused() -> None:
    with pytest.raises(InputError, match="real"):
        to_si((1 + 2j) * u.m, "m", "x")
    with pytest.raises(InputError, match=r"shape \(3,\), got shape \(2,\)"):
        to_si([1, 2] * u.m, "m", "x", shape=(3,))
    with pytest.raises(UnitError, match="different kinds"):
        to_si([1 * u.m, 1 * u.s], "m", "x", shape=(2,))


def test_floats_are_read_only_copies() -> None:
    values = np.ones(3)
    floats = to_si(values * u.m, "m", "x", shape=(3,))
    values[0] = 5
    assert floats[0] == 1
    with pytest.raises(ValueError, match="read-only"):
        floats[0] = 2
