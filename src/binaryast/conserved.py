"""What a run should conserve, at its rows: energies and momenta, and what of them came from outside."""

from functools import cached_property

import numpy as np
from astropy.units import Quantity

from binaryast.rows import Rows, rotation_errors
from binaryast.units import Floats, quantity


class Conserved(Rows):
    """Energies and momenta of the rows of a run."""

    @property
    def potential_energy(self) -> Quantity:
        """U (N,)."""
        return quantity(self.si.potential_energy, "J")

    @property
    def translational_energy(self) -> Quantity:
        """Kinetic energy of the mass centres about the barycentre (N,)."""
        _, velocity = self._about_barycentre
        return quantity(0.5 * np.sum(velocity**2, axis=-1) @ self._masses, "J")

    @cached_property
    def _about_barycentre(self) -> tuple[Floats, Floats]:
        """Positions and velocities (N, n, 3) relative to the barycentre."""
        masses = self._masses / self._masses.sum()
        position, velocity = self.si.position, self.si.velocity
        if len(masses) == 2:  # by the difference, which keeps digits where the barycentre is far or fast
            factors = np.array([[-masses[1]], [masses[0]]])
            return factors * np.diff(position, axis=1), factors * np.diff(velocity, axis=1)
        return (
            position - np.einsum("i,nij->nj", masses, position)[:, None],
            velocity - np.einsum("i,nij->nj", masses, velocity)[:, None],
        )

    @property
    def _masses(self) -> Floats:
        return np.array([body.si.mass * body.pulls for body in self.system.bodies])

    @property
    def _moments(self) -> Floats:
        return np.array([body.si.moments * body.pulls for body in self.system.bodies])

    @property
    def rotational_energy(self) -> Quantity:
        """Of all bodies together (N,)."""
        return quantity(0.5 * np.sum(self._moments * self.si.spin**2, axis=(-2, -1)), "J")

    @property
    def energy(self) -> Quantity:
        """Total energy about the barycentre (N,)."""
        return self.translational_energy + self.rotational_energy + self.potential_energy

    @property
    def energy_of_orbit(self) -> Quantity:
        """Translational and potential energy (N,): below zero a pair is bound, but for what its spins can give."""
        return self.translational_energy + self.potential_energy

    @property
    def linear_momentum(self) -> Quantity:
        """The paper's gamma_T (N, 3)."""
        return quantity(np.einsum("i,nij->nj", self._masses, self.si.velocity), "kg m / s")

    @property
    def angular_momentum(self) -> Quantity:
        """The paper's pi_T, about the barycentre, inertial (N, 3)."""
        spins = np.einsum("nbij,nbj->ni", self.si.attitude, self._moments * self.si.spin)
        orbits = np.einsum("i,nij->nj", self._masses, np.cross(*self._about_barycentre))
        return quantity(orbits + spins, "kg m2 / s")

    @property
    def work(self) -> Quantity:
        """Done from outside since the start (N,): by forces, and by potentials that change with time.

        The energy less this work is what a run should keep. It is counted about the barycentre, as the energy is.
        """
        return quantity(self.si.work, "J")

    @property
    def impulse(self) -> Quantity:
        """Linear momentum that came from outside since the start (N, 3)."""
        return quantity(self.si.impulse, "kg m / s")

    @property
    def angular_impulse(self) -> Quantity:
        """Angular momentum about the barycentre that came from outside since the start (N, 3)."""
        return quantity(self.si.angular_impulse, "kg m2 / s")

    @property
    def rotation_error(self) -> Floats:
        """||I - R^T R||, the largest of all attitudes (N,)."""
        return np.asarray(rotation_errors(self.si.attitude).max(axis=1))
