/* Sums, element arithmetic, principal values, hashes, the Hilbert curve and more that everything else trusts.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/exact_sum.h"
#include "base/hash.h"
#include "base/hilbert.h"
#include "base/json.h"
#include "base/principal.h"
#include "base/tet.h"
#include "base/vector.h"
#include "domain/element.h"
#include "support/dice.h"

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

/* Every exponent, so every place in every limb; and that what is added goes when it is taken away. */
static void test_sum_of_one(void **state) {
    (void)state;
    rg_exact_sum rest = {0};
    for (unsigned exponent = 0; exponent < 0x7ff; exponent++) {
        uint64_t bits = (uint64_t)exponent << 52 | rg_hash(exponent, 1) >> 12;
        double x;
        memcpy(&x, &bits, sizeof x);
        for (int sign = -1; sign <= 1; sign += 2) {
            rg_exact_sum s = {0};
            rg_exact_add(&s, sign * x);
            assert_int_equal(s.pending, 1);
            rg_exact_add(&rest, sign * x);
            assert_true(rg_exact_value(&s) == sign * x);
            assert_int_equal(s.pending, 0);
        }
        rg_exact_add(&rest, -0x1p-70);
        assert_true(rg_exact_value(&rest) == -0x1p-70 * (exponent + 1));
    }
}

/* Against whole numbers, and the same bits for the negative. */
static void test_sum_of_integers(void **state) {
    (void)state;
    dice d = {11, 0};
    for (int n = 0; n < 300; n++) {
        rg_exact_sum s = {0}, minus = {0}, part[2] = {{{0}, 0, 0}};
        int64_t total = 0;
        for (int i = 0; i < 20; i++) {
            int64_t x = (int64_t)(dice_sign(&d) * 0x1p46);
            total += x;
            rg_exact_add(&s, ldexp((double)x, n - 150));
            rg_exact_add(&minus, -ldexp((double)x, n - 150));
            rg_exact_add(&part[i % 2], ldexp((double)x, n - 150));
        }
        rg_exact_merge(&part[0], &part[1]);
        assert_true(part[0].pending == 0 && part[1].pending == 10);
        assert_true(rg_exact_value(&s) == ldexp((double)total, n - 150));
        assert_true(rg_exact_value(&part[0]) == ldexp((double)total, n - 150));
        assert_true(rg_exact_value(&minus) == -ldexp((double)total, n - 150));
    }
    for (int n = 0; n < 300; n++) { /* of many limbs: rounded, and the same for the negative */
        rg_exact_sum s = {0}, minus = {0};
        double most = 0;
        for (int i = 0; i < 20; i++) {
            double x = sample(20 * n + i);
            rg_exact_add(&s, x);
            rg_exact_add(&minus, -x);
            most = fmax(most, fabs(x));
        }
        assert_true(rg_exact_value(&s) == -rg_exact_value(&minus));
        rg_exact_add(&s, -rg_exact_value(&s)); /* what is left is within rounding */
        assert_true(fabs(rg_exact_value(&s)) <= 2.3e-16 * 20 * most);
    }
}

/* Limbs have room for 2^29 additions: then carries move up. */
static void test_carries_in_time(void **state) {
    (void)state;
    rg_exact_sum s = {.pending = (1 << 29) - 2};
    s.limb[40] = INT64_C(0x1234567890);
    rg_exact_add(&s, 1);
    assert_true(s.pending == (1 << 29) - 1 && s.limb[40] == INT64_C(0x1234567890));
    rg_exact_add(&s, 1);
    assert_true(s.pending == 0 && s.limb[40] == INT64_C(0x34567890) && s.limb[41] == 0x12);
    rg_exact_sum t = {.limb[40] = -1};
    rg_exact_merge(&s, &t);
    assert_true(s.limb[40] == INT64_C(0x3456788f) && s.limb[41] == 0x12);
}

static void test_not_finite(void **state) {
    (void)state;
    const double bad[] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        rg_exact_sum s = {0}, t = {0};
        rg_exact_add(&t, 1);
        rg_exact_add(&s, bad[i]);
        assert_true(isnan(rg_exact_value(&s)) && s.not_finite == 1 && s.pending == 0);
        rg_exact_merge(&t, &s);
        assert_true(isnan(rg_exact_value(&t)));
    }
}

/* ---- vectors, hashes, the curve ---- */

static void test_vectors(void **state) {
    (void)state;
    const double a[3] = {2, 3, 5}, b[3] = {7, -11, 13}, c[3] = {-17, 19, 23};
    double cross[3], difference[3];
    rg_vector_cross(a, b, cross);
    rg_vector_subtract(a, b, difference);
    assert_true(rg_vector_dot(a, b) == 14 - 33 + 65);
    assert_true(cross[0] == 39 + 55 && cross[1] == 35 - 26 && cross[2] == -22 - 21);
    assert_true(difference[0] == -5 && difference[1] == 14 && difference[2] == -8);
    const double o[3] = {1, -2, 0.5};
    double at[3][3];
    for (int i = 0; i < 3; i++) {
        at[0][i] = o[i] + a[i];
        at[1][i] = o[i] + b[i];
        at[2][i] = o[i] + c[i];
    }
    double six = 94 * -17 + 9 * 19 - 43 * 23; /* (a x b).c */
    assert_true(rg_tet_volume(o, at[0], at[1], at[2]) == six / 6);
    assert_true(rg_tet_volume(o, at[1], at[0], at[2]) == -six / 6);
    assert_true(rg_tet_volume(o, at[1], at[2], at[0]) == six / 6);
}

/* rg_mix is the finalizer of splitmix64, whose first number from seed 0 is well known; the others were
 * computed by another program from the definition. They decide on meshes and strengths. */
static void test_hashes(void **state) {
    (void)state;
    assert_true(rg_mix(UINT64_C(0x9e3779b97f4a7c15)) == UINT64_C(0xe220a8397b1dcdaf));
    assert_true(rg_hash(7, 3) == UINT64_C(0xca5e7abac0b38880));
    assert_true(rg_hash(3, 7) == UINT64_C(0x75cc7191379f4728));
    assert_true(rg_hash_double(5, 0.0) == UINT64_C(0x63033b0ca389c35a));
    assert_true(rg_hash_double(5, -0.0) == UINT64_C(0x4143451dd94a31d3));
    assert_true(rg_hash_double(5, 2.5) == UINT64_C(0x440d69f03af7c3ad));
    assert_true(rg_hash_uniform(0) == 0 && rg_hash_uniform(UINT64_C(1) << 63) == 0.5);
    assert_true(rg_hash_uniform(UINT64_MAX) == 1 - 0x1p-53 && rg_hash_uniform(2047) == 0);
    assert_true(rg_hash_uniform(2048) == 0x1p-53);
}

/* The 512 cells whose coordinates are multiples of 2^shift, below 8 of them, are a stretch of the curve, on
 * which each step leads to a neighbour. */
static void test_hilbert_curve(void **state) {
    (void)state;
    for (int shift = 0; shift <= RG_HILBERT_BITS - 3; shift += 3) {
        int16_t cell_of[512];
        memset(cell_of, -1, sizeof cell_of);
        for (uint32_t i = 0; i < 512; i++) {
            const uint32_t cell[3] = {(i & 7) << shift, (i >> 3 & 7) << shift, (i >> 6) << shift};
            uint64_t at = rg_hilbert_cell(cell) >> 3 * shift;
            assert_true(at < 512 && cell_of[at] == -1);
            cell_of[at] = (int16_t)i;
        }
        for (int k = 1; k < 512; k++) {
            int a = cell_of[k - 1], b = cell_of[k];
            assert_int_equal(
                abs((a & 7) - (b & 7)) + abs((a >> 3 & 7) - (b >> 3 & 7)) + abs((a >> 6) - (b >> 6)), 1);
        }
    }
}

static void test_hilbert_point(void **state) {
    (void)state;
    const double low[3] = {-1, 2, 5}, edge = 4, cells = 1 << RG_HILBERT_BITS;
    dice d = {17, 0};
    for (int i = 0; i < 100; i++) {
        double x[3];
        uint32_t cell[3];
        for (int c = 0; c < 3; c++) {
            cell[c] = (uint32_t)(cells * dice_unit(&d));
            x[c] = low[c] + edge / cells * (cell[c] + 0.9 * dice_unit(&d) + 0.05);
        }
        assert_true(rg_hilbert_point(x, low, edge) == rg_hilbert_cell(cell));
    }
    const double first[3] = {-9, 2 - 1e-9, 5}, last[3] = {3, 6 + 1e-9, 99};
    const uint32_t most = (1U << RG_HILBERT_BITS) - 1, end[3] = {most, most, most};
    assert_true(rg_hilbert_point(first, low, edge) == 0);
    assert_true(rg_hilbert_point(last, low, edge) == rg_hilbert_cell(end));
    const uint32_t across[3] = {most, 0, 0}; /* the curve ends where x alone is largest */
    assert_true(rg_hilbert_cell(across) == (UINT64_C(1) << 63) - 1);
}

/* ---- JSON ---- */

static void test_json(void **state) {
    (void)state;
    char *text = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&text, &size);
    rg_json_text(f, "a", "x \"y\" \\ z\n\tw\x1f!");
    rg_json_integer(f, "b", INT64_MIN);
    rg_json_number(f, "c", 0.1);
    rg_json_number(f, "d", INFINITY);
    rg_json_number(f, "e", NAN);
    rg_json_vector(f, "f", (const double[3]){1, -2.5, 1e300});
    rg_json_vector(f, "g", (const double[3]){NAN, 0, -INFINITY});
    fclose(f);
    assert_string_equal(text, "  \"a\": \"x \\\"y\\\" \\\\ z  w !\",\n"
                              "  \"b\": -9223372036854775808,\n"
                              "  \"c\": 0.10000000000000001,\n"
                              "  \"d\": null,\n"
                              "  \"e\": null,\n"
                              "  \"f\": [1, -2.5, 1.0000000000000001e+300],\n"
                              "  \"g\": [null, 0, null],\n");
    free(text);
}

/* ---- elements ---- */

static void test_mass_and_inverse(void **state) {
    (void)state;
    for (rg_mass kind = RG_MASS_CONSISTENT; kind < (rg_mass)RG_MASSES; kind++) {
        double total = 0;
        for (int a = 0; a < RG_NODES; a++) {
            for (int b = 0; b < RG_NODES; b++) {
                double product = 0;
                for (int k = 0; k < RG_NODES; k++) {
                    product += rg_mass_entry(kind, a, k) * rg_inverse_mass_entry(kind, k, b);
                }
                assert_true(fabs(product - (a == b)) < 1e-13);
                total += rg_mass_entry(kind, a, b);
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

/* Tensors with given principal values (some of them equal) along random axes. */
static void test_principal_axes(void **state) {
    (void)state;
    dice d = {23, 0};
    for (int n = 0; n < 2000; n++) {
        double R[3][3], value[3], axis[3][3], sorted[3], high[3],
            of[3] = {dice_sign(&d), dice_sign(&d), dice_sign(&d)};
        dice_rotation(&d, R);
        of[1] = n % 4 == 1 ? of[0] : of[1];
        of[2] = n % 4 == 2 ? of[0] : of[2];
        of[2] = n % 8 == 3 ? of[0] + 1e-9 : of[2];
        double s[6] = {0}, scale = n % 3 == 0 ? 1e9 : 1;
        for (int k = 0; k < 6; k++) {
            static const int row[6] = {0, 1, 2, 1, 2, 0}, column[6] = {0, 1, 2, 2, 0, 1};
            for (int i = 0; i < 3; i++) {
                s[k] += scale * of[i] * R[row[k]][i] * R[column[k]][i];
            }
        }
        rg_principal_axes(s, value, axis);
        rg_principal(s, high);
        memcpy(sorted, of, sizeof sorted);
        for (int k = 0; k < 3; k++) {
            int a = k == 1 ? 1 : 0, b = a + 1;
            double least = fmin(sorted[a], sorted[b]), most = fmax(sorted[a], sorted[b]);
            sorted[a] = least;
            sorted[b] = most;
        }
        const double full[3][3] = {{s[0], s[5], s[4]}, {s[5], s[1], s[3]}, {s[4], s[3], s[2]}};
        for (int k = 0; k < 3; k++) {
            /* equal values make the cosine's formula lose half of the digits */
            assert_true(fabs(value[k] / scale - sorted[k]) < 2e-15);
            assert_true(fabs(high[2 - k] / scale - sorted[k]) < 3e-8);
            double largest = 0;
            for (int i = 0; i < 3; i++) {
                double off = rg_vector_dot(full[i], axis[k]) - value[k] * axis[k][i];
                assert_true(fabs(off) < 2.5e-15 * scale);
                assert_true(fabs(rg_vector_dot(axis[k], axis[i]) - (i == k)) < 3e-15);
                largest = fabs(axis[k][i]) > fabs(largest) ? axis[k][i] : largest;
            }
            assert_true(largest > 0);
        }
    }
    const double diagonal[6] = {3, 1, 2, 0, 0, 0};
    double value[3], axis[3][3];
    rg_principal_axes(diagonal, value, axis);
    assert_true(value[0] == 1 && value[1] == 2 && value[2] == 3);
    assert_true(axis[0][1] == 1 && axis[1][2] == 1 && axis[2][0] == 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sum_ignores_order),
        cmocka_unit_test(test_sum_is_exact),
        cmocka_unit_test(test_mass_and_inverse),
        cmocka_unit_test(test_shape_functions),
        cmocka_unit_test(test_principal_values),
        cmocka_unit_test(test_sum_of_one),
        cmocka_unit_test(test_sum_of_integers),
        cmocka_unit_test(test_carries_in_time),
        cmocka_unit_test(test_not_finite),
        cmocka_unit_test(test_vectors),
        cmocka_unit_test(test_hashes),
        cmocka_unit_test(test_hilbert_curve),
        cmocka_unit_test(test_hilbert_point),
        cmocka_unit_test(test_json),
        cmocka_unit_test(test_principal_axes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
