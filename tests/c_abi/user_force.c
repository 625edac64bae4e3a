/* Rows 101 to 103, 108, 109, 113, 114: forces of the host, what they may do and how they may fail. */
#include "common.h"

/* f = k u + c v + k3 u^3 on one degree of freedom, failing as told. */
typedef struct spring {
    double k, c, k3, at_rest, wrong, noise;
    int64_t calls, fail_at, states;
    int32_t code;
    double poison; /* written into f at the failing call where code is 0 */
    int bad;
    hbvib_model *model, *other;
    hbvib_branch *branch;
    int nested;
} spring;

static void intrude(spring *s);

static int32_t spring_force(void *user, const hbvib_force_call *call)
{
    spring *s = user;
    int64_t j, number = s->calls++;
    s->bad += call->struct_size != sizeof *call || call->reserved != 0 || call->n != 1 || call->samples < 32;
    s->bad += call->states != 0 || call->z0 != NULL || call->z != NULL || call->dz_dz != NULL || call->df_dz != NULL;
    s->bad += !(call->omega > 0) || call->u == NULL || call->v == NULL || call->df_dv == NULL;
    for (j = 0; j < call->samples; j++) {
        double u = call->u[j], v = call->v[j];
        s->bad += !isfinite(u) || !isfinite(v) || !isnan(call->f[j]) || call->df_du[j] != 0 || call->df_dv[j] != 0;
        call->f[j] = s->at_rest + s->k * u + s->c * v + s->k3 * u * u * u + s->noise * sin(2.7 * (double)s->calls);
        call->df_du[j] = (s->k + 3 * s->k3 * u * u) * s->wrong;
        call->df_dv[j] = s->c * s->wrong;
    }
    if (s->model != NULL || s->branch != NULL) intrude(s);
    if (number == s->fail_at) {
        if (s->code != 0) return s->code;
        call->f[5] = s->poison;
    }
    return 0;
}

static spring plain(void)
{
    spring s = {0};
    s.k3 = 1;
    s.c = 0.1;
    s.wrong = 1;
    s.fail_at = -1;
    return s;
}

static const int64_t FIRST[1] = {0};

static hbvib_user_force description(spring *s)
{
    hbvib_user_force o;
    WORKS("109", hbvib_user_force_init(&o, sizeof o));
    EXPECT("109", o.struct_size == sizeof o && o.dofs == NULL && o.n == 0 && o.states == 0 && o.samples == 0);
    EXPECT("109", o.uses_velocity == 0 && o.is_odd == 0 && o.force == NULL && o.user == NULL);
    o.dofs = FIRST;
    o.n = 1;
    o.uses_velocity = 1;
    o.is_odd = 1;
    o.force = spring_force;
    o.user = s;
    return o;
}

/* A mass on a spring with the force. */
static hbvib_model *oscillator(spring *s)
{
    const double one = 1;
    hbvib_matrix a = matrix(1, &one);
    hbvib_user_force o = description(s);
    hbvib_model *model = NULL;
    int64_t id = -1;
    o.is_odd = s->at_rest == 0;
    WORKS("109", hbvib_model_new(1, &model));
    WORKS("109", hbvib_model_set_matrix(model, HBVIB_MASS, &a));
    WORKS("109", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a));
    WORKS("109", hbvib_model_add_force(model, 0, 1, 0.2, 0));
    WORKS("109", hbvib_model_add_user_force(model, &o, &id));
    EXPECT("109", id == 0 && s->calls == 0);
    return model;
}

static hbvib_status sweep(const hbvib_model *model, hbvib_branch **branch)
{
    hbvib_solver_options options = solver_options();
    hbvib_forced_options range;
    if (hbvib_forced_options_init(&range, sizeof range) != HBVIB_OK) abort();
    options.harmonics = 3;
    options.max_points = 400;
    range.omega_start = 0.5;
    range.omega_stop = 2;
    *branch = NULL;
    return hbvib_forced_response(model, &options, &range, NULL, branch);
}

static double last_amplitude(const hbvib_branch *branch)
{
    hbvib_view view;
    if (hbvib_view_init(&view, sizeof view) != HBVIB_OK) abort();
    if (hbvib_branch_field(branch, HBVIB_AMPLITUDE, &view) != HBVIB_OK || view.shape[0] < 1) return NAN;
    return view.data[view.shape[0] - 1];
}

/* The library's own cubic spring, with the damper as the structure's. */
static void same_as_the_librarys(void)
{
    spring s = plain();
    hbvib_model *model = oscillator(&s), *copy = NULL, *own = NULL;
    hbvib_branch *branch = NULL, *reference = NULL;
    const double one = 1, damping = 0.1;
    hbvib_matrix a = matrix(1, &one), c = matrix(1, &damping);
    hbvib_contact cubic;
    double x[8], y[8];
    int64_t calls;
    WORKS("109", hbvib_contact_init(&cubic, sizeof cubic));
    cubic.kind = HBVIB_CUBIC;
    cubic.dof_a[0] = 0;
    cubic.cubic = 1;
    WORKS("109", hbvib_model_new(1, &own));
    WORKS("109", hbvib_model_set_matrix(own, HBVIB_MASS, &a));
    WORKS("109", hbvib_model_set_matrix(own, HBVIB_STIFFNESS, &a));
    WORKS("109", hbvib_model_set_matrix(own, HBVIB_DAMPING, &c));
    WORKS("109", hbvib_model_add_force(own, 0, 1, 0.2, 0));
    WORKS("109", hbvib_model_add_contact(own, &cubic, NULL));
    WORKS("109", sweep(own, &reference));
    WORKS("109", sweep(model, &branch));
    EXPECT("109", s.bad == 0 && s.calls > 20);
    EXPECT("109", fabs(last_amplitude(branch) / last_amplitude(reference) - 1) < 1e-8);
    /* A copy has the same force; results ask it again, and outlive the models. */
    WORKS("109", hbvib_model_clone(model, &copy));
    WORKS("109", hbvib_model_free(model));
    calls = s.calls;
    WORKS("109", hbvib_branch_harmonics(branch, 3, 0, 1, x, 4));
    EXPECT("109", s.calls > calls);
    WORKS("109", hbvib_branch_free(branch));
    WORKS("109", sweep(copy, &branch));
    WORKS("109", hbvib_branch_harmonics(branch, 3, 0, 1, y, 4));
    EXPECT("109", memcmp(x, y, sizeof x) == 0);
    WORKS("109", hbvib_branch_free(branch));
    WORKS("109", hbvib_branch_free(reference));
    WORKS("109", hbvib_model_free(copy));
    WORKS("109", hbvib_model_free(own));
}

/* Rows 108, 109: codes and numbers that are not finite. */
static void failures_of_a_callback(void)
{
    spring sound = plain();
    hbvib_model *model = oscillator(&sound);
    hbvib_branch *branch = NULL, *whole = NULL;
    hbvib_view view;
    double x[8];
    int64_t points, k;
    WORKS("109", sweep(model, &whole));
    WORKS("109", hbvib_model_free(model));
    points = hbvib_branch_points(whole);

    for (k = 0; k < 3; k++) { /* overcome: a code above 0, NaN, infinity */
        spring s = plain();
        model = oscillator(&s);
        s.fail_at = 40;
        s.code = k == 0 ? 3 : 0;
        s.poison = k == 1 ? NAN : INFINITY;
        WORKS("108, 109", sweep(model, &branch));
        EXPECT("108, 109", s.bad == 0 && fabs(last_amplitude(branch) / last_amplitude(whole) - 1) < 1e-7);
        WORKS("109", hbvib_branch_free(branch));
        WORKS("109", hbvib_model_free(model));
    }
    for (k = 0; k < 2; k++) { /* it gives up: with points, and without any */
        spring s = plain();
        model = oscillator(&s);
        s.fail_at = k == 0 ? 100 : 3;
        s.code = -42;
        if (k == 1) {
            REFUSED("109", sweep(model, &branch), HBVIB_E_CALLBACK, 0, "returned -42");
            EXPECT("109", branch == NULL && s.calls == 4);
        } else {
            EXPECT("109", sweep(model, &branch) == HBVIB_STOPPED_CALLBACK && s.calls == 101);
            EXPECT("109", strstr(hbvib_last_error(), "contact 0: the force callback returned -42") != NULL);
            EXPECT("109", hbvib_last_error_argument() == 0);
            EXPECT("109", hbvib_branch_status(branch) == HBVIB_STOPPED_CALLBACK);
            EXPECT("109", strstr(hbvib_last_error(), "returned -42") != NULL);
            EXPECT("109", strcmp(hbvib_status_name(HBVIB_STOPPED_CALLBACK), "HBVIB_STOPPED_CALLBACK") == 0);
            EXPECT("109", hbvib_branch_points(branch) > 0 && hbvib_branch_points(branch) < points);
            WORKS("109", hbvib_view_init(&view, sizeof view));
            WORKS("109", hbvib_branch_field(branch, HBVIB_RESIDUAL, &view));
            EXPECT("109", view.shape[0] == hbvib_branch_points(branch) && view.data[0] < 1e-6);
            /* It fails once more while results are recovered: nothing is written. */
            s.fail_at = s.calls;
            x[2] = 7;
            REFUSED("109", hbvib_branch_harmonics(branch, 0, 0, 1, x, 4), HBVIB_E_CALLBACK, 0, "returned -42");
            EXPECT("109", x[2] == 7);
            WORKS("109", hbvib_branch_harmonics(branch, 0, 0, 1, x, 4));
            WORKS("109", hbvib_branch_free(branch));
        }
        WORKS("109", hbvib_model_free(model));
    }
    WORKS("109", hbvib_branch_free(whole));
}

static int32_t broken(void *user, const hbvib_force_call *call)
{
    (void)user;
    (void)call;
    return 0; /* writes nothing */
}

/* Rows 113, 114: tangents that are wrong, forces that follow from no motion. */
static void wrong_callbacks(void)
{
    spring s = plain();
    hbvib_model *model;
    hbvib_branch *branch = NULL;
    hbvib_jacobian_gap gap;
    hbvib_user_force o;
    const double amplitude[2] = {0.8, 1}, zero = 0;
    hbvib_status status;

    model = oscillator(&s);
    WORKS("113", hbvib_jacobian_gap_init(&gap, sizeof gap));
    WORKS("113", hbvib_check_jacobian(model, 0, 1.5, amplitude, 1, &gap));
    EXPECT("113", gap.gap < 1e-7 && gap.struct_size == sizeof gap && s.bad == 0);
    s.wrong = -1;
    WORKS("113", hbvib_check_jacobian(model, 0, 1.5, amplitude, 1, &gap));
    EXPECT("113", gap.gap > 1 && gap.tangent == HBVIB_DF_DU && gap.row == 0 && gap.column == 0);
    EXPECT("113", gap.sample >= 0 && fabs(gap.given / gap.difference + 1) < 1e-6);
    gap.gap = 77;
    REFUSED("113", hbvib_check_jacobian(NULL, 0, 1.5, amplitude, 1, &gap), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("113", hbvib_check_jacobian(model, 1, 1.5, amplitude, 1, &gap), HBVIB_E_INDEX, 2, "contact = 1");
    REFUSED("113", hbvib_check_jacobian(the_model, 0, 1.5, amplitude, 1, &gap), HBVIB_E_ARGUMENT, 2, "force of the caller");
    REFUSED("113", hbvib_check_jacobian(model, 0, -1, amplitude, 1, &gap), HBVIB_E_ARGUMENT, 3, "omega = -1");
    REFUSED("113", hbvib_check_jacobian(model, 0, 1.5, &zero, 1, &gap), HBVIB_E_ARGUMENT, 4, "amplitude[0] = 0");
    REFUSED("113", hbvib_check_jacobian(model, 0, 1.5, NULL, 1, &gap), HBVIB_E_NULL, 4, "amplitude");
    REFUSED("113", hbvib_check_jacobian(model, 0, 1.5, amplitude, 2, &gap), HBVIB_E_DIMENSION, 5, "2 amplitudes");
    REFUSED("113", hbvib_check_jacobian(model, 0, 1.5, amplitude, 1, NULL), HBVIB_E_NULL, 6, "NULL");
    REFUSED("113", hbvib_jacobian_gap_init(NULL, sizeof gap), HBVIB_E_NULL, 1, "NULL");
    REFUSED("113", hbvib_jacobian_gap_init(&gap, 8), HBVIB_E_STRUCT_SIZE, 2, "hbvib_jacobian_gap_init");
    s.fail_at = s.calls + 2;
    s.code = 6;
    REFUSED("113", hbvib_check_jacobian(model, 0, 1.5, amplitude, 1, &gap), HBVIB_E_CALLBACK, 0, "returned 6");
    EXPECT("113", gap.gap == 77);
    s.fail_at = -1;
    /* A weak force leads nowhere in small steps, a strong one finds no start. */
    status = sweep(model, &branch);
    EXPECT("113", status != HBVIB_OK);
    WORKS("113", hbvib_branch_free(branch));
    s.k = 1;
    REFUSED("113", sweep(model, &branch), HBVIB_E_NO_CONVERGENCE, 0, "no solution was found at the start");
    EXPECT("113", branch == NULL);
    WORKS("113", hbvib_model_free(model));

    s = plain();
    model = oscillator(&s);
    s.noise = 0.05;
    status = sweep(model, &branch);
    EXPECT("114", status != HBVIB_OK && s.calls < 1000000);
    WORKS("114", hbvib_branch_free(branch));
    WORKS("114", hbvib_model_free(model));

    /* Row 108: a callback that writes no force. */
    s = plain();
    model = oscillator(&s);
    o = description(&s);
    o.force = broken;
    WORKS("108", hbvib_model_add_user_force(model, &o, NULL));
    REFUSED("108", sweep(model, &branch), HBVIB_E_CALLBACK, 0, "contact 1: the force callback gave f[0,0] = ");
    WORKS("108", hbvib_model_free(model));
}

static void bad_descriptions(void)
{
    const int64_t twice[2] = {1, 1}, beyond[2] = {0, NDOF};
    spring s = plain();
    hbvib_user_force good = description(&s), o = good;
    int64_t id = 77;
    REFUSED("109", hbvib_user_force_init(NULL, sizeof o), HBVIB_E_NULL, 1, "NULL");
    REFUSED("109", hbvib_user_force_init(&o, 12), HBVIB_E_STRUCT_SIZE, 2, "hbvib_user_force_init");
    REFUSED("109", hbvib_model_add_user_force(NULL, &o, &id), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("109", hbvib_model_add_user_force(the_model, NULL, &id), HBVIB_E_NULL, 2, "NULL");
#define BAD(change, wanted, words)                                                             \
    do {                                                                                       \
        o = good;                                                                              \
        change;                                                                                \
        REFUSED("109", hbvib_model_add_user_force(the_model, &o, &id), wanted, 2, words);      \
    } while (0)
    BAD(o.struct_size = 8, HBVIB_E_STRUCT_SIZE, "struct_size = 8");
    BAD(o.force = NULL, HBVIB_E_NULL, "force is NULL");
    BAD(o.dofs = NULL, HBVIB_E_NULL, "dofs is NULL");
    BAD(o.n = 0, HBVIB_E_DIMENSION, "n = 0");
    BAD(o.n = -1, HBVIB_E_DIMENSION, "n = -1");
    BAD(o.n = NDOF + 1, HBVIB_E_DIMENSION, "n = 5");
    BAD((o.n = 2, o.dofs = twice), HBVIB_E_ARGUMENT, "dofs[1] = 1 stands there twice");
    BAD((o.n = 2, o.dofs = beyond), HBVIB_E_INDEX, "dofs[1]");
    BAD(o.states = -1, HBVIB_E_DIMENSION, "states = -1");
    BAD(o.states = INT64_MAX, HBVIB_E_DIMENSION, "states = ");
    BAD(o.samples = -1, HBVIB_E_DIMENSION, "samples = -1");
    BAD(o.uses_velocity = 2, HBVIB_E_ARGUMENT, "uses_velocity = 2");
    BAD(o.is_odd = -1, HBVIB_E_ARGUMENT, "is_odd = -1");
    BAD(o.reserved = 1, HBVIB_E_ARGUMENT, "reserved = 1");
    EXPECT("109", id == 77 && s.calls == 0);
    { /* fewer samples than tell the harmonics apart */
        hbvib_model *model = oscillator(&s);
        hbvib_branch *branch = NULL;
        o = good;
        o.samples = 4;
        WORKS("109", hbvib_model_add_user_force(model, &o, NULL));
        REFUSED("109", sweep(model, &branch), HBVIB_E_ARGUMENT, 0, "samples = 4");
        WORKS("109", hbvib_model_free(model));
    }
}

/* Rows 101 to 103: everything that must not be done to a model in use, then what may be done. */
static void intrude(spring *s)
{
    hbvib_model *model = s->model;
    if (s->branch != NULL) {
        s->bad += hbvib_branch_free(s->branch) != HBVIB_E_BUSY;
        return;
    }
    if (s->nested++ > 3) return;
    s->model = NULL; /* what is solved from here is not intruded on */
    {
        hbvib_user_force o = {0};
        hbvib_model *copy = NULL;
        hbvib_branch *branch = NULL;
        solution *nested = malloc(sizeof *nested);
        o.struct_size = sizeof o;
        o.dofs = FIRST;
        o.n = 1;
        o.force = spring_force;
        o.user = s;
        s->bad += hbvib_model_free(model) != HBVIB_E_BUSY;
        s->bad += hbvib_model_clear_forces(model) != HBVIB_E_BUSY;
        s->bad += hbvib_model_set_rayleigh(model, 0, 0) != HBVIB_E_BUSY;
        s->bad += hbvib_model_add_user_force(model, &o, NULL) != HBVIB_E_BUSY;
        s->bad += hbvib_last_error_argument() != 1 || strstr(hbvib_last_error(), "in use") == NULL;
        s->bad += nested == NULL || solve(s->other, nested) != HBVIB_OK ||
                  memcmp(nested, &the_solution, sizeof *nested) != 0;
        s->bad += sweep(model, &branch) != HBVIB_OK || hbvib_branch_free(branch) != HBVIB_OK;
        s->bad += hbvib_model_clone(model, &copy) != HBVIB_OK || hbvib_model_free(copy) != HBVIB_OK;
        s->bad += hbvib_model_new(-3, &copy) != HBVIB_E_DIMENSION; /* an error in here is not the solve's */
        free(nested);
    }
    s->model = model;
}

static void callbacks_that_call_the_library(void)
{
    spring s = plain();
    hbvib_model *model = oscillator(&s);
    hbvib_branch *branch = NULL, *again = NULL;
    double x[8];
    s.model = model;
    s.other = the_model;
    WORKS("101, 102, 103", sweep(model, &branch));
    EXPECT("101, 102, 103", s.bad == 0 && s.nested > 4);
    s.model = NULL;
    WORKS("101", sweep(model, &again));
    EXPECT("101", last_amplitude(branch) == last_amplitude(again));
    s.branch = branch;
    WORKS("101", hbvib_branch_harmonics(branch, 0, 0, 1, x, 4));
    EXPECT("101", s.bad == 0);
    s.branch = NULL;
    WORKS("101", hbvib_branch_free(branch));
    WORKS("101", hbvib_branch_free(again));
    WORKS("101", hbvib_model_free(model));
}

/* A slider whose force is its state, and one with a force at rest. */
static int32_t slider_force(void *user, const hbvib_force_call *call)
{
    spring *s = user;
    double z = call->z0[0], before = call->u[call->samples - 1];
    int64_t j;
    s->calls++;
    s->bad += call->states != 1 || call->v != NULL || call->df_dv != NULL || call->dz_dv != NULL ||
              call->dz_dv_before != NULL || call->dz_domega == NULL;
    for (j = 0; j < call->samples; j++) {
        double trial = z + s->k * (call->u[j] - before), limit = s->k3;
        int sticks = fabs(trial) <= limit;
        s->bad += !isnan(call->z[j]) || call->dz_dz[j] != 0 || call->df_dz[j] != 0;
        z = sticks ? trial : trial > 0 ? limit : -limit;
        before = call->u[j];
        call->f[j] = call->z[j] = z;
        call->df_dz[j] = 1;
        if (sticks) {
            call->dz_dz[j] = 1;
            call->dz_du[j] = s->k;
            call->dz_du_before[j] = -s->k;
        }
    }
    return 0;
}

static void states_and_loads(void)
{
    const double one = 1, damping = 0.1, amplitude = 1;
    hbvib_matrix a = matrix(1, &one), c = matrix(1, &damping);
    hbvib_model *models[2] = {NULL, NULL};
    hbvib_branch *branches[2] = {NULL, NULL};
    hbvib_jacobian_gap gap;
    hbvib_contact jenkins;
    hbvib_user_force o;
    hbvib_mode_options range;
    spring s = plain();
    int i;
    s.k = 0.5;
    s.k3 = 0.1;
    for (i = 0; i < 2; i++) {
        WORKS("109", hbvib_model_new(1, &models[i]));
        WORKS("109", hbvib_model_set_matrix(models[i], HBVIB_MASS, &a));
        WORKS("109", hbvib_model_set_matrix(models[i], HBVIB_STIFFNESS, &a));
        WORKS("109", hbvib_model_set_matrix(models[i], HBVIB_DAMPING, &c));
        WORKS("109", hbvib_model_add_force(models[i], 0, 1, 0.2, 0));
    }
    o = description(&s);
    o.force = slider_force;
    o.uses_velocity = 0;
    o.states = 1;
    o.samples = 1024;
    WORKS("109", hbvib_model_add_user_force(models[0], &o, NULL));
    WORKS("109", hbvib_contact_init(&jenkins, sizeof jenkins));
    jenkins.kind = HBVIB_JENKINS;
    jenkins.dof_a[0] = 0;
    jenkins.kt = 0.5;
    jenkins.mu = 0.1;
    jenkins.preload = 1;
    WORKS("109", hbvib_model_add_contact(models[1], &jenkins, NULL));
    for (i = 0; i < 2; i++) WORKS("109", sweep(models[i], &branches[i]));
    EXPECT("109", s.bad == 0 && fabs(last_amplitude(branches[0]) / last_amplitude(branches[1]) - 1) < 1e-4);
    WORKS("113", hbvib_jacobian_gap_init(&gap, sizeof gap));
    WORKS("113", hbvib_check_jacobian(models[0], 0, 2, &amplitude, 1, &gap));
    EXPECT("113", gap.gap < 1e-6);
    for (i = 0; i < 2; i++) {
        WORKS("109", hbvib_branch_free(branches[i]));
        WORKS("109", hbvib_model_free(models[i]));
    }

    s = plain();
    s.at_rest = 0.3;
    models[0] = oscillator(&s);
    WORKS("109", sweep(models[0], &branches[0]));
    WORKS("109", hbvib_branch_free(branches[0]));
    WORKS("109", hbvib_mode_options_init(&range, sizeof range));
    range.log10_start = -2;
    range.log10_stop = 0;
    branches[0] = NULL;
    /* The mode vibrates about the static state under that force. */
    WORKS("109", hbvib_nonlinear_mode(models[0], NULL, &range, NULL, &branches[0]));
    EXPECT("109", hbvib_branch_points(branches[0]) > 5);
    WORKS("109", hbvib_branch_free(branches[0]));
    WORKS("109", hbvib_model_free(models[0]));
}

int main(void)
{
    begin();
    same_as_the_librarys();
    failures_of_a_callback();
    wrong_callbacks();
    bad_descriptions();
    callbacks_that_call_the_library();
    states_and_loads();
    WORKS("90", hbvib_model_free(the_model));
    return verdict(200);
}
