"""Chipmunk, pymunk's engine, as the islands use it: spaces, bodies, shapes, joints, contacts.

Python calls its functions through pymunk. The compiled islands call the same functions by their
addresses: ``chipmunk.pxi`` is this module in C. No other module here knows the engine.
"""

from __future__ import annotations

from typing import Any, TypeAlias

from pymunk._chipmunk_cffi import ffi, lib

__all__ = [
    "DAMPED_SPRING", "GEAR", "NOTHING", "PIN", "PIVOT", "ROTARY_LIMIT", "ROTARY_SPRING", "SLIDE",
    "Arbiters", "Handle", "Vector", "add_body", "add_joint", "add_shape", "aim", "angle_of",
    "check_signals", "count_of", "first_of", "free_body", "free_joint", "free_shape", "free_space",
    "ground_of", "impulse_of", "make_joint", "new_body", "new_control", "new_disc", "new_ground",
    "new_polygon", "new_segment", "new_space", "normal_of", "point_of", "position_of", "push",
    "put", "remove_body", "remove_joint", "remove_shape", "scale", "second_of", "set_iterations",
    "set_joint", "set_max_bias", "set_max_force", "set_surface", "spin_of", "step", "used_of",
    "velocity_of", "watch",
]  # fmt: skip

Handle: TypeAlias = Any
"""A thing of the engine."""

Vector: TypeAlias = Any
"""A vector of the engine, with x and y."""

NOTHING: Handle = None

PIVOT, GEAR, SLIDE, PIN, DAMPED_SPRING, ROTARY_LIMIT, ROTARY_SPRING = range(7)
"""The kinds of joints."""

_KINDS = (
    ("Pivot", "Joint"), ("Gear", "Joint"), ("Slide", "Joint"), ("Pin", "Joint"),
    ("Damped", "Spring"), ("RotaryLimit", "Joint"), ("DampedRotary", "Spring"),
)  # fmt: skip
_ALLOC = [getattr(lib, f"cp{a}{b}Alloc") for a, b in _KINDS]
_INIT = [getattr(lib, f"cp{a}{b}Init") for a, b in _KINDS]
_OWN = [ffi.typeof(f"cp{a}{b} *") for a, b in _KINDS]
_BASE = ffi.typeof("cpConstraint *")

# -- spaces -----------------------------------------------------------------------------------


def new_space(slop: float) -> Handle:
    """Return a space. slop: the overlap that is left in steady contact, metres.

    What the solver remembers of a contact goes when it parts: it would count as impulse of the
    next.
    """
    space = lib.cpSpaceNew()
    lib.cpSpaceSetCollisionSlop(space, slop)
    lib.cpSpaceSetCollisionPersistence(space, 1)
    return space


def set_iterations(space: Handle, count: int) -> None:
    """Set how often the solver goes over contacts and joints."""
    lib.cpSpaceSetIterations(space, count)


def ground_of(space: Handle) -> Handle:
    """Return the body of a space that stands still."""
    return lib.cpSpaceGetStaticBody(space)


def step(space: Handle, h: float) -> None:
    """Step by h seconds, as if the last step had been as long."""
    lib.cpSpaceSetCurrentTimeStep(space, h)
    lib.cpSpaceStep(space, h)
    if _caught:
        raise _caught.pop()


free_space = lib.cpSpaceFree

# -- bodies and shapes ------------------------------------------------------------------------


def new_body(mass: float, moment: float, number: int) -> Handle:
    """Return a body, which is found by its number in contacts."""
    body = lib.cpBodyNew(mass, moment)
    lib.cpBodySetUserData(body, ffi.cast("void *", number))
    return body


def new_ground(number: int) -> Handle:
    """Return a body that stands still."""
    body = lib.cpBodyNewStatic()
    lib.cpBodySetUserData(body, ffi.cast("void *", number))
    return body


def new_disc(body: Handle, radius: float, x: float, y: float, surface: Any) -> Handle:
    """Return a disc on a body. surface: coefficients of friction and restitution."""
    return _surfaced(lib.cpCircleShapeNew(body, radius, (x, y)), surface)


def new_polygon(body: Handle, points: Any, surface: Any) -> Handle:
    """Return a convex polygon on a body, of points (x, y) counter-clockwise."""
    return _surfaced(lib.cpPolyShapeNewRaw(body, len(points), list(points), 0.0), surface)


def new_segment(body: Handle, ends: Any, surface: Any) -> Handle:
    """Return a wall without thickness between two points."""
    return _surfaced(lib.cpSegmentShapeNew(body, ends[0], ends[1], 0.0), surface)


def _surfaced(shape: Handle, surface: Any) -> Handle:
    lib.cpShapeSetFriction(shape, surface[0])
    lib.cpShapeSetElasticity(shape, surface[1])
    return shape


new_control = lib.cpBodyNewKinematic
add_body, remove_body, free_body = lib.cpSpaceAddBody, lib.cpSpaceRemoveBody, lib.cpBodyFree
add_shape, remove_shape, free_shape = lib.cpSpaceAddShape, lib.cpSpaceRemoveShape, lib.cpShapeFree


def put(body: Handle, x: float, y: float, angle: float) -> None:
    """Put a body somewhere."""
    lib.cpBodySetPosition(body, (x, y))
    lib.cpBodySetAngle(body, angle)


def aim(body: Handle, vx: float, vy: float, spin: float) -> None:
    """Give a body a velocity."""
    lib.cpBodySetVelocity(body, (vx, vy))
    lib.cpBodySetAngularVelocity(body, spin)


def push(body: Handle, x: float, y: float, torque: float) -> None:
    """Let a force and a torque act on a body in the next step."""
    lib.cpBodySetForce(body, (x, y))
    lib.cpBodySetTorque(body, torque)


position_of, velocity_of = lib.cpBodyGetPosition, lib.cpBodyGetVelocity
angle_of, spin_of = lib.cpBodyGetAngle, lib.cpBodyGetAngularVelocity

# -- joints -----------------------------------------------------------------------------------


def make_joint(
    kind: int, joint: Handle, a: Handle, b: Handle, ends: Any, p: float, q: float, r: float
) -> Handle:
    """Return a joint that has not held anything yet, in the memory of one outside of spaces.

    joint: that one, or NOTHING. ends: the anchors in the frames of a and b, and where none are
    needed, any. p, q, r: the kind's numbers, in the order in which the engine takes them.
    """
    itself = _ALLOC[kind]() if joint is None else ffi.cast(_OWN[kind], joint)
    if kind == PIVOT:
        _INIT[kind](itself, a, b, ends[0], ends[1])
    elif kind in (GEAR, ROTARY_LIMIT):
        _INIT[kind](itself, a, b, p, q)
    elif kind == SLIDE:
        _INIT[kind](itself, a, b, ends[0], ends[1], p, q)
    elif kind == PIN:
        _INIT[kind](itself, a, b, ends[0], ends[1])
    elif kind == DAMPED_SPRING:
        _INIT[kind](itself, a, b, ends[0], ends[1], p, q, r)
    else:
        _INIT[kind](itself, a, b, p, q, r)
    made = ffi.cast(_BASE, itself)
    if kind == PIN:
        lib.cpPinJointSetDist(made, p)
    return made


def set_joint(joint: Handle, bias: float, collide: bool) -> None:
    """Set what is left of its error after a second, and whether its bodies collide."""
    lib.cpConstraintSetErrorBias(joint, bias)
    lib.cpConstraintSetCollideBodies(joint, collide)


set_max_force, set_max_bias = lib.cpConstraintSetMaxForce, lib.cpConstraintSetMaxBias
add_joint, remove_joint = lib.cpSpaceAddConstraint, lib.cpSpaceRemoveConstraint
free_joint, used_of = lib.cpConstraintFree, lib.cpConstraintGetImpulse

# -- contacts ---------------------------------------------------------------------------------


_caught: list[BaseException] = []
"""What a signal's handler raised within a call of the engine, which would swallow it."""


def _catch(_kind: object, error: BaseException, _trace: object) -> None:
    _caught.append(error)


@ffi.callback("void(cpArbiter *, void *)", onerror=_catch)  # type: ignore[untyped-decorator]
def _NOTE(arbiter: Handle, data: Handle) -> None:  # noqa: N802
    ffi.from_handle(data).append(arbiter)


@ffi.callback("void(cpArbiter *, cpSpace *, void *)", onerror=_catch)  # type: ignore[untyped-decorator]
def _SETTLE(arbiter: Handle, _space: Handle, data: Handle) -> None:  # noqa: N802
    ffi.from_handle(data).settle(arbiter)


def watch(space: Handle, surfaces: Any) -> None:
    """Let surfaces settle each contact of a space before each step."""
    if surfaces.handle is None:
        surfaces.handle = ffi.new_handle(surfaces)
    handler = lib.cpSpaceAddGlobalCollisionHandler(space)
    handler.preSolveFunc, handler.userData = _SETTLE, surfaces.handle


class Arbiters:
    """The contacts that the solver of a space knows."""

    def __init__(self) -> None:
        """Start without any."""
        self._found: list[Handle] = []

    def find(self, space: Handle) -> int:
        """Find those of a space, and return how many there are."""
        self._found = []
        data = ffi.new_handle(self._found)
        lib.cpSpaceEachCachedArbiter(space, _NOTE, data)
        if _caught:
            raise _caught.pop()
        return len(self._found)

    def at(self, k: int) -> Handle:
        """Return one of those found last."""
        return self._found[k]


def _number_of(body: Handle) -> int:
    return int(ffi.cast("intptr_t", lib.cpBodyGetUserData(body)))


def first_of(arbiter: Handle) -> int:
    """Return the number of a contact's first body."""
    return _number_of(_bodies_of(arbiter)[0])


def second_of(arbiter: Handle) -> int:
    """Return the number of a contact's second body."""
    return _number_of(_bodies_of(arbiter)[1])


def _bodies_of(arbiter: Handle) -> tuple[Handle, Handle]:
    first, second = ffi.new("cpBody **"), ffi.new("cpBody **")
    lib.cpArbiterGetBodies(arbiter, first, second)
    return first[0], second[0]


def scale(arbiter: Handle, ratio: float) -> None:
    """Scale the impulses that the solver keeps of a contact."""
    for k in range(arbiter.count):
        contact = arbiter.contacts[k]
        contact.jnAcc *= ratio
        contact.jtAcc *= ratio


def set_surface(arbiter: Handle, friction: float, restitution: float) -> None:
    """Set the friction and the restitution of a contact for this step."""
    lib.cpArbiterSetFriction(arbiter, friction)
    lib.cpArbiterSetRestitution(arbiter, restitution)


count_of, impulse_of = lib.cpArbiterGetCount, lib.cpArbiterTotalImpulse
normal_of = lib.cpArbiterGetNormal


def point_of(arbiter: Handle, k: int, second: bool) -> Vector:
    """Return one of its points, on the surface of its first or second body."""
    return (lib.cpArbiterGetPointB if second else lib.cpArbiterGetPointA)(arbiter, k)


def check_signals() -> None:
    """Let a signal's handler run; Python does so by itself."""
