/* Creates a model, solves and frees it, many times: memory does not grow. Run as: cycles <times>; prints the resident
 * memory after a tenth of them and at the end, in bytes. */
#include "analyses.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static long long resident(void)
{
    long long size = 0, pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file == NULL || fscanf(file, "%lld %lld", &size, &pages) != 2) abort();
    fclose(file);
    return pages * (long long)sysconf(_SC_PAGESIZE);
}

int main(int argc, char **argv)
{
    long long i, times, after_a_tenth = 0;
    uint64_t first = 0;
    if (argc != 2) return 2;
    times = atoll(argv[1]);
    for (i = 0; i < times; i++) {
        hbvib_model *model = NULL;
        uint64_t sum = 1;
        if (i == times / 10) after_a_tenth = resident();
        if (ring(&model) < 0 || forced(model, &sum) < 0 || hbvib_model_free(model) != HBVIB_OK) return 3;
        if (i == 0) first = sum;
        if (sum != first) return 4;
    }
    printf("%lld %lld\n", after_a_tenth, resident());
    return 0;
}
