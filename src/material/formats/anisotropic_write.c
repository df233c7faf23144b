/* Writing anisotropic tables in HDF5: anisotropic_file.h has the layout. */
#include <math.h>
#include <stdlib.h>

#include "../../core/hdf_write.h"
#include "../../core/output.h"
#include "../anisotropic_table.h"
#include "anisotropic_file.h"

enum { RANK = GONIO_I_ANISOTROPIC_RANK, DEFLATE = 4 };

static const char equation[] =
    "ln(rho + floor) = c[0] + sum_k c[2k-1] cos(k symmetry phi_h) + c[2k] sin(k symmetry phi_h)";

static bool write_axes(hid_t file, const gonio_anisotropic_table *t)
{
    const size_t counts[3] = {GONIO_THETA_H_BINS, GONIO_THETA_D_BINS, (size_t)t->phi_d_cells};
    const hid_t native = H5T_NATIVE_DOUBLE;
    const hid_t stored = H5T_IEEE_F64LE;
    double theta_h[GONIO_THETA_H_BINS];
    double theta_d[GONIO_THETA_D_BINS];
    double phi_d[GONIO_PHI_D_BINS];
    for (int k = 0; k < GONIO_THETA_H_BINS; k++) {
        const gonio_half_difference centre = gonio_bin_centre((gonio_bin){k, k, 0});
        theta_h[k] = centre.theta_h;
        theta_d[k] = centre.theta_d;
    }
    for (int k = 0; k < t->phi_d_cells; k++) {
        phi_d[k] = (k + 0.5) * M_PI / t->phi_d_cells;
    }
    return gonio_i_hdf_write_array(file, "theta_h", 1, &counts[0], native, stored, theta_h) &&
           gonio_i_hdf_write_array(file, "theta_d", 1, &counts[1], native, stored, theta_d) &&
           gonio_i_hdf_write_array(file, "phi_d", 1, &counts[2], native, stored, phi_d);
}

static bool write_facts(hid_t file, const char *name, const gonio_anisotropic_table *t)
{
    const size_t one = 1;
    const hid_t native = H5T_NATIVE_DOUBLE;
    const hid_t stored = H5T_IEEE_F64LE;
    return gonio_i_hdf_write_string(file, "format", GONIO_I_ANISOTROPIC_FORMAT) &&
           gonio_i_hdf_write_number(file, "version", GONIO_I_ANISOTROPIC_VERSION) &&
           gonio_i_hdf_write_string(file, "name", name) &&
           gonio_i_hdf_write_string(file, "unit", "1/sr") &&
           gonio_i_hdf_write_string(file, "equation", equation) &&
           gonio_i_hdf_write_number(file, "symmetry", t->symmetry) && write_axes(file, t) &&
           gonio_i_hdf_write_array(file, "floor", 1, &t->channels, native, stored, t->floor) &&
           gonio_i_hdf_write_array(file, "theta_limit", 1, &one, native, stored, &t->theta_limit) &&
           (t->wavelength == NULL || gonio_i_hdf_write_array(file, "wavelength_nm", 1, &t->channels,
                                                             native, stored, t->wavelength));
}

static bool write_coefficients(hid_t file, const gonio_anisotropic_table *t)
{
    const hsize_t extents[RANK] = {GONIO_THETA_H_BINS, GONIO_THETA_D_BINS, (hsize_t)t->phi_d_cells,
                                   t->channels, 1 + 2 * (hsize_t)t->orders};
    const hsize_t chunk[RANK] = {1, GONIO_THETA_D_BINS, 1, extents[3], extents[4]};
    const hid_t space = H5Screate_simple(RANK, extents, NULL);
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(properties, false); /* same input, same bytes */
    H5Pset_chunk(properties, RANK, chunk);
    H5Pset_shuffle(properties);
    H5Pset_deflate(properties, DEFLATE);
    const hid_t set = H5Dcreate2(file, "coefficient", H5T_IEEE_F32LE, space, H5P_DEFAULT,
                                 properties, H5P_DEFAULT);
    bool done = set >= 0 &&
                H5Dwrite(set, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, t->coefficient) >= 0;
    done = set >= 0 && H5Dclose(set) >= 0 && done;
    H5Pclose(properties);
    H5Sclose(space);
    return done;
}

static gonio_status write_image(gonio_context *context, hid_t file, const char *path)
{
    const void *image = NULL;
    size_t size = 0;
    gonio_i_output output;
    if (!gonio_i_hdf_read_image(file, &image, &size)) {
        return gonio_i_fail(context, GONIO_ERROR_MEMORY, "HDF5 cannot make the table");
    }
    gonio_status status = gonio_i_output_open(context, path, &output);
    if (status == GONIO_OK) {
        status = gonio_i_output_write(context, &output, image, size);
    }
    return gonio_i_output_close(context, &output, status);
}

static gonio_status write_table(gonio_context *context, const char *name,
                                const gonio_anisotropic_table *t, const char *path)
{
    gonio_i_hdf_session session;
    gonio_status status = gonio_i_hdf_load(context);
    if (status != GONIO_OK) {
        return status;
    }
    gonio_i_hdf_enter(&session);
    const hid_t file = gonio_i_hdf_create_image();
    const bool made = file >= 0 && write_facts(file, name, t) && write_coefficients(file, t);
    status = made ? write_image(context, file, path)
                  : gonio_i_fail(context, GONIO_ERROR_MEMORY, "HDF5 cannot make the table");
    if (file >= 0) {
        H5Fclose(file);
    }
    gonio_i_hdf_leave(&session);
    return status;
}

gonio_status gonio_i_anisotropic_write(gonio_context *context, const gonio_material *material,
                                       const char *path)
{
    const gonio_anisotropic_table *own = gonio_i_anisotropic_of(material);
    const char *name = gonio_material_name(material);
    gonio_anisotropic_table made = {0};
    gonio_i_sampler sampler;
    gonio_status status = GONIO_OK;
    if (own == NULL) {
        status = gonio_i_sampler_begin(context, material, false, &sampler);
        if (status == GONIO_OK) {
            status = gonio_i_anisotropic_fit(context, &sampler, 0, &made);
            gonio_i_sampler_end(&sampler);
        }
    }
    if (status == GONIO_OK) {
        status = write_table(context, name, own != NULL ? own : &made, path);
    }
    gonio_i_anisotropic_clear(&made);
    return status == GONIO_OK ? gonio_i_progress(context, "writing", 1.0) : status;
}
