/* The fuzz targets: PLAIN(name) for fuzz_NAME.c, MUTATED(name) for one with its own changes. */
PLAIN(material)
PLAIN(grid)
PLAIN(hdf)
#ifndef GONIO_WITHOUT_RENDER
PLAIN(image)
PLAIN(mesh)
#endif
PLAIN(readings)
PLAIN(plan)
PLAIN(instrument)
PLAIN(run)
PLAIN(splits)
PLAIN(pieces)
MUTATED(results)
MUTATED(basis)
PLAIN(chain)
