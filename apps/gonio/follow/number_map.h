/* Numbers that are found by a key of 64 bits, however many there are. */
#ifndef GONIO_FOLLOW_NUMBER_MAP_H
#define GONIO_FOLLOW_NUMBER_MAP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct number_map_slot {
    uint64_t key;
    size_t number; /* plus 1; 0: the slot is free */
} number_map_slot;

/* All 0 is an empty map. */
typedef struct number_map {
    number_map_slot *slot;
    size_t room; /* slots: 0 or a power of two */
    size_t count;
} number_map;

/* Gives a key a number in place of the one that it has. False when out of memory. */
bool number_map_put(number_map *map, uint64_t key, size_t number);

/* Whether a key has a number, which goes to *number. */
bool number_map_get(const number_map *map, uint64_t key, size_t *number);

void number_map_free(number_map *map);

#endif
