#include "case/expr.h"

#include <ctype.h>
#include <math.h>
#include <muParserDLL.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "case/tree.h"

enum { VARIABLES = 7, LONGEST = 19999 }; /* x, y, z, t, nx, ny, nz; characters that muParser takes */

/* clang-format off */
const rg_expr_word rg_expr_words[] = {
    {"x, y, z", "reference position (m)"},
    {"t", "time (s)"},
    {"nx, ny, nz", "unit normal of a face, of either sign"},
    {"pi", "3.14159..."},
    {"_e", "2.71828..."},
    {"+ - * / ^", "arithmetic; ^ is the power, from the right: 2^3^2 is 512, and -2^2 is -4"},
    {"< <= > >= == !=", "comparisons: 1 where they hold, else 0"},
    {"&& ||", "and, or"},
    {"a ? b : c", "b where a is not 0, else c; in quotes, for the colon"},
    {"sin(a) cos(a) tan(a)", "of an angle in radians"},
    {"asin(a) acos(a) atan(a) atan2(a, b)", "their inverses; atan2 is the angle of the point (b, a)"},
    {"sinh(a) cosh(a) tanh(a)", "hyperbolic functions"},
    {"asinh(a) acosh(a) atanh(a)", "their inverses"},
    {"exp(a) log(a) ln(a)", "exponential, natural logarithm under both names"},
    {"log2(a) log10(a)", "logarithms of base 2 and 10"},
    {"sqrt(a) abs(a) sign(a)", "root, absolute value, -1, 0 or 1"},
    {"rint(a)", "nearest integer"},
    {"min(a, ...) max(a, ...)", "least and largest of one or more"},
    {"sum(a, ...) avg(a, ...)", "sum and mean of one or more"},
    {"name(a)", "the function that `tables` gives by that name"},
    {NULL, NULL},
};
/* clang-format on */

struct rg_expr {
    char *text;
    const rg_curves *tables; /* that it may call; NULL: none */
    muParserHandle_t parser; /* NULL: a number */
    double *variable;        /* read by the parser */
    double constant;         /* the value if no variable is used */
    bool uses[VARIABLES];
};

static const char *digits(const char *p, int *count) {
    for (; isdigit((unsigned char)*p); p++) {
        (*count)++;
    }
    return p;
}

bool rg_is_number(const char *text, bool *integer) {
    const char *p = text;
    int mantissa = 0, exponent = 0;
    *integer = true;
    p += *p == '+' || *p == '-' ? 1 : 0;
    p = digits(p, &mantissa);
    if (*p == '.') {
        *integer = false;
        p = digits(p + 1, &mantissa);
    }
    if (mantissa > 0 && (*p == 'e' || *p == 'E')) {
        *integer = false;
        p += p[1] == '+' || p[1] == '-' ? 2 : 1;
        p = digits(p, &exponent);
        mantissa = exponent; /* no digits: no number */
    }
    return mantissa > 0 && *p == '\0';
}

/* muParser would change a variable on x=1; comparisons are fine. */
static bool assigns(const char *text) {
    char before = '\0';
    for (const char *p = text; *p != '\0'; before = *p++) {
        if (*p == '=' && p[1] != '=' && (before == '\0' || strchr("=<>!", before) == NULL)) {
            return true;
        }
    }
    return false;
}

static void find_variables(rg_expr *e) {
    int used = mupGetExprVarNum(e->parser);
    for (int i = 0; i < used; i++) {
        const char *name = NULL;
        double *variable = NULL;
        mupGetExprVar(e->parser, (unsigned)i, &name, &variable);
        e->uses[variable - e->variable] = true;
    }
}

static double table_value(void *curve, double argument) {
    return rg_curve_value(curve, argument);
}

static void define_tables(rg_expr *e) {
    for (int i = 0; e->tables != NULL && i < e->tables->count; i++) {
        rg_curve *c = &e->tables->curve[i];
        mupDefineFunUserData1(e->parser, c->name, table_value, c, 1);
    }
}

/* Sets the parser up and evaluates once, which is when muParser parses. Returns what is wrong, or NULL. */
static char *parse(rg_expr *e) {
    static const char *const name[VARIABLES] = {"x", "y", "z", "t", "nx", "ny", "nz"};
    e->variable = RG_NEW(double, VARIABLES);
    e->parser = mupCreate(muBASETYPE_FLOAT);
    mupDefineConst(e->parser, "pi", acos(-1.0));
    for (int i = 0; i < VARIABLES; i++) {
        mupDefineVar(e->parser, name[i], &e->variable[i]);
    }
    define_tables(e);
    mupSetExpr(e->parser, e->text);
    int values = 0;
    const double *value = mupError(e->parser) ? NULL : mupEvalMulti(e->parser, &values);
    if (mupError(e->parser)) {
        return rg_text_format("%s", mupGetErrorMsg(e->parser));
    }
    if (values != 1) {
        return rg_text_format("%d values where one is needed", values);
    }
    e->constant = value[0];
    find_variables(e);
    return NULL;
}

static bool uses_any(const rg_expr *e) {
    return rg_expr_uses_position(e) || rg_expr_uses_time(e) || rg_expr_uses_normal(e);
}

static char *check(const rg_expr *e) {
    if (!uses_any(e) && !isfinite(e->constant)) {
        return rg_text_format("not finite");
    }
    return NULL;
}

rg_expr *rg_expr_new(const char *text, char **message) {
    return rg_expr_with(text, NULL, message);
}

rg_expr *rg_expr_with(const char *text, const rg_curves *tables, char **message) {
    rg_expr *e = RG_NEW(rg_expr, 1);
    bool integer = false;
    *message = NULL;
    e->tables = tables;
    e->text = rg_text_copy(text, strlen(text));
    if (rg_is_number(text, &integer)) {
        e->constant = strtod(text, NULL);
    } else if (strlen(text) > LONGEST) {
        *message =
            rg_text_format("longer than %d characters: a set of the mesh, or a table, can say more", LONGEST);
    } else if (assigns(text)) {
        *message = rg_text_format("an assignment is not an expression");
    } else {
        *message = parse(e);
    }
    if (*message == NULL) {
        *message = check(e);
    }
    if (*message != NULL) {
        rg_expr_free(e);
        return NULL;
    }
    return e;
}

rg_expr *rg_expr_copy(const rg_expr *e) {
    char *message = NULL;
    return e == NULL ? NULL : rg_expr_with(e->text, e->tables, &message);
}

void rg_expr_free(rg_expr *e) {
    if (e != NULL) {
        if (e->parser != NULL) {
            mupRelease(e->parser);
        }
        rg_free(e->variable);
        rg_free(e->text);
        rg_free(e);
    }
}

const char *rg_expr_text(const rg_expr *e) {
    return e->text;
}

bool rg_expr_is_number(const rg_expr *e) {
    return e->parser == NULL;
}

bool rg_expr_uses_position(const rg_expr *e) {
    return e->uses[0] || e->uses[1] || e->uses[2];
}

bool rg_expr_uses_time(const rg_expr *e) {
    return e->uses[3];
}

bool rg_expr_uses_normal(const rg_expr *e) {
    return e->uses[4] || e->uses[5] || e->uses[6];
}

double rg_expr_face_value(const rg_expr *e, const double x[3], const double normal[3]) {
    for (int k = 0; k < 3 && e->variable != NULL; k++) {
        e->variable[4 + k] = normal[k];
    }
    return rg_expr_value(e, x, 0);
}

double rg_expr_value(const rg_expr *e, const double x[3], double t) {
    if (!uses_any(e)) {
        return e->constant;
    }
    for (int k = 0; k < 3; k++) {
        e->variable[k] = x[k];
    }
    e->variable[3] = t;
    return mupEval(e->parser);
}
