"""Scenario files and the catalogue: what they hold, and one line for each mistake."""

from pathlib import Path

import astropy.units as u
import numpy as np
import pytest

import binaryast as ba
from binaryast.errors import InputError, ScenarioError, StorageError
from binaryast.scenario import load, loads

PLAIN = ba.catalogue.text("didymos").replace("accuracy = 1e-8\n", "")  # it has a step alone


@pytest.mark.parametrize("name", ba.catalogue.names())
def test_every_entry_runs_and_has_sources(name: str) -> None:
    entry = ba.catalogue.entry(name)
    assert entry.title
    assert entry.sources
    assert ba.catalogue.title(name) == entry.title
    step = entry.integrator.step
    run = ba.propagate(entry.system, entry.state, duration=20 * step, integrator=entry.integrator)
    assert run.status == "completed"
    assert entry.duration > 100 * step


def test_the_entries_hold_the_published_numbers() -> None:
    didymos, state = ba.catalogue.load("didymos")
    assert sum(body.si.gm for body in didymos.bodies) == pytest.approx(34.8961209875640, rel=1e-13)
    assert state.separation.value == pytest.approx(1184.2, abs=0.1)
    assert state.frame == "ICRF"
    patroclus, state = ba.catalogue.load("patroclus")
    assert sum(body.si.gm for body in patroclus.bodies) == pytest.approx(
        (0.0740606361329036 + 0.020917) * 1e9, rel=1e-12
    )
    assert patroclus.primary.density.value == pytest.approx(patroclus.secondary.density.value, rel=1e-9)
    assert state.separation.to_value("km") == pytest.approx(692.5, abs=2)
    moshup, state = ba.catalogue.load("moshup")
    assert moshup.primary.si.mass == 2.353e12
    assert state.separation.to_value("km") == pytest.approx(2.55, abs=0.02)


def test_a_printed_entry_is_a_scenario(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(PLAIN, encoding="utf-8")
    scenario = load(path)
    assert scenario.name == "mine"
    assert scenario.duration == 60 * u.day
    assert scenario.integrator.step == 40 * u.s
    assert scenario.accuracy is None


def test_the_other_ways_to_start() -> None:
    def start(state: str) -> ba.State:
        return loads(
            PLAIN[: PLAIN.index("[state]")] + state + '[run]\nduration = "1 d"\nstep = "40 s"\n', name="x", where="x"
        ).state

    elements = start(
        '[state]\ntype = "from_elements"\nsemi_major_axis = "1.2 km"\neccentricity = 0.1\nmean_anomaly = "10 deg"\n'
        'spins = ["[0, 1e-5, 7e-4] rad / s", "1e-4 rad / s"]\nepoch = "2022-09-26T23:14:24.184 UTC"\n'
    )
    np.testing.assert_allclose(elements.si.spin, [[0, 1e-5, 7e-4], [0, 0, 1e-4]])
    assert elements.epoch.utc.isot == "2022-09-26T23:14:24.184"
    inertial = start(
        '[state]\ntype = "inertial"\nposition = "[[0, 0, 0], [1.2, 0, 0]] km"\n'
        'velocity = "[[0, 0, 0], [0, 17, 0]] cm / s"\n'
        "attitude = [[[1, 0, 0], [0, 1, 0], [0, 0, 1]], [[1, 0, 0], [0, 1, 0], [0, 0, 1]]]\n"
        'spin = "[[0, 0, 1], [0, 0, 2]] deg / min"\n'
    )
    assert inertial.separation == 1200 * u.m


def test_dates_of_toml_with_a_zone() -> None:
    for date in ('"2022-09-26T23:14:24 UTC"', "2022-09-26T23:14:24Z", "2022-09-27T01:14:24+02:00"):
        state = loads(PLAIN.replace("[state]", f"[state]\nepoch = {date}"), name="x", where="x").state
        assert state.epoch.utc.isot == "2022-09-26T23:14:24.000"


def changed(old: str, new: str) -> str:
    assert old in PLAIN
    return PLAIN.replace(old, new, 1)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (changed('gm = "34', 'gn = "34'), r"bodies\[0\]\.gn: unknown key: did you mean 'gm'"),
        (changed("[state]", "[sate]"), "sate: unknown key: did you mean 'state'"),
        (changed('period = "', 'perod = "'), "state.perod: unknown key: did you mean 'period'"),
        (changed('step = "', 'stp = "'), "run.stp: unknown key: did you mean 'step'"),
        (changed('step = "40 s"', ""), "run.step is missing: expected a step, or an accuracy such as"),
        (changed('step = "40 s"', 'accuracy = "1e-8"'), "run.accuracy: expected a number such as 1e-8"),
        (changed('step = "40 s"', 'step = "40 s"\nintegrator = { type = "Spliting" }'), "did you mean 'Splitting'?"),
        (
            changed('step = "40 s"', 'step = "40 s"\nintegrator = { type = "LGVI", order = 5 }'),
            "run.integrator: LGVI: order=5",
        ),
        (changed('step = "40 s"', "step = 40"), 'run.step: expected a text with a unit such as "40 s"'),
        (changed('step = "40 s"', 'step = "40"'), "'40' has no unit"),
        (changed('step = "40 s"', 'step = "40 kg"'), "is not a time"),
        (changed('step = "40 s"', 'step = "-40 s"'), "positive"),
        (changed('step = "40 s"', 'step = "nan s"'), "finite"),
        (changed('"Ellipsoid"', '"Elipsoid"'), "did you mean 'Ellipsoid'"),
        (changed('a = "425.5 m", ', ""), r"bodies\[0\]\.shape\.a is missing"),
        (changed('a = "425.5 m"', "a = 425.5"), 'a text with a unit such as "425.5 m", got 425.5'),
        (changed('a = "425.5 m"', 'a = "425.5 kg"'), "is not a length"),
        (changed('a = "425.5 m"', 'a = "425.5 parsecs and more"'), "is not understood"),
        (changed('"Multipole"\ndegree = 4', '"PointPairs"'), "not a set of points"),
        (changed('"circular_orbit"', '"circular"'), "did you mean 'circular_orbit'"),
        (changed('["2.26 h", "synchronous"]', '["2.26 h", "sync"]'), "is not understood"),
        (changed('["2.26 h", "synchronous"]', '"2.26 h"'), "expected a list"),
        (changed('name = "Dimorphos"', 'name = "Didymos"'), "two bodies are called"),
        (changed("[state]", '[state]\nepoch = "yesterday"'), "state.epoch"),
        (changed("[state]", '[state]\nepoch = "2022-09-26T23:14:24 XYZ"'), "is no date"),
        (changed('"425.5 m"', '"1e200 m"'), "beyond what can be computed"),
        (changed('period = "11.921473 h"', 'period = "1e-200 s"'), "beyond what can be computed"),
        (changed('["69.326861266 deg", "-72.724550396 deg"]', '["[1, 2] m", "1 deg"]'), "state: pole"),
        (changed("[state]", "sources = 1\n[state]"), "sources"),
        (changed('name = "Didymos"', 'name = "a\\u0000b"'), "printable"),
        ("a = " + 600 * "[" + 600 * "]", "not TOML"),
        (changed('spins = ["2.26 h", "synchronous"]', "spins = [2.26, 11.9]"), r'spins\[0\].*such as "2.26 h"'),
        ("bodies = 1\nstate = 2\nrun = 3", "bodies: expected a table"),
        ("", "bodies is missing"),
        ("[[bodies]\n", "not TOML"),
    ],
)
def test_one_line_for_each_mistake(text: str, says: str) -> None:
    with pytest.raises(ScenarioError, match=says) as caught:
        loads(text, name="mine", where="mine.toml")
    assert str(caught.value).startswith("mine.toml: ")
    assert "\n" not in str(caught.value)


MANY = """
title = 7
[[bodies]]
name = "A"
shape = { type = "Ellipsoid", a = "400 kg", b = "390", c = "300 m" }
density = 2000

[[bodies]]
name = "B"
shape = { type = "Sphere", radus = "60 m" }
mas = "2e9 kg"

[gravity]
type = "Multipol"

[state]
type = "circular_orbit"
separation = "1.2 h"   # a time
spin = ["3 h",
    "synchronous"]

[run]
step = "-60 s"
save_every = "10 min"
accuracy = true

[[impulses]]
type = "Impulse"
time = "1 h"
delta_v = "[0, -2.6, 0]"

[[sources]]
source = "none"
"""


def test_all_mistakes_are_listed_with_their_lines() -> None:
    with pytest.raises(ScenarioError) as caught:
        loads(MANY, name="mine", where="mine.toml")
    text = str(caught.value)
    assert text.startswith("mine.toml: 13 mistakes: ")
    assert "\n" not in text
    found = [part.split(": ")[:2] for part in text.removeprefix("mine.toml: 13 mistakes: ").split(" | ")]
    assert found == [
        ["line 2", "title"],
        ["line 5", "bodies[0].shape.b"],
        ["line 6", "bodies[0].density"],
        ["line 10", "bodies[1].shape.radus"],
        ["line 11", "bodies[1].mas"],
        ["line 14", "gravity.type"],
        ["line 19", "state.spin"],
        ["line 22", "run.duration is missing"],
        ["line 23", "run.step"],
        ["line 25", "run.accuracy"],
        ["line 27", "impulses[0].body is missing"],
        ["line 30", "impulses[0].delta_v"],
        ["line 32", "sources[0].what is missing"],
    ]


def test_one_mistake_has_its_line_too() -> None:
    with pytest.raises(ScenarioError, match=r"^mine\.toml: line \d+: bodies\[0\]\.gn: unknown key"):
        loads(changed('gm = "34', 'gn = "34'), name="mine", where="mine.toml")


@pytest.mark.parametrize(
    ("version", "says"),
    [("1", None), ("2", "expected 1 to 1, got 2: a newer binaryast wrote it"), ("0", "whole number"), ('"1"', "whole")],
)
def test_the_version_of_the_format_is_checked(version: str, says: str | None) -> None:
    text = f"format_version = {version}\n{PLAIN}"
    if says is None:
        assert loads(text, name="mine", where="mine.toml").duration == 60 * u.day
        return
    with pytest.raises(ScenarioError, match=rf"line 1: format_version: .*{says}"):
        loads(text, name="mine", where="mine.toml")


def test_files_that_are_not_there_or_not_text(tmp_path: Path) -> None:
    with pytest.raises(StorageError, match="no such file"):
        load(tmp_path / "none.toml")
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(StorageError, match="as text"):
        load(tmp_path / "binary.toml")
    with pytest.raises(StorageError, match="as text"):
        load(tmp_path)


def test_unknown_names_get_the_nearest() -> None:
    with pytest.raises(InputError, match="did you mean 'didymos'"):
        ba.catalogue.load("didimos")


SN263 = ba.catalogue.text("sn263")
GRAVITY = 'type = "Multipole"\ndegree = 4'
PAIRS = """[[gravity.pairs]]
bodies = ["Gamma", "Alpha"]
type = "PointMass"
"""


def test_the_example_of_the_documentation_runs() -> None:
    import textwrap

    import binaryast.scenario

    assert binaryast.scenario.__doc__
    text = textwrap.dedent(binaryast.scenario.__doc__.partition("::\n")[2])
    scenario = loads(text, name="example", where="example.toml")
    assert [type(pair.gravity).__name__ for pair in scenario.system.pairs] == [*2 * ["Multipole"], "PointMass"]
    run = ba.propagate(scenario.system, scenario.state, duration=1 * u.h, integrator=scenario.integrator)
    assert run.status == "completed"


def test_gravity_by_pairs() -> None:
    text = SN263.replace(GRAVITY, f"{GRAVITY}\n{PAIRS}")
    system = loads(text, name="mine", where="mine.toml").system
    assert [type(pair.gravity).__name__ for pair in system.pairs] == ["PointMass", "Multipole", "Multipole"]


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        (GRAVITY, f"{GRAVITY}\npairs = 1", "gravity.pairs: expected tables"),
        (GRAVITY, f"{GRAVITY}\n{PAIRS}".replace("Gamma", "Delta"), "is no pair"),
        (GRAVITY, f"{GRAVITY}\n{PAIRS}".replace("bodies", "names"), "bodies is missing"),
        ('about = "inner"', 'about = "outer"', "expected one of primary, inner"),
        ('semi_major_axis = "3.804 km"', "semi_major_axis = 3.804", r"state.orbits\[0\].semi_major_axis"),
        ("eccentricity = 0.016", "excentricity = 0.016", "did you mean 'eccentricity'"),
        ("eccentricity = 0.016", "eccentricity = 1.016", "0 <= e < 1"),
        ('Alpha = ["67.81 deg"', 'Alfa = ["67.81 deg"', "did you mean 'Alpha'"),
        ('["3.4256 h", "synchronous", "13.43 h"]', '["3.4256 h", "synchronous"]', "expected a list of 3"),
        ("[[state.orbits]]", "[[state.orbit]]", "orbits: expected a table"),
        ('type = "from_orbits"', 'type = "circular_orbit"', "unknown key"),
    ],
)
def test_one_line_for_each_mistake_of_several_bodies(old: str, new: str, says: str) -> None:
    assert old in SN263
    with pytest.raises(ScenarioError, match=says) as caught:
        loads(SN263.replace(old, new), name="mine", where="mine.toml")
    assert "\n" not in str(caught.value)


def test_a_point_in_a_file() -> None:
    text = SN263.replace('{ type = "Ellipsoid", a = "382.8 m", b = "519.0 m", c = "328.2 m" }', '{ type = "Point" }')
    with pytest.raises(ScenarioError, match="Beta is a point"):
        loads(text, name="mine", where="mine.toml")
    scenario = loads(text.replace('"13.43 h"', '"none"'), name="mine", where="mine.toml")
    run = ba.propagate(scenario.system, scenario.state, duration=1 * u.h, integrator=scenario.integrator)
    assert run.status == "completed"


ROCK = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def with_shape(shape: str) -> str:
    start = PLAIN.index("shape = {")
    return PLAIN[:start] + f"shape = {shape}" + PLAIN[PLAIN.index("\n", start) :]


def test_a_polyhedron_from_a_file_beside_the_scenario(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "shapes").mkdir()
    (tmp_path / "shapes" / "rock.obj").write_text(ROCK)
    path = tmp_path / "mine.toml"
    path.write_text(with_shape('{ type = "Polyhedron", file = "shapes/rock.obj", unit = "km" }'))
    monkeypatch.chdir(tmp_path / "shapes")
    shape = load(path).system.primary.shape
    assert isinstance(shape, ba.Polyhedron)
    assert shape.volume == pytest.approx(1e9 / 6)
    monkeypatch.chdir(tmp_path)
    assert load("mine.toml").system.primary.shape.volume == shape.volume
    inner = '{ type = "Sphere", radius = "100 m" }'
    layers = f'outer = {{ type = "Sphere", radius = "400 m" }}, inner = {inner}, density_ratio = 2'
    path.write_text(with_shape(f'{{ type = "Layered", {layers} }}'))
    assert isinstance(load(path).system.primary.shape, ba.Layered)


@pytest.mark.parametrize(
    ("shape", "says"),
    [
        ('{ type = "Polyhedron", unit = "km" }', "bodies[0].shape.file is missing"),
        ('{ type = "Polyhedron", file = "rock.obj" }', "bodies[0].shape.unit is missing"),
        ('{ type = "Polyhedron", file = "rock.obj", unit = "kg" }', "expected the unit of a length"),
        ('{ type = "Polyhedron", file = "rock.obj", unit = 1000 }', "expected the unit of a length"),
        ('{ type = "Polyhedron", file = 3, unit = "km" }', "file: expected a text in quotes, got 3"),
        ('{ type = "Polyhedron", file = "open.obj", unit = "km" }', "open.obj: Polyhedron: the mesh is not one sound"),
        ('{ type = "Polyhedron", file = "rock.obj", unit = "km", mend = 1 }', "mend: expected true or false"),
        ('{ type = "Polyhedron", file = "rock.obj", unit = "km", scale = 2 }', "shape.scale: unknown key"),
        ('{ type = "Polyhedon", file = "rock.obj" }', "did you mean 'Polyhedron'"),
        ('{ type = "Layered", outer = "big", inner = "small", density_ratio = 1 }', "outer: expected a ba.Ellipsoid"),
        (
            '{ type = "Layered", outer = { type = "Sphere" }, inner = { type = "Sphere" }, density_ratio = 1 }',
            "bodies[0].shape.outer.radius is missing",
        ),
    ],
)
def test_one_line_for_each_mistake_in_a_shape(shape: str, says: str, tmp_path: Path) -> None:
    (tmp_path / "rock.obj").write_text(ROCK)
    (tmp_path / "open.obj").write_text(ROCK.replace("f 1 3 2", "f 1 2 4"))
    path = tmp_path / "mine.toml"
    path.write_text(with_shape(shape))
    with pytest.raises(ScenarioError) as caught:
        load(path)
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_mesh_that_is_not_there(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(with_shape('{ type = "Polyhedron", file = "none.obj", unit = "km" }'))
    with pytest.raises(StorageError, match=r"none\.obj: no such file"):
        load(path)


def test_integrators_and_accuracies() -> None:
    text = PLAIN.replace('step = "40 s"', 'step = "40 s"\nintegrator = { type = "KeplerSplitting", scheme = "aba104" }')
    found = loads(text, name="x", where="x")
    assert repr(found.integrator) == repr(ba.KeplerSplitting(40 * u.s, "aba104"))
    assert found.accuracy is None
    found = loads(PLAIN.replace('step = "40 s"', "accuracy = 1e-8"), name="x", where="x")
    assert found.integrator is None
    assert found.accuracy == 1e-8
