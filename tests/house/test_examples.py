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
    "billiards": "1b119fad86462a5d8cc35cefa58ccafe2e052656c5401b7563540418065b4c6e",
    "braitenberg": "fa5b3c2855c34ba929db4888325744c2ca45b007f899a4e5cd7b4a405ab2f864",
    "capture_the_flag": "b553b2b0d14f3c17b9e81f3aa98447e2ca13f9a921acda78b6218c7350fd5676",
    "circular_motion": "e53fa758636e82a5271508869ae0c029e2255bca7c1175b11b6948a36a0fee76",
    "corner_game": "2d170d696cca7a0eae66291c4b00d326d01b486f4f350d620106234308bb4542",
    "coverage_circle": "6232c722454c29da4d6f858474f23346acc163113cc8bd4e7878b7355266e576",
    "coverage_square": "14bcc4e2b8722ae1f22063066e65eb39c2f05f89b22c766c8031c68eb281ccd2",
    "crowd": "84712c73e24ddf3d69dd903816df8334952ed114f54eacf978d18dd56c29e248",
    "cyclic_pursuit": "812d1f69fde55312f16fe5b7f4beea39bee4508c352679ddbf5c1fbe0f023ac6",
    "dead_reckoning": "abcf646057647121de1dbf386c8f52e1db24b49f02005fdd97cc847fd037bf26",
    "encirclement": "31cfd25ddf2c43ba6b59aa5857c512b442d9212ca718f67462998832cfdc089f",
    "escort": "5e60e1aa5bf893d7442052aaebec563f3bed068f8bcec1e1aadb8901bf9b72dd",
    "flocking": "b6e3e93d858a7206c64d33201edc01629cdf57bc2b30f43a96b953436dbeb8cf",
    "follow_the_leader": "7b1006cac62a2b6f748e4bb3e1d8a093511f7bbeadc54adbf01f899a89a14ea9",
    "formation": "1c31cd58f092e912c62055fa40145f8c5a437b19ee52c740373c51da50038aff",
    "go_to_point": "134bf40bd439dfe82d92c445d0ada05cb206505e1e422d494e5bd86bde8009a0",
    "guard_the_line": "4adebb7816b7bd68058ef5268eddc18061ed84545cd992635c8fbaf944edb64f",
    "head_on": "5ce7648ada31000408869070db8b0bfd311854d577a2bfbf00ea9fdcffc1e1fa",
    "herding": "a226c2f1c724d875b07f5d219f35f735aebc2b0194ce869a0c7c95786c52cac4",
    "hide_and_seek": "b9448f5189c1ae4f7db18b567f22b3379e471cf4272387260b3fe89d15973d8f",
    "homicidal_chauffeur": "642db8c7a46ba7bd0aa5dda8089eee25cdaadc7292415f6a7a10450d889b2e95",
    "leader_following": "efd9620dea54eb94752954e3e49c91526db9b1c779a98b672c7d96fd47105c5d",
    "lion_and_man": "762cf5cbc41063c1114e5fc533dd5379475eea494f9cc007cadd79082b14a9ba",
    "many_push_one": "d44d1d8c7b6a50ffc7d1bd4ad617a1c74bbad1eb213eb7a5b1beeaf797cb3648",
    "material_pairs": "e4c1f416319b2de338f62ae0c1e4eb097009460999aed7ae38f8681ce1fe130a",
    "obstacle_avoidance": "ad0d30660f25c2824212b7dcf06367f6731bcecd733d0e30efd0d8944d3a7b19",
    "own_sensor_and_addon": "7f35607de2e0202f3307952717f018f52190d55f74f4b21b03d041d6371913f6",
    "path_planning": "8122c21af1ea2beed9a916b43b1604b1951ce13e09ba03c12e8bbed59297be3b",
    "plan_push": "49885d9aef0d39599a2b3a5999f789eeae0a8e029986b926418f0dafb7d00225",
    "pursuit_corners": "3d9f884527c7cf3c8ace85397f792879e5761ebadd259e839810998de692ac9d",
    "pursuit_voronoi": "d722c03b8229e22cd6d37f023bbf52531d99f1122752ee40d3627f983373b37b",
    "push_box": "7da670f4906e87cdde4aa25bb5bfbecd97968bbe42c8b3feecc976f7c43c6821",
    "random_walk": "2ac911c38b77c2cd0929360da1b7bdd0d200bc1bf46b3513ad5acec93313647c",
    "rendezvous": "e6d6cdb7ab189f90a86169dfea16b87e34b4e3311cbc088de759d2d6ec47ffb0",
    "round_a_pillar": "da04d4f4dd9b4b3c4557c8961b34b0965248bf7b73932287219d7171e94bc0fd",
    "selfish_herd": "a0d15f1e53680d8da0c8a6f5cc51574e12b0671f2d7a3061987075cfd6e3616d",
    "shove_and_spin": "e396aaf1081a2a453d0e6d12a94a7cc5c2285dbd943cc7bdc16251f46955ed90",
    "stick_slip": "08fbecedee7e877e8b21e712ca67decafc6cc9733fc3a1204d05360024298b6c",
    "straight_chase": "9b8f5dd307d06ed82f6bf2a0ae445022b893ae58b31a2f2b30c4a334d4a70f4b",
    "sumo": "5b1fd118a4b870779103db196fb81756e33957b98e4b78de181936f2d20d57f8",
    "token_ring": "9eed2e88451125b5f3a822182608e43b05eba76b9be02fc2389015c8dc7e6c6f",
    "tug_of_war": "053449a36f1973c352c44c04987961f5cf50b032cdd37246ecd4c650d913d5d3",
    "two_cars": "18ad082f3b355ffebb120fb61fcc8c9376717ea30a963f758c59a199d5bf607c",
    "wall_follower": "52effd1775b256cc7de2b0d5b6ed7425fce762a37642ceb65ba39af71c0ed5d5",
    "wall_slide": "b0936f8a079d0cc80d0645d0c326c1dc49562899ee53b507f91561e0865c88d1",
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
    "circular_motion", "coverage_square", "dead_reckoning", "flocking", "homicidal_chauffeur",
    "obstacle_avoidance", "pursuit_corners", "pursuit_voronoi", "two_cars",
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
    assert len(lines) <= 70
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
