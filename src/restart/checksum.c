#include "restart/checksum.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/hash.h"
#include "base/mem.h"

enum { WORDS = 1 << 17, PART = 8 * WORDS, LANES = 4 }; /* of a part, its bytes */

/* Hash of words in LANES chains, which the processor follows at once. */
static uint64_t hash_words(uint64_t seed, const uint64_t *word, size_t words) {
    uint64_t h[LANES];
    for (uint64_t k = 0; k < LANES; k++) {
        h[k] = rg_hash(seed, k);
    }
    size_t i = 0;
    for (; i + LANES <= words; i += LANES) {
        for (size_t k = 0; k < LANES; k++) {
            h[k] = rg_hash(h[k], word[i + k]);
        }
    }
    for (; i < words; i++) {
        h[i % LANES] = rg_hash(h[i % LANES], word[i]);
    }
    return rg_hash(rg_hash(h[0], h[1]), rg_hash(h[2], h[3]));
}

/* All bytes from `at`, as many as there are up to `size`; -1 on failure. */
static ssize_t read_all(int file, char *data, size_t size, off_t at) {
    size_t got = 0;
    while (got < size) {
        ssize_t n = pread(file, data + got, size - got, at + (off_t)got);
        if (n < 0) {
            return -1;
        }
        if (n == 0) {
            break;
        }
        got += (size_t)n;
    }
    return (ssize_t)got;
}

/* Hash of part p; false, with errno set where that helps: it cannot be read or is shorter. */
static bool hash_part(int file, int64_t bytes, int64_t p, uint64_t *data, uint64_t *hash) {
    int64_t at = RG_CHECKSUM + p * PART, left = bytes - at;
    size_t size = left < PART ? (size_t)left : PART, words = (size + 7) / 8;
    data[words - 1] = 0;
    errno = 0;
    bool ok = read_all(file, (char *)data, size, at) == (ssize_t)size;
    *hash = ok ? hash_words((uint64_t)p + 1, data, words) : 0;
    return ok;
}

/* Sum over this rank's parts, which its threads share; false, with errno set where that helps, if the file
 * cannot be read or is shorter. */
static bool sum_parts(int file, int64_t bytes, int rank, int ranks, uint64_t *sum) {
    int64_t parts = (bytes - RG_CHECKSUM + PART - 1) / PART;
    uint64_t all = 0;
    int failed = -1; /* errno of a thread, 0 included */
#pragma omp parallel reduction(+ : all) reduction(max : failed)
    {
        uint64_t *data = RG_NEW(uint64_t, WORDS), hash;
#pragma omp for schedule(static)
        for (int64_t p = rank; p < parts; p += ranks) {
            if (hash_part(file, bytes, p, data, &hash)) {
                all += hash;
            } else {
                failed = errno;
            }
        }
        rg_free(data);
    }
    *sum = all;
    errno = failed < 0 ? errno : failed;
    return failed < 0;
}

/* Collective: sum over the file; false everywhere if some rank cannot read it. */
static bool sum_file(const char *path, int64_t bytes, MPI_Comm comm, uint64_t *sum) {
    int rank, ranks;
    MPI_Comm_rank(comm, &rank);
    MPI_Comm_size(comm, &ranks);
    int file = open(path, O_RDONLY);
    uint64_t found[2] = {0, 0};
    found[1] = file < 0 || !sum_parts(file, bytes, rank, ranks, &found[0]);
    if (file >= 0) {
        close(file);
    }
    MPI_Allreduce(MPI_IN_PLACE, found, 2, MPI_UINT64_T, MPI_SUM, comm);
    *sum = found[0];
    return found[1] == 0;
}

static void render(char checksum[RG_CHECKSUM], int64_t step, int64_t bytes, uint64_t sum) {
    memset(checksum, 0, RG_CHECKSUM);
    int used = snprintf(checksum, RG_CHECKSUM,
                        "rhegma checkpoint 1\nstep %" PRId64 "\nbytes %" PRId64 "\nsum %016" PRIx64 "\n",
                        step, bytes, sum);
    uint64_t word[RG_CHECKSUM / 8];
    memcpy(word, checksum, RG_CHECKSUM);
    char line[32];
    snprintf(line, sizeof line, "check %016" PRIx64 "\n", hash_words(0, word, RG_CHECKSUM / 8));
    memcpy(checksum + used, line, strlen(line));
}

static int64_t size_of(const char *path) {
    struct stat found;
    return stat(path, &found) == 0 ? (int64_t)found.st_size : -1;
}

static bool write_checksum(const char *path, const char checksum[RG_CHECKSUM]) {
    int file = open(path, O_WRONLY);
    bool ok = file >= 0 && pwrite(file, checksum, RG_CHECKSUM, 0) == RG_CHECKSUM;
    int reason = errno;
    ok = (file < 0 || close(file) == 0) && ok;
    errno = reason;
    return ok;
}

bool rg_checksum_put(const char *path, int64_t step, MPI_Comm comm) {
    int rank, ok = 1;
    uint64_t sum;
    MPI_Comm_rank(comm, &rank);
    int64_t bytes = rank == 0 ? size_of(path) : 0;
    MPI_Bcast(&bytes, 1, MPI_INT64_T, 0, comm);
    if (bytes < RG_CHECKSUM || !sum_file(path, bytes, comm, &sum)) {
        return false;
    }
    if (rank == 0) {
        char checksum[RG_CHECKSUM];
        render(checksum, step, bytes, sum);
        ok = write_checksum(path, checksum);
    }
    MPI_Bcast(&ok, 1, MPI_INT, 0, comm);
    return ok;
}

/* Rank 0: whether the checksum itself is right and the file as long as it says. */
static bool checksum_right(const char *path, int64_t *bytes, uint64_t *sum, char *reason, size_t size) {
    char found[RG_CHECKSUM + 1] = {0}, wanted[RG_CHECKSUM];
    int64_t step = 0, there = size_of(path);
    int file = open(path, O_RDONLY);
    ssize_t got = file < 0 ? -1 : read_all(file, found, RG_CHECKSUM, 0);
    if (got < 0) {
        snprintf(reason, size, "cannot be read: %s", strerror(errno));
    }
    if (file >= 0) {
        close(file);
    }
    if (got < 0) {
        return false;
    }
    if (sscanf(found, "rhegma checkpoint 1 step %" SCNd64 " bytes %" SCNd64 " sum %" SCNx64, &step, bytes,
               sum) != 3) {
        snprintf(reason, size, "its head is not that of a checkpoint");
        return false;
    }
    render(wanted, step, *bytes, *sum);
    if (memcmp(found, wanted, RG_CHECKSUM) != 0) {
        snprintf(reason, size, "its head is damaged");
        return false;
    }
    if (there != *bytes) {
        snprintf(reason, size, "it has %" PRId64 " bytes and should have %" PRId64, there, *bytes);
        return false;
    }
    return true;
}

bool rg_checksum_holds(const char *path, MPI_Comm comm, char *reason, size_t size) {
    struct {
        int64_t right, bytes;
        uint64_t sum;
    } head = {0, 0, 0};
    int rank;
    MPI_Comm_rank(comm, &rank);
    reason[0] = '\0';
    if (rank == 0) {
        head.right = checksum_right(path, &head.bytes, &head.sum, reason, size);
    }
    MPI_Bcast(&head, (int)sizeof head, MPI_BYTE, 0, comm);
    MPI_Bcast(reason, (int)size, MPI_CHAR, 0, comm);
    if (!head.right) {
        return false;
    }
    uint64_t sum = 0;
    if (!sum_file(path, head.bytes, comm, &sum)) {
        snprintf(reason, size, "it cannot be read to its end");
        return false;
    }
    if (sum != head.sum) {
        snprintf(reason, size, "its checksum is wrong: it is damaged");
        return false;
    }
    return true;
}
