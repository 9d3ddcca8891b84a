"""Pymunk's library of the engine, as far as Python and C use it in different ways.

Python calls its functions through pymunk. The compiled islands call the same functions by their
addresses: ``library.pxi`` is this module in C. Tests find out where its numbers are.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias, TypeVar

from pymunk._chipmunk_cffi import ffi, lib

T = TypeVar("T")

Handle: TypeAlias = Any
"""A thing of the engine."""

Vector: TypeAlias = Any
"""A vector of the engine, with x and y."""

Arbiter: TypeAlias = Any
"""A contact of two shapes: a and b, of body_a and body_b, with n, its normal from a to b.

It has `count` points, of which none counts in a step that begins with 0. Each of `contacts` is one:
r1 and r2 lead to it from the bodies' centres of mass, jnAcc and jtAcc are the impulses on b along
the normal and a quarter turn to its left [N s], and bounce is the restitution times the speed at
which bodies parted before the step [m/s].
"""

# -- where the engine has its numbers -----------------------------------------------------------

PIVOT, GROOVE, GEAR, SLIDE, PIN, DAMPED_SPRING, ROTARY_LIMIT, ROTARY_SPRING = range(8)
"""The kinds of joints, in the order in which `build` names the functions that make them."""

SEWN, JOINED = 1, 2
"""The engine's collision types: of walls that meet others, and of pieces that lie flush."""

_KINDS = (
    "PivotJoint", "GrooveJoint", "GearJoint", "SlideJoint", "PinJoint", "DampedSpring",
    "RotaryLimitJoint", "DampedRotarySpring",
)  # fmt: skip
_POINTER = ffi.sizeof("void *")
"""The size of an address, bytes: 8, and 4 in WebAssembly."""

_JOINT = (24 + 10 * _POINTER) // 8
"""Where the structs of joints have the fields of their kind, in numbers of eight bytes.

Three numbers, nine pointers, and a truth that is as long as one stand before them.
"""

PIVOT_IMPULSE, GEAR_IMPULSE, GROOVE_IMPULSE = _JOINT + 12, _JOINT + 5, _JOINT + 19
"""Where the engine's structs of these joints have their impulses, in numbers of eight bytes."""

REST, REST_ANGLE = _JOINT + 4, _JOINT
"""Where the engine's springs, and those that turn, have their rest, in numbers of eight bytes.

Stiffness and damping follow.
"""

LOST, LOST_TURNING, EFFECTIVE_MASS, EFFECTIVE_MOMENT = (
    _JOINT + 9,
    _JOINT + 5,
    _JOINT + 14,
    _JOINT + 6,
)
"""Where they have the share of speed that a step loses, and the mass or moment that is felt."""

_BODY = 2 * _POINTER // 8
"""Where the structs of bodies have their mass, behind two pointers, in numbers of eight bytes."""

LEAD, CENTER, FAST, ANGLE, SPIN, TURN, BIAS, SPIN_BIAS = (
    _BODY + k for k in (4, 6, 8, 12, 13, 15, 22, 24)
)
"""Where the engine's bodies have these, in numbers of eight bytes.

They are the centre of mass in the body's frame and in the world, its velocity, angle and spin, the
transformation to the world, and the velocity and spin by which overlaps are corrected.
"""

SHAPES = (-(-(64 + 3 * _POINTER) // 8) * 8 + 8) // _POINTER + 4
"""Where the engine's spaces have the number of the next shape, in addresses."""

# -- values and addresses -----------------------------------------------------------------------


def vector(x: float, y: float) -> Vector:
    """Return a vector of the engine."""
    return ffi.new("cpVect *", (x, y))[0]


def vertices(points: Any) -> Any:
    """Return points (x, y) as the engine takes them."""
    return list(points)


def doubles(thing: Handle) -> Any:
    """Return the memory of a body or joint as numbers of eight bytes."""
    return ffi.cast("double *", thing)


def number_shapes_again(space: Handle) -> None:
    """Let a space without shapes number those to come as a new one does: their order follows."""
    ffi.cast("uintptr_t *", space)[SHAPES] = 0


def numbered(number: int) -> Handle:
    """Return a number as the engine keeps it for a body."""
    return ffi.cast("void *", number)


def number_of(body: Handle) -> int:
    """Return the number that the engine keeps for a body."""
    return int(ffi.cast("intptr_t", lib.cpBodyGetUserData(body)))


def address_of(thing: Any) -> Handle:
    """Return by what the engine finds an object with a `handle`, as long as that exists."""
    if thing.handle is None:
        thing.handle = ffi.new_handle(thing)
    return thing.handle


def thing_at(address: Handle) -> Any:
    """Return the object with this address."""
    return ffi.from_handle(address)


def owned(kind: int, joint: Handle) -> Handle:
    """Return a joint, new memory for one if there is none, as its kind's functions take it."""
    name = f"cp{_KINDS[kind]}"
    return getattr(lib, f"{name}Alloc")() if joint is None else ffi.cast(f"{name} *", joint)


def as_joint(joint: Handle) -> Handle:
    """Return a joint as functions for all kinds take it."""
    return ffi.cast("cpConstraint *", joint)


# -- what the engine calls ----------------------------------------------------------------------

_caught: list[BaseException] = []
"""What a signal's handler raised within a call of the engine, which would swallow it."""


def _catch(_kind: object, error: BaseException, _trace: object) -> None:
    _caught.append(error)


def raise_caught() -> None:
    """Raise what was raised while the engine ran."""
    if _caught:
        raise _caught.pop()


def check_signals() -> None:
    """Let a signal's handler run; Python does so by itself."""


def callback(kind: str) -> Callable[[T], T]:
    """Return a decorator for a function of this type in C, which the engine calls."""
    decorator: Callable[[T], T] = ffi.callback(kind, onerror=_catch)
    return decorator


def handle_contacts(space: Handle, kind: int, before: Any) -> None:
    """Let a function be called with each contact of a type of shapes before each step."""
    lib.cpSpaceAddWildcardHandler(space, kind).preSolveFunc = before


def watch_contacts(space: Handle, before: Any, thing: Any) -> None:
    """Let a function be called with each contact, and the address of an object."""
    handler = lib.cpSpaceAddGlobalCollisionHandler(space)
    handler.preSolveFunc, handler.userData = before, address_of(thing)


@callback("void(cpBody *, cpArbiter *, void *)")
def _note(body: Handle, arbiter: Arbiter, data: Handle) -> None:
    first = arbiter.body_a  # its function would tell `body` first
    if first == body or number_of(first) < 0:
        thing_at(data).append(arbiter)


class Arbiters:
    """Contacts that the solver of a space knows, in an order that depends on no address."""

    def __init__(self) -> None:
        """Start without any."""
        self._found: list[Arbiter] = []

    def clear(self) -> None:
        """Forget all that were found."""
        self._found = []

    def add_those_of(self, body: Handle) -> None:
        """Find those of a body; one of two bodies is found at its first."""
        lib.cpBodyEachArbiter(body, _note, ffi.new_handle(self._found))
        raise_caught()

    def count(self) -> int:
        """Return how many were found."""
        return len(self._found)

    def at(self, k: int) -> Arbiter:
        """Return one of those found."""
        return self._found[k]
