"""A run by heyoka's Taylor integrator: gravity and motion as formulas, which are run on symbols and compiled.

    run > motion > attraction > multipole | points
    run > compiled

Only `compiled` knows heyoka. The formulas take numbers of any kind, floats among them.
"""
