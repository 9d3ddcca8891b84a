"""Pairs of materials, rules and static friction in a scenario, checked."""

from __future__ import annotations

import pytest

from mars2d import InputError, MaterialPair, Robot, Scenario
from mars2d.bodies import Puck
from mars2d.scenario.changes import moves_alike
from tests.cases import each_case

# -- checks -----------------------------------------------------------------------------------


@each_case(
    ("make", "message"),
    [
        (lambda: MaterialPair("steal", "ice", friction=0.1), r"MaterialPair\.a.*mean 'steel'"),
        (lambda: MaterialPair("steel", "ice"), r"'steel', 'ice'\): expected a friction or a"),
        (
            lambda: MaterialPair("steel", "ice", friction=0.2, static_friction=0.1),
            r"MaterialPair\.static_friction = 0\.1: expected at least the kinetic .* 0\.2",
        ),
        (
            lambda: MaterialPair("steel", "ice", restitution=0.2, static_friction=0.1),
            r"static_friction = 0\.1: expected None, or the kinetic",
        ),
        (
            lambda: Scenario(
                material_pairs=[
                    MaterialPair("wood", "ice", friction=0.1),
                    MaterialPair("ice", "wood", restitution=0.1),
                ]
            ),
            r"material_pairs\[1\]: 'ice' and 'wood' are also Scenario\.material_pairs\[0\]",
        ),
        (lambda: Scenario(restitution_rule="average"), r"restitution_rule = 'average'.*'mean'"),
        (lambda: Robot(static_friction=0.4), r"Robot\.static_friction = 0\.4: .* 0\.5, or None"),
        (lambda: Robot(friction="ice", static_friction=0.1), r"Robot\.static_friction.* 0\.22"),
        (lambda: Puck(static_ground_friction=0.09), r"Puck\.static_ground_friction = 0\.09.* 0\.1"),
    ],
)
def test_what_can_not_be_is_refused_in_one_clear_line(make, message):
    with pytest.raises(InputError, match=message):
        make()


# -- names of materials stay ------------------------------------------------------------------


def test_materials_of_the_same_value_are_told_apart():
    wood, glass = Robot(friction="wood"), Robot(friction="glass")
    assert wood.friction != glass.friction
    assert not wood.friction == glass.friction  # noqa: SIM201
    assert wood.friction == 0.63
    assert hash(wood.friction) == hash(0.63)
    assert not moves_alike(Scenario(robots=[wood]), Scenario(robots=[glass]))
