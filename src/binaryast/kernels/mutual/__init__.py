"""Mutual gravity of a pair of bodies: U, dU/dX and M, one file per model."""
