/* Runs every analysis in a thread with a small stack below which no page is mapped, and measures the bytes of it that were
 * used. Run as: stacks <bytes> [small], where "small" takes building, forced responses and modes alone, of every model and
 * with the default tolerance too. Prints the use of each analysis and the largest. */
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
    enum { RUNS = sizeof runs / sizeof *runs, MODELS = sizeof models / sizeof *models };
    size_t bytes;
    int64_t most = 0;
    int i, j, well = 1;
    if (argc < 2) return 2;
    bytes = (size_t)atoll(argv[1]);
    setvbuf(stdout, NULL, _IOLBF, 1024);
    if (argc == 2) {
        for (i = 0; i < N_ALL && well; i++) well = measure(analysis_number(i), bytes, &most);
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
