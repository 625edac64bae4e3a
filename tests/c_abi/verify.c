/* Points of forced responses checked in time, and what is refused. */
#include "common.h"

enum { H = 9, COUNT = (H + 1) * NDOF };

static hbvib_verify_options verify_options(void)
{
    hbvib_verify_options o;
    if (hbvib_verify_options_init(&o, sizeof o) != HBVIB_OK) abort();
    return o;
}

static hbvib_verification verification(void)
{
    hbvib_verification v;
    if (hbvib_verification_init(&v, sizeof v) != HBVIB_OK) abort();
    return v;
}

/* The one point of the ring damper at a frequency. */
static hbvib_branch *one_point(double hz)
{
    hbvib_solver_options s = solver_options();
    hbvib_forced_options o = frequencies(hz, hz);
    hbvib_branch *branch = NULL;
    s.tolerance = 0;
    s.harmonics = H;
    WORKS("solve", hbvib_forced_response(the_model, &s, &o, NULL, &branch));
    return branch;
}

/* The truth at a frequency, "f re im" of the blade tip's fundamental, and the error of H = 9 against it. */
static void tells_the_error(hbvib_branch *branch, double re, double im, double error)
{
    hbvib_verification v = verification();
    hbvib_verify_options o = verify_options();
    double before[2 * COUNT], after[2 * COUNT], x[2 * COUNT], errors[H + 1], sum = 0, size = hypot(re, im);
    int h;

    EXPECT("defaults", o.struct_size == sizeof o && o.method == HBVIB_SHOOTING && o.tolerance == 1e-11);
    EXPECT("defaults", o.max_periods == 10000 && o.same_within == 0.1);
    WORKS("before", hbvib_branch_harmonics(branch, 0, 0, NDOF, before, COUNT));
    WORKS("check", hbvib_verify(the_model, branch, 0, &o, NULL, x, COUNT, errors, H + 1, &v));
    WORKS("after", hbvib_branch_harmonics(branch, 0, 0, NDOF, after, COUNT));
    EXPECT("point", memcmp(before, after, sizeof before) == 0);
    EXPECT("truth", hypot(x[2 * NDOF] - re, x[2 * NDOF + 1] - im) < 1e-8 * size);
    EXPECT("truth", v.response[0] == x[2 * NDOF] && v.response[1] == x[2 * NDOF + 1] && v.harmonic == 1);
    EXPECT("error", fabs(v.response_error - error) < 1e-8);
    EXPECT("same", v.same_solution == 1 && v.marched == 0 && v.reserved == 0);
    EXPECT("norms", fabs(hypot(v.motion_error, v.above) - v.distance) < 1e-12 && v.above > 1e-6);
    for (h = 0; h <= H; h++) sum += errors[h] * errors[h];
    EXPECT("norms", fabs(sqrt(sum) - v.motion_error) < 1e-12);
    EXPECT("peak", v.peak > 0.9 * size && v.peak < 1.1 * size && v.peak_error > 0 && v.peak_error < 0.1);
    EXPECT("info", v.residual <= o.tolerance && v.periods >= 1 && v.events == 8);
    o.same_within = v.distance / 2;
    WORKS("far", hbvib_verify(the_model, branch, 0, &o, NULL, NULL, 0, NULL, 0, &v));
    EXPECT("far", v.same_solution == 0);
    WORKS("nothing wanted", hbvib_verify(the_model, branch, 0, NULL, NULL, NULL, 0, NULL, 0, NULL));
}

static int32_t stop_at_once(void *user, const hbvib_progress *p)
{
    *(int64_t *)user = p->point;
    return 1;
}

static void hooks_stop_it(hbvib_branch *branch)
{
    hbvib_verification v = verification();
    hbvib_cancel_flag cancel = 1;
    hbvib_hooks hooks;
    int64_t point = 0;
    WORKS("hooks", hbvib_hooks_init(&hooks, sizeof hooks));
    hooks.progress = stop_at_once;
    hooks.user = &point;
    EXPECT("hooks", hbvib_verify(the_model, branch, 0, NULL, &hooks, NULL, 0, NULL, 0, &v) == HBVIB_STOPPED_BY_CALLER);
    EXPECT("hooks", point == 1 && v.periods == 1 && v.peak > 0);
    WORKS("hooks", hbvib_hooks_init(&hooks, sizeof hooks));
    hooks.cancel = &cancel;
    EXPECT("cancel", hbvib_verify(the_model, branch, 0, NULL, &hooks, NULL, 0, NULL, 0, &v) == HBVIB_STOPPED_BY_CALLER);
}

static void bad_input(hbvib_branch *branch)
{
    hbvib_verify_options o = verify_options(), good = o;
    hbvib_verification v = verification();
    hbvib_solver_options s = solver_options();
    hbvib_mode_options range = amplitudes(-1, 0);
    hbvib_branch *mode = NULL, *freed = one_point(208.85);
    hbvib_model *other = two_masses(ONES, RISING, 1);
    hbvib_hooks hooks;
    double x[2 * COUNT], errors[H + 1];
    x[0] = errors[0] = 77;

    REFUSED("NULL", hbvib_verify_options_init(NULL, sizeof o), HBVIB_E_NULL, 1, "hbvib_verify_options");
    REFUSED("size", hbvib_verify_options_init(&o, 8), HBVIB_E_STRUCT_SIZE, 2, "needs 32");
    REFUSED("NULL", hbvib_verification_init(NULL, sizeof v), HBVIB_E_NULL, 1, "hbvib_verification");
    REFUSED("size", hbvib_verification_init(&v, 8), HBVIB_E_STRUCT_SIZE, 2, "needs 128");
    REFUSED("NULL", hbvib_verify(NULL, branch, 0, NULL, NULL, NULL, 0, NULL, 0, &v), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("NULL", hbvib_verify(the_model, NULL, 0, NULL, NULL, NULL, 0, NULL, 0, &v), HBVIB_E_HANDLE, 2, "NULL");
    REFUSED("type", hbvib_verify((hbvib_model *)branch, branch, 0, NULL, NULL, NULL, 0, NULL, 0, &v), HBVIB_E_HANDLE, 1, "another type");
    REFUSED("type", hbvib_verify(the_model, (hbvib_branch *)the_model, 0, NULL, NULL, NULL, 0, NULL, 0, &v), HBVIB_E_HANDLE, 2, "another type");
    WORKS("freed", hbvib_branch_free(freed));
    REFUSED("freed", hbvib_verify(the_model, freed, 0, NULL, NULL, NULL, 0, NULL, 0, &v), HBVIB_E_HANDLE, 2, "freed");
    REFUSED("point", hbvib_verify(the_model, branch, -1, NULL, NULL, NULL, 0, NULL, 0, &v), HBVIB_E_INDEX, 3, "point = -1");
    REFUSED("point", hbvib_verify(the_model, branch, hbvib_branch_stored(branch), NULL, NULL, NULL, 0, NULL, 0, &v), HBVIB_E_INDEX, 3, "point = ");
    REFUSED("length", hbvib_verify(the_model, branch, 0, NULL, NULL, x, COUNT - 1, NULL, 0, &v), HBVIB_E_DIMENSION, 7, "ndof = 40");
    REFUSED("length", hbvib_verify(the_model, branch, 0, NULL, NULL, NULL, COUNT, NULL, 0, &v), HBVIB_E_NULL, 6, "ndof");
    REFUSED("length", hbvib_verify(the_model, branch, 0, NULL, NULL, NULL, 0, errors, H, &v), HBVIB_E_DIMENSION, 9, "harmonics + 1 = 10");
    REFUSED("length", hbvib_verify(the_model, branch, 0, NULL, NULL, NULL, 0, NULL, H + 1, &v), HBVIB_E_NULL, 8, "harmonics + 1");
    REFUSED("misaligned", hbvib_verify(the_model, branch, 0, NULL, NULL, (double *)((char *)x + 4), COUNT, NULL, 0, &v), HBVIB_E_ARGUMENT, 6, "misaligned");
    REFUSED("overlap", hbvib_verify(the_model, branch, 0, NULL, NULL, x, COUNT, x, H + 1, &v), HBVIB_E_ARGUMENT, 8, "overlap");
    v.struct_size = 8;
    REFUSED("size", hbvib_verify(the_model, branch, 0, NULL, NULL, NULL, 0, NULL, 0, &v), HBVIB_E_STRUCT_SIZE, 10, "hbvib_verification_init");
    v = verification();
    o.struct_size = 8;
    REFUSED("size", hbvib_verify(the_model, branch, 0, &o, NULL, NULL, 0, NULL, 0, &v), HBVIB_E_STRUCT_SIZE, 4, "hbvib_verify_options_init");
    o = good;
    o.method = 2;
    REFUSED("method", hbvib_verify(the_model, branch, 0, &o, NULL, NULL, 0, NULL, 0, &v), HBVIB_E_ARGUMENT, 4, "method = 2");
    o = good;
    o.tolerance = 1;
    REFUSED("tolerance", hbvib_verify(the_model, branch, 0, &o, NULL, NULL, 0, NULL, 0, &v), HBVIB_E_ARGUMENT, 4, "tolerance = 1");
    o = good;
    o.max_periods = -1;
    REFUSED("periods", hbvib_verify(the_model, branch, 0, &o, NULL, NULL, 0, NULL, 0, &v), HBVIB_E_ARGUMENT, 4, "max_periods = -1");
    o = good;
    o.same_within = -1;
    REFUSED("distance", hbvib_verify(the_model, branch, 0, &o, NULL, NULL, 0, NULL, 0, &v), HBVIB_E_ARGUMENT, 4, "same_within = -1");
    o.same_within = NAN;
    REFUSED("distance", hbvib_verify(the_model, branch, 0, &o, NULL, NULL, 0, NULL, 0, &v), HBVIB_E_NOT_FINITE, 4, "same_within");
    o = good;
    o.max_periods = 1;
    o.method = HBVIB_MARCHING;
    REFUSED("periods", hbvib_verify(the_model, branch, 0, &o, NULL, x, COUNT, errors, H + 1, &v), HBVIB_E_NO_CONVERGENCE, 0, "max_periods = 1");
    WORKS("hooks", hbvib_hooks_init(&hooks, sizeof hooks));
    hooks.log_level = 9;
    REFUSED("hooks", hbvib_verify(the_model, branch, 0, NULL, &hooks, NULL, 0, NULL, 0, &v), HBVIB_E_ARGUMENT, 5, "log_level = 9");
    REFUSED("other", hbvib_verify(other, branch, 0, NULL, NULL, x, COUNT, errors, H + 1, &v), HBVIB_E_ARGUMENT, 1, "another one");
    s.tolerance = 0;
    s.harmonics = 1;
    WORKS("mode", hbvib_nonlinear_mode(the_model, &s, &range, NULL, &mode));
    REFUSED("mode", hbvib_verify(the_model, mode, 0, NULL, NULL, NULL, 0, NULL, 0, &v), HBVIB_E_UNSUPPORTED, 2, "nonlinear mode");
    WORKS("free", hbvib_branch_free(mode));
    WORKS("free", hbvib_model_free(other));
    EXPECT("untouched", x[0] == 77 && errors[0] == 77 && v.periods == 0 && v.peak == 0);
}

int main(int argc, char **argv)
{
    hbvib_branch *branch;
    if (argc != 5) return 3;
    begin();
    branch = one_point(atof(argv[1]));
    tells_the_error(branch, atof(argv[2]), atof(argv[3]), atof(argv[4]));
    hooks_stop_it(branch);
    bad_input(branch);
    WORKS("free", hbvib_branch_free(branch));
    WORKS("free", hbvib_model_free(the_model));
    return verdict(70);
}
