"""Sines, angles and lengths of our own: right to the last digit but one, and as the engine's."""

from __future__ import annotations

import ast
import math
from pathlib import Path

import numpy as np
import pytest

from mars2d.core import arithmetic
from mars2d.core.arithmetic import angle_of, angles_of, cosine_sine, cosines_sines, norm, norms
from mars2d.geometry.shapes import arsinh, logarithm
from mars2d.physics.islands import arithmetic as engine
from tests.cases import each_case

PACKAGE = Path(arithmetic.__file__).parents[1]
ROOMS = ("core", "geometry", "bodies", "sensors", "addons", "scenario", "physics", "world")

ANGLES = np.concatenate(
    [
        np.random.default_rng(0).uniform(-10, 10, 5000),
        np.random.default_rng(1).uniform(-1e5, 1e5, 500),
        np.arange(-8, 9) * math.pi / 4, [0.0, -0.0, 1e-300, 5e-324],
    ]
)  # fmt: skip


def test_sines_are_right_to_the_last_digit_but_one_and_those_of_the_engine():
    c, s = cosines_sines(ANGLES)
    np.testing.assert_allclose(c, np.cos(ANGLES), rtol=0, atol=1.2e-16)
    np.testing.assert_allclose(s, np.sin(ANGLES), rtol=0, atol=1.2e-16)
    for number, *pair in zip(ANGLES.tolist(), c.tolist(), s.tolist(), strict=True):
        assert (*pair,) == cosine_sine(number) == engine.cosine_sine(number)


@each_case("shape", [(), (3,), (2, 4), (40, 2), (0,)])
def test_shapes_stay_and_few_are_as_many(shape):
    angles = np.resize(ANGLES, shape)
    c, s = cosines_sines(angles)
    assert c.shape == s.shape == shape
    whole = cosines_sines(ANGLES)
    np.testing.assert_array_equal(np.ravel(s), np.resize(whole[1], angles.size))
    assert angles_of(angles, angles).shape == norms(angles, angles).shape == shape


def test_turns_beyond_a_million_are_taken_off_and_what_is_no_angle_has_no_sine():
    assert cosine_sine(1e6 * 2 * math.pi) == pytest.approx((1, 0), abs=1e-8)
    for odd in (math.inf, -math.inf, math.nan):
        assert all(map(math.isnan, cosine_sine(odd)))
        assert np.isnan(cosines_sines(np.full(40, odd))).all()


def test_angles_are_right_in_all_directions():
    rng = np.random.default_rng(2)
    y, x = rng.normal(size=(2, 5000)) * 10 ** rng.uniform(-9, 9, (2, 5000))
    np.testing.assert_allclose(angles_of(y, x), np.arctan2(y, x), rtol=3e-16)
    assert angles_of(y, x).tolist() == [angle_of(*pair) for pair in zip(y, x, strict=True)]
    axes = (-math.inf, -1.0, 0.0, 1.0, math.inf)
    for pair in ((b, a) for a in axes for b in axes if (a, b) != (0.0, 0.0)):
        assert angle_of(*pair) == math.atan2(*pair)


def test_lengths_do_not_overflow():
    numbers = [0.0, 1e-150, 0.3, 4.0, 1e200, 1e308, math.inf]
    pairs = [(x, -y) for x in numbers for y in numbers]
    wanted = [math.hypot(*pair) for pair in pairs]
    np.testing.assert_allclose([norm(*pair) for pair in pairs], wanted, rtol=3e-16)
    assert norms(*np.transpose(pairs)).tolist() == [norm(*pair) for pair in pairs]
    assert math.isnan(norm(math.nan, 1.0))
    assert norm(1e-170, 0.0) == norms([1e-170], [0.0])[0] == 0.0


def test_logarithms():
    numbers = 10 ** np.random.default_rng(3).uniform(-300, 300, 2000)
    for x in numbers.tolist():
        assert logarithm(x) == pytest.approx(math.log(x), rel=4e-16)
    for x in (-3.0, -1e-9, 0.0, 1e-4, 0.4, 0.7, 1e9):
        assert arsinh(x) == pytest.approx(math.asinh(x), rel=1e-15)


def test_a_base_of_decay_has_a_power_that_is_a_number():
    """So every library's power, which is off by less than 0.6 of a last digit, is the same."""
    from decimal import Decimal, localcontext

    with localcontext() as context:
        context.prec = 60
        for rate in (6.32163094, 356.674944):
            for h in 10 ** np.random.default_rng(4).uniform(-6, -1.3, 300):
                base = Decimal(engine.decay_base(rate, math.exp(-rate), float(h)))
                exact = (base.ln() * Decimal(float(h))).exp()
                near = float(exact)
                assert abs(exact - Decimal(near)) < Decimal(0.1 * math.ulp(near))
                assert near == pytest.approx(math.exp(-rate * h), rel=1e-14)


LIBRARY = {
    "cos", "sin", "tan", "acos", "asin", "atan", "atan2", "arccos", "arcsin", "arctan", "arctan2",
    "hypot", "exp", "expm1", "log", "log1p", "log10", "sinh", "cosh", "tanh", "asinh", "arcsinh",
    "pow", "power", "cbrt", "matmul", "dot", "einsum", "norm",
}  # fmt: skip
"""Functions of math and numpy that round as a processor or a library does."""

ALLOWED = {
    ("physics/space.py", "arctan2"),  # whether an outline is convex
    ("core/plane.py", "log10"),  # how to divide an axis
    ("addons/estimate.py", "log"),  # how large an ellipse is drawn
    ("scenario/parameters.py", "log10"),  # how many digits a slider shows
    ("scenario/prediction.py", "log10"),  # how many digits are printed
}


def test_nothing_that_is_recorded_asks_a_library_for_more_than_a_square_root():
    found = set()
    for room in ROOMS:
        for path in (PACKAGE / room).rglob("*.py"):
            tree = ast.parse(path.read_text(encoding="utf-8"))
            math_names = {
                alias.name
                for node in ast.walk(tree)
                if isinstance(node, ast.ImportFrom) and node.module == "math"
                for alias in node.names
            }
            name = path.relative_to(PACKAGE).as_posix()
            found |= {(name, each) for each in math_names & LIBRARY}
            found |= {
                (name, node.attr)
                for node in ast.walk(tree)
                if isinstance(node, ast.Attribute)
                and node.attr in LIBRARY
                and isinstance(node.value, (ast.Name, ast.Attribute))
                and ast.unparse(node.value) in ("np", "math", "np.linalg", "cmath")
            }
    assert {each for each in found if "maps/" not in each[0]} == ALLOWED
