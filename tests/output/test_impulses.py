"""Blows are shown for a second, normal and friction apart, with the cone of friction."""

from __future__ import annotations

import dataclasses
from math import atan, atan2, hypot

import numpy as np
import pytest

from mars2d import Robot, Scenario, World
from mars2d.addons import Map
from mars2d.bodies.props import Ball, Box
from mars2d.core.scene import Arrow, Line, Polygon, Text
from mars2d.output.layers.arrows import CUT_WIDTH, EDGE
from mars2d.output.layers.forces import force_scale, forces
from mars2d.output.layers.impulses import (
    FRICTION,
    NORMAL,
    blows,
    impulse_scale,
    impulses,
    in_newton_seconds,
)
from mars2d.output.layers.legend import legends
from mars2d.output.layers.table import LAYERS, Layers
from mars2d.scenario.material_pair import MaterialPair
from tests.cases import each_case

AWAY = Robot(pose=(0, 3, 0), controller=lambda robot: (0.0, 0.0))


def of(kind, scene, color=None):
    found = [shape for shape in scene.shapes if isinstance(shape, kind)]
    return [each for each in found if color is None or color in (getattr(each, "fill", None),)]


def has_cut(scene):
    return any(
        isinstance(shape, Line) and (shape.stroke, shape.width) == (EDGE, CUT_WIDTH)
        for shape in scene.shapes
    )


def length(arrow):
    return hypot(*np.subtract(arrow.tip, arrow.tail))


def meeting(offset=0.0, friction=0.0, restitution=1.0, speed=0.5, **changes):
    """Return the world in which a ball has just met another that was at rest."""
    ball = Ball(diameter=0.2, mass=1.0, restitution=restitution, friction=friction)
    props = [ball.replace(velocity=(speed, 0, 0)).at(-0.4, 0), ball.at(0, offset)]
    scenario = Scenario(robots=[AWAY], props=props, workspace=None, sampling_time=0.05, **changes)
    world = World(scenario)
    while not len(world.frame.contact_log()):
        world.step(np.zeros((2, 1)))
    return world


def test_a_central_blow_of_equal_balls_has_the_whole_momentum_along_the_normal():
    world = meeting()
    scene, unit = impulses(world.frame), impulse_scale(world.scenario).unit
    (arrow,) = of(Arrow, scene)
    assert length(arrow) / unit == pytest.approx(1.0 * 0.5)  # m v, for e = 1
    assert [text.text for text in of(Text, scene)] == ["0.50 N s"]
    assert not of(Polygon, scene), "without friction there is no cone"


def test_normal_and_friction_stand_apart_and_their_sum_ends_on_the_cone_of_a_sliding_blow():
    world = meeting(offset=0.12, friction=0.3)
    scene, unit = impulses(world.frame), impulse_scale(world.scenario).unit
    (press,), (rub,) = of(Arrow, scene, NORMAL), of(Arrow, scene, FRICTION)
    np.testing.assert_allclose(rub.tail, press.tip)
    ahead, across = np.subtract(press.tip, press.tail), np.subtract(rub.tip, rub.tail)
    assert abs(ahead @ across) < 1e-12
    (row,) = blows(world.frame)
    assert length(press) / unit == pytest.approx(row["normal_impulse"])
    assert length(rub) / unit == pytest.approx(abs(row["tangential_impulse"]))
    assert length(rub) / length(press) == pytest.approx(0.09, rel=1e-2)  # 0.3 * 0.3: it slides
    (cone,) = of(Polygon, scene)
    sides = cone.points[[1, -1]] - cone.points[0]
    np.testing.assert_allclose(cone.points[0], press.tail)
    for side in sides:
        angle = atan2(abs(ahead[0] * side[1] - ahead[1] * side[0]), ahead @ side)
        assert angle == pytest.approx(atan(0.09))


def test_what_the_arrows_say_is_what_the_other_body_gets():
    world = meeting(offset=0.12, friction=0.4)
    frame, unit = world.frame, impulse_scale(world.scenario).unit
    arrows = of(Arrow, impulses(frame))
    total = sum(np.subtract(arrow.tip, arrow.tail) for arrow in arrows) / unit
    # Rolling begins: m v sin(a) / 6 beside m v cos(a), of discs with sin(a) = 0.6.
    rub, press = (length(each) for each in arrows)
    assert rub / press == pytest.approx(0.6 / 0.8 / 6, rel=1e-2)
    np.testing.assert_allclose(total, 1.0 * frame.exact_velocity[:2, 2], atol=1e-9)


def test_a_blow_is_shown_for_a_second_of_the_experiment():
    world = meeting()
    began = float(world.frame.contact_log()["time"][0])
    seen = []
    for _ in range(30):
        seen.append((world.time - began, bool(impulses(world.frame).shapes)))
        world.step(np.zeros((2, 1)))
    assert [shown for _, shown in seen] == [age < 1.0 for age, _ in seen]
    assert {shown for _, shown in seen} == {True, False}


def test_on_an_obstacle_the_impulse_on_the_body_is_drawn():
    ball = Ball(diameter=0.2, mass=1.0, restitution=1.0, velocity=(0.5, 0, 0)).at(-0.4, 0)
    wall = Map([[(0.1, -1), (0.1, 1)]])
    world = World(Scenario(robots=[AWAY], props=[ball], addons=[wall], workspace=None))
    while not len(world.frame.contact_log()):
        world.step(np.zeros((2, 1)))
    arrow = of(Arrow, impulses(world.frame), NORMAL)[0]
    assert arrow.tip[0] < arrow.tail[0]
    assert length(arrow) / impulse_scale(world.scenario).unit == pytest.approx(1.0), "2 m v"


def test_steady_pushing_is_a_force_and_no_blow():
    box = Box(pose=(0.5, 0, 0), length=0.3, width=0.3, ground_friction=0.6, mass=1)
    world = World(Scenario(robots=[Robot()], props=[box], workspace=None, stop_time=9))
    while world.time < 4:
        world.step([[0.2], [0.0]])
    assert forces(world.frame).shapes
    assert not impulses(world.frame).shapes


def test_one_rule_shortens_all_long_arrows_and_the_legend_says_from_where_on():
    fast = meeting(speed=0.5)
    assert not has_cut(impulses(fast.frame))
    frame = fast.frame
    strong = frame.contact_log().copy()
    strong["impulse"] *= 10
    strong["normal_impulse"] *= 10
    frame = dataclasses.replace(frame, contact_log=lambda: strong)
    scene, scale = impulses(frame), impulse_scale(fast.scenario)
    (arrow,) = of(Arrow, scene)
    assert length(arrow) == pytest.approx(scale.longest)
    assert has_cut(scene)
    assert len(of(Line, scene)) == 3  # two strokes, and the line to where it acts
    found = {legend.layer: legend for legend in legends(fast.scenario)}
    for layer in ("forces", "impulses", "velocities"):
        legend = found[layer]
        bound = legend.ruler.in_words(legend.ruler.longest / legend.ruler.unit)
        assert legend.signs[0].name == f"over {bound}"
        assert has_cut(legend.signs[0].scene)
        for point in (1e-4, 0.01, 1.0, 100.0):
            assert legend.ruler.sign(point).length <= legend.ruler.longest, "it is not cut itself"
        assert 0 < max(metres for metres, _ in legend.ruler.lengths) <= legend.ruler.longest
    assert force_scale(fast.scenario).longest == scale.longest


def test_the_key_of_forces_switches_impulses_along_and_each_has_a_switch_of_its_own():
    on = Layers().toggled("forces")
    assert on.forces
    assert on.impulses
    alone = on.toggled("impulses", alone=True)
    assert alone.forces
    assert not alone.impulses
    assert on.toggled("forces", alone=True).impulses
    off = on.toggled("forces")
    assert not off.impulses
    names = [layer.name for layer in LAYERS]
    assert names.index("impulses") < names.index("forces")


def test_friction_between_two_bodies_is_what_the_engine_uses():
    steel, ice = Box(material="steel", mass=1.0), Box(material="ice", mass=1.0)
    props = [steel.at(1, 0), ice.at(2, 0)]
    of_tables = Scenario(robots=[AWAY], props=props)
    a, b = (body.surface.friction for body in of_tables.bodies[1:])
    assert of_tables.friction_between(1, 2) == pytest.approx(a * b)
    least = of_tables.replace(friction_rule="minimum")
    assert least.friction_between(1, 2) == min(a, b)
    pair = of_tables.replace(material_pairs=[MaterialPair("steel", "ice", friction=0.03)])
    assert pair.friction_between(1, 2) == 0.03
    grips = MaterialPair("ice", "steel", friction=0.03, static_friction=0.1)
    held = pair.replace(material_pairs=[grips])
    assert held.friction_between(1, 2) == 0.1
    walled = of_tables.replace(on_exit="wall")
    assert walled.friction_between(1, -1) == a  # a wall has friction 1


@each_case(
    "impulse, text",
    [(0.0, "0 N s"), (0.0042, "4.2 mN s"), (0.00996, "0.010 N s"), (1.25, "1.2 N s"),
     (1240, "1240 N s")],
)  # fmt: skip
def test_impulses_are_read_with_two_digits(impulse, text):
    assert in_newton_seconds(impulse) == text
