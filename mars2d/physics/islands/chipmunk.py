"""Chipmunk, pymunk's engine, as the islands use it: spaces, bodies, shapes, joints, contacts."""

from __future__ import annotations

from typing import Any

from pymunk._chipmunk_cffi import lib

from mars2d.physics.islands import library
from mars2d.physics.islands import shadow as cython
from mars2d.physics.islands.arithmetic import cosine_sine, implicitness
from mars2d.physics.islands.library import Arbiter, Handle, Vector, callback, doubles, vector

set_iterations, ground_of = lib.cpSpaceSetIterations, lib.cpSpaceGetStaticBody
free_space = lib.cpSpaceFree
new_control = lib.cpBodyNewKinematic
add_body, remove_body, free_body = lib.cpSpaceAddBody, lib.cpSpaceRemoveBody, lib.cpBodyFree
add_shape, remove_shape, free_shape = lib.cpSpaceAddShape, lib.cpSpaceRemoveShape, lib.cpShapeFree
position_of, velocity_of = lib.cpBodyGetPosition, lib.cpBodyGetVelocity
angle_of, spin_of = lib.cpBodyGetAngle, lib.cpBodyGetAngularVelocity
set_max_force, set_max_bias = lib.cpConstraintSetMaxForce, lib.cpConstraintSetMaxBias
add_joint, remove_joint = lib.cpSpaceAddConstraint, lib.cpSpaceRemoveConstraint
free_joint, used_of = lib.cpConstraintFree, lib.cpConstraintGetImpulse
count_of, impulse_of = lib.cpArbiterGetCount, lib.cpArbiterTotalImpulse
corners_of, set_type = lib.cpPolyShapeGetCount, lib.cpShapeSetCollisionType
set_data, data_of = lib.cpShapeSetUserData, lib.cpShapeGetUserData


@cython.cclass
class Held:
    """A thing of the engine that Python keeps: a shape, or a joint."""

    handle: Handle
    ground: Handle


# -- spaces -----------------------------------------------------------------------------------


def new_space(slop: cython.double) -> Handle:
    """Return a space. slop: the overlap that is left in steady contact, metres.

    What the solver remembers of a contact goes when it parts: it would count as impulse of the
    next.
    """
    space: Handle = lib.cpSpaceNew()
    lib.cpSpaceSetCollisionSlop(space, slop)
    lib.cpSpaceSetCollisionPersistence(space, 1)
    return space


def step(space: Handle, h: cython.double, bias: cython.double) -> cython.void:
    """Step by h seconds, as if the last step had been as long.

    bias: what is left after a second of an overlap beyond that which the space leaves.
    """
    lib.cpSpaceSetCollisionBias(space, bias)
    lib.cpSpaceSetCurrentTimeStep(space, h)
    lib.cpSpaceStep(space, h)
    library.raise_caught()


# -- bodies and shapes ------------------------------------------------------------------------


def new_body(mass: cython.double, moment: cython.double, number: cython.int) -> Handle:
    """Return a body, which is found by its number in contacts."""
    body: Handle = lib.cpBodyNew(mass, moment)
    lib.cpBodySetUserData(body, library.numbered(number))
    lib.cpBodySetPositionUpdateFunc(body, move)
    return body


def new_ground(number: cython.int) -> Handle:
    """Return a body that stands still."""
    body: Handle = lib.cpBodyNewStatic()
    lib.cpBodySetUserData(body, library.numbered(number))
    return body


def surfaced(shape: Handle, surface: Any) -> Handle:
    """Return a shape with coefficients of friction and restitution."""
    lib.cpShapeSetFriction(shape, surface[0])
    lib.cpShapeSetElasticity(shape, surface[1])
    return shape


def new_disc(
    body: Handle, radius: cython.double, x: cython.double, y: cython.double, surface: Any
) -> Handle:
    """Return a disc on a body. surface: coefficients of friction and restitution."""
    return surfaced(lib.cpCircleShapeNew(body, radius, vector(x, y)), surface)


def new_polygon(body: Handle, points: Any, surface: Any) -> Handle:
    """Return a convex polygon on a body, of points (x, y) counter-clockwise."""
    return surfaced(
        lib.cpPolyShapeNewRaw(body, len(points), library.vertices(points), 0.0), surface
    )


def new_segment(body: Handle, ends: Any, surface: Any) -> Handle:
    """Return a wall without thickness between two points."""
    a: Vector = vector(ends[0][0], ends[0][1])
    b: Vector = vector(ends[1][0], ends[1][1])
    return surfaced(lib.cpSegmentShapeNew(body, a, b, 0.0), surface)


def weight_at(body: Handle, ahead: cython.double) -> cython.void:
    """Put a body's centre of mass ahead of its pose, metres; velocities are those of the centre."""
    lib.cpBodySetCenterOfGravity(body, vector(ahead, 0.0))


def put(body: Handle, x: cython.double, y: cython.double, angle: cython.double) -> cython.void:
    """Put a body's pose somewhere, with sines that do not depend on the C library."""
    n: cython.p_double = doubles(body)
    c, s = cosine_sine(angle)
    n[library.CENTER] = (c * n[library.LEAD] - s * n[library.LEAD + 1]) + x
    n[library.CENTER + 1] = (s * n[library.LEAD] + c * n[library.LEAD + 1]) + y
    turn_to(body, angle, c, s)


def turn_to(body: Handle, angle: cython.double, c: cython.double, s: cython.double) -> cython.void:
    """Turn a body about its centre of mass. c, s: the cosine and the sine of its new angle."""
    n: cython.p_double = doubles(body)
    n[library.ANGLE] = angle
    n[library.TURN], n[library.TURN + 1], n[library.TURN + 2], n[library.TURN + 3] = c, s, -s, c
    n[library.TURN + 4] = n[library.CENTER] - (n[library.LEAD] * c - n[library.LEAD + 1] * s)
    n[library.TURN + 5] = n[library.CENTER + 1] - (n[library.LEAD] * s + n[library.LEAD + 1] * c)


@callback("void(cpBody *, double)")
def move(body: Handle, h: cython.double) -> cython.void:
    """Move a body for h seconds, as the engine does, with sines that depend on no C library."""
    n: cython.p_double = doubles(body)
    for k in range(2):
        n[library.CENTER + k] += (n[library.FAST + k] + n[library.BIAS + k]) * h
        n[library.BIAS + k] = 0.0
    angle: cython.double = n[library.ANGLE] + (n[library.SPIN] + n[library.SPIN_BIAS]) * h
    n[library.SPIN_BIAS] = 0.0
    c, s = cosine_sine(angle)
    turn_to(body, angle, c, s)


def aim(body: Handle, vx: cython.double, vy: cython.double, spin: cython.double) -> cython.void:
    """Give a body a velocity."""
    n: cython.p_double = doubles(body)
    n[library.FAST], n[library.FAST + 1], n[library.SPIN] = vx, vy, spin


def settle_down(body: Handle) -> cython.void:
    """Let a body forget by which velocity its overlaps are to be corrected in the next step."""
    n: cython.p_double = doubles(body)
    n[library.BIAS] = n[library.BIAS + 1] = n[library.SPIN_BIAS] = 0.0


def push(body: Handle, x: cython.double, y: cython.double, torque: cython.double) -> cython.void:
    """Let a force and a torque act on a body in the next step."""
    lib.cpBodySetForce(body, vector(x, y))
    lib.cpBodySetTorque(body, torque)


# -- joints -----------------------------------------------------------------------------------


def make_joint(
    kind: cython.int,
    joint: Handle,
    a: Handle,
    b: Handle,
    ends: Any,
    p: cython.double,
    q: cython.double,
    r: cython.double,
) -> Handle:
    """Return a joint that has not held anything yet, in the memory of one outside of spaces.

    joint: that one, or None. ends: the anchors in the frames of a and b, and where none are
    needed, any. p, q, r: the kind's numbers, in the order in which the engine takes them. A groove
    of a goes from (-p, -q) to (p, q).
    """
    on_a: Vector = vector(ends[0][0], ends[0][1])
    on_b: Vector = vector(ends[1][0], ends[1][1])
    itself: Handle = library.owned(kind, joint)
    made: Handle = library.as_joint(itself)
    if kind == library.PIVOT:
        lib.cpPivotJointInit(itself, a, b, on_a, on_b)
    elif kind == library.GROOVE:
        lib.cpGrooveJointInit(itself, a, b, vector(-p, -q), vector(p, q), on_b)
    elif kind == library.GEAR:
        lib.cpGearJointInit(itself, a, b, p, q)
    elif kind == library.SLIDE:
        lib.cpSlideJointInit(itself, a, b, on_a, on_b, p, q)
    elif kind == library.PIN:
        lib.cpPinJointInit(itself, a, b, on_a, on_b)
        lib.cpPinJointSetDist(made, p)
    elif kind == library.ROTARY_LIMIT:
        lib.cpRotaryLimitJointInit(itself, a, b, p, q)
    elif kind == library.DAMPED_SPRING:
        lib.cpDampedSpringInit(itself, a, b, on_a, on_b, p, q, r)
        if r > 0.0:
            lib.cpDampedSpringSetSpringForceFunc(made, pull)
    else:
        lib.cpDampedRotarySpringInit(itself, a, b, p, q, r)
        if r > 0.0:
            lib.cpDampedRotarySpringSetSpringTorqueFunc(made, twist_back)
    return made


def set_joint(joint: Handle, bias: cython.double, collide: cython.bint) -> cython.void:
    """Set the share of its error that is left after a second, and whether its bodies collide."""
    lib.cpConstraintSetErrorBias(joint, bias)
    lib.cpConstraintSetCollideBodies(joint, collide)


def set_limits(joint: Handle, least: cython.double, largest: cython.double) -> cython.void:
    """Set the limits of a joint of the kind ROTARY_LIMIT."""
    lib.cpRotaryLimitJointSetMin(joint, least)
    lib.cpRotaryLimitJointSetMax(joint, largest)


@callback("double(cpConstraint *, double)")
def pull(spring: Handle, length: cython.double) -> cython.double:
    """Return the force of a spring; see `damped`."""
    n: cython.p_double = doubles(spring)
    a: cython.p_double = doubles(lib.cpConstraintGetBodyA(spring))
    b: cython.p_double = doubles(lib.cpConstraintGetBodyB(spring))
    arms: cython.p_double = n + library.LOST + 1  # x, y of that to its end on a, then on b
    normal: cython.p_double = n + library.EFFECTIVE_MASS + 1
    x: cython.double = (b[library.FAST] - b[library.SPIN] * arms[3]) - (
        a[library.FAST] - a[library.SPIN] * arms[1]
    )
    y: cython.double = (b[library.FAST + 1] + b[library.SPIN] * arms[2]) - (
        a[library.FAST + 1] + a[library.SPIN] * arms[0]
    )
    closing: cython.double = x * normal[0] + y * normal[1]
    stretch: cython.double = n[library.REST] - length
    return stretch * damped(spring, library.REST, library.LOST, library.EFFECTIVE_MASS, closing)


@callback("double(cpConstraint *, double)")
def twist_back(spring: Handle, angle: cython.double) -> cython.double:
    """Return the torque of a spring that turns; see `damped`."""
    a: cython.p_double = doubles(lib.cpConstraintGetBodyA(spring))
    b: cython.p_double = doubles(lib.cpConstraintGetBodyB(spring))
    closing: cython.double = a[library.SPIN] - b[library.SPIN]
    rest: cython.double = doubles(spring)[library.REST_ANGLE]
    return (angle - rest) * damped(
        spring, library.REST_ANGLE, library.LOST_TURNING, library.EFFECTIVE_MOMENT, closing
    )


def damped(
    spring: Handle,
    rest: cython.int,
    lost: cython.int,
    effective: cython.int,
    closing: cython.double,
) -> cython.double:
    """Return a spring's stiffness, and let its damper act on the speed all through the step.

    closing: the speed before the step. The engine works out the share of speed that is lost with
    the C library's exponential, and asks for the force right after it. It draws the speed v* that
    all forces lead to towards the number in front of `lost`, by the share there. So it becomes
    v' = v* - x ((1 - theta) v + theta v'), where x is what fades and theta is such that this is
    exact with no other force, and at rest where forces hold the spring.
    """
    n: cython.p_double = doubles(spring)
    h: cython.double = lib.cpSpaceGetCurrentTimeStep(lib.cpConstraintGetSpace(spring))
    fades: cython.double = n[rest + 2] * h / n[effective]
    theta: cython.double = implicitness(fades)
    n[lost - 1] = -closing * (1.0 - theta) / theta
    n[lost] = fades * theta / (1.0 + fades * theta)
    stiffness: cython.double = n[rest + 1]
    return stiffness


def reaction_of(joint: Handle, kind: cython.int) -> Vector:
    """Return the impulse of a joint, PIVOT or GROOVE, on its second body in the last step."""
    n: cython.p_double = doubles(joint) + (
        library.GROOVE_IMPULSE if kind == library.GROOVE else library.PIVOT_IMPULSE
    )
    return vector(n[0], n[1])


def twist_of(joint: Handle) -> cython.double:
    """Return the turning impulse of a joint of the kind GEAR on its second body."""
    impulse: cython.double = doubles(joint)[library.GEAR_IMPULSE]
    return impulse


# -- contacts ---------------------------------------------------------------------------------


def first_of(arbiter: Arbiter) -> cython.int:
    """Return the number of a contact's first body."""
    return library.number_of(arbiter.body_a)


def second_of(arbiter: Arbiter) -> cython.int:
    """Return the number of a contact's second body."""
    return library.number_of(arbiter.body_b)


def scale(arbiter: Arbiter, ratio: cython.double) -> cython.void:
    """Scale the impulses that the solver keeps of a contact."""
    for k in range(arbiter.count):
        arbiter.contacts[k].jnAcc *= ratio
        arbiter.contacts[k].jtAcc *= ratio


def set_surface(
    arbiter: Arbiter, friction: cython.double, restitution: cython.double
) -> cython.void:
    """Set the friction and the restitution of a contact for this step."""
    lib.cpArbiterSetFriction(arbiter, friction)
    lib.cpArbiterSetRestitution(arbiter, restitution)


def shape_of(arbiter: Arbiter, second: cython.bint) -> Handle:
    """Return a contact's first or second shape."""
    return arbiter.b if second else arbiter.a


def put_point(
    arbiter: Arbiter, ax: cython.double, ay: cython.double, bx: cython.double, by: cython.double
) -> cython.void:
    """Let a contact have one point, at these places on its bodies, without impulses so far."""
    a: cython.p_double = doubles(arbiter.body_a)
    b: cython.p_double = doubles(arbiter.body_b)
    arbiter.count = 1
    arbiter.contacts[0].r1 = vector(ax - a[library.CENTER], ay - a[library.CENTER + 1])
    arbiter.contacts[0].r2 = vector(bx - b[library.CENTER], by - b[library.CENTER + 1])
    arbiter.contacts[0].jnAcc = arbiter.contacts[0].jtAcc = 0.0


def point_of(arbiter: Arbiter, k: cython.int, second: cython.bint) -> Vector:
    """Return one of its points, on the surface of its first or second body."""
    if second:
        return lib.cpArbiterGetPointB(arbiter, k)
    return lib.cpArbiterGetPointA(arbiter, k)


def depth_of(arbiter: Arbiter, k: cython.int) -> cython.double:
    """Return how deep bodies are in each other in one of its points, metres."""
    apart: cython.double = lib.cpArbiterGetDepth(arbiter, k)
    return -apart


def corner_of(shape: Handle, k: cython.int) -> Vector:
    """Return where a corner of a polygon is."""
    return lib.cpBodyLocalToWorld(lib.cpShapeGetBody(shape), lib.cpPolyShapeGetVert(shape, k))


def place_of(shape: Handle, x: cython.double, y: cython.double) -> Vector:
    """Return where a point in the frame of a shape's body is."""
    return lib.cpBodyLocalToWorld(lib.cpShapeGetBody(shape), vector(x, y))
