/* Both senses of a nodal diameter: crossings of engine orders, waves of a rotating wheel, flutter of one sense, and what is refused. */
#include "common.h"

enum { SECTORS = 10, SPEEDS = 181, MODES = 2 };

/* Ten masses that move radially and along the circumference, with Coriolis forces. */
static hbvib_model *rotating(void)
{
    static const double mass[4] = {1, 0, 0, 1}, stiffness[4] = {1500, 0, 0, 1900};
    static const double next[4] = {-200, -250, 250, -350}, coriolis[4] = {0, 2, -2, 0}; /* columns */
    hbvib_model *model = NULL;
    hbvib_matrix a;
    WORKS("wheel", hbvib_cyclic_new(2, SECTORS, &model));
    a = matrix(2, mass);
    WORKS("wheel", hbvib_model_set_matrix(model, HBVIB_MASS, &a));
    a = matrix(2, stiffness);
    WORKS("wheel", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a));
    a = matrix(2, next);
    WORKS("wheel", hbvib_cyclic_set_coupling(model, HBVIB_STIFFNESS, &a));
    a = matrix(2, coriolis);
    WORKS("wheel", hbvib_model_set_matrix(model, HBVIB_GYROSCOPIC, &a));
    WORKS("wheel", hbvib_cyclic_set_wave(model, 1));
    return model;
}

static int near(double found, double wanted)
{
    return fabs(found / wanted - 1) < 1e-11;
}

static void crossings(const hbvib_model *model)
{
    static const struct { int64_t order; double speed[2]; } KNOWN[2] = {
        {9, {3.7995179098748477, 4.05780386908863}}, {19, {1.710413476178725, 1.9829812203464108}}};
    static const int64_t OF_EITHER_SENSE[4] = {HBVIB_DIAMETER_OF_ENGINE_ORDER, 1, -1, 9};
    double speeds[SPEEDS], speed[4], omega[4];
    int64_t direction[4], found = -1, wave = 0;
    int i, k;
    for (i = 0; i < SPEEDS; i++) speeds[i] = 0.2 + (45 - 0.2) * i / (SPEEDS - 1);
    for (k = 0; k < 2; k++) {
        for (i = 0; i < 4; i++) {
            found = -1;
            WORKS("crossings", hbvib_campbell_crossings(model, SPEEDS, speeds, OF_EITHER_SENSE[i], HBVIB_CONTACTS_STUCK, MODES,
                                                        KNOWN[k].order, 4, speed, omega, direction, &found, NULL));
            EXPECT("two", found == 2);
            EXPECT("speeds", near(speed[0], KNOWN[k].speed[0]) && near(speed[1], KNOWN[k].speed[1]));
            EXPECT("frequencies", near(omega[0], (double)KNOWN[k].order * speed[0]));
        }
        WORKS("wave", hbvib_cyclic_signed_diameter(model, KNOWN[k].order, &wave));
        EXPECT("wave", wave == -1);
    }
    WORKS("another", hbvib_campbell_crossings(model, SPEEDS, speeds, 2, HBVIB_CONTACTS_STUCK, MODES, 9, 4, speed, omega, NULL,
                                              &found, NULL));
    EXPECT("an order of another diameter", found == 0);
}

static void waves(hbvib_model *model)
{
    static const double FORWARD[2] = {26.31490692, 44.72523732}, BACKWARD[2] = {34.10755906, 36.93258518};
    int64_t diameter[SECTORS], direction[SECTORS * MODES];
    double omega[SECTORS * MODES], ratio[SECTORS * MODES], lambda[4], own[2];
    int64_t equal = -1;
    int i, k;
    WORKS("speed", hbvib_model_set_speed(model, 5));
    WORKS("all", hbvib_interference(model, HBVIB_CONTACTS_STUCK, MODES, SECTORS, diameter, omega, ratio, direction, &equal, NULL));
    EXPECT("senses", equal == 0);
    for (i = 0; i < SECTORS; i++) {
        EXPECT("diameters", diameter[i] == i - 4);
        WORKS("one", hbvib_damped_modes(model, diameter[i] + 3 * SECTORS, HBVIB_CONTACTS_STUCK, MODES, lambda, NULL, NULL, NULL));
        WORKS("undamped", hbvib_linear_modes(model, diameter[i] - SECTORS, HBVIB_CONTACTS_STUCK, MODES, own, NULL));
        for (k = 0; k < MODES; k++) {
            EXPECT("the same", near(lambda[2 * k + 1], omega[i * MODES + k]) && near(own[k], omega[i * MODES + k]));
            EXPECT("undamped", fabs(ratio[i * MODES + k]) < 1e-12);
        }
    }
    for (k = 0; k < MODES; k++) {
        EXPECT("forward", fabs(omega[5 * MODES + k] - FORWARD[k]) < 1e-7);
        EXPECT("backward", fabs(omega[3 * MODES + k] - BACKWARD[k]) < 1e-7);
    }
    WORKS("its own", hbvib_damped_modes(model, HBVIB_DIAMETER_OF_ENGINE_ORDER, HBVIB_CONTACTS_STUCK, MODES, lambda, NULL, NULL, NULL));
    EXPECT("its own", near(lambda[1], omega[5 * MODES]));
    WORKS("at rest", hbvib_model_set_speed(model, 0));
    WORKS("at rest", hbvib_interference(model, HBVIB_CONTACTS_STUCK, MODES, SECTORS, diameter, omega, NULL, NULL, &equal, NULL));
    EXPECT("at rest", equal == 1);
    REFUSED("room", hbvib_interference(model, 1, MODES, SECTORS - 1, diameter, omega, NULL, NULL, NULL, NULL), HBVIB_E_DIMENSION, 4,
            "capacity = 9, needs at least 10");
    REFUSED("modes", hbvib_interference(model, 1, 3, SECTORS, diameter, omega, NULL, NULL, NULL, NULL), HBVIB_E_DIMENSION, 3, "count = 3");
    REFUSED("contacts", hbvib_interference(model, 7, 2, SECTORS, diameter, omega, NULL, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 2,
            "contacts = 7");
    REFUSED("omega", hbvib_interference(model, 1, 2, SECTORS, diameter, NULL, NULL, NULL, NULL, NULL), HBVIB_E_NULL, 6, "omega");
    REFUSED("wave", hbvib_cyclic_signed_diameter(model, 3, NULL), HBVIB_E_NULL, 3, "diameter");
}

static void flutter(void)
{
    enum { WAVES = 24 };
    const double one = 1, damping = 0.005, coupling = -0.1, influence[4] = {0.01, 0, -0.01, 0};
    const int64_t dof = 0, offsets[2] = {1, -1};
    int64_t diameter[WAVES];
    double omega[WAVES], ratio[WAVES], least = 1;
    hbvib_model *model = NULL;
    hbvib_matrix a;
    int64_t equal = -1;
    int i, unstable = 0;
    WORKS("flutter", hbvib_cyclic_new(1, WAVES, &model));
    a = matrix(1, &one);
    WORKS("flutter", hbvib_model_set_matrix(model, HBVIB_MASS, &a));
    WORKS("flutter", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a));
    a = matrix(1, &damping);
    WORKS("flutter", hbvib_model_set_matrix(model, HBVIB_DAMPING, &a));
    a = matrix(1, &coupling);
    WORKS("flutter", hbvib_cyclic_set_coupling(model, HBVIB_STIFFNESS, &a));
    WORKS("flutter", hbvib_cyclic_set_aero(model, 1, &dof, 2, influence, offsets, HBVIB_AERO_DISPLACEMENT));
    WORKS("flutter", hbvib_interference(model, HBVIB_CONTACTS_FREE, 1, WAVES, diameter, omega, ratio, NULL, &equal, NULL));
    for (i = 0; i < WAVES; i++) {
        unstable += ratio[i] < 0;
        if (ratio[i] < least) least = ratio[i];
        EXPECT("the sense that the flow drives", (ratio[i] < 0) <= (diameter[i] < 0));
    }
    EXPECT("unstable waves", unstable == 10 && equal == 0);
    EXPECT("least damping", fabs(least + 0.007618136725428) < 1e-12);
    WORKS("flutter", hbvib_model_free(model));
}

int main(void)
{
    hbvib_model *model = rotating(), *plain = NULL;
    double omega[4];
    int64_t diameter[4];
    crossings(model);
    waves(model);
    flutter();
    WORKS("free", hbvib_model_free(model));
    WORKS("plain", hbvib_model_new(1, &plain));
    REFUSED("plain", hbvib_interference(plain, 1, 1, 4, diameter, omega, NULL, NULL, NULL, NULL), HBVIB_E_UNSUPPORTED, 0, "no nodal diameters");
    WORKS("plain", hbvib_cyclic_signed_diameter(plain, 7, diameter));
    EXPECT("plain", diameter[0] == 0);
    WORKS("plain", hbvib_model_free(plain));
    return verdict(150);
}
