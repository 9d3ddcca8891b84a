/* The spaces that a team is stepped in: pymunk's for a small one; for a large one spaces of the kernel's
   own, one a group, with all walls in each. What is built is what mars2d/physics/space.py builds. */

#include <stdlib.h>

#include "kernel.h"

/* Adds the segment of a wall to a group's space. first: that of its obstacle. */
static void add_wall(Kernel *k, Group *group, int segment, int first)
{
    const Team *t = &k->team;
    const Engine *e = &k->engine;
    if (first == segment) {
        group->grounds[first] = e->new_static();
        e->set_data(group->grounds[first], (void *)(intptr_t)(-1 - t->obstacle[segment]));
        e->add_body(group->space, group->grounds[first]);
    }
    Vector a = t->start[segment], b = {a.x + t->edge[segment].x, a.y + t->edge[segment].y};
    void *wall = group->walls[segment] = e->new_segment(group->grounds[first], a, b, 0.0);
    e->set_friction(wall, t->wall_friction[segment]);
    e->set_elasticity(wall, t->wall_restitution[segment]);
    e->add_shape(group->space, wall);
}

static void add_robot(Kernel *k, int i)
{
    Team *t = &k->team;
    const Engine *e = &k->engine;
    const State *s = t->state + i;
    Group *group = k->groups + k->group_of[i];
    void *body = t->body[i] = e->new_body(t->mass[i], t->moment[i]);
    e->set_data(body, (void *)(intptr_t)i);
    e->set_position(body, s->position);
    e->set_angle(body, s->angle);
    e->set_velocity(body, s->velocity);
    e->set_spin(body, s->spin);
    t->control[i] = e->new_kinematic();
    t->pivot[i] = e->alloc_pivot();
    t->gear[i] = e->alloc_gear();
    make_joints(k, i);
    void *disc = k->disc[i] = e->new_circle(body, t->radius[i], (Vector){0.0, 0.0});
    e->set_friction(disc, t->friction[i]);
    e->set_elasticity(disc, t->restitution[i]);
    e->add_body(group->space, body);
    e->add_shape(group->space, disc);
}

static void make_own_spaces(Kernel *k)
{
    Team *t = &k->team;
    size_t n = (size_t)t->n, segments = (size_t)t->segments;
    t->body = t->control = t->pivot = t->gear = NULL;
    ZEROED(k, t->body, n);
    ZEROED(k, t->control, n);
    ZEROED(k, t->pivot, n);
    ZEROED(k, t->gear, n);
    ZEROED(k, k->disc, n);
    if (!k->error) assign_groups(k);
    for (int g = 0; g < t->groups && !k->error; g++) {
        Group *group = k->groups + g;
        ZEROED(k, group->walls, segments);
        ZEROED(k, group->grounds, segments);
        if (k->error) return;
        group->space = k->engine.new_space();
        k->engine.set_iterations(group->space, t->iterations);
        k->engine.set_slop(group->space, t->slop);
        for (int s = 0, first = 0; s < t->segments; s++) {
            if (t->obstacle[s] != t->obstacle[first]) first = s;
            add_wall(k, group, s, first);
        }
    }
    for (int i = 0; i < t->n && !k->error; i++) add_robot(k, i);
}

void make_spaces(Kernel *k)
{
    const Team *t = &k->team;
    ZEROED(k, k->groups, (size_t)t->groups);
    for (int g = 0; g < t->groups && !k->error; g++) {
        k->groups[g].last_step = t->last_step;
        make_set(k, &k->groups[g].latest, t->n);
    }
    if (k->error) return;
    if (t->groups > 1) make_own_spaces(k);
    else {
        k->groups[0].space = t->space;
        assign_groups(k);
    }
}

/* -- freeing ---------------------------------------------------------------------------------- */

static void free_robot(Kernel *k, int i)
{
    const Team *t = &k->team;
    const Engine *e = &k->engine;
    void *space = k->groups[k->group_of[i]].space;
    if (t->engaged[i]) remove_joints(k, i);
    e->remove_shape(space, k->disc[i]);
    e->remove_body(space, t->body[i]);
    e->free_shape(k->disc[i]);
    e->free_joint(t->pivot[i]);
    e->free_joint(t->gear[i]);
    e->free_body(t->control[i]);
    e->free_body(t->body[i]);
}

static void free_walls(Kernel *k, Group *group)
{
    const Engine *e = &k->engine;
    for (int s = 0; s < k->team.segments; s++)
        if (group->walls[s] != NULL) {
            e->remove_shape(group->space, group->walls[s]);
            e->free_shape(group->walls[s]);
        }
    for (int s = 0; s < k->team.segments; s++)
        if (group->grounds[s] != NULL) {
            e->remove_body(group->space, group->grounds[s]);
            e->free_body(group->grounds[s]);
        }
    e->free_space(group->space);
}

static void free_own_spaces(Kernel *k)
{
    Team *t = &k->team;
    for (int i = 0; i < t->n && k->disc != NULL; i++)
        if (k->disc[i] != NULL) free_robot(k, i);
    for (int g = 0; g < t->groups; g++) {
        if (k->groups[g].space != NULL) free_walls(k, k->groups + g);
        free(k->groups[g].walls);
        free(k->groups[g].grounds);
    }
    if (k->disc == NULL) return; /* else those of Python are in their places */
    free(t->body);
    free(t->control);
    free(t->pivot);
    free(t->gear);
}

void free_spaces(Kernel *k)
{
    if (k->groups == NULL) return;
    if (k->team.groups > 1) free_own_spaces(k);
    for (int g = 0; g < k->team.groups; g++) {
        free(k->groups[g].members);
        free_set(&k->groups[g].latest);
    }
    free(k->groups);
}
