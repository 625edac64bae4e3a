/* Nonlinear modes: reference numbers, how the mode is chosen, losses, hooks. The arguments are two
 * rows of reference data for H = 3 (amplitude over the slip limit's displacement, angular frequency,
 * damping ratio), then the largest damping ratio. */
#include "common.h"

static double unit_of_length(void)
{
    hbvib_contact c = ring_contact();
    return c.mu * c.preload / c.kt;
}

static hbvib_model *undamped(void)
{
    hbvib_model *model = ring_damper();
    if (hbvib_model_set_rayleigh(model, 0, 0) != HBVIB_OK) abort();
    return model;
}

static hbvib_solver_options three_harmonics(void)
{
    hbvib_solver_options s = solver_options();
    s.harmonics = 3;
    return s;
}

static hbvib_mode_point mode_point(hbvib_branch *branch, int64_t point)
{
    hbvib_mode_point p;
    WORKS("point", hbvib_mode_point_init(&p, sizeof p));
    WORKS("point", hbvib_branch_mode_point(branch, point, &p));
    return p;
}

static hbvib_mode_info mode_info(hbvib_branch *branch)
{
    hbvib_mode_info i;
    WORKS("info", hbvib_mode_info_init(&i, sizeof i));
    WORKS("info", hbvib_branch_mode_info(branch, &i));
    return i;
}

static const double *field(hbvib_branch *branch, int32_t which)
{
    hbvib_view view;
    WORKS("field", hbvib_view_init(&view, sizeof view));
    WORKS("field", hbvib_branch_field(branch, which, &view));
    EXPECT("field", view.rank == 1 && view.shape[0] == hbvib_branch_points(branch) && view.stride[0] == 1);
    return view.data;
}

/* Arrays and points say the same, whatever the point; D is that of the balance of work. */
static void curve(hbvib_branch *branch, const hbvib_mode_options *o, double largest)
{
    const double *p = field(branch, HBVIB_LOG10_AMPLITUDE), *modal = field(branch, HBVIB_MODAL_AMPLITUDE);
    const double *omega = field(branch, HBVIB_OMEGA), *damping = field(branch, HBVIB_DAMPING_RATIO);
    const double *energy = field(branch, HBVIB_ENERGY), *friction = field(branch, HBVIB_DISSIPATION);
    const double *structure = field(branch, HBVIB_STRUCTURAL_LOSS), *alike = field(branch, HBVIB_MODAL_ASSURANCE);
    int64_t i, n = hbvib_branch_points(branch);
    hbvib_mode_info info = mode_info(branch);
    hbvib_view view;
    EXPECT("curve", n > 10 && p[0] == o->log10_start && p[n - 1] == o->log10_stop && alike[0] == 1);
    EXPECT("curve", info.linear_up_to > o->log10_start && info.linear_up_to < o->log10_stop);
    for (i = 0; i < n; i++) {
        hbvib_mode_point at = mode_point(branch, i);
        EXPECT("curve", at.log10_amplitude == p[i] && at.modal_amplitude == modal[i] && at.omega == omega[i] &&
                            at.damping_ratio == damping[i] && at.energy == energy[i] && at.friction_loss == friction[i] &&
                            at.structural_loss == structure[i] && at.assurance == alike[i]);
        EXPECT("curve", fabs(log10(modal[i]) - p[i]) < 1e-12 && energy[i] > 0 && fabs(structure[i]) <= 1e-15 * energy[i]);
        EXPECT("curve", fabs(at.energy_damping_ratio - at.damping_ratio) < 1e-9 * largest);
        EXPECT("curve", fabs(at.energy_damping_ratio * 4 * PI * energy[i] - friction[i] - structure[i]) <= 1e-12 * fabs(friction[i]) + 1e-15 * energy[i]);
        EXPECT("curve", at.fundamental_share > 0.99 && at.fundamental_share < 1 + 1e-14);
        EXPECT("curve", alike[i] > 0.9 && alike[i] < 1 + 1e-14);
        if (p[i] <= info.linear_up_to)
            EXPECT("curve", fabs(damping[i]) < 1e-12 && fabs(omega[i] / info.omega - 1) < 1e-12);
        else
            EXPECT("curve", damping[i] > 0 && omega[i] < info.omega);
    }
    WORKS("curve", hbvib_view_init(&view, sizeof view));
    REFUSED("curve", hbvib_branch_field(branch, 99, &view), HBVIB_E_ARGUMENT, 2, "needs a value of enum hbvib_field");
}

/* The frequencies and damping ratios of the reference, and all that is said of these points. */
static void reference(char **arguments)
{
    double row[7], at[2], x[2 * 4 * NDOF], stuck[1], omega, amplitude, modal;
    hbvib_model *model = undamped();
    hbvib_solver_options s = three_harmonics();
    hbvib_mode_options o = amplitudes(1, 4);
    hbvib_branch *branch = NULL;
    hbvib_mode_info info;
    hbvib_mode_point p;
    hbvib_energy e;
    int64_t point, count;
    int i, k;
    for (i = 0; i < 7; i++) row[i] = strtod(arguments[i], NULL);
    for (i = 0; i < 2; i++) at[i] = log10(row[3 * i] * unit_of_length());
    o.at = at;
    o.at_len = 2;
    WORKS("reference", hbvib_nonlinear_mode(model, &s, &o, NULL, &branch));
    WORKS("reference", hbvib_branch_status(branch));
    info = mode_info(branch);
    WORKS("reference", hbvib_linear_modes(model, 2, HBVIB_CONTACTS_STUCK, 1, stuck, NULL));
    EXPECT("info", info.mode_index == 0 && info.multiple == HBVIB_MODE_SINGLE && info.multiplicity == 1 &&
                       info.amplitude_contact == -1 && info.reference_dof == 0 && info.engine_order == 2 && fabs(info.omega / stuck[0] - 1) < 1e-12);
    for (i = 0; i < 2; i++) {
        point = count = -1;
        WORKS("at", hbvib_branch_at(branch, i, 1, &amplitude, &point, &count));
        EXPECT("at", count == 1 && point >= hbvib_branch_points(branch));
        p = mode_point(branch, point);
        EXPECT("reference", fabs(p.omega / row[3 * i + 1] - 1) < 1e-9);
        EXPECT("reference", fabs(p.damping_ratio - row[3 * i + 2]) < 1e-7 * row[6]);
        EXPECT("at", fabs(p.log10_amplitude - at[i]) < 1e-12 && fabs(p.energy_damping_ratio - p.damping_ratio) < 1e-9 * row[6]);
        WORKS("at", hbvib_energy_init(&e, sizeof e));
        WORKS("at", hbvib_branch_energy(branch, point, &e));
        EXPECT("at", fabs(e.twice_mean_kinetic / p.energy - 1) < 1e-12 && fabs(e.friction_loss / p.friction_loss - 1) < 1e-9);
        WORKS("at", hbvib_branch_harmonics(branch, point, 0, NDOF, x, 4 * NDOF));
        EXPECT("at", fabs(hypot(x[2 * NDOF], x[2 * NDOF + 1]) / amplitude - 1) < 1e-12);
        EXPECT("at", fabs(x[2 * NDOF + 1]) < 1e-12 * amplitude); /* the phase reference */
        for (modal = 0, k = 0; k < 2 * NDOF; k++) modal += MASS[5 * (k / 2)] * x[2 * NDOF + k] * x[2 * NDOF + k];
        EXPECT("at", fabs(sqrt(modal) / p.modal_amplitude - 1) < 1e-12);
    }
    REFUSED("at", hbvib_branch_at(branch, 2, 1, &amplitude, &point, &count), HBVIB_E_INDEX, 2, "wanted = 2");
    /* The peak of a mode is its largest damping ratio. */
    WORKS("peak", hbvib_branch_peaks(branch, 1, &omega, NULL, &point, &count));
    p = mode_point(branch, point);
    EXPECT("peak", count == 1 && p.omega == omega && fabs(p.damping_ratio / row[6] - 1) < 1e-9);
    WORKS("folds", hbvib_branch_folds(branch, 0, NULL, NULL, NULL, &count));
    EXPECT("folds", count == 0);
    curve(branch, &o, row[6]);
    WORKS("free", hbvib_branch_free(branch));
    WORKS("free", hbvib_model_free(model));
}

/* The solution at the end of a range, its fundamental, and how it began. */
typedef struct ending {
    hbvib_mode_info info;
    hbvib_mode_point point;
    double x[2 * NDOF];
    int64_t response_dof;
} ending;

static ending ends(hbvib_model *model, const hbvib_solver_options *s, const hbvib_mode_options *o)
{
    double all[2 * 4 * NDOF];
    hbvib_branch *branch = NULL;
    hbvib_reduction r;
    int64_t last;
    ending e;
    memset(&e, 0, sizeof e);
    WORKS("choice", hbvib_nonlinear_mode(model, s, o, NULL, &branch));
    if (branch == NULL) return e;
    last = hbvib_branch_points(branch) - 1;
    e.info = mode_info(branch);
    e.point = mode_point(branch, last);
    WORKS("choice", hbvib_branch_harmonics(branch, last, 0, NDOF, all, 4 * NDOF));
    memcpy(e.x, all + 2 * NDOF, sizeof e.x);
    WORKS("choice", hbvib_reduction_init(&r, sizeof r));
    WORKS("choice", hbvib_branch_reduction(branch, &r));
    e.response_dof = r.response_dof;
    WORKS("choice", hbvib_branch_free(branch));
    return e;
}

static void choices(void)
{
    hbvib_branch *none = NULL;
    hbvib_model *model = undamped();
    hbvib_solver_options s = three_harmonics();
    hbvib_mode_options o = amplitudes(1.5, 2.5);
    double stuck[NDOF], shapes[2 * NDOF * NDOF], ratio;
    ending base = ends(model, &s, &o), e;
    WORKS("choice", hbvib_linear_modes(model, 2, HBVIB_CONTACTS_STUCK, NDOF, stuck, shapes));

    o.reference_dof = 3;
    s.response_dof = -1;
    e = ends(model, &s, &o);
    EXPECT("reference_dof", e.info.reference_dof == 3 && e.response_dof == 3 && base.response_dof == 0);
    EXPECT("reference_dof", fabs(e.x[7]) < 1e-12 * fabs(e.x[6]) && fabs(base.x[7]) > 1e-9 * fabs(base.x[6]));
    EXPECT("reference_dof", fabs(e.point.omega / base.point.omega - 1) < 1e-9);

    o = amplitudes(1.5, 2.5);
    o.damping_form = HBVIB_DAMPING_STIFFNESS;
    e = ends(model, &s, &o);
    ratio = e.point.damping_ratio / base.point.damping_ratio;
    EXPECT("damping_form", ratio != 1 && fabs(ratio - 1) < 0.2);

    WORKS("diameter", hbvib_cyclic_set_wave(model, 5));
    o = amplitudes(1.5, 2.5);
    o.diameter = 2;
    s.response_dof = 0;
    e = ends(model, &s, &o);
    EXPECT("diameter", memcmp(&e, &base, sizeof e) == 0);
    WORKS("diameter", hbvib_cyclic_set_wave(model, 2));

    o = amplitudes(-1, 0); /* nothing slips: quick */
    o.mode_index = 1;
    e = ends(model, &s, &o);
    EXPECT("mode_index", e.info.mode_index == 1 && fabs(e.info.omega / stuck[1] - 1) < 1e-12);
    o.near_omega = 1.01 * stuck[2]; /* only one field may choose */
    REFUSED("mode_index", hbvib_nonlinear_mode(model, &s, &o, NULL, &none), HBVIB_E_ARGUMENT, 3, "mode_index = 1 beside near_omega");
    o.mode_index = 0;
    e = ends(model, &s, &o);
    EXPECT("near_omega", e.info.mode_index == 2 && fabs(e.point.omega / stuck[2] - 1) < 1e-12);
    o.near_omega = 0;
    o.shape = shapes + 2 * NDOF;
    o.shape_len = NDOF;
    e = ends(model, &s, &o);
    EXPECT("shape", e.info.mode_index == 1 && e.info.multiple == HBVIB_MODE_SINGLE);

    /* The contact sticks until its motion is that of the slip limit. */
    o = amplitudes(-1, 1);
    o.amplitude_contact = 0;
    e = ends(model, &s, &o);
    EXPECT("amplitude_contact", e.info.amplitude_contact == 0 && fabs(e.info.linear_up_to - log10(unit_of_length())) < 1e-12);
    EXPECT("amplitude_contact", fabs(hypot(e.x[4] - e.x[6], e.x[5] - e.x[7]) / (10 * unit_of_length()) - 1) < 1e-9);
    EXPECT("amplitude_contact", fabs(e.point.log10_amplitude - log10(10 * unit_of_length())) < 1e-12);
    WORKS("free", hbvib_model_free(model));
}

/* A repeated frequency: the result says what was done about it. */
static void repeated(void)
{
    hbvib_model *model = two_masses(ONES, ONES, 0);
    hbvib_solver_options s = three_harmonics();
    const double shape[4] = {1, 0, 0, 0};
    hbvib_mode_options o;
    hbvib_branch *branch = NULL;
    hbvib_mode_info info;
    WORKS("repeated", hbvib_mode_options_init(&o, sizeof o));
    o.log10_start = -3;
    o.log10_stop = -2;
    WORKS("repeated", hbvib_nonlinear_mode(model, &s, &o, NULL, &branch));
    info = mode_info(branch);
    EXPECT("repeated", info.multiplicity == 2 && info.multiple == HBVIB_MODE_TRAVELLING_WAVE);
    WORKS("repeated", hbvib_branch_free(branch));
    o.shape = shape;
    o.shape_len = 2;
    WORKS("repeated", hbvib_nonlinear_mode(model, &s, &o, NULL, &branch));
    info = mode_info(branch);
    EXPECT("repeated", info.multiplicity == 2 && info.multiple == HBVIB_MODE_PROJECTED);
    WORKS("repeated", hbvib_branch_free(branch));
    WORKS("repeated", hbvib_model_free(model));
}

/* Damping of the structure adds its work; a cubic spring takes none, and is never linear. */
static void losses(void)
{
    hbvib_model *model = two_masses(ONES, RISING, 2);
    hbvib_solver_options s = three_harmonics();
    hbvib_mode_options o = amplitudes(2, 3);
    hbvib_contact c;
    ending e = ends(the_model, &s, &o);
    EXPECT("losses", e.point.structural_loss > 0 && e.point.friction_loss > 0);
    EXPECT("losses", fabs(e.point.energy_damping_ratio / e.point.damping_ratio - 1) < 1e-9);

    WORKS("cubic", hbvib_contact_init(&c, sizeof c));
    c.kind = HBVIB_CUBIC;
    c.dof_a[0] = 1;
    c.cubic = 2;
    WORKS("cubic", hbvib_model_add_contact(model, &c, NULL));
    WORKS("cubic", hbvib_mode_options_init(&o, sizeof o));
    o.mode_index = 1;
    o.log10_start = -2;
    o.log10_stop = 0;
    s = solver_options();
    s.harmonics = 1; /* omega^2 = k + 3/4 cubic amplitude^2 */
    {
        hbvib_branch *branch = NULL;
        hbvib_mode_point p;
        hbvib_mode_info info;
        int64_t i;
        WORKS("cubic", hbvib_nonlinear_mode(model, &s, &o, NULL, &branch));
        info = mode_info(branch);
        EXPECT("cubic", info.mode_index == 1 && info.omega == 2 && isinf(info.linear_up_to) && info.linear_up_to < 0);
        for (i = 0; i < hbvib_branch_points(branch); i++) {
            p = mode_point(branch, i);
            EXPECT("cubic", fabs(p.omega / sqrt(4 + 1.5 * p.modal_amplitude * p.modal_amplitude) - 1) < 1e-12);
            EXPECT("cubic", fabs(p.damping_ratio) < 1e-12 && fabs(p.energy_damping_ratio) < 1e-12);
        }
        WORKS("cubic", hbvib_branch_free(branch));
    }
    WORKS("cubic", hbvib_model_free(model));
}

typedef struct seen {
    double parameter[MOST_POINTS];
    int64_t calls, stop_at;
    int wrong;
} seen;

static int32_t progress(void *user, const hbvib_progress *p)
{
    seen *s = user;
    s->wrong += p->point != s->calls + 1 || !(p->amplitude > 0) || !(p->fraction_done >= 0 && p->fraction_done <= 1);
    if (s->calls < MOST_POINTS) s->parameter[s->calls] = p->parameter;
    return ++s->calls >= s->stop_at;
}

/* A hook that stops keeps the points; so does the flag, before the first one. */
static void cancelled(void)
{
    hbvib_mode_options o = amplitudes(1, 4);
    hbvib_solver_options s = three_harmonics();
    hbvib_branch *branch = NULL;
    hbvib_cancel_flag flag = 1;
    hbvib_hooks h;
    seen found;
    int64_t stop, count = -1, i;
    const double *p;
    o.at = &o.log10_stop;
    o.at_len = 1;
    for (stop = 1; stop <= 31; stop += 15) {
        memset(&found, 0, sizeof found);
        found.stop_at = stop;
        WORKS("hooks", hbvib_hooks_init(&h, sizeof h));
        h.user = &found;
        h.progress = progress;
        EXPECT("hooks", hbvib_nonlinear_mode(the_model, &s, &o, &h, &branch) == HBVIB_STOPPED_BY_CALLER);
        EXPECT("hooks", strstr(hbvib_last_error(), "points found so far are kept") != NULL);
        EXPECT("hooks", hbvib_branch_status(branch) == HBVIB_STOPPED_BY_CALLER);
        EXPECT("hooks", found.calls == stop && found.wrong == 0 && hbvib_branch_points(branch) == stop);
        p = field(branch, HBVIB_LOG10_AMPLITUDE);
        for (i = 0; i < stop; i++) EXPECT("hooks", p[i] == found.parameter[i]);
        EXPECT("hooks", mode_point(branch, stop - 1).omega > 0 && mode_info(branch).omega > 0);
        WORKS("hooks", hbvib_branch_at(branch, 0, 0, NULL, NULL, &count));
        EXPECT("hooks", count == 0);
        WORKS("hooks", hbvib_branch_free(branch));
    }
    WORKS("hooks", hbvib_hooks_init(&h, sizeof h));
    h.cancel = &flag;
    EXPECT("hooks", hbvib_nonlinear_mode(the_model, &s, &o, &h, &branch) == HBVIB_STOPPED_BY_CALLER);
    EXPECT("hooks", hbvib_branch_points(branch) <= 1);
    WORKS("hooks", hbvib_branch_free(branch));
}

/* Two masses on hardening springs, weakly coupled: beside their opposed mode are two localised ones. */
static void branches(void)
{
    hbvib_solver_options s = three_harmonics();
    hbvib_mode_options o;
    hbvib_model *model = NULL;
    hbvib_branch *branch = NULL, *child = NULL;
    hbvib_contact c;
    hbvib_descent d;
    hbvib_matrix m;
    double mass[4] = {1, 0, 0, 1}, stiffness[4] = {1.1, -0.1, -0.1, 1.1};
    int64_t i, kind = 0, place = 0, count = 0;
    WORKS("model", hbvib_model_new(2, &model));
    m = matrix(2, mass);
    WORKS("mass", hbvib_model_set_matrix(model, HBVIB_MASS, &m));
    m = matrix(2, stiffness);
    WORKS("stiffness", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &m));
    for (i = 0; i < 2; i++) {
        WORKS("contact", hbvib_contact_init(&c, sizeof c));
        c.kind = HBVIB_CUBIC;
        c.dof_a[0] = i;
        c.cubic = 1;
        WORKS("contact", hbvib_model_add_contact(model, &c, NULL));
    }
    WORKS("options", hbvib_mode_options_init(&o, sizeof o));
    EXPECT("defaults", o.branches == 0 && o.branch_depth == 0 && o.most_branches == 0);
    o.log10_start = -1;
    o.log10_stop = 0.5;
    o.mode_index = 1;
    o.branch_depth = 2;
    REFUSED("depth alone", hbvib_nonlinear_mode(model, &s, &o, NULL, &branch), HBVIB_E_ARGUMENT, 3, "branch_depth = 2 with branches = 0");
    o.branch_depth = 0;
    o.branches = 2;
    REFUSED("branches", hbvib_nonlinear_mode(model, &s, &o, NULL, &branch), HBVIB_E_ARGUMENT, 3, "branches = 2");
    o.branches = 1;
    WORKS("mode", hbvib_nonlinear_mode(model, &s, &o, NULL, &branch));
    WORKS("branch point", hbvib_branch_bifurcations(branch, 1, NULL, NULL, &kind, &place, NULL, NULL, &count));
    EXPECT("branch point", count == 1 && kind == HBVIB_BIFURCATION_BRANCH_POINT);
    EXPECT("branch point", fabs(mode_point(branch, place).modal_amplitude - 0.5147) < 1e-3);
    EXPECT("children", hbvib_branch_children(branch) == 2);
    WORKS("child", hbvib_branch_child(branch, 1, &child));
    WORKS("descent", hbvib_descent_init(&d, sizeof d));
    WORKS("descent", hbvib_branch_descent(child, &d));
    EXPECT("descent", d.kind == HBVIB_BIFURCATION_BRANCH_POINT && d.bifurcation == 0 && d.internal_resonance == 0);
    WORKS("free", hbvib_branch_free(branch));
    WORKS("free", hbvib_model_free(model));
}

int main(int count, char **arguments)
{
    if (count != 8) return 2;
    begin();
    reference(arguments + 1);
    choices();
    repeated();
    losses();
    cancelled();
    branches();
    WORKS("free", hbvib_model_free(the_model));
    return verdict(500);
}
