/* A caller whose locale has a decimal comma gets the results, saved models and sentences of one without it, and its locale
 * stays. Run with LOCPATH set to a folder with the locale that is the only argument; prints one line. */
#include "analyses.h"

#include <locale.h>
#include <stdio.h>
#include <stdlib.h>

static unsigned char bytes[2][1 << 14];
static char sentence[2][1024];

/* All that could have numbers as text. */
static int everything(int i, uint64_t *sum, int64_t *size)
{
    hbvib_model *model = NULL;
    *sum = 1;
    if (table(&model) < 0 || forced_to_tolerance(model, sum) < 0) return 3;
    if (hbvib_model_save(model, sizeof bytes[i], bytes[i], size) != HBVIB_OK) return 4;
    if (hbvib_model_set_loss_factor(model, -0.5) != HBVIB_E_ARGUMENT) return 5;
    if (hbvib_last_error_copy(sentence[i], sizeof sentence[i]) <= 0 || hbvib_model_free(model) != HBVIB_OK) return 6;
    model = NULL;
    if (hbvib_model_load(*size, bytes[i], &model) != HBVIB_OK || forced_to_tolerance(model, sum) < 0) return 7;
    return hbvib_model_free(model);
}

int main(int argc, char **argv)
{
    uint64_t sums[2];
    int64_t sizes[2];
    char half[8], name[64];
    int failed;
    if (argc != 2 || (failed = everything(0, &sums[0], &sizes[0])) != 0) return 2;
    if (setlocale(LC_ALL, argv[1]) == NULL) return 8;
    /* The locale has the comma. */
    snprintf(half, sizeof half, "%.1f", 0.5);
    if (strcmp(half, "0,5") != 0) return 9;
    snprintf(name, sizeof name, "%s", setlocale(LC_ALL, NULL));
    if ((failed = everything(1, &sums[1], &sizes[1])) != 0) return failed;
    if (strcmp(name, setlocale(LC_ALL, NULL)) != 0) return 10;
    if (sums[0] != sums[1] || sizes[0] != sizes[1] || memcmp(bytes[0], bytes[1], (size_t)sizes[0]) != 0) return 11;
    if (strcmp(sentence[0], sentence[1]) != 0 || strstr(sentence[0], "-0.5") == NULL) return 12;
    printf("the same with a decimal comma\n");
    return 0;
}
