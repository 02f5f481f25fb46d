"""CPU time against error, of our methods and of other codes: ``python -m validation.benchmark``."""
