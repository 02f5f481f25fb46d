"""Whether something happens between looks: g passes through zero, or turns back so near to it that it may have touched.

Of each event a row of marks keeps the last three looks. A pass is between the last two of them. A turn is about the
middle one, where the parabola through the three crosses zero, or comes nearer to it than g changed between them: what
is missed with that margin is a g that turns twice between three looks.
"""

from numba import types

from binaryast.kernels.jit import ROWS, Array, jit

TIMES, VALUES = 0, 3  # of the last three looks, the newest last
COUNT = 6  # how many looks there were
DIRECTION = 7  # of the passes that are wanted: 1 upwards, -1 downwards, 0 both
PERIOD = 8  # of g, 0 without one: an angle that jumps by a turn passes through nothing
MARKS = 9

NOTHING, PASS, TURN = 0.0, 1.0, 2.0

# A finding: which event, a pass or a turn, and the three looks.
EVENT, KIND, LOOKS = 0, 1, 2
FINDING = 8


@jit()
def turns_near_zero(t0: float, g0: float, t1: float, g1: float, t2: float, g2: float) -> bool:
    """Whether |g| is smallest at the middle one of three looks, and may have touched zero about there."""
    if not (abs(g1) < abs(g0) and abs(g1) <= abs(g2)):
        return False
    first, second = (g1 - g0) / (t1 - t0), (g2 - g1) / (t2 - t1)
    bend = (second - first) / (t2 - t0)
    slope = first + bend * (t1 - t0)  # of the parabola at t1
    lowest = g1 - 0.25 * slope * slope / bend
    change = max(abs(g1 - g0), abs(g2 - g1))
    return (lowest < 0.0) != (g1 < 0.0) or abs(lowest) <= change


@jit(types.float64(ROWS, types.int64, types.float64, types.float64))
def notice(marks: Array, e: int, t: float, g: float) -> float:
    """Take in a look at event ``e``, and return what is found: a pass, a turn, or nothing."""
    for k in range(2):
        marks[e, TIMES + k] = marks[e, TIMES + k + 1]
        marks[e, VALUES + k] = marks[e, VALUES + k + 1]
    marks[e, TIMES + 2], marks[e, VALUES + 2] = t, g
    marks[e, COUNT] += 1.0
    if marks[e, COUNT] < 2.0:
        return NOTHING
    before = marks[e, VALUES + 1]
    if marks[e, PERIOD] > 0.0 and abs(g - before) > 0.5 * marks[e, PERIOD]:
        marks[e, COUNT] = 1.0
        return NOTHING
    if (before < 0.0) != (g < 0.0):
        return PASS if (g - before) * marks[e, DIRECTION] >= 0.0 else NOTHING
    first = marks[e, VALUES]
    if marks[e, COUNT] < 3.0 or (first < 0.0) != (g < 0.0):
        return NOTHING
    return TURN if turns_near_zero(marks[e, TIMES], first, marks[e, TIMES + 1], before, t, g) else NOTHING
