/* Rows 51, 83, 89, 90, 95, 101 to 104: hooks, cancellation, threads on one model. */
#include "common.h"

#include <pthread.h>
#include <signal.h>

typedef struct seen {
    hbvib_model *model, *other;
    int64_t calls, stop_at, last_point;
    double last_parameter, last_fraction;
    int wrong, nested, lines;
    hbvib_cancel_flag *flag;
} seen;

static int32_t progress(void *user, const hbvib_progress *p)
{
    seen *s = user;
    s->calls++;
    s->wrong += p->struct_size != sizeof *p || p->point != s->calls || !(p->residual >= 0) || !(p->amplitude > 0);
    s->wrong += !(p->fraction_done >= 0 && p->fraction_done <= 1);
    s->last_point = p->point;
    s->last_parameter = p->parameter;
    s->last_fraction = p->fraction_done;
    return s->stop_at > 0 && s->calls >= s->stop_at;
}

/* Tries everything that must not be done to a model in use, then what may be done. */
static int32_t intrude(void *user, const hbvib_progress *p)
{
    seen *s = user;
    hbvib_matrix a = matrix(NDOF, MASS);
    hbvib_contact c = ring_contact();
    const double two[2] = {1, 2};
    const int64_t dof = 0;
    const int32_t power = 2;
    hbvib_model *copy = NULL;
    solution *nested = malloc(sizeof *nested);
    if (nested == NULL) return 1;
    s->calls++;
    s->last_point = p->point;
    s->wrong += hbvib_model_free(s->model) != HBVIB_E_BUSY; /* row 90 */
    s->wrong += hbvib_last_error_argument() != 1 || strstr(hbvib_last_error(), "in use") == NULL;
    s->wrong += hbvib_model_add_contact(s->model, &c, NULL) != HBVIB_E_BUSY; /* row 51 */
    s->wrong += hbvib_model_set_matrix(s->model, HBVIB_MASS, &a) != HBVIB_E_BUSY; /* row 101 */
    s->wrong += hbvib_model_set_rayleigh(s->model, 0, 0) != HBVIB_E_BUSY;
    s->wrong += hbvib_cyclic_set_coupling(s->model, HBVIB_MASS, &a) != HBVIB_E_BUSY;
    s->wrong += hbvib_cyclic_set_coupling_previous(s->model, HBVIB_DAMPING, &a) != HBVIB_E_BUSY;
    s->wrong += hbvib_cyclic_set_diameter(s->model, HBVIB_MASS, 0, &a) != HBVIB_E_BUSY;
    s->wrong += hbvib_cyclic_set_wave(s->model, 3) != HBVIB_E_BUSY;
    s->wrong += hbvib_cyclic_set_aero(s->model, 0, NULL, 0, NULL, NULL, 0) != HBVIB_E_BUSY;
    s->wrong += hbvib_model_add_table(s->model, 0, 1, 0, 2, two, two, NULL) != HBVIB_E_BUSY;
    s->wrong += hbvib_model_add_spring_damper(s->model, 0, 1, 0, 1, two, 0, NULL, NULL) != HBVIB_E_BUSY;
    s->wrong += hbvib_model_add_polynomial(s->model, &dof, 1, 1, &dof, two, &power, NULL, NULL) != HBVIB_E_BUSY;
    s->wrong += hbvib_model_add_stiffness_tensors(s->model, &dof, 1, two, NULL, NULL) != HBVIB_E_BUSY;
    s->wrong += hbvib_model_add_patch(s->model, &c, 0, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL) != HBVIB_E_BUSY;
    s->wrong += hbvib_model_set_preload(s->model, 0, 1) != HBVIB_E_BUSY;
    s->wrong += hbvib_model_add_force(s->model, 0, 1, 1, 0) != HBVIB_E_BUSY;
    s->wrong += hbvib_model_clear_forces(s->model) != HBVIB_E_BUSY;
    if (s->nested++ < 2) { /* rows 101, 102, 103: solving, copying, asking */
        s->wrong += solve(s->model, nested) != HBVIB_OK || memcmp(nested, &the_solution, sizeof *nested) != 0;
        s->wrong += solve(s->other, nested) != HBVIB_OK || memcmp(nested, &the_solution, sizeof *nested) != 0;
        s->wrong += hbvib_model_clone(s->model, &copy) != HBVIB_OK || hbvib_model_free(copy) != HBVIB_OK;
        s->wrong += hbvib_version() != (HBVIB_VERSION_MAJOR << 16 | HBVIB_VERSION_MINOR << 8 | HBVIB_VERSION_PATCH);
        s->wrong += hbvib_last_error()[0] != '\0';
    }
    s->wrong += hbvib_model_free(NULL) != HBVIB_OK;
    s->wrong += hbvib_model_new(-3, &copy) != HBVIB_E_DIMENSION; /* an error in here is not the solve's */
    free(nested);
    return 0;
}

static void keep_line(void *user, int32_t level, const char *message)
{
    seen *s = user;
    s->lines++;
    s->wrong += level < HBVIB_LOG_WARN || level > HBVIB_LOG_DEBUG || message == NULL || message[0] == '\0';
}

static hbvib_hooks hooks_for(seen *s)
{
    hbvib_hooks h;
    if (hbvib_hooks_init(&h, sizeof h) != HBVIB_OK) abort();
    h.user = s;
    h.progress = progress;
    return h;
}

static void hooks(void)
{
    hbvib_forced_options o = frequencies(207, 211);
    hbvib_solver_options options = solver_options();
    hbvib_branch *branch = NULL;
    hbvib_cancel_flag flag = 0;
    seen s = {0};
    hbvib_hooks h = hooks_for(&s);
    hbvib_view omega;
    int64_t count = -1;

    /* All points are reported, the log too, and nothing changes by it. */
    h.log = keep_line;
    h.log_level = HBVIB_LOG_DEBUG;
    h.cancel = &flag;
    options.num_threads = 1;
    WORKS("83", hbvib_forced_response(the_model, &options, &o, &h, &branch));
    EXPECT("83", s.wrong == 0 && s.lines > 0 && s.calls == the_solution.points && s.last_fraction == 1);
    EXPECT("83", s.last_parameter == the_solution.omega[the_solution.points - 1]);
    WORKS("83", hbvib_branch_free(branch));
    branch = NULL;

    /* Row 104: the hook stops; the points so far are there. */
    memset(&s, 0, sizeof s);
    h = hooks_for(&s);
    s.stop_at = 5;
    EXPECT("104", hbvib_forced_response(the_model, &options, &o, &h, &branch) == HBVIB_STOPPED_BY_CALLER);
    EXPECT("104", strstr(hbvib_last_error(), "points found so far are kept") != NULL && hbvib_last_error_argument() == 0);
    EXPECT("104", s.calls == 5 && hbvib_branch_points(branch) == 5);
    EXPECT("104", hbvib_branch_status(branch) == HBVIB_STOPPED_BY_CALLER);
    WORKS("104", hbvib_view_init(&omega, sizeof omega));
    WORKS("104", hbvib_branch_field(branch, HBVIB_OMEGA, &omega));
    EXPECT("104", omega.shape[0] == 5 && memcmp(omega.data, the_solution.omega, 5 * sizeof(double)) == 0);
    WORKS("104", hbvib_branch_field(branch, HBVIB_SLIP_FRACTION, &omega));
    EXPECT("104", omega.rank == 2 && omega.shape[0] == 5 && omega.shape[1] == 1);
    WORKS("104", hbvib_branch_peaks(branch, 0, NULL, NULL, NULL, &count));
    EXPECT("104", count == 0);
    WORKS("104", hbvib_branch_free(branch));
    branch = NULL;

    /* The flag before the start: an empty branch, whose queries work. */
    flag = 1;
    memset(&s, 0, sizeof s);
    h = hooks_for(&s);
    h.cancel = &flag;
    EXPECT("104", hbvib_forced_response(the_model, &options, &o, &h, &branch) == HBVIB_STOPPED_BY_CALLER);
    EXPECT("104", s.calls == 0 && hbvib_branch_points(branch) == 0 && flag == 1);
    WORKS("104", hbvib_branch_field(branch, HBVIB_AMPLITUDE, &omega));
    EXPECT("104", omega.shape[0] == 0 && omega.data == NULL);
    WORKS("104", hbvib_branch_folds(branch, 0, NULL, NULL, NULL, &count));
    WORKS("104", hbvib_branch_free(branch));
    branch = NULL;
    flag = 0;
    WORKS("104", hbvib_forced_response(the_model, &options, &o, &h, &branch));
    WORKS("104", hbvib_branch_free(branch));
    branch = NULL;

    /* Rows 51, 90, 101 to 103: what a callback may do. */
    memset(&s, 0, sizeof s);
    h = hooks_for(&s);
    s.model = the_model;
    s.other = ring_damper();
    h.progress = intrude;
    WORKS("101", hbvib_forced_response(the_model, &options, &o, &h, &branch));
    EXPECT("90, 101, 102, 103", s.wrong == 0 && s.calls == the_solution.points);
    WORKS("101", hbvib_branch_free(branch));
    WORKS("101", hbvib_model_free(s.other));
    EXPECT("101", same_solution(the_model, &the_solution));
}

static hbvib_cancel_flag raised;

static void raise_flag(int number)
{
    (void)number;
    raised = 1;
}

static int32_t raise_signal(void *user, const hbvib_progress *p)
{
    seen *s = user;
    s->calls = p->point;
    if (p->point == 7) s->wrong += raise(SIGUSR1) != 0;
    return 0;
}

static void signals(void)
{
    hbvib_forced_options o = frequencies(207, 211);
    hbvib_branch *branch = NULL;
    seen s = {0};
    hbvib_hooks h = hooks_for(&s);
    h.progress = raise_signal;
    h.cancel = &raised;
    signal(SIGUSR1, raise_flag);
    EXPECT("104", hbvib_forced_response(the_model, NULL, &o, &h, &branch) == HBVIB_STOPPED_BY_CALLER);
    EXPECT("104", s.wrong == 0 && s.calls == 7 && hbvib_branch_points(branch) == 7);
    WORKS("104", hbvib_branch_free(branch));
    signal(SIGUSR1, SIG_DFL);
}

/* Row 89: another thread tries to free the model while this one solves it. */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t changed = PTHREAD_COND_INITIALIZER;
static int stage = 0;

static void go_to(int next)
{
    pthread_mutex_lock(&lock);
    stage = next;
    pthread_cond_broadcast(&changed);
    pthread_mutex_unlock(&lock);
}

static void wait_for(int wanted)
{
    pthread_mutex_lock(&lock);
    while (stage < wanted) pthread_cond_wait(&changed, &lock);
    pthread_mutex_unlock(&lock);
}

static int32_t hold(void *user, const hbvib_progress *p)
{
    (void)user;
    if (p->point == 3) {
        go_to(1);
        wait_for(2);
    }
    return 0;
}

static void *intruder(void *user)
{
    int *wrong = user;
    solution *mine = malloc(sizeof *mine);
    wait_for(1);
    *wrong += hbvib_last_error()[0] != '\0'; /* row 95: no text of another thread */
    *wrong += hbvib_model_free(the_model) != HBVIB_E_BUSY;
    *wrong += hbvib_model_clear_forces(the_model) != HBVIB_E_BUSY;
    /* Row 99: but solving it at the same time gives the same bits. */
    *wrong += mine == NULL || solve(the_model, mine) != HBVIB_OK || memcmp(mine, &the_solution, sizeof *mine) != 0;
    *wrong += hbvib_model_new(0, &(hbvib_model *){NULL}) != HBVIB_E_DIMENSION;
    free(mine);
    go_to(2);
    return NULL;
}

static void *solver(void *user)
{
    int *wrong = user, i;
    for (i = 0; i < 50; i++) *wrong += !same_solution(the_model, &the_solution);
    return NULL;
}

static void *own_model(void *user)
{
    int *wrong = user, i;
    for (i = 0; i < 50; i++) {
        hbvib_model *model = ring_damper();
        *wrong += !same_solution(model, &the_solution);
        *wrong += hbvib_model_free(model) != HBVIB_OK;
    }
    return NULL;
}

static void *create(void *user)
{
    *(hbvib_model **)user = ring_damper();
    return NULL;
}

static void threads(void)
{
    pthread_t thread[4];
    int wrong[4] = {0}, i;
    hbvib_forced_options o = frequencies(207, 211);
    hbvib_solver_options options = solver_options();
    hbvib_branch *branch = NULL;
    hbvib_model *model = NULL;
    hbvib_hooks h;
    if (hbvib_hooks_init(&h, sizeof h) != HBVIB_OK) abort();
    h.progress = hold;
    if (pthread_create(&thread[0], NULL, intruder, wrong) != 0) abort();
    WORKS("89", hbvib_forced_response(the_model, &options, &o, &h, &branch));
    pthread_join(thread[0], NULL);
    EXPECT("89, 95, 99", wrong[0] == 0 && hbvib_last_error()[0] == '\0');
    WORKS("89", hbvib_branch_free(branch));

    for (i = 0; i < 4; i++) /* rows 99, 100 */
        if (pthread_create(&thread[i], NULL, i < 2 ? solver : own_model, &wrong[i]) != 0) abort();
    for (i = 0; i < 4; i++) {
        pthread_join(thread[i], NULL);
        EXPECT("99, 100", wrong[i] == 0);
    }
    if (pthread_create(&thread[0], NULL, create, &model) != 0) abort(); /* row 94 */
    pthread_join(thread[0], NULL);
    EXPECT("94", same_solution(model, &the_solution));
    WORKS("94", hbvib_model_free(model));
}

/* A flag that another thread sets while a call reads it. */
static void *sets_the_flag(void *flag)
{
    return hbvib_cancel(flag, 1) == HBVIB_OK ? NULL : flag;
}

static void cancelled_by_a_setter(void)
{
    hbvib_cancel_flag flag = 0;
    hbvib_hooks hooks;
    hbvib_forced_options o = frequencies(207, 211);
    hbvib_branch *branch = NULL;
    pthread_t thread;
    void *failed = &hooks;
    EXPECT("104", hbvib_cancel(NULL, 1) == HBVIB_E_NULL && hbvib_cancel(&flag, 2) == HBVIB_E_ARGUMENT && flag == 0);
    if (pthread_create(&thread, NULL, sets_the_flag, (void *)(uintptr_t)&flag) != 0) abort();
    pthread_join(thread, &failed);
    EXPECT("104", failed == NULL && flag == 1);
    WORKS("104", hbvib_hooks_init(&hooks, sizeof hooks));
    hooks.cancel = &flag;
    EXPECT("104", hbvib_forced_response(the_model, NULL, &o, &hooks, &branch) == HBVIB_STOPPED_BY_CALLER);
    WORKS("104", hbvib_branch_free(branch));
    branch = NULL;
    EXPECT("104", hbvib_cancel(&flag, 0) == HBVIB_OK);
    WORKS("104", hbvib_forced_response(the_model, NULL, &o, &hooks, &branch));
    WORKS("104", hbvib_branch_free(branch));
}

int main(void)
{
    begin();
    hooks();
    signals();
    threads();
    cancelled_by_a_setter();
    WORKS("89", hbvib_model_free(the_model));
    return verdict(50);
}
