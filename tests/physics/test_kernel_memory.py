"""When memory runs out, wherever in the kernel, there is an error, and nothing is left behind.

Here the kernel is compiled anew with functions that give memory a given number of times only.
"""

from __future__ import annotations

import importlib.util
import os
import shutil
import sysconfig
from pathlib import Path

import pytest

import mars2d
from mars2d.physics.kernel.build import compile_into

pytestmark = pytest.mark.slow

SETUPTOOLS = importlib.util.find_spec("setuptools") is not None
COMPILER = (os.environ.get("CC") or sysconfig.get_config_var("CC") or "").split()

SCARCE = """
#ifndef SCARCE_H
#define SCARCE_H
#include <stdlib.h>
#define SHARED __attribute__((weak, visibility("default")))
SHARED long mars2d_left = 1000000, mars2d_taken = 0;
static inline void *scarce_calloc(size_t count, size_t size)
{
    if (mars2d_left-- <= 0) return NULL;
    mars2d_taken++;
    return calloc(count, size);
}
static inline void *scarce_realloc(void *memory, size_t size)
{
    if (mars2d_left-- <= 0) return NULL;
    mars2d_taken += memory == NULL;
    return realloc(memory, size);
}
static inline void scarce_free(void *memory)
{
    mars2d_taken -= memory != NULL;
    free(memory);
}
#define calloc scarce_calloc
#define realloc scarce_realloc
#define free scarce_free
#endif
"""

TRIED = """
import ctypes, gc
from importlib import import_module
from mars2d import Robot, Scenario, World
from mars2d.addons import Map

robots = [Robot(pose=(0.31 * (i % 7), 0.31 * (i // 7), i)) for i in range(40)]
scenario = Scenario(robots=robots, addons=[Map([[(-0.2, -0.2), (3, -0.2)]])])
library = ctypes.CDLL(import_module("mars2d.physics.kernel._kernel").__file__)
left, taken = (ctypes.c_long.in_dll(library, f"mars2d_{name}") for name in ("left", "taken"))
World(scenario)
ends, now = [], ""
while now != "done":
    left.value = len(ends)
    world, now = None, "making"
    try:
        world = World(scenario, lambda world: [[0.5] * 40, [0.3] * 40])
        now = "moving"
        for _ in range(10):
            world.step()
        now = "done"
    except MemoryError:
        if now == "moving":
            assert world.over_message.startswith("Error: MemoryError"), world.over_message
            assert len(world.record) == world.iteration + 1
    del world
    gc.collect()
    assert taken.value == 0, (len(ends), now, taken.value)
    ends.append(now)
print(ends.count("making"), ends.count("moving"), ends.count("done"))
"""


@pytest.mark.skipif(not SETUPTOOLS, reason="setuptools, which compiles, is not installed")
@pytest.mark.skipif(os.name == "nt", reason="the compiler there names its options otherwise")
@pytest.mark.skipif(
    not COMPILER or shutil.which(COMPILER[0]) is None, reason="there is no C compiler"
)
def test_without_memory_there_is_an_error_and_nothing_leaks(tmp_path, child):
    package = tmp_path / "mars2d"
    shutil.copytree(
        Path(mars2d.__file__).parent, package, ignore=shutil.ignore_patterns("*.so", "__pycache__")
    )
    header = tmp_path / "scarce.h"
    header.write_text(SCARCE)
    made = compile_into(tmp_path / "made", ["-include", str(header)])
    shutil.copy(made, package / "physics" / "kernel" / made.name)
    done = child(TRIED, PYTHONPATH=str(tmp_path))
    assert done.returncode == 0, done.stderr
    making, moving, complete = map(int, done.stdout.split())
    assert making > 20
    assert moving > 20
    assert complete == 1
