/* Sets of pairs of bodies. */

#include <stdlib.h>

#include "kernel.h"

void make_set(Kernel *k, Set *set, int n)
{
    ZEROED(k, set->head, (size_t)n);
    for (int i = 0; i < n && !k->error; i++) set->head[i] = -1;
}

void free_set(Set *set)
{
    free(set->head);
    free(set->as);
    free(set->links);
}

void empty(Set *set)
{
    for (int l = 0; l < set->count; l++) set->head[set->as[l]] = -1;
    set->count = 0;
}

/* Where a pair is in a set; -1 if it is not there. */
int find(const Set *set, int a, int b)
{
    int l = set->head[a];
    while (l >= 0 && set->links[l].b != b) l = set->links[l].next;
    return l;
}

/* Adds a pair, or does nothing without memory. Returns whether it was there before. */
int add(Kernel *k, Set *set, int a, int b)
{
    if (find(set, a, b) >= 0) return 1;
    int l = set->count;
    GROW(k, set->links, set->link_room, l + 1);
    GROW(k, set->as, set->as_room, l + 1);
    if (k->error) return 0;
    set->links[l] = (Link){b, set->head[a]};
    set->as[l] = a;
    set->head[a] = l;
    set->count++;
    return 0;
}

void exchange(Set *one, Set *other)
{
    Set kept = *one;
    *one = *other;
    *other = kept;
}
