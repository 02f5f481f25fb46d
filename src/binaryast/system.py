"""A system: bodies and how each pair of them attracts, checked once."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np
from astropy.units import Quantity

from binaryast import markup
from binaryast.bodies import RigidBody
from binaryast.errors import InputError, did_you_mean
from binaryast.gravity import Gravity, SecondDegree
from binaryast.perturbations import Perturbation
from binaryast.rotations import rotation
from binaryast.units import Floats, brief, quantity, to_si
from binaryast.values import Value

OTHERS = "others"  # in a table of gravities: the pairs that it does not name


class Pair(NamedTuple):
    """Two of the bodies, by index, how they attract, and what the potential needs to know of them."""

    primary: int
    secondary: int
    gravity: Gravity
    parameters: Floats

    @property
    def potential(self) -> Callable[..., Any]:
        """The compiled pair potential that takes these parameters."""
        return self.gravity.potential_for(self.parameters)


@dataclass(frozen=True, eq=False)
class MutualGravity:
    """The mutual gravity of a pair in one configuration; vectors are in the primary's frame.

    Attributes
    ----------
    energy : Quantity
        U [J].
    gradient : Quantity
        dU/dX (3,) [N].
    moment : Quantity
        The paper's M (3,), equation (54) [N m].
    force_on_secondary, torque_on_secondary, torque_on_primary : Quantity
        -dU/dX, -M and X x dU/dX + M (3,), each torque about that body's mass centre.
    """

    energy: Quantity
    gradient: Quantity
    moment: Quantity
    force_on_secondary: Quantity
    torque_on_secondary: Quantity
    torque_on_primary: Quantity


@dataclass(frozen=True, eq=False)
class System(Value):
    """Bodies under mutual gravity.

    Parameters
    ----------
    bodies : sequence of RigidBody
        Two or more. Of a pair, index 0 is the primary (the paper's body 2), which owns the relative frame; index 1 the
        secondary (body 1). Of each pair among several, the one with the lower index is the primary.
    gravity : Gravity, mapping or sequence
        How the bodies attract: one model for every pair, `SecondDegree` by default; or a table of models by pairs of
        names, where ``"others"`` stands for the pairs that are not named; or a sequence in the order of `pairs`.
    perturbations : sequence of Perturbation
        What else acts: `Sun`, `Planet`, `Flyby`, `ThirdBody`, `TidalTorque`, `Yorp`, `Byorp`, `RadiationPressure`, or
        an `ExternalPotential` or a `Force` of your own.

    Attributes
    ----------
    pairs : tuple of Pair
        Index of the primary and of the secondary, gravity and its parameters, for (0, 1), (0, 2), .., (1, 2), ...;
        there is none of two bodies that do not pull.

    Raises
    ------
    InputError
        For fewer than two bodies, names that are not unique, a pair without gravity, or a gravity that cannot take its
        bodies.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> one, two = (ba.RigidBody(n, ba.Sphere(1 * u.km), mass=1e12 * u.kg) for n in ("one", "two"))
    >>> system = ba.System([one, two])
    >>> attraction = system.mutual_gravity(position=[10, 0, 0] * u.km)
    >>> print(attraction.gradient)
    [667430.      0.      0.] N

    A spacecraft beside them, each pair with its own gravity:

    >>> craft = ba.RigidBody("craft", ba.Point(), mass=12 * u.kg)
    >>> three = ba.System([one, two, craft], gravity={("one", "two"): ba.SecondDegree(), "others": ba.PointMass()})
    >>> [(pair.primary, pair.secondary, pair.gravity) for pair in three.pairs]
    [(0, 1, SecondDegree()), (0, 2, PointMass()), (1, 2, PointMass())]
    """

    bodies: Sequence[RigidBody]
    gravity: Any = field(default_factory=SecondDegree)
    perturbations: Sequence[Perturbation] = ()
    pairs: tuple[Pair, ...] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        bodies = _checked_bodies(self.bodies)
        self._set(bodies=bodies)
        self._set(perturbations=_checked_perturbations(self.perturbations, bodies))
        count = range(len(bodies))
        indices = [(i, j) for i, j in combinations(count, 2) if bodies[i].pulls or bodies[j].pulls]
        models = [self.gravity] * len(indices)
        if isinstance(self.gravity, Mapping):
            models = _models_by_names(self.gravity, [(bodies[i].name, bodies[j].name) for i, j in indices])
        elif isinstance(self.gravity, Sequence) and not isinstance(self.gravity, str):
            models = list(self.gravity)
            if len(models) != len(indices):
                raise InputError(
                    f"System: gravity: {len(bodies)} bodies make {len(indices)} pairs, got {len(models)} models"
                )
        for model in models:
            if not isinstance(model, Gravity):
                raise InputError(f"System: gravity: expected a model such as ba.SecondDegree(), got {brief(model)}")
        if not isinstance(self.gravity, Gravity):
            self._set(gravity=tuple(models))
        pairs = []
        for (i, j), model in zip(indices, models, strict=True):
            parameters = model.parameters(bodies[j], bodies[i])
            if not np.all(np.isfinite(parameters)):
                raise InputError("System: the masses or sizes are beyond what can be computed with")
            parameters.flags.writeable = False
            pairs.append(Pair(i, j, model, parameters))
        self._set(pairs=tuple(pairs))

    @property
    def parameters(self) -> Floats:
        """What the potential of a pair needs of its bodies: a copy, for compiled functions take no read-only array."""
        return self._only_pair("parameters").parameters.copy()

    @property
    def primary(self) -> RigidBody:
        """The paper's body 2; of several bodies, the first."""
        return self.bodies[0]

    @property
    def secondary(self) -> RigidBody:
        """The paper's body 1."""
        self._only_pair("secondary")
        return self.bodies[1]

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the bodies."""
        return tuple(body.name for body in self.bodies)

    @property
    def reduced_mass(self) -> float:
        """The paper's m = m1 m2/(m1 + m2) of a pair [kg]."""
        self._only_pair("reduced_mass")
        one, two = self.bodies[1].si.mass, self.bodies[0].si.mass
        return one * two / (one + two)

    def _repr_html_(self) -> str:
        """Return what a notebook shows."""
        return markup.system(self)

    def index(self, body: str | int) -> int:
        """Return the index of a body given by its name or index.

        Raises
        ------
        InputError
            Where there is none; the nearest name is shown.
        """
        if isinstance(body, str) and body in self.names:
            return self.names.index(body)
        if isinstance(body, (int, np.integer)) and not isinstance(body, bool) and 0 <= body < len(self.bodies):
            return int(body)
        near = did_you_mean(body, self.names) if isinstance(body, str) else ""
        raise InputError(f"{brief(repr(body))} is no body of this system{near}; it has {', '.join(self.names)}")

    def pair(self, primary: str | int, secondary: str | int) -> "System":
        """Return the system of two of the bodies alone, given by names or indices, with their own gravity.

        Examples
        --------
        >>> import binaryast as ba
        >>> system, _ = ba.catalogue.load("sn263")
        >>> system.pair("Alpha", "Gamma").names
        ('Alpha', 'Gamma')
        """
        i, j = self.index(primary), self.index(secondary)
        if i == j:
            raise InputError(f"pair: {self.names[i]} twice: expected two bodies")
        model = next((pair.gravity for pair in self.pairs if {pair.primary, pair.secondary} == {i, j}), None)
        if model is None:
            raise InputError(f"pair: {self.names[i]} and {self.names[j]} do not pull: expected one that does")
        acting = [one for one in self.perturbations if one.concerns((self.names[i], self.names[j]))]
        return System([self.bodies[i], self.bodies[j]], gravity=model, perturbations=acting)

    def _only_pair(self, what: str) -> Pair:
        """Return the pair, or say that there are several."""
        if len(self.bodies) > 2:
            names = ", ".join(repr(name) for name in self.names[:2])
            raise InputError(
                f"{what}: of two bodies; this system has {len(self.bodies)}: choose two, such as system.pair({names})"
            )
        return self.pairs[0]

    def attraction(self, x: Floats, r: Floats, pair: Pair | None = None) -> tuple[float, ...]:
        """Return U, dU/dX (3) and M (3) of one of the pairs at X (3,) and R (3, 3), all plain SI floats.

        Raises
        ------
        InputError
            Where the potential gives something that is not a number, or raises.
        """
        pair = pair or self._only_pair("attraction")
        try:
            values: tuple[float, ...] = pair.potential(pair.parameters.copy(), *x, *r.ravel())
        except InputError:
            raise
        except Exception as error:  # whatever a user's function raises
            raise InputError(f"gravity: the potential raised {type(error).__name__}: {brief(error)}") from None
        if not np.all(np.isfinite(values)):
            raise InputError(f"gravity: at X = {brief(x)} m it is not a number: {pair.gravity.limits}")
        return values

    def mutual_gravity(self, position: Quantity, attitude: Any = None) -> MutualGravity:
        """Return energy, force and torques of one configuration of a pair.

        Parameters
        ----------
        position : Quantity
            X (3,): the secondary's mass centre in the primary's frame (length).
        attitude : array-like or Rotation, optional
            R (3, 3): secondary's body frame -> primary's; the identity by default.

        Returns
        -------
        MutualGravity

        Raises
        ------
        InputError
            For an attitude that is not a rotation, coinciding mass centres, bodies that overlap where gravity cannot
            take it, or a system of several bodies.
        """
        self._only_pair("mutual_gravity")
        x = to_si(position, "m", "position", shape=(3,))
        if not np.any(x):
            raise InputError("position: the mass centres coincide: expected a position that is not zero")
        r = np.eye(3) if attitude is None else rotation(attitude, "attitude", ())
        self.pairs[0].gravity.check_place(self.secondary, self.primary, x, r)
        u, *rest = self.attraction(x, r)
        gradient, moment = np.array(rest[:3]), np.array(rest[3:])
        return MutualGravity(
            energy=quantity(u, "J"),
            gradient=quantity(gradient, "N"),
            moment=quantity(moment, "N m"),
            force_on_secondary=quantity(-gradient, "N"),
            torque_on_secondary=quantity(-moment, "N m"),
            torque_on_primary=quantity(np.cross(x, gradient) + moment, "N m"),
        )


def _checked_bodies(bodies: Any) -> tuple[RigidBody, ...]:
    """Return bodies as a tuple, after a look at what they are."""
    if not isinstance(bodies, Sequence):
        raise InputError(f"System: bodies: expected a list of ba.RigidBody, primary first, got {brief(bodies)}")
    for body in bodies:
        if not isinstance(body, RigidBody):
            raise InputError(f"System: bodies: expected ba.RigidBody, got {brief(body)}")
    if not any(body.pulls for body in bodies):
        raise InputError("System: bodies: none of them pulls: expected at least one with pulls=True")
    if len(bodies) < 2:
        raise InputError(f"System: bodies: expected at least two, primary first; got {len(bodies)}")
    names = [body.name for body in bodies]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"System: two bodies are called {name!r}: give each its own name")
    return tuple(bodies)


def _checked_perturbations(perturbations: Any, bodies: Sequence[RigidBody]) -> tuple[Perturbation, ...]:
    """Return perturbations as a tuple, after a look at what they are and whether they can act on these bodies."""
    if isinstance(perturbations, Perturbation) or not isinstance(perturbations, Sequence):
        raise InputError(f"System: perturbations: expected a list such as [ba.Sun(...)], got {brief(perturbations)}")
    for perturbation in perturbations:
        if not isinstance(perturbation, Perturbation):
            raise InputError(f"System: perturbations: expected such as ba.Sun(...), got {brief(perturbation)}")
        perturbation.check(bodies)
    return tuple(perturbations)


def _models_by_names(table: Mapping[Any, Any], pairs: list[tuple[str, str]]) -> list[Any]:
    """Return the model of each pair from a table by pairs of names, in either order."""
    named: dict[Any, Any] = {OTHERS: table.get(OTHERS)}
    for key, model in table.items():
        if key == OTHERS:
            continue
        ordered = key if key in pairs else tuple(reversed(key)) if isinstance(key, tuple) else key
        if ordered not in pairs:
            shown = ", ".join(repr(pair) for pair in pairs[:3])
            raise InputError(
                f"System: gravity: {key!r} is no pair of these bodies: expected such as {shown}, or 'others'"
            )
        if ordered in named:
            raise InputError(f"System: gravity: the pair {key!r} is given twice")
        named[ordered] = model
    for pair in pairs:
        if named.get(pair, named[OTHERS]) is None:
            raise InputError(f"System: gravity: nothing is said of {pair!r}: add it, or a model for 'others'")
    return [named.get(pair, named[OTHERS]) for pair in pairs]
