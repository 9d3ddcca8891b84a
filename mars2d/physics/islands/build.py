"""How the islands are compiled: by `pip install`, through the hook in ``hatch_build.py``.

The modules are joined into one, in the order in which they import each other, with Cython in the
place of `shadow`, and ``library.pxi`` in that of `library`. So what runs in Python where there is
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
    "arithmetic", "settings", "chipmunk", "piece", "rigid", "drive", "body", "floor",
    "flush", "seams", "surfaces", "thrust", "pair", "tie", "solver", "contacts", "impact", "island",
    "neighbours", "mover", "rays",
)  # fmt: skip
"""The modules, each after those that it imports."""

CONSTANTS = r"^([A-Z_]+) = (\d+|\d+\.\d+(?: / \d+\.\d+)?|\d+e-\d+)(?:  #.*)?$"
"""Lines that give a name to a number, which is one of C. Whole numbers are divided in C as such."""

IMPORTS = r"^if TYPE_CHECKING:$|^ *from [^\n]+ import (\([^)]*\)|[^\n]*)\n"
"""Lines that get names from other modules."""

PREFIXES = r"\b(?:chipmunk|library|settings)\.(\w+)"
"""Names of modules that are imported as such."""

ALIASES = r"^(\w+(?:, \w+)*) = (lib\.cp\w+(?:, lib\.cp\w+)*)$"
"""Lines in which `chipmunk` only gives names to the engine's functions."""

OF_C = r"^( *)def (?!__)(?=\w+\([^)]*\) -> (?!None|bool|int|float|array|list\[Any|tuple\[Any))"
"""Where a function begins that only the islands call: its result is none of Python's."""

NO_RESULT = r"(?<!check=False\)\n)^( *)def (\w+\([^)]*\)) -> cython\.void:\n((?:\1 .+\n|\n)+)"
"""One without a result, which the engine does not call."""

NEVER_FAILS = r"^( *)def (?=\w+\([^)]*\) -> (?:Vector|tuple\[cython.double, cython.double\]):)"
"""One whose result is a struct: in C there is none that stands for an error."""

FUNCTIONS = """
void(Handle, double): SpaceStep SpaceSetCurrentTimeStep SpaceSetCollisionSlop
  SpaceSetCollisionBias ShapeSetFriction ShapeSetElasticity BodySetTorque
  PinJointSetDist RotaryLimitJointSetMin RotaryLimitJointSetMax ConstraintSetMaxForce
  ConstraintSetMaxBias ConstraintSetErrorBias ArbiterSetFriction ArbiterSetRestitution
Handle(): SpaceNew BodyNewKinematic BodyNewStatic PivotJointAlloc GrooveJointAlloc GearJointAlloc
  SlideJointAlloc PinJointAlloc DampedSpringAlloc RotaryLimitJointAlloc DampedRotarySpringAlloc
Handle(Handle): SpaceGetStaticBody BodyGetUserData ConstraintGetSpace ConstraintGetBodyA
  ConstraintGetBodyB SpaceAddGlobalCollisionHandler ShapeGetUserData ShapeGetBody
void(Handle, Handle): BodySetUserData SpaceRemoveBody SpaceRemoveShape SpaceRemoveConstraint
  ShapeSetUserData
void(Handle): SpaceFree BodyFree ShapeFree ConstraintFree
double(Handle): BodyGetAngle BodyGetAngularVelocity SpaceGetCurrentTimeStep ConstraintGetImpulse
Handle(Handle, Handle): SpaceAddBody SpaceAddShape SpaceAddConstraint
void(Handle, Vector): BodySetCenterOfGravity BodySetForce
Vector(Handle): BodyGetPosition BodyGetVelocity ArbiterTotalImpulse
Vector(Handle, int): ArbiterGetPointA ArbiterGetPointB PolyShapeGetVert
Handle(Handle, Handle, Handle, Vector, Vector): PivotJointInit PinJointInit
Handle(Handle, Handle, Handle, double, double): GearJointInit RotaryLimitJointInit
void(Handle, double (*)(Handle, double) noexcept): DampedSpringSetSpringForceFunc
  DampedRotarySpringSetSpringTorqueFunc
int(Handle): ArbiterGetCount PolyShapeGetCount
void(Handle, int): SpaceSetIterations
void(Handle, unsigned int): SpaceSetCollisionPersistence
Handle(double, double): BodyNew
Handle(Handle, double, Vector): CircleShapeNew
Handle(Handle, Vector, Vector, double): SegmentShapeNew
Handle(Handle, int, Vector *, double): PolyShapeNewRaw
void(Handle, void (*)(Handle, double) noexcept): BodySetPositionUpdateFunc
Handle(Handle, Handle, Handle, Vector, Vector, Vector): GrooveJointInit
Handle(Handle, Handle, Handle, Vector, Vector, double, double): SlideJointInit
Handle(Handle, Handle, Handle, Vector, Vector, double, double, double): DampedSpringInit
Handle(Handle, Handle, Handle, double, double, double): DampedRotarySpringInit
void(Handle, unsigned char): ConstraintSetCollideBodies
void(Handle, void (*)(Handle, Handle, Handle) noexcept, Handle): BodyEachArbiter
double(Handle, int): ArbiterGetDepth
Handle(Handle, uintptr_t): SpaceAddWildcardHandler
void(Handle, uintptr_t): ShapeSetCollisionType
Vector(Handle, Vector): BodyLocalToWorld
"""
"""The engine's functions that are called, without their "cp", behind their types in C."""

HEAD = """
# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
# cython: initializedcheck=False, nonecheck=False, binding=False, auto_pickle=False
# cython: infer_types=True
cimport cython
from libc.math cimport ceil, floor, fmod, sqrt
from array import array
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
    names = [*(f"{name}.py" for name in MODULES), "build.py", "library.pxi"]
    return hashlib.sha256(b"\0".join((HERE / name).read_bytes() for name in names)).hexdigest()


def functions() -> list[tuple[str, str]]:
    """Return the engine's functions that are called: their names and types, as declared in C."""
    lines = FUNCTIONS.strip().replace("\n  ", " ").splitlines()
    kinds = [line.replace("(", "(*)(", 1).split(": ") for line in lines]
    return [
        (f"cp{name}", kind.replace("Handle", "void *"))
        for kind, names in kinds
        for name in names.split()
    ]


def struct() -> str:
    """Return a struct of these functions, for Cython."""
    fields = [kind.replace("(*)", f"(*{name})", 1) for name, kind in functions()]
    return "cdef struct Engine:\n" + "".join(f"    {field} noexcept\n" for field in fields)


def in_c() -> dict[str, str]:
    """Return what is called in C by the names that `chipmunk` only gives to engine's functions."""
    text = (HERE / "chipmunk.py").read_text(encoding="utf-8")
    found = re.findall(ALIASES, text, flags=re.M)
    return {
        name: function.replace("lib.", "engine.")
        for names, functions in found
        for name, function in zip(names.split(", "), functions.split(", "), strict=True)
    }


def _constant(found: re.Match[str]) -> str:
    """Return a constant in C."""
    return f"cdef {'int' if found[2].isdigit() else 'double'} {found[1]} = {found[2]}"


def _of_c(text: str) -> str:
    """Let functions and classes be those of C.

    A function without a result returns 0, or -1 with an error, which is quicker to look for.
    """

    def with_result(found: re.Match[str]) -> str:
        body = re.sub(r"^( +return)$", r"\1 0", found[3], flags=re.M)
        return f"{found[1]}def {found[2]} -> cython.int:\n{body}"

    text = re.sub(NO_RESULT, with_result, text, flags=re.M)
    text = re.sub(OF_C, r"\1@cython.cfunc\n\1def ", text, flags=re.M)
    text = re.sub(NEVER_FAILS, r"\1@cython.exceptval(check=False)\n\1def ", text, flags=re.M)
    for base in re.findall(r"^class \w+\((\w+)\)", text, flags=re.M):
        text = text.replace(f"@cython.cclass\nclass {base}", f"@cython.cclass  #\nclass {base}")
    text = text.replace("@cython.cclass\n", "@cython.final\n@cython.cclass\n")
    known = (f"cdef class {name}\n" for name in re.findall(r"^class (\w+):", text, flags=re.M))
    return "".join(known) + text


def joined() -> str:
    """Return the modules as one for Cython."""
    engine = (HERE / "library.pxi").read_text("utf-8")
    engine = engine.replace("cdef Engine engine", f"{struct()}\ncdef Engine engine")
    parts = []
    named = in_c()
    for name in MODULES:
        text = (HERE / f"{name}.py").read_text(encoding="utf-8")
        text = re.sub(IMPORTS, "", text, flags=re.M)
        text = re.sub(PREFIXES, lambda found: named.get(found[1], found[1]), text)
        text = re.sub(r"\bcython\.Doubles\b", "cython.double[::1]", text)
        text = re.sub(CONSTANTS, _constant, text, flags=re.M)
        text = re.sub(ALIASES, "", text, flags=re.M)
        text = re.sub(r"\blib\.cp", "engine.cp", text)
        text = re.sub(r"^@callback\(.*\)$", "@cython.exceptval(check=False)", text, flags=re.M)
        parts.append(f"# -- {name}.py\n{text}")
    return "\n".join([HEAD.format(fingerprint=fingerprint()), engine, _of_c("\n".join(parts))])


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
