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
    WORKS("free", hbvib_branch_free(branch));
    WORKS("free", hbvib_model_free(the_model));
    return verdict(20);
}
