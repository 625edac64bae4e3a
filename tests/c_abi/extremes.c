/* Rows 35, 38, 47, 50, 53, 82 and 84: other layouts and units, too many contacts, motions without bound, ends of a range. */
#include "common.h"

#include <time.h>

static hbvib_forced_options range(double start, double stop)
{
    hbvib_forced_options o;
    if (hbvib_forced_options_init(&o, sizeof o) != HBVIB_OK) abort();
    o.omega_start = start;
    o.omega_stop = stop;
    return o;
}

static hbvib_solver_options with_harmonics(int64_t harmonics)
{
    hbvib_solver_options s;
    if (hbvib_solver_options_init(&s, sizeof s) != HBVIB_OK) abort();
    s.tolerance = 0;
    s.harmonics = harmonics;
    return s;
}

/* Two masses with a slider between them; the second coordinate in a unit `unit` times larger, so that its rows and columns
 * of the matrices are too. */
static hbvib_model *pair_of_masses(double unit, int32_t storage)
{
    const double u = unit;
    const double mass[4] = {1, 0, 0, 2 * u * u}, stiffness[4] = {2, -u, -u, 3 * u * u}, damping[4] = {0.05, 0, 0, 0.02 * u * u};
    hbvib_matrix m = matrix(2, mass), k = matrix(2, stiffness), d = matrix(2, damping);
    hbvib_contact c;
    hbvib_model *model = NULL;
    m.storage = k.storage = d.storage = storage;
    WORKS("38", hbvib_model_new(2, &model));
    WORKS("38", hbvib_model_set_matrix(model, HBVIB_MASS, &m));
    WORKS("38", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &k));
    WORKS("38", hbvib_model_set_matrix(model, HBVIB_DAMPING, &d));
    WORKS("38", hbvib_contact_init(&c, sizeof c));
    c.kind = HBVIB_JENKINS;
    c.dof_a[0] = 0;
    c.kt = 1;
    c.mu = 0.3;
    c.preload = 1;
    WORKS("38", hbvib_model_add_contact(model, &c, NULL));
    WORKS("38", hbvib_model_add_force(model, 0, 1, 0.5, 0));
    return model;
}

/* Fundamental of the first mass at a frequency where the slider slips. */
static void first_mass(hbvib_model *model, double *x)
{
    hbvib_solver_options s = with_harmonics(9);
    hbvib_forced_options o = range(1.6, 1.6);
    hbvib_branch *branch = NULL;
    double all[2 * 10];
    s.response_dof = 0;
    WORKS("38", hbvib_forced_response(model, &s, &o, NULL, &branch));
    WORKS("38", hbvib_branch_harmonics(branch, 0, 0, 1, all, 10));
    x[0] = all[2];
    x[1] = all[3];
    WORKS("38", hbvib_branch_free(branch));
    WORKS("38", hbvib_model_free(model));
}

static void units_and_layouts(void)
{
    double x[2], y[2];
    first_mass(pair_of_masses(1, HBVIB_COL_MAJOR), x);
    first_mass(pair_of_masses(1e6, HBVIB_COL_MAJOR), y);
    EXPECT("38", hypot(x[0] - y[0], x[1] - y[1]) < 1e-8 * hypot(x[0], x[1]) && hypot(x[0], x[1]) > 0.4);
    first_mass(pair_of_masses(1e-6, HBVIB_COL_MAJOR), y);
    EXPECT("38", hypot(x[0] - y[0], x[1] - y[1]) < 1e-8 * hypot(x[0], x[1]));
    first_mass(pair_of_masses(1, HBVIB_ROW_MAJOR), y);
    EXPECT("35", x[0] == y[0] && x[1] == y[1]);
}

/* A mass without a spring that a constant force pulls off its stop: there is no static state. */
static void no_equilibrium(void)
{
    const double one = 1, none = 0, damping = 0.1;
    hbvib_matrix m = matrix(1, &one), k = matrix(1, &none), d = matrix(1, &damping);
    hbvib_solver_options s = with_harmonics(5);
    hbvib_forced_options o = range(0.9, 1.1);
    hbvib_contact c;
    hbvib_model *model = NULL;
    hbvib_branch *branch = NULL;
    hbvib_status status;
    WORKS("47", hbvib_model_new(1, &model));
    WORKS("47", hbvib_model_set_matrix(model, HBVIB_MASS, &m));
    WORKS("47", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &k));
    WORKS("47", hbvib_model_set_matrix(model, HBVIB_DAMPING, &d));
    WORKS("47", hbvib_contact_init(&c, sizeof c));
    c.kind = HBVIB_UNILATERAL;
    c.dof_a[2] = 0;
    c.kn = 1;
    c.gap = -0.1;
    WORKS("47", hbvib_model_add_contact(model, &c, NULL));
    WORKS("47", hbvib_model_add_force(model, 0, 0, 1, 0));
    WORKS("47", hbvib_model_add_force(model, 0, 1, 0.1, 0));
    status = hbvib_forced_response(model, &s, &o, NULL, &branch);
    EXPECT("47", (status == HBVIB_E_NO_CONVERGENCE || status == HBVIB_E_SINGULAR || status == HBVIB_E_NO_BOUNDED_SOLUTION) && branch == NULL);
    WORKS("47", hbvib_model_free(model));
}

static int32_t stop_at_once(void *user, const hbvib_phase_report *report)
{
    (void)user;
    (void)report;
    return 1;
}

/* 10^5 contacts are added in less time than a quadratic search would take, and a solve with them can be stopped. */
static void many_contacts(void)
{
    enum { MANY = 100000 };
    static int64_t dof_a[MANY], dof_b[MANY];
    static double kt[MANY], mu[MANY], preload[MANY];
    hbvib_solver_options s = with_harmonics(5);
    hbvib_forced_options o = range(1.5, 1.6);
    hbvib_model *model = pair_of_masses(1, HBVIB_COL_MAJOR);
    hbvib_branch *branch = NULL;
    hbvib_hooks h;
    const clock_t begin = clock();
    int i;
    for (i = 0; i < MANY; i++) {
        dof_b[i] = HBVIB_GROUND;
        kt[i] = mu[i] = preload[i] = 1e-5;
    }
    WORKS("50", hbvib_model_add_jenkins(model, MANY, dof_a, dof_b, NULL, kt, mu, preload, NULL));
    EXPECT("50", (double)(clock() - begin) / CLOCKS_PER_SEC < 1);
    EXPECT("50", hbvib_hooks_init(&h, sizeof h) == HBVIB_OK);
    h.phase = stop_at_once;
    EXPECT("50", hbvib_forced_response(model, &s, &o, &h, &branch) == HBVIB_STOPPED_BY_CALLER);
    if (branch != NULL) WORKS("50", hbvib_branch_free(branch));
    EXPECT("50", (double)(clock() - begin) / CLOCKS_PER_SEC < 2);
    WORKS("50", hbvib_model_free(model));
}

/* k = 1 - y^2 / 2: a barrier at y = 1.4, beyond which no motion is bounded. */
static void soft_cubic(void)
{
    const double one = 1, damping = 0.02;
    hbvib_matrix m = matrix(1, &one), k = matrix(1, &one), d = matrix(1, &damping);
    hbvib_solver_options s = with_harmonics(5);
    hbvib_forced_options o = range(0.3, 1.2);
    hbvib_contact c;
    hbvib_model *model = NULL;
    hbvib_branch *branch = NULL;
    hbvib_status status;
    WORKS("53", hbvib_model_new(1, &model));
    WORKS("53", hbvib_model_set_matrix(model, HBVIB_MASS, &m));
    WORKS("53", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &k));
    WORKS("53", hbvib_model_set_matrix(model, HBVIB_DAMPING, &d));
    WORKS("53", hbvib_contact_init(&c, sizeof c));
    c.kind = HBVIB_CUBIC;
    c.dof_a[0] = 0;
    c.cubic = -0.5;
    WORKS("53", hbvib_model_add_contact(model, &c, NULL));
    WORKS("53", hbvib_model_add_force(model, 0, 1, 0.5, 0));
    s.max_points = 300;
    status = hbvib_forced_response(model, &s, &o, NULL, &branch);
    EXPECT("53", status >= 0 ? hbvib_branch_points(branch) > 0 : status == HBVIB_E_NO_CONVERGENCE && branch == NULL);
    if (branch != NULL) WORKS("53", hbvib_branch_free(branch));
    WORKS("53", hbvib_model_free(model));
}

/* A fold at the very end of the range, from both sides. */
static void fold_at_the_end(void)
{
    const double one = 1, damping = 0.05;
    hbvib_matrix m = matrix(1, &one), k = matrix(1, &one), d = matrix(1, &damping);
    hbvib_solver_options s = with_harmonics(3);
    hbvib_contact c;
    hbvib_model *model = NULL;
    double omega[4], amplitude[4];
    int64_t count = 0;
    int i;
    WORKS("82", hbvib_model_new(1, &model));
    WORKS("82", hbvib_model_set_matrix(model, HBVIB_MASS, &m));
    WORKS("82", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &k));
    WORKS("82", hbvib_model_set_matrix(model, HBVIB_DAMPING, &d));
    WORKS("82", hbvib_contact_init(&c, sizeof c));
    c.kind = HBVIB_CUBIC;
    c.dof_a[0] = 0;
    c.cubic = 0.5;
    WORKS("82", hbvib_model_add_contact(model, &c, NULL));
    WORKS("82", hbvib_model_add_force(model, 0, 1, 0.15, 0));
    for (i = -1; i < 3; i++) {
        hbvib_forced_options o = range(0.8, i < 0 ? 2.5 : omega[0] * (1 + (i - 1) * 1e-12));
        hbvib_branch *branch = NULL;
        hbvib_view view;
        int64_t k;
        WORKS("82", hbvib_view_init(&view, sizeof view));
        EXPECT("82", hbvib_forced_response(model, &s, &o, NULL, &branch) >= 0);
        if (i < 0) WORKS("82", hbvib_branch_folds(branch, 4, omega, amplitude, NULL, &count));
        EXPECT("82", count == 2);
        WORKS("82", hbvib_branch_field(branch, HBVIB_OMEGA, &view));
        for (k = 0; k < view.shape[0]; k++)
            EXPECT("82", view.data[k] <= o.omega_stop && view.data[k] >= o.omega_start);
        WORKS("82", hbvib_branch_free(branch));
    }
    WORKS("82", hbvib_model_free(model));
}

/* Variables of the environment have no effect. */
static void environment(void)
{
    double x[2], y[2];
    first_mass(pair_of_masses(1, HBVIB_COL_MAJOR), x);
    setenv("HBVIB_NUM_THREADS", "abc", 1);
    setenv("OMP_NUM_THREADS", "-7", 1);
    setenv("RAYON_NUM_THREADS", "x", 1);
    first_mass(pair_of_masses(1, HBVIB_COL_MAJOR), y);
    EXPECT("84", x[0] == y[0] && x[1] == y[1]);
}

int main(void)
{
    begin();
    units_and_layouts();
    no_equilibrium();
    many_contacts();
    soft_cubic();
    fold_at_the_end();
    environment();
    return verdict(100);
}
