# library.py in C: the engine's functions by their addresses, which `connect` takes.

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
ctypedef void (*Before)(Arbiter, Handle, Handle) noexcept

cdef struct cpCollisionHandler:
    uintptr_t typeA, typeB
    Handle beginFunc
    Before preSolveFunc
    Handle postSolveFunc, separateFunc, userData

cdef enum:  # where the engine has its numbers, and its collision types: see library.py
    LEAD = 6, CENTER = 8, FAST = 10, ANGLE = 14, SPIN = 15, TURN = 17, BIAS = 24, SPIN_BIAS = 26
    REST = 17, REST_ANGLE = 13, LOST = 22, LOST_TURNING = 18, EFFECTIVE_MASS = 27, EFFECTIVE_MOMENT = 19
    PIVOT_IMPULSE = 25, GEAR_IMPULSE = 18, GROOVE_IMPULSE = 32
    SHAPES = 16, SEWN = 1, JOINED = 2

cdef enum:
    PIVOT, GROOVE, GEAR, SLIDE, PIN, DAMPED_SPRING, ROTARY_LIMIT, ROTARY_SPRING


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

cdef Vector corners[64]

cdef Vector *vertices(points) except NULL:
    cdef int k, count = len(points)
    if count > 64:
        raise ValueError(f"{count} vertices, expected at most 64")
    for k in range(count):
        corners[k] = vector(points[k][0], points[k][1])
    return corners

cdef inline double *doubles(Handle thing) noexcept:
    return <double *>thing
cdef inline void number_shapes_again(Handle space) noexcept:
    (<uintptr_t *>space)[SHAPES] = 0
cdef inline Handle numbered(int number) noexcept:
    return <void *><intptr_t>number
cdef inline int number_of(Handle body) noexcept:
    return <int><intptr_t>engine.cpBodyGetUserData(body)
cdef inline Handle address_of(thing) noexcept:
    return <void *>thing
cdef inline object thing_at(Handle address):
    return <object>address
cdef Handle owned(int kind, Handle joint) noexcept:
    return (&engine.cpPivotJointAlloc)[kind]() if joint == NULL else joint
cdef inline Handle as_joint(Handle joint) noexcept:
    return joint

cdef inline void raise_caught() noexcept:
    pass
cdef inline int check_signals() except -1:
    return PyErr_CheckSignals()
cdef void handle_contacts(Handle space, uintptr_t kind, Before before) noexcept:
    (<cpCollisionHandler *>engine.cpSpaceAddWildcardHandler(space, kind)).preSolveFunc = before
cdef void watch_contacts(Handle space, Before before, thing) noexcept:
    cdef cpCollisionHandler *handler = <cpCollisionHandler *>engine.cpSpaceAddGlobalCollisionHandler(space)
    handler.preSolveFunc, handler.userData = before, <void *>thing

cdef struct Found:
    Arbiter *arbiters
    int count
    int room
    bint lost

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
