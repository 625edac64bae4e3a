/* Damping by numbers, speed of rotation, damped modes and the Campbell diagram: Stodola's rotor, and refusals. */
#include "common.h"

static const double MASSES[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.3, 0, 0, 0, 0, 0.3};
static const double SPRINGS[16] = {1, 0, 0.4, 0, 0, 1, 0, 0.4, 0.4, 0, 0.8, 0, 0, 0.4, 0, 0.8};
static const double GYROSCOPIC[16] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -0.5, 0, 0, 0.5, 0};
static const double STODOLA[4] = {0.693911507, 0.917055456, 1.246325060, 2.689847777};

static int near(double a, double b, double tolerance)
{
    return fabs(a - b) <= tolerance * fabs(b);
}

static double amplitude(hbvib_model *model, double omega)
{
    hbvib_solver_options s = solver_options();
    hbvib_forced_options o = frequencies(1, 1);
    hbvib_branch *branch = NULL;
    hbvib_view view;
    double found;
    s.harmonics = 3;
    o.omega_start = o.omega_stop = omega;
    WORKS("solve", hbvib_forced_response(model, &s, &o, NULL, &branch));
    WORKS("solve", hbvib_view_init(&view, sizeof view));
    WORKS("solve", hbvib_branch_field(branch, HBVIB_AMPLITUDE, &view));
    found = view.data[0];
    WORKS("solve", hbvib_branch_free(branch));
    return found;
}

static void rotor(hbvib_model *model)
{
    const double speeds[2] = {0.8, 1};
    double lambda[8], shapes[32], omega[8], ratio[8], at[8], frequency[8], before;
    int64_t direction[8], sense[8], found = -1;
    int k;
    WORKS("speed", hbvib_model_set_speed(model, 1));
    WORKS("modes", hbvib_damped_modes(model, 0, HBVIB_CONTACTS_FREE, 4, lambda, shapes, direction, NULL));
    for (k = 0; k < 4; k++) {
        EXPECT("rotor", near(lambda[2 * k + 1], STODOLA[k], 1e-9) && fabs(lambda[2 * k]) < 1e-12);
        EXPECT("whirl", direction[k] == (k % 2 ? 1 : -1));
    }
    WORKS("modes", hbvib_damped_modes(model, 0, HBVIB_CONTACTS_FREE, 4, lambda, NULL, NULL, NULL));
    WORKS("campbell", hbvib_campbell(model, 2, speeds, 0, HBVIB_CONTACTS_FREE, 4, omega, ratio, direction, NULL));
    EXPECT("campbell", near(omega[5], STODOLA[1], 1e-9) && fabs(ratio[5]) < 1e-12 && direction[5] == 1);
    WORKS("campbell", hbvib_campbell(model, 2, speeds, 0, HBVIB_CONTACTS_FREE, 4, omega, NULL, NULL, NULL));
    WORKS("critical", hbvib_campbell_crossings(model, 2, speeds, 0, HBVIB_CONTACTS_FREE, 4, 1, 8, at, frequency, sense,
                                               &found, NULL));
    EXPECT("critical", found == 1 && near(at[0], 0.9135225809938965, 1e-12) && near(frequency[0], at[0], 1e-12) && sense[0] == 1);
    found = -1;
    WORKS("room", hbvib_campbell_crossings(model, 2, speeds, 0, HBVIB_CONTACTS_FREE, 4, 1, 0, NULL, NULL, NULL, &found, NULL));
    EXPECT("room", found == 1);

    WORKS("damping", hbvib_model_set_rayleigh(model, 0, 0.02));
    WORKS("unbalance", hbvib_model_add_unbalance(model, 0, 1, 0.1, 0.3));
    WORKS("tied", hbvib_model_set_speed_per_omega(model, 1));
    before = amplitude(model, 0.8);
    WORKS("fixed", hbvib_model_set_speed(model, 0.8));
    EXPECT("tied", near(amplitude(model, 0.8), before, 1e-12));

    REFUSED("24", hbvib_model_set_speed(model, NAN), HBVIB_E_NOT_FINITE, 2, "speed = NaN");
    REFUSED("24", hbvib_model_set_speed_per_omega(model, INFINITY), HBVIB_E_NOT_FINITE, 2, "per_omega = inf");
    REFUSED("39", hbvib_model_add_unbalance(model, 4, 1, 1, 0), HBVIB_E_INDEX, 2, "dof_x = 4");
    REFUSED("39", hbvib_model_add_unbalance(model, 0, -1, 1, 0), HBVIB_E_INDEX, 3, "dof_y = -1");
    REFUSED("41", hbvib_model_add_unbalance(model, 1, 1, 1, 0), HBVIB_E_ARGUMENT, 3, "both 1");
    REFUSED("24", hbvib_model_add_unbalance(model, 0, 1, NAN, 0), HBVIB_E_NOT_FINITE, 4, "m_e = NaN");
    REFUSED("24", hbvib_model_add_unbalance(model, 0, 1, 1, NAN), HBVIB_E_NOT_FINITE, 5, "phase = NaN");
    REFUSED("1", hbvib_damped_modes(model, 0, 0, 4, NULL, NULL, NULL, NULL), HBVIB_E_NULL, 5, "eigenvalue");
    REFUSED("63", hbvib_damped_modes(model, 1, 0, 4, lambda, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 2, "diameter = 1");
    REFUSED("54", hbvib_damped_modes(model, 0, 7, 4, lambda, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 3, "contacts = 7");
    REFUSED("5", hbvib_damped_modes(model, 0, 0, 0, lambda, NULL, NULL, NULL), HBVIB_E_DIMENSION, 4, "count = 0");
    REFUSED("5", hbvib_campbell(model, 0, speeds, 0, 0, 4, omega, NULL, NULL, NULL), HBVIB_E_DIMENSION, 3, "no speeds");
    REFUSED("1", hbvib_campbell(model, 2, NULL, 0, 0, 4, omega, NULL, NULL, NULL), HBVIB_E_NULL, 3, "speeds");
    REFUSED("1", hbvib_campbell(model, 2, speeds, 0, 0, 4, NULL, NULL, NULL, NULL), HBVIB_E_NULL, 7, "omega");
    REFUSED("6", hbvib_campbell(model, -1, speeds, 0, 0, 4, omega, NULL, NULL, NULL), HBVIB_E_DIMENSION, 2, "n = -1");
    REFUSED("1", hbvib_campbell_crossings(model, 2, speeds, 0, 0, 4, 1, 8, NULL, frequency, sense, &found, NULL),
            HBVIB_E_NULL, 9, "speed");
    REFUSED("1", hbvib_campbell_crossings(model, 2, speeds, 0, 0, 4, 1, 8, at, NULL, sense, &found, NULL), HBVIB_E_NULL,
            10, "omega");
    REFUSED("1", hbvib_campbell_crossings(model, 2, speeds, 0, 0, 4, 1, 8, at, frequency, sense, NULL, NULL),
            HBVIB_E_NULL, 12, "found");
    REFUSED("61", hbvib_campbell_crossings(model, 2, speeds, 0, 0, 4, 0, 8, at, frequency, sense, &found, NULL),
            HBVIB_E_ARGUMENT, 7, "engine_order = 0");
    REFUSED("4", hbvib_damped_modes(NULL, 0, 0, 4, lambda, NULL, NULL, NULL), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("4", hbvib_campbell(NULL, 2, speeds, 0, 0, 4, omega, NULL, NULL, NULL), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("4", hbvib_campbell_crossings(NULL, 2, speeds, 0, 0, 4, 1, 8, at, frequency, sense, &found, NULL),
            HBVIB_E_HANDLE, 1, "NULL");
}

static void damping(hbvib_model *model)
{
    const double ratios[2] = {0.02, -0.01}, good[2] = {0.02, 0.01};
    hbvib_matrix d = matrix(4, MASSES);
    double lambda[8];
    WORKS("loss", hbvib_model_set_speed(model, 0));
    WORKS("loss", hbvib_model_set_rayleigh(model, 0, 0));
    WORKS("loss", hbvib_model_set_loss_factor(model, 0.02));
    WORKS("loss", hbvib_damped_modes(model, 0, HBVIB_CONTACTS_FREE, 2, lambda, NULL, NULL, NULL));
    EXPECT("loss", near(-lambda[0] / lambda[1], 0.01, 1e-3));
    WORKS("loss", hbvib_model_set_loss_factor(model, 0));
    WORKS("structural", hbvib_model_set_matrix(model, HBVIB_STRUCTURAL, &d));
    d.values = GYROSCOPIC;
    REFUSED("27", hbvib_model_set_matrix(model, HBVIB_STRUCTURAL, &d), HBVIB_E_NOT_HERMITIAN, 3, "structural");
    d.values = SPRINGS;
    REFUSED("27", hbvib_model_set_matrix(model, HBVIB_GYROSCOPIC, &d), HBVIB_E_NOT_HERMITIAN, 3, "skew-symmetric");
    WORKS("softening", hbvib_model_set_matrix(model, HBVIB_STIFFNESS_SPEED2, &d));
    REFUSED("44", hbvib_model_set_loss_factor(model, -1), HBVIB_E_ARGUMENT, 2, "loss_factor = -1");
    REFUSED("24", hbvib_model_set_loss_factor(model, NAN), HBVIB_E_NOT_FINITE, 2, "loss_factor = NaN");
    REFUSED("44", hbvib_model_set_modal_damping(model, 2, ratios), HBVIB_E_ARGUMENT, 3, "ratios[1] = -0.01");
    REFUSED("6", hbvib_model_set_modal_damping(model, -1, ratios), HBVIB_E_DIMENSION, 2, "n = -1");
    REFUSED("1", hbvib_model_set_modal_damping(model, 2, NULL), HBVIB_E_NULL, 3, "ratios");
    WORKS("modal", hbvib_model_set_modal_damping(model, 2, good));
    WORKS("modal", hbvib_model_set_modal_damping(model, 0, NULL));
    REFUSED("4", hbvib_model_set_speed(NULL, 1), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("4", hbvib_model_set_speed_per_omega(NULL, 1), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("4", hbvib_model_set_loss_factor(NULL, 0.1), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("4", hbvib_model_set_modal_damping(NULL, 2, good), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("4", hbvib_model_add_unbalance(NULL, 0, 1, 1, 0), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("4", hbvib_model_set_preload_at_speed(NULL, 0, 1, 1), HBVIB_E_HANDLE, 1, "NULL");
}

/* A load of the speed is that load. */
static void load(void)
{
    hbvib_model *copy = NULL;
    double before, preload = 30, speed = 2;
    WORKS("load", hbvib_model_clone(the_model, &copy));
    WORKS("load", hbvib_model_set_preload(copy, 0, preload));
    before = amplitude(copy, 1300);
    WORKS("load", hbvib_model_set_preload_at_speed(copy, 0, preload - 4, 1));
    WORKS("load", hbvib_model_set_speed(copy, speed));
    EXPECT("load", amplitude(copy, 1300) == before);
    REFUSED("52", hbvib_model_set_preload_at_speed(copy, 1, 1, 1), HBVIB_E_INDEX, 2, "id = 1");
    REFUSED("44", hbvib_model_set_preload_at_speed(copy, 0, -1, 1), HBVIB_E_ARGUMENT, 3, "preload = -1");
    REFUSED("24", hbvib_model_set_preload_at_speed(copy, 0, 1, NAN), HBVIB_E_NOT_FINITE, 4, "per_speed2 = NaN");
    WORKS("load", hbvib_model_set_preload_at_speed(copy, 0, 1, -1));
    REFUSED("75", hbvib_model_set_speed_per_omega(copy, 1), HBVIB_E_ARGUMENT, 2, "per_speed2 = -1");
    WORKS("free", hbvib_model_free(copy));
}

int main(void)
{
    hbvib_model *model = NULL;
    hbvib_matrix a = matrix(4, MASSES);

    begin();
    WORKS("rotor", hbvib_model_new(4, &model));
    WORKS("rotor", hbvib_model_set_matrix(model, HBVIB_MASS, &a));
    a.values = SPRINGS;
    WORKS("rotor", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a));
    a.values = GYROSCOPIC;
    WORKS("rotor", hbvib_model_set_matrix(model, HBVIB_GYROSCOPIC, &a));
    rotor(model);
    damping(model);
    load();
    WORKS("free", hbvib_model_free(model));
    return verdict(90);
}
