"""Bodies of any shape, props and joints look like what they are, where they are."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest

from mars2d import Robot, Scenario, World
from mars2d.bodies.colors import MATERIAL_COLORS, prop_colors
from mars2d.bodies.joints import Rod, Rope, Spring
from mars2d.bodies.props import Ball, Box, Gate, Puck, Solid
from mars2d.core.materials import MATERIALS
from mars2d.core.scene import Circle, Line, Polygon, Scene
from mars2d.geometry.shapes import Compound, Disc
from mars2d.geometry.shapes import Polygon as Outline
from mars2d.output.layers.bodies import draw_prop, draw_robot, initial_poses, joints, props, robots
from mars2d.output.layers.trails import trails

ARROWHEAD = [(-0.2, -0.2), (0.3, 0.0), (-0.2, 0.2), (-0.1, 0.0)]
ELL = Outline([(0, 0), (0.6, 0), (0.6, 0.2), (0.2, 0.2), (0.2, 0.6), (0, 0.6)])


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


def test_the_parts_of_a_compound_have_no_edges_inside():
    dumbbell = Compound(
        [Disc(0.3).moved(-0.2, 0), Disc(0.3).moved(0.2, 0),
         Outline([(-0.2, -0.05), (0.2, -0.05), (0.2, 0.05), (-0.2, 0.05)])]
    )  # fmt: skip
    filled = drawn(Robot(shape=dumbbell))
    bodies = [shape for shape in filled.shapes if not isinstance(shape, Line)]
    assert [bool(shape.fill) for shape in bodies] == [False] * 3 + [True] * 3
    hollow = of(Polygon, drawn(Robot(shape=dumbbell), fill=None))
    assert len(hollow) == 1, "the outline of their union"
    apart = Compound([Disc(0.2).moved(-0.3, 0), Disc(0.2).moved(0.3, 0)])
    assert len(of(Polygon, drawn(Robot(shape=apart), fill=None))) == 2


def test_the_mark_of_a_concave_prop_stays_within_it():
    scene = Scene()
    prop = Solid(ELL)
    draw_prop(scene, prop, np.array(prop.pose), "#d9b384")
    start, end = of(Line, scene)[0].points
    x, y = ELL.centroid
    for point in (start, end):
        assert -1e-9 <= point[0] + x <= 0.6 + 1e-9
        assert -1e-9 <= point[1] + y <= 0.6 + 1e-9


def test_props_show_their_colour_their_material_or_a_neutral_one():
    listed = [Box(color="#123456", material="wood"), Puck(material="ice"), Ball()]
    own, ice, neutral = prop_colors(listed)
    assert own == "#123456"
    assert ice == MATERIAL_COLORS["ice"]
    assert neutral not in (own, ice)
    assert set(MATERIAL_COLORS) == set(MATERIALS)


def test_a_ball_that_turns_looks_different():
    ends = []
    for theta in (0.0, pi / 2):
        scene = Scene()
        draw_prop(scene, Ball(), np.array([0.0, 0.0, theta]), "#d9b384")
        ends.append(of(Line, scene)[0].points[1])
    np.testing.assert_allclose(ends, [(0.1, 0), (0, 0.1)], atol=1e-12)


def test_initial_poses_of_props_are_hollow_and_props_filled():
    scenario = Scenario(robots=[Robot()], props=[Box(pose=(1, 1, 0.3)), Puck(pose=(2, 1, 0))])
    frame = World(scenario).frame
    box, puck = of(Polygon, initial_poses(frame))[0], of(Circle, initial_poses(frame))[0]
    assert box.fill is None
    assert puck.fill is None
    assert of(Polygon, props(frame))[0].fill
    np.testing.assert_allclose(of(Polygon, props(frame))[0].points, box.points)


def test_points_in_place_of_robots_leave_props_to_scale():
    from mars2d import Animation

    animation = Animation(show_real_shape=False)
    scenario = Scenario(robots=[Robot()], props=[Puck(pose=(1, 0, 0))], animation=animation)
    frame = World(scenario).frame
    assert of(Circle, robots(frame))[0].radius == 0.0
    assert of(Circle, props(frame))[0].radius == pytest.approx(0.1)


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


def test_joints_are_drawn_where_they_act():
    rope = Rope(a="robot0", b="puck0")
    assert tied(rope).shapes
    assert not tied(rope, physics="ideal").shapes


def test_a_prop_that_moved_leaves_a_thin_trail():
    from dataclasses import replace

    scenario = Scenario(robots=[Robot()], props=[Puck(pose=(1, 0, 0)), Box(pose=(2, 1, 0))])
    frame = World(scenario).frame
    path = np.repeat(frame.prop_pose[None], 5, axis=0)
    path[:, 0, 0] += np.linspace(-0.5, -0.1, 5)
    of_robots = len(trails(frame).shapes)
    scene = trails(replace(frame, prop_path=path))
    assert len(scene.shapes) == of_robots + 1
    np.testing.assert_allclose(scene.shapes[0].points[[0, -1]], [(0.5, 0), (1, 0)])
    assert scene.shapes[0].width < scene.shapes[-1].width
