# chipmunk.py in C: the engine's functions by their addresses, which `connect` takes.

from cpython.exc cimport PyErr_CheckSignals
from libc.stdint cimport intptr_t, uintptr_t
from libc.stdlib cimport free as free_memory, realloc

ctypedef void *Handle

cdef struct Vector:
    double x, y

cdef Engine engine

# The first fields of the engine's structs, as far as they are used.

cdef struct cpContact:
    Vector r1, r2
    double nMass, tMass, bounce, jnAcc, jtAcc, jBias, bias
    uintptr_t hash

cdef struct cpArbiter:
    double e, u
    Vector surface_vr
    Handle data, a, b, body_a, body_b
    Handle thread_a[2]
    Handle thread_b[2]
    int count
    cpContact *contacts
    Vector n

ctypedef cpArbiter *Arbiter
ctypedef void (*Before)(Handle, Handle, Handle) noexcept

cdef struct cpCollisionHandler:
    uintptr_t typeA, typeB
    Handle beginFunc
    Before preSolveFunc
    Handle postSolveFunc, separateFunc, userData

cdef enum:  # where the engine has its numbers, and its collision types: see chipmunk.py
    LEAD = 6, CENTER = 8, FAST = 10, ANGLE = 14, SPIN = 15, TURN = 17, BIAS = 24, SPIN_BIAS = 26
    REST = 17, REST_ANGLE = 13, LOST = 22, LOST_TURNING = 18, EFFECTIVE_MASS = 27, EFFECTIVE_MOMENT = 19
    PIVOT_IMPULSE = 25, GEAR_IMPULSE = 18, GROOVE_IMPULSE = 32
    SEWN = 1, JOINED = 2

cdef enum:
    PIVOT, GEAR, SLIDE, PIN, DAMPED_SPRING, ROTARY_LIMIT, ROTARY_SPRING, GROOVE


def connect(addresses):
    """Take the addresses of the engine's functions, in the order in which they stand above."""
    cdef int k
    if len(addresses) * sizeof(Handle) != sizeof(engine):
        raise ValueError(f"{len(addresses)} functions")
    for k, address in enumerate(addresses):
        (<uintptr_t *>&engine)[k] = address

cdef inline Vector vector(double x, double y) noexcept:
    cdef Vector made
    made.x, made.y = x, y
    return made

cdef void set_handler(Handle handler, Before before, Handle data) noexcept:
    (<cpCollisionHandler *>handler).preSolveFunc = before
    (<cpCollisionHandler *>handler).userData = data

# -- spaces -----------------------------------------------------------------------------------

cdef Handle new_space(double slop) noexcept:
    cdef Handle space = engine.cpSpaceNew()
    engine.cpSpaceSetCollisionSlop(space, slop)
    engine.cpSpaceSetCollisionPersistence(space, 1)
    set_handler(engine.cpSpaceAddWildcardHandler(space, SEWN), correct_contact, NULL)
    set_handler(engine.cpSpaceAddWildcardHandler(space, JOINED), straighten_contact, NULL)
    return space

cdef inline void step(Handle space, double h, double bias) noexcept:
    engine.cpSpaceSetCollisionBias(space, bias)
    engine.cpSpaceSetCurrentTimeStep(space, h)
    engine.cpSpaceStep(space, h)

# -- bodies and shapes ------------------------------------------------------------------------

cdef Handle new_body(double mass, double moment, int number) noexcept:
    cdef Handle body = engine.cpBodyNew(mass, moment)
    engine.cpBodySetUserData(body, <void *><intptr_t>number)
    engine.cpBodySetPositionUpdateFunc(body, move)
    return body

cdef Handle new_ground(int number) noexcept:
    cdef Handle body = engine.cpBodyNewStatic()
    engine.cpBodySetUserData(body, <void *><intptr_t>number)
    return body

cdef Handle surfaced(Handle shape, surface) except NULL:
    engine.cpShapeSetFriction(shape, surface[0])
    engine.cpShapeSetElasticity(shape, surface[1])
    return shape

cdef Handle new_disc(Handle body, double radius, double x, double y, surface) except NULL:
    return surfaced(engine.cpCircleShapeNew(body, radius, vector(x, y)), surface)

cdef Handle new_polygon(Handle body, points, surface) except NULL:
    cdef Vector vertices[64]
    cdef int k, count = len(points)
    if count > 64:
        raise ValueError(f"{count} vertices, expected at most 64")
    for k in range(count):
        vertices[k] = vector(points[k][0], points[k][1])
    return surfaced(engine.cpPolyShapeNewRaw(body, count, vertices, 0.0), surface)

cdef Handle new_segment(Handle body, ends, surface) except NULL:
    a, b = ends
    return surfaced(
        engine.cpSegmentShapeNew(body, vector(a[0], a[1]), vector(b[0], b[1]), 0.0), surface)

cdef inline void weight_at(Handle body, double ahead) noexcept:
    engine.cpBodySetCenterOfGravity(body, vector(ahead, 0.0))

cdef void put(Handle body, double x, double y, double angle) noexcept:
    cdef double *n = <double *>body
    cdef double c, s
    c, s = cosine_sine(angle)
    n[CENTER] = (c * n[LEAD] - s * n[LEAD + 1]) + x
    n[CENTER + 1] = (s * n[LEAD] + c * n[LEAD + 1]) + y
    turn_to(n, angle, c, s)

cdef void turn_to(double *n, double angle, double c, double s) noexcept:
    n[ANGLE] = angle
    n[TURN], n[TURN + 1], n[TURN + 2], n[TURN + 3] = c, s, -s, c
    n[TURN + 4] = n[CENTER] - (n[LEAD] * c - n[LEAD + 1] * s)
    n[TURN + 5] = n[CENTER + 1] - (n[LEAD] * s + n[LEAD + 1] * c)

cdef void move(Handle body, double h) noexcept:
    cdef double *n = <double *>body
    cdef double c, s
    cdef int k
    for k in range(2):
        n[CENTER + k] += (n[FAST + k] + n[BIAS + k]) * h
        n[BIAS + k] = 0.0
    cdef double angle = n[ANGLE] + (n[SPIN] + n[SPIN_BIAS]) * h
    n[SPIN_BIAS] = 0.0
    c, s = cosine_sine(angle)
    turn_to(n, angle, c, s)

cdef inline void aim(Handle body, double vx, double vy, double spin) noexcept:
    engine.cpBodySetVelocity(body, vector(vx, vy))
    engine.cpBodySetAngularVelocity(body, spin)
cdef inline void settle_down(Handle body) noexcept:
    cdef double *n = <double *>body
    n[BIAS] = n[BIAS + 1] = n[SPIN_BIAS] = 0.0
cdef inline void push(Handle body, double x, double y, double torque) noexcept:
    engine.cpBodySetForce(body, vector(x, y))
    engine.cpBodySetTorque(body, torque)

# -- joints -----------------------------------------------------------------------------------

cdef Handle new_joint(int kind) noexcept:
    if kind == PIVOT:
        return engine.cpPivotJointAlloc()
    if kind == GEAR:
        return engine.cpGearJointAlloc()
    if kind == SLIDE:
        return engine.cpSlideJointAlloc()
    if kind == PIN:
        return engine.cpPinJointAlloc()
    if kind == DAMPED_SPRING:
        return engine.cpDampedSpringAlloc()
    if kind == ROTARY_LIMIT:
        return engine.cpRotaryLimitJointAlloc()
    if kind == GROOVE:
        return engine.cpGrooveJointAlloc()
    return engine.cpDampedRotarySpringAlloc()

cdef Handle make_joint(
    int kind, Handle joint, Handle a, Handle b, ends, double p, double q, double r
) except NULL:
    cdef Vector on_a = vector(ends[0][0], ends[0][1]), on_b = vector(ends[1][0], ends[1][1])
    if joint == NULL:
        joint = new_joint(kind)
    if kind == PIVOT:
        engine.cpPivotJointInit(joint, a, b, on_a, on_b)
    elif kind == GEAR:
        engine.cpGearJointInit(joint, a, b, p, q)
    elif kind == ROTARY_LIMIT:
        engine.cpRotaryLimitJointInit(joint, a, b, p, q)
    elif kind == GROOVE:
        engine.cpGrooveJointInit(joint, a, b, vector(-p, -q), vector(p, q), on_b)
    elif kind == SLIDE:
        engine.cpSlideJointInit(joint, a, b, on_a, on_b, p, q)
    elif kind == PIN:
        engine.cpPinJointInit(joint, a, b, on_a, on_b)
        engine.cpPinJointSetDist(joint, p)
    elif kind == DAMPED_SPRING:
        engine.cpDampedSpringInit(joint, a, b, on_a, on_b, p, q, r)
        if r > 0.0:
            engine.cpDampedSpringSetSpringForceFunc(joint, pull)
    else:
        engine.cpDampedRotarySpringInit(joint, a, b, p, q, r)
        if r > 0.0:
            engine.cpDampedRotarySpringSetSpringTorqueFunc(joint, twist_back)
    return joint

cdef double pull(Handle spring, double length) noexcept:
    cdef double *n = <double *>spring
    cdef double *arms = n + LOST + 1
    cdef double *normal = n + EFFECTIVE_MASS + 1
    cdef double *a = <double *>engine.cpConstraintGetBodyA(spring)
    cdef double *b = <double *>engine.cpConstraintGetBodyB(spring)
    cdef double x = (b[FAST] - b[SPIN] * arms[3]) - (a[FAST] - a[SPIN] * arms[1])
    cdef double y = (b[FAST + 1] + b[SPIN] * arms[2]) - (a[FAST + 1] + a[SPIN] * arms[0])
    return (n[REST] - length) * damped(spring, REST, LOST, EFFECTIVE_MASS, x * normal[0] + y * normal[1])

cdef double twist_back(Handle spring, double angle) noexcept:
    cdef double *a = <double *>engine.cpConstraintGetBodyA(spring)
    cdef double *b = <double *>engine.cpConstraintGetBodyB(spring)
    cdef double closing = a[SPIN] - b[SPIN]
    cdef double stiffness = damped(spring, REST_ANGLE, LOST_TURNING, EFFECTIVE_MOMENT, closing)
    return (angle - (<double *>spring)[REST_ANGLE]) * stiffness

cdef double damped(Handle spring, int rest, int lost, int effective, double closing) noexcept:
    cdef double *n = <double *>spring
    cdef double h = engine.cpSpaceGetCurrentTimeStep(engine.cpConstraintGetSpace(spring))
    cdef double fades = n[rest + 2] * h / n[effective], theta = implicitness(fades)
    n[lost - 1] = -closing * (1.0 - theta) / theta
    n[lost] = fades * theta / (1.0 + fades * theta)
    return n[rest + 1]

cdef inline void set_joint(Handle joint, double bias, bint collide) noexcept:
    engine.cpConstraintSetErrorBias(joint, bias)
    engine.cpConstraintSetCollideBodies(joint, collide)
cdef inline void set_limits(Handle joint, double least, double largest) noexcept:
    engine.cpRotaryLimitJointSetMin(joint, least)
    engine.cpRotaryLimitJointSetMax(joint, largest)
cdef inline Vector reaction_of(Handle joint, int kind) noexcept:
    cdef double *n = <double *>joint + (GROOVE_IMPULSE if kind == GROOVE else PIVOT_IMPULSE)
    return vector(n[0], n[1])
cdef inline double twist_of(Handle joint) noexcept:
    return (<double *>joint)[GEAR_IMPULSE]

# -- contacts ---------------------------------------------------------------------------------

cdef struct Found:
    Arbiter *arbiters
    int count
    int room
    bint lost

cdef int number_of(Handle body) noexcept:
    return <int><intptr_t>engine.cpBodyGetUserData(body)

cdef void note_arbiter(void *body, Handle arbiter, void *data) noexcept:
    cdef Found *found = <Found *>data
    cdef Handle first = (<Arbiter>arbiter).body_a
    cdef Arbiter *more
    if first != body and number_of(first) >= 0:
        return
    if found.count >= found.room:
        more = <Arbiter *>realloc(found.arbiters, (2 * found.room + 16) * sizeof(Arbiter))
        if more == NULL:
            found.lost = True
            return
        found.arbiters = more
        found.room = 2 * found.room + 16
    found.arbiters[found.count] = <Arbiter>arbiter
    found.count += 1

cdef class Arbiters:
    cdef Found found

    def __dealloc__(self):
        free_memory(self.found.arbiters)

    cdef void clear(self) noexcept:
        self.found.count = 0

    cdef int add_those_of(self, Handle body) except -1:
        engine.cpBodyEachArbiter(body, note_arbiter, &self.found)
        if self.found.lost:
            self.found.lost = False
            raise MemoryError
        return 0

    cdef inline int count(self) noexcept:
        return self.found.count

    cdef inline Arbiter at(self, int k) noexcept:
        return self.found.arbiters[k]

cdef int first_of(Arbiter arbiter) noexcept:
    return number_of(arbiter.body_a)
cdef int second_of(Arbiter arbiter) noexcept:
    return number_of(arbiter.body_b)

cdef inline void scale(Arbiter arbiter, double ratio) noexcept:
    cdef int k
    for k in range(arbiter.count):
        arbiter.contacts[k].jnAcc *= ratio
        arbiter.contacts[k].jtAcc *= ratio

cdef inline void set_surface(Arbiter arbiter, double friction, double restitution) noexcept:
    engine.cpArbiterSetFriction(arbiter, friction)
    engine.cpArbiterSetRestitution(arbiter, restitution)
cdef void settle_contact(Handle touched, Handle space, Handle data) noexcept:
    (<Surfaces>data).settle(<Arbiter>touched)
cdef void watch(Handle space, surfaces) noexcept:
    set_handler(engine.cpSpaceAddGlobalCollisionHandler(space), settle_contact, <void *>surfaces)

cdef inline void put_point(Arbiter arbiter, double ax, double ay, double bx, double by) noexcept:
    cdef double *a = <double *>arbiter.body_a
    cdef double *b = <double *>arbiter.body_b
    cdef cpContact *contact = arbiter.contacts
    arbiter.count = 1
    contact.r1 = vector(ax - a[CENTER], ay - a[CENTER + 1])
    contact.r2 = vector(bx - b[CENTER], by - b[CENTER + 1])
    contact.jnAcc = contact.jtAcc = 0.0

cdef inline Handle shape_of(Arbiter arbiter, bint second) noexcept:
    return arbiter.b if second else arbiter.a

cdef inline Vector point_of(Arbiter arbiter, int k, bint second) noexcept:
    if second:
        return engine.cpArbiterGetPointB(arbiter, k)
    return engine.cpArbiterGetPointA(arbiter, k)

cdef inline double depth_of(Arbiter arbiter, int k) noexcept:
    return -engine.cpArbiterGetDepth(arbiter, k)
cdef inline int check_signals() except -1:
    return PyErr_CheckSignals()

# -- seams ------------------------------------------------------------------------------------

cdef void correct_contact(Handle touched, Handle space, Handle data) noexcept:
    cdef Arbiter arbiter = <Arbiter>touched
    cdef bint first = first_of(arbiter) < 0
    (<Seams>engine.cpShapeGetUserData(shape_of(arbiter, not first))).correct(arbiter, first)

cdef inline void sew(Handle segment, seams) noexcept:
    engine.cpShapeSetUserData(segment, <void *>seams)
    engine.cpShapeSetCollisionType(segment, SEWN)
cdef inline Vector corner_of(Handle shape, int k) noexcept:
    return engine.cpBodyLocalToWorld(
        engine.cpShapeGetBody(shape), engine.cpPolyShapeGetVert(shape, k))

cdef void straighten_contact(Handle touched, Handle space, Handle data) noexcept:
    cdef Arbiter arbiter = <Arbiter>touched
    if first_of(arbiter) >= 0 and second_of(arbiter) >= 0:
        flush_of(arbiter, False).straighten(arbiter)

cdef inline void show(Handle shape, flush) noexcept:
    engine.cpShapeSetUserData(shape, <void *>flush)
cdef inline void join(Handle shape) noexcept:
    engine.cpShapeSetCollisionType(shape, JOINED)
cdef inline Flush flush_of(Arbiter arbiter, bint second):
    return <Flush>engine.cpShapeGetUserData(shape_of(arbiter, second))
cdef inline Vector place_of(Handle shape, double x, double y) noexcept:
    return engine.cpBodyLocalToWorld(engine.cpShapeGetBody(shape), vector(x, y))
