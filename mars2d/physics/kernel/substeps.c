/* Those that are near something, stepped finely; see `Engine._substeps` in mars2d/physics/engine.py and
   mars2d/physics/drive_joints.py. */

#include <math.h>
#include <string.h>

#include "kernel.h"

/* Presses together what touches by a rounding only, and would lose touch by another. */
static void press(Kernel *k)
{
    const Team *t = &k->team;
    for (int p = 0; p < k->pair_count; p++) {
        const Pair *pair = k->pairs + p;
        if (!(pair->gap <= 0) || !(pair->gap > -(t->pressed / 8))) continue;
        int a = pair->a, b = pair->b;
        double share = b < 0 ? 1.0 : t->mass[b] / (t->mass[a] + t->mass[b]);
        double way[2] = {share * t->pressed, (share - 1) * t->pressed};
        for (int end = 0; end < (b < 0 ? 1 : 2); end++) {
            int i = end ? b : a;
            Vector where = t->state[i].position;
            where.x += way[end] * pair->normal.x;
            where.y += way[end] * pair->normal.y;
            put(k, i, where);
        }
    }
}

/* -- how long the next substep may be --------------------------------------------------------- */

/* When its drive ends the spin of a robot that just begins to slip. */
static double time_to_brake(const Kernel *k, int i)
{
    const Team *t = &k->team;
    if (!t->slipping[i] || t->since[i] <= 0) return INFINITY;
    double spin = fabs(t->state[i].spin - k->spin[i]);
    double rim = MAX(spin * t->rim[i], t->least);
    return MAX(spin * t->moment[i] / t->torque[i], t->turned / rim);
}

/* Whether its drive can't bring a robot back to its command within h. */
static uint8_t out_of_reach(const Kernel *k, int i, double h)
{
    const Team *t = &k->team;
    const State *s = t->state + i;
    Vector aim = chord(k, i, s->angle, h);
    double impulse = hypot(fabs(s->velocity.x - aim.x), fabs(s->velocity.y - aim.y)) * t->mass[i];
    double spin = fabs(s->spin - k->spin[i]) * t->moment[i];
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

/* Marks those that slip: what touches or is pulled does, and what its drive can't bring back. Returns
   how long a substep may be for them, at most h. */
static double longest_contact_step(Kernel *k, double h)
{
    Team *t = &k->team;
    int any = 0;
    for (int w = 0; w < k->near_count; w++) {
        int i = k->who[w];
        if (k->touching[w] || t->pulled[i]) t->slipping[i] = 1;
        any |= t->slipping[i];
    }
    if (!any) return h;
    h = MIN(h, t->contact_step);
    h = MIN(h, t->growth * k->group->last_step);
    for (int w = 0; w < k->near_count; w++) {
        double brake = time_to_brake(k, k->who[w]);
        if (brake < h) h = brake;
    }
    for (int w = 0; w < k->near_count; w++) {
        int i = k->who[w];
        if (t->slipping[i] && !k->touching[w] && !t->pulled[i])
            t->slipping[i] = out_of_reach(k, i, h);
    }
    return h;
}

/* Works out how those that are near move, and how quickly that may turn; see `Driven.motion`. */
static void set_motion(Kernel *k)
{
    const Team *t = &k->team;
    for (int w = 0; w < k->near_count; w++) {
        int i = k->who[w];
        int follows = !t->slipping[i], curved = follows && t->in_robot_frame[i];
        k->velocity[w] = follows ? chord(k, i, t->state[i].angle, 0.0) : t->state[i].velocity;
        k->bend[w] = curved ? fabs(hypot(k->forward[i], k->left[i]) * k->spin[i]) : 0.0;
    }
}

/* Works out how those that are near move, who slips, and how long the next substep may be. */
static double look_ahead(Kernel *k, double left)
{
    double h = longest_contact_step(k, left);
    set_motion(k);
    double touch = time_to_touch(k);
    h = MIN(h, touch);
    return left / ceil(left / h - 1e-9); /* equal ones settle best, without a sliver */
}

/* -- one substep ------------------------------------------------------------------------------ */

/* Lets what pulls at robot i from outside act in the substep that follows. */
static void pull(Kernel *k, int i)
{
    k->engine.set_force(k->team.body[i], k->team.pull[i].force);
    k->engine.set_torque(k->team.body[i], k->team.pull[i].torque);
}

/* Prepares those that are near for a substep of h. */
static void aim(Kernel *k, double h)
{
    Team *t = &k->team;
    int brief = h <= t->contact_step, any = 0;
    for (int w = 0; w < k->near_count; w++) {
        int i = k->who[w], slips = t->slipping[i];
        const State *s = t->state + i;
        any |= slips;
        if (t->pulled[i]) pull(k, i);
        k->aimed[i] = slips ? s->velocity : chord(k, i, s->angle, h);
        k->aimed_spin[i] = slips ? s->spin : k->spin[i];
        t->since[i] = slips ? 0 : t->since[i] + 1;
        k->wanted[i] = slips || (brief && t->since[i] <= t->linger);
        if (!k->wanted[i]) continue;
        k->aimed[t->n + i] = chord(k, i, s->angle + k->aimed_spin[i] * h, h);
        k->aimed_spin[t->n + i] = k->spin[i];
    }
    for (int w = 0; w < k->near_count; w++)
        if (k->wanted[k->who[w]] && !t->engaged[k->who[w]]) engage(k, k->who[w]);
    for (int w = 0; w < k->near_count; w++)
        if (t->engaged[k->who[w]] && !k->wanted[k->who[w]]) disengage(k, k->who[w]);
    if (!any || !(t->growth * h < k->group->last_step)) return;
    for (int w = 0; w < k->near_count; w++)
        if (t->slipping[k->who[w]]) renew(k, k->who[w]);
}

/* Notes how much of their bounds drives have used in the last substep; see `Space.effort`. */
static void note_effort(Kernel *k)
{
    Team *t = &k->team;
    for (int w = 0; w < k->near_count; w++) {
        int i = k->who[w];
        if (!t->slipping[i]) continue;
        double push = k->engine.get_impulse(t->pivot[i]) / (t->force[i] * k->group->last_step);
        double turn = k->engine.get_impulse(t->gear[i]) / (t->torque[i] * k->group->last_step);
        double most = MAX(push, turn);
        t->effort[i] = MAX(t->effort[i], most);
    }
}

/* Adds to their paths how far those that are near will go; returns the longest. */
static double add_paths(Kernel *k, double h)
{
    double furthest = 0.0;
    for (int w = 0; w < k->near_count; w++) {
        k->gone[w] += h * hypot(k->velocity[w].x, k->velocity[w].y);
        furthest = MAX(furthest, k->gone[w]);
    }
    return furthest;
}

/* Steps through `duration` as finely as those need that are near, until one would have gone further
   than `path`; returns the seconds gone. */
double substeps(Kernel *k, double duration, double time, double path)
{
    double elapsed = 0.0, h = 0.0;
    memset(k->gone, 0, (size_t)k->near_count * sizeof *k->gone);
    for (;;) {
        int any = measure(k);
        if (elapsed > 0) note_contacts(k, time + elapsed, h, any);
        if (k->error || elapsed >= duration) return elapsed;
        if (any) press(k);
        double left = duration - elapsed;
        h = look_ahead(k, left);
        if (!(elapsed + h > elapsed)) k->error = MARS2D_LOST;
        if (++k->substep % 256 == 0 && k->interrupted()) k->error = MARS2D_INTERRUPTED;
        if (k->error) return elapsed;
        if (add_paths(k, h) > path && elapsed > 0) {
            read_state(k, 1);
            return elapsed;
        }
        aim(k, h);
        space_step(k, h, elapsed == 0);
        elapsed = h == left ? duration : elapsed + h;
        read_state(k, elapsed >= duration);
        note_effort(k);
    }
}
