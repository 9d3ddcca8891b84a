"""The speed bench of ``mars2d bench``: scenes that other simulators are given as well."""
