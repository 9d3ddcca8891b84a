"""A law sees what its setting allows, and nothing else: each name, in each setting."""

import numpy as np
import pytest

import mars2d
from mars2d import Addon, Holonomic, LawError, Robot, Scenario, Sensor, World
from mars2d.addons import Communication
from mars2d.world.team_view import TeamPositionsView
from mars2d.world.views import VIEWS, Neighbour, PropView, RobotView
from tests.cases import each_case
from tests.worlds import untimed

OF_ITSELF = {
    "command", "diameter", "drive", "effort", "inbox", "index", "memory", "name", "radius", "rng",
    "sampling_time", "send", "sense", "time",
}  # fmt: skip
ITS_STATE = {"contacts", "pose", "position", "velocity"}
OTHERS = {"neighbours"}
ALL = {"world"}

ALLOWED = {
    "full": OF_ITSELF | ITS_STATE | OTHERS | ALL,
    "partial": OF_ITSELF | ITS_STATE | OTHERS,
    "positions": OF_ITSELF | ITS_STATE | OTHERS,
    "sensors": OF_ITSELF,
    "team": OF_ITSELF | OTHERS | {"position"},
}
"""What of `robot` a law may touch; "team": of world.robots, where the team's law sees positions."""

REFUSALS = {
    "partial": "this law sees itself and its neighbours only",
    "positions": "this law sees itself and its neighbours' positions only",
    "sensors": "this law sees sensors only",
    "team": "this law sees positions only",
}

OF_POSITIONS = {
    "addons", "bounds", "command", "effort", "iteration", "obstacles", "position", "rng", "robots",
    "sampling_time", "stop", "time", "workspace",
}  # fmt: skip
"""What of `world` a law may touch that sees positions only."""

MORE = {
    "contacts", "filename", "finished", "fork", "frame", "geometric_center", "history", "hold",
    "neighbour_indices", "observe", "over", "over_message", "pose", "prop_pose", "prop_velocity",
    "props", "record", "scenario", "seed", "step", "stream", "surroundings", "velocity",
}  # fmt: skip
"""What else there is, which tells more than positions."""

OF_WHO_RUNS_IT = {
    "break_off", "change", "control", "energy", "momentum", "operator", "recorder",
    "reset", "simulation", "watch",
}  # fmt: skip
"""What a World has and no law."""


def names(thing):
    return {name for name in dir(thing) if not name.startswith("_")}


def views():
    """A view of each setting."""
    robots = [Robot(sees=sees).at(k, 0) for k, sees in enumerate(VIEWS)]
    world = World(Scenario(robots=robots))
    inside = world.simulation
    own = {sees: VIEWS[sees](inside, i, inside.minds[i]) for i, sees in enumerate(VIEWS)}
    return own | {"team": TeamPositionsView(inside).robots[0]}


def asked(question, sees, **fields):
    """What a law of the setting is answered, in a run; it asks `question(robot)`."""
    answers = []

    def law(robot):
        answers.append(question(robot))
        return 0, 0

    def control(world):
        answers.append(question(world.robots[0]))
        return np.zeros((2, 2))

    own = {} if sees == "team" else {"controller": law, "sees": sees}
    scenario = Scenario(
        robots=[Robot(pose=(1, 2, 3), **own), Robot(pose=(2, 2, 1))],
        sees="positions" if sees == "team" else "full",
        addons=[Communication()],
        stop_time=0.0,
        **fields,
    )
    mars2d.run(scenario, control=control if sees == "team" else None)
    return answers[0]


def asked_world(question, robots=2, **fields):
    """What a law of the team is answered that sees positions only; it asks `question(world)`."""
    answers = []

    def control(world):
        answers.append(question(world))
        return np.zeros((2, robots))

    team = [Robot(pose=(k, 2, 1 + k)) for k in range(robots)]
    scenario = Scenario(robots=team, sees="positions", stop_time=0.0, **fields)
    mars2d.run(scenario, control=control)
    return answers[0]


# -- each name, in each setting ---------------------------------------------------------------


def test_each_name_of_a_robot_is_known_to_this_test():
    assert names(views()["full"]) == ALLOWED["full"]


def test_each_name_of_a_world_is_known_to_this_test():
    world = World(Scenario())
    assert names(world) == OF_POSITIONS | MORE | OF_WHO_RUNS_IT
    assert names(world.robots[0].world) == OF_POSITIONS | MORE


def test_no_view_has_names_that_others_have_not():
    for sees, view in views().items():
        assert names(view) == ALLOWED["full"], sees


def answers(thing, of):
    """What a law is answered for each name: its value, or the text of the error."""
    found = {}
    for name in sorted(of):
        try:
            found[name] = getattr(thing, name)
        except LawError as error:
            found[name] = str(error)
    return found


@each_case("sees", ALLOWED)
def test_a_law_may_use_what_its_setting_allows_and_is_refused_the_rest(sees):
    for name, answer in asked(lambda robot: answers(robot, ALLOWED["full"]), sees).items():
        if name in ALLOWED[sees]:
            assert answer is not None, name
            assert "is not available" not in str(answer), name
        else:
            assert answer.startswith(f"{REFUSALS[sees]}: robot.{name} is not available"), name


def test_a_teams_law_that_sees_positions_may_use_these_and_is_refused_the_rest():
    found = asked_world(lambda world: answers(world, OF_POSITIONS | MORE | OF_WHO_RUNS_IT))
    for name in OF_POSITIONS:
        assert "positions only" not in str(found[name]), name
    for name in MORE:
        said = f"this law sees positions only: world.{name} is not available; there is world.posi"
        assert found[name].startswith(said), name
    for name in OF_WHO_RUNS_IT:
        assert found[name].startswith(f"a world has no {name!r}"), name


# -- what is allowed is right -----------------------------------------------------------------


@each_case("sees", ["full", "partial", "positions"])
def test_a_law_sees_its_own_state_and_where_its_neighbours_are(sees):
    assert asked(lambda robot: robot.pose.tolist(), sees) == [1, 2, 3]
    assert asked(lambda robot: robot.position.tolist(), sees) == [1, 2]
    assert asked(lambda robot: [n.position.tolist() for n in robot.neighbours], sees) == [[2, 2]]


@each_case("sees", ["positions", "team"])
def test_where_only_positions_are_seen_neighbours_have_no_poses(sees):
    with pytest.raises(LawError) as raised:
        asked(lambda robot: robot.neighbours[0].pose, sees)
    assert untimed(raised.value).partition(": ")[2] == (
        "this law sees positions only: a neighbour's pose is not available; "
        "there is neighbour.position"
    )


def test_a_team_that_sees_positions_gets_them_as_its_robots_move():
    seen = []

    def control(world):
        seen.append(world.position.tolist())
        assert [robot.position.tolist() for robot in world.robots] == np.transpose(
            seen[-1]
        ).tolist()
        return np.ones((2, len(world.robots)))

    robots = [Robot(drive=Holonomic(max_linear_speed=2)).at(k, 0) for k in range(3)]
    record = mars2d.run(Scenario(robots=robots, sees="positions", stop_time=1), control=control)
    assert np.array_equal(seen, record.pose[:, :2])
    assert np.ptp(record.pose[:, 0], axis=0) == pytest.approx(1, abs=1e-9)


def test_a_team_that_sees_positions_has_readings_messages_memory_and_may_stop():
    class Compass(Sensor):
        def read(self, robot, world, rng):
            return robot.pose[2]

    def control(world):
        first, second = world.robots
        first.memory.count = getattr(first.memory, "count", 0) + 1
        first.send("hello", second.index)
        if second.inbox:
            assert second.inbox[0].content == "hello"
            assert second.sense.compass == 2.0
            world.stop(f"after {first.memory.count} steps")
        return np.zeros((2, 2))

    robots = [Robot(), Robot(pose=(1, 0, 2), sensors=[Compass()])]
    scenario = Scenario(robots=robots, sees="positions", addons=[Communication()])
    assert mars2d.run(scenario, control=control).over_message == "after 2 steps"


# -- no way round -----------------------------------------------------------------------------


@each_case("kind", [RobotView, Neighbour, PropView])
@each_case("name", ["index", "name", "pose"])
def test_what_is_seen_can_not_be_set(kind, name):
    assert getattr(kind, name).fset is None


def test_a_neighbour_that_is_kept_moves_on():
    seen = []

    def law(robot):
        friend = robot.neighbours[0]
        while True:
            seen.append(float(friend.position[0]))
            yield 0, 0

    away = Robot(pose=(1, 0, 0), controller=lambda robot: (0.5, 0))
    robots = [Robot(controller=law), away]
    mars2d.run(Scenario(robots=robots, stop_time=1, sampling_time=0.5))
    assert seen == pytest.approx([1, 1.25, 1.5])


# -- what does not depend on what laws see ----------------------------------------------------


def test_sensors_and_addons_know_all_whatever_the_laws_see():
    class Compass(Sensor):
        def read(self, robot, world, rng):
            assert len(robot.world.pose) == 3
            return robot.pose[2]

    class Judge(Addon):
        def on_step(self, world):
            self.heading = float(world.pose[2, 0])
            assert world.history.pose.shape[1:] == (3, 1)

    found = []

    def law(robot):
        found.append(robot.sense.compass)
        return 0, 0

    def control(world):
        found.append(world.addons.judge.heading)
        return np.zeros((2, 1))

    robot = Robot(pose=(0, 0, 2), sensors=[Compass()], controller=law, sees="sensors")
    scenario = Scenario(robots=[robot], sees="positions", addons=[Judge()], stop_time=0)
    mars2d.run(scenario, control=control)
    assert found == [2.0, 2.0]
