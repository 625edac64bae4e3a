/* A wheel of as many sectors as the library takes, with three degrees of freedom each: marching ends within a second of
 * processor time after it was told to stop, and shooting, whose derivatives no machine can hold, is refused before the wheel is
 * unrolled; a response to a tolerance takes no more memory than its predicted need; nor does a response without contacts,
 * whatever the number of samples, nor a result whose samples were refined. Prints figures. */
#include "failing_malloc.h"
#include "predicted_need.h"

#include <stdio.h>
#include <time.h>

static const double STOPPED_AFTER = 0.04, ENDED_WITHIN = 1, REFUSED_WITHIN = 0.01; /* seconds of processor time */

static clock_t started;
static int failures;

static double spent(void) { return (double)(clock() - started) / CLOCKS_PER_SEC; }

static int32_t on_phase(void *user, const hbvib_phase_report *report)
{
    (void)user;
    (void)report;
    return spent() > STOPPED_AFTER;
}

static hbvib_status wheel(int64_t sectors, hbvib_model **model)
{
    static const double mass[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, stiffness[9] = {2, -1, 0, -1, 2, -1, 0, -1, 2};
    const hbvib_matrix m = dense(3, mass), k = dense(3, stiffness);
    hbvib_status status = hbvib_cyclic_new(3, sectors, model);
    STEP(hbvib_model_set_matrix(*model, HBVIB_MASS, &m));
    STEP(hbvib_model_set_matrix(*model, HBVIB_STIFFNESS, &k));
    STEP(hbvib_model_set_rayleigh(*model, 0.01, 0.01));
    STEP(hbvib_cyclic_set_wave(*model, 1));
    STEP(hbvib_model_add_force(*model, 0, 1, 0.3, 0));
    return status;
}

/* Integration in time with a slider in each sector. */
static hbvib_status in_time(int32_t method)
{
    static double x[6 * 3 * 2];
    hbvib_model *model = NULL;
    hbvib_contact c = law(HBVIB_JENKINS, 0, HBVIB_GROUND, HBVIB_GROUND);
    hbvib_hooks h;
    hbvib_time_options o;
    hbvib_time_info info;
    double seconds, bytes;
    hbvib_status status = wheel(1 << 20, &model), integrated = HBVIB_OK;
    memset(&h, 0, sizeof h);
    memset(&o, 0, sizeof o);
    memset(&info, 0, sizeof info);
    c.kt = 1;
    c.mu = 0.3;
    c.preload = 1;
    STEP(hbvib_model_add_contact(model, &c, NULL));
    STEP(hbvib_hooks_init(&h, sizeof h));
    STEP(hbvib_time_options_init(&o, sizeof o));
    STEP(hbvib_time_info_init(&info, sizeof info));
    h.phase = on_phase;
    o.omega = 1.2;
    o.harmonics = 5;
    o.method = method;
    bytes = -(double)memory_bytes();
    memory_arm(0, 0);
    started = clock();
    if (status >= 0) integrated = hbvib_time_response(model, &o, &h, x, 6 * 3, NULL, 0, &info);
    seconds = spent();
    bytes += (double)memory_peak();
    if (method == HBVIB_SHOOTING)
        failures += integrated != HBVIB_E_OUT_OF_MEMORY || seconds > REFUSED_WITHIN || bytes > 16 * KIB;
    else
        failures += integrated != HBVIB_STOPPED_BY_CALLER || seconds > STOPPED_AFTER + ENDED_WITHIN;
    printf("in time, method %d: status %d after %.4f s, %.0f bytes\n", (int)method, (int)integrated, seconds, bytes);
    return status < 0 ? status : hbvib_model_free(model);
}

/* A response, with or without a unilateral contact in each sector. */
static hbvib_status respond(const char *name, int64_t sectors, int contact, double tolerance, int64_t samples)
{
    hbvib_model *model = NULL;
    hbvib_branch *branch = NULL;
    hbvib_contact c = law(HBVIB_UNILATERAL, HBVIB_GROUND, HBVIB_GROUND, 0);
    hbvib_solver_options s;
    hbvib_forced_options o;
    hbvib_hooks h;
    sizes m;
    double need, bytes;
    hbvib_status status = wheel(sectors, &model), solved = HBVIB_OK;
    memset(&s, 0, sizeof s);
    memset(&o, 0, sizeof o);
    memset(&h, 0, sizeof h);
    c.kn = 1;
    c.gap = 0.1;
    if (contact) STEP(hbvib_model_add_contact(model, &c, NULL));
    STEP(hbvib_solver_options_init(&s, sizeof s));
    STEP(hbvib_forced_options_init(&o, sizeof o));
    STEP(hbvib_hooks_init(&h, sizeof h));
    s.tolerance = tolerance;
    s.harmonics = 3;
    s.max_harmonics = 10;
    s.samples = samples;
    s.max_points = 10;
    o.omega_start = 1.2;
    o.omega_stop = 1.3;
    m = sizes_of(model);
    need = 16 * KIB + need_of_a_branch(&m, &s, 3 * (double)s.max_points);
    bytes = -(double)memory_bytes();
    memory_arm(0, 0);
    STEP(solved = hbvib_forced_response(model, &s, &o, &h, &branch));
    bytes += (double)memory_peak();
    failures += solved < 0 || bytes > need;
    printf("%s: status %d, %.0f bytes, %.0f are its need\n", name, (int)solved, bytes, need);
    STEP(hbvib_branch_free(branch));
    return status < 0 ? status : hbvib_model_free(model);
}

/* The energy of a point whose samples a tolerance has refined. */
static hbvib_status energy_of_refined(void)
{
    hbvib_model *model = NULL;
    hbvib_branch *branch = NULL;
    hbvib_contact c = law(HBVIB_REGULARISED, 0, HBVIB_GROUND, HBVIB_GROUND);
    hbvib_solver_options s;
    hbvib_forced_options o;
    hbvib_energy energy;
    sizes m;
    double need, bytes;
    hbvib_status status = wheel(1, &model), told = HBVIB_OK;
    memset(&s, 0, sizeof s);
    memset(&o, 0, sizeof o);
    memset(&energy, 0, sizeof energy);
    c.mu = 0.3;
    c.preload = 1;
    c.velocity = 1e-2;
    STEP(hbvib_model_add_contact(model, &c, NULL));
    STEP(hbvib_solver_options_init(&s, sizeof s));
    STEP(hbvib_forced_options_init(&o, sizeof o));
    STEP(hbvib_energy_init(&energy, sizeof energy));
    s.tolerance = 1e-300;
    s.max_harmonics = 30;
    o.omega_start = o.omega_stop = 1.2;
    m = sizes_of(model);
    need = 16 * KIB + need_of_a_result(&m, highest(&s), samples_of_results(&m, &s));
    STEP(hbvib_forced_response(model, &s, &o, NULL, &branch));
    bytes = -(double)memory_bytes();
    memory_arm(0, 0);
    STEP(told = hbvib_branch_energy(branch, 0, &energy));
    bytes += (double)memory_peak();
    failures += told < 0 || bytes > need;
    printf("energy, refined samples: status %d, %.0f bytes, %.0f are its need\n", (int)told, bytes, need);
    STEP(hbvib_branch_free(branch));
    return status < 0 ? status : hbvib_model_free(model);
}

int main(void)
{
    hbvib_hooks h;
    hbvib_status status = HBVIB_OK;
    memset(&h, 0, sizeof h);
    STEP(hbvib_hooks_init(&h, sizeof h));
    /* What a thread keeps is taken by its first call that may need it. */
    (void)!hbvib_branch_energy_with_hooks(NULL, 0, NULL, &h);
    if (status < 0) return 2;
    failures += in_time(HBVIB_MARCHING) < 0;
    failures += in_time(HBVIB_SHOOTING) < 0;
    failures += respond("to a tolerance", 1 << 20, 1, 0.05, 0) < 0;
    failures += respond("no contact, many samples", 1, 0, 0, 1 << 20) < 0;
    failures += energy_of_refined() < 0;
    printf("in all: %d failures\n", failures);
    return failures != 0;
}
