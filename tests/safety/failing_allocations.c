/* Lets requests for memory fail, one after the other, in every analysis on every model, and checks that
 *  - the call returns HBVIB_E_OUT_OF_MEMORY, or the results that it has with memory, bit by bit;
 *  - all memory is free again;
 *  - the same model then has the same results; slow analyses are repeated after one failure in eight.
 * The first analysis is also tried as the first call of a process.
 * Run under LD_PRELOAD=failing_malloc.so as: failing_allocations <share> [first] [last], where share 1 takes every request
 * and share n the first and then about one in n, of the analyses with these numbers, from 1. Prints a line for each analysis (how many requests
 * it has, how many failed, one in how many) and one for all. */
#include "designs.h"
#include "failing_malloc.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* Outcomes of failing requests; shared with the processes in which they are tried. */
typedef struct outcomes {
    int64_t refused, unharmed, died, leaked, changed, other;
    int64_t requests[2]; /* of the analysis, of the building of its model */
    int64_t tried[2];    /* that failed alone, with all later ones */
    int64_t n;           /* request that fails now */
} outcomes;

/* About one request in `share` fails. */
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
    all->tried[for_good]++;
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

/* Requests of an analysis that fail always, those of threads and of what is set up among them. */
enum { FIRST = 16 };

static int64_t next(int64_t n)
{
    /* Steps that differ, so that no part of a loop is always left out. */
    return n + (share == 1 || n < FIRST ? 1 : 1 + (n * 7919 + 12345) % (2 * share - 1));
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
        all->requests[1] = requests;
        if (requests < all->n) return;
    }
}

/* An analysis in a thread of its own, which also asks for what a thread needs once. */
typedef struct task {
    const analysis *analysis;
    const hbvib_model *model;
    int64_t n, requests;
    int32_t for_good;
    hbvib_status status;
    uint64_t sum;
} task;

static void *work(void *user)
{
    task *t = user;
    memory_arm(t->n, t->for_good);
    t->status = t->analysis->run(t->model, &t->sum);
    t->requests = memory_disarm();
    return NULL;
}

/* Requests of an analysis, each of a new model in a new thread. */
static void try_running(const analysis *a, int32_t for_good, outcomes *all, uint64_t reference)
{
    for (;; all->n = next(all->n)) {
        hbvib_model *model = NULL;
        const int64_t before = memory_blocks();
        uint64_t again = 1;
        pthread_t thread;
        task t = {a, NULL, 0, 0, 0, HBVIB_OK, 1};
        if (a->build(&model) < 0) abort();
        t.model = model;
        t.n = all->n;
        t.for_good = for_good;
        if (pthread_create(&thread, NULL, work, &t) != 0 || pthread_join(thread, NULL) != 0) abort();
        if (t.requests >= all->n) judge(a, "analysis", for_good, all, t.status, t.sum == reference);
        if ((all->n % 8 == 0 || quick) && (a->run(model, &again) < 0 || again != reference)) {
            all->changed++;
            complain(a, "analysis", for_good, all->n, "the model has other results afterwards");
        }
        if (hbvib_model_free(model) != HBVIB_OK) abort();
        leak(a, "analysis", for_good, all, before);
        all->requests[0] = t.requests;
        if (t.requests < all->n) return;
    }
}

/* The first analysis of a process, which also asks for what is set up once: each request in a process of its own. */
static void try_first(const analysis *a, int32_t for_good, outcomes *all, task *t)
{
    for (;; all->n = next(all->n)) {
        int result = 0;
        pid_t child = fork();
        if (child < 0) abort();
        if (child == 0) {
            hbvib_model *model = NULL;
            t->sum = 1;
            memory_arm(all->n, for_good);
            t->status = a->build(&model);
            if (t->status >= 0) t->status = a->run(model, &t->sum);
            t->requests = memory_disarm();
            _exit(0);
        }
        if (waitpid(child, &result, 0) != child) abort();
        if (!WIFEXITED(result) || WEXITSTATUS(result) != 0) {
            all->died++;
            complain(a, "first call", for_good, all->n, "the process died");
        } else {
            if (t->requests < all->n) return;
            judge(a, "first call", for_good, all, t->status, 1);
        }
    }
}

/* Two threads at one time: their stacks and tables stay in the process, and are used again. */
static void *nothing(void *user)
{
    pthread_t thread;
    if (user != NULL && (pthread_create(&thread, NULL, nothing, NULL) != 0 || pthread_join(thread, NULL) != 0)) abort();
    return user;
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
            pthread_t thread;
            if (pthread_create(&thread, NULL, nothing, all) != 0 || pthread_join(thread, NULL) != 0) abort();
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

/* An analysis that fails now and then: its line, and the same added to the outcomes of all. */
static void tell(int number, const analysis *a, const outcomes *all, outcomes *sum)
{
    printf("%2d %-38s %lld requests, %lld of building; failed: %lld alone, %lld with all later ones, one in %lld: "
           "%lld refused, %lld without effect, %lld deaths, %lld leaks, %lld changed, %lld other\n",
           number, a->name, (long long)(all->requests[0] + all->requests[1]), (long long)all->requests[1],
           (long long)all->tried[0], (long long)all->tried[1], (long long)share, (long long)all->refused,
           (long long)all->unharmed, (long long)all->died, (long long)all->leaked, (long long)all->changed, (long long)all->other);
    fflush(stdout);
    sum->refused += all->refused;
    sum->unharmed += all->unharmed;
    sum->died += all->died;
    sum->other += all->leaked + all->changed + all->other;
}

int main(int argc, char **argv)
{
    outcomes *all = mmap(NULL, sizeof *all, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    task *first = mmap(NULL, sizeof *first, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    const int64_t given = argc > 1 ? atoll(argv[1]) : 0;
    const int from = argc > 2 ? atoi(argv[2]) : 1, to = argc > 3 ? atoi(argv[3]) : N_ALL;
    outcomes sum = {0};
    int64_t tried;
    int i;
    if (all == MAP_FAILED || first == MAP_FAILED || given < 1 || from < 1 || to > N_ALL) return 2;
    for (i = from - 1; i < to; i++) {
        const analysis *a = analysis_number(i);
        hbvib_model *model = NULL;
        uint64_t reference = 1, again = 1;
        clock_t begin;
        int32_t for_good;
        memset(all, 0, sizeof *all);
        share = given;
        for (for_good = 0; for_good < 2 && i == 0; for_good++) {
            all->n = 1;
            try_first(a, for_good, all, first);
        }
        begin = clock();
        /* Twice, so that what is set up once in a process is there. */
        memory_arm(0, 0);
        if (a->build(&model) < 0 || a->run(model, &reference) < 0 || a->run(model, &again) < 0 || again != reference) {
            fprintf(stderr, "%s cannot be solved twice: %s\n", a->name, hbvib_last_error());
            return 2;
        }
        if (hbvib_model_free(model) != HBVIB_OK) return 2;
        quick = (double)(clock() - begin) / 2 / CLOCKS_PER_SEC < 0.01;
        if (given > 1) share = given * (1 + memory_disarm() / 4000);
        for (for_good = 0; for_good < 2; for_good++) {
            survive(a, 1, for_good, all, reference);
            survive(a, 0, for_good, all, reference);
        }
        tell(i + 1, a, all, &sum);
    }
    tried = sum.refused + sum.unharmed + sum.died + sum.other;
    printf("%lld failing requests: %lld refused, %lld without effect, %lld deaths, %lld others\n", (long long)tried,
           (long long)sum.refused, (long long)sum.unharmed, (long long)sum.died, (long long)sum.other);
    return sum.died + sum.other == 0 && tried > 0 ? 0 : 1;
}
