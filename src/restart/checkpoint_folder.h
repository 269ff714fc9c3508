/* The files in a folder of checkpoints. */
#ifndef RG_CHECKPOINT_FOLDER_H
#define RG_CHECKPOINT_FOLDER_H

#include <stdbool.h>
#include <stdint.h>

/* The steps of all checkpoints in `folder`, newest first; returns how many. The caller frees *steps. */
int rg_folder_list(const char *folder, int64_t **steps);

/* folder/step-NNNNNNNNNNNN.h5; the caller frees it. */
char *rg_folder_path(const char *folder, int64_t step);

/* Removes what a killed run left half-written. */
void rg_folder_clean(const char *folder);

/* Removes all but the newest `keep` checkpoints. */
void rg_folder_prune(const char *folder, int keep);

#endif
