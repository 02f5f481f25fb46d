"""The mathematics of the package, compiled: numba, numpy and math only, plain SI floats, one idea per file."""
