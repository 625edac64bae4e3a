/* Responses synthesised from a nonlinear mode: near the computed ones, and bad input. */
#include "common.h"

enum { CAPACITY = 4096 };

static hbvib_branch *mode_of(hbvib_model *model)
{
    hbvib_solver_options s = solver_options();
    hbvib_mode_options o = amplitudes(0, 5);
    hbvib_branch *branch = NULL;
    s.step_max = 0.002;
    WORKS("mode", hbvib_nonlinear_mode(model, &s, &o, NULL, &branch));
    return branch;
}

static hbvib_synthesis_options synthesis_options(void)
{
    hbvib_synthesis_options o;
    WORKS("options", hbvib_synthesis_options_init(&o, sizeof o));
    EXPECT("options", o.force_factor == 1 && o.damping_ratio == 0 && o.model_damping == 0);
    return o;
}

/* The peak of the computed response, 1e-3 away at worst as measured: 2e-4 at 5 N. */
static void near_the_computed_one(hbvib_branch *mode)
{
    static double omega[CAPACITY], response[2 * CAPACITY], modal[CAPACITY];
    hbvib_solver_options s = solver_options();
    hbvib_forced_options range = frequencies(207, 211);
    hbvib_branch *forced = NULL;
    double w = 0, a = 0, peak_w = 0, peak_a = 0, p = 0, d = 0, other = 0, error = 77, largest = 0;
    int64_t count = 0, i, best = 0;
    int32_t flags = -1;

    WORKS("computed", hbvib_forced_response(the_model, &s, &range, NULL, &forced));
    WORKS("computed", hbvib_branch_peaks(forced, 1, &w, &a, NULL, &count));
    EXPECT("computed", count == 1);
    WORKS("computed", hbvib_branch_free(forced));

    WORKS("peaks", hbvib_branch_synthesis_peaks(mode, the_model, NULL, 1, &peak_w, &peak_a, &p, &d, &other, &error, &flags, &count));
    EXPECT("peaks", count == 1 && flags == HBVIB_SYNTHESIS_VALID && d > 1e-3 && d < 1e-2 && other > 10);
    EXPECT("peaks", fabs(peak_a / a - 1) < 1e-3 && fabs(peak_w / w - 1) < 1e-4 && fabs(peak_a / a - 1 - error) < 1e-7);
    WORKS("peaks", hbvib_branch_synthesis_peaks(mode, the_model, NULL, 0, NULL, NULL, NULL, NULL, NULL, NULL, NULL, &count));
    EXPECT("peaks", count == 1);

    WORKS("curve", hbvib_branch_synthesis(mode, the_model, NULL, CAPACITY, omega, response, modal, &count));
    EXPECT("curve", count > 20 && count <= 2 * hbvib_branch_points(mode));
    for (i = 0; i < count; i++) {
        double size = hypot(response[2 * i], response[2 * i + 1]);
        EXPECT("curve", i == 0 || omega[i] > omega[i - 1]);
        if (size > largest) {
            largest = size;
            best = i;
        }
    }
    EXPECT("curve", best > 0 && best < count - 1 && largest <= peak_a && largest > 0.98 * peak_a);
    /* Well below resonance in phase with the force, well above against it. */
    EXPECT("curve", fabs(response[1]) < 0.1 * response[0] && response[2 * count - 2] < 0);
    EXPECT("curve", modal[best] > modal[0] && modal[best] > modal[count - 1]);

    /* Twice the force by the option is twice the force in the model. */
    {
        hbvib_synthesis_options o = synthesis_options();
        hbvib_model *doubled = NULL;
        double by_option = 0, by_model = 0;
        o.force_factor = 2;
        WORKS("factor", hbvib_model_clone(the_model, &doubled));
        WORKS("factor", hbvib_model_add_force(doubled, 0, 1, 5, 0));
        WORKS("factor", hbvib_model_add_force(doubled, 1, 1, 5, 0));
        WORKS("factor", hbvib_branch_synthesis_peaks(mode, the_model, &o, 1, NULL, &by_option, NULL, NULL, NULL, NULL, NULL, &count));
        WORKS("factor", hbvib_branch_synthesis_peaks(mode, doubled, NULL, 1, NULL, &by_model, NULL, NULL, NULL, NULL, NULL, &count));
        EXPECT("factor", fabs(by_option / by_model - 1) < 1e-12 && by_option > 1.5 * peak_a);
        WORKS("factor", hbvib_model_free(doubled));
        o = synthesis_options();
        o.damping_ratio = 1e-3;
        WORKS("damping", hbvib_branch_synthesis_peaks(mode, the_model, &o, 1, NULL, &by_option, NULL, NULL, NULL, NULL, NULL, &count));
        EXPECT("damping", by_option < peak_a);
        o.damping_ratio = 0;
        o.force_factor = 1e9;
        WORKS("far", hbvib_branch_synthesis_peaks(mode, the_model, &o, 0, NULL, NULL, NULL, NULL, NULL, NULL, NULL, &count));
        EXPECT("far", count == 0);
    }
}

static void bad_input(hbvib_branch *mode)
{
    hbvib_synthesis_options o = synthesis_options();
    hbvib_model *other = NULL;
    hbvib_branch *forced = NULL;
    hbvib_forced_options range = frequencies(208, 208);
    hbvib_matrix m = matrix(NDOF, MASS);
    double x[8] = {77, 77, 77, 77, 77, 77, 77, 77};
    int32_t flag = 77;
    int64_t count = -1;

    REFUSED("NULL", hbvib_synthesis_options_init(NULL, sizeof o), HBVIB_E_NULL, 1, "hbvib_synthesis_options");
    REFUSED("size", hbvib_synthesis_options_init(&o, 16), HBVIB_E_STRUCT_SIZE, 2, "needs 24");
    REFUSED("NULL", hbvib_branch_synthesis(NULL, the_model, NULL, 0, NULL, NULL, NULL, &count), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("NULL", hbvib_branch_synthesis(mode, NULL, NULL, 0, NULL, NULL, NULL, &count), HBVIB_E_HANDLE, 2, "NULL");
    REFUSED("NULL", hbvib_branch_synthesis(mode, the_model, NULL, 0, NULL, NULL, NULL, NULL), HBVIB_E_NULL, 8, "count");
    REFUSED("NULL", hbvib_branch_synthesis_peaks(NULL, the_model, NULL, 0, NULL, NULL, NULL, NULL, NULL, NULL, NULL, &count), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("NULL", hbvib_branch_synthesis_peaks(mode, the_model, NULL, 0, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL), HBVIB_E_NULL, 12, "count");
    REFUSED("capacity", hbvib_branch_synthesis(mode, the_model, NULL, -1, x, NULL, NULL, &count), HBVIB_E_DIMENSION, 4, "capacity");
    REFUSED("capacity", hbvib_branch_synthesis(mode, the_model, NULL, 1, x, NULL, NULL, &count), HBVIB_E_DIMENSION, 4, "capacity = 1");
    EXPECT("capacity", count > 20 && x[0] == 77);
    REFUSED("capacity", hbvib_branch_synthesis_peaks(mode, the_model, NULL, 0, NULL, NULL, NULL, NULL, NULL, NULL, &flag, &count), HBVIB_E_DIMENSION, 4, "capacity = 0, needs 1");
    EXPECT("capacity", count == 1 && flag == 77);
    REFUSED("misaligned", hbvib_branch_synthesis(mode, the_model, NULL, 1, (double *)((char *)x + 4), NULL, NULL, &count), HBVIB_E_ARGUMENT, 5, "misaligned");
    {
        static double both[3 * CAPACITY];
        REFUSED("overlap", hbvib_branch_synthesis(mode, the_model, NULL, CAPACITY, both, both + 2, NULL, &count), HBVIB_E_ARGUMENT, 6, "overlap");
        EXPECT("overlap", both[0] == 0);
    }
    o.struct_size = 8;
    REFUSED("size", hbvib_branch_synthesis(mode, the_model, &o, 0, NULL, NULL, NULL, &count), HBVIB_E_STRUCT_SIZE, 3, "hbvib_synthesis_options_init");
    o = synthesis_options();
    o.model_damping = 2;
    REFUSED("flag", hbvib_branch_synthesis(mode, the_model, &o, 0, NULL, NULL, NULL, &count), HBVIB_E_ARGUMENT, 3, "model_damping = 2");
    o = synthesis_options();
    o.force_factor = 0;
    REFUSED("factor", hbvib_branch_synthesis(mode, the_model, &o, 0, NULL, NULL, NULL, &count), HBVIB_E_ARGUMENT, 3, "force_factor = 0");
    o.force_factor = NAN;
    REFUSED("factor", hbvib_branch_synthesis(mode, the_model, &o, 0, NULL, NULL, NULL, &count), HBVIB_E_NOT_FINITE, 3, "force_factor");
    o = synthesis_options();
    o.damping_ratio = 1;
    REFUSED("ratio", hbvib_branch_synthesis(mode, the_model, &o, 0, NULL, NULL, NULL, &count), HBVIB_E_ARGUMENT, 3, "damping_ratio = 1");

    EXPECT("forced", hbvib_forced_response(the_model, NULL, &range, NULL, &forced) == HBVIB_OK);
    REFUSED("forced", hbvib_branch_synthesis(forced, the_model, NULL, 0, NULL, NULL, NULL, &count), HBVIB_E_UNSUPPORTED, 1, "forced response");
    WORKS("forced", hbvib_branch_free(forced));
    WORKS("wave", hbvib_model_clone(the_model, &other));
    WORKS("wave", hbvib_cyclic_set_wave(other, 3));
    REFUSED("wave", hbvib_branch_synthesis(mode, other, NULL, 0, NULL, NULL, NULL, &count), HBVIB_E_ARGUMENT, 2, "engine order 3");
    WORKS("wave", hbvib_cyclic_set_wave(other, 26));
    WORKS("wave", hbvib_branch_synthesis(mode, other, NULL, 0, NULL, NULL, NULL, &count));
    WORKS("force", hbvib_model_clear_forces(other));
    REFUSED("force", hbvib_branch_synthesis(mode, other, NULL, 0, NULL, NULL, NULL, &count), HBVIB_E_ARGUMENT, 2, "no force");
    WORKS("force", hbvib_model_free(other));
    other = NULL;
    WORKS("other model", hbvib_model_new(NDOF, &other));
    WORKS("other model", hbvib_model_set_matrix(other, HBVIB_MASS, &m));
    REFUSED("other model", hbvib_branch_synthesis(mode, other, NULL, 0, NULL, NULL, NULL, &count), HBVIB_E_DIMENSION, 2, "1 sectors");
    WORKS("other model", hbvib_model_free(other));
}

/* A model in which another degree of freedom is fixed has other unknowns. */
static void another_is_fixed(hbvib_branch *mode)
{
    const int64_t ring[1] = {3};
    hbvib_model *model = NULL;
    int64_t count = 0;
    WORKS("fixed", hbvib_model_clone(the_model, &model));
    WORKS("fixed", hbvib_model_fix(model, 1, ring));
    EXPECT("fixed", hbvib_branch_synthesis(mode, model, NULL, 0, NULL, NULL, NULL, &count) == HBVIB_E_ARGUMENT);
    EXPECT("fixed", strstr(hbvib_last_error(), "are fixed") != NULL);
    WORKS("fixed", hbvib_model_free(model));
}

int main(void)
{
    hbvib_branch *mode;
    begin();
    mode = mode_of(the_model);
    near_the_computed_one(mode);
    bad_input(mode);
    another_is_fixed(mode);
    WORKS("free", hbvib_branch_free(mode));
    WORKS("free", hbvib_model_free(the_model));
    return verdict(60);
}
