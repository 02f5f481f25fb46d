"""The working state of n bodies: one flat array of floats, SI, and the constants that go with it.

Grouped by kind, each for all bodies in the order of the system: positions and velocities relative to the barycentre in
inertial axes, attitudes as unit quaternions (scalar last, body to inertial), angular momenta, each in its body's own
frame. These 13 n numbers are the motion. Then follow the potential and what it exerts at this configuration, kept so
that a step evaluates it once, and for each number of the motion the part that it lost to rounding. Nothing else
influences the next step: this array is a checkpoint. Where something acts from outside, the numbers of
``external/layout.py`` follow.
"""

from binaryast.kernels.jit import jit

MOTION = 13  # numbers of the motion for each body


@jit()
def velocity_of(n: int) -> int:
    """Return where the velocities of n bodies begin; positions begin at 0."""
    return 3 * n


@jit()
def attitude_of(n: int) -> int:
    """Return where the attitudes begin: 4 numbers for each body."""
    return 6 * n


@jit()
def momentum_of(n: int) -> int:
    """Return where the angular momenta Pi begin."""
    return 10 * n


@jit()
def potential_of(n: int) -> int:
    """Return where U is."""
    return 13 * n


@jit()
def gradient_of(n: int) -> int:
    """Return where dU/dx begins, inertial [N]."""
    return 13 * n + 1


@jit()
def torque_of(n: int) -> int:
    """Return where the torques M begin, each in its body's frame (24) [N m]."""
    return 16 * n + 1


@jit()
def remainder_of(n: int) -> int:
    """Return where the remainders begin: of the motion, in its order."""
    return 19 * n + 1


@jit()
def size_of(n: int) -> int:
    """Return the size of the whole state."""
    return 32 * n + 1


@jit()
def row_size_of(n: int) -> int:
    """Return how much of it a saved row keeps: the motion and U."""
    return 13 * n + 1


# Constants: the number of bodies and of pairs; for each body its mass, whether it is a point, of its principal moments
# 1/I_i and (I_j - I_k)/I_i, cyclic, and whether it pulls others; for each pair its primary, its secondary, where its
# parameters begin and end, whether it attracts as two points do, and who feels it: both, or the secondary, or the
# primary alone.
HEADER = 2
BODY = 9
MASS = 0
IS_POINT = 1
INVERSE = 2
RATIOS = 5
PULLS = 8
PAIR = 6
PRIMARY = 0
SECONDARY = 1
BEGIN = 2
END = 3
AS_POINTS = 4
FELT_BY = 5
BOTH, ONLY_SECONDARY, ONLY_PRIMARY = 0.0, 1.0, 2.0


@jit()
def body_constants(i: int) -> int:
    """Return where the constants of body i begin."""
    return HEADER + BODY * i


@jit()
def pair_constants(n: int, k: int) -> int:
    """Return where the constants of pair k of n bodies begin."""
    return HEADER + BODY * n + PAIR * k
