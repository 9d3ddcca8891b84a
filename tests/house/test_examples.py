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
    "billiards": "9c5dda1891225ba0e69ff9d9cec64cfbc91179fc3e37210c95492569cfb7adfc",
    "braitenberg": "3811f9225ab784375c66fb6d8afb3ab6a5f2e5331c76e8e8c4a6100a579fa1e6",
    "circular_motion": "9b85ec05281bab5f94bceddf67346a79aaf83abeb717c39c4720b34ebc9c70f7",
    "corner_game": "2369b01fae3b2d8d735d79378f52ed240c6441addc5642558843b240b8d47ece",
    "coverage_circle": "b4936e0be33167b604adcc4698cf9bc8f55b1087e57b032aebedadbf50450186",
    "coverage_square": "ffad3126d148287e3df074022adda9d814758b2bc575e9712f76d7c38ca980a7",
    "crowd": "45d11f675a87710e50869da181dc3ea9705f7e884f359465c204ca8aaa2ed0a5",
    "cyclic_pursuit": "190125fc4d2969c66d4bd9c5b3e9d68954eaa97649e3d69e0c5a4ecbd924520d",
    "dead_reckoning": "c13404459843662a7136bc51612717496950e5a022b6406d77e2bd449d5f4199",
    "flocking": "a7f009fdace7a52ba2f4d3935e3dd77560a0e57d163115a9795c5d10a5b5890c",
    "follow_the_leader": "f93ebf5d7872477931827abf5bc86e8ca2d37eab31eb2dbcccebd0791e049f35",
    "formation": "6618269503aa1c94e645c16f6655e569a79f2cff0c5a5ef529edf754e2cdd052",
    "go_to_point": "3ddb80852972aa04c610f9c7d4e2de279d87ea60bb73932730fd2155a6925463",
    "head_on": "d7a16c9731fcf58b093e773ec1db81b68350500a9d52bb5f8f2ea428dfaf5505",
    "herding": "2c09d695f555e3201c05e6474832ff345002b5d2c32fb0b0827a47603fafe283",
    "leader_following": "6ad6d2308d881c36e541f7b0201ffd35e4ac4dba84f8b30a2d73e50e96e18a76",
    "many_push_one": "a723e5cd4225813e48d0184e7463974295559ef016b5518aa76567b18a225d0c",
    "material_pairs": "f8ab0c6eeaea32a08fe5f85d383fd253018c5c440114a95abba5ab2d34383130",
    "obstacle_avoidance": "65f4f109c80a0b1267c434579f046849f2d9012a84a7ed4c923b1c9e3fc8f1b7",
    "own_sensor_and_addon": "2e95c9dea56d9627b075df3eab2601bd8a9b61796345f6484eadd5516ce6a3b5",
    "path_planning": "8639560b7a322a712bea815c96e56e1a88ab4266ace0429b12d56e151873a6c6",
    "pursuit_corners": "8fc4f866de02ff8495d2c2dfe35b68ecff6d2ffbbe14b096d8545c92fc866b68",
    "pursuit_voronoi": "8850cc03721836a21fc4f81b1543a4ff38fd807a9620c47358c736dc6f291d65",
    "push_box": "1f6a1b99b3d18bcda38f031f730fb143cf25e398ca61136050479266e3aa7115",
    "random_walk": "6bd73b4922ed4923fd121886e190e7f7a55a5356869ad34c90305a3ecee971dc",
    "rendezvous": "0b7d9c86dd4937b2649e17cd0e9bab6dd268a9ac4402766522455fc50b967cc3",
    "shove_and_spin": "45972ec6931fe4b5c4d0856406a83424aa83740c3f83cd058bde45009dfbf065",
    "stick_slip": "b4420a334e05ea00c94ae4171de8267c9693cb2ad940a29a707e529aba7cb1b3",
    "sumo": "ced2de2d6c4fe9e797b115f4c2a3c705c3697b8e15fcdb0d3384afa2e957d390",
    "token_ring": "cbf1ac174cf15adfebaf41c50d41e88c8142d188678909be6b3f5df1c9720b02",
    "tug_of_war": "81fa5e15a7a581e1eb34741a53fd9b5502caf7ade904165092eb1d7ad772f2cc",
    "wall_follower": "65697ac59e11519c0b255c917de701d872358f2f5c8e2dcd102d1c23bf5c653c",
    "wall_slide": "5c4830d5447d08d5e2c0a00ad25ecfd3f61decab61a60eafd2442364202c1670",
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
