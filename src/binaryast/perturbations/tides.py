"""Tides that lag behind."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from astropy.units import Quantity

from binaryast.bodies import RigidBody
from binaryast.constants import G
from binaryast.errors import InputError
from binaryast.perturbations.base import Perturbation, Span, index_of, radius_of
from binaryast.units import Floats, numbers, quantity, to_si

SLOW = 1e-3  # of the mean motion: a body that turns so little beside the other has no lag angle to speak of


@dataclass(frozen=True, eq=False, repr=False)
class TidalTorque(Perturbation):
    """The tide that one body raises on another, which lags behind: the torque on it, and the force on both.

    What a tide does without lag, a change of the force between them, is left out.

    Parameters
    ----------
    body, raised_by : str
        The names of both bodies.
    love_number : float
        k2 of the body that is raised; 0 has no tide.
    quality_factor : float, optional
        Q: a constant lag angle epsilon, with 1/Q = sin 2 epsilon. Below a thousandth of the orbital motion, in the
        turning of the body beside the other, the torque falls to zero.
    time_lag : Quantity, optional
        In its place a constant lag in time.
    radius : Quantity, optional
        Of the body; by default that of a ball of its volume.

    Raises
    ------
    InputError
        For a Love number below 0, Q below 1, both lags or none, bodies that are not in the system.

    References
    ----------
    C. D. Murray, S. F. Dermott, Solar System Dynamics (1999), section 4.9; F. Mignard, Moon and Planets 20 (1979) 301.

    Examples
    --------
    >>> import binaryast as ba
    >>> tide = ba.TidalTorque("Didymos", raised_by="Dimorphos", love_number=1e-5, quality_factor=100)
    """

    body: str
    raised_by: str
    love_number: float
    quality_factor: float | None = None
    time_lag: Quantity | None = None
    radius: Quantity | None = None

    conservative: ClassVar[bool] = False

    def __post_init__(self) -> None:
        k2 = float(numbers(self.love_number, "TidalTorque: love_number", ()))
        if k2 < 0:
            raise InputError(f"TidalTorque: love_number: expected at least 0, got {k2:g}")
        self._set(love_number=k2)
        if (self.quality_factor is None) == (self.time_lag is None):
            raise InputError("TidalTorque: give exactly one of quality_factor= and time_lag=")
        if self.quality_factor is not None:
            quality = float(numbers(self.quality_factor, "TidalTorque: quality_factor", ()))
            if quality < 1:
                raise InputError(f"TidalTorque: quality_factor: expected at least 1 (1/Q is a sine), got {quality:g}")
            self._set(quality_factor=quality)
        if self.time_lag is not None:
            lag = to_si(self.time_lag, "s", "TidalTorque: time_lag", sign="non-negative")
            self._set(time_lag=quantity(lag, "s"))
        if self.radius is not None:
            radius = to_si(self.radius, "m", "TidalTorque: radius", sign="positive")
            self._set(radius=quantity(radius, "m"))

    @property
    def kernel(self) -> Callable[..., Any]:
        """The compiled force."""
        from binaryast.kernels.external.tides import force

        return force

    def check(self, bodies: Sequence[RigidBody]) -> None:
        """Raise where it cannot act on these bodies."""
        i, j = (index_of(name, bodies, f"TidalTorque: {key}") for key, name in self._named)
        if i == j:
            raise InputError(f"TidalTorque: {self.body} is named twice: expected two bodies")
        if bodies[i].is_point:
            raise InputError(f"TidalTorque: {self.body} is a point, which does not turn")
        radius_of(bodies[i], self.radius, f"TidalTorque: {self.body}")

    @property
    def _named(self) -> tuple[tuple[str, str], ...]:
        return ("body", self.body), ("raised_by", self.raised_by)

    def parameters(self, bodies: Sequence[RigidBody], span: Span) -> Floats:
        """Return which bodies, the strength, which lag, and how slow a turning is."""
        i, j = (index_of(name, bodies, key) for key, name in self._named)
        size = radius_of(bodies[i], self.radius, self.body)
        strength = self.love_number * G * bodies[j].si.mass ** 2 * size**5
        if self.time_lag is not None:
            return np.array([i, j, 3 * strength * float(self.time_lag.value), 1.0, 0.0])
        whole = bodies[i].si.gm + bodies[j].si.gm
        slow = SLOW * np.sqrt(whole / (2 * size) ** 3)
        return np.array([i, j, 1.5 * strength / float(self.quality_factor or 1.0), 0.0, slow])
