"""Chipmunk, pymunk's engine, as the islands use it: spaces, bodies, shapes, joints, contacts.

Python calls its functions through pymunk. The compiled islands call the same functions by their
addresses: ``chipmunk.pxi`` is this module in C. Tests find out where its numbers are.
"""

from __future__ import annotations

from typing import Any, TypeAlias

from pymunk._chipmunk_cffi import ffi, lib

from mars2d.physics.islands.arithmetic import cosine_sine, implicitness

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

PIVOT, GEAR, SLIDE, PIN, DAMPED_SPRING, ROTARY_LIMIT, ROTARY_SPRING, GROOVE = range(8)
"""The kinds of joints."""

_KINDS = (
    ("Pivot", "Joint"), ("Gear", "Joint"), ("Slide", "Joint"), ("Pin", "Joint"),
    ("Damped", "Spring"), ("RotaryLimit", "Joint"), ("DampedRotary", "Spring"),
    ("Groove", "Joint"),
)  # fmt: skip
_ALLOC = [getattr(lib, f"cp{a}{b}Alloc") for a, b in _KINDS]
_INIT = [getattr(lib, f"cp{a}{b}Init") for a, b in _KINDS]
_OWN = [ffi.typeof(f"cp{a}{b} *") for a, b in _KINDS]
_POINTER = ffi.sizeof("void *")
"""The size of an address, bytes: 8, and 4 in WebAssembly."""

_JOINT = (24 + 10 * _POINTER) // 8
"""Where the structs of joints have the fields of their kind, in numbers of eight bytes.

Three numbers, nine pointers, and a truth that is as long as one stand before them.
"""

PIVOT_IMPULSE, GEAR_IMPULSE, GROOVE_IMPULSE = _JOINT + 12, _JOINT + 5, _JOINT + 19
"""Where the engine's structs of these joints have their impulses, in numbers of eight bytes."""

_BASE = ffi.typeof("cpConstraint *")

_caught: list[BaseException] = []
"""What a signal's handler raised within a call of the engine, which would swallow it."""


def _catch(_kind: object, error: BaseException, _trace: object) -> None:
    _caught.append(error)


# -- spaces -----------------------------------------------------------------------------------


def new_space(slop: float) -> Handle:
    """Return a space. slop: the overlap that is left in steady contact, metres.

    What the solver remembers of a contact goes when it parts: it would count as impulse of the
    next.
    """
    space = lib.cpSpaceNew()
    lib.cpSpaceSetCollisionSlop(space, slop)
    lib.cpSpaceSetCollisionPersistence(space, 1)
    lib.cpSpaceAddWildcardHandler(space, SEWN).preSolveFunc = _CORRECT
    lib.cpSpaceAddWildcardHandler(space, JOINED).preSolveFunc = _STRAIGHTEN
    return space


def step(space: Handle, h: float, bias: float) -> None:
    """Step by h seconds, as if the last step had been as long.

    bias: what is left after a second of an overlap beyond that which the space leaves.
    """
    lib.cpSpaceSetCollisionBias(space, bias)
    lib.cpSpaceSetCurrentTimeStep(space, h)
    lib.cpSpaceStep(space, h)
    if _caught:
        raise _caught.pop()


set_iterations, ground_of = lib.cpSpaceSetIterations, lib.cpSpaceGetStaticBody
free_space = lib.cpSpaceFree

# -- bodies and shapes ------------------------------------------------------------------------


def new_body(mass: float, moment: float, number: int) -> Handle:
    """Return a body, which is found by its number in contacts."""
    body = lib.cpBodyNew(mass, moment)
    lib.cpBodySetUserData(body, ffi.cast("void *", number))
    lib.cpBodySetPositionUpdateFunc(body, _MOVE)
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


def weight_at(body: Handle, ahead: float) -> None:
    """Put a body's centre of mass ahead of its pose, metres; velocities are those of the centre."""
    lib.cpBodySetCenterOfGravity(body, (ahead, 0.0))


_BODY = 2 * _POINTER // 8
"""Where the structs of bodies have their mass, behind two pointers, in numbers of eight bytes."""

LEAD, CENTER, FAST, ANGLE, SPIN, TURN, BIAS, SPIN_BIAS = (
    _BODY + k for k in (4, 6, 8, 12, 13, 15, 22, 24)
)
"""Where the engine's bodies have these, in numbers of eight bytes.

They are the centre of mass in the body's frame and in the world, its velocity, angle and spin, the
transformation to the world, and the velocity and spin by which overlaps are corrected.
"""


def put(body: Handle, x: float, y: float, angle: float) -> None:
    """Put a body's pose somewhere, with sines that do not depend on the C library."""
    numbers = ffi.cast("double *", body)
    c, s = cosine_sine(angle)
    ahead, left = numbers[LEAD], numbers[LEAD + 1]
    numbers[CENTER], numbers[CENTER + 1] = (c * ahead - s * left) + x, (s * ahead + c * left) + y
    _turn(numbers, angle, c, s)


def _turn(numbers: Any, angle: float, c: float, s: float) -> None:
    """Turn a body about its centre of mass. c, s: the cosine and the sine of its new angle."""
    ahead, left = numbers[LEAD], numbers[LEAD + 1]
    numbers[ANGLE] = angle
    numbers[TURN], numbers[TURN + 1], numbers[TURN + 2], numbers[TURN + 3] = c, s, -s, c
    numbers[TURN + 4] = numbers[CENTER] - (ahead * c - left * s)
    numbers[TURN + 5] = numbers[CENTER + 1] - (ahead * s + left * c)


@ffi.callback("void(cpBody *, double)", onerror=_catch)  # type: ignore[untyped-decorator]
def _MOVE(body: Handle, h: float) -> None:  # noqa: N802
    numbers = ffi.cast("double *", body)
    for k in range(2):
        numbers[CENTER + k] += (numbers[FAST + k] + numbers[BIAS + k]) * h
        numbers[BIAS + k] = 0.0
    angle = numbers[ANGLE] + (numbers[SPIN] + numbers[SPIN_BIAS]) * h
    numbers[SPIN_BIAS] = 0.0
    _turn(numbers, angle, *cosine_sine(angle))


def aim(body: Handle, vx: float, vy: float, spin: float) -> None:
    """Give a body a velocity."""
    lib.cpBodySetVelocity(body, (vx, vy))
    lib.cpBodySetAngularVelocity(body, spin)


def settle_down(body: Handle) -> None:
    """Let a body forget by which velocity its overlaps are to be corrected in the next step."""
    numbers = ffi.cast("double *", body)
    numbers[BIAS] = numbers[BIAS + 1] = numbers[SPIN_BIAS] = 0.0


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

    joint: that one, or None. ends: the anchors in the frames of a and b, and where none are
    needed, any. p, q, r: the kind's numbers, in the order in which the engine takes them. A groove
    of a goes from (-p, -q) to (p, q).
    """
    itself = _ALLOC[kind]() if joint is None else ffi.cast(_OWN[kind], joint)
    taken: tuple[Any, ...] = (p, q, r)
    if kind in (GEAR, ROTARY_LIMIT):
        taken = (p, q)
    elif kind in (PIVOT, PIN):
        taken = ends
    elif kind == GROOVE:
        taken = (-p, -q), (p, q), ends[1]
    elif kind == SLIDE:
        taken = (*ends, p, q)
    elif kind == DAMPED_SPRING:
        taken = (*ends, p, q, r)
    _INIT[kind](itself, a, b, *taken)
    made = ffi.cast(_BASE, itself)
    if kind == PIN:
        lib.cpPinJointSetDist(made, p)
    elif kind == DAMPED_SPRING and r > 0.0:
        lib.cpDampedSpringSetSpringForceFunc(made, _PULL)
    elif kind == ROTARY_SPRING and r > 0.0:
        lib.cpDampedRotarySpringSetSpringTorqueFunc(made, _TWIST)
    return made


def set_joint(joint: Handle, bias: float, collide: bool) -> None:
    """Set the share of its error that is left after a second, and whether its bodies collide."""
    lib.cpConstraintSetErrorBias(joint, bias)
    lib.cpConstraintSetCollideBodies(joint, collide)


def set_limits(joint: Handle, least: float, largest: float) -> None:
    """Set the limits of a joint of the kind ROTARY_LIMIT."""
    lib.cpRotaryLimitJointSetMin(joint, least)
    lib.cpRotaryLimitJointSetMax(joint, largest)


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
"""Where they have the share of speed that is lost in a step, and the mass or moment that is felt.

The engine works out that share with the C library's exponential, and asks for the force right after
it. So the functions below, which return the force, replace the share, and the speed in front of it
that is drawn near.
"""


@ffi.callback("double(cpConstraint *, double)", onerror=_catch)  # type: ignore[untyped-decorator]
def _PULL(spring: Handle, length: float) -> float:  # noqa: N802
    n = ffi.cast("double *", spring)
    ax, ay, bx, by = (float(n[LOST + 1 + k]) for k in range(4))  # the arms to its ends
    a, b = (ffi.cast("double *", body) for body in _ends_of(spring))
    x = (b[FAST] - b[SPIN] * by) - (a[FAST] - a[SPIN] * ay)
    y = (b[FAST + 1] + b[SPIN] * bx) - (a[FAST + 1] + a[SPIN] * ax)
    closing = x * n[EFFECTIVE_MASS + 1] + y * n[EFFECTIVE_MASS + 2]
    return float(n[REST] - length) * _damped(spring, REST, LOST, EFFECTIVE_MASS, closing)


@ffi.callback("double(cpConstraint *, double)", onerror=_catch)  # type: ignore[untyped-decorator]
def _TWIST(spring: Handle, angle: float) -> float:  # noqa: N802
    a, b = (ffi.cast("double *", body) for body in _ends_of(spring))
    stiffness = _damped(spring, REST_ANGLE, LOST_TURNING, EFFECTIVE_MOMENT, a[SPIN] - b[SPIN])
    return float(angle - ffi.cast("double *", spring)[REST_ANGLE]) * stiffness


def _ends_of(spring: Handle) -> tuple[Handle, Handle]:
    return lib.cpConstraintGetBodyA(spring), lib.cpConstraintGetBodyB(spring)


def _damped(spring: Handle, rest: int, lost: int, effective: int, closing: float) -> float:
    """Return a spring's stiffness, and let its damper act on the speed all through the step.

    closing: the speed before the step. The engine draws the speed v* that all forces lead to
    towards the number in front of `lost`, by the share there. So it becomes
    v' = v* - x ((1 - theta) v + theta v'), where x is what fades and theta is such that this is
    exact with no other force, and at rest where forces hold the spring.
    """
    n = ffi.cast("double *", spring)
    h = lib.cpSpaceGetCurrentTimeStep(lib.cpConstraintGetSpace(spring))
    fades = float(n[rest + 2]) * h / float(n[effective])
    theta = implicitness(fades)
    n[lost - 1] = -closing * (1.0 - theta) / theta
    n[lost] = fades * theta / (1.0 + fades * theta)
    return float(n[rest + 1])


def reaction_of(joint: Handle, kind: int) -> Vector:
    """Return the impulse of a joint, PIVOT or GROOVE, on its second body in the last step."""
    numbers = ffi.cast("double *", joint)
    place = GROOVE_IMPULSE if kind == GROOVE else PIVOT_IMPULSE
    return ffi.new("cpVect *", (numbers[place], numbers[place + 1]))[0]


def twist_of(joint: Handle) -> float:
    """Return the turning impulse of a joint of the kind GEAR on its second body."""
    return float(ffi.cast("double *", joint)[GEAR_IMPULSE])


set_max_force, set_max_bias = lib.cpConstraintSetMaxForce, lib.cpConstraintSetMaxBias
add_joint, remove_joint = lib.cpSpaceAddConstraint, lib.cpSpaceRemoveConstraint
free_joint, used_of = lib.cpConstraintFree, lib.cpConstraintGetImpulse

# -- contacts ---------------------------------------------------------------------------------


@ffi.callback(  # type: ignore[untyped-decorator]
    "void(cpBody *, cpArbiter *, void *)", onerror=_catch
)
def _NOTE(body: Handle, arbiter: Arbiter, data: Handle) -> None:  # noqa: N802
    first = arbiter.body_a  # its function would tell `body` first
    if first == body or _number_of(first) < 0:
        ffi.from_handle(data).append(arbiter)


@ffi.callback("void(cpArbiter *, cpSpace *, void *)", onerror=_catch)  # type: ignore[untyped-decorator]
def _SETTLE(arbiter: Arbiter, _space: Handle, data: Handle) -> None:  # noqa: N802
    ffi.from_handle(data).settle(arbiter)


def watch(space: Handle, surfaces: Any) -> None:
    """Let surfaces settle each contact of a space before each step."""
    if surfaces.handle is None:
        surfaces.handle = ffi.new_handle(surfaces)
    handler = lib.cpSpaceAddGlobalCollisionHandler(space)
    handler.preSolveFunc, handler.userData = _SETTLE, surfaces.handle


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
        data = ffi.new_handle(self._found)
        lib.cpBodyEachArbiter(body, _NOTE, data)
        if _caught:
            raise _caught.pop()

    def count(self) -> int:
        """Return how many were found."""
        return len(self._found)

    def at(self, k: int) -> Arbiter:
        """Return one of those found."""
        return self._found[k]


def _number_of(body: Handle) -> int:
    return int(ffi.cast("intptr_t", lib.cpBodyGetUserData(body)))


def first_of(arbiter: Arbiter) -> int:
    """Return the number of a contact's first body."""
    return _number_of(arbiter.body_a)


def second_of(arbiter: Arbiter) -> int:
    """Return the number of a contact's second body."""
    return _number_of(arbiter.body_b)


def scale(arbiter: Arbiter, ratio: float) -> None:
    """Scale the impulses that the solver keeps of a contact."""
    for k in range(arbiter.count):
        contact = arbiter.contacts[k]
        contact.jnAcc *= ratio
        contact.jtAcc *= ratio


def set_surface(arbiter: Arbiter, friction: float, restitution: float) -> None:
    """Set the friction and the restitution of a contact for this step."""
    lib.cpArbiterSetFriction(arbiter, friction)
    lib.cpArbiterSetRestitution(arbiter, restitution)


count_of, impulse_of = lib.cpArbiterGetCount, lib.cpArbiterTotalImpulse


def shape_of(arbiter: Arbiter, second: bool) -> Handle:
    """Return a contact's first or second shape."""
    return arbiter.b if second else arbiter.a


def put_point(arbiter: Arbiter, ax: float, ay: float, bx: float, by: float) -> None:
    """Let a contact have one point, at these places on its bodies, without impulses so far."""
    a, b = ffi.cast("double *", arbiter.body_a), ffi.cast("double *", arbiter.body_b)
    contact, arbiter.count = arbiter.contacts[0], 1
    contact.r1.x, contact.r1.y = ax - a[CENTER], ay - a[CENTER + 1]
    contact.r2.x, contact.r2.y = bx - b[CENTER], by - b[CENTER + 1]
    contact.jnAcc = contact.jtAcc = 0.0


def point_of(arbiter: Arbiter, k: int, second: bool) -> Vector:
    """Return one of its points, on the surface of its first or second body."""
    return (lib.cpArbiterGetPointB if second else lib.cpArbiterGetPointA)(arbiter, k)


def depth_of(arbiter: Arbiter, k: int) -> float:
    """Return how deep bodies are in each other in one of its points, metres."""
    return -float(lib.cpArbiterGetDepth(arbiter, k))


def check_signals() -> None:
    """Let a signal's handler run; Python does so by itself."""


# -- seams ------------------------------------------------------------------------------------

SEWN, JOINED = 1, 2
"""The engine's collision types: of walls that meet others, and of pieces that lie flush."""


@ffi.callback("void(cpArbiter *, cpSpace *, void *)", onerror=_catch)  # type: ignore[untyped-decorator]
def _CORRECT(arbiter: Arbiter, _space: Handle, _data: Handle) -> None:  # noqa: N802
    first = first_of(arbiter) < 0
    data = lib.cpShapeGetUserData(arbiter.a if first else arbiter.b)
    ffi.from_handle(data).correct(arbiter, first)


def sew(segment: Handle, seams: Any) -> None:
    """Let contacts with a wall be corrected at its seams."""
    if seams.handle is None:
        seams.handle = ffi.new_handle(seams)
    lib.cpShapeSetUserData(segment, seams.handle)
    lib.cpShapeSetCollisionType(segment, SEWN)


corners_of = lib.cpPolyShapeGetCount


def corner_of(shape: Handle, k: int) -> Vector:
    """Return where a corner of a polygon is."""
    return lib.cpBodyLocalToWorld(lib.cpShapeGetBody(shape), lib.cpPolyShapeGetVert(shape, k))


@ffi.callback("void(cpArbiter *, cpSpace *, void *)", onerror=_catch)  # type: ignore[untyped-decorator]
def _STRAIGHTEN(arbiter: Arbiter, _space: Handle, _data: Handle) -> None:  # noqa: N802
    if first_of(arbiter) >= 0 and second_of(arbiter) >= 0:
        flush_of(arbiter, False).straighten(arbiter)


def show(shape: Handle, flush: Any) -> None:
    """Say what is to straighten contacts with a shape of a body, once it is joined."""
    flush.handle = ffi.new_handle(flush)
    lib.cpShapeSetUserData(shape, flush.handle)


def join(shape: Handle) -> None:
    """Let contacts with a shape of a body be straightened."""
    lib.cpShapeSetCollisionType(shape, JOINED)


def flush_of(arbiter: Arbiter, second: bool) -> Any:
    """Return what was shown of a contact's first or second shape."""
    return ffi.from_handle(lib.cpShapeGetUserData(shape_of(arbiter, second)))


def place_of(shape: Handle, x: float, y: float) -> Vector:
    """Return where a point in the frame of a shape's body is."""
    return lib.cpBodyLocalToWorld(lib.cpShapeGetBody(shape), (x, y))
