/* A force of the caller in the solver: a Bouc-Wen element, the hysteresis of a rubber or wire-rope mount,
 * supports an oscillator. Checks the derivatives of the force, follows the response over the resonance,
 * prints it, the element's loop at the peak, and the balance of work there.
 *
 *   cargo build --release
 *   cc -std=c99 -Wall -Wextra -pedantic examples/c/user_force.c -Iinclude -Ltarget/release -lhbvib \
 *      -Wl,-rpath,target/release -lm -o target/user_force
 *   target/user_force
 */
#include "hbvib.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { HARMONICS = 7, TIMES = 1024 };

static const double PI = 3.14159265358979323846;

/* Ends the program with the error sentence of the library if a call failed. */
static void check(hbvib_status status, const char *call)
{
    if (status == HBVIB_OK) return;
    fprintf(stderr, "%s: %s (argument %d): %s\n", call, hbvib_status_name(status),
            (int)hbvib_last_error_argument(), hbvib_last_error());
    exit(EXIT_FAILURE);
}
#define CHECK(call) check((call), #call)

/* f = k z with dz = du - (beta |du| + gamma sign(z) du) z: z follows u at first, and is at most
 * 1 / (beta + gamma). */
typedef struct bouc_wen {
    double k, beta, gamma;
} bouc_wen;

/* One step of the midpoint rule from the state z over du, with its derivatives. */
static double step(const bouc_wen *e, double z, double du, double *by_z, double *by_du)
{
    double sense = du < 0 ? -1 : 1;
    double c0 = e->beta * sense + (z < 0 ? -e->gamma : e->gamma);
    double middle = z + 0.5 * du * (1 - c0 * z);
    double c1 = e->beta * sense + (middle < 0 ? -e->gamma : e->gamma);
    *by_z = 1 - du * c1 * (1 - 0.5 * du * c0);
    *by_du = 1 - c1 * middle - du * c1 * 0.5 * (1 - c0 * z);
    return z + du * (1 - c1 * middle);
}

/* One degree of freedom and one state, so that each array has one number per sample. The last
 * sample, with the state z0, precedes sample 0. */
static int32_t force(void *user, const hbvib_force_call *call)
{
    const bouc_wen *e = user;
    double z = call->z0[0], before = call->u[call->samples - 1];
    int64_t j;
    for (j = 0; j < call->samples; j++) {
        double by_z, by_du;
        z = step(e, z, call->u[j] - before, &by_z, &by_du);
        before = call->u[j];
        if (!isfinite(z)) return 1; /* the step was too long: request a shorter one */
        call->z[j] = z;
        call->dz_dz[j] = by_z;
        call->dz_du[j] = by_du;
        call->dz_du_before[j] = -by_du;
        call->f[j] = e->k * z;
        call->df_dz[j] = e->k;
    }
    return 0;
}

static hbvib_matrix view(const double *value)
{
    hbvib_matrix a;
    CHECK(hbvib_matrix_init(&a, sizeof a));
    a.rows = a.cols = 1;
    a.values = value;
    return a;
}

static hbvib_model *oscillator(bouc_wen *element, double mass, double damping, double stiffness, double load)
{
    const int64_t dofs[1] = {0};
    hbvib_matrix m = view(&mass), c = view(&damping), k = view(&stiffness);
    hbvib_user_force own;
    hbvib_model *model = NULL;

    CHECK(hbvib_model_new(1, &model));
    CHECK(hbvib_model_set_matrix(model, HBVIB_MASS, &m));
    CHECK(hbvib_model_set_matrix(model, HBVIB_DAMPING, &c));
    CHECK(hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &k));
    CHECK(hbvib_model_add_force(model, 0, 1, load, 0));

    CHECK(hbvib_user_force_init(&own, sizeof own));
    own.dofs = dofs;
    own.n = 1;
    own.states = 1;
    own.is_odd = 1; /* f(-u) = -f(u): the mean and the even harmonics vanish */
    own.force = force;
    own.user = element; /* must live as long as the model and its branches */
    CHECK(hbvib_model_add_user_force(model, &own, NULL));
    return model;
}

int main(void)
{
    bouc_wen element = {0.6, 4, 2};
    const double mass = 1, damping = 0.02, stiffness = 1, load = 0.1, amplitude = 0.5;
    hbvib_model *model = oscillator(&element, mass, damping, stiffness, load);
    hbvib_jacobian_gap gap;
    hbvib_solver_options solver;
    hbvib_forced_options range;
    hbvib_branch *branch = NULL;
    hbvib_view omega, response;
    double peak_omega, peak_amplitude, x[2 * (HARMONICS + 1)];
    double motion[TIMES], loop[TIMES], z = 0, unused, given, damped = 0, lost = 0;
    int64_t peaks, peak, i, j;

    /* Wrong derivatives are a frequent reason why a solve does not converge. */
    CHECK(hbvib_jacobian_gap_init(&gap, sizeof gap));
    CHECK(hbvib_check_jacobian(model, 0, 1, &amplitude, 1, &gap));
    printf("derivatives: gap %.1e\n", gap.gap);
    if (gap.gap > 1e-6) {
        fprintf(stderr, "derivative %d, sample %ld: given %g, difference %g\n", (int)gap.tangent, (long)gap.sample,
                gap.given, gap.difference);
        return EXIT_FAILURE;
    }

    CHECK(hbvib_solver_options_init(&solver, sizeof solver));
    solver.tolerance = 0; /* fixed harmonics */
    solver.harmonics = HARMONICS;
    CHECK(hbvib_forced_options_init(&range, sizeof range));
    range.omega_start = 0.5;
    range.omega_stop = 2;
    CHECK(hbvib_forced_response(model, &solver, &range, NULL, &branch));

    CHECK(hbvib_view_init(&omega, sizeof omega));
    CHECK(hbvib_branch_field(branch, HBVIB_OMEGA, &omega));
    CHECK(hbvib_view_init(&response, sizeof response));
    CHECK(hbvib_branch_field(branch, HBVIB_AMPLITUDE, &response));
    for (i = 0; i < omega.shape[0]; i++)
        printf("response: %.6f %.6e\n", omega.data[i * omega.stride[0]], response.data[i * response.stride[0]]);

    CHECK(hbvib_branch_peaks(branch, 1, &peak_omega, &peak_amplitude, &peak, &peaks));
    if (peaks == 0) {
        fprintf(stderr, "no peak\n");
        return EXIT_FAILURE;
    }
    printf("peak: %.17g %.17g\n", peak_omega, peak_amplitude);

    /* The loop: the element under the motion at the peak, in the second period, when it is periodic. */
    CHECK(hbvib_branch_time_history(branch, peak, 0, TIMES, motion));
    for (j = 0; j < 2 * TIMES; j++) {
        double du = motion[j % TIMES] - motion[(j + TIMES - 1) % TIMES];
        double before = z;
        z = step(&element, z, du, &unused, &unused);
        loop[j % TIMES] = element.k * z;
        if (j >= TIMES) lost += 0.5 * element.k * (before + z) * du;
    }
    for (j = 0; j < TIMES; j += TIMES / 32) printf("loop: %+.6f %+.6f\n", motion[j], loop[j]);

    /* The work of the load per cycle is dissipated by damper and element. */
    CHECK(hbvib_branch_harmonics(branch, peak, 0, 1, x, HARMONICS + 1));
    given = -PI * load * x[3];
    for (i = 1; i <= HARMONICS; i++)
        damped += PI * damping * peak_omega * (double)(i * i) * (x[2 * i] * x[2 * i] + x[2 * i + 1] * x[2 * i + 1]);
    printf("work: load %.17g, damper %.17g, element %.17g\n", given, damped, lost);

    CHECK(hbvib_branch_free(branch));
    CHECK(hbvib_model_free(model));
    return EXIT_SUCCESS;
}
