"""How a body is selected: by a click, or one after the other."""

from __future__ import annotations

import numpy as np

from mars2d import Robot, Scenario, World
from mars2d.bodies.props import Box, Solid
from mars2d.window.screen.picking import body_at
from tests.cases import each_case
from tests.worlds import ELL


def crowded():
    solid = Solid(ELL, pose=(2, 0, np.pi / 2), name="ell")
    return World(
        Scenario(robots=[Robot(), Robot(pose=(0.4, 0, 0))], props=[solid, Box(pose=(0, 1, 0))])
    ).frame


@each_case(
    "point, body",
    [((0, 0), 0), ((0.1, 0.1), 0), ((0.4, 0.14), 1), ((0, 1.19), 3), ((0.2, 0.5), None),
     ((0.0, 0.16), 0), ((0.0, 0.18), None)],
)  # fmt: skip
def test_what_lies_under_the_pointer_is_hit_with_a_little_slack(point, body):
    assert body_at(crowded(), point, 0.02) == body
