"""What a loop of steps can end with."""

COMPLETED = 0
NO_ROTATION_1 = 1  # (123) has no solution: the secondary would turn too far in one step
NO_ROTATION_2 = 2  # (124) has none: the primary would
CONTACT = 3  # the surfaces touch
NOT_FINITE = 4  # the energy is not a number any more
