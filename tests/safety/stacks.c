/* Runs every analysis in a thread with a small stack below which no page is mapped, and measures the bytes of it that were
 * used. Run as: stacks <bytes> [small | large], where "small" takes building, forced responses and modes alone, of every model and
 * with the default tolerance too, and "large" chains of up to 700 masses. Prints the use of each analysis and the largest. */
#define _GNU_SOURCE
#include "designs.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>

enum { GUARD = 1 << 16, PAINT = 0xA5 };

typedef struct task {
    const analysis *analysis;
    hbvib_status status;
} task;

static void *work(void *user)
{
    task *t = user;
    hbvib_model *model = NULL;
    uint64_t sum = 1;
    t->status = t->analysis->build(&model);
    if (t->status >= 0) t->status = t->analysis->run(model, &sum);
    if (model != NULL && hbvib_model_free(model) != HBVIB_OK) t->status = HBVIB_E_INTERNAL;
    return NULL;
}

/* A forced response and a mode with default options, but for the points. */
static hbvib_status forced_by_default(const hbvib_model *model, uint64_t *sum)
{
    hbvib_solver_options s;
    hbvib_status status = hbvib_solver_options_init(&s, sizeof s);
    s.max_points = 4;
    return status < 0 ? status : respond(model, s, sum);
}

static hbvib_status mode_by_default(const hbvib_model *model, uint64_t *sum)
{
    hbvib_solver_options s;
    hbvib_status status = hbvib_solver_options_init(&s, sizeof s);
    s.max_points = 4;
    return status < 0 ? status : follow(model, s, sum);
}

/* A chain of masses between walls with sliders to the ground, of which dampers on some masses make the modes complex. */
static hbvib_status chain_of(int64_t n, int dampers, hbvib_model **model)
{
    hbvib_status status = HBVIB_OK;
    double *m = calloc((size_t)(n * n), sizeof *m), *k = calloc((size_t)(n * n), sizeof *k), *c = calloc((size_t)(n * n), sizeof *c);
    hbvib_matrix mass = dense(n, m), stiffness = dense(n, k), damping = dense(n, c);
    int64_t i;
    if (m == NULL || k == NULL || c == NULL) abort();
    for (i = 0; i < n; i++) {
        m[i * n + i] = 1;
        k[i * n + i] = 2;
        if (i + 1 < n) k[i * n + i + 1] = k[(i + 1) * n + i] = -1;
        c[i * n + i] = dampers ? 1e-3 * (double)(1 + i % 5) : 0;
    }
    STEP(hbvib_model_new(n, model));
    STEP(hbvib_model_set_matrix(*model, HBVIB_MASS, &mass));
    STEP(hbvib_model_set_matrix(*model, HBVIB_STIFFNESS, &stiffness));
    if (dampers) STEP(hbvib_model_set_matrix(*model, HBVIB_DAMPING, &damping));
    if (!dampers) STEP(hbvib_model_set_rayleigh(*model, 1e-3, 1e-3));
    for (i = 0; i < 12; i++) {
        hbvib_contact slider;
        STEP(hbvib_contact_init(&slider, sizeof slider));
        slider.kind = HBVIB_JENKINS;
        slider.dof_a[0] = 4 * i;
        slider.kt = 0.3;
        slider.mu = 1;
        slider.preload = 0.02;
        STEP(hbvib_model_add_contact(*model, &slider, NULL));
    }
    STEP(hbvib_model_add_force(*model, n - 3, 1, 1, 0));
    free(m);
    free(k);
    free(c);
    return finished(status, model);
}

static hbvib_status chain_60(hbvib_model **model) { return chain_of(60, 0, model); }
static hbvib_status chain_60_with_dampers(hbvib_model **model) { return chain_of(60, 1, model); }
static hbvib_status chain_150(hbvib_model **model) { return chain_of(150, 0, model); }
static hbvib_status chain_150_with_dampers(hbvib_model **model) { return chain_of(150, 1, model); }
static hbvib_status chain_400(hbvib_model **model) { return chain_of(400, 0, model); }
static hbvib_status chain_700(hbvib_model **model) { return chain_of(700, 0, model); }

/* Responses over a range, to a tolerance or not, with the multipliers of the first point. */
static hbvib_status wide(const hbvib_model *model, double tolerance)
{
    static double multipliers[2 * 2000];
    hbvib_solver_options s;
    hbvib_forced_options o;
    hbvib_floquet_info info;
    hbvib_branch *branch = NULL;
    hbvib_status status = hbvib_solver_options_init(&s, sizeof s);
    STEP(hbvib_forced_options_init(&o, sizeof o));
    STEP(hbvib_floquet_info_init(&info, sizeof info));
    s.tolerance = tolerance;
    s.harmonics = 5;
    s.max_harmonics = 15;
    s.max_points = 6;
    o.omega_start = 0.3;
    o.omega_stop = 0.4;
    STEP(hbvib_forced_response(model, &s, &o, NULL, &branch));
    if (status >= 0 && hbvib_model_dofs(model) < 200) {
        const hbvib_status found = hbvib_floquet(model, branch, 0, NULL, NULL, multipliers, 2000, NULL, 0, &info);
        status = found < 0 ? found : status;
    }
    if (branch != NULL && hbvib_branch_free(branch) != HBVIB_OK) return HBVIB_E_INTERNAL;
    return status;
}

static hbvib_status fixed_response(const hbvib_model *model, uint64_t *sum)
{
    *sum += 1;
    return wide(model, 0);
}

static hbvib_status adaptive_response(const hbvib_model *model, uint64_t *sum)
{
    *sum += 1;
    return wide(model, 1e-3);
}

static hbvib_status large_mode(const hbvib_model *model, uint64_t *sum)
{
    hbvib_solver_options s;
    hbvib_mode_options o;
    hbvib_branch *branch = NULL;
    hbvib_status status = hbvib_solver_options_init(&s, sizeof s);
    STEP(hbvib_mode_options_init(&o, sizeof o));
    *sum += 1;
    s.tolerance = 0;
    s.harmonics = 3;
    s.max_points = 5;
    o.log10_start = -2;
    o.log10_stop = -1;
    STEP(hbvib_nonlinear_mode(model, &s, &o, NULL, &branch));
    if (branch != NULL && hbvib_branch_free(branch) != HBVIB_OK) return HBVIB_E_INTERNAL;
    return status;
}

static hbvib_status linear_modes(const hbvib_model *model, uint64_t *sum)
{
    double omega[10];
    *sum += 1;
    return hbvib_linear_modes(model, 0, HBVIB_CONTACTS_STUCK, 10, omega, NULL);
}

/* Bytes of a stack of this size that an analysis uses; -1: it fails. An overflow ends the process. */
static int64_t used(const analysis *a, size_t bytes)
{
    pthread_attr_t attributes;
    pthread_t thread;
    task t = {a, HBVIB_OK};
    size_t unused = 0;
    unsigned char *stack = mmap(NULL, bytes + GUARD, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (stack == MAP_FAILED || mprotect(stack + GUARD, bytes, PROT_READ | PROT_WRITE) != 0) abort();
    stack += GUARD;
    memset(stack, PAINT, bytes);
    if (pthread_attr_init(&attributes) != 0 || pthread_attr_setstack(&attributes, stack, bytes) != 0) abort();
    if (pthread_create(&thread, &attributes, work, &t) != 0 || pthread_join(thread, NULL) != 0) abort();
    pthread_attr_destroy(&attributes);
    while (unused < bytes && stack[unused] == PAINT) unused++;
    munmap(stack - GUARD, bytes + GUARD);
    return t.status < 0 ? -1 : (int64_t)(bytes - unused);
}

/* Prints the use of an analysis. Returns whether it succeeded, or is refused for every stack: a law may have no mode. */
static int measure(const analysis *a, size_t bytes, int64_t *most)
{
    hbvib_model *model = NULL;
    uint64_t sum = 1;
    int64_t n;
    printf("%-48s ", a->name);
    fflush(stdout);
    n = used(a, bytes);
    if (n > *most) *most = n;
    if (n < 0) {
        const int refused = a->build(&model) >= 0 && a->run(model, &sum) < 0;
        printf("%s: %s\n", refused ? "refused" : "failed", hbvib_last_error());
        return hbvib_model_free(model) == HBVIB_OK && refused;
    }
    printf("%lld\n", (long long)n);
    return 1;
}

int main(int argc, char **argv)
{
    static const analysis runs[] = {{"forced", NULL, forced},
                                    {"forced to a tolerance", NULL, forced_to_tolerance},
                                    {"forced by default", NULL, forced_by_default},
                                    {"mode", NULL, mode},
                                    {"mode to a tolerance", NULL, mode_to_tolerance},
                                    {"mode by default", NULL, mode_by_default}};
    static const analysis models[] = {
        {"ring", ring, NULL},
        {"small ring", small_ring, NULL},
        {"friction in one direction", friction_2d, NULL},
        {"friction in a plane", friction_3d, NULL},
        {"unilateral", unilateral, NULL},
        {"cubic", cubic, NULL},
        {"regularised", regularised, NULL},
        {"Iwan", iwan, NULL},
        {"table", table, NULL},
        {"polynomials", polynomials, NULL},
        {"law of the caller", caller_law, NULL},
        {"rotor", rotor, NULL},
        {"faces", faces, NULL},
    };
    static const analysis large_models[] = {{"60 masses", chain_60, NULL},
                                            {"60 masses and dampers", chain_60_with_dampers, NULL},
                                            {"150 masses", chain_150, NULL},
                                            {"150 masses and dampers", chain_150_with_dampers, NULL},
                                            {"400 masses", chain_400, NULL},
                                            {"700 masses", chain_700, NULL}};
    static const analysis large_runs[] = {{"response", NULL, fixed_response},
                                          {"response to a tolerance", NULL, adaptive_response},
                                          {"mode", NULL, large_mode},
                                          {"linear modes", NULL, linear_modes}};
    enum { RUNS = sizeof runs / sizeof *runs, MODELS = sizeof models / sizeof *models };
    enum { LARGE_RUNS = sizeof large_runs / sizeof *large_runs, LARGE_MODELS = sizeof large_models / sizeof *large_models };
    size_t bytes;
    int64_t most = 0;
    int i, j, well = 1;
    if (argc < 2) return 2;
    bytes = (size_t)atoll(argv[1]);
    setvbuf(stdout, NULL, _IOLBF, 1024);
    if (argc == 2) {
        for (i = 0; i < N_ALL && well; i++) well = measure(analysis_number(i), bytes, &most);
    } else if (strcmp(argv[2], "large") == 0) {
        for (i = 0; i < LARGE_MODELS && well; i++) {
            for (j = 0; j < LARGE_RUNS && well; j++) {
                char name[64];
                const analysis a = {name, large_models[i].build, large_runs[j].run};
                snprintf(name, sizeof name, "%s, %s", large_models[i].name, large_runs[j].name);
                well = measure(&a, bytes, &most);
            }
        }
    } else {
        for (i = 0; i < MODELS && well; i++) {
            for (j = 0; j < RUNS && well; j++) {
                char name[64];
                const analysis a = {name, models[i].build, runs[j].run};
                snprintf(name, sizeof name, "%s, %s", models[i].name, runs[j].name);
                well = measure(&a, bytes, &most);
            }
        }
    }
    if (well) printf("%lld of %lld bytes at most\n", (long long)most, (long long)bytes);
    return !well;
}
