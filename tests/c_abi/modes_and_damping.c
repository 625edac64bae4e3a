/* Modes about the static state, structural damping given as one triangle, terms of the speed: closed forms, and what is
 * refused. */
#include "common.h"

static const double ETA = 0.02;

static int near(double a, double b, double tolerance)
{
    return fabs(a - b) <= tolerance * fabs(b);
}

/* m = 1 on a spring of 1. */
static hbvib_model *oscillator(void)
{
    const double one = 1;
    hbvib_model *model = NULL;
    hbvib_matrix a = matrix(1, &one);
    WORKS("oscillator", hbvib_model_new(1, &model));
    WORKS("oscillator", hbvib_model_set_matrix(model, HBVIB_MASS, &a));
    WORKS("oscillator", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a));
    return model;
}

static hbvib_contact contact(int32_t kind)
{
    hbvib_contact c;
    WORKS("contact", hbvib_contact_init(&c, sizeof c));
    c.kind = kind;
    return c;
}

static hbvib_mode_options amplitude_range(double from, double to)
{
    hbvib_mode_options o;
    WORKS("options", hbvib_mode_options_init(&o, sizeof o));
    o.log10_start = from;
    o.log10_stop = to;
    return o;
}

static hbvib_branch *mode(hbvib_model *model, int64_t harmonics, double from, double to)
{
    hbvib_solver_options s = solver_options();
    hbvib_mode_options o = amplitude_range(from, to);
    hbvib_branch *branch = NULL;
    s.harmonics = harmonics;
    WORKS("mode", hbvib_nonlinear_mode(model, &s, &o, NULL, &branch));
    return branch;
}

static hbvib_mode_info info_of(hbvib_branch *branch)
{
    hbvib_mode_info i;
    WORKS("info", hbvib_mode_info_init(&i, sizeof i));
    WORKS("info", hbvib_branch_mode_info(branch, &i));
    return i;
}

/* A stop that presses at rest, then one that only touches; friction under a constant force. */
static void pressed(void)
{
    hbvib_model *model = oscillator();
    hbvib_contact stop = contact(HBVIB_UNILATERAL), friction = contact(HBVIB_JENKINS);
    hbvib_branch *branch;
    hbvib_mode_info info;
    hbvib_energy energy;
    hbvib_view view;
    double x[2 * 64], a, touching = 2 * sqrt(3) / (1 + sqrt(3));
    int64_t i;

    stop.dof_a[2] = 0;
    stop.kn = 2;
    stop.preload = 0.5;
    WORKS("stop", hbvib_model_add_contact(model, &stop, NULL));
    branch = mode(model, 9, -2, 1);
    info = info_of(branch);
    EXPECT("pressed", near(info.omega, sqrt(3), 1e-12) && near(info.lift_off_from, log10(1. / 12), 1e-9));
    EXPECT("pressed", info.slip_from == INFINITY && near(info.linear_up_to, log10(1. / 12), 1e-8));
    WORKS("pressed", hbvib_branch_harmonics(branch, 0, 0, 1, x, 10));
    EXPECT("at rest", near(x[0], 1. / 6, 1e-12) && x[1] == 0);
    a = hypot(x[2], x[3]);
    WORKS("energy", hbvib_energy_init(&energy, sizeof energy));
    WORKS("energy", hbvib_branch_energy(branch, 0, &energy));
    /* From the static state on: that of the spring of the structure, not of the stop. */
    EXPECT("energy", near(energy.potential_mean, 0.25 * a * a, 1e-10) && near(energy.twice_mean_kinetic, 1.5 * a * a, 1e-10));
    WORKS("energy", hbvib_view_init(&view, sizeof view));
    WORKS("energy", hbvib_branch_field(branch, HBVIB_ENERGY, &view));
    EXPECT("energy", near(view.data[0], 1.5 * a * a, 1e-10));
    WORKS("free", hbvib_branch_free(branch));

    WORKS("touching", hbvib_model_set_preload(model, 0, 0));
    branch = mode(model, 63, -2, 1);
    WORKS("touching", hbvib_branch_field(branch, HBVIB_OMEGA, &view));
    for (i = 0; i < hbvib_branch_points(branch); i++)
        EXPECT("touching", near(view.data[i], touching, 1e-9));
    info = info_of(branch);
    EXPECT("touching", info.lift_off_from == -INFINITY && info.linear_up_to == -INFINITY);
    WORKS("free", hbvib_branch_free(branch));
    WORKS("free", hbvib_model_free(model));

    model = oscillator();
    friction.dof_a[0] = 0;
    friction.kt = friction.preload = 1;
    friction.mu = 0.3;
    WORKS("friction", hbvib_model_add_contact(model, &friction, NULL));
    WORKS("friction", hbvib_model_add_force(model, 0, 0, 0.2, 0));
    branch = mode(model, 5, -2, 0.5);
    info = info_of(branch);
    /* 0.1 of the limit of 0.3 is taken at rest. */
    EXPECT("friction", fabs(info.linear_up_to - log10(0.2)) < 1e-8 && fabs(info.slip_from - log10(0.3)) < 1e-6);
    WORKS("friction", hbvib_branch_harmonics(branch, 0, 0, 1, x, 6));
    EXPECT("friction", near(x[0], 0.1, 1e-12));
    WORKS("free", hbvib_branch_free(branch));
    WORKS("free", hbvib_model_free(model));
}

static hbvib_status response(const hbvib_model *model, double omega, double *x, int64_t n)
{
    hbvib_solver_options s = solver_options();
    hbvib_forced_options o = frequencies(1, 1);
    hbvib_branch *branch = NULL;
    hbvib_status status;
    s.harmonics = 1;
    o.omega_start = o.omega_stop = omega;
    status = hbvib_forced_response(model, &s, &o, NULL, &branch);
    if (status != HBVIB_OK) return status;
    status = hbvib_branch_harmonics(branch, 0, 0, n, x, 2 * n);
    WORKS("free", hbvib_branch_free(branch));
    return status;
}

/* Two masses of 1 between three springs of (1 + i eta), at omega = 1: 1/(i eta) and 1/(2 + 3 i eta) of the two modes. */
static void parts(void)
{
    const double e = ETA, n = NAN, units[4] = {1, 0, 0, 1}, springs[4] = {2, -1, -1, 2};
    const double lower[8] = {2, 2 * e, -1, -e, n, n, 2, 2 * e}, upper[8] = {2, 2 * e, n, n, -1, -e, 2, 2 * e};
    const double full[8] = {2, 2 * e, -1, -e, -1, -e, 2, 2 * e};
    const double *values[3] = {full, lower, upper};
    const int32_t names[3] = {HBVIB_SYMMETRIC, HBVIB_SYMMETRIC_LOWER, HBVIB_SYMMETRIC_UPPER};
    const double size = 4 + 9 * e * e, re[2] = {0.5 * 2 / size, -0.5 * 2 / size};
    const double im[2] = {0.5 * (-1 / e - 3 * e / size), 0.5 * (-1 / e + 3 * e / size)};
    hbvib_model *model = NULL, *copy = NULL;
    hbvib_matrix m = matrix(2, units), k = matrix(2, springs);
    hbvib_solver_options s = solver_options();
    hbvib_forced_options o = frequencies(1, 1);
    hbvib_branch *branch = NULL;
    hbvib_verification v;
    hbvib_time_options t;
    double x[8];
    int i, j;

    WORKS("verify", hbvib_verification_init(&v, sizeof v));
    WORKS("parts", hbvib_model_new(2, &model));
    WORKS("parts", hbvib_model_set_matrix(model, HBVIB_MASS, &m));
    WORKS("parts", hbvib_model_add_force(model, 0, 1, 1, 0));
    for (i = 0; i < 5; i++) {
        WORKS("parts", hbvib_model_clone(model, &copy));
        k = matrix(2, i < 3 ? values[i] : springs);
        if (i < 3) k.scalar = HBVIB_COMPLEX, k.part = names[i];
        WORKS("parts", hbvib_model_set_matrix(copy, HBVIB_STIFFNESS, &k));
        if (i == 3) WORKS("parts", hbvib_model_set_loss_factor(copy, ETA));
        if (i == 4) {
            double d[4];
            for (j = 0; j < 4; j++) d[j] = ETA * springs[j];
            k = matrix(2, d);
            k.part = HBVIB_LOWER;
            WORKS("parts", hbvib_model_set_matrix(copy, HBVIB_STRUCTURAL, &k));
        }
        WORKS("parts", response(copy, 1, x, 2));
        for (j = 0; j < 2; j++) EXPECT("parts", hypot(x[4 + 2 * j] - re[j], x[5 + 2 * j] - im[j]) < 1e-12 / e);
        /* No causal law in time. */
        WORKS("time", hbvib_time_options_init(&t, sizeof t));
        t.omega = 1;
        REFUSED("75", hbvib_time_response(copy, &t, NULL, NULL, 0, NULL, 0, NULL), HBVIB_E_UNSUPPORTED, 0, "viscous equivalent");
        s.harmonics = 1;
        o.omega_start = o.omega_stop = 1;
        WORKS("verify", hbvib_forced_response(copy, &s, &o, NULL, &branch));
        REFUSED("75", hbvib_verify(copy, branch, 0, NULL, NULL, NULL, 0, NULL, 0, &v), HBVIB_E_UNSUPPORTED, 0, "no causal law");
        WORKS("free", hbvib_branch_free(branch));
        WORKS("free", hbvib_model_free(copy));
    }
    /* A triangle with a complex diagonal is that of no Hermitian matrix. */
    k = matrix(2, lower);
    k.scalar = HBVIB_COMPLEX;
    k.part = HBVIB_LOWER;
    REFUSED("28", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &k), HBVIB_E_NOT_HERMITIAN, 3, "SYMMETRIC_LOWER");
    k.values = upper;
    k.part = HBVIB_UPPER;
    REFUSED("28", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &k), HBVIB_E_NOT_HERMITIAN, 3, "SYMMETRIC_UPPER");
    k.values = full;
    k.part = HBVIB_FULL;
    REFUSED("28", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &k), HBVIB_E_NOT_HERMITIAN, 3, "SYMMETRIC");
    k.part = HBVIB_SYMMETRIC;
    REFUSED("27", hbvib_model_set_matrix(model, HBVIB_MASS, &k), HBVIB_E_NOT_HERMITIAN, 3, "mass");
    k.values = lower;
    k.part = HBVIB_SYMMETRIC_UPPER;
    REFUSED("24", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &k), HBVIB_E_NOT_FINITE, 3, "stiffness[0,1]");
    k.part = 7;
    REFUSED("54", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &k), HBVIB_E_ARGUMENT, 3, "part = 7");
    WORKS("free", hbvib_model_free(model));
}

/* Stiffness 1 - 0.2 Omega^2, an unbalance, and engine orders that meet it. */
static void speed(void)
{
    const double softening = -0.2, speeds[3] = {0.2, 0.5, 1}, zeros[3] = {0, 0, 0}, falling[2] = {0.5, 0.2};
    const double bad[2] = {0, NAN}, unit[4] = {1, 0, 0, 1};
    hbvib_model *model = oscillator();
    hbvib_matrix a = matrix(1, &softening);
    hbvib_contact stop = contact(HBVIB_UNILATERAL);
    hbvib_solver_options s = solver_options();
    hbvib_mode_options o = amplitude_range(-2, 1);
    hbvib_branch *branch = (hbvib_branch *)&the_solution;
    double lambda[2], omega[3], ratio[3], at[4], frequency[4], x[8], p = 0.5, w = 0.7;
    int64_t direction[3], found = -1, order;

    WORKS("speed", hbvib_model_set_matrix(model, HBVIB_STIFFNESS_SPEED2, &a));
    WORKS("speed", hbvib_model_set_speed(model, 1));
    WORKS("speed", hbvib_damped_modes(model, 0, HBVIB_CONTACTS_FREE, 1, lambda, NULL, direction, NULL));
    EXPECT("speed", near(lambda[1], sqrt(0.8), 1e-13) && fabs(lambda[0]) < 1e-14 && direction[0] == 0);
    WORKS("campbell", hbvib_campbell(model, 3, speeds, 0, HBVIB_CONTACTS_FREE, 1, omega, ratio, NULL, NULL));
    EXPECT("campbell", near(omega[1], sqrt(0.95), 1e-13));
    for (order = 1; order <= 3; order++) {
        double speed = sqrt(1 / ((double)(order * order) + 0.2));
        WORKS("crossings", hbvib_campbell_crossings(model, 3, speeds, 0, HBVIB_CONTACTS_FREE, 1, order, 4, at, frequency, NULL, &found, NULL));
        EXPECT("crossings", found == 1 && near(at[0], speed, 1e-12) && near(frequency[0], (double)order * speed, 1e-12));
    }
    WORKS("tied", hbvib_model_set_speed_per_omega(model, p));
    WORKS("tied", hbvib_model_add_force(model, 0, 1, 1, 0));
    WORKS("tied", response(model, w, x, 1));
    EXPECT("tied", near(x[2], 1 / (1 - 0.2 * p * p * w * w - w * w), 1e-12));
    REFUSED("75", hbvib_damped_modes(model, 0, HBVIB_CONTACTS_FREE, 1, lambda, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 0, "fixed speed");
    /* The static state of a pressed contact would follow the frequency. */
    stop.dof_a[2] = 0;
    stop.kn = 2;
    stop.preload = 0.5;
    WORKS("stop", hbvib_model_add_contact(model, &stop, NULL));
    REFUSED("75", hbvib_nonlinear_mode(model, &s, &o, NULL, &branch), HBVIB_E_UNSUPPORTED, 0, "set a fixed speed");
    EXPECT("75", branch == (hbvib_branch *)&the_solution);
    WORKS("static", hbvib_model_set_speed(model, 0));
    WORKS("static", hbvib_damped_modes(model, 0, HBVIB_CONTACTS_STATIC, 1, lambda, NULL, NULL, NULL));
    EXPECT("static", near(lambda[1], sqrt(3), 1e-12));
    REFUSED("5", hbvib_damped_modes(model, 0, HBVIB_CONTACTS_FREE, 2, lambda, NULL, NULL, NULL), HBVIB_E_DIMENSION, 4, "count = 2");
    REFUSED("24", hbvib_campbell(model, 2, bad, 0, 0, 1, omega, NULL, NULL, NULL), HBVIB_E_NOT_FINITE, 3, "speeds[1] = NaN");
    REFUSED("71", hbvib_campbell(model, 2, falling, 0, 0, 1, omega, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 3, "speeds[1] = 0.2");
    REFUSED("71", hbvib_campbell(model, 3, zeros, 0, 0, 1, omega, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 3, "speeds[1] = 0");
    WORKS("free", hbvib_model_free(model));

    /* Two directions: m_e w^2 cos(w t + phase) on x, the sine on y. */
    WORKS("unbalance", hbvib_model_new(2, &model));
    a = matrix(2, unit);
    WORKS("unbalance", hbvib_model_set_matrix(model, HBVIB_MASS, &a));
    WORKS("unbalance", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a));
    WORKS("unbalance", hbvib_model_add_unbalance(model, 0, 1, 0.3, 0.4));
    WORKS("unbalance", response(model, w, x, 2));
    p = 0.3 * w * w / (1 - w * w);
    EXPECT("unbalance", hypot(x[4] - p * cos(0.4), x[5] - p * sin(0.4)) < 1e-12 * p);
    EXPECT("unbalance", hypot(x[6] - p * sin(0.4), x[7] + p * cos(0.4)) < 1e-12 * p);
    WORKS("free", hbvib_model_free(model));
}

int main(void)
{
    begin();
    pressed();
    parts();
    speed();
    WORKS("free", hbvib_model_free(the_model));
    return verdict(200);
}
