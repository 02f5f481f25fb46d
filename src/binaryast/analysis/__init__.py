"""What is read off a trajectory. Each function takes a `binaryast.Trajectory` and returns one value or frozen object."""

from binaryast.analysis.attitude import RollPitchYaw, Tumbling, roll_pitch_yaw, tumbling
from binaryast.analysis.elements import Elements, mean_elements, osculating_elements
from binaryast.analysis.libration import libration_amplitude, libration_angle, loss_of_synchrony
from binaryast.analysis.orbit import mean_orbit_axes, mutual_period, orbit_angle

__all__ = [
    "Elements",
    "RollPitchYaw",
    "Tumbling",
    "libration_amplitude",
    "libration_angle",
    "loss_of_synchrony",
    "mean_elements",
    "mean_orbit_axes",
    "mutual_period",
    "orbit_angle",
    "osculating_elements",
    "roll_pitch_yaw",
    "tumbling",
]
