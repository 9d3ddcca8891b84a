/* The control step's motion of a team of discs among walls: what mars2d/physics/engine.py does for any world,
   done here for this one kind without a detour through arrays. The Python files named at the top of
   each file say what is done and why. */

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kernel.h"

/* -- the control step ------------------------------------------------------------------------- */

/* Takes the drives of those off that touch nothing, and aims them at the ends of their arcs; see
   `DriveJoints.release` and `Engine._carry`. */
static void carry(Kernel *k, double duration)
{
    Team *t = &k->team;
    for (int i = 0; i < t->n; i++) {
        if (k->near[i]) continue; /* see `aim` */
        if (t->engaged[i]) disengage(k, i);
        t->since[i] = t->linger + 1;
        k->aimed[i] = chord(k, i, t->state[i].angle, duration);
        k->aimed_spin[i] = k->spin[i];
    }
}

/* Puts those of a group that were carried where they are after `gone` seconds: they were on the chord
   of a longer time; see `Engine._arrive`. */
static void arrive(Kernel *k, double gone)
{
    for (int m = 0; m < k->group->count; m++) {
        int i = k->group->members[m];
        if (k->near[i]) continue;
        const State *before = k->before + i;
        Vector way = chord(k, i, before->angle, gone), where = before->position;
        where.x += gone * way.x;
        where.y += gone * way.y;
        put(k, i, where);
    }
}

/* Lets one group go on by at most `duration`; returns by how much. */
static double advance_group(Kernel *k, double duration, double time, double path)
{
    Group *group = k->group;
    k->who = k->nears + group->first_near;
    k->near_count = group->near_count;
    k->pairs = k->ordered + group->first_pair;
    k->pair_count = group->pair_count;
    if (k->near_count == 0) {
        space_step(k, duration, 1);
        read_state(k, 1);
        empty(&group->latest);
        return duration;
    }
    double gone = substeps(k, duration, time, path);
    if (!k->error && gone < duration) arrive(k, gone);
    return gone;
}

/* Goes on by at most `duration`; returns by how much; see `Engine._advance`. Several groups always go
   all the way: none can wait for another one whose robot was thrown further than was thought. */
static double advance(Kernel *k, double duration, double time)
{
    const Team *t = &k->team;
    double path = find_near(k, duration), gone = duration;
    if (k->error) return 0.0;
    carry(k, duration);
    find_pairs(k, path + t->max_overlap);
    if (t->groups > 1) {
        join_groups(k);
        path = INFINITY;
    }
    order_by_groups(k);
    memcpy(k->before, t->state, (size_t)t->n * sizeof *k->before);
    for (int g = 0; g < t->groups && !k->error; g++) {
        k->group = k->groups + g;
        gone = advance_group(k, duration, time, path);
    }
    return gone;
}

/* What is left for Python to fetch. */
static int left_over(const Kernel *k)
{
    const Team *t = &k->team;
    /* What touched before is to be told apart from what begins to touch next time. */
    int what = k->row_count > 0 || k->previous.count > 0 ? MARS2D_CONTACTS : 0;
    for (int i = 0; i < t->n; i++) {
        if (t->placed[i]) what |= MARS2D_PLACED;
        if (t->effort[i] > 0) what |= MARS2D_EFFORT;
    }
    return what;
}

int mars2d_kernel_drive(Kernel *k, const double *twist, double duration, double time)
{
    double elapsed = 0.0;
    k->forward = twist;
    k->left = twist + k->team.n;
    k->spin = k->left + k->team.n;
    while (elapsed < duration && !k->error) {
        double left = duration - elapsed, gone = advance(k, left, time + elapsed);
        double reached = gone == left ? duration : elapsed + gone;
        if (!(reached > elapsed) && !k->error) k->error = MARS2D_LOST;
        elapsed = reached;
    }
    return k->error ? k->error : left_over(k);
}

/* -- making and freeing ----------------------------------------------------------------------- */

void mars2d_kernel_free(Kernel *k)
{
    if (k == NULL) return;
    free_spaces(k);
    void *memory[] = {k->near, k->wanted, k->group_of, k->member, k->place, k->parent, k->target,
                      k->disc, k->speed, k->before, k->aimed, k->aimed_spin,
                      k->nears, k->found, k->ordered, k->touching, k->velocity, k->bend, k->gone,
                      k->first_robot, k->robots, k->first_wall, k->walls,
                      k->cells, k->cell, k->next, k->hits,
                      k->rows, k->substeps, k->helds, k->sums};
    for (size_t m = 0; m < sizeof memory / sizeof *memory; m++) free(memory[m]);
    Set *sets[] = {&k->touched, &k->previous, &k->listed, &k->taken};
    for (size_t s = 0; s < sizeof sets / sizeof *sets; s++) free_set(sets[s]);
    free(k);
}

Kernel *mars2d_kernel_new(const Team *team, const Engine *engine, Interrupted interrupted)
{
    Kernel *k = calloc(1, sizeof *k);
    if (k == NULL) return NULL;
    k->team = *team;
    k->engine = *engine;
    k->interrupted = interrupted;
    k->team.skin = -1.0; /* so that the list is made at the first question */
    size_t n = (size_t)team->n;
    ZEROED(k, k->near, n);
    ZEROED(k, k->wanted, n);
    ZEROED(k, k->group_of, n);
    ZEROED(k, k->member, n);
    ZEROED(k, k->place, n);
    ZEROED(k, k->parent, n);
    ZEROED(k, k->target, n);
    ZEROED(k, k->speed, n);
    ZEROED(k, k->before, n);
    ZEROED(k, k->aimed, 2 * n);
    ZEROED(k, k->aimed_spin, 2 * n);
    ZEROED(k, k->nears, n);
    ZEROED(k, k->touching, n);
    ZEROED(k, k->velocity, n);
    ZEROED(k, k->bend, n);
    ZEROED(k, k->gone, n);
    ZEROED(k, k->first_robot, n + 1);
    ZEROED(k, k->first_wall, n + 1);
    ZEROED(k, k->cell, n);
    ZEROED(k, k->next, n);
    make_set(k, &k->touched, team->n);
    make_set(k, &k->previous, team->n);
    make_set(k, &k->listed, team->n);
    make_set(k, &k->taken, team->n);
    k->wide = 3 + (int)sqrt(4.0 * team->n); /* some four cells a robot */
    ZEROED(k, k->cells, (size_t)k->wide * (size_t)k->wide);
    if (!k->error) make_spaces(k);
    if (k->error) {
        mars2d_kernel_free(k);
        return NULL;
    }
    return k;
}
