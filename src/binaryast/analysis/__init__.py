"""What is read off a trajectory: each function takes a `binaryast.Trajectory`, and returns one value or object."""

from binaryast.analysis.attitude import RollPitchYaw, Tumbling, roll_pitch_yaw, tumbling
from binaryast.analysis.budgets import AngularMomentumBudget, EnergyBudget, angular_momentum_budget, energy_budget
from binaryast.analysis.elements import Elements, mean_elements, osculating_elements
from binaryast.analysis.equilibria import Equilibrium, relative_equilibria, relative_equilibrium
from binaryast.analysis.libration import libration_amplitude, libration_angle, loss_of_synchrony
from binaryast.analysis.orbit import mean_orbit_axes, mutual_period, orbit_angle
from binaryast.analysis.sections import Passages, PoincareSection, crossings, poincare_section, stroboscopic_period
from binaryast.analysis.spectra import (
    Spectrum,
    libration_spectrum,
    orbit_spectrum,
    proper_frequencies,
    separation_spectrum,
    spectrum,
)

__all__ = [
    "AngularMomentumBudget",
    "Elements",
    "EnergyBudget",
    "Equilibrium",
    "Passages",
    "PoincareSection",
    "RollPitchYaw",
    "Spectrum",
    "Tumbling",
    "angular_momentum_budget",
    "crossings",
    "energy_budget",
    "libration_amplitude",
    "libration_angle",
    "libration_spectrum",
    "loss_of_synchrony",
    "mean_elements",
    "mean_orbit_axes",
    "mutual_period",
    "orbit_angle",
    "orbit_spectrum",
    "osculating_elements",
    "poincare_section",
    "proper_frequencies",
    "relative_equilibria",
    "relative_equilibrium",
    "roll_pitch_yaw",
    "separation_spectrum",
    "spectrum",
    "stroboscopic_period",
    "tumbling",
]
