/* Lets requests for memory fail, one after the other, in every analysis on every model, and checks that
 *  - the call returns HBVIB_E_OUT_OF_MEMORY, or the results that it has with memory, bit by bit;
 *  - all memory is free again;
 *  - the same model then has the same results; slow analyses are repeated after one failure in eight.
 * Run under LD_PRELOAD=failing_malloc.so as: failing_allocations <share> [name], where share 1 takes every request and
 * share n about one in n. Prints a line for each analysis and one for all. */
#include "analyses.h"
#include "failing_malloc.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* Outcomes of failing requests; shared with the processes in which they are tried. */
typedef struct outcomes {
    int64_t refused, unharmed, died, leaked, changed, other;
    int64_t n; /* request that fails now */
} outcomes;

static int64_t share = 1;

/* Whether an analysis is so quick that it is repeated after each failure; others are after one in eight. */
static int quick;

static void complain(const analysis *a, const char *phase, int32_t for_good, int64_t n, const char *said)
{
    fprintf(stderr, "%s, %s, request %lld%s fails: %s (last error: %s)\n", a->name, phase, (long long)n,
            for_good ? " and all later ones" : "", said, hbvib_last_error());
}

/* Counts the outcome of a call during which requests failed. */
static void judge(const analysis *a, const char *phase, int32_t for_good, outcomes *all, hbvib_status status, int same)
{
    if (status == HBVIB_E_OUT_OF_MEMORY) {
        all->refused++;
    } else if (status < 0) {
        all->other++;
        complain(a, phase, for_good, all->n, hbvib_status_name(status));
    } else if (!same) {
        all->changed++;
        complain(a, phase, for_good, all->n, "other results");
    } else {
        all->unharmed++;
    }
}

static void leak(const analysis *a, const char *phase, int32_t for_good, outcomes *all, int64_t before)
{
    if (memory_blocks() != before) {
        all->leaked++;
        complain(a, phase, for_good, all->n, "memory was not freed");
    }
}

static int64_t next(int64_t n)
{
    /* Steps that differ, so that no part of a loop is always left out. */
    return n + (share == 1 ? 1 : 1 + (n * 7919 + 12345) % (2 * share - 1));
}

/* Requests of the building of a model. */
static void try_building(const analysis *a, int32_t for_good, outcomes *all)
{
    for (;; all->n = next(all->n)) {
        hbvib_model *model = NULL;
        const int64_t before = memory_blocks();
        hbvib_status status;
        int64_t requests;
        memory_arm(all->n, for_good);
        status = a->build(&model);
        requests = memory_disarm();
        if (requests >= all->n) judge(a, "model", for_good, all, status, 1);
        if (model != NULL && hbvib_model_free(model) != HBVIB_OK) abort();
        leak(a, "model", for_good, all, before);
        if (requests < all->n) return;
    }
}

/* Requests of an analysis, each of a new model. */
static void try_running(const analysis *a, int32_t for_good, outcomes *all, uint64_t reference)
{
    for (;; all->n = next(all->n)) {
        hbvib_model *model = NULL;
        const int64_t before = memory_blocks();
        hbvib_status status;
        uint64_t sum = 1, again = 1;
        int64_t requests;
        if (a->build(&model) < 0) abort();
        memory_arm(all->n, for_good);
        status = a->run(model, &sum);
        requests = memory_disarm();
        if (requests >= all->n) judge(a, "analysis", for_good, all, status, sum == reference);
        if ((all->n % 8 == 0 || quick) && (a->run(model, &again) < 0 || again != reference)) {
            all->changed++;
            complain(a, "analysis", for_good, all->n, "the model has other results afterwards");
        }
        if (hbvib_model_free(model) != HBVIB_OK) abort();
        leak(a, "analysis", for_good, all, before);
        if (requests < all->n) return;
    }
}

/* Tries a phase in a process, and in another one after each request at which it dies. */
static void survive(const analysis *a, int building, int32_t for_good, outcomes *all, uint64_t reference)
{
    all->n = 1;
    for (;;) {
        int result = 0;
        pid_t child = fork();
        if (child < 0) abort();
        if (child == 0) {
            if (building) try_building(a, for_good, all);
            else try_running(a, for_good, all, reference);
            _exit(0);
        }
        if (waitpid(child, &result, 0) != child) abort();
        if (WIFEXITED(result) && WEXITSTATUS(result) == 0) return;
        all->died++;
        complain(a, building ? "model" : "analysis", for_good, all->n, "the process died");
        all->n = next(all->n);
    }
}

int main(int argc, char **argv)
{
    outcomes *all = mmap(NULL, sizeof *all, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    int64_t tried = 0, bad = 0, i;
    outcomes sum = {0};
    if (all == MAP_FAILED || argc < 2) return 2;
    share = atoll(argv[1]);
    for (i = 0; i < N_ANALYSES; i++) {
        const analysis *a = &ANALYSES[i];
        hbvib_model *model = NULL;
        uint64_t reference = 1, again = 1;
        const clock_t begin = clock();
        int32_t for_good;
        if (argc > 2 && strcmp(argv[2], a->name) != 0) continue;
        /* Twice, so that what is set up once in a process is there. */
        if (a->build(&model) < 0 || a->run(model, &reference) < 0 || a->run(model, &again) < 0 || again != reference) {
            fprintf(stderr, "%s cannot be solved twice: %s\n", a->name, hbvib_last_error());
            return 2;
        }
        if (hbvib_model_free(model) != HBVIB_OK) return 2;
        quick = (clock() - begin) / 2 < CLOCKS_PER_SEC / 100;
        memset(all, 0, sizeof *all);
        for (for_good = 0; for_good < 2; for_good++) {
            survive(a, 1, for_good, all, reference);
            survive(a, 0, for_good, all, reference);
        }
        printf("%-32s %lld refused, %lld without effect, %lld deaths, %lld leaks, %lld changed, %lld other\n", a->name,
               (long long)all->refused, (long long)all->unharmed, (long long)all->died, (long long)all->leaked,
               (long long)all->changed, (long long)all->other);
        fflush(stdout);
        sum.refused += all->refused;
        sum.unharmed += all->unharmed;
        sum.died += all->died;
        bad += all->leaked + all->changed + all->other;
    }
    tried = sum.refused + sum.unharmed + sum.died + bad;
    printf("%lld failing requests: %lld refused, %lld without effect, %lld deaths, %lld others\n", (long long)tried,
           (long long)sum.refused, (long long)sum.unharmed, (long long)sum.died, (long long)bad);
    return sum.died + bad == 0 && tried > 0 ? 0 : 1;
}
