/* Contact laws against closed forms of their harmonics, tables and polynomials in a model against
 * those of the residual, patches against their sum of areas and against linear structures. */
#include "common.h"

static hbvib_contact contact(int32_t kind)
{
    hbvib_contact c;
    WORKS("contact", hbvib_contact_init(&c, sizeof c));
    EXPECT("contact", c.velocity == 0 && c.normal[2] == 0 && c.dof_b[2] == HBVIB_GROUND);
    c.kind = kind;
    return c;
}

static int near(double a, double b, double tolerance) { return fabs(a - b) <= tolerance; }

/* Harmonic 1 of a spring kt in series with a slider of limit g under amplitude a > g / kt:
 * with cos(t) = 1 - 2 g / (kt a) in phase kt a (t - sin t cos t) / pi, against it 4 g (1 - g / (kt a)) / pi. */
static void slider(double kt, double g, double a, double *re, double *im)
{
    double t = acos(1 - 2 * g / (kt * a));
    *re = kt * a / PI * (t - sin(t) * cos(t));
    *im = 4 * g / PI * (1 - g / (kt * a));
}

static void friction_in_one_direction(void)
{
    /* x in the first four numbers, then y. */
    double y[8] = {0, 0, 0.7, 0.4, 0, 0, 0, 0}, f[8], jac[64], re, im;
    const double a = hypot(0.7, 0.4);
    hbvib_contact c = contact(HBVIB_FRICTION_2D);
    c.kt = 3;
    c.kn = 2;
    c.mu = 0.4;
    c.preload = 1.5;
    slider(3, 0.6, a, &re, &im);
    WORKS("2d", hbvib_contact_evaluate(&c, 1, 0, 1, y, 4, f, 4, jac, 64));
    EXPECT("2d", near(f[2], (re * 0.7 - im * 0.4) / a, 1e-14) && near(f[3], (re * 0.4 + im * 0.7) / a, 1e-14));
    EXPECT("2d", f[4] == -1.5 && f[6] == 0 && f[7] == 0);
    EXPECT("2d", jac[8 * 6 + 6] == 2 && jac[8 * 6 + 2] != 0);
    /* Load at rest from a closing over the gap: 2 (0.3 - (-0.2)) = 1. */
    c.preload = 0;
    c.gap = -0.2;
    y[4] = -0.3;
    slider(3, 0.4, a, &re, &im);
    WORKS("2d", hbvib_contact_evaluate(&c, 1, 0, 1, y, 4, f, 4, NULL, 0));
    EXPECT("2d", near(f[2], (re * 0.7 - im * 0.4) / a, 1e-14) && near(f[4], -1, 1e-15));
    /* Half the time open: N = kn max(-y, 0) with y = 0.5 cos. */
    c.gap = 0;
    y[2] = y[3] = y[4] = 0;
    y[6] = 0.5;
    WORKS("2d", hbvib_contact_evaluate(&c, 1, 0, 1, y, 4, f, 4, NULL, 0));
    EXPECT("2d", near(f[4], -1 / PI, 1e-15) && near(f[6], 0.5, 1e-15) && f[2] == 0 && f[3] == 0);
    /* mu = 0 leaves the normal spring alone. */
    c.mu = 0;
    y[2] = 4;
    WORKS("2d", hbvib_contact_evaluate(&c, 1, 0, 1, y, 4, f, 4, NULL, 0));
    EXPECT("2d", f[2] == 0 && f[3] == 0 && near(f[6], 0.5, 1e-15));
    REFUSED("2d", hbvib_contact_evaluate(&c, 1, 0, 1, y, 2, f, 4, NULL, 0), HBVIB_E_DIMENSION, 6, "= 4");
}

static void friction_in_a_plane(void)
{
    double y[12] = {0}, f[12], re, im;
    hbvib_contact c = contact(HBVIB_FRICTION_3D);
    c.kt = 3;
    c.mu = 0.4;
    c.preload = 1.5;
    /* On a circle of radius r the spring has length 0.6 / 3 = r sin(phi) and leads by 90 deg - phi:
     * F = limit (sin + i cos). Samples err as their distance squared. */
    y[2] = 1;
    y[7] = -1; /* sin = Re(-i e^it) */
    WORKS("3d", hbvib_contact_evaluate(&c, 1, 8192, 1, y, 4, f, 4, NULL, 0));
    re = 0.6 * 0.2;
    im = 0.6 * sqrt(1 - 0.2 * 0.2);
    EXPECT("3d", near(f[2], re, 1e-6) && near(f[3], im, 1e-6));
    EXPECT("3d", near(f[6], im, 1e-6) && near(f[7], -re, 1e-6));
    /* On a line it is friction in one direction. */
    memset(y, 0, sizeof y);
    y[2] = 0.6;
    y[6] = 0.8;
    slider(3, 0.6, 1, &re, &im);
    WORKS("3d", hbvib_contact_evaluate(&c, 1, 8192, 1, y, 4, f, 4, NULL, 0));
    EXPECT("3d", near(f[2], 0.6 * re, 1e-6) && near(f[7], 0.8 * im, 1e-6));
    /* kn states that there is a motion along n: its force is -N. */
    c.kn = 5;
    REFUSED("3d", hbvib_contact_evaluate(&c, 1, 8192, 1, y, 4, f, 4, NULL, 0), HBVIB_E_DIMENSION, 6, "= 6");
    y[8] = -0.1;
    slider(3, 0.8, 1, &re, &im);
    WORKS("3d", hbvib_contact_evaluate(&c, 1, 8192, 1, y, 6, f, 6, NULL, 0));
    EXPECT("3d", near(f[8], -2, 1e-12) && near(f[2], 0.6 * re, 1e-6) && near(f[7], 0.8 * im, 1e-6));
    /* Directions are those of a model: none counts here. */
    c.normal[0] = NAN;
    WORKS("3d", hbvib_contact_evaluate(&c, 1, 0, 1, y, 6, f, 6, NULL, 0));
}

static void regularised(void)
{
    double y[4] = {0, 0, 1e-3, 0}, f[4];
    const double r = 2 * 1e-3 / 0.5; /* velocity over that of the law */
    hbvib_contact c = contact(HBVIB_REGULARISED);
    c.mu = 0.5;
    c.preload = 6;
    c.velocity = 0.5;
    /* limit tanh(r cos) has the harmonic r - r^3 / 4 + r^5 / 12, with the velocity. */
    WORKS("tanh", hbvib_contact_evaluate(&c, 1, 0, 2, y, 2, f, 2, NULL, 0));
    EXPECT("tanh", near(f[3], 3 * (r - r * r * r / 4 + pow(r, 5) / 12), 1e-14) && near(f[2], 0, 1e-15));
    y[2] = 1e3; /* Coulomb's square wave but for pi^2 / 24 (velocity / V)^2, below 1e-7 */
    WORKS("tanh", hbvib_contact_evaluate(&c, 1, 1 << 18, 2, y, 2, f, 2, NULL, 0));
    EXPECT("tanh", near(f[3], 3 * 4 / PI, 1e-6) && near(f[2], 0, 1e-12));
    c.velocity = 0;
    REFUSED("tanh", hbvib_contact_evaluate(&c, 1, 0, 2, y, 2, f, 2, NULL, 0), HBVIB_E_ARGUMENT, 1, "velocity = 0");
    c.velocity = -1;
    REFUSED("tanh", hbvib_contact_evaluate(&c, 1, 0, 2, y, 2, f, 2, NULL, 0), HBVIB_E_ARGUMENT, 1, "velocity = -1");
    c.velocity = NAN;
    REFUSED("tanh", hbvib_contact_evaluate(&c, 1, 0, 2, y, 2, f, 2, NULL, 0), HBVIB_E_NOT_FINITE, 1, "velocity = NaN");
    c.struct_size = 104; /* compiled before the field was there */
    REFUSED("tanh", hbvib_contact_evaluate(&c, 1, 0, 2, y, 2, f, 2, NULL, 0), HBVIB_E_ARGUMENT, 1, "velocity = 0");
}

enum { H = 3, DOFS = 2, MANY = 2 * (H + 1) * DOFS };

/* Forces of a model without mass, damping and stiffness at x_0 = a cos, x_1 = b cos, omega = 2. */
static void forces(hbvib_model *model, double mean, double a, double b, double *r)
{
    double x[MANY] = {0};
    hbvib_solver_options s = solver_options();
    s.harmonics = H;
    x[0] = mean;
    x[2 * DOFS] = a;
    x[2 * DOFS + 2] = b;
    WORKS("forces", hbvib_forced_residual(model, &s, 2, x, MANY / 2, r, MANY / 2, NULL, 0, NULL, 0));
}

static void tables_and_polynomials(void)
{
    const double at[3] = {-1, 0, 1}, push[3] = {0, 0, 4}, straight[3] = {-2, 0, 2};
    const double spring[3] = {1, 2, 3}, damper[3] = {0, 0, 0.25};
    const int64_t both[2] = {1, 0}, direction[3] = {0, 1, 0};
    const double coefficient[3] = {2, 3, 5};
    const int32_t x_powers[6] = {1, 2, 0, 0, 0, 1}, v_powers[6] = {0, 0, 0, 3, 1, 0};
    double quadratic[8] = {0}, cubic[16] = {0}, r[MANY];
    const double a = 0.5, b = 0.8;
    double *one = r + 2 * DOFS, *two = one + 2 * DOFS, *three = two + 2 * DOFS;
    hbvib_model *model = NULL;
    int64_t id = -1;

    WORKS("table", hbvib_model_new(DOFS, &model));
    WORKS("table", hbvib_model_add_table(model, 0, HBVIB_GROUND, 0, 3, at, push, &id));
    EXPECT("table", id == 0);
    forces(model, 0, a, b, r); /* 4 max(a cos, 0) */
    EXPECT("table", near(r[0], 4 * a / PI, 1e-15) && near(one[0], 2 * a, 1e-15) && near(two[0], 8 * a / (3 * PI), 1e-15));
    EXPECT("table", r[2] == 0 && one[2] == 0 && near(three[0], 0, 1e-15));
    WORKS("table", hbvib_model_add_table(model, 0, 1, 0, 3, at, straight, &id));
    EXPECT("table", id == 1);
    forces(model, 0, a, b, r); /* and 2 (x_0 - x_1) */
    EXPECT("table", near(one[0], 2 * a + 2 * (a - b), 1e-15) && near(one[2], 2 * (b - a), 1e-15));
    REFUSED("preload", hbvib_model_set_preload(model, 1, 1), HBVIB_E_ARGUMENT, 3, "table");
    WORKS("table", hbvib_model_free(model));

    WORKS("damper", hbvib_model_new(DOFS, &model));
    WORKS("damper", hbvib_model_add_spring_damper(model, 0, HBVIB_GROUND, 0, 3, spring, 3, damper, NULL));
    forces(model, 0, a, b, r); /* y + 2 y^2 + 3 y^3 + v^3 / 4, v = -2 a sin */
    EXPECT("damper", near(r[0], a * a, 1e-15) && near(two[0], a * a, 1e-15));
    EXPECT("damper", near(one[0], a + 2.25 * a * a * a, 1e-15) && near(three[0], 0.75 * a * a * a, 1e-15));
    EXPECT("damper", near(one[1], 0.1875 * pow(2 * a, 3), 1e-15) && r[2] == 0);
    WORKS("damper", hbvib_model_add_spring_damper(model, 1, HBVIB_GROUND, 0, 0, NULL, 1, spring, &id));
    EXPECT("damper", id == 1);
    forces(model, 0, a, b, r);
    EXPECT("damper", near(one[3], 2 * b, 1e-15) && near(one[2], 0, 1e-15));
    WORKS("damper", hbvib_model_add_spring_damper(model, 1, 0, 0, 1, spring, 0, NULL, &id));
    forces(model, 0, a, b, r);
    EXPECT("damper", near(one[2], b - a, 1e-15));
    WORKS("damper", hbvib_model_free(model));

    /* Motions u = x_1 and w = x_0: 2 u w^2 + 5 w u' on dof 1, 3 w'^3 on dof 0. */
    WORKS("polynomial", hbvib_model_new(DOFS, &model));
    WORKS("polynomial", hbvib_model_add_polynomial(model, both, 2, 3, direction, coefficient, x_powers, v_powers, &id));
    EXPECT("polynomial", id == 0);
    forces(model, 0, a, b, r);
    EXPECT("polynomial", near(one[2], 1.5 * b * a * a, 1e-15) && near(three[2], 0.5 * b * a * a, 1e-15));
    EXPECT("polynomial", near(two[3], 5 * a * b, 1e-15) && near(r[2], 0, 1e-15)); /* -2 a b cos sin = -a b sin 2 */
    EXPECT("polynomial", near(one[1], 2.25 * pow(2 * a, 3), 1e-14) && near(one[0], 0, 1e-15));
    REFUSED("preload", hbvib_model_set_preload(model, 0, 1), HBVIB_E_ARGUMENT, 3, "polynomial");
    /* Without velocities. */
    WORKS("polynomial", hbvib_model_add_polynomial(model, both, 2, 1, direction, coefficient, x_powers, NULL, &id));
    forces(model, 0, a, b, r);
    EXPECT("polynomial", near(one[2], 3 * b * a * a, 1e-15));
    WORKS("polynomial", hbvib_model_free(model));

    /* f_0 = 3 x_0 x_1, f_1 = 7 x_0^2 x_1 over dofs in order. */
    WORKS("tensors", hbvib_model_new(DOFS, &model));
    quadratic[1] = 1; /* 0 0 1 and 0 1 0: nothing is taken for symmetric */
    quadratic[2] = 2;
    cubic[8 + 1] = 7; /* 1 0 0 1 */
    {
        const int64_t order[2] = {0, 1};
        WORKS("tensors", hbvib_model_add_stiffness_tensors(model, order, 2, quadratic, cubic, &id));
        forces(model, 0.25, a, b, r);
        EXPECT("tensors", near(r[0], 1.5 * a * b, 1e-15) && near(one[0], 0.75 * b, 1e-15));
        EXPECT("tensors", near(one[2], 7 * b * (0.0625 + 0.75 * a * a), 1e-15));
        WORKS("tensors", hbvib_model_add_stiffness_tensors(model, order, 2, quadratic, NULL, NULL));
        WORKS("tensors", hbvib_model_add_stiffness_tensors(model, order, 2, NULL, cubic, &id));
        EXPECT("tensors", id == 2);
        forces(model, 0.25, a, b, r);
        EXPECT("tensors", near(r[0], 3 * a * b, 1e-15) && near(one[2], 14 * b * (0.0625 + 0.75 * a * a), 1e-15));
    }
    WORKS("tensors", hbvib_model_free(model));
}

/* n bodies of three directions each with mass, stiffness and forces in the given shares. */
static hbvib_model *bodies(int n, const double *share, double tangential, double normal)
{
    double m[144] = {0}, k[144] = {0}, c[144] = {0};
    hbvib_matrix a;
    hbvib_model *model = NULL;
    int i, j;
    WORKS("bodies", hbvib_model_new(3 * n, &model));
    for (i = 0; i < n; i++)
        for (j = 0; j < 3; j++) {
            m[(3 * i + j) * (3 * n + 1)] = share[i];
            k[(3 * i + j) * (3 * n + 1)] = share[i] * (1 + 0.5 * j);
            c[(3 * i + j) * (3 * n + 1)] = 0.05 * share[i];
        }
    a = matrix(3 * n, m);
    WORKS("bodies", hbvib_model_set_matrix(model, HBVIB_MASS, &a));
    a.values = k;
    WORKS("bodies", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a));
    a.values = c;
    WORKS("bodies", hbvib_model_set_matrix(model, HBVIB_DAMPING, &a));
    for (i = 0; i < n; i++) {
        WORKS("bodies", hbvib_model_add_force(model, 3 * i, 1, share[i] * tangential, 0));
        WORKS("bodies", hbvib_model_add_force(model, 3 * i + 1, 1, 0, share[i] * tangential));
        WORKS("bodies", hbvib_model_add_force(model, 3 * i + 2, 1, share[i] * normal, 0));
    }
    return model;
}

/* All harmonics 0 .. 5 at one frequency. */
static void response(hbvib_model *model, double omega, int64_t first_dof, double *x)
{
    hbvib_solver_options s = solver_options();
    hbvib_forced_options o;
    hbvib_branch *branch = NULL;
    WORKS("response", hbvib_forced_options_init(&o, sizeof o));
    s.harmonics = 5;
    o.omega_start = o.omega_stop = omega;
    WORKS("response", hbvib_forced_response(model, &s, &o, NULL, &branch));
    WORKS("response", hbvib_branch_harmonics(branch, 0, first_dof, 3, x, 18));
    WORKS("response", hbvib_branch_free(branch));
}

static double gap_of(const double *a, const double *b, int n)
{
    double gap = 0;
    while (n-- > 0) gap = fmax(gap, fabs(a[n] - b[n]));
    return gap;
}

static void patches(int32_t kind)
{
    const double share[4] = {0.1, 0.2, 0.3, 0.4}, one = 1;
    const int64_t dofs[12] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
    const double normal[12] = {0, 0, 1, 0, 0, 3, 0, 0, 0.1, 0, 0, 1}, tangent[12] = {1, 0, 0, 2, 0, 0, 1, 0, 0, 1, 0, 0};
    const double pressure[4] = {0.5, 0.5, 0.5, 0.5}, gaps[4] = {0.01, 0.01, 0.01, 0.01};
    const double omega = 1.3;
    double small[36], whole[36], linear[6];
    int64_t first = -1;
    int i;
    hbvib_model *four = bodies(4, share, 0.4, 0.1), *all = bodies(1, &one, 0.4, 0.1);
    hbvib_contact law = contact(kind), sum;
    law.kt = 2;
    law.kn = 3;
    law.mu = 0.5;
    law.preload = 0.7;
    sum = law;
    sum.dof_a[0] = 0;
    if (kind == HBVIB_FRICTION_3D) sum.dof_a[1] = 1;
    sum.dof_a[2] = 2;
    law.dof_a[1] = 77; /* not looked at, nor are directions */
    law.normal[0] = NAN;
    WORKS("patch", hbvib_model_add_patch(four, &law, 4, dofs, NULL, normal, tangent, share, NULL, NULL, &first));
    EXPECT("patch", first == 0);
    WORKS("patch", hbvib_model_add_contact(all, &sum, NULL));
    response(all, omega, 0, whole);
    EXPECT("patch", fabs(whole[30]) > 1e-6); /* it slips: a fifth harmonic */
    for (i = 0; i < 4; i++) {
        response(four, omega, 3 * i, small);
        EXPECT("patch", gap_of(small, whole, 36) < 1e-9);
    }
    /* Numbers follow each other; loads by number. */
    sum.preload = 0.9;
    WORKS("preload", hbvib_model_set_preload(all, 0, 0.9));
    for (i = 0; i < 4; i++) WORKS("preload", hbvib_model_set_preload(four, i, 0.9 * share[i]));
    response(all, omega, 0, whole);
    response(four, omega, 3, small);
    EXPECT("preload", gap_of(small, whole, 36) < 1e-9);
    WORKS("patch", hbvib_model_free(four));
    WORKS("patch", hbvib_model_free(all));

    /* Pressed together, then vibrating little: the linear structure with kt and kn, about the rest
     * position that load and spring hold: k x = N = 0.5 - 3 (x + 0.01), as closing is -x. */
    four = bodies(4, share, 1e-3, 1e-3);
    WORKS("stuck", hbvib_model_add_patch(four, &law, 4, dofs, NULL, normal, tangent, share, pressure, gaps, NULL));
    response(four, omega, 6, small);
    for (i = 0; i < 3; i++) {
        double stiffness = 1 + 0.5 * i + (i == 2 ? 3 : i == 0 || kind == HBVIB_FRICTION_3D ? 2 : 0) - omega * omega;
        double size = stiffness * stiffness + 0.0025 * omega * omega;
        linear[2 * i] = 1e-3 * (i == 1 ? 0.05 * omega : stiffness) / size;
        linear[2 * i + 1] = 1e-3 * (i == 1 ? stiffness : -0.05 * omega) / size;
    }
    EXPECT("stuck", gap_of(small + 6, linear, 6) < 1e-10 * 1e-3);
    EXPECT("stuck", near(small[4], (0.5 - 3 * 0.01) / 5, 1e-12) && near(small[0], 0, 1e-15));
    WORKS("stuck", hbvib_model_free(four));
}

/* A law of one direction, inclined; a pair without area; no pairs. */
static void directions(void)
{
    const double one = 1, areas[2] = {0.5, 0}, n[6] = {0, 0, 1, 0, 0, 1}, t[6] = {3, 4, 0, 0, 1, 0};
    const int64_t dofs[6] = {0, 1, 2, 0, 1, 2};
    double x[36], again[36];
    int64_t first = -1;
    hbvib_model *model = bodies(1, &one, 0.4, 0), *other = bodies(1, &one, 0.4, 0);
    hbvib_contact c = contact(HBVIB_FRICTION_2D), law = c;
    law.kt = 4;
    law.kn = 6;
    law.mu = 0.3;
    law.preload = 2;
    c.kt = 2;
    c.kn = 3;
    c.mu = 0.3;
    c.preload = 1;
    c.dof_a[0] = 0;
    c.dof_a[1] = 1;
    c.dof_a[2] = 2;
    memcpy(c.normal, n, sizeof c.normal);
    REFUSED("tangent", hbvib_model_add_contact(model, &c, NULL), HBVIB_E_ARGUMENT, 2, "tangent is zero");
    memcpy(c.tangent, t, sizeof c.tangent);
    WORKS("directions", hbvib_model_add_contact(model, &c, NULL));
    response(model, 1.3, 0, x);
    WORKS("directions", hbvib_model_add_patch(other, &law, 2, dofs, NULL, n, t, areas, NULL, NULL, &first));
    WORKS("directions", hbvib_model_add_patch(other, &law, 0, NULL, NULL, NULL, NULL, NULL, NULL, NULL, &first));
    EXPECT("directions", first == 2);
    response(other, 1.3, 0, again);
    EXPECT("directions", gap_of(x, again, 36) < 1e-12);
    WORKS("directions", hbvib_model_free(model));
    WORKS("directions", hbvib_model_free(other));
}

/* Elements whose coefficients are all zero change nothing. */
static void without_force(void)
{
    const double one = 1, zeros[8] = {0}, points[2] = {-1, 1};
    const int64_t dofs[2] = {0, 2}, direction = 1;
    const int32_t powers[2] = {2, 1};
    double x[36], again[36];
    hbvib_model *model = bodies(1, &one, 0.4, 0.2);
    hbvib_contact c = contact(HBVIB_FRICTION_3D);
    response(model, 1.3, 0, x);
    WORKS("zero", hbvib_model_add_table(model, 0, HBVIB_GROUND, 0, 2, points, zeros, NULL));
    WORKS("zero", hbvib_model_add_spring_damper(model, 0, 1, 0, 2, zeros, 3, zeros, NULL));
    WORKS("zero", hbvib_model_add_polynomial(model, dofs, 2, 1, &direction, zeros, powers, NULL, NULL));
    WORKS("zero", hbvib_model_add_stiffness_tensors(model, dofs, 2, zeros, NULL, NULL));
    c.dof_a[0] = 0;
    c.dof_a[1] = 1;
    EXPECT("zero", hbvib_model_add_contact(model, &c, NULL) == HBVIB_E_ARGUMENT && strstr(hbvib_last_error(), "kt = 0"));
    response(model, 1.3, 0, again);
    EXPECT("zero", gap_of(x, again, 36) < 1e-13);
    WORKS("zero", hbvib_model_free(model));
}

int main(void)
{
    friction_in_one_direction();
    friction_in_a_plane();
    regularised();
    tables_and_polynomials();
    patches(HBVIB_FRICTION_2D);
    patches(HBVIB_FRICTION_3D);
    directions();
    without_force();
    return verdict(150);
}
