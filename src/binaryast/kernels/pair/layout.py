"""The working state of a pair: one flat array of floats, SI, and the constants that go with it.

The first twenty numbers are the motion: position and velocity of the secondary relative to the primary in inertial
axes, then for each body, the primary (the paper's body 2) first, its attitude as a unit quaternion (scalar last, body
to inertial) and its angular momentum in its own frame. Then follow the potential and what it exerts at this
configuration, a function of the motion that is kept so that a step evaluates it once, and for each of the twenty
numbers the part that it lost to rounding. Nothing else influences the next step: this array is a checkpoint. Where
something acts from outside, the numbers of ``external/layout.py`` follow.
"""

POSITION = 0  # x1 - x2 [m]
VELOCITY = 3
ATTITUDE_2 = 6  # quaternion
MOMENTUM_2 = 10  # Pi2 [kg m2/s]
ATTITUDE_1 = 13
MOMENTUM_1 = 17  # Pi1, in the secondary's own frame
POTENTIAL = 20  # U [J]
GRADIENT = 21  # dU/dx1 = -dU/dx2, inertial [N]
TORQUE_2 = 24  # X x dU/dX + M, in the primary's frame [N m]
TORQUE_1 = 27  # -R^T M, in the secondary's frame
REMAINDER = 30  # + 0 .. 19: what rounding took from the motion
STATE_SIZE = 50
ROW_SIZE = 21  # what a saved row keeps: the motion and U

# Constants: the reduced mass and G (m1 + m2); for each body 1/I_i and (I_j - I_k)/I_i, cyclic, of its principal
# moments I; what part of all the mass each body is, and one over all of it.
REDUCED_MASS = 0
GM = 1
INVERSE_2 = 2
RATIOS_2 = 5
INVERSE_1 = 8
RATIOS_1 = 11
SHARE_2 = 14
SHARE_1 = 15
INVERSE_MASS = 16
CONSTANTS_SIZE = 17
