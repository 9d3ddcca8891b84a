"""What a law is given leads to nothing that steps, rebuilds or changes its world."""

import numpy as np
import pytest

from mars2d import Addon, LawError, Robot, Scenario, World
from mars2d.addons import Communication, Density, Game, Map, Trails, Voronoi, Waypoints
from mars2d.core.interfaces import FrameLike, RobotLike, ScenarioLike, WorldLike
from mars2d.output.films.footage import Filmed
from mars2d.output.formats.mcap.log import Logged
from mars2d.output.pages.notebook import Shown
from mars2d.sensors import RangeFinder
from tests.cases import each_case

MACHINERY = {
    "rebuild", "change", "follow", "break_off", "go_on", "recorder", "engine", "simulation",
    "operator", "watch",
}  # fmt: skip


def reached(start, depth=5):
    """Every object of the package or its containers that public attributes lead to, by its path."""
    found, known, level = {}, set(), [("subject", start)]
    for _ in range(depth):
        following = []
        for path, thing in level:
            if id(thing) in known:
                continue
            known.add(id(thing))
            found[path] = thing
            if isinstance(thing, (list, tuple)):
                following += [(f"{path}[{i}]", item) for i, item in enumerate(thing[:3])]
            elif type(thing).__module__.startswith(("mars2d", "types")):
                for name in dir(thing):
                    if not name.startswith("_"):
                        try:
                            following.append((f"{path}.{name}", getattr(thing, name)))
                        except Exception:
                            continue
        level = following
    return found


def scenario(law=None, **fields):
    return Scenario(
        robots=[
            Robot(controller=law, sensors=[RangeFinder(beams=4)], name="red"),
            Robot(pose=(2, 0, 0), name="blue"),
        ],
        props=[],
        addons=[
            Communication(), Density(lambda x, y: 1 + x * x), Voronoi(), Trails(),
            Map([[(4, 4), (4, 5)]]), Waypoints([[(1, 0)], [(3, 0)]]),
            Game({"pursuer": ["red"], "evader": ["blue"]}),
        ],
        workspace=[(-5, -5), (5, -5), (5, 5), (-5, 5)],
        **fields,
    )  # fmt: skip


@each_case("sees", ["full", "positions"])
def test_no_public_attribute_of_what_a_law_is_given_leads_to_the_machinery(sees):
    given = []

    def law(robot):
        given.append(reached(robot))
        return 0, 0

    def control(world):
        given.append(reached(world))
        return np.zeros((2, 2))

    World(scenario(law, sees=sees), control).step()
    assert len(given) == 2
    for found in given:
        assert len(found) > 50
        for path, thing in found.items():
            assert not isinstance(thing, World), path
            names = {name for name in MACHINERY if name in dir(thing)}
            if not type(thing).__module__.startswith("mars2d.world"):
                names &= {"rebuild", "follow", "break_off", "go_on", "recorder", "engine"}
            assert not names, (path, names)


def test_a_law_that_wants_the_machinery_is_told_that_there_is_none():
    world = World(Scenario(), lambda world: world.operator.hold(0))
    with pytest.raises(LawError, match="a world has no 'operator'"):
        world.step()


def test_a_law_that_steps_its_world_is_refused():
    world = World(Scenario(), lambda world: world.step())
    with pytest.raises(LawError, match=r"world.step\(\) was called from within a step"):
        world.step()


def test_a_law_may_stop_its_world_and_hold_a_robot():
    def control(world):
        world.hold("red")
        if world.iteration == 3:
            world.stop("enough")
        return np.ones((2, 2))

    world = World(scenario(), control)
    while not world.over:
        world.step()
    assert world.over_message == "enough"
    assert not world.record.command[:, :, 0].any()
    assert world.record.command[:, 0, 1].all()


def test_addons_and_watchers_are_given_the_world_itself():
    given = []

    class Witness(Addon):
        def on_start(self, world):
            given.append(world)

        def on_step(self, world):
            given.append(world)

    world = World(Scenario(addons=[Witness()]), watch=given.append)
    world.step()
    assert given == [world] * 3


def members(protocol):
    return {name for name in dir(protocol) if not name.startswith("_")}


@each_case(
    ("protocol", "given"),
    [
        (ScenarioLike, lambda world: world.scenario),
        (FrameLike, lambda world: world.frame),
        (RobotLike, lambda world: world.robots[0]),
        (WorldLike, lambda world: world),
        (WorldLike, lambda world: world.robots[0].world),
        (Filmed, lambda world: world),
        (Logged, lambda world: world),
        (Shown, lambda world: world),
    ],
)
def test_what_parts_are_given_has_all_that_its_protocol_promises(protocol, given):
    world = World(scenario())
    assert members(protocol) <= {*dir(given(world)), *vars(type(given(world)))}
