/* The checksum of a checkpoint: 512 bytes in front of the HDF5 file (its user block) that fingerprint every
 * byte behind them, and themselves. A file is opened by HDF5 only if its checksum is right: no damaged byte
 * ever reaches that library's parser.
 *
 * Text, filled up with zeros:
 *
 *   rhegma checkpoint 1
 *   step N
 *   bytes N          of the whole file
 *   sum H            of what is behind the checksum
 *   check H          hash of the lines above
 *
 * What is behind the checksum is taken in 64-bit words (the last one filled up with zeros) and in parts of 1
 * MiB; its sum is that of the parts' hashes, each seeded with its number: ranks and threads share the parts.
 */
#ifndef RG_CHECKSUM_H
#define RG_CHECKSUM_H

#include <mpi.h>
#include <stdbool.h>
#include <stdint.h>
#include <stddef.h>

enum { RG_CHECKSUM = 512 };

/* Reads the file and writes its checksum, which it leaves to the caller to bring to the disk; collective.
 * False, with errno set where that helps: it cannot be read or written; on all ranks alike. */
bool rg_checksum_put(const char *path, int64_t step, MPI_Comm comm);

/* Whether the file is what was written; collective, the same everywhere. If not, `reason` (on every rank)
 * says what is wrong with it. */
bool rg_checksum_holds(const char *path, MPI_Comm comm, char *reason, size_t size);

#endif
