/* Seeds: instruments, journals and lines of runs that are followed. */
#include <stdio.h>
#include <string.h>

#include "fuzz.h"

#include "follow/journal.h"
#include "instrument/builtin.h"
#include "seeds.h"

#define AXIS(name)                                                                                 \
    "\"" name "\":{\"from_deg\":0,\"to_deg\":80,\"step_deg\":2,\"speed_deg_per_s\":5}"

static const struct {
    const char *name;
    const char *text;
} instruments[] = {
    {"direct",
     "{\"gonio_instrument\":1,\"kinematics\":\"direct\",\"axes\":{" AXIS("theta_i") "," AXIS(
         "theta_o") "," AXIS("phi_o") "},\"values\":{\"kind\":\"relative\",\"reference\":"
                                      "\"tile\",\"reference_factors\":[[12,1.07],[75,0.9]"
                                      "]},\"reciprocal\":true}"},
    {"plane", "{\"gonio_instrument\":1,\"kinematics\":\"in-plane\",\"axes\":{\"incidence\":{"
              "\"positions_deg\":[5,41.4,60]},\"detector\":{\"from_deg\":-80,\"to_deg\":80}},"
              "\"values\":{\"kind\":\"counts\",\"counts_of_1_per_sr\":5e5},"
              "\"wavelengths_nm\":[532]}"},
    {"arms",
     "{\"gonio_instrument\":1,\"kinematics\":\"arms\",\"axes\":{" AXIS("incidence") "," AXIS(
         "azimuth") "," AXIS("receive") "},\"limits\":{\"theta_o_deg\":[0,60]},"
                                        "\"forbidden\":[{\"name\":\"x\",\"separation_deg\":"
                                        "[0,5],\"azimuth_deg\":[20,40]}],\"footprint\":{"
                                        "\"lit_mm\":3,\"seen_mm\":12,\"inside\":\"lit\"},"
                                        "\"times\":{\"axes_move\":\"in-turn\",\"exposure_s"
                                        "\":0.5}}"},
    {"table", "{\"gonio_instrument\":1,\"kinematics\":\"table\",\"directions\":[[30,0,40,180],"
              "[10,0,20,90],[0,0,60,0]],\"apertures\":{\"source_half_angle_deg\":1}}"},
    {"table-axes", "{\"gonio_instrument\":1,\"kinematics\":\"table\",\"axes\":{" AXIS(
                       "a") "},"
                            "\"directions\":[[30,0,40,180,1],[10,0,20,90,2.5]]}"},
};

static void seed_instruments(void)
{
    for (size_t k = 0; k < sizeof instruments / sizeof *instruments; k++) {
        seed_text("instrument", instruments[k].name, instruments[k].text);
    }
    for (int k = 0; gonio_instrument_word(k) != NULL; k++) {
        size_t size = 0;
        const char *text = gonio_i_builtin_instrument(gonio_instrument_word(k), &size);
        seed_bytes("instrument", gonio_instrument_word(k), text, size);
    }
}

static const char *const lines[] = {
    "\2theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,value_per_sr,time_s\n28.6,0,28.6,180,0.5,10\n"
    "57,0,17,86,0.25,20\nstalled\n28.6,0,28.6,180,0.5,10\n!01,2,3,4,5,6\n!0\n"
    "28.6,0,28.6,180,0.7,30\n",
    "\2# robot\nsep=;\ntheta_i;phi_i;theta_o;phi_o;mark;R;G;B\n;;;;;1/sr;1/sr;1/sr\n"
    "28,6;0;28,6;180;reference;1;1;1\n28,6;0;28,6;180;;0,5;0,25;\n@abcdefghijklmnop\n",
};

static gonio_status ignore(void *user, const char *kind, const char *text)
{
    (void)user;
    (void)kind;
    (void)text;
    return GONIO_OK;
}

/* A journal, behind the byte that says so. */
static void seed_journal(void)
{
    char path[4096];
    char bytes[512] = "\1";
    journal *j = NULL;
    journal_found found;
    char *problem = NULL;
    seed_path(path, "run", "journal");
    unlink(path);
    check(journal_open(path, ignore, NULL, &found, &j, &problem) == GONIO_OK &&
              journal_append(j, "plan", "0123456789abcdef") &&
              journal_append(j, "line", "2 0.5 30,0,40,180,0.25") &&
              journal_append(j, "ask", "1") && journal_append(j, "adapt", "30 0 40 180 10 0 20 90"),
          "a journal is written");
    journal_close(&j);
    FILE *file = fopen(path, "rb");
    check(file != NULL, "a journal is there");
    const size_t size = 1 + fread(bytes + 1, 1, sizeof bytes - 1, file);
    fclose(file);
    seed_bytes("run", "journal", bytes, size);
}

void seed_rigs(void)
{
    char name[16];
    seed_instruments();
    seed_journal();
    for (size_t k = 0; k < sizeof lines / sizeof *lines; k++) {
        snprintf(name, sizeof name, "lines-%zu", k);
        seed_text("run", name, lines[k]);
    }
}
