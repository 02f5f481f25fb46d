"""Checks and measurements that are not part of the installed package: run from the project's root."""
