/* The checksum of checkpoints, on any number of ranks: whatever bit is flipped, whatever is cut off or added,
 * it is noticed. Prints TAP. */
#include "restart/checksum.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/hash.h"
#include "base/mem.h"
#include "support/tap.h"

enum { PLANNED = 12, PART = 1 << 20, BYTES = RG_CHECKSUM + 2 * (1 << 20) + 12345, RANDOM = 1000 };

static int ranks;
static char path[200], reason[300];
static bool agreed = true;

/* Where the file seems to end: it may get shorter after its size was asked for. */
static off_t seen_end = INT64_MAX;
ssize_t __wrap_pread64(int file, void *data, size_t size, off_t at);
ssize_t __real_pread64(int file, void *data, size_t size, off_t at);

ssize_t __wrap_pread64(int file, void *data, size_t size, off_t at) {
    off_t left = seen_end > at ? seen_end - at : 0;
    return __real_pread64(file, data, left < (off_t)size ? (size_t)left : size, at);
}

/* What rank 0 finds, so that all ranks go on alike; notes whether all found that. */
static bool holds(void) {
    MPI_Barrier(MPI_COMM_WORLD);
    bool mine = rg_checksum_holds(path, MPI_COMM_WORLD, reason, sizeof reason), good = mine;
    MPI_Bcast(&good, 1, MPI_C_BOOL, 0, MPI_COMM_WORLD);
    agreed = agreed && mine == good;
    MPI_Barrier(MPI_COMM_WORLD);
    return good;
}

static void flip(off_t position, int bit) {
    if (rank == 0) {
        unsigned char byte;
        int file = open(path, O_RDWR);
        bool good = pread(file, &byte, 1, position) == 1;
        byte ^= (unsigned char)(1 << bit);
        if (!good || pwrite(file, &byte, 1, position) != 1) {
            printf("Bail out! %s cannot be changed\n", path);
            MPI_Abort(MPI_COMM_WORLD, 1);
        }
        close(file);
    }
}

/* Whether the file is refused for that reason on every rank. */
static bool refused(const char *why) {
    int good = !holds() && strcmp(reason, why) == 0, all;
    if (!good) {
        printf("# '%s', not '%s'\n", reason, why);
    }
    MPI_Allreduce(&good, &all, 1, MPI_INT, MPI_LAND, MPI_COMM_WORLD);
    return all;
}

/* Whether the file is refused with this bit flipped, and taken once it is flipped back. */
static bool noticed(off_t position, int bit) {
    flip(position, bit);
    bool good = !holds() && reason[0] != '\0';
    flip(position, bit);
    return good;
}

/* Also runs of the same byte. */
static char byte_at(size_t i) {
    return i < RG_CHECKSUM ? 0 : (char)rg_mix(i / 3);
}

static void write_bytes(size_t bytes) {
    char *data = RG_NEW(char, bytes);
    for (size_t i = 0; i < bytes; i++) {
        data[i] = byte_at(i);
    }
    int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (file < 0 || write(file, data, bytes) != (ssize_t)bytes) {
        printf("Bail out! %s cannot be written\n", path);
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    close(file);
    rg_free(data);
}

static void write_file(void) {
    write_bytes(BYTES);
}

/* The sum of such a file, word after word: each goes on with one of four chains of its part. */
static uint64_t plain_sum(size_t bytes) {
    uint64_t sum = 0;
    for (size_t part = RG_CHECKSUM, p = 1; part < bytes; part += PART, p++) {
        uint64_t h[4] = {rg_hash(p, 0), rg_hash(p, 1), rg_hash(p, 2), rg_hash(p, 3)};
        for (size_t i = 0; i < PART && part + i < bytes; i += 8) {
            uint64_t word = 0;
            char *byte = (char *)&word;
            for (size_t k = 0; k < 8 && part + i + k < bytes; k++) {
                byte[k] = byte_at(part + i + k);
            }
            h[i / 8 % 4] = rg_hash(h[i / 8 % 4], word);
        }
        sum += rg_hash(rg_hash(h[0], h[1]), rg_hash(h[2], h[3]));
    }
    return sum;
}

/* Files that end at the end of a part, of a word and of four words, and one byte before and after it. */
static void check_sums(void) {
    static const size_t ends[] = {8, 16, 24, 32, 40, PART - 8, PART, PART + 8, 2 * PART - 24, 2 * PART};
    bool good = true;
    for (size_t k = 0; k < 3 * sizeof ends / sizeof *ends; k++) {
        size_t bytes = RG_CHECKSUM + ends[k / 3] + k % 3 - 1;
        if (rank == 0) {
            write_bytes(bytes);
        }
        MPI_Barrier(MPI_COMM_WORLD);
        good = rg_checksum_put(path, 5, MPI_COMM_WORLD) && good;
        if (rank == 0) {
            char found[RG_CHECKSUM + 1] = {0};
            int file = open(path, O_RDONLY);
            const char *sum =
                pread(file, found, RG_CHECKSUM, 0) == RG_CHECKSUM ? strstr(found, "sum ") : NULL;
            good = sum != NULL && strtoull(sum + 4, NULL, 16) == plain_sum(bytes) && good;
            close(file);
        }
    }
    report(good, "checksum", "its sum, word after word");
}

static void check_bits(void) {
    bool head = true, body = true;
    int every = ranks == 1 ? 1 : 32; /* several ranks: that they agree */
    for (int bit = 0; bit < 8 * RG_CHECKSUM; bit += every) {
        head = noticed(bit / 8, bit % 8) && head;
    }
    report(head, "checksum", "its bits: all of them, on one rank");
    for (uint64_t i = 0; i < RANDOM; i += (uint64_t)every) {
        uint64_t h = rg_hash(1, i);
        off_t position = RG_CHECKSUM + (off_t)(rg_hash_uniform(h) * (BYTES - RG_CHECKSUM));
        body = noticed(position, (int)(h % 8)) && body;
    }
    body = noticed(RG_CHECKSUM, 0) && body;
    body = noticed(BYTES - 1, 7) && body;
    report(body, "checksum", "bits of what it covers: 1,000 on one rank, and the first and the last");
    report(holds(), "checksum", "the file as it was");
}

static void check_length(void) {
    bool good = true;
    const off_t lengths[] = {0,         1,         100,      RG_CHECKSUM - 1, RG_CHECKSUM, RG_CHECKSUM + 1,
                             BYTES / 2, BYTES - 1, BYTES + 1};
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        if (rank == 0) {
            write_file();
        }
        MPI_Barrier(MPI_COMM_WORLD);
        good = rg_checksum_put(path, 77, MPI_COMM_WORLD) && holds() && good;
        good = (rank != 0 || truncate(path, lengths[i]) == 0) && good;
        char why[100];
        snprintf(why, sizeof why, "it has %lld bytes and should have %d", (long long)lengths[i], BYTES);
        good = refused(lengths[i] < 100 ? "its head is not that of a checkpoint" : why) && good;
    }
    report(good, "checksum", "any other length");
}

static void check_end(void) {
    seen_end = BYTES - 1;
    bool good = refused("it cannot be read to its end") && !rg_checksum_put(path, 77, MPI_COMM_WORLD);
    seen_end = INT64_MAX;
    report(good && holds(), "checksum", "a file that gets shorter while it is read");
}

/* What is written stays readable for later versions: of a file of 3 parts, by any number of ranks. */
static void check_text(void) {
    static const char wanted[] =
        "rhegma checkpoint 1\nstep 77\nbytes 2110009\nsum 173403126ea03d38\ncheck 25686768156c05eb\n";
    char found[RG_CHECKSUM + 1] = {0};
    bool good = true;
    if (rank == 0) {
        int file = open(path, O_RDONLY);
        good = pread(file, found, RG_CHECKSUM, 0) == RG_CHECKSUM && strcmp(found, wanted) == 0;
        for (size_t i = strlen(wanted); i < RG_CHECKSUM; i++) {
            good = good && found[i] == '\0';
        }
        close(file);
    }
    if (!good) {
        printf("# %s", found);
    }
    report(good, "checksum", "its text");
}

static void check_reasons(void) {
    flip(3, 0);
    bool good = refused("its head is not that of a checkpoint");
    flip(3, 0);
    flip(RG_CHECKSUM - 1, 6);
    good = refused("its head is damaged") && good;
    flip(RG_CHECKSUM - 1, 6);
    flip(BYTES - 5, 2);
    good = refused("its checksum is wrong: it is damaged") && good;
    flip(BYTES - 5, 2);
    report(good, "checksum", "what is wrong");
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    if (rank == 0) {
        printf("1..%d\n", PLANNED);
        snprintf(path, sizeof path, "/tmp/test_checksum.XXXXXX");
        close(mkstemp(path));
        write_file();
    }
    MPI_Bcast(path, sizeof path, MPI_CHAR, 0, MPI_COMM_WORLD);
    report(!holds(), "checksum", "a file without one");
    report(rg_checksum_put(path, 77, MPI_COMM_WORLD) && holds(), "checksum", "a file with it");
    check_text();
    check_reasons();
    check_bits();
    check_end();
    check_length();
    check_sums();
    if (rank == 0) {
        unlink(path);
    }
    MPI_Barrier(MPI_COMM_WORLD);
    report(refused("cannot be read: No such file or directory") && !rg_checksum_put(path, 77, MPI_COMM_WORLD),
           "checksum", "no file");
    report(agreed, "checksum", "all ranks find the same");
    MPI_Finalize();
    return failures > 0 || number != PLANNED;
}
