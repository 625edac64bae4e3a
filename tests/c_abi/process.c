/* Rows 96 to 98 and 105 to 107: the library in a host's process. Run as: process <copy of the
 * library>, which is opened at run time beside the one that is linked. */
#include "common.h"

#include <dlfcn.h>
#include <fenv.h>
#ifdef __x86_64__
#include <xmmintrin.h>
#endif
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

enum { TRAPS = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW };

static int32_t looks_at_traps(void *user, const hbvib_progress *progress)
{
    *(int *)user += progress->point > 0 && fegetexcept() == TRAPS;
    return 0;
}

static void modes_under_traps(void)
{
    hbvib_model *model = NULL;
    hbvib_branch *branch = NULL;
    hbvib_mode_options mode = amplitudes(0, 1);
    hbvib_hooks hooks;
    int seen = 0;
    WORKS("107", hbvib_hooks_init(&hooks, sizeof hooks));
    hooks.user = &seen;
    hooks.progress = looks_at_traps;
    WORKS("107", hbvib_nonlinear_mode(the_model, NULL, &mode, &hooks, &branch));
    EXPECT("107", seen > 0 && seen == hbvib_branch_points(branch));
    WORKS("107", hbvib_model_clone(the_model, &model));
    WORKS("107", hbvib_model_set_preload(model, 0, HUGE_VAL));
    mode.log10_start = -6;
    mode.log10_stop = -2;
    REFUSED("107", hbvib_nonlinear_mode(model, NULL, &mode, NULL, &branch), HBVIB_E_ARGUMENT, 0, "it is linear");
    WORKS("107", hbvib_branch_free(branch));
    WORKS("107", hbvib_model_free(model));
}

/* Whether the resonance is this one to the last bit; it is kept for the next question. The options come from
 * outside, because this program's own arithmetic rounds like its host's. */
static int same_peaks(const hbvib_forced_options *o, double *amplitude)
{
    const double before = *amplitude;
    hbvib_branch *branch = NULL;
    int64_t count = 0;
    hbvib_solver_options s = solver_options();
    WORKS("106", hbvib_forced_response(the_model, &s, o, NULL, &branch));
    WORKS("106", hbvib_branch_peaks(branch, 1, NULL, amplitude, NULL, &count));
    WORKS("106", hbvib_branch_free(branch));
    return count == 1 && *amplitude == before;
}

static int32_t rounds_upward(void *user, const hbvib_progress *progress)
{
    *(int *)user += progress->point > 1 && fegetround() == FE_UPWARD;
    feraiseexcept(FE_DIVBYZERO);
    return fesetround(FE_UPWARD);
}

/* What a callback does to its own arithmetic is there in the next one, and after the call. */
static void callbacks_keep_their_arithmetic(void)
{
    hbvib_forced_options o = frequencies(207, 211);
    hbvib_branch *branch = NULL;
    hbvib_hooks hooks;
    int seen = 0;
    WORKS("106", hbvib_hooks_init(&hooks, sizeof hooks));
    hooks.user = &seen;
    hooks.progress = rounds_upward;
    WORKS("106", hbvib_forced_response(the_model, NULL, &o, &hooks, &branch));
    EXPECT("106", fegetround() == FE_UPWARD && fetestexcept(FE_DIVBYZERO) != 0);
    EXPECT("106", seen == hbvib_branch_points(branch) - 1);
    WORKS("106", hbvib_branch_free(branch));
}

static void floating_point(void)
{
    const hbvib_forced_options o = frequencies(207, 211);
    fenv_t plain;
    double the_peak = 0;
    if (fegetenv(&plain) != 0) abort();
    EXPECT("106", !same_peaks(&o, &the_peak));
    /* Row 107: a host that traps on invalid operations, division by zero and overflow. */
    feclearexcept(FE_ALL_EXCEPT);
    if (feenableexcept(TRAPS) == -1) abort();
    EXPECT("107", same_solution(the_model, &the_solution));
    EXPECT("107", fegetexcept() == TRAPS);
    /* Where the library itself meets infinity, and a callback the host's traps. */
    modes_under_traps();
    EXPECT("107", fegetexcept() == TRAPS && fetestexcept(TRAPS) == 0);
    fesetenv(&plain);
    /* Row 106: another rounding mode is neither changed nor changes anything. */
    fesetround(FE_TOWARDZERO);
    EXPECT("106", same_peaks(&o, &the_peak) && fegetround() == FE_TOWARDZERO);
    fesetenv(&plain);
#ifdef __x86_64__
    /* Nor do small numbers that are flushed to zero. */
    _mm_setcsr(_mm_getcsr() | 0x8040);
    EXPECT("106", same_peaks(&o, &the_peak) && (_mm_getcsr() & 0x8040) == 0x8040);
    fesetenv(&plain);
#endif
    callbacks_keep_their_arithmetic();
    fesetenv(&plain);
    EXPECT("106", same_solution(the_model, &the_solution) && same_peaks(&o, &the_peak));
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
