"""Any number of bodies in the paper's inertial frame, each pair with its own gravity."""
