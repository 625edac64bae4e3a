/* Rows 36, 37, 59, 76, 80 and 115: input that is unusual and cannot be refused has the result that it says: other units, damping
 * that feeds energy, numbers of samples that are odd or prime, modes of one frequency, a callback that takes its time. */
#include "common.h"

/* A mass on a spring, driven by cos(omega t). */
static hbvib_model *oscillator(double k, double c)
{
    const double one = 1;
    hbvib_matrix m = matrix(1, &one), spring = matrix(1, &k), damper = matrix(1, &c);
    hbvib_model *model = NULL;
    WORKS("36", hbvib_model_new(1, &model));
    WORKS("36", hbvib_model_set_matrix(model, HBVIB_MASS, &m));
    WORKS("36", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &spring));
    WORKS("36", hbvib_model_set_matrix(model, HBVIB_DAMPING, &damper));
    WORKS("36", hbvib_model_add_force(model, 0, 1, 1, 0));
    return model;
}

/* Its response at one frequency; the complex fundamental and, where wanted, the largest Floquet multiplier. */
static void respond(const char *row, hbvib_model *model, double omega, double *x, double *multiplier)
{
    hbvib_solver_options s = solver_options();
    hbvib_forced_options o = frequencies(1, 1);
    hbvib_branch *branch = NULL;
    double all[2 * 4], two[4];
    s.harmonics = 3;
    o.omega_start = o.omega_stop = omega;
    WORKS(row, hbvib_forced_response(model, &s, &o, NULL, &branch));
    WORKS(row, hbvib_branch_harmonics(branch, 0, 0, 1, all, 4));
    x[0] = all[2];
    x[1] = all[3];
    if (multiplier != NULL) {
        WORKS(row, hbvib_floquet(model, branch, 0, NULL, NULL, two, 2, NULL, 0, NULL));
        *multiplier = hypot(two[0], two[1]);
    }
    WORKS(row, hbvib_branch_free(branch));
}

static int is_response(const double *x, double k, double c, double omega)
{
    /* 1 / (k - omega^2 + i c omega) */
    const double re = k - omega * omega, im = c * omega, square = re * re + im * im;
    return hypot(x[0] - re / square, x[1] + im / square) < 1e-12 * hypot(x[0], x[1]);
}

/* Rows 36, 76: no number tells its unit. Frequencies are those of the matrices as given, and are angular throughout. */
static void units(void)
{
    hbvib_model *metre = oscillator(4e6, 20), *millimetre = oscillator(4e3, 20);
    double of_metre, of_millimetre, x[2];
    WORKS("36", hbvib_linear_modes(metre, 0, HBVIB_CONTACTS_FREE, 1, &of_metre, NULL));
    WORKS("36", hbvib_linear_modes(millimetre, 0, HBVIB_CONTACTS_FREE, 1, &of_millimetre, NULL));
    EXPECT("36", fabs(of_metre - 2000) < 1e-9 && fabs(of_metre / of_millimetre - sqrt(1000)) < 1e-12);
    respond("76", metre, 318.3, x, NULL); /* its resonance in Hz is far below the resonance */
    EXPECT("76", is_response(x, 4e6, 20, 318.3) && hypot(x[0], x[1]) < 1.1 / 4e6);
    WORKS("36", hbvib_model_free(metre));
    WORKS("36", hbvib_model_free(millimetre));
}

/* Row 37: damping that feeds energy. The periodic motion exists, and is told to be unstable. */
static void negative_damping(void)
{
    static const double damping[2] = {-0.05, 0.05}, omega[3] = {0.8, 1, 1.3};
    int i, j;
    for (i = 0; i < 2; i++) {
        hbvib_model *model = oscillator(1, damping[i]);
        for (j = 0; j < 3; j++) {
            double x[2], multiplier = 0;
            respond("37", model, omega[j], x, &multiplier);
            EXPECT("37", is_response(x, 1, damping[i], omega[j]));
            /* Perturbations decay, or grow, by exp(-c T / 2). */
            EXPECT("37", fabs(multiplier / exp(-damping[i] * PI / omega[j]) - 1) < 1e-9);
        }
        WORKS("37", hbvib_model_free(model));
    }
}

/* Row 59: the number of samples needs no factors. */
static void numbers_of_samples(void)
{
    static const int64_t samples[4] = {1024, 1023, 1009, 729};
    hbvib_model *model = oscillator(1, 0.05);
    hbvib_contact c;
    double first[2] = {0, 0};
    int i;
    WORKS("59", hbvib_contact_init(&c, sizeof c));
    c.kind = HBVIB_REGULARISED;
    c.dof_a[0] = 0;
    c.mu = c.preload = 0.5;
    c.velocity = 1;
    WORKS("59", hbvib_model_add_contact(model, &c, NULL));
    for (i = 0; i < 4; i++) {
        hbvib_solver_options s = solver_options();
        hbvib_forced_options o = frequencies(1, 1);
        hbvib_branch *branch = NULL;
        double all[2 * 10];
        s.samples = samples[i];
        o.omega_start = o.omega_stop = 1;
        WORKS("59", hbvib_forced_response(model, &s, &o, NULL, &branch));
        WORKS("59", hbvib_branch_harmonics(branch, 0, 0, 1, all, 10));
        if (i == 0) memcpy(first, all + 2, sizeof first);
        EXPECT("59", hypot(all[2] - first[0], all[3] - first[1]) < 1e-9 * hypot(first[0], first[1]) && hypot(first[0], first[1]) > 1);
        WORKS("59", hbvib_branch_free(branch));
    }
    WORKS("59", hbvib_model_free(model));
}

/* Row 80: two modes of one frequency. Which one was taken is told, and both can be had by their shapes. */
static void double_mode(void)
{
    hbvib_model *model = two_masses(ONES, ONES, 0);
    int choice;
    for (choice = -1; choice < 2; choice++) {
        double shape[4] = {0, 0, 0, 0};
        hbvib_branch *branch = NULL;
        hbvib_mode_options o;
        hbvib_mode_info info;
        WORKS("80", hbvib_mode_options_init(&o, sizeof o));
        WORKS("80", hbvib_mode_info_init(&info, sizeof info));
        o.log10_start = -1;
        o.log10_stop = 0.5;
        if (choice >= 0) {
            shape[2 * choice] = 1;
            o.shape = shape;
            o.shape_len = 2;
        }
        WORKS("80", hbvib_nonlinear_mode(model, NULL, &o, NULL, &branch));
        WORKS("80", hbvib_branch_mode_info(branch, &info));
        EXPECT("80", info.multiplicity == 2 && fabs(info.omega - sqrt(2)) < 1e-12);
        EXPECT("80", choice < 0 ? info.multiple == HBVIB_MODE_TRAVELLING_WAVE || info.multiple == HBVIB_MODE_FIRST
                                : info.multiple == HBVIB_MODE_PROJECTED);
        if (choice >= 0) {
            double x[2 * 20 * 2];
            hbvib_reduction reduction;
            WORKS("80", hbvib_reduction_init(&reduction, sizeof reduction));
            WORKS("80", hbvib_branch_reduction(branch, &reduction));
            EXPECT("80", reduction.harmonics_asked < 20);
            WORKS("80", hbvib_branch_harmonics(branch, 0, 0, 2, x, 2 * (reduction.harmonics_asked + 1)));
            /* The other mass stays at rest. */
            EXPECT("80", hypot(x[4 + 2 * choice], x[5 + 2 * choice]) > 0.09);
            EXPECT("80", hypot(x[6 - 2 * choice], x[7 - 2 * choice]) < 1e-9);
        }
        WORKS("80", hbvib_branch_free(branch));
    }
    WORKS("80", hbvib_model_free(model));
}

/* A cubic spring that asks for a stop in one of its calls, and goes on as if nothing was. */
typedef struct slow_spring {
    hbvib_cancel_flag cancel;
    int64_t calls, cancel_at;
} slow_spring;

static int32_t slow_force(void *user, const hbvib_force_call *call)
{
    slow_spring *s = user;
    int64_t j;
    if (++s->calls == s->cancel_at && hbvib_cancel(&s->cancel, 1) != HBVIB_OK) return -1;
    for (j = 0; j < call->samples; j++) {
        call->f[j] = 0.5 * call->u[j] * call->u[j] * call->u[j];
        call->df_du[j] = 1.5 * call->u[j] * call->u[j];
    }
    return 0;
}

/* Row 115: nothing can end a callback, but a stop that is requested meanwhile is obeyed when it returns. */
static void slow_callback(void)
{
    static const int64_t dofs[1] = {0}, cancel_at[4] = {1, 2, 7, 40};
    hbvib_model *model = oscillator(1, 0.05);
    slow_spring s = {0, 0, 0};
    hbvib_user_force force;
    int i;
    WORKS("115", hbvib_user_force_init(&force, sizeof force));
    force.dofs = dofs;
    force.n = 1;
    force.force = slow_force;
    force.user = &s;
    WORKS("115", hbvib_model_add_user_force(model, &force, NULL));
    for (i = 0; i < 4; i++) {
        hbvib_solver_options options = solver_options();
        hbvib_forced_options o = frequencies(0.1, 0.3);
        hbvib_hooks h;
        hbvib_branch *branch = NULL;
        WORKS("115", hbvib_hooks_init(&h, sizeof h));
        s.cancel = 0;
        s.calls = 0;
        s.cancel_at = cancel_at[i];
        h.cancel = &s.cancel;
        EXPECT("115", hbvib_forced_response(model, &options, &o, &h, &branch) == HBVIB_STOPPED_BY_CALLER);
        EXPECT("115", s.calls == s.cancel_at);
        WORKS("115", hbvib_branch_free(branch));
    }
    WORKS("115", hbvib_model_free(model));
}

int main(void)
{
    begin();
    units();
    negative_damping();
    numbers_of_samples();
    double_mode();
    slow_callback();
    WORKS("36", hbvib_model_free(the_model));
    return verdict(100);
}
