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

struct Kernel {
    Team team;
    Engine engine;
    Interrupted interrupted;
    unsigned substep; /* how many there have been */
    int error; /* why it was broken off, for good; 0: it was not */
    /* The twists of this control step, (n) each. */
    const double *forward, *left, *spin;
    /* Of all robots, (n). Of their control bodies: the second half of `aimed`, (2 n). */
    uint8_t *near, *wanted;
    int *place; /* in `who` */
    double *speed;
    State *before;
    Vector *aimed; /* what the engine is told */
    double *aimed_spin;
    /* Of those that are near, `near_count` of them, by their places in `who`. */
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
    /* What may touch during the time to come. */
    Pair *pairs;
    int pair_count, pair_room;
    /* The contacts of this control step. */
    Row *rows;
    Substep *substeps;
    Held *helds;
    int row_count, row_room, substep_count, substep_room, held_count, held_room;
    Vector *sums;
    int sum_room;
    /* Who touches now, who did after the last substep, and after the last control step; who is
       listed by the solver, and whose contacts are taken. */
    Set touched, latest, previous, listed, taken;
};

/* memory.c */
void *grown(Kernel *k, void *items, int *room, int wanted, size_t size);
#define GROW(k, items, room, wanted) ((items) = grown(k, items, &(room), wanted, sizeof *(items)))

/* sets.c */
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
void encounter(Kernel *k, double reach);
int measure(Kernel *k);

/* bodies.c */
void put(Kernel *k, int i, Vector where);
void read_state(Kernel *k, int all);
void engage(Kernel *k, const uint8_t *wanted);
void renew(Kernel *k, int i);
void space_step(Kernel *k, double h, int all);

/* contacts.c */
void note_contacts(Kernel *k, double time, double h, int any);

/* substeps.c */
double substeps(Kernel *k, double duration, double time, double path);

static inline double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y; }

#endif
