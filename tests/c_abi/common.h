/* What the C tests share: the ring damper as reference case, and checks that name their row.
 * "Row n" is a line of the table of bad inputs that the interface was designed against. */
#ifndef COMMON_H
#define COMMON_H

#include "hbvib.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NDOF = 4, MOST_POINTS = 512 };

static int failures = 0;
static int checks = 0;

#define PI 3.14159265358979323846

#define EXPECT(row, condition)                                                                 \
    do {                                                                                       \
        checks++;                                                                              \
        if (!(condition)) {                                                                    \
            failures++;                                                                        \
            fprintf(stderr, "%s:%d: row %s: %s (last error: %s)\n", __FILE__, __LINE__, row,   \
                    #condition, hbvib_last_error());                                           \
        }                                                                                      \
    } while (0)

/* The call succeeds, and leaves no error text behind. */
#define WORKS(row, call)                                                                       \
    do {                                                                                       \
        EXPECT(row, (call) == HBVIB_OK);                                                       \
        EXPECT(row, hbvib_last_error()[0] == '\0' && hbvib_last_error_argument() == 0);        \
    } while (0)

static inline hbvib_matrix matrix(int64_t n, const double *values)
{
    hbvib_matrix a;
    if (hbvib_matrix_init(&a, sizeof a) != HBVIB_OK) abort();
    a.rows = a.cols = n;
    a.values = values;
    return a;
}

static inline hbvib_contact ring_contact(void)
{
    const double spin = 3000 * 2 * PI / 60;
    hbvib_contact c;
    if (hbvib_contact_init(&c, sizeof c) != HBVIB_OK) abort();
    c.kind = HBVIB_JENKINS;
    c.dof_a[0] = 2;
    c.dof_b[0] = 3;
    c.kt = 5e7;
    c.mu = 0.3;
    c.preload = 0.03 * 0.165 * spin * spin;
    return c;
}

/* f = 5 y - 2 y^3 between the same degrees of freedom. */
static inline hbvib_contact cubic_contact(void)
{
    hbvib_contact c;
    if (hbvib_contact_init(&c, sizeof c) != HBVIB_OK) abort();
    c.kind = HBVIB_CUBIC;
    c.dof_a[0] = 2;
    c.dof_b[0] = 3;
    c.kt = 5;
    c.cubic = -2;
    return c;
}

static const double MASS[16] = {0.2, 0, 0, 0, 0, 0.3, 0, 0, 0, 0, 1.2, 0, 0, 0, 0, 0.03};
static const double STIFFNESS[16] = {2e6, -2e6, 0, 0, -2e6, 3e6, -1e6, 0, 0, -1e6, 101.6e6, 0, 0, 0, 0, 4e7};
static const double COUPLING[16] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -5e7, 0, 0, 0, 0, -2e7};

/* One of 24 sectors: blade tip, blade root, disk, ring. */
static inline hbvib_model *ring_damper(void)
{
    hbvib_model *model = NULL;
    hbvib_matrix m = matrix(NDOF, MASS), k = matrix(NDOF, STIFFNESS), next = matrix(NDOF, COUPLING);
    hbvib_contact c = ring_contact();
    int32_t worst = 0;
    worst |= hbvib_cyclic_new(NDOF, 24, &model);
    worst |= hbvib_model_set_matrix(model, HBVIB_MASS, &m);
    worst |= hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &k);
    worst |= hbvib_cyclic_set_coupling(model, HBVIB_STIFFNESS, &next);
    worst |= hbvib_model_set_rayleigh(model, 0, 1.5e-6);
    worst |= hbvib_cyclic_set_wave(model, 2);
    worst |= hbvib_model_add_force(model, 0, 1, 5, 0);
    worst |= hbvib_model_add_force(model, 1, 1, 5, 0);
    worst |= hbvib_model_add_contact(model, &c, NULL);
    if (worst != 0) {
        fprintf(stderr, "the reference model was refused: %s\n", hbvib_last_error());
        exit(2);
    }
    return model;
}

static inline hbvib_solver_options solver_options(void)
{
    hbvib_solver_options s;
    if (hbvib_solver_options_init(&s, sizeof s) != HBVIB_OK) abort();
    s.tolerance = 0;
    s.response_dof = 0;
    return s;
}

static inline hbvib_forced_options frequencies(double from_hz, double to_hz)
{
    hbvib_forced_options o;
    if (hbvib_forced_options_init(&o, sizeof o) != HBVIB_OK) abort();
    o.omega_start = 2 * PI * from_hz;
    o.omega_stop = 2 * PI * to_hz;
    return o;
}

/* A mode of the ring damper: log10 of the modal amplitude over the slip limit's displacement. */
static inline hbvib_mode_options amplitudes(double log10_from, double log10_to)
{
    hbvib_contact c = ring_contact();
    double unit = log10(c.mu * c.preload / c.kt);
    hbvib_mode_options o;
    if (hbvib_mode_options_init(&o, sizeof o) != HBVIB_OK) abort();
    o.log10_start = unit + log10_from;
    o.log10_stop = unit + log10_to;
    return o;
}

/* Frequencies, amplitudes and the harmonics at the peak: the bits of a solution. */
typedef struct solution {
    int64_t points;
    double omega[MOST_POINTS], amplitude[MOST_POINTS], harmonics[2 * 10 * NDOF];
} solution;

static inline hbvib_status solve(const hbvib_model *model, solution *found)
{
    hbvib_solver_options s = solver_options();
    hbvib_forced_options o = frequencies(207, 211);
    hbvib_branch *branch = NULL;
    hbvib_view view;
    int64_t peak = -1, count = 0;
    hbvib_status status = hbvib_forced_response(model, &s, &o, NULL, &branch);
    memset(found, 0, sizeof *found);
    if (status != HBVIB_OK) return status;
    found->points = hbvib_branch_points(branch);
    if (found->points < 1 || found->points > MOST_POINTS) return 77;
    if (hbvib_view_init(&view, sizeof view) != HBVIB_OK) return 78;
    if (hbvib_branch_field(branch, HBVIB_OMEGA, &view) != HBVIB_OK) return 79;
    memcpy(found->omega, view.data, (size_t)found->points * sizeof(double));
    if (hbvib_branch_field(branch, HBVIB_AMPLITUDE, &view) != HBVIB_OK) return 80;
    memcpy(found->amplitude, view.data, (size_t)found->points * sizeof(double));
    if (hbvib_branch_peaks(branch, 1, NULL, NULL, &peak, &count) != HBVIB_OK) return 81;
    status = hbvib_branch_harmonics(branch, peak, 0, NDOF, found->harmonics, 10 * NDOF);
    if (status != HBVIB_OK) return status;
    return hbvib_branch_free(branch);
}

static inline int same_solution(const hbvib_model *model, const solution *reference)
{
    solution *again = malloc(sizeof *again);
    int same = again != NULL && solve(model, again) == HBVIB_OK && memcmp(again, reference, sizeof *again) == 0;
    free(again);
    return same;
}

/* Where set, the model that every refused call must leave as it was. */
static hbvib_model *the_model = NULL;

/* It is solved again after each refused call; under a tool that makes solving slow, after one in some. */
#ifndef ONE_REFUSAL_IN
#define ONE_REFUSAL_IN 1
#endif
static solution the_solution;

static inline void refused(const char *file, int line, const char *row, const char *call, hbvib_status status,
                           hbvib_status wanted, int32_t argument, const char *words)
{
    static int refusals = 0;
    const char *text = hbvib_last_error();
    checks++;
    if (status != wanted || hbvib_last_error_argument() != argument || text[0] == '\0' || strstr(text, words) == NULL) {
        failures++;
        fprintf(stderr, "%s:%d: row %s: %s\n  gave %s, argument %d: \"%s\"\n  needs %s, argument %d: \"...%s...\"\n",
                file, line, row, call, hbvib_status_name(status), (int)hbvib_last_error_argument(), text,
                hbvib_status_name(wanted), (int)argument, words);
    }
    if (the_model != NULL && refusals++ % ONE_REFUSAL_IN == 0 && !same_solution(the_model, &the_solution)) {
        failures++;
        fprintf(stderr, "%s:%d: row %s: %s changed the model\n", file, line, row, call);
    }
}

/* The call is refused with this status, blames this argument, and says these words. */
#define REFUSED(row, call, wanted, argument, words)                                            \
    refused(__FILE__, __LINE__, row, #call, (hbvib_status)(call), wanted, argument, words)

static inline void begin(void)
{
    hbvib_model *model = ring_damper();
    if (solve(model, &the_solution) != HBVIB_OK) {
        fprintf(stderr, "the reference case was not solved: %s\n", hbvib_last_error());
        exit(2);
    }
    the_model = model;
}

/* Two masses that do not know each other; contacts to the ground from dof first_contact on. */
static inline hbvib_model *two_masses(const double *m, const double *k, int64_t first_contact)
{
    hbvib_model *model = NULL;
    hbvib_matrix a = matrix(2, m), b = matrix(2, k);
    hbvib_contact c;
    int64_t dof;
    WORKS("two masses", hbvib_model_new(2, &model));
    WORKS("two masses", hbvib_model_set_matrix(model, HBVIB_MASS, &a));
    WORKS("two masses", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &b));
    for (dof = first_contact; dof < 2; dof++) {
        WORKS("two masses", hbvib_contact_init(&c, sizeof c));
        c.kind = HBVIB_JENKINS;
        c.dof_a[0] = dof;
        c.kt = c.mu = c.preload = 1;
        WORKS("two masses", hbvib_model_add_contact(model, &c, NULL));
    }
    return model;
}

static const double ONES[4] = {1, 0, 0, 1}, RISING[4] = {1, 0, 0, 4};

static inline int verdict(int least_checks)
{
    if (checks < least_checks) {
        fprintf(stderr, "only %d checks ran\n", checks);
        return 1;
    }
    return failures == 0 ? 0 : 1;
}

#endif
