/* Writing BSDF-XML: the mean of the BRDF over pairs of patches of the full Klems basis (klems.h),
 * as WINDOW and Radiance read it. Colours are CIE-X, Visible and CIE-Z, in which a flat spectrum
 * has three times the same; a single channel is Visible. Front and back are alike, because WINDOW's
 * front is Radiance's back. */
#include <math.h>
#include <stdlib.h>

#include "../../core/core.h"
#include "../colour.h"
#include "../sampler.h"
#include "../text_output.h"
#include "klems.h"
#include "writers.h"

/* Directions that a pair of patches is averaged over: ACROSS x ACROSS in either patch. */
enum { ACROSS = 4, SAMPLES = ACROSS * ACROSS, PLANES = GONIO_CHANNELS };

typedef struct writer {
    gonio_context *context;
    const gonio_i_sampler *sampler;
    const gonio_i_klems *basis;
    size_t patches;
    double *mean;     /* [incident][outgoing][X, Y, Z] */
    gonio_pair *pair; /* [outgoing][SAMPLES][SAMPLES], of an incident patch */
    double *rgb;
} writer;

/* Sample k of a patch. `shift` makes the samples of different patches different. */
static gonio_angles sample_patch(const gonio_i_klems *basis, size_t patch, size_t k, double shift,
                                 bool incident)
{
    const size_t row = k / ACROSS;
    const double across = ((double)row + shift) / ACROSS;
    const double around = ((double)(k % ACROSS) + shift) / ACROSS;
    return gonio_i_klems_direction(basis, patch, across, around, incident);
}

static void set_directions(const writer *w, size_t in)
{
    for (size_t out = 0; out < w->patches; out++) {
        for (size_t k = 0; k < SAMPLES * SAMPLES; k++) {
            /* the diagonal of the square of strata, so that each half vector is another one */
            const size_t of_incident = k / SAMPLES;
            const double shift = ((double)of_incident + 0.5) / SAMPLES;
            w->pair[out * SAMPLES * SAMPLES + k] =
                (gonio_pair){sample_patch(w->basis, in, of_incident, 0.5, true),
                             sample_patch(w->basis, out, k % SAMPLES, shift, false)};
        }
    }
}

/* Stores the means over the samples with data for an incident patch; 0 without data. */
static void store(const writer *w, size_t in)
{
    for (size_t out = 0; out < w->patches; out++) {
        double sum[PLANES] = {0.0};
        double count = 0.0;
        for (size_t k = 0; k < SAMPLES * SAMPLES; k++) {
            const double *rgb = w->rgb + (out * SAMPLES * SAMPLES + k) * PLANES;
            count += isnan(rgb[0]) ? 0.0 : 1.0;
            for (size_t c = 0; c < PLANES && !isnan(rgb[0]); c++) {
                sum[c] += rgb[c];
            }
        }
        for (size_t c = 0; c < PLANES; c++) {
            sum[c] /= fmax(count, 1.0);
        }
        gonio_i_rgb_to_xyz(sum, w->mean + (in * w->patches + out) * PLANES);
    }
}

static gonio_status find_means(const writer *w)
{
    gonio_status status = GONIO_OK;
    for (size_t in = 0; in < w->patches && status == GONIO_OK; in++) {
        set_directions(w, in);
        status = gonio_i_sampler_colours(w->context, w->sampler, w->pair,
                                         w->patches * SAMPLES * SAMPLES, w->rgb);
        if (status == GONIO_OK) {
            store(w, in);
            status = gonio_i_progress(w->context, "writing",
                                      0.99 * (double)(in + 1) / (double)w->patches);
        }
    }
    return status;
}

/* ---- text ---- */

static void print_escaped(FILE *to, const char *text)
{
    for (; *text != '\0'; text++) {
        const unsigned char c = (unsigned char)*text;
        if (c == '&' || c == '<' || c == '>' || c < 0x20) {
            fprintf(to, "&#%d;", c < 0x20 ? ' ' : c);
        } else {
            fputc(c, to);
        }
    }
}

static void print_basis(FILE *to, const gonio_i_klems *basis)
{
    fprintf(to, "<AngleBasis>\n<AngleBasisName>%s</AngleBasisName>\n", basis->name);
    for (size_t k = 0; k < basis->rings; k++) {
        const double low = basis->bound[k];
        const double high = basis->bound[k + 1];
        fprintf(to,
                "<AngleBasisBlock>\n<Theta>%g</Theta>\n<ThetaBounds><LowerTheta>%g</LowerTheta>"
                "<UpperTheta>%g</UpperTheta></ThetaBounds>\n<nPhis>%zu</nPhis>\n"
                "</AngleBasisBlock>\n",
                k == 0 ? 0.0 : 0.5 * (low + high), low, high, basis->patches[k]);
    }
    fprintf(to, "</AngleBasis>\n");
}

static void print_block(const writer *w, FILE *to, const char *wavelength, const char *direction,
                        size_t plane)
{
    fprintf(to,
            "<WavelengthData>\n<LayerNumber>System</LayerNumber>\n"
            "<Wavelength unit=\"Integral\">%s</Wavelength>\n"
            "<SourceSpectrum>CIE Illuminant E</SourceSpectrum>\n"
            "<DetectorSpectrum>CIE 1931</DetectorSpectrum>\n<WavelengthDataBlock>\n"
            "<WavelengthDataDirection>%s</WavelengthDataDirection>\n"
            "<ColumnAngleBasis>%s</ColumnAngleBasis>\n<RowAngleBasis>%s</RowAngleBasis>\n"
            "<ScatteringDataType>BRDF</ScatteringDataType>\n<ScatteringData>\n",
            wavelength, direction, w->basis->name, w->basis->name);
    for (size_t out = 0; out < w->patches; out++) {
        for (size_t in = 0; in < w->patches; in++) {
            fprintf(to, "%.7g,%s", w->mean[(in * w->patches + out) * PLANES + plane],
                    in + 1 == w->patches ? "\n" : " ");
        }
    }
    fprintf(to, "</ScatteringData>\n</WavelengthDataBlock>\n</WavelengthData>\n");
}

static void print_all(const writer *w, FILE *to)
{
    static const char *const wavelength[PLANES] = {"CIE-X", "Visible", "CIE-Z"};
    static const char *const direction[2] = {"Reflection Front", "Reflection Back"};
    const bool grey = w->sampler->view->channels == 1;
    fprintf(to, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                "<WindowElement xmlns=\"http://windows.lbl.gov\">\n"
                "<WindowElementType>System</WindowElementType>\n<Optical>\n<Layer>\n"
                "<Material>\n<Name>");
    print_escaped(to, w->sampler->view->name);
    fprintf(to, "</Name>\n<Manufacturer>gonio</Manufacturer>\n</Material>\n<DataDefinition>\n"
                "<IncidentDataStructure>Columns</IncidentDataStructure>\n");
    print_basis(to, w->basis);
    fprintf(to, "</DataDefinition>\n");
    for (size_t side = 0; side < 2; side++) {
        for (size_t plane = 0; plane < PLANES; plane++) {
            if (!grey || plane == 1) {
                print_block(w, to, wavelength[plane], direction[side], plane);
            }
        }
    }
    fprintf(to, "</Layer>\n</Optical>\n</WindowElement>\n");
}

static gonio_status write_sampled(writer *w, const char *path)
{
    const size_t samples = w->patches * SAMPLES * SAMPLES;
    w->mean = gonio_i_allocate(w->context, w->patches * w->patches * PLANES, sizeof *w->mean);
    w->pair = gonio_i_allocate(w->context, samples, sizeof *w->pair);
    w->rgb = gonio_i_allocate(w->context, samples * PLANES, sizeof *w->rgb);
    gonio_status status =
        w->mean != NULL && w->pair != NULL && w->rgb != NULL ? find_means(w) : GONIO_ERROR_MEMORY;
    gonio_i_text_output text;
    if (status == GONIO_OK) {
        status = gonio_i_text_open(w->context, &text);
        if (status == GONIO_OK) {
            print_all(w, text.stream);
            status = gonio_i_text_close(w->context, &text, path, status);
        }
    }
    free(w->mean);
    free(w->pair);
    free(w->rgb);
    return status;
}

static gonio_status write_klems(gonio_context *context, const gonio_material *material,
                                const char *path, const gonio_write_options *options)
{
    gonio_i_sampler sampler;
    (void)options;
    gonio_status status = gonio_i_sampler_begin(context, material, false, &sampler);
    if (status != GONIO_OK) {
        return status;
    }
    writer w = {
        .context = context, .sampler = &sampler, .basis = gonio_i_klems_named("LBNL/Klems Full")};
    w.patches = gonio_i_klems_patches(w.basis);
    status = write_sampled(&w, path);
    gonio_i_sampler_end(&sampler);
    return status == GONIO_OK ? gonio_i_progress(context, "writing", 1.0) : status;
}

const gonio_i_format_writer gonio_i_klems_writer = {
    .name = "klems",
    .extension = ".xml",
    .summary = "BSDF-XML, 145 x 145 patches of the full Klems basis, for Radiance, WINDOW",
    .write = write_klems,
};
