/* The wheel of a cyclic model: its matrices, contacts and forces; patterns of mistuning in closed form; refusals. */
#include "common.h"

#include <complex.h>
#include <math.h>

enum { SECTORS = 5 };

static const double none[SECTORS] = {0}, delta[SECTORS] = {0.1, -0.05, 0.02, 0, 0.03};

/* A mass and stiffness, a coupling to the next sector, a contact with the ground and a force of engine order 2. */
static hbvib_model *ring(void)
{
    const double one = 1, stiffness = 3, coupling = -1;
    hbvib_matrix a;
    hbvib_contact c;
    hbvib_model *model = NULL;
    WORKS("ring", hbvib_cyclic_new(1, SECTORS, &model));
    a = matrix(1, &one);
    WORKS("mass", hbvib_model_set_matrix(model, HBVIB_MASS, &a));
    a = matrix(1, &stiffness);
    WORKS("stiffness", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a));
    a = matrix(1, &coupling);
    WORKS("coupling", hbvib_cyclic_set_coupling(model, HBVIB_STIFFNESS, &a));
    WORKS("wave", hbvib_cyclic_set_wave(model, 2));
    WORKS("init", hbvib_contact_init(&c, sizeof c));
    c.kind = HBVIB_JENKINS;
    c.dof_a[0] = 0;
    c.dof_b[0] = HBVIB_GROUND;
    c.kt = 1;
    c.mu = 0.3;
    c.preload = 2;
    WORKS("contact", hbvib_model_add_contact(model, &c, NULL));
    WORKS("force", hbvib_model_add_force(model, 0, 1, 0.2, 0));
    return model;
}

/* An entry of the diagonal of a matrix. */
static double diagonal(const hbvib_model *wheel, int32_t which, int64_t at)
{
    int64_t row[64], column[64], count = 0, i;
    double complex value[64];
    WORKS("matrix", hbvib_model_matrix(wheel, which, HBVIB_BLOCK_OWN, 64, row, column, (double *)value, &count));
    for (i = 0; i < count; i++)
        if (row[i] == at && column[i] == at) return creal(value[i]);
    return verdict(90);
}

int main(void)
{
    hbvib_model *cyclic = ring(), *wheel = NULL;
    hbvib_matrix a;
    const double direction = 4;
    const int64_t blade = 0, far = 7;
    double complex force[SECTORS];
    int64_t dof[SECTORS], harmonic[SECTORS], unbalance[SECTORS], count = 0;
    hbvib_contact c;
    int s;
    a = matrix(1, &direction);

    WORKS("wheel", hbvib_wheel_new(cyclic, &wheel));
    EXPECT("size", hbvib_model_dofs(wheel) == SECTORS && hbvib_model_sectors(wheel) == 1);
    WORKS("blade", hbvib_wheel_mistune(wheel, cyclic, HBVIB_MISTUNING_FREQUENCY, 1, &blade, NULL, 0, SECTORS, delta));
    WORKS("mass", hbvib_wheel_mistune(wheel, cyclic, HBVIB_MISTUNING_MASS, 0, NULL, &a, 0, SECTORS, delta));
    WORKS("load", hbvib_wheel_mistune(wheel, cyclic, HBVIB_MISTUNING_PRELOAD, 0, NULL, NULL, -1, SECTORS, delta));
    WORKS("force", hbvib_wheel_mistune(wheel, cyclic, HBVIB_MISTUNING_FORCE, 0, NULL, NULL, 0, SECTORS, delta));

    WORKS("forces", hbvib_model_forces(wheel, SECTORS, dof, harmonic, (double *)force, unbalance, &count));
    EXPECT("forces", count == SECTORS);
    WORKS("init", hbvib_contact_init(&c, sizeof c));
    for (s = 0; s < SECTORS; s++) {
        /* A blade over the neighbours that carry it along: 3 (x_s - (x_(s-1) + x_(s+1)) / 3)^2 / 2. */
        const double own = delta[s] * (2 + delta[s]), d1 = delta[(s + 1) % SECTORS], d2 = delta[(s + 4) % SECTORS];
        const double stiffness = 3 + 3 * own + (d1 * (2 + d1) + d2 * (2 + d2)) / 3;
        const double complex expected = 0.2 * (1 + delta[s]) * cexp(-2 * I * acos(-1.0) * 2 * s / SECTORS);
        EXPECT("stiffness", fabs(diagonal(wheel, HBVIB_STIFFNESS, s) - stiffness) < 1e-14);
        EXPECT("mass", fabs(diagonal(wheel, HBVIB_MASS, s) - 1 - 4 * delta[s]) < 1e-15);
        EXPECT("force", dof[s] == s && harmonic[s] == 1 && cabs(force[s] - expected) < 1e-15);
        WORKS("contact", hbvib_model_contact(wheel, s, &c, NULL));
        EXPECT("contact", c.dof_a[0] == s && fabs(c.preload - 2 * (1 + delta[s])) < 1e-15);
    }

    REFUSED("null", hbvib_wheel_new(cyclic, NULL), HBVIB_E_NULL, 2, "out");
    REFUSED("plain", hbvib_wheel_new(wheel, &wheel), HBVIB_E_UNSUPPORTED, 1, "plain structure");
    REFUSED("kind", hbvib_wheel_mistune(wheel, cyclic, 6, 0, NULL, NULL, 0, SECTORS, none), HBVIB_E_ARGUMENT, 3, "kind = 6");
    REFUSED("dofs", hbvib_wheel_mistune(wheel, cyclic, 0, 1, &far, NULL, 0, SECTORS, none), HBVIB_E_INDEX, 5, "dofs");
    REFUSED("neither", hbvib_wheel_mistune(wheel, cyclic, 0, 0, NULL, NULL, 0, SECTORS, none), HBVIB_E_ARGUMENT, 4, "direction");
    REFUSED("both", hbvib_wheel_mistune(wheel, cyclic, 0, 1, &blade, &a, 0, SECTORS, none), HBVIB_E_ARGUMENT, 6, "one of them");
    REFUSED("frequency", hbvib_wheel_mistune(wheel, cyclic, 1, 0, NULL, &a, 0, SECTORS, none), HBVIB_E_ARGUMENT, 6, "blade");
    REFUSED("contact", hbvib_wheel_mistune(wheel, cyclic, 4, 0, NULL, NULL, 1, SECTORS, none), HBVIB_E_INDEX, 7, "contact");
    REFUSED("length", hbvib_wheel_mistune(wheel, cyclic, 5, 0, NULL, NULL, 0, 4, none), HBVIB_E_DIMENSION, 9, "delta");

    {
        double amplitude[SECTORS], omega[SECTORS], error[SECTORS];
        hbvib_wheel_info info;
        hbvib_solver_options solver;
        hbvib_branch *branch = NULL;
        int64_t blades = 0;
        WORKS("init", hbvib_wheel_info_init(&info, sizeof info));
        WORKS("init", hbvib_solver_options_init(&solver, sizeof solver));
        solver.harmonics = 3;
        solver.tolerance = 0;
        WORKS("damping", hbvib_model_set_rayleigh(cyclic, 0, 0.02));
        WORKS("damping", hbvib_model_set_rayleigh(wheel, 0, 0.02));
        WORKS("peaks", hbvib_wheel_peaks(wheel, cyclic, NULL, &solver, 1, 3, NULL, SECTORS, amplitude, omega, error, &blades, &info,
                                         &branch));
        EXPECT("peaks", blades == SECTORS && info.blade >= 0 && info.largest == amplitude[info.blade] && isnan(error[0]));
        for (s = 0; s < SECTORS; s++) EXPECT("largest", !(amplitude[s] > info.largest));
        EXPECT("amplification", info.tuned > 0 && info.amplification == info.largest / info.tuned && info.amplification > 1);
        EXPECT("responses", hbvib_branch_responses(branch) == SECTORS);
        WORKS("branch", hbvib_branch_free(branch));
        EXPECT("within", info.beyond == 0 && info.end_amplitude < info.largest && (info.end_omega == 1 || info.end_omega == 3));
        {
            /* A range that ends below the highest peak: told, not counted. */
            const double end = omega[info.blade] * (1 - 1e-3);
            EXPECT("status", hbvib_wheel_peaks(wheel, cyclic, NULL, &solver, 1, end, NULL, SECTORS, amplitude, NULL, NULL, &blades, &info,
                                               NULL) == HBVIB_STOPPED_NO_PEAK);
            EXPECT("sentence", strstr(hbvib_last_error(), "highest peak lies beyond") != NULL);
            EXPECT("beyond", info.beyond >= 1 && info.end_omega == end && isnan(info.amplification));
            EXPECT("end", !(info.end_amplitude <= info.largest));
        }
        {
            /* A sector of the same size with other matrices is not the one of the wheel. */
            hbvib_model *other = ring();
            const double softer = 2.9;
            hbvib_matrix k = matrix(1, &softer);
            WORKS("softer", hbvib_model_set_matrix(other, HBVIB_STIFFNESS, &k));
            REFUSED("another sector", hbvib_wheel_mistune(wheel, other, 0, 1, &blade, NULL, 0, SECTORS, none), HBVIB_E_ARGUMENT, 9,
                    "other matrices");
            REFUSED("another tuned one",
                    hbvib_wheel_peaks(wheel, other, NULL, NULL, 1, 3, NULL, SECTORS, NULL, NULL, NULL, &blades, NULL, NULL),
                    HBVIB_E_ARGUMENT, 0, "other matrices");
            WORKS("free", hbvib_model_free(other));
            other = ring();
            REFUSED("damping", hbvib_wheel_peaks(wheel, other, NULL, NULL, 1, 3, NULL, SECTORS, NULL, NULL, NULL, &blades, NULL, NULL),
                    HBVIB_E_ARGUMENT, 0, "Rayleigh damping 0, 0");
            WORKS("free", hbvib_model_free(other));
        }
        REFUSED("another wheel", hbvib_wheel_peaks(cyclic, cyclic, NULL, NULL, 1, 3, NULL, SECTORS, NULL, NULL, NULL, &blades, NULL, NULL),
                HBVIB_E_DIMENSION, 0, "needs the wheel");
        REFUSED("range", hbvib_wheel_peaks(wheel, cyclic, NULL, NULL, 0, 3, NULL, SECTORS, NULL, NULL, NULL, &blades, NULL, NULL),
                HBVIB_E_ARGUMENT, 5, "omega_start");
        REFUSED("capacity", hbvib_wheel_peaks(wheel, cyclic, NULL, NULL, 1, 3, NULL, 2, amplitude, NULL, NULL, &blades, NULL, NULL),
                HBVIB_E_DIMENSION, 8, "capacity = 2");
    }
    {
        double omega[SECTORS], sigma[SECTORS], shapes[2 * SECTORS * SECTORS], found[SECTORS], covariance[SECTORS * SECTORS], chi2 = -1;
        hbvib_model *other = NULL;
        int64_t degrees = 0;
        WORKS("wheel", hbvib_wheel_new(cyclic, &other));
        WORKS("blade", hbvib_wheel_mistune(other, cyclic, HBVIB_MISTUNING_FREQUENCY, 1, &blade, NULL, 0, SECTORS, delta));
        WORKS("modes", hbvib_linear_modes(other, 0, HBVIB_CONTACTS_STUCK, SECTORS, omega, shapes));
        for (s = 0; s < SECTORS; s++) sigma[s] = 1e-3;
        WORKS("pattern", hbvib_wheel_identify(cyclic, HBVIB_MISTUNING_FREQUENCY, 1, &blade, NULL, HBVIB_CONTACTS_STUCK, 1, 1, &blade,
                                              SECTORS, omega, sigma, shapes, sigma, NULL, SECTORS, found, covariance, &chi2, &degrees));
        for (s = 0; s < SECTORS; s++) EXPECT("pattern", fabs(found[s] - delta[s]) < 1e-10 && covariance[(SECTORS + 1) * s] > 0);
        EXPECT("residuals", chi2 >= 0 && chi2 < 1e-10 && degrees == SECTORS * (SECTORS - 1));
        WORKS("the pattern alone", hbvib_wheel_identify(cyclic, HBVIB_MISTUNING_FREQUENCY, 1, &blade, NULL, HBVIB_CONTACTS_STUCK, 1, 1,
                                                        &blade, SECTORS, omega, sigma, shapes, sigma, NULL, SECTORS, found, NULL, NULL, NULL));
        REFUSED("loads", hbvib_wheel_identify(cyclic, HBVIB_MISTUNING_PRELOAD, 1, &blade, NULL, HBVIB_CONTACTS_STUCK, 1, 1, &blade, SECTORS,
                                              omega, sigma, shapes, sigma, NULL, SECTORS, found, NULL, NULL, NULL),
                HBVIB_E_UNSUPPORTED, 2, "loads");
        REFUSED("points", hbvib_wheel_identify(cyclic, HBVIB_MISTUNING_STIFFNESS, 1, &blade, NULL, HBVIB_CONTACTS_STUCK, 1, 1, &far,
                                               SECTORS, omega, sigma, shapes, sigma, NULL, SECTORS, found, NULL, NULL, NULL),
                HBVIB_E_INDEX, 9, "points");
        REFUSED("overlap", hbvib_wheel_identify(cyclic, HBVIB_MISTUNING_STIFFNESS, 1, &blade, NULL, HBVIB_CONTACTS_STUCK, 1, 1, &blade,
                                                SECTORS, omega, sigma, shapes, sigma, NULL, SECTORS, omega, NULL, NULL, NULL),
                HBVIB_E_ARGUMENT, 17, "overlap");
        REFUSED("sectors", hbvib_wheel_identify(cyclic, HBVIB_MISTUNING_STIFFNESS, 1, &blade, NULL, HBVIB_CONTACTS_STUCK, 1, 1, &blade,
                                                SECTORS, omega, sigma, shapes, sigma, NULL, 4, found, NULL, NULL, NULL),
                HBVIB_E_DIMENSION, 16, "sectors");
        WORKS("other", hbvib_model_free(other));
    }
    {
        /* A disk with a blade of two masses on its first cantilever mode: K = [2 -1; -1 1], squares of the frequencies (3 -+ sqrt 5) / 2. */
        const double k[9] = {4, -1, 0, -1, 2, -1, 0, -1, 1}, m[9] = {5, 0, 0, 0, 1, 0, 0, 0, 1}, next[9] = {-1, 0, 0, 0, 0, 0, 0, 0, 0};
        const int64_t dofs[2] = {1, 2}, tip = 2;
        double weights[2], left_out = -1;
        int64_t numbers[3], first = -1;
        hbvib_model *full = NULL, *reduced = NULL;
        WORKS("sector", hbvib_cyclic_new(3, SECTORS, &full));
        a = matrix(3, m);
        WORKS("mass", hbvib_model_set_matrix(full, HBVIB_MASS, &a));
        a = matrix(3, k);
        WORKS("stiffness", hbvib_model_set_matrix(full, HBVIB_STIFFNESS, &a));
        a = matrix(3, next);
        WORKS("coupling", hbvib_cyclic_set_coupling(full, HBVIB_STIFFNESS, &a));
        WORKS("modes", hbvib_wheel_blade_modes(full, 2, dofs, 1, 1, NULL, 1, &tip, 2, weights, 3, numbers, &first, &left_out, &reduced));
        EXPECT("order", hbvib_model_dofs(reduced) == 2 && first == 1 && numbers[0] == 0 && numbers[1] == -1 && numbers[2] == -1);
        EXPECT("cantilever", fabs(diagonal(reduced, HBVIB_STIFFNESS, 1) - (3 - sqrt(5)) / 2) < 1e-14);
        EXPECT("mass of a mode", fabs(diagonal(reduced, HBVIB_MASS, 1) - 1) < 1e-14);
        /* Both masses follow the disk by 1, and the first mode is (1, (1 + sqrt 5) / 2) of length 1. */
        EXPECT("tip", fabs(weights[0] - 1) < 1e-14 && fabs(fabs(weights[1]) - 0.850650808352040) < 1e-12);
        EXPECT("error", left_out > 0 && left_out < 0.1);
        REFUSED("all modes", hbvib_wheel_blade_modes(full, 2, dofs, 2, 1, NULL, 0, NULL, 0, NULL, 3, NULL, NULL, NULL, &reduced),
                HBVIB_E_ARGUMENT, 1, "modes = 2");
        REFUSED("families", hbvib_wheel_blade_modes(full, 2, dofs, 1, 0, NULL, 0, NULL, 0, NULL, 3, NULL, NULL, NULL, &reduced),
                HBVIB_E_ARGUMENT, 5, "families = 0");
        REFUSED("room", hbvib_wheel_blade_modes(full, 2, dofs, 1, 1, NULL, 1, &tip, 1, weights, 3, NULL, NULL, NULL, &reduced),
                HBVIB_E_DIMENSION, 9, "weights_len = 1");
        REFUSED("disk", hbvib_wheel_blade_modes(full, 2, (int64_t[]){0, 1}, 1, 1, NULL, 0, NULL, 0, NULL, 3, NULL, NULL, NULL, &reduced),
                HBVIB_E_ARGUMENT, 1, "another sector");
        WORKS("free", hbvib_model_free(reduced));
        WORKS("free", hbvib_model_free(full));
    }
    WORKS("wheel", hbvib_model_free(wheel));
    WORKS("cyclic", hbvib_model_free(cyclic));
    return verdict(90);
}
