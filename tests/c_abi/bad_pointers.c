/* Rows 1 to 23: pointers, sizes, buffers. Row 1 goes through every pointer of every function. */
#include "common.h"

static void *misaligned(void *p) { return (char *)p + 4; }

/* Row 1: NULL for each pointer, one at a time. Row 4: NULL handles. */
static void null_pointers(hbvib_model *model, hbvib_branch *branch, hbvib_branch *backbone)
{
    hbvib_matrix a = matrix(NDOF, STIFFNESS);
    hbvib_contact c = ring_contact();
    hbvib_forced_options o = frequencies(207, 211);
    hbvib_model *no_model = (hbvib_model *)&a, *kept_model = no_model;
    hbvib_branch *no_branch = (hbvib_branch *)&a, *kept_branch = no_branch;
    hbvib_reduction reduction;
    hbvib_energy energy;
    hbvib_mode_options mode = amplitudes(1, 3);
    hbvib_mode_point mode_point;
    hbvib_mode_info mode_info;
    hbvib_contact_summary summary;
    hbvib_view view;
    double numbers[8 * NDOF * NDOF] = {0};
    int64_t count = 0;

    REFUSED("1", hbvib_matrix_init(NULL, sizeof a), HBVIB_E_NULL, 1, "hbvib_matrix");
    REFUSED("1", hbvib_contact_init(NULL, sizeof c), HBVIB_E_NULL, 1, "hbvib_contact");
    REFUSED("1", hbvib_solver_options_init(NULL, 104), HBVIB_E_NULL, 1, "hbvib_solver_options");
    REFUSED("1", hbvib_forced_options_init(NULL, sizeof o), HBVIB_E_NULL, 1, "hbvib_forced_options");
    REFUSED("1", hbvib_hooks_init(NULL, sizeof(hbvib_hooks)), HBVIB_E_NULL, 1, "hbvib_hooks");
    REFUSED("1", hbvib_view_init(NULL, sizeof view), HBVIB_E_NULL, 1, "hbvib_view");
    REFUSED("1", hbvib_reduction_init(NULL, sizeof reduction), HBVIB_E_NULL, 1, "hbvib_reduction");
    REFUSED("1", hbvib_energy_init(NULL, sizeof energy), HBVIB_E_NULL, 1, "hbvib_energy");
    REFUSED("1", hbvib_mode_options_init(NULL, sizeof mode), HBVIB_E_NULL, 1, "hbvib_mode_options");
    REFUSED("1", hbvib_mode_point_init(NULL, sizeof mode_point), HBVIB_E_NULL, 1, "hbvib_mode_point");
    REFUSED("1", hbvib_mode_info_init(NULL, sizeof mode_info), HBVIB_E_NULL, 1, "hbvib_mode_info");
    REFUSED("1", hbvib_contact_summary_init(NULL, sizeof summary), HBVIB_E_NULL, 1, "hbvib_contact_summary");

    /* Row 2: the out handle. */
    REFUSED("2", hbvib_model_new(4, NULL), HBVIB_E_NULL, 2, "out");
    REFUSED("2", hbvib_cyclic_new(4, 24, NULL), HBVIB_E_NULL, 3, "out");
    REFUSED("2", hbvib_model_clone(model, NULL), HBVIB_E_NULL, 2, "out");
    REFUSED("2", hbvib_forced_response(model, NULL, &o, NULL, NULL), HBVIB_E_NULL, 5, "out");
    REFUSED("2", hbvib_nonlinear_mode(model, NULL, &mode, NULL, NULL), HBVIB_E_NULL, 5, "out");

    REFUSED("4", hbvib_model_set_matrix(NULL, HBVIB_MASS, &a), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_model_set_matrix(model, HBVIB_MASS, NULL), HBVIB_E_NULL, 3, "hbvib_matrix");
    REFUSED("4", hbvib_model_set_rayleigh(NULL, 0, 0), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("4", hbvib_cyclic_set_coupling(NULL, HBVIB_MASS, &a), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_cyclic_set_coupling(model, HBVIB_MASS, NULL), HBVIB_E_NULL, 3, "hbvib_matrix");
    REFUSED("4", hbvib_cyclic_set_coupling_previous(NULL, HBVIB_DAMPING, &a), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_cyclic_set_coupling_previous(model, HBVIB_DAMPING, NULL), HBVIB_E_NULL, 3, "hbvib_matrix");
    REFUSED("4", hbvib_cyclic_set_diameter(NULL, HBVIB_MASS, 0, &a), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_cyclic_set_diameter(model, HBVIB_MASS, 0, NULL), HBVIB_E_NULL, 4, "hbvib_matrix");
    REFUSED("4", hbvib_cyclic_set_wave(NULL, 2), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("4", hbvib_model_clone(NULL, &no_model), HBVIB_E_HANDLE, 1, "NULL");
    EXPECT("4", no_model == kept_model);
    WORKS("4", hbvib_model_free(NULL));
    REFUSED("4", hbvib_model_add_contact(NULL, &c, NULL), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_model_add_contact(model, NULL, &count), HBVIB_E_NULL, 2, "hbvib_contact");
    REFUSED("4", hbvib_model_set_preload(NULL, 0, 1), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("4", hbvib_model_add_force(NULL, 0, 1, 1, 0), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("4", hbvib_model_clear_forces(NULL), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("4", hbvib_linear_modes(NULL, 0, HBVIB_CONTACTS_FREE, 4, numbers, NULL), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_linear_modes(model, 0, HBVIB_CONTACTS_FREE, 4, NULL, numbers), HBVIB_E_NULL, 5, "omega");
    REFUSED("4", hbvib_forced_response(NULL, NULL, &o, NULL, &no_branch), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_forced_response(model, NULL, NULL, NULL, &no_branch), HBVIB_E_NULL, 3, "hbvib_forced_options");
    REFUSED("4", hbvib_nonlinear_mode(NULL, NULL, &mode, NULL, &no_branch), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_nonlinear_mode(model, NULL, NULL, NULL, &no_branch), HBVIB_E_NULL, 3, "hbvib_mode_options");
    EXPECT("1", no_branch == kept_branch);
    WORKS("4", hbvib_branch_free(NULL));
    REFUSED("4", hbvib_branch_points(NULL), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("4", hbvib_branch_status(NULL), HBVIB_E_HANDLE, 1, "NULL");
    WORKS("1", hbvib_view_init(&view, sizeof view));
    REFUSED("4", hbvib_branch_field(NULL, HBVIB_OMEGA, &view), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_branch_field(branch, HBVIB_OMEGA, NULL), HBVIB_E_NULL, 3, "hbvib_view");
    REFUSED("4", hbvib_branch_harmonics(NULL, 0, 0, NDOF, numbers, 40), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_branch_harmonics(branch, 0, 0, NDOF, NULL, 40), HBVIB_E_NULL, 5, "x");
    REFUSED("4", hbvib_branch_slip_fraction(NULL, 0, numbers, 1), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_branch_slip_fraction(branch, 0, NULL, 1), HBVIB_E_NULL, 3, "shares");
    REFUSED("4", hbvib_branch_peaks(NULL, 0, NULL, NULL, NULL, &count), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_branch_peaks(branch, 0, NULL, NULL, NULL, NULL), HBVIB_E_NULL, 6, "count");
    REFUSED("4", hbvib_branch_folds(NULL, 0, NULL, NULL, NULL, &count), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_branch_folds(branch, 0, NULL, NULL, NULL, NULL), HBVIB_E_NULL, 6, "count");
    REFUSED("4", hbvib_branch_at(NULL, 0, 0, NULL, NULL, &count), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_branch_at(branch, 0, 0, NULL, NULL, NULL), HBVIB_E_NULL, 6, "count");
    WORKS("1", hbvib_reduction_init(&reduction, sizeof reduction));
    REFUSED("4", hbvib_branch_reduction(NULL, &reduction), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_branch_reduction(branch, NULL), HBVIB_E_NULL, 2, "hbvib_reduction");
    WORKS("1", hbvib_energy_init(&energy, sizeof energy));
    REFUSED("4", hbvib_branch_energy(NULL, 0, &energy), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_branch_energy(branch, 0, NULL), HBVIB_E_NULL, 3, "hbvib_energy");
    WORKS("1", hbvib_mode_point_init(&mode_point, sizeof mode_point));
    REFUSED("4", hbvib_branch_mode_point(NULL, 0, &mode_point), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_branch_mode_point(backbone, 0, NULL), HBVIB_E_NULL, 3, "hbvib_mode_point");
    WORKS("1", hbvib_mode_info_init(&mode_info, sizeof mode_info));
    REFUSED("4", hbvib_branch_mode_info(NULL, &mode_info), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_branch_mode_info(backbone, NULL), HBVIB_E_NULL, 2, "hbvib_mode_info");
    REFUSED("4", hbvib_branch_time_history(NULL, 0, 0, 8, numbers), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_branch_time_history(branch, 0, 0, 8, NULL), HBVIB_E_NULL, 5, "x");
    REFUSED("4", hbvib_branch_contact_loop(NULL, 0, 0, 0, 8, numbers, NULL, NULL), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_branch_contact_loop(branch, 0, 0, 0, 8, NULL, NULL, NULL), HBVIB_E_NULL, 6, "one of them");
    WORKS("1", hbvib_contact_summary_init(&summary, sizeof summary));
    REFUSED("4", hbvib_branch_contact_summary(NULL, 0, 0, &summary), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("1", hbvib_branch_contact_summary(branch, 0, 0, NULL), HBVIB_E_NULL, 4, "hbvib_contact_summary");

    REFUSED("4", hbvib_forced_residual(NULL, NULL, 1, numbers, 40, numbers, 40, NULL, 0, NULL, 0), HBVIB_E_HANDLE, 1,
            "NULL");
    REFUSED("1", hbvib_forced_residual(model, NULL, 1, NULL, 40, numbers, 40, NULL, 0, NULL, 0), HBVIB_E_NULL, 4, "x");
    REFUSED("1", hbvib_forced_residual(model, NULL, 1, numbers, 40, NULL, 40, NULL, 0, NULL, 0), HBVIB_E_NULL, 6, "r");
    REFUSED("1", hbvib_forced_residual(model, NULL, 1, numbers, 40, numbers, 40, NULL, 6400, NULL, 0), HBVIB_E_NULL, 8,
            "jac");
    REFUSED("1", hbvib_forced_residual(model, NULL, 1, numbers, 40, numbers, 40, NULL, 0, NULL, 40), HBVIB_E_NULL, 10,
            "d_omega");
    REFUSED("1", hbvib_contact_evaluate(NULL, 1, 0, 1, numbers, 2, numbers + 8, 2, NULL, 0), HBVIB_E_NULL, 1,
            "hbvib_contact");
    REFUSED("1", hbvib_contact_evaluate(&c, 1, 0, 1, NULL, 2, numbers + 8, 2, NULL, 0), HBVIB_E_NULL, 5, "motion");
    REFUSED("1", hbvib_contact_evaluate(&c, 1, 0, 1, numbers, 2, NULL, 2, NULL, 0), HBVIB_E_NULL, 7, "force");
    REFUSED("1", hbvib_contact_evaluate(&c, 1, 0, 1, numbers, 2, numbers + 8, 2, NULL, 16), HBVIB_E_NULL, 9, "jac");

    /* Pointers inside structs. */
    a.values = NULL;
    REFUSED("1", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_NULL, 3, "values");
    a = matrix(NDOF, STIFFNESS);
    a.storage = HBVIB_CSC;
    REFUSED("1", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_NULL, 3, "col_ptr");
    {
        const int64_t ptr[5] = {0, 1, 1, 1, 1}, idx[1] = {0};
        a.col_ptr = ptr;
        REFUSED("1", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_NULL, 3, "row_idx");
        a.row_idx = idx;
        a.values = NULL;
        REFUSED("1", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_NULL, 3, "values");
    }
    o.at_len = 1;
    REFUSED("1", hbvib_forced_response(model, NULL, &o, NULL, &no_branch), HBVIB_E_NULL, 3, "at");
    o.at_len = 0;
    o.guess_len = 40;
    REFUSED("1", hbvib_forced_response(model, NULL, &o, NULL, &no_branch), HBVIB_E_NULL, 3, "guess");
    mode.at_len = 1;
    REFUSED("1", hbvib_nonlinear_mode(model, NULL, &mode, NULL, &no_branch), HBVIB_E_NULL, 3, "at");
    mode.at_len = 0;
    mode.shape_len = NDOF;
    REFUSED("1", hbvib_nonlinear_mode(model, NULL, &mode, NULL, &no_branch), HBVIB_E_NULL, 3, "shape");
    EXPECT("1", no_branch == kept_branch);
}

static void sizes(hbvib_model *model)
{
    const int64_t bad[] = {0, -1, INT64_MIN, INT64_MAX, INT64_C(1) << 32, INT64_C(3037000500)};
    hbvib_model *none = (hbvib_model *)model, *kept = none;
    hbvib_matrix a = matrix(NDOF, STIFFNESS);
    hbvib_forced_options o = frequencies(207, 211);
    hbvib_mode_options mode = amplitudes(1, 3);
    hbvib_branch *branch = NULL;
    double padded[6 * NDOF];
    size_t i;
    int j;

    for (i = 0; i < sizeof bad / sizeof *bad; i++) { /* rows 5, 6, 7 */
        REFUSED("5-7", hbvib_model_new(bad[i], &none), HBVIB_E_DIMENSION, 1, "ndof");
        REFUSED("5-7", hbvib_cyclic_new(bad[i], 24, &none), HBVIB_E_DIMENSION, 1, "ndof");
        EXPECT("5-7", none == kept);
        a.rows = a.cols = bad[i];
        REFUSED("5-7", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_DIMENSION, 3, "needs 4 x 4");
        a = matrix(NDOF, STIFFNESS);
        if (bad[i] > 0) {
            a.ld = bad[i]; /* the matrix would not lie in memory */
            a.scalar = HBVIB_COMPLEX;
            if (bad[i] == INT64_MAX)
                REFUSED("7", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_DIMENSION, 3, "memory");
            a = matrix(NDOF, STIFFNESS);
        }
        o.at_len = bad[i];
        o.at = MASS;
        if (bad[i] == INT64_MAX)
            REFUSED("7", hbvib_forced_response(model, NULL, &o, NULL, &branch), HBVIB_E_DIMENSION, 3, "at");
        if (bad[i] < 0)
            REFUSED("6", hbvib_forced_response(model, NULL, &o, NULL, &branch), HBVIB_E_DIMENSION, 3, "at_len");
        o = frequencies(207, 211);
        if (bad[i] != 0) {
            o.guess_len = bad[i];
            o.guess = MASS;
            REFUSED("6-8", hbvib_forced_response(model, NULL, &o, NULL, &branch), HBVIB_E_DIMENSION, 3, "guess_len");
        }
        o = frequencies(207, 211);
        mode.at = mode.shape = MASS;
        mode.at_len = bad[i];
        mode.shape_len = NDOF;
        if (bad[i] == INT64_MAX)
            REFUSED("7", hbvib_nonlinear_mode(model, NULL, &mode, NULL, &branch), HBVIB_E_DIMENSION, 3, "at");
        if (bad[i] < 0)
            REFUSED("6", hbvib_nonlinear_mode(model, NULL, &mode, NULL, &branch), HBVIB_E_DIMENSION, 3, "at_len");
        mode.at_len = 0;
        mode.shape_len = bad[i];
        REFUSED("6-8", hbvib_nonlinear_mode(model, NULL, &mode, NULL, &branch), HBVIB_E_DIMENSION, 3, "shape_len");
        REFUSED("6-8", hbvib_linear_modes(model, 0, 0, bad[i], padded, NULL), HBVIB_E_DIMENSION, 4, "needs 1 .. ndof = 4");
    }
    EXPECT("7", branch == NULL);

    { /* row 9: sizes that fit into 64 bits but not into memory */
        enum { BIG = 200000 };
        int64_t *ptr = malloc((BIG + 1) * sizeof *ptr);
        double *ones = malloc(BIG * sizeof *ones), *omega = malloc(BIG * sizeof *omega);
        hbvib_model *big = NULL;
        hbvib_matrix d = matrix(BIG, ones);
        if (ptr == NULL || ones == NULL || omega == NULL) abort();
        omega[0] = -1;
        for (i = 0; i <= BIG; i++) ptr[i] = (int64_t)i;
        for (i = 0; i < BIG; i++) ones[i] = 1;
        d.storage = HBVIB_CSC;
        d.col_ptr = ptr;
        d.row_idx = ptr;
        WORKS("9", hbvib_model_new(BIG, &big));
        WORKS("9", hbvib_model_set_matrix(big, HBVIB_MASS, &d));
        WORKS("9", hbvib_model_set_matrix(big, HBVIB_STIFFNESS, &d));
        WORKS("9", hbvib_model_add_force(big, 7, 1, 1, 0));
        REFUSED("9", hbvib_linear_modes(big, 0, HBVIB_CONTACTS_FREE, BIG, omega, NULL), HBVIB_E_OUT_OF_MEMORY, 0, "memory");
        EXPECT("9", omega[0] < 0);
        WORKS("9", hbvib_model_free(big));
        free(ptr);
        free(ones);
        free(omega);
    }

    a.ld = 3; /* row 10 */
    REFUSED("10", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a), HBVIB_E_DIMENSION, 3, "ld = 3");
    a.ld = -4;
    REFUSED("10", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a), HBVIB_E_DIMENSION, 3, "ld = -4");
    for (i = 0; i < NDOF; i++) /* row 11 */
        for (j = 0; j < 6; j++) padded[6 * i + (size_t)j] = j < NDOF ? STIFFNESS[NDOF * i + (size_t)j] : (double)NAN;
    a.ld = 6;
    a.values = padded;
    WORKS("11", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a));
    a.storage = HBVIB_ROW_MAJOR;
    WORKS("11", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a));
    memset(padded, 0x55, sizeof padded); /* row 18: the library owns a copy */
    EXPECT("11, 18", same_solution(model, &the_solution));
    { /* row 17: the same numbers for all three */
        hbvib_matrix k = matrix(NDOF, STIFFNESS), m = matrix(NDOF, MASS), zero;
        double nothing[16] = {0};
        zero = matrix(NDOF, nothing);
        WORKS("17", hbvib_model_set_matrix(model, HBVIB_MASS, &k));
        WORKS("17", hbvib_model_set_matrix(model, HBVIB_DAMPING, &k));
        WORKS("17", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &k));
        WORKS("17", hbvib_model_set_matrix(model, HBVIB_MASS, &m));
        WORKS("17", hbvib_model_set_matrix(model, HBVIB_DAMPING, &zero));
        EXPECT("17", same_solution(model, &the_solution));
    }
}

/* Times, loops and summaries of a contact. */
static void inside_contacts(hbvib_branch *branch)
{
    const int64_t wrong[] = {0, -1, (1 << 24) + 1, INT64_MAX, INT64_MIN};
    hbvib_contact_summary summary;
    double a[16] = {0}, b[16] = {0};
    int32_t state[16] = {7};
    size_t i;
    WORKS("14", hbvib_contact_summary_init(&summary, sizeof summary));
    for (i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        REFUSED("9", hbvib_branch_time_history(branch, 0, 0, wrong[i], a), HBVIB_E_DIMENSION, 4, "n = ");
        REFUSED("9", hbvib_branch_contact_loop(branch, 0, 0, 0, wrong[i], a, b, state), HBVIB_E_DIMENSION, 5, "n = ");
    }
    REFUSED("14", hbvib_branch_time_history(branch, 0, 0, 8, misaligned(a)), HBVIB_E_ARGUMENT, 5, "misaligned");
    REFUSED("14", hbvib_branch_contact_loop(branch, 0, 0, 0, 8, misaligned(a), b, state), HBVIB_E_ARGUMENT, 6, "misaligned");
    REFUSED("14", hbvib_branch_contact_loop(branch, 0, 0, 0, 8, a, misaligned(b), state), HBVIB_E_ARGUMENT, 7, "misaligned");
    REFUSED("14", hbvib_branch_contact_loop(branch, 0, 0, 0, 8, a, b, (int32_t *)((char *)state + 2)), HBVIB_E_ARGUMENT, 8,
            "misaligned");
    REFUSED("14", hbvib_branch_contact_summary(branch, 0, 0, (hbvib_contact_summary *)misaligned(a)), HBVIB_E_ARGUMENT, 4,
            "misaligned");
    REFUSED("16", hbvib_branch_contact_loop(branch, 0, 0, 0, 8, a, a + 7, NULL), HBVIB_E_ARGUMENT, 7, "overlap");
    REFUSED("16", hbvib_branch_contact_loop(branch, 0, 0, 0, 8, NULL, a, (int32_t *)a), HBVIB_E_ARGUMENT, 8, "overlap");
    REFUSED("39", hbvib_branch_time_history(branch, INT64_MAX, 0, 8, a), HBVIB_E_INDEX, 2, "point");
    REFUSED("39", hbvib_branch_time_history(branch, -1, 0, 8, a), HBVIB_E_INDEX, 2, "point = -1");
    REFUSED("39", hbvib_branch_time_history(branch, 0, NDOF, 8, a), HBVIB_E_INDEX, 3, "dof = 4");
    REFUSED("39", hbvib_branch_contact_loop(branch, -1, 0, 0, 8, a, b, state), HBVIB_E_INDEX, 2, "point = -1");
    REFUSED("39", hbvib_branch_contact_loop(branch, 0, 1, 0, 8, a, b, state), HBVIB_E_INDEX, 3, "contact = 1");
    REFUSED("39", hbvib_branch_contact_loop(branch, 0, 0, 1, 8, a, b, state), HBVIB_E_INDEX, 4, "direction = 1, needs 0 .. 0");
    REFUSED("39", hbvib_branch_contact_loop(branch, 0, 0, -1, 8, a, b, state), HBVIB_E_INDEX, 4, "direction = -1");
    REFUSED("39", hbvib_branch_contact_summary(branch, INT64_MAX, 0, &summary), HBVIB_E_INDEX, 2, "point");
    REFUSED("39", hbvib_branch_contact_summary(branch, 0, -1, &summary), HBVIB_E_INDEX, 3, "contact = -1");
    EXPECT("39", summary.load_max == 0 && a[0] == 0 && b[0] == 0 && state[0] == 7);
    summary.struct_size = 64;
    REFUSED("66", hbvib_branch_contact_summary(branch, 0, 0, &summary), HBVIB_E_STRUCT_SIZE, 4, "struct_size = 64");
    REFUSED("66", hbvib_contact_summary_init(&summary, 71), HBVIB_E_STRUCT_SIZE, 2, "struct_size = 71");
}

static void buffers(hbvib_model *model, hbvib_branch *branch, hbvib_branch *backbone)
{
    hbvib_energy energy;
    hbvib_mode_point mode_point;
    hbvib_mode_options mode = amplitudes(1, 3);
    hbvib_matrix a = matrix(NDOF, STIFFNESS);
    hbvib_contact c = ring_contact();
    double x[200] = {0}, r[200];
    const int64_t wrong[] = {39, 41, 0, -1, INT64_MAX, INT64_MIN};
    int64_t idx[10] = {0}, count = -5, point = -5;
    double jac[64], omega = -1, shares = -1;
    char text[300];
    size_t i, needed;
    hbvib_view view;

    for (i = 0; i < sizeof wrong / sizeof *wrong; i++) { /* row 12 */
        REFUSED("12", hbvib_forced_residual(model, NULL, 1, x, wrong[i], r, 40, NULL, 0, NULL, 0), HBVIB_E_DIMENSION, 5, "= 40");
        REFUSED("12", hbvib_forced_residual(model, NULL, 1, x, 40, r, wrong[i], NULL, 0, NULL, 0), HBVIB_E_DIMENSION, 7, "= 40");
        REFUSED("12", hbvib_forced_residual(model, NULL, 1, x, 40, r, 40, r, wrong[i], NULL, 0), HBVIB_E_DIMENSION, 9, "= 6400");
        REFUSED("12", hbvib_forced_residual(model, NULL, 1, x, 40, r, 40, NULL, 0, r, wrong[i]), HBVIB_E_DIMENSION, 11, "= 40");
        REFUSED("12", hbvib_branch_harmonics(branch, 0, 0, NDOF, r, wrong[i]), HBVIB_E_DIMENSION, 6, "= 40");
        REFUSED("12", hbvib_branch_slip_fraction(branch, 0, &shares, wrong[i]), HBVIB_E_DIMENSION, 4, "= 1");
        REFUSED("12", hbvib_contact_evaluate(&c, 1, 0, 1, x, wrong[i], r, 2, NULL, 0), HBVIB_E_DIMENSION, 6, "= 2");
        REFUSED("12", hbvib_contact_evaluate(&c, 1, 0, 1, x, 2, r, wrong[i], NULL, 0), HBVIB_E_DIMENSION, 8, "= 2");
        REFUSED("12", hbvib_contact_evaluate(&c, 1, 0, 1, x, 2, r, 2, jac, wrong[i]), HBVIB_E_DIMENSION, 10, "= 16");
    }
    EXPECT("12", shares < 0);
    for (i = 0; i < 3; i++) {
        const int64_t many[] = {0, -1, 5};
        REFUSED("12", hbvib_branch_harmonics(branch, 0, 0, many[i], r, 40), HBVIB_E_DIMENSION, 4, "needs 1 .. 4");
    }

    /* Row 14: misaligned pointers. */
    a.values = misaligned(x);
    REFUSED("14", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_ARGUMENT, 3, "misaligned");
    REFUSED("14", hbvib_model_set_matrix(model, HBVIB_MASS, misaligned(&a)), HBVIB_E_ARGUMENT, 3, "misaligned");
    REFUSED("14", hbvib_linear_modes(model, 0, 0, 4, misaligned(x), NULL), HBVIB_E_ARGUMENT, 5, "misaligned");
    REFUSED("14", hbvib_linear_modes(model, 0, 0, 4, x, misaligned(x)), HBVIB_E_ARGUMENT, 6, "misaligned");
    REFUSED("14", hbvib_forced_residual(model, NULL, 1, misaligned(x), 40, r, 40, NULL, 0, NULL, 0), HBVIB_E_ARGUMENT, 4, "misaligned");
    REFUSED("14", hbvib_branch_harmonics(branch, 0, 0, NDOF, misaligned(r), 40), HBVIB_E_ARGUMENT, 5, "misaligned");
    REFUSED("14", hbvib_branch_peaks(branch, 9, misaligned(r), NULL, NULL, &count), HBVIB_E_ARGUMENT, 3, "misaligned");
    REFUSED("14", hbvib_branch_peaks(branch, 9, NULL, NULL, NULL, misaligned(idx)), HBVIB_E_ARGUMENT, 6, "misaligned");
    REFUSED("14", hbvib_branch_energy(branch, 0, (hbvib_energy *)misaligned(r)), HBVIB_E_ARGUMENT, 3, "misaligned");
    REFUSED("14", hbvib_branch_mode_point(backbone, 0, (hbvib_mode_point *)misaligned(r)), HBVIB_E_ARGUMENT, 3, "misaligned");
    REFUSED("14", hbvib_branch_mode_info(backbone, (hbvib_mode_info *)misaligned(r)), HBVIB_E_ARGUMENT, 2, "misaligned");
    REFUSED("14", hbvib_nonlinear_mode(model, NULL, &mode, NULL, misaligned(idx)), HBVIB_E_ARGUMENT, 5, "misaligned");
    REFUSED("14", hbvib_model_add_contact(model, &c, misaligned(idx)), HBVIB_E_ARGUMENT, 3, "misaligned");
    REFUSED("14", hbvib_model_new(4, misaligned(idx)), HBVIB_E_ARGUMENT, 2, "misaligned");

    /* Rows 15, 16: overlapping input and output. */
    REFUSED("15", hbvib_forced_residual(model, NULL, 1, x, 40, x, 40, NULL, 0, NULL, 0), HBVIB_E_ARGUMENT, 6, "overlap");
    REFUSED("16", hbvib_forced_residual(model, NULL, 1, x, 40, x + 78, 40, NULL, 0, NULL, 0), HBVIB_E_ARGUMENT, 6, "overlap");
    REFUSED("16", hbvib_forced_residual(model, NULL, 1, x, 40, r, 40, NULL, 0, r + 79, 40), HBVIB_E_ARGUMENT, 10, "overlap");
    REFUSED("16", hbvib_contact_evaluate(&c, 1, 0, 1, x, 2, x + 3, 2, NULL, 0), HBVIB_E_ARGUMENT, 7, "overlap");
    WORKS("16", hbvib_forced_residual(model, NULL, 1, x, 40, x + 80, 40, NULL, 0, NULL, 0));

    /* Row 19: the message buffer. */
    EXPECT("19", hbvib_model_new(-1, NULL) == HBVIB_E_NULL);
    needed = hbvib_last_error_copy(text, sizeof text);
    EXPECT("1", hbvib_last_error_copy(NULL, 0) == needed && hbvib_last_error_copy(NULL, 9) == needed);
    EXPECT("19", needed == strlen(hbvib_last_error()) + 1 && strcmp(text, hbvib_last_error()) == 0);
    memset(text, 'x', sizeof text);
    EXPECT("19", hbvib_last_error_copy(text, 0) == needed && text[0] == 'x');
    EXPECT("19", hbvib_last_error_copy(text, 1) == needed && text[0] == '\0' && text[1] == 'x');
    EXPECT("19", hbvib_last_error_copy(text, needed - 1) == needed && strlen(text) == needed - 2 && text[needed] == 'x');
    EXPECT("19", hbvib_last_error_copy(text, needed) == needed && strlen(text) == needed - 1);

    { /* Rows 20, 22: sparse indices, base 0 and 1. Row 40: 0 under base 1. */
        const int64_t from_one[5] = {1, 2, 3, 4, 5}, from_zero[5] = {0, 1, 2, 3, 4};
        const int64_t down[5] = {0, 3, 2, 3, 4}, negative[5] = {0, 0, 0, 0, -1}, lowest[5] = {1, 1, 1, 1, INT64_MIN};
        const int64_t rows_low[4] = {0, INT64_MIN, 2, 3}, rows_high[4] = {0, 4, 2, 3}, huge[5] = {0, 0, 0, 0, INT64_MAX};
        a = matrix(NDOF, MASS);
        a.storage = HBVIB_CSC;
        a.row_idx = from_zero;
        a.col_ptr = from_one;
        REFUSED("20", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_INDEX, 3, "col_ptr[0] = 1");
        a.col_ptr = down;
        REFUSED("20", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_INDEX, 3, "col_ptr[2] = 2");
        a.col_ptr = negative;
        REFUSED("22", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_INDEX, 3, "col_ptr[4] = -1");
        a.col_ptr = huge;
        REFUSED("22", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_DIMENSION, 3, "memory");
        a.col_ptr = from_zero;
        a.row_idx = rows_high;
        REFUSED("20", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_INDEX, 3, "row_idx[1] = 4, needs 0 .. 3");
        a.index_base = 1;
        a.col_ptr = lowest;
        REFUSED("20", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_INDEX, 3, "col_ptr[4]");
        a.col_ptr = from_one;
        a.row_idx = from_zero;
        REFUSED("40", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_INDEX, 3, "row_idx[0] = 0, needs 1 .. 4");
        a.row_idx = rows_low;
        REFUSED("20", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_INDEX, 3, "needs 1 .. 4");
        a.index_base = 2;
        REFUSED("20", hbvib_model_set_matrix(model, HBVIB_MASS, &a), HBVIB_E_ARGUMENT, 3, "index_base = 2");
    }

    { /* Row 21: duplicates are summed. */
        const double halves[5] = {0.1, 0.1, 0.3, 1.2, 0.03};
        const int64_t ptr[5] = {1, 3, 4, 5, 6}, idx1[5] = {1, 1, 2, 3, 4};
        a = matrix(NDOF, halves);
        a.storage = HBVIB_CSC;
        a.index_base = 1;
        a.col_ptr = ptr;
        a.row_idx = idx1;
        WORKS("21", hbvib_model_set_matrix(model, HBVIB_MASS, &a));
        EXPECT("21", same_solution(model, &the_solution));
    }

    /* Row 23: too small a capacity tells the one needed and writes nothing else. */
    REFUSED("23", hbvib_branch_peaks(branch, 0, &omega, NULL, &point, &count), HBVIB_E_DIMENSION, 2, "needs 1");
    EXPECT("23", count == 1 && omega < 0 && point == -5);
    REFUSED("23", hbvib_branch_peaks(branch, -1, &omega, NULL, NULL, &count), HBVIB_E_DIMENSION, 2, "capacity = -1");
    WORKS("23", hbvib_branch_peaks(branch, 0, NULL, NULL, NULL, &count));
    WORKS("23", hbvib_branch_peaks(branch, 1, &omega, NULL, &point, &count));
    EXPECT("23", omega > 0 && point >= hbvib_branch_points(branch));
    REFUSED("39", hbvib_branch_at(branch, 1, 0, NULL, NULL, &count), HBVIB_E_INDEX, 2, "wanted");
    REFUSED("39", hbvib_branch_harmonics(branch, point + 1, 0, NDOF, r, 40), HBVIB_E_INDEX, 2, "point");
    REFUSED("39", hbvib_branch_harmonics(branch, -1, 0, NDOF, r, 40), HBVIB_E_INDEX, 2, "point = -1");
    REFUSED("39", hbvib_branch_harmonics(branch, 0, 4, NDOF, r, 40), HBVIB_E_INDEX, 3, "first_dof = 4");
    REFUSED("39", hbvib_branch_slip_fraction(branch, INT64_MAX, &shares, 1), HBVIB_E_INDEX, 2, "point");
    WORKS("39", hbvib_energy_init(&energy, sizeof energy));
    REFUSED("39", hbvib_branch_energy(branch, point + 1, &energy), HBVIB_E_INDEX, 2, "point");
    REFUSED("39", hbvib_branch_energy(branch, -1, &energy), HBVIB_E_INDEX, 2, "point = -1");
    EXPECT("39", energy.twice_mean_kinetic == 0 && energy.friction_loss == 0);
    WORKS("39", hbvib_branch_energy(branch, point, &energy));
    WORKS("39", hbvib_mode_point_init(&mode_point, sizeof mode_point));
    REFUSED("39", hbvib_branch_mode_point(backbone, INT64_MAX, &mode_point), HBVIB_E_INDEX, 2, "point");
    REFUSED("39", hbvib_branch_mode_point(backbone, -1, &mode_point), HBVIB_E_INDEX, 2, "point = -1");
    EXPECT("39", mode_point.omega == 0 && mode_point.energy == 0);
    WORKS("39", hbvib_branch_slip_fraction(branch, point, &shares, 1));
    EXPECT("39", shares > 0 && shares < 1);
    WORKS("39", hbvib_view_init(&view, sizeof view));
    REFUSED("54", hbvib_branch_field(branch, 9999, &view), HBVIB_E_ARGUMENT, 2, "field = 9999");
    REFUSED("54", hbvib_branch_field(backbone, 9999, &view), HBVIB_E_ARGUMENT, 2, "field = 9999");
    EXPECT("54", view.data == NULL && view.rank == 0);
}

int main(void)
{
    hbvib_branch *branch = NULL, *backbone = NULL;
    hbvib_forced_options o = frequencies(207, 211);
    hbvib_mode_options mode = amplitudes(1, 3);
    hbvib_solver_options s = solver_options();
    const double wanted = 2 * PI * 208;
    begin();
    o.at = &wanted;
    o.at_len = 1;
    WORKS("1", hbvib_forced_response(the_model, &s, &o, NULL, &branch));
    WORKS("1", hbvib_nonlinear_mode(the_model, &s, &mode, NULL, &backbone));
    null_pointers(the_model, branch, backbone);
    sizes(the_model);
    buffers(the_model, branch, backbone);
    inside_contacts(branch);
    WORKS("1", hbvib_branch_free(branch));
    WORKS("1", hbvib_branch_free(backbone));
    WORKS("1", hbvib_model_free(the_model));
    return verdict(200);
}
