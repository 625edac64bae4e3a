/* Rows 96 to 98 and 105 to 107: the library in a host's process. Run as: process <copy of the
 * library>, which is opened at run time beside the one that is linked. */
#include "common.h"

#include <dlfcn.h>
#include <fenv.h>
#include <pthread.h>
#include <sys/wait.h>
#include <unistd.h>

static void *solve_in_thread(void *user)
{
    int *good = user;
    *good = same_solution(the_model, &the_solution);
    return NULL;
}

static void small_stacks(void)
{
    const size_t sizes[] = {128 * 1024, 64 * 1024};
    size_t i;
    for (i = 0; i < 2; i++) { /* row 105 */
        pthread_attr_t attributes;
        pthread_t thread;
        int good = 0;
        pthread_attr_init(&attributes);
        if (pthread_attr_setstacksize(&attributes, sizes[i]) != 0) abort();
        if (pthread_create(&thread, &attributes, solve_in_thread, &good) != 0) abort();
        pthread_join(thread, NULL);
        EXPECT("105", good);
        pthread_attr_destroy(&attributes);
    }
}

static void floating_point(void)
{
    fenv_t plain;
    solution *found = malloc(sizeof *found);
    if (found == NULL || fegetenv(&plain) != 0) abort();
    /* Row 107: a host that traps on invalid operations, division by zero and overflow. */
    feclearexcept(FE_ALL_EXCEPT);
    if (feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW) == -1) abort();
    EXPECT("107", same_solution(the_model, &the_solution));
    EXPECT("107", fegetexcept() == (FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW));
    fesetenv(&plain);
    /* Row 106: another rounding mode is neither changed nor fatal. */
    fesetround(FE_TOWARDZERO);
    EXPECT("106", solve(the_model, found) != HBVIB_E_INTERNAL && fegetround() == FE_TOWARDZERO);
    fesetenv(&plain);
    EXPECT("106", same_solution(the_model, &the_solution));
    free(found);
}

static void forks(void)
{
    int result = -1;
    pid_t child = fork(); /* row 97 */
    if (child == 0) _exit(same_solution(the_model, &the_solution) ? 0 : 1);
    EXPECT("97", child > 0 && waitpid(child, &result, 0) == child && WIFEXITED(result) && WEXITSTATUS(result) == 0);
}

typedef hbvib_status new_function(int64_t, hbvib_model **);
typedef hbvib_status free_function(hbvib_model *);

static void copies(const char *path)
{
    int i;
    for (i = 0; i < 100; i++) { /* row 96 */
        hbvib_model *model = NULL;
        new_function *make;
        free_function *end;
        void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
        EXPECT("96", library != NULL);
        if (library == NULL) return;
        *(void **)&make = dlsym(library, "hbvib_model_new");
        *(void **)&end = dlsym(library, "hbvib_model_free");
        EXPECT("96", make != NULL && end != NULL && make != hbvib_model_new);
        EXPECT("96", make(4, &model) == HBVIB_OK);
        /* Row 98: the other copy has a table of its own. */
        EXPECT("98", hbvib_model_free(model) == HBVIB_E_HANDLE);
        EXPECT("96", end(model) == HBVIB_OK && end(model) == HBVIB_E_HANDLE);
        EXPECT("96", dlclose(library) == 0);
    }
    EXPECT("98", same_solution(the_model, &the_solution));
}

int main(int argc, char **argv)
{
    if (argc != 2) return 2;
    begin();
    small_stacks();
    floating_point();
    forks();
    copies(argv[1]);
    WORKS("96", hbvib_model_free(the_model));
    return verdict(300);
}
