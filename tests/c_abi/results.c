/* What comes out: names and versions, special points, harmonics, views, loops, modes, residuals. */
#include "common.h"

static void names(void)
{
    char version[32];
    int32_t status;
    snprintf(version, sizeof version, "%d.%d.%d", HBVIB_VERSION_MAJOR, HBVIB_VERSION_MINOR, HBVIB_VERSION_PATCH);
    EXPECT("names", strcmp(hbvib_version_string(), version) == 0);
    EXPECT("names", strcmp(hbvib_status_name(HBVIB_OK), "HBVIB_OK") == 0);
    EXPECT("names", strcmp(hbvib_status_name(HBVIB_E_SINGULAR), "HBVIB_E_SINGULAR") == 0);
    for (status = HBVIB_E_NOT_POSITIVE_DEFINITE; status <= HBVIB_STOPPED_NO_FORCE; status++)
        EXPECT("names", strncmp(hbvib_status_name(status), "HBVIB_", 6) == 0 &&
                            strstr(hbvib_status_name(status), "UNKNOWN") == NULL);
    EXPECT("names", strcmp(hbvib_status_name(12345), "HBVIB_UNKNOWN_STATUS") == 0);
    EXPECT("names", strcmp(hbvib_status_name(INT32_MIN), "HBVIB_UNKNOWN_STATUS") == 0);
}

static void special_points(hbvib_branch *branch, const double *at)
{
    double omega = 0, amplitude = 0, x[80], part[20];
    int64_t point = -1, count = -1, points = hbvib_branch_points(branch), stored = hbvib_branch_stored(branch), h;
    hbvib_view view;
    size_t i;

    WORKS("peak", hbvib_branch_peaks(branch, 1, &omega, &amplitude, &point, &count));
    EXPECT("peak", count == 1 && point >= points && omega > at[0] && omega < at[1]);
    WORKS("peak", hbvib_branch_harmonics(branch, point, 0, NDOF, x, 40));
    EXPECT("peak", fabs(hypot(x[2 * NDOF], x[2 * NDOF + 1]) / amplitude - 1) < 1e-12);
    /* A range of degrees of freedom is that part of the whole; even harmonics are zero. */
    WORKS("peak", hbvib_branch_harmonics(branch, point, 2, 1, part, 10));
    for (h = 0; h < 10; h++) {
        EXPECT("peak", part[2 * h] == x[2 * (NDOF * h + 2)] && part[2 * h + 1] == x[2 * (NDOF * h + 2) + 1]);
        EXPECT("peak", (part[2 * h] == 0) == (h % 2 == 0));
    }
    WORKS("folds", hbvib_branch_folds(branch, 0, NULL, NULL, NULL, &count));
    EXPECT("folds", count == 0);
    for (i = 0; i < 2; i++) {
        WORKS("at", hbvib_branch_at(branch, (int64_t)i, 1, &amplitude, &point, &count));
        EXPECT("at", count == 1 && point >= points);
        WORKS("at", hbvib_branch_harmonics(branch, point, 0, 1, part, 10));
        EXPECT("at", fabs(hypot(part[2], part[3]) / amplitude - 1) < 1e-12);
    }
    EXPECT("stored", stored == points + 3); /* one peak, no fold, two solutions wanted */
    WORKS("stored", hbvib_branch_harmonics(branch, stored - 1, 0, 1, part, 10));
    EXPECT("stored", hbvib_branch_harmonics(branch, stored, 0, 1, part, 10) == HBVIB_E_INDEX);
    for (i = 0; i < 17; i++) {
        hbvib_status status;
        WORKS("views", hbvib_view_init(&view, sizeof view));
        status = hbvib_branch_field(branch, (int32_t)i, &view);
        if (i == 2 || i == 3 || i == 4 || (i >= 10 && i != 14)) {
            int a_modes = i != 16;
            EXPECT("views", status == HBVIB_E_ARGUMENT && hbvib_last_error_argument() == 2 && view.data == NULL);
            EXPECT("views", (strstr(hbvib_last_error(), "only a nonlinear mode has it") != NULL) == a_modes);
            continue;
        }
        EXPECT("views", status == HBVIB_OK && view.shape[0] == points && view.scalar == HBVIB_REAL);
        EXPECT("views", view.rank == (i == HBVIB_SLIP_FRACTION ? 2 : 1) && view.stride[0] == 1 && view.data != NULL);
        /* Errors were not asked for: unknown. */
        for (h = 0; h < points; h++) EXPECT("views", (i == HBVIB_ERROR_ESTIMATE) != (view.data[h * view.stride[0]] >= 0));
        /* Exact events have no sampling to check. */
        for (h = 0; i == HBVIB_SAMPLING_ERROR && h < points; h++) EXPECT("views", view.data[h] == 0);
    }
    /* The same fields of all stored points: those on the curve first. */
    for (i = 0; i < 2; i++) {
        hbvib_view all;
        int32_t which = i == 0 ? HBVIB_OMEGA : HBVIB_AMPLITUDE;
        WORKS("stored", hbvib_view_init(&view, sizeof view));
        WORKS("stored", hbvib_view_init(&all, sizeof all));
        WORKS("stored", hbvib_branch_field(branch, which, &view));
        WORKS("stored", hbvib_branch_stored_field(branch, which, &all));
        EXPECT("stored", all.shape[0] == stored && memcmp(all.data, view.data, (size_t)points * sizeof *all.data) == 0);
        WORKS("stored", hbvib_branch_at(branch, 0, 1, &amplitude, &point, &count));
        EXPECT("stored", i == 0 ? all.data[point] > 0 : all.data[point] == amplitude);
    }
    REFUSED("stored", hbvib_branch_stored_field(branch, 99, &view), HBVIB_E_ARGUMENT, 2, "needs a value of enum hbvib_field");
}

/* The residual vanishes where the branch says that it is solved. */
static void residual(hbvib_model *model, hbvib_branch *branch, const double *at)
{
    enum { SIZE = 80 };
    double x[SIZE], r[SIZE], d_omega[SIZE], largest = 0, slope = 0, amplitude, step, r2[SIZE];
    double *jac = malloc(SIZE * SIZE * sizeof *jac);
    int64_t point, count;
    int i, j;
    if (jac == NULL) abort();
    WORKS("residual", hbvib_branch_at(branch, 0, 1, &amplitude, &point, &count));
    WORKS("residual", hbvib_branch_harmonics(branch, point, 0, NDOF, x, 40));
    WORKS("residual", hbvib_forced_residual(model, NULL, at[0], x, 40, r, 40, jac, SIZE * SIZE, d_omega, 40));
    for (i = 0; i < SIZE; i++) largest = fmax(largest, fabs(r[i]));
    EXPECT("residual", largest < 1e-7 * 5); /* of the force of 5 N */
    WORKS("residual", hbvib_forced_residual(model, NULL, at[0] * (1 + 1e-6), x, 40, r2, 40, NULL, 0, NULL, 0));
    for (i = 0; i < SIZE; i++) slope = fmax(slope, fabs((r2[i] - r[i]) / (1e-6 * at[0]) - d_omega[i]));
    for (largest = 0, i = 0; i < SIZE; i++) largest = fmax(largest, fabs(d_omega[i]));
    EXPECT("residual", slope < 1e-4 * largest);
    /* Column-major: a step in one unknown moves the residual along its column. */
    j = 2 * NDOF + 4; /* Re X_1 of the disk */
    step = 1e-7 * amplitude;
    x[j] += step;
    WORKS("residual", hbvib_forced_residual(model, NULL, at[0], x, 40, r2, 40, NULL, 0, NULL, 0));
    for (slope = largest = 0, i = 0; i < SIZE; i++) {
        slope = fmax(slope, fabs((r2[i] - r[i]) / step - jac[j * SIZE + i]));
        largest = fmax(largest, fabs(jac[j * SIZE + i]));
    }
    EXPECT("residual", slope < 1e-4 * largest);
    free(jac);
}

/* What belongs to a mode is refused. */
static void no_mode(hbvib_branch *branch)
{
    hbvib_mode_point point;
    hbvib_mode_info info;
    WORKS("no mode", hbvib_mode_point_init(&point, sizeof point));
    WORKS("no mode", hbvib_mode_info_init(&info, sizeof info));
    REFUSED("no mode", hbvib_branch_mode_point(branch, 0, &point), HBVIB_E_UNSUPPORTED, 1, "a forced response has no mode");
    REFUSED("no mode", hbvib_branch_mode_info(branch, &info), HBVIB_E_UNSUPPORTED, 1, "a forced response has no mode");
    EXPECT("no mode", point.omega == 0 && info.omega == 0);
}

/* The work of both forces of 5 N goes into damping and friction; 24 sectors make the wheel. */
static void energy(hbvib_branch *branch)
{
    hbvib_energy e;
    double x[80], work;
    int64_t point = -1, count = -1;
    WORKS("energy", hbvib_branch_at(branch, 0, 1, NULL, &point, &count));
    WORKS("energy", hbvib_branch_harmonics(branch, point, 0, NDOF, x, 40));
    WORKS("energy", hbvib_energy_init(&e, sizeof e));
    WORKS("energy", hbvib_branch_energy(branch, point, &e));
    work = -PI * 5 * (x[2 * NDOF + 1] + x[2 * NDOF + 3]);
    EXPECT("energy", fabs((e.structural_loss + e.friction_loss) / work - 1) < 1e-9);
    EXPECT("energy", e.structural_loss > 0 && e.friction_loss > 0 && e.twice_mean_kinetic == 2 * e.kinetic_mean);
    EXPECT("energy", e.kinetic_peak > e.kinetic_mean && e.potential_peak > e.potential_mean);
    EXPECT("energy", fabs(e.wheel_kinetic_mean / (24 * e.kinetic_mean) - 1) < 1e-14);
    EXPECT("energy", fabs(e.wheel_potential_mean / (24 * e.potential_mean) - 1) < 1e-14);
    EXPECT("energy", e.wheel_kinetic_peak >= e.wheel_kinetic_mean && e.wheel_kinetic_peak < 24 * e.kinetic_peak);
    EXPECT("energy", e.wheel_potential_peak >= e.wheel_potential_mean && e.wheel_potential_peak < 24 * e.potential_peak);
}

/* The loop of the ring's contact, against its summary and the energies of the point. */
static void inside_contact(hbvib_branch *branch)
{
    enum { TIMES = 4096 };
    static double motion[TIMES], force[TIMES], again[TIMES], disk[TIMES], ring[TIMES];
    static int32_t state[TIMES];
    const hbvib_contact c = ring_contact();
    const double limit = c.mu * c.preload;
    hbvib_contact_summary s;
    hbvib_energy e;
    double area = 0, share, largest = 0;
    int64_t point = -1, count = -1;
    int slipping = 0, wrong = 0, j;
    WORKS("loop", hbvib_branch_peaks(branch, 1, NULL, NULL, &point, &count));
    WORKS("loop", hbvib_branch_contact_loop(branch, point, 0, 0, TIMES, motion, force, state));
    WORKS("loop", hbvib_branch_contact_loop(branch, point, 0, 0, TIMES, NULL, again, NULL));
    EXPECT("loop", memcmp(force, again, sizeof force) == 0);
    WORKS("loop", hbvib_branch_time_history(branch, point, 2, TIMES, disk));
    WORKS("loop", hbvib_branch_time_history(branch, point, 3, TIMES, ring));
    for (j = 0; j < TIMES; j++) {
        const int next = (j + 1) % TIMES;
        area += (force[j] + force[next]) / 2 * (motion[next] - motion[j]);
        slipping += state[j] == HBVIB_STATE_SLIP;
        largest = fmax(largest, fabs(motion[j]));
        wrong += state[j] != HBVIB_STATE_SLIP && state[j] != HBVIB_STATE_STICK;
        wrong += fabs(force[j]) > limit * (1 + 1e-12);
        wrong += state[j] == HBVIB_STATE_SLIP && fabs(fabs(force[j]) / limit - 1) > 1e-12;
        wrong += fabs(disk[j] - ring[j] - motion[j]) > 1e-9 * (fabs(disk[j]) + fabs(ring[j]) + limit / c.kt);
    }
    EXPECT("loop", wrong == 0 && slipping > 0 && slipping < TIMES);
    WORKS("loop", hbvib_contact_summary_init(&s, sizeof s));
    WORKS("loop", hbvib_branch_contact_summary(branch, point, 0, &s));
    WORKS("loop", hbvib_energy_init(&e, sizeof e));
    WORKS("loop", hbvib_branch_energy(branch, point, &e));
    WORKS("loop", hbvib_branch_slip_fraction(branch, point, &share, 1));
    EXPECT("loop", fabs(s.work / e.friction_loss - 1) < 1e-10 && fabs(area / s.work - 1) < 1e-3);
    EXPECT("loop", fabs(s.slip_share - share) < 1e-12 && fabs(slipping / (double)TIMES - share) < 0.01);
    EXPECT("loop", s.open_share == 0 && s.load_min == c.preload && s.load_max == c.preload);
    EXPECT("loop", s.half_range >= largest && s.half_range < largest * (1 + 1e-4));
    EXPECT("loop", s.motion_max == s.half_range && s.motion_min == -s.half_range);
    EXPECT("loop", s.directions == 1 && s.all_min[0] == s.motion_min && s.all_max[0] == s.motion_max);
    EXPECT("loop", s.all_min[1] == 0 && s.all_max[1] == 0 && s.all_min[2] == 0 && s.all_max[2] == 0);
}

static void modes(hbvib_model *model)
{
    double omega[NDOF], stuck[NDOF], shapes[2 * NDOF * NDOF], norm;
    int i, k;
    WORKS("modes", hbvib_linear_modes(model, 2, HBVIB_CONTACTS_FREE, NDOF, omega, shapes));
    WORKS("modes", hbvib_linear_modes(model, 2, HBVIB_CONTACTS_STUCK, NDOF, stuck, NULL));
    REFUSED("modes", hbvib_linear_modes(model, 2, 3, NDOF, omega, NULL), HBVIB_E_ARGUMENT, 3, "contacts = 3");
    for (k = 0; k < NDOF; k++) {
        for (norm = 0, i = 0; i < 2 * NDOF; i++) norm += MASS[5 * (i / 2)] * shapes[2 * NDOF * k + i] * shapes[2 * NDOF * k + i];
        EXPECT("modes", fabs(norm - 1) < 1e-12 && omega[k] <= stuck[k] * (1 + 1e-14));
        EXPECT("modes", k == 0 || omega[k] >= omega[k - 1]);
    }
}

int main(void)
{
    const double at[2] = {2 * PI * 208.5, 2 * PI * 209.5};
    hbvib_forced_options o = frequencies(207, 211);
    hbvib_solver_options s = solver_options();
    hbvib_branch *branch = NULL;
    begin();
    names();
    o.at = at;
    o.at_len = 2;
    WORKS("solve", hbvib_forced_response(the_model, &s, &o, NULL, &branch));
    special_points(branch, at);
    residual(the_model, branch, at);
    no_mode(branch);
    energy(branch);
    inside_contact(branch);
    modes(the_model);
    WORKS("free", hbvib_branch_free(branch));
    WORKS("free", hbvib_model_free(the_model));
    return verdict(100);
}
