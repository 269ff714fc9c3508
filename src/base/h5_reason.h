/* Why a call of HDF5 failed, in one line instead of the error stack that it prints by itself. */
#ifndef RG_H5_REASON_H
#define RG_H5_REASON_H

#include <hdf5.h>

enum { RG_H5_REASON = 200 };

/* From now on the first failure of HDF5 leaves its cause in reason[RG_H5_REASON], an empty text until then.
 * The calls that clean up afterwards fail or clear the stack, so the first cause counts. */
void rg_h5_listen(char *reason);

/* Back to HDF5's own way. */
void rg_h5_deafen(void);

#endif
