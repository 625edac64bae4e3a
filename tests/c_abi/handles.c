/* Rows 85 to 94: handles that are freed, foreign, random or many. */
#include "common.h"

#include <unistd.h>

static long resident_bytes(void)
{
    long total = 0, resident = 0;
    FILE *f = fopen("/proc/self/statm", "r");
    if (f == NULL) return 0;
    if (fscanf(f, "%ld %ld", &total, &resident) != 2) resident = 0;
    fclose(f);
    return resident * sysconf(_SC_PAGESIZE);
}

static uint64_t state = 88172645463325252u;

static uint64_t random_bits(void)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return state;
}

/* Every function that takes a model refuses `m`. */
static void no_model(const char *row, hbvib_model *m, const char *words)
{
    hbvib_matrix a = matrix(NDOF, MASS);
    hbvib_contact c = ring_contact();
    hbvib_forced_options o = frequencies(207, 211);
    hbvib_mode_options mode = amplitudes(1, 3);
    hbvib_model *out = NULL;
    hbvib_branch *branch = NULL;
    double numbers[160] = {0};
    REFUSED(row, hbvib_model_set_matrix(m, HBVIB_MASS, &a), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_model_set_rayleigh(m, 0, 0), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_cyclic_set_coupling(m, HBVIB_MASS, &a), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_cyclic_set_coupling_previous(m, HBVIB_DAMPING, &a), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_cyclic_set_diameter(m, HBVIB_MASS, 0, &a), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_cyclic_set_wave(m, 2), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_cyclic_set_aero(m, 0, NULL, 0, NULL, NULL, 0), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_model_clone(m, &out), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_model_free(m), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_model_add_contact(m, &c, NULL), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_model_set_preload(m, 0, 1), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_model_add_force(m, 0, 1, 1, 0), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_model_clear_forces(m), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_model_dofs(m), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_model_sectors(m), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_model_contacts(m), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_linear_modes(m, 0, 0, 4, numbers, NULL), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_forced_response(m, NULL, &o, NULL, &branch), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_nonlinear_mode(m, NULL, &mode, NULL, &branch), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_forced_residual(m, NULL, 1, numbers, 40, numbers + 80, 40, NULL, 0, NULL, 0), HBVIB_E_HANDLE, 1, words);
    EXPECT(row, out == NULL && branch == NULL);
}

/* Every function that takes a branch refuses `b`. */
static void no_branch(const char *row, hbvib_branch *b, const char *words)
{
    hbvib_view view;
    hbvib_reduction reduction;
    hbvib_energy energy;
    hbvib_mode_point point;
    hbvib_mode_info info;
    hbvib_contact_summary summary;
    hbvib_verification verification;
    double numbers[80];
    int64_t count = -1;
    WORKS(row, hbvib_view_init(&view, sizeof view));
    WORKS(row, hbvib_reduction_init(&reduction, sizeof reduction));
    WORKS(row, hbvib_energy_init(&energy, sizeof energy));
    WORKS(row, hbvib_mode_point_init(&point, sizeof point));
    WORKS(row, hbvib_mode_info_init(&info, sizeof info));
    WORKS(row, hbvib_contact_summary_init(&summary, sizeof summary));
    REFUSED(row, hbvib_branch_free(b), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_branch_points(b), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_branch_stored(b), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_branch_status(b), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_branch_field(b, HBVIB_OMEGA, &view), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_branch_harmonics(b, 0, 0, NDOF, numbers, 40), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_branch_slip_fraction(b, 0, numbers, 1), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_branch_peaks(b, 0, NULL, NULL, NULL, &count), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_branch_folds(b, 0, NULL, NULL, NULL, &count), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_branch_at(b, 0, 0, NULL, NULL, &count), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_branch_reduction(b, &reduction), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_branch_energy(b, 0, &energy), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_branch_mode_point(b, 0, &point), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_branch_mode_info(b, &info), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_branch_time_history(b, 0, 0, 8, numbers), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_branch_contact_loop(b, 0, 0, 0, 8, numbers, NULL, NULL), HBVIB_E_HANDLE, 1, words);
    REFUSED(row, hbvib_branch_contact_summary(b, 0, 0, &summary), HBVIB_E_HANDLE, 1, words);
    WORKS(row, hbvib_verification_init(&verification, sizeof verification));
    REFUSED(row, hbvib_verify(the_model, b, 0, NULL, NULL, NULL, 0, NULL, 0, &verification), HBVIB_E_HANDLE, 2, words);
    EXPECT(row, count == -1);
}

int main(void)
{
    hbvib_forced_options o = frequencies(207, 211);
    hbvib_solver_options s = solver_options();
    hbvib_model *model, **many;
    hbvib_branch *branch = NULL;
    hbvib_view omega;
    double first, last;
    long before;
    int i, wrong = 0;

    begin();
    model = ring_damper();
    WORKS("87", hbvib_forced_response(model, &s, &o, NULL, &branch));
    no_model("87", (hbvib_model *)branch, "another type");
    no_branch("87", (hbvib_branch *)model, "another type");
    no_model("87", (hbvib_model *)&s, "never returned by this library"); /* an address of the caller's */
    no_branch("87", (hbvib_branch *)&s, "never returned by this library");

    /* Row 91: the branch keeps what it needs, its views too. */
    WORKS("91", hbvib_view_init(&omega, sizeof omega));
    WORKS("91", hbvib_branch_field(branch, HBVIB_OMEGA, &omega));
    WORKS("91", hbvib_model_free(model));
    {
        double x[80];
        WORKS("91", hbvib_branch_harmonics(branch, 3, 0, NDOF, x, 40));
    }
    first = omega.data[0];
    last = omega.data[(omega.shape[0] - 1) * omega.stride[0]];
    EXPECT("91", first == o.omega_start && last == o.omega_stop && omega.rank == 1);

    /* Rows 85, 86: freed twice, used after that; also when the slot is in use again. */
    no_model("85, 86", model, "freed");
    {
        hbvib_model *again = ring_damper();
        EXPECT("86", again != model);
        no_model("86", model, "freed");
        WORKS("86", hbvib_model_free(again));
    }
    WORKS("85", hbvib_branch_free(branch));
    no_branch("85, 86", branch, "freed");

    for (i = 0; i < 100000; i++) { /* row 88 */
        uintptr_t bits = (uintptr_t)random_bits();
        /* Every other one has the top bits of a real handle. */
        if (i % 2) bits = ((uintptr_t)the_model & ~(uintptr_t)0xFFFFFFFFFFFFu) | (bits & 0xFFFFFFFFFFFFu);
        if ((hbvib_model *)bits == the_model) continue;
        wrong += hbvib_cyclic_set_wave((hbvib_model *)bits, 1) != HBVIB_E_HANDLE;
        wrong += bits != 0 && hbvib_branch_free((hbvib_branch *)bits) != HBVIB_E_HANDLE;
        wrong += bits != 0 && hbvib_model_free((hbvib_model *)bits) != HBVIB_E_HANDLE;
    }
    EXPECT("88", wrong == 0);
    EXPECT("88", same_solution(the_model, &the_solution));

    for (i = 0; i < 1000; i++) { /* row 92, warmed up */
        wrong += hbvib_model_new(4, &model) != HBVIB_OK;
        wrong += hbvib_model_free(model) != HBVIB_OK;
    }
    before = resident_bytes();
    for (i = 0; i < 100000; i++) {
        wrong += hbvib_model_new(4, &model) != HBVIB_OK;
        wrong += hbvib_model_free(model) != HBVIB_OK;
    }
    EXPECT("92", wrong == 0 && resident_bytes() - before < 1 << 20);

    many = malloc(100000 * sizeof *many); /* row 93 */
    if (many == NULL) abort();
    for (i = 0; i < 100000; i++) wrong += hbvib_model_new(1 + i % 7, &many[i]) != HBVIB_OK;
    for (i = 0; i < 100000; i += 2) wrong += hbvib_model_free(many[i]) != HBVIB_OK;
    for (i = 0; i < 100000; i += 2) wrong += hbvib_model_new(1, &many[i]) != HBVIB_OK;
    for (i = 0; i < 100000; i++) wrong += hbvib_model_free(many[i]) != HBVIB_OK;
    for (i = 0; i < 100000; i++) wrong += hbvib_model_free(many[i]) != HBVIB_E_HANDLE;
    EXPECT("93", wrong == 0);
    free(many);

    WORKS("92", hbvib_model_free(the_model));
    return verdict(50);
}
