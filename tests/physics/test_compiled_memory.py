"""The islands give back all memory that they take, and touch none that is not theirs."""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

import mars2d
from mars2d.physics.islands.build import compile_into
from tests.cases import each_case
from tests.islands import FIND_TESTS

pytestmark = [
    pytest.mark.nightly,
    pytest.mark.skipif(sys.platform != "linux", reason="memory is looked at as Linux tells of it"),
]

COMPILER = (os.environ.get("CC") or sysconfig.get_config_var("CC") or "").split()

SCENE = (
    FIND_TESTS
    + """
from mars2d import MaterialPair, World
from mars2d.addons import Map
from tests.physics.test_same_bits import crowd

def scenario(physics):
    scene = crowd(5, 12, gap=0.0, faults=True, things=True, physics=physics, max_overlap=0.01)
    first, *others = scene.robots
    rubs = first.replace(friction="steel", static_friction=0.9)
    pairs = [MaterialPair("ice", "steel", friction=0.03, restitution=0.5)]
    return scene.replace(robots=[rubs, *others], material_pairs=pairs)
"""
)
"""Robots, props and joints of many kinds and surfaces, close to each other and to walls."""

MANY = """
import gc
from pathlib import Path
scene = scenario("contact")

def worlds(count):
    for _ in range(count):
        world = World(scene)
        for _ in range(3):
            world.step([[1.0] * len(scene.robots), [0.5] * len(scene.robots)])
        assert len(world.record.contacts)
        del world
        gc.collect()
    return 4096 * int(Path("/proc/self/statm").read_text().split()[1])

before = worlds(50)
print(worlds({count}) - before)
"""


@each_case(("plain", "count"), [("", 400), ("1", 60)])
def test_worlds_made_and_dropped_take_no_memory(child, plain, count):
    """A world of this scene takes some hundred kilobytes while it is there."""
    done = child(SCENE + MANY.format(count=count), MARS2D_PLAIN=plain)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) < 500 * count + 100_000, "bytes that the process has grown by"


MOVED = """
import gc
import numpy as np
from mars2d.physics.islands import reason_without

assert not reason_without(), reason_without()
rng = np.random.default_rng(1)
for physics in ("contact", "stop", "ideal"):
    world = World(scenario(physics))
    contacts = 0
    for _ in range(40):
        world.step(rng.uniform(-1, 1, (2, len(world.robots))))
        contacts += len(world.contacts)
    assert contacts > 8
    del world
    gc.collect()
"""

BEYOND = """
from array import array
world = World(scenario("contact"))
world.simulation.engine._mover.write_states(array("d", [0.0]))
"""


@pytest.fixture(scope="module")
def sanitized(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """A copy of the package whose islands report wrong uses of memory, and what is to be loaded."""
    for name in ("setuptools", "Cython"):
        if importlib.util.find_spec(name) is None:
            pytest.skip(f"it is compiled by {name}, not installed")
    if not COMPILER or shutil.which(COMPILER[0]) is None:
        pytest.skip("there is no C compiler")
    libraries = [
        subprocess.run(
            [COMPILER[0], f"-print-file-name=lib{name}.so"],
            capture_output=True, text=True, check=True,
        ).stdout.strip()
        for name in ("asan", "ubsan")
    ]  # fmt: skip
    if not all(Path(library).is_absolute() for library in libraries):
        pytest.skip(f"{COMPILER[0]} has no sanitizers")
    folder = tmp_path_factory.mktemp("sanitized")
    ignored = shutil.ignore_patterns("*.so", "__pycache__", "examples")
    shutil.copytree(Path(mars2d.__file__).parent, folder / "mars2d", ignore=ignored)
    (folder / "made").mkdir()
    flags = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-g"]
    made = compile_into(folder / "made", flags)
    shutil.copy(made, folder / "mars2d" / "physics" / "islands")
    return folder, ":".join(libraries)


@each_case("code", [MOVED, BEYOND])
def test_a_sanitizer_finds_nothing_wrong_but_what_is(child, sanitized, code):
    folder, libraries = sanitized
    done = child(
        SCENE + code, PYTHONPATH=str(folder), LD_PRELOAD=libraries, PYTHONMALLOC="malloc",
        ASAN_OPTIONS="detect_leaks=0",
    )  # fmt: skip
    found = "AddressSanitizer: heap-buffer-overflow" in done.stderr
    assert found == (code == BEYOND), done.stderr
    assert (done.returncode == 0) == (code == MOVED), done.stderr
