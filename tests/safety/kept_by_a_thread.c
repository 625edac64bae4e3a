/* A thread keeps 4 MiB for products of large matrices from its first analysis until it ends, in address space too, and asks for
 * them twice before; how large the products are does not matter. Run under LD_PRELOAD=libfailing_malloc.so. */
#include "designs.h"
#include "failing_malloc.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { KEPT = (4 << 20) + (1 << 16), MARGIN = 1 << 20, ORDER = 300 };

static int failures;

static int64_t address_space(void)
{
    long pages = 0;
    FILE *f = fopen("/proc/self/statm", "r");
    if (f == NULL || fscanf(f, "%ld", &pages) != 1) abort();
    fclose(f);
    return (int64_t)pages * sysconf(_SC_PAGESIZE);
}

/* Modes of a chain of 300 masses in dense matrices. */
static hbvib_status large(const hbvib_model *model, uint64_t *sum)
{
    static double m[ORDER * ORDER], k[ORDER * ORDER];
    hbvib_matrix mass = dense(ORDER, m), stiffness = dense(ORDER, k);
    hbvib_model *chained = NULL;
    double omega[4];
    hbvib_status status = hbvib_model_new(ORDER, &chained);
    int i;
    (void)model;
    for (i = 0; i < ORDER; i++) {
        m[i * (ORDER + 1)] = 1;
        k[i * (ORDER + 1)] = 2;
        if (i > 0) k[i * (ORDER + 1) - 1] = k[(i - 1) * (ORDER + 1) + 1] = -1;
    }
    STEP(hbvib_model_set_matrix(chained, HBVIB_MASS, &mass));
    STEP(hbvib_model_set_matrix(chained, HBVIB_STIFFNESS, &stiffness));
    STEP(hbvib_linear_modes(chained, 0, HBVIB_CONTACTS_FREE, 4, omega, NULL));
    digest(sum, omega, sizeof omega);
    return hbvib_model_free(chained) == HBVIB_OK ? status : HBVIB_E_INTERNAL;
}

/* An analysis on a model of which nothing is left afterwards. */
static void watch(const char *name, hbvib_status (*run)(const hbvib_model *, uint64_t *), int is_first)
{
    hbvib_model *model = NULL;
    uint64_t sum = 1;
    int64_t blocks = memory_bytes(), space = address_space(), peak;
    hbvib_status status = HBVIB_OK;
    memory_arm(0, 0);
    STEP(ring(&model));
    STEP(run(model, &sum));
    if (model == NULL || hbvib_model_free(model) != HBVIB_OK) abort();
    peak = memory_peak() - blocks;
    memory_disarm();
    blocks = memory_bytes() - blocks;
    space = address_space() - space;
    printf("%s: status %d, %lld bytes at most, keeps %lld bytes and %lld of address space\n", name, (int)status,
           (long long)peak, (long long)blocks, (long long)space);
    failures += status != HBVIB_OK && status != HBVIB_STOPPED_MAX_POINTS;
    /* They are requested twice, once so that it can fail. */
    failures += is_first ? blocks > KEPT || peak > 2 * KEPT + MARGIN : blocks > 1 << 16;
    failures += space > (is_first ? KEPT : 0) + 4 * MARGIN;
}

static void *work(void *user)
{
    watch("first analysis", forced, 1);
    watch("modes of 300 degrees of freedom", large, 0);
    watch("the first once more", forced, 0);
    return user;
}

int main(void)
{
    int64_t before = 0;
    int i;
    for (i = 0; i < 3; i++) {
        pthread_t thread;
        if (pthread_create(&thread, NULL, work, NULL) != 0 || pthread_join(thread, NULL) != 0) abort();
        if (i == 0) before = memory_bytes();
    }
    printf("%lld bytes stay when threads end\n", (long long)(memory_bytes() - before));
    failures += memory_bytes() != before;
    printf("in all: %d failures\n", failures);
    return failures != 0;
}
