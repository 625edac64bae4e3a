/* Aerodynamic influence: a ring of equal masses has the response of its closed form; reading back, and what is refused. */
#include "common.h"

#include <complex.h>

enum { SECTORS = 5, ORDER = 2 };

static hbvib_model *ring(void)
{
    const double one = 1, stiffness = 3, damping = 0.03;
    hbvib_matrix a;
    hbvib_model *model = NULL;
    WORKS("ring", hbvib_cyclic_new(1, SECTORS, &model));
    a = matrix(1, &one);
    WORKS("ring", hbvib_model_set_matrix(model, HBVIB_MASS, &a));
    a = matrix(1, &stiffness);
    WORKS("ring", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a));
    a = matrix(1, &damping);
    WORKS("ring", hbvib_model_set_matrix(model, HBVIB_DAMPING, &a));
    WORKS("ring", hbvib_cyclic_set_wave(model, ORDER));
    return model;
}

static double complex response(const hbvib_model *model, double omega, int32_t expected)
{
    hbvib_solver_options s;
    hbvib_forced_options o;
    hbvib_branch *branch = NULL;
    double x[4] = {0};
    WORKS("options", hbvib_solver_options_init(&s, sizeof s));
    WORKS("options", hbvib_forced_options_init(&o, sizeof o));
    s.harmonics = 1;
    s.tolerance = 0;
    o.omega_start = o.omega_stop = omega;
    EXPECT("solve", hbvib_forced_response(model, &s, &o, NULL, &branch) == expected);
    WORKS("point", hbvib_branch_harmonics(branch, 0, 0, 1, x, 2));
    WORKS("branch", hbvib_branch_free(branch));
    return x[2] + I * x[3];
}

int main(void)
{
    const int64_t dof = 0, twice[2] = {0, 0}, offsets[3] = {0, 1, -1}, same[2] = {1, -4};
    const double c[6] = {-0.1, -0.05, 0.07, 0.02, 0.01, -0.06}, real[2] = {-0.02, 0};
    const double bad[2] = {0, NAN}, omega = 0.8;
    double coefficient[6];
    double complex influence = 0, z;
    int64_t force[3], motion[3], offset[3], count = -1;
    int k;
    hbvib_model *model = ring(), *plain = NULL;
    hbvib_time_options t;

    WORKS("set", hbvib_cyclic_set_aero(model, 1, &dof, 3, c, offsets, HBVIB_AERO_DISPLACEMENT));
    WORKS("set", hbvib_cyclic_set_aero(model, 1, &dof, 1, real, offsets, HBVIB_AERO_VELOCITY));
    /* A model that can only flutter has no forced response. */
    EXPECT("no force", response(model, omega, HBVIB_STOPPED_NO_FORCE) == 0);
    WORKS("force", hbvib_model_add_force(model, 0, 1, 1, 0));
    for (k = 0; k < 3; k++) influence += (c[2 * k] + I * c[2 * k + 1]) * cexp(-I * (2 * PI * ORDER * (double)offsets[k] / SECTORS));
    z = 3 - influence - omega * omega + I * omega * (0.03 + 0.02);
    EXPECT("response", cabs(response(model, omega, HBVIB_OK) * z - 1) < 1e-12);

    WORKS("count", hbvib_cyclic_aero(model, HBVIB_AERO_DISPLACEMENT, 0, NULL, NULL, NULL, NULL, &count));
    EXPECT("count", count == 3);
    WORKS("read", hbvib_cyclic_aero(model, HBVIB_AERO_DISPLACEMENT, 3, force, motion, offset, coefficient, &count));
    EXPECT("read", memcmp(coefficient, c, sizeof c) == 0 && memcmp(offset, offsets, sizeof offset) == 0 && force[1] == 0 && motion[2] == 0);
    REFUSED("room", hbvib_cyclic_aero(model, 0, 2, force, NULL, NULL, NULL, &count), HBVIB_E_DIMENSION, 3, "needs 3");
    REFUSED("form", hbvib_cyclic_aero(model, 2, 0, NULL, NULL, NULL, NULL, &count), HBVIB_E_ARGUMENT, 2, "form = 2");
    REFUSED("null", hbvib_cyclic_aero(model, 0, 0, NULL, NULL, NULL, NULL, NULL), HBVIB_E_NULL, 8, "count");

    REFUSED("handle", hbvib_cyclic_set_aero(NULL, 1, &dof, 1, c, offsets, 0), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("n_dofs", hbvib_cyclic_set_aero(model, -1, &dof, 1, c, offsets, 0), HBVIB_E_DIMENSION, 2, "n_dofs = -1");
    REFUSED("n_offsets", hbvib_cyclic_set_aero(model, 1, &dof, -1, c, offsets, 0), HBVIB_E_DIMENSION, 4, "n_offsets");
    REFUSED("many", hbvib_cyclic_set_aero(model, 1, &dof, INT64_MAX, c, offsets, 0), HBVIB_E_DIMENSION, 6, "memory");
    REFUSED("n_dofs", hbvib_cyclic_set_aero(model, INT64_MAX, &dof, 1, c, offsets, 0), HBVIB_E_DIMENSION, 3, "memory");
    REFUSED("dofs", hbvib_cyclic_set_aero(model, 1, offsets + 1, 1, c, offsets, 0), HBVIB_E_INDEX, 3, "dofs[0] = 1");
    REFUSED("dofs", hbvib_cyclic_set_aero(model, 2, twice, 0, c, offsets, 0), HBVIB_E_ARGUMENT, 3, "dofs[0] and dofs[1]");
    REFUSED("dofs", hbvib_cyclic_set_aero(model, 1, NULL, 1, c, offsets, 0), HBVIB_E_NULL, 3, "dofs");
    REFUSED("coefficients", hbvib_cyclic_set_aero(model, 1, &dof, 1, NULL, offsets, 0), HBVIB_E_NULL, 5, "coefficients");
    REFUSED("coefficients", hbvib_cyclic_set_aero(model, 1, &dof, 1, bad, offsets, 0), HBVIB_E_NOT_FINITE, 5, "coefficients[0]");
    REFUSED("offsets", hbvib_cyclic_set_aero(model, 1, &dof, 2, c, same, 0), HBVIB_E_ARGUMENT, 6, "offsets[0] and offsets[1]");
    REFUSED("form", hbvib_cyclic_set_aero(model, 1, &dof, 1, c, offsets, 7), HBVIB_E_ARGUMENT, 7, "form = 7");
    EXPECT("unchanged", cabs(response(model, omega, HBVIB_OK) * z - 1) < 1e-12);

    WORKS("time", hbvib_time_options_init(&t, sizeof t));
    t.omega = omega;
    REFUSED("time", hbvib_time_response(model, &t, NULL, NULL, 0, NULL, 0, NULL), HBVIB_E_UNSUPPORTED, 0, "complex");
    WORKS("remove", hbvib_cyclic_set_aero(model, 0, NULL, 0, NULL, NULL, HBVIB_AERO_DISPLACEMENT));
    WORKS("remove", hbvib_cyclic_aero(model, HBVIB_AERO_DISPLACEMENT, 0, NULL, NULL, NULL, NULL, &count));
    EXPECT("remove", count == 0);
    WORKS("plain", hbvib_model_new(1, &plain));
    REFUSED("plain", hbvib_cyclic_set_aero(plain, 1, &dof, 1, c, offsets, 0), HBVIB_E_UNSUPPORTED, 1, "plain structure");
    WORKS("free", hbvib_model_free(plain));
    WORKS("free", hbvib_model_free(model));
    return verdict(40);
}
