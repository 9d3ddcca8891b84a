"""The structs of pymunk's engine: do they have their numbers where `library` expects them?"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import chain

from pymunk._chipmunk_cffi import ffi, lib

from mars2d.physics.islands import chipmunk, library
from mars2d.physics.islands.arithmetic import cosine_sine, exponential

STEP = 0.0625
"""Seconds."""


def misplaced() -> list[str]:
    """Return which numbers are elsewhere. A body and joints are tried out."""
    found = []
    for what, struct, wanted in chain(_of_bodies(), _of_joints()):
        numbers = ffi.cast("double *", struct)
        for place, values in wanted.items():
            if any(abs(numbers[place + k] - value) > 1e-12 for k, value in enumerate(values)):
                found.append(f"{what} elsewhere")
    return found


Places = dict[int, tuple[float, ...]]


def _of_bodies() -> Iterator[tuple[str, library.Handle, Places]]:
    """Yield a body, and the numbers that it should have from some places on."""
    body = lib.cpBodyNew(2.0, 3.0)
    lib.cpBodySetCenterOfGravity(body, (0.25, -0.5))
    lib.cpBodySetAngle(body, 0.75)
    lib.cpBodySetPosition(body, (4.0, 5.0))
    chipmunk.aim(body, 6.0, 7.0, 8.0)
    c, s = cosine_sine(0.75)
    yield (
        "bodies have their poses",
        body,
        {
            library.LEAD: (0.25, -0.5),
            library.CENTER: (4 + 0.25 * c + 0.5 * s, 5 + 0.25 * s - 0.5 * c),
            library.FAST: (6.0, 7.0),
            library.ANGLE: (0.75, 8.0),
            library.TURN: (c, s, -s, c, 4.0, 5.0),
            library.BIAS: (0.0, 0.0, 0.0),
        },
    )
    chipmunk.free_body(body)


def _of_joints() -> Iterator[tuple[str, library.Handle, Places]]:
    """Yield joints that have acted on a body for a step, and the numbers that they should have."""
    space, body = chipmunk.new_space(0.0), chipmunk.new_body(2.0, 3.0, 0)
    chipmunk.add_body(space, body)
    lost = [1.0 - exponential(-1.5 * STEP / felt) for felt in (2.0, 3.0)]
    rest = (0.125, 4.0, 1.5)
    impulses, damping = "joints have their impulses", "springs have their damping"
    tried: tuple[tuple[str, int, tuple[float, float], Places], ...] = (
        (impulses, library.PIVOT, (0.0, 0.0), {library.PIVOT_IMPULSE: (-3.0, 4.0)}),
        (impulses, library.GEAR, (0.0, 1.0), {library.GEAR_IMPULSE: (-12.0,)}),
        (impulses, library.GROOVE, (0.0, 1.0), {library.GROOVE_IMPULSE: (-3.0, 0.0)}),
        (damping, library.DAMPED_SPRING, rest[:2],
         {library.REST: rest, library.LOST: (lost[0],), library.EFFECTIVE_MASS: (2.0,)}),
        (damping, library.ROTARY_SPRING, rest[:2],
         {library.REST_ANGLE: rest, library.LOST_TURNING: (lost[1],),
          library.EFFECTIVE_MOMENT: (3.0,)}),
    )  # fmt: skip
    for what, kind, numbers, wanted in tried:
        chipmunk.put(body, 0.0, 0.0, 0.0)
        chipmunk.aim(body, 1.5, -2.0, 4.0)
        ends = (0.0, 0.0), (0.0, 0.0)
        joint = chipmunk.make_joint(
            kind, None, chipmunk.ground_of(space), body, ends, *numbers, 0.0
        )
        chipmunk.set_max_bias(joint, 0.0)
        if kind == library.DAMPED_SPRING:  # as the engine damps, not as we do
            lib.cpDampedSpringSetDamping(joint, rest[2])
        elif kind == library.ROTARY_SPRING:
            lib.cpDampedRotarySpringSetDamping(joint, rest[2])
        chipmunk.add_joint(space, joint)
        chipmunk.step(space, STEP, 0.5)
        yield what, joint, wanted
        chipmunk.remove_joint(space, joint)
        chipmunk.free_joint(joint)
    chipmunk.remove_body(space, body)
    chipmunk.free_body(body)
    chipmunk.free_space(space)


FIELDS: dict[str, dict[str, tuple[int, str]]] = {
    "struct cpArbiter": {
        "a": (40, "struct cpShape *"),
        "b": (48, "struct cpShape *"),
        "body_a": (56, "struct cpBody *"),
        "body_b": (64, "struct cpBody *"),
        "count": (104, "int"),
        "contacts": (112, "struct cpContact *"),
        "n": (120, "struct cpVect"),
    },
    "struct cpContact": {
        "r1": (0, "struct cpVect"),
        "r2": (16, "struct cpVect"),
        "bounce": (48, "double"),
        "jnAcc": (56, "double"),
        "jtAcc": (64, "double"),
    },
    "struct cpCollisionHandler": {
        "preSolveFunc": (24, "void(*)(struct cpArbiter *, struct cpSpace *, void *)"),
        "userData": (48, "void *"),
    },
}
"""Fields of the engine's structs that are used directly: where they are, and their types."""

CONTACT_SIZE = 96
"""The size of the engine's struct of a contact."""


def plain(kind: str) -> str:
    """Return a function's type with all pointers alike, and vectors by our name."""
    kind = kind.replace(" noexcept", "").replace("Vector *", "void *")
    kind = kind.replace("struct cpVect *", "void *").replace("struct cpVect", "Vector")
    return re.sub(r"struct \w+ \*", "void *", kind).replace("void)", ")").replace(" ", "")
