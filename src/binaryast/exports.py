"""A run as a table: astropy's, and on demand pandas' and xarray's."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from scipy.spatial.transform import Rotation

from binaryast.errors import MissingPackageError

if TYPE_CHECKING:
    from astropy.table import QTable

XYZ = ("x", "y", "z")


class Exports:
    """What `binaryast.Trajectory` makes of itself for other packages."""

    def to_table(self: Any) -> "QTable":
        """Return the run as an astropy table: one row a time, a column a number; attitudes as quaternions, scalar last.

        Examples
        --------
        >>> import astropy.units as u
        >>> import binaryast as ba
        >>> system, state = ba.catalogue.load("didymos")
        >>> run = ba.propagate(system, state, duration=1 * u.h, integrator=ba.LGVI(40 * u.s), save_every=10 * u.min)
        >>> table = run.to_table()
        >>> len(table), table.colnames[:3]
        (7, ['time', 'Didymos.x', 'Didymos.y'])
        """
        from astropy.table import QTable  # a quarter of a second, needed only here

        columns: dict[str, Any] = {"time": self.time}
        for i, name in enumerate(self.system.names):
            quaternion = Rotation.from_matrix(self.si.attitude[:, i].copy()).as_quat()
            for parts, values in (
                (XYZ, self.position[:, i]),
                (("vx", "vy", "vz"), self.velocity[:, i]),
                (("qx", "qy", "qz", "qw"), quaternion),
                (("spin_x", "spin_y", "spin_z"), self.spin[:, i]),
            ):
                columns |= {f"{name}.{part}": values[:, j] for j, part in enumerate(parts)}
        table = QTable(columns)
        table["energy"] = self.energy
        table.meta = described(self)
        return table

    def to_pandas(self: Any) -> Any:
        """Return the run as a pandas ``DataFrame``, in SI: the columns of `to_table`, the time [s] as index.

        ``attrs`` of the frame holds the units of its columns, as texts, and where the run comes from.

        Raises
        ------
        MissingPackageError
            Where pandas is not installed.

        Examples
        --------
        >>> import pytest
        >>> pandas = pytest.importorskip("pandas")
        >>> import astropy.units as u
        >>> import binaryast as ba
        >>> system, state = ba.catalogue.load("didymos")
        >>> run = ba.propagate(system, state, duration=1 * u.h, integrator=ba.LGVI(40 * u.s), save_every=10 * u.min)
        >>> frame = run.to_pandas()
        >>> frame.shape, frame.attrs["units"]["Dimorphos.vx"]
        ((7, 27), 'm / s')
        """
        pandas = needed("pandas", "to_pandas")
        table = self.to_table()
        columns = {name: getattr(table[name], "value", table[name]) for name in table.colnames}
        index = pandas.Index(columns.pop("time"), name="time")
        frame = pandas.DataFrame(columns, index=index)
        units = {name: str(getattr(table[name], "unit", None) or "") for name in table.colnames}
        frame.attrs = {"units": units, **table.meta}
        return frame

    def to_xarray(self: Any) -> Any:
        """Return the run as an xarray ``Dataset``, in SI, by time, body and axis.

        Each variable has its ``units`` among its attributes. Attitudes are matrices, body frame -> inertial: inertial
        axes by ``axis``, the body's by ``body_axis``, by which spins are counted too. A run with an epoch has dates, of
        the scale TDB, as the coordinate ``tdb``.

        Raises
        ------
        MissingPackageError
            Where xarray is not installed.

        Examples
        --------
        >>> import pytest
        >>> xarray = pytest.importorskip("xarray")
        >>> import astropy.units as u
        >>> import binaryast as ba
        >>> system, state = ba.catalogue.load("didymos")
        >>> run = ba.propagate(system, state, duration=1 * u.h, integrator=ba.LGVI(40 * u.s), save_every=10 * u.min)
        >>> run.to_xarray().position.sel(body="Dimorphos", axis="x").shape
        (7,)
        """
        xarray = needed("xarray", "to_xarray")
        by_axis, by_body_axis = ("time", "body", "axis"), ("time", "body", "body_axis")
        variables = {
            "position": (by_axis, self.position),
            "velocity": (by_axis, self.velocity),
            "attitude": ((*by_axis, "body_axis"), self.attitude),
            "spin": (by_body_axis, self.spin),
            "energy": (("time",), self.energy),
            "potential_energy": (("time",), self.potential_energy),
            "linear_momentum": (("time", "axis"), self.linear_momentum),
            "angular_momentum": (("time", "axis"), self.angular_momentum),
        }
        coordinates: dict[str, Any] = {"body": list(self.system.names), "axis": list(XYZ), "body_axis": list(XYZ)}
        coordinates["time"] = ("time", self.si.time, {"units": "s", "long_name": "since the start of the run"})
        if self.epoch is not None:
            coordinates["tdb"] = ("time", self.epochs.datetime64, {"long_name": "date, of the scale TDB"})
        return xarray.Dataset(
            {
                name: (axes, getattr(values, "value", values), {"units": str(getattr(values, "unit", ""))})
                for name, (axes, values) in variables.items()
            },
            coords=coordinates,
            attrs=described(self),
        )


def described(run: Any) -> dict[str, str]:
    """Return where a run comes from, as texts."""
    epoch = {} if run.epoch is None else {"epoch": f"{run.epoch.isot} TDB"}
    return {"frame": run.frame, "status": run.status, **run.provenance, **epoch}


def needed(package: str, method: str) -> Any:
    """Return a package that is not installed with this one, or say how to get it."""
    try:
        return import_module(package)
    except ImportError:
        raise MissingPackageError(f"{method}: {package} is not installed: pip install 'binaryast[tables]'") from None
