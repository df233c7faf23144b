/* The HDF5 library, loaded when it is used. After gonio_i_hdf_load has succeeded, its
 * functions are called as if it were linked: see core/on_demand.h. */
#ifndef GONIO_HDF_LIBRARY_H
#define GONIO_HDF_LIBRARY_H

#include <hdf5.h>

#include "on_demand.h"

#define GONIO_I_HDF_SYMBOLS(X)                                                                     \
    X(H5Aclose)                                                                                    \
    X(H5Acreate2)                                                                                  \
    X(H5Awrite)                                                                                    \
    X(H5Dclose)                                                                                    \
    X(H5Dcreate2)                                                                                  \
    X(H5Dget_space)                                                                                \
    X(H5Dwrite)                                                                                    \
    X(H5Dwrite_chunk)                                                                              \
    X(H5Eclear2)                                                                                   \
    X(H5Eget_auto2)                                                                                \
    X(H5Eset_auto2)                                                                                \
    X(H5Fclose)                                                                                    \
    X(H5Fcreate)                                                                                   \
    X(H5Fflush)                                                                                    \
    X(H5Fget_file_image)                                                                           \
    X(H5Fget_vfd_handle)                                                                           \
    X(H5Pclose)                                                                                    \
    X(H5Pcreate)                                                                                   \
    X(H5Pset_chunk)                                                                                \
    X(H5Pset_deflate)                                                                              \
    X(H5Pset_fapl_core)                                                                            \
    X(H5Pset_obj_track_times)                                                                      \
    X(H5Pset_shuffle)                                                                              \
    X(H5Sclose)                                                                                    \
    X(H5Screate)                                                                                   \
    X(H5Screate_simple)                                                                            \
    X(H5Sselect_hyperslab)                                                                         \
    X(H5Tclose)                                                                                    \
    X(H5Tcopy)                                                                                     \
    X(H5Tset_cset)                                                                                 \
    X(H5Tset_size)                                                                                 \
    X(H5open)                                                                                      \
    X(H5check_version)                                                                             \
    X(H5T_IEEE_F32LE_g)                                                                            \
    X(H5T_IEEE_F64LE_g)                                                                            \
    X(H5T_STD_I64LE_g)                                                                             \
    X(H5T_C_S1_g)                                                                                  \
    X(H5T_NATIVE_FLOAT_g)                                                                          \
    X(H5T_NATIVE_DOUBLE_g)                                                                         \
    X(H5T_NATIVE_INT64_g)                                                                          \
    X(H5P_CLS_FILE_CREATE_ID_g) X(H5P_CLS_FILE_ACCESS_ID_g) X(H5P_CLS_DATASET_CREATE_ID_g)

struct gonio_i_hdf {
    GONIO_I_HDF_SYMBOLS(GONIO_I_SYMBOL_POINTER)
};

extern struct gonio_i_hdf gonio_i_hdf;

gonio_status gonio_i_hdf_load(gonio_context *context);

#ifndef GONIO_I_HDF_ITSELF
#define H5Aclose (*gonio_i_hdf.H5Aclose)
#define H5Acreate2 (*gonio_i_hdf.H5Acreate2)
#define H5Awrite (*gonio_i_hdf.H5Awrite)
#define H5Dclose (*gonio_i_hdf.H5Dclose)
#define H5Dcreate2 (*gonio_i_hdf.H5Dcreate2)
#define H5Dget_space (*gonio_i_hdf.H5Dget_space)
#define H5Dwrite (*gonio_i_hdf.H5Dwrite)
#define H5Dwrite_chunk (*gonio_i_hdf.H5Dwrite_chunk)
#define H5Eclear2 (*gonio_i_hdf.H5Eclear2)
#define H5Eget_auto2 (*gonio_i_hdf.H5Eget_auto2)
#define H5Eset_auto2 (*gonio_i_hdf.H5Eset_auto2)
#define H5Fclose (*gonio_i_hdf.H5Fclose)
#define H5Fcreate (*gonio_i_hdf.H5Fcreate)
#define H5Fflush (*gonio_i_hdf.H5Fflush)
#define H5Fget_file_image (*gonio_i_hdf.H5Fget_file_image)
#define H5Fget_vfd_handle (*gonio_i_hdf.H5Fget_vfd_handle)
#define H5Pclose (*gonio_i_hdf.H5Pclose)
#define H5Pcreate (*gonio_i_hdf.H5Pcreate)
#define H5Pset_chunk (*gonio_i_hdf.H5Pset_chunk)
#define H5Pset_deflate (*gonio_i_hdf.H5Pset_deflate)
#define H5Pset_fapl_core (*gonio_i_hdf.H5Pset_fapl_core)
#define H5Pset_obj_track_times (*gonio_i_hdf.H5Pset_obj_track_times)
#define H5Pset_shuffle (*gonio_i_hdf.H5Pset_shuffle)
#define H5Sclose (*gonio_i_hdf.H5Sclose)
#define H5Screate (*gonio_i_hdf.H5Screate)
#define H5Screate_simple (*gonio_i_hdf.H5Screate_simple)
#define H5Sselect_hyperslab (*gonio_i_hdf.H5Sselect_hyperslab)
#define H5Tclose (*gonio_i_hdf.H5Tclose)
#define H5Tcopy (*gonio_i_hdf.H5Tcopy)
#define H5Tset_cset (*gonio_i_hdf.H5Tset_cset)
#define H5Tset_size (*gonio_i_hdf.H5Tset_size)
#define H5check_version (*gonio_i_hdf.H5check_version)
#define H5open (*gonio_i_hdf.H5open)
#define H5T_IEEE_F32LE_g (*gonio_i_hdf.H5T_IEEE_F32LE_g)
#define H5T_IEEE_F64LE_g (*gonio_i_hdf.H5T_IEEE_F64LE_g)
#define H5T_STD_I64LE_g (*gonio_i_hdf.H5T_STD_I64LE_g)
#define H5T_C_S1_g (*gonio_i_hdf.H5T_C_S1_g)
#define H5T_NATIVE_FLOAT_g (*gonio_i_hdf.H5T_NATIVE_FLOAT_g)
#define H5T_NATIVE_DOUBLE_g (*gonio_i_hdf.H5T_NATIVE_DOUBLE_g)
#define H5T_NATIVE_INT64_g (*gonio_i_hdf.H5T_NATIVE_INT64_g)
#define H5P_CLS_FILE_CREATE_ID_g (*gonio_i_hdf.H5P_CLS_FILE_CREATE_ID_g)
#define H5P_CLS_FILE_ACCESS_ID_g (*gonio_i_hdf.H5P_CLS_FILE_ACCESS_ID_g)
#define H5P_CLS_DATASET_CREATE_ID_g (*gonio_i_hdf.H5P_CLS_DATASET_CREATE_ID_g)
#endif

#endif
