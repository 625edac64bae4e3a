/* An analysis at the end of a process, in a function of atexit that was registered before the first call and in a destructor
 * of the program after it, as those of static objects, has the result of the one before. Prints two lines at the end. */
#include "analyses.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static uint64_t before = 1;

static uint64_t solve(void)
{
    hbvib_model *model = NULL;
    uint64_t sum = 1;
    if (ring(&model) < 0 || forced_to_tolerance(model, &sum) < 0 || hbvib_model_free(model) != HBVIB_OK) {
        fprintf(stderr, "%s\n", hbvib_last_error());
        _exit(3);
    }
    return sum;
}

static void check(const char *when)
{
    if (before == 1) return;
    if (solve() != before) _exit(4);
    printf("the same %s\n", when);
    fflush(stdout);
}

static void at_end(void)
{
    check("in atexit");
}

__attribute__((destructor)) static void last(void)
{
    check("in a destructor");
}

int main(void)
{
    if (atexit(at_end) != 0) return 2;
    before = solve();
    return 0;
}
