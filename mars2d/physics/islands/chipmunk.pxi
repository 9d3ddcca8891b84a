# chipmunk.py in C: the engine's functions by their addresses, which `connect` takes.

from cpython.exc cimport PyErr_CheckSignals
from libc.stdint cimport intptr_t, uintptr_t
from libc.stdlib cimport free as free_memory, realloc

cdef extern from *:
    """
    typedef struct { double x, y; } Vector;
    typedef void *Handle;

    static struct {
        void *(*cpSpaceNew)(void);
        void (*cpSpaceFree)(void *);
        void (*cpSpaceStep)(void *, double);
        void (*cpSpaceSetCurrentTimeStep)(void *, double);
        void (*cpSpaceSetIterations)(void *, int);
        void (*cpSpaceSetCollisionSlop)(void *, double);
        void (*cpSpaceSetCollisionBias)(void *, double);
        void (*cpSpaceSetCollisionPersistence)(void *, unsigned int);
        void *(*cpSpaceGetStaticBody)(void *);
        void *(*cpBodyNew)(double, double);
        void *(*cpBodyNewKinematic)(void);
        void *(*cpBodyNewStatic)(void);
        void (*cpBodyFree)(void *);
        void (*cpBodySetUserData)(void *, void *);
        void *(*cpBodyGetUserData)(void *);
        void *(*cpCircleShapeNew)(void *, double, Vector);
        void *(*cpSegmentShapeNew)(void *, Vector, Vector, double);
        void *(*cpPolyShapeNewRaw)(void *, int, Vector *, double);
        void (*cpShapeSetFriction)(void *, double);
        void (*cpShapeSetElasticity)(void *, double);
        void (*cpShapeFree)(void *);
        void *(*cpSpaceAddBody)(void *, void *);
        void (*cpSpaceRemoveBody)(void *, void *);
        void *(*cpSpaceAddShape)(void *, void *);
        void (*cpSpaceRemoveShape)(void *, void *);
        void *(*cpSpaceAddConstraint)(void *, void *);
        void (*cpSpaceRemoveConstraint)(void *, void *);
        void (*cpConstraintFree)(void *);
        void (*cpBodySetCenterOfGravity)(void *, Vector);
        void (*cpBodySetPositionUpdateFunc)(void *, void (*)(void *, double));
        void (*cpBodySetVelocity)(void *, Vector);
        void (*cpBodySetAngularVelocity)(void *, double);
        Vector (*cpBodyGetPosition)(void *);
        double (*cpBodyGetAngle)(void *);
        Vector (*cpBodyGetVelocity)(void *);
        double (*cpBodyGetAngularVelocity)(void *);
        void (*cpBodySetForce)(void *, Vector);
        void (*cpBodySetTorque)(void *, double);
        void *(*cpPivotJointAlloc)(void);
        void *(*cpPivotJointInit)(void *, void *, void *, Vector, Vector);
        void *(*cpGrooveJointAlloc)(void);
        void *(*cpGrooveJointInit)(void *, void *, void *, Vector, Vector, Vector);
        void *(*cpGearJointAlloc)(void);
        void *(*cpGearJointInit)(void *, void *, void *, double, double);
        void *(*cpSlideJointAlloc)(void);
        void *(*cpSlideJointInit)(void *, void *, void *, Vector, Vector, double, double);
        void *(*cpPinJointAlloc)(void);
        void *(*cpPinJointInit)(void *, void *, void *, Vector, Vector);
        void (*cpPinJointSetDist)(void *, double);
        void (*cpRotaryLimitJointSetMin)(void *, double);
        void (*cpRotaryLimitJointSetMax)(void *, double);
        void *(*cpDampedSpringAlloc)(void);
        void *(*cpDampedSpringInit)(void *, void *, void *, Vector, Vector, double, double, double);
        void *(*cpRotaryLimitJointAlloc)(void);
        void *(*cpRotaryLimitJointInit)(void *, void *, void *, double, double);
        void *(*cpDampedRotarySpringAlloc)(void);
        void *(*cpDampedRotarySpringInit)(void *, void *, void *, double, double, double);
        void (*cpDampedSpringSetSpringForceFunc)(void *, double (*)(void *, double));
        void (*cpDampedRotarySpringSetSpringTorqueFunc)(void *, double (*)(void *, double));
        void *(*cpConstraintGetSpace)(void *);
        void *(*cpConstraintGetBodyA)(void *);
        void *(*cpConstraintGetBodyB)(void *);
        double (*cpSpaceGetCurrentTimeStep)(void *);
        void (*cpConstraintSetMaxForce)(void *, double);
        void (*cpConstraintSetMaxBias)(void *, double);
        void (*cpConstraintSetErrorBias)(void *, double);
        void (*cpConstraintSetCollideBodies)(void *, unsigned char);
        double (*cpConstraintGetImpulse)(void *);
        void (*cpBodyEachArbiter)(void *, void (*)(void *, void *, void *), void *);
        Vector (*cpArbiterTotalImpulse)(void *);
        int (*cpArbiterGetCount)(void *);
        double (*cpArbiterGetDepth)(void *, int);
        Vector (*cpArbiterGetPointA)(void *, int);
        Vector (*cpArbiterGetPointB)(void *, int);
        void (*cpArbiterSetFriction)(void *, double);
        void (*cpArbiterSetRestitution)(void *, double);
        void *(*cpSpaceAddGlobalCollisionHandler)(void *);
        void *(*cpSpaceAddWildcardHandler)(void *, uintptr_t);
        void (*cpShapeSetCollisionType)(void *, uintptr_t);
        void (*cpShapeSetUserData)(void *, void *);
        void *(*cpShapeGetUserData)(void *);
        void *(*cpShapeGetBody)(void *);
        int (*cpPolyShapeGetCount)(void *);
        Vector (*cpPolyShapeGetVert)(void *, int);
        Vector (*cpBodyLocalToWorld)(void *, Vector);
    } engine;

    static Vector vector(double x, double y) { Vector v = {x, y}; return v; }

    /* The first fields of the engine's structs, as far as they are used. */
    typedef struct {
        Vector r1, r2;
        double normal_mass, tangent_mass, bounce, normal_impulse, tangent_impulse, bias_impulse, bias;
        uintptr_t hash;
    } Contact_;
    typedef struct {
        double e, u;
        Vector surface_velocity;
        void *data, *a, *b, *body_a, *body_b, *thread_a[2], *thread_b[2];
        int count;
        Contact_ *contacts;
        Vector n;
    } Arbiter_;
    typedef void (*Before_)(void *, void *, void *);
    typedef struct {
        uintptr_t type_a, type_b;
        void *begin;
        Before_ pre_solve;
        void *post_solve, *separate, *data;
    } Handler_;

    enum { SEWN = 1, JOINED = 2 };  /* the engine's collision types: see chipmunk.py */
    static void connect_function(int k, uintptr_t address) {
        ((void (**)(void))&engine)[k] = (void (*)(void))address;
    }
    static size_t count_functions(void) { return sizeof engine / sizeof(void (*)(void)); }
    static void scale_contacts(void *arbiter, double ratio) {
        Arbiter_ *itself = arbiter;
        for (int k = 0; k < itself->count; k++) {
            itself->contacts[k].normal_impulse *= ratio;
            itself->contacts[k].tangent_impulse *= ratio;
        }
    }
    static void set_handler(void *handler, Before_ before, void *data) {
        ((Handler_ *)handler)->pre_solve = before;
        ((Handler_ *)handler)->data = data;
    }
    /* Bodies: the numbers are where bodies_are_as_thought in chipmunk.py finds them. */
    enum { LEAD = 6, CENTER = 8, FAST = 10, ANGLE = 14, SPIN = 15, TURN = 17, MENDED = 24,
           TURNED = 26 };
    static void turn_to(void *body, double angle, double c, double s) {
        double *n = body;
        n[ANGLE] = angle;
        n[TURN] = c; n[TURN + 1] = s; n[TURN + 2] = -s; n[TURN + 3] = c;
        n[TURN + 4] = n[CENTER] - (n[LEAD] * c - n[LEAD + 1] * s);
        n[TURN + 5] = n[CENTER + 1] - (n[LEAD] * s + n[LEAD + 1] * c);
    }
    static void put_at(void *body, double x, double y, double angle, double c, double s) {
        double *n = body;
        n[CENTER] = (c * n[LEAD] - s * n[LEAD + 1]) + x;
        n[CENTER + 1] = (s * n[LEAD] + c * n[LEAD + 1]) + y;
        turn_to(body, angle, c, s);
    }
    static void forget_mending(void *body) {
        double *n = body;
        n[MENDED] = n[MENDED + 1] = n[TURNED] = 0.0;
    }
    static double move_by(void *body, double h) {
        double *n = body;
        for (int k = 0; k < 2; k++) {
            n[CENTER + k] += (n[FAST + k] + n[MENDED + k]) * h;
            n[MENDED + k] = 0.0;
        }
        double angle = n[ANGLE] + (n[SPIN] + n[TURNED]) * h;
        n[TURNED] = 0.0;
        return angle;
    }
    /* Springs: the numbers are where springs_are_as_thought in chipmunk.py finds them. */
    enum { REST = 17, REST_ANGLE = 13, LOST = 22, LOST_TURNING = 18, FELT = 27, FELT_TURNING = 19 };
    static double fading(void *spring, int rest, int felt) {
        void *space = engine.cpConstraintGetSpace(spring);
        double *n = spring, h = engine.cpSpaceGetCurrentTimeStep(space);
        return n[rest + 2] * h / n[felt];
    }
    static void damp(double *n, int lost, double fades, double theta, double closing) {
        n[lost - 1] = -closing * (1.0 - theta) / theta;
        n[lost] = fades * theta / (1.0 + fades * theta);
    }
    static double pull_of(void *spring, double length, double fades, double theta) {
        double *n = spring, *r = n + LOST + 1, *u = n + FELT + 1;
        double *a = engine.cpConstraintGetBodyA(spring), *b = engine.cpConstraintGetBodyB(spring);
        double x = (b[FAST] - b[SPIN] * r[3]) - (a[FAST] - a[SPIN] * r[1]);
        double y = (b[FAST + 1] + b[SPIN] * r[2]) - (a[FAST + 1] + a[SPIN] * r[0]);
        damp(n, LOST, fades, theta, x * u[0] + y * u[1]);
        return (n[REST] - length) * n[REST + 1];
    }
    static double twist_to(void *spring, double angle, double fades, double theta) {
        double *n = spring;
        double *a = engine.cpConstraintGetBodyA(spring), *b = engine.cpConstraintGetBodyB(spring);
        damp(n, LOST_TURNING, fades, theta, a[SPIN] - b[SPIN]);
        return (angle - n[REST_ANGLE]) * n[REST_ANGLE + 1];
    }
    static Vector drag(void *joint, int at) {
        return vector(((double *)joint)[at], ((double *)joint)[at + 1]);
    }
    static double twist(void *joint) { return ((double *)joint)[18]; }
    """
    ctypedef struct Vector:
        double x
        double y
    ctypedef struct Contact_:
        Vector r1
        Vector r2
        double normal_mass
        double tangent_mass
        double bounce
        double normal_impulse
        double tangent_impulse
        double bias
    ctypedef void *Handle
    ctypedef struct Engine_:
        void *(*cpSpaceNew)() noexcept
        void (*cpSpaceFree)(void *) noexcept
        void (*cpSpaceStep)(void *, double) noexcept
        void (*cpSpaceSetCurrentTimeStep)(void *, double) noexcept
        void (*cpSpaceSetIterations)(void *, int) noexcept
        void (*cpSpaceSetCollisionSlop)(void *, double) noexcept
        void (*cpSpaceSetCollisionBias)(void *, double) noexcept
        void (*cpSpaceSetCollisionPersistence)(void *, unsigned int) noexcept
        void *(*cpSpaceGetStaticBody)(void *) noexcept
        void *(*cpBodyNew)(double, double) noexcept
        void *(*cpBodyNewKinematic)() noexcept
        void *(*cpBodyNewStatic)() noexcept
        void (*cpBodyFree)(void *) noexcept
        void (*cpBodySetUserData)(void *, void *) noexcept
        void *(*cpBodyGetUserData)(void *) noexcept
        void *(*cpCircleShapeNew)(void *, double, Vector) noexcept
        void *(*cpSegmentShapeNew)(void *, Vector, Vector, double) noexcept
        void *(*cpPolyShapeNewRaw)(void *, int, Vector *, double) noexcept
        void (*cpShapeSetFriction)(void *, double) noexcept
        void (*cpShapeSetElasticity)(void *, double) noexcept
        void (*cpShapeFree)(void *) noexcept
        void *(*cpSpaceAddBody)(void *, void *) noexcept
        void (*cpSpaceRemoveBody)(void *, void *) noexcept
        void *(*cpSpaceAddShape)(void *, void *) noexcept
        void (*cpSpaceRemoveShape)(void *, void *) noexcept
        void *(*cpSpaceAddConstraint)(void *, void *) noexcept
        void (*cpSpaceRemoveConstraint)(void *, void *) noexcept
        void (*cpConstraintFree)(void *) noexcept
        void (*cpBodySetCenterOfGravity)(void *, Vector) noexcept
        void (*cpBodySetPositionUpdateFunc)(
            void *, void (*)(void *, double) noexcept) noexcept
        void (*cpBodySetVelocity)(void *, Vector) noexcept
        void (*cpBodySetAngularVelocity)(void *, double) noexcept
        Vector (*cpBodyGetPosition)(void *) noexcept
        double (*cpBodyGetAngle)(void *) noexcept
        Vector (*cpBodyGetVelocity)(void *) noexcept
        double (*cpBodyGetAngularVelocity)(void *) noexcept
        void (*cpBodySetForce)(void *, Vector) noexcept
        void (*cpBodySetTorque)(void *, double) noexcept
        void *(*cpPivotJointAlloc)() noexcept
        void *(*cpPivotJointInit)(void *, void *, void *, Vector, Vector) noexcept
        void *(*cpGrooveJointAlloc)() noexcept
        void *(*cpGrooveJointInit)(void *, void *, void *, Vector, Vector, Vector) noexcept
        void *(*cpGearJointAlloc)() noexcept
        void *(*cpGearJointInit)(void *, void *, void *, double, double) noexcept
        void *(*cpSlideJointAlloc)() noexcept
        void *(*cpSlideJointInit)(void *, void *, void *, Vector, Vector, double, double) noexcept
        void *(*cpPinJointAlloc)() noexcept
        void *(*cpPinJointInit)(void *, void *, void *, Vector, Vector) noexcept
        void (*cpPinJointSetDist)(void *, double) noexcept
        void (*cpRotaryLimitJointSetMin)(void *, double) noexcept
        void (*cpRotaryLimitJointSetMax)(void *, double) noexcept
        void *(*cpDampedSpringAlloc)() noexcept
        void *(*cpDampedSpringInit)(
            void *, void *, void *, Vector, Vector, double, double, double) noexcept
        void *(*cpRotaryLimitJointAlloc)() noexcept
        void *(*cpRotaryLimitJointInit)(void *, void *, void *, double, double) noexcept
        void *(*cpDampedRotarySpringAlloc)() noexcept
        void *(*cpDampedRotarySpringInit)(void *, void *, void *, double, double, double) noexcept
        void (*cpDampedSpringSetSpringForceFunc)(
            void *, double (*)(void *, double) noexcept) noexcept
        void (*cpDampedRotarySpringSetSpringTorqueFunc)(
            void *, double (*)(void *, double) noexcept) noexcept
        void *(*cpConstraintGetSpace)(void *) noexcept
        void *(*cpConstraintGetBodyA)(void *) noexcept
        void *(*cpConstraintGetBodyB)(void *) noexcept
        double (*cpSpaceGetCurrentTimeStep)(void *) noexcept
        void (*cpConstraintSetMaxForce)(void *, double) noexcept
        void (*cpConstraintSetMaxBias)(void *, double) noexcept
        void (*cpConstraintSetErrorBias)(void *, double) noexcept
        void (*cpConstraintSetCollideBodies)(void *, unsigned char) noexcept
        double (*cpConstraintGetImpulse)(void *) noexcept
        void (*cpBodyEachArbiter)(
            void *, void (*)(void *, void *, void *) noexcept, void *) noexcept
        Vector (*cpArbiterTotalImpulse)(void *) noexcept
        int (*cpArbiterGetCount)(void *) noexcept
        double (*cpArbiterGetDepth)(void *, int) noexcept
        Vector (*cpArbiterGetPointA)(void *, int) noexcept
        Vector (*cpArbiterGetPointB)(void *, int) noexcept
        void (*cpArbiterSetFriction)(void *, double) noexcept
        void (*cpArbiterSetRestitution)(void *, double) noexcept
        void *(*cpSpaceAddGlobalCollisionHandler)(void *) noexcept
        void *(*cpSpaceAddWildcardHandler)(void *, uintptr_t) noexcept
        void (*cpShapeSetCollisionType)(void *, uintptr_t) noexcept
        void (*cpShapeSetUserData)(void *, void *) noexcept
        void *(*cpShapeGetUserData)(void *) noexcept
        void *(*cpShapeGetBody)(void *) noexcept
        int (*cpPolyShapeGetCount)(void *) noexcept
        Vector (*cpPolyShapeGetVert)(void *, int) noexcept
        Vector (*cpBodyLocalToWorld)(void *, Vector) noexcept
    ctypedef struct Arbiter_:
        double e
        void *a
        void *b
        void *body_a
        void *body_b
        int count
        Contact_ *contacts
        Vector n
    Engine_ engine
    void connect_function(int, uintptr_t) noexcept
    size_t count_functions() noexcept
    Vector vector(double, double) noexcept
    void scale_contacts(void *, double) noexcept
    void set_handler(void *, void (*)(void *, void *, void *) noexcept, void *) noexcept
    void turn_to(void *, double, double, double) noexcept
    void put_at(void *, double, double, double, double, double) noexcept
    double move_by(void *, double) noexcept
    void forget_mending(void *) noexcept
    enum: REST, REST_ANGLE, FELT, FELT_TURNING, CENTER, SEWN, JOINED
    double fading(void *, int, int) noexcept
    double pull_of(void *, double, double, double) noexcept
    double twist_to(void *, double, double, double) noexcept
    Vector drag(void *, int) noexcept
    double twist(void *) noexcept


def connect(addresses):
    """Take the addresses of the engine's functions, in the order in which they stand above."""
    if len(addresses) != count_functions():
        raise ValueError(f"{len(addresses)} functions, expected {count_functions()}")
    for k, address in enumerate(addresses):
        connect_function(k, address)


cdef Handle NOTHING = NULL
cdef enum:
    PIVOT, GEAR, SLIDE, PIN, DAMPED_SPRING, ROTARY_LIMIT, ROTARY_SPRING, GROOVE

# -- spaces -----------------------------------------------------------------------------------

cdef Handle new_space(double slop) except NULL:
    cdef Handle space = engine.cpSpaceNew()
    if space == NULL:
        raise MemoryError
    engine.cpSpaceSetCollisionSlop(space, slop)
    engine.cpSpaceSetCollisionPersistence(space, 1)
    set_handler(engine.cpSpaceAddWildcardHandler(space, SEWN), mend_contact, NULL)
    set_handler(engine.cpSpaceAddWildcardHandler(space, JOINED), straighten_contact, NULL)
    return space

cdef inline void set_iterations(Handle space, int count) noexcept:
    engine.cpSpaceSetIterations(space, count)

cdef inline Handle ground_of(Handle space) noexcept:
    return engine.cpSpaceGetStaticBody(space)

cdef inline void step(Handle space, double h, double bias) noexcept:
    engine.cpSpaceSetCollisionBias(space, bias)
    engine.cpSpaceSetCurrentTimeStep(space, h)
    engine.cpSpaceStep(space, h)

cdef inline void free_space(Handle space) noexcept:
    engine.cpSpaceFree(space)

# -- bodies and shapes ------------------------------------------------------------------------

cdef Handle new_body(double mass, double moment, int number) except NULL:
    cdef Handle body = engine.cpBodyNew(mass, moment)
    if body == NULL:
        raise MemoryError
    engine.cpBodySetUserData(body, <void *><intptr_t>number)
    engine.cpBodySetPositionUpdateFunc(body, move)
    return body

cdef Handle new_ground(int number) except NULL:
    cdef Handle body = engine.cpBodyNewStatic()
    if body == NULL:
        raise MemoryError
    engine.cpBodySetUserData(body, <void *><intptr_t>number)
    return body

cdef Handle new_control() except NULL:
    cdef Handle body = engine.cpBodyNewKinematic()
    if body == NULL:
        raise MemoryError
    return body

cdef Handle surfaced(Handle shape, surface) except NULL:
    if shape == NULL:
        raise MemoryError
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

cdef inline void add_body(Handle space, Handle body) noexcept:
    engine.cpSpaceAddBody(space, body)

cdef inline void remove_body(Handle space, Handle body) noexcept:
    engine.cpSpaceRemoveBody(space, body)

cdef inline void free_body(Handle body) noexcept:
    engine.cpBodyFree(body)

cdef inline void add_shape(Handle space, Handle shape) noexcept:
    engine.cpSpaceAddShape(space, shape)

cdef inline void remove_shape(Handle space, Handle shape) noexcept:
    engine.cpSpaceRemoveShape(space, shape)

cdef inline void free_shape(Handle shape) noexcept:
    engine.cpShapeFree(shape)

cdef inline void weight_at(Handle body, double ahead) noexcept:
    engine.cpBodySetCenterOfGravity(body, vector(ahead, 0.0))

cdef inline void put(Handle body, double x, double y, double angle) noexcept:
    cdef double c, s
    c, s = cosine_sine(angle)
    put_at(body, x, y, angle, c, s)

cdef void move(void *body, double h) noexcept:
    cdef double c, s, angle = move_by(body, h)
    c, s = cosine_sine(angle)
    turn_to(body, angle, c, s)

cdef inline void aim(Handle body, double vx, double vy, double spin) noexcept:
    engine.cpBodySetVelocity(body, vector(vx, vy))
    engine.cpBodySetAngularVelocity(body, spin)

cdef inline void settle_down(Handle body) noexcept:
    forget_mending(body)

cdef inline void push(Handle body, double x, double y, double torque) noexcept:
    engine.cpBodySetForce(body, vector(x, y))
    engine.cpBodySetTorque(body, torque)

cdef inline Vector position_of(Handle body) noexcept:
    return engine.cpBodyGetPosition(body)

cdef inline Vector velocity_of(Handle body) noexcept:
    return engine.cpBodyGetVelocity(body)

cdef inline double angle_of(Handle body) noexcept:
    return engine.cpBodyGetAngle(body)

cdef inline double spin_of(Handle body) noexcept:
    return engine.cpBodyGetAngularVelocity(body)

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
    if joint == NULL:
        raise MemoryError
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

cdef double pull(void *spring, double length) noexcept:
    cdef double fades = fading(spring, REST, FELT)
    return pull_of(spring, length, fades, implicitness(fades))

cdef double twist_back(void *spring, double angle) noexcept:
    cdef double fades = fading(spring, REST_ANGLE, FELT_TURNING)
    return twist_to(spring, angle, fades, implicitness(fades))

cdef inline void set_joint(Handle joint, double bias, bint collide) noexcept:
    engine.cpConstraintSetErrorBias(joint, bias)
    engine.cpConstraintSetCollideBodies(joint, collide)

cdef inline void set_max_force(Handle joint, double force) noexcept:
    engine.cpConstraintSetMaxForce(joint, force)

cdef inline void set_limits(Handle joint, double least, double largest) noexcept:
    engine.cpRotaryLimitJointSetMin(joint, least)
    engine.cpRotaryLimitJointSetMax(joint, largest)

cdef inline void set_max_bias(Handle joint, double bias) noexcept:
    engine.cpConstraintSetMaxBias(joint, bias)

cdef inline void add_joint(Handle space, Handle joint) noexcept:
    engine.cpSpaceAddConstraint(space, joint)

cdef inline void remove_joint(Handle space, Handle joint) noexcept:
    engine.cpSpaceRemoveConstraint(space, joint)

cdef inline void free_joint(Handle joint) noexcept:
    engine.cpConstraintFree(joint)

cdef inline Vector drag_of(Handle joint, int kind) noexcept:
    return drag(joint, 32 if kind == GROOVE else 25)

cdef inline double twist_of(Handle joint) noexcept:
    return twist(joint)

cdef inline double used_of(Handle joint) noexcept:
    return engine.cpConstraintGetImpulse(joint)

# -- contacts ---------------------------------------------------------------------------------

cdef struct Found:
    Handle *arbiters
    int count
    int room
    bint lost

cdef int number_of(Handle body) noexcept:
    return <int><intptr_t>engine.cpBodyGetUserData(body)

cdef void note_arbiter(void *body, void *arbiter, void *data) noexcept:
    cdef Found *found = <Found *>data
    cdef Handle first = (<Arbiter_ *>arbiter).body_a
    cdef Handle *more
    if first != body and number_of(first) >= 0:
        return
    if found.count >= found.room:
        more = <Handle *>realloc(found.arbiters, (2 * found.room + 16) * sizeof(Handle))
        if more == NULL:
            found.lost = True
            return
        found.arbiters = more
        found.room = 2 * found.room + 16
    found.arbiters[found.count] = arbiter
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

    cdef inline Handle at(self, int k) noexcept:
        return self.found.arbiters[k]

cdef int first_of(Handle arbiter) noexcept:
    return number_of((<Arbiter_ *>arbiter).body_a)

cdef int second_of(Handle arbiter) noexcept:
    return number_of((<Arbiter_ *>arbiter).body_b)

cdef inline void scale(Handle arbiter, double ratio) noexcept:
    scale_contacts(arbiter, ratio)

cdef inline void set_surface(Handle arbiter, double friction, double restitution) noexcept:
    engine.cpArbiterSetFriction(arbiter, friction)
    engine.cpArbiterSetRestitution(arbiter, restitution)

cdef void settle_contact(void *arbiter, void *space, void *data) noexcept:
    (<Surfaces>data).settle(arbiter)

cdef void watch(Handle space, surfaces) noexcept:
    set_handler(engine.cpSpaceAddGlobalCollisionHandler(space), settle_contact, <void *>surfaces)

cdef inline int count_of(Handle arbiter) noexcept:
    return engine.cpArbiterGetCount(arbiter)

cdef inline Vector impulse_of(Handle arbiter) noexcept:
    return engine.cpArbiterTotalImpulse(arbiter)

cdef inline Vector normal_of(Handle arbiter) noexcept:
    return (<Arbiter_ *>arbiter).n

cdef inline void set_normal(Handle arbiter, double x, double y) noexcept:
    (<Arbiter_ *>arbiter).n = vector(x, y)

cdef inline void put_point(Handle arbiter, double ax, double ay, double bx, double by) noexcept:
    cdef double *a = <double *>(<Arbiter_ *>arbiter).body_a
    cdef double *b = <double *>(<Arbiter_ *>arbiter).body_b
    cdef Contact_ *contact = (<Arbiter_ *>arbiter).contacts
    (<Arbiter_ *>arbiter).count = 1
    contact.r1 = vector(ax - a[CENTER], ay - a[CENTER + 1])
    contact.r2 = vector(bx - b[CENTER], by - b[CENTER + 1])
    contact.normal_impulse = contact.tangent_impulse = 0.0

cdef inline void leave_out(Handle arbiter) noexcept:
    (<Arbiter_ *>arbiter).count = 0

cdef inline Handle shape_of(Handle arbiter, bint second) noexcept:
    return (<Arbiter_ *>arbiter).b if second else (<Arbiter_ *>arbiter).a

cdef inline Vector point_of(Handle arbiter, int k, bint second) noexcept:
    if second:
        return engine.cpArbiterGetPointB(arbiter, k)
    return engine.cpArbiterGetPointA(arbiter, k)

cdef inline Vector arm_of(Handle arbiter, int k, bint second) noexcept:
    return (<Arbiter_ *>arbiter).contacts[k].r2 if second else (<Arbiter_ *>arbiter).contacts[k].r1

cdef inline double push_of(Handle arbiter, int k) noexcept:
    return (<Arbiter_ *>arbiter).contacts[k].normal_impulse

cdef inline double depth_of(Handle arbiter, int k) noexcept:
    return -engine.cpArbiterGetDepth(arbiter, k)

cdef inline double rub_of(Handle arbiter, int k) noexcept:
    return (<Arbiter_ *>arbiter).contacts[k].tangent_impulse

cdef inline double bounce_of(Handle arbiter, int k) noexcept:
    return (<Arbiter_ *>arbiter).contacts[k].bounce

cdef inline bint is_void(Handle arbiter) noexcept:
    return (<Arbiter_ *>arbiter).count == 0

cdef inline int check_signals() except -1:
    return PyErr_CheckSignals()

# -- seams ------------------------------------------------------------------------------------

cdef void mend_contact(void *arbiter, void *space, void *data) noexcept:
    cdef bint first = first_of(arbiter) < 0
    (<Seams>engine.cpShapeGetUserData(shape_of(arbiter, not first))).mend(arbiter, first)

cdef inline void sew(Handle segment, seams) noexcept:
    engine.cpShapeSetUserData(segment, <void *>seams)
    engine.cpShapeSetCollisionType(segment, SEWN)

cdef inline int corners_of(Handle shape) noexcept:
    return engine.cpPolyShapeGetCount(shape)

cdef inline Vector corner_of(Handle shape, int k) noexcept:
    return engine.cpBodyLocalToWorld(
        engine.cpShapeGetBody(shape), engine.cpPolyShapeGetVert(shape, k))

cdef void straighten_contact(void *arbiter, void *space, void *data) noexcept:
    if first_of(arbiter) >= 0 and second_of(arbiter) >= 0:
        flush_of(arbiter, False).straighten(arbiter)

cdef inline void show(Handle shape, flush) noexcept:
    engine.cpShapeSetUserData(shape, <void *>flush)

cdef inline void join(Handle shape) noexcept:
    engine.cpShapeSetCollisionType(shape, JOINED)

cdef inline Flush flush_of(Handle arbiter, bint second):
    return <Flush>engine.cpShapeGetUserData(shape_of(arbiter, second))

cdef inline Vector place_of(Handle shape, double x, double y) noexcept:
    return engine.cpBodyLocalToWorld(engine.cpShapeGetBody(shape), vector(x, y))
