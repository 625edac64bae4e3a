/* Floquet multipliers of points of forced responses, and what is refused. */
#include "common.h"

enum { H = 9, MOST = 24 * (2 * NDOF + 1) };

static hbvib_floquet_options floquet_options(void)
{
    hbvib_floquet_options o;
    if (hbvib_floquet_options_init(&o, sizeof o) != HBVIB_OK) abort();
    return o;
}

static hbvib_floquet_info floquet_info(void)
{
    hbvib_floquet_info i;
    if (hbvib_floquet_info_init(&i, sizeof i) != HBVIB_OK) abort();
    return i;
}

static int32_t stop_at_once(void *user, const hbvib_progress *p)
{
    (void)user;
    (void)p;
    return 1;
}

static void are_those_of_the_reference(hbvib_branch *branch)
{
    hbvib_floquet_options o = floquet_options();
    hbvib_floquet_info i = floquet_info();
    double mu[2 * MOST];
    int64_t classes[MOST], k, ordinary = 0;

    EXPECT("defaults", o.waves == HBVIB_WAVES_WAVE && o.refine == 1 && o.tolerance == 1e-11 && o.max_periods == 10000);
    EXPECT("defaults", i.grazing == HBVIB_GRAZING_NONE && i.grazing_contact == -1);
    WORKS("wave", hbvib_floquet(the_model, branch, 0, NULL, NULL, mu, MOST, classes, MOST, &i));
    EXPECT("wave", fabs(i.radius - 0.993431437676) < 1e-8 && i.count == 54 && i.unstable == 0 && i.neutral == 0);
    EXPECT("wave", fabs(hypot(mu[0], mu[1]) - i.radius) < 1e-14 && i.orbit_change > 0 && i.orbit_change < 0.1);
    o.waves = HBVIB_WAVES_WHEEL;
    WORKS("wheel", hbvib_floquet(the_model, branch, 0, &o, NULL, mu, MOST, classes, MOST, &i));
    EXPECT("wheel", fabs(i.radius - 0.998436261437) < 1e-8 && i.count == MOST && i.neutral == 1);
    EXPECT("wheel", classes[0] == HBVIB_MULTIPLIER_NEUTRAL_RIGID && mu[0] == 1 && mu[1] == 0);
    for (k = 0; k < MOST; k++) ordinary += classes[k] == HBVIB_MULTIPLIER_ORDINARY;
    EXPECT("wheel", ordinary == MOST - 25 && classes[MOST - 1] == HBVIB_MULTIPLIER_MEMORY);
    WORKS("a few", hbvib_floquet(the_model, branch, 0, &o, NULL, mu, 2, NULL, 0, NULL));
    EXPECT("a few", fabs(hypot(mu[2], mu[3]) - i.radius) < 1e-12);
}

static void refuse(hbvib_branch *branch)
{
    hbvib_floquet_options o = floquet_options(), good = o;
    hbvib_floquet_info i = floquet_info();
    hbvib_hooks hooks;
    double mu[2];

    REFUSED("point", hbvib_floquet(the_model, branch, 9, &o, NULL, NULL, 0, NULL, 0, &i), HBVIB_E_INDEX, 3, "point = 9");
    o.waves = 2;
    REFUSED("waves", hbvib_floquet(the_model, branch, 0, &o, NULL, NULL, 0, NULL, 0, &i), HBVIB_E_ARGUMENT, 4, "waves = 2");
    o = good;
    o.refine = 2;
    REFUSED("refine", hbvib_floquet(the_model, branch, 0, &o, NULL, NULL, 0, NULL, 0, &i), HBVIB_E_ARGUMENT, 4, "refine = 2");
    o = good;
    o.modes = -2;
    REFUSED("modes", hbvib_floquet(the_model, branch, 0, &o, NULL, NULL, 0, NULL, 0, &i), HBVIB_E_ARGUMENT, 4, "modes = -2");
    o = good;
    o.tolerance = 0;
    REFUSED("tolerance", hbvib_floquet(the_model, branch, 0, &o, NULL, NULL, 0, NULL, 0, &i), HBVIB_E_ARGUMENT, 4, "tolerance = 0");
    REFUSED("NULL with a length", hbvib_floquet(the_model, branch, 0, NULL, NULL, NULL, 1, NULL, 0, &i), HBVIB_E_DIMENSION, 7,
            "multipliers_len = 1");
    if (hbvib_hooks_init(&hooks, sizeof hooks) != HBVIB_OK) abort();
    hooks.progress = stop_at_once;
    EXPECT("hooks", hbvib_floquet(the_model, branch, 0, NULL, &hooks, mu, 1, NULL, 0, &i) == HBVIB_STOPPED_BY_CALLER);
    EXPECT("hooks", i.count == 0 && i.radius != i.radius);
}

/* With negative damping, C = beta K - alpha M, the ring damper has two limit cycles. */
static void limit_cycles(void)
{
    hbvib_solver_options s = solver_options();
    hbvib_mode_options o;
    hbvib_floquet_info i = floquet_info();
    hbvib_model *model = ring_damper();
    hbvib_branch *branch = NULL;
    double omega[2], amplitude[2], slope[2];
    int64_t point[2], count = -1;

    WORKS("damping", hbvib_model_set_rayleigh(model, -7, 1.5e-6));
    WORKS("options", hbvib_mode_options_init(&o, sizeof o));
    o.log10_start = -6;
    o.log10_stop = -1;
    s.tolerance = 0;
    s.harmonics = 31;
    WORKS("mode", hbvib_nonlinear_mode(model, &s, &o, NULL, &branch));
    WORKS("count", hbvib_branch_limit_cycles(branch, 0, NULL, NULL, NULL, NULL, &count));
    EXPECT("count", count == 2);
    WORKS("cycles", hbvib_branch_limit_cycles(branch, 2, omega, amplitude, slope, point, &count));
    EXPECT("cycles", slope[0] > 0 && slope[1] < 0 && amplitude[0] < amplitude[1] && omega[0] > omega[1]);
    WORKS("stability", hbvib_floquet(model, branch, point[0], NULL, NULL, NULL, 0, NULL, 0, &i));
    EXPECT("stability", i.unstable > 0 && fabs(i.radius - 1.009943) < 1e-5 && fabs(i.omega / omega[0] - 1) < 1e-4);
    EXPECT("room", hbvib_branch_limit_cycles(branch, 1, omega, NULL, NULL, NULL, &count) == HBVIB_E_DIMENSION && count == 2);
    EXPECT("null", hbvib_branch_limit_cycles(branch, 2, omega, amplitude, slope, point, NULL) == HBVIB_E_NULL);
    EXPECT("no cycle", hbvib_floquet(model, branch, 0, NULL, NULL, NULL, 0, NULL, 0, &i) == HBVIB_E_UNSUPPORTED);
    WORKS("free", hbvib_branch_free(branch));
    WORKS("free", hbvib_model_free(model));
}

/* A hardening spring has three motions: a kick leads from the lowest one across the middle one. */
static void kicks(void)
{
    hbvib_solver_options s = solver_options();
    hbvib_forced_options o = frequencies(1, 1);
    hbvib_model *model = NULL;
    hbvib_branch *branch = NULL;
    hbvib_contact c;
    hbvib_matrix m;
    hbvib_kick kick;
    double mass = 1, damping = 0.1, at = 1.1017664364;
    int64_t point[4], count = 0;

    WORKS("model", hbvib_model_new(1, &model));
    m = matrix(1, &mass);
    WORKS("mass", hbvib_model_set_matrix(model, HBVIB_MASS, &m));
    WORKS("stiffness", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &m));
    m = matrix(1, &damping);
    WORKS("damping", hbvib_model_set_matrix(model, HBVIB_DAMPING, &m));
    WORKS("contact", hbvib_contact_init(&c, sizeof c));
    c.kind = HBVIB_CUBIC;
    c.dof_a[0] = 0;
    c.cubic = 0.1;
    WORKS("contact", hbvib_model_add_contact(model, &c, NULL));
    WORKS("force", hbvib_model_add_force(model, 0, 1, 0.18, 0));
    s.tolerance = 0;
    s.harmonics = 7;
    o.omega_start = 0.9;
    o.omega_stop = 1.3;
    o.at = &at;
    o.at_len = 1;
    WORKS("solve", hbvib_forced_response(model, &s, &o, NULL, &branch));
    WORKS("motions", hbvib_branch_at(branch, 0, 4, NULL, point, &count));
    EXPECT("three motions", count == 3);
    WORKS("kick", hbvib_kick_init(&kick, sizeof kick));
    WORKS("kick", hbvib_smallest_kick(model, branch, point[2], branch, point[1], 0, 4, NULL, &kick));
    EXPECT("kick", kick.verified == 1 && kick.multiplier > 1 && fabs(kick.returning) < fabs(kick.impulse));
    EXPECT("kick", fabs(kick.velocity - kick.impulse) < 1e-12);
    REFUSED("no saddle", hbvib_smallest_kick(model, branch, point[2], branch, point[0], 0, 4, NULL, &kick), HBVIB_E_ARGUMENT, 0, "one unstable direction");
    REFUSED("dof", hbvib_smallest_kick(model, branch, point[2], branch, point[1], 1, 4, NULL, &kick), HBVIB_E_INDEX, 6, "dof = 1");
    REFUSED("phases", hbvib_smallest_kick(model, branch, point[2], branch, point[1], 0, -1, NULL, &kick), HBVIB_E_ARGUMENT, 7, "phases = -1");
    WORKS("free", hbvib_branch_free(branch));
    WORKS("free", hbvib_model_free(model));
}

/* A mass against a stop that it touches at rest doubles its period. */
static void children(void)
{
    hbvib_solver_options s = solver_options();
    hbvib_forced_options o = frequencies(1, 1);
    hbvib_model *model = NULL, *longer = NULL;
    hbvib_branch *branch = NULL, *child = NULL, *same = NULL;
    hbvib_contact c;
    hbvib_descent d;
    hbvib_searched searched;
    hbvib_matrix m;
    double mass = 1, stiffness = 1, damping = 0.05;

    WORKS("model", hbvib_model_new(1, &model));
    m = matrix(1, &mass);
    WORKS("mass", hbvib_model_set_matrix(model, HBVIB_MASS, &m));
    m = matrix(1, &stiffness);
    WORKS("stiffness", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &m));
    m = matrix(1, &damping);
    WORKS("damping", hbvib_model_set_matrix(model, HBVIB_DAMPING, &m));
    WORKS("contact", hbvib_contact_init(&c, sizeof c));
    c.kind = HBVIB_UNILATERAL;
    c.dof_a[2] = 0;
    c.kn = 10;
    WORKS("contact", hbvib_model_add_contact(model, &c, NULL));
    WORKS("force", hbvib_model_add_force(model, 0, 1, 1, 0));
    s.tolerance = 0;
    s.harmonics = 9;
    o.omega_start = 2.3;
    o.omega_stop = 2.4;
    EXPECT("defaults", o.branches == 0 && o.branch_depth == 0 && o.most_branches == 0);
    o.branch_depth = 2;
    REFUSED("depth alone", hbvib_forced_response(model, &s, &o, NULL, &branch), HBVIB_E_ARGUMENT, 3, "branch_depth = 2 with branches = 0");
    o.branch_depth = 0;
    o.most_branches = 7;
    REFUSED("most alone", hbvib_forced_response(model, &s, &o, NULL, &branch), HBVIB_E_ARGUMENT, 3, "most_branches = 7 with branches = 0");
    o.most_branches = 0;
    o.branches = 1;
    {
        const double stop = o.omega_stop;
        o.omega_stop = o.omega_start;
        REFUSED("one frequency", hbvib_forced_response(model, &s, &o, NULL, &branch), HBVIB_E_ARGUMENT, 3, "branches = 1 at the single");
        o.omega_stop = stop;
    }
    o.branches = 0;
    s.stability = HBVIB_STABILITY_WHEEL;
    REFUSED("no wheel", hbvib_forced_response(model, &s, &o, NULL, &branch), HBVIB_E_ARGUMENT, 2, "stability = wheel, needs a cyclic model");
    s.stability = HBVIB_STABILITY_NONE;
    o.branches = 5;
    REFUSED("branches", hbvib_forced_response(model, &s, &o, NULL, &branch), HBVIB_E_ARGUMENT, 3, "branches = 5");
    o.branches = 1;
    o.branch_depth = 9;
    REFUSED("depth", hbvib_forced_response(model, &s, &o, NULL, &branch), HBVIB_E_ARGUMENT, 3, "branch_depth = 9");
    o.branch_depth = 1;
    o.most_branches = -1;
    REFUSED("most", hbvib_forced_response(model, &s, &o, NULL, &branch), HBVIB_E_ARGUMENT, 3, "most_branches = -1");
    o.most_branches = 4;
    WORKS("solve", hbvib_forced_response(model, &s, &o, NULL, &branch));
    EXPECT("count", hbvib_branch_children(branch) == 1);
    WORKS("child", hbvib_branch_child(branch, 0, &child));
    WORKS("child", hbvib_branch_child(branch, 0, &same));
    EXPECT("same", child == same && child != branch && hbvib_branch_points(child) > 3 && hbvib_branch_children(child) == 0);
    REFUSED("number", hbvib_branch_child(branch, 1, &same), HBVIB_E_INDEX, 2, "number = 1");
    EXPECT("null", hbvib_branch_child(branch, 0, NULL) == HBVIB_E_NULL);
    WORKS("descent", hbvib_descent_init(&d, sizeof d));
    EXPECT("defaults", d.kind == -1 && d.bifurcation == -1 && d.periods == 1 && d.mode == -1);
    WORKS("descent", hbvib_branch_descent(child, &d));
    EXPECT("descent", d.kind == HBVIB_BIFURCATION_PERIOD_DOUBLING && d.bifurcation == 0 && d.periods == 2 && d.merges_at == 0);
    WORKS("descent", hbvib_branch_descent(branch, &d));
    EXPECT("descent", d.bifurcation == -1 && d.periods == 1);
    WORKS("searched", hbvib_searched_init(&searched, sizeof searched));
    WORKS("searched", hbvib_branch_searched(branch, &searched));
    EXPECT("searched", searched.bifurcations == 1 && searched.lost == 0 && searched.modes == 0);
    EXPECT("searched", searched.force_curves == 0 && searched.deflations == 0);
    WORKS("longer", hbvib_model_longer_period(model, 2, &longer));
    WORKS("stability", hbvib_floquet(longer, child, 3, NULL, NULL, NULL, 0, NULL, 0, NULL));
    REFUSED("periods", hbvib_model_longer_period(model, 0, &longer), HBVIB_E_ARGUMENT, 2, "periods = 0");
    REFUSED("free", hbvib_branch_free(child), HBVIB_E_ARGUMENT, 1, "child");
    WORKS("free", hbvib_branch_free(branch));
    EXPECT("freed", hbvib_branch_points(child) == HBVIB_E_HANDLE);
    WORKS("free", hbvib_model_free(longer));
    WORKS("free", hbvib_model_free(model));
}

/* A Duffing oscillator is unstable between its folds. */
static void along_a_branch(void)
{
    hbvib_solver_options s = solver_options();
    hbvib_forced_options o;
    hbvib_view view;
    hbvib_model *model = NULL;
    hbvib_branch *branch = NULL;
    hbvib_contact c;
    double one = 1, damping = 0.1, omega[2];
    int64_t kind[2] = {-1, -1}, before[2], after[2], count = -1, k;
    hbvib_matrix m;

    WORKS("options", hbvib_forced_options_init(&o, sizeof o));
    WORKS("view", hbvib_view_init(&view, sizeof view));
    WORKS("model", hbvib_model_new(1, &model));
    m = matrix(1, &one);
    WORKS("mass", hbvib_model_set_matrix(model, HBVIB_MASS, &m));
    WORKS("stiffness", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &m));
    m = matrix(1, &damping);
    WORKS("damping", hbvib_model_set_matrix(model, HBVIB_DAMPING, &m));
    WORKS("contact", hbvib_contact_init(&c, sizeof c));
    c.kind = HBVIB_CUBIC;
    c.dof_a[0] = 0;
    c.cubic = 0.1;
    WORKS("contact", hbvib_model_add_contact(model, &c, NULL));
    WORKS("force", hbvib_model_add_force(model, 0, 1, 0.18, 0));
    o.omega_start = 0.9;
    o.omega_stop = 1.3;
    s.tolerance = 0;
    s.stability = 3;
    REFUSED("option", hbvib_forced_response(model, &s, &o, NULL, &branch), HBVIB_E_ARGUMENT, 2, "stability = 3");
    s.stability = HBVIB_STABILITY_WAVE;
    WORKS("solve", hbvib_forced_response(model, &s, &o, NULL, &branch));
    WORKS("list", hbvib_branch_bifurcations(branch, 2, omega, NULL, kind, NULL, before, after, &count));
    EXPECT("list", count == 2 && kind[0] == HBVIB_BIFURCATION_FOLD && kind[1] == HBVIB_BIFURCATION_FOLD);
    EXPECT("list", before[0] == 0 && after[0] == 1 && before[1] == 1 && after[1] == 0 && omega[0] > omega[1]);
    EXPECT("room", hbvib_branch_bifurcations(branch, 1, omega, NULL, NULL, NULL, NULL, NULL, &count) == HBVIB_E_DIMENSION);
    WORKS("field", hbvib_branch_field(branch, HBVIB_UNSTABLE_DIRECTIONS, &view));
    EXPECT("field", view.shape[0] == hbvib_branch_points(branch) && view.data[0] == 0);
    for (count = 0, k = 0; k < view.shape[0]; k++) count += view.data[k] == 1;
    EXPECT("field", count > 0 && count < view.shape[0]);
    WORKS("free", hbvib_branch_free(branch));
    s.stability = HBVIB_STABILITY_NONE;
    WORKS("solve", hbvib_forced_response(model, &s, &o, NULL, &branch));
    REFUSED("field", hbvib_branch_field(branch, HBVIB_FLOQUET_RADIUS, &view), HBVIB_E_ARGUMENT, 2, "stability");
    WORKS("free", hbvib_branch_free(branch));
    WORKS("free", hbvib_model_free(model));
}

int main(void)
{
    hbvib_solver_options s = solver_options();
    hbvib_forced_options o = frequencies(208.85, 208.85);
    hbvib_branch *branch = NULL;

    begin();
    s.tolerance = 0;
    s.harmonics = H;
    WORKS("solve", hbvib_forced_response(the_model, &s, &o, NULL, &branch));
    are_those_of_the_reference(branch);
    refuse(branch);
    limit_cycles();
    kicks();
    children();
    along_a_branch();
    WORKS("free", hbvib_branch_free(branch));
    WORKS("free", hbvib_model_free(the_model));
    return verdict(20);
}
