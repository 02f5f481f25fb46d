"""What a working state has more where something acts from outside: the time, and what was done since the start.

These numbers lie behind the state of a pair or of several bodies, from `base` on. The momenta begin with what the
system has, the work with zero, and each gets what the kicks give: so the energy less the work and the momenta less
these stay what they were at the start, as without anything outside.
"""

TIME = 0  # since the start of the run [s]
WORK = 1  # done by forces, and by potentials that change with time [J]
LINEAR = 2  # momentum (3) that the system should have [kg m/s]
ANGULAR = 5  # angular momentum (3) about the origin [kg m2/s]
CENTRE = 8  # of a pair: its mass centre (3) [m]
KEPT = 11  # numbers that are sums over steps
LOST = KEPT  # + 0 .. 10: what rounding took from them
RATE = 22  # dU/dt of the potentials at this configuration [W]
FORCE = 23  # their force (3) on all bodies together [N]
TORQUE = 26  # and torque (3) about the origin, inertial [N m]
SIZE = 29
