/* Changes of HDF5 files for fuzz targets, from single bytes, and what a reader leaves behind. */
#ifndef RG_FUZZ_H5_CHANGES_H
#define RG_FUZZ_H5_CHANGES_H

#include <hdf5.h>
#include <stdbool.h>
#include <stdint.h>

/* A value that is near, far, at a limit or (of doubles) not finite. */
int64_t rg_fuzz_integer(uint8_t code);
double rg_fuzz_real(uint8_t code);

/* Gives an integer attribute this value, or puts one of other type and size in its place. */
void rg_fuzz_change_attribute(hid_t object, const char *name, int64_t value, bool other_type);

/* Another dataset in place of this one: none, without values, of any size and type. */
void rg_fuzz_change_shape(hid_t file, const char *name, int64_t rows, uint8_t code);

/* HDF5 keeps what it has freed for what comes, and says nothing of errors. To be called first. */
void rg_fuzz_h5_begin(void);

/* Closes what a reader that refused the file left open; now and then also what is tied to no file. */
void rg_fuzz_h5_close(void);

#endif
