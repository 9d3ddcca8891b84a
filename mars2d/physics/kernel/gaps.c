/* How near discs are to each other and to walls; see mars2d/geometry/pair_list.py. */

#include <math.h>

#include "kernel.h"

/* The vector from a point to the nearest point of a segment. */
Vector towards(const Team *t, int segment, Vector point)
{
    Vector start = t->start[segment], edge = t->edge[segment];
    Vector from = {point.x - start.x, point.y - start.y};
    double along = dot(from, t->per_length[segment]);
    along = along < 0.0 ? 0.0 : along > 1.0 ? 1.0 : along;
    return (Vector){along * edge.x - from.x, along * edge.y - from.y};
}

/* Whether x, y are plainly further away than `far`: that spares most of the roots. */
int beyond(double x, double y, double far)
{
    return x * x + y * y > far * far * (1 + 1e-9);
}

/* Whether the gap between two robots is no wider than `reach`. */
int within(const Team *t, int i, int j, double reach)
{
    Vector a = t->state[i].position, b = t->state[j].position;
    double x = a.x - b.x, y = a.y - b.y, r = t->radius[i], s = t->radius[j];
    return !beyond(x, y, r + s + reach) && hypot(x, y) - r - s <= reach;
}

/* Whether the gap between a robot and a segment is no wider than `reach`. */
int wall_within(const Team *t, int i, int segment, double reach)
{
    Vector way = towards(t, segment, t->state[i].position);
    double r = t->radius[i];
    return !beyond(way.x, way.y, r + reach) && hypot(way.x, way.y) - r <= reach;
}
