"""Many small robots are seen, and what is drawn of them has legends."""

from __future__ import annotations

import numpy as np
import pytest

import mars2d
from mars2d import Holonomic, Robot, Scenario
from mars2d.addons import Communication, Theory
from mars2d.core.scene import Circle
from mars2d.output.figures.contacts import plot_contacts
from mars2d.output.figures.figure import plot_paths, save_drawing
from mars2d.output.figures.signals import plot_signals
from mars2d.output.layers.bodies import RING, place_ring
from mars2d.output.layers.legend import legends
from mars2d.output.layers.table import of_bodies
from tests.cases import each_case


def frame_of(scenario):
    from mars2d import World

    return World(scenario).frame


# -- rings -----------------------------------------------------------------------------------------


@each_case("side, count", [(10, 0), (24, 0), (26, 3), (200, 3)])
def test_robots_of_less_than_a_hundredth_of_the_arena_have_rings(side, count):
    half = side / 2
    area = [(-half, -half), (half, -half), (half, half), (-half, half)]
    robots = [Robot(pose=(k, 0, 0), diameter=0.3) for k in range(3)]
    found = of_bodies(place_ring)(frame_of(Scenario(robots=robots, workspace=area))).shapes
    assert len(found) == count
    for ring in found:
        assert isinstance(ring, Circle)
        assert (ring.radius, ring.pixels) == (0.0, RING)  # under a robot that is seen large


# -- legends ---------------------------------------------------------------------------------------


def meanings(scenario):
    return {each.layer: [sign.name for sign in each.signs] for each in legends(scenario)}


def test_messages_and_theory_have_legends_where_they_are_drawn():
    assert meanings(Scenario(robots=2)).keys() == {"forces", "impulses", "velocities"}
    addons = [Communication(), Theory(lambda scene, frame: None)]
    found = meanings(Scenario(robots=1, addons=addons))
    assert found["messages"] == ["message", "message lost"]
    assert found["theory"] == ["theory"]


# -- figures ---------------------------------------------------------------------------------------


@pytest.mark.slow
def test_figures_of_a_hundred_robots_are_files_of_less_than_two_megabytes(tmp_path):
    robots = [Robot(pose=(k % 10, k // 10, 0), drive=Holonomic()) for k in range(98)]
    scenario = Scenario(robots=robots, workspace=None, physics="ideal", stop_time=60)
    noise = np.random.default_rng(1)
    record = mars2d.run(scenario, control=lambda world: noise.normal(size=(2, 98)))
    figures = {
        "paths": lambda: plot_paths(record).figure,
        "signals": lambda: plot_signals(record, ["x", "speed", "command"])[0].figure,
        "contacts": lambda: plot_contacts(record)[0].figure,
    }
    for name, draw in figures.items():
        file = save_drawing(draw, tmp_path / f"{name}.svg")
        assert file.stat().st_size < 2e6, name
    assert len(record._repr_svg_()) < 2e6
    assert len(record._repr_html_()) < 2e6
