/* Sums, element arithmetic and principal values that everything else trusts. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "element.h"
#include "exact_sum.h"
#include "hash.h"
#include "principal.h"

enum { COUNT = 5000 };

static double sample(int i) {
    uint64_t h = rg_hash(7, (uint64_t)i);
    double magnitude = ldexp(rg_hash_uniform(h), (int)(h % 200) - 100);
    return (h & 512) != 0 ? magnitude : -magnitude;
}

static uint64_t bits_of(double x) {
    uint64_t b;
    memcpy(&b, &x, sizeof b);
    return b;
}

static void test_sum_ignores_order(void **state) {
    (void)state;
    rg_exact_sum forward = {0}, backward = {0}, split[3] = {{{0}, 0, 0}};
    double plain_forward = 0, plain_backward = 0;
    for (int i = 0; i < COUNT; i++) {
        rg_exact_add(&forward, sample(i));
        rg_exact_add(&backward, sample(COUNT - 1 - i));
        rg_exact_add(&split[i % 3], sample(i));
        plain_forward += sample(i);
        plain_backward += sample(COUNT - 1 - i);
    }
    rg_exact_merge(&split[0], &split[2]);
    rg_exact_merge(&split[0], &split[1]);
    uint64_t expected = bits_of(rg_exact_value(&forward));
    assert_int_equal(expected, bits_of(rg_exact_value(&backward)));
    assert_int_equal(expected, bits_of(rg_exact_value(&split[0])));
    assert_int_not_equal(bits_of(plain_forward), bits_of(plain_backward)); /* the data do tell orders apart */
}

static void test_sum_is_exact(void **state) {
    (void)state;
    rg_exact_sum s = {0};
    rg_exact_add(&s, 1e300);
    rg_exact_add(&s, 3.5);
    rg_exact_add(&s, -1e300);
    rg_exact_add(&s, 0x1p-1074);
    rg_exact_add(&s, -0.5);
    assert_true(rg_exact_value(&s) == 3.0);
    rg_exact_add(&s, -3.0);
    assert_true(rg_exact_value(&s) == 0x1p-1074);
    rg_exact_add(&s, -0x1p-1073);
    assert_true(rg_exact_value(&s) == -0x1p-1074);
    rg_exact_add(&s, NAN);
    assert_true(isnan(rg_exact_value(&s)));
}

static void test_mass_and_inverse(void **state) {
    (void)state;
    for (int lumped = 0; lumped < 2; lumped++) {
        double total = 0;
        for (int a = 0; a < RG_NODES; a++) {
            for (int b = 0; b < RG_NODES; b++) {
                double product = 0;
                for (int k = 0; k < RG_NODES; k++) {
                    product += rg_mass_entry(lumped, a, k) * rg_inverse_mass_entry(lumped, k, b);
                }
                assert_true(fabs(product - (a == b)) < 1e-13);
                total += rg_mass_entry(lumped, a, b);
            }
        }
        assert_true(fabs(total - 1) < 1e-14);
    }
}

static void test_shape_functions(void **state) {
    (void)state;
    const double corner[12] = {1, 0.1, 0, 0.2, 2, 0.3, -0.1, 0.4, 3, 0.5, 0.5, 0.5};
    for (int n = 0; n < RG_NODES; n++) {
        double x[3], l[4], N[RG_NODES];
        rg_node_position(corner, n, x);
        rg_barycentric(corner, x, l);
        rg_shape(l, N);
        for (int m = 0; m < RG_NODES; m++) {
            assert_true(fabs(N[m] - (m == n)) < 1e-13);
        }
    }
}

static void test_principal_values(void **state) {
    (void)state;
    const double turn = 0.7, value[3] = {5, 2, -3};
    double c = cos(turn), s = sin(turn),
           out[3]; /* diag(5, 2, -3) turned about z, then checked by invariants */
    const double tensor[6] = {5 * c * c + 2 * s * s, 5 * s * s + 2 * c * c, -3, 0, 0, (5 - 2) * s * c};
    rg_principal(tensor, out);
    for (int k = 0; k < 3; k++) {
        assert_true(fabs(out[k] - value[k]) < 1e-13);
    }
    const double general[6] = {1, 2, 3, 0.5, -0.7, 0.9};
    rg_principal(general, out);
    double det = 1 * (2 * 3 - 0.25) - 0.9 * (0.9 * 3 - 0.5 * -0.7) + -0.7 * (0.9 * 0.5 - 2 * -0.7);
    assert_true(fabs(out[0] + out[1] + out[2] - 6) < 1e-13);
    assert_true(fabs(out[0] * out[1] * out[2] - det) < 1e-12);
    assert_true(out[0] >= out[1] && out[1] >= out[2]);
    const double equal[6] = {4, 4, 4, 0, 0, 0};
    rg_principal(equal, out);
    assert_true(out[0] == 4 && out[1] == 4 && out[2] == 4);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sum_ignores_order), cmocka_unit_test(test_sum_is_exact),
        cmocka_unit_test(test_mass_and_inverse),  cmocka_unit_test(test_shape_functions),
        cmocka_unit_test(test_principal_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
