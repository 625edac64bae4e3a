/* Calls need at most the bytes that the header and docs/memory.md tell, and are refused before they ask for what a limit
 * does not allow. Run under LD_PRELOAD=libfailing_malloc.so. Prints the largest share of the told bytes. */
#include "failing_malloc.h"
#include "predicted_need.h"

#include <stdio.h>
#include <stdlib.h>

enum { MOST = 1 << 18 };

static double x[MOST], r[MOST], jacobian[4 * 63 * 63], largest;
static int failures;

/* Judges a call that began with so many bytes. */
static void judge(const char *what, int64_t before, hbvib_status status, int64_t told)
{
    const double share = (double)(memory_peak() - before) / (double)told;
    memory_disarm();
    if (share > largest) largest = share;
    if (status == HBVIB_OK && share <= 1) return;
    failures++;
    printf("%s: status %d, %.2f of %lld bytes: %s\n", what, (int)status, share, (long long)told, hbvib_last_error());
}

static void laws(void)
{
    static const int32_t kinds[6] = {HBVIB_JENKINS, HBVIB_FRICTION_2D, HBVIB_FRICTION_3D, HBVIB_UNILATERAL, HBVIB_CUBIC, HBVIB_REGULARISED};
    static const int64_t directions[6] = {1, 2, 3, 1, 1, 1}, harmonics[4] = {1, 20, 150, 1500}, samples[3] = {0, 4096, 1048573};
    int i, j, k;
    for (i = 0; i < 6; i++) {
        for (j = 0; j < 4; j++) {
            for (k = 0; k < (j == 1 ? 3 : j == 3 ? 1 : 2); k++) {
                const int64_t n = directions[i] * (harmonics[j] + 1), before = memory_bytes();
                hbvib_contact c = law(kinds[i], 0, 1, 2);
                hbvib_status status;
                if (i == 2 && j >= 2) continue; /* minutes of events */
                c.kt = i == 3 || i == 5 ? 0 : 1;
                c.kn = i == 1 || i == 2 || i == 3 ? 1 : 0;
                c.mu = i == 3 || i == 4 ? 0 : 0.3;
                c.preload = i == 4 ? 0 : 0.2;
                c.cubic = i == 4;
                c.velocity = i == 5 ? 0.1 : 0;
                memory_arm(0, 0);
                status = hbvib_contact_evaluate(&c, harmonics[j], samples[k], 1.1, x, n, r, n, NULL, 0);
                judge("a law", before, status, (int64_t)need_of_a_force(&c, (double)harmonics[j], (double)samples[k]));
                if (j < 2) {
                    memory_arm(0, 0);
                    status = hbvib_contact_evaluate(&c, harmonics[j], samples[k], 1.1, x, n, r, n, jacobian, 4 * n * n);
                    judge("a law with its Jacobian", before, status,
                          (int64_t)need_of_a_law((double)directions[i], (double)harmonics[j], (double)samples[k]));
                }
            }
        }
    }
}

/* Entries of all matrices: 3 x 3, or a band. */
static void residual(const char *what, hbvib_status (*build)(hbvib_model **), int64_t directions, int64_t contacts, int64_t entries)
{
    enum { H = 60 };
    hbvib_model *model = NULL;
    hbvib_solver_options s;
    hbvib_status status;
    int64_t before, told, n;
    if (build(&model) != HBVIB_OK || hbvib_solver_options_init(&s, sizeof s) != HBVIB_OK) abort();
    s.tolerance = 0;
    s.harmonics = H;
    n = (H + 1) * hbvib_model_dofs(model);
    told = contacts * (int64_t)need_of_a_law((double)directions, H, 0) + 96 * (H + 1) * entries;
    before = memory_bytes();
    memory_arm(0, 0);
    status = hbvib_forced_residual(model, &s, 1.1, x, n, r, n, NULL, 0, NULL, 0);
    judge(what, before, status, told);
    s.memory_limit = told;
    if (hbvib_forced_residual(model, &s, 1.1, x, n, r, n, NULL, 0, NULL, 0) != HBVIB_OK) {
        printf("%s with a limit of %lld bytes: %s\n", what, (long long)told, hbvib_last_error());
        failures++;
    }
    s.memory_limit = told / 4;
    memory_arm(0, 0);
    before = memory_bytes();
    status = hbvib_forced_residual(model, &s, 1.1, x, n, r, n, NULL, 0, NULL, 0);
    if (status != HBVIB_E_OUT_OF_MEMORY || memory_peak() - before > 1 << 15) {
        printf("%s with a limit: status %d, %lld bytes\n", what, (int)status, (long long)(memory_peak() - before));
        failures++;
    }
    memory_disarm();
    if (hbvib_model_free(model) != HBVIB_OK) abort();
}

/* A request beyond any machine is refused before a byte of it is touched. */
static void too_large(void)
{
    enum { H = 100000 };
    hbvib_contact c = law(HBVIB_REGULARISED, 0, HBVIB_GROUND, HBVIB_GROUND);
    int64_t before = memory_bytes();
    hbvib_status status;
    c.velocity = c.mu = c.preload = 1;
    memory_arm(0, 0);
    status = hbvib_contact_evaluate(&c, H, 0, 1, x, H + 1, r, H + 1, NULL, 0);
    if (status != HBVIB_E_OUT_OF_MEMORY || memory_peak() - before > 1 << 15) {
        printf("too large: status %d, %lld bytes\n", (int)status, (long long)(memory_peak() - before));
        failures++;
    }
    if (strstr(hbvib_last_error(), "memory_limit") != NULL || strstr(hbvib_last_error(), "harmonics") == NULL) {
        printf("too large: %s\n", hbvib_last_error());
        failures++;
    }
    memory_disarm();
}

static hbvib_solver_options fixed(int64_t harmonics)
{
    hbvib_solver_options s;
    if (hbvib_solver_options_init(&s, sizeof s) != HBVIB_OK) abort();
    s.tolerance = 0;
    s.harmonics = harmonics;
    s.max_points = 3;
    return s;
}

/* The bytes of a response of a few points; a refused one has no branch. */
static hbvib_status respond(const hbvib_model *model, const hbvib_solver_options *s, double omega, int64_t *before)
{
    hbvib_forced_options o;
    hbvib_branch *branch = NULL;
    hbvib_status status;
    if (hbvib_forced_options_init(&o, sizeof o) != HBVIB_OK) abort();
    o.omega_start = omega;
    o.omega_stop = 1.01 * omega;
    *before = memory_bytes();
    memory_arm(0, 0);
    status = hbvib_forced_response(model, s, &o, NULL, &branch);
    if (branch != NULL && hbvib_branch_free(branch) != HBVIB_OK) abort();
    return status < 0 ? status : HBVIB_OK;
}

/* Chain with a contact at each of its masses. */
static hbvib_status many(hbvib_model **model)
{
    hbvib_contact c = law(HBVIB_JENKINS, 0, HBVIB_GROUND, HBVIB_GROUND);
    hbvib_status status = chain(model);
    c.kt = c.mu = c.preload = 0.5;
    for (c.dof_a[0] = 0; c.dof_a[0] < LONG; c.dof_a[0]++) STEP(hbvib_model_add_contact(*model, &c, NULL));
    return finished(status, model);
}

/* Forced responses with fixed harmonics take what is told, and far less where a limit refuses their equations. */
static void responses(void)
{
    static hbvib_status (*const build[])(hbvib_model **) = {ring, friction_3d, friction_2d, cubic, unilateral, regularised, chain, many};
    enum { MODELS = sizeof build / sizeof *build };
    static const int64_t harmonics[2] = {15, 120};
    int i, j;
    for (i = 0; i < MODELS; i++) {
        hbvib_model *model = NULL;
        const double omega = i == 0 ? 1300 : i >= 6 ? 0.4 : 1.2;
        sizes size;
        if (build[i](&model) != HBVIB_OK) abort();
        size = sizes_of(model);
        for (j = 0; j < (i == 1 ? 1 : 2); j++) {
            hbvib_solver_options s = fixed(harmonics[j]);
            int64_t before = 0;
            hbvib_status status = respond(model, &s, omega, &before);
            judge("a response", before, status, (int64_t)need_of_a_branch(&size, &s, 6));
        }
        {
            hbvib_solver_options s = fixed(2000);
            int64_t before = 0;
            hbvib_status status;
            s.memory_limit = 1 << 23;
            status = respond(model, &s, omega, &before);
            if (status != HBVIB_E_OUT_OF_MEMORY || (double)(memory_peak() - before) > need_of_structure(&size, 2000) || strstr(hbvib_last_error(), "memory_limit") == NULL) {
                printf("2000 harmonics with a limit: status %d, %lld bytes: %s\n", (int)status,
                       (long long)(memory_peak() - before), hbvib_last_error());
                failures++;
            }
            memory_disarm();
            /* With a tolerance the limit lets fewer harmonics, and estimates of fewer, through. */
            s.tolerance = 1e-9;
            s.max_harmonics = 2000;
            s.memory_limit = 1 << 21;
            status = respond(model, &s, omega, &before);
            if (i != 1) judge("a tolerance with a limit", before, status, (int64_t)need_of_a_branch(&size, &s, 6));
        }
        if (hbvib_model_free(model) != HBVIB_OK) abort();
    }
}

/* Stability along a response: its matrices grow with the wheel, those of the response with a sector. */
static void stability(void)
{
    static const int64_t sectors[3] = {3, 24, 96}, harmonics[3] = {1, 3, 9};
    int i, j;
    for (i = 0; i < 3; i++) {
        for (j = 0; j < 6; j++) {
            hbvib_solver_options s = fixed(harmonics[j % 3]);
            hbvib_model *model = NULL;
            hbvib_status status;
            int64_t before = 0;
            sizes size;
            if (ring_of(sectors[i], 1.5e-6, &model) != HBVIB_OK) abort();
            if (j >= 3) {
                /* Another contact, which slips, on the mass that is driven. */
                hbvib_contact c = law(HBVIB_JENKINS, 0, HBVIB_GROUND, HBVIB_GROUND);
                c.kt = 1e4;
                c.mu = c.preload = 1;
                if (hbvib_model_add_contact(model, &c, NULL) != HBVIB_OK) abort();
            }
            s.stability = j % 2 == 0 ? HBVIB_STABILITY_WHEEL : HBVIB_STABILITY_WAVE;
            size = sizes_of(model);
            status = respond(model, &s, 1300, &before);
            judge("stability of a response", before, status, (int64_t)need_of_a_branch(&size, &s, 6));
            if (hbvib_model_free(model) != HBVIB_OK) abort();
        }
    }
}

int main(void)
{
    hbvib_contact c = law(HBVIB_CUBIC, 0, HBVIB_GROUND, HBVIB_GROUND);
    hbvib_hooks h;
    int64_t i;
    for (i = 0; i < MOST; i++) x[i] = 0.5 / (double)(1 + i) * (double)(i % 3 - 1);
    c.cubic = 1;
    /* What a thread needs once. */
    if (hbvib_contact_evaluate(&c, 1, 0, 1, x, 2, r, 2, NULL, 0) != HBVIB_OK) abort();
    if (hbvib_hooks_init(&h, sizeof h) != HBVIB_OK || hbvib_branch_energy_with_hooks(NULL, 0, NULL, &h) == HBVIB_OK) abort();
    laws();
    residual("friction in one direction", friction_2d, 2, 1, 3 * 9);
    residual("cubic", cubic, 1, 1, 3 * 9);
    residual("chain", chain, 1, 2, 4 * 3 * LONG);
    too_large();
    responses();
    stability();
    printf("%.2f of the told bytes at most, %d failures\n", largest, failures);
    return failures > 0;
}
