/* Named sets that overlap: groups, combinations, joining. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/mem.h"
#include "mesh/sets.h"

static rg_sets make(void) {
    rg_sets s = {.count = 0};
    assert_int_equal(rg_sets_add(&s, "a"), 0);
    assert_int_equal(rg_sets_add(&s, "bee"), 1);
    assert_int_equal(rg_sets_add(&s, "c"), 2);
    assert_int_equal(rg_sets_add(&s, "d"), 3);
    assert_int_equal(rg_sets_combine(&s, 2, (const int32_t[]){0, 2}), 4);
    assert_int_equal(rg_sets_combine(&s, 3, (const int32_t[]){1, 2, 3}), 5);
    return s;
}

/* Bits of the sets of a group. */
static unsigned bits(const rg_sets *s, int32_t group) {
    unsigned sum = 0;
    int32_t count;
    const int32_t *set = rg_sets_of(s, &group, &count);
    for (int32_t i = 0; i < count; i++) {
        sum |= 1U << set[i];
        assert_true(i == 0 || set[i - 1] < set[i]);
    }
    for (int32_t k = 0; k < s->count; k++) {
        assert_int_equal(rg_sets_hold(s, group, k), sum >> k & 1);
    }
    return sum;
}

static void expect_all(const rg_sets *s) {
    static const unsigned expected[] = {0, 0, 1, 2, 4, 8, 5, 14}; /* of groups -2 to 5 */
    assert_int_equal(rg_sets_groups(s), 6);
    for (int32_t g = -2; g < 6; g++) {
        assert_int_equal(bits(s, g), expected[g + 2]);
    }
    for (int32_t k = 0; k < 4; k++) {
        bool *in = rg_sets_groups_in(s, k);
        for (int32_t g = 0; g < 6; g++) {
            assert_int_equal(in[g], expected[g + 2] >> k & 1);
        }
        rg_free(in);
    }
    assert_int_equal(rg_sets_find(s, "a"), 0);
    assert_int_equal(rg_sets_find(s, "bee"), 1);
    assert_int_equal(rg_sets_find(s, "d"), 3);
    assert_int_equal(rg_sets_find(s, "be"), -1);
}

static void test_groups(void **state) {
    (void)state;
    size_t before = rg_alloc_total();
    rg_sets s = make(), copy = rg_sets_copy(&s);
    expect_all(&s);
    rg_sets_free(&s);
    assert_int_equal(s.count, 0);
    expect_all(&copy);
    rg_sets_free(&copy);
    assert_int_equal(rg_alloc_total(), before);
}

/* Things of all 64 combinations of six sets, put into one set after the other: so many groups and no more,
 * and each holds what it should. */
static void test_joining(void **state) {
    (void)state;
    enum { SETS = 6, THINGS = 3 * 64 };
    static const char *const names[SETS] = {"0", "1", "2", "3", "4", "5"};
    rg_sets s = {.count = 0};
    int32_t group[THINGS];
    for (int k = 0; k < SETS; k++) {
        rg_sets_add(&s, names[k]);
    }
    rg_sets_joining join = {.sets = &s};
    memset(group, -1, sizeof group);
    for (int32_t k = 0; k < SETS; k++) {
        for (int i = 0; i < THINGS; i++) {
            for (int again = 0; again < 2 && ((i * 37) >> k & 1) != 0; again++) {
                group[i] = rg_sets_join(&join, group[i], k);
            }
        }
    }
    rg_sets_joined(&join);
    for (int i = 0; i < THINGS; i++) {
        assert_int_equal(bits(&s, group[i]), (unsigned)(i * 37) & 63);
    }
    assert_int_equal(s.combinations, 64 - 1 - SETS);
    rg_sets_free(&s);
}

/* In the other order: other combinations, but of the right sets, ascending. */
static void test_joining_backwards(void **state) {
    (void)state;
    rg_sets s = make();
    int32_t group[16];
    rg_sets_joining join = {.sets = &s};
    for (int i = 0; i < 16; i++) {
        group[i] = -1;
        for (int32_t k = 3; k >= 0; k--) {
            group[i] = (i >> k & 1) != 0 ? rg_sets_join(&join, group[i], k) : group[i];
        }
        group[i] = (i & 1) != 0 ? rg_sets_join(&join, group[i], 2) : group[i];
    }
    rg_sets_joined(&join);
    for (int i = 0; i < 16; i++) {
        assert_int_equal(bits(&s, group[i]), (unsigned)i | ((i & 1) != 0 ? 4U : 0));
    }
    rg_sets_free(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_groups),
        cmocka_unit_test(test_joining),
        cmocka_unit_test(test_joining_backwards),
    };
    int failed = cmocka_run_group_tests_name("sets", tests, NULL, NULL);
    return failed + (rg_alloc_blocks() > 0); /* all is given back */
}
