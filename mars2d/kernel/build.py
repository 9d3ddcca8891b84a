"""How the kernel is compiled: by `pip install`, through the hook in ``hatch_build.py``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from cffi import FFI

HERE = Path(__file__).parent

PREAMBLE = '#include <stddef.h>\n#include <stdint.h>\n#include "kernel.h"\n'

# Fused multiplications round once where the plain engine rounds twice.
EXACTLY = ["/O2", "/fp:precise"] if sys.platform == "win32" else ["-O2", "-ffp-contract=off"]


def builder() -> Any:
    """Return what compiles the extension module ``mars2d.kernel._kernel``."""
    made = FFI()
    made.cdef((HERE / "kernel.h").read_text(encoding="utf-8"))
    made.set_source(
        "mars2d.kernel._kernel",
        PREAMBLE,
        sources=[str(HERE / "kernel.c")],
        include_dirs=[str(HERE)],
        extra_compile_args=EXACTLY,
        libraries=[] if sys.platform == "win32" else ["m"],
    )
    return made


def compile_into(folder: Path) -> Path:
    """Compile, with `folder` for what comes and goes, and return the extension module's file."""
    return Path(builder().compile(tmpdir=str(folder), verbose=False))
