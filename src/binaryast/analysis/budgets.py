"""Who has the energy and the angular momentum: each body's spin and its motion, and what they give each other."""

from dataclasses import dataclass

import numpy as np
from astropy.units import Quantity

from binaryast.errors import InputError
from binaryast.trajectory import Trajectory
from binaryast.units import brief, quantity
from binaryast.values import Value


@dataclass(frozen=True, eq=False)
class EnergyBudget(Value):
    """Energies along a run, about the barycentre [J].

    Attributes
    ----------
    time : Quantity
        Since the start (N,) [s].
    translational, rotational : Quantity
        Kinetic energies of each body (N, n).
    potential : Quantity
        Of all pairs together (N,).
    orbit : Quantity
        Translational and potential energies of all (N,).
    total : Quantity
        (N,)
    """

    time: Quantity
    translational: Quantity
    rotational: Quantity
    potential: Quantity
    orbit: Quantity
    total: Quantity


@dataclass(frozen=True, eq=False)
class AngularMomentumBudget(Value):
    """Angular momenta along a run, about the barycentre, inertial [kg m2/s].

    Attributes
    ----------
    time : Quantity
        Since the start (N,) [s].
    orbital, spin : Quantity
        Of each body's mass centre and of its rotation (N, n, 3).
    total : Quantity
        (N, 3)
    exchange : ndarray
        What each spin has taken from the orbits since the start, along the total, over its size (N, n). That the
        orbits gave as much is what the conservation of the total says.
    """

    time: Quantity
    orbital: Quantity
    spin: Quantity
    total: Quantity
    exchange: Quantity


def energy_budget(run: Trajectory) -> EnergyBudget:
    """Return the energies of each body.

    Parameters
    ----------
    run : Trajectory

    Returns
    -------
    EnergyBudget

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("sn263")
    >>> run = ba.propagate(system, state, duration=1 * u.day, integrator=ba.LGVI(60 * u.s))
    >>> ba.analysis.energy_budget(run).rotational.shape[1]
    3
    """
    _check(run)
    masses = np.array([body.si.mass for body in run.system.bodies])
    moments = np.array([body.si.moments for body in run.system.bodies])
    velocity = run.si.velocity - (np.einsum("i,nij->nj", masses / masses.sum(), run.si.velocity))[:, None]
    translational = 0.5 * masses * np.sum(velocity**2, axis=-1)
    return EnergyBudget(
        time=run.time,
        translational=quantity(translational, "J"),
        rotational=quantity(0.5 * np.sum(moments * run.si.spin**2, axis=-1), "J"),
        potential=run.potential_energy,
        orbit=run.energy_of_orbit,
        total=run.energy,
    )


def angular_momentum_budget(run: Trajectory) -> AngularMomentumBudget:
    """Return the angular momenta of each body, and what spins and orbits exchange.

    Parameters
    ----------
    run : Trajectory

    Returns
    -------
    AngularMomentumBudget

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> run = ba.propagate(system, state, duration=1 * u.day, integrator=ba.LGVI(60 * u.s))
    >>> budget = ba.analysis.angular_momentum_budget(run)
    >>> bool(abs(budget.exchange).max() < 1e-4)
    True
    """
    _check(run)
    masses = np.array([body.si.mass for body in run.system.bodies])
    moments = np.array([body.si.moments for body in run.system.bodies])
    shares = masses / masses.sum()
    x, v = (array - np.einsum("i,nij->nj", shares, array)[:, None] for array in (run.si.position, run.si.velocity))
    spin = np.einsum("nbij,nbj->nbi", run.si.attitude, moments * run.si.spin)
    total = run.angular_momentum.value
    size = float(np.linalg.norm(total[0]))
    along = total[0] / size if size > 0 else np.zeros(3)
    return AngularMomentumBudget(
        time=run.time,
        orbital=quantity(masses[:, None] * np.cross(x, v), "kg m2 / s"),
        spin=quantity(spin, "kg m2 / s"),
        total=quantity(total, "kg m2 / s"),
        exchange=quantity((spin - spin[0]) @ along / (size if size > 0 else 1.0), ""),
    )


def _check(run: Trajectory) -> None:
    if not isinstance(run, Trajectory):
        raise InputError(f"run: expected a ba.Trajectory, got {brief(run)}")
