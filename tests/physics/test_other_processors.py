"""Processors that can do less, other kernels of linear algebra, other numpys: the same bits."""

from __future__ import annotations

import json
import os
import platform
import subprocess
import sys
from pathlib import Path

import pytest

from tests.processes import bare_environment

pytestmark = [
    pytest.mark.nightly,
    pytest.mark.skipif(
        (platform.system(), platform.machine(), platform.libc_ver()[0])
        != ("Linux", "x86_64", "glibc"),
        reason="glibc can be told to do with less on Linux on x86-64 only",
    ),
]

OLDER = {
    "GLIBC_TUNABLES": "glibc.cpu.hwcaps=-FMA,-AVX2_Usable,-AVX512F_Usable,-AVX2,-AVX512F",
    "NPY_DISABLE_CPU_FEATURES": "X86_V4 X86_V3 AVX512_ICL AVX512_SPR",
    "OPENBLAS_CORETYPE": "Nehalem",
}
"""What lets the C library, numpy and its linear algebra run as on a processor of 2009."""


def printed(code: list[str], **environment: str) -> str:
    done = subprocess.run(
        [sys.executable, "-W", "ignore", *code], env=bare_environment(**environment), text=True,
        capture_output=True, timeout=600, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_an_older_processor_gives_the_same_bits():
    run = ["-m", "tests.physics.rounding"]
    here, older = (json.loads(printed(run, **each)) for each in ({}, OLDER))
    assert len(here) > 40
    assert {name for name in here if here[name] != older[name]} == set()


def test_the_c_library_does_round_otherwise_then():
    """Else the test above could not fail."""
    code = "import math\nprint([math.cos(k / 7) for k in range(100_000)])"
    if "fma" not in Path("/proc/cpuinfo").read_text(encoding="utf-8").split():
        pytest.skip("this processor has no FMA to do without")
    assert printed(["-c", code]) != printed(["-c", code], **OLDER)
    assert os.environ.get("GLIBC_TUNABLES", "") != OLDER["GLIBC_TUNABLES"]
