"""What every perturbation has in common."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import Any, ClassVar, NamedTuple

import numpy as np
from astropy.time import Time
from astropy.units import Quantity

from binaryast.bodies import RigidBody
from binaryast.errors import InputError, did_you_mean
from binaryast.units import Floats, brief
from binaryast.values import Value


class Span(NamedTuple):
    """The time for which something acts.

    Attributes
    ----------
    begin, end : float
        In the time of the run [s].
    epoch : Time or None
        When that time is zero.
    frame : str
        The inertial axes of the run.
    """

    begin: float
    end: float
    epoch: Time | None
    frame: str

    def time_of(self, epoch: Time | None, what: str) -> float:
        """Return an epoch in the time of the run [s]; the start of the run where there is none."""
        if epoch is None:
            return 0.0
        if self.epoch is None:
            raise InputError(f"{what}: it has an epoch, the state has none: give ba.State an epoch=, or leave this out")
        return float((epoch - self.epoch).to_value("s"))


class Perturbation(Value, ABC):
    """What acts on the bodies of a system from outside; for `binaryast.System`.

    Attributes
    ----------
    conservative : bool
        Whether it has a potential, which may change with time: it is then part of the energy.
    """

    conservative: ClassVar[bool]

    @property
    @abstractmethod
    def kernel(self) -> Callable[..., Any]:
        """The compiled function: of a potential where it is conservative, else of a force."""

    @abstractmethod
    def check(self, bodies: Sequence[RigidBody]) -> None:
        """Raise an `InputError` where it cannot act on these bodies."""

    @abstractmethod
    def parameters(self, bodies: Sequence[RigidBody], span: Span) -> Floats:
        """Return what the function needs to know."""

    def check_start(self, bodies: Sequence[RigidBody], position: Floats, span: Span) -> None:
        """Raise an `InputError` where it cannot act on bodies at positions (n, 3) [m] about their barycentre."""

    def concerns(self, names: Sequence[str]) -> bool:
        """Whether it can act where there are only the bodies of these names."""
        named = (getattr(self, key, None) for key in ("body", "raised_by", "about"))
        return all(name in names for name in named if name is not None)

    def __repr__(self) -> str:
        said = (f"{key}={_short(value)}" for key, value in self.arguments().items() if value is not None)
        return f"{type(self).__name__}({', '.join(said)})"


def _short(value: Any) -> str:
    """Return a value in few words."""
    if isinstance(value, Quantity):
        return str(value) if value.ndim == 0 else f"{value.shape} in {value.unit}"
    return brief(repr(value))


def index_of(name: Any, bodies: Sequence[RigidBody], where: str) -> int:
    """Return the index of a body given by its name."""
    names = [body.name for body in bodies]
    if not isinstance(name, str) or name not in names:
        near = did_you_mean(str(name), names)
        raise InputError(f"{where}: {brief(repr(name))} is no body of this system{near}; it has {', '.join(names)}")
    return names.index(name)


def radius_of(body: RigidBody, given: Quantity | None, where: str) -> float:
    """Return a radius [m]: the one given, or that of a ball of the body's volume."""
    if given is not None:
        return float(given.value)
    if body.shape.volume is None:
        raise InputError(f"{where}: {type(body.shape).__name__} has no volume: give radius=")
    return float(np.cbrt(0.75 / np.pi * body.shape.volume))
