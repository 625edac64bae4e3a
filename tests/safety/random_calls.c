/* Random sequences of calls through the C interface: good and extreme values, live, freed and foreign handles, options of
 * other sizes, callbacks that fail, call back into the library, or cancel. Run as: random_calls <seed> <seconds> [calls
 * [seconds after which a call is stopped]]; the calls depend on the seed, but for those that are stopped for their time.
 * Prints the outcomes of each function, the longest call and one line of counts; a crash, an internal error, output of a
 * success that is not finite, a report after a stop, a call that takes more memory than its predicted need, or solves of which
 * fewer than a third have a result are failures. So is a call that does not end: one of HANGS seconds, which no busy machine
 * makes of the milliseconds that calls take. */
#include "models.h"
#include "failing_malloc.h"
#include "predicted_need.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

/* Counted where the program is linked with the malloc that counts. */
#pragma weak memory_arm
#pragma weak memory_bytes
#pragma weak memory_peak

enum { MOST = 24, N_FUNCTIONS = 80, HANGS = 30 };

static uint64_t state;

static uint64_t next(void)
{
    uint64_t z = (state += 0x9E3779B97F4A7C15u); /* splitmix64 */
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

static int one_in(int n) { return next() % (uint64_t)n == 0; }
static double uniform(void) { return (double)(next() >> 11) / 9007199254740992.0; }

static double number(double usual)
{
    static const double extreme[] = {0, -1, 1e300, -1e300, 1e-300, 5e-324, 1e-12, 1e12, HUGE_VAL, -HUGE_VAL, NAN, -0.0};
    return one_in(40) ? extreme[next() % 12] : usual * (0.5 + uniform());
}

static int64_t count(int64_t usual)
{
    static const int64_t extreme[] = {0, -1, 1, INT64_MIN, INT64_MAX, INT64_MAX / 8, 1 << 20, 4294967296, -2};
    return one_in(40) ? extreme[next() % 9] : usual;
}

/* Times, samples and harmonics: mostly the usual number, sometimes up to 2^24. */
static int64_t times(int64_t usual)
{
    return one_in(60) ? (int64_t)1 << (10 + next() % 15) : count(usual);
}

/* Handles: live ones, those that were freed, and others. */
static hbvib_model *models[MOST];
static hbvib_branch *branches[MOST];
static int64_t dofs[MOST];
static int n_models, n_branches;
static hbvib_model *freed_model;
static hbvib_branch *freed_branch;

/* From which the need of results follows. */
static struct solved {
    sizes model;
    double harmonics, samples;
    hbvib_model *of;
} of_branch[MOST];

static hbvib_model *some_model(int *which)
{
    *which = n_models > 0 ? (int)(next() % (uint64_t)n_models) : -1;
    if (one_in(50)) return (hbvib_model *)(uintptr_t)next();
    if (one_in(50)) return (hbvib_model *)freed_branch;
    if (one_in(50) || *which < 0) return freed_model;
    return models[*which];
}

/* A branch, mostly a live one. */
static hbvib_branch *some_branch(void)
{
    if (one_in(50)) return (hbvib_branch *)(uintptr_t)next();
    if (one_in(50) || n_branches == 0) return freed_branch;
    return branches[next() % (uint64_t)n_branches];
}

/* What the need of its results follows from; nothing for another handle. */
static struct solved sizes_of_branch(const hbvib_branch *branch)
{
    static const struct solved none;
    int i;
    for (i = 0; i < n_branches; i++) {
        if (branches[i] == branch) return of_branch[i];
    }
    return none;
}

/* The model of a branch where it lives, mostly; else some model. */
static hbvib_model *model_of(const struct solved *of, int *which)
{
    int i;
    for (i = 0; i < n_models && !one_in(4); i++) {
        if (models[i] != of->of) continue;
        *which = i;
        return models[i];
    }
    return some_model(which);
}

/* Outcomes of each function: its statuses, from HBVIB_OK on. */
static struct outcome {
    const char *name;
    int64_t calls, succeeded, stopped, refused, bytes;
    double share;
} outcomes[N_FUNCTIONS];
static int64_t calls, failures, solves, solved;
static clock_t longest;

/* Whether a callback has told the call that it is to stop. */
static int told_to_stop;

/* Bytes that the next call may take at one time: its predicted need. */
static double allowed;

/* What is solved, for a report, and the longest call. */
static char solving[600] = "", slowest[700] = "";
static const hbvib_model *solved_model;

static struct outcome *outcome_of(const char *name)
{
    int i = 0;
    while (i < N_FUNCTIONS && outcomes[i].name != NULL && strcmp(outcomes[i].name, name) != 0) i++;
    if (i == N_FUNCTIONS) abort();
    outcomes[i].name = name;
    return &outcomes[i];
}

/* When a call began, and the bytes that were allocated then. */
typedef struct beginning {
    clock_t time;
    int64_t bytes;
} beginning;

/* Writes the model that is solved to a file named by the environment, for a look at a failure. */
static void save_model(void)
{
    const char *name = getenv("RANDOM_CALLS_SAVE");
    int64_t size = 0;
    unsigned char *bytes;
    FILE *file;
    if (name == NULL || solved_model == NULL || hbvib_model_save(solved_model, 0, NULL, &size) != HBVIB_OK) return;
    bytes = malloc((size_t)size);
    file = fopen(name, "wb");
    if (bytes != NULL && file != NULL && hbvib_model_save(solved_model, size, bytes, &size) == HBVIB_OK) fwrite(bytes, 1, (size_t)size, file);
    if (file != NULL) fclose(file);
    free(bytes);
    fprintf(stderr, "saved the model of %lld degrees of freedom and %lld contacts\n", (long long)hbvib_model_dofs(solved_model),
            (long long)hbvib_model_contacts(solved_model));
}

static beginning begin_call(void)
{
    beginning b = {clock(), 0};
    told_to_stop = 0;
    if (memory_arm != NULL) {
        b.bytes = memory_bytes();
        memory_arm(0, 0);
    }
    return b;
}

/* Bytes that no call has taken yet. */
static double set_aside = 2 * (4 * MIB + 64 * KIB);

static void judge(const char *name, int64_t status, beginning begin)
{
    struct outcome *o = outcome_of(name);
    const clock_t spent = clock() - begin.time;
    const int64_t bytes = memory_arm != NULL ? memory_peak() - begin.bytes : 0;
    if (bytes > o->bytes) o->bytes = bytes;
    if ((double)bytes > o->share * allowed) o->share = (double)bytes / allowed;
    if ((double)bytes > allowed) {
        /* What a thread sets aside for its first products, twice at a time, falls into one call: in two of 2.6 million calls it was
         * not the first one. */
        const int is_set_aside = (double)bytes <= allowed + set_aside;
        if (is_set_aside) set_aside = 0;
        failures += !is_set_aside;
        save_model();
        fprintf(stderr, "%s: %lld bytes, %.0f are its need%s\n", name, (long long)bytes, allowed, solving);
    }
    calls++;
    o->calls++;
    if (status == 0) o->succeeded++;
    else if (status > 0) o->stopped++;
    else o->refused++;
    if (spent > longest) {
        longest = spent;
        snprintf(slowest, sizeof slowest, "%s%s", name, solving);
    }
    if (status == HBVIB_E_INTERNAL || status < HBVIB_E_INTERNAL || (status < 0 && hbvib_last_error()[0] == '\0')) {
        failures++;
        fprintf(stderr, "%s: status %lld, %s\n", name, (long long)status, hbvib_last_error());
    }
}

/* A call that may take so many bytes beside those of any call, counted under a name. */
#define CALL_NAMED(name, need, function, ...)                                                  \
    do {                                                                                       \
        beginning begin;                                                                       \
        allowed = 16 * KIB + (need);                                                           \
        begin = begin_call();                                                                  \
        status = function(__VA_ARGS__);                                                        \
        judge(name, status, begin);                                                            \
    } while (0)

#define CALL_WITHIN(need, function, ...) CALL_NAMED(#function, need, function, __VA_ARGS__)

#define CALL(function, ...) CALL_WITHIN(0, function, __VA_ARGS__)

/* Callbacks: most go on; some stop, fail, or call the library. Every call is stopped after a number of reports, or a share
 * of the time that it may take. */
enum { MOST_REPORTS = 300, MOST_POINTS = 2 * MOST_REPORTS };
static int64_t reports;
static clock_t started;
static double most_working = 0.5; /* seconds */

/* An answer to a report: nothing may be reported after a phase was told to stop, and no point after a point was: the
 * results of what is kept then, as those of the last period in time, have a phase of their own. */
enum { POINT = 1, PHASE = 2 };

static int32_t answer(int report, int stop)
{
    if (told_to_stop == PHASE || told_to_stop == report) {
        failures++;
        fprintf(stderr, "a report after the stop%s\n", solving);
    }
    if (stop) told_to_stop = report;
    return stop;
}

static int late(void)
{
    return ++reports > MOST_REPORTS || (double)(clock() - started) > most_working * CLOCKS_PER_SEC;
}

static void intrude(void)
{
    int which;
    hbvib_model *model = some_model(&which);
    hbvib_model_dofs(model);
    hbvib_model_add_force(model, 0, 1, 1, 0);
    if (one_in(8)) hbvib_branch_points(some_branch());
}

static int32_t on_progress(void *user, const hbvib_progress *p)
{
    (void)user;
    (void)p;
    if (one_in(100)) intrude();
    return answer(POINT, late() || one_in(400));
}

static int32_t on_phase(void *user, const hbvib_phase_report *p)
{
    (void)user;
    (void)p;
    return answer(PHASE, late());
}

static int32_t on_force(void *user, const hbvib_force_call *call)
{
    int64_t j, i;
    (void)user;
    if (one_in(3000)) return (int32_t)(next() % 3) - 1;
    if (one_in(1000)) intrude();
    for (j = 0; j < call->samples; j++) {
        for (i = 0; i < call->n; i++) {
            const int64_t k = j * call->n + i;
            call->f[k] = 0.1 * call->u[k] * call->u[k] * call->u[k];
            call->df_du[(j * call->n + i) * call->n + i] = 0.3 * call->u[k] * call->u[k];
        }
    }
    if (one_in(3000)) call->f[0] = NAN;
    return 0;
}

static hbvib_hooks hooks(void)
{
    hbvib_hooks h;
    memset(&h, 0, sizeof h);
    hbvib_hooks_init(&h, sizeof h);
    h.progress = on_progress;
    h.phase = on_phase;
    reports = 0;
    started = clock();
    return h;
}

static int64_t degree(int which) { return which < 0 ? 0 : count((int64_t)(next() % (uint64_t)dofs[which])); }

/* A guess of some harmonics with random content, or none: its complex numbers are counted. The last few are not always there. */
static double guessed[2 * 9 * 128];

static int64_t guess(int which)
{
    const int64_t n = which < 0 ? 1 : dofs[which], len = (1 + (int64_t)(next() % 8)) * n;
    int64_t i;
    if (one_in(2)) return 0;
    for (i = 0; i < 2 * len; i++) guessed[i] = one_in(3) ? number(uniform() - 0.5) : 0;
    return one_in(20) ? count(len) % (9 * 128) : len;
}

/* Structs whose size may be stated as larger than they are, as by a newer header. */
typedef union wide_options {
    hbvib_solver_options s;
    unsigned char bytes[512];
} wide_options;

typedef union wide_contact {
    hbvib_contact c;
    unsigned char bytes[512];
} wide_contact;

static hbvib_solver_options solver(void)
{
    hbvib_solver_options s;
    memset(&s, 0, sizeof s);
    hbvib_solver_options_init(&s, sizeof s);
    s.tolerance = one_in(4) ? number(0.05) : 0;
    s.harmonics = count(1 + (int64_t)(next() % 6));
    s.max_harmonics = count(30);
    s.samples = one_in(5) ? times(64) : 0;
    s.max_points = count(20);
    s.max_newton = count(20);
    s.response_dof = one_in(5) ? count(0) : -1;
    s.estimate_error = one_in(10);
    s.keep_even_harmonics = one_in(10);
    s.memory_limit = one_in(10) ? count(1 << 22) : 64 << 20;
    s.flexibility = one_in(10) ? (int32_t)(next() % 5) - 1 : 0;
    if (one_in(10)) s.tol_residual = number(1e-9);
    if (one_in(10)) s.step_max = number(0.1);
    /* Intervals of steps that the automatic ones cross, or that are empty. */
    if (one_in(12)) s.step = number(pow(10, 6 * uniform() - 4));
    if (one_in(12)) s.step_min = number(pow(10, 9 * uniform() - 7));
    if (one_in(12)) s.step_max = number(pow(10, 9 * uniform() - 7));
    if (one_in(30)) s.stability = (int32_t)(next() % 4);
    if (one_in(100)) s.struct_size = (uint32_t)next() % 300;
    if (one_in(100)) s.num_threads = (int32_t)next();
    return s;
}

static void add_model(void)
{
    static hbvib_status (*const build[])(hbvib_model **) = {ring, three, friction_2d, friction_3d, unilateral, cubic, regularised,
                                                            iwan, table, polynomials, caller_law, rotor, faces, small_ring, chain};
    hbvib_model *model = NULL;
    hbvib_status status;
    if (n_models == MOST) return;
    if (one_in(10)) CALL(hbvib_model_new, count(3), &model);
    else if (one_in(10)) CALL(hbvib_cyclic_new, count(3), count(5), &model);
    else if (n_models > 0 && one_in(4)) {
        const int i = (int)(next() % (uint64_t)n_models);
        const sizes m = sizes_of(models[i]);
        CALL_WITHIN(need_of_a_change(&m), hbvib_model_clone, models[i], &model);
    } else status = build[next() % (sizeof build / sizeof *build)](&model);
    if (model == NULL) return;
    dofs[n_models] = hbvib_model_dofs(model);
    if (dofs[n_models] > 100) {
        CALL(hbvib_model_free, model);
        return;
    }
    models[n_models++] = model;
}

/* Constants that a law has, mostly. */
static void usual_constants(hbvib_contact *c)
{
    const int friction = c->kind == HBVIB_JENKINS || c->kind == HBVIB_FRICTION_2D || c->kind == HBVIB_FRICTION_3D;
    if (friction || c->kind == HBVIB_CUBIC || one_in(20)) c->kt = number(1);
    if (c->kind == HBVIB_UNILATERAL || c->kind == HBVIB_FRICTION_2D || one_in(20)) c->kn = number(1);
    if (friction || c->kind == HBVIB_REGULARISED || one_in(20)) c->mu = number(0.4);
    if (friction || c->kind == HBVIB_REGULARISED || one_in(20)) c->preload = number(0.5);
    if (c->kind == HBVIB_CUBIC || one_in(20)) c->cubic = number(0.3);
    if (c->kind == HBVIB_REGULARISED || one_in(20)) c->velocity = number(0.1);
    if (c->kind == HBVIB_UNILATERAL) {
        c->dof_a[2] = c->dof_a[0];
        c->dof_a[0] = HBVIB_GROUND;
    } else if (c->kind == HBVIB_FRICTION_2D && c->kn != 0) {
        c->dof_a[2] = c->dof_a[0] > 0 ? c->dof_a[0] - 1 : 1;
    } else if (c->kind == HBVIB_FRICTION_3D) {
        c->dof_a[1] = c->dof_a[0] > 0 ? c->dof_a[0] - 1 : 1;
    }
}

/* Up to 20,000 contacts on few degrees of freedom. */
static void many_contacts(hbvib_model *model, int which)
{
    enum { MANY = 20000 };
    static int64_t a[MANY], b[MANY];
    static double kt[MANY], mu[MANY], preload[MANY];
    const int64_t n = 1 + (int64_t)(next() % MANY), free_ones = which < 0 ? 1 : dofs[which];
    hbvib_status status;
    int64_t i;
    for (i = 0; i < n; i++) {
        a[i] = (int64_t)(next() % (uint64_t)free_ones);
        b[i] = one_in(2) ? HBVIB_GROUND : (int64_t)(next() % (uint64_t)free_ones);
        if (b[i] == a[i]) b[i] = HBVIB_GROUND;
        kt[i] = (0.1 + uniform()) / (double)n;
        mu[i] = 0.3;
        preload[i] = uniform() / (double)n;
    }
    CALL_WITHIN(1000 * (double)n + 8 * (double)sizes_of(model).saved, hbvib_model_add_jenkins, model, n, a, b, NULL, kt, mu, preload, NULL);
}

#define CHANGE(function, ...) CALL_WITHIN(need, function, __VA_ARGS__)

static void change_model(void)
{
    int which, i;
    hbvib_model *model = some_model(&which);
    hbvib_status status;
    int64_t a[2], id = 0;
    double x[16];
    wide_contact wide = {law((int32_t)(next() % 8), degree(which), HBVIB_GROUND, HBVIB_GROUND)};
    hbvib_contact *const c = &wide.c;
    hbvib_user_force force;
    hbvib_matrix m;
    const sizes before = sizes_of(model);
    const double need = need_of_a_change(&before);
    for (i = 0; i < 16; i++) x[i] = number(i % 4 == 0 ? 1 : 0.1) * (i % 3 == 0);
    a[0] = degree(which);
    a[1] = degree(which);
    switch (one_in(200) ? 14 : next() % 14) {
    case 0:
        usual_constants(c);
        if (one_in(3)) c->dof_b[0] = a[1];
        if (one_in(20)) c->struct_size = (uint32_t)next() % 400;
        CHANGE(hbvib_model_add_contact, model, c, &id);
        break;
    case 1: CHANGE(hbvib_model_add_force, model, a[0], count(1), number(0.3), one_in(4) ? number(0.1) : 0); break;
    case 2: CHANGE(hbvib_model_set_preload, model, count(0), number(0.5)); break;
    case 3: CHANGE(hbvib_model_set_rayleigh, model, number(0.02), number(0.01)); break;
    case 4: CHANGE(hbvib_model_add_springs, model, one_in(20) ? -1 : 1, &a[0], &a[1], NULL, x); break;
    case 5: CHANGE(hbvib_model_set_loss_factor, model, number(0.02)); break;
    case 6:
        for (i = 0; i < 4; i++) x[i] = number(0.1 * (i + 1)) + 0.2 * i - 0.3;
        CHANGE(hbvib_model_add_table, model, a[0], HBVIB_GROUND, 0, 4, x, x + 4, &id);
        break;
    case 7: CHANGE(hbvib_model_add_spring_damper, model, a[0], HBVIB_GROUND, 0, 3, x, 2, x + 3, &id); break;
    case 8: CHANGE(hbvib_model_set_speed, model, one_in(2) ? 0 : number(0.4)); break;
    case 9:
        if (one_in(4)) CHANGE(hbvib_model_fix, model, 1, a);
        else if (one_in(2)) CHANGE(hbvib_cyclic_set_wave, model, count((int64_t)(next() % 7) - 3));
        else CHANGE(hbvib_cyclic_set_aero, model, one_in(20) ? -1 : 1, a, one_in(9) ? 0 : 1, x, a + 1, (int32_t)(next() % 3));
        break;
    case 10:
        m = dense(which < 0 ? 3 : dofs[which], x);
        if (dofs[which < 0 ? 0 : which] > 4) break;
        m.part = (int32_t)(next() % 8);
        CHANGE(hbvib_model_set_matrix, model, one_in(3) ? (int32_t)(next() % 7) : HBVIB_DAMPING, &m);
        break;
    case 11:
        memset(&force, 0, sizeof force);
        hbvib_user_force_init(&force, sizeof force);
        force.dofs = a;
        force.n = 1;
        force.force = on_force;
        CHANGE(hbvib_model_add_user_force, model, &force, &id);
        break;
    case 12: CHANGE(hbvib_model_set_preload_at_speed, model, count(0), number(0.3), number(0.01)); break;
    case 14: many_contacts(model, which); break;
    default: CHANGE(hbvib_model_add_iwan, model, a[0], HBVIB_GROUND, 0, number(0.2), number(1), number(-0.3), number(0.1), count(5), &id);
    }
}

static void keep(hbvib_branch *branch, const struct solved *from)
{
    hbvib_status status;
    if (branch == NULL) return;
    if (n_branches == MOST) {
        freed_branch = branches[--n_branches];
        CALL(hbvib_branch_free, freed_branch);
    }
    of_branch[n_branches] = *from;
    branches[n_branches++] = branch;
}

static double somewhere(int which)
{
    return number(which >= 0 && dofs[which] == 4 ? 1300 : 1.2);
}

static void ask_of(hbvib_branch *branch, int what);

static void solve(void)
{
    static const int asked_at_once[4] = {8, 9, 10, 13};
    static double at[1];
    int which;
    hbvib_model *model = some_model(&which);
    wide_options wide = {solver()};
    hbvib_solver_options *const s = &wide.s;
    hbvib_hooks h = hooks();
    hbvib_branch *branch = NULL;
    hbvib_status status;
    struct solved from = {sizes_of(model), 0, 0, model};
    snprintf(solving, sizeof solving,
             "; n = %lld, wheel = %lld, m = %g, d = %g, tolerance = %g, harmonics = %lld and %lld, samples = %lld, points = %lld, step_max = %g, "
             "limit = %lld, flexibility = %d, stability = %d, bytes saved = %lld",
             (long long)from.model.dofs, (long long)from.model.wheel, from.model.motions, from.model.most, s->tolerance, (long long)s->harmonics,
             (long long)s->max_harmonics, (long long)s->samples, (long long)s->max_points, s->step_max, (long long)s->memory_limit,
             (int)s->flexibility, (int)s->stability, (long long)from.model.saved);
    const int estimates = s->tolerance > 0 || s->estimate_error;
    solved_model = model;
    from.harmonics = highest(s);
    from.samples = samples_of_results(&from.model, s);
    if (one_in(2)) {
        hbvib_forced_options o;
        memset(&o, 0, sizeof o);
        hbvib_forced_options_init(&o, sizeof o);
        o.omega_start = somewhere(which);
        o.omega_stop = one_in(3) ? o.omega_start : o.omega_start * number(1.02);
        snprintf(solving + strlen(solving), sizeof solving - strlen(solving), ", omega = %.17g .. %.17g", o.omega_start, o.omega_stop);
        if (one_in(4)) {
            o.guess_len = guess(which);
            o.guess = o.guess_len != 0 || one_in(20) ? guessed : NULL;
        }
        if (one_in(8)) {
            at[0] = o.omega_start * number(1);
            o.at = at;
            o.at_len = 1;
        }
        if (one_in(20)) {
            hbvib_solver_options_init(s, sizeof *s);
            from.harmonics = highest(s);
            from.samples = samples_of_results(&from.model, s);
            CALL_WITHIN(need_of_a_branch(&from.model, s, MOST_POINTS), hbvib_forced_response, model, NULL, &o, &h, &branch);
        } else {
            CALL_NAMED(estimates ? "hbvib_forced_response" : "hbvib_forced_response, no estimate",
                       need_of_a_branch(&from.model, s, MOST_POINTS), hbvib_forced_response, model, s, &o, &h, &branch);
        }
    } else if (one_in(2)) {
        hbvib_mode_options o;
        memset(&o, 0, sizeof o);
        hbvib_mode_options_init(&o, sizeof o);
        o.log10_start = which >= 0 && dofs[which] == 4 ? -5.6 : number(-1);
        o.log10_stop = o.log10_start + fabs(number(0.5));
        o.mode_index = count(0);
        if (one_in(3)) o.diameter = count((int64_t)(next() % 9) - 4);
        if (one_in(4)) o.damping_form = (int32_t)(next() % 3);
        if (one_in(6)) o.amplitude_contact = count(0);
        if (one_in(6)) o.reference_dof = degree(which);
        if (one_in(4)) {
            o.guess_len = guess(which);
            o.guess = o.guess_len != 0 ? guessed : NULL;
            if (o.guess_len != 0) o.guess_omega = somewhere(which);
            if (o.guess_len != 0) o.guess_damping = number(0.02);
        }
        if (one_in(8)) {
            at[0] = number(o.log10_start);
            o.at = at;
            o.at_len = 1;
        }
        CALL_NAMED(estimates ? "hbvib_nonlinear_mode" : "hbvib_nonlinear_mode, no estimate",
                   need_of_a_branch(&from.model, s, MOST_POINTS), hbvib_nonlinear_mode, model, s, &o, &h, &branch);
    } else {
        static double x[4096];
        hbvib_time_options o;
        hbvib_time_info info;
        memset(&o, 0, sizeof o);
        memset(&info, 0, sizeof info);
        hbvib_time_options_init(&o, sizeof o);
        hbvib_time_info_init(&info, sizeof info);
        o.omega = somewhere(which);
        o.max_periods = count(40);
        o.harmonics = 5;
        o.method = one_in(4);
        if (one_in(10)) o.tolerance = number(1e-9);
        if (one_in(4)) {
            o.start_len = guess(which);
            o.start = o.start_len != 0 ? guessed : NULL;
        }
        if (one_in(20) && which >= 0 && dofs[which] < 5) {
            /* A long record, or many harmonics. */
            const int64_t n = dofs[which];
            double *series = NULL, *record = NULL;
            if (one_in(2)) o.harmonics = times(5);
            else o.samples = times(1 << 16);
            if (o.harmonics >= 0 && o.harmonics <= 1 << 24) series = malloc((size_t)((o.harmonics + 1) * n) * 2 * sizeof *series);
            if (o.samples >= 0 && o.samples <= 1 << 24) record = malloc((size_t)(o.samples * n) * sizeof *record + 8);
            CALL_NAMED("hbvib_time_response, long", need_in_time(&from.model, within(o.harmonics, 1e5)) + 8 * within(o.samples, 1 << 24) * (double)n,
                       hbvib_time_response, model, &o, &h, series, series == NULL ? 0 : (o.harmonics + 1) * n, o.samples == 0 ? NULL : record,
                       record == NULL ? 0 : o.samples * n, &info);
            free(series);
            free(record);
        } else {
            CALL_WITHIN(need_in_time(&from.model, 5), hbvib_time_response, model, &o, &h, which < 0 ? NULL : x,
                        which < 0 ? 0 : 6 * dofs[which], NULL, 0, &info);
        }
    }
    solves++;
    if (status >= 0) solved++;
    solving[0] = '\0';
    solved_model = NULL;
    keep(branch, &from);
    /* Later most models have changed. */
    if (branch != NULL && one_in(2)) ask_of(branch, asked_at_once[next() % 4]);
}

/* Damped modes, Campbell and interference diagrams of signed diameters. */
static void ask_for_waves(void)
{
    static double value[2 * 64 * 128], second[64 * 128];
    static int64_t diameter[64], direction[64 * 128];
    static const double speeds[3] = {0.1, 0.3, 0.7};
    int which;
    hbvib_model *model = some_model(&which);
    hbvib_hooks h = hooks();
    hbvib_status status;
    const sizes m = sizes_of(model);
    const int64_t sectors = m.dofs > 0 ? m.wheel / m.dofs : 1, n = count(1 + (int64_t)(next() % 3));
    const int64_t d = count((int64_t)(next() % 9) - 4), order = count(1 + (int64_t)(next() % 9));
    const int32_t contacts = (int32_t)(next() % 4);
    /* Of all waves and speeds at a time. */
    const double need = need_at_rest(&m) + 4 * need_of_linear_modes(&m) + 2000 * (double)(m.wheel + 64) + 100 * (double)(m.saved);
    int64_t found = 0;
    if (n > 3) return;
    switch (next() % 4) {
    case 0: CALL_WITHIN(need, hbvib_damped_modes, model, d, contacts, n, value, one_in(2) ? NULL : second, direction, &h); break;
    case 1: CALL_WITHIN(need, hbvib_campbell, model, 3, speeds, d, contacts, n, value, second, direction, &h); break;
    case 2:
        CALL_WITHIN(need, hbvib_campbell_crossings, model, 3, speeds, d, contacts, n, order, 64, value, second, direction, &found, &h);
        break;
    default:
        CALL_WITHIN(need, hbvib_interference, model, contacts, n, one_in(20) ? count(64) & 63 : 64, diameter, value, second, direction,
                    one_in(2) ? NULL : &found, &h);
        for (found = 0; status == HBVIB_OK && found < sectors && found < 64; found++)
            failures += 2 * diameter[found] <= -sectors || 2 * diameter[found] > sectors;
    }
}

/* Loops and histories of up to 2^24 times. */
static void ask_for_many_times(const hbvib_branch *branch, int64_t point, double need, const struct solved *of, const hbvib_hooks *h)
{
    const int64_t n = times(1 << 12);
    const double record = 8 * within(n, 1 << 24), march = of->model.sampled ? smaller(500 * MIB, record * (4 * of->harmonics + 40)) : 0;
    hbvib_status status;
    double *y, *f;
    int32_t *states;
    if (n < 0 || n > 1 << 24) return;
    y = malloc((size_t)n * sizeof *y + 8);
    f = malloc((size_t)n * sizeof *f + 8);
    states = malloc((size_t)n * sizeof *states + 8);
    if (one_in(2)) CALL_NAMED("hbvib_branch_time_history_with_hooks, long", need + 1.1 * record, hbvib_branch_time_history_with_hooks, branch, point, 0, n, y, h);
    else CALL_NAMED("hbvib_branch_contact_loop_with_hooks, long", need + 2.2 * record + march + 16 * MIB, hbvib_branch_contact_loop_with_hooks, branch, point, count(0), count(0), n, y, f, states, h);
    free(y);
    free(f);
    free(states);
}

/* Derivatives at a point of a branch, whose model has changed since, mostly. */
static void ask_for_sensitivity(const hbvib_model *model, const hbvib_branch *branch, int64_t point, double need)
{
    hbvib_hooks h = hooks();
    hbvib_parameter p;
    hbvib_status status;
    double derivative;
    int64_t reason, onset;
    memset(&p, 0, sizeof p);
    hbvib_parameter_init(&p, sizeof p);
    p.kind = (int32_t)(next() % 11) - 1;
    p.contact = one_in(3) ? count(0) : -1;
    p.scaling = one_in(3);
    CALL_WITHIN(need, hbvib_sensitivity, model, branch, point, (int32_t)(next() % (one_in(9) ? 6 : 3)), &p, 1, &derivative, 1, &reason, &onset, &h);
}

/* Lives, sweeps, and passages through the resonance of a mode; branches are mostly no modes, which is refused. */
static void ask_for_lives_and_passages(const hbvib_branch *branch, const hbvib_model *model, double need)
{
    enum { ROOM = 4096 };
    static double a[ROOM], b[ROOM], c[ROOM], d[ROOM], e[ROOM], f[ROOM];
    static int64_t kind[64], whose[64];
    const double begin = number(1), end = number(1), rate = number(0.02), factors[2] = {number(1), number(0.5)};
    const double cycles[2] = {number(1), number(3)}, volume[1] = {number(0.01)}, at[1] = {number(1)}, spring[1] = {number(1)};
    const double time[3] = {0, number(100), number(300)}, speed[3] = {number(1), number(1), number(1)}, stress[1] = {number(50)};
    const int64_t contact[1] = {count(0)};
    int64_t n = 0;
    hbvib_hooks h = hooks();
    hbvib_solver_options s = solver();
    hbvib_status status;
    hbvib_life_options life;
    hbvib_life_info worn;
    hbvib_best_load best;
    hbvib_sweep_options sweep;
    hbvib_sweep_info swept;
    hbvib_run_up_options up;
    hbvib_run_up_info passed;
    hbvib_mission_options flight;
    hbvib_campbell_options diagram;
    hbvib_life_options_init(&life, sizeof life);
    hbvib_life_info_init(&worn, sizeof worn);
    hbvib_best_load_init(&best, sizeof best);
    hbvib_sweep_options_init(&sweep, sizeof sweep);
    hbvib_sweep_info_init(&swept, sizeof swept);
    hbvib_run_up_options_init(&up, sizeof up);
    hbvib_run_up_info_init(&passed, sizeof passed);
    hbvib_mission_options_init(&flight, sizeof flight);
    hbvib_campbell_options_init(&diagram, sizeof diagram);
    life.contacts = contact;
    life.contacts_len = 1;
    life.rates = volume;
    life.stiffness = one_in(3) ? NULL : spring;
    life.duty_omega = at;
    life.duties_len = 1;
    life.most_steps = 20;
    if (one_in(3)) {
        life.follow = HBVIB_LIFE_PEAK;
        life.omega_start = begin;
        life.omega_stop = end;
    }
    sweep.omega_start = up.omega_start = begin;
    sweep.omega_stop = up.omega_stop = end;
    sweep.rate = up.rate = rate;
    up.integrated_turns = one_in(3) ? count(0) : up.integrated_turns;
    up.damping_ratio = one_in(5) ? number(0.01) : 0;
    flight.times = time;
    flight.speeds = speed;
    flight.points_len = 3;
    flight.edges = one_in(2) ? factors : NULL;
    flight.edges_len = flight.edges != NULL;
    flight.stresses = stress;
    flight.stresses_len = one_in(2);
    flight.woehler_stress = number(100);
    flight.woehler_cycles = number(1e6);
    flight.woehler_slope = number(5);
    diagram.engine_order = number(2);
    diagram.acceleration = one_in(2) ? number(1e-3) : 0;
    switch (next() % 6) {
    case 0:
        CALL_WITHIN(need, hbvib_life, model, one_in(3) ? &s : NULL, &life, &h, one_in(20) ? count(2) & 1 : 2, cycles, a, b, c, d, e, 64, f, kind, whose,
                    &n, &worn);
        break;
    case 1: CALL_WITHIN(need, hbvib_best_load_for_life, model, one_in(3) ? &s : NULL, &life, cycles[1], factors[1], factors[0], &h, &best); break;
    case 2: CALL_WITHIN(need, hbvib_time_sweep, model, &sweep, &h, ROOM, a, b, c, &n, &swept); break;
    case 3:
        CALL_WITHIN(need, hbvib_branch_run_up, branch, model, &up, &h, ROOM, a, b, c, d, &n, &passed);
        failures += status == HBVIB_OK && !isfinite(passed.largest);
        break;
    case 4: CALL_WITHIN(need, hbvib_branch_mission, branch, model, &flight, &h, a, b, c, ROOM / 6, d, &n, e); break;
    default: CALL_WITHIN(need, hbvib_campbell_response, branch, model, &diagram, &h, 2, factors, a, b, c, d, e, f);
    }
}

static void ask_of(hbvib_branch *branch, int what)
{
    static double x[2 * 64 * 128], y[256], f[256];
    static int32_t states[256];
    static int64_t point[64];
    hbvib_hooks h = hooks();
    hbvib_status status;
    const int64_t stored = hbvib_branch_stored(branch), at = stored > 0 ? count((int64_t)(next() % (uint64_t)stored)) : count(0);
    int64_t n = 0;
    int which, i;
    hbvib_model *model;
    hbvib_view view;
    hbvib_energy energy;
    hbvib_contact_summary summary;
    hbvib_verification v;
    hbvib_floquet_info info;
    hbvib_reduction r;
    const struct solved of = sizes_of_branch(branch);
    const sizes m = sizes_of(model = model_of(&of, &which));
    const double result = need_of_a_result(&of.model, of.harmonics, of.samples);
    memset(&r, 0, sizeof r);
    hbvib_reduction_init(&r, sizeof r);
    switch (what) {
    case 0:
        memset(&view, 0, sizeof view);
        hbvib_view_init(&view, sizeof view);
        if (one_in(2)) CALL(hbvib_branch_field, branch, (int32_t)(next() % 22) - 1, &view);
        else CALL(hbvib_branch_stored_field, branch, (int32_t)(next() % 22) - 1, &view);
        if (status == HBVIB_OK && view.data != NULL && view.shape[0] > 0) y[0] = view.data[(view.shape[0] - 1) * view.stride[0]];
        break;
    case 1:
        CALL(hbvib_branch_reduction, branch, &r);
        if (status != HBVIB_OK || r.harmonics_asked > 60) break;
        CALL_WITHIN(result, hbvib_branch_harmonics, branch, at, 0, 1, x, one_in(20) ? count(7) : r.harmonics_asked + 1);
        for (i = 0; status == HBVIB_OK && i < 2 * (r.harmonics_asked + 1); i++) failures += !isfinite(x[i]);
        break;
    case 2:
        memset(&energy, 0, sizeof energy);
        hbvib_energy_init(&energy, sizeof energy);
        CALL_WITHIN(result, hbvib_branch_energy_with_hooks, branch, at, &energy, &h);
        break;
    case 3: CALL_WITHIN(result, hbvib_branch_contact_loop, branch, at, count(0), count(0), 256, y, f, states); break;
    case 4:
        memset(&summary, 0, sizeof summary);
        hbvib_contact_summary_init(&summary, sizeof summary);
        CALL_WITHIN(result, hbvib_branch_contact_summary, branch, at, count(0), &summary);
        break;
    case 5: CALL(hbvib_branch_peaks, branch, 64, y, f, point, &n); break;
    case 6: CALL(hbvib_branch_folds, branch, 64, y, f, point, &n); break;
    case 7: CALL_WITHIN(result, hbvib_branch_time_history_with_hooks, branch, at, 0, 256, y, &h); break;
    case 8:
        memset(&v, 0, sizeof v);
        hbvib_verification_init(&v, sizeof v);
        CALL_WITHIN(result + need_in_time(&m, of.harmonics), hbvib_verify, model, branch, at, NULL, &h, NULL, 0, NULL, 0, &v);
        break;
    case 9:
        memset(&info, 0, sizeof info);
        hbvib_floquet_info_init(&info, sizeof info);
        CALL_WITHIN(result + need_of_multipliers(&m, of.harmonics), hbvib_floquet, model, branch, at, NULL, &h, x, 64, NULL, 0, &info);
        break;
    case 10: CALL_WITHIN(result, hbvib_branch_synthesis_with_hooks, branch, model, NULL, 64, y, x, f, &n, &h); break;
    case 11: ask_for_waves(); break;
    case 12: ask_for_many_times(branch, at, result, &of, &h); break;
    case 13: ask_for_sensitivity(model, branch, at, result + need_of_a_branch_point(&of.model, of.harmonics, of.samples) + 8 * (double)m.saved); break;
    case 15: ask_for_lives_and_passages(branch, model, 500 * MIB + 8 * (result + need_in_time(&m, of.harmonics))); break;
    case 14: CALL_WITHIN(result, hbvib_branch_slip_fraction, branch, at, y, one_in(20) ? count(1) : hbvib_model_contacts(model) & 255); break;
    default:
        solved_model = model;
        CALL_WITHIN(need_of_linear_modes(&m) + need_at_rest(&m), hbvib_linear_modes_with_hooks, model,
                         m.wheel == m.dofs && !one_in(9) ? 0 : count((int64_t)(next() % 9) - 4), (int32_t)(next() % (one_in(5) ? 4 : 3)), count(1),
                         y, NULL, &h);
        solved_model = NULL;
    }
}

static void ask(void) { ask_of(some_branch(), (int)(next() % 17)); }

/* A law at a motion of up to 10,000 harmonics, with and without its Jacobian, exactly or by samples. */
static void many_harmonics(const hbvib_contact *c, int64_t d)
{
    const int with = one_in(2);
    const int64_t h = (int64_t)(pow(10, with ? 3 * uniform() : 4 * uniform())), n = d * (h + 1), samples = one_in(2) ? times(4 * h + 16) : 0;
    const double held = within(samples, 1 << 24), alone = need_of_a_force(c, (double)h, held);
    const double need = with ? need_of_a_law((double)d, (double)h, held) : alone;
    /* Beside what jac asks for, no more than 500 MiB. */
    const double most = 500 * MIB + (with ? need_of_a_law((double)d, (double)h, 0) : 0);
    double *motion = malloc((size_t)n * 2 * sizeof *motion), *force = malloc((size_t)n * 2 * sizeof *force), *jac = NULL;
    hbvib_hooks hook = hooks();
    hbvib_status status;
    int64_t i;
    snprintf(solving, sizeof solving, "; kind %d, kt = %g, kn = %g, mu = %g, preload = %g, H = %lld, samples = %lld", (int)c->kind, c->kt, c->kn,
             c->mu, c->preload, (long long)h, (long long)samples);
    if (with) jac = malloc((size_t)(4 * n * n) * sizeof *jac);
    for (i = 0; i < 2 * n; i++) motion[i] = number(uniform() - 0.5) / (1 + (double)(i / 2 % (h + 1)));
    CALL_NAMED(with ? "hbvib_contact_evaluate_with_hooks, jac" : "hbvib_contact_evaluate_with_hooks", smaller(need, most),
               hbvib_contact_evaluate_with_hooks, c, h, samples, number(1), motion, n, force, n, jac, with ? 4 * n * n : 0, &hook);
    solving[0] = '\0';
    free(motion);
    free(force);
    free(jac);
}

static void low(void)
{
    static double x[64], y[64], jac[1 << 12];
    static unsigned char bytes[1 << 14];
    hbvib_contact c = law((int32_t)(next() % 8), 0, HBVIB_GROUND, HBVIB_GROUND);
    hbvib_model *model = NULL;
    int which, i;
    int64_t size = 0;
    hbvib_status status;
    for (i = 0; i < 64; i++) x[i] = number(1);
    usual_constants(&c);
    if (one_in(2)) {
        const int64_t d = c.kind == HBVIB_FRICTION_3D && c.kn != 0 ? 3
                          : c.kind == HBVIB_FRICTION_3D || (c.kind == HBVIB_FRICTION_2D && c.kn != 0) ? 2 : 1;
        const int64_t n = one_in(20) ? 6 : 6 * d, samples = one_in(3) ? count(32) : 0;
        const double held = (double)(samples > 1 << 20 ? 1 << 20 : samples);
        if (one_in(15)) many_harmonics(&c, d);
        else CALL_WITHIN(smaller(need_of_a_law((double)d, 5, held), 500 * MIB + need_of_a_law((double)d, 5, 0)), hbvib_contact_evaluate, &c, 5, samples, number(1), x, n, y, n, jac, 4 * n * n);
        return;
    }
    CALL(hbvib_model_save, some_model(&which), sizeof bytes, bytes, &size);
    if (status != HBVIB_OK) return;
    if (one_in(2)) bytes[next() % (uint64_t)size] ^= (unsigned char)(1 << next() % 8);
    CALL_WITHIN(8 * (double)size, hbvib_model_load, one_in(4) ? (int64_t)(next() % (uint64_t)size) : size, bytes, &model);
    if (model != NULL) CALL(hbvib_model_free, model);
}

static void end_one(void)
{
    hbvib_status status;
    if (one_in(20)) CALL(hbvib_model_free, freed_model);
    if (one_in(20)) CALL(hbvib_branch_free, freed_branch);
    if (n_models > 0 && one_in(2)) {
        const int i = (int)(next() % (uint64_t)n_models);
        freed_model = models[i];
        CALL(hbvib_model_free, freed_model);
        models[i] = models[--n_models];
        dofs[i] = dofs[n_models];
    } else if (n_branches > 0) {
        const int i = (int)(next() % (uint64_t)n_branches);
        freed_branch = branches[i];
        CALL(hbvib_branch_free, freed_branch);
        branches[i] = branches[--n_branches];
        of_branch[i] = of_branch[n_branches];
    }
}

int main(int argc, char **argv)
{
    const clock_t begin = clock();
    double seconds;
    int64_t most;
    hbvib_status status;
    hbvib_hooks h;
    int i;
    if (argc < 3) return 2;
    state = strtoull(argv[1], NULL, 10);
    seconds = atof(argv[2]);
    most = argc > 3 ? atoll(argv[3]) : INT64_MAX;
    /* What a thread keeps is taken by its first call that may need it. */
    h = hooks();
    (void)!hbvib_branch_energy_with_hooks(NULL, 0, NULL, &h);
    if (argc > 4) most_working = atof(argv[4]);
    while (calls < most && (double)(clock() - begin) / CLOCKS_PER_SEC < seconds) {
        switch (next() % 12) {
        case 0: add_model(); break;
        case 1:
        case 2: change_model(); break;
        case 3:
        case 4: solve(); break;
        case 5: end_one(); break;
        case 6: low(); break;
        default: ask();
        }
    }
    while (n_models > 0) CALL(hbvib_model_free, models[--n_models]);
    while (n_branches > 0) CALL(hbvib_branch_free, branches[--n_branches]);
    for (i = 0; i < N_FUNCTIONS && outcomes[i].name != NULL; i++)
        printf("%-40s %lld calls: %lld done, %lld stopped early, %lld refused, %lld kB at most, %.2f of the need\n", outcomes[i].name,
               (long long)outcomes[i].calls, (long long)outcomes[i].succeeded, (long long)outcomes[i].stopped,
               (long long)outcomes[i].refused, (long long)(outcomes[i].bytes / 1024), outcomes[i].share);
    printf("%lld calls, %lld of %lld solves with a result, %.2f s the longest (%s), %lld failures\n", (long long)calls,
           (long long)solved, (long long)solves, (double)longest / CLOCKS_PER_SEC, slowest, (long long)failures);
    return failures == 0 && 3 * solved >= solves && (double)longest < HANGS * CLOCKS_PER_SEC ? 0 : 1;
}
