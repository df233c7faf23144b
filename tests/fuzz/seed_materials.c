/* Seeds: materials of every format that has no fixed size. */
#include "fuzz.h"

#include "material/tensor_write.h"
#include "seeds.h"

enum { MOST_NUMBERS = 2048 };

static float numbers[MOST_NUMBERS]; /* 0.1, 0.2 ... */

static void write_tensors(const char *name, const gonio_i_tensor_field *fields, size_t count)
{
    char path[4096];
    seed_path(path, "material", name);
    check(gonio_i_tensor_write(NULL, path, fields, count) == GONIO_OK, "a file is written");
}

static const unsigned char one[1] = {1};

static void seed_rgl(const char *name, uint64_t phis, bool spectral)
{
    static const float phi[4] = {-3.14159265F, -2.0F, -1.0F, 0.0F};
    static const float theta[3] = {0.0F, 0.7F, 1.3F};
    static const float wavelength[4] = {400.0F, 500.0F, 600.0F, 700.0F};
    const uint64_t channels = spectral ? 4 : 3;
    const gonio_i_tensor_field fields[] = {
        {"phi_i", GONIO_I_TENSOR_F32, 1, {phis}, phi},
        {"theta_i", GONIO_I_TENSOR_F32, 1, {3}, theta},
        {"ndf", GONIO_I_TENSOR_F32, 2, {2, 3}, numbers},
        {"sigma", GONIO_I_TENSOR_F32, 2, {2, 3}, numbers},
        {"vndf", GONIO_I_TENSOR_F32, 4, {phis, 3, 3, 2}, numbers},
        {"luminance", GONIO_I_TENSOR_F32, 4, {phis, 3, 3, 3}, numbers},
        {"description", GONIO_I_TENSOR_U8, 1, {4}, "made"},
        {"jacobian", GONIO_I_TENSOR_U8, 1, {1}, one},
        {spectral ? "spectra" : "rgb", GONIO_I_TENSOR_F32, 5, {phis, 3, channels, 3, 3}, numbers},
        {"wavelengths", GONIO_I_TENSOR_F32, 1, {4}, wavelength},
    };
    write_tensors(name, fields, spectral ? 10 : 9);
}

static void seed_kaist(void)
{
    static const uint16_t wavelength[2] = {450, 622};
    static const float phi_d[3] = {-180.0F, 0.0F, 180.0F};
    static const float theta[2] = {0.0F, 90.0F};
    const gonio_i_tensor_field fields[] = {
        {"theta_d", GONIO_I_TENSOR_F32, 2, {1, 2}, theta},
        {"theta_h", GONIO_I_TENSOR_F32, 2, {1, 2}, theta},
        {"phi_d", GONIO_I_TENSOR_F32, 2, {1, 3}, phi_d},
        {"wvls", GONIO_I_TENSOR_U16, 1, {2}, wavelength},
        {"M", GONIO_I_TENSOR_F32, 6, {3, 2, 2, 2, 4, 4}, numbers},
    };
    write_tensors("kaist.pbsdf", fields, 5);
}

/* ---- BSDF-XML ---- */

#define XML_BEGIN                                                                                  \
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<WindowElement xmlns=\"http://x\"><Optical>"      \
    "<Layer><DataDefinition><IncidentDataStructure>"
#define XML_BASIS                                                                                  \
    "<AngleBasis><AngleBasisName>Two</AngleBasisName><AngleBasisBlock><Theta>0</Theta>"            \
    "<nPhis>1</nPhis><ThetaBounds><LowerTheta>0</LowerTheta><UpperTheta>30</UpperTheta>"           \
    "</ThetaBounds></AngleBasisBlock><AngleBasisBlock><nPhis>2</nPhis><ThetaBounds><LowerTheta>30" \
    "</LowerTheta><UpperTheta>90</UpperTheta></ThetaBounds></AngleBasisBlock></AngleBasis>"
#define XML_BLOCK(wavelength, data)                                                                \
    "<WavelengthData><LayerNumber>System</LayerNumber><Wavelength unit=\"Integral\">" wavelength   \
    "</Wavelength><WavelengthDataBlock><WavelengthDataDirection>Reflection Front"                  \
    "</WavelengthDataDirection><ColumnAngleBasis>Two</ColumnAngleBasis><RowAngleBasis>Two"         \
    "</RowAngleBasis><ScatteringDataType>BRDF</ScatteringDataType><ScatteringData>" data           \
    "</ScatteringData></WavelengthDataBlock></WavelengthData>"
#define XML_END "</Layer></Optical></WindowElement>\n"
#define NINE "0.1, 0.2, 0.3,\n0.4 0.5 0.6\n0.7;0.8;0.9"

static const char matrices[] = XML_BEGIN
    "Columns</IncidentDataStructure>" XML_BASIS "</DataDefinition>" XML_BLOCK("Visible", NINE)
        XML_BLOCK("CIE-X", NINE) XML_BLOCK("CIE-Z", NINE) XML_END;

static const char spectrum[] = XML_BEGIN
    "Rows</IncidentDataStructure>" XML_BASIS "</DataDefinition><WavelengthData><Wavelength "
    "unit=\"Micrometers\">0.55</Wavelength><WavelengthDataBlock><WavelengthDataDirection>"
    "Reflection Back</WavelengthDataDirection><ColumnAngleBasis>Two</ColumnAngleBasis>"
    "<RowAngleBasis>Two</RowAngleBasis><ScatteringData>" NINE
    "</ScatteringData></WavelengthDataBlock></WavelengthData>" XML_END;

static const char tree3[] =
    XML_BEGIN "TensorTree3</IncidentDataStructure></DataDefinition>" XML_BLOCK(
        "Visible", "{{0.1}{0.2}{0.3}{1 2 3 4 5 6 7 8}{{1}{2}{3}{4}{5}{6}{7}{8}}{0.6}{0.7}{0.8}}")
        XML_END;

static const char tree4[] =
    XML_BEGIN "TensorTree4</IncidentDataStructure></DataDefinition>" XML_BLOCK(
        "Visible", "{ 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 }") XML_END;

#define SIX "TIS 1\n1 2 3\n0 5 6\n"
#define PLANE "DataBegin\n" SIX SIX SIX SIX SIX SIX "DataEnd\n"

static const char grid[] =
    "# a sheet\nSymmetry ASymmetrical4D\nSpectralContent XYZ\nScatterType BRDF\nSampleRotation "
    "3\n0 "
    "45 90\nAngleOfIncidence 2\n10 50\nScatterAzimuth 3\n0 90 180\nScatterRadial 2\n0 30\n"
    "TristimulusX\n" PLANE "TristimulusY\n" PLANE "TristimulusZ\n" PLANE;

/* The smallest anisotropic table. */
static void seed_anisotropic_table(void)
{
    enum { COUNT = GONIO_THETA_H_BINS * GONIO_THETA_D_BINS * 3 };
    static float coefficient[COUNT];
    const double floor = 1e-4;
    const gonio_anisotropic_table table = {.size = sizeof table,
                                           .channels = 1,
                                           .phi_d_cells = 1,
                                           .symmetry = 2,
                                           .orders = 1,
                                           .floor = &floor,
                                           .coefficient = coefficient};
    gonio_material *material = NULL;
    char path[4096];
    for (size_t k = 0; k < COUNT; k++) {
        coefficient[k] = 0.01F * (float)(k % 97);
    }
    seed_path(path, "material", "anisotropic.h5");
    if (gonio_anisotropic_material(NULL, "seed", "seed", &table, &material) == GONIO_OK) {
        gonio_material_write(NULL, material, path, NULL);
    }
    gonio_material_free(&material);
}

void seed_materials(void)
{
    for (size_t k = 0; k < MOST_NUMBERS; k++) {
        numbers[k] = 0.1F * (float)(1 + k % 97);
    }
    seed_rgl("isotropic.bsdf", 1, false);
    seed_rgl("anisotropic.bsdf", 4, false);
    seed_rgl("spectral.bsdf", 2, true);
    seed_kaist();
    seed_anisotropic_table();
    seed_text("material", "matrices.xml", matrices);
    seed_text("material", "spectrum.xml", spectrum);
    seed_text("material", "tree3.xml", tree3);
    seed_text("material", "tree4.xml", tree4);
    seed_text("material", "zemax.bsdf", grid);
}
