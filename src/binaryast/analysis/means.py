"""Running means of what oscillates with a period that is known."""

import numpy as np

from binaryast.units import Floats


def running_mean(time: Floats, values: Floats, period: float) -> Floats:
    """Return the means of values (N, ...) over two periods, with triangular weights, where both lie within the rows.

    A period, and any whole part of one, falls out altogether, a slope is kept. It is the second difference of the
    second integral of a spline, so rows need not be equally spaced.
    """
    from scipy.interpolate import CubicSpline  # a third of a second, needed only here

    middle, slope = values.mean(axis=0), (values[-1] - values[0]) / (time[-1] - time[0])
    line = middle + np.multiply.outer(time - time.mean(), slope)  # taken off, for its integral would take digits
    twice = CubicSpline(time, values - line).antiderivative(2)
    inside = (time >= time[0] + period) & (time <= time[-1] - period)
    at = time[inside]
    return np.asarray(line[inside] + (twice(at + period) - 2 * twice(at) + twice(at - period)) / period**2)
