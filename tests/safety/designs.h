/* Analyses of designs, of stability and of damped modes, each reduced to a number as in analyses.h. */
#ifndef DESIGNS_H
#define DESIGNS_H

#include "analyses.h"

static hbvib_parameter parameter(int32_t kind, int32_t scaling, int64_t contact)
{
    hbvib_parameter p;
    memset(&p, 0, sizeof p);
    hbvib_parameter_init(&p, sizeof p);
    p.kind = kind;
    p.scaling = scaling;
    p.contact = contact;
    return p;
}

/* The range of frequency in which a peak lies. */
static hbvib_forced_options around_a_peak(const hbvib_model *model)
{
    const int64_t ndof = hbvib_model_dofs(model);
    hbvib_forced_options o;
    memset(&o, 0, sizeof o);
    hbvib_forced_options_init(&o, sizeof o);
    o.omega_start = ndof == 4 ? 1290 : 1.1;
    o.omega_stop = ndof == 4 ? 1330 : 1.6;
    return o;
}

/* Derivatives of all results of a response and of a mode by a parameter of each kind. */
static hbvib_status sensitive(const hbvib_model *model, uint64_t *sum)
{
    enum { COUNT = 5 };
    hbvib_parameter p[COUNT];
    hbvib_solver_options s = options(0);
    hbvib_forced_options o = around_a_peak(model);
    hbvib_mode_options m;
    hbvib_branch *branch = NULL, *backbone = NULL;
    hbvib_status status = HBVIB_OK;
    double derivatives[COUNT], omega[16], amplitude[16];
    int64_t reasons[COUNT], point[16], onset = 0, count = 0;
    int32_t of;
    p[0] = parameter(HBVIB_PARAMETER_FORCE, 0, -1);
    p[1] = parameter(HBVIB_PARAMETER_PRELOAD, 0, 0);
    p[2] = parameter(HBVIB_PARAMETER_KT, 0, -1);
    p[3] = parameter(HBVIB_PARAMETER_MASS, HBVIB_SCALING_FACTOR, -1);
    p[4] = parameter(HBVIB_PARAMETER_STIFFNESS, HBVIB_SCALING_FACTOR, -1);
    s.max_points = 60;
    s.harmonics = 1;
    STEP(hbvib_forced_response(model, &s, &o, NULL, &branch));
    STEP(hbvib_branch_peaks(branch, 16, omega, amplitude, point, &count));
    for (of = HBVIB_OF_AMPLITUDE; of <= HBVIB_OF_PEAK_OMEGA && status >= 0 && count > 0; of++) {
        STEP(hbvib_sensitivity(model, branch, point[0], of, p, COUNT, derivatives, COUNT, reasons, &onset, NULL));
        if (status >= 0) digest(sum, derivatives, sizeof derivatives);
    }
    memset(&m, 0, sizeof m);
    STEP(hbvib_mode_options_init(&m, sizeof m));
    m.log10_start = hbvib_model_dofs(model) == 4 ? -5.5 : -1;
    m.log10_stop = m.log10_start + 0.5;
    STEP(hbvib_nonlinear_mode(model, &s, &m, NULL, &backbone));
    for (of = HBVIB_OF_MODE_OMEGA; of <= HBVIB_OF_MODE_DAMPING && status >= 0 && count > 0; of++) {
        STEP(hbvib_sensitivity(model, backbone, 2, of, p + 1, COUNT - 1, derivatives, COUNT - 1, reasons, &onset, NULL));
        if (status >= 0) digest(sum, derivatives, (COUNT - 1) * sizeof *derivatives);
    }
    if (hbvib_branch_free(branch) != HBVIB_OK || hbvib_branch_free(backbone) != HBVIB_OK) return HBVIB_E_INTERNAL;
    return status < 0 || count > 0 ? status : HBVIB_E_INTERNAL;
}

/* A response over the stiffness, or a peak over the normal load of all contacts. */
static hbvib_status over(const hbvib_model *model, int32_t follow, uint64_t *sum)
{
    double value[16], amplitude[16];
    int64_t maximum[16], point[16], count = 0;
    hbvib_solver_options s = options(0);
    hbvib_parameter load = parameter(HBVIB_PARAMETER_PRELOAD, 0, -1);
    hbvib_parameter stiffness = parameter(HBVIB_PARAMETER_STIFFNESS, HBVIB_SCALING_FACTOR, -1);
    hbvib_parameter_options o;
    hbvib_status status = HBVIB_OK;
    const int ring = hbvib_model_dofs(model) == 4;
    hbvib_branch *branch = NULL;
    s.max_points = 60;
    s.harmonics = ring ? 3 : 1;
    /* A few points, so that each of their requests for memory can fail. */
    s.step = s.step_max = 0.3;
    memset(&o, 0, sizeof o);
    STEP(hbvib_parameter_options_init(&o, sizeof o));
    o.follow = follow;
    o.parameter = follow == HBVIB_FOLLOW_OMEGA ? &stiffness : &load;
    o.start = follow == HBVIB_FOLLOW_OMEGA ? 0.99 : ring ? 300 : 0.3;
    o.stop = follow == HBVIB_FOLLOW_OMEGA ? 0.9901 : ring ? 300.1 : 0.3001;
    o.omega = ring ? 1305 : 1.35;
    STEP(hbvib_parameter_response(model, &s, &o, NULL, &branch));
    STEP(hbvib_branch_optima(branch, 16, value, amplitude, maximum, point, &count));
    STEP(hbvib_branch_turns(branch, 16, value, amplitude, NULL, maximum, point, &count));
    if (status >= 0) digest(sum, value, (size_t)count * sizeof(double));
    return of_branch(status, branch, hbvib_model_dofs(model), sum);
}

static hbvib_status over_a_parameter(const hbvib_model *model, uint64_t *sum)
{
    return over(model, HBVIB_FOLLOW_OMEGA, sum);
}

static hbvib_status peak_over_a_parameter(const hbvib_model *model, uint64_t *sum)
{
    return over(model, HBVIB_FOLLOW_PEAK, sum);
}

/* Peaks of three designs by some threads; one branch is taken. */
static hbvib_status batch_of(const hbvib_model *model, int32_t threads, uint64_t *sum)
{
    enum { DESIGNS = 3 };
    static const double values[2 * DESIGNS] = {1, 1, 1.1, 1, 1, 1.01};
    double amplitude[DESIGNS], omega[DESIGNS];
    int64_t statuses[DESIGNS], points[DESIGNS];
    hbvib_parameter p[2];
    hbvib_solver_options s = options(0);
    hbvib_forced_options range = around_a_peak(model);
    hbvib_batch_options o;
    hbvib_batch *batch = NULL;
    hbvib_branch *branch = NULL;
    hbvib_status status = HBVIB_OK, failed = HBVIB_OK;
    int i;
    p[0] = parameter(HBVIB_PARAMETER_FORCE, 0, -1);
    p[1] = parameter(HBVIB_PARAMETER_STIFFNESS, HBVIB_SCALING_FACTOR, -1);
    s.max_points = 40;
    memset(&o, 0, sizeof o);
    STEP(hbvib_batch_options_init(&o, sizeof o));
    o.threads = threads;
    o.keep = 1;
    o.omega_start = range.omega_start;
    o.omega_stop = range.omega_stop;
    STEP(hbvib_batch_solve(model, &s, &o, NULL, p, 2, DESIGNS, values, &batch));
    STEP(hbvib_batch_peaks(batch, DESIGNS, amplitude, omega, statuses, points));
    if (status >= 0) {
        digest(sum, amplitude, sizeof amplitude);
        digest(sum, omega, sizeof omega);
        digest(sum, points, sizeof points);
        /* A design that fails for want of memory says so itself. */
        for (i = 0; i < DESIGNS; i++)
            if (statuses[i] < 0) failed = (hbvib_status)statuses[i];
        if (failed >= 0) STEP(hbvib_batch_branch(batch, 2, &branch));
    }
    status = of_branch(status, branch, hbvib_model_dofs(model), sum);
    if (hbvib_batch_free(batch) != HBVIB_OK) return HBVIB_E_INTERNAL;
    return status < 0 ? status : failed;
}

static hbvib_status batch(const hbvib_model *model, uint64_t *sum)
{
    return batch_of(model, 1, sum);
}

static hbvib_status batch_by_threads(const hbvib_model *model, uint64_t *sum)
{
    return batch_of(model, 2, sum);
}

/* A response with the multipliers of each point, and its bifurcations. */
static hbvib_status stable(const hbvib_model *model, uint64_t *sum)
{
    double omega[16], amplitude[16];
    int64_t kind[16], point[16], before[16], after[16], count = 0;
    hbvib_solver_options s = options(0);
    hbvib_forced_options o = range(model);
    hbvib_branch *branch = NULL;
    hbvib_view view;
    hbvib_status status = HBVIB_OK;
    s.stability = hbvib_model_sectors(model) > 1 ? HBVIB_STABILITY_WHEEL : HBVIB_STABILITY_WAVE;
    memset(&view, 0, sizeof view);
    STEP(hbvib_view_init(&view, sizeof view));
    STEP(hbvib_forced_response(model, &s, &o, NULL, &branch));
    STEP(hbvib_branch_field(branch, HBVIB_FLOQUET_RADIUS, &view));
    if (status >= 0) digest(sum, view.data, (size_t)view.shape[0] * sizeof(double));
    STEP(hbvib_branch_bifurcations(branch, 16, omega, amplitude, kind, point, before, after, &count));
    if (status >= 0) digest(sum, amplitude, (size_t)count * sizeof(double));
    return of_branch(status, branch, hbvib_model_dofs(model), sum);
}

/* Six sectors of nine masses in a row, two of which rub, and of one on a spring so stiff that perturbations of all degrees of freedom
 * would take too many steps: stability is then computed on modes and sliders. All modes decay alike. */
static hbvib_status stiff_wheel(hbvib_model **model)
{
    enum { N = 10 };
    double mass[N * N] = {0}, stiffness[N * N] = {0}, next[N * N] = {0};
    hbvib_matrix m = dense(N, mass), k = dense(N, stiffness), coupling = dense(N, next);
    hbvib_contact c = law(HBVIB_JENKINS, 1, HBVIB_GROUND, HBVIB_GROUND), d = law(HBVIB_JENKINS, 0, HBVIB_GROUND, HBVIB_GROUND);
    hbvib_status status = hbvib_cyclic_new(N, 6, model);
    int i;
    for (i = 0; i < N; i++) {
        mass[i * N + i] = i < N - 1 ? 0.2 : 1e-4;
        stiffness[i * N + i] = i < N - 1 ? 16 : 1e8;
        if (i > 0) stiffness[i * N + i - 1] = stiffness[(i - 1) * N + i] = -8;
    }
    next[1 * N + 1] = -0.1;
    c.kt = 0.3;
    c.mu = c.preload = 0.1;
    d.dof_b[0] = 2;
    d.kt = 0.3;
    d.mu = d.preload = 0.1;
    STEP(hbvib_model_set_matrix(*model, HBVIB_MASS, &m));
    STEP(hbvib_model_set_matrix(*model, HBVIB_STIFFNESS, &k));
    STEP(hbvib_cyclic_set_coupling(*model, HBVIB_STIFFNESS, &coupling));
    STEP(hbvib_model_set_rayleigh(*model, 0.1, 0));
    STEP(hbvib_cyclic_set_wave(*model, 3));
    STEP(hbvib_model_add_force(*model, 0, 1, 0.4, 0));
    STEP(hbvib_model_add_contact(*model, &c, NULL));
    STEP(hbvib_model_add_contact(*model, &d, NULL));
    return finished(status, model);
}

/* The multipliers of a wheel on modes and sliders. */
static hbvib_status on_sliders(const hbvib_model *model, uint64_t *sum)
{
    static double multipliers[2 * 128];
    int64_t classes[128];
    hbvib_solver_options s = options(0);
    hbvib_forced_options o = range(model);
    hbvib_floquet_options f;
    hbvib_floquet_info info;
    hbvib_branch *branch = NULL;
    hbvib_status status = HBVIB_OK;
    memset(&f, 0, sizeof f);
    memset(&info, 0, sizeof info);
    STEP(hbvib_floquet_options_init(&f, sizeof f));
    STEP(hbvib_floquet_info_init(&info, sizeof info));
    s.harmonics = 9;
    o.omega_stop = o.omega_start;
    f.waves = HBVIB_WAVES_WHEEL;
    f.modes = 8;
    STEP(hbvib_forced_response(model, &s, &o, NULL, &branch));
    STEP(hbvib_floquet(model, branch, 0, &f, NULL, multipliers, 128, classes, 128, &info));
    /* Eight modes: there are only seven beside the degrees of freedom of the contacts, and those are none of the states. */
    if (status >= 0 && (info.modes != 8 || info.count > 128)) status = HBVIB_E_INTERNAL;
    if (status >= 0) digest(sum, multipliers, (size_t)info.count * 2 * sizeof(double));
    return of_branch(status, branch, hbvib_model_dofs(model), sum);
}

/* Negative damping that a contact limits. */
static hbvib_status self_excited(hbvib_model **model)
{
    static const double none[9] = {0};
    hbvib_matrix d = dense(3, none);
    hbvib_contact c = law(HBVIB_JENKINS, 1, HBVIB_GROUND, HBVIB_GROUND);
    hbvib_status status;
    c.kt = 1;
    c.mu = c.preload = 0.4;
    status = with_contact(model, &c);
    STEP(hbvib_model_set_matrix(*model, HBVIB_DAMPING, &d));
    STEP(hbvib_model_set_rayleigh(*model, -0.02, 0));
    return finished(status, model);
}

/* Limit cycles on a mode, and the multipliers of the first. */
static hbvib_status cycles(const hbvib_model *model, uint64_t *sum)
{
    static double multipliers[2 * 64];
    double omega[16], amplitude[16], slope[16];
    int64_t point[16], classes[64], count = 0;
    hbvib_solver_options s = options(0);
    hbvib_mode_options o;
    hbvib_floquet_info info;
    hbvib_branch *branch = NULL;
    hbvib_status status = HBVIB_OK;
    s.max_points = 60;
    s.harmonics = 5;
    memset(&o, 0, sizeof o);
    memset(&info, 0, sizeof info);
    STEP(hbvib_mode_options_init(&o, sizeof o));
    STEP(hbvib_floquet_info_init(&info, sizeof info));
    o.log10_start = -0.5;
    o.log10_stop = 1;
    STEP(hbvib_nonlinear_mode(model, &s, &o, NULL, &branch));
    STEP(hbvib_branch_limit_cycles(branch, 16, omega, amplitude, slope, point, &count));
    if (status >= 0 && count == 0) status = HBVIB_E_INTERNAL;
    STEP(hbvib_floquet(model, branch, point[0], NULL, NULL, multipliers, 64, classes, 64, &info));
    if (status >= 0) digest(sum, multipliers, (size_t)(info.count < 64 ? info.count : 64) * 2 * sizeof(double));
    return of_branch(status, branch, hbvib_model_dofs(model), sum);
}

/* Damped modes in each state of the contacts, and a Campbell diagram of one nodal diameter. */
static hbvib_status damped(const hbvib_model *model, uint64_t *sum)
{
    static const double speeds[3] = {0, 0.2, 0.5};
    static double shapes[2 * 2 * 9], waves[2 * 64];
    double eigenvalues[4], diagram[6], ratios[6];
    int64_t direction[6], diameters[64], equal;
    hbvib_status status = HBVIB_OK;
    int32_t contacts;
    for (contacts = HBVIB_CONTACTS_FREE; contacts <= HBVIB_CONTACTS_STATIC && status >= 0; contacts++) {
        STEP(hbvib_damped_modes(model, 1, contacts, 2, eigenvalues, shapes, direction, NULL));
        if (status >= 0) digest(sum, eigenvalues, sizeof eigenvalues);
        STEP(hbvib_campbell(model, 3, speeds, 1, contacts, 2, diagram, ratios, direction, NULL));
        if (status >= 0) digest(sum, diagram, sizeof diagram);
        STEP(hbvib_interference(model, contacts, 2, 64, diameters, waves, NULL, NULL, &equal, NULL));
        if (status >= 0) digest(sum, waves, (size_t)(2 * hbvib_model_sectors(model)) * sizeof(double));
    }
    return status;
}

/* The pattern of a wheel from the tuned modes of its sectors with other amplitudes. */
static hbvib_status pattern(const hbvib_model *model, uint64_t *sum)
{
    enum { MOST = 64 };
    static double shapes[2 * 2 * MOST], delta[MOST], covariance[MOST * MOST];
    static const double sigma[2] = {1e-3, 1e-3};
    const int64_t blade = 0, sectors = hbvib_model_sectors(model);
    double omega[2], chi2 = 0;
    hbvib_status status = HBVIB_OK;
    int64_t s;
    STEP(hbvib_linear_modes(model, 1, HBVIB_CONTACTS_STUCK, 1, omega, NULL));
    omega[1] = 1.001 * omega[0];
    for (s = 0; s < 2 * sectors; s++) {
        shapes[2 * s] = cos(6.283185307179586 * (double)(s % sectors) / (double)sectors - (s < sectors ? 0 : 1.5)) + 0.01 * (double)(s % 3);
        shapes[2 * s + 1] = 0;
    }
    STEP(hbvib_wheel_identify(model, HBVIB_MISTUNING_STIFFNESS, 1, &blade, NULL, HBVIB_CONTACTS_STUCK, 1, 1, &blade, 2, omega, sigma, shapes,
                              sigma, NULL, sectors, delta, covariance, &chi2, NULL));
    if (status >= 0) digest(sum, delta, (size_t)sectors * sizeof(double));
    return status;
}

static const analysis DESIGNS_AND_STABILITY[] = {
    {"sensitivities", ring, sensitive},
    {"sensitivities, friction in a plane", friction_3d, sensitive},
    {"over a parameter", ring, over_a_parameter},
    {"peak over a parameter", ring, peak_over_a_parameter},
    {"peak over a parameter, two directions", friction_2d, peak_over_a_parameter},
    {"batch", ring, batch},
    {"batch by two threads", ring, batch_by_threads},
    {"batch, table", table, batch},
    {"batch, chain", chain, batch},
    {"stability of a wheel", small_ring, stable},
    {"stability, cubic", cubic, stable},
    {"stability, unilateral", unilateral, stable},
    {"stability, modes and sliders", stiff_wheel, on_sliders},
    {"limit cycles", self_excited, cycles},
    {"damped modes of a wheel", faces, damped},
    {"pattern of a wheel", small_ring, pattern},
};
enum { N_DESIGNS = sizeof DESIGNS_AND_STABILITY / sizeof *DESIGNS_AND_STABILITY };

/* All analyses, those of analyses.h first. */
enum { N_ALL = N_ANALYSES + N_DESIGNS };

static const analysis *analysis_number(int i)
{
    return i < N_ANALYSES ? &ANALYSES[i] : &DESIGNS_AND_STABILITY[i - N_ANALYSES];
}

#endif
