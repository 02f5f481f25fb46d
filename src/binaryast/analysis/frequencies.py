"""Frequencies of a series by refined frequency analysis (NAFF), on plain floats."""

from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from binaryast.units import Floats

ROUNDS = 20  # of refining all lines together
SETTLED = 1e-12  # rad over the whole time, below which a round changes nothing any more
Complexes: TypeAlias = NDArray[Any]


class Lines(NamedTuple):
    """Frequencies (K,) [rad/s], complex amplitudes at the start of a series (K,), and what is left of it (N,)."""

    frequency: Floats
    amplitude: Complexes
    rest: Complexes


def lines_of(time: Floats, values: Complexes, count: int, *, power: int = 2) -> Lines:
    """Return the strongest lines of equally spaced values, real or complex, strongest first.

    The mean product of the values with the window (1 + cos)^power and exp(-i w t) is large near a line (Laskar 1993).
    The first guess is the largest of its fast Fourier transform; the maximum itself, between its neighbours, is where
    its derivative vanishes. Of two near lines each shifts the other's maximum: so, when a line has been added, all are
    refined, each with the others taken off, and the amplitudes fitted together; in the end, until they stay. A line of
    a real series is one with its mirror image, and a constant is fitted beside them.

    Parameters
    ----------
    time : ndarray
        Equally spaced (N,) [s].
    values : ndarray
        (N,), real or complex.
    count : int
        How many lines; fewer where what is left is round-off.
    power : int
        Of the window. A higher one shuts out what is far away better, and takes nearer lines for one: two of them need
        2 (power + 1) turns against each other.

    Returns
    -------
    Lines
        Real amplitudes are those of cosines: a line is Re(amplitude exp(i w (t - t[0]))).

    References
    ----------
    J. Laskar, Physica D 67 (1993) 257-281; the corrections: M. Sidlichovsky, D. Nesvorny, Celest. Mech. Dyn. Astron. 65
    (1996) 137-148.
    """
    real = not np.iscomplexobj(values)
    s = (2 * np.arange(len(time)) - len(time) + 1.0) / len(time)  # within -1 and 1
    weights = (1 + np.cos(np.pi * s)) ** power
    middle = time - time.mean()
    size = float(np.abs(values - values.mean()).max(initial=0.0))
    found: Floats = np.zeros(0)
    rest = values - values.mean()
    for _ in range(count):
        if not float(np.abs(rest).max(initial=0.0)) > 1e-14 * max(size, float(np.abs(values).max(initial=0.0))):
            break
        found = np.append(found, _peak(middle, weights, rest, *_guess(middle, weights, rest, real)))
        found, rest = _refined(middle, weights, values, found, real, rounds=2)
    found, rest = _refined(middle, weights, values, found, real, rounds=ROUNDS)
    amplitudes, rest = _fit(middle, weights, values, found, real)
    order = np.argsort(-np.abs(amplitudes), kind="stable")
    amplitudes = amplitudes * np.exp(1j * found * (time[0] - time.mean()))
    return Lines(found[order], amplitudes[order], rest)


def _guess(time: Floats, weights: Floats, values: Complexes, real: bool) -> tuple[float, float]:
    """Return the frequency at which a transform four times as fine as the values' own is largest, and its grid."""
    n = len(time)
    padded = 4 * n
    transform = np.abs(np.fft.fft(weights * values, padded))
    grid = 2 * np.pi * np.fft.fftfreq(padded, time[1] - time[0])
    if real:
        transform[grid <= 0] = 0.0
    return float(grid[np.argmax(transform)]), float(grid[1])


def _peak(time: Floats, weights: Floats, values: Complexes, guess: float, half: float) -> float:
    """Return the frequency, within ``half`` of a guess, at which the windowed mean is largest: its slope is zero."""
    from scipy.optimize import brentq

    weighted = weights * values

    def slope(frequency: float) -> float:
        product = weighted * np.exp(-1j * frequency * time)
        return float((product.sum().conjugate() * (-1j * time * product).sum()).real)

    low, high = guess - half, guess + half
    if not slope(low) > 0 > slope(high):
        return guess
    return float(brentq(slope, low, high, xtol=1e-18, rtol=4 * np.finfo(float).eps))


def _refined(
    time: Floats, weights: Floats, values: Complexes, found: Floats, real: bool, rounds: int
) -> tuple[Floats, Complexes]:
    """Return the frequencies after each was sought with all others taken off, until none moves; and what is left."""
    length = float(time[-1] - time[0])
    amplitudes, rest = _fit(time, weights, values, found, real)
    for _ in range(rounds):
        before = found
        waves = amplitudes * np.exp(1j * np.outer(time, found)) * (0.5 if real else 1.0)
        refined = [
            _peak(time, weights, rest + wave, float(frequency), np.pi / (2 * length))
            for wave, frequency in zip(waves.T, found, strict=True)
        ]
        found = np.array(refined)
        amplitudes, rest = _fit(time, weights, values, found, real)
        if not len(found) or np.abs(found - before).max() * length < SETTLED:
            break
    return found, rest


def _fit(time: Floats, weights: Floats, values: Complexes, found: Floats, real: bool) -> tuple[Complexes, Complexes]:
    """Return the amplitudes of all lines in the middle of the series, by weighted least squares, and what is left."""
    waves = np.exp(1j * np.outer(time, found))
    constant = np.ones((len(time), 1))
    columns = np.hstack([constant, waves.real, -waves.imag]) if real else np.hstack([constant, waves])
    root = np.sqrt(weights)
    fitted = np.linalg.lstsq(root[:, None] * columns, root * values)[0]
    amplitudes = fitted[1 : 1 + len(found)] + (1j * fitted[1 + len(found) :] if real else 0.0)
    return amplitudes, values - columns @ fitted
