/* Rows 77 to 79: bad options of a nonlinear mode, and models that have none: refused, and the out handle untouched. */
#include "common.h"

static hbvib_branch *const KEPT = (hbvib_branch *)&the_solution;

/* The out handle stays as it is. */
static hbvib_status with(const hbvib_model *model, const hbvib_solver_options *s, const hbvib_mode_options *o)
{
    hbvib_branch *branch = KEPT;
    hbvib_status status = hbvib_nonlinear_mode(model, s, o, NULL, &branch);
    return branch == KEPT ? status : 55;
}

/* A bad value of one field of the options. */
#define BAD(field, value, wanted, words)                                                       \
    do {                                                                                       \
        hbvib_mode_options bad_ = amplitudes(1, 3);                                            \
        bad_.field = (value);                                                                  \
        REFUSED(#field, with(the_model, NULL, &bad_), wanted, 3, words);                       \
    } while (0)

static void bad_options(void)
{
    double numbers[2 * NDOF] = {1, 0, 0, 0, 0, 0, 0, 0};
    hbvib_mode_options o;
    hbvib_solver_options s = solver_options();
    BAD(damping_form, 2, HBVIB_E_ARGUMENT, "damping_form = 2");
    BAD(damping_form, -1, HBVIB_E_ARGUMENT, "damping_form = -1");
    BAD(log10_start, NAN, HBVIB_E_NOT_FINITE, "log10_start = NaN");
    BAD(log10_stop, INFINITY, HBVIB_E_NOT_FINITE, "log10_stop = inf");
    BAD(log10_stop, 1e9, HBVIB_E_ARGUMENT, "log10_stop = 1000000000");
    BAD(mode_index, NDOF, HBVIB_E_INDEX, "mode_index = 4, needs 0 .. 3");
    BAD(mode_index, INT64_MAX, HBVIB_E_INDEX, "mode_index = 9");
    BAD(mode_index, -1, HBVIB_E_INDEX, "mode_index = -1");
    BAD(near_omega, -1, HBVIB_E_ARGUMENT, "near_omega = -1");
    BAD(near_omega, NAN, HBVIB_E_NOT_FINITE, "near_omega = NaN");
    BAD(near_omega, INFINITY, HBVIB_E_NOT_FINITE, "near_omega = inf");
    BAD(amplitude_contact, 1, HBVIB_E_INDEX, "amplitude_contact = 1, needs 0 .. 0 or -1");
    BAD(amplitude_contact, -2, HBVIB_E_INDEX, "amplitude_contact = -2");
    BAD(reference_dof, NDOF, HBVIB_E_INDEX, "reference_dof = 4, needs 0 .. 3 or -1");
    BAD(reference_dof, INT64_MIN, HBVIB_E_INDEX, "reference_dof = -");
    BAD(shape_len, NDOF, HBVIB_E_NULL, "shape is NULL");
    BAD(shape_len, -1, HBVIB_E_DIMENSION, "shape_len = -1");
    BAD(shape, numbers, HBVIB_E_DIMENSION, "shape_len = 0, needs ndof = 4");
    BAD(at_len, 1, HBVIB_E_NULL, "at is NULL");
    BAD(at_len, -1, HBVIB_E_DIMENSION, "at_len = -1");

    WORKS("range", hbvib_mode_options_init(&o, sizeof o)); /* the range was not set */
    REFUSED("range", with(the_model, NULL, &o), HBVIB_E_ARGUMENT, 3, "empty or reversed: log10_start = 0, log10_stop = 0");
    o.log10_start = 1;
    REFUSED("range", with(the_model, NULL, &o), HBVIB_E_ARGUMENT, 3, "empty or reversed");

    o = amplitudes(1, 3);
    o.at = numbers;
    o.at_len = 2;
    numbers[0] = o.log10_start;
    numbers[1] = NAN;
    REFUSED("at", with(the_model, NULL, &o), HBVIB_E_NOT_FINITE, 3, "at[1] = NaN");
    numbers[1] = o.log10_stop + 1;
    REFUSED("at", with(the_model, NULL, &o), HBVIB_E_ARGUMENT, 3, "at[1]");
    o = amplitudes(1, 3);
    o.shape = numbers;
    o.shape_len = 3;
    REFUSED("shape", with(the_model, NULL, &o), HBVIB_E_DIMENSION, 3, "shape_len = 3, needs ndof = 4");
    o.shape_len = NDOF;
    numbers[1] = NAN;
    REFUSED("shape", with(the_model, NULL, &o), HBVIB_E_NOT_FINITE, 3, "shape[0]");
    numbers[0] = numbers[1] = 0;
    REFUSED("shape", with(the_model, NULL, &o), HBVIB_E_ARGUMENT, 3, "shape is zero");
    numbers[0] = 1;
    o.near_omega = 1300;
    REFUSED("shape", with(the_model, NULL, &o), HBVIB_E_ARGUMENT, 3, "near_omega = 1300 and shape");

    o = amplitudes(1, 3);
    o.shape = (const double *)((const char *)numbers + 4);
    o.shape_len = NDOF - 1;
    REFUSED("shape", with(the_model, NULL, &o), HBVIB_E_DIMENSION, 3, "shape_len = 3");
    o.shape_len = NDOF;
    REFUSED("shape", with(the_model, NULL, &o), HBVIB_E_ARGUMENT, 3, "shape = 0x");
    o = amplitudes(1, 3);
    o.at = (const double *)((const char *)numbers + 4);
    o.at_len = 1;
    REFUSED("at", with(the_model, NULL, &o), HBVIB_E_ARGUMENT, 3, "misaligned");

    o = amplitudes(1, 3);
    s.harmonics = 0;
    REFUSED("solver", with(the_model, &s, &o), HBVIB_E_ARGUMENT, 0, "harmonics = 0, a nonlinear mode needs at least 1");
    s = solver_options();
    s.response_dof = 4;
    REFUSED("solver", with(the_model, &s, &o), HBVIB_E_INDEX, 2, "response_dof = 4");
}

/* What only model and options together show. */
static void bad_models(void)
{
    const double indefinite[4] = {1, 2, 2, 1}, loose[4] = {0, 0, 0, 4};
    hbvib_model *model = two_masses(ONES, RISING, 1);
    hbvib_mode_options o;
    WORKS("models", hbvib_mode_options_init(&o, sizeof o));
    o.log10_start = -1;
    o.log10_stop = 1;
    REFUSED("still contact", with(model, NULL, &o), HBVIB_E_ARGUMENT, 0, "moves no contact");
    o.mode_index = 1;
    o.reference_dof = 0;
    REFUSED("node", with(model, NULL, &o), HBVIB_E_ARGUMENT, 0, "reference_dof = 0 is a node");
    WORKS("node", hbvib_model_free(model));

    /* A constant force that friction alone would have to hold. */
    model = two_masses(ONES, loose, 0);
    o.mode_index = 0;
    o.reference_dof = -1;
    WORKS("no static state", hbvib_model_add_force(model, 0, 0, 1e6, 0));
    REFUSED("no static state", with(model, NULL, &o), HBVIB_E_NO_CONVERGENCE, 0, "no static state");
    WORKS("no static state", hbvib_model_free(model));

    model = two_masses(ONES, RISING, 0);
    o.mode_index = 1;
    o.amplitude_contact = 0;
    o.reference_dof = 1;
    REFUSED("still contact", with(model, NULL, &o), HBVIB_E_ARGUMENT, 0, "amplitude_contact = 0: the mode does not move");
    o.mode_index = 2;
    REFUSED("mode_index", with(model, NULL, &o), HBVIB_E_INDEX, 3, "mode_index = 2, needs 0 .. 1");
    o.diameter = 1;
    REFUSED("diameter", with(model, NULL, &o), HBVIB_E_ARGUMENT, 3, "diameter = 1, needs 0 .. 0: a plain structure");
    o.diameter = -1;
    REFUSED("diameter", with(model, NULL, &o), HBVIB_E_ARGUMENT, 3, "diameter = -1, needs 0 .. 0");
    o.diameter = INT64_MAX;
    REFUSED("diameter", with(model, NULL, &o), HBVIB_E_ARGUMENT, 3, "diameter = 9");
    WORKS("still contact", hbvib_model_free(model));

    WORKS("models", hbvib_mode_options_init(&o, sizeof o));
    o.log10_start = -1;
    o.log10_stop = 1;
    model = two_masses(indefinite, RISING, 0);
    REFUSED("indefinite M", with(model, NULL, &o), HBVIB_E_NOT_POSITIVE_DEFINITE, 0, "mass matrix");
    WORKS("indefinite M", hbvib_model_free(model));
    model = two_masses(ONES, loose, 1);
    REFUSED("rigid body", with(model, NULL, &o), HBVIB_E_ARGUMENT, 0, "rigid body");
    WORKS("rigid body", hbvib_model_free(model));
    model = two_masses(ONES, RISING, 2);
    REFUSED("no contact", with(model, NULL, &o), HBVIB_E_ARGUMENT, 0, "moves no contact");
    o.amplitude_contact = 0;
    REFUSED("no contact", with(model, NULL, &o), HBVIB_E_INDEX, 3, "amplitude_contact = 0, needs -1");
    WORKS("no contact", hbvib_model_free(model));
    o.amplitude_contact = -1;
    model = NULL;
    WORKS("no matrices", hbvib_model_new(2, &model));
    REFUSED("no matrices", with(model, NULL, &o), HBVIB_E_ARGUMENT, 0, "no matrices were set");
    WORKS("no matrices", hbvib_model_free(model));
}

int main(void)
{
    begin();
    bad_options();
    bad_models();
    WORKS("free", hbvib_model_free(the_model));
    return verdict(60);
}
