"""The add-on Waypoints: where robots are to go, how far they have got, and how that is drawn."""

import numpy as np
import pytest

import mars2d
from mars2d import Holonomic, InputError, LawError, Robot, Scenario, World
from mars2d.addons import Waypoints
from mars2d.core.scene import Circle, Line, Scene
from tests.cases import each_case

ROUTE = [(1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
COLORS = ["#0072b2", "#d55e00"]


def go(world):
    """Head straight for the waypoint, at 1 m/s at most."""
    ways = world.addons.waypoints
    commands = []
    for robot in world.robots:
        dx, dy = (
            (0.0, 0.0) if ways.arrived(robot.index) else ways.goal(robot.index) - robot.position
        )
        far = np.hypot(dx, dy)
        commands.append((dx, dy) if far <= 1 else (dx / far, dy / far))
    if all(ways.arrived(robot.index) for robot in world.robots):
        world.stop("all are there")
    return np.transpose(commands)


def scenario(*routes, robots=None, **options):
    fast = Holonomic(max_linear_speed=2)
    team = [Robot(pose=(0, 2 * i), drive=fast, color=c) for i, c in enumerate(COLORS)]
    return Scenario(
        robots=team[: robots or max(len(routes), 1)],
        addons=[Waypoints(routes, **options)],
        stop_time=20.0,
    )


def drawn(record, row):
    scene = Scene()
    record.scenario.addons[0].draw(scene, record.frame(row))
    return scene.shapes


# -- how far ------------------------------------------------------------------------------------


def test_waypoints_are_reached_one_after_the_other_and_then_the_robot_has_arrived():
    record = mars2d.run(scenario(ROUTE, tolerance=0.1), control=go)
    assert record.over_message == "all are there"
    counts = [record.scenario.addons[0].of(record.frame(k))[0] for k in range(len(record))]
    assert counts == sorted(counts)
    assert set(counts) == {0, 1, 2, 3}
    for done, place in enumerate(ROUTE):
        x, y, _ = record.pose[counts.index(done + 1), :, 0]
        assert np.hypot(x - place[0], y - place[1]) <= 0.1


def test_a_waypoint_is_reached_at_the_tolerance_and_not_beyond():
    for x, reached in ((0.75, 1), (0.749, 0)):
        assert Waypoints([[(1, 0)]], tolerance=0.25).passed([[(x, 0)]]) == (reached,)


def test_what_laws_are_told_is_what_the_record_shows():
    world = World(scenario(ROUTE, [(2, 2), (2, -2)]), go)
    live = []
    while not world.over:
        world.step()
        live.append(world.addons.waypoints.reached)
    record, ways = world.record, world.scenario.addons[0]
    assert live == [ways.of(record.frame(k)) for k in range(len(record))]
    assert live[-1] == (3, 2)


def test_the_goal_is_the_next_waypoint_and_stays_the_last_one():
    world = World(scenario(ROUTE), go)
    ways = world.addons.waypoints
    assert (ways.goal(0), ways.arrived(0)) == (ROUTE[0], False)
    while not world.over:
        world.step()
    assert (ways.goal(0), ways.arrived(0)) == (ROUTE[2], True)
    record = world.record
    assert record.scenario.addons[0].goal(0, record.frame(0)) == ROUTE[0]


def test_robots_without_a_route_have_arrived_and_have_no_goal():
    world = World(scenario([], ROUTE, robots=2), go)
    ways = world.addons.waypoints
    assert ways.arrived(0)
    assert not ways.arrived(1)
    with pytest.raises(LawError, match="waypoints: robot 0 has no waypoints to go to"):
        ways.goal(0)
    with pytest.raises(LawError, match="robot 1 has no waypoints"):
        World(scenario(ROUTE, robots=2)).addons.waypoints.goal(1)
    with pytest.raises(LawError, match="there is no robot -1"):
        ways.goal(-1)


# -- what is drawn --------------------------------------------------------------------------------


def test_routes_are_drawn_dotted_in_the_robots_colours_from_their_starts():
    record = mars2d.run(scenario(ROUTE, [(2, 2)]), control=go)
    lines = [shape for shape in drawn(record, 0) if isinstance(shape, Line)]
    assert [line.stroke[:7] for line in lines] == [COLORS[0]] * 3 + [COLORS[1]]
    assert {line.style for line in lines} == {":"}
    assert lines[0].points.tolist() == [[0, 0], [1, 0]]
    assert lines[3].points.tolist() == [[0, 2], [2, 2]]
    dots = [shape for shape in drawn(record, 0) if isinstance(shape, Circle) and shape.fill]
    assert [dot.center for dot in dots] == [*ROUTE, (2, 2)]


# -- errors -------------------------------------------------------------------------------------


@each_case(
    ("routes", "message"),
    [
        ([], r"Waypoints.routes = \[\]: expected one list of points for each robot.*at least one"),
        ([(1, 0), (2, 0)], "put one more pair of brackets round it"),
        ([[(1, 0)], [(float("nan"), 0)]], r"Waypoints.routes\[1\]\[0\]"),
        ([[(1, 0)], 7], r"Waypoints.routes\[1\] = 7: expected a list of points"),
    ],
)
def test_routes_that_are_none_are_refused_in_words(routes, message):
    with pytest.raises(InputError, match=message):
        Waypoints(routes)


def test_a_waypoint_outside_of_the_workspace_is_named_unless_robots_may_leave_it():
    outside = scenario(ROUTE, [(2, 0), (9, 0)])
    with pytest.raises(
        InputError, match=r"Waypoints.routes\[1\]\[1\] = \(9.0, 0.0\): expected a po"
    ):
        World(outside)
    World(outside.replace(on_exit="ignore"))
    World(outside.replace(workspace=None))
