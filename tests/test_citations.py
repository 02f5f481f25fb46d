"""What is to be cited for a run: what it used, and nothing else."""

import re
from typing import Any

import astropy.units as u
import pytest

import binaryast as ba
from binaryast import citations, schemes

LIBRARIES = {"numpy", "scipy", "astropy", "numba"}


def keys(text: str) -> list[str]:
    return re.findall(r"^@\w+\{(\w+),$", text, flags=re.MULTILINE)


def cited(integrator: ba.LGVI | None = None, gravity: Any = None, **more: Any) -> list[str]:
    """Return the keys of a short run of two bodies of no catalogue, less the package's and the libraries'."""
    shape = more.pop("shape", ba.Ellipsoid(500 * u.m, 450 * u.m, 400 * u.m))
    bodies = [ba.RigidBody(name, shape, mass=1e12 * u.kg) for name in ("one", "two")]
    system = ba.System(bodies, gravity=gravity or ba.SecondDegree(), perturbations=more.pop("perturbations", ()))
    state = ba.State.circular_orbit(system, separation=5 * u.km, spins=[5 * u.h, 5 * u.h])
    run = ba.propagate(system, state, duration=100 * u.s, integrator=integrator or ba.LGVI(20 * u.s), **more)
    first, *rest = keys(ba.cite(run))
    assert first == "binaryast"
    assert set(rest) >= LIBRARIES
    return [key for key in rest if key not in LIBRARIES]


@pytest.mark.parametrize(
    ("integrator", "expected"),
    [
        (ba.LGVI(20 * u.s), ["lee2007"]),
        (ba.LGVI(20 * u.s, order=8), ["lee2007", "kahan1997"]),
        (ba.LGVI(20 * u.s, scheme="yoshida4"), ["lee2007", "yoshida1990"]),
        (ba.Splitting(20 * u.s), ["touma1994", "blanes2002"]),
        (ba.KeplerSplitting(20 * u.s), ["wisdom1991", "touma1994", "blanes2013"]),
        (
            ba.KeplerSplitting(20 * u.s, scheme="aba104", corrector=True),
            ["wisdom1991", "touma1994", "blanes2013", "corrector"],
        ),
        (ba.RungeKutta(), ["hairer1993"]),
    ],
)
def test_integrators(integrator: Any, expected: list[str]) -> None:
    assert cited(integrator) == expected


def test_gravity_and_shapes() -> None:
    assert cited(gravity=ba.Multipole(4)) == ["lee2007", "hou2017"]
    assert cited(gravity=ba.EllipsoidPair()) == ["lee2007", "chandrasekhar1969"]
    corners = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]] * u.km
    faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
    assert cited(shape=ba.Polyhedron(corners, faces)) == ["lee2007", "dobrovolskis1996"]


def test_what_acts_from_outside() -> None:
    tide = ba.TidalTorque("one", raised_by="two", love_number=1e-5, quality_factor=100)
    assert cited(perturbations=[tide]) == ["lee2007", "murray1999", "mignard1979"]


def test_the_catalogue_s_sources() -> None:
    system, state = ba.catalogue.load("didymos")
    run = ba.propagate(system, state, duration=1 * u.h, integrator=ba.LGVI(40 * u.s))
    text = ba.cite(run)
    assert [key for key in keys(text) if key.startswith("didymos")] == [
        f"didymos{i + 1}" for i in range(len(ba.catalogue.entry("didymos").sources))
    ]
    assert "% catalogue entry didymos: GM of both bodies" in text
    assert r"didymos\_system\_15.tpc (JPL)" in text
    entry = ba.catalogue.entry("dart")
    hit = ba.propagate(
        entry.system, entry.state, duration=3 * u.day, integrator=ba.LGVI(40 * u.s), impulses=entry.impulses
    )
    found = keys(ba.cite(hit))
    assert {"dart2", "dart4", "didymos1"} <= set(found)
    assert len(found) == len(set(found))


def test_every_scheme_has_its_source() -> None:
    entries = citations._entries()
    named = schemes.COMPOSITIONS | schemes.SPLITTINGS | schemes.KEPLER_SPLITTINGS
    assert set(citations.SCHEMES) == set(named)
    for name, scheme in named.items():
        entry = entries[citations.SCHEMES[name]]
        surname, year = (
            re.match(r"(?:\S+\. )+([A-Z]\w+)", scheme.source).group(1),
            re.search(r"\((\d{4})\)", scheme.source),
        )
        assert surname in entry
        assert f"year = {{{year.group(1)}}}" in entry
        volume, page = re.search(r"(\d+) \(\d{4}\) (\d+)", scheme.source).groups()
        assert f"volume = {{{volume}}}" in entry
        assert f"pages = {{{page}--" in entry


def test_the_file_is_sound() -> None:
    entries = citations._entries()
    values = [citations.METHODS, citations.FORCES]
    used = {key for table in values for some in table.values() for key in some}
    for table in (citations.SCHEMES, citations.RUNGE_KUTTA, citations.GRAVITIES, citations.SHAPES):
        used |= set(table.values())
    assert set(entries) == used | LIBRARIES | {"binaryast"}
    for text in entries.values():
        assert text.count("{") == text.count("}")
        assert ("year" in text) or text.startswith("@software")


def test_versions_are_those_of_the_run() -> None:
    system, state = ba.catalogue.load("dumbbells")
    run = ba.propagate(system, state, duration=0.01 * u.s, integrator=ba.LGVI(0.001 * u.s))
    text = ba.cite(run)
    assert f"version = {{{ba.__version__}}}" in text
    assert f"% computed with numpy {run.provenance['numpy']}" in text
    with pytest.raises(ba.BinaryastError, match=r"cite: expected a ba.Trajectory"):
        ba.cite(run[0])
