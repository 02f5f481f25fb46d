"""The one constant of nature of the package, pinned so that a run can be repeated.

Another value of G is had by giving `binaryast.RigidBody` a ``gm``: only products G m enter the motion.
"""

G = 6.67430e-11
"""Newtonian constant of gravitation, CODATA 2018 [m3 kg-1 s-2]."""
