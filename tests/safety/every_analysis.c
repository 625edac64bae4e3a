/* Every analysis once, for tools that watch a program. Run as: every_analysis [name]. Prints their number. */
#include "designs.h"

#include <stdio.h>

int main(int argc, char **argv)
{
    int i, count = 0;
    for (i = 0; i < N_ALL; i++) {
        const analysis *a = analysis_number(i);
        hbvib_model *model = NULL;
        uint64_t sum = 1;
        if (argc > 1 && strcmp(argv[1], a->name) != 0) continue;
        if (a->build(&model) < 0 || a->run(model, &sum) < 0 || hbvib_model_free(model) != HBVIB_OK) {
            fprintf(stderr, "%s: %s\n", a->name, hbvib_last_error());
            return 1;
        }
        count++;
    }
    printf("%d analyses\n", count);
    return count == 0;
}
