/* Runs every analysis in a thread with a small stack below which no page is mapped, and measures the bytes of it that were
 * used. Run as: stacks <bytes> [small], where "small" takes building, forced responses and modes alone. Prints the use of
 * each analysis and the largest. */
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

int main(int argc, char **argv)
{
    size_t bytes;
    int64_t most = 0;
    int i, small = argc > 2;
    if (argc < 2) return 2;
    bytes = (size_t)atoll(argv[1]);
    setvbuf(stdout, NULL, _IOLBF, 1024);
    for (i = 0; i < N_ALL; i++) {
        const analysis *a = analysis_number(i);
        int64_t n;
        if (small && a->run != forced && a->run != forced_to_tolerance && a->run != mode && a->run != mode_to_tolerance) continue;
        printf("%-36s ", a->name);
        fflush(stdout);
        n = used(a, bytes);
        if (n < 0) {
            printf("failed\n");
            return 1;
        }
        printf("%lld\n", (long long)n);
        if (n > most) most = n;
    }
    printf("%lld of %lld bytes at most\n", (long long)most, (long long)bytes);
    return 0;
}
