"""Environments of gymnasium and PettingZoo: spaces, rewards, ends, seeds, records, errors."""

import warnings

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from pettingzoo.test import parallel_api_test, parallel_seed_test

import mars2d.rl
from mars2d import Holonomic, InputError, Robot, Scenario
from mars2d.addons import Game
from mars2d.addons.contest import Contest, Outcome
from mars2d.rl import Environment, ParallelEnvironment
from mars2d.rl.registration import IDS
from mars2d.scenario.observation import Observation
from mars2d.sensors import Bumper, Imu, RangeBearing, RangeFinder
from mars2d.world.verify import rerun
from mars2d.world.world import World
from tests.cases import each_case


def chase(apart=3.0, stop_time=5.0, **fields):
    """A pursuer at (0, 0), and an evader that stands still at (apart, 0)."""
    robot = Robot(drive=Holonomic(), sees="positions")
    return Scenario(
        robots=[robot.at(0, 0).replace(name="red"), robot.at(apart, 0).replace(name="blue")],
        stop_time=stop_time,
        addons=[Game({"pursuer": ["red"], "evader": ["blue"]})],
        **fields,
    )


def herd(apart=1.0):
    """A pursuer, and two evaders that are caught in turn if it goes straight on."""
    robot = Robot(drive=Holonomic(), sees="positions")
    names = {"red": 0, "blue": apart, "green": 2 * apart}
    return Scenario(
        robots=[robot.at(x, 0.6 * (x > 0)).replace(name=name) for name, x in names.items()],
        stop_time=20,
        addons=[Game({"pursuer": ["red"], "evader": ["blue", "green"]}, capture=0.7)],
    )


def steps(environment, action, seed=0):
    environment.reset(seed=seed)
    while True:
        *results, terminated, truncated, info = environment.step(action)
        yield *results, terminated, truncated, info
        if terminated or truncated:
            return


@each_case("name", IDS)
def test_what_is_registered_passes_the_check_of_gymnasium_without_a_warning(name):
    environment = gymnasium.make(name, render_mode="rgb_array")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(environment.unwrapped, skip_render_check=True)
    environment.reset(seed=1)
    picture = environment.render()
    assert picture.shape == (480, 640, 3)
    assert picture.std() > 10  # something is drawn
    environment.close()


def test_who_is_out_of_a_game_ends_alone_while_the_others_go_on():
    environment = ParallelEnvironment(herd(), record=True)
    environment.reset(seed=1)
    chasing = {"red": [1, 0], "blue": [0, 0], "green": [0, 0]}
    while len(environment.agents) == 3:
        seen, rewards, terminated, truncated, infos = environment.step(
            {agent: chasing[agent] for agent in environment.agents}
        )
    assert environment.agents == ["red", "green"]
    assert terminated == {"red": False, "blue": True, "green": False}
    assert rewards == {"red": 0, "blue": -1, "green": 0}
    assert truncated == dict.fromkeys(chasing, False)
    assert not any(infos.values())
    with pytest.raises(InputError, match="blue is out of the game already"):
        environment.step(chasing)
    while environment.agents:
        seen, rewards, terminated, *_ = environment.step({"red": [1, 0], "green": [0, 0]})
    assert set(seen) == set(rewards) == set(terminated) == {"red", "green"}
    assert rewards == {"red": 1, "green": -1}
    assert terminated == {"red": True, "green": True}
    assert rerun(environment.record) is None


@each_case(
    "make, cycles",
    [
        (lambda: ParallelEnvironment(herd(apart=0.7)), 300),
        (lambda: ParallelEnvironment("corner_game", options={"stop_time": 3}), 100),
    ],
)
def test_the_parallel_environment_passes_the_tests_of_pettingzoo_without_a_warning(make, cycles):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        parallel_api_test(make(), num_cycles=cycles)
        parallel_seed_test(make, num_cycles=50)


def test_a_capture_ends_it_in_the_step_in_which_it_happens():
    *_, last = steps(Environment(chase(apart=0.8), "pursuer"), [1, 0])
    _, reward, terminated, truncated, info = last
    assert (reward, terminated, truncated) == (1.0, True, False)
    assert "catches" in info["over"]


def test_the_stop_time_truncates_and_the_record_has_all_rows():
    environment = Environment(chase(), "pursuer", record=True)
    *before, last = steps(environment, [0, 0])
    assert last[1:4] == (-1.0, False, True)  # the evader has won
    assert len(before) + 1 == environment.world.scenario.last_iteration
    assert len(environment.record) == len(before) + 2
    assert environment.record.finished


def test_a_contest_that_only_reads_records_needs_a_reward():
    class Hill(Contest):
        def outcome(self, record):
            return Outcome((), {}, None)

    scenario = chase(stop_time=0.2).replace(addons=[Hill({"red": ["red"], "blue": ["blue"]})])
    with pytest.raises(InputError, match="Hill says who has won of a record alone: give it a"):
        list(steps(Environment(scenario, "red"), [0, 0]))
    *_, last = steps(Environment(scenario, "red", reward=lambda world, robot: 0.5), [0, 0])
    assert last[1:4] == (0.5, False, True)


def test_who_leaves_the_workspace_terminates_in_the_same_step():
    environment = Environment(chase(stop_time=60, on_exit="stop"), "pursuer", record=True)
    *_, last = steps(environment, [-1, 0])
    assert last[2:4] == (True, False)
    assert "left the workspace" in last[4]["over"]
    assert environment.world.pose[0, 0] < -5


def test_an_episode_is_the_run_that_mars2d_makes_of_the_same_commands_and_replays_bit_for_bit():
    environment = Environment("corner_game", "pursuer", record=True, options={"stop_time": 4})
    for _ in steps(environment, [0.3, -0.2], seed=7):
        pass
    record = environment.record
    run = mars2d.run(
        "corner_game", stop_time=4, seed=7, options={"evader": "evaders/corners.py"},
    )  # fmt: skip
    assert np.array_equal(record.pose[0], run.pose[0])  # the same start
    assert rerun(record) is None


def test_the_same_seed_gives_the_same_episode_and_others_follow_from_it():
    one, two = (Environment("corner_game", "evader") for _ in range(2))
    first = [one.reset(seed=3)[0], one.reset()[0], one.reset()[0]]
    again = [two.reset(seed=3)[0], two.reset()[0], two.reset()[0]]
    assert np.array_equal(first, again)
    assert not np.array_equal(first[0], first[1])
    assert not np.array_equal(first[1], first[2])


def test_an_action_is_a_share_of_the_bounds_of_the_drive():
    environment = Environment(chase(), "red")
    environment.reset(seed=0)
    environment.step([0.5, -2.0])  # beyond -1 it is clipped
    assert environment.world.pose[:2, 0] == pytest.approx([0.025, -0.05], rel=0.2)
    assert environment.world.command[:, 0] == pytest.approx(
        Holonomic().saturate(np.array([[0.25], [-0.5]]))[:, 0]
    )


def test_an_observation_has_what_its_law_may_see_within_bounds():
    robot = Robot(pose=(1, 2, np.pi / 2), sensors=[RangeFinder(beams=4), Bumper(), Imu()])
    other = Robot(pose=(1, 3, np.pi))
    names = {
        "sensors": [], "positions": ["pose", "positions"], "partial": ["pose", "poses"],
        "full": ["pose", "poses"],
    }  # fmt: skip
    for sees, expected in names.items():
        world = World(Scenario(robots=[robot.replace(sees=sees), other]))
        world.observe()
        seen = Observation.of(world.scenario, 0, world.robots[0])
        sensed = ["sense.range_finder", "sense.bumper", "sense.imu"]
        assert [part.name for part in seen.parts] == expected + sensed
        row = seen(world.robots[0])
        assert ((row >= seen.low.astype("f4")) & (row <= seen.high.astype("f4"))).all()
    ahead = row[4:8]  # a unicycle sees others from itself
    assert ahead == pytest.approx([1, 0, 0, 1], abs=1e-6)
    assert row[8:12] == pytest.approx([5, 5, row[10], 5])  # nothing within the range: its end
    assert np.isinf(seen.high[-3:]).all()


def test_laws_of_others_are_given_by_role():
    still = Environment("corner_game", "pursuer", laws={"evader": lambda robot: (0, 0)})
    for _ in steps(still, [0, 0]):
        if still.world.iteration == 20:
            break
    assert np.array_equal(still.world.pose[:, 1], still.world.scenario.robots[1].pose)


class Crab(mars2d.Drive):
    """A drive without bounds."""

    def twist(self, command):
        return np.array([command[0], command[1], 0 * command[0]])


def after_the_end():
    environment = Environment(chase(apart=0.8), "pursuer")
    assert list(steps(environment, [1, 0]))
    environment.step([1, 0])


def no_action():
    environment = ParallelEnvironment(chase())
    environment.reset(seed=1)
    environment.step({"red": [0, 0]})


def rewarded(**robot):
    return Environment(Scenario(robots=[Robot(**robot)]), reward=lambda world, robot: 0)


def stepped(action):
    environment = Environment(chase(), "red")
    environment.reset(seed=1)
    environment.step(action)


WRONG = {
    "shape (3,): expected shares of its bounds for (vx, vy)": lambda: stepped([1, 2, 3]),
    "red is (1.0, nan)": lambda: stepped([1, float("nan")]),
    "red is 'left'": lambda: stepped("left"),
    "there is no such robot or role; did you mean 'pursuer'?": lambda: Environment(
        chase(), "pursuers"
    ),
    "there is no learner 'rod'; did you mean 'red'?": lambda: ParallelEnvironment(
        chase()
    ).action_space("rod"),
    "laws: red learns": lambda: Environment(chase(), "red", laws={"pursuer": lambda robot: (0, 0)}),
    "laws of evder: there is no such robot or role; did you mean 'evader'": lambda: Environment(
        chase(), "red", laws={"evder": lambda robot: (0, 0)}
    ),
    "the episode is over": after_the_end,
    "there is no action of blue": no_action,
    "reward = None": lambda: Environment(Scenario(robots=[Robot()])),
    "reward returned nan": lambda: next(
        steps(Environment(chase(), "red", reward=lambda world, robot: np.nan), [0, 0])
    ),
    "did you mean 'rgb_array'": lambda: Environment(chase(), "red", render_mode="rgb_aray"),
    "does not limit its commands": lambda: rewarded(drive=Crab()),
    "sees sensors only, and carries none": lambda: rewarded(sees="sensors"),
    "not a fixed number of numbers": lambda: rewarded(sensors=[RangeBearing()]),
    "no record is kept": lambda: Environment(chase(), "red").record,
}


@each_case("words", WRONG)
def test_what_is_wrong_is_said_in_one_line(words):
    with pytest.raises(InputError) as caught:
        WRONG[words]()
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.slow
def test_a_window_shows_an_episode_and_closes(monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    environment = Environment(chase(apart=0.8), "pursuer", render_mode="human")
    assert list(steps(environment, [1, 0]))
    environment.close()
    environment.close()
