/* Groups of a large team: robots that may touch each other are in the same one. */

#include <math.h>
#include <stdlib.h>

#include "kernel.h"

/* -- who is in which -------------------------------------------------------------------------- */

static void enter(Kernel *k, int i, int to)
{
    Group *group = k->groups + to;
    GROW(k, group->members, group->room, group->count + 1);
    if (k->error) return;
    k->group_of[i] = to;
    k->member[i] = group->count;
    group->members[group->count++] = i;
}

static void leave(Kernel *k, int i)
{
    Group *group = k->groups + k->group_of[i];
    int last = group->members[--group->count];
    group->members[k->member[i]] = last;
    k->member[last] = k->member[i];
}

/* Moves a robot with all that it has into another group. */
static void move(Kernel *k, int i, int to)
{
    const Engine *e = &k->engine;
    Group *old = k->groups + k->group_of[i], *new = k->groups + to;
    void *body = k->team.body[i];
    if (k->team.engaged[i]) remove_joints(k, i);
    e->remove_shape(old->space, k->disc[i]);
    e->remove_body(old->space, body);
    for (int l = old->latest.head[i]; l >= 0; l = old->latest.links[l].next)
        add(k, &new->latest, i, old->latest.links[l].b);
    leave(k, i);
    enter(k, i, to);
    e->add_body(k->groups[k->group_of[i]].space, body);
    e->add_shape(k->groups[k->group_of[i]].space, k->disc[i]);
    if (!k->team.engaged[i]) return;
    make_joints(k, i); /* what they did was for steps of another length */
    add_joints(k, i);
}

/* A robot and one of its coordinates, to be sorted by it. */
typedef struct { double at; int robot; } Mark;

static int by_place(const void *a, const void *b)
{
    const Mark *p = a, *q = b;
    if (p->at != q->at) return p->at < q->at ? -1 : 1;
    return (p->robot > q->robot) - (p->robot < q->robot);
}

/* Of `count` things in a row, where the `part`th of so many parts begins. */
static int begin(int count, int part, int parts) { return (int)((int64_t)count * part / parts); }

/* Puts neighbours into one group: bands by y, and in each band parts by x. */
void assign_groups(Kernel *k)
{
    const Team *t = &k->team;
    int bands = (int)sqrt((double)t->groups);
    Mark *marks;
    ZEROED(k, marks, (size_t)t->n);
    for (int i = 0; i < t->n && !k->error; i++) marks[i] = (Mark){t->state[i].position.y, i};
    if (!k->error) qsort(marks, (size_t)t->n, sizeof *marks, by_place);
    for (int band = 0; band < bands && !k->error; band++) {
        int low = begin(t->n, band, bands), count = begin(t->n, band + 1, bands) - low;
        int first = begin(t->groups, band, bands), parts = begin(t->groups, band + 1, bands) - first;
        for (int m = low; m < low + count; m++) marks[m].at = t->state[marks[m].robot].position.x;
        qsort(marks + low, (size_t)count, sizeof *marks, by_place);
        for (int m = 0; m < count; m++) enter(k, marks[low + m].robot, first + begin(parts, m, count));
    }
    free(marks);
}

int mars2d_kernel_group_size(const Kernel *k, int group) { return k->groups[group].count; }

/* -- at each control step --------------------------------------------------------------------- */

/* The robot with the smallest number of those that may touch i, or each other's others. */
static int root(Kernel *k, int i)
{
    while (k->parent[i] != i) i = k->parent[i] = k->parent[k->parent[i]];
    return i;
}

/* Brings robots that may touch each other into one group, the smallest of theirs. */
void join_groups(Kernel *k)
{
    const Team *t = &k->team;
    for (int i = 0; i < t->n; i++) k->parent[i] = i;
    for (int p = 0; p < k->found_count; p++) {
        if (k->found[p].segment >= 0) continue;
        int a = root(k, k->found[p].a), b = root(k, k->found[p].b);
        k->parent[MAX(a, b)] = MIN(a, b);
    }
    for (int i = 0; i < t->n; i++) { /* roots come first, since their numbers are smallest */
        int r = root(k, i), mine = k->group_of[i];
        if (r == i || k->groups[mine].count < k->groups[k->target[r]].count) k->target[r] = mine;
    }
    for (int i = 0; i < t->n && !k->error; i++) {
        int target = k->target[root(k, i)];
        if (target != k->group_of[i]) move(k, i, target);
    }
}

/* Puts those that are near, and their pairs, in the order of their groups. */
void order_by_groups(Kernel *k)
{
    const Team *t = &k->team;
    GROW(k, k->ordered, k->ordered_room, k->found_count);
    if (k->error) return;
    for (int g = 0; g < t->groups; g++) k->groups[g].near_count = k->groups[g].pair_count = 0;
    for (int i = 0; i < t->n; i++)
        if (k->near[i]) k->place[i] = k->groups[k->group_of[i]].near_count++;
    for (int p = 0; p < k->found_count; p++) k->groups[k->group_of[k->found[p].a]].pair_count++;
    for (int g = 0, nears = 0, pairs = 0; g < t->groups; g++) {
        Group *group = k->groups + g;
        group->first_near = nears;
        group->first_pair = pairs;
        nears += group->near_count;
        pairs += group->pair_count;
        group->pair_count = 0;
    }
    for (int i = 0; i < t->n; i++)
        if (k->near[i]) k->nears[k->groups[k->group_of[i]].first_near + k->place[i]] = i;
    for (int p = 0; p < k->found_count; p++) {
        Pair pair = k->found[p];
        Group *group = k->groups + k->group_of[pair.a];
        pair.i = k->place[pair.a];
        pair.j = pair.segment < 0 ? k->place[pair.b] : -1;
        k->ordered[group->first_pair + group->pair_count++] = pair;
    }
}
