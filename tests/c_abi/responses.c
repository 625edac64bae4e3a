/* Responses of a forced response: their values, peaks and derivatives against other calls, and refusals. */
#include "common.h"

static const int64_t TIP[1] = {0}, PAIR[2] = {0, 1};
static const double DIFFERENCE[2] = {1, -1};

static hbvib_response gauge(int32_t measure, int64_t n, const int64_t *dofs, const double *weights)
{
    hbvib_response r;
    WORKS("init", hbvib_response_init(&r, sizeof r));
    EXPECT("init", r.measure == HBVIB_MEASURE_FUNDAMENTAL && r.harmonic == 1 && r.n == 0 && r.sector == 0);
    r.measure = measure;
    r.n = n;
    r.dofs = dofs;
    r.weights = weights;
    return r;
}

static const double *lent(const hbvib_branch *branch, int64_t response, int32_t reading, int64_t *points)
{
    hbvib_view view;
    WORKS("view", hbvib_view_init(&view, sizeof view));
    WORKS("view", hbvib_branch_response(branch, response, reading, &view));
    EXPECT("view", view.rank == 1 && view.scalar == (reading == HBVIB_READING_COMPLEX ? HBVIB_COMPLEX : HBVIB_REAL));
    *points = view.shape[0];
    return view.data;
}

static void values(hbvib_model *model)
{
    hbvib_solver_options s = solver_options();
    hbvib_forced_options o = frequencies(207, 211);
    hbvib_response watched[3];
    hbvib_branch *branch = NULL;
    double omega[8], value[8], omega0[8], amplitude0[8], x[2 * 4 * 10], found, complex_value[2], instant, derivative, peak_derivative;
    const double *tip, *number, *phase, *errors;
    int64_t points = 0, peaks = 0, peaks0 = 0, at[8], stored, k;
    hbvib_parameter force;
    watched[0] = gauge(HBVIB_MEASURE_FUNDAMENTAL, 1, TIP, NULL);
    watched[1] = gauge(HBVIB_MEASURE_PEAK, 2, PAIR, DIFFERENCE);
    watched[2] = gauge(HBVIB_MEASURE_RMS, 1, TIP, NULL);
    watched[2].component = HBVIB_VELOCITY;
    watched[2].sector = 5;
    s.harmonics = 9;
    s.response_dof = 0;
    o.responses = watched;
    o.responses_len = 3;
    WORKS("solve", hbvib_forced_response(model, &s, &o, NULL, &branch));
    EXPECT("count", hbvib_branch_responses(branch) == 3);
    stored = hbvib_branch_stored(branch);

    tip = lent(branch, 0, HBVIB_READING_VALUE, &points);
    number = lent(branch, 0, HBVIB_READING_COMPLEX, &points);
    EXPECT("stored", points == stored);
    for (k = 0; k < stored; k++) EXPECT("complex", fabs(hypot(number[2 * k], number[2 * k + 1]) - tip[k]) <= 1e-9 * tip[k]);
    errors = lent(branch, 1, HBVIB_READING_ERROR, &points);
    phase = lent(branch, 1, HBVIB_READING_INSTANT, &points);
    EXPECT("no errors without a tolerance", isnan(errors[0]) && phase[0] >= 0 && phase[0] < 2 * PI);
    number = lent(branch, 2, HBVIB_READING_COMPLEX, &points);
    EXPECT("no complex RMS", isnan(number[0]));

    WORKS("peaks", hbvib_branch_response_peaks(branch, 0, 8, omega, value, at, &peaks));
    WORKS("peaks", hbvib_branch_peaks(branch, 8, omega0, amplitude0, NULL, &peaks0));
    EXPECT("the first leads", peaks == peaks0 && peaks == 1 && omega[0] == omega0[0] && value[0] == amplitude0[0] && tip[at[0]] == value[0]);
    for (k = 1; k < 3; k++) {
        WORKS("peaks", hbvib_branch_response_peaks(branch, k, 8, omega, value, at, &peaks));
        EXPECT("a peak", peaks == 1 && lent(branch, k, HBVIB_READING_VALUE, &points)[at[0]] == value[0]);
    }
    peaks = 0;
    WORKS("count", hbvib_branch_response_peaks(branch, 2, 0, NULL, NULL, NULL, &peaks));
    EXPECT("count", peaks == 1);

    /* The same number from the harmonics of the point, one sector as good as another. */
    WORKS("harmonics", hbvib_branch_harmonics(branch, at[0], 0, 4, x, 40));
    watched[2].sector = 0;
    WORKS("read", hbvib_response_of(&watched[2], 4, omega[0], x, 40, &found, complex_value, &instant));
    EXPECT("read", fabs(found - value[0]) <= 1e-9 * value[0] && isnan(complex_value[0]) && isnan(instant));
    WORKS("read", hbvib_response_of(&watched[1], 4, omega[0], x, 40, &found, NULL, &instant));
    EXPECT("read", fabs(found - lent(branch, 1, HBVIB_READING_VALUE, &points)[at[0]]) <= 1e-9 * found && instant >= 0);

    {
        double again[3 * 200], both[2 * 3 * 200], instants[3 * 200];
        const int64_t all = 3 * stored;
        EXPECT("fits", stored <= 200);
        watched[2].sector = 5;
        WORKS("read", hbvib_branch_read_responses(branch, watched, 3, again, all, both, all, instants, all, NULL));
        for (k = 0; k < stored; k++)
            EXPECT("read", fabs(again[k] - tip[k]) <= 1e-9 * tip[k] && fabs(hypot(both[2 * k], both[2 * k + 1]) - tip[k]) <= 1e-9 * tip[k] &&
                               isnan(instants[k]) && fabs(instants[stored + k] - phase[k]) < 1e-6);
        WORKS("less", hbvib_branch_read_responses(branch, watched, 3, again, all, NULL, 0, NULL, 0, NULL));
        REFUSED("room", hbvib_branch_read_responses(branch, watched, 3, again, all - 1, NULL, 0, NULL, 0, NULL), HBVIB_E_DIMENSION, 5,
                "responses_len * stored points");
        REFUSED("overlap", hbvib_branch_read_responses(branch, watched, 3, again, all, NULL, 0, again, all, NULL), HBVIB_E_ARGUMENT, 8,
                "overlap");
        watched[1].sector = 99;
        REFUSED("sector", hbvib_branch_read_responses(branch, watched, 3, again, all, NULL, 0, NULL, 0, NULL), HBVIB_E_INDEX, 2,
                "responses[1]: sector = 99");
        watched[1].sector = 0;
        watched[2].sector = 0;
        REFUSED("leading", hbvib_branch_leading_response(branch, 0), HBVIB_E_ARGUMENT, 2, "no error of a response is known");
        REFUSED("leading", hbvib_branch_leading_response(branch, stored), HBVIB_E_INDEX, 2, "point");
    }

    {
        int64_t kinks = -1, before[1], after[1];
        WORKS("kinks", hbvib_branch_response_kinks(branch, 1, 1, omega, value, before, after, &kinks));
        EXPECT("one blade has none", kinks == 0);
        WORKS("count", hbvib_branch_response_kinks(branch, 0, 0, NULL, NULL, NULL, NULL, &kinks));
        REFUSED("response", hbvib_branch_response_kinks(branch, 3, 1, omega, value, before, after, &kinks), HBVIB_E_INDEX, 2, "response = 3");
        WORKS("again", hbvib_branch_response_peaks(branch, 2, 8, omega, value, at, &peaks));
    }

    /* At a peak the derivative at a fixed frequency is that of the peak. */
    WORKS("parameter", hbvib_parameter_init(&force, sizeof force));
    WORKS("derivative", hbvib_sensitivity(model, branch, at[0], HBVIB_OF_RESPONSE + 2, &force, 1, &derivative, 1, NULL, NULL, NULL));
    EXPECT("derivative", derivative > 0 && derivative < 2 * value[0]);
    WORKS("derivative", hbvib_sensitivity(model, branch, at[0], HBVIB_OF_RESPONSE_PEAK_OMEGA + 2, &force, 1, &peak_derivative, 1, NULL,
                                          NULL, NULL));
    EXPECT("derivative", fabs(peak_derivative) < 1e-2 * omega[0] && peak_derivative != 0);
    REFUSED("no such response", hbvib_sensitivity(model, branch, at[0], HBVIB_OF_RESPONSE + 3, &force, 1, &derivative, 1, NULL, NULL, NULL),
            HBVIB_E_ARGUMENT, 0, "response 3");
    REFUSED("another peak", hbvib_sensitivity(model, branch, 0, HBVIB_OF_RESPONSE_PEAK_OMEGA, &force, 1, &derivative, 1, NULL, NULL, NULL),
            HBVIB_E_ARGUMENT, 0, "is no peak of response 0");

    {
        hbvib_view view;
        double two[2];
        WORKS("view", hbvib_view_init(&view, sizeof view));
        REFUSED("response", hbvib_branch_response(branch, 3, HBVIB_READING_VALUE, &view), HBVIB_E_INDEX, 2, "needs 0 .. 2");
        REFUSED("reading", hbvib_branch_response(branch, 0, 9, &view), HBVIB_E_ARGUMENT, 3, "reading = 9");
        REFUSED("response", hbvib_branch_response_peaks(branch, -1, 8, omega, value, at, &peaks), HBVIB_E_INDEX, 2, "response = -1");
        REFUSED("room", hbvib_branch_response_peaks(branch, 0, 0, two, NULL, NULL, &peaks), HBVIB_E_DIMENSION, 3, "capacity");
        REFUSED("sector", hbvib_response_of(&watched[0], 4, 1, x, 39, &found, NULL, NULL), HBVIB_E_DIMENSION, 0, "39 complex entries");
    }
    WORKS("free", hbvib_branch_free(branch));

    /* A tolerance holds for each, or for all in one norm. */
    s.tolerance = 1e-3;
    for (o.together = 0; o.together < 2; o.together++) {
        hbvib_verification checked;
        WORKS("solve", hbvib_forced_response(model, &s, &o, NULL, &branch));
        k = hbvib_branch_leading_response(branch, 0);
        EXPECT("leading", k >= 0 && k < 3);
        WORKS("verify", hbvib_verification_init(&checked, sizeof checked));
        EXPECT("verify", checked.worst_response == 0 && checked.worst_response_error == 0);
        WORKS("verify", hbvib_verify(model, branch, 0, NULL, NULL, NULL, 0, NULL, 0, &checked));
        EXPECT("verify", checked.worst_response >= 0 && checked.worst_response_error < 2e-3);
        WORKS("free", hbvib_branch_free(branch));
    }
    REFUSED("together", hbvib_forced_response(model, &s, &o, NULL, &branch), HBVIB_E_ARGUMENT, 3, "together = 2");
}

static void refusals(hbvib_model *model)
{
    hbvib_solver_options s = solver_options();
    hbvib_forced_options o = frequencies(207, 211);
    hbvib_response r = gauge(HBVIB_MEASURE_PEAK, 1, TIP, NULL);
    const double zero[1] = {0}, not_finite[1] = {NAN};
    const int64_t far[1] = {4};
    hbvib_branch *branch = NULL;
    o.responses = &r;
    o.responses_len = 1;
#define GIVES(row, wanted, words) REFUSED(row, hbvib_forced_response(model, &s, &o, NULL, &branch), wanted, 3, words)
    o.responses_len = -1;
    GIVES("count", HBVIB_E_DIMENSION, "responses_len = -1");
    o.responses_len = 1;
    o.responses = NULL;
    GIVES("null", HBVIB_E_NULL, "responses is NULL");
    o.responses = &r;
    r.measure = 5;
    GIVES("measure", HBVIB_E_ARGUMENT, "responses[0]: measure = 5");
    r.measure = HBVIB_MEASURE_HARMONIC;
    r.harmonic = -1;
    GIVES("harmonic", HBVIB_E_ARGUMENT, "harmonic = -1");
    r.harmonic = 1;
    r.dofs = far;
    GIVES("dof", HBVIB_E_INDEX, "responses[0]: dofs[0] = 4");
    r.dofs = TIP;
    r.component = 3;
    GIVES("component", HBVIB_E_ARGUMENT, "component = 3");
    r.component = HBVIB_ACCELERATION;
    r.reserved = 1;
    GIVES("reserved", HBVIB_E_ARGUMENT, "reserved = 1");
    r.reserved = 0;
    r.n = -1;
    GIVES("n", HBVIB_E_DIMENSION, "n = -1");
    r.n = 1;
    r.struct_size = 48;
    GIVES("size", HBVIB_E_STRUCT_SIZE, "hbvib_response_init");
    r.struct_size = sizeof r;
    REFUSED("size", hbvib_response_init(&r, 48), HBVIB_E_STRUCT_SIZE, 2, "needs 56");
#undef GIVES
#define GIVES(row, wanted, words) REFUSED(row, hbvib_forced_response(model, &s, &o, NULL, &branch), wanted, 0, words)
    r.sector = 24;
    GIVES("sector", HBVIB_E_INDEX, "sector = 24, needs 0 .. 23");
    r.sector = 0;
    r.weights = zero;
    GIVES("weights", HBVIB_E_ARGUMENT, "weights are all 0");
    r.weights = not_finite;
    GIVES("weights", HBVIB_E_NOT_FINITE, "needs finite numbers");
    r.weights = NULL;
    r.measure = HBVIB_MEASURE_FUNDAMENTAL;
    r.component = HBVIB_DISPLACEMENT;
    s.response_dof = 1;
    GIVES("two first ones", HBVIB_E_ARGUMENT, "response_dof = 1");
    EXPECT("nothing was made", branch == NULL);
}

int main(void)
{
    hbvib_model *model = ring_damper();
    begin();
    values(model);
    refusals(model);
    WORKS("free", hbvib_model_free(model));
    return verdict(80);
}
