/* Memory: alignment, zeros, what is counted, and whoever writes more than he asked for. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/error.h"
#include "base/mem.h"
#include "support/child.h"
#include "support/sanitized.h"

enum { LARGE = 4 << 20 };

static void test_blocks(void **state) {
    (void)state;
    void *(*const alloc[])(size_t, size_t) = {rg_alloc, rg_alloc_sparse};
    static const size_t sizes[] = {0, 1, 7, 63, 64, 65, 1000, LARGE - 1, LARGE, LARGE + 1};
    size_t before = rg_alloc_total(), others = rg_alloc_blocks();
    for (size_t i = 0; i < 2 * sizeof sizes / sizeof *sizes; i++) {
        size_t size = sizes[i / 2];
        unsigned char *block[3];
        for (int k = 0; k < 3; k++) {
            block[k] = alloc[i % 2](size, 1);
            assert_int_equal((uintptr_t)block[k] % 64, 0);
            for (size_t n = 0; n < size; n += n < 100 || n + 100 > size ? 1 : 97) {
                assert_int_equal(block[k][n], 0);
            }
            memset(block[k], 0xab, size);
        }
        assert_int_equal(rg_alloc_total() - before, 3 * size);
        assert_int_equal(rg_alloc_blocks() - others, 3);
        rg_free(block[1]);
        assert_int_equal(rg_alloc_total() - before, 2 * size);
        assert_int_equal(rg_alloc_blocks() - others, 2);
        rg_free(block[0]);
        rg_free(block[2]);
        assert_int_equal(rg_alloc_total(), before);
        assert_int_equal(rg_alloc_blocks(), others);
    }
    rg_free(NULL);
    double *items = RG_NEW(double, 5);
    assert_int_equal(rg_alloc_total() - before, 5 * sizeof *items);
    rg_free(items);
}

/* What is grown keeps what it held, is not counted, and has room for half as much again and 64 more. */
static void test_growth(void **state) {
    (void)state;
    size_t before = rg_alloc_total(), others = rg_alloc_blocks(), room = 0, growths = 0;
    int *list = NULL;
    for (size_t n = 0; n < 1000; n++) {
        size_t had = room;
        list = rg_grow(list, &room, n, sizeof *list);
        if (room != had) {
            assert_int_equal(n, had);
            assert_int_equal(room, n + n / 2 + 64);
            growths++;
        }
        list[n] = (int)n;
    }
    assert_int_equal(growths, 6); /* at 0, 64, 160, 304, 520, 844 */
    for (size_t n = 0; n < 1000; n++) {
        assert_int_equal(list[n], n);
    }
    assert_int_equal(rg_alloc_total(), before);
    assert_int_equal(rg_alloc_blocks(), others + 1);
    rg_free(list);
    assert_int_equal(rg_alloc_blocks(), others);
    assert_int_equal(rg_alloc_total(), before);
}

/* ---- mistakes ---- */

static size_t wide;

static void write_behind(void) {
    volatile char *block = rg_alloc(wide, 1);
    block[wide] = 1;
    rg_free((void *)block);
}

static void write_behind_sparse(void) {
    volatile char *block = rg_alloc_sparse(wide, 1);
    block[wide + 7] = 1;
    rg_free((void *)block);
}

static void write_behind_grown(void) {
    volatile char *block = rg_realloc(rg_realloc(NULL, 3, 1), wide, 1);
    block[wide] = 1;
    rg_free((void *)block);
}

static void write_behind_before_growth(void) {
    volatile char *block = rg_realloc(NULL, wide, 1);
    block[wide] = 1;
    rg_realloc((void *)block, 2 * wide + 99, 1);
}

static void write_within(void) {
    char *block = rg_realloc(NULL, wide, 1);
    memset(block, 1, wide);
    rg_free(block);
}

static void test_writing_behind(void **state) {
    (void)state;
    void (*const job[])(void) = {write_behind, write_behind_sparse, write_behind_grown,
                                 write_behind_before_growth};
    static const size_t sizes[] = {0, 1, 64, 999, LARGE - 1};
    for (size_t i = 0; i < 4 * sizeof sizes / sizeof *sizes; i++) {
        char said[300], expected[300];
        wide = sizes[i / 4];
        snprintf(expected, sizeof expected,
                 "rhegma: a fault of this program: it wrote more than a block of %zu bytes holds\n", wide);
        assert_int_equal(run_child(job[i % 4], said, sizeof said), RG_FAILURE);
        assert_string_equal(said, expected);
        assert_int_equal(run_child(write_within, said, sizeof said), RG_OK);
    }
}

static void ask_for_too_much(void) {
    rg_alloc(SIZE_MAX / 4, 3);
}

static void ask_beyond_all_numbers(void) {
    rg_alloc(SIZE_MAX / 4, 8);
}

static void ask_sparse(void) {
    rg_alloc_sparse(SIZE_MAX / 8, 2);
}

static void ask_to_grow(void) {
    rg_realloc(NULL, SIZE_MAX / 4, 5);
}

static void test_too_much(void **state) {
    (void)state;
    static const struct {
        void (*job)(void);
        size_t count, size;
    } cases[] = {{ask_for_too_much, SIZE_MAX / 4, 3},
                 {ask_beyond_all_numbers, SIZE_MAX / 4, 8},
                 {ask_sparse, SIZE_MAX / 8, 2},
                 {ask_to_grow, SIZE_MAX / 4, 5}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases && !RG_SANITIZED;
         i++) { /* which refuses such sizes by itself */
        char said[300], expected[300];
        snprintf(expected, sizeof expected, "rhegma: out of memory: %zu items of %zu bytes\n", cases[i].count,
                 cases[i].size);
        assert_int_equal(run_child(cases[i].job, said, sizeof said), RG_FAILURE);
        assert_string_equal(said, expected);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_blocks),
        cmocka_unit_test(test_growth),
        cmocka_unit_test(test_writing_behind),
        cmocka_unit_test(test_too_much),
    };
    return cmocka_run_group_tests_name("mem", tests, NULL, NULL);
}
