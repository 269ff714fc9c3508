/* What ranks tell each other, on any number of them: records and answers, exact sums, the lowest place, input
 * that is wrong. Prints TAP from rank 0. */
#include "base/exchange.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "base/exact_sum.h"
#include "base/input_errors.h"
#include "base/hash.h"
#include "base/mem.h"
#include "base/first_bad.h"
#include "support/tap_memory.h"

static int ranks;

/* ---- records ---- */

typedef struct {
    int from, number;
    char tail[3]; /* an odd size */
} record;

/* Record i of rank r goes there: in no order, and nothing to the last of three ranks. */
static int target(int r, int i) {
    return (int)(rg_hash((uint64_t)r, (uint64_t)i) % (uint64_t)(ranks == 3 ? 2 : ranks));
}

static int count_of(int r) {
    return r == 1 ? 0 : 100 + 10 * r; /* one that sends nothing */
}

static void test_exchange(void) {
    int mine = count_of(rank), *to = RG_NEW(int, (size_t)mine + 1);
    record *sent = RG_NEW(record, (size_t)mine + 1);
    for (int i = 0; i < mine; i++) {
        to[i] = target(rank, i);
        sent[i] = (record){rank, i, "xy"};
    }
    rg_exchange *x = rg_exchange_make(to, (size_t)mine, MPI_COMM_WORLD);
    size_t expected = 0;
    for (int r = 0; r < ranks; r++) {
        for (int i = 0; i < count_of(r); i++) {
            expected += target(r, i) == rank;
        }
    }
    report(x->arriving == expected && x->ranks == ranks && x->count == (size_t)mine, "exchange",
           "counts what comes");
    record *arrived = RG_NEW(record, expected + 2);
    arrived[expected].from = -7; /* the end of the room */
    rg_exchange_send(x, sizeof(record), sent, arrived);
    bool good = arrived[expected].from == -7;
    size_t at = 0;
    long *answer = RG_NEW(long, expected + 1);
    for (int r = 0; r < ranks; r++) {
        for (int i = 0; i < count_of(r); i++) {
            if (target(r, i) == rank) {
                record a = arrived[at];
                good = good && a.from == r && a.number == i && strcmp(a.tail, "xy") == 0;
                answer[at++] = 1000L * r + i + 1000000L * rank;
            }
        }
    }
    report(good, "exchange", "brings records by rank, each in its order");
    long *back = RG_NEW(long, (size_t)mine + 1);
    back[mine] = -9;
    rg_exchange_answer(x, sizeof(long), answer, back);
    good = back[mine] == -9;
    for (int i = 0; i < mine; i++) {
        good = good && back[i] == 1000L * rank + i + 1000000L * to[i];
    }
    report(good, "exchange", "brings answers back in the order of the records");
    rg_exchange_free(x);
    rg_exchange_free(NULL);
    rg_free(to);
    rg_free(sent);
    rg_free(arrived);
    rg_free(answer);
    rg_free(back);
}

/* ---- sums ---- */

static double addend(int r, int i) {
    uint64_t h = rg_hash((uint64_t)r, (uint64_t)i);
    return ldexp(rg_hash_uniform(h) - 0.5, (int)(h % 100) - 50);
}

static void test_sums(void) {
    rg_exact_sum sum[2][3] = {{{{0}, 0, 0}}}, all[3] = {{{0}, 0, 0}};
    for (int r = 0; r < ranks; r++) {
        for (int i = 0; i < 300; i++) {
            rg_exact_add(&all[i % 3], addend(r, i));
            for (int k = 0; k < 2 && r == rank; k++) {
                rg_exact_add(&sum[k][i % 3], addend(r, i));
            }
        }
    }
    MPI_Request request;
    rg_exact_allreduce(sum[0], 2, MPI_COMM_WORLD); /* the third stays */
    rg_exact_start_allreduce(sum[1], 3, MPI_COMM_WORLD, &request);
    MPI_Wait(&request, MPI_STATUS_IGNORE);
    bool good = true, moved = true;
    for (int i = 0; i < 3; i++) {
        moved = moved && sum[0][i].pending == (i < 2 ? 0 : 100) && sum[1][i].pending == 0;
        good = good && (i == 2 || rg_exact_value(&sum[0][i]) == rg_exact_value(&all[i]));
        good = good && rg_exact_value(&sum[1][i]) == rg_exact_value(&all[i]);
    }
    report(good, "exact sums", "over ranks have the bits of one");
    report(moved, "exact sums", "move their carries before they go");
}

/* ---- the lowest place ---- */

static void test_first_bad_values(void) {
    rg_first_bad none = {.which = RG_NOWHERE}, p = none;
    report(!rg_first_bad_lowest(&none, MPI_COMM_WORLD) && none.which == RG_NOWHERE, "place", "is nowhere");
    /* each replaces the one before, but for the marked ones */
    static const struct {
        int64_t which;
        double x[3];
        bool lower;
    } noted[] = {{5, {1, 1, 1}, true},  {5, {1, 1, 1}, false}, {5, {1, 1, 2}, false},  {5, {2, 0, 0}, false},
                 {6, {0, 0, 0}, false}, {5, {1, 1, 0}, true},  {5, {1, 2, -1}, false}, {5, {1, 0, 9}, true},
                 {5, {0, 9, 9}, true},  {4, {7, 8, 9}, true}};
    bool good = true;
    for (int i = 0; i < (int)(sizeof noted / sizeof *noted); i++) {
        double before = p.value;
        rg_first_bad_note(&p, noted[i].which, noted[i].x, i + 1);
        good = good && p.value == (noted[i].lower ? i + 1 : before);
    }
    report(good && p.which == 4 && p.x[0] == 7 && p.x[1] == 8 && p.x[2] == 9, "place", "is the lowest noted");
    for (int n = 0; n < 500; n++) { /* drawn at random */
        int digit[2][4];
        rg_first_bad q = {.which = RG_NOWHERE};
        for (int i = 0; i < 2; i++) {
            for (int k = 0; k < 4; k++) {
                digit[i][k] = (int)(rg_hash((uint64_t)n, (uint64_t)(4 * i + k)) % 3);
            }
            rg_first_bad_note(&q, digit[i][0], (const double[3]){digit[i][1], digit[i][2], digit[i][3]}, i);
        }
        int number_of[2];
        for (int i = 0; i < 2; i++) {
            number_of[i] = 27 * digit[i][0] + 9 * digit[i][1] + 3 * digit[i][2] + digit[i][3];
        }
        good = good && q.value == (number_of[1] < number_of[0]);
    }
    report(good, "place", "is the lower one of two");
    for (int lowest = 0; lowest < ranks; lowest++) { /* on one rank; others have it further on, or none */
        rg_first_bad q = {.which = RG_NOWHERE};
        if (rank == lowest || rank % 2 == 0) {
            rg_first_bad_note(&q, 3, (const double[3]){1, rank == lowest ? 0.5 : 2, -3}, 10 + rank);
        }
        good = rg_first_bad_lowest(&q, MPI_COMM_WORLD);
        report(good && q.which == 3 && q.x[0] == 1 && q.x[1] == 0.5 && q.x[2] == -3 && q.value == 10 + lowest,
               "place", "is the lowest of all ranks");
    }
    /* The first rank goes on to tell; the others wait until it comes to the same barrier, which here it does.
     */
    int told = 0, heard = 0;
    if (rank == 0) {
        told = 1;
        rg_speak(MPI_COMM_WORLD);
        for (int r = 1; r < ranks; r++) {
            MPI_Send(&told, 1, MPI_INT, r, 1, MPI_COMM_WORLD);
        }
        MPI_Barrier(MPI_COMM_WORLD);
    } else {
        MPI_Request request;
        MPI_Irecv(&heard, 1, MPI_INT, 0, 1, MPI_COMM_WORLD, &request);
        rg_speak(MPI_COMM_WORLD);
        MPI_Test(&request, &told, MPI_STATUS_IGNORE);
        MPI_Wait(&request, MPI_STATUS_IGNORE);
    }
    report(told && (rank == 0 || heard), "place", "is told by the first rank, for which others wait");
}

/* ---- faults ---- */

static bool kept(const rg_input_errors *f, int count, const int keys[][2], const char *words) {
    bool good = f->kept == count;
    for (int i = 0; i < count && good; i++) {
        char expected[64];
        snprintf(expected, sizeof expected, "%s %d %d", words, keys[i][0], keys[i][1]);
        good = f->input_error[i].key[0] == keys[i][0] && f->input_error[i].key[1] == keys[i][1] &&
               strcmp(f->input_error[i].words, expected) == 0;
    }
    return good;
}

/* Keys of fault k of `total`, in no order; distinct. */
static void key_of(int k, int total, int key[2]) {
    key[0] = k % 3 - 1;
    key[1] = 5 * k % total - total / 2;
}

/* Those of all of them, sorted. */
static void sorted_keys(int total, int keys[][2]) {
    for (int k = 0; k < total; k++) {
        int key[2], at = k;
        key_of(k, total, key);
        for (;
             at > 0 && (keys[at - 1][0] > key[0] || (keys[at - 1][0] == key[0] && keys[at - 1][1] > key[1]));
             at--) {
            memcpy(keys[at], keys[at - 1], sizeof key);
        }
        memcpy(keys[at], key, sizeof key);
    }
}

/* The lowest ten stay, in order; one says where its words go, or that they are not wanted. */
static void test_faults_of_one(void) {
    enum { TOTAL = 23 };
    rg_input_errors f = {.name = "f"};
    int keys[TOTAL][2];
    sorted_keys(TOTAL, keys);
    for (int k = 0; k < TOTAL; k++) {
        int key[2];
        key_of(k, TOTAL, key);
        rg_input_errors_add(&f, key[0], key[1], "fault %d %d", key[0], key[1]);
    }
    report(f.count == TOTAL && kept(&f, RG_INPUT_ERRORS_TOLD, (const int(*)[2])keys, "fault"), "faults",
           "the lowest ones are kept");
    const int64_t *last = f.input_error[9].key, *third = f.input_error[2].key;
    bool good = rg_input_errors_place(&f, last[0], last[1] + 1) == NULL && f.count == TOTAL + 1;
    char *words = rg_input_errors_place(&f, third[0], third[1] - 1);
    good = good && words == f.input_error[2].words && f.count == TOTAL + 2 && f.kept == RG_INPUT_ERRORS_TOLD;
    good = good && f.input_error[2].key[0] == keys[2][0] && f.input_error[2].key[1] == keys[2][1] - 1;
    for (int k = 3; k < RG_INPUT_ERRORS_TOLD; k++) {
        good = good && f.input_error[k].key[0] == keys[k - 1][0] && f.input_error[k].key[1] == keys[k - 1][1];
    }
    report(good, "faults", "a low one takes its place, and the last one goes");
    rg_input_errors_add(&f, -9, 0, "%0500d", 7);
    report(strlen(f.input_error[0].words) == RG_INPUT_ERROR_WORDS - 1, "faults", "long words are cut");
}

/* Fault k is on ranks k % ranks and (2 k + 1) % ranks, so some are brought twice, and told once. */
static void test_faults_of_all(int total, int told) {
    rg_input_errors f = {.name = rank == 0 ? "zero" : "other"}, all = {0};
    int64_t brought = 0;
    int keys[32][2];
    sorted_keys(total, keys);
    for (int n = 0; n < total; n++) {
        int k = n * 3 % total, key[2];
        key_of(k, total, key);
        for (int r = 0; r < ranks; r++) {
            bool once = k % ranks == r || (2 * k + 1) % ranks == r;
            brought += once;
            if (once && r == rank) {
                rg_input_errors_add(&f, key[0], key[1], "of all %d %d", key[0], key[1]);
            }
        }
    }
    bool good = rg_input_errors_gather(&f, &all, MPI_COMM_WORLD);
    if (rank == 0) {
        good = good && kept(&all, told, (const int(*)[2])keys, "of all") && strcmp(all.name, "zero") == 0;
        /* beyond those told, one that two ranks bring may count twice */
        good = good && (total <= RG_INPUT_ERRORS_TOLD ? all.count == total
                                                      : all.count >= total && all.count <= brought);
    }
    report(good, "faults", "of all ranks are told once, in order");
}

static void test_no_faults(void) {
    rg_input_errors f = {.name = "f"}, all = {.count = 77};
    report(!rg_input_errors_gather(&f, &all, MPI_COMM_WORLD) && all.count == 77, "faults", "are on no rank");
    rg_input_errors_agree(&f, MPI_COMM_WORLD); /* goes on */
    rg_input_errors_end(&f);
    f.count = rank == ranks - 1;
    f.kept = (int)f.count;
    f.input_error[0] = (rg_input_error){{3, 4}, "of all 3 4"};
    bool good = rg_input_errors_gather(&f, &all, MPI_COMM_WORLD);
    report(good && (rank != 0 || (all.count == 1 && kept(&all, 1, (const int[1][2]){{3, 4}}, "of all"))),
           "faults", "are on the last rank alone");
}

/* Two ranks say different things of one key: the lower word of them is told, whichever rank it comes from. */
static void test_words_of_one_fault(void) {
    for (int lower = 0; lower < ranks; lower++) {
        rg_input_errors f = {.name = "f"}, all = {0};
        rg_input_errors_add(&f, 1, 2, "%s", rank == lower ? "abc" : "b");
        rg_input_errors_gather(&f, &all, MPI_COMM_WORLD);
        report(rank != 0 || (all.count == 1 && all.kept == 1 && strcmp(all.input_error[0].words, "abc") == 0),
               "faults", "are told in the same words");
    }
}

int main(int argc, char **argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    test_exchange();
    test_sums();
    test_first_bad_values();
    test_faults_of_one();
    test_faults_of_all(8, 8);
    test_faults_of_all(7, 7);
    test_faults_of_all(29, RG_INPUT_ERRORS_TOLD);
    test_no_faults();
    test_words_of_one_fault();
    return finish_with_nothing_left();
}
