"""The golden paths: small, whole, sharp enough to see a change, and held on another platform."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import mars2d
from mars2d.scenario.examples import examples
from tests.house.goldens import FOLDER, LARGEST, ROWS, Golden

SHORT = ("head_on", "shove_and_spin", "tug_of_war", "obstacle_avoidance", "sumo")
"""Examples that take no time, with contacts, sensors and noise."""

LIBM = """
#define _GNU_SOURCE
#include <dlfcn.h>
#include <math.h>
#include <stdint.h>

/* Another C library: its functions err by one in the last digit, as good ones may. */

static double off(double exact, double argument)
{
    union { double number; uint64_t bits; } u = { argument };
    uint64_t mixed = (u.bits ^ (u.bits >> 29)) * 0x9e3779b97f4a7c15ULL >> 62;
    if (exact == 0 || fabs(exact) == 1 || !isfinite(exact) || mixed > 1) return exact;
    return nextafter(exact, mixed ? INFINITY : -INFINITY);
}

#define ONE(name) double name(double x) { \\
    static double (*real)(double); \\
    if (!real) real = (double (*)(double)) dlsym(RTLD_NEXT, #name); \\
    return off(real(x), x); }
#define TWO(name) double name(double x, double y) { \\
    static double (*real)(double, double); \\
    if (!real) real = (double (*)(double, double)) dlsym(RTLD_NEXT, #name); \\
    return off(real(x, y), x + 3 * y); }

ONE(sin) ONE(cos) ONE(tan) ONE(asin) ONE(acos) ONE(atan) ONE(exp) ONE(log)
TWO(atan2) TWO(hypot)
"""

ELSEWHERE = """
import json, sys
import mars2d
from tests.house.goldens import SETTINGS, Golden
for name in sys.argv[1:]:
    record = mars2d.run(name, options=SETTINGS.get(name))
    print(json.dumps([name, record.digest, Golden.read(name).excess(record)]))
"""


def test_every_example_has_a_golden_path_that_says_something():
    assert {file.stem for file in FOLDER.iterdir()} == set(examples())
    for name in examples():
        golden = Golden.read(name)
        assert golden.rows[0] == 0
        assert len(golden.rows) >= ROWS, name
        assert golden.rows[-1] >= 20, name
        assert (np.diff(golden.tolerances) >= 0).all(), name
        assert golden.tolerances[-1] <= LARGEST, name
        assert np.abs(golden.poses[-1] - golden.poses[0]).max() > 0.1, name


@pytest.mark.parametrize(
    "change",
    [{"robots.*.mass": 1.01}, {"props.0.ground_friction": 0.501}, {"stop_time": 11.0}],
    ids=str,
)
def test_a_change_of_the_physics_or_an_early_end_is_seen(change):
    assert Golden.read("push_box").excess(mars2d.run("push_box", options=change)) > 1


def other_platform(folder: Path, names: tuple[str, ...]) -> list[tuple[str, str, float]]:
    """Run examples with a C library that rounds otherwise: names, digests, how far they are off."""
    compiler = shutil.which("gcc")
    if compiler is None or sys.platform != "linux":
        pytest.skip("needs gcc on Linux, which can put another C library before that of the system")
    (folder / "libm.c").write_text(LIBM)
    library = folder / "libm.so"
    command = [compiler, "-O1", "-fno-builtin", "-shared", "-fPIC", "-o", library, "libm.c"]
    subprocess.run([*command, "-ldl", "-lm"], cwd=folder, check=True)
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", ELSEWHERE, *names],
        env={"LD_PRELOAD": str(library), "PATH": "/usr/bin:/bin"},
        cwd=Path(__file__).parents[2], capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return [tuple(json.loads(line)) for line in done.stdout.splitlines()]


def check_elsewhere(folder: Path, names: tuple[str, ...]) -> None:
    told = other_platform(folder, names)
    assert [name for name, _, _ in told] == list(names)
    pinned = [Golden.read(name).digest for name in names]
    assert [digest for _, digest, _ in told] != pinned  # it is another platform
    assert {name: excess for name, _, excess in told if excess >= 1} == {}


@pytest.mark.slow
def test_golden_paths_hold_on_a_platform_that_rounds_otherwise(tmp_path):
    check_elsewhere(tmp_path, SHORT)


@pytest.mark.nightly
def test_all_golden_paths_hold_on_a_platform_that_rounds_otherwise(tmp_path):
    check_elsewhere(tmp_path, tuple(examples()))
