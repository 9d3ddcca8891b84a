"""The examples in docstrings do what they say."""

import doctest
import importlib
import pkgutil

import pytest

import mars2d

MODULES = [m.name for m in pkgutil.walk_packages(mars2d.__path__, "mars2d.")]
ROOMS = sorted({name.split(".")[1] for name in MODULES} - {"__main__", "examples"})


@pytest.mark.parametrize("room", ROOMS)  # the examples are run by tests of their own
def test_docstring_examples_hold(room):
    names = [m for m in MODULES if m.split(".")[1] == room and not m.endswith("__main__")]
    failed = {name: doctest.testmod(importlib.import_module(name)).failed for name in names}
    assert {name: count for name, count in failed.items() if count} == {}
