/* Memory, taken and grown. Without it `error` says so. */

#include <limits.h>
#include <stdlib.h>

#include "kernel.h"

/* Takes memory, zeroed, for `count` items. */
void *zeroed(Kernel *k, size_t count, size_t size)
{
    void *items = calloc(MAX(count, 1), size);
    if (items == NULL) k->error = MARS2D_NO_MEMORY;
    return items;
}

/* Returns the items with room for as many as wanted. Without memory nothing has changed. */
void *grown(Kernel *k, void *items, int *room, int wanted, size_t size)
{
    if (wanted <= *room) return items;
    int more = *room < INT_MAX / 4 ? 2 * *room + 16 : INT_MAX - 1; /* so that counts may be 1 above */
    more = MAX(more, wanted);
    void *larger = NULL;
    if (more < INT_MAX && (size_t)more <= SIZE_MAX / size) larger = realloc(items, (size_t)more * size);
    if (larger == NULL) {
        k->error = MARS2D_NO_MEMORY;
        return items;
    }
    *room = more;
    return larger;
}
