/* Rows 55 to 83: harmonics, sampling, solver options, struct sizes, frequency ranges. */
#include "common.h"

static hbvib_branch *const KEPT = (hbvib_branch *)&the_solution;

/* Solves with changed options; the out handle must stay untouched. */
static hbvib_status with(const hbvib_solver_options *s, const hbvib_forced_options *o, const hbvib_hooks *h)
{
    hbvib_branch *branch = KEPT;
    hbvib_status status = hbvib_forced_response(the_model, s, o, h, &branch);
    if ((status < 0) != (branch == KEPT)) return 55;
    if (status >= 0) {
        hbvib_status ended = hbvib_branch_status(branch);
        if (ended != status || hbvib_branch_points(branch) < 0 || hbvib_branch_free(branch) != HBVIB_OK) return 56;
    }
    return status;
}

/* A bad value of one field of the solver options. */
#define BAD(row, field, value, wanted, words)                                                  \
    do {                                                                                       \
        hbvib_solver_options bad_ = solver_options();                                          \
        bad_.field = (value);                                                                  \
        REFUSED(row, with(&bad_, &o, NULL), wanted, 2, words);                                 \
    } while (0)

static void solver(void)
{
    hbvib_forced_options o = frequencies(207, 211);
    hbvib_solver_options s;
    hbvib_contact c = ring_contact();
    double y[4] = {0, 0, 1e-4, 0}, f[4];
    BAD("56", harmonics, -1, HBVIB_E_ARGUMENT, "harmonics = -1");
    BAD("56", harmonics, 1000000000, HBVIB_E_ARGUMENT, "harmonics = 1000000000");
    BAD("56", harmonics, INT64_MAX, HBVIB_E_ARGUMENT, "harmonics");
    BAD("57", samples, 18, HBVIB_E_ARGUMENT, "= 19");
    BAD("59", samples, 1, HBVIB_E_ARGUMENT, "samples = 1");
    BAD("59", samples, -1, HBVIB_E_ARGUMENT, "samples = -1");
    BAD("59", samples, INT64_C(1) << 40, HBVIB_E_ARGUMENT, "samples = 1099511627776");
    REFUSED("56", hbvib_contact_evaluate(&c, -1, 0, 1, y, 0, f, 0, NULL, 0), HBVIB_E_ARGUMENT, 2, "harmonics = -1");
    REFUSED("57", hbvib_contact_evaluate(&c, 1, 2, 1, y, 2, f, 2, NULL, 0), HBVIB_E_ARGUMENT, 3, "= 3");
    REFUSED("75", hbvib_contact_evaluate(&c, 1, 0, -1, y, 2, f, 2, NULL, 0), HBVIB_E_ARGUMENT, 4, "omega = -1");
    REFUSED("75", hbvib_contact_evaluate(&c, 1, 0, NAN, y, 2, f, 2, NULL, 0), HBVIB_E_ARGUMENT, 4, "omega = NaN");
    REFUSED("59", hbvib_contact_evaluate(&c, 1, -8, 1, y, 2, f, 2, NULL, 0), HBVIB_E_ARGUMENT, 3, "samples = -8");
    BAD("69", tolerance, -1, HBVIB_E_ARGUMENT, "tolerance = -1");
    BAD("69", tolerance, NAN, HBVIB_E_ARGUMENT, "tolerance = NaN");
    BAD("69", tolerance, INFINITY, HBVIB_E_ARGUMENT, "tolerance = inf");
    BAD("69", tol_residual, 0, HBVIB_E_ARGUMENT, "tol_residual = 0");
    BAD("69", tol_residual, -1, HBVIB_E_ARGUMENT, "tol_residual = -1");
    BAD("69", tol_residual, NAN, HBVIB_E_ARGUMENT, "tol_residual = NaN");
    BAD("69", tol_residual, 1e300, HBVIB_E_ARGUMENT, "tol_residual");
    BAD("70", max_newton, 0, HBVIB_E_ARGUMENT, "max_newton = 0");
    BAD("70", max_newton, -1, HBVIB_E_ARGUMENT, "max_newton = -1");
    BAD("70", max_points, 0, HBVIB_E_ARGUMENT, "max_points = 0");
    BAD("70", max_points, INT64_MIN, HBVIB_E_ARGUMENT, "max_points = -");
    BAD("70", max_harmonics, -1, HBVIB_E_ARGUMENT, "max_harmonics = -1");
    BAD("71", step, -1, HBVIB_E_ARGUMENT, "step = -1");
    BAD("71", step, NAN, HBVIB_E_ARGUMENT, "step = NaN");
    BAD("71", step_min, INFINITY, HBVIB_E_ARGUMENT, "step_min = inf");
    BAD("71", step_max, -0.5, HBVIB_E_ARGUMENT, "step_max = -0.5");
    BAD("39", response_dof, 4, HBVIB_E_INDEX, "response_dof = 4");
    BAD("39", response_dof, -2, HBVIB_E_INDEX, "response_dof = -2");
    BAD("39", response_dof, INT64_MAX, HBVIB_E_INDEX, "response_dof");
    BAD("68", estimate_error, 2, HBVIB_E_ARGUMENT, "estimate_error = 2");
    BAD("68", keep_even_harmonics, 2, HBVIB_E_ARGUMENT, "keep_even_harmonics = 2");
    BAD("68", flexibility, 3, HBVIB_E_ARGUMENT, "flexibility = 3");
    BAD("68", memory_limit, -1, HBVIB_E_ARGUMENT, "memory_limit = -1");
    BAD("68", stability, 3, HBVIB_E_ARGUMENT, "stability = 3, needs a value of enum hbvib_stability");
    BAD("68", freedom, 2, HBVIB_E_ARGUMENT, "freedom = 2, needs 0 or 1");
    BAD("68", reserved, 1, HBVIB_E_ARGUMENT, "reserved = 1, needs 0");
    BAD("83", num_threads, -1, HBVIB_E_ARGUMENT, "num_threads = -1, needs 0 or 1");
    BAD("83", num_threads, 2, HBVIB_E_ARGUMENT, "num_threads = 2, needs 0 or 1");
    s = solver_options();
    s.step_min = 1;
    s.step_max = 0.5;
    REFUSED("71", with(&s, &o, NULL), HBVIB_E_ARGUMENT, 2, "step_min");

    /* The legal ends of the ranges. */
    s = solver_options();
    s.num_threads = 1;
    WORKS("83", with(&s, &o, NULL));
    s = solver_options();
    s.max_newton = INT64_MAX;
    s.max_points = INT64_MAX;
    WORKS("70", with(&s, &o, NULL));
    s = solver_options();
    s.samples = 1009; /* row 59: a prime number */
    WORKS("59", with(&s, &o, NULL));
    s.samples = 19;
    EXPECT("58", with(&s, &o, NULL) >= 0);
    s = solver_options();
    s.step_max = 1e-14; /* row 72: a sweep that would never end */
    s.max_points = 100;
    EXPECT("72", with(&s, &o, NULL) == HBVIB_STOPPED_MAX_POINTS);
    EXPECT("72", strstr(hbvib_last_error(), "") != NULL);
    s = solver_options();
    s.tol_residual = 1e-300; /* row 69: below round-off */
    EXPECT("69", with(&s, &o, NULL) >= 0);
    REFUSED("56", (s = solver_options(), s.harmonics = 0, with(&s, &o, NULL)), HBVIB_E_ARGUMENT, 0, "harmonics = 0");
}

/* Row 66: the sizes of structs; row 67: structs that were never filled. */
static void struct_sizes(void)
{
    const uint32_t bad[] = {0, 1, 8, 96, 105, 0xAAAAAAAAu, 0xFFFFFFF8u};
    struct { hbvib_solver_options known; int64_t more[2]; } larger;
    hbvib_forced_options o = frequencies(207, 211);
    hbvib_solver_options s;
    hbvib_view view;
    hbvib_reduction reduction;
    hbvib_energy energy;
    hbvib_mode_options mode = amplitudes(1, 3);
    hbvib_mode_point point;
    hbvib_mode_info info;
    hbvib_hooks h;
    hbvib_branch *branch = NULL;
    size_t i;
    for (i = 0; i < sizeof bad / sizeof *bad; i++) {
        s = solver_options();
        s.struct_size = bad[i];
        REFUSED("66", with(&s, &o, NULL), HBVIB_E_STRUCT_SIZE, 2, "struct_size");
        REFUSED("66", hbvib_solver_options_init(&s, bad[i]), HBVIB_E_STRUCT_SIZE, 2, "struct_size");
        EXPECT("66", s.struct_size == bad[i] && s.harmonics == 9);
    }
    REFUSED("66", hbvib_matrix_init((hbvib_matrix *)&larger, 64), HBVIB_E_STRUCT_SIZE, 2, "needs 72");
    REFUSED("66", hbvib_contact_init((hbvib_contact *)&larger, 96), HBVIB_E_STRUCT_SIZE, 2, "needs 224");
    REFUSED("66", hbvib_forced_options_init(&o, 48), HBVIB_E_STRUCT_SIZE, 2, "needs 88");
    REFUSED("66", hbvib_hooks_init(&h, 32), HBVIB_E_STRUCT_SIZE, 2, "needs 48");
    REFUSED("66", hbvib_view_init(&view, 64), HBVIB_E_STRUCT_SIZE, 2, "needs 72");
    REFUSED("66", hbvib_reduction_init(&reduction, 88), HBVIB_E_STRUCT_SIZE, 2, "needs 136");
    REFUSED("66", hbvib_energy_init(&energy, 88), HBVIB_E_STRUCT_SIZE, 2, "needs 96");
    REFUSED("66", hbvib_mode_options_init(&mode, 88), HBVIB_E_STRUCT_SIZE, 2, "needs 144");
    REFUSED("66", hbvib_mode_point_init(&point, 80), HBVIB_E_STRUCT_SIZE, 2, "needs 88");
    REFUSED("66", hbvib_mode_info_init(&info, 56), HBVIB_E_STRUCT_SIZE, 2, "needs 80");
    memset(&s, 0xAA, sizeof s);
    REFUSED("67", with(&s, &o, NULL), HBVIB_E_STRUCT_SIZE, 2, "hbvib_solver_options_init");
    memset(&o, 0xAA, sizeof o);
    REFUSED("67", with(NULL, &o, NULL), HBVIB_E_STRUCT_SIZE, 3, "hbvib_forced_options_init");
    memset(&h, 0xAA, sizeof h);
    o = frequencies(207, 211);
    REFUSED("67", with(NULL, &o, &h), HBVIB_E_STRUCT_SIZE, 4, "hbvib_hooks_init");
    memset(&mode, 0xAA, sizeof mode);
    REFUSED("67", hbvib_nonlinear_mode(the_model, NULL, &mode, NULL, &branch), HBVIB_E_STRUCT_SIZE, 3,
            "hbvib_mode_options_init");
    mode = amplitudes(1, 3);
    memset(&point, 0xAA, sizeof point);
    memset(&info, 0xAA, sizeof info);
    WORKS("67", hbvib_nonlinear_mode(the_model, NULL, &mode, NULL, &branch));
    REFUSED("67", hbvib_branch_mode_point(branch, 0, &point), HBVIB_E_STRUCT_SIZE, 3, "hbvib_mode_point_init");
    REFUSED("67", hbvib_branch_mode_info(branch, &info), HBVIB_E_STRUCT_SIZE, 2, "hbvib_mode_info_init");
    WORKS("67", hbvib_branch_free(branch));
    branch = NULL;
    memset(&view, 0xAA, sizeof view);
    memset(&reduction, 0xAA, sizeof reduction);
    memset(&energy, 0xAA, sizeof energy);
    s = solver_options();
    WORKS("67", hbvib_forced_response(the_model, &s, &o, NULL, &branch));
    REFUSED("67", hbvib_branch_field(branch, HBVIB_OMEGA, &view), HBVIB_E_STRUCT_SIZE, 3, "hbvib_view_init");
    REFUSED("67", hbvib_branch_reduction(branch, &reduction), HBVIB_E_STRUCT_SIZE, 2, "hbvib_reduction_init");
    REFUSED("67", hbvib_branch_energy(branch, 0, &energy), HBVIB_E_STRUCT_SIZE, 3, "hbvib_energy_init");
    WORKS("67", hbvib_reduction_init(&reduction, sizeof reduction));
    WORKS("67", hbvib_branch_reduction(branch, &reduction));
    EXPECT("67", reduction.sectors == 24 && reduction.degrees_of_freedom == 4 && reduction.coordinates == 1 &&
                     reduction.harmonics_carried == 5 && reduction.unknowns == 10 && reduction.even_removed == 1 && reduction.held_by_contacts == 0 &&
                     reduction.struct_size == sizeof reduction && reduction.response_dof == 0);
    WORKS("67", hbvib_branch_free(branch));

    /* A newer header: accepted while it asks for nothing that is unknown here. */
    memset(&larger, 0xAA, sizeof larger);
    WORKS("66", hbvib_solver_options_init(&larger.known, sizeof larger));
    EXPECT("66", larger.known.struct_size == sizeof larger && larger.more[0] == 0 && larger.more[1] == 0);
    WORKS("66", with(&larger.known, &o, NULL));
    larger.more[1] = 1;
    REFUSED("66", with(&larger.known, &o, NULL), HBVIB_E_STRUCT_SIZE, 2, "newer library");
}

static void ranges(void)
{
    const double bad[] = {0, -1, NAN, INFINITY, -INFINITY};
    hbvib_forced_options o;
    hbvib_hooks h;
    double at[2], x[80] = {0}, r[80];
    size_t i;
    for (i = 0; i < sizeof bad / sizeof *bad; i++) { /* row 75 */
        hbvib_status wanted = i < 2 ? HBVIB_E_ARGUMENT : HBVIB_E_NOT_FINITE;
        o = frequencies(207, 211);
        o.omega_start = bad[i];
        REFUSED("75", with(NULL, &o, NULL), wanted, 3, "omega_start");
        o = frequencies(207, 211);
        o.omega_stop = bad[i];
        REFUSED("75", with(NULL, &o, NULL), wanted, 3, "omega_stop");
        o = frequencies(207, 211);
        at[0] = 2 * PI * 208;
        at[1] = bad[i];
        o.at = at;
        o.at_len = 2;
        REFUSED("75", with(NULL, &o, NULL), wanted, 3, "at[1]");
        if (i > 0)
            REFUSED("75", hbvib_forced_residual(the_model, NULL, bad[i], x, 40, r, 40, NULL, 0, NULL, 0), wanted, 3, "omega");
    }
    o = frequencies(207, 211);
    o.together = 2;
    REFUSED("68", with(NULL, &o, NULL), HBVIB_E_ARGUMENT, 3, "together = 2");
    o = frequencies(1e-300, 1e300); /* row 75: extreme, but a defined status */
    {
        hbvib_solver_options s = solver_options();
        hbvib_status status;
        s.max_points = 200;
        status = with(&s, &o, NULL);
        EXPECT("75", status != HBVIB_E_INTERNAL && status < 50);
    }
    o = frequencies(211, 207); /* row 73 */
    WORKS("73", with(NULL, &o, NULL));
    o = frequencies(208, 208); /* row 74 */
    WORKS("74", with(NULL, &o, NULL));
    o = frequencies(207, 211);
    WORKS("3", with(NULL, &o, NULL)); /* row 3: NULL options and hooks are the defaults */

    WORKS("68", hbvib_hooks_init(&h, sizeof h));
    h.log_level = 4;
    REFUSED("68", with(NULL, &o, &h), HBVIB_E_ARGUMENT, 4, "log_level = 4");
    h.log_level = 0;
    h.cancel = (const hbvib_cancel_flag *)((const char *)x + 2);
    REFUSED("14", with(NULL, &o, &h), HBVIB_E_ARGUMENT, 4, "misaligned");

    { /* rows 61, 62: sectors and engine orders */
        const int64_t sectors[] = {0, -1, INT64_MIN, INT64_MAX, 2000000};
        const int64_t same[] = {26, -22, 2 + 24 * INT64_C(1000000)};
        hbvib_model *none = NULL;
        for (i = 0; i < sizeof sectors / sizeof *sectors; i++)
            REFUSED("62", hbvib_cyclic_new(4, sectors[i], &none), HBVIB_E_ARGUMENT, 2, "sectors");
        EXPECT("62", none == NULL);
        WORKS("62", hbvib_cyclic_new(4, 1, &none));
        WORKS("62", hbvib_model_free(none));
        for (i = 0; i < sizeof same / sizeof *same; i++) {
            WORKS("61", hbvib_cyclic_set_wave(the_model, same[i]));
            EXPECT("61", same_solution(the_model, &the_solution));
        }
        WORKS("61", hbvib_cyclic_set_wave(the_model, INT64_MIN));
        WORKS("61", with(NULL, &o, NULL));
        WORKS("61", hbvib_cyclic_set_wave(the_model, 2));
    }
    { /* row 81: a guess far away */
        double guess[80];
        hbvib_status status;
        for (i = 0; i < 80; i++) guess[i] = 1e150;
        o.guess = guess;
        o.guess_len = 40;
        status = with(NULL, &o, NULL);
        EXPECT("81", status == HBVIB_OK || status == HBVIB_E_NO_CONVERGENCE);
        o.guess_len = 39;
        REFUSED("12", with(NULL, &o, NULL), HBVIB_E_DIMENSION, 3, "guess_len = 39, needs (H + 1) * ndof, a multiple of 4");
    }
}

int main(void)
{
    begin();
    solver();
    struct_sizes();
    ranges();
    WORKS("55", hbvib_model_free(the_model));
    return verdict(100);
}
