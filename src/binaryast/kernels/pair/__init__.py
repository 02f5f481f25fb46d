"""A pair of bodies, in the variables of the paper's relative frame: the relative position instead of two positions."""
