/* The table of kinematics. */
#include <string.h>

#include "instrument.h"

#define ENTRY(name) &gonio_i_##name##_kinematics,
static const gonio_i_kinematics *const kinematics[] = {GONIO_I_KINEMATICS(ENTRY)};

enum { COUNT = sizeof kinematics / sizeof *kinematics };

const gonio_i_kinematics *gonio_i_kinematics_at(int index)
{
    return index >= 0 && index < COUNT ? kinematics[index] : NULL;
}

const gonio_i_kinematics *gonio_i_kinematics_named(const char *name)
{
    const gonio_i_kinematics *found = NULL;
    for (int k = 0; k < COUNT; k++) {
        found = strcmp(kinematics[k]->name, name) == 0 ? kinematics[k] : found;
    }
    return found;
}

const char *gonio_kinematics_name(int index)
{
    return gonio_i_kinematics_at(index) != NULL ? kinematics[index]->name : NULL;
}

const char *gonio_kinematics_summary(int index)
{
    return gonio_i_kinematics_at(index) != NULL ? kinematics[index]->summary : NULL;
}
