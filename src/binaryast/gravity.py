"""How a pair attracts: each model checks whether it can take two bodies, and gives a compiled function and parameters.

The paper's body 1 is the secondary, its body 2 the primary; U(X, R) is in the primary's frame.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from binaryast.bodies import RigidBody
from binaryast.compiling import Function, compiled
from binaryast.errors import InputError
from binaryast.kernels.mutual import ellipsoid_parameters
from binaryast.kernels.mutual.multipole_parameters import parameters_of, term_sizes
from binaryast.shapes import Ellipsoid, Sphere
from binaryast.units import Floats, brief, numbers
from binaryast.values import Value

LARGEST_DEGREE = 16  # of a multipole potential: beyond it, compiling takes longer than it is worth


class Gravity(Value, ABC):
    """A model of the mutual gravity of a pair.

    Attributes
    ----------
    limits : str
        Why it may give something that is not a number.
    """

    limits: str = "too near, too far, or a wrong potential"

    @property
    @abstractmethod
    def potential(self) -> Callable[..., Any]:
        """The compiled pair potential: U, dU/dX, M from (parameters, X, R)."""

    @property
    def cut_at(self) -> int | None:
        """The total degree at which the model ends; None where it is not a sum over degrees."""
        return None

    def potential_for(self, parameters: Floats) -> Callable[..., Any]:
        """Return the compiled pair potential that takes these parameters: `potential`, unless there are several."""
        return self.potential

    @abstractmethod
    def parameters(self, secondary: RigidBody, primary: RigidBody) -> Floats:
        """Return what the potential needs of the two bodies.

        Raises
        ------
        InputError
            Where the model cannot take these bodies.
        """

    def evaluation_time(self, secondary: RigidBody, primary: RigidBody) -> float:
        """Return about how long an evaluation takes [us], to compare methods: it chooses between them, no more."""
        return 10.0

    def check_place(self, secondary: RigidBody, primary: RigidBody, x: Floats, r: Floats) -> None:
        """Raise an `InputError` where the model cannot be asked at X (3,) [m] and R (3, 3); most always can.

        A run does not ask: it ends where surfaces touch.
        """

    def next_terms(self, secondary: RigidBody, primary: RigidBody, x: Floats, r: Floats) -> Floats | None:
        """Return the size of the next two terms of U that the model leaves out, over G m1 m2/r.

        Parameters
        ----------
        secondary, primary : RigidBody
            The pair.
        x, r : ndarray
            X (N, 3) [m] and R (N, 3, 3).

        Returns
        -------
        ndarray or None
            (N,); None of a model that is not cut at a degree, or where the moments are not known so far or not finite.
        """
        if self.cut_at is None:
            return None
        try:
            parameters = _multipole_parameters(secondary, primary, self.cut_at + 2)
        except InputError:
            return None
        with np.errstate(all="ignore"):
            sizes = term_sizes(parameters, self.cut_at + 2, x, r)
        return sizes if np.all(np.isfinite(sizes)) else None


@dataclass(frozen=True, eq=False)
class PointMass(Gravity):
    """Two point masses: bodies that attract like spheres and turn freely.

    Examples
    --------
    >>> import binaryast as ba
    >>> ba.PointMass()
    PointMass()
    """

    @property
    def potential(self) -> Callable[..., Any]:
        """The compiled pair potential."""
        from binaryast.kernels.mutual.point_mass import potential

        return potential

    def evaluation_time(self, secondary: RigidBody, primary: RigidBody) -> float:
        """Return about how long an evaluation takes [us]."""
        return 0.02

    def parameters(self, secondary: RigidBody, primary: RigidBody) -> Floats:
        """Return G m1 m2."""
        return np.array([secondary.si.gm * primary.si.mass])


@dataclass(frozen=True, eq=False)
class SecondDegree(Gravity):
    """MacCullagh's field of both bodies: monopoles, and each body's second-degree moments on the other's mass.

    It needs nothing but masses and moments of inertia, so it takes every body.

    Examples
    --------
    >>> import binaryast as ba
    >>> ba.SecondDegree()
    SecondDegree()
    """

    @property
    def potential(self) -> Callable[..., Any]:
        """The compiled pair potential."""
        from binaryast.kernels.mutual.second_degree import potential

        return potential

    def evaluation_time(self, secondary: RigidBody, primary: RigidBody) -> float:
        """Return about how long an evaluation takes [us]."""
        return 0.04

    def parameters(self, secondary: RigidBody, primary: RigidBody) -> Floats:
        """Return G m1 m2, G m2 J1 (3), G m1 J2 (3)."""
        one, two = secondary.si, primary.si
        return np.concatenate([[one.gm * two.mass], two.gm * one.moments, one.gm * two.moments])

    @property
    def cut_at(self) -> int:
        """The degree at which it ends."""
        return 2


@dataclass(frozen=True, eq=False)
class Multipole(Gravity):
    """The mass moments of both bodies up to a total degree N: what remains falls off as (size/r)^(N + 1).

    All terms are taken whose degrees in the two bodies add up to N or less. Degree 2 is that of `SecondDegree`. The sum
    converges where spheres about the mass centres that hold the bodies do not meet; nearer it may, and a run says how
    large its next terms are (`Trajectory.max_next_degree_term`).

    Parameters
    ----------
    degree : int
        N, from 2 to `LARGEST_DEGREE`, 16. Degree 1 vanishes, because bodies are about their mass centres.

    Raises
    ------
    InputError
        For another degree; from `System`, where a body's moments are not known up to it.

    References
    ----------
    The sum over moments is that of solid harmonics, see ``kernels/mutual/multipole.py``; with inertia integrals it is
    given by X. Hou, D. J. Scheeres, X. Xin, Celest. Mech. Dyn. Astron. 127 (2017) 369-395.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> bodies = [ba.RigidBody(n, ba.Ellipsoid(5 * u.m, 4 * u.m, 3 * u.m), mass=1e6 * u.kg) for n in "AB"]
    >>> for degree in (2, 4, 6, 8):
    ...     print(ba.System(bodies, ba.Multipole(degree)).mutual_gravity([12, 0, 0] * u.m).energy.round(4))
    -5.755 J
    -5.773 J
    -5.7754 J
    -5.7759 J
    """

    degree: int

    def __post_init__(self) -> None:
        whole = isinstance(self.degree, (int, np.integer)) and not isinstance(self.degree, bool)
        if not whole or not 2 <= self.degree <= LARGEST_DEGREE:
            raise InputError(
                f"Multipole: degree: expected a whole number from 2 to {LARGEST_DEGREE}, got {brief(self.degree)}"
                + (": for point masses there is ba.PointMass()" if whole and 0 <= self.degree < 2 else "")
            )
        self._set(degree=int(self.degree))

    @property
    def potential(self) -> Callable[..., Any]:
        """The compiled pair potential for all bodies."""
        from binaryast.kernels.mutual.multipole_kernels import potential_of

        return potential_of(self.degree, even=False)

    def potential_for(self, parameters: Floats) -> Callable[..., Any]:
        """Return the compiled pair potential for these bodies: a faster one, where odd moments vanish."""
        from binaryast.kernels.mutual.multipole_kernels import kernel_for

        return kernel_for(parameters, self.degree)

    def evaluation_time(self, secondary: RigidBody, primary: RigidBody) -> float:
        """Return about how long an evaluation takes [us]."""
        return float(0.02 + 0.002 * self.degree**2.2)

    def parameters(self, secondary: RigidBody, primary: RigidBody) -> Floats:
        """Return G m1 m2 and the moments of both bodies."""
        return _multipole_parameters(secondary, primary, self.degree)

    @property
    def cut_at(self) -> int:
        """The degree at which it ends."""
        return self.degree


def _multipole_parameters(secondary: RigidBody, primary: RigidBody, degree: int) -> Floats:
    """Return what the multipole kernels need; infinite where sizes are beyond what can be computed with."""
    with np.errstate(over="ignore", invalid="ignore"):
        return parameters_of(
            secondary.si.gm * primary.si.mass, secondary.moments(degree), primary.moments(degree), degree
        )


@dataclass(frozen=True, eq=False)
class PointPairs(Gravity):
    """Every point of one body attracts every point of the other: exact for dumbbells, point clouds and spheres.

    Examples
    --------
    >>> import binaryast as ba
    >>> ba.PointPairs()
    PointPairs()
    """

    @property
    def potential(self) -> Callable[..., Any]:
        """The compiled pair potential."""
        from binaryast.kernels.mutual.points import potential

        return potential

    def evaluation_time(self, secondary: RigidBody, primary: RigidBody) -> float:
        """Return about how long an evaluation takes [us]."""
        return 0.04 + 0.001 * len(_points(secondary)[1]) * len(_points(primary)[1])

    def potential_for(self, parameters: Floats) -> Callable[..., Any]:
        """Return the compiled pair potential for these bodies: of eight points at a time, where there are so many."""
        from binaryast.kernels.mutual import point_octets, points

        fast: Callable[..., Any] = point_octets.potential
        return fast if parameters[0] >= point_octets.LANES else points.potential

    def parameters(self, secondary: RigidBody, primary: RigidBody) -> Floats:
        """Return the counts, and the coordinates and masses of the points of both bodies."""
        (x1, f1), (x2, f2) = _points(secondary), _points(primary)
        gm1, m2 = f1 * secondary.si.gm, f2 * primary.si.mass
        return np.concatenate([[len(f1), len(f2)], x1.T.ravel(), gm1, x2.T.ravel(), m2])


def _points(body: RigidBody) -> tuple[Floats, Floats]:
    """Return a body's points, or say that it has none."""
    if body.points is None:
        raise InputError(
            f"PointPairs: {body.name}, of shape {type(body.shape).__name__}, is not a set of points: "
            "use gravity=ba.Multipole(4), or fill the shape with points, ba.mascons"
        )
    return body.points


@dataclass(frozen=True, eq=False)
class EllipsoidPair(Gravity):
    """Two homogeneous ellipsoids or spheres exactly, at any separation up to contact.

    The field of one is in closed form, Carlson's elliptic integrals; its mean over the other is a sum over nodes on
    that one's focal disc, as many as its place and attitude need for an error of round-off: some 20 far away, one for a
    sphere, a thousand for two elongated bodies in contact. The force and the moment are the derivatives of that sum.

    Raises
    ------
    InputError
        From `System`, for bodies that are not homogeneous ellipsoids or spheres, or too thin to be resolved at contact;
        from `System.mutual_gravity`, for bodies that overlap.

    References
    ----------
    The potential: NIST Digital Library of Mathematical Functions, 19.33. Means over confocal ellipsoids: Maclaurin's
    theorem, as in S. Chandrasekhar, Ellipsoidal Figures of Equilibrium (1969), chapter 3. See
    ``kernels/mutual/ellipsoid_parameters.py``.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> bodies = [ba.RigidBody(n, ba.Ellipsoid(5 * u.m, 4 * u.m, 3 * u.m), mass=1e6 * u.kg) for n in "AB"]
    >>> print(ba.System(bodies, ba.EllipsoidPair()).mutual_gravity([12, 0, 0] * u.m).energy.round(4))
    -5.776 J
    """

    @property
    def potential(self) -> Callable[..., Any]:
        """The compiled pair potential."""
        from binaryast.kernels.mutual.ellipsoids import potential

        return potential

    def parameters(self, secondary: RigidBody, primary: RigidBody) -> Floats:
        """Return G m1 m2, the axes, and nodes for all separations."""
        axes = _semi_axes(secondary), _semi_axes(primary)
        result = ellipsoid_parameters.parameters_of(secondary.si.gm * primary.si.mass, *axes)
        if not result.size:
            raise InputError(
                f"EllipsoidPair: {primary.name} and {secondary.name} are too thin: at contact they would need more "
                f"than {ellipsoid_parameters.LARGEST_RULE} nodes; use ba.Multipole(8), or axes less far from equal"
            )
        return result

    def check_place(self, secondary: RigidBody, primary: RigidBody, x: Floats, r: Floats) -> None:
        """Raise where the bodies overlap: where the function of Perram and Wertheim is nowhere above 1."""
        one, two = (np.diag(_semi_axes(body) ** 2) for body in (secondary, primary))
        s = np.linspace(0, 1, 1001)[1:-1, None, None]
        between = np.linalg.solve((1 - s) * two + s * (r @ one @ r.T), x[:, None])[..., 0] @ x
        if np.max(s[:, 0, 0] * (1 - s[:, 0, 0]) * between) < 1:
            raise InputError(
                f"EllipsoidPair: {primary.name} and {secondary.name} overlap at X = {brief(x)} m, "
                f"{np.linalg.norm(x):g} m apart: expected bodies that do not touch"
            )


def _semi_axes(body: RigidBody) -> Floats:
    """Return the semi-axes (3,) of a homogeneous ellipsoid, or say that the body is none."""
    if not isinstance(body.shape, (Ellipsoid, Sphere)):
        raise InputError(
            f"EllipsoidPair: {body.name} has the shape {type(body.shape).__name__}, which is no ellipsoid: "
            "use gravity=ba.Multipole(8), or give it an Ellipsoid or a Sphere"
        )
    if "inertia" in body.given:
        raise InputError(
            f"EllipsoidPair: {body.name} was given an inertia of its own, so it is not homogeneous: leave inertia= "
            "out, or use gravity=ba.Multipole(8)"
        )
    return body.shape.pieces[0][1]


@dataclass(frozen=True, eq=False)
class PairPotential(Gravity):
    """A mutual potential that the user wrote.

    Parameters
    ----------
    function : callable
        A function compiled by `binaryast.pair_potential`.
    values : sequence of float
        Its parameters ``p``, in SI.

    Examples
    --------
    >>> import binaryast as ba
    >>> @ba.pair_potential
    ... def kepler(p, x, y, z, r11, r12, r13, r21, r22, r23, r31, r32, r33):
    ...     r = (x * x + y * y + z * z) ** 0.5
    ...     w = p[0] / r**3
    ...     return -p[0] / r, w * x, w * y, w * z, 0.0, 0.0, 0.0
    >>> gravity = ba.PairPotential(kepler, [1e10])
    """

    function: Callable[..., Any] | str
    values: Sequence[float] = ()

    def __post_init__(self) -> None:
        from binaryast.kernels.jit import PAIR_POTENTIAL

        if not isinstance(self.function, str) and PAIR_POTENTIAL.args not in getattr(self.function, "overloads", {}):
            raise InputError(
                f"PairPotential: {brief(self.function)} is not compiled: decorate it with @ba.pair_potential"
            )
        count = len(self.values) if isinstance(self.values, (Sequence, np.ndarray)) else 0
        self._set(values=numbers(self.values, "PairPotential: values", (count,)).copy())

    @property
    def potential(self) -> Callable[..., Any]:
        """The compiled pair potential."""
        if isinstance(self.function, str):  # read from a file on which only the name could be kept
            raise InputError(
                f"PairPotential: the function {self.function} cannot be imported here: build the system anew"
            )
        return self.function

    def parameters(self, secondary: RigidBody, primary: RigidBody) -> Floats:
        """Return the user's parameters."""
        return np.array(self.values)


def pair_potential(function: Function) -> Function:
    """Compile a user's mutual potential of a pair, for `binaryast.PairPotential`.

    Parameters
    ----------
    function : callable
        ``function(p, x, y, z, r11, r12, r13, r21, r22, r23, r31, r32, r33)``: parameters ``p`` (float array), the
        secondary's centre X [m] and attitude R (row by row) in the primary's frame. It returns seven floats: U [J],
        dU/dX [N] and the moment M [N m] of equation (54) of Lee, Leok and McClamroch (2007), which is minus the torque
        on the secondary, in the primary's frame.

    Returns
    -------
    callable
        The compiled function. It can still be called from Python.

    Raises
    ------
    InputError
        Where numba cannot compile it to that signature.

    Examples
    --------
    >>> import binaryast as ba
    >>> @ba.pair_potential
    ... def kepler(p, x, y, z, r11, r12, r13, r21, r22, r23, r31, r32, r33):
    ...     r = (x * x + y * y + z * z) ** 0.5
    ...     w = p[0] / r**3
    ...     return -p[0] / r, w * x, w * y, w * z, 0.0, 0.0, 0.0
    """
    from binaryast.kernels.jit import PAIR_POTENTIAL

    expected = "13 arguments (p, x, y, z, r11 .. r33) and seven floats as the result"
    return compiled(function, PAIR_POTENTIAL, "pair_potential", expected)
