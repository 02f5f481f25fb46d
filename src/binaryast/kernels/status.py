"""What a loop of steps can end with."""

COMPLETED = 0  # below: minus the number of findings, of a loop that looks for events
STOPPED = -(10**9)  # by an event
NOT_FINITE = 1  # the energy is not a number any more
NO_ROTATION = 1_000  # + the index of the body that would turn too far in one step: (95), (123) or (124) has no solution
CONTACT = 1_000_000  # + the index of the pair whose surfaces touch
