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
        double (*cpSpaceGetCurrentTimeStep)(void *);
        void (*cpConstraintSetMaxForce)(void *, double);
        void (*cpConstraintSetMaxBias)(void *, double);
        void (*cpConstraintSetErrorBias)(void *, double);
        void (*cpConstraintSetCollideBodies)(void *, unsigned char);
        double (*cpConstraintGetImpulse)(void *);
        void (*cpBodyEachArbiter)(void *, void (*)(void *, void *, void *), void *);
        Vector (*cpArbiterTotalImpulse)(void *);
        Vector (*cpArbiterGetNormal)(void *);
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

    /* See Seams in chipmunk.py. Sums and products stand in the same order there. */
    enum { SEWN = 1, FREE = 0, BULGES = 1, MOST_CORNERS = 64 };
    static const double STRAIGHT = 1e-9, NEARLY = 0.999;
    typedef struct { double x, y, ux, uy, far, reach, met[12]; } Seams_;

    static int holds(const double *met, double turn, Vector own, Vector d) {
        int past_own = turn * (own.x * d.y - own.y * d.x) >= 0.0;
        int before_other = turn * (d.x * met[2] - d.y * met[1]) >= 0.0;
        return met[0] == BULGES ? past_own || before_other : past_own && before_other;
    }
    static int corners_of(void *shape, Vector *corners) {
        void *body = engine.cpShapeGetBody(shape);
        int count = engine.cpPolyShapeGetCount(shape);
        for (int k = 0; k < count && k < MOST_CORNERS; k++)
            corners[k] = engine.cpBodyLocalToWorld(body, engine.cpPolyShapeGetVert(shape, k));
        return count < MOST_CORNERS ? count : MOST_CORNERS;
    }
    static void mend_contact(Arbiter_ *arbiter, const Seams_ *s, int is_first) {
        Vector n = arbiter->n, corners[MOST_CORNERS];
        int count = is_first ? corners_of(arbiter->b, corners) : 0;
        if (!is_first) n = vector(-n.x, -n.y);
        double along = n.x * s->ux + n.y * s->uy;
        Vector d = n;
        double low = 1e300, high = -1e300;
        if (count) {
            d = vector(0.0, 0.0);
            Vector last = corners[count - 1];
            double above = (last.y - s->y) * s->ux - (last.x - s->x) * s->uy;
            double at = (last.x - s->x) * s->ux + (last.y - s->y) * s->uy;
            for (int k = 0; k < count; k++) {
                Vector corner = corners[k];
                double before = above, last_at = at;
                d.x += (corner.x - s->x) / count;
                d.y += (corner.y - s->y) / count;
                above = (corner.y - s->y) * s->ux - (corner.x - s->x) * s->uy;
                at = (corner.x - s->x) * s->ux + (corner.y - s->y) * s->uy;
                if ((before < 0.0) != (above < 0.0)) {
                    double crossed = last_at + before / (before - above) * (at - last_at);
                    low = crossed < low ? crossed : low;
                    high = crossed > high ? crossed : high;
                }
            }
        }
        int upright = -STRAIGHT <= along && along <= STRAIGHT;
        int at_start = low < high && high < s->reach;
        int at_end = s->far - s->reach < low && low < high;
        if (at_start && at_end && upright) {
            at_end = d.x * s->ux + d.y * s->uy > s->far / 2;
        } else if (at_start == at_end) {
            if (upright) return;
            at_end = along > 0.0;
        }
        if (count && at_end) d = vector(d.x - s->far * s->ux, d.y - s->far * s->uy);
        const double *met = s->met + (at_end ? 6 : 0);
        if (met[0] == FREE) return;
        Vector own = at_end ? vector(-s->ux, -s->uy) : vector(s->ux, s->uy);
        double turn = at_end ? -1.0 : 1.0;
        int right = !holds(met, turn, own, d);
        if (right && !holds(met + 3, -turn, own, d)) {
            arbiter->count = 0;
            return;
        }
        met += right ? 3 : 0;
        Vector f = right ? vector(s->uy, -s->ux) : vector(-s->uy, s->ux);
        if (upright) {
            if (n.x * f.x + n.y * f.y > 0.0) return;
        } else if (met[0] == BULGES && n.x * met[1] + n.y * met[2] <= STRAIGHT) {
            return;
        } else if (met[0] != BULGES && n.x * f.x + n.y * f.y > NEARLY && count) {
            arbiter->n = f;
            return;
        }
        double least = s->met[right ? 3 : 0] > BULGES ? -s->reach : 0.0;
        double most = s->met[right ? 9 : 6] > BULGES ? s->far + s->reach : s->far;
        double deepest = -1.0;
        Vector p = {0.0, 0.0};
        for (int k = 0; k < count; k++) {
            double at = (corners[k].x - s->x) * s->ux + (corners[k].y - s->y) * s->uy;
            double depth = (s->x - corners[k].x) * f.x + (s->y - corners[k].y) * f.y;
            if (least <= at && at <= most && deepest < depth && depth <= s->reach && depth >= 0.0) {
                deepest = depth;
                p = corners[k];
            }
        }
        if (deepest < 0.0) {
            arbiter->count = 0;
            return;
        }
        Contact_ *contact = arbiter->contacts;
        arbiter->count = 1;
        arbiter->n = f;
        Vector wall = engine.cpBodyGetPosition(arbiter->body_a);
        Vector body = engine.cpBodyGetPosition(arbiter->body_b);
        contact->r1 = vector(p.x + deepest * f.x - wall.x, p.y + deepest * f.y - wall.y);
        contact->r2 = vector(p.x - body.x, p.y - body.y);
        contact->normal_impulse = contact->tangent_impulse = 0.0;
    }
    static void mend(void *arbiter, void *space, void *data) {
        Arbiter_ *itself = arbiter;
        Seams_ *first = engine.cpShapeGetUserData(itself->a);
        mend_contact(itself, first ? first : engine.cpShapeGetUserData(itself->b), first != 0);
    }
    static void mend_in(void *space) {
        Handler_ *handler = engine.cpSpaceAddWildcardHandler(space, SEWN);
        handler->pre_solve = mend;
    }
    static int count_kept(void *arbiter) { return ((Arbiter_ *)arbiter)->count; }

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
    static void *first_body(void *arbiter) { return ((Arbiter_ *)arbiter)->body_a; }
    static void *second_body(void *arbiter) { return ((Arbiter_ *)arbiter)->body_b; }
    /* Springs: the numbers are where springs_are_as_thought in chipmunk.py finds them. */
    enum { REST = 17, REST_ANGLE = 13, LOST = 22, LOST_TURNING = 18, FELT = 27, FELT_TURNING = 19 };
    static double fading(void *spring, int rest, int felt) {
        void *space = engine.cpConstraintGetSpace(spring);
        double *n = spring, h = engine.cpSpaceGetCurrentTimeStep(space);
        return n[rest + 2] * h / n[felt];
    }
    static double pull_of(void *spring, double length, double lost, double surge) {
        double *n = spring;
        n[LOST] = lost;
        return (n[REST] - length) * n[REST + 1] * surge;
    }
    static double twist_to(void *spring, double angle, double lost, double surge) {
        double *n = spring;
        n[LOST_TURNING] = lost;
        return (angle - n[REST_ANGLE]) * n[REST_ANGLE + 1] * surge;
    }
    static Vector drag(void *joint, int at) {
        return vector(((double *)joint)[at], ((double *)joint)[at + 1]);
    }
    static double twist(void *joint) { return ((double *)joint)[18]; }
    static Contact_ *contact_at(void *arbiter, int k) { return ((Arbiter_ *)arbiter)->contacts + k; }
    """
    ctypedef struct Vector:
        double x
        double y
    ctypedef struct Contact_:
        Vector r1
        Vector r2
        double bounce
        double normal_impulse
        double tangent_impulse
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
        double (*cpSpaceGetCurrentTimeStep)(void *) noexcept
        void (*cpConstraintSetMaxForce)(void *, double) noexcept
        void (*cpConstraintSetMaxBias)(void *, double) noexcept
        void (*cpConstraintSetErrorBias)(void *, double) noexcept
        void (*cpConstraintSetCollideBodies)(void *, unsigned char) noexcept
        double (*cpConstraintGetImpulse)(void *) noexcept
        void (*cpBodyEachArbiter)(
            void *, void (*)(void *, void *, void *) noexcept, void *) noexcept
        Vector (*cpArbiterTotalImpulse)(void *) noexcept
        Vector (*cpArbiterGetNormal)(void *) noexcept
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
    ctypedef struct Seams_:
        pass
    Engine_ engine
    void connect_function(int, uintptr_t) noexcept
    size_t count_functions() noexcept
    Vector vector(double, double) noexcept
    void scale_contacts(void *, double) noexcept
    void set_handler(void *, void (*)(void *, void *, void *) noexcept, void *) noexcept
    Contact_ *contact_at(void *, int) noexcept
    void turn_to(void *, double, double, double) noexcept
    void put_at(void *, double, double, double, double, double) noexcept
    double move_by(void *, double) noexcept
    void forget_mending(void *) noexcept
    void *first_body(void *) noexcept
    void *second_body(void *) noexcept
    enum: REST, REST_ANGLE, FELT, FELT_TURNING
    double fading(void *, int, int) noexcept
    double pull_of(void *, double, double, double) noexcept
    double twist_to(void *, double, double, double) noexcept
    Vector drag(void *, int) noexcept
    double twist(void *) noexcept
    void mend_in(void *) noexcept
    int count_kept(void *) noexcept


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
    mend_in(space)
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
    return pull_of(spring, length, 1.0 - exponential(-fades), surge(fades))

cdef double twist_back(void *spring, double angle) noexcept:
    cdef double fades = fading(spring, REST_ANGLE, FELT_TURNING)
    return twist_to(spring, angle, 1.0 - exponential(-fades), surge(fades))

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
    cdef Handle first = first_body(arbiter)
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
    return number_of(first_body(arbiter))

cdef int second_of(Handle arbiter) noexcept:
    return number_of(second_body(arbiter))

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
    return engine.cpArbiterGetNormal(arbiter)

cdef inline Vector point_of(Handle arbiter, int k, bint second) noexcept:
    if second:
        return engine.cpArbiterGetPointB(arbiter, k)
    return engine.cpArbiterGetPointA(arbiter, k)

cdef inline Vector arm_of(Handle arbiter, int k, bint second) noexcept:
    return contact_at(arbiter, k).r2 if second else contact_at(arbiter, k).r1

cdef inline double push_of(Handle arbiter, int k) noexcept:
    return contact_at(arbiter, k).normal_impulse

cdef inline double depth_of(Handle arbiter, int k) noexcept:
    return -engine.cpArbiterGetDepth(arbiter, k)

cdef inline double rub_of(Handle arbiter, int k) noexcept:
    return contact_at(arbiter, k).tangent_impulse

cdef inline double bounce_of(Handle arbiter, int k) noexcept:
    return contact_at(arbiter, k).bounce

cdef inline bint is_void(Handle arbiter) noexcept:
    return count_kept(arbiter) == 0

cdef inline int check_signals() except -1:
    return PyErr_CheckSignals()

# -- seams ------------------------------------------------------------------------------------

cdef class Seams:
    cdef Seams_ numbers

    def __init__(self, numbers):
        cdef double *to = <double *>&self.numbers
        if len(numbers) != 18:
            raise ValueError(f"{len(numbers)} numbers, expected 18")
        for k, number in enumerate(numbers):
            to[k] = number

cdef inline void sew(Handle segment, Seams seams) noexcept:
    engine.cpShapeSetUserData(segment, &seams.numbers)
    engine.cpShapeSetCollisionType(segment, 1)
