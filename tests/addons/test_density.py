"""The add-on Density: functions, what is wrong with them, and how they look."""

from __future__ import annotations

import numpy as np
import pytest

import mars2d
from mars2d import InputError, LawError, Robot, Scenario, World
from mars2d.addons import Density, Voronoi
from mars2d.core.scene import Image as Pixels
from mars2d.output.layers.addons import floor
from tests.cases import each_case

# -- what it is -------------------------------------------------------------------------------


def test_a_function_is_called_with_arrays_of_coordinates():
    density = Density(lambda x, y: x * x + y)
    assert density.of([[1, 2, 3], [0, 1, 2]]).tolist() == [1, 5, 11]
    assert density.of(np.empty((2, 0))).shape == (0,)


def test_robots_gather_where_it_is_dense():
    def end(*density):
        robots = [Robot(drive=mars2d.Holonomic(max_linear_speed=5)).at(x, 0) for x in (-1, 1)]
        scenario = Scenario(robots=robots, addons=[Voronoi(), *density], stop_time=20)
        law = lambda world: world.addons.voronoi.now.centroids - world.position  # noqa: E731
        return mars2d.run(scenario, control=law).pose[-1, :2].mean(axis=1)

    assert end() == pytest.approx([0, 0], abs=0.01)
    hill = Density(lambda x, y: 1 / (1 + (x - 2) ** 2 + (y - 3) ** 2))
    assert (end(hill) > [0.6, 1.0]).all()


# -- what can't be ----------------------------------------------------------------------------


@each_case(
    ("fields", "message"),
    [
        ({"function": 3}, "Density.function = 3: expected a function of two arguments"),
        ({"function": lambda x: x}, r"Density.function = .*: .* exactly two arguments, x \[m\]"),
        ({"function": max, "color": "rde"}, "Density.color = 'rde': .*did you mean 'red'"),
    ],
)
def test_a_density_that_can_not_be_is_an_error(fields, message):
    with pytest.raises(InputError, match=message):
        Density(**fields)


@each_case(
    ("phi", "message"),
    [
        (lambda x, y: x, r"array of numbers >= 0, .*; it is -[\d.]+ at \(-[\d.]+, -?[\d.]+\)"),
        (lambda x, y: np.where(y > 3, np.inf, 1), "; it is inf at "),
        (lambda x, y: ["much"], "it returned .'much'."),
        (lambda x, y: 0 * x, "Density.function: it is 0 everywhere in the workspace"),
    ],
)
@pytest.mark.filterwarnings("ignore:invalid value")
def test_what_a_function_returns_is_looked_at_when_a_world_is_made(phi, message):
    with pytest.raises(InputError, match=r"^Density\.function: .*" + message.split(": ")[-1]) as e:
        World(Scenario(addons=[Density(phi)]))
    assert not isinstance(e.value, LawError)


# -- how it looks -----------------------------------------------------------------------------


def test_it_lies_on_the_floor_darker_where_it_is_denser():
    def left(x, y):
        return np.where(x < 0, 2.0, 0.5)

    (shape,) = floor(Scenario(addons=[Density(left, color="#ff0000")])).shapes
    assert isinstance(shape, Pixels)
    assert shape.bounds == (-5, 5, -5, 5)
    assert shape.pixels.shape == (200, 200, 4)
    assert shape.pixels[100, 50].tolist() == [255, 0, 0, 128]
    assert shape.pixels[100, 150].tolist() == [255, 0, 0, 32]
