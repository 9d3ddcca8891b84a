"""The examples in docstrings do what they say."""

import doctest
import importlib

import pytest

from tests.house.test_imports import FILES, PACKAGE, ROOMS


@pytest.mark.parametrize("room", ROOMS)
def test_docstring_examples_hold(room):
    shown = [file for file in FILES if PACKAGE / room in file.parents and ">>>" in file.read_text()]
    for file in shown:
        name = ".".join(file.relative_to(PACKAGE.parent).with_suffix("").parts)
        module = importlib.import_module(name.removesuffix(".__init__"))
        assert doctest.testmod(module).failed == 0, name
