/* A bladed disk with a friction ring damper, in C: one of 24 sectors, engine order 2, friction
 * between disk and ring. Prints the resonance of the blade tip under three forces.
 *
 *   sh examples/install.sh $HOME/hbvib
 *   make -C examples/c PKG_CONFIG_PATH=$HOME/hbvib/lib/pkgconfig
 */
#include "hbvib.h"

#include <stdio.h>
#include <stdlib.h>

enum { B2, B1, D, R, NDOF }; /* blade tip, blade root, disk, ring */

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

/* Borrows a packed, real, symmetric matrix. */
static hbvib_matrix view(const double values[NDOF][NDOF])
{
    hbvib_matrix a;
    CHECK(hbvib_matrix_init(&a, sizeof a));
    a.rows = a.cols = NDOF;
    a.values = &values[0][0];
    return a;
}

static hbvib_model *ring_damper(double ring_mass, double rpm)
{
    const double kb2 = 2e6, kb1 = 1e6, kd = 5e7, kg = 6e5, kr = 2e7, radius = 0.165, spin = rpm * 2 * PI / 60;
    const double mass[NDOF][NDOF] = {{0.2, 0, 0, 0}, {0, 0.3, 0, 0}, {0, 0, 1.2, 0}, {0, 0, 0, ring_mass}};
    const double stiffness[NDOF][NDOF] = {
        {kb2, -kb2, 0, 0}, {-kb2, kb2 + kb1, -kb1, 0}, {0, -kb1, kb1 + kg + 2 * kd, 0}, {0, 0, 0, 2 * kr}};
    const double coupling[NDOF][NDOF] = {{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, -kd, 0}, {0, 0, 0, -kr}};
    hbvib_matrix m = view(mass), k = view(stiffness), next = view(coupling);
    hbvib_contact friction;
    hbvib_model *model = NULL;

    CHECK(hbvib_cyclic_new(NDOF, 24, &model));
    CHECK(hbvib_model_set_matrix(model, HBVIB_MASS, &m));
    CHECK(hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &k));
    CHECK(hbvib_cyclic_set_coupling(model, HBVIB_STIFFNESS, &next));
    CHECK(hbvib_model_set_rayleigh(model, 0, 1.5e-6)); /* C = 1.5e-6 s * K */
    CHECK(hbvib_cyclic_set_wave(model, 2));            /* engine order */
    CHECK(hbvib_contact_init(&friction, sizeof friction));
    friction.kind = HBVIB_JENKINS;
    friction.dof_a[0] = D;
    friction.dof_b[0] = R;
    friction.kt = 5e7;
    friction.mu = 0.3;
    friction.preload = ring_mass * radius * spin * spin;
    CHECK(hbvib_model_add_contact(model, &friction, NULL));
    return model;
}

int main(void)
{
    const double forces[] = {1, 5, 20};
    hbvib_model *model = ring_damper(0.03, 3000);
    hbvib_solver_options solver;
    hbvib_forced_options range;
    size_t f;
    CHECK(hbvib_solver_options_init(&solver, sizeof solver));
    solver.tolerance = 0; /* fixed harmonics: exactly H = 63 */
    solver.harmonics = 63;
    solver.response_dof = B2;
    CHECK(hbvib_forced_options_init(&range, sizeof range));
    range.omega_start = 2 * PI * 207;
    range.omega_stop = 2 * PI * 211;

    printf("   F/N              f/Hz            |X1|/m\n");
    for (f = 0; f < sizeof forces / sizeof *forces; f++) {
        hbvib_branch *branch = NULL;
        double omega[8], amplitude[8];
        int64_t peaks = 0, i, best = 0;
        CHECK(hbvib_model_clear_forces(model));
        CHECK(hbvib_model_add_force(model, B2, 1, forces[f], 0));
        CHECK(hbvib_model_add_force(model, B1, 1, forces[f], 0));
        CHECK(hbvib_forced_response(model, &solver, &range, NULL, &branch));
        CHECK(hbvib_branch_peaks(branch, 8, omega, amplitude, NULL, &peaks));
        for (i = 1; i < peaks; i++)
            if (amplitude[i] > amplitude[best]) best = i;
        if (peaks > 0) printf("%6.1f  %16.11f  %19.12E\n", forces[f], omega[best] / (2 * PI), amplitude[best]);
        CHECK(hbvib_branch_free(branch));
    }
    CHECK(hbvib_model_free(model));
    return EXIT_SUCCESS;
}
