/* What is kept of a CSV file, and how it names channels: see csv_kept.h. */
#include "csv_kept.h"

#include <stdlib.h>

#include "../../plan/plan_file.h"

void gonio_i_csv_name_channel(const gonio_readings *readings, int channel,
                              char name[GONIO_I_NAME_ROOM])
{
    const bool colour = gonio_readings_are_colours(readings) && channel < GONIO_CHANNELS;
    if (channel == GONIO_ALL_CHANNELS || colour) {
        snprintf(name, GONIO_I_NAME_ROOM, "%s", gonio_i_planned_channel_name(channel));
    } else if (readings->wavelength != NULL && (size_t)channel < readings->channels) {
        snprintf(name, GONIO_I_NAME_ROOM, "%.10gnm", readings->wavelength[channel]);
    } else {
        snprintf(name, GONIO_I_NAME_ROOM, "%d", channel + 1);
    }
}

void gonio_i_csv_kept_free(void *data)
{
    gonio_i_csv_kept *kept = data;
    gonio_i_csv_columns_free(&kept->columns);
    free(kept->text);
    free(kept);
}

const gonio_i_csv_kept *gonio_i_csv_kept_of(const gonio_readings *readings)
{
    return readings->attachment.release == gonio_i_csv_kept_free ? readings->attachment.data : NULL;
}
