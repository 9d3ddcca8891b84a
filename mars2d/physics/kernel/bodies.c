/* The engine's bodies and joints, written and read; see mars2d/physics/space.py. */

#include <string.h>

#include "kernel.h"

/* Puts a robot somewhere; see `Space.place`. */
void put(Kernel *k, int i, Vector where)
{
    k->team.state[i].position = where;
    k->team.placed[i] = 1;
    k->engine.set_position(k->team.body[i], where);
}

/* Reads where bodies are and how they move, of all or of those that are near: the others are carried
   along, and nobody asks meanwhile. */
void read_state(Kernel *k, int all)
{
    const Team *t = &k->team;
    const Engine *e = &k->engine;
    int count = all ? k->group->count : k->near_count;
    const int *which = all ? k->group->members : k->who;
    for (int c = 0; c < count; c++) {
        int i = which[c];
        void *body = t->body[i];
        State *s = t->state + i;
        s->position = e->get_position(body);
        s->angle = e->get_angle(body);
        s->velocity = e->get_velocity(body);
        s->spin = e->get_spin(body);
    }
}

/* -- joints ----------------------------------------------------------------------------------- */

void add_joints(Kernel *k, int i)
{
    void *space = k->groups[k->group_of[i]].space;
    k->engine.add_constraint(space, k->team.pivot[i]);
    k->engine.add_constraint(space, k->team.gear[i]);
}

void remove_joints(Kernel *k, int i)
{
    void *space = k->groups[k->group_of[i]].space;
    k->engine.remove_constraint(space, k->team.pivot[i]);
    k->engine.remove_constraint(space, k->team.gear[i]);
}

/* Makes joints, which are in no space now, as if they had not held anything yet; see
   `Space._joint_pair`. */
void make_joints(Kernel *k, int i)
{
    const Team *t = &k->team;
    const Engine *e = &k->engine;
    Vector zero = {0.0, 0.0};
    e->init_pivot(t->pivot[i], t->control[i], t->body[i], zero, zero);
    e->init_gear(t->gear[i], t->control[i], t->body[i], 0.0, 1.0);
    e->set_max_bias(t->pivot[i], 0.0);
    e->set_max_bias(t->gear[i], 0.0);
    e->set_max_force(t->pivot[i], t->force[i]);
    e->set_max_force(t->gear[i], t->torque[i]);
}

/* Lets a drive act; see `Space.engage`. */
void engage(Kernel *k, int i)
{
    make_joints(k, i);
    add_joints(k, i);
    k->team.engaged[i] = 1;
}

void disengage(Kernel *k, int i)
{
    remove_joints(k, i);
    k->team.engaged[i] = 0;
}

/* Lets a drive that acts begin anew; see `Space.renew`. */
void renew(Kernel *k, int i)
{
    remove_joints(k, i);
    make_joints(k, i);
    add_joints(k, i);
}

/* -- steps ------------------------------------------------------------------------------------ */

typedef struct { const Team *team; double ratio; } Scale;

/* Scales the impulses that the solver keeps of a contact; see `Space._scale_contacts`. */
static void scale_contact(void *arbiter, void *data)
{
    const Scale *scale = data;
    const Team *t = scale->team;
    const char *memory = arbiter;
    int32_t state, count;
    char *contact;
    memcpy(&state, memory + t->arbiter_state, sizeof state);
    memcpy(&count, memory + t->arbiter_count, sizeof count);
    memcpy(&contact, memory + t->arbiter_contacts, sizeof contact);
    if (state != 0 && state != 1) return; /* neither just begun nor going on */
    for (; count > 0; count--, contact += t->contact_size) {
        double kept[2];
        memcpy(kept, contact + t->contact_normal, sizeof *kept);
        memcpy(kept + 1, contact + t->contact_tangent, sizeof *kept);
        kept[0] *= scale->ratio;
        kept[1] *= scale->ratio;
        memcpy(contact + t->contact_normal, kept, sizeof *kept);
        memcpy(contact + t->contact_tangent, kept + 1, sizeof *kept);
    }
}

static void set_velocity(Kernel *k, void *body, int aimed)
{
    k->engine.set_velocity(body, k->aimed[aimed]);
    k->engine.set_spin(body, k->aimed_spin[aimed]);
}

/* Lets the engine step, with velocities set anew of all, or of those that are near; see
   `Space.step`. */
void space_step(Kernel *k, double h, int all)
{
    const Team *t = &k->team;
    Group *group = k->group;
    if (h != group->last_step) {
        Scale scale = {t, h / group->last_step};
        k->engine.each_arbiter(group->space, scale_contact, &scale);
        group->last_step = h;
    }
    k->engine.set_time_step(group->space, h);
    int count = all ? group->count : k->near_count;
    const int *which = all ? group->members : k->who;
    for (int c = 0; c < count; c++) {
        int i = which[c];
        t->placed[i] = 0;
        set_velocity(k, t->body[i], i);
        if (t->engaged[i]) set_velocity(k, t->control[i], t->n + i);
    }
    k->engine.step(group->space, h);
}
