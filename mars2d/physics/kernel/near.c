/* Who is near something and what may touch; see `Engine._find_near` in mars2d/physics/engine.py, `Clearance`
   and `DiscPairs` in mars2d/geometry/pair_list.py. */

#include <math.h>
#include <string.h>

#include "kernel.h"

/* The gap between a robot and the nearest of the segments that are listed for it. */
static double wall_gap(const Kernel *k, int i)
{
    const Team *t = &k->team;
    double least = INFINITY, r = t->radius[i];
    for (int w = k->first_wall[i]; w < k->first_wall[i + 1]; w++) {
        Vector way = towards(t, k->walls[w], t->state[i].position);
        if (beyond(way.x, way.y, r + least)) continue;
        double gap = hypot(way.x, way.y) - r;
        if (gap < least) least = gap;
    }
    return least;
}

/* Marks what may touch something while each robot moves by at most its reach. */
static void may_touch(Kernel *k)
{
    Team *t = &k->team;
    int i = 0;
    while (i < t->n && !(t->moved[i] + t->reach[i] > t->skin)) i++;
    if (i < t->n) list_anew(k);
    if (k->error) return;
    for (i = 0; i < t->n; i++)
        for (int p = k->first_robot[i]; p < k->first_robot[i + 1]; p++) {
            int j = k->robots[p];
            if (k->near[i] && k->near[j]) continue;
            if (within(t, i, j, t->reach[i] + t->reach[j])) k->near[i] = k->near[j] = 1;
        }
    for (i = 0; i < t->n; i++) {
        if (!(t->wall_gap[i] <= t->reach[i])) continue;
        double gap = wall_gap(k, i);
        if (gap <= t->reach[i]) k->near[i] = 1;
        t->wall_gap[i] = MIN(gap, t->skin - t->moved[i]); /* others are not listed */
    }
}

/* Works out how fast each robot may be, and marks those that slip. */
static void begin_with_slipping(Kernel *k)
{
    const Team *t = &k->team;
    for (int i = 0; i < t->n; i++) {
        k->near[i] = t->slipping[i];
        k->speed[i] = hypot(k->forward[i], k->left[i]);
        if (!k->near[i]) continue;
        double moves = hypot(t->state[i].velocity.x, t->state[i].velocity.y);
        k->speed[i] = MAX(k->speed[i], moves);
    }
}

/* How many are near; `fastest`, m/s, is set if any is. */
static int count_near(const Kernel *k, double *fastest)
{
    int count = 0;
    double most = -1.0;
    for (int i = 0; i < k->team.n; i++)
        if (k->near[i]) {
            count++;
            most = MAX(most, k->speed[i]);
        }
    if (count > 0) *fastest = most;
    return count;
}

/* Marks those that may touch something within `duration`. Returns the longest path that one of them
   may take. */
double find_near(Kernel *k, double duration)
{
    Team *t = &k->team;
    double path = 0.0, fastest = 0.0;
    begin_with_slipping(k);
    for (int now = count_near(k, &fastest), count = -1; now != count && !k->error;) {
        count = now;
        if (now > 0) path = t->slack * fastest * duration;
        for (int i = 0; i < t->n; i++)
            t->reach[i] = k->near[i] ? path + t->max_overlap : k->speed[i] * duration;
        may_touch(k);
        now = count_near(k, &fastest);
    }
    for (int i = 0; i < t->n; i++) {
        t->moved[i] += t->reach[i];
        t->wall_gap[i] -= t->reach[i];
    }
    return path;
}

static void list_pair(Kernel *k, int a, int b, int segment, double radii)
{
    GROW(k, k->found, k->found_room, k->found_count + 1);
    if (!k->error) k->found[k->found_count++] = (Pair){-1, -1, segment, a, b, radii, 0.0, {0.0, 0.0}};
}

/* Finds what may touch among those that are near, each moving by at most `reach`. */
void find_pairs(Kernel *k, double reach)
{
    const Team *t = &k->team;
    k->found_count = 0;
    for (int a = 0; a < t->n; a++)
        for (int p = k->first_robot[a]; k->near[a] && p < k->first_robot[a + 1]; p++) {
            int b = k->robots[p];
            if (k->near[b] && within(t, a, b, 2 * reach))
                list_pair(k, a, b, -1, t->radius[a] + t->radius[b]);
        }
    for (int a = 0; a < t->n; a++) {
        if (!k->near[a] || t->wall_gap[a] > 0) continue;
        for (int w = k->first_wall[a]; w < k->first_wall[a + 1]; w++) {
            int s = k->walls[w];
            if (wall_within(t, a, s, reach)) list_pair(k, a, -1 - t->obstacle[s], s, t->radius[a]);
        }
    }
}

/* Measures the gaps of the pairs. Returns whether any touch, and marks the robots that do. */
int measure(Kernel *k)
{
    const Team *t = &k->team;
    int any = 0;
    memset(k->touching, 0, (size_t)k->near_count);
    for (int p = 0; p < k->pair_count; p++) {
        Pair *pair = k->pairs + p;
        Vector here = t->state[pair->a].position, between;
        if (pair->j < 0) between = towards(t, pair->segment, here);
        else {
            Vector there = t->state[pair->b].position;
            between = (Vector){there.x - here.x, there.y - here.y};
        }
        double distance = hypot(between.x, between.y);
        double scale = 1.0 / MAX(distance, t->tiny);
        pair->gap = distance - pair->radii;
        pair->normal = (Vector){between.x * scale, between.y * scale};
        if (pair->gap <= 0) {
            any = k->touching[pair->i] = 1;
            if (pair->j >= 0) k->touching[pair->j] = 1;
        }
    }
    return any;
}
