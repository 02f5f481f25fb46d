"""What acts on the bodies of a system from outside: distant masses, tides, radiation, a user's own forces."""

from binaryast.perturbations.base import Perturbation
from binaryast.perturbations.distant import Flyby, Planet, Sun, ThirdBody
from binaryast.perturbations.radiation import Byorp, RadiationPressure, Yorp
from binaryast.perturbations.tides import TidalTorque
from binaryast.perturbations.user import ExternalPotential, Force, external_potential, force

KINDS: dict[str, type[Perturbation]] = {  # that a scenario file can name
    kind.__name__: kind for kind in (Sun, Planet, Flyby, ThirdBody, TidalTorque, Yorp, Byorp, RadiationPressure)
}

__all__ = [
    "KINDS",
    "Byorp",
    "ExternalPotential",
    "Flyby",
    "Force",
    "Perturbation",
    "Planet",
    "RadiationPressure",
    "Sun",
    "ThirdBody",
    "TidalTorque",
    "Yorp",
    "external_potential",
    "force",
]
