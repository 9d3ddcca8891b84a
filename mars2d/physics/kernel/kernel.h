/* What the kernel's files share. Names are those of the plain engine, and so is every formula and the
   order of each sum: then both give the same bits. */

#ifndef MARS2D_KERNEL_H
#define MARS2D_KERNEL_H

#include <float.h>
#include <stddef.h>
#include <stdint.h>

#include "team.h"

/* Where a compiler would round otherwise than numpy does, the plain engine is to do the work. */
#if defined(__FAST_MATH__)
#error "compiled for speed rather than for equal bits"
#endif
#if defined(FLT_EVAL_METHOD) && FLT_EVAL_METHOD != 0
#error "this processor's arithmetic has more digits than a double"
#endif

#define MAX(a, b) ((a) > (b) ? (a) : (b))
#define MIN(a, b) ((a) < (b) ? (a) : (b))

/* Two discs, or a disc and a segment, that are near each other. */
typedef struct {
    int i, j;    /* robots, by their places in `who`; j < 0: a wall */
    int segment; /* of the wall */
    int a, b;    /* robots, by their numbers; b = -1 - k: obstacle k */
    double radii, gap;
    Vector normal;
} Pair;

/* One contact of two shapes after one substep, with a < b or b an obstacle. */
typedef struct {
    int a, b, substep;
    Vector impulse, normal, point, velocity;
    double strength;
} Row;

typedef struct { double time, length; } Substep;

/* How long a pair has stayed in touch in one substep. */
typedef struct { int a, b; double length; } Held;

/* A set of pairs (a, b) of bodies, of which a is a robot: lists by a, few of which are long. */
typedef struct { int b, next; } Link;
typedef struct {
    int *head; /* (n) the first link of each list, -1 for none */
    int *as;   /* the a of each link */
    Link *links;
    int count, as_room, link_room;
} Set;

/* A robot and a segment within its skin. */
typedef struct { int robot, segment; } Hit;

/* Robots that are stepped together, in one space: all of a small team. A large one is stepped in
   parts, each only as finely as it needs itself. */
typedef struct {
    void *space;
    double last_step;
    int *members, count, room;
    Set latest; /* who touched after the last substep */
    /* Those of its members that are near, and their pairs: where they begin in the kernel's lists. */
    int first_near, near_count, first_pair, pair_count;
    /* Shapes of walls and their bodies, if the kernel has made them: of each segment; a body is that
       of the first segment of its obstacle. */
    void **walls, **grounds;
} Group;

struct Kernel {
    Team team;
    Engine engine;
    Interrupted interrupted;
    Group *groups;    /* of which there are `team.groups` */
    Group *group;     /* that is stepped now */
    unsigned substep; /* how many there have been */
    int error;        /* why it was broken off, for good; 0: it was not */
    /* The twists of this control step, (n) each. */
    const double *forward, *left, *spin;
    /* Of all robots, (n). Of their control bodies: the second half of `aimed`, (2 n). */
    uint8_t *near, *wanted;
    int *group_of, *member; /* which group it is in, and where among the members */
    int *place;             /* where among those that are near in its group */
    int *parent, *target;   /* of those that may touch each other: see groups.c */
    void **disc;            /* its shape, if the kernel has made it */
    double *speed;
    State *before;
    Vector *aimed; /* what the engine is told */
    double *aimed_spin;
    /* Those that are near, by groups; what may touch, as it was found and by groups. */
    int *nears;
    Pair *found, *ordered;
    int found_count, found_room, ordered_room;
    /* Of those that are near in this group, `near_count` of them, by their places in `who`. */
    int near_count, *who;
    uint8_t *touching;
    Vector *velocity; /* as they move now */
    double *bend, *gone;
    /* The Verlet list, (n + 1) where each robot's part begins: robots with larger numbers, and
       segments. */
    int *first_robot, *robots, robot_count, robot_room;
    int *first_wall, *walls, wall_room;
    /* What it is made by: square cells, `wide` times as many, each with its first robot and the
       next ones; robots and segments. */
    double size;
    int wide, *cells, *cell, *next;
    Hit *hits;
    int hit_count, hit_room;
    Pair *pairs; /* what may touch during the time to come */
    int pair_count;
    /* The contacts of this control step. */
    Row *rows;
    Substep *substeps;
    Held *helds;
    int row_count, row_room, substep_count, substep_room, held_count, held_room;
    Vector *sums;
    int sum_room;
    /* Who touches now, and who did after the last control step; who is listed by the solver, and
       whose contacts are taken. */
    Set touched, previous, listed, taken;
};

/* memory.c */
void *zeroed(Kernel *k, size_t count, size_t size);
#define ZEROED(k, items, count) ((items) = zeroed(k, count, sizeof *(items)))
void *grown(Kernel *k, void *items, int *room, int wanted, size_t size);
#define GROW(k, items, room, wanted) ((items) = grown(k, items, &(room), wanted, sizeof *(items)))

/* sets.c */
void make_set(Kernel *k, Set *set, int n);
void free_set(Set *set);
void empty(Set *set);
int find(const Set *set, int a, int b);
int add(Kernel *k, Set *set, int a, int b);
void exchange(Set *one, Set *other);

/* arcs.c */
Vector chord(const Kernel *k, int i, double theta, double h);

/* gaps.c */
Vector towards(const Team *t, int segment, Vector point);
int beyond(double x, double y, double far);
int within(const Team *t, int i, int j, double reach);
int wall_within(const Team *t, int i, int segment, double reach);

/* verlet.c */
void list_anew(Kernel *k);

/* near.c */
double find_near(Kernel *k, double duration);
void find_pairs(Kernel *k, double reach);
int measure(Kernel *k);

/* bodies.c */
void put(Kernel *k, int i, Vector where);
void read_state(Kernel *k, int all);
void make_joints(Kernel *k, int i);
void add_joints(Kernel *k, int i);
void remove_joints(Kernel *k, int i);
void engage(Kernel *k, int i);
void disengage(Kernel *k, int i);
void renew(Kernel *k, int i);
void space_step(Kernel *k, double h, int all);

/* groups.c */
void assign_groups(Kernel *k);
void join_groups(Kernel *k);
void order_by_groups(Kernel *k);

/* spaces.c */
void make_spaces(Kernel *k);
void free_spaces(Kernel *k);

/* contacts.c */
void note_contacts(Kernel *k, double time, double h, int any);

/* substeps.c */
double substeps(Kernel *k, double duration, double time, double path);

static inline double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y; }

#endif
