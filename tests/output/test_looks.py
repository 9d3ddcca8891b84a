"""Bodies of any shape, props and joints look like what they are, where they are."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest

from mars2d import Robot, Scenario, World
from mars2d.bodies.colors import MATERIAL_COLORS, prop_colors
from mars2d.bodies.joints import Rod, Rope, Spring
from mars2d.bodies.props import Ball, Box, Gate, Puck
from mars2d.core.materials import MATERIALS
from mars2d.core.scene import Circle, Line, Polygon, Scene
from mars2d.geometry.shapes import Polygon as Outline
from mars2d.output.layers.bodies import draw_robot, joints

ARROWHEAD = [(-0.2, -0.2), (0.3, 0.0), (-0.2, 0.2), (-0.1, 0.0)]


def of(kind, scene):
    return [shape for shape in scene.shapes if isinstance(shape, kind)]


def drawn(robot, pose=(0.0, 0.0, 0.0), fill="#0072b2"):
    scene = Scene()
    draw_robot(scene, robot, np.array(pose, dtype=float), fill, "#ffffff")
    return scene


def length(points):
    return np.hypot(*np.diff(points, axis=0).T).sum()


def test_a_disc_is_a_circle_and_a_line_from_its_centre_to_the_front():
    disc, heading = drawn(Robot(), (1, 2, pi / 2)).shapes
    assert (disc.center, disc.radius, disc.width) == ((1, 2), 0.15, 1.5)
    np.testing.assert_allclose(heading.points, [(1, 2), (1, 2.15)], atol=1e-12)


def test_a_polygon_keeps_its_concave_outline_and_its_place():
    pose = (1.0, -2.0, 0.7)
    robot = Robot(shape=Outline(ARROWHEAD), center_offset=0.05)
    scene = drawn(robot, pose)
    c, s = cos(0.7), sin(0.7)
    local = np.array(ARROWHEAD) - (0.05, 0.0)
    expected = local @ np.array([[c, s], [-s, c]]) + (1.0, -2.0)
    np.testing.assert_allclose(of(Polygon, scene)[0].points, expected)
    heading = of(Line, scene)[0].points
    np.testing.assert_allclose(heading[0], (1.0, -2.0))
    np.testing.assert_allclose(heading[1], (1.0 + 0.25 * c, -2.0 + 0.25 * s))
    assert of(Circle, scene)[0].center == (1.0, -2.0)  # where it turns about


def test_props_show_their_colour_their_material_or_a_neutral_one():
    listed = [Box(color="#123456", material="wood"), Puck(material="ice"), Ball()]
    own, ice, neutral = prop_colors(listed)
    assert own == "#123456"
    assert ice == MATERIAL_COLORS["ice"]
    assert neutral not in (own, ice)
    assert set(MATERIAL_COLORS) == set(MATERIALS)


def tied(joint, x=1.0, **changes):
    scenario = Scenario(robots=[Robot()], props=[Puck(pose=(x, 0, 0))], joints=[joint], **changes)
    return joints(World(scenario).frame)


def test_a_taut_rope_is_straight_and_a_slack_one_about_as_long_as_it_is():
    taut = of(Line, tied(Rope(a="robot0", b="puck0")))[0]
    np.testing.assert_allclose(taut.points, [(0, 0), (1, 0)], atol=1e-12)
    for rope in (1.05, 1.3, 2.0):
        slack = of(Line, tied(Rope(a="robot0", b="puck0", length=rope)))[0]
        assert length(slack.points) == pytest.approx(rope, rel=0.05)


def test_a_spring_is_a_zigzag_that_stretches_with_as_many_coils():
    near = of(Line, tied(Spring(a="robot0", b="puck0", rest_length=0.5), x=0.6))[0].points
    far = of(Line, tied(Spring(a="robot0", b="puck0", rest_length=0.5), x=1.2))[0].points
    assert len(near) == len(far)
    assert np.ptp(near[:, 1]) == pytest.approx(np.ptp(far[:, 1]))
    np.testing.assert_allclose(far[-1], (1.2, 0), atol=1e-12)


def test_rods_reach_their_anchors_and_hinges_are_pins():
    rod = Rod(a="robot0", anchor_a=(0.1, 0), b="puck0", anchor_b=(0, 0.05))
    for line in of(Line, tied(rod)):
        np.testing.assert_allclose(line.points, [(0.1, 0), (1, 0.05)], atol=1e-12)
    scenario = Scenario(robots=[Robot()], props=[Gate(pose=(2, 0, pi / 2), length=1.0)])
    (pin,) = joints(World(scenario).frame).shapes
    np.testing.assert_allclose(pin.center, (2, -0.5))
    assert pin.radius == 0.0
