"""Movies of a run: as many pictures as asked, of the right length, with bodies in them; and what is refused."""

import subprocess
from importlib.util import find_spec
from pathlib import Path
from shutil import which

import astropy.units as u
import numpy as np
import pytest
from PIL import Image

import binaryast as ba
from binaryast import cli
from binaryast.viewer import facets, movie
from tests import solids

GROUND = np.array([16, 19, 24])


@pytest.fixture(scope="module")
def run() -> ba.Trajectory:
    """Half a day of Didymos."""
    system, state = ba.catalogue.load("didymos")
    return ba.propagate(system, state, duration=12 * u.h, integrator=ba.LGVI(40 * u.s), save_every=10 * u.min)


def pictures(path: Path) -> list[np.ndarray]:
    """Return the pictures of a gif (height, width, 3)."""
    with Image.open(path) as film:
        found = []
        for k in range(film.n_frames):
            film.seek(k)
            found.append(np.asarray(film.convert("RGB")).astype(int))
    return found


def test_a_gif_shows_what_moves(run: ba.Trajectory, tmp_path: Path) -> None:
    path = ba.animate(run, tmp_path / "day.gif", pictures=4, rate=10)
    films = pictures(path)
    assert len(films) == 4
    assert films[0].shape == (660, 800, 3)
    with Image.open(path) as film:
        assert film.info["duration"] == 100  # ms
    reddish = [np.argwhere((film[60:480, 100:780, 0] - film[60:480, 100:780, 2]) > 60) for film in films]
    places = [np.median(points, axis=0) for points in reddish]  # of the secondary and its way
    assert np.linalg.norm(places[1] - places[0]) > 50
    bluish = (films[0][..., 2] - films[0][..., 0]) > 30
    assert bluish[:500].mean() > 0.03  # the primary


@pytest.mark.skipif(which("ffmpeg") is None and find_spec("imageio_ffmpeg") is None, reason="there is no ffmpeg")
def test_an_mp4_is_one(run: ba.Trajectory, tmp_path: Path) -> None:
    path = ba.animate(run, tmp_path / "day.mp4", pictures=5, rate=5, axes="line")
    assert path.read_bytes()[4:8] == b"ftyp"
    told = subprocess.run([movie._ffmpeg(), "-i", str(path)], capture_output=True, text=True, check=False).stderr
    assert "Duration: 00:00:01.0" in told
    assert "800x660" in told


def test_without_ffmpeg_it_says_what_to_do(run: ba.Trajectory, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(movie, "which", lambda name: None)
    monkeypatch.setattr(movie, "find_spec", lambda name: None)
    with pytest.raises(ba.BinaryastError, match=r"an .mp4 needs ffmpeg: .* 'binaryast\[movie\]'; or write a .gif"):
        ba.animate(run, tmp_path / "day.mp4")
    assert not list(tmp_path.iterdir())


def test_one_row_and_one_picture(run: ba.Trajectory, tmp_path: Path) -> None:
    for name, some, count in (("row", run[:1], 2), ("picture", run, 1)):
        assert pictures(ba.animate(some, tmp_path / f"{name}.gif", pictures=count))


def test_triangles_face_outward_and_enclose_the_volume() -> None:
    vertices, faces = solids.box()
    for shape, volume in (
        (ba.Ellipsoid(3 * u.km, 2 * u.km, 1 * u.km), 8e9 * np.pi),
        (ba.Polyhedron((vertices + 5) * u.km, faces), 1e9),
        (ba.Dumbbell(4 * u.km, 1 * u.km), 8e9 * np.pi / 3),
    ):
        body = ba.RigidBody("B", shape, density=2000 * u.kg / u.m**3)
        found = facets.facets(body)
        assert np.linalg.det(found).sum() / 6 == pytest.approx(volume, rel=0.02)
    assert facets.facets(ba.RigidBody("P", ba.Point(), mass=1 * u.kg)).shape == (0, 3, 3)
    cloud = ba.PointCloud([[1, 0, 0], [-1, 0, 0], [0, 2, 0], [0, 0, 3], [0, -2, 0], [0, 0, -3]] * u.km)
    found = facets.facets(ba.RigidBody("C", cloud, mass=1e12 * u.kg))
    assert np.abs(found.mean(axis=(0, 1))).max() < 1  # m


def test_only_what_faces_the_eye_is_seen() -> None:
    seen = facets.seen(facets.sphere(36), np.array([0.0, 0.0, 1.0]))
    assert len(seen.corners) == len(facets.sphere(36)) / 2
    assert seen.depth.min() > 0
    area = np.linalg.det(seen.corners[:, 1:] - seen.corners[:, :1]).sum() / 2
    assert area == pytest.approx(np.pi, rel=0.02)
    brightest = seen.shade == seen.shade.max()
    assert seen.depth[brightest].min() > 0.95


@pytest.mark.parametrize(
    ("options", "line"),
    [
        ({"path": "a.avi"}, "expected a name that ends in .gif or .mp4"),
        ({"pictures": 0}, "pictures: expected a whole number, 1 or more, got 0"),
        ({"rate": 0.0}, "rate: expected a whole number, 1 to 240, got 0.0"),
        ({"axes": "body"}, "axes: expected 'inertial' or 'line', got 'body'"),
        ({"path": "no/a.gif"}, "there is no folder"),
        ({"run": 3}, "run: expected a ba.Trajectory, got 3"),
    ],
)
def test_what_it_refuses(
    run: ba.Trajectory, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, options: dict, line: str
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ba.BinaryastError, match=line):
        ba.animate(**{"run": run, "path": "a.gif"} | options)


def test_the_command(run: ba.Trajectory, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    run.write("day.h5")
    assert cli.main(["animate", "day.h5", "--pictures", "2"]) == 0
    assert capsys.readouterr().out.startswith("written: day.gif (0.1")
    assert cli.main(["animate", "day.h5", "-o", "day.gif"]) == 2
    assert "day.gif exists already" in capsys.readouterr().err
