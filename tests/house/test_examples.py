"""The examples: short enough to project, and the same to the last bit from run to run."""

import os
import platform
import subprocess
import sys
from importlib.metadata import version

import numpy as np
import pytest

import mars2d
from mars2d.scenario.code_file import lesson_of
from mars2d.scenario.examples import examples, thumbnail_of
from tests.cases import each_case
from tests.house.goldens import SETTINGS, Golden

# Another platform or engine may round the last digit differently: it is held to the golden paths.
ON_THE_PINNED_PLATFORM = (
    sys.platform == "linux"
    and platform.machine() == "x86_64"
    and platform.libc_ver()[0] == "glibc"
    and version("pymunk").startswith("7.3.")
)

SLOW = {
    "circular_motion", "coverage_square", "dead_reckoning", "flocking", "homicidal_chauffeur",
    "obstacle_avoidance", "plan_push", "pursuit_corners", "pursuit_voronoi", "two_cars",
    "wall_follower",
}  # fmt: skip
"""Examples that take most of a second and more."""


@pytest.mark.parametrize(
    "name",
    [pytest.param(n, marks=[pytest.mark.slow] if n in SLOW else []) for n in examples()],
)
def test_an_example_goes_its_golden_way_and_where_digests_are_pinned_has_its_own(name):
    record, golden = mars2d.run(name), Golden.read(name)
    if ON_THE_PINNED_PLATFORM:
        assert record.digest == golden.digest
    settings = SETTINGS.get(name)
    if settings is not None:
        record = mars2d.run(name, options=settings)
    assert golden.excess(record) < 1


@pytest.mark.nightly
def test_older_processors_give_the_same_digests():
    """numpy picks its routines by processor; here those of older ones, as far as there are any."""
    from numpy._core._multiarray_umath import __cpu_dispatch__, __cpu_features__

    newer = [name for name in __cpu_dispatch__ if __cpu_features__.get(name)]
    if not newer:
        pytest.skip("numpy has only one set of routines for this processor")
    code = f"import mars2d; print(*[mars2d.run(n).digest for n in {list(examples())}])"

    def digests(**extra: str) -> list[str]:
        done = subprocess.run(
            [sys.executable, "-W", "ignore", "-c", code],
            env=os.environ | extra, capture_output=True, text=True, check=True,
        )  # fmt: skip
        return done.stdout.split()

    # Where they are pinned, the test above has seen those of this processor.
    pinned = [Golden.read(name).digest for name in examples()]
    here = pinned if ON_THE_PINNED_PLATFORM else digests()
    assert digests(NPY_DISABLE_CPU_FEATURES=" ".join(newer)) == here


@each_case("name", examples())
def test_an_example_is_short_enough_to_project_and_has_its_pictures(name):
    lines = examples()[name].read_text().splitlines()
    assert len(lines) <= 70
    assert max(map(len, lines)) <= 100
    assert lines[0].startswith('"""')
    assert all(thumbnail_of(name, looks).is_file() for looks in ("light", "dark"))


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


def test_a_lesson_has_each_of_its_parts_and_the_lines_of_its_table():
    parts = dict(lesson_of(examples()["corner_game"]))
    assert list(parts) == ["", "Question", "Setting", "Source", "Measured"]
    assert parts["Question"].endswith("--seed 3")
    assert parts["Measured"].splitlines()[1].split() == ["away", "corners", "round"]
