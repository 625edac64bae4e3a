/* From the matrices of a finite-element program to the motion of all its nodes and back, in C: reads stiffness and mass, solves the
 * response to a force on one degree of freedom, and writes each harmonic of the largest motion as a shape of a universal file.
 *
 *   motion_to_uff wheel.sti DOF FROM_HZ TO_HZ shapes.uff        DOF: row of the matrices, from 0
 */
#include "hbvib.h"
#include "hbvib_io.h"

#include <stdio.h>
#include <stdlib.h>

static const double PI = 3.14159265358979323846;

static void check(hbvib_status status, const char *call)
{
    if (status == HBVIB_OK) return;
    fprintf(stderr, "%s: %s: %s\n", call, hbvib_status_name(status), hbvib_last_error());
    exit(EXIT_FAILURE);
}
#define CHECK(call) check((call), #call)

static void check_io(int32_t status)
{
    if (status == 0) return;
    fprintf(stderr, "%s\n", hbvib_io_last_error());
    exit(EXIT_FAILURE);
}

static void *memory(size_t count, size_t size)
{
    void *found = calloc(count ? count : 1, size);
    if (!found) exit(EXIT_FAILURE);
    return found;
}

/* Row or column of an entry: those of one triangle, whichever it is, come into the lower one. */
static uint32_t place(const hbvib_io_matrix *a, int64_t k, int want_column)
{
    uint32_t row = a->row[k], column = a->column[k];
    if (a->symmetry == HBVIB_IO_SYMMETRIC && row < column) return want_column ? row : column;
    return want_column ? column : row;
}

/* Gives the model a real matrix of the file, whose entries become compressed columns. */
static void set(hbvib_model *model, hbvib_matrix_kind kind, const hbvib_io_file *file, int32_t which)
{
    hbvib_io_matrix from;
    hbvib_matrix to;
    int64_t *start, *row, *next, k;
    double *value;
    check_io(hbvib_io_matrix_of(file, which, &from));
    start = memory((size_t)from.columns + 1, sizeof *start);
    next = memory((size_t)from.columns, sizeof *next);
    row = memory((size_t)from.entries, sizeof *row);
    value = memory((size_t)from.entries, sizeof *value);
    for (k = 0; k < from.entries; k++) start[place(&from, k, 1) + 1]++;
    for (k = 0; k < from.columns; k++) next[k] = start[k + 1] += start[k];
    for (k = from.entries - 1; k >= 0; k--) {
        int64_t at = --next[place(&from, k, 1)];
        row[at] = place(&from, k, 0);
        value[at] = from.values[k];
    }
    CHECK(hbvib_matrix_init(&to, sizeof to));
    to.storage = HBVIB_CSC;
    to.part = from.symmetry == HBVIB_IO_SYMMETRIC ? HBVIB_SYMMETRIC_LOWER : HBVIB_GENERAL;
    to.rows = from.rows;
    to.cols = from.columns;
    to.col_ptr = start;
    to.row_idx = row;
    to.values = value;
    CHECK(hbvib_model_set_matrix(model, kind, &to));
    free(start);
    free(next);
    free(row);
    free(value);
}

int main(int argc, char **argv)
{
    hbvib_io_file *file = NULL;
    hbvib_io_results *results = NULL;
    hbvib_model *model = NULL;
    hbvib_branch *branch = NULL;
    hbvib_solver_options solver;
    hbvib_forced_options range;
    int64_t n, h, k, *dofs, *nodes, count = 0, peaks = 0, point;
    double omega, amplitude, *x, *motion;
    if (argc != 6) return EXIT_FAILURE;
    check_io(hbvib_io_read(argv[1], &file));
    n = hbvib_io_dofs(file);
    if (n < 1) return fprintf(stderr, "%s names no nodes\n", argv[1]), EXIT_FAILURE;
    dofs = memory((size_t)n, 2 * sizeof *dofs);
    check_io(hbvib_io_dof_table(file, dofs));

    CHECK(hbvib_model_new(n, &model));
    set(model, HBVIB_STIFFNESS, file, HBVIB_IO_STIFFNESS);
    set(model, HBVIB_MASS, file, HBVIB_IO_MASS);
    hbvib_io_free(file);
    CHECK(hbvib_model_set_rayleigh(model, 0, 1e-6));
    CHECK(hbvib_model_add_force(model, atoi(argv[2]), 1, 1, 0));
    CHECK(hbvib_solver_options_init(&solver, sizeof solver));
    solver.tolerance = 0;
    solver.harmonics = 1;
    solver.response_dof = atoi(argv[2]);
    CHECK(hbvib_forced_options_init(&range, sizeof range));
    range.omega_start = 2 * PI * atof(argv[3]);
    range.omega_stop = 2 * PI * atof(argv[4]);
    CHECK(hbvib_forced_response(model, &solver, &range, NULL, &branch));
    CHECK(hbvib_branch_peaks(branch, 1, &omega, &amplitude, &point, &peaks));
    if (peaks < 1) return fprintf(stderr, "no peak\n"), EXIT_FAILURE;

    /* Harmonics 0 and 1 of all degrees of freedom, as motions of nodes along x, y and z. */
    x = memory(2 * (size_t)n, 2 * sizeof *x);
    nodes = memory((size_t)n, sizeof *nodes);
    motion = memory((size_t)n, 6 * sizeof *motion);
    CHECK(hbvib_branch_harmonics(branch, point, 0, n, x, 2 * n));
    check_io(hbvib_io_results_new(0, NULL, NULL, &results));
    for (h = 1; h <= 1; h++) {
        for (k = 0, count = 0; k < n; k++) {
            /* Rows of a node stand together. */
            if (k == 0 || dofs[2 * k] != dofs[2 * k - 2]) nodes[count++] = dofs[2 * k];
            if (dofs[2 * k + 1] < 1 || dofs[2 * k + 1] > 3) continue;
            motion[6 * (count - 1) + 2 * (dofs[2 * k + 1] - 1)] = x[2 * (h * n + k)];
            motion[6 * (count - 1) + 2 * (dofs[2 * k + 1] - 1) + 1] = x[2 * (h * n + k) + 1];
        }
        check_io(hbvib_io_results_add_shape(results, "harmonic 1 at the peak", omega / (2 * PI), count, nodes, motion));
    }
    check_io(hbvib_io_results_write(results, argv[5]));
    hbvib_io_results_free(results);
    printf("%.9f Hz, %.9e, %d nodes\n", omega / (2 * PI), amplitude, (int)count);
    CHECK(hbvib_branch_free(branch));
    CHECK(hbvib_model_free(model));
    free(x);
    free(nodes);
    free(motion);
    free(dofs);
    return EXIT_SUCCESS;
}
