"""What a law is given leads to nothing that steps, rebuilds or changes its world."""

import numpy as np

from mars2d import Addon, Robot, Scenario, World
from mars2d.addons import Communication, Density, Game, Map, Trails, Voronoi, Waypoints
from mars2d.core.interfaces import FrameLike, RobotLike, ScenarioLike, WorldLike
from mars2d.sensors import RangeFinder
from tests.cases import each_case


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
    ],
)
def test_what_parts_are_given_has_all_that_its_protocol_promises(protocol, given):
    world = World(scenario())
    assert members(protocol) <= {*dir(given(world)), *vars(type(given(world)))}
