"""The same scenario, seed and version give the same run, to the last bit."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import mars2d
from mars2d import Car, Differential, Holonomic, Robot, Scenario, Unicycle, World, sensors
from mars2d.bodies.props import Ball, Bar, Box, Puck
from mars2d.geometry.shapes import Polygon
from mars2d.scenario.experiment import open_experiment
from mars2d.scenario.registry import members
from mars2d.sensors import Proximity, RangeBearing, RangeFinder, Sensor
from tests.cases import each_case

BUSTLE = Path(__file__).parent / "bustle" / "bustle.py"


def wander(robot):
    return 0.3, robot.rng.normal()


def crowd(**fields) -> Scenario:
    robots = [
        Robot(pose=(0.4 * x, 0.4 * y, x), controller=wander, **fields)
        for x in range(3)
        for y in range(3)
    ]
    box = [(-0.5, -0.5), (1.5, -0.5), (1.5, 1.5), (-0.5, 1.5)]
    return Scenario(robots=robots, workspace=box, on_exit="wall", stop_time=3)


def test_worlds_stepped_in_turn_give_what_each_gives_alone_and_other_seeds_give_others():
    alone = [mars2d.run(crowd(), seed=seed).digest for seed in range(3)]
    worlds = [World(crowd(), seed=seed) for seed in range(3)]
    while not worlds[0].over:
        for world in worlds:
            world.step()
    assert worlds[0].record.collisions > 0
    assert [world.record.digest for world in worlds] == alone
    assert len(set(alone)) == 3


def test_a_sensor_more_changes_neither_noise_nor_laws():
    class Noise(Sensor):
        def read(self, robot, world, rng):
            return rng.normal()

    plain = mars2d.run(crowd(sensors=[Noise()]), seed=3)
    more = mars2d.run(crowd(sensors=[Noise(name="first"), Noise(), Proximity(range=1)]), seed=3)
    assert np.array_equal(plain.pose, more.pose)
    assert np.array_equal(plain.sensors["noise"], more.sensors["noise"])


# -- what is added changes nothing else -----------------------------------------------------------


SENSORS = {name: {} for name in sensors.__all__ if name in members("sensors")}
SENSORS |= {"Proximity": {"range": 0.5}, "Beacon": {"range": 2.0}}
"""The fields of each shipped sensor that is added, without noise."""

ACTING = {
    "Communication": "carries messages, which laws hear, and draws which are lost",
    "Game": "is a referee: who is caught stands still, and the run may end",
    "Map": "puts obstacles in the way",
    "Ring": "is a referee: who is out has lost, and the run ends",
}
"""Add-ons that are there to change a run, and how."""

NEEDED: dict[str, dict] = {
    "Beacon": {"at": (0.4, 0.1)},
    "Density": {"function": lambda x, y: 1 / (1 + x * x + y * y)},
    "Floor": {"color": "#00ff00"},
    "Theory": {"draws": lambda scene, frame: None},
    "Waypoints": {"routes": [[(0.1, 0.1), (1.0, 0.3)]]},
}
"""The fields that an add-on must be given."""

ADDONS = {name: NEEDED.get(name, {}) for name in members("addons") if name not in ACTING}
"""The fields of each shipped add-on that is added."""


def test_all_shipped_sensors_are_added_below_and_all_addons_but_those_that_are_named():
    assert set(SENSORS) >= {n for n, kind in members("sensors").items() if shipped(kind)}
    assert {*NEEDED, *ACTING} <= {n for n, kind in members("addons").items() if shipped(kind)}


def shipped(kind: type) -> bool:
    return kind.__module__.startswith("mars2d.")


@each_case("discs", [True, False])
def test_sensors_without_noise_and_addons_without_physics_and_chance_change_nothing_else(discs):
    scenario = open_experiment(BUSTLE, {"discs": discs}, seed=3).scenario
    plain = mars2d.run(scenario, seed=3)
    assert plain.collisions >= 5
    assert plain.contents
    kinds = members("sensors")
    more = [kinds[name](name=f"more_{name}", **fields) for name, fields in SENSORS.items()]
    robots = [robot.replace(sensors=[*more, *robot.sensors]) for robot in scenario.robots]
    kinds = members("addons")
    addons = [kinds[name](name=f"more_{name}", **fields) for name, fields in ADDONS.items()]
    full = scenario.replace(robots=robots, addons=[*scenario.addons, *addons])
    after = mars2d.run(full, seed=3)
    columns = after.columns()
    assert plain.over_message == after.over_message
    assert {  # what a floor's colour is measured by is to change
        name for name, column in plain.columns().items()
        if column.tobytes() != columns[name].tobytes()
    } == {"sensor:ground"}  # fmt: skip


# -- the order of robots --------------------------------------------------------------------------


WEDGE = Polygon([(-0.15, -0.12), (0.2, 0), (-0.15, 0.12)])

DRIVES = (
    Unicycle(noise=0.1), Holonomic(noise=0.1), Car(), Differential(noise=0.1),
    Unicycle(dead_time=0.15, max_acceleration=0.5), Car(max_steering_rate=1.0),
    Differential(command="twist", max_linear_speed=0.2),
)  # fmt: skip


def loose(n: int, shape: Polygon | None = None, props: int = 0, **fields) -> Scenario:
    """Robots of all drives, and props, far enough from each other to meet nothing."""
    look = [RangeFinder(beams=7, range=3.0, noise=0.01), RangeBearing(noise=0.01, identity=False)]
    robots = [
        Robot(
            name=f"r{k}",
            pose=(2.0 * (k % 8), 2.0 * (k // 8) + 0.01 * (k % 3), 0.7 * k),
            drive=DRIVES[k % len(DRIVES)],
            mass=1.0 + 0.1 * (k % 5),
            shape=shape if k % 2 else None,
            controller=wander,
            sensors=look if k % 3 == 0 and n < 64 else (),
        )
        for k in range(n)
    ]
    things = [
        [Ball, Bar, Box, Puck][k % 4](
            name=f"p{k}", pose=(2.0 * k, -3.0, k), velocity=(0.1, 0.2 * k, 1.0 - k)
        )
        for k in range(props)
    ]
    return Scenario(
        robots=robots, props=things, workspace=None, stop_time=2.0, command_delay=0.03, **fields
    )


@each_case(
    "scenario", [loose(16, WEDGE, props=6), loose(21), loose(70), loose(21, physics="ideal")]
)
def test_robots_and_props_in_another_order_go_the_same_ways_in_that_order(scenario):
    rng = np.random.default_rng(1)
    robots, props = (rng.permutation(len(x)) for x in (scenario.robots, scenario.props))
    other = scenario.replace(
        robots=[scenario.robots[k] for k in robots], props=[scenario.props[k] for k in props]
    )
    before, after = mars2d.run(scenario, seed=1), mars2d.run(other, seed=1)
    assert before.collisions == 0
    assert np.hypot(*np.ptp(before.pose, axis=0)[:2]).min() > 0.001
    for name in ("pose", "command", "effort"):
        assert np.array_equal(getattr(before, name)[..., robots], getattr(after, name)), name
    assert np.array_equal(before.prop_pose[..., props], after.prop_pose)
    for name, values in before.sensors.items():
        place = {robot: k for k, robot in enumerate(before.sensor_robots[name])}
        rows = [place[robots[k]] for k in after.sensor_robots[name]]
        assert np.array_equal(values[:, rows], after.sensors[name], equal_nan=True), name


def test_in_contact_another_order_changes_last_digits_alone_until_chaos_makes_more_of_them():
    """The solver takes the pairs in order: what touches is the same to a tenth of a millimetre."""
    robots = [
        Robot(name="left", pose=(-0.6, 0, 0)),
        Robot(name="right", pose=(0.6, 0.12, np.pi), mass=2),
        Robot(name="above", pose=(0.1, 0.8, -np.pi / 2)),
    ]
    scenario = Scenario(robots=robots, stop_time=3.0)

    def law(world):
        return np.outer([0.3, 0.0], np.ones(3))

    before = mars2d.run(scenario, control=law)
    after = mars2d.run(scenario.replace(robots=robots[::-1]), control=law)
    assert before.collisions >= 2
    assert np.abs(before.pose - after.pose[..., ::-1]).max() < 1e-4


def test_global_random_numbers_are_neither_used_nor_changed():
    np.random.seed(0)  # noqa: NPY002 - this is what is tested
    before = np.random.get_state()[1].tolist()  # noqa: NPY002
    digest = mars2d.run(crowd(), seed=1).digest
    assert np.random.get_state()[1].tolist() == before  # noqa: NPY002
    np.random.seed(1)  # noqa: NPY002
    assert mars2d.run(crowd(), seed=1).digest == digest
