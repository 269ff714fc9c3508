/* Rules of the keys of an anisotropic solid. */
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/stiffness.h"
#include "base/vector.h"
#include "case/check.h"

/* A problem of the key `word`, or of the block. */
static void wrong(rg_check *ck, const rg_node *node, const char *word, const char *allowed,
                  const char *what) {
    const rg_material_check *m = &ck->material;
    char *key =
        word[0] != '\0' ? rg_text_format("%s%s", m->path, word) : rg_text_copy(m->path, strlen(m->path) - 1);
    rg_subject subject = {.key = key, .allowed = allowed};
    rg_problem_add(ck->problems, word[0] != '\0' ? node->key_at : node->at, &subject, "%s", what);
    rg_free(key);
}

/* One way to give the constants, whole. */
static bool check_given(rg_check *ck) {
    const rg_material_check *m = &ck->material;
    const rg_node *const *given = m->constant;
    const rg_node *engineering = given[RG_OF_YOUNG] != NULL     ? given[RG_OF_YOUNG]
                                 : given[RG_OF_POISSON] != NULL ? given[RG_OF_POISSON]
                                                                : given[RG_OF_SHEAR];
    const char *allowed = "stiffness, or young, poisson, shear", *what = NULL, *word = "";
    const rg_node *at = m->block;
    if (given[RG_OF_STIFFNESS] != NULL && engineering != NULL) {
        word = "stiffness";
        at = given[RG_OF_STIFFNESS];
        what = "given beside young, poisson or shear";
    } else if (given[RG_OF_STIFFNESS] == NULL && engineering == NULL) {
        what = "missing stiffness";
    } else if (engineering != NULL && given[RG_OF_YOUNG] == NULL) {
        what = "missing young";
    } else if (engineering != NULL && given[RG_OF_SHEAR] == NULL) {
        what = "missing shear";
    }
    if (what != NULL) {
        wrong(ck, at, word, allowed, what);
    }
    return what == NULL;
}

/* What gives energy when it is strained is no solid. */
static void check_stable(rg_check *ck) {
    const rg_material_check *m = &ck->material;
    const rg_anisotropic_input *in = &m->of->anisotropic;
    double c[RG_STIFFNESS], least;
    char what[160] = "";
    if (m->constant[RG_OF_STIFFNESS] != NULL) {
        least = rg_stiffness_least(in->stiffness);
        if (!(least > 0)) {
            snprintf(what, sizeof what, "not positive definite: its smallest eigenvalue is %.6g Pa", least);
            wrong(ck, m->constant[RG_OF_STIFFNESS], "stiffness", NULL, what);
        }
    } else if (!rg_stiffness_orthotropic(in->young, in->poisson, in->shear, c, &least)) {
        snprintf(what, sizeof what,
                 "with these, the compliance is not positive definite: its smallest eigenvalue is %.6g 1/Pa",
                 least);
        wrong(ck, m->constant[RG_OF_POISSON], "poisson", NULL, what);
    }
}

/* Ways to say how the axes lie, one of which may be given; true: there are several, and the second is told.
 */
static bool check_ways(rg_check *ck) {
    static const struct {
        int key;
        const char *name, *way;
    } keys[] = {
        {RG_OF_AXIS_1, "orientation.axis_1", "axes"},      {RG_OF_AXIS_2, "orientation.axis_2", "axes"},
        {RG_OF_ANGLE_1, "orientation.angle_1", "angle_1"}, {RG_OF_ANGLE_2, "orientation.angle_2", "angle_1"},
        {RG_OF_ANGLE_3, "orientation.angle_3", "angle_1"}, {RG_OF_FIELD, "orientation.field", "field"},
        {RG_OF_ANGLES, "orientation.angles", "angles"}};
    enum { KEYS = sizeof keys / sizeof *keys };
    const rg_material_check *m = &ck->material;
    int first = -1;
    for (int i = 0; i < KEYS; i++) {
        const rg_node *node = m->constant[keys[i].key];
        if (node != NULL && first >= 0 && strcmp(keys[i].way, keys[first].way) != 0) {
            char what[80];
            snprintf(what, sizeof what, "given beside %s",
                     strcmp(keys[first].way, "axes") == 0 ? "axes" : strrchr(keys[first].name, '.') + 1);
            wrong(ck, node, keys[i].name, NULL, what);
            return true;
        }
        first = node != NULL && first < 0 ? i : first;
    }
    if (m->constant[RG_OF_FIELD] != NULL && ck->c->mesh.file == NULL) {
        wrong(ck, m->constant[RG_OF_FIELD], "orientation.field", NULL,
              "not used with the box: it is a dataset of a mesh file");
    }
    return false;
}

static void check_axes(rg_check *ck) {
    const rg_material_check *m = &ck->material;
    const rg_node *one = m->constant[RG_OF_AXIS_1], *two = m->constant[RG_OF_AXIS_2];
    double(*axis)[3] = m->of->anisotropic.axis;
    if (check_ways(ck)) {
        return;
    }
    if ((one == NULL) != (two == NULL)) {
        wrong(ck, one != NULL ? one : two, one != NULL ? "orientation.axis_1" : "orientation.axis_2", NULL,
              one != NULL ? "not used without axis_2" : "not used without axis_1");
    } else if (one != NULL) {
        double across[3];
        rg_vector_cross(axis[0], axis[1], across);
        double sine2 = rg_vector_dot(across, across);
        if (!(sine2 > 1e-12 * rg_vector_dot(axis[0], axis[0]) * rg_vector_dot(axis[1], axis[1]))) {
            wrong(ck, two, "orientation.axis_2", NULL, "along axis_1, or one of them is 0");
        }
    }
}

void rg_anisotropic_rule(rg_check *ck) {
    if (check_given(ck)) {
        check_stable(ck);
    }
    check_axes(ck);
}
