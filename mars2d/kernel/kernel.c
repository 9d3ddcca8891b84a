/* The control step's motion of a team of discs among walls: what mars2d/engine.py does for any world,
   done here for this one kind without a detour through arrays. engine.py, clutches.py, clearance.py
   and contact.py say what is done and why; names are theirs, and so is every formula and the order of
   each sum, so that both give the same bits. To be compiled without fused multiplication. */

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "kernel.h"

typedef struct { double x, y; } Vector;

typedef void (*Step)(void *, double);
typedef void (*Visit)(void *, void *);
typedef void (*Each)(void *, Visit, void *);
typedef void *(*Change)(void *, void *);
typedef void (*Remove)(void *, void *);
typedef void (*SetVector)(void *, Vector);
typedef Vector (*GetVector)(const void *);
typedef void (*SetNumber)(void *, double);
typedef double (*GetNumber)(const void *);
typedef void *(*InitPivot)(void *, void *, void *, Vector, Vector);
typedef void *(*InitGear)(void *, void *, void *, double, double);
typedef void (*BodiesOf)(const void *, void **, void **);
typedef int (*CountOf)(const void *);
typedef Vector (*PointOf)(const void *, int);

#pragma pack(push, 1)
typedef struct { /* mars2d.contact.CONTACT */
    double time, duration;
    int32_t a, b;
    Vector point, normal;
    double impulse, normal_impulse, tangential_impulse, speed, slip;
    uint8_t began, ended;
} Contact;
#pragma pack(pop)

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

/* Pairs (a, b) of bodies in touch, in lists by a, which is a robot; few have many. */
typedef struct { int b, next; } Link;
typedef struct {
    int *head; /* (n), -1 for none */
    int *as;   /* of each link */
    Link *links;
    int as_room, link_count, link_room;
} Pairs;

/* How long a pair has stayed in touch in one substep. */
typedef struct { int a, b; double length; } Held;

struct Kernel {
    Team team;
    Functions f;
    const double *twist; /* (3, n) of this control step */
    double elapsed;      /* seconds of it */
    int failed;          /* memory has run out */
    /* Of all robots, (n); of their control bodies, the second half of `aimed`. */
    uint8_t *near, *wanted;
    int *place; /* in `who` */
    double *speed, *start;
    Vector *aimed; /* what the engine is told */
    double *aimed_spin;
    /* Of those that are near. */
    int near_count, *who;
    uint8_t *touching;
    Vector *velocity; /* as they move now */
    double *bend, *gone;
    /* The segments within each robot's skin when the Verlet list was made. */
    int *first_wall, *walls, wall_count, wall_room;
    /* The Verlet list: of each robot those with larger numbers; and cells, by which it is made. */
    int *first_pair, *lists, list_count, list_room;
    int *next, *cells, cell_room;
    Pair *pairs;
    int pair_count, pair_room;
    /* The contacts of this control step. */
    Row *rows;
    Substep *substeps;
    Held *helds;
    int row_count, row_room, substep_count, substep_room, held_count, held_room;
    /* Who touches now, who did after the last substep, and after the last control step; who is
       listed by the solver, and whose contacts are taken. */
    Pairs touched, latest, before, listed, taken;
    Vector *sums;
    int sum_room;
};

#define AS(type, address) ((type)(uintptr_t)(address))
#define MAX(a, b) ((a) > (b) ? (a) : (b))
#define MIN(a, b) ((a) < (b) ? (a) : (b))

static void *grown(Kernel *k, void *memory, int *room, int wanted, size_t size)
{
    if (wanted <= *room) return memory;
    int more = MAX(wanted, 2 * *room + 16);
    void *larger = realloc(memory, (size_t)more * size);
    if (larger == NULL) { k->failed = 1; return memory; }
    *room = more;
    return larger;
}

#define GROW(k, what, count) (what##s = grown(k, what##s, &what##_room, count, sizeof *what##s))

static double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y; }

/* -- arcs and gaps ---------------------------------------------------------------------------- */

/* The velocity that brings robot i, at heading theta, along its arc in h. */
static Vector chord(const Kernel *k, int i, double theta, double h)
{
    const Team *t = &k->team;
    double forward = k->twist[i], left = k->twist[t->n + i], spin = k->twist[2 * t->n + i];
    double half = t->in_robot_frame[i] ? spin * (h / 2) : 0.0;
    double turned = t->in_robot_frame[i] ? theta + half : 0.0;
    double shrink = half == 0.0 ? 1.0 : sin(half) / half;
    double c = shrink * cos(turned), s = shrink * sin(turned);
    Vector v = {forward * c - left * s, forward * s + left * c};
    return v;
}

/* The vector from a point to the nearest point of a segment. */
static Vector towards(const Team *t, int segment, Vector point)
{
    const double *start = t->start + 2 * segment, *edge = t->edge + 2 * segment;
    const double *per_length = t->per_length + 2 * segment;
    Vector from = {point.x - start[0], point.y - start[1]};
    double along = from.x * per_length[0] + from.y * per_length[1];
    along = along < 0.0 ? 0.0 : along > 1.0 ? 1.0 : along;
    Vector way = {along * edge[0] - from.x, along * edge[1] - from.y};
    return way;
}

static Vector center(const Team *t, int i)
{
    Vector c = {t->state[6 * i], t->state[6 * i + 1]};
    return c;
}

/* Whether x, y are plainly further away than `far`: that spares most of the roots. */
static int beyond(double x, double y, double far)
{
    return x * x + y * y > far * far * (1 + 1e-9);
}

/* Whether two robots are no further apart than this. */
static int close(const Team *t, int64_t i, int64_t j, double reach)
{
    const double *a = t->state + 6 * i, *b = t->state + 6 * j;
    double x = a[0] - b[0], y = a[1] - b[1], r = t->radius[i], s = t->radius[j];
    return !beyond(x, y, r + s + reach) && hypot(x, y) - r - s <= reach;
}

static int close_to_wall(const Team *t, int i, int segment, double reach)
{
    Vector way = towards(t, segment, center(t, i));
    double r = t->radius[i];
    return !beyond(way.x, way.y, r + reach) && hypot(way.x, way.y) - r <= reach;
}

/* The gap between a robot and the nearest of the segments that are listed for it. */
static double wall_gap(const Kernel *k, int i)
{
    const Team *t = &k->team;
    double least = INFINITY, r = t->radius[i];
    for (int w = k->first_wall[i]; w < k->first_wall[i + 1]; w++) {
        Vector way = towards(t, k->walls[w], center(t, i));
        if (beyond(way.x, way.y, r + least)) continue;
        double gap = hypot(way.x, way.y) - r;
        if (gap < least) least = gap;
    }
    return least;
}

static int by_number(const void *a, const void *b)
{
    int x = *(const int *)a, y = *(const int *)b;
    return (x > y) - (x < y);
}

static int cell_of(double x, double least, double size, int count)
{
    int cell = (int)((x - least) / size);
    return cell < 0 ? 0 : cell >= count ? count - 1 : cell;
}

static void list_pair(Kernel *k, int j)
{
    GROW(k, k->list, k->list_count + 1);
    if (!k->failed) k->lists[k->list_count++] = j;
}

/* Lists for each robot those with larger numbers within `cutoff`, in their order, by way of square
   cells of that size. */
static void list_robots(Kernel *k, double cutoff)
{
    const Team *t = &k->team;
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < t->n; i++)
        for (int d = 0; d < 2; d++) {
            low[d] = MIN(low[d], t->state[6 * i + d]);
            high[d] = MAX(high[d], t->state[6 * i + d]);
        }
    /* No more cells than robots in a row, however far apart they are. */
    double size = MAX(cutoff, MAX(high[0] - low[0], high[1] - low[1]) / (sqrt((double)t->n) + 1));
    int across = (int)((high[0] - low[0]) / size) + 1, up = (int)((high[1] - low[1]) / size) + 1;
    GROW(k, k->cell, across * up);
    if (k->failed) return;
    for (int c = 0; c < across * up; c++) k->cells[c] = -1;
    for (int i = t->n - 1; i >= 0; i--) { /* so that each cell's list ascends */
        int x = cell_of(t->state[6 * i], low[0], size, across);
        int y = cell_of(t->state[6 * i + 1], low[1], size, up);
        k->next[i] = k->cells[y * across + x];
        k->cells[y * across + x] = i;
    }
    for (int i = 0; i < t->n; i++) {
        int first = k->first_pair[i] = k->list_count;
        int x = cell_of(t->state[6 * i], low[0], size, across);
        int y = cell_of(t->state[6 * i + 1], low[1], size, up);
        for (int v = MAX(y - 1, 0); v <= MIN(y + 1, up - 1); v++)
            for (int u = MAX(x - 1, 0); u <= MIN(x + 1, across - 1); u++)
                for (int j = k->cells[v * across + u]; j >= 0; j = k->next[j]) {
                    double dx = t->state[6 * i] - t->state[6 * j];
                    double dy = t->state[6 * i + 1] - t->state[6 * j + 1];
                    if (j > i && !beyond(dx, dy, cutoff)) list_pair(k, j);
                }
        if (k->failed) return;
        qsort(k->lists + first, (size_t)(k->list_count - first), sizeof *k->lists, by_number);
    }
}

/* Lists for each robot the segments within its skin. */
static void list_walls(Kernel *k)
{
    const Team *t = &k->team;
    k->wall_count = 0;
    for (int i = 0; i < t->n; i++) {
        k->first_wall[i] = k->wall_count;
        if (t->wall_gap[i] > t->skin) continue;
        for (int s = 0; s < t->segments; s++) {
            const double *start = t->start + 2 * s, *edge = t->edge + 2 * s;
            double x = t->state[6 * i] - (start[0] + edge[0] / 2);
            double y = t->state[6 * i + 1] - (start[1] + edge[1] / 2);
            double half = (fabs(edge[0]) + fabs(edge[1])) / 2; /* no less than half its length */
            if (beyond(x, y, half + t->radius[i] + t->skin)) continue;
            if (!close_to_wall(t, i, s, t->skin)) continue;
            GROW(k, k->wall, k->wall_count + 1);
            if (k->failed) return;
            k->walls[k->wall_count++] = s;
        }
    }
    k->first_wall[t->n] = k->wall_count;
}

/* Makes the Verlet list anew, of few robots once and for all: then its skin is infinite. */
static void list_pairs(Kernel *k)
{
    Team *t = &k->team;
    double furthest = 0.0, largest = 0.0;
    for (int i = 0; i < t->n; i++) {
        furthest = MAX(furthest, t->reach[i]);
        largest = MAX(largest, t->radius[i]);
        t->moved[i] = 0.0;
    }
    k->list_count = 0;
    if (t->n <= t->few) {
        t->skin = INFINITY;
        for (int i = 0; i < t->n; i++) {
            k->first_pair[i] = k->list_count;
            for (int j = i + 1; j < t->n; j++) list_pair(k, j);
        }
    } else {
        double skin = 4 * furthest;
        t->skin = 2 * MAX(skin, largest);
        list_robots(k, 2 * largest + 2 * t->skin);
    }
    k->first_pair[t->n] = k->list_count;
    list_walls(k);
}

/* Marks what may touch something while each robot moves by at most its reach. */
static void may_touch(Kernel *k)
{
    Team *t = &k->team;
    for (int i = 0; i < t->n; i++)
        if (t->moved[i] + t->reach[i] > t->skin) {
            list_pairs(k);
            break;
        }
    if (k->failed) return;
    for (int i = 0; i < t->n; i++)
        for (int p = k->first_pair[i]; p < k->first_pair[i + 1]; p++) {
            int j = k->lists[p];
            if (k->near[i] && k->near[j]) continue;
            if (close(t, i, j, t->reach[i] + t->reach[j])) k->near[i] = k->near[j] = 1;
        }
    for (int i = 0; i < t->n; i++) {
        if (!(t->wall_gap[i] <= t->reach[i])) continue;
        double gap = wall_gap(k, i);
        if (gap <= t->reach[i]) k->near[i] = 1;
        t->wall_gap[i] = MIN(gap, t->skin - t->moved[i]); /* others are not listed */
    }
}

/* Marks those that may touch something within `duration`. Returns the longest path that one of them
   may take. */
static double find_near(Kernel *k, double duration)
{
    Team *t = &k->team;
    int count = -1, now = 0;
    double path = 0.0;
    for (int i = 0; i < t->n; i++) {
        k->near[i] = t->slipping[i];
        now += k->near[i];
        k->speed[i] = hypot(k->twist[i], k->twist[t->n + i]);
        if (k->near[i]) {
            double moves = hypot(t->state[6 * i + 3], t->state[6 * i + 4]);
            k->speed[i] = MAX(k->speed[i], moves);
        }
        t->reach[i] = k->speed[i] * duration;
    }
    while (now != count) {
        count = now;
        may_touch(k);
        double fastest = -1.0;
        now = 0;
        for (int i = 0; i < t->n; i++)
            if (k->near[i]) {
                now++;
                fastest = MAX(fastest, k->speed[i]);
            }
        if (now == 0) break;
        path = t->slack * fastest * duration;
        for (int i = 0; i < t->n; i++)
            t->reach[i] = k->near[i] ? path + t->max_overlap : k->speed[i] * duration;
    }
    for (int i = 0; i < t->n; i++) {
        t->moved[i] += t->reach[i];
        t->wall_gap[i] -= t->reach[i];
    }
    return path;
}

/* Lists what may touch among those that are near, each moving by at most `reach`. */
static void encounter(Kernel *k, double reach)
{
    Team *t = &k->team;
    k->near_count = k->pair_count = 0;
    for (int i = 0; i < t->n; i++) {
        k->place[i] = k->near[i] ? k->near_count : -1;
        if (k->near[i]) k->who[k->near_count++] = i;
    }
    for (int a = 0; a < t->n; a++)
        for (int p = k->first_pair[a]; k->near[a] && p < k->first_pair[a + 1]; p++) {
            int b = k->lists[p];
            if (!k->near[b] || !close(t, a, b, 2 * reach)) continue;
            GROW(k, k->pair, k->pair_count + 1);
            if (k->failed) return;
            double radii = t->radius[a] + t->radius[b];
            Pair pair = {k->place[a], k->place[b], -1, a, b, radii, 0.0, {0.0, 0.0}};
            k->pairs[k->pair_count++] = pair;
        }
    for (int w = 0; w < k->near_count; w++) {
        int a = k->who[w];
        if (t->wall_gap[a] > 0) continue;
        for (int l = k->first_wall[a]; l < k->first_wall[a + 1]; l++) {
            int s = k->walls[l];
            if (!close_to_wall(t, a, s, reach)) continue;
            GROW(k, k->pair, k->pair_count + 1);
            if (k->failed) return;
            Pair pair = {w, -1, s, a, -1 - t->obstacle[s], t->radius[a], 0.0, {0.0, 0.0}};
            k->pairs[k->pair_count++] = pair;
        }
    }
}

/* Measures the gaps of the pairs. Returns whether any touch, and marks the robots that do. */
static int measure(Kernel *k)
{
    Team *t = &k->team;
    int any = 0;
    memset(k->touching, 0, (size_t)k->near_count);
    for (int p = 0; p < k->pair_count; p++) {
        Pair *pair = k->pairs + p;
        Vector here = center(t, pair->a), between;
        if (pair->j < 0) between = towards(t, pair->segment, here);
        else {
            Vector there = center(t, pair->b);
            between.x = there.x - here.x;
            between.y = there.y - here.y;
        }
        double distance = hypot(between.x, between.y);
        pair->gap = distance - pair->radii;
        double scale = 1.0 / MAX(distance, t->tiny);
        pair->normal.x = between.x * scale;
        pair->normal.y = between.y * scale;
        if (pair->gap <= 0) {
            any = 1;
            k->touching[pair->i] = 1;
            if (pair->j >= 0) k->touching[pair->j] = 1;
        }
    }
    return any;
}

/* -- the engine's bodies ---------------------------------------------------------------------- */

static void place(Kernel *k, int i, Vector where)
{
    k->team.state[6 * i] = where.x;
    k->team.state[6 * i + 1] = where.y;
    k->team.placed[i] = 1;
    AS(SetVector, k->f.set_position)(AS(void *, k->team.body[i]), where);
}

/* Reads where bodies are and how they move, of all or of those that are near: the others are carried
   along, and nobody asks meanwhile. */
static void read_state(Kernel *k, int all)
{
    Team *t = &k->team;
    int count = all ? t->n : k->near_count;
    for (int p = 0; p < count; p++) {
        int i = all ? p : k->who[p];
        const void *body = AS(void *, t->body[i]);
        double *s = t->state + 6 * i;
        Vector p = AS(GetVector, k->f.get_position)(body), v = AS(GetVector, k->f.get_velocity)(body);
        s[0] = p.x;
        s[1] = p.y;
        s[2] = AS(GetNumber, k->f.get_angle)(body);
        s[3] = v.x;
        s[4] = v.y;
        s[5] = AS(GetNumber, k->f.get_spin)(body);
    }
}

static void set_velocity(Kernel *k, uintptr_t body, Vector velocity, double spin)
{
    AS(SetVector, k->f.set_velocity)(AS(void *, body), velocity);
    AS(SetNumber, k->f.set_spin)(AS(void *, body), spin);
}

static void add_joints(Kernel *k, int i)
{
    AS(Change, k->f.add_constraint)(AS(void *, k->team.space), AS(void *, k->team.pivot[i]));
    AS(Change, k->f.add_constraint)(AS(void *, k->team.space), AS(void *, k->team.gear[i]));
}

static void remove_joints(Kernel *k, int i)
{
    AS(Remove, k->f.remove_constraint)(AS(void *, k->team.space), AS(void *, k->team.pivot[i]));
    AS(Remove, k->f.remove_constraint)(AS(void *, k->team.space), AS(void *, k->team.gear[i]));
}

/* Makes joints, which are in no space now, as if they had not held anything yet. */
static void make_anew(Kernel *k, int i)
{
    Team *t = &k->team;
    void *pivot = AS(void *, t->pivot[i]), *gear = AS(void *, t->gear[i]);
    void *control = AS(void *, t->control[i]), *body = AS(void *, t->body[i]);
    Vector zero = {0.0, 0.0};
    AS(InitPivot, k->f.init_pivot)(pivot, control, body, zero, zero);
    AS(InitGear, k->f.init_gear)(gear, control, body, 0.0, 1.0);
    AS(SetNumber, k->f.set_max_bias)(pivot, 0.0);
    AS(SetNumber, k->f.set_max_bias)(gear, 0.0);
    AS(SetNumber, k->f.set_max_force)(pivot, t->force[i]);
    AS(SetNumber, k->f.set_max_force)(gear, t->torque[i]);
}

static void engage(Kernel *k, const uint8_t *wanted)
{
    Team *t = &k->team;
    for (int i = 0; i < t->n; i++)
        if (wanted[i] && !t->engaged[i]) {
            make_anew(k, i);
            add_joints(k, i);
        }
    for (int i = 0; i < t->n; i++)
        if (t->engaged[i] && !wanted[i]) remove_joints(k, i);
    memcpy(t->engaged, wanted, (size_t)t->n);
}

static void scale_contact(void *arbiter, void *data)
{
    Kernel *k = *(Kernel **)data;
    double ratio = *(double *)((char *)data + sizeof(Kernel *));
    const Team *t = &k->team;
    char *memory = arbiter;
    int32_t state, count;
    char *contacts;
    memcpy(&state, memory + t->arbiter_state, sizeof state);
    memcpy(&count, memory + t->arbiter_count, sizeof count);
    memcpy(&contacts, memory + t->arbiter_contacts, sizeof contacts);
    if (state != 0 && state != 1) return; /* neither just begun nor going on */
    for (int c = 0; c < count; c++) {
        char *contact = contacts + (size_t)c * t->contact_size;
        *(double *)(contact + t->contact_normal) *= ratio;
        *(double *)(contact + t->contact_tangent) *= ratio;
    }
}

/* Lets the engine step, with velocities set anew of all, or of those that are near. */
static void space_step(Kernel *k, double h, int all)
{
    Team *t = &k->team;
    void *space = AS(void *, t->space);
    if (h != t->last_step) {
        struct { Kernel *k; double ratio; } data = {k, h / t->last_step};
        AS(Each, k->f.each_arbiter)(space, scale_contact, &data);
        t->last_step = h;
    }
    memset(t->placed, 0, (size_t)t->n);
    AS(Step, k->f.set_time_step)(space, h);
    int count = all ? t->n : k->near_count;
    for (int p = 0; p < count; p++) {
        int i = all ? p : k->who[p];
        set_velocity(k, t->body[i], k->aimed[i], k->aimed_spin[i]);
        if (t->engaged[i]) set_velocity(k, t->control[i], k->aimed[t->n + i], k->aimed_spin[t->n + i]);
    }
    AS(Step, k->f.step)(space, h);
}

/* -- contacts --------------------------------------------------------------------------------- */

static void empty(Pairs *set)
{
    for (int l = 0; l < set->link_count; l++) set->head[set->as[l]] = -1;
    set->link_count = 0;
}

/* Where a pair is in a set; -1 if it is not there. */
static int find(const Pairs *set, int a, int b)
{
    int l = set->head[a];
    while (l >= 0 && set->links[l].b != b) l = set->links[l].next;
    return l;
}

/* Adds a pair; returns where it is in the set, or -1 - where if it was there before. */
static int add(Kernel *k, Pairs *set, int a, int b)
{
    int found = find(set, a, b), count = set->link_count;
    if (found >= 0) return -1 - found;
    GROW(k, set->link, count + 1);
    set->as = grown(k, set->as, &set->as_room, count + 1, sizeof *set->as);
    if (k->failed) return 0;
    Link link = {b, set->head[a]};
    set->links[count] = link;
    set->as[count] = a;
    set->head[a] = count;
    set->link_count++;
    return count;
}

static void swap_sets(Pairs *a, Pairs *b)
{
    Pairs other = *a;
    *a = *b;
    *b = other;
}

/* The number of a body; the names of all bodies are sorted by address. */
static int number_of(const Team *t, const void *body)
{
    int low = 0, high = t->bodies;
    uintptr_t address = (uintptr_t)body;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (t->address[middle] <= address) low = middle;
        else high = middle;
    }
    return (int)t->name[low];
}

/* The velocity of a body's point, as the engine was told; obstacles stand still. */
static Vector point_velocity(const Kernel *k, int body, Vector point)
{
    Vector v = {0.0, 0.0};
    if (body < 0) return v;
    double x = point.x - k->team.state[6 * body], y = point.y - k->team.state[6 * body + 1];
    v.x = k->aimed[body].x - k->aimed_spin[body] * y;
    v.y = k->aimed[body].y + k->aimed_spin[body] * x;
    return v;
}

static Vector middle_of(Vector a, Vector b)
{
    Vector m = {(a.x + b.x) / 2, (a.y + b.y) / 2};
    return m;
}

/* Notes what the solver lists, if it touches after this substep. */
static void list_contact(void *arbiter, void *data)
{
    Kernel *k = *(Kernel **)data;
    const Functions *f = &k->f;
    void *body_a, *body_b;
    AS(BodiesOf, f->bodies_of)(arbiter, &body_a, &body_b);
    int first = number_of(&k->team, body_a), second = number_of(&k->team, body_b);
    int swap = first < 0 || (second >= 0 && second < first);
    int a = swap ? second : first, b = swap ? first : second;
    if (find(&k->touched, a, b) < 0) return;
    GROW(k, k->row, k->row_count + 1);
    if (k->failed) return;
    int count = AS(CountOf, f->count_of)(arbiter);
    Vector zero = {0.0, 0.0}, on_first = zero, on_second = zero;
    if (count > 0) {
        on_first = AS(PointOf, f->point_a)(arbiter, 0);
        on_second = AS(PointOf, f->point_b)(arbiter, 0);
    }
    if (count > 1) {
        on_first = middle_of(on_first, AS(PointOf, f->point_a)(arbiter, 1));
        on_second = middle_of(on_second, AS(PointOf, f->point_b)(arbiter, 1));
    }
    Row *row = k->rows + k->row_count++;
    row->a = a;
    row->b = b;
    row->substep = k->substep_count - 1;
    row->normal = AS(GetVector, f->normal_of)(arbiter);
    row->impulse = AS(GetVector, f->impulse_of)(arbiter);
    row->point = swap ? on_second : on_first;
    Vector fast = point_velocity(k, second, on_second), slow = point_velocity(k, first, on_first);
    row->velocity.x = fast.x - slow.x;
    row->velocity.y = fast.y - slow.y;
    if (swap) {
        row->normal.x = -row->normal.x;
        row->normal.y = -row->normal.y;
        row->velocity.x = -row->velocity.x;
        row->velocity.y = -row->velocity.y;
    }
    if (dot(row->impulse, row->normal) < 0) {
        row->impulse.x = -row->impulse.x;
        row->impulse.y = -row->impulse.y;
    }
    row->strength = hypot(row->impulse.x, row->impulse.y);
}

/* By pair, strength and then whatever distinguishes two. */
static int by_row(const void *a, const void *b)
{
    const Row *p = a, *q = b;
    if (p->a != q->a) return p->a < q->a ? -1 : 1;
    if (p->b != q->b) return p->b < q->b ? -1 : 1;
    double x[5] = {-p->strength, p->point.x, p->point.y, p->normal.x, p->normal.y};
    double y[5] = {-q->strength, q->point.x, q->point.y, q->normal.x, q->normal.y};
    for (int i = 0; i < 5; i++)
        if (x[i] != y[i]) return x[i] < y[i] ? -1 : 1;
    return 0;
}

/* Notes who touches whom after a substep of h. */
static void note_contacts(Kernel *k, double time, double h, int any)
{
    if (!any) {
        empty(&k->latest);
        return;
    }
    empty(&k->touched);
    for (int p = 0; p < k->pair_count; p++)
        if (k->pairs[p].gap <= 0) add(k, &k->touched, k->pairs[p].a, k->pairs[p].b);
    GROW(k, k->substep, k->substep_count + 1);
    if (k->failed) return;
    Substep substep = {time, h};
    k->substeps[k->substep_count++] = substep;
    int first = k->row_count, several = 0;
    Kernel *data = k;
    AS(Each, k->f.each_arbiter)(AS(void *, k->team.space), list_contact, &data);
    GROW(k, k->held, k->held_count + k->row_count - first);
    if (k->failed) return;
    empty(&k->listed);
    for (int r = first; r < k->row_count; r++) {
        int a = k->rows[r].a, b = k->rows[r].b;
        if (add(k, &k->listed, a, b) < 0) several = 1;
        else if (find(&k->latest, a, b) >= 0) {
            Held held = {a, b, h};
            k->helds[k->held_count++] = held;
        }
    }
    /* The solver lists several contacts of a pair in the order of their addresses in memory. */
    if (several) qsort(k->rows + first, (size_t)(k->row_count - first), sizeof *k->rows, by_row);
    swap_sets(&k->latest, &k->listed);
}

/* By time, then by pair. */
static int by_time(const void *a, const void *b)
{
    const Contact *p = a, *q = b;
    if (p->time != q->time) return p->time < q->time ? -1 : 1;
    if (p->a != q->a) return p->a < q->a ? -1 : 1;
    return (p->b > q->b) - (p->b < q->b);
}

int mars2d_kernel_contacts(Kernel *k)
{
    empty(&k->taken);
    for (int r = 0; r < k->row_count; r++) add(k, &k->taken, k->rows[r].a, k->rows[r].b);
    GROW(k, k->sum, k->taken.link_count);
    return k->failed ? -1 : k->taken.link_count;
}

int mars2d_kernel_take(Kernel *k, void *memory)
{
    Contact *contacts = memory;
    int count = k->taken.link_count;
    memset(contacts, 0, (size_t)count * sizeof *contacts);
    for (int c = 0; c < count; c++) contacts[c].a = -1;
    memset(k->sums, 0, (size_t)count * sizeof *k->sums);
    for (int r = 0; r < k->row_count; r++) {
        const Row *row = k->rows + r;
        Contact *contact = contacts + find(&k->taken, row->a, row->b);
        if (contact->a < 0) { /* the first of its pair */
            contact->a = row->a;
            contact->b = row->b;
            contact->normal = row->normal;
            contact->point = row->point;
            contact->began = find(&k->before, row->a, row->b) < 0;
            contact->ended = find(&k->latest, row->a, row->b) < 0;
            const Substep *substep = k->substeps + row->substep;
            contact->time = substep->time - (contact->began ? 0.0 : substep->length);
            contact->speed = contact->began ? -dot(row->velocity, row->normal) : 0.0;
            contact->slip = row->velocity.y * row->normal.x - row->velocity.x * row->normal.y;
        }
        k->sums[contact - contacts].x += row->impulse.x;
        k->sums[contact - contacts].y += row->impulse.y;
        contact->normal_impulse += dot(row->impulse, row->normal);
        contact->tangential_impulse += row->impulse.y * row->normal.x - row->impulse.x * row->normal.y;
    }
    for (int h = 0; h < k->held_count; h++)
        contacts[find(&k->taken, k->helds[h].a, k->helds[h].b)].duration += k->helds[h].length;
    for (int c = 0; c < count; c++) contacts[c].impulse = hypot(k->sums[c].x, k->sums[c].y);
    if (count > 1) qsort(contacts, (size_t)count, sizeof *contacts, by_time);
    k->row_count = k->substep_count = k->held_count = 0;
    empty(&k->before);
    for (int l = 0; l < k->latest.link_count; l++)
        add(k, &k->before, k->latest.as[l], k->latest.links[l].b);
    return k->failed ? -1 : count;
}

/* -- one substep ------------------------------------------------------------------------------ */

/* Presses together what touches by a rounding only, and would lose touch by another. */
static void press(Kernel *k)
{
    Team *t = &k->team;
    for (int p = 0; p < k->pair_count; p++) {
        const Pair *pair = k->pairs + p;
        if (!(pair->gap <= 0) || !(pair->gap > -(t->pressed / 8))) continue;
        int a = pair->a, b = pair->b;
        double share = b < 0 ? 1.0 : t->mass[b] / (t->mass[a] + t->mass[b]);
        double ways[2] = {share * t->pressed, (share - 1) * t->pressed};
        for (int end = 0; end < 2; end++) {
            int i = end ? b : a;
            if (i < 0) continue;
            Vector where = center(t, i);
            where.x += ways[end] * pair->normal.x;
            where.y += ways[end] * pair->normal.y;
            place(k, i, where);
        }
    }
}

/* When its drive ends the spin of a robot that just begins to slip. */
static double time_to_brake(const Kernel *k, int i)
{
    const Team *t = &k->team;
    if (!t->slipping[i] || t->since[i] <= 0) return INFINITY;
    double spin = fabs(t->state[6 * i + 5] - k->twist[2 * t->n + i]);
    double rim = MAX(spin * t->rim[i], t->least);
    return MAX(spin * t->moment[i] / t->torque[i], t->turned / rim);
}

/* Whether its drive can't bring a robot back to its command within h. */
static int out_of_reach(const Kernel *k, int i, double h)
{
    const Team *t = &k->team;
    const double *s = t->state + 6 * i;
    Vector aim = chord(k, i, s[2], h);
    double impulse = hypot(fabs(s[3] - aim.x), fabs(s[4] - aim.y)) * t->mass[i];
    double spin = fabs(s[5] - k->twist[2 * t->n + i]) * t->moment[i];
    return impulse > t->force[i] * h || spin > t->torque[i] * h;
}

/* For how long no pair gets deeper than a body may enter. */
static double time_to_touch(const Kernel *k)
{
    const Team *t = &k->team;
    double shortest = INFINITY, depth = t->entry;
    for (int p = 0; p < k->pair_count; p++) {
        const Pair *pair = k->pairs + p;
        Vector approach = k->velocity[pair->i];
        double turn = k->bend[pair->i];
        if (pair->j >= 0) {
            approach.x -= k->velocity[pair->j].x;
            approach.y -= k->velocity[pair->j].y;
            turn += k->bend[pair->j];
        }
        double closing = dot(approach, pair->normal), room = pair->gap + depth;
        closing = MAX(closing, 0.0);
        room = MAX(room, depth / 64);
        double h = 2 * room / (closing + sqrt(closing * closing + 2 * turn * room) + t->tiny);
        if (h < shortest) shortest = h;
    }
    return shortest;
}

/* Works out how those that are near move, who slips, and how long the next substep may be. */
static double look_ahead(Kernel *k, double left)
{
    Team *t = &k->team;
    double h = left;
    int any = 0;
    for (int w = 0; w < k->near_count; w++) {
        int i = k->who[w];
        if (k->touching[w]) t->slipping[i] = 1;
        any |= t->slipping[i];
    }
    if (any) {
        h = MIN(h, t->contact_step);
        h = MIN(h, t->growth * t->last_step);
        for (int w = 0; w < k->near_count; w++) {
            double brake = time_to_brake(k, k->who[w]);
            if (brake < h) h = brake;
        }
        for (int w = 0; w < k->near_count; w++) {
            int i = k->who[w];
            if (t->slipping[i] && !k->touching[w]) t->slipping[i] = (uint8_t)out_of_reach(k, i, h);
        }
    }
    for (int w = 0; w < k->near_count; w++) {
        int i = k->who[w];
        const double *s = t->state + 6 * i;
        if (t->slipping[i]) {
            Vector moves = {s[3], s[4]};
            k->velocity[w] = moves;
            k->bend[w] = 0.0;
            continue;
        }
        k->velocity[w] = chord(k, i, s[2], 0.0);
        double speed = hypot(k->twist[i], k->twist[t->n + i]);
        k->bend[w] = t->in_robot_frame[i] ? fabs(speed * k->twist[2 * t->n + i]) : 0.0;
    }
    h = MIN(h, time_to_touch(k));
    return left / ceil(left / h - 1e-9);
}

/* Prepares those that are near for a substep of h. */
static void aim(Kernel *k, double h)
{
    Team *t = &k->team;
    int brief = h <= t->contact_step, any = 0;
    memset(k->wanted, 0, (size_t)t->n);
    for (int w = 0; w < k->near_count; w++) {
        int i = k->who[w];
        const double *s = t->state + 6 * i;
        double spin = k->twist[2 * t->n + i];
        if (t->slipping[i]) {
            Vector moves = {s[3], s[4]};
            k->aimed[i] = moves;
            k->aimed_spin[i] = s[5];
            t->since[i] = 0;
            any = 1;
        } else {
            k->aimed[i] = chord(k, i, s[2], h);
            k->aimed_spin[i] = spin;
            t->since[i]++;
        }
        if (!t->slipping[i] && !(brief && t->since[i] <= t->linger)) continue;
        k->aimed[t->n + i] = chord(k, i, s[2] + k->aimed_spin[i] * h, h);
        k->aimed_spin[t->n + i] = spin;
        k->wanted[i] = 1;
    }
    engage(k, k->wanted);
    if (!any || !(t->growth * h < t->last_step)) return;
    for (int w = 0; w < k->near_count; w++) {
        int i = k->who[w];
        if (!t->slipping[i]) continue;
        remove_joints(k, i);
        make_anew(k, i);
        add_joints(k, i);
    }
}

/* Notes how much of their bounds drives have used in the last substep. */
static void note_effort(Kernel *k)
{
    Team *t = &k->team;
    for (int w = 0; w < k->near_count; w++) {
        int i = k->who[w];
        if (!t->slipping[i]) continue;
        double push = AS(GetNumber, k->f.get_impulse)(AS(void *, t->pivot[i]));
        double turn = AS(GetNumber, k->f.get_impulse)(AS(void *, t->gear[i]));
        push = push / (t->force[i] * t->last_step);
        turn = turn / (t->torque[i] * t->last_step);
        double most = MAX(push, turn);
        t->effort[i] = MAX(t->effort[i], most);
    }
}

/* -- the control step ------------------------------------------------------------------------- */

/* Steps through `duration` as finely as those need that are near; returns the seconds gone. */
static double substeps(Kernel *k, double duration, double time, double path)
{
    double elapsed = 0.0, h = 0.0;
    memset(k->gone, 0, (size_t)k->near_count * sizeof *k->gone);
    for (;;) {
        int any = measure(k);
        if (elapsed > 0) note_contacts(k, time + elapsed, h, any);
        if (k->failed || elapsed >= duration) break;
        if (any) press(k);
        double left = duration - elapsed, furthest = 0.0;
        h = look_ahead(k, left);
        for (int w = 0; w < k->near_count; w++) {
            k->gone[w] += h * hypot(k->velocity[w].x, k->velocity[w].y);
            furthest = MAX(furthest, k->gone[w]);
        }
        if (elapsed > 0 && furthest > path) {
            read_state(k, 1);
            break;
        }
        aim(k, h);
        space_step(k, h, elapsed == 0);
        elapsed = h == left ? duration : elapsed + h;
        read_state(k, elapsed >= duration);
        note_effort(k);
    }
    return elapsed;
}

/* Goes on by at most `duration`; returns by how much. */
static double advance(Kernel *k, double duration, double time)
{
    Team *t = &k->team;
    double path = find_near(k, duration), gone = duration;
    int any = 0;
    if (k->failed) return -1.0;
    for (int i = 0; i < t->n; i++) {
        k->wanted[i] = t->engaged[i] && k->near[i];
        any |= k->near[i];
        if (!k->near[i]) t->since[i] = t->linger + 1;
        k->aimed[i] = chord(k, i, t->state[6 * i + 2], duration);
        k->aimed_spin[i] = k->twist[2 * t->n + i];
    }
    engage(k, k->wanted);
    if (!any) {
        space_step(k, duration, 1);
        read_state(k, 1);
        empty(&k->latest);
        return duration;
    }
    encounter(k, path + t->max_overlap);
    if (k->failed) return -1.0;
    memcpy(k->start, t->state, 6 * (size_t)t->n * sizeof *k->start);
    gone = substeps(k, duration, time, path);
    if (gone < duration) /* those that are carried were on the chord of a longer time */
        for (int i = 0; i < t->n; i++) {
            if (k->near[i]) continue;
            Vector way = chord(k, i, k->start[6 * i + 2], gone);
            Vector where = {k->start[6 * i] + gone * way.x, k->start[6 * i + 1] + gone * way.y};
            place(k, i, where);
        }
    return gone;
}

int mars2d_kernel_drive(Kernel *k, const double *twist, double duration, double time)
{
    int left_over = 0;
    k->twist = twist;
    while (k->elapsed < duration) {
        double left = duration - k->elapsed;
        double gone = advance(k, left, time + k->elapsed);
        if (k->failed) return -1;
        k->elapsed = gone == left ? duration : k->elapsed + gone;
    }
    k->elapsed = 0.0;
    for (int i = 0; i < k->team.n; i++) {
        if (k->team.placed[i]) left_over |= MARS2D_PLACED;
        if (k->team.effort[i] > 0) left_over |= MARS2D_EFFORT;
    }
    if (k->row_count > 0) return left_over | MARS2D_CONTACTS;
    empty(&k->before); /* what touches has rows */
    return left_over;
}

void mars2d_kernel_sines(const double *angle, int count, double *sine, double *cosine, double *far)
{
    for (int i = 0; i < count; i++) {
        sine[i] = sin(angle[i]);
        cosine[i] = cos(angle[i]);
        far[i] = hypot(angle[i], sine[i]);
    }
}

/* -- making and freeing ----------------------------------------------------------------------- */

Team *mars2d_kernel_team(Kernel *k) { return &k->team; }

void mars2d_kernel_free(Kernel *k)
{
    if (k == NULL) return;
    void *memory[] = {k->who, k->place, k->near, k->touching, k->wanted, k->velocity, k->bend, k->gone,
                      k->aimed, k->aimed_spin, k->speed, k->start, k->pairs, k->rows, k->substeps,
                      k->helds, k->sums, k->first_wall, k->walls, k->first_pair, k->lists,
                      k->next, k->cells};
    Pairs *sets[] = {&k->touched, &k->latest, &k->before, &k->listed, &k->taken};
    for (size_t m = 0; m < sizeof sets / sizeof *sets; m++) {
        free(sets[m]->head);
        free(sets[m]->as);
        free(sets[m]->links);
    }
    for (size_t m = 0; m < sizeof memory / sizeof *memory; m++) free(memory[m]);
    free(k);
}

Kernel *mars2d_kernel_new(const Team *team, const Functions *functions)
{
    Kernel *k = calloc(1, sizeof *k);
    if (k == NULL) return NULL;
    size_t n = (size_t)team->n;
    k->team = *team;
    k->f = *functions;
    void *memory[] = {
        k->who = calloc(n, sizeof *k->who), k->place = calloc(n, sizeof *k->place),
        k->near = calloc(n, 1), k->touching = calloc(n, 1), k->wanted = calloc(n, 1),
        k->velocity = calloc(n, sizeof *k->velocity), k->bend = calloc(n, sizeof *k->bend),
        k->gone = calloc(n, sizeof *k->gone), k->aimed = calloc(2 * n, sizeof *k->aimed),
        k->aimed_spin = calloc(2 * n, sizeof *k->aimed_spin), k->speed = calloc(n, sizeof *k->speed),
        k->start = calloc(6 * n, sizeof *k->start),
        k->first_wall = calloc(n + 1, sizeof *k->first_wall),
        k->first_pair = calloc(n + 1, sizeof *k->first_pair), k->next = calloc(n, sizeof *k->next),
        k->touched.head = malloc(n * sizeof *k->touched.head),
        k->latest.head = malloc(n * sizeof *k->latest.head),
        k->before.head = malloc(n * sizeof *k->before.head),
        k->listed.head = malloc(n * sizeof *k->listed.head),
        k->taken.head = malloc(n * sizeof *k->taken.head)};
    for (size_t m = 0; m < sizeof memory / sizeof *memory; m++)
        if (memory[m] == NULL) {
            mars2d_kernel_free(k);
            return NULL;
        }
    Pairs *sets[] = {&k->touched, &k->latest, &k->before, &k->listed, &k->taken};
    for (size_t m = 0; m < sizeof sets / sizeof *sets; m++)
        for (size_t i = 0; i < n; i++) sets[m]->head[i] = -1;
    k->team.skin = -1.0; /* to be listed at the first question */
    return k;
}
