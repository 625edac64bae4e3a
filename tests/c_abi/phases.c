/* Phases of a call, and variants with hooks of the functions that have no points to keep. */
#include "common.h"

enum { H = 5, COUNT = (H + 1) * NDOF, TIMES = 16, CAPACITY = 4096, SIGNAL = 41 };

typedef struct seen {
    int64_t reports, points;
    int wrong, phases; /* bits of the phases */
    int32_t stop_in;   /* phase, or -1 */
} seen;

static int32_t on_phase(void *user, const hbvib_phase_report *r)
{
    seen *s = user;
    s->reports++;
    s->wrong += r->struct_size != sizeof *r || !(r->share >= 0 && r->share <= 1);
    s->wrong += r->phase < HBVIB_PHASE_SETUP || r->phase > HBVIB_PHASE_FACTORISATION;
    s->phases |= 1 << r->phase;
    return r->phase == s->stop_in;
}

static int32_t on_progress(void *user, const hbvib_progress *p)
{
    seen *s = user;
    s->points++;
    s->wrong += p->point != s->points;
    return 0;
}

static hbvib_hooks hooks_for(seen *s)
{
    hbvib_hooks h;
    if (hbvib_hooks_init(&h, sizeof h) != HBVIB_OK) abort();
    s->stop_in = -1;
    h.user = s;
    h.phase = on_phase;
    return h;
}

/* Phases change no number and no count of points; one of them stops the solve. */
static void of_a_solve(void)
{
    hbvib_forced_options o = frequencies(207, 211);
    hbvib_branch *branch = NULL;
    seen s = {0};
    hbvib_hooks h = hooks_for(&s), first_version;
    int32_t phase;

    h.progress = on_progress;
    WORKS("phases", hbvib_forced_response(the_model, NULL, &o, &h, &branch));
    EXPECT("phases", s.wrong == 0 && s.points == hbvib_branch_points(branch) && s.reports > 3);
    for (phase = HBVIB_PHASE_CONDENSATION; phase <= HBVIB_PHASE_ESTIMATE; phase++) EXPECT("phases", s.phases >> phase & 1);
    EXPECT("phases", s.phases & 1 << HBVIB_PHASE_SETUP);
    WORKS("phases", hbvib_branch_free(branch));
    for (phase = HBVIB_PHASE_CONDENSATION; phase <= HBVIB_PHASE_ESTIMATE; phase++) {
        branch = NULL;
        h = hooks_for(&s);
        s.stop_in = phase;
        EXPECT("stop", hbvib_forced_response(the_model, NULL, &o, &h, &branch) == HBVIB_STOPPED_BY_CALLER);
        EXPECT("stop", branch != NULL && hbvib_branch_status(branch) == HBVIB_STOPPED_BY_CALLER);
        WORKS("stop", hbvib_branch_free(branch));
    }
    /* A caller of the first version has no such field. */
    first_version = hooks_for(&s);
    memset(&s, 0, sizeof s);
    first_version.struct_size = 40;
    branch = NULL;
    WORKS("first version", hbvib_forced_response(the_model, NULL, &o, &first_version, &branch));
    EXPECT("first version", s.reports == 0);
    WORKS("first version", hbvib_branch_free(branch));
}

/* With the flag set: the status, its sentence, and nothing written. */
#define STOPS(row, call)                                                                  \
    do {                                                                                  \
        EXPECT(row, (call) == HBVIB_STOPPED_BY_CALLER);                                   \
        EXPECT(row, strstr(hbvib_last_error(), "before there was a result") != NULL);     \
        EXPECT(row, hbvib_last_error_argument() == 0);                                    \
    } while (0)

static void of_a_model(const hbvib_hooks *none, const hbvib_hooks *stop)
{
    double omega[2] = {-1, -1}, plain[2], x[2 * COUNT] = {0}, r[2 * COUNT], again[2 * COUNT];
    double y[2 * SIGNAL] = {0}, f[2 * SIGNAL], g[2 * SIGNAL];
    hbvib_contact c = ring_contact();
    hbvib_solver_options s = solver_options();

    WORKS("modes", hbvib_linear_modes(the_model, 2, HBVIB_CONTACTS_STUCK, 2, plain, NULL));
    STOPS("modes", hbvib_linear_modes_with_hooks(the_model, 2, HBVIB_CONTACTS_STUCK, 2, omega, NULL, stop));
    EXPECT("modes", omega[0] == -1);
    WORKS("modes", hbvib_linear_modes_with_hooks(the_model, 2, HBVIB_CONTACTS_STUCK, 2, omega, NULL, none));
    EXPECT("modes", memcmp(omega, plain, sizeof omega) == 0);

    y[2] = 1e-4;
    memset(g, 0, sizeof g);
    WORKS("law", hbvib_contact_evaluate(&c, SIGNAL - 1, 0, 1, y, SIGNAL, f, SIGNAL, NULL, 0));
    STOPS("law", hbvib_contact_evaluate_with_hooks(&c, SIGNAL - 1, 0, 1, y, SIGNAL, g, SIGNAL, NULL, 0, stop));
    EXPECT("law", g[2] == 0);
    WORKS("law", hbvib_contact_evaluate_with_hooks(&c, SIGNAL - 1, 0, 1, y, SIGNAL, g, SIGNAL, NULL, 0, none));
    EXPECT("law", memcmp(f, g, sizeof f) == 0 && f[2] != 0);

    s.harmonics = H;
    s.tolerance = 0;
    x[2 * NDOF] = 1e-4;
    WORKS("residual", hbvib_forced_residual(the_model, &s, 1300, x, COUNT, r, COUNT, NULL, 0, NULL, 0));
    STOPS("residual", hbvib_forced_residual_with_hooks(the_model, &s, 1300, x, COUNT, again, COUNT, NULL, 0, NULL, 0, stop));
    WORKS("residual", hbvib_forced_residual_with_hooks(the_model, &s, 1300, x, COUNT, again, COUNT, NULL, 0, NULL, 0, none));
    EXPECT("residual", memcmp(r, again, sizeof r) == 0);
}

static void of_a_point(const hbvib_hooks *none, const hbvib_hooks *stop)
{
    double x[2 * COUNT], again[2 * COUNT], history[TIMES] = {0}, force[TIMES] = {0};
    hbvib_solver_options s = solver_options();
    hbvib_forced_options o = frequencies(208, 208);
    hbvib_branch *branch = NULL;
    hbvib_energy energy;
    hbvib_contact_summary summary;

    s.harmonics = H;
    s.tolerance = 0;
    WORKS("point", hbvib_forced_response(the_model, &s, &o, NULL, &branch));
    WORKS("point", hbvib_branch_harmonics(branch, 0, 0, NDOF, x, COUNT));
    STOPS("harmonics", hbvib_branch_harmonics_with_hooks(branch, 0, 0, NDOF, again, COUNT, stop));
    WORKS("harmonics", hbvib_branch_harmonics_with_hooks(branch, 0, 0, NDOF, again, COUNT, none));
    EXPECT("harmonics", memcmp(x, again, sizeof x) == 0);
    STOPS("history", hbvib_branch_time_history_with_hooks(branch, 0, 0, TIMES, history, stop));
    EXPECT("history", history[0] == 0);
    WORKS("history", hbvib_branch_time_history_with_hooks(branch, 0, 0, TIMES, history, none));
    EXPECT("history", history[0] != 0);
    WORKS("energy", hbvib_energy_init(&energy, sizeof energy));
    STOPS("energy", hbvib_branch_energy_with_hooks(branch, 0, &energy, stop));
    EXPECT("energy", energy.kinetic_mean == 0);
    WORKS("energy", hbvib_branch_energy_with_hooks(branch, 0, &energy, none));
    EXPECT("energy", energy.kinetic_mean > 0);
    /* The motion of a contact is stored: its loop and its work are short, and may be over before a check. */
    WORKS("loop", hbvib_branch_contact_loop_with_hooks(branch, 0, 0, 0, TIMES, NULL, force, NULL, none));
    EXPECT("loop", force[0] != 0);
    WORKS("summary", hbvib_contact_summary_init(&summary, sizeof summary));
    WORKS("summary", hbvib_branch_contact_summary_with_hooks(branch, 0, 0, &summary, none));
    EXPECT("summary", summary.work > 0);
    WORKS("point", hbvib_branch_free(branch));
}

static void of_a_mode(const hbvib_hooks *none, const hbvib_hooks *stop)
{
    static double omega[CAPACITY];
    hbvib_solver_options s = solver_options();
    hbvib_mode_options o = amplitudes(0, 5);
    hbvib_branch *branch = NULL;
    int64_t count = -1, peaks = -1;

    s.harmonics = H;
    s.tolerance = 0;
    WORKS("mode", hbvib_nonlinear_mode(the_model, &s, &o, NULL, &branch));
    STOPS("synthesis", hbvib_branch_synthesis_with_hooks(branch, the_model, NULL, CAPACITY, omega, NULL, NULL, &count, stop));
    EXPECT("synthesis", count == -1);
    WORKS("synthesis", hbvib_branch_synthesis_with_hooks(branch, the_model, NULL, CAPACITY, omega, NULL, NULL, &count, none));
    STOPS("peaks", hbvib_branch_synthesis_peaks_with_hooks(branch, the_model, NULL, 0, NULL, NULL, NULL, NULL, NULL, NULL, NULL,
                                                           &peaks, stop));
    EXPECT("peaks", peaks == -1);
    WORKS("peaks", hbvib_branch_synthesis_peaks_with_hooks(branch, the_model, NULL, 0, NULL, NULL, NULL, NULL, NULL, NULL, NULL,
                                                           &peaks, none));
    EXPECT("synthesis", count > 0 && peaks == 1);
    WORKS("mode", hbvib_branch_free(branch));
}

int main(void)
{
    hbvib_cancel_flag flag = 1;
    hbvib_hooks stop;
    seen s = {0};
    const hbvib_hooks told = hooks_for(&s);

    begin();
    WORKS("hooks", hbvib_hooks_init(&stop, sizeof stop));
    stop.cancel = &flag;
    of_a_solve();
    of_a_model(&told, &stop);
    of_a_model(NULL, &stop);
    of_a_point(NULL, &stop);
    of_a_mode(&told, &stop);
    EXPECT("phases", s.wrong == 0 && s.reports > 0);
    WORKS("free", hbvib_model_free(the_model));
    return verdict(100);
}
