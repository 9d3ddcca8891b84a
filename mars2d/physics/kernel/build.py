"""How the kernel is compiled: by `pip install`, through the hook in ``hatch_build.py``."""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

__all__ = ["builder", "compile_into", "fingerprint"]

HERE = Path(__file__).parent

PREAMBLE = """
#include <stddef.h>
#include <stdint.h>
#include "team.h"
static const char mars2d_kernel_fingerprint[] = "{fingerprint}";
"""

DECLARED = """
extern "Python" int mars2d_kernel_interrupted(void);
static const char mars2d_kernel_fingerprint[];
"""

# Fused multiplications round once where the plain engine rounds twice. GCC's vectorizer makes them
# of x y' + y x' beside x x' - y y' even where it is told not to.
EXACTLY = (
    ["/O2", "/fp:precise"]
    if sys.platform == "win32"
    else ["-O2", "-ffp-contract=off", "-fno-tree-vectorize", "-fvisibility=hidden"]
)


def fingerprint() -> str:
    """Return what tells whether the kernel was compiled of the sources that are here now."""
    files = sorted([*HERE.glob("*.[ch]"), HERE / "build.py"])
    return hashlib.sha256(b"\0".join(file.read_bytes() for file in files)).hexdigest()


def builder(flags: Sequence[str] = ()) -> Any:
    """Return what compiles the extension module ``mars2d.physics.kernel._kernel``.

    flags: more of them for the compiler and the linker, as a sanitizer's.
    """
    from cffi import FFI

    made = FFI()
    made.cdef((HERE / "team.h").read_text(encoding="utf-8") + DECLARED)
    made.set_source(
        "mars2d.physics.kernel._kernel",
        PREAMBLE.format(fingerprint=fingerprint()),
        sources=[str(file) for file in sorted(HERE.glob("*.c"))],
        include_dirs=[str(HERE)],
        extra_compile_args=[*EXACTLY, *flags],
        extra_link_args=list(flags),
        libraries=[] if sys.platform == "win32" else ["m"],
    )
    return made


def compile_into(folder: Path, flags: Sequence[str] = ()) -> Path:
    """Compile, with `folder` for what comes and goes, and return the extension module's file."""
    return Path(builder(flags).compile(tmpdir=str(folder), verbose=False))
