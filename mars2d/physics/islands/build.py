"""How the islands are compiled: by `pip install`, through the hook in ``hatch_build.py``.

The modules are joined into one, in the order in which they import each other, with Cython in the
place of `shadow`, and ``chipmunk.pxi`` in that of `chipmunk`. So what runs in Python where there is
no compiler and what runs as C where there is one are the same lines.
"""

from __future__ import annotations

import hashlib
import re
import sys
from collections.abc import Sequence
from contextlib import chdir
from pathlib import Path

HERE = Path(__file__).parent

MODULES = (
    "arithmetic", "piece", "state", "rigid", "drive", "body", "floor", "flush", "seams", "surfaces",
    "thrust", "pair", "tie", "solver", "contacts", "impact", "island", "neighbours", "mover",
)  # fmt: skip
"""The modules, each after those that it imports."""

HEAD = """
# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
# cython: initializedcheck=False, nonecheck=False, binding=False, auto_pickle=False
cimport cython
from libc.math cimport ceil, floor, fmod, sqrt
from typing import Any

FINGERPRINT = "{fingerprint}"
"""

EXACTLY = ["/O2", "/fp:precise", "/w"] if sys.platform == "win32" else [
    "-O2", "-ffp-contract=off", "-fno-tree-vectorize", "-fno-strict-aliasing",
    "-fvisibility=hidden", "-g0", "-w",
]  # fmt: skip
"""Fused multiplications round once where Python rounds twice. Warnings would be of Cython's C."""


def fingerprint() -> str:
    """Return a key that tells whether the islands were compiled from the present sources."""
    names = [*(f"{name}.py" for name in MODULES), "build.py", "chipmunk.py", "chipmunk.pxi"]
    return hashlib.sha256(b"\0".join((HERE / name).read_bytes() for name in names)).hexdigest()


def functions() -> list[tuple[str, str]]:
    """Return the engine's functions that are called: their names and types, as declared in C."""
    text = (HERE / "chipmunk.pxi").read_text(encoding="utf-8")
    declared = text[text.index("cdef struct Engine:") : text.index("cdef Engine engine")]
    found = re.findall(r"^    (\w+) \(\*(\w+)\)\((.*?)\) noexcept$", declared, flags=re.M | re.S)
    kinds = [f"{result}(*)({' '.join(taken.split())})" for result, _, taken in found]
    plain = [kind.replace("Handle", "void *").replace(" noexcept", "") for kind in kinds]
    return [(name, kind) for (_, name, _), kind in zip(found, plain, strict=True)]


def in_c() -> dict[str, str]:
    """Return what is called in C by the names that `chipmunk` only gives to engine's functions."""
    text = (HERE / "chipmunk.py").read_text(encoding="utf-8")
    found = re.findall(r"^(\w+(?:, \w+)*) = (lib\.cp\w+(?:, lib\.cp\w+)*)$", text, flags=re.M)
    return {
        name: function.replace("lib.", "engine.")
        for names, functions in found
        for name, function in zip(names.split(", "), functions.split(", "), strict=True)
    }


def joined() -> str:
    """Return the modules as one for Cython."""
    parts = [HEAD.format(fingerprint=fingerprint()), (HERE / "chipmunk.pxi").read_text("utf-8")]
    named = in_c()
    for name in MODULES:
        text = (HERE / f"{name}.py").read_text(encoding="utf-8")
        text = re.sub(r"^from [^\n]+ import (\([^)]*\)|[^\n]*)\n", "", text, flags=re.M)
        text = re.sub(r"\bchipmunk\.(\w+)", lambda found: named.get(found[1], found[1]), text)
        text = re.sub(r"\bcython\.Doubles\b", "cython.double[::1]", text)
        parts.append(f"# -- {name}.py\n{text}")
    return "\n".join(parts)


def compile_into(folder: Path, flags: Sequence[str] = ()) -> Path:
    """Compile, with `folder` for temporary files, and return the extension module's file.

    flags: more of them for the compiler and the linker, as a sanitizer's.
    """
    from Cython.Build import cythonize
    from setuptools import Distribution, Extension

    (folder / "_compiled.pyx").write_text(joined(), encoding="utf-8")
    extension = Extension(
        "mars2d.physics.islands._compiled",
        ["_compiled.pyx"],
        extra_compile_args=[*EXACTLY, *flags],
        extra_link_args=list(flags),
    )
    with chdir(folder):  # Cython keeps the path of its source: the same from each folder
        made = cythonize([extension], quiet=True, force=True)
        command = Distribution({"ext_modules": made}).get_command_obj("build_ext")
        command.build_lib, command.build_temp = ".", "temp"
        command.ensure_finalized()
        command.run()
        return Path(command.get_ext_fullpath("mars2d.physics.islands._compiled")).resolve()


if __name__ == "__main__":
    print(compile_into(Path(sys.argv[1])))
