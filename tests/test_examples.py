"""The examples: short enough to project, and the same to the last bit from run to run."""

import os
import platform
import subprocess
import sys
from importlib.metadata import version

import numpy as np
import pytest

import mars2d
from mars2d.files import examples

# Another platform or engine may round the last digit differently.
DIGESTS = {
    "follow_the_leader": "32df3379b40f872b4711737dc09a7f8b20175fe3662a7418c401ce53c2f97ca6",
    "go_to_point": "5993df66e130eba797152ee608536bc86f135ab50b3ac8322b1925f2c0330c17",
    "own_sensor_and_addon": "9a7420ea70f7164023f522f4cf16f27c9ff609db5ac5a0ad93a081702b5ccc85",
    "random_walk": "332532de78425b562c85409727befe00eebf8aefb62417f500fd3da9a127385c",
}
PINNED_ON = "Linux x86_64 with pymunk 7.3"
ON_THE_PINNED_PLATFORM = (
    sys.platform == "linux"
    and platform.machine() == "x86_64"
    and version("pymunk").startswith("7.3.")
)


def test_every_example_is_pinned():
    assert set(examples()) == set(DIGESTS)


@pytest.mark.parametrize("name", DIGESTS)
@pytest.mark.skipif(not ON_THE_PINNED_PLATFORM, reason=f"digests are pinned on {PINNED_ON}")
def test_an_example_has_its_pinned_digest(name):
    assert mars2d.run(name).digest == DIGESTS[name]


def test_older_processors_give_the_same_digests():
    """numpy picks its routines by processor; here those of older ones, as far as there are any."""
    from numpy._core._multiarray_umath import __cpu_dispatch__, __cpu_features__

    newer = [name for name in __cpu_dispatch__ if __cpu_features__.get(name)]
    if not newer:
        pytest.skip("numpy has only one set of routines for this processor")
    code = f"import mars2d; print([mars2d.run(n).digest for n in {list(DIGESTS)}])"
    outputs = [
        subprocess.run(
            [sys.executable, "-W", "ignore", "-c", code],
            env=os.environ | extra, capture_output=True, text=True, check=True,
        ).stdout
        for extra in ({}, {"NPY_DISABLE_CPU_FEATURES": " ".join(newer)})
    ]  # fmt: skip
    assert outputs[0] == outputs[1]


@pytest.mark.parametrize("name", DIGESTS)
def test_an_example_is_short_enough_to_project(name):
    lines = examples()[name].read_text().splitlines()
    assert len(lines) <= 60
    assert max(map(len, lines)) <= 100
    assert lines[0].startswith('"""')


def test_random_walk_is_the_papers_algorithm_2():
    record = mars2d.run("random_walk")
    assert record.time[-1] == 1000.0
    assert record.scenario.initial_pose.T.tolist() == [[1, 3, 0], [9, 7, np.pi]]
    seen, command = record.sensors["proximity"], record.command
    for robot in (0, 1):
        for k in range(1, len(record)):
            v, omega = command[k, :, robot]
            if seen[k, robot]:
                assert (v, omega) == (-0.2, 0.0)
            elif command[k - 1, 0, robot] < 0:
                assert v == 0.0
                assert np.pi / 2 <= omega <= 3 * np.pi / 2
            else:
                assert (v, omega) == (0.2, 0.0)
    assert seen.any(axis=0).all()


def test_go_to_point_brings_both_robots_to_their_goals():
    record = mars2d.run("go_to_point")
    assert "arrived" in record.over_message
    goals = np.array([[4, 2], [4, -2]]).T
    assert np.hypot(*(record.pose[-1, :2] - goals)).max() < 0.02
    assert np.all(record.pose[:, 2, 0] == 2.0)  # the holonomic robot keeps its heading


def test_followers_keep_behind_their_leader():
    record = mars2d.run("follow_the_leader")
    gaps = np.hypot(*np.diff(record.pose[:, :2], axis=2).transpose(1, 0, 2))
    assert record.collisions == 0
    assert gaps[300:].max() < 1.0
    assert gaps.min() > 0.3


def test_the_lamps_are_found():
    record = mars2d.run("own_sensor_and_addon")
    assert record.over_message.startswith("All 3 lamps were found")
    assert record.sensors["eyes"].shape == (len(record), 3, 2)
