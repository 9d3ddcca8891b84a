/* The Verlet list: what is within each robot's skin, so that nothing else need be asked until one may
   have moved by it. `Clearance` in mars2d/geometry/pair_list.py finds it by a k-d tree, and does not list walls;
   here robots are sorted into cells. */

#include <math.h>
#include <stdlib.h>

#include "kernel.h"

/* -- cells ------------------------------------------------------------------------------------ */

/* The column, or row, of cells that x is in. They are those of a torus: what lies further out is
   wrapped round it, so that there are few cells however far apart robots are. */
static int column_of(const Kernel *k, double x)
{
    double column = fmod(floor(x / k->size), k->wide);
    if (column < 0) column += k->wide;
    return column > 0 && column < k->wide ? (int)column : 0;
}

static int after(const Kernel *k, int column) { return column + 1 < k->wide ? column + 1 : 0; }

static int before(const Kernel *k, int column) { return column > 0 ? column - 1 : k->wide - 1; }

/* Sorts the robots into cells of this size, so that each cell's list ascends. */
static void fill_cells(Kernel *k, double size)
{
    k->size = size;
    for (int c = 0; c < k->wide * k->wide; c++) k->cells[c] = -1;
    for (int i = k->team.n - 1; i >= 0; i--) {
        Vector where = k->team.state[i].position;
        int c = k->cell[i] = column_of(k, where.y) * k->wide + column_of(k, where.x);
        k->next[i] = k->cells[c];
        k->cells[c] = i;
    }
}

/* -- robots ----------------------------------------------------------------------------------- */

static void list_robot(Kernel *k, int j)
{
    GROW(k, k->robots, k->robot_room, k->robot_count + 1);
    if (!k->error) k->robots[k->robot_count++] = j;
}

static int by_number(const void *a, const void *b)
{
    int x = *(const int *)a, y = *(const int *)b;
    return (x > y) - (x < y);
}

/* Lists for robot i those with larger numbers within `cutoff`, no more than the size of a cell, in
   their order. */
static void list_neighbours(Kernel *k, int i, double cutoff)
{
    Vector here = k->team.state[i].position;
    int first = k->robot_count, row = k->cell[i] / k->wide, column = k->cell[i] % k->wide;
    int rows[3] = {before(k, row), row, after(k, row)};
    int columns[3] = {before(k, column), column, after(k, column)};
    for (int v = 0; v < 3; v++)
        for (int u = 0; u < 3; u++)
            for (int j = k->cells[rows[v] * k->wide + columns[u]]; j >= 0; j = k->next[j]) {
                Vector there = k->team.state[j].position;
                if (j > i && !beyond(here.x - there.x, here.y - there.y, cutoff)) list_robot(k, j);
            }
    size_t count = (size_t)(k->robot_count - first);
    if (count > 1) qsort(k->robots + first, count, sizeof *k->robots, by_number);
}

/* -- walls ------------------------------------------------------------------------------------ */

static void hit(Kernel *k, int i, int segment)
{
    if (!wall_within(&k->team, i, segment, k->team.skin)) return;
    GROW(k, k->hits, k->hit_room, k->hit_count + 1);
    if (!k->error) k->hits[k->hit_count++] = (Hit){i, segment};
}

/* How many columns, or rows, hold what lies from `low` to `high`. */
static int columns_in(const Kernel *k, double low, double high)
{
    double count = floor(high / k->size) - floor(low / k->size) + 1;
    return count < k->wide ? (int)count : k->wide;
}

/* Finds the robots in whose skins a segment is: they are in the cells of the box round it. */
static void hit_near(Kernel *k, int segment, double margin)
{
    Vector start = k->team.start[segment], edge = k->team.edge[segment];
    double left = start.x + MIN(edge.x, 0.0) - margin, right = start.x + MAX(edge.x, 0.0) + margin;
    double low = start.y + MIN(edge.y, 0.0) - margin, high = start.y + MAX(edge.y, 0.0) + margin;
    int across = columns_in(k, left, right), up = columns_in(k, low, high);
    for (int row = column_of(k, low); up > 0; row = after(k, row), up--)
        for (int u = 0, column = column_of(k, left); u < across; column = after(k, column), u++)
            for (int i = k->cells[row * k->wide + column]; i >= 0; i = k->next[i]) hit(k, i, segment);
}

/* Lists the segments of each robot, in their order, in which they were hit. */
static void list_walls(Kernel *k)
{
    int n = k->team.n;
    GROW(k, k->walls, k->wall_room, k->hit_count);
    if (k->error) return;
    for (int i = 0; i <= n; i++) k->first_wall[i] = 0;
    for (int h = 0; h < k->hit_count; h++) k->first_wall[k->hits[h].robot]++;
    for (int i = 0; i < n; i++) k->first_wall[i + 1] += k->first_wall[i]; /* where each part ends */
    for (int h = k->hit_count - 1; h >= 0; h--)
        k->walls[--k->first_wall[k->hits[h].robot]] = k->hits[h].segment;
    k->first_wall[n] = k->hit_count;
}

/* -- both ------------------------------------------------------------------------------------- */

/* Lists all, once and for all. */
static void list_few(Kernel *k)
{
    int n = k->team.n;
    k->team.skin = INFINITY;
    for (int i = 0; i < n; i++) {
        k->first_robot[i] = k->robot_count;
        for (int j = i + 1; j < n; j++) list_robot(k, j);
    }
    for (int s = 0; s < k->team.segments; s++)
        for (int i = 0; i < n; i++) hit(k, i, s);
}

/* Lists what is within a skin that lasts for several questions. */
static void list_many(Kernel *k)
{
    Team *t = &k->team;
    double furthest = 0.0, largest = 0.0;
    for (int i = 0; i < t->n; i++) {
        furthest = MAX(furthest, t->reach[i]);
        largest = MAX(largest, t->radius[i]);
    }
    double far = 4 * furthest;
    t->skin = 2 * MAX(far, largest);
    double cutoff = 2 * largest + 2 * t->skin;
    fill_cells(k, cutoff * (1 + 1e-6)); /* columns of two within it differ by 1, however rounded */
    for (int i = 0; i < t->n && !k->error; i++) {
        k->first_robot[i] = k->robot_count;
        list_neighbours(k, i, cutoff);
    }
    for (int s = 0; s < t->segments && !k->error; s++) hit_near(k, s, cutoff);
}

/* Makes the list, or makes it anew. */
void list_anew(Kernel *k)
{
    Team *t = &k->team;
    for (int i = 0; i < t->n; i++) t->moved[i] = 0.0;
    k->robot_count = k->hit_count = 0;
    if (t->n <= t->few) list_few(k);
    else list_many(k);
    k->first_robot[t->n] = k->robot_count;
    list_walls(k);
}
