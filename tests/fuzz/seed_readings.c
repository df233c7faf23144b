/* Seeds: readings of every format, and plans. */
#include "seeds.h"

static const struct {
    const char *name;
    const char *text;
} readings[] = {
    {"csv", "# gonio plan\n# basis: 00000000000000ff\n# components: 2\n# method: condition\n"
            "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,channel,R_per_sr,G_per_sr,B_per_sr\n"
            "30,0,40,180,R,0.1,,0.3\n30,90,50,270,all,0.4,0.5,0.6\n"},
    {"csv-spectral",
     "sep=;\ntheta_i;phi_i;theta_r;phi_r;400nm;500.5 nm;x\n[deg];[deg];[deg];[deg];;;\n"
     "10,5;0;20;-180;0,5;0,25;a\n-10,5;0;20;0;1e-3;;\"b;c\"\n"},
    {"csv-factor",
     "# reflectance factor\nincidence angle\tviewing angle\tazimuth\tbrf\tsigma\n30\t40\t180\t0.5\t"
     "0.01\n30\t-40\t0\t0.25\t0.02\n"},
    {"csv-blanks",
     "% a lab\n% thetaIn phiIn thetaOut phiOut R550 rotation\n\n20  0 30 180\t0.5 15\n"
     "% end\n20 0 -30 0 0.25 30\n"},
    {"csv-strokes",
     "Instrument, X\n| AOI | scatter angle | brdf |\n|---|:-:|---|\n| 20 | -30 | 0.5 "
     "|\n| 20 | 30 | 0.25 |\n"},
    {"csv-forms",
     "theta_i;theta_o;brf;R\n30;20 deg;98,5 % ± 1 %;0.31(2)\n30;-20 deg;97 %;0,3 ± 1\n"},
    {"crossed", "# AOI: 30 deg\nBRF\ntheta\\phi\t0\t90\t180\n0\t1\t1\t1\n30\t0.5\t\t9\nAOI 40\n"
                "theta\\phi\t0\t90\n30\t.1\t---\n"},
    {"crossed-spectra", "unit: %\nwavelength_nm;45as15;r45as-15;45/0\n400;1,5;2;3\n500;1;2;3\n"},
    {"crossed-stack", "theta_i,45,,30\ntheta_o,0,15,30\nphi_o,0,180,90\nnm,,,\n400,1,2,3\n"},
    {"csv-geometry", "# unit: %\ngeometry,400nm,500nm\n45as15,1,2\n45/0,3,4\n"},
    {"csv-colours", "theta_i,theta_o,channel,brdf\n30,20,R,0.3\n30,20,G,0.5\n40,20,B,0.7\n"},
    {"csv-polarised",
     "elevation_i,elevation_o,pol,400nm [1e-3/sr],500nm [10^-3 1/sr]\n60,50,s,1,2\n"
     "60,50,p,3,\n60,20,unpolarised,5,6\n"},
    {"scattered", "2\n500 600\n0.5 0 1.0 3.14 0.5 0.25\n0.5 0 0.2 0 0.1 0.1\n"},
    {"alta", "#SAMPLE \"x\"\n#DIM 3 1\n#VS 0\n#PARAM_IN ISOTROPIC_TL_TV_PROJ_DPHI\n"
             "0.25 0.3 -0.4 0.7\n0.25 -0.2 0 0.1\n"},
    {"alta-cartesian", "#DIM 6 2\n#PARAM_IN CARTESIAN\n0 0 1  0.6 0 0.8  0.25 0.5\n"},
    {"pab", "#sample_name x\n#incident_angle 30 90\n#upphi 90\n#format: theta phi DSF\n"
            "#datapoints 3\n60 270 0.25\n 0 10 0.4\n120 0 7\n"},
    {"astm", "ASTM x\nNUM_POINTS 2\nWAVELENGTH 0\nVARS theta_i,phi_i,theta_s,phi_s,400nm, 500nm\n"
             "0.3, 0, 1.04719755, 3.14159265, 0.5, 0.25\n0.3,0,0,0,0.1,0.2\n"},
    {"tracepro",
     "TracePro Surface Property Data\nTemperature\tWavelength\tIncAngle\n300\t0.55\t30\n"
     "Table_BSDF_Data\nTemperature\tWavelength\tIncAngle\tAziAngle\tScatterBeta\t"
     "ScatterAzimuth\tBRDF\tBTDF\n300\t0.55\t30\t0\t0.2\t0\t0.1\t\n300\t0.65\t30\t0\t0.2\t0\t0.5\t"
     "\n"},
    {"zemax",
     "# a sheet\nSource  Measured\nSymmetry  PlaneSymmetrical\nSpectralContent  Monochrome\n"
     "ScatterType  BRDF\nSampleRotation  1\n0\nAngleOfIncidence  2\n10 30\n"
     "ScatterAzimuth 3\n0 90\n180\nScatterRadial 2\n0 20\nMonochrome\nDataBegin\nTIS 0.1\n1 2\n"
     "1 3\n1 4\nTIS 0.2\n5 6\n5 7\n5 0\nDataEnd\n"},
    {"fred", "type bsdf_data\nformat angles=deg bsdf=value scale=2\n!! a comment\n10\t0\n"
             "0 0 0.3\n0 90 0.3\n10 180 0.00001\n30 0 0.4\n95 0 1\n50 90\n20 90 0.5\n"},
    {"columns", "# theta_i phi_i theta_r phi_r value\n30 10 40 100 0.5\n30 10 -20 100 0.25\n"},
    {"in-plane", " Incident_angle,Measure_angle, 390nm , 400nm \n10,-78,0.31415926536,0.1\n"
                 "10,30,0.2,0.62831853072\n10,-12,0,0\n"},
    {"json",
     "{\"metadata\":{\"type\":\"BRDF\"},\"data\":{\"theta_i\":{\"unit\":\"deg\",\"values\":[30,30]"
     "},\"phi_i\":{\"unit\":\"deg\",\"values\":0},\"theta_r\":{\"unit\":\"rad\",\"value\":[0.5,0.6]"
     "},\"phi_r\":{\"unit\":\"deg\",\"values\":[180,180]},\"wavelength_i\":{\"unit\":\"um\","
     "\"values\":[0.65,0.55]},\"polarization_i\":{\"values\":[\"s\",\"p\"]},\"BRDF\":{\"unit\":"
     "\"sr^-1\",\"values\":[0.2,null],\"uncertainty\":{\"coverage_factor\":2,\"values\":[0.06,0.02]"
     "}}}}"},
    {"openmaterial", "{\"$schema\":\"material_brdf_schema.json\",\"brdf\":{\"lookupTable\":["
                     "[5.5e-07,0.5,0.25,3.14,0.3],[6.5e-07,0.5,0.25,3.14,0.4]]}}"},
    {"curet", "3  0.1 0.2 0.3\n7  0.2 0.2 0.1\n"},
};

static const struct {
    const char *name;
    const char *text;
} plans[] = {
    {"channels", "# gonio plan\n# program: gonio 0.2.0\n# basis: 0123456789abcdef\n"
                 "# components: 35\n# method: condition\n"
                 "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,channel\n"
                 "30.500000000,90.0,30.5,270.0,R\n12,89.9,45,200.1,B\n0,0,0,0,G\n"},
    {"nested", "# gonio plan\n# method: expected-error\n# expected_e6_percent: 3.2\n"
               "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,channel,expected_e6_percent\n"
               "30,90,30,270,all,12.5\n60,10,70,180,all,9.1\n"},
    {"values", "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,500nm_per_sr,note\n10,0,20,180,,x\n"
               "10,0,20,180,0.5,\"y\"\n"},
};

static void seed_utf_16(void)
{
    static const char text[] = "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,G_per_sr\r\n"
                               "10,0,20,180,0.5\r\n";
    char wide[2 * sizeof text] = "\xff\xfe";
    for (size_t k = 0; k + 1 < sizeof text; k++) {
        wide[2 + 2 * k] = text[k];
        wide[3 + 2 * k] = '\0';
    }
    seed_bytes("readings", "utf-16", wide, sizeof wide);
}

void seed_readings(void)
{
    seed_utf_16();
    for (size_t k = 0; k < sizeof readings / sizeof *readings; k++) {
        seed_text("readings", readings[k].name, readings[k].text);
    }
    for (size_t k = 0; k < sizeof plans / sizeof *plans; k++) {
        seed_text("plan", plans[k].name, plans[k].text);
        seed_text("readings", plans[k].name, plans[k].text);
    }
}
