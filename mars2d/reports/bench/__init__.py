"""The speed bench of ``mars2d bench``: four scenes, which other simulators are given as well."""
