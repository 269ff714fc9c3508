/* Operations at a point of the solids of material/hencky.h, term by term. */
#ifndef RG_COST_HENCKY_H
#define RG_COST_HENCKY_H

enum {
    HENCKY_FMA = 2,
    HENCKY_DOT = 5,
    HENCKY_COAXIAL = 6 * HENCKY_DOT,              /* product of coaxial symmetric tensors */
    HENCKY_SYM_DOT = 2 * HENCKY_DOT + HENCKY_FMA, /* full contraction */
    HENCKY_CONGRUENCE = 15 * HENCKY_DOT,          /* G S, then six entries of (G S) G^T */
    /* polynomials by Estrin's scheme: FMAs of all levels and squares of x between them */
    HENCKY_LOG_SERIES = 9 * HENCKY_FMA + 3,
    HENCKY_EXP_SERIES = 11 * HENCKY_FMA + 3,
    HENCKY_LOG = 4 + HENCKY_LOG_SERIES + 2 + 1 + 3 * HENCKY_FMA, /* s, z; tail, k, sum */
    HENCKY_EXP_PARTS =
        HENCKY_FMA + 1 + 2 * HENCKY_FMA + HENCKY_EXP_SERIES + 1 + HENCKY_FMA, /* k, r; r^2, p */
    HENCKY_EXP = HENCKY_EXP_PARTS + HENCKY_FMA,
    HENCKY_EXPM1 = HENCKY_EXP_PARTS + 1 + HENCKY_FMA,
    HENCKY_LOG1P = HENCKY_LOG + 4,
    HENCKY_POW = HENCKY_LOG + 1 + HENCKY_EXP,
    HENCKY_EXPM1_SMALL = (4 * HENCKY_FMA + 2) + 1 + HENCKY_FMA,
    HENCKY_LOG1P_SMALL = 3 + (2 * HENCKY_FMA + 1) + 2 + HENCKY_FMA,

    HENCKY_INVARIANTS = 3 + (HENCKY_SYM_DOT + 1), /* q, r of a symmetric tensor with trace 0 */
    /* x; x^2, q, r; six determinants and their sums; one division; three products; e' */
    HENCKY_LOGARITHM = 3 + (3 * HENCKY_FMA + 3) + HENCKY_COAXIAL + HENCKY_INVARIANTS +
                       3 * (4 * HENCKY_FMA + 1 + 2 + 1 + HENCKY_FMA) + 3 + 3 * (1 + 2 * HENCKY_FMA) + 2 +
                       (1 + 3 * (1 + 1 + HENCKY_FMA) + 3 * (1 + HENCKY_FMA)),
    /* F, Cp^-1, cofactors, J and its inverse, b, log b, log J, eb */
    HENCKY_STRAIN =
        3 + 3 + 27 + HENCKY_DOT + 1 + HENCKY_CONGRUENCE + HENCKY_LOGARITHM + HENCKY_LOG + HENCKY_SYM_DOT + 2,
    HENCKY_PIOLA = 2 + 6 * (HENCKY_FMA + 1) + 9 * HENCKY_DOT,
    /* cof^T cof, row sums, norm; pressure, deviator and spread; bound and guards */
    HENCKY_STIFFENING =
        6 * HENCKY_DOT + 9 + 2 + (HENCKY_FMA + 1 + HENCKY_FMA) + (HENCKY_FMA + 1) + (1 + HENCKY_FMA),
    HENCKY_EXPONENTIAL =
        HENCKY_COAXIAL + HENCKY_INVARIANTS + 10 * HENCKY_FMA + (HENCKY_FMA + 1 + 6 * 4), /* |y| small */
    HENCKY_LONG_SERIES = 12 * (2 * (1 + HENCKY_FMA) + 1), /* of the exponential, where |y| is large */
    /* y; exponential; times b; inverse of F; congruence; Cp^-1 */
    HENCKY_FLOW = 7 + HENCKY_EXPONENTIAL + HENCKY_COAXIAL + 9 + HENCKY_CONGRUENCE + 6,
};

#endif
