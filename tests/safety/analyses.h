/* Every analysis of the library on a given model, reduced to a number that changes with any bit of its results. Each
 * function returns the status of the first call that fails, and leaves nothing behind. */
#ifndef ANALYSES_H
#define ANALYSES_H

#include "models.h"

/* Arrays of the analyses, not on the stack; a program with threads defines it as static __thread. */
#ifndef BUFFER
#define BUFFER static
#endif

/* FNV-1a. */
static void digest(uint64_t *sum, const void *bytes, size_t n)
{
    const unsigned char *b = bytes;
    while (n-- > 0) *sum = (*sum ^ *b++) * 1099511628211u;
}

/* All that can be asked of a point of a branch. */
static hbvib_status of_point(const hbvib_branch *branch, int64_t point, int64_t ndof, uint64_t *sum)
{
    BUFFER double x[2 * 400 * 4], y[64], force[64];
    BUFFER int32_t state[64];
    hbvib_reduction reduction;
    hbvib_energy energy;
    hbvib_contact_summary summary;
    const int64_t n = ndof < 4 ? ndof : 4;
    hbvib_status status = HBVIB_OK;
    memset(&reduction, 0, sizeof reduction);
    memset(&energy, 0, sizeof energy);
    memset(&summary, 0, sizeof summary);
    STEP(hbvib_reduction_init(&reduction, sizeof reduction));
    STEP(hbvib_branch_reduction(branch, &reduction));
    if (status < 0 || reduction.harmonics_asked >= 400) return status;
    STEP(hbvib_branch_harmonics(branch, point, 0, n, x, (reduction.harmonics_asked + 1) * n));
    if (status >= 0) digest(sum, x, (size_t)((reduction.harmonics_asked + 1) * n) * 2 * sizeof *x);
    STEP(hbvib_energy_init(&energy, sizeof energy));
    STEP(hbvib_branch_energy(branch, point, &energy));
    STEP(hbvib_contact_summary_init(&summary, sizeof summary));
    STEP(hbvib_branch_time_history(branch, point, 0, 64, y));
    if (status >= 0) digest(sum, y, sizeof y);
    if (reduction.contacts > 0) {
        STEP(hbvib_branch_contact_summary(branch, point, 0, &summary));
        STEP(hbvib_branch_contact_loop(branch, point, 0, 0, 64, y, force, state));
        if (status >= 0) digest(sum, force, sizeof force);
    }
    digest(sum, &energy, sizeof energy);
    digest(sum, &summary, sizeof summary);
    return status;
}

/* All fields, special points and the last point of a branch, which is freed. */
static hbvib_status of_branch(hbvib_status status, hbvib_branch *branch, int64_t ndof, uint64_t *sum)
{
    double omega[16], amplitude[16], slope[16];
    int64_t point[16], count = 0, at[16];
    int32_t field;
    hbvib_status freed;
    digest(sum, &status, sizeof status);
    if (branch == NULL) return status;
    for (field = HBVIB_OMEGA; field <= HBVIB_DAMPING_ERROR_ESTIMATE && status >= 0; field++) {
        hbvib_view view;
        memset(&view, 0, sizeof view);
        STEP(hbvib_view_init(&view, sizeof view));
        if (status >= 0 && hbvib_branch_field(branch, field, &view) == HBVIB_OK && view.data != NULL)
            digest(sum, view.data, (size_t)(view.shape[0] * view.shape[1]) * sizeof(double));
    }
    STEP(hbvib_branch_peaks(branch, 16, omega, amplitude, point, &count));
    if (status >= 0) digest(sum, amplitude, (size_t)count * sizeof(double));
    STEP(hbvib_branch_folds(branch, 16, omega, amplitude, point, &count));
    STEP(hbvib_branch_limit_cycles(branch, 16, omega, amplitude, slope, at, &count));
    if (status >= 0 && hbvib_branch_points(branch) > 0)
        STEP(of_point(branch, hbvib_branch_stored(branch) - 1, ndof, sum));
    freed = hbvib_branch_free(branch);
    return freed == HBVIB_OK ? status : HBVIB_E_INTERNAL;
}

static hbvib_solver_options options(double tolerance)
{
    hbvib_solver_options s;
    memset(&s, 0, sizeof s);
    hbvib_solver_options_init(&s, sizeof s);
    s.tolerance = tolerance;
    s.harmonics = 3;
    s.max_harmonics = 20;
    s.max_points = 8;
    return s;
}

/* The share of the first resonance in which all models are solved. */
static hbvib_forced_options range(const hbvib_model *model)
{
    const int64_t ndof = hbvib_model_dofs(model);
    const double middle = ndof == 4 ? 1313 : ndof == LONG ? 0.4 : 1.3;
    hbvib_forced_options o;
    memset(&o, 0, sizeof o);
    hbvib_forced_options_init(&o, sizeof o);
    o.omega_start = (ndof == 4 ? 0.999 : 0.985) * middle;
    o.omega_stop = (ndof == 4 ? 1.001 : 1.01) * middle;
    return o;
}

static hbvib_status respond(const hbvib_model *model, hbvib_solver_options s, uint64_t *sum)
{
    hbvib_forced_options o = range(model);
    hbvib_branch *branch = NULL;
    hbvib_status status = hbvib_forced_response(model, &s, &o, NULL, &branch);
    return of_branch(status, branch, hbvib_model_dofs(model), sum);
}

static hbvib_status forced(const hbvib_model *model, uint64_t *sum)
{
    return respond(model, options(0), sum);
}

static hbvib_status forced_to_tolerance(const hbvib_model *model, uint64_t *sum)
{
    return respond(model, options(1e-2), sum);
}

static hbvib_status forced_directly(const hbvib_model *model, uint64_t *sum)
{
    hbvib_solver_options s = options(0);
    s.flexibility = HBVIB_FLEXIBILITY_DIRECT;
    return respond(model, s, sum);
}

static hbvib_status forced_on_basis(const hbvib_model *model, uint64_t *sum)
{
    hbvib_solver_options s = options(0);
    s.flexibility = HBVIB_FLEXIBILITY_KRYLOV;
    return respond(model, s, sum);
}

/* A response to a tolerance on a basis, whose first amplitude is that without a basis. */
static hbvib_status on_basis_to_tolerance(const hbvib_model *model, uint64_t *sum)
{
    double amplitude[2] = {0, 0};
    hbvib_forced_options o = range(model);
    hbvib_status status = HBVIB_OK;
    int i;
    for (i = 0; i < 2 && status >= 0; i++) {
        hbvib_solver_options s = options(1e-2);
        hbvib_branch *branch = NULL;
        hbvib_view view;
        s.flexibility = i == 0 ? HBVIB_FLEXIBILITY_DIRECT : HBVIB_FLEXIBILITY_KRYLOV;
        memset(&view, 0, sizeof view);
        STEP(hbvib_view_init(&view, sizeof view));
        STEP(hbvib_forced_response(model, &s, &o, NULL, &branch));
        STEP(hbvib_branch_field(branch, HBVIB_AMPLITUDE, &view));
        if (status >= 0) amplitude[i] = view.data[0];
        status = of_branch(status, branch, hbvib_model_dofs(model), sum);
    }
    if (status >= 0 && fabs(amplitude[1] / amplitude[0] - 1) > 1e-6) return HBVIB_E_INTERNAL;
    return status;
}

/* A nonlinear mode, and the response synthesised from it. */
static hbvib_status follow(const hbvib_model *model, hbvib_solver_options s, uint64_t *sum)
{
    BUFFER double omega[256], response[512], modal[256];
    double peak[16];
    int64_t count = 0;
    hbvib_mode_options o;
    hbvib_branch *branch = NULL;
    hbvib_status status = HBVIB_OK, synthesised = HBVIB_OK;
    s.max_points = 60;
    memset(&o, 0, sizeof o);
    hbvib_mode_options_init(&o, sizeof o);
    o.log10_start = hbvib_model_dofs(model) == 4 ? -5.5 : -1;
    o.log10_stop = o.log10_start + 1;
    STEP(hbvib_nonlinear_mode(model, &s, &o, NULL, &branch));
    if (branch != NULL) {
        synthesised = hbvib_branch_synthesis(branch, model, NULL, 256, omega, response, modal, &count);
        if (synthesised == HBVIB_OK) digest(sum, response, (size_t)count * 2 * sizeof(double));
        if (synthesised == HBVIB_OK)
            synthesised = hbvib_branch_synthesis_peaks(branch, model, NULL, 16, peak, NULL, NULL, NULL, NULL, NULL, NULL, &count);
        if (synthesised == HBVIB_OK) digest(sum, peak, (size_t)count * sizeof(double));
        digest(sum, &synthesised, sizeof synthesised);
    }
    status = of_branch(status, branch, hbvib_model_dofs(model), sum);
    return synthesised < 0 ? synthesised : status;
}

static hbvib_status mode(const hbvib_model *model, uint64_t *sum)
{
    return follow(model, options(0), sum);
}

static hbvib_status mode_to_tolerance(const hbvib_model *model, uint64_t *sum)
{
    return follow(model, options(1e-2), sum);
}

/* Shooting, marching, a point compared with time, and its multipliers. */
static hbvib_status in_time(const hbvib_model *model, uint64_t *sum)
{
    BUFFER double x[2 * 10 * 9], samples[16 * 9], multipliers[2 * 400];
    BUFFER int64_t classes[400];
    const int64_t ndof = hbvib_model_dofs(model);
    hbvib_solver_options s = options(0);
    hbvib_forced_options o = range(model);
    hbvib_time_options t;
    hbvib_time_info info;
    hbvib_verification v;
    hbvib_floquet_options f;
    hbvib_floquet_info i;
    hbvib_branch *branch = NULL;
    hbvib_status status = HBVIB_OK, freed = HBVIB_OK;
    memset(&t, 0, sizeof t);
    memset(&info, 0, sizeof info);
    memset(&v, 0, sizeof v);
    memset(&f, 0, sizeof f);
    memset(&i, 0, sizeof i);
    STEP(hbvib_time_options_init(&t, sizeof t));
    STEP(hbvib_time_info_init(&info, sizeof info));
    STEP(hbvib_verification_init(&v, sizeof v));
    STEP(hbvib_floquet_options_init(&f, sizeof f));
    STEP(hbvib_floquet_info_init(&i, sizeof i));
    t.omega = o.omega_start;
    t.samples = 16;
    STEP(hbvib_time_response(model, &t, NULL, x, 10 * ndof, samples, 16 * ndof, &info));
    if (status >= 0) digest(sum, samples, (size_t)(16 * ndof) * sizeof(double));
    t.method = HBVIB_MARCHING;
    t.tolerance = 1e-5;
    /* The wheel is damped too lightly to be marched in a short time. */
    if (hbvib_model_sectors(model) == 1) STEP(hbvib_time_response(model, &t, NULL, x, 10 * ndof, NULL, 0, &info));
    if (status >= 0) digest(sum, x, (size_t)(20 * ndof) * sizeof(double));
    o.omega_stop = o.omega_start;
    s.harmonics = 9;
    STEP(hbvib_forced_response(model, &s, &o, NULL, &branch));
    STEP(hbvib_verify(model, branch, 0, NULL, NULL, NULL, 0, NULL, 0, &v));
    digest(sum, &v, sizeof v);
    STEP(hbvib_floquet(model, branch, 0, &f, NULL, multipliers, 400, classes, 400, &i));
    if (status >= 0) digest(sum, multipliers, (size_t)(i.count < 400 ? i.count : 400) * 2 * sizeof(double));
    if (branch != NULL) freed = hbvib_branch_free(branch);
    return freed == HBVIB_OK ? status : HBVIB_E_INTERNAL;
}

/* Linear and damped modes, a Campbell diagram and its crossings, where the model has them. */
static hbvib_status linear(const hbvib_model *model, uint64_t *sum)
{
    BUFFER double omega[9], shapes[18 * 9], eigenvalues[4], diagram[6];
    static const double speeds[3] = {0, 0.4, 0.8};
    double speed[6], crossing[6];
    int64_t direction[6], found = 0;
    hbvib_status status = HBVIB_OK;
    STEP(hbvib_linear_modes(model, 0, HBVIB_CONTACTS_STUCK, 2, omega, shapes));
    STEP(hbvib_linear_modes(model, 0, HBVIB_CONTACTS_STATIC, 2, omega, NULL));
    STEP(hbvib_damped_modes(model, 0, HBVIB_CONTACTS_FREE, 2, eigenvalues, NULL, direction, NULL));
    STEP(hbvib_campbell(model, 3, speeds, 0, HBVIB_CONTACTS_FREE, 2, diagram, NULL, NULL, NULL));
    STEP(hbvib_campbell_crossings(model, 3, speeds, 0, HBVIB_CONTACTS_FREE, 2, 3, 6, speed, crossing, direction, &found, NULL));
    digest(sum, omega, sizeof omega);
    digest(sum, eigenvalues, sizeof eigenvalues);
    digest(sum, diagram, sizeof diagram);
    return status;
}

/* The residual at a motion, the forces of the laws of the header, derivatives of a force of the caller. */
static hbvib_status low_level(const hbvib_model *model, uint64_t *sum)
{
    enum { H = 3, N = 3 * (H + 1) };
    BUFFER double x[2 * N], r[2 * N], jac[4 * N * N], d_omega[2 * N];
    static const int32_t kinds[6] = {HBVIB_JENKINS, HBVIB_FRICTION_2D, HBVIB_FRICTION_3D, HBVIB_UNILATERAL, HBVIB_CUBIC, HBVIB_REGULARISED};
    static const int64_t directions[6] = {1, 2, 3, 1, 1, 1};
    const double amplitude[1] = {0.5};
    hbvib_solver_options s = options(0);
    hbvib_jacobian_gap gap;
    hbvib_status status = HBVIB_OK;
    int i;
    memset(&gap, 0, sizeof gap);
    for (i = 0; i < 2 * N; i++) x[i] = 0.1 * (double)(i % 7) - 0.2;
    STEP(hbvib_forced_residual(model, &s, 1.1, x, N, r, N, jac, 4 * N * N, d_omega, N));
    if (status >= 0) digest(sum, jac, sizeof jac);
    for (i = 0; i < 6; i++) {
        const int64_t n = directions[i] * (H + 1);
        hbvib_contact c = law(kinds[i], 0, 1, 2);
        c.kt = i == 3 || i == 5 ? 0 : 1;
        c.kn = i == 1 || i == 2 || i == 3 ? 1 : 0;
        c.mu = i == 3 || i == 4 ? 0 : 0.3;
        c.preload = i == 4 ? 0 : 0.2;
        c.cubic = i == 4;
        c.velocity = i == 5 ? 0.1 : 0;
        STEP(hbvib_contact_evaluate(&c, H, 0, 1.1, x, n, r, n, jac, 4 * n * n));
        if (status >= 0) digest(sum, r, (size_t)(2 * n) * sizeof *r);
    }
    STEP(hbvib_jacobian_gap_init(&gap, sizeof gap));
    STEP(hbvib_check_jacobian(model, 0, 1.1, amplitude, 1, &gap));
    digest(sum, &gap, sizeof gap);
    return status;
}

/* A forced response of a model that was saved and loaded. */
static hbvib_status saved(const hbvib_model *model, uint64_t *sum)
{
    BUFFER unsigned char bytes[1 << 16];
    hbvib_model *copy = NULL;
    int64_t size = 0;
    hbvib_status status = HBVIB_OK, freed = HBVIB_OK;
    STEP(hbvib_model_save(model, sizeof bytes, bytes, &size));
    STEP(hbvib_model_load(size, bytes, &copy));
    STEP(forced(copy, sum));
    if (copy != NULL) freed = hbvib_model_free(copy);
    return freed == HBVIB_OK ? status : HBVIB_E_INTERNAL;
}

/* A model and an analysis of it. */
typedef struct analysis {
    const char *name;
    hbvib_status (*build)(hbvib_model **model);
    hbvib_status (*run)(const hbvib_model *model, uint64_t *sum);
} analysis;

static const analysis ANALYSES[] = {
    {"forced", ring, forced},
    {"forced to a tolerance", ring, forced_to_tolerance},
    {"mode", ring, mode},
    {"mode to a tolerance", ring, mode_to_tolerance},
    {"wheel in time", small_ring, in_time},
    {"chain, directly", chain, forced_directly},
    {"chain, basis", chain, forced_on_basis},
    {"sector, basis to a tolerance", faces, on_basis_to_tolerance},
    {"friction in one direction", friction_2d, forced},
    {"friction in a plane", friction_3d, forced},
    {"unilateral", unilateral, forced},
    {"unilateral in time", unilateral, in_time},
    {"cubic to a tolerance", cubic, forced_to_tolerance},
    {"cubic in time", cubic, in_time},
    {"cubic mode", cubic, mode},
    {"regularised", regularised, forced},
    {"Iwan", iwan, forced},
    {"table", table, forced},
    {"polynomials", polynomials, forced},
    {"law of the caller", caller_law, forced},
    {"low level", caller_law, low_level},
    {"rotor", rotor, linear},
    {"rotor, forced", rotor, forced},
    {"faces", faces, forced},
    {"saved and loaded", faces, saved},
    {"saved and loaded polynomials", polynomials, saved},
    {"saved and loaded table", table, saved},
};
enum { N_ANALYSES = sizeof ANALYSES / sizeof *ANALYSES };

#endif
