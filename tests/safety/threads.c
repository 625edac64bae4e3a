/* Analyses of shared models by several threads, while another one cancels calls and tries to change a model in use:
 * results have the bits of one thread alone, the change is refused, and a cancelled call ends. Run as:
 * threads <threads> <seconds>. Prints the number of analyses. */
#define BUFFER static __thread
#include "analyses.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

enum { SHARED = 6, MOST = 64 };

static const analysis SHARED_ANALYSES[SHARED] = {
    {"forced", ring, forced},       {"mode", ring, mode},           {"cubic", cubic, forced},
    {"plane", friction_2d, forced}, {"caller", caller_law, forced}, {"chain", chain, forced_on_basis},
};

static hbvib_model *models[SHARED];

/* One that is solved, stopped and changed. */
static hbvib_model *changed;

static uint64_t reference[SHARED];
static hbvib_cancel_flag cancel;
static int over, failures;
static int64_t done, cancelled;

static void fail(const char *what, hbvib_status status)
{
    __atomic_add_fetch(&failures, 1, __ATOMIC_RELAXED);
    fprintf(stderr, "%s: status %d, %s\n", what, (int)status, hbvib_last_error());
}

/* A response that the flag stops at some point. */
static void stoppable(const hbvib_model *model)
{
    hbvib_solver_options s = options(0);
    hbvib_forced_options o = range(model);
    hbvib_hooks h;
    hbvib_branch *branch = NULL;
    hbvib_status status;
    if (hbvib_hooks_init(&h, sizeof h) != HBVIB_OK) abort();
    h.cancel = &cancel;
    s.max_points = 400;
    s.harmonics = 15;
    o.omega_start *= 0.7;
    status = hbvib_forced_response(model, &s, &o, &h, &branch);
    if (status < 0 && status != HBVIB_E_NO_CONVERGENCE && status != HBVIB_E_BUSY) fail("a response that may be stopped", status);
    if (status == HBVIB_STOPPED_BY_CALLER) __atomic_add_fetch(&cancelled, 1, __ATOMIC_RELAXED);
    if (branch != NULL && hbvib_branch_free(branch) != HBVIB_OK) fail("free", HBVIB_E_BUSY);
}

static void *work(void *user)
{
    unsigned k = (unsigned)(uintptr_t)user;
    while (!__atomic_load_n(&over, __ATOMIC_RELAXED)) {
        const unsigned i = (k = k * 1103515245u + 12345u) / 65536u % SHARED;
        uint64_t sum = 1;
        hbvib_status status;
        hbvib_model *own = NULL;
        if (k / 8192u % 4 == 0) {
            stoppable(changed);
            continue;
        }
        status = SHARED_ANALYSES[i].run(models[i], &sum);
        if (status < 0 || sum != reference[i]) fail(SHARED_ANALYSES[i].name, status);
        /* And a model of its own. */
        status = hbvib_model_clone(models[i], &own);
        if (status != HBVIB_OK) fail("clone", status);
        if (hbvib_model_free(own) != HBVIB_OK) fail("free", HBVIB_E_INTERNAL);
        __atomic_add_fetch(&done, 1, __ATOMIC_RELAXED);
    }
    return NULL;
}

int main(int argc, char **argv)
{
    pthread_t threads[MOST];
    struct timespec pause = {0, 3000000};
    time_t end;
    int i, n, busy = 0;
    if (argc != 3 || (n = atoi(argv[1])) > MOST) return 2;
    for (i = 0; i < SHARED; i++) {
        reference[i] = 1;
        if (SHARED_ANALYSES[i].build(&models[i]) < 0 || SHARED_ANALYSES[i].run(models[i], &reference[i]) < 0) return 3;
    }
    if (ring(&changed) < 0) return 3;
    end = time(NULL) + atoi(argv[2]);
    for (i = 0; i < n; i++)
        if (pthread_create(&threads[i], NULL, work, (void *)(uintptr_t)(i + 1)) != 0) abort();
    for (i = 0; time(NULL) < end; i++) {
        if (hbvib_cancel(&cancel, i % 2) != HBVIB_OK) fail("cancel", HBVIB_E_INTERNAL);
        /* A change of a model that is in use is refused, and a use while it is changed. */
        busy += hbvib_model_set_preload(changed, 0, 488.5) == HBVIB_E_BUSY;
        nanosleep(&pause, NULL);
    }
    __atomic_store_n(&over, 1, __ATOMIC_RELAXED);
    for (i = 0; i < n; i++)
        if (pthread_join(threads[i], NULL) != 0) abort();
    for (i = 0; i < SHARED; i++)
        if (hbvib_model_free(models[i]) != HBVIB_OK) fail("free", HBVIB_E_BUSY);
    if (hbvib_model_free(changed) != HBVIB_OK) fail("free", HBVIB_E_BUSY);
    printf("%lld analyses, %lld stopped, %d changes refused, %d failures\n", (long long)done, (long long)cancelled, busy, failures);
    return failures > 0 || done == 0 || cancelled == 0 || busy == 0;
}
