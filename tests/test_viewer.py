"""The page that plays a run: what it holds, and that its script puts bodies where they are."""

import base64
import re
from pathlib import Path

import astropy.units as u
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast import cli
from binaryast.viewer import solids as drawn
from binaryast.viewer import threejs
from binaryast.viewer.page import page
from tests import pages, solids

needs_node = pytest.mark.skipif(pages.NODE is None, reason="there is no Node to run the page's script")


@pytest.fixture(scope="module")
def run() -> ba.Trajectory:
    """A day of Didymos, its primary's turns seen 27 times each."""
    system, state = ba.catalogue.load("didymos")
    return ba.propagate(system, state, duration=1 * u.day, integrator=ba.LGVI(40 * u.s), save_every=2 * u.min)


def unpacked(text: str, kind: type) -> np.ndarray:
    """Return the numbers of a packed array, as doubles or whole numbers."""
    numbers = np.frombuffer(base64.b64decode(text), dtype=kind)
    return numbers.astype(float) if kind is np.float32 else numbers


def test_the_page_holds_everything(run: ba.Trajectory) -> None:
    text = page(run)
    assert not re.search(r"\{\{\w+\}\}", text)  # no place of the template is left
    assert "src=" not in text.split("<script>")[0]
    assert "default-src 'none'" in text
    data = pages.data_of(text)
    assert [body["name"] for body in data["bodies"]] == ["Didymos", "Dimorphos"]
    assert len(text) < 1.2e6
    position = unpacked(data["motion"]["position"], np.float32).reshape(len(run), 2, 3) * data["unit"]
    assert np.abs(position - run.si.position).max() < 1e-4  # m, single precision
    assert unpacked(data["motion"]["time"], float).tolist() == run.si.time.tolist()
    energy = next(one for one in data["kept"] if one["name"] == "energy")
    assert unpacked(energy["values"], float).tolist() == run.energy.value.tolist()
    assert unpacked(energy["errors"], np.float32).max() == pytest.approx(run.max_relative_energy_error, rel=0.1)


def test_ten_thousand_rows_are_below_ten_megabytes(run: ba.Trajectory) -> None:
    many = run.at(np.linspace(0, 1, 10_000) * u.day)
    assert len(page(many)) < 5e6
    data = pages.data_of(page(many, rows=100))
    time = unpacked(data["motion"]["time"], float)
    assert len(time) == 100
    assert time[[0, -1]].tolist() == [0, 86400]
    assert data["rows"] == 10_000


def test_many_bodies_take_fewer_rows() -> None:
    rng = np.random.default_rng(1)
    rock = ba.RigidBody("rock", ba.Sphere(100 * u.m), mass=1e10 * u.kg)
    dust = [ba.RigidBody(f"grain {i}", ba.Point(), mass=1e-9 * u.kg, pulls=False) for i in range(300)]
    places = np.concatenate([np.zeros((1, 3)), 1000 + 100 * rng.random((300, 3))])
    system = ba.System([rock, *dust], gravity=ba.PointMass())
    state = ba.State(
        places * u.m, np.zeros((301, 3)) * u.m / u.s, np.eye(3)[None].repeat(301, 0), np.zeros((301, 3)) / u.s * u.rad
    )
    run = ba.propagate(system, state, duration=2000 * u.s, integrator=ba.LGVI(1 * u.s), save_every=1 * u.s)
    text = page(run)
    assert len(text) < 10e6
    assert pages.data_of(text)["title"].endswith("grain 5 and 294 others")
    assert unpacked(pages.data_of(text)["motion"]["time"], float).size == 827


@needs_node
def test_between_rows_bodies_are_where_they_are(run: ba.Trajectory) -> None:
    data = pages.data_of(page(run, rows=49))  # half an hour apart: 4.5 of them a turn of the primary
    times = np.random.default_rng(2).uniform(0, 86400, 200)
    times.sort()
    found = pages.in_node(
        data, f"{times.tolist()}.map(t => [0, 1].map(i => [motion.at(t, i).place, motion.attitude(t, i)]))"
    )
    truth = run.at(times * u.s)
    places = np.array([[one[0] for one in both] for both in found]) * data["unit"]
    turns = Rotation.from_quat(np.array([[one[1] for one in both] for both in found]).reshape(-1, 4))
    apart = np.linalg.norm(places - truth.si.position, axis=-1)
    angles = (turns.inv() * Rotation.from_matrix(truth.si.attitude.reshape(-1, 3, 3).copy())).magnitude()
    assert apart.max() < 0.05  # m
    assert apart.max() > 1e-4  # it was between rows
    assert angles.max() < 1e-5


@needs_node
def test_bodies_turn_by_their_spins_where_rows_are_more_than_a_turn_apart(run: ba.Trajectory) -> None:
    data = pages.data_of(page(run, rows=9))  # 3 h apart; the primary turns in 2.26 h
    times = np.linspace(1000, 86000, 50)
    found = pages.in_node(data, f"{times.tolist()}.map(t => motion.attitude(t, 0))")
    truth = Rotation.from_matrix(run.at(times * u.s).si.attitude[:, 0].copy())
    assert (Rotation.from_quat(found).inv() * truth).magnitude().max() < 1e-5


def test_places_are_about_the_barycentre() -> None:
    system, state = ba.catalogue.load("didymos")
    away = [3, 4, 5] * u.km
    moved = ba.State(state.position + away, state.velocity + away / (1 * u.h), state.attitude, state.spin)
    how = {"duration": 1 * u.h, "integrator": ba.LGVI(40 * u.s)}
    one, two = (pages.data_of(page(ba.propagate(system, start, **how))) for start in (state, moved))
    for name in ("position", "velocity"):
        here, there = (unpacked(data["motion"][name], np.float32) for data in (one, two))
        assert here == pytest.approx(there, abs=1e-6)


@needs_node
def test_axes_turn_with_the_line_of_centres_and_with_bodies(run: ba.Trajectory) -> None:
    data = pages.data_of(page(run))
    code = "[0, 40000, 86400].map(t => ['line', 'body'].map(kind => motion.shown(t, {kind, body: 1})))"
    for t, (line, body) in zip((0, 40000, 86400), pages.in_node(data, code), strict=True):
        state = run.at(t * u.s) if 0 < t < 86400 else run[0 if t == 0 else -1]
        between = state.si.position[1] - state.si.position[0]
        seen = Rotation.from_quat(line["turn"]).apply(between)
        assert seen == pytest.approx([np.linalg.norm(between), 0, 0], abs=1e-4)
        turn = Rotation.from_quat(body["turn"]).as_matrix() @ state.si.attitude[1]
        assert turn == pytest.approx(np.eye(3), abs=1e-7)
        assert np.array(body["origin"]) * data["unit"] == pytest.approx(state.si.position[1], abs=1e-4)


@needs_node
def test_an_impulse_is_at_its_time() -> None:
    system, state = ba.catalogue.load("didymos")
    kick = ba.Impulse(6 * u.h, [0, 0, 3] * u.cm / u.s, "Dimorphos")
    run = ba.propagate(
        system, state, duration=12 * u.h, integrator=ba.LGVI(40 * u.s), save_every=1 * u.h, impulses=[kick]
    )
    data = pages.data_of(page(run))
    before, after = pages.in_node(data, "[21599.9, 21600.1].map(t => motion.at(t, 1).velocity)")
    jump = (np.array(after) - before) * data["unit"]
    assert np.linalg.norm(jump) == pytest.approx(0.03, rel=0.02)
    errors = unpacked(data["kept"][0]["errors"], np.float32)
    assert errors.max() < 1e-7  # counted anew after the impulse


def test_a_run_of_one_row(run: ba.Trajectory, tmp_path: Path) -> None:
    path = ba.view(run[:1], tmp_path / "one.html")
    data = pages.data_of(path.read_text(encoding="utf-8"))
    assert unpacked(data["motion"]["time"], float).tolist() == [0.0]
    assert data["period"] > 0
    if pages.NODE:
        assert pages.in_node(data, "motion.at(0, 0).place")


def test_what_is_drawn_of_shapes() -> None:
    def of(shape: ba.Shape, **mass: u.Quantity) -> tuple[ba.RigidBody, list[dict]]:
        body = ba.RigidBody("B", shape, **(mass or {"mass": 1e9 * u.kg}))
        return body, drawn.solids(body, 10.0)

    _, (ellipsoid,) = of(ba.Ellipsoid(30 * u.m, 20 * u.m, 10 * u.m))
    assert np.reshape(ellipsoid["matrix"], (3, 3)) == pytest.approx(np.diag([3, 2, 1]))
    _, dumbbell = of(ba.Dumbbell(100 * u.m, 10 * u.m))
    assert sorted(one["centre"][0] for one in dumbbell[:2]) == [-5, 5]
    assert {tuple(end) for end in dumbbell[2]["rod"]} == {(5, 0, 0), (-5, 0, 0)}
    assert of(ba.Point())[1] == []
    cloud = ba.PointCloud([[30, 0, 0], [-30, 0, 0], [0, 20, 0], [0, -20, 0]] * u.m, [1, 1, 8, 8])
    _, (balls,) = of(cloud)
    radii = unpacked(balls["radii"], np.float32)
    assert radii[2] == pytest.approx(2 * radii[0])


def test_faces_are_drawn_in_the_body_frame() -> None:
    corners = np.array([[0, 0, 0], [4, 0, 0], [0, 3, 0], [0, 0, 2]]) * u.km
    faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    body = ba.RigidBody("B", ba.Polyhedron(corners, faces), density=2000 * u.kg / u.m**3)
    (mesh,) = drawn.solids(body, 1.0)
    vertices = unpacked(mesh["vertices"], np.float32).reshape(-1, 3)
    assert vertices == pytest.approx(body.corners, rel=1e-6, abs=1e-3)
    assert unpacked(mesh["faces"], np.uint32).reshape(-1, 3).tolist() == body.shape.faces.tolist()


def test_layers_and_unions_of_faces() -> None:
    vertices, faces = solids.box()
    outer, inner = ba.Polyhedron((vertices - 0.5) * 4 * u.km, faces), ba.Polyhedron((vertices - 0.5) * u.km, faces)
    layered = ba.RigidBody("L", ba.Layered(outer, inner, density_ratio=2), mass=1e14 * u.kg)
    (mesh,) = drawn.solids(layered, 1.0)
    assert np.abs(unpacked(mesh["vertices"], np.float32)).max() == pytest.approx(2000)
    parts = [ba.Part(outer, mass=2e14 * u.kg), ba.Part(inner, mass=1e13 * u.kg, offset=[3, 0, 0] * u.km)]
    union = ba.RigidBody("U", ba.Union(parts))
    both = [unpacked(mesh["vertices"], np.float32).reshape(-1, 3) for mesh in drawn.solids(union, 1.0)]
    assert np.concatenate(both) == pytest.approx(union.corners, abs=1e-3)


def test_names_cannot_break_the_page(run: ba.Trajectory) -> None:
    bodies = [
        ba.RigidBody(name, ba.Sphere(1 * u.km), mass=1e12 * u.kg)
        for name in ('</script><script>alert("1")</script>', "<b>&amp; {{data}}")
    ]
    system = ba.System(bodies, gravity=ba.PointMass())
    state = ba.State.circular_orbit(system, separation=4 * u.km, spins=[3 * u.h, 3 * u.h])
    text = page(ba.propagate(system, state, duration=1 * u.h, integrator=ba.LGVI(10 * u.s)))
    assert "<script>alert" not in text
    assert text.count("</script>") == 3
    assert [body["name"] for body in pages.data_of(text)["bodies"]] == [body.name for body in bodies]


def test_three_js_is_whole_and_has_its_licence() -> None:
    library = threejs.library()
    assert library.startswith("/**\n * @license\n * Copyright 2010-")
    assert "SPDX-License-Identifier: MIT" in library
    assert "TrackballControls" not in library


def test_a_trimesh_without_it_is_one_clear_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(threejs, "MEMBER", "another")
    with pytest.raises(ba.BinaryastError, match=r"trimesh .* does not hold three.js .* pip install"):
        threejs.library()


@pytest.mark.parametrize(
    ("call", "line"),
    [
        (lambda run, folder: ba.view(run[0], folder / "a.html"), "run: expected a ba.Trajectory"),
        (lambda run, folder: ba.view(run, folder / "a.png"), "expected a name that ends in .html"),
        (lambda run, folder: ba.view(run, folder / "no" / "a.html"), "there is no folder"),
        (lambda run, folder: ba.view(run, folder / "a.html", rows=0), "rows: expected a whole number, 1 or more"),
        (lambda run, folder: ba.view(run, folder / "there.html"), "exists already"),
        (ba.view, "expected a name that ends in .html"),
    ],
)
def test_what_it_refuses(run: ba.Trajectory, tmp_path: Path, call, line: str) -> None:
    (tmp_path / "there.html").touch()
    with pytest.raises(ba.BinaryastError, match=line):
        call(run, tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["there.html"]


def test_the_command(run: ba.Trajectory, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    run.write("day.h5")
    assert cli.main(["view", "day.h5"]) == 0
    assert capsys.readouterr().out == "written: day.html (0.82 MB): open it in a browser\n"
    assert cli.main(["view", "day.h5"]) == 2
    assert "day.html exists already" in capsys.readouterr().err
    Path("not.h5").write_text("no")
    assert cli.main(["view", "not.h5"]) == 2
    assert capsys.readouterr().err.count("\n") == 1
