/* Residual forces: the place of a slider, the freedom of contacts that stick, and the band of a response; refusals. */
#include "common.h"

static int stop(void *user, const hbvib_phase_report *report)
{
    (void)user;
    (void)report;
    return 1;
}

/* A face of a wedge damper (u, v) against the platform or the blade q. */
static void face(hbvib_model *model, int64_t blade, double side, double mu)
{
    hbvib_contact c;
    WORKS("init", hbvib_contact_init(&c, sizeof c));
    c.kind = HBVIB_FRICTION_2D;
    c.dof_a[0] = 1;
    c.dof_a[1] = 2;
    c.dof_b[0] = blade;
    c.kt = 1;
    c.kn = 1.5;
    c.mu = mu;
    c.normal[0] = side;
    c.normal[1] = -1;
    c.tangent[0] = 1;
    c.tangent[1] = side;
    WORKS("contact", hbvib_model_add_contact(model, &c, NULL));
}

static hbvib_model *wedge(void)
{
    const double m[9] = {1, 0, 0, 0, 0.01, 0, 0, 0, 0.01}, d[9] = {0.04, 0, 0, 0, 0.004, 0, 0, 0, 0.004};
    const double k[9] = {1, 0, 0, 0, 1e-3, 0, 0, 0, 1e-3};
    hbvib_model *model = NULL;
    hbvib_matrix a = matrix(3, m);
    WORKS("model", hbvib_model_new(3, &model));
    WORKS("mass", hbvib_model_set_matrix(model, HBVIB_MASS, &a));
    a = matrix(3, d);
    WORKS("damping", hbvib_model_set_matrix(model, HBVIB_DAMPING, &a));
    a = matrix(3, k);
    WORKS("stiffness", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a));
    face(model, HBVIB_GROUND, 1, 0.6);
    face(model, 0, -1, 0.15);
    WORKS("outward", hbvib_model_add_force(model, 2, 0, 1, 0));
    WORKS("force", hbvib_model_add_force(model, 0, 1, 0.02, 0));
    return model;
}

int main(void)
{
    hbvib_model *model = wedge();
    hbvib_solver_options s;
    hbvib_forced_options o;
    hbvib_band_options b;
    hbvib_band_info info;
    hbvib_hooks hooks;
    hbvib_branch *branch = NULL, *ends[2] = {NULL, NULL};
    int64_t peak[4], peaks = 0, contact[4] = {7, 7, 7, 7}, direction[4], count = 0, none = 5, one = 1;
    double omega[4], amplitude[4], place[4], derivative[4], low[4], high[4], states[4 * 64], found;

    WORKS("init", hbvib_solver_options_init(&s, sizeof s));
    s.tolerance = 0;
    s.harmonics = 15;
    WORKS("init", hbvib_forced_options_init(&o, sizeof o));
    o.omega_start = 1.2;
    o.omega_stop = 1.3;
    WORKS("solve", hbvib_forced_response(model, &s, &o, NULL, &branch));
    WORKS("peaks", hbvib_branch_peaks(branch, 4, omega, amplitude, peak, &peaks));
    EXPECT("peaks", peaks == 1);

    WORKS("count", hbvib_branch_freedom(model, branch, peak[0], 0, NULL, NULL, NULL, NULL, &count, NULL));
    EXPECT("count", count == 1);
    WORKS("freedom", hbvib_branch_freedom(model, branch, peak[0], 4, contact, direction, place, derivative, &count, NULL));
    EXPECT("freedom", contact[0] == 0 && direction[0] == 0 && contact[1] == 7 && fabs(place[0] - 0.134) < 2e-3);
    EXPECT("freedom", derivative[0] > 0.1 && derivative[0] < 0.2);

    /* The freedom of all points with the branch. */
    {
        hbvib_branch *all = NULL;
        hbvib_view count_of, by_place, amplitudes;
        hbvib_solver_options with = s;
        WORKS("view", hbvib_view_init(&count_of, sizeof count_of));
        WORKS("view", hbvib_view_init(&by_place, sizeof by_place));
        WORKS("view", hbvib_view_init(&amplitudes, sizeof amplitudes));
        REFUSED("field", hbvib_branch_field(branch, HBVIB_FREE_SLIDERS, &count_of), HBVIB_E_ARGUMENT, 2, "freedom");
        with.freedom = 1;
        WORKS("solve", hbvib_forced_response(model, &with, &o, NULL, &all));
        WORKS("field", hbvib_branch_stored_field(all, HBVIB_FREE_SLIDERS, &count_of));
        WORKS("field", hbvib_branch_stored_field(all, HBVIB_D_AMPLITUDE_BY_PLACE, &by_place));
        WORKS("field", hbvib_branch_stored_field(branch, HBVIB_AMPLITUDE, &amplitudes));
        EXPECT("shape", count_of.rank == 1 && count_of.shape[0] == amplitudes.shape[0]);
        EXPECT("shape", by_place.rank == 3 && by_place.shape[0] == count_of.shape[0] && by_place.shape[1] == 2 && by_place.shape[2] == 2);
        EXPECT("columns", count_of.data[peak[0]] == 1 && fabs(by_place.data[4 * peak[0]] - derivative[0]) < 1e-9);
        EXPECT("not free", isnan(by_place.data[4 * peak[0] + 1]) && isnan(by_place.data[4 * peak[0] + 2]));
        WORKS("free", hbvib_branch_free(all));
    }

    WORKS("init", hbvib_band_options_init(&b, sizeof b));
    EXPECT("init", b.of == HBVIB_BAND_AMPLITUDE && b.starts == 3);
    WORKS("init", hbvib_band_info_init(&info, sizeof info));
    b.of = HBVIB_BAND_PEAK_AMPLITUDE;
    WORKS("band", hbvib_band(model, branch, peak[0], &s, &b, NULL, &info, 4, contact, direction, low, high, 64, states,
                             &ends[0], &ends[1]));
    EXPECT("band", info.complete == 1 && info.sliders == 1 && info.states > 4 && info.states < 64 && info.solved > 0);
    EXPECT("band", fabs(info.lower - 0.17125) < 1e-3 && fabs(info.upper - 0.3836) < 2e-3);
    EXPECT("limits", info.lower_at_limit == 1 && info.upper_at_limit == 1 && info.lower_gain == 0);
    EXPECT("states", fabs(states[0] - low[0]) < 1e-12 && fabs(states[1] - info.lower) < 1e-12);
    EXPECT("states", fabs(states[4 * (info.states - 1)] - high[0]) < 1e-12 && states[3] == info.lower_omega);
    EXPECT("ends", ends[0] != NULL && ends[1] != NULL && hbvib_branch_points(ends[1]) == 1);

    /* The end is the solution of the model with its slider there. */
    WORKS("slider", hbvib_model_set_slider(model, 0, 0, high[0]));
    o.omega_start = o.omega_stop = info.upper_omega;
    WORKS("free", hbvib_branch_free(branch));
    WORKS("solve", hbvib_forced_response(model, &s, &o, NULL, &branch));
    {
        hbvib_view view;
        WORKS("view", hbvib_view_init(&view, sizeof view));
        WORKS("view", hbvib_branch_field(branch, HBVIB_AMPLITUDE, &view));
        found = *(const double *)view.data;
    }
    EXPECT("upper", fabs(found / info.upper - 1) < 1e-6);
    WORKS("branch", hbvib_branch_freedom(model, ends[1], 0, 4, NULL, NULL, place, NULL, &count, NULL));
    EXPECT("place", fabs(place[0] - high[0]) < 1e-6);

    REFUSED("id", hbvib_model_set_slider(model, 2, 0, 0.1), HBVIB_E_INDEX, 2, "id");
    REFUSED("direction", hbvib_model_set_slider(model, 0, 2, 0.1), HBVIB_E_INDEX, 3, "direction");
    REFUSED("t2", hbvib_model_set_slider(model, 0, 1, 0.1), HBVIB_E_UNSUPPORTED, 3, "slider_t2");
    REFUSED("place", hbvib_model_set_slider(model, 0, 0, NAN), HBVIB_E_NOT_FINITE, 4, "finite");
    REFUSED("point", hbvib_branch_freedom(model, branch, 9, 0, NULL, NULL, NULL, NULL, &count, NULL), HBVIB_E_INDEX, 3, "point");
    REFUSED("capacity", hbvib_branch_freedom(model, branch, 0, 0, contact, NULL, NULL, NULL, &count, NULL), HBVIB_E_DIMENSION, 4,
            "capacity = 0");
    REFUSED("capacity", hbvib_band(model, branch, 0, &s, NULL, NULL, &info, 3, contact, NULL, NULL, NULL, 0, NULL, NULL, NULL),
            HBVIB_E_DIMENSION, 8, "needs 4");
    REFUSED("no peak", hbvib_band(model, branch, 0, &s, &b, NULL, &info, 0, NULL, NULL, NULL, NULL, 0, NULL, NULL, NULL),
            HBVIB_E_ARGUMENT, 5, "no peak");
    b.of = 3;
    REFUSED("of", hbvib_band(model, branch, 0, &s, &b, NULL, &info, 0, NULL, NULL, NULL, NULL, 0, NULL, NULL, NULL),
            HBVIB_E_ARGUMENT, 5, "of = 3");
    b.of = HBVIB_BAND_AMPLITUDE;
    b.contacts = &none;
    b.contacts_len = 1;
    REFUSED("contacts", hbvib_band(model, branch, 0, &s, &b, NULL, &info, 0, NULL, NULL, NULL, NULL, 0, NULL, NULL, NULL),
            HBVIB_E_INDEX, 5, "contacts");
    b.contacts = &one;
    WORKS("free", hbvib_branch_free(ends[0]));
    WORKS("no freedom", hbvib_band(model, branch, 0, &s, &b, NULL, &info, 0, NULL, NULL, NULL, NULL, 0, NULL, &ends[0], NULL));
    EXPECT("no freedom", info.sliders == 0 && info.lower == info.upper && ends[0] == NULL);
    b.contacts_len = 0;
    b.contacts = NULL;
    b.starts = 0;
    REFUSED("starts", hbvib_band(model, branch, 0, &s, &b, NULL, &info, 0, NULL, NULL, NULL, NULL, 0, NULL, NULL, NULL),
            HBVIB_E_ARGUMENT, 5, "starts = 0");
    WORKS("init", hbvib_hooks_init(&hooks, sizeof hooks));
    hooks.phase = stop;
    EXPECT("stop", hbvib_band(model, branch, 0, &s, NULL, &hooks, &info, 0, NULL, NULL, NULL, NULL, 0, NULL, NULL, NULL) ==
                       HBVIB_STOPPED_BY_CALLER);

    {
        const double factors[2] = {1, 0.5};
        double motion[6], places[8], forces[12];
        WORKS("history", hbvib_static_history(model, &s, 2, factors, NULL, NULL, motion, 6, places, 8, forces, 12));
        EXPECT("history", forces[2] < 0 && forces[8] > forces[2] && motion[5] < motion[2] && places[1] == 0);
        REFUSED("steps", hbvib_static_history(model, &s, 0, factors, NULL, NULL, motion, 6, NULL, 0, NULL, 0), HBVIB_E_DIMENSION, 3,
                "steps = 0");
        REFUSED("length", hbvib_static_history(model, &s, 2, factors, NULL, NULL, motion, 5, NULL, 0, NULL, 0), HBVIB_E_DIMENSION, 8,
                "length = 5");
        REFUSED("factors", hbvib_static_history(model, &s, 2, NULL, NULL, NULL, motion, 6, NULL, 0, NULL, 0), HBVIB_E_DIMENSION, 3,
                "neither");
    }
    WORKS("free", hbvib_branch_free(ends[1]));
    WORKS("free", hbvib_branch_free(branch));
    WORKS("free", hbvib_model_free(model));
    return failures > 0;
}
