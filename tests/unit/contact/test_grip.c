/* What friction remembers: a list of pairs against plain loops, through searches and rows of a checkpoint. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/mem.h"
#include "contact/grip.h"
#include "support/dice.h"

enum { SIDE = 9 }; /* faces 0 to 8, by 10 */

/* What a pair holds: each value another one, and of some pairs nothing. */
static void hold(int a, int b, double value[RG_GRIP]) {
    for (int k = 0; k < RG_GRIP; k++) {
        value[k] = 1000 * a + 100 * b + k;
    }
    value[RG_GRIP_STIFFNESS] = (a + b) % 3 == 0 ? 0 : 0.25 * (a + b);
}

static rg_grips make(void) {
    rg_grips g = {0};
    for (int k = 0; k < SIDE * SIDE; k++) {
        double value[RG_GRIP];
        hold(k / SIDE, k % SIDE, value);
        if (k / SIDE < k % SIDE) {
            rg_grips_add(&g, 10 * (k / SIDE), 10 * (k % SIDE), value);
        }
    }
    return g;
}

/* All pairs of numbers up to 99 are asked for in turn, those that are not there too. */
static void assert_holds(const rg_grips *g, int every) {
    size_t at = 0, found = 0;
    for (int k = 0; k < 10000; k += every) {
        int a = k / 100, b = k % 100;
        double value[RG_GRIP], wanted[RG_GRIP] = {0};
        bool there = a % 10 == 0 && b % 10 == 0 && a < b && b < 10 * SIDE && (a + b) / 10 % 3 != 0;
        memset(value, 1, sizeof value);
        if (there) {
            hold(a / 10, b / 10, wanted);
            found++;
        }
        rg_grips_find(g, &at, a, b, value);
        assert_memory_equal(value, wanted, sizeof value);
    }
    assert_true(found > 1);
    assert_true(every > 1 || found == g->count);
}

static void test_search(void **state) {
    (void)state;
    rg_grips g = make();
    assert_true(g.count == 24);
    assert_holds(&g, 1);
    assert_holds(&g, 20); /* as a search that has lost pairs */
    rg_grips_clear(&g);
    assert_true(g.count == 0 && g.room == 0 && g.grip == NULL);
    assert_int_equal(rg_alloc_blocks(), 0);
}

/* Both faces of a pair bring it, or one of them, in any order; what was there before goes. */
static void test_rows(void **state) {
    (void)state;
    dice d = {7, 0};
    rg_grips g = make(), back = {0};
    int64_t key[100];
    double row[100][RG_GRIP_ROW], old[RG_GRIP];
    size_t rows = 0;
    for (size_t i = 0; i < 2 * g.count; i++) {
        const rg_grip *from = &g.grip[i / 2];
        if (i / 2 % 3 == 2 || i / 2 % 3 == i % 2) {
            key[rows] = from->face[i % 2];
            rg_grips_row(from->face[1 - i % 2], from->value, row[rows++]);
        }
    }
    assert_true(rows > g.count);
    for (size_t i = 1; i < rows; i++) {
        size_t k = (size_t)(dice_unit(&d) * (double)(i + 1));
        int64_t was = key[i];
        double moved[RG_GRIP_ROW];
        key[i] = key[k];
        key[k] = was;
        memcpy(moved, row[i], sizeof moved);
        memcpy(row[i], row[k], sizeof moved);
        memcpy(row[k], moved, sizeof moved);
    }
    hold(1, 1, old);
    rg_grips_add(&back, 10, 11, old);
    rg_grips_take(&back, rows, key, row[0]);
    assert_true(back.count == g.count);
    assert_holds(&back, 1);
    rg_grips_take(&back, 0, key, row[0]);
    assert_true(back.count == 0);
    rg_grips_clear(&back);
    rg_grips_clear(&g);
    assert_int_equal(rg_alloc_blocks(), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_search), cmocka_unit_test(test_rows)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
