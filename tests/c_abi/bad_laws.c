/* Rows 1, 4, 6, 7, 14, 24, 39, 41, 43, 44, 48, 54: contact laws, tables, polynomials and patches that are
 * refused, by argument and entry, and leave the model as it was. */
#include "common.h"

static void *misaligned(void *p) { return (char *)p + 4; }

static hbvib_contact friction(int32_t kind)
{
    hbvib_contact c;
    if (hbvib_contact_init(&c, sizeof c) != HBVIB_OK) abort();
    c.kind = kind;
    c.dof_a[0] = 0;
    c.dof_a[2] = 2;
    if (kind == HBVIB_FRICTION_3D) c.dof_a[1] = 1;
    c.kt = c.kn = c.preload = 1;
    c.mu = 0.3;
    return c;
}

static void contacts(hbvib_model *model)
{
    const int32_t kinds[2] = {HBVIB_FRICTION_2D, HBVIB_FRICTION_3D};
    const double bad[] = {-1, NAN, INFINITY, -INFINITY};
    hbvib_contact c;
    hbvib_model *copy = NULL;
    int64_t id = -5;
    size_t i, k;
#define BAD(row, status, words) REFUSED(row, hbvib_model_add_contact(model, &c, &id), status, 2, words)

    for (k = 0; k < 2; k++) {
        for (i = 0; i < 4; i++) { /* rows 43, 44 */
            hbvib_status wanted = i == 0 ? HBVIB_E_ARGUMENT : HBVIB_E_NOT_FINITE;
            c = friction(kinds[k]);
            c.kt = bad[i];
            BAD("43", wanted, "kt = ");
            c = friction(kinds[k]);
            c.kn = bad[i];
            BAD("43", wanted, "kn = ");
            c = friction(kinds[k]);
            c.mu = bad[i];
            BAD("44", wanted, "mu = ");
            c = friction(kinds[k]);
            c.preload = bad[i];
            BAD("44", wanted, "preload = ");
            c = friction(kinds[k]);
            c.gap = bad[i];
            if (i > 0) BAD("44", HBVIB_E_NOT_FINITE, "gap = ");
        }
        c = friction(kinds[k]);
        c.kn = 0;
        BAD("43", HBVIB_E_ARGUMENT, "kn = 0, needs a number > 0");
        c = friction(kinds[k]);
        c.cubic = 1;
        BAD("54", HBVIB_E_ARGUMENT, "cubic = 1, needs 0");
        c = friction(kinds[k]);
        c.velocity = 1;
        BAD("54", HBVIB_E_ARGUMENT, "velocity = 1, needs 0");
        c = friction(kinds[k]);
        c.dof_b[2] = NDOF; /* row 39 */
        BAD("39", HBVIB_E_INDEX, "dof_b[2] = 4");
        c.dof_b[2] = HBVIB_GROUND;
        c.dof_a[2] = 0; /* two directions of one degree of freedom */
        BAD("41", HBVIB_E_ARGUMENT, "dof_a[0] and dof_a[2] are both 0");
        c.dof_a[2] = c.dof_b[2] = 3;
        BAD("41", HBVIB_E_ARGUMENT, "same degree of freedom");
        c.dof_a[2] = c.dof_b[2] = HBVIB_GROUND;
        BAD("41", HBVIB_E_ARGUMENT, kinds[k] == HBVIB_FRICTION_2D ? "both the ground" : "kn = 1, gap = 0, need 0");
    }
    c = friction(HBVIB_FRICTION_2D);
    c.dof_a[1] = 1;
    BAD("54", HBVIB_E_ARGUMENT, "dof_a[1] = 1, needs to be empty");
    c = friction(HBVIB_REGULARISED);
    c.kt = c.kn = 0;
    c.velocity = 1;
    BAD("54", HBVIB_E_ARGUMENT, "dof_a[2] = 2, needs to be empty");
    c.dof_a[2] = HBVIB_GROUND;
    c.kt = 1;
    BAD("54", HBVIB_E_ARGUMENT, "kt = 1, needs 0");
    c.kt = 0;
    c.preload = INFINITY;
    BAD("44", HBVIB_E_NOT_FINITE, "preload = inf");
    c.preload = 1;
    for (i = 0; i < 4; i++) {
        c.velocity = bad[i];
        BAD("54", i == 0 ? HBVIB_E_ARGUMENT : HBVIB_E_NOT_FINITE, "velocity = ");
    }
    c.velocity = 0;
    BAD("54", HBVIB_E_ARGUMENT, "velocity = 0, needs a number > 0");
    c.kind = 7;
    BAD("54", HBVIB_E_ARGUMENT, "kind = 7, needs 1 .. 6");

    /* Row 48: directions. */
    c = friction(HBVIB_FRICTION_2D);
    c.dof_a[1] = 1;
    c.tangent[0] = 1;
    BAD("48", HBVIB_E_ARGUMENT, "normal is zero");
    c.normal[2] = 2;
    c.tangent[2] = 0.1;
    BAD("48", HBVIB_E_ARGUMENT, "not orthogonal");
    c.tangent[1] = NAN;
    BAD("48", HBVIB_E_NOT_FINITE, "tangent[1] = NaN");
    c.tangent[0] = c.tangent[1] = c.tangent[2] = 0;
    BAD("48", HBVIB_E_ARGUMENT, "tangent is zero");
    c.kind = HBVIB_JENKINS;
    c.kn = 0;
    BAD("48", HBVIB_E_ARGUMENT, "tangent is zero, needs a direction; kind = 1");
    c.normal[0] = INFINITY;
    c.tangent[1] = 1;
    BAD("48", HBVIB_E_NOT_FINITE, "normal[0] = inf");
    EXPECT("39", id == -5);

    /* The loads of the kinds. */
    WORKS("44", hbvib_model_clone(model, &copy));
    for (k = 0; k < 2; k++) {
        c = friction(kinds[k]);
        WORKS("44", hbvib_model_add_contact(copy, &c, &id));
        EXPECT("44", id == 1 + (int64_t)k);
        WORKS("44", hbvib_model_set_preload(copy, id, 0));
        for (i = 0; i < 4; i++)
            REFUSED("44", hbvib_model_set_preload(copy, id, bad[i]), i == 0 ? HBVIB_E_ARGUMENT : HBVIB_E_NOT_FINITE, 3,
                    "preload = ");
    }
    WORKS("44", hbvib_model_free(copy));
#undef BAD
}

static void tables(hbvib_model *model)
{
    const double x[4] = {-1, 0, 1, 2}, f[4] = {-1, 0, 1, 3}, unsorted[3] = {0, 2, 1}, equal[2] = {1, 1};
    double bad[2] = {0, 1}, steep[2] = {-1.7e308, 1.7e308};
    int64_t id = -5, ids[2];
#define TABLE(a, b, s, n, x, f) hbvib_model_add_table(model, a, b, s, n, x, f, &id)
    REFUSED("4", hbvib_model_add_table(NULL, 0, 1, 0, 4, x, f, &id), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("39", TABLE(4, 1, 0, 4, x, f), HBVIB_E_INDEX, 2, "dof_a = 4");
    REFUSED("39", TABLE(0, INT64_MIN, 0, 4, x, f), HBVIB_E_INDEX, 3, "dof_b = -9223372036854775808");
    REFUSED("41", TABLE(1, 1, 0, 4, x, f), HBVIB_E_ARGUMENT, 2, "same degree of freedom");
    REFUSED("41", TABLE(-1, -1, 0, 4, x, f), HBVIB_E_ARGUMENT, 2, "ground");
    REFUSED("6", TABLE(0, 1, 0, -1, x, f), HBVIB_E_DIMENSION, 5, "n = -1");
    REFUSED("5", TABLE(0, 1, 0, 0, NULL, NULL), HBVIB_E_DIMENSION, 5, "n = 0, needs at least 2");
    REFUSED("5", TABLE(0, 1, 0, 1, x, f), HBVIB_E_DIMENSION, 5, "n = 1, needs at least 2");
    REFUSED("7", TABLE(0, 1, 0, INT64_MAX, x, f), HBVIB_E_DIMENSION, 6, "memory");
    REFUSED("1", TABLE(0, 1, 0, 4, NULL, f), HBVIB_E_NULL, 6, "displacement");
    REFUSED("1", TABLE(0, 1, 0, 4, x, NULL), HBVIB_E_NULL, 7, "force");
    REFUSED("14", TABLE(0, 1, 0, 1, misaligned(bad), f), HBVIB_E_DIMENSION, 5, "n = 1");
    REFUSED("14", TABLE(0, 1, 0, 2, misaligned(bad), f), HBVIB_E_ARGUMENT, 6, "misaligned");
    REFUSED("14", hbvib_model_add_table(model, 0, 1, 0, 4, x, f, misaligned(ids)), HBVIB_E_ARGUMENT, 8, "misaligned");
    REFUSED("48", TABLE(0, 1, 0, 3, unsorted, f), HBVIB_E_ARGUMENT, 6, "displacement[2] = 1 of the table");
    REFUSED("48", TABLE(0, 1, 0, 2, equal, f), HBVIB_E_ARGUMENT, 6, "does not exceed");
    bad[1] = NAN;
    REFUSED("24", TABLE(0, 1, 0, 2, bad, f), HBVIB_E_NOT_FINITE, 6, "displacement[1]");
    REFUSED("24", TABLE(0, 1, 0, 2, x, bad), HBVIB_E_NOT_FINITE, 7, "force[1]");
    REFUSED("26", TABLE(0, 1, 0, 2, x, steep), HBVIB_E_NOT_FINITE, 7, "slope");
    EXPECT("3", id == -5);
#undef TABLE
}

static void spring_dampers(hbvib_model *model)
{
    double c[16] = {1, 2, 3};
    int64_t id = -5;
#define ADD(a, b, s, n, k, m, d) hbvib_model_add_spring_damper(model, a, b, s, n, k, m, d, &id)
    REFUSED("4", hbvib_model_add_spring_damper(NULL, 0, 1, 0, 3, c, 3, c, &id), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("39", ADD(-2, 1, 0, 3, c, 3, c), HBVIB_E_INDEX, 2, "dof_a = -2");
    REFUSED("39", ADD(0, 4, 0, 3, c, 3, c), HBVIB_E_INDEX, 3, "dof_b = 4");
    REFUSED("41", ADD(2, 2, 24, 3, c, 3, c), HBVIB_E_ARGUMENT, 2, "same degree of freedom");
    REFUSED("6", ADD(0, 1, 0, -1, c, 3, c), HBVIB_E_DIMENSION, 5, "n_spring = -1, needs 0 .. 15");
    REFUSED("7", ADD(0, 1, 0, 16, c, 3, c), HBVIB_E_DIMENSION, 5, "n_spring = 16");
    REFUSED("7", ADD(0, 1, 0, 3, c, INT64_MAX, c), HBVIB_E_DIMENSION, 7, "n_damper");
    REFUSED("5", ADD(0, 1, 0, 0, NULL, 0, NULL), HBVIB_E_DIMENSION, 5, "n_spring and n_damper are 0");
    REFUSED("1", ADD(0, 1, 0, 3, NULL, 3, c), HBVIB_E_NULL, 6, "spring");
    REFUSED("1", ADD(0, 1, 0, 3, c, 3, NULL), HBVIB_E_NULL, 8, "damper");
    REFUSED("14", hbvib_model_add_spring_damper(model, 0, 1, 0, 3, c, 0, NULL, misaligned(c)), HBVIB_E_ARGUMENT, 9, "misaligned");
    c[2] = INFINITY;
    REFUSED("24", ADD(0, 1, 0, 3, c, 0, NULL), HBVIB_E_NOT_FINITE, 6, "spring[2]");
    REFUSED("24", ADD(0, 1, 0, 2, c, 3, c), HBVIB_E_NOT_FINITE, 8, "damper[2]");
    EXPECT("3", id == -5);
#undef ADD
}

static void polynomials(hbvib_model *model)
{
    int64_t dofs[2] = {0, 1}, direction[2] = {0, 1}, id = -5;
    double c[2] = {1, 2}, tensor[16] = {1};
    int32_t x[4] = {1, 1, 2, 0}, v[4] = {0, 0, 0, 0};
#define ADD(dofs, n, terms, direction, c, x, v) hbvib_model_add_polynomial(model, dofs, n, terms, direction, c, x, v, &id)
    REFUSED("4", hbvib_model_add_polynomial(NULL, dofs, 2, 2, direction, c, x, v, &id), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("5", ADD(dofs, 0, 2, direction, c, x, v), HBVIB_E_DIMENSION, 3, "n_dofs = 0");
    REFUSED("6", ADD(dofs, -2, 2, direction, c, x, v), HBVIB_E_DIMENSION, 3, "n_dofs = -2");
    REFUSED("7", ADD(dofs, INT64_MAX, 2, direction, c, x, v), HBVIB_E_DIMENSION, 2, "memory");
    REFUSED("5", ADD(dofs, 2, 0, direction, c, x, v), HBVIB_E_DIMENSION, 4, "n_terms = 0");
    REFUSED("7", ADD(dofs, 2, INT64_MAX, direction, c, x, v), HBVIB_E_DIMENSION, 5, "memory");
    REFUSED("1", ADD(NULL, 2, 2, direction, c, x, v), HBVIB_E_NULL, 2, "dofs");
    REFUSED("1", ADD(dofs, 2, 2, NULL, c, x, v), HBVIB_E_NULL, 5, "direction");
    REFUSED("1", ADD(dofs, 2, 2, direction, NULL, x, v), HBVIB_E_NULL, 6, "coefficient");
    REFUSED("1", ADD(dofs, 2, 2, direction, c, NULL, NULL), HBVIB_E_ARGUMENT, 7, "monomial 0: all exponents are 0");
    REFUSED("14", ADD(dofs, 2, 2, direction, c, (int32_t *)((char *)x + 2), v), HBVIB_E_ARGUMENT, 7, "misaligned");
    REFUSED("14", hbvib_model_add_polynomial(model, dofs, 2, 2, direction, c, x, v, misaligned(direction)), HBVIB_E_ARGUMENT, 9, "misaligned");
    x[2] = 16;
    REFUSED("54", ADD(dofs, 2, 2, direction, c, x, v), HBVIB_E_ARGUMENT, 7, "x_powers[1,0] = 16, needs 0 .. 15");
    x[2] = 0;
    REFUSED("54", ADD(dofs, 2, 2, direction, c, x, v), HBVIB_E_ARGUMENT, 7, "monomial 1: all exponents are 0");
    v[3] = -1;
    REFUSED("54", ADD(dofs, 2, 2, direction, c, x, v), HBVIB_E_ARGUMENT, 8, "v_powers[1,1] = -1");
    v[3] = 1;
    c[1] = NAN;
    REFUSED("24", ADD(dofs, 2, 2, direction, c, x, v), HBVIB_E_NOT_FINITE, 6, "coefficient[1] = NaN");
    c[1] = 1;
    direction[1] = 2;
    REFUSED("39", ADD(dofs, 2, 2, direction, c, x, v), HBVIB_E_INDEX, 5, "direction[1] = 2, needs 0 .. 1");
    direction[1] = -1;
    REFUSED("39", ADD(dofs, 2, 2, direction, c, x, v), HBVIB_E_INDEX, 5, "direction[1] = -1");
    direction[1] = 1;
    dofs[1] = NDOF;
    REFUSED("39", ADD(dofs, 2, 2, direction, c, x, v), HBVIB_E_INDEX, 2, "dofs[1] = 4, needs 0 .. 3");
    dofs[1] = HBVIB_GROUND;
    REFUSED("39", ADD(dofs, 2, 2, direction, c, x, v), HBVIB_E_INDEX, 2, "dofs[1] = -1");
    dofs[1] = 0;
    REFUSED("41", ADD(dofs, 2, 2, direction, c, x, v), HBVIB_E_ARGUMENT, 2, "dofs[0] and dofs[1] are both 0");
#undef ADD
#define ADD(dofs, n, q, c) hbvib_model_add_stiffness_tensors(model, dofs, n, q, c, &id)
    REFUSED("41", ADD(dofs, 2, tensor, tensor), HBVIB_E_ARGUMENT, 2, "dofs[0] and dofs[1] are both 0");
    dofs[1] = INT64_MAX;
    REFUSED("39", ADD(dofs, 2, tensor, tensor), HBVIB_E_INDEX, 2, "dofs[1] = 9223372036854775807");
    dofs[1] = 1;
    REFUSED("4", hbvib_model_add_stiffness_tensors(NULL, dofs, 2, tensor, tensor, &id), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", ADD(NULL, 2, tensor, tensor), HBVIB_E_NULL, 2, "dofs");
    REFUSED("5", ADD(dofs, 0, tensor, tensor), HBVIB_E_DIMENSION, 3, "n = 0");
    REFUSED("6", ADD(dofs, -1, tensor, tensor), HBVIB_E_DIMENSION, 3, "n = -1");
    REFUSED("1", ADD(dofs, 2, NULL, NULL), HBVIB_E_NULL, 4, "needs one of them");
    REFUSED("14", ADD(dofs, 1, misaligned(tensor), NULL), HBVIB_E_ARGUMENT, 4, "misaligned");
    REFUSED("14", ADD(dofs, 1, NULL, misaligned(tensor)), HBVIB_E_ARGUMENT, 5, "misaligned");
    REFUSED("14", hbvib_model_add_stiffness_tensors(model, dofs, 1, tensor, NULL, misaligned(direction)), HBVIB_E_ARGUMENT, 6, "misaligned");
    tensor[7] = -INFINITY;
    REFUSED("24", ADD(dofs, 2, tensor, NULL), HBVIB_E_NOT_FINITE, 4, "quadratic stiffness: entry 7 (row 1)");
    REFUSED("24", ADD(dofs, 2, NULL, tensor), HBVIB_E_NOT_FINITE, 5, "cubic stiffness: entry 7 (row 0)");
    { /* row 8: products that wrap although each factor is fine alone */
        enum { LONG = 200000 };
        hbvib_model *big = NULL, *kept = the_model;
        int64_t *many = malloc(LONG * sizeof *many), i;
        int32_t *powers = calloc(LONG, sizeof *powers);
        if (many == NULL || powers == NULL) abort();
        for (i = 0; i < LONG; i++) many[i] = i;
        WORKS("8", hbvib_model_new(LONG, &big));
        the_model = NULL;
        REFUSED("8", hbvib_model_add_stiffness_tensors(big, many, LONG, NULL, tensor, &id), HBVIB_E_DIMENSION, 5, "200000^4");
        REFUSED("8", hbvib_model_add_polynomial(big, many, LONG, INT64_C(1) << 50, direction, c, powers, NULL, &id),
                HBVIB_E_DIMENSION, 7, "1125899906842624 x 200000 entries");
        many[LONG - 1] = 7; /* found in a long list, too */
        powers[3] = 1;
        REFUSED("41", hbvib_model_add_polynomial(big, many, LONG, 1, direction, c, powers, NULL, &id), HBVIB_E_ARGUMENT, 2,
                "dofs[7] and dofs[199999] are both 7");
        the_model = kept;
        WORKS("8", hbvib_model_free(big));
        free(many);
        free(powers);
    }
    EXPECT("3", id == -5);
#undef ADD
}

static void patches(hbvib_model *model)
{
    int64_t a[6] = {0, 1, 2, 1, 2, 3}, b[6] = {3, -1, -1, -1, -1, 0}, id = -5;
    double n[6] = {0, 0, 1, 1, 0, 0}, t[6] = {1, 0, 0, 0, 0, 1}, area[2] = {1, 2}, p[2] = {1, 2}, g[2] = {0, 0};
    hbvib_contact law = friction(HBVIB_FRICTION_2D);
#define PATCH(law, m, a, b, n, t, area, p, g) hbvib_model_add_patch(model, law, m, a, b, n, t, area, p, g, &id)
#define BAD(row, status, argument, words) REFUSED(row, PATCH(&law, 2, a, b, n, t, area, p, g), status, argument, words)
    REFUSED("4", hbvib_model_add_patch(NULL, &law, 2, a, b, n, t, area, p, g, &id), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", PATCH(NULL, 2, a, b, n, t, area, p, g), HBVIB_E_NULL, 2, "hbvib_contact");
    REFUSED("6", PATCH(&law, -1, a, b, n, t, area, p, g), HBVIB_E_DIMENSION, 3, "n = -1");
    REFUSED("7", PATCH(&law, INT64_MAX, a, b, n, t, area, p, g), HBVIB_E_DIMENSION, 4, "memory");
    REFUSED("7", PATCH(&law, INT64_MAX / 8, a, b, n, t, area, p, g), HBVIB_E_DIMENSION, 4, "memory");
    REFUSED("1", PATCH(&law, 2, NULL, b, n, t, area, p, g), HBVIB_E_NULL, 4, "dof_a");
    REFUSED("1", PATCH(&law, 2, a, b, NULL, t, area, p, g), HBVIB_E_NULL, 6, "normal");
    REFUSED("1", PATCH(&law, 2, a, b, n, NULL, area, p, g), HBVIB_E_ARGUMENT, 7, "tangent is missing");
    REFUSED("1", PATCH(&law, 2, a, b, n, t, NULL, p, g), HBVIB_E_NULL, 8, "area");
    REFUSED("14", PATCH(&law, 2, misaligned(a), b, n, t, area, p, g), HBVIB_E_ARGUMENT, 4, "misaligned");
    REFUSED("14", PATCH(&law, 2, a, b, n, t, area, misaligned(p), g), HBVIB_E_ARGUMENT, 9, "misaligned");
    REFUSED("14", hbvib_model_add_patch(model, &law, 2, a, b, n, t, area, p, g, misaligned(a)), HBVIB_E_ARGUMENT, 11, "misaligned");
    a[4] = NDOF; /* row 39 */
    BAD("39", HBVIB_E_INDEX, 4, "dof_a[4] = 4");
    a[4] = 2;
    b[5] = -2;
    BAD("39", HBVIB_E_INDEX, 5, "dof_b[5] = -2");
    b[5] = 0;
    a[5] = 1;
    BAD("41", HBVIB_E_ARGUMENT, 4, "entry 1: contact: dof_a[0] and dof_a[2] are both 1");
    a[5] = 3;
    b[1] = 3;
    BAD("41", HBVIB_E_ARGUMENT, 5, "entry 0: contact: dof_b[0] and dof_b[1] are both 3");
    b[1] = -1;
    REFUSED("41", PATCH(&law, 2, a, a, n, t, area, p, g), HBVIB_E_ARGUMENT, 4, "entry 0: contact: dof_a and dof_b");
    n[3] = 0; /* row 48 */
    BAD("48", HBVIB_E_ARGUMENT, 6, "entry 1: normal is zero");
    n[3] = NAN;
    BAD("48", HBVIB_E_NOT_FINITE, 6, "entry 1: normal[0] = NaN");
    n[3] = 1;
    t[5] = 0;
    BAD("48", HBVIB_E_ARGUMENT, 7, "entry 1: tangent is zero");
    t[5] = t[3] = 1;
    BAD("48", HBVIB_E_ARGUMENT, 7, "entry 1: tangent is not orthogonal to normal");
    t[3] = 0;
    area[1] = -1; /* rows 43, 44 */
    BAD("43", HBVIB_E_ARGUMENT, 8, "entry 1: area = -1");
    area[1] = INFINITY;
    BAD("43", HBVIB_E_NOT_FINITE, 8, "entry 1: area = inf");
    area[1] = 2;
    p[0] = -1;
    BAD("44", HBVIB_E_ARGUMENT, 9, "entry 0: pressure = -1");
    p[0] = INFINITY;
    BAD("44", HBVIB_E_NOT_FINITE, 9, "entry 0: pressure = inf");
    p[0] = 1;
    g[1] = NAN;
    BAD("44", HBVIB_E_NOT_FINITE, 10, "entry 1: gap = NaN");
    g[1] = 0;
    law.kt = -1;
    BAD("43", HBVIB_E_ARGUMENT, 2, "patch, law: contact: kt = -1");
    law.kt = 1;
    law.kn = 0;
    BAD("43", HBVIB_E_ARGUMENT, 2, "patch, law: contact: kn = 0, needs a number > 0");
    law.kn = 1e300;
    area[0] = 1e300;
    BAD("26", HBVIB_E_NOT_FINITE, 2, "entry 0: contact: kn = inf");
    area[0] = law.kn = 1;
    law.sector_offset = 1; /* the model is a sector; a plain one has none */
    {
        hbvib_model *plain = NULL;
        WORKS("62", hbvib_model_new(NDOF, &plain));
        REFUSED("62", hbvib_model_add_patch(plain, &law, 2, a, b, n, t, area, p, g, &id), HBVIB_E_ARGUMENT, 2, "sector_offset = 1");
        WORKS("62", hbvib_model_free(plain));
    }
    law.kind = -1;
    BAD("54", HBVIB_E_ARGUMENT, 2, "kind = -1");
    law.struct_size = 8;
    BAD("66", HBVIB_E_STRUCT_SIZE, 2, "struct_size = 8");
    EXPECT("3", id == -5);
}

int main(void)
{
    begin();
    contacts(the_model);
    tables(the_model);
    spring_dampers(the_model);
    polynomials(the_model);
    patches(the_model);
    WORKS("24", hbvib_model_free(the_model));
    return verdict(180);
}
