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
    "billiards": "a6fcb5253b310e38039ad72e32d7e92fc4327e896538ec21b94ae80a124a272c",
    "braitenberg": "d0f9e7aa6777a474ecfeb96cf49ed65eb9b2a9cb429dfe9203fef9204c2eba00",
    "circular_motion": "56df0af30f1553af2b184e7f2971c3a55397f58b18f549a7d64c9ca18377f52d",
    "corner_game": "2369b01fae3b2d8d735d79378f52ed240c6441addc5642558843b240b8d47ece",
    "coverage_circle": "56c5291efb3ef1d6d9e152ff308efd7e29869ce743bcda39f6697a94db97b75e",
    "coverage_square": "04ec0f04419ef33622cdeda854b4539ce9ceeaa69db5ab760c6b5e2e3e8da762",
    "crowd": "d0cda8d658dd47175d52a3ae42e05d25b0cca3cb33c7ad8802d1855749a84420",
    "cyclic_pursuit": "0c98a675508861c8624530e735a80b16e340f9692e0fecbb1a61481129918ea7",
    "dead_reckoning": "108502bfded7031e41d972347dd7bcbc99e8a4771a428dee09fabf39eb7ec6d9",
    "flocking": "5cd882a1b4ca3625b10276997936214c1a1c3d9b4c7b28ce3209717e02a500bc",
    "follow_the_leader": "931b3e2346e6eb3d6cdb099a70ca397521d5b6ddedec41be7b83f677dff2736f",
    "formation": "748e976ab8b4744724f6644844570ccefd7fa70c0a5bea4b6ffb449e7ef07ba7",
    "go_to_point": "3ddb80852972aa04c610f9c7d4e2de279d87ea60bb73932730fd2155a6925463",
    "head_on": "363d023d50865a9e70f5aa3beecaff1828248b2257e77c3f3f6d4948e9919dfb",
    "herding": "d5012042f532befa6dfa38ef1149c15dc5a7ec22d23315a7dc3e4185c7e257d6",
    "leader_following": "8abf74092bdbd5e4751b4c49cf42e0d732678d9e3fe3b6bc549aca5e616e26e5",
    "many_push_one": "a24119b6b0cf09431e63480ef211b3643a840e65bda9830814d7192c9c54c1e4",
    "obstacle_avoidance": "1de1b5785e893ec6b2e5bd71bdcb92d50dca0c7ca290999f2e63f648944dd63c",
    "own_sensor_and_addon": "08bf99e50221d5c7ee65b7a4ac0c15c0a3d65e595abc7a1a5723dcb1c2a80580",
    "path_planning": "d3af34d5bc9c9d947ec88d7ccd5799ab7361e8f08582d1c503766cf62bed6730",
    "pursuit_corners": "f01ee2b01053b2e9a0eed1161ae606d88353502a8ea5944e4dbb0f94a6e88ee0",
    "pursuit_voronoi": "8850cc03721836a21fc4f81b1543a4ff38fd807a9620c47358c736dc6f291d65",
    "push_box": "365534f7136bf71df428b8f172058e30f61e1a986da54d2160bb092b4e530d30",
    "random_walk": "914c9ae91a7f718268043edbc156cfafb5299cc64efcb983faae97aae3e22440",
    "rendezvous": "0b7d9c86dd4937b2649e17cd0e9bab6dd268a9ac4402766522455fc50b967cc3",
    "shove_and_spin": "1c233159d0e1f7160097ed10bd7be72ec374a86f0084f6a5206236d25113c369",
    "sumo": "92b3c90538d1a58ff2947246e7f74e50b4d7669e7a3fdbacacb61c178930d24d",
    "token_ring": "cbf1ac174cf15adfebaf41c50d41e88c8142d188678909be6b3f5df1c9720b02",
    "tug_of_war": "d740cf155d73b5267075d5826034af20cb0a8830028c8a03d5e1242cc6787457",
    "wall_follower": "ced94c09eb54e7f43ef20fd460f26a8c6b7d612c29260a8130dfb65cb22208d4",
    "wall_slide": "ef8343e6df01902a4da2dbb1e56b65ac2e14a39d44dac16d8ea298fe5cf05950",
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
