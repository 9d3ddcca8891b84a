"""Many worlds in one environment: each as alone, to the bit; spaces, ends and what is wrong."""

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

from mars2d import Holonomic, InputError, Robot, Scenario, Unicycle
from mars2d.rl import Environment, VectorEnvironment
from mars2d.rl.registration import IDS
from mars2d.scenario.random_starts import RandomStarts
from tests.cases import each_case


def chased(drive):
    """Two robots that start at random, and soon touch; the second one goes at random."""
    robot = Robot(drive=drive, sees="partial")

    def stray(robot):
        return tuple(robot.rng.uniform(-0.5, 0.5, 2))

    return Scenario(
        robots=[robot.replace(name="red"), robot.replace(name="blue", controller=stray)],
        workspace=[(-1, -1), (1, -1), (1, 1), (-1, 1)],
        random_starts=[RandomStarts()],
        on_exit="stop",
        stop_time=1.5,
    )


def apart(world, robot):
    return float(np.ptp(world.pose[0]))


CASES = {
    "a game": ("corner_game", {"options": {"stop_time": 1.2}}),
    "starts that are drawn": (chased(Holonomic()), {"reward": apart}),
    "ramps and noise": (chased(Unicycle(max_acceleration=2.0, noise=0.1)), {"reward": apart}),
    "a delay": (chased(Unicycle(dead_time=0.07)), {"reward": apart}),
}


def alone(experiment, more, seed, actions, mode):
    """Return all that one world gives alone if it starts again by itself, and its digests."""
    environment = Environment(experiment, 0, record=True, **more)
    observation, _ = environment.reset(seed=seed)
    rows, digests, ended = [(observation, 0.0, False, False)], [], False
    for action in actions:
        if ended and mode is AutoresetMode.NEXT_STEP:
            rows.append((environment.reset()[0], 0.0, False, False))
            ended = False
            continue
        *row, _ = environment.step(action)
        ended = row[2] or row[3]
        if ended:
            digests.append(environment.record.digest)
        if ended and mode is AutoresetMode.SAME_STEP:
            row[0] = environment.reset()[0]
        rows.append(tuple(row))
    return rows, digests


@each_case("mode, name", [(mode, name) for mode in list(AutoresetMode)[:2] for name in CASES])
def test_each_world_is_that_of_an_environment_alone_to_the_bit(mode, name):
    experiment, more = CASES[name]
    count, steps = 3, 40
    actions = np.random.default_rng(5).uniform(-1.2, 1.2, (steps, count, 2))
    many = VectorEnvironment(experiment, 0, count, record=True, autoreset_mode=mode, **more)
    rows = [(many.reset(seed=7)[0], *np.zeros((3, count)))]
    digests = [[] for _ in range(count)]
    for action in actions:
        worlds = [one.world.simulation for one in many.envs]
        *row, infos = many.step(action)
        rows.append(row)
        for k in np.flatnonzero(row[2] | row[3]):
            last = worlds[k]
            assert last.over
            assert infos["final_info" if mode is AutoresetMode.SAME_STEP else "over"] is not None
            digests[k].append(last.record.digest)
    assert all(digests)
    for k in range(count):
        expected, ends = alone(experiment, more, 7 + k, actions[:, k], mode)
        for here, there in zip(rows, expected, strict=True):
            for one, other in zip(here, there, strict=True):
                assert np.array_equal(one[k], other)
        assert digests[k] == ends


def test_gymnasium_makes_each_task_as_many_worlds():
    for name in IDS:
        many = gymnasium.make_vec(name, num_envs=3, render_mode="rgb_array")
        assert isinstance(many, VectorEnvironment)
        one = gymnasium.make(name)
        assert many.single_observation_space == one.observation_space
        assert many.single_action_space == one.action_space
        observations, infos = many.reset(seed=[4, None, 4])
        assert infos == {}
        assert observations in many.observation_space
        assert np.array_equal(observations[0], one.reset(seed=4)[0])
        assert np.array_equal(observations[0], observations[2])
        assert not np.array_equal(observations[0], observations[1])
        assert one.unwrapped.world.scenario.random_starts == ()  # these are drawn
        results = many.step(many.action_space.sample())
        assert [part.shape for part in results[:4]] == [observations.shape, (3,), (3,), (3,)]
        pictures = many.render()
        assert [picture.shape for picture in pictures] == [(480, 640, 3)] * 3
        many.close()


def test_where_worlds_do_not_start_again_by_themselves_a_mask_says_which_do():
    scenario = chased(Holonomic())
    many = VectorEnvironment(
        scenario, 0, 2, reward=apart, autoreset_mode="Disabled", options={"stop_time": 0.2}
    )
    many.reset(seed=1)
    many.step(np.zeros((2, 2)))
    *_, truncated, infos = many.step(np.zeros((2, 2)))
    assert truncated.all()
    assert infos["over"].tolist() == ["finished after 0.2 s"] * 2
    many.reset(options={"reset_mask": np.array([False, True])})
    assert [one.world.iteration for one in many.envs] == [2, 0]
    with pytest.raises(InputError, match="the episode is over: finished after"):
        many.step(np.zeros((2, 2)))


WRONG = {
    "num_envs = 0": lambda: VectorEnvironment("corner_game", 0, 0),
    "expected one for each of 2 worlds": lambda: two().step(np.zeros((3, 2))),
    "the action of red is an array of shape (3,)": lambda: two().step(np.zeros((2, 3))),
}


def two():
    many = VectorEnvironment(chased(Holonomic()), 0, 2, reward=apart)
    many.reset(seed=1)
    return many


@each_case("words", WRONG)
def test_what_is_wrong_is_said(words):
    with pytest.raises(InputError) as caught:
        WRONG[words]()
    assert words in str(caught.value)
