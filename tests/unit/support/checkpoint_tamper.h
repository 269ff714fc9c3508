/* Checkpoints that hold something else than they should: changes of their HDF5 files. */
#ifndef RG_TEST_CHECKPOINT_TAMPER_H
#define RG_TEST_CHECKPOINT_TAMPER_H

#include <hdf5.h>
#include <stdint.h>

typedef struct {
    const char *name,
        *words;       /* what the file then has; what is said of it, NULL: that it does not hold the state */
    const char *gone; /* object that is deleted; NULL: the change is one of its own */
} checkpoint_change;

enum { CHECKPOINT_TAMPERS = 26 };
extern const checkpoint_change checkpoint_tampers[CHECKPOINT_TAMPERS];

/* Changes a file of the test's random state in one of these ways. */
void checkpoint_tamper(hid_t file, int which);

/* Puts another text in the place of an attribute. */
void put_text(hid_t file, const char *name, const char *value);

/* The dataset `path`, which must be [*rows][columns] of this type (*rows negative: any number, which it
 * becomes); NULL otherwise. The caller owns the result. */
void *load(hid_t file, const char *path, hid_t type, int64_t *rows, int columns);

#endif
