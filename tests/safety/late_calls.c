/* An analysis at the end of a process, in a function of atexit that was registered before the first call, has the result of
 * the one before; and a locale with a decimal comma, where the system has one, changes no sentence and no result. Prints
 * one line at the end. */
#include "analyses.h"

#include <locale.h>
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

static void at_end(void)
{
    if (solve() != before) _exit(4);
    printf("the same at the end\n");
}

int main(void)
{
    static const char *const commas[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "nl_NL.UTF-8", "C.UTF-8"};
    hbvib_model *model = NULL;
    int i;
    if (atexit(at_end) != 0) return 2;
    before = solve();
    for (i = 0; i < 5 && setlocale(LC_ALL, commas[i]) == NULL; i++) {
    }
    if (solve() != before) return 5;
    if (three(&model) < 0 || hbvib_model_set_loss_factor(model, -0.5) != HBVIB_E_ARGUMENT) return 6;
    if (strstr(hbvib_last_error(), "-0.5") == NULL) return 7;
    return hbvib_model_free(model);
}
