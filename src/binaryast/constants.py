"""The one constant of nature of the package, pinned so that a run can be repeated, and the version.

Another value of G is had by giving `binaryast.RigidBody` a ``gm``: only products G m enter the motion.
"""

from importlib.metadata import PackageNotFoundError, version

G = 6.67430e-11
"""Newtonian constant of gravitation, CODATA 2018 [m3 kg-1 s-2]."""

try:
    VERSION = version("binaryast")
except PackageNotFoundError:  # a bare source tree has none
    VERSION = "0+unknown"
"""Version of the package."""
