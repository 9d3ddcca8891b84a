"""The examples in docstrings do what they say."""

import doctest
import importlib
import pkgutil

import pytest

import mars2d

MODULES = ["mars2d", *(m.name for m in pkgutil.walk_packages(mars2d.__path__, "mars2d."))]


@pytest.mark.parametrize("name", [m for m in MODULES if not m.endswith("__main__")])
def test_docstring_examples_hold(name):
    if ".examples" in name:
        pytest.skip("an experiment, run by the tests of the examples")
    result = doctest.testmod(importlib.import_module(name))
    assert result.failed == 0
