/* Tables of any channels in HDF5: the layout that reader and writer share.
 *
 * Root attributes: format ("gonio BRDF table"), version (1), name, unit ("1/sr"). Datasets: rho,
 * float32 [channel][theta_h 90][theta_d 90][phi_d 180], NaN for no data; theta_h, theta_d, phi_d,
 * float64, the bins' centres in radians; wavelength_nm, float64 [channel], where channels are
 * wavelengths; otherwise there are three channels, R, G, B, or one. */
#ifndef GONIO_TABLE_FILE_H
#define GONIO_TABLE_FILE_H

#define GONIO_I_TABLE_FORMAT "gonio BRDF table"

enum { GONIO_I_TABLE_VERSION = 1, GONIO_I_TABLE_CHANNELS = 4096, GONIO_I_TABLE_RANK = 4 };

#endif
