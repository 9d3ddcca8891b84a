/* Who touches whom, where and how hard; see `ContactLog` in mars2d/record/contact.py. */

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kernel.h"

#pragma pack(push, 1)
typedef struct { /* mars2d.record.contact.CONTACT */
    double time, duration;
    int32_t a, b;
    Vector point, normal;
    double impulse, normal_impulse, tangential_impulse, speed, slip;
    uint8_t began, ended;
} Contact;
#pragma pack(pop)

/* -- after a substep -------------------------------------------------------------------------- */

/* The number of a body that is a robot or an obstacle; no others have shapes. */
static int number_of(const Kernel *k, void *body)
{
    const Team *t = &k->team;
    if (t->groups > 1) return (int)(intptr_t)k->engine.data_of(body);
    int low = 0, high = t->bodies;
    uintptr_t address = (uintptr_t)body;
    while (high - low > 1) {
        int middle = low + (high - low) / 2;
        if (t->address[middle] <= address) low = middle;
        else high = middle;
    }
    return (int)t->name[low];
}

/* The velocity of a body's point, as the engine was told; obstacles stand still. */
static Vector point_velocity(const Kernel *k, int body, Vector point)
{
    if (body < 0) return (Vector){0.0, 0.0};
    Vector from = k->team.state[body].position, v = k->aimed[body];
    double spin = k->aimed_spin[body];
    return (Vector){v.x - spin * (point.y - from.y), v.y + spin * (point.x - from.x)};
}

static Vector middle_of(Vector a, Vector b) { return (Vector){(a.x + b.x) / 2, (a.y + b.y) / 2}; }

static Vector reversed(Vector v) { return (Vector){-v.x, -v.y}; }

/* What the solver found of one contact of two shapes, as from the first to the second body. */
static Row row_of(const Kernel *k, void *arbiter, int first, int second)
{
    const Engine *e = &k->engine;
    int count = e->count_of(arbiter);
    Vector on_first = {0.0, 0.0}, on_second = {0.0, 0.0};
    if (count > 0) {
        on_first = e->point_a(arbiter, 0);
        on_second = e->point_b(arbiter, 0);
    }
    if (count > 1) {
        on_first = middle_of(on_first, e->point_a(arbiter, 1));
        on_second = middle_of(on_second, e->point_b(arbiter, 1));
    }
    Vector fast = point_velocity(k, second, on_second), slow = point_velocity(k, first, on_first);
    Row row = {first, second, k->substep_count - 1, e->impulse_of(arbiter), e->normal_of(arbiter),
               on_first, {fast.x - slow.x, fast.y - slow.y}, 0.0};
    if (first < 0 || (second >= 0 && second < first)) {
        row.a = second;
        row.b = first;
        row.point = on_second;
        row.normal = reversed(row.normal);
        row.velocity = reversed(row.velocity);
    }
    /* On b, and away from a: the solver's sign depends on the order of the shapes. */
    if (dot(row.impulse, row.normal) < 0) row.impulse = reversed(row.impulse);
    row.strength = hypot(row.impulse.x, row.impulse.y);
    return row;
}

/* Notes what the solver lists, if it touches after this substep: some parted shortly before. */
static void note_contact(void *arbiter, void *data)
{
    Kernel *k = data;
    void *body_a, *body_b;
    k->engine.bodies_of(arbiter, &body_a, &body_b);
    int first = number_of(k, body_a), second = number_of(k, body_b);
    int a = MAX(first, second), b = MIN(first, second);
    if (a < 0 || find(&k->touched, b < 0 ? a : b, b < 0 ? b : a) < 0) return;
    GROW(k, k->rows, k->row_room, k->row_count + 1);
    if (!k->error) k->rows[k->row_count++] = row_of(k, arbiter, first, second);
}

/* By pair, the strongest first, then by whatever distinguishes two. */
static int by_pair(const void *a, const void *b)
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

static void note_held(Kernel *k, int a, int b, double h)
{
    GROW(k, k->helds, k->held_room, k->held_count + 1);
    if (!k->error) k->helds[k->held_count++] = (Held){a, b, h};
}

/* Notes who touches whom after a substep of h; `any`: whether anybody does. */
void note_contacts(Kernel *k, double time, double h, int any)
{
    Set *latest = &k->group->latest;
    if (!any) {
        empty(latest);
        return;
    }
    empty(&k->touched);
    for (int p = 0; p < k->pair_count; p++)
        if (k->pairs[p].gap <= 0) add(k, &k->touched, k->pairs[p].a, k->pairs[p].b);
    GROW(k, k->substeps, k->substep_room, k->substep_count + 1);
    if (k->error) return;
    k->substeps[k->substep_count++] = (Substep){time, h};
    int first = k->row_count, several = 0;
    k->engine.each_arbiter(k->group->space, note_contact, k);
    empty(&k->listed);
    for (int r = first; r < k->row_count; r++) {
        int a = k->rows[r].a, b = k->rows[r].b;
        if (add(k, &k->listed, a, b)) several = 1;
        else if (find(latest, a, b) >= 0) note_held(k, a, b, h);
    }
    /* The solver lists several contacts of a pair in the order of their addresses in memory. */
    if (several) qsort(k->rows + first, (size_t)(k->row_count - first), sizeof *k->rows, by_pair);
    exchange(latest, &k->listed);
}

/* -- after a control step --------------------------------------------------------------------- */

int mars2d_kernel_contacts(Kernel *k)
{
    empty(&k->taken);
    for (int r = 0; r < k->row_count; r++) add(k, &k->taken, k->rows[r].a, k->rows[r].b);
    GROW(k, k->sums, k->sum_room, k->taken.count);
    return k->error ? k->error : k->taken.count;
}

/* Begins a contact with the first row of its pair. */
static Contact begun(const Kernel *k, const Row *row)
{
    const Substep *substep = k->substeps + row->substep;
    Contact c = {0};
    c.a = row->a;
    c.b = row->b;
    c.point = row->point;
    c.normal = row->normal;
    c.began = find(&k->previous, row->a, row->b) < 0;
    c.ended = find(&k->groups[k->group_of[row->a]].latest, row->a, row->b) < 0;
    c.time = substep->time - (c.began ? 0.0 : substep->length);
    c.speed = c.began ? -(0.0 + dot(row->velocity, row->normal)) : 0.0; /* numpy's sums begin so */
    c.slip = row->velocity.y * row->normal.x - row->velocity.x * row->normal.y;
    return c;
}

/* By time, then by pair. */
static int by_time(const void *a, const void *b)
{
    const Contact *p = a, *q = b;
    if (p->time != q->time) return p->time < q->time ? -1 : 1;
    if (p->a != q->a) return p->a < q->a ? -1 : 1;
    return (p->b > q->b) - (p->b < q->b);
}

int mars2d_kernel_take(Kernel *k, void *memory)
{
    Contact *contacts = memory;
    int count = k->taken.count, filled = 0;
    if (count > 0) memset(k->sums, 0, (size_t)count * sizeof *k->sums);
    for (int r = 0; r < k->row_count; r++) {
        const Row *row = k->rows + r;
        int c = find(&k->taken, row->a, row->b); /* they were added in this order */
        if (c == filled) contacts[filled++] = begun(k, row);
        double x = row->impulse.x, y = row->impulse.y;
        k->sums[c].x += x;
        k->sums[c].y += y;
        contacts[c].normal_impulse += dot(row->impulse, row->normal);
        contacts[c].tangential_impulse += y * row->normal.x - x * row->normal.y;
    }
    for (int h = 0; h < k->held_count; h++)
        contacts[find(&k->taken, k->helds[h].a, k->helds[h].b)].duration += k->helds[h].length;
    for (int c = 0; c < count; c++) contacts[c].impulse = hypot(k->sums[c].x, k->sums[c].y);
    if (count > 1) qsort(contacts, (size_t)count, sizeof *contacts, by_time);
    k->row_count = k->substep_count = k->held_count = 0;
    empty(&k->previous);
    for (int g = 0; g < k->team.groups; g++) {
        const Set *latest = &k->groups[g].latest;
        for (int l = 0; l < latest->count; l++)
            add(k, &k->previous, latest->as[l], latest->links[l].b);
    }
    return k->error ? k->error : count;
}
