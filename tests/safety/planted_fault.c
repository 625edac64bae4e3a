/* Row 13, and other faults on purpose, which a tool that watches the library must see. Run as: planted_fault address, where the
 * library writes beyond an array that is shorter than stated; planted_fault leak, where memory is lost; or planted_fault race,
 * with a plain store to a cancel flag. */
#include "analyses.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

static hbvib_cancel_flag cancel;
static hbvib_model *model;

static void *solve(void *user)
{
    hbvib_solver_options s = options(0);
    hbvib_forced_options o = range(model);
    hbvib_hooks h;
    hbvib_branch *branch = NULL;
    if (hbvib_hooks_init(&h, sizeof h) != HBVIB_OK) abort();
    h.cancel = &cancel;
    s.max_points = 400;
    o.omega_start *= 0.7;
    if (hbvib_forced_response(model, &s, &o, &h, &branch) < 0 || hbvib_branch_free(branch) != HBVIB_OK) abort();
    return user;
}

int main(int argc, char **argv)
{
    pthread_t thread;
    if (argc != 2 || ring(&model) < 0) return 2;
    if (strcmp(argv[1], "race") == 0) {
        if (pthread_create(&thread, NULL, solve, NULL) != 0) return 2;
        cancel = 1;
        if (pthread_join(thread, NULL) != 0) return 2;
    } else if (strcmp(argv[1], "leak") == 0) {
        char *volatile lost = malloc(100);
        lost[0] = 1;
        lost = NULL;
        return hbvib_model_free(model) != HBVIB_OK;
    } else {
        hbvib_solver_options s = options(0);
        hbvib_forced_options o = range(model);
        hbvib_branch *branch = NULL;
        double *x = malloc(7 * sizeof *x);
        if (x == NULL || hbvib_forced_response(model, &s, &o, NULL, &branch) < 0) return 2;
        if (hbvib_branch_harmonics(branch, 0, 0, 1, x, 4) != HBVIB_OK || hbvib_branch_free(branch) != HBVIB_OK) return 2;
        printf("%g\n", x[6]);
        free(x);
    }
    printf("the planted fault was not seen\n");
    return hbvib_model_free(model) != HBVIB_OK;
}
