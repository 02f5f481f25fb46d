"""A run in the words of astropy and SciPy: dates, directions in the sky, rotations."""

from typing import Any

import numpy as np
from astropy.time import Time, TimeDelta
from astropy.units import Quantity
from scipy.spatial.transform import Rotation

from binaryast.errors import InputError
from binaryast.units import Floats


class Directions:
    """What `binaryast.Trajectory` says of itself in the words of other packages."""

    @property
    def epochs(self: Any) -> Time:
        """Dates of the rows (N,), of the scale TDB.

        Raises
        ------
        InputError
            Of a run without an epoch.
        """
        if self.epoch is None:
            raise InputError("epochs: the run has no epoch: give its first ba.State an epoch=, an astropy Time")
        return self.epoch + TimeDelta(self.time)

    def rotation(self: Any, body: str | int) -> Rotation:
        """Return the attitudes of a body as SciPy rotations (N,), body frame -> inertial.

        Parameters
        ----------
        body : str or int
            Its name or its index.

        Examples
        --------
        >>> import astropy.units as u, numpy as np
        >>> import binaryast as ba
        >>> system, state = ba.catalogue.load("didymos")
        >>> run = ba.propagate(system, state, duration=2.26 * u.h, integrator=ba.LGVI(40 * u.s))
        >>> turn = run.rotation("Didymos")
        >>> print(np.degrees((turn[-1] * turn[0].inv()).magnitude()).round(1))
        0.1
        """
        return Rotation.from_matrix(self.si.attitude[:, self.system.index(body)].copy())

    def pole(self: Any, body: str | int) -> Any:
        """Return the direction of a body's spin as an astropy ``SkyCoord`` (N,), ICRS.

        Parameters
        ----------
        body : str or int
            Its name or its index.

        Raises
        ------
        InputError
            Where the inertial axes of the run are not those of the ICRF, or the body does not turn.

        Examples
        --------
        >>> import astropy.units as u
        >>> import binaryast as ba
        >>> system, state = ba.catalogue.load("didymos")
        >>> run = ba.propagate(system, state, duration=1 * u.day, integrator=ba.LGVI(step=40 * u.s))
        >>> print(run.pole("Didymos")[-1].to_string(precision=3))
        69.327 -72.725
        """
        i = self.system.index(body)
        spins = np.einsum("nij,nj->ni", self.si.attitude[:, i], self.si.spin[:, i])
        return _sky(self, spins, f"pole: {self.system.names[i]} does not turn at some row")

    def orbit_pole(self: Any, body: str | int = 1, about: str | int = 0) -> Any:
        """Return the direction of the pole of a body's orbit about another as an astropy ``SkyCoord`` (N,), ICRS.

        Parameters
        ----------
        body, about : str or int
            Names or indices: of a pair, the secondary's about the primary.

        Raises
        ------
        InputError
            Where the inertial axes of the run are not those of the ICRF, or the bodies move on a line.
        """
        i, j = self.system.index(body), self.system.index(about)
        x, v = (array[:, i] - array[:, j] for array in (self.si.position, self.si.velocity))
        return _sky(self, np.cross(x, v), "orbit_pole: the bodies move on a line at some row")


def _sky(run: Any, vectors: Floats, without: str) -> Any:
    """Return directions of vectors (N, 3) in the sky."""
    if run.frame != "ICRF":
        raise InputError(
            f"the axes of this run are {run.frame!r}, of which no right ascension is known: "
            "give its first ba.State frame='ICRF', or a pole by right ascension and declination"
        )
    sizes = np.linalg.norm(vectors, axis=1, keepdims=True)
    if not np.all(sizes > 0):
        raise InputError(without)
    from astropy.coordinates import SkyCoord, UnitSphericalRepresentation  # half a second, needed only here

    x, y, z = (vectors / sizes).T
    longitude, latitude = Quantity(np.arctan2(y, x), "rad"), Quantity(np.arctan2(z, np.hypot(x, y)), "rad")
    return SkyCoord(UnitSphericalRepresentation(longitude, latitude), frame="icrs")
