/* Periodic responses by integration in time, and what they refuse. */
#include "common.h"

enum { H = 9, COUNT = (H + 1) * NDOF, SAMPLES = 48 };

static hbvib_time_options time_options(double hz)
{
    hbvib_time_options o;
    if (hbvib_time_options_init(&o, sizeof o) != HBVIB_OK) abort();
    o.omega = 2 * PI * hz;
    return o;
}

static hbvib_time_info time_info(void)
{
    hbvib_time_info i;
    if (hbvib_time_info_init(&i, sizeof i) != HBVIB_OK) abort();
    return i;
}

/* The truth at a frequency, "f re im" of the blade tip's fundamental. */
static void is_the_truth(double hz, double re, double im)
{
    hbvib_time_options o = time_options(hz);
    hbvib_time_info i = time_info();
    double x[2 * COUNT], again[2 * COUNT], samples[SAMPLES * NDOF];
    double sum_re = 0, sum_im = 0, size = hypot(re, im);
    int k;

    o.samples = SAMPLES;
    WORKS("truth", hbvib_time_response(the_model, &o, NULL, x, COUNT, samples, SAMPLES * NDOF, &i));
    EXPECT("truth", hypot(x[2 * NDOF] - re, x[2 * NDOF + 1] - im) < 1e-8 * size);
    EXPECT("info", fabs(i.period * hz - 1) < 1e-14 && i.residual <= o.tolerance && i.periods >= 1 && i.events >= 4);
    for (k = 0; k < SAMPLES; k++) {
        sum_re += samples[k * NDOF] * cos(2 * PI * k / SAMPLES) * 2 / SAMPLES;
        sum_im -= samples[k * NDOF] * sin(2 * PI * k / SAMPLES) * 2 / SAMPLES;
    }
    EXPECT("samples", hypot(sum_re - re, sum_im - im) < 1e-8 * size);

    /* From the solution itself nothing is to be found any more. */
    o.start = x;
    o.start_len = COUNT;
    o.samples = 0;
    WORKS("start", hbvib_time_response(the_model, &o, NULL, again, COUNT, NULL, 0, &i));
    EXPECT("start", hypot(again[2 * NDOF] - re, again[2 * NDOF + 1] - im) < 1e-8 * size && i.periods <= 2);
    WORKS("nothing wanted", hbvib_time_response(the_model, &o, NULL, NULL, 0, NULL, 0, NULL));
}

static int32_t stop_at_once(void *user, const hbvib_progress *p)
{
    *(int64_t *)user = p->point;
    return 1;
}

static void hooks_stop_it(void)
{
    hbvib_time_options o = time_options(208.85);
    hbvib_time_info i = time_info();
    hbvib_cancel_flag cancel = 1;
    hbvib_hooks hooks;
    double x[2 * COUNT] = {77};
    int64_t point = 0;
    WORKS("hooks", hbvib_hooks_init(&hooks, sizeof hooks));
    hooks.progress = stop_at_once;
    hooks.user = &point;
    EXPECT("hooks", hbvib_time_response(the_model, &o, &hooks, x, COUNT, NULL, 0, &i) == HBVIB_STOPPED_BY_CALLER);
    EXPECT("hooks", point == 1 && i.periods == 1 && x[0] != 77);
    WORKS("hooks", hbvib_hooks_init(&hooks, sizeof hooks));
    hooks.cancel = &cancel;
    EXPECT("cancel", hbvib_time_response(the_model, &o, &hooks, x, COUNT, NULL, 0, &i) == HBVIB_STOPPED_BY_CALLER);
}

static void bad_input(void)
{
    hbvib_time_options o = time_options(208.85), good = o;
    hbvib_time_info i = time_info();
    hbvib_hooks hooks;
    hbvib_model *light = NULL;
    double x[2 * COUNT], start[2 * NDOF] = {0}, samples[4 * NDOF];
    double m[4] = {1, 0, 0, 0};
    x[0] = 77;

    REFUSED("NULL", hbvib_time_options_init(NULL, sizeof o), HBVIB_E_NULL, 1, "hbvib_time_options");
    REFUSED("size", hbvib_time_options_init(&o, 8), HBVIB_E_STRUCT_SIZE, 2, "needs 80");
    REFUSED("NULL", hbvib_time_info_init(NULL, sizeof i), HBVIB_E_NULL, 1, "hbvib_time_info");
    REFUSED("size", hbvib_time_info_init(&i, 8), HBVIB_E_STRUCT_SIZE, 2, "needs 40");
    REFUSED("NULL", hbvib_time_response(NULL, &o, NULL, x, COUNT, NULL, 0, &i), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("NULL", hbvib_time_response(the_model, NULL, NULL, x, COUNT, NULL, 0, &i), HBVIB_E_NULL, 2, "hbvib_time_options");
    REFUSED("length", hbvib_time_response(the_model, &o, NULL, x, COUNT - 1, NULL, 0, &i), HBVIB_E_DIMENSION, 5, "ndof = 40");
    REFUSED("length", hbvib_time_response(the_model, &o, NULL, NULL, COUNT, NULL, 0, &i), HBVIB_E_NULL, 4, "ndof");
    REFUSED("length", hbvib_time_response(the_model, &o, NULL, x, COUNT, samples, 4 * NDOF, &i), HBVIB_E_DIMENSION, 7, "samples * ndof = 0");
    REFUSED("misaligned", hbvib_time_response(the_model, &o, NULL, (double *)((char *)x + 4), COUNT, NULL, 0, &i), HBVIB_E_ARGUMENT, 4, "misaligned");
    i.struct_size = 8;
    REFUSED("size", hbvib_time_response(the_model, &o, NULL, x, COUNT, NULL, 0, &i), HBVIB_E_STRUCT_SIZE, 8, "hbvib_time_info_init");
    i = time_info();
    o.struct_size = 8;
    REFUSED("size", hbvib_time_response(the_model, &o, NULL, x, COUNT, NULL, 0, &i), HBVIB_E_STRUCT_SIZE, 2, "hbvib_time_options_init");
    o = good;
    o.omega = 0;
    REFUSED("omega", hbvib_time_response(the_model, &o, NULL, x, COUNT, NULL, 0, &i), HBVIB_E_ARGUMENT, 2, "omega = 0");
    o.omega = NAN;
    REFUSED("omega", hbvib_time_response(the_model, &o, NULL, x, COUNT, NULL, 0, &i), HBVIB_E_NOT_FINITE, 2, "omega");
    o = good;
    o.method = 2;
    REFUSED("method", hbvib_time_response(the_model, &o, NULL, x, COUNT, NULL, 0, &i), HBVIB_E_ARGUMENT, 2, "method = 2");
    o = good;
    o.harmonics = -1;
    REFUSED("harmonics", hbvib_time_response(the_model, &o, NULL, x, COUNT, NULL, 0, &i), HBVIB_E_ARGUMENT, 2, "harmonics = -1");
    o = good;
    o.samples = INT64_MAX;
    REFUSED("samples", hbvib_time_response(the_model, &o, NULL, x, COUNT, NULL, 0, &i), HBVIB_E_ARGUMENT, 2, "samples = 92");
    o = good;
    o.tolerance = 0;
    REFUSED("tolerance", hbvib_time_response(the_model, &o, NULL, x, COUNT, NULL, 0, &i), HBVIB_E_ARGUMENT, 2, "tolerance = 0");
    o = good;
    o.max_periods = 0;
    REFUSED("periods", hbvib_time_response(the_model, &o, NULL, x, COUNT, NULL, 0, &i), HBVIB_E_ARGUMENT, 2, "max_periods = 0");
    o = good;
    o.max_periods = 1;
    o.method = HBVIB_MARCHING;
    REFUSED("periods", hbvib_time_response(the_model, &o, NULL, x, COUNT, NULL, 0, &i), HBVIB_E_NO_CONVERGENCE, 0, "max_periods = 1");
    o = good;
    o.start = start;
    o.start_len = NDOF - 1;
    REFUSED("start", hbvib_time_response(the_model, &o, NULL, x, COUNT, NULL, 0, &i), HBVIB_E_DIMENSION, 2, "start has 3");
    o.start_len = NDOF;
    start[3] = INFINITY;
    REFUSED("start", hbvib_time_response(the_model, &o, NULL, x, COUNT, NULL, 0, &i), HBVIB_E_NOT_FINITE, 2, "start[1]");
    o.start = NULL;
    REFUSED("start", hbvib_time_response(the_model, &o, NULL, x, COUNT, NULL, 0, &i), HBVIB_E_NULL, 2, "start");
    o.start = x;
    o.start_len = COUNT;
    memset(x, 0, sizeof x);
    x[0] = 77;
    REFUSED("overlap", hbvib_time_response(the_model, &o, NULL, x, COUNT, NULL, 0, &i), HBVIB_E_ARGUMENT, 4, "overlap");
    WORKS("hooks", hbvib_hooks_init(&hooks, sizeof hooks));
    hooks.log_level = 9;
    REFUSED("hooks", hbvib_time_response(the_model, &good, &hooks, x, COUNT, NULL, 0, &i), HBVIB_E_ARGUMENT, 3, "log_level = 9");
    light = two_masses(m, RISING, 1);
    REFUSED("massless", hbvib_time_response(light, &good, NULL, NULL, 0, NULL, 0, &i), HBVIB_E_UNSUPPORTED, 0, "freedom 1 has no mass");
    WORKS("massless", hbvib_model_free(light));
    EXPECT("untouched", x[0] == 77 && i.periods == 0);
}

int main(int argc, char **argv)
{
    if (argc != 4) return 3;
    begin();
    is_the_truth(atof(argv[1]), atof(argv[2]), atof(argv[3]));
    hooks_stop_it();
    bad_input();
    WORKS("free", hbvib_model_free(the_model));
    return verdict(50);
}
