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

/* By what the pieces are joined of a text that is too long for muParser; in the order of binding. */
typedef enum { JOIN_OR, JOIN_AND, JOIN_SUM, JOINS } join;
static const char *const join_word[JOINS] = {"||", "&&", "+"};

struct rg_expr {
    char *text;
    const rg_curves *tables; /* that it may call; NULL: none */
    muParserHandle_t parser; /* NULL: a number, or in pieces */
    rg_expr **piece;         /* [pieces] */
    int pieces;
    join joined;
    double *variable; /* read by the parser */
    double constant;  /* the value if no variable is used */
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

/* ---- Texts that are too long ---- */

/* Finds what joins the text's operands outside of parentheses: false where nothing does that may be taken
 * apart. A sum may not where something binds less there: a comparison, or a sign of a number's power. */
static bool find_join(const char *text, join *out) {
    int depth = 0;
    bool has[JOINS] = {false}, binds_less = false;
    for (const char *p = text; *p != '\0'; p++) {
        depth += (*p == '(') - (*p == ')');
        if (depth > 0) {
            continue;
        }
        if (*p == '?' || *p == ',') {
            return false;
        }
        binds_less = binds_less || strchr("<>=!", *p) != NULL;
        has[JOIN_OR] = has[JOIN_OR] || strncmp(p, "||", 2) == 0;
        has[JOIN_AND] = has[JOIN_AND] || strncmp(p, "&&", 2) == 0;
        has[JOIN_SUM] = has[JOIN_SUM] || *p == '+';
    }
    *out = has[JOIN_OR] ? JOIN_OR : has[JOIN_AND] ? JOIN_AND : JOIN_SUM;
    return has[*out] && !(*out == JOIN_SUM && binds_less);
}

/* Whether a sum may be cut before the plus at p: it stands between operands, and is no sign of an exponent
 * or operand. */
static bool may_cut(const char *text, const char *p) {
    const char *before = p;
    while (before > text && isspace((unsigned char)before[-1])) {
        before--;
    }
    bool exponent = before == p && p - text > 1 && (p[-1] == 'e' || p[-1] == 'E') &&
                    (isdigit((unsigned char)p[-2]) || p[-2] == '.');
    return before > text && strchr("+-*/^", before[-1]) == NULL && !exponent;
}

static char *add_piece(rg_expr *e, const char *text, size_t length) {
    char *message = NULL, *copy = rg_text_copy(text, length);
    e->piece = rg_realloc(e->piece, (size_t)e->pieces + 1, sizeof(rg_expr *));
    e->piece[e->pieces] = rg_expr_with(copy, e->tables, &message);
    e->pieces += message == NULL;
    rg_free(copy);
    return message;
}

static char *too_long(void) {
    return rg_text_format(
        "an operand is longer than %d characters: a set of the mesh, or a table, can say more", LONGEST);
}

/* What is inside of parentheses around all of the text, as the only piece. */
static char *unwrap(rg_expr *e) {
    const char *text = e->text;
    size_t first = strspn(text, " \t\r\n"), last = strlen(text) - 1;
    int depth = 0;
    while (last > first && isspace((unsigned char)text[last])) {
        last--;
    }
    bool wrapped = text[first] == '(' && text[last] == ')';
    for (size_t i = first; i < last && wrapped; i++) {
        depth += (text[i] == '(') - (text[i] == ')');
        wrapped = depth > 0;
    }
    e->joined = JOIN_SUM;
    return wrapped ? add_piece(e, text + first + 1, last - first - 1) : too_long();
}

/* Takes the text apart into pieces of as many operands as muParser takes at a time; one that is longer is
 * taken apart in turn. Returns what is wrong, or NULL. */
static char *take_apart(rg_expr *e) {
    const char *begin = e->text, *end = begin; /* the piece so far: up to the operand that ends at `end` */
    if (!find_join(begin, &e->joined)) {
        return unwrap(e);
    }
    const char *word = join_word[e->joined];
    size_t skip = strlen(word);
    int depth = 0;
    char *message = NULL;
    for (const char *p = begin; message == NULL && *begin != '\0'; p++) {
        depth += (*p == '(') - (*p == ')');
        bool cut =
            depth == 0 && strncmp(p, word, skip) == 0 && (e->joined != JOIN_SUM || may_cut(e->text, p));
        if (!cut && *p != '\0') {
            continue;
        }
        if (p - begin > LONGEST && end > begin) {
            message = add_piece(e, begin, (size_t)(end - begin));
            begin = end + skip;
        }
        end = p;
        if (*p == '\0' && message == NULL) {
            message = begin == e->text ? too_long() : add_piece(e, begin, (size_t)(p - begin));
            begin = p;
        }
    }
    return message;
}

static double joined_value(const rg_expr *e, const double x[3], double t) {
    double sum = 0;
    bool any = false, all = true;
    for (int i = 0; i < e->pieces; i++) {
        double value = rg_expr_value(e->piece[i], x, t);
        sum += value;
        any = any || value != 0;
        all = all && value != 0;
    }
    return e->joined == JOIN_OR ? any : e->joined == JOIN_AND ? all : sum;
}

static void join_pieces(rg_expr *e) {
    for (int i = 0; i < e->pieces * VARIABLES; i++) {
        e->uses[i % VARIABLES] = e->uses[i % VARIABLES] || e->piece[i / VARIABLES]->uses[i % VARIABLES];
    }
    e->constant = joined_value(e, (double[3]){0, 0, 0}, 0);
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
        *message = take_apart(e);
        join_pieces(e);
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
        for (int i = 0; i < e->pieces; i++) {
            rg_expr_free(e->piece[i]);
        }
        rg_free(e->piece);
        rg_free(e->variable);
        rg_free(e->text);
        rg_free(e);
    }
}

const char *rg_expr_text(const rg_expr *e) {
    return e->text;
}

bool rg_expr_is_number(const rg_expr *e) {
    return e->parser == NULL && e->pieces == 0;
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

static void set_normal(const rg_expr *e, const double normal[3]) {
    for (int k = 0; k < 3 && e->variable != NULL; k++) {
        e->variable[4 + k] = normal[k];
    }
    for (int i = 0; i < e->pieces; i++) {
        set_normal(e->piece[i], normal);
    }
}

double rg_expr_face_value(const rg_expr *e, const double x[3], const double normal[3]) {
    set_normal(e, normal);
    return rg_expr_value(e, x, 0);
}

double rg_expr_value(const rg_expr *e, const double x[3], double t) {
    if (!uses_any(e)) {
        return e->constant;
    }
    if (e->pieces > 0) {
        return joined_value(e, x, t);
    }
    for (int k = 0; k < 3; k++) {
        e->variable[k] = x[k];
    }
    e->variable[3] = t;
    return mupEval(e->parser);
}
