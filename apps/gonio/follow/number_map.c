/* Numbers by a key: see number_map.h. */
#include "number_map.h"

#include <stdlib.h>

enum { FIRST_ROOM = 64 };

/* The slot of a key, or the free one where it belongs. */
static number_map_slot *slot_of(const number_map *map, uint64_t key)
{
    size_t k = (size_t)(key ^ key >> 32) & (map->room - 1);
    while (map->slot[k].number > 0 && map->slot[k].key != key) {
        k = (k + 1) & (map->room - 1);
    }
    return &map->slot[k];
}

/* Twice the room, so that at most half of it is used. */
static bool grow(number_map *map)
{
    number_map larger = {.room = map->room > 0 ? 2 * map->room : FIRST_ROOM, .count = map->count};
    larger.slot = calloc(larger.room, sizeof *larger.slot);
    if (larger.slot == NULL) {
        return false;
    }
    for (size_t k = 0; k < map->room; k++) {
        if (map->slot[k].number > 0) {
            *slot_of(&larger, map->slot[k].key) = map->slot[k];
        }
    }
    free(map->slot);
    *map = larger;
    return true;
}

bool number_map_put(number_map *map, uint64_t key, size_t number)
{
    if (2 * map->count >= map->room && !grow(map)) {
        return false;
    }
    number_map_slot *slot = slot_of(map, key);
    map->count += slot->number == 0;
    *slot = (number_map_slot){key, number + 1};
    return true;
}

bool number_map_get(const number_map *map, uint64_t key, size_t *number)
{
    const number_map_slot *slot = map->room > 0 ? slot_of(map, key) : NULL;
    if (slot == NULL || slot->number == 0) {
        return false;
    }
    *number = slot->number - 1;
    return true;
}

void number_map_free(number_map *map)
{
    free(map->slot);
    *map = (number_map){0};
}
