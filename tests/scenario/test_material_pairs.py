"""Pairs of materials, rules and static friction in a scenario: checked, kept, and read again."""

from __future__ import annotations

import pytest

import mars2d
from mars2d import InputError, MaterialPair, Record, Robot, Scenario, World
from mars2d.addons import Map
from mars2d.bodies import Box, Puck
from mars2d.bodies.rigid import Surface
from mars2d.core.materials import MATERIALS, Coefficient, material_of
from mars2d.scenario import load_scenario, save_scenario
from mars2d.scenario.changes import moves_alike
from mars2d.scenario.options import override
from mars2d.scenario.serialize import from_description, to_scenario
from mars2d.window.editor.draft import Draft
from mars2d.world.verify import rerun
from tests.cases import each_case


class Sled(Box):
    """A prop of the user's own, with a surface of its own."""

    @property
    def surface(self) -> Surface:
        return Surface(Coefficient(MATERIALS["ice"].friction, "ice"), 0.25, 0.375)


def rich() -> Scenario:
    """A scenario with all of it."""
    return Scenario(
        robots=[Robot(pose=(-0.3, 0.03, 0), friction="rubber", static_friction=1.25)],
        props=[
            Box(
                pose=(0.3, 0, 0),
                material="wood",
                friction=0.3,
                mass=1.5,
                static_ground_friction=0.625,
            ),
            Puck(pose=(0, 1, 0), material="steel", mass=2.0),
            Sled(pose=(0, -1, 0)),
        ],
        addons=[Map([[(1, -2), (1, 2)]], friction="ice", restitution="ice", static_friction=0.5)],
        friction_rule="geometric",
        restitution_rule="maximum",
        material_pairs=[
            MaterialPair("rubber", "ice", friction=0.125, static_friction=0.1875),
            MaterialPair("wood", "wood", restitution=0.4375),
        ],
        stop_time=2.0,
    )


def surfaces_of(scenario: Scenario) -> list[tuple[object, ...]]:
    """All coefficients, with the names of their materials."""
    surfaces = [body.surface for body in scenario.bodies] + [*scenario.surfaces]
    return [
        (s.friction, material_of(s.friction), s.restitution, material_of(s.restitution),
         s.static_friction)
        for s in surfaces
    ]  # fmt: skip


def run(scenario: Scenario) -> Record:
    world = World(scenario)
    while not world.over:
        world.step([[0.3], [0.1]])
    return world.record


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


# -- kept and read again ----------------------------------------------------------------------


def test_a_toml_file_holds_all_of_it(tmp_path):
    scenario = rich()
    path = tmp_path / "scene.toml"
    save_scenario(scenario, path)
    text = path.read_text(encoding="utf-8")
    for line in ('friction_rule = "geometric"', "[[material_pairs]]", 'friction = "rubber"',
                 "static_friction = 1.25", "static_ground_friction = 0.625"):  # fmt: skip
        assert line in text.splitlines()
    again = load_scenario(path)
    assert surfaces_of(again) == surfaces_of(scenario)
    assert again.material_pairs == scenario.material_pairs
    assert run(again).digest == run(scenario).digest
    save_scenario(again, path)
    save_scenario(again.replace(title="x"), tmp_path / "twice.toml")
    assert load_scenario(tmp_path / "twice.toml") == again.replace(title="x")


def test_a_toml_file_says_where_a_pair_is_wrong(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text('format = 1\n[[material_pairs]]\na = "steel"\nb = "icy"\nfriction = 0.1\n')
    with pytest.raises(InputError, match="did you mean 'ice'") as error:
        load_scenario(path)
    assert error.value.where == "scene.toml, line 4, material_pairs[0]"


def test_a_record_holds_all_of_it_and_runs_again(tmp_path):
    record = run(rich())
    assert len(record.contacts) > 5
    for suffix in (".npz", ".mcap"):
        again = mars2d.load(record.save(tmp_path / f"run{suffix}"))
        assert again.digest == record.digest
        assert surfaces_of(again.scenario) == surfaces_of(record.scenario)
        assert again.scenario.material_pairs == record.scenario.material_pairs
    assert rerun(again) is None


def test_plain_data_without_these_fields_are_read_as_before():
    def stripped(value):
        if isinstance(value, list):
            return [stripped(item) for item in value]
        if not isinstance(value, dict):
            return value
        new = {"friction_rule", "restitution_rule", "material_pairs", "static_friction",
               "static_ground_friction"}  # fmt: skip
        return {key: stripped(item) for key, item in value.items() if key not in new}

    old = Scenario(robots=[Robot(friction=0.3)], props=[Puck(pose=(1, 1, 0))])
    assert to_scenario(stripped(from_description(old)))[0] == old


def test_the_editor_keeps_it():
    scenario = rich()
    edited = Draft(scenario).scenario()
    assert surfaces_of(edited) == surfaces_of(scenario)
    assert edited.material_pairs == scenario.material_pairs
    assert edited.friction_rule == "geometric"


def test_an_option_sets_it():
    changed = override(
        rich(), {"material_pairs.0.friction": 0.0625, "robots.*.friction": "steel",
                 "friction_rule": "mean", "props.0.static_ground_friction": None},
    )  # fmt: skip
    assert changed.material_pairs[0].friction == 0.0625
    assert material_of(changed.robots[0].friction) == "steel"
    assert changed.props[0].resting_friction == 0.5
