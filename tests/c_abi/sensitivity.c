/* Derivatives by parameters in C, and what is refused. */
#include "common.h"

enum { H = 9 };

static hbvib_parameter parameter(int32_t kind, int64_t contact)
{
    hbvib_parameter p;
    if (hbvib_parameter_init(&p, sizeof p) != HBVIB_OK) abort();
    EXPECT("defaults", p.kind == HBVIB_PARAMETER_FORCE && p.contact == -1 && !p.direction && p.scaling == HBVIB_SCALING_ADDITIVE);
    p.kind = kind;
    p.contact = contact;
    return p;
}

static int32_t stop(void *user, const hbvib_phase_report *report)
{
    (void)user;
    (void)report;
    return 1;
}

int main(void)
{
    hbvib_model *model = NULL;
    hbvib_branch *branch = NULL;
    hbvib_contact contact;
    hbvib_solver_options solver;
    hbvib_forced_options range;
    hbvib_hooks hooks;
    hbvib_matrix direction;
    hbvib_parameter p[4], q;
    double values[4], omega, amplitude, one = 1.0;
    int64_t reasons[4], onset = 7, point, count;

    const double mass = 1, stiffness = 1, damping = 0.05;
    hbvib_matrix m = matrix(1, &mass), k = matrix(1, &stiffness), c = matrix(1, &damping);
    WORKS("model", hbvib_model_new(1, &model));
    WORKS("mass", hbvib_model_set_matrix(model, HBVIB_MASS, &m));
    WORKS("stiffness", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &k));
    WORKS("damping", hbvib_model_set_matrix(model, HBVIB_DAMPING, &c));
    WORKS("contact", hbvib_contact_init(&contact, sizeof contact));
    contact.kind = HBVIB_JENKINS;
    contact.dof_a[0] = 0;
    contact.kt = 1;
    contact.mu = 0.3;
    contact.preload = 1;
    WORKS("contact", hbvib_model_add_contact(model, &contact, NULL));
    WORKS("force", hbvib_model_add_force(model, 0, 1, 1, 0));
    WORKS("options", hbvib_solver_options_init(&solver, sizeof solver));
    WORKS("options", hbvib_forced_options_init(&range, sizeof range));
    solver.tolerance = 0;
    solver.harmonics = H;
    range.omega_start = 0.8;
    range.omega_stop = 1.6;
    WORKS("solve", hbvib_forced_response(model, &solver, &range, NULL, &branch));
    WORKS("peak", hbvib_branch_peaks(branch, 1, &omega, &amplitude, &point, &count));

    direction = matrix(1, &one);
    p[0] = parameter(HBVIB_PARAMETER_FORCE, -1);
    p[1] = parameter(HBVIB_PARAMETER_PRELOAD, 0);
    p[2] = parameter(HBVIB_PARAMETER_STIFFNESS, -1);
    p[2].direction = &direction;
    p[3] = parameter(HBVIB_PARAMETER_STIFFNESS, -1);
    p[3].scaling = HBVIB_SCALING_FACTOR;
    WORKS("derivatives", hbvib_sensitivity(model, branch, point, HBVIB_OF_PEAK_AMPLITUDE, p, 4, values, 4, reasons, &onset, NULL));
    EXPECT("scaling", fabs((values[0] + values[1]) / amplitude - 1) < 1e-9 && values[1] < 0);
    EXPECT("a stiffness of 1", values[2] == values[3] && values[2] < 0);
    EXPECT("reasons", reasons[0] == HBVIB_DERIVATIVE_EXISTS && reasons[3] == HBVIB_DERIVATIVE_EXISTS && onset == -1);
    WORKS("frequency", hbvib_sensitivity(model, branch, point, HBVIB_OF_PEAK_OMEGA, p, 4, values, 4, NULL, NULL, NULL));
    EXPECT("frequency", values[2] > 0 && fabs(values[0] + values[1]) < 1e-6);

    {
        hbvib_parameter_options o;
        hbvib_branch *study = NULL;
        double value[8], size[8];
        int64_t maximum[8], where[8], n;
        hbvib_view view;
        if (hbvib_parameter_options_init(&o, sizeof o) != HBVIB_OK || hbvib_view_init(&view, sizeof view) != HBVIB_OK) abort();
        REFUSED("no parameter", hbvib_parameter_response(model, &solver, &o, NULL, &study), HBVIB_E_NULL, 3, "parameter");
        o.parameter = &p[1];
        o.start = 1;
        o.stop = 3;
        o.omega = omega;
        o.follow = HBVIB_FOLLOW_PEAK;
        WORKS("study", hbvib_parameter_response(model, &solver, &o, NULL, &study));
        WORKS("field", hbvib_branch_field(study, HBVIB_PARAMETER_VALUE, &view));
        EXPECT("field", view.data[0] == 1 && view.data[view.shape[0] - 1] == 3);
        WORKS("optima", hbvib_branch_optima(study, 8, value, size, maximum, where, &n));
        EXPECT("optima", n <= 8);
        REFUSED("no parameter", hbvib_branch_field(branch, HBVIB_D_AMPLITUDE, &view), HBVIB_E_ARGUMENT, 2, "parameter response");
        REFUSED("models", hbvib_sensitivity(model, study, 0, 0, p, 1, values, 1, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 0, "model of its own");
        WORKS("free", hbvib_branch_free(study));
        o.follow = HBVIB_FOLLOW_PEAK_THROUGH_FOLDS;
        WORKS("through folds", hbvib_parameter_response(model, &solver, &o, NULL, &study));
        WORKS("turns", hbvib_branch_turns(study, 8, value, size, size, maximum, where, &n));
        EXPECT("turns", n == 0);
        WORKS("free", hbvib_branch_free(study));
        o.follow = 5;
        REFUSED("follow", hbvib_parameter_response(model, &solver, &o, NULL, &study), HBVIB_E_ARGUMENT, 3, "follow = 5");
        o.follow = HBVIB_FOLLOW_FOLD;
        REFUSED("no fold", hbvib_parameter_response(model, &solver, &o, NULL, &study), HBVIB_E_NO_CONVERGENCE, 0, "no fold");
        o.follow = HBVIB_FOLLOW_OMEGA;
        solver.tolerance = 1e-3;
        WORKS("tolerance", hbvib_parameter_response(model, &solver, &o, NULL, &study));
        REFUSED("no mode", hbvib_branch_field(study, HBVIB_D_DAMPING, &view), HBVIB_E_ARGUMENT, 2, "of a mode");
        WORKS("no higher peak", hbvib_branch_higher_peaks(study, 8, value, size, NULL, where, &n));
        EXPECT("no higher peak", n == 0);
        WORKS("free", hbvib_branch_free(study));
        o.follow = HBVIB_FOLLOW_MODE_MAX_DAMPING;
        WORKS("damping", hbvib_parameter_response(model, &solver, &o, NULL, &study));
        WORKS("its derivative", hbvib_branch_field(study, HBVIB_D_DAMPING, &view));
        /* By similarity the largest damping ratio does not depend on the normal load. */
        EXPECT("its derivative", fabs(view.data[0]) < 1e-10);
        WORKS("free", hbvib_branch_free(study));
    }
    REFUSED("no peak", hbvib_sensitivity(model, branch, 0, HBVIB_OF_PEAK_OMEGA, p, 4, values, 4, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 0, "no peak");
    REFUSED("of", hbvib_sensitivity(model, branch, 0, 5, p, 4, values, 4, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 4, "of = 5");
    REFUSED("point", hbvib_sensitivity(model, branch, 9999, 0, p, 4, values, 4, NULL, NULL, NULL), HBVIB_E_INDEX, 3, "point");
    REFUSED("count", hbvib_sensitivity(model, branch, 0, 0, p, 0, values, 0, NULL, NULL, NULL), HBVIB_E_DIMENSION, 6, "count = 0");
    REFUSED("length", hbvib_sensitivity(model, branch, 0, 0, p, 4, values, 3, NULL, NULL, NULL), HBVIB_E_DIMENSION, 8, "needs count = 4");
    REFUSED("NULL", hbvib_sensitivity(model, branch, 0, 0, NULL, 4, values, 4, NULL, NULL, NULL), HBVIB_E_NULL, 5, "parameters");
    q = parameter(HBVIB_PARAMETER_KN, 0);
    REFUSED("kn", hbvib_sensitivity(model, branch, 0, 0, &q, 1, values, 1, NULL, NULL, NULL), HBVIB_E_UNSUPPORTED, 5, "kn of contact 0");
    q = parameter(HBVIB_PARAMETER_KT, 3);
    REFUSED("kt", hbvib_sensitivity(model, branch, 0, 0, &q, 1, values, 1, NULL, NULL, NULL), HBVIB_E_INDEX, 5, "contact 3");
    q = parameter(HBVIB_PARAMETER_SPEED, 0);
    REFUSED("speed", hbvib_sensitivity(model, branch, 0, 0, &q, 1, values, 1, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 5, "contact = 0");
    q = parameter(HBVIB_PARAMETER_MASS, -1);
    REFUSED("mass", hbvib_sensitivity(model, branch, 0, 0, &q, 1, values, 1, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 5, "direction is NULL");
    q.scaling = 2;
    REFUSED("scaling", hbvib_sensitivity(model, branch, 0, 0, &q, 1, values, 1, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 5, "scaling = 2");
    q.scaling = HBVIB_SCALING_FACTOR;
    q.direction = &direction;
    REFUSED("direction", hbvib_sensitivity(model, branch, 0, 0, &q, 1, values, 1, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 5, "needs NULL with");
    q = parameter(HBVIB_PARAMETER_FORCE, -1);
    q.direction = &direction;
    REFUSED("direction", hbvib_sensitivity(model, branch, 0, 0, &q, 1, values, 1, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 5, "no matrix");
    q = parameter(HBVIB_PARAMETER_KT, -2);
    REFUSED("contact", hbvib_sensitivity(model, branch, 0, 0, &q, 1, values, 1, NULL, NULL, NULL), HBVIB_E_INDEX, 5, "contact = -2");
    q = parameter(12, -1);
    REFUSED("kind", hbvib_sensitivity(model, branch, 0, 0, &q, 1, values, 1, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 5, "kind = 12");

    if (hbvib_hooks_init(&hooks, sizeof hooks) != HBVIB_OK) abort();
    hooks.phase = stop;
    values[0] = 7;
    EXPECT("stop", hbvib_sensitivity(model, branch, point, 0, p, 1, values, 1, NULL, NULL, &hooks) == HBVIB_STOPPED_BY_CALLER && values[0] == 7);

    WORKS("free", hbvib_branch_free(branch));
    WORKS("free", hbvib_model_free(model));
    return verdict(56);
}
