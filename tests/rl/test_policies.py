"""Laws that were learned: loaded from ONNX files, checked, played in a tournament, refused."""

import json
import subprocess
import sys

import numpy as np
import onnx
import pytest
from onnx import TensorProto, helper, numpy_helper

import mars2d
from mars2d import Holonomic, InputError, LawError, Robot, Scenario, World, load_law
from mars2d.cli.command_line import main
from mars2d.rl import Environment
from mars2d.sensors import RangeFinder
from tests.cases import each_case


def save(path, metadata, action=(0.5, 0.0), size=6, outputs=2):
    """Write a network that always returns `action`, whatever it sees."""
    bias = np.resize(np.array(action, np.float32), outputs)
    graph = helper.make_graph(
        [helper.make_node("Gemm", ["observation", "w", "b"], ["action"])],
        "policy",
        [helper.make_tensor_value_info("observation", TensorProto.FLOAT, [1, size])],
        [helper.make_tensor_value_info("action", TensorProto.FLOAT, [1, outputs])],
        [
            numpy_helper.from_array(np.zeros((size, outputs), np.float32), "w"),
            numpy_helper.from_array(bias, "b"),
        ],
    )
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)
    if metadata is not None:
        helper.set_model_props(model, metadata)
    onnx.save(model, path)
    return path


@pytest.fixture(scope="module")
def spaces():
    return Environment("corner_game", "pursuer").policy_metadata


@pytest.fixture
def policy(spaces, tmp_path):
    return save(tmp_path / "hunter.onnx", {"mars2d": spaces})


def test_a_policy_decides_as_the_environment_asked_it_by_shares_of_the_bounds(policy):
    environment = Environment("corner_game", "pursuer", record=True, options={"stop_time": 2})
    environment.reset(seed=4)
    for _ in range(20):
        environment.step([0.5, 0.0])
    options = {"pursuer": str(policy)}
    run = mars2d.run("corner_game", stop_time=2, seed=4, options=options)
    assert np.array_equal(environment.record.pose, run.pose)
    assert run.command[:, :, 0] == pytest.approx(np.tile([0.2, 0.0], (21, 1)))


def test_a_world_with_a_policy_forks(policy):
    robot = Robot(drive=Holonomic(max_linear_speed=0.45), sees="positions")
    law = load_law(policy)
    world = World(Scenario(robots=[robot.at(0, 0).replace(controller=law), robot.at(2, 0)]))
    world.step()
    fork = world.fork()
    fork.step()
    world.step()
    assert np.allclose(fork.pose, world.pose)


def test_the_trained_pursuer_catches_and_forfeits_nothing_in_the_default_game(capsys):
    from mars2d.scenario.examples import examples

    file = examples()["corner_game"].with_name("learned.onnx")
    command = ["check", str(file), "--for", "corner_game", "--role", "pursuer"]
    assert main([*command, "--set", "stop_time=3"]) == 0
    assert "forfeited none" in capsys.readouterr().out
    options = {"pursuer": str(file), "mu": 1.2}
    record = mars2d.run("corner_game", stop_time=60, seed=1, options=options)
    assert "red catches blue" in record.over_message


def changed(metadata, **values):
    return {"mars2d": json.dumps(json.loads(metadata) | values)}


PART = {"name": "posse", "low": [0], "high": [1]}

BROKEN = {
    "no network in the format ONNX": lambda path, spaces: path.write_bytes(b"nonsense"),
    "has no metadata 'mars2d' with its spaces": lambda path, spaces: save(path, None),
    "no metadata 'mars2d' with its spaces; did you mean 'mars'": lambda path, spaces: save(
        path, {"mars": spaces}
    ),
    "has metadata 'mars2d' that can't be read": lambda path, spaces: save(path, {"mars2d": "{"}),
    "its observation has a part 'posse'; did you mean 'pose'": lambda path, spaces: save(
        path, changed(spaces, observation=[PART])
    ),
    "takes tensor(float) [1, 4]; its metadata say one tensor(float) [1, 6]": lambda p, s: save(
        p, {"mars2d": s}, size=4
    ),
    "returns [1, 3], expected an action [1, 2]": lambda path, spaces: save(
        path, {"mars2d": spaces}, outputs=3
    ),
}  # fmt: skip


@each_case("words", BROKEN)
def test_a_broken_file_is_one_line_that_names_it(words, spaces, tmp_path):
    path = tmp_path / "hunter.onnx"
    BROKEN[words](path, spaces)
    with pytest.raises(InputError) as caught:
        load_law(path)
    assert words in str(caught.value)
    assert "hunter.onnx" in str(caught.value)
    assert "\n" not in str(caught.value)


HOLONOMIC = Robot(drive=Holonomic(), sees="positions")

MISFITS = {
    "commands a Holonomic, and robot0 is a Unicycle": Scenario(robots=[Robot()]),
    "positions of robot0 has 2 numbers, expected 4": Scenario(
        robots=[HOLONOMIC, HOLONOMIC.at(2, 0)]
    ),
    "robot.pose is not available": Scenario(
        robots=[HOLONOMIC.replace(sees="sensors", sensors=[RangeFinder()])]
    ),
}


@each_case("words", MISFITS)
def test_a_robot_that_does_not_fit_is_said_to_in_what(words, tmp_path):
    team = Scenario(robots=[HOLONOMIC.at(x, 0) for x in (-2, 0, 2)])
    spaces = Environment(team, reward=lambda world, robot: 0.0).policy_metadata
    law = load_law(save(tmp_path / "hunter.onnx", {"mars2d": spaces}, size=8))
    scenario = MISFITS[words]
    robots = [robot.replace(controller=law) for robot in scenario.robots[:1]]
    world = World(scenario.replace(robots=[*robots, *scenario.robots[1:]]))
    with pytest.raises(LawError) as caught:
        world.step()
    assert words in str(caught.value)
    assert "hunter.onnx" in str(caught.value)


@pytest.mark.slow
def test_the_training_script_writes_a_law_and_its_curve(tmp_path):
    from mars2d.scenario.examples import examples

    pytest.importorskip("stable_baselines3")
    script = examples()["corner_game"].parents[2] / "learning" / "train.py"
    law = tmp_path / "law.onnx"
    command = [sys.executable, str(script), "mars2d/Push-v0", "--steps", "8192", "--out", str(law)]
    subprocess.run(command, check=True, timeout=300)
    assert callable(load_law(law))
    assert law.with_suffix(".png").stat().st_size > 1000
