/* A damper under a platform: its degrees of freedom, contacts, centrifugal force and curves of its band; refusals. */
#include "common.h"

#include <math.h>

int main(void)
{
    const double one = 1, damping = 0.04;
    const int64_t roll = 3, far = 9;
    hbvib_model *model = NULL;
    hbvib_branch *branch = NULL;
    hbvib_matrix a;
    hbvib_damper_face faces[2];
    hbvib_damper d;
    hbvib_solver_options s;
    hbvib_forced_options f;
    hbvib_band_options b;
    hbvib_contact c;
    hbvib_time_options t;
    int64_t dof = 0, contact = 7, sliders[2], complete[2], count = 0;
    double omega[2], lower[2], upper[2], places[2] = {9, 9};
    int i;

    WORKS("model", hbvib_model_new(1, &model));
    a = matrix(1, &one);
    WORKS("mass", hbvib_model_set_matrix(model, HBVIB_MASS, &a));
    WORKS("stiffness", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a));
    a = matrix(1, &damping);
    WORKS("damping", hbvib_model_set_matrix(model, HBVIB_DAMPING, &a));
    for (i = 0; i < 2; i++) {
        WORKS("face", hbvib_damper_face_init(&faces[i], sizeof faces[i]));
        faces[i].angle = i ? 0.7 : -0.7;
        faces[i].kt = 1;
        faces[i].kn = 1.5;
        faces[i].mu = i ? 0.15 : 0.6;
    }
    faces[1].dofs[0] = 0;
    WORKS("damper", hbvib_damper_init(&d, sizeof d));
    REFUSED("mass", hbvib_model_add_damper(model, &d, NULL, NULL), HBVIB_E_ARGUMENT, 2, "mass = 0");
    d.mass = 0.01;
    d.radius = 0.05;
    d.length = 0.2;
    d.orbit = 25;
    d.support[0] = 1e-3;
    d.support_damping[0] = 4e-3;
    REFUSED("faces", hbvib_model_add_damper(model, &d, NULL, NULL), HBVIB_E_ARGUMENT, 2, "without faces");
    d.faces = faces;
    d.faces_len = 2;
    faces[1].dofs[0] = far;
    REFUSED("dofs", hbvib_model_add_damper(model, &d, NULL, NULL), HBVIB_E_INDEX, 2, "faces[1]: dofs[0] = 9");
    faces[1].dofs[0] = 0;
    WORKS("add", hbvib_model_add_damper(model, &d, &dof, &contact));
    EXPECT("place", dof == 1 && contact == 0 && hbvib_model_dofs(model) == 4 && hbvib_model_contacts(model) == 2);
    WORKS("init", hbvib_contact_init(&c, sizeof c));
    WORKS("contact", hbvib_model_contact(model, 1, &c, NULL));
    EXPECT("contact", c.kind == HBVIB_FRICTION_2D && c.dof_a[0] == 1 && c.dof_b[0] == 0 && c.rotation[2] == 3 &&
                          c.rotation[0] == HBVIB_GROUND && fabs(c.arm[0] - 0.05 * sin(0.7)) < 1e-15);
    WORKS("fix", hbvib_model_fix(model, 1, &roll));
    REFUSED("dof", hbvib_model_add_centrifugal(model, far, 1), HBVIB_E_INDEX, 2, "dof");
    REFUSED("radius", hbvib_model_add_centrifugal(model, 2, NAN), HBVIB_E_NOT_FINITE, 3, "finite");
    WORKS("centrifugal", hbvib_model_add_centrifugal(model, 2, 0.05));
    WORKS("speed", hbvib_model_set_speed(model, 2));
    WORKS("force", hbvib_model_add_force(model, 0, 1, 0.1, 0));
    WORKS("init", hbvib_solver_options_init(&s, sizeof s));
    s.harmonics = 5;
    s.tolerance = 0;
    WORKS("init", hbvib_forced_options_init(&f, sizeof f));
    f.omega_start = 1.2;
    f.omega_stop = 1.2;
    WORKS("solve", hbvib_forced_response(model, &s, &f, NULL, &branch));
    WORKS("curve", hbvib_band_curve(model, branch, 0, NULL, &s, NULL, NULL, 2, omega, lower, upper, sliders, complete, &count));
    EXPECT("curve", count == 1 && omega[0] == 1.2 && lower[0] < upper[0] && sliders[0] == 1 && complete[0] == 1);
    REFUSED("capacity", hbvib_band_curve(model, branch, 0, NULL, &s, NULL, NULL, 0, omega, NULL, NULL, NULL, NULL, &count),
            HBVIB_E_DIMENSION, 8, "capacity = 0");
    REFUSED("point", hbvib_band_curve(model, branch, 1, &far, &s, NULL, NULL, 2, omega, NULL, NULL, NULL, NULL, &count),
            HBVIB_E_INDEX, 4, "points");
    WORKS("init", hbvib_band_options_init(&b, sizeof b));
    b.of = HBVIB_BAND_PEAK_OMEGA;
    REFUSED("of", hbvib_band_curve(model, branch, 0, NULL, &s, &b, NULL, 2, omega, NULL, NULL, NULL, NULL, &count),
            HBVIB_E_ARGUMENT, 6, "amplitude");
    WORKS("init", hbvib_time_options_init(&t, sizeof t));
    t.omega = 1.2;
    t.places = places;
    t.places_len = 1;
    REFUSED("places", hbvib_time_response(model, &t, NULL, NULL, 0, NULL, 0, NULL), HBVIB_E_DIMENSION, 2, "number of contacts");
    t.places_len = 2;
    WORKS("time", hbvib_time_response(model, &t, NULL, NULL, 0, NULL, 0, NULL));
    EXPECT("places", places[0] > 0 && places[0] < 9);
    {
        hbvib_branch *mode = NULL;
        hbvib_mode_options m;
        hbvib_band_info info;
        int64_t direction[4], own[4], third = 9;
        double ends[12], states[6];
        WORKS("init", hbvib_mode_options_init(&m, sizeof m));
        m.log10_start = -0.4;
        m.log10_stop = -0.35;
        s.max_points = 1;
        WORKS("speed", hbvib_model_clear_forces(model));
        WORKS("centrifugal", hbvib_model_add_centrifugal(model, 2, 0.25));
        EXPECT("mode", hbvib_nonlinear_mode(model, &s, &m, NULL, &mode) == HBVIB_STOPPED_MAX_POINTS);
        WORKS("init", hbvib_band_info_init(&info, sizeof info));
        WORKS("band", hbvib_mode_band(model, mode, 0, NULL, NULL, HBVIB_MODE_BAND_DAMPING, 0, NULL, NULL, &info, 4, own, direction, ends, 2,
                                      states));
        EXPECT("band", info.sliders == 1 && info.complete == 1 && own[0] == 0 && direction[0] == 0 && info.states > 10);
        EXPECT("ends", ends[5] == info.lower && ends[11] == info.upper && ends[4] == info.lower_omega && info.upper > 1.1 * info.lower);
        REFUSED("of", hbvib_mode_band(model, mode, 0, NULL, NULL, 2, 0, NULL, NULL, &info, 0, NULL, NULL, NULL, 0, NULL), HBVIB_E_ARGUMENT,
                6, "of = 2");
        REFUSED("contacts", hbvib_mode_band(model, mode, 0, NULL, NULL, 0, 1, &third, NULL, &info, 0, NULL, NULL, NULL, 0, NULL),
                HBVIB_E_INDEX, 8, "contacts");
        REFUSED("capacity", hbvib_mode_band(model, mode, 0, NULL, NULL, 0, 0, NULL, NULL, &info, 3, own, NULL, NULL, 0, NULL),
                HBVIB_E_DIMENSION, 11, "needs 4");
        REFUSED("response", hbvib_mode_band(model, branch, 0, NULL, NULL, 0, 0, NULL, NULL, &info, 0, NULL, NULL, NULL, 0, NULL),
                HBVIB_E_UNSUPPORTED, 0, "no nonlinear mode");
        WORKS("free", hbvib_branch_free(mode));
    }
    WORKS("free", hbvib_branch_free(branch));
    WORKS("free", hbvib_model_free(model));
    return failures > 0;
}
