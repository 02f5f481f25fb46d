"""What to cite for a run: the BibTeX of exactly what it used, each entry once, and why it is there."""

import re
from collections.abc import Iterator
from functools import cache
from importlib.resources import files
from typing import Any, NamedTuple

from binaryast import catalogue
from binaryast.adaptive import Adaptive
from binaryast.bodies import RigidBody
from binaryast.errors import InputError
from binaryast.integrators import LGVI, Integrator, KeplerSplitting, RungeKutta, Splitting, Stepping, Taylor
from binaryast.layered import Layered
from binaryast.scenario import Scenario
from binaryast.system import System
from binaryast.trajectory import Trajectory
from binaryast.unions import Union
from binaryast.units import brief

SCHEMES = {
    "leapfrog": "verlet1967",
    "yoshida4": "yoshida1990",
    "suzuki4": "suzuki1990",
    "kl6": "kahan1997",
    "kl8": "kahan1997",
    "ss10": "sofroniou2005",
    "rkn4": "blanes2002",
    "rkn6a": "blanes2002",
    "aba104": "blanes2013",
    "aba864": "blanes2013",
    "aba1064": "blanes2013",
}
METHODS: dict[type, tuple[str, ...]] = {
    LGVI: ("lee2007",),
    Splitting: ("touma1994",),
    KeplerSplitting: ("wisdom1991", "touma1994"),
    Taylor: ("biscani2021",),
}
RUNGE_KUTTA = {"DOP853": "hairer1993", "RK45": "dormand1980", "RK23": "bogacki1989"}
GRAVITIES = {"Multipole": "hou2017", "PolyhedronPoint": "werner1996", "EllipsoidPair": "chandrasekhar1969"}
SHAPES = {"Polyhedron": "dobrovolskis1996", "InertiaIntegrals": "davis2020"}
FORCES = {"TidalTorque": ("murray1999", "mignard1979"), "RadiationPressure": ("montenbruck2000",)}
LIBRARIES = ("numpy", "scipy", "astropy", "numba")
REFERS = re.compile(r"as in the entry (\w+)")


class Reference(NamedTuple):
    """One thing to cite: its key, for what, and its BibTeX."""

    key: str
    what: str
    text: str


def cite(run: Trajectory) -> str:
    """Return the BibTeX of exactly what a run used, to be pasted into a bibliography.

    The package; what the integrator and its scheme were published in; the models of gravity, of shapes and of what acts
    from outside that have a source; the sources of the catalogue's numbers, for bodies that are those of an entry; and
    the libraries that computed it. A comment before each entry says for what it is cited.

    Parameters
    ----------
    run : Trajectory

    Returns
    -------
    str

    Raises
    ------
    InputError
        For what is not a run.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> run = ba.propagate(system, state, duration=1 * u.h, integrator=ba.LGVI(step=40 * u.s))
    >>> print(ba.cite(run))
    % this package
    @software{binaryast,
    ...
    % the integrator LGVI
    @article{lee2007,
    ...
    """
    if not isinstance(run, Trajectory):
        raise InputError(f"cite: expected a ba.Trajectory, got {brief(run)}")
    found: dict[str, Reference] = {}
    for reference in references(run):
        found.setdefault(reference.key, reference)
    return "\n\n".join(f"% {one.what}\n{one.text}" for one in found.values()) + "\n"


def references(run: Trajectory) -> Iterator[Reference]:
    """Yield everything that a run used; some may come several times."""
    version = run.provenance.get("binaryast", "")
    yield of("binaryast", "this package", f"version = {{{version}}}" if version else "")
    yield from _of_method(run.integrator)
    for gravity in (pair.gravity for pair in run.system.pairs):
        parts = (gravity.near, gravity.far) if isinstance(gravity, Adaptive) else (gravity,)
        for kind in (type(part).__name__ for part in parts if part is not None):
            if kind in GRAVITIES:
                yield of(GRAVITIES[kind], f"the gravity {kind}")
    for body in run.system.bodies:
        for kind in _kinds(body.shape):
            if kind in SHAPES:
                yield of(SHAPES[kind], f"the mass moments of a {kind}")
    for kind in (type(one).__name__ for one in run.system.perturbations):
        for key in FORCES.get(kind, ()):
            yield of(key, f"the perturbation {kind}")
    yield from _of_catalogue(run)
    for name in LIBRARIES:
        yield of(name, f"computed with {name} {run.provenance.get(name, '')}".rstrip())


def _of_method(integrator: Integrator) -> Iterator[Reference]:
    """Yield what an integrator and its scheme were published in."""
    name = type(integrator).__name__
    for key in METHODS.get(type(integrator), ()):
        yield of(key, f"the integrator {name}")
    if isinstance(integrator, RungeKutta):
        yield of(RUNGE_KUTTA[integrator.method], f"the method {integrator.method}")
    if not isinstance(integrator, Stepping):
        return
    scheme = integrator.shares
    if not (isinstance(integrator, LGVI) and integrator.order == 2):  # which is the paper's own step
        yield of(SCHEMES[scheme.name], f"the scheme {scheme.name}")
    if integrator.changed is not None:
        yield note("corrector", f"the {integrator.changed.name}", integrator.changed.source)


def _kinds(shape: Any) -> Iterator[str]:
    """Yield the kinds of a shape and of all that it consists of."""
    yield type(shape).__name__
    if isinstance(shape, Layered):
        yield from _kinds(shape.outer)
        yield from _kinds(shape.inner)
    if isinstance(shape, Union):
        for part in shape.parts:
            yield from _kinds(part.shape)


def _of_catalogue(run: Trajectory) -> Iterator[Reference]:
    """Yield the sources of the numbers of a catalogue entry, if the bodies of a run are its own."""
    entries = [(name, catalogue.entry(name)) for name in catalogue.names()]
    fitting = [(name, entry) for name, entry in entries if _same_bodies(entry.system, run.system)]
    exact = [one for one in fitting if bool(one[1].impulses) == bool(run.impulses)]
    for name, entry in (exact or fitting)[:1]:
        yield from _sources(name, entry)


def _sources(name: str, entry: Scenario) -> Iterator[Reference]:
    """Yield the sources of an entry, and of the one that it refers to."""
    for number, source in enumerate(entry.sources, start=1):
        other = REFERS.fullmatch(source["source"])
        if other:
            yield from _sources(other.group(1), catalogue.entry(other.group(1)))
        else:
            yield note(f"{name}{number}", f"catalogue entry {name}: {source['what']}", source["source"])


def _same_bodies(one: System, two: System) -> bool:
    """Whether systems have the same bodies: names, masses, and moments of inertia."""
    return len(one.bodies) == len(two.bodies) and all(map(_same_body, one.bodies, two.bodies))


def _same_body(one: RigidBody, two: RigidBody) -> bool:
    return one.name == two.name and one.si.gm == two.si.gm and one.si.moments.tolist() == two.si.moments.tolist()


def of(key: str, what: str, more: str = "") -> Reference:
    """Return an entry of ``references.bib``, with one more line on request."""
    text = _entries()[key]
    return Reference(key, what, f"{text.removesuffix('}').rstrip()}\n  {more},\n}}" if more else text)


def note(key: str, what: str, source: str) -> Reference:
    """Return an entry for what is known as one text."""
    escaped = re.sub(r"([&%$#_])", r"\\\1", source)
    return Reference(key, what, f"@misc{{{key},\n  note = {{{escaped}}},\n}}")


@cache
def _entries() -> dict[str, str]:
    """Return the entries of ``references.bib`` by their keys."""
    text = (files("binaryast") / "references.bib").read_text(encoding="utf-8")
    return {key: entry for entry, key in re.findall(r"(@\w+\{(\w+),\n.*?\n\})", text, flags=re.DOTALL)}
