"""Clocks that jump: a machine that is set right, or wakes up, in the midst of a run."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

import mars2d

pytestmark = [pytest.mark.slow, pytest.mark.skipif(sys.platform != "linux", reason="LD_PRELOAD")]

JUMPING = """
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <sys/time.h>
#include <time.h>

/* The clock on the wall goes wrong by so many seconds, there and back every 50 ms. */
static long off(void) {
    static int (*now)(clockid_t, struct timespec *);
    struct timespec t;
    if (!now) now = dlsym(RTLD_NEXT, "clock_gettime");
    now(CLOCK_MONOTONIC, &t);
    return (t.tv_nsec / 50000000) % 2 ? atol(getenv("JUMP")) : 0;
}

int clock_gettime(clockid_t id, struct timespec *t) {
    static int (*real)(clockid_t, struct timespec *);
    if (!real) real = dlsym(RTLD_NEXT, "clock_gettime");
    int result = real(id, t);
    if (id == CLOCK_REALTIME || id == CLOCK_REALTIME_COARSE) t->tv_sec += off();
    return result;
}

int gettimeofday(struct timeval *restrict t, void *restrict zone) {
    static int (*real)(struct timeval *restrict, void *restrict);
    if (!real) real = dlsym(RTLD_NEXT, "gettimeofday");
    int result = real(t, zone);
    t->tv_sec += off();
    return result;
}

time_t time(time_t *t) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    if (t) *t = now.tv_sec;
    return now.tv_sec;
}
"""

DAY = 86400


@pytest.fixture(scope="module")
def shim(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A library that makes the wall's clock jump."""
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        pytest.skip("no C compiler")
    folder = tmp_path_factory.mktemp("shim")
    (folder / "jumping.c").write_text(JUMPING)
    library = folder / "jumping.so"
    command = [compiler, "-shared", "-fPIC", "-o", library, folder / "jumping.c", "-ldl"]
    if subprocess.run(command, capture_output=True, check=False).returncode:
        pytest.skip("no C library to compile against")
    return library


def python(shim: Path, jump: int, folder: Path, *words: str) -> str:
    """Run Python while the clock jumps; return what it printed, and check that it was well."""
    done = subprocess.run(
        [sys.executable, "-P", *words],
        cwd=folder, capture_output=True, text=True, check=False, timeout=120,
        env=os.environ | {"LD_PRELOAD": str(shim), "JUMP": str(jump), "DISPLAY": ""},
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, ""), done
    return done.stdout


@pytest.mark.parametrize("jump", [DAY, -DAY])
def test_the_clock_really_jumps_and_a_run_keeps_its_pace_and_its_digest(
    shim, jump, tmp_path
) -> None:
    code = (
        "import time, mars2d\n"
        "seen = [time.time()]\n"
        "def look(world):\n"
        "    seen.append(time.time())\n"
        "start = time.monotonic()\n"
        "record = mars2d.run('random_walk', 30, speed=30, show=False, watchers=[look])\n"
        "took = time.monotonic() - start\n"
        "jumps = sum(abs(b - a) > 8e4 for a, b in zip(seen, seen[1:]))\n"
        "print(jumps, took, record.digest)\n"
    )
    jumps, took, digest = python(shim, jump, tmp_path, "-c", code).split()
    assert int(jumps) >= 2
    assert 1.0 <= float(took) < 60.0  # 30 simulated seconds at 30 times the pace
    assert digest == mars2d.run("random_walk", 30).digest


def test_a_sweep_has_the_same_rows(shim, tmp_path) -> None:
    argv = ["-m", "mars2d", "sweep", "random_walk", "--stop-time", "20", "--seeds", "4",
            "--workers", "2", "--time-limit", "60", "--out"]  # fmt: skip
    python(shim, -DAY, tmp_path, *argv, "jumped.csv")
    mars2d.sweep("random_walk", seeds=4, stop_time=20.0, out=tmp_path / "still.csv", workers=1)
    assert (tmp_path / "jumped.csv").read_bytes() == (tmp_path / "still.csv").read_bytes()


@pytest.mark.parametrize("jump", [DAY, -DAY])
def test_an_innocent_law_has_no_verdict_and_a_slow_one_has(shim, jump, tmp_path) -> None:
    law = "import time\ndef control(robot):\n    time.sleep({})\n    return 0.1, 0.1\n"
    (tmp_path / "innocent.py").write_text(law.format(0.005))
    (tmp_path / "fair.py").write_text(law.format(0))
    (tmp_path / "slow.py").write_text(law.format(10))
    argv = ["-m", "mars2d", "tournament", "sumo", "--role", "red=innocent.py", "--role",
            "blue=fair.py", "slow.py", "--seeds", "1", "--stop-time", "2", "--tick-limit",
            "2", "--workers", "1", "--out", "league"]  # fmt: skip
    begun = time.monotonic()
    python(shim, jump, tmp_path, *argv)
    assert time.monotonic() - begun < 110
    rows = (tmp_path / "league" / "matches.csv").read_text().splitlines()
    verdicts = [("fair" in row, "blue: slow" in row, "red:" in row) for row in rows[1:]]
    assert len(verdicts) == 2
    assert all(fair != slow for fair, slow, _ in verdicts), rows
    assert not any(red for *_, red in verdicts), rows


def test_nothing_in_the_package_measures_by_the_clock_on_the_wall() -> None:
    package = Path(mars2d.__file__).parent
    wrong = ("time.time(", "import time as", "from time import time", "utcnow(")
    found = [
        f"{path.name}: {word}"
        for path in package.rglob("*.py")
        for word in wrong
        if word in path.read_text(encoding="utf-8")
    ]
    assert found == []
