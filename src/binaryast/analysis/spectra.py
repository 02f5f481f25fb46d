"""Spectra of a motion: its lines by refined frequency analysis, its proper frequencies, and the lines named by them."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from astropy.units import Quantity

from binaryast.analysis.frequencies import Lines, lines_of
from binaryast.analysis.libration import libration_angle
from binaryast.analysis.orbit import mean_orbit_axes, mutual_period
from binaryast.analysis.pairs import Bodies, pair_of, relative_motion
from binaryast.errors import InputError
from binaryast.trajectory import Trajectory
from binaryast.units import Floats, brief, quantity, to_si
from binaryast.values import Value

FEWEST = 16  # rows
SAME = 0.1  # of 2 pi over the time, within which a line is taken for a combination
UNEQUAL = 1e-6  # of the time between rows


@dataclass(frozen=True, eq=False)
class Spectrum(Value):
    """The lines of a series, strongest first: a sum of amplitude cos(frequency t + phase), t since the first row.

    Attributes
    ----------
    frequency : Quantity
        (K,) [rad/s]; of a complex series with a sign.
    amplitude : Quantity
        (K,), in the unit of the series.
    phase : Quantity
        At the first row (K,) [rad].
    duration : Quantity
        Of the series [s]: lines nearer to each other than some turns in it are not told apart.
    rest : Quantity
        Root of the mean square of what the lines leave, in the unit of the series.
    """

    frequency: Quantity
    amplitude: Quantity
    phase: Quantity
    duration: Quantity
    rest: Quantity

    @property
    def period(self) -> Quantity:
        """Of each line (K,) [h]."""
        return quantity(2 * np.pi / np.abs(self.frequency.value), "s").to("h")

    def names(self, proper: Mapping[str, Quantity], *, largest: int = 4) -> tuple[str, ...]:
        """Return each line as a combination of proper frequencies in whole numbers, such as ``"2 orbit - libration"``.

        Parameters
        ----------
        proper : mapping
            Frequencies [rad/s] by their names, such as `proper_frequencies` returns.
        largest : int
            Largest sum of the sizes of the numbers.

        Returns
        -------
        tuple of str
            Of all combinations within a tenth of a turn over the whole time, the one of the smallest numbers; empty
            where there is none.

        Examples
        --------
        >>> import astropy.units as u, numpy as np
        >>> import binaryast as ba
        >>> t = np.linspace(0, 400, 2000)
        >>> found = ba.analysis.spectrum(t * u.s, (np.cos(t) + 0.1 * np.cos(1.7 * t)) * u.deg, lines=2)
        >>> found.names({"a": 1 * u.rad / u.s, "b": 0.3 * u.rad / u.s})
        ('a', '2 a - b')
        """
        if not isinstance(proper, Mapping) or not proper:
            raise InputError(f"proper: expected frequencies by their names, got {brief(proper)}")
        rates = np.array([float(to_si(value, "rad / s", f"proper[{name!r}]")) for name, value in proper.items()])
        numbers = sorted(_combinations(len(rates), largest), key=lambda one: sum(map(abs, one)))
        width = SAME * 2 * np.pi / float(self.duration.value)
        totals = np.array(numbers) @ rates
        names = []
        for frequency in self.frequency.value:
            near = np.flatnonzero(np.abs(totals - frequency) < width)
            names.append(_named(numbers[near[0]], list(proper)) if len(near) else "")
        return tuple(names)


def spectrum(time: Quantity, values: Any, *, lines: int = 8) -> Spectrum:
    """Return the strongest lines of equally spaced values, by refined frequency analysis (NAFF).

    Frequencies are far better than the 2 pi over the time of a Fourier transform: of a sum of lines that are some turns
    apart, to round-off; else what is left of other lines is what errs.

    Parameters
    ----------
    time : Quantity
        (N,), equally spaced.
    values : Quantity or array-like
        (N,), real or complex; numbers have no unit.
    lines : int
        How many, at most.

    Returns
    -------
    Spectrum

    Raises
    ------
    InputError
        For fewer than 16 values, or times that are not equally spaced.

    References
    ----------
    J. Laskar, Physica D 67 (1993) 257-281.

    Examples
    --------
    >>> import astropy.units as u, numpy as np
    >>> import binaryast as ba
    >>> t = np.linspace(0, 300, 1000)
    >>> found = ba.analysis.spectrum(t * u.s, 2 * np.cos(0.7 * t + 0.5) + 0.01 * np.sin(0.9 * t), lines=2)
    >>> bool(np.allclose(found.frequency.value, [0.7, 0.9], rtol=1e-13))
    True
    """
    if not isinstance(time, Quantity) or time.ndim != 1:
        raise InputError(f"time: expected times (N,) with a unit, got {brief(time)}")
    seconds = to_si(time, "s", "time", shape=time.shape)
    series = Quantity(values)
    if series.shape != seconds.shape or not np.all(np.isfinite(series.value)):
        raise InputError(f"values: expected finite ones of shape {seconds.shape}, got {brief(series)}")
    if isinstance(lines, bool) or not isinstance(lines, (int, np.integer)) or lines < 1:
        raise InputError(f"lines: expected how many, such as 8, got {brief(lines)}")
    _check_spacing(seconds)
    found = lines_of(seconds, series.value, int(lines))
    return _spectrum(found, seconds, series.unit)


def libration_spectrum(run: Trajectory, bodies: Bodies = None, *, lines: int = 8) -> Spectrum:
    """Return the lines of the secondary's libration angle [deg].

    Parameters
    ----------
    run : Trajectory
        Without impulses: else take one of ``run.legs``. A last row out of step is left out.
    bodies : tuple of two, optional
        As for `orbit_angle`.
    lines : int
        How many, at most.

    Returns
    -------
    Spectrum

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("moshup")
    >>> run = ba.propagate(system, state, duration=20 * u.day, accuracy=1e-8)
    >>> found = ba.analysis.libration_spectrum(run, lines=3)
    >>> len(found.frequency)
    3
    """
    return _of_run(run, np.degrees(libration_angle(run, bodies).value), "deg", lines)


def separation_spectrum(run: Trajectory, bodies: Bodies = None, *, lines: int = 8) -> Spectrum:
    """Return the lines of the distance of the mass centres [m]; arguments as for `libration_spectrum`."""
    pair = pair_of(run, bodies)
    return _of_run(run, run.distance(*pair).value, "m", lines)


def orbit_spectrum(run: Trajectory, bodies: Bodies = None, *, lines: int = 8) -> Spectrum:
    """Return the lines of x + i y of the secondary relative to the primary in the mean orbit plane [m].

    The strongest is the mean motion; frequencies are positive where they go round with it. Arguments as for
    `libration_spectrum`.
    """
    x, _ = relative_motion(run, bodies)
    first, second, _ = mean_orbit_axes(run, bodies)
    return _of_run(run, x @ first + 1j * (x @ second), "m", lines)


def proper_frequencies(run: Trajectory, bodies: Bodies = None) -> dict[str, Quantity]:
    """Return the frequencies that the orbit and the libration in its plane are made of.

    Parameters
    ----------
    run : Trajectory
        As for `libration_spectrum`.
    bodies : tuple of two, optional
        As for `orbit_angle`.

    Returns
    -------
    dict of Quantity
        [rad/s]. ``orbit``, the mean sidereal rate; ``distance``, the strongest line of the separation, which is that of
        the anomaly; ``libration``, the strongest line of the libration angle that is no combination of these two. What
        is not there, such as the libration of a secondary that turns freely, is left out.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> scenario = ba.catalogue.entry("dart")
    >>> run = ba.propagate(
    ...     scenario.system, scenario.state, duration=60 * u.day, accuracy=1e-7, impulses=scenario.impulses)
    >>> list(ba.analysis.proper_frequencies(run.legs[1]))
    ['orbit', 'distance', 'libration']
    """
    rate = 2 * np.pi / mutual_period(run, bodies).to_value("s")
    strongest = orbit_spectrum(run, bodies, lines=4).frequency.value[0]
    found = {"orbit": quantity(strongest if abs(strongest / rate - 1) < 0.1 else rate, "rad / s")}
    of_distance = separation_spectrum(run, bodies, lines=4).frequency
    if len(of_distance):
        found["distance"] = of_distance[0]
    _, secondary = pair_of(run, bodies)
    if not run.system.bodies[secondary].is_point and np.ptp(libration_angle(run, bodies).value) < np.pi:
        of_face = libration_spectrum(run, bodies, lines=6)
        names = of_face.names(found)
        free = [line for line, name in zip(of_face.frequency, names, strict=True) if not name]
        if free:
            found["libration"] = free[0]
    return found


def _of_run(run: Trajectory, values: Floats, unit: str, lines: int) -> Spectrum:
    """Return the lines of a series of a run, without a last row that is out of step."""
    if len(run.legs) > 1:
        raise InputError("the run has impulses, across which there is no spectrum: take one of run.legs")
    steps = np.diff(run.si.time)
    rows = len(values) - (1 if len(steps) > 1 and abs(steps[-1] / steps[0] - 1) > UNEQUAL else 0)
    return spectrum(run.time[:rows], Quantity(values[:rows], unit), lines=lines)


def _check_spacing(time: Floats) -> None:
    """Raise where there are too few values, or they are not equally spaced."""
    if len(time) < FEWEST:
        raise InputError(f"a spectrum needs at least {FEWEST} rows, got {len(time)}: save more often, or run longer")
    steps = np.diff(time)
    mean = float(steps.mean())
    if not mean > 0 or np.abs(steps - mean).max() > UNEQUAL * mean:
        raise InputError(
            f"a spectrum needs equally spaced rows, got {steps.min():g} to {steps.max():g} s: run with save_every="
        )


def _spectrum(found: Lines, time: Floats, unit: Any) -> Spectrum:
    """Attach units."""
    return Spectrum(
        frequency=quantity(found.frequency, "rad / s"),
        amplitude=Quantity(np.abs(found.amplitude), unit),
        phase=quantity(np.angle(found.amplitude), "rad"),
        duration=quantity(time[-1] - time[0], "s"),
        rest=Quantity(np.sqrt(np.mean(np.abs(found.rest) ** 2)), unit),
    )


def _combinations(count: int, largest: int) -> list[tuple[int, ...]]:
    """Return all whole numbers, ``count`` at a time, whose sizes add up to ``largest`` or less, but for zeros alone."""
    spans = product(range(largest, -largest - 1, -1), repeat=count)
    return [one for one in spans if 0 < sum(map(abs, one)) <= largest]


def _named(numbers: tuple[int, ...], names: list[str]) -> str:
    """Return a combination as a text."""
    text = ""
    for number, name in sorted(zip(numbers, names, strict=True), key=lambda pair: pair[0] < 0):
        if number:
            sign = (" + " if number > 0 else " - ") if text else ("" if number > 0 else "-")
            text += sign + ("" if abs(number) == 1 else f"{abs(number)} ") + name
    return text
