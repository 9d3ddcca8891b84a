"""The examples: short enough to project, and the same to the last bit from run to run."""

import os
import platform
import subprocess
import sys
from importlib.metadata import version

import numpy as np
import pytest

import mars2d
from mars2d.scenario.experiment import examples
from tests.house.make_golden import SETTINGS, Golden

# Another platform or engine may round the last digit differently: it is held to the golden paths.
DIGESTS = {
    "billiards": "e207cac9e1ed828edd63fa54d7e8f8722ab5f05086e04ec83963c538395209b6",
    "braitenberg": "e8431f3f2803ffe1cba4d1b8a6598ef870caa02e5505e1c13ec7cd217272d267",
    "circular_motion": "c7971ed1056bc95ba0dcdadd9b03a0a156fde13b7cd5ee7fc090d620189a1c46",
    "corner_game": "89794aa64dcf4c84667d21801a9da3b6a23abb72b2987aa930a3215876f88138",
    "coverage_circle": "6232c722454c29da4d6f858474f23346acc163113cc8bd4e7878b7355266e576",
    "coverage_square": "14bcc4e2b8722ae1f22063066e65eb39c2f05f89b22c766c8031c68eb281ccd2",
    "crowd": "e539b342566aa40f9db17df3a70f9a82abf9083ba66c1483c1154337f5a10a68",
    "cyclic_pursuit": "812d1f69fde55312f16fe5b7f4beea39bee4508c352679ddbf5c1fbe0f023ac6",
    "dead_reckoning": "02415f80d530e7dfe96735b22ba92116f61f0bfc67cedf6e0066698f60a22c2b",
    "flocking": "d412c201d687d6b6d384bd946e1ae27c250f200faf00590a02ed0ebd624b59f7",
    "follow_the_leader": "7b1006cac62a2b6f748e4bb3e1d8a093511f7bbeadc54adbf01f899a89a14ea9",
    "formation": "1c31cd58f092e912c62055fa40145f8c5a437b19ee52c740373c51da50038aff",
    "go_to_point": "134bf40bd439dfe82d92c445d0ada05cb206505e1e422d494e5bd86bde8009a0",
    "head_on": "5ce7648ada31000408869070db8b0bfd311854d577a2bfbf00ea9fdcffc1e1fa",
    "herding": "939eac47aef1293a0c800911698967a1a3e195e605e089c033f324b62353028d",
    "leader_following": "916ae150e9d54cb2e4ca098a641583d4cb5ee98bdcfdae72222a09066999316e",
    "many_push_one": "87b39622c95b0632e652cb5fd66d98bd4878abcdaa40ce68febeea28851a480f",
    "material_pairs": "3fa52ea5d2606155466214ab8c135115883a125931d87e8772935739b54b9e8b",
    "obstacle_avoidance": "1c03896cfacffecd4462943e8817138e10d3a184cfe40140575e5b96b83925f1",
    "own_sensor_and_addon": "21cf5c7223c40110ba16b71c16767ea62de9afc2300bec5e17a3e189f13e987b",
    "path_planning": "527f1aecadd141f2bdeb3cb81fca98f15830d7eea831d0e9922ff49a19da2ceb",
    "pursuit_corners": "3d9f884527c7cf3c8ace85397f792879e5761ebadd259e839810998de692ac9d",
    "pursuit_voronoi": "16943d1f6cbf55b80dc17b51e3bab68771c4d481ab7a0cb9da09a6515106c69c",
    "push_box": "66da118d3ffee6d57fdc2e4ad8d1bfd998c17964f5b90614aac88c8d4974dcc7",
    "random_walk": "2ac911c38b77c2cd0929360da1b7bdd0d200bc1bf46b3513ad5acec93313647c",
    "rendezvous": "e6d6cdb7ab189f90a86169dfea16b87e34b4e3311cbc088de759d2d6ec47ffb0",
    "shove_and_spin": "0cff0a7143b1f8636d5a15d664e38f8088d1e2ac5822a0052038cd4eb4b94699",
    "stick_slip": "08fbecedee7e877e8b21e712ca67decafc6cc9733fc3a1204d05360024298b6c",
    "sumo": "0b51cb55614fb058e71a0db9105546b2527a973dbe0e503eabac8edc678cfec4",
    "token_ring": "9eed2e88451125b5f3a822182608e43b05eba76b9be02fc2389015c8dc7e6c6f",
    "tug_of_war": "053449a36f1973c352c44c04987961f5cf50b032cdd37246ecd4c650d913d5d3",
    "wall_follower": "08bc7f1895ac7630c56b40b079fd48fcdd6fb6047e0d271de171c35ca32fa56d",
    "wall_slide": "e2414b6de83a791b4d26885ae9914cd55d408b65dd90521875e0fc40c012d498",
}
ON_THE_PINNED_PLATFORM = (
    sys.platform == "linux"
    and platform.machine() == "x86_64"
    and platform.libc_ver()[0] == "glibc"
    and version("pymunk").startswith("7.3.")
)


def test_every_example_is_pinned():
    assert set(examples()) == set(DIGESTS)


SLOW = {
    "circular_motion", "coverage_square", "dead_reckoning", "flocking", "obstacle_avoidance",
    "pursuit_corners", "pursuit_voronoi",
}  # fmt: skip
"""Examples that take a second and more."""


@pytest.mark.parametrize(
    "name",
    [pytest.param(n, marks=[pytest.mark.slow] if n in SLOW else []) for n in DIGESTS],
)
def test_an_example_goes_its_golden_way_and_where_digests_are_pinned_has_its_own(name):
    record = mars2d.run(name)
    if ON_THE_PINNED_PLATFORM:
        assert record.digest == DIGESTS[name]
    settings = SETTINGS.get(name)
    if settings is not None:
        record = mars2d.run(name, options=settings)
    assert Golden.read(name).excess(record) < 1


@pytest.mark.soak
def test_older_processors_give_the_same_digests():
    """numpy picks its routines by processor; here those of older ones, as far as there are any."""
    from numpy._core._multiarray_umath import __cpu_dispatch__, __cpu_features__

    newer = [name for name in __cpu_dispatch__ if __cpu_features__.get(name)]
    if not newer:
        pytest.skip("numpy has only one set of routines for this processor")
    code = f"import mars2d; print(*[mars2d.run(n).digest for n in {list(DIGESTS)}])"

    def digests(**extra: str) -> list[str]:
        done = subprocess.run(
            [sys.executable, "-W", "ignore", "-c", code],
            env=os.environ | extra, capture_output=True, text=True, check=True,
        )  # fmt: skip
        return done.stdout.split()

    # Where they are pinned, the test above has seen those of this processor.
    here = [*DIGESTS.values()] if ON_THE_PINNED_PLATFORM else digests()
    assert digests(NPY_DISABLE_CPU_FEATURES=" ".join(newer)) == here


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
