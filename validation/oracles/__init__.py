"""The oracles: codes and closed forms that share no equation with the package.

They are given masses, moments of inertia and starts of the package's objects, and its G. What these inputs are worth is
seen where a body is given by its axes and density alone and the oracle has moments of its own: GUBAS's runs, the free
tops, the ellipsoids.
"""
