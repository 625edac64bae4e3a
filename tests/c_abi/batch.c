/* Batches of designs: peaks, statuses, branches, threads, progress, and what is refused. */
#include "common.h"

enum { DESIGNS = 6, PARAMETERS = 2 };

static hbvib_parameter parameter(int32_t kind)
{
    hbvib_parameter p;
    if (hbvib_parameter_init(&p, sizeof p) != HBVIB_OK) abort();
    p.kind = kind;
    return p;
}

static int32_t count(void *user, const hbvib_progress *progress)
{
    int *calls = user;
    ++*calls;
    return progress->fraction_done > 1 || progress->point > DESIGNS;
}

static int32_t refuses(void *user, const hbvib_force_call *call)
{
    (void)user;
    (void)call;
    return -1;
}

int main(void)
{
    const double values[DESIGNS * PARAMETERS] = {1, 300, 1, 100, 2, 600, 1, -5, 0.5, 150, 1, 800};
    double amplitude[DESIGNS], omega[DESIGNS], again[DESIGNS];
    int64_t statuses[DESIGNS], points[DESIGNS], dofs[1] = {0};
    hbvib_model *model = ring_damper();
    hbvib_batch *batch = NULL, *other = NULL;
    hbvib_branch *branch = NULL;
    hbvib_solver_options s = solver_options();
    hbvib_batch_options o;
    hbvib_hooks hooks;
    hbvib_user_force force;
    /* One more, zero: that before it is said to be longer than it is. */
    hbvib_parameter p[PARAMETERS + 1];
    int calls = 0, i;

    begin();
    memset(&p[PARAMETERS], 0, sizeof p[0]);
    s.harmonics = 9;
    p[0] = parameter(HBVIB_PARAMETER_FORCE);
    p[1] = parameter(HBVIB_PARAMETER_PRELOAD);
    p[1].contact = 0;
    WORKS("options", hbvib_batch_options_init(&o, sizeof o));
    EXPECT("options", o.threads == 1 && o.keep == 0);
    o.omega_start = 2 * PI * 200;
    o.omega_stop = 2 * PI * 215;
    WORKS("hooks", hbvib_hooks_init(&hooks, sizeof hooks));
    hooks.progress = count;
    hooks.user = &calls;
    WORKS("solve", hbvib_batch_solve(model, &s, &o, &hooks, p, PARAMETERS, DESIGNS, values, &batch));
    EXPECT("progress", calls == DESIGNS);
    EXPECT("designs", hbvib_batch_designs(batch) == DESIGNS);
    WORKS("peaks", hbvib_batch_peaks(batch, DESIGNS, amplitude, omega, statuses, points));
    EXPECT("reference", fabs(amplitude[0] / 1.934880980e-3 - 1) < 1e-7 && fabs(omega[0] / (2 * PI) - 208.0970308) < 1e-6);
    EXPECT("reference", fabs(amplitude[1] / 4.886556792e-3 - 1) < 1e-7 && fabs(amplitude[5] / 1.706910530e-3 - 1) < 1e-7);
    /* Force and normal load together scale the motion. */
    EXPECT("scale", fabs(amplitude[2] / amplitude[0] - 2) < 1e-7 && fabs(amplitude[4] / amplitude[0] - 0.5) < 1e-7);
    for (i = 0; i < DESIGNS; i++)
        EXPECT("status", i == 3 ? statuses[i] == HBVIB_E_ARGUMENT && amplitude[i] != amplitude[i] && points[i] == 0
                                : statuses[i] == HBVIB_OK && points[i] > 5);
    REFUSED("failed", hbvib_batch_status(batch, 3), HBVIB_E_ARGUMENT, 0, "preload = -5");
    WORKS("status", hbvib_batch_status(batch, 0));
    REFUSED("index", hbvib_batch_status(batch, DESIGNS), HBVIB_E_INDEX, 2, "design = 6");
    REFUSED("branch", hbvib_batch_branch(batch, 0, &branch), HBVIB_E_ARGUMENT, 2, "keep = 1");
    REFUSED("room", hbvib_batch_peaks(batch, DESIGNS - 1, amplitude, NULL, NULL, NULL), HBVIB_E_DIMENSION, 2, "needs 6");
    REFUSED("overlap", hbvib_batch_peaks(batch, DESIGNS, amplitude, amplitude, NULL, NULL), HBVIB_E_ARGUMENT, 4, "overlap");

    o.threads = 3;
    WORKS("threads", hbvib_batch_solve(model, &s, &o, NULL, p, PARAMETERS, DESIGNS, values, &other));
    WORKS("threads", hbvib_batch_peaks(other, DESIGNS, again, NULL, NULL, NULL));
    EXPECT("threads", memcmp(amplitude, again, sizeof again) == 0);
    WORKS("free", hbvib_batch_free(other));
    other = NULL;
    /* Branches that are kept have more points, and the same peaks. */
    o.keep = 1;
    WORKS("keep", hbvib_batch_solve(model, &s, &o, NULL, p, PARAMETERS, DESIGNS, values, &other));
    WORKS("keep", hbvib_batch_peaks(other, DESIGNS, again, NULL, NULL, points));
    for (i = 0; i < DESIGNS; i++) EXPECT("keep", i == 3 || fabs(again[i] / amplitude[i] - 1) < 1e-9);
    WORKS("branch", hbvib_batch_branch(other, 1, &branch));
    EXPECT("branch", hbvib_branch_points(branch) == points[1]);
    REFUSED("twice", hbvib_batch_branch(other, 1, &branch), HBVIB_E_ARGUMENT, 2, "taken before");
    REFUSED("none", hbvib_batch_branch(other, 3, &branch), HBVIB_E_ARGUMENT, 2, "failed");
    WORKS("free", hbvib_batch_free(other));
    EXPECT("stays", hbvib_branch_points(branch) == points[1]);
    WORKS("free", hbvib_branch_free(branch));
    REFUSED("freed", hbvib_batch_status(other, 0), HBVIB_E_HANDLE, 1, "freed");
    REFUSED("type", hbvib_batch_free((hbvib_batch *)model), HBVIB_E_HANDLE, 1, "another type");

    {
        /* The peaks of responses: the first leads. */
        static const int64_t tip[1] = {0};
        hbvib_response watched[2];
        double speed[DESIGNS];
        for (i = 0; i < 2; i++) {
            WORKS("response", hbvib_response_init(&watched[i], sizeof watched[i]));
            watched[i].n = 1;
            watched[i].dofs = tip;
        }
        watched[1].measure = HBVIB_MEASURE_RMS;
        watched[1].component = HBVIB_VELOCITY;
        o.keep = 0;
        o.responses = watched;
        o.responses_len = 2;
        WORKS("responses", hbvib_batch_solve(model, &s, &o, NULL, p, PARAMETERS, DESIGNS, values, &batch));
        WORKS("responses", hbvib_batch_response_peaks(batch, 0, DESIGNS, again, NULL));
        WORKS("responses", hbvib_batch_response_peaks(batch, 1, DESIGNS, speed, omega));
        for (i = 0; i < DESIGNS; i++) {
            EXPECT("leads", i == 3 ? isnan(again[i]) && isnan(speed[i]) : fabs(again[i] / amplitude[i] - 1) < 1e-9);
            EXPECT("speed", i == 3 || (speed[i] > 0.7 * omega[i] * amplitude[i] && speed[i] < 0.8 * omega[i] * amplitude[i]));
        }
        WORKS("ends", hbvib_batch_response_ends(batch, 0, DESIGNS, again, omega));
        for (i = 0; i < DESIGNS; i++)
            EXPECT("ends", isnan(again[i]) ? isnan(amplitude[i])
                                           : again[i] < amplitude[i] && (omega[i] == o.omega_start || omega[i] == o.omega_stop));
        REFUSED("ends", hbvib_batch_response_ends(batch, 2, DESIGNS, again, NULL), HBVIB_E_INDEX, 2, "response = 2");
        REFUSED("room of ends", hbvib_batch_response_ends(batch, 0, 1, again, NULL), HBVIB_E_DIMENSION, 3, "needs 6");
        REFUSED("response", hbvib_batch_response_peaks(batch, 2, DESIGNS, speed, NULL), HBVIB_E_INDEX, 2, "response = 2");
        REFUSED("room", hbvib_batch_response_peaks(batch, 0, 1, speed, NULL), HBVIB_E_DIMENSION, 3, "needs 6");
        WORKS("free", hbvib_batch_free(batch));
        batch = NULL;
        watched[1].sector = 99;
        REFUSED("sector", hbvib_batch_solve(model, &s, &o, NULL, p, PARAMETERS, DESIGNS, values, &batch), HBVIB_E_INDEX, 3,
                "responses[1]: sector = 99");
        o.responses = NULL;
        o.responses_len = 0;
    }

    o.omega_stop = 2 * PI * 203;
    WORKS("none", hbvib_batch_solve(model, &s, &o, NULL, p, PARAMETERS, 1, values, &other));
    EXPECT("none", hbvib_batch_status(other, 0) == HBVIB_STOPPED_NO_PEAK && strstr(hbvib_last_error(), "no maximum"));
    WORKS("free", hbvib_batch_free(other));

    other = NULL;
    REFUSED("threads", (o.threads = 0, hbvib_batch_solve(model, &s, &o, NULL, p, PARAMETERS, 1, values, &other)), HBVIB_E_ARGUMENT, 3,
            "threads = 0");
    REFUSED("threads", (o.threads = -1, hbvib_batch_solve(model, &s, &o, NULL, p, PARAMETERS, 1, values, &other)), HBVIB_E_ARGUMENT, 3,
            "threads = -1");
    o.threads = 1;
    REFUSED("keep", (o.keep = 2, hbvib_batch_solve(model, &s, &o, NULL, p, PARAMETERS, 1, values, &other)), HBVIB_E_ARGUMENT, 3, "keep = 2");
    o.keep = 0;
    p[1].struct_size += 8;
    REFUSED("sizes", hbvib_batch_solve(model, &s, &o, NULL, p, 2, 1, values, &other), HBVIB_E_STRUCT_SIZE, 5, "parameter 1");
    p[1].struct_size -= 8;
    REFUSED("count", hbvib_batch_solve(model, &s, &o, NULL, p, 0, 1, values, &other), HBVIB_E_DIMENSION, 6, "count = 0");
    REFUSED("designs", hbvib_batch_solve(model, &s, &o, NULL, p, 1, -1, values, &other), HBVIB_E_DIMENSION, 7, "designs = -1");
    REFUSED("null", hbvib_batch_solve(model, &s, &o, NULL, p, 1, 1, NULL, &other), HBVIB_E_NULL, 8, "values");
    REFUSED("null", hbvib_batch_solve(model, &s, &o, NULL, NULL, 1, 1, values, &other), HBVIB_E_NULL, 5, "parameters");
    REFUSED("null", hbvib_batch_solve(model, &s, &o, NULL, p, 1, 1, values, NULL), HBVIB_E_NULL, 9, "out");
    p[1].kind = HBVIB_PARAMETER_KN;
    REFUSED("law", hbvib_batch_solve(model, &s, &o, NULL, p, 2, 1, values, &other), HBVIB_E_UNSUPPORTED, 5, "kn of contact 0");
    WORKS("force", hbvib_user_force_init(&force, sizeof force));
    force.dofs = dofs;
    force.n = 1;
    force.force = refuses;
    WORKS("force", hbvib_model_add_user_force(model, &force, NULL));
    o.threads = 2;
    REFUSED("force", hbvib_batch_solve(model, &s, &o, NULL, p, 1, 1, values, &other), HBVIB_E_UNSUPPORTED, 5, "threads = 2");
    EXPECT("untouched", other == NULL);
    WORKS("free", hbvib_batch_free(batch));
    WORKS("free", hbvib_batch_free(NULL));
    WORKS("free", hbvib_model_free(model));
    return verdict(60);
}
