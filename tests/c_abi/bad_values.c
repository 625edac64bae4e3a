/* Rows 24 to 48 and 54: values in matrices, forces and contacts. */
#include "common.h"

static void matrices(hbvib_model *model)
{
    const double bad[] = {NAN, INFINITY, -INFINITY};
    const int places[] = {0, 5, 15};
    const char *const names[] = {"[0,0]", "[1,1]", "[3,3]"};
    double values[32];
    hbvib_matrix a;
    size_t i, j;
    int which;

    for (which = HBVIB_MASS; which <= HBVIB_STIFFNESS; which++) /* row 24 */
        for (i = 0; i < 3; i++)
            for (j = 0; j < 3; j++) {
                memcpy(values, which == HBVIB_MASS ? MASS : STIFFNESS, sizeof MASS);
                values[places[j]] = bad[i];
                a = matrix(NDOF, values);
                REFUSED("24", hbvib_model_set_matrix(model, which, &a), HBVIB_E_NOT_FINITE, 3, names[j]);
                REFUSED("24", hbvib_cyclic_set_coupling(model, which, &a), HBVIB_E_NOT_FINITE, 3, names[j]);
            }
    REFUSED("24", hbvib_model_set_rayleigh(model, NAN, 0), HBVIB_E_NOT_FINITE, 2, "alpha_mass = NaN");
    REFUSED("24", hbvib_model_set_rayleigh(model, 0, INFINITY), HBVIB_E_NOT_FINITE, 3, "beta_stiffness = inf");
    REFUSED("24", hbvib_model_add_force(model, 0, 1, NAN, 0), HBVIB_E_NOT_FINITE, 4, "NaN");
    REFUSED("24", hbvib_model_add_force(model, 0, 1, 0, INFINITY), HBVIB_E_NOT_FINITE, 5, "inf");
    {
        hbvib_forced_options o = frequencies(207, 211);
        hbvib_branch *branch = NULL;
        double guess[80] = {0}, r[80], motion[4] = {0, 0, NAN, 0};
        hbvib_contact c = ring_contact();
        guess[79] = NAN;
        o.guess = guess;
        o.guess_len = 40;
        REFUSED("24", hbvib_forced_response(model, NULL, &o, NULL, &branch), HBVIB_E_NOT_FINITE, 3, "guess[39]");
        r[0] = -7;
        REFUSED("24", hbvib_forced_residual(model, NULL, 1, guess, 40, r, 40, NULL, 0, NULL, 0), HBVIB_E_NOT_FINITE, 4, "x[39]");
        REFUSED("24", hbvib_contact_evaluate(&c, 1, 0, 1, motion, 2, r, 2, NULL, 0), HBVIB_E_NOT_FINITE, 5, "motion[1]");
        EXPECT("24", r[0] == -7 && branch == NULL);
    }

    memcpy(values, STIFFNESS, sizeof STIFFNESS); /* rows 27, 34 */
    values[1] = -1e6;
    a = matrix(NDOF, values);
    REFUSED("27", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a), HBVIB_E_NOT_HERMITIAN, 3, "stiffness[1,0]");
    values[1] = values[6] = values[2] = values[3] = 0;
    a = matrix(NDOF, values);
    REFUSED("34", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a), HBVIB_E_NOT_HERMITIAN, 3, "triangle");
    a.part = HBVIB_LOWER;
    a.storage = HBVIB_ROW_MAJOR;
    values[1] = NAN; /* the other triangle is not read */
    WORKS("34", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a));
    EXPECT("34", same_solution(model, &the_solution));
    /* Of a real matrix the parts with A = A^T are those of a Hermitian one. */
    memcpy(values, STIFFNESS, sizeof STIFFNESS);
    a = matrix(NDOF, values);
    for (which = HBVIB_SYMMETRIC; which <= HBVIB_SYMMETRIC_UPPER; which++) {
        a.part = which;
        values[1] = which == HBVIB_SYMMETRIC_UPPER ? NAN : STIFFNESS[1];
        values[4] = which == HBVIB_SYMMETRIC_LOWER ? NAN : STIFFNESS[4];
        WORKS("34", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a));
        EXPECT("34", same_solution(model, &the_solution));
    }
    a = matrix(NDOF, MASS);
    a.part = HBVIB_GENERAL;
    REFUSED("27", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_NOT_HERMITIAN, 3, "GENERAL");
    a.part = 7;
    REFUSED("54", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_ARGUMENT, 3, "part = 7");
    a.part = 0;
    a.scalar = -1;
    REFUSED("54", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_ARGUMENT, 3, "scalar = -1");
    a.scalar = 0;
    a.storage = 3;
    REFUSED("54", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_ARGUMENT, 3, "storage = 3");
    a.storage = 0;
    REFUSED("54", hbvib_model_set_matrix(model, 6, &a), HBVIB_E_ARGUMENT, 2, "which = 6");
    REFUSED("54", hbvib_model_set_matrix(model, -1, &a), HBVIB_E_ARGUMENT, 2, "which = -1");
    a.reserved = 1;
    REFUSED("68", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_ARGUMENT, 3, "reserved = 1");
    REFUSED("27", hbvib_cyclic_set_coupling_previous(model, HBVIB_MASS, &a), HBVIB_E_ARGUMENT, 3, "reserved");
    a.reserved = 0;
    REFUSED("27", hbvib_cyclic_set_coupling_previous(model, HBVIB_MASS, &a), HBVIB_E_UNSUPPORTED, 3, "mass");

    { /* rows 28, 29: complex sector matrices */
        hbvib_model *wheel = NULL;
        hbvib_matrix h;
        for (i = 0; i < 16; i++) {
            values[2 * i] = STIFFNESS[i];
            values[2 * i + 1] = 0;
        }
        h = matrix(NDOF, values);
        h.scalar = HBVIB_COMPLEX;
        WORKS("28", hbvib_cyclic_new(NDOF, 24, &wheel));
        values[3] = 1e3;
        REFUSED("28", hbvib_cyclic_set_diameter(wheel, HBVIB_STIFFNESS, 2, &h), HBVIB_E_NOT_HERMITIAN, 4, "stiffness[1,0]");
        values[3] = 0;
        values[1] = 1e6;
        REFUSED("29", hbvib_cyclic_set_diameter(wheel, HBVIB_STIFFNESS, 2, &h), HBVIB_E_NOT_HERMITIAN, 4, "stiffness[0,0]");
        values[1] = 1e-17;
        WORKS("29", hbvib_cyclic_set_diameter(wheel, HBVIB_STIFFNESS, 2, &h));
        /* row 63: any number of waves counts modulo the sectors, but a matrix belongs to a number */
        WORKS("63", hbvib_cyclic_set_diameter(wheel, HBVIB_STIFFNESS, INT64_MAX, &h));
        WORKS("63", hbvib_cyclic_set_diameter(wheel, HBVIB_STIFFNESS, INT64_MIN, &h));
        REFUSED("63", hbvib_cyclic_set_diameter(wheel, HBVIB_STIFFNESS, HBVIB_DIAMETER_OF_ENGINE_ORDER, &h), HBVIB_E_ARGUMENT, 3,
                "diameter = -2147483647, needs a number of waves");
        WORKS("28", hbvib_model_free(wheel));
        WORKS("64", hbvib_model_new(NDOF, &wheel));
        REFUSED("64", hbvib_linear_modes(wheel, 3, 0, 4, values, NULL), HBVIB_E_ARGUMENT, 2, "diameter = 3, needs 0 .. 0");
        REFUSED("64", hbvib_linear_modes(wheel, -1, 0, 4, values, NULL), HBVIB_E_ARGUMENT, 2, "diameter = -1, needs 0 .. 0");
        WORKS("64", hbvib_model_free(wheel));
    }
    { /* rows 30 to 33: singular, indefinite and zero matrices */
        const double k1 = -1, zero = 0, k2[4] = {1, 0, 0, 1}, m2[4] = {1, 2, 2, 1};
        double omega = -1;
        hbvib_model *one = NULL;
        hbvib_branch *branch = NULL;
        hbvib_forced_options o = frequencies(1, 2);
        hbvib_solver_options s = solver_options();
        a = matrix(1, &k1);
        WORKS("31", hbvib_model_new(1, &one));
        REFUSED("31", hbvib_model_set_matrix(one, HBVIB_MASS, &a), HBVIB_E_NOT_POSITIVE_DEFINITE, 3, "mass[0,0]");
        REFUSED("33", hbvib_linear_modes(one, 0, 0, 1, &omega, NULL), HBVIB_E_ARGUMENT, 0, "no matrices were set");
        /* row 33: without a force the zero solution, and a status that says so */
        a.values = k2;
        WORKS("33", hbvib_model_set_matrix(one, HBVIB_MASS, &a));
        WORKS("33", hbvib_model_set_matrix(one, HBVIB_STIFFNESS, &a));
        EXPECT("33", hbvib_forced_response(one, &s, &o, NULL, &branch) == HBVIB_STOPPED_NO_FORCE);
        {
            double x[20];
            WORKS("33", hbvib_branch_harmonics(branch, 0, 0, 1, x, 10));
            for (i = 0; i < 20; i++) EXPECT("33", x[i] == 0);
        }
        WORKS("33", hbvib_branch_free(branch));
        branch = NULL;
        a.values = &zero; /* row 32: nothing carries a constant force */
        WORKS("32", hbvib_model_set_matrix(one, HBVIB_STIFFNESS, &a));
        WORKS("32", hbvib_model_add_force(one, 0, 0, 1, 0));
        REFUSED("32", hbvib_forced_response(one, &s, &o, NULL, &branch), HBVIB_E_SINGULAR, 0, "harmonic 0");
        EXPECT("32", branch == NULL);
        WORKS("31", hbvib_model_free(one));
        WORKS("31", hbvib_model_new(2, &one));
        a = matrix(2, m2);
        WORKS("31", hbvib_model_set_matrix(one, HBVIB_MASS, &a));
        a = matrix(2, k2);
        WORKS("31", hbvib_model_set_matrix(one, HBVIB_STIFFNESS, &a));
        REFUSED("31", hbvib_linear_modes(one, 0, 0, 1, &omega, NULL), HBVIB_E_NOT_POSITIVE_DEFINITE, 0, "mass");
        EXPECT("31", omega < 0);
        WORKS("31", hbvib_model_free(one));
    }
}

static void contacts(hbvib_model *model)
{
    const int64_t bad_dofs[] = {-2, 4, INT64_MAX, INT64_MIN};
    const double bad[] = {-1, NAN, INFINITY, -INFINITY};
    hbvib_contact c;
    int64_t id = -5;
    size_t i;

    for (i = 0; i < 4; i++) { /* row 39 */
        c = ring_contact();
        c.dof_a[0] = bad_dofs[i];
        REFUSED("39", hbvib_model_add_contact(model, &c, &id), HBVIB_E_INDEX, 2, "needs 0 .. 3");
        c = ring_contact();
        c.dof_b[0] = bad_dofs[i];
        REFUSED("39", hbvib_model_add_contact(model, &c, &id), HBVIB_E_INDEX, 2, "dof_b[0]");
        REFUSED("39", hbvib_model_add_force(model, bad_dofs[i], 1, 1, 0), HBVIB_E_INDEX, 2, "needs 0 .. 3");
    }
    REFUSED("39", hbvib_model_add_force(model, -1, 1, 1, 0), HBVIB_E_INDEX, 2, "dof = -1");
    REFUSED("60", hbvib_model_add_force(model, 0, -1, 1, 0), HBVIB_E_ARGUMENT, 3, "harmonic = -1");
    REFUSED("60", hbvib_model_add_force(model, 0, INT64_MAX, 1, 0), HBVIB_E_ARGUMENT, 3, "harmonic");
    REFUSED("60", hbvib_model_add_force(model, 0, 0, 1, 1), HBVIB_E_ARGUMENT, 5, "constant");
    c = ring_contact(); /* row 41 */
    c.dof_b[0] = 2;
    REFUSED("41", hbvib_model_add_contact(model, &c, &id), HBVIB_E_ARGUMENT, 2, "same degree of freedom");
    c.dof_a[0] = c.dof_b[0] = HBVIB_GROUND;
    REFUSED("41", hbvib_model_add_contact(model, &c, &id), HBVIB_E_ARGUMENT, 2, "ground");
    for (i = 0; i < 4; i++) { /* rows 43, 44 */
        hbvib_status wanted = i == 0 ? HBVIB_E_ARGUMENT : HBVIB_E_NOT_FINITE;
        c = ring_contact();
        c.kt = bad[i];
        if (i != 2)                                 /* an infinite kt is rigid, a negative one is out of range */
            REFUSED("43", hbvib_model_add_contact(model, &c, &id), i == 3 ? HBVIB_E_ARGUMENT : wanted, 2, "kt");
        c = ring_contact();
        c.mu = bad[i];
        REFUSED("44", hbvib_model_add_contact(model, &c, &id), wanted, 2, "mu");
        if (i == 2) continue;                       /* an infinite preload sticks for ever */
        if (i == 3) wanted = HBVIB_E_ARGUMENT;      /* a negative one is out of range */
        c = ring_contact();
        c.preload = bad[i];
        REFUSED("44", hbvib_model_add_contact(model, &c, &id), wanted, 2, "preload");
        REFUSED("44", hbvib_model_set_preload(model, 0, bad[i]), wanted, 3, "preload");
    }
    c = ring_contact(); /* row 54 */
    c.kind = 9999;
    REFUSED("54", hbvib_model_add_contact(model, &c, &id), HBVIB_E_ARGUMENT, 2, "kind = 9999");
    c.kind = 0;
    REFUSED("54", hbvib_model_add_contact(model, &c, &id), HBVIB_E_ARGUMENT, 2, "kind = 0");
    c = ring_contact();
    c.kn = 1;
    REFUSED("54", hbvib_model_add_contact(model, &c, &id), HBVIB_E_ARGUMENT, 2, "kn = 1");
    c = ring_contact();
    c.gap = NAN;
    REFUSED("54", hbvib_model_add_contact(model, &c, &id), HBVIB_E_NOT_FINITE, 2, "gap = NaN");
    c.gap = 1;
    REFUSED("54", hbvib_model_add_contact(model, &c, &id), HBVIB_E_ARGUMENT, 2, "gap = 1, needs 0");
    /* A unilateral spring acts along n alone. */
    {
        double y[4] = {-0.5, 0, 1, 0}, f[4];
        hbvib_contact stop;
        WORKS("54", hbvib_contact_init(&stop, sizeof stop));
        stop.kind = HBVIB_UNILATERAL;
        stop.kn = 3;
        stop.gap = 0.5;
        stop.dof_b[2] = 1;
        WORKS("54", hbvib_contact_evaluate(&stop, 1, 0, 1, y, 2, f, 2, NULL, 0));
        EXPECT("54", fabs(f[0] + 3 / PI) < 1e-15 && fabs(f[2] - 1.5) < 1e-15 && fabs(f[3]) < 1e-15);
        stop.dof_b[0] = 1;
        REFUSED("54", hbvib_model_add_contact(model, &stop, &id), HBVIB_E_ARGUMENT, 2, "dof_b[0] = 1");
        stop.dof_b[0] = HBVIB_GROUND;
        stop.dof_b[2] = NDOF;
        REFUSED("54", hbvib_model_add_contact(model, &stop, &id), HBVIB_E_INDEX, 2, "dof_b[2] = 4");
        stop.dof_b[2] = 1;
        stop.kt = 1;
        REFUSED("54", hbvib_model_add_contact(model, &stop, &id), HBVIB_E_ARGUMENT, 2, "kt = 1, needs 0");
        stop.kt = 0;
        stop.mu = 0.1;
        REFUSED("54", hbvib_model_add_contact(model, &stop, &id), HBVIB_E_ARGUMENT, 2, "mu = 0.1, needs 0");
        stop.mu = 0;
        stop.kn = -1;
        REFUSED("43", hbvib_model_add_contact(model, &stop, &id), HBVIB_E_ARGUMENT, 2, "kn = -1");
        stop.kn = 3;
        stop.preload = INFINITY;
        REFUSED("44", hbvib_model_add_contact(model, &stop, &id), HBVIB_E_NOT_FINITE, 2, "preload = inf");
        stop.preload = -1;
        REFUSED("44", hbvib_model_add_contact(model, &stop, &id), HBVIB_E_ARGUMENT, 2, "preload = -1");
    }
    c = ring_contact();
    c.cubic = 2;
    REFUSED("54", hbvib_model_add_contact(model, &c, &id), HBVIB_E_ARGUMENT, 2, "cubic = 2, needs 0");
    c.struct_size = 104; /* compiled before the field was there: not read */
    {
        double y[4] = {0, 0, 1e-4, 0}, f[4];
        WORKS("54", hbvib_contact_evaluate(&c, 1, 0, 1, y, 2, f, 2, NULL, 0));
    }
    c = cubic_contact();
    c.kn = 1;
    REFUSED("54", hbvib_model_add_contact(model, &c, &id), HBVIB_E_ARGUMENT, 2, "kn = 1");
    c = cubic_contact();
    c.gap = -1;
    REFUSED("54", hbvib_model_add_contact(model, &c, &id), HBVIB_E_ARGUMENT, 2, "gap = -1");
    c = cubic_contact();
    c.mu = 0.3;
    REFUSED("54", hbvib_model_add_contact(model, &c, &id), HBVIB_E_ARGUMENT, 2, "mu = 0.3, needs 0");
    c = cubic_contact();
    c.preload = INFINITY;
    REFUSED("54", hbvib_model_add_contact(model, &c, &id), HBVIB_E_ARGUMENT, 2, "preload = inf, needs 0");
    c = cubic_contact();
    c.dof_b[1] = 1;
    REFUSED("54", hbvib_model_add_contact(model, &c, &id), HBVIB_E_ARGUMENT, 2, "dof_b");
    for (i = 0; i < 4; i++) { /* rows 43, 44: its cubic term has any sign */
        c = cubic_contact();
        c.kt = bad[i];
        REFUSED("43", hbvib_model_add_contact(model, &c, &id), i == 0 ? HBVIB_E_ARGUMENT : HBVIB_E_NOT_FINITE, 2, "kt");
        c = cubic_contact();
        c.cubic = bad[i];
        if (i > 0) REFUSED("44", hbvib_model_add_contact(model, &c, &id), HBVIB_E_NOT_FINITE, 2, "cubic");
    }
    c = ring_contact();
    c.dof_a[2] = 1;
    REFUSED("54", hbvib_model_add_contact(model, &c, &id), HBVIB_E_ARGUMENT, 2, "dof_a");
    c = ring_contact();
    c.struct_size = 0;
    REFUSED("66", hbvib_model_add_contact(model, &c, &id), HBVIB_E_STRUCT_SIZE, 2, "struct_size = 0");
    REFUSED("52", hbvib_model_set_preload(model, 1, 1), HBVIB_E_INDEX, 2, "id = 1");
    REFUSED("52", hbvib_model_set_preload(model, -1, 1), HBVIB_E_INDEX, 2, "id = -1");
    EXPECT("39", id == -5);

    { /* rows 43, 44, 45: kt = 0, mu = 0, preload = 0 give no force; a huge limit sticks */
        double y[4] = {0, 0, 1e-4, 0}, f[4], jac[16];
        c = ring_contact();
        c.kt = 0;
        WORKS("43", hbvib_contact_evaluate(&c, 1, 0, 1, y, 2, f, 2, jac, 16));
        EXPECT("43", f[2] == 0 && f[3] == 0);
        REFUSED("43", hbvib_model_add_contact(model, &c, &id), HBVIB_E_ARGUMENT, 2, "kt = 0, needs a number > 0");
        c = ring_contact();
        c.preload = 0;
        WORKS("44", hbvib_contact_evaluate(&c, 1, 0, 1, y, 2, f, 2, NULL, 0));
        EXPECT("44", f[2] == 0 && f[3] == 0);
        c.mu = 0;
        c.preload = INFINITY;
        WORKS("44", hbvib_contact_evaluate(&c, 1, 0, 1, y, 2, f, 2, NULL, 0));
        EXPECT("44", f[2] == 0 && f[3] == 0);
        c.mu = 0.3;
        WORKS("45", hbvib_contact_evaluate(&c, 1, 0, 1, y, 2, f, 2, NULL, 0));
        EXPECT("45", f[2] == 5e3 && f[3] == 0);
        c.preload = 1e300;
        WORKS("45", hbvib_contact_evaluate(&c, 1, 0, 1, y, 2, f, 2, NULL, 0));
        EXPECT("45", f[2] == 5e3 && f[3] == 0);
    }
    { /* the describing function of a cubic spring, and no preload on it */
        double y[4] = {0, 0, 0, 2}, f[4], jac[16];
        hbvib_model *copy = NULL;
        c = cubic_contact();
        WORKS("43", hbvib_contact_evaluate(&c, 1, 0, 1, y, 2, f, 2, jac, 16));
        EXPECT("43", f[2] == 0 && f[3] == (5 - 0.75 * 2 * 4) * 2);
        WORKS("43", hbvib_model_clone(model, &copy));
        WORKS("43", hbvib_model_add_contact(copy, &c, NULL));
        REFUSED("44", hbvib_model_set_preload(copy, 1, 1), HBVIB_E_ARGUMENT, 3, "cubic spring");
        WORKS("43", hbvib_model_free(copy));
    }
    { /* row 42: equal contacts add up. Row 49: no contact is a linear problem. Row 46: kt = 1e30. */
        hbvib_model *copy = NULL;
        solution *found = malloc(sizeof *found);
        hbvib_status status;
        if (found == NULL) abort();
        WORKS("42", hbvib_model_clone(model, &copy));
        EXPECT("42", same_solution(copy, &the_solution));
        c = ring_contact();
        WORKS("42", hbvib_model_add_contact(copy, &c, &id));
        EXPECT("42", id == 1);
        WORKS("42", solve(copy, found));
        WORKS("44", hbvib_model_set_preload(copy, 1, 0));
        EXPECT("44", same_solution(copy, &the_solution));
        WORKS("44", hbvib_model_set_preload(copy, 1, INFINITY));
        WORKS("44", solve(copy, found));
        WORKS("42", hbvib_model_free(copy));
        WORKS("46", hbvib_model_clone(model, &copy));
        c.kt = 1e30;
        WORKS("46", hbvib_model_add_contact(copy, &c, NULL));
        status = solve(copy, found);
        EXPECT("46", status == HBVIB_OK || status == HBVIB_E_NO_CONVERGENCE || status > 0);
        WORKS("46", hbvib_model_free(copy));
        free(found);
    }
    { /* a plain structure has no neighbouring sector */
        hbvib_model *plain = NULL;
        hbvib_matrix k = matrix(2, STIFFNESS);
        const double k2[4] = {2, -1, -1, 2};
        k.values = k2;
        WORKS("62", hbvib_model_new(2, &plain));
        REFUSED("62", hbvib_cyclic_set_coupling(plain, HBVIB_STIFFNESS, &k), HBVIB_E_UNSUPPORTED, 3, "plain");
        c = ring_contact();
        c.dof_a[0] = 0;
        c.dof_b[0] = 1;
        c.sector_offset = 1;
        REFUSED("62", hbvib_model_add_contact(plain, &c, NULL), HBVIB_E_ARGUMENT, 2, "sector_offset = 1");
        WORKS("62", hbvib_model_free(plain));
    }
}

static void extremes(void)
{
    /* Rows 25, 26, 45: tiny and huge numbers end in a defined status, never in NaN with success. */
    const double scales[] = {1e-320, 1e-300, 1e-150, 1e150, 1e300};
    size_t i, j, n;
    for (i = 0; i < sizeof scales / sizeof *scales; i++) {
        for (n = 0; n < 2; n++) {
            hbvib_model *model = ring_damper();
            solution *found = malloc(sizeof *found);
            double k[16];
            hbvib_matrix a = matrix(NDOF, k);
            hbvib_status status;
            if (found == NULL) abort();
            for (j = 0; j < 16; j++) k[j] = (n ? MASS : STIFFNESS)[j] * scales[i];
            status = hbvib_model_set_matrix(model, n ? HBVIB_MASS : HBVIB_STIFFNESS, &a);
            if (status == HBVIB_OK) {
                status = solve(model, found);
                if (status == HBVIB_OK)
                    for (j = 0; j < (size_t)found->points; j++) EXPECT("25, 26", isfinite(found->amplitude[j]));
            }
            EXPECT("25, 26", status != HBVIB_E_INTERNAL);
            WORKS("25, 26", hbvib_model_clear_forces(model));
            WORKS("25, 26", hbvib_model_add_force(model, 0, 1, scales[i], 0));
            WORKS("25, 26", hbvib_model_free(model));
            model = ring_damper();
            WORKS("26", hbvib_model_add_force(model, 0, 1, 1e5 * scales[i] * 1e3, 0));
            status = solve(model, found);
            if (status == HBVIB_OK)
                for (j = 0; j < (size_t)found->points; j++) EXPECT("26", isfinite(found->amplitude[j]));
            EXPECT("26", status != HBVIB_E_INTERNAL);
            WORKS("26", hbvib_model_free(model));
            free(found);
        }
    }
}

int main(void)
{
    begin();
    matrices(the_model);
    contacts(the_model);
    extremes();
    WORKS("24", hbvib_model_free(the_model));
    return verdict(150);
}
