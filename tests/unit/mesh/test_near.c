/* Boxes that meet, against all pairs of them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/mem.h"
#include "mesh/near.h"
#include "support/dice.h"

enum { MOST = 150 };

typedef struct {
    const rg_near_box *box;
    int seen[MOST][MOST], visits;
} pairs;

static void see(void *context, int64_t i, int64_t j) {
    pairs *p = context;
    assert_true(p->box[i].part < p->box[j].part);
    p->seen[i][j]++;
    p->visits++;
}

static bool share(const rg_near_box *a, const rg_near_box *b) {
    return a->low[0] <= b->high[0] && b->low[0] <= a->high[0] && a->low[1] <= b->high[1] &&
           b->low[1] <= a->high[1] && a->low[2] <= b->high[2] && b->low[2] <= a->high[2];
}

/* How many meet. */
static int assert_all_pairs(const rg_near_box *box, int count) {
    static pairs p;
    int wanted = 0;
    p = (pairs){.box = box};
    rg_near_pairs(box, count, see, &p);
    for (int i = 0; i < count; i++) {
        for (int j = 0; j < count; j++) {
            bool meet = box[i].part < box[j].part && share(&box[i], &box[j]);
            assert_int_equal(p.seen[i][j], meet);
            wanted += meet;
        }
    }
    assert_int_equal(p.visits, wanted);
    return wanted;
}

/* Long and flat regions, sizes of boxes that differ a hundredfold, places on a lattice, where boxes meet in a
 * point; points alone. */
static void test_all_pairs(void **state) {
    (void)state;
    dice d = {3, 0};
    int few = 0, many = 0;
    for (int trial = 0; trial < 60; trial++) {
        rg_near_box box[MOST];
        int count = trial == 0 ? 0 : trial < 4 ? trial : MOST, parts = 1 + trial % 5;
        double region[3], size = dice_power(&d, -2, 0);
        for (int c = 0; c < 3; c++) {
            region[c] = trial % 7 == 6 && c == 1 ? 0 : dice_power(&d, -1, 1.3);
        }
        for (int i = 0; i < count; i++) {
            box[i].part = (int32_t)(dice_unit(&d) * parts);
            for (int c = 0; c < 3; c++) {
                double x = dice_sign(&d) * region[c] - 30, w = size * dice_power(&d, -1, 1);
                box[i].low[c] = trial % 3 == 0 ? floor(x) : x;
                box[i].high[c] = box[i].low[c] + (trial % 11 == 10 ? 0 : trial % 3 == 0 ? floor(3 * w) : w);
            }
        }
        int meet = assert_all_pairs(box, count);
        few += meet > 0 && meet < 100;
        many += meet > 500;
        assert_true(parts > 1 || meet == 0);
    }
    assert_true(few > 8 && many > 4);
    assert_int_equal(rg_alloc_blocks(), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_all_pairs)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
