"""What may be switched on: names, velocities with their scale, links between neighbours."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pygame
import pytest

from mars2d import Robot, Scenario, Unicycle
from mars2d.core.scene import Arrow
from mars2d.output.layers.legend import legends
from mars2d.output.layers.neighbours import neighbours
from mars2d.output.layers.velocities import speed_scale, velocities
from mars2d.output.raster.camera import Camera
from mars2d.output.raster.legend import draw_legends
from mars2d.output.raster.painter import Painter
from mars2d.record.frame import Frame
from mars2d.scenario.neighbours import Graph, Within
from tests.cases import each_case

SIZE = (640, 480)
CAMERA = Camera(80.0, 320.0, 240.0)


def frame_of(poses, velocity=(0.0, 0.0, 0.0), **changes):
    """Return a frame a control step after which robots at poses have moved like this."""
    robots = [Robot(pose=pose) for pose in poses]
    scenario = Scenario(robots=robots, workspace=None, **changes)
    dt, before = scenario.sampling_time, np.array(poses, dtype=float).T
    pose = before + dt * np.array(velocity)[:, None]
    props = np.array([prop.pose for prop in scenario.props]).reshape(-1, 3).T
    return Frame(scenario, dt, 1, pose, before[None], prop_pose=props, prop_path=props[None])


# -- velocities -----------------------------------------------------------------------------------


def test_an_arrow_is_as_long_as_the_body_is_fast():
    scale = speed_scale(frame_of([(0, 0, 0)]).scenario)
    for speed in (0.1, 0.4):
        (arrow,) = velocities(frame_of([(0, 0, 0)], (speed, 0, 0))).shapes
        assert isinstance(arrow, Arrow)
        length = np.hypot(arrow.tip[0] - arrow.tail[0], arrow.tip[1] - arrow.tail[1])
        assert length == pytest.approx(speed * scale.unit)
        assert arrow.tail == pytest.approx((0.1 * speed, 0))


def test_what_stands_or_creeps_has_no_arrow_and_what_flies_a_bounded_one():
    assert velocities(frame_of([(0, 0, 0)])).shapes == []
    assert velocities(frame_of([(0, 0, 0)], (0.004, 0, 0))).shapes == []
    frame = frame_of([(0, 0, 0)], (1000.0, 0, 0))
    arrow, *cut = velocities(frame).shapes
    assert len(cut) == 2, "the two strokes that say that it is shortened"
    assert arrow.tip[0] - arrow.tail[0] == pytest.approx(speed_scale(frame.scenario).longest)


def test_circles_show_how_tightly_a_robot_can_turn_at_its_speed():
    frame = frame_of([(1, 2, pi / 2)], (0, 0.4, 0))
    (robot,) = frame.scenario.robots
    robot = robot.replace(drive=Unicycle(max_angular_speed=0.5))
    bounded = replace(frame, scenario=frame.scenario.replace(robots=[robot]))
    left, right, _ = velocities(bounded).shapes
    assert [left.radius, right.radius] == pytest.approx([0.8, 0.8])
    assert np.array([left.center, right.center]) == pytest.approx(
        np.array([[1.8, 2.04], [0.2, 2.04]])
    )


@each_case("scale", [20.0, 80.0, 150.0, 333.0])
def test_the_legends_lie_side_by_side(scale):
    scenario, plot = frame_of([(0, 0, 0)]).scenario, pygame.Rect(0, 0, 1280, 600)
    camera, seen = Camera(scale, 320.0, 240.0), {}
    for forces, velocities_too in ((True, False), (False, True), (True, True)):
        surface = pygame.Surface(plot.size, 0, 32)
        wanted = {"forces": forces, "velocities": velocities_too, "impulses": False}
        shown = [each for each in legends(scenario) if wanted[each.layer]]
        draw_legends(surface, Painter(), camera, plot, shown)
        seen[forces, velocities_too] = pygame.surfarray.array3d(surface).any(axis=(1, 2))
    wide = [int(seen[key].sum()) for key in ((True, False), (False, True))]
    both = seen[True, True]
    assert int(both.sum()) == sum(wide)
    assert len(np.flatnonzero(np.diff(both.astype(int)))) == 4  # with a gap between them


# -- neighbours -----------------------------------------------------------------------------------


def linked(frame):
    """Return whether a line goes from robot to robot, for each pair of neighbours on a row."""
    surface = pygame.Surface(SIZE, 0, 32)
    Painter().paint(surface, neighbours(frame).shapes, CAMERA)
    middles = CAMERA.to_pixels((frame.pose[:2, 1:] + frame.pose[:2, :-1]).T / 2)
    return [surface.get_at((round(x), round(y)))[:3] != (0, 0, 0) for x, y in middles.tolist()]


def test_neighbours_are_linked():
    places = [(-2, 0, 0), (-1, 0, 0), (0.5, 0, 0)]
    assert linked(frame_of(places, neighbours=Within(1.2))) == [True, False]
    last_two = Graph([[0, 0, 0], [0, 0, 1], [0, 0, 0]])
    assert linked(frame_of(places, neighbours=last_two)) == [False, True]
    assert linked(frame_of(places)) == [False, False], "all are neighbours: that says nothing"
