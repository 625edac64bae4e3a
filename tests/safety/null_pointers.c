/* Calls functions with one pointer that is NULL. The calls are generated from the header (null_pointers.rs). Prints their
 * number and that of the failures, each of which is explained. */
#include "models.h"

#include <stdio.h>
#include <stdlib.h>

static hbvib_model *model, *wheel, *new_model;
static hbvib_branch *branch, *backbone, *new_branch;
static hbvib_batch *batch, *new_batch;
static hbvib_cancel_flag flag;
static double buffers[20][8192];
static int calls, refused, failures;

static void complain(const char *what, int64_t status)
{
    failures++;
    printf("NULL for %s: status %lld, argument %d, \"%s\"\n", what, (long long)status, (int)hbvib_last_error_argument(), hbvib_last_error());
}

/* Judges the status of a call, and frees what it made. An accepted pointer may be NULL. */
static void try(int64_t status, int accepted, int handle, int argument, const char *what)
{
    calls++;
    refused += status < 0;
    if (status == HBVIB_E_INTERNAL) complain(what, status);
    else if (!accepted && status != (handle ? HBVIB_E_HANDLE : HBVIB_E_NULL)) complain(what, status);
    /* hbvib_cancel does not touch the last error. */
    else if (!accepted && hbvib_last_error_argument() != argument && strncmp(what, "hbvib_cancel", 12) != 0) complain(what, status);
    if (hbvib_model_free(new_model) != HBVIB_OK || hbvib_branch_free(new_branch) != HBVIB_OK || hbvib_batch_free(new_batch) != HBVIB_OK)
        complain(what, status);
    new_model = NULL;
    new_branch = NULL;
    new_batch = NULL;
}

#include "calls.h"

/* A model with a contact, a wheel, and results of the model. */
static hbvib_status prepare(void)
{
    static const double value = 0.1, at = 1.25;
    static const int64_t dof = 0, other = 2;
    hbvib_contact c = law(HBVIB_JENKINS, 1, HBVIB_GROUND, HBVIB_GROUND);
    hbvib_status status;
    c.kt = 0.5;
    c.mu = c.preload = 0.4;
    status = caller_law(&model);
    STEP(hbvib_model_add_contact(model, &c, NULL));
    STEP(hbvib_model_add_springs(model, 1, &dof, &other, NULL, &value));
    STEP(faces(&wheel));
    an_hbvib_solver_options.tolerance = 0;
    an_hbvib_solver_options.harmonics = 3;
    an_hbvib_forced_options.omega_start = an_hbvib_batch_options.omega_start = 1.2;
    an_hbvib_forced_options.omega_stop = an_hbvib_batch_options.omega_stop = 1.3;
    an_hbvib_forced_options.at = &at;
    an_hbvib_forced_options.at_len = 1;
    an_hbvib_parameter_options.parameter = &an_hbvib_parameter;
    an_hbvib_parameter_options.start = 1;
    an_hbvib_parameter_options.stop = 1.1;
    an_hbvib_parameter_options.omega = 1.2;
    an_hbvib_mode_options.log10_start = -1;
    an_hbvib_mode_options.log10_stop = -0.5;
    STEP(hbvib_forced_response(model, &an_hbvib_solver_options, &an_hbvib_forced_options, NULL, &branch));
    STEP(hbvib_nonlinear_mode(model, &an_hbvib_solver_options, &an_hbvib_mode_options, NULL, &backbone));
    STEP(hbvib_batch_solve(model, &an_hbvib_solver_options, &an_hbvib_batch_options, NULL, &an_hbvib_parameter, 1, 1, &value, &batch));
    an_hbvib_solver_options.harmonics = 9;
    an_hbvib_time_options.omega = 1.2;
    an_hbvib_time_options.samples = 64;
    an_hbvib_contact = c;
    return status;
}

int main(void)
{
    hbvib_status status;
    fill();
    status = prepare();
    if (status < 0) {
        printf("%s\n", hbvib_last_error());
        return 2;
    }
    all();
    if (hbvib_model_free(model) < 0 || hbvib_model_free(wheel) < 0 || hbvib_branch_free(branch) < 0 || hbvib_branch_free(backbone) < 0 ||
        hbvib_batch_free(batch) < 0)
        return 3;
    printf("%d calls, %d refused, %d failures\n", calls, refused, failures);
    return 0;
}
