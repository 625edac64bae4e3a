/* Stiffness and friction of a joint from measured responses, in C: complex amplitudes of a chain of
 * two masses under three forces, of which the first mass rubs on the ground. Prints the parameters
 * with their standard deviations, the resonance predicted at another force, and the interval of
 * the friction limit by the profile of the likelihood.
 *
 *   sh examples/install.sh $HOME/hbvib
 *   make -C examples/c PKG_CONFIG_PATH=$HOME/hbvib/lib/pkgconfig
 *   examples/c/fit_joint examples/data/joint.csv
 */
#include "hbvib.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { NDOF = 2, P = 4, LEVELS = 3, MOST = 100, SCAN = 9 };

/* Data of a test at one force. */
typedef struct {
    double force, omega[MOST], value[2 * MOST], sigma[MOST];
    int64_t n;
} level;

/* Ends the program with the error sentence of the library if a call failed. */
static void check(hbvib_status status, const char *call)
{
    if (status == HBVIB_OK) return;
    fprintf(stderr, "%s: %s (argument %d): %s\n", call, hbvib_status_name(status),
            (int)hbvib_last_error_argument(), hbvib_last_error());
    exit(EXIT_FAILURE);
}
#define CHECK(call) check((call), #call)

/* Reads rows of force, omega, re, im and sigma; the force tells the level. */
static int read_levels(const char *path, level levels[LEVELS])
{
    FILE *file = fopen(path, "r");
    double force, omega, re, im, sigma;
    int count = 0;
    if (!file) {
        fprintf(stderr, "%s cannot be read\n", path);
        exit(EXIT_FAILURE);
    }
    if (fscanf(file, "%*[^\n]") != 0) exit(EXIT_FAILURE); /* names of the columns */
    while (fscanf(file, "%lf,%lf,%lf,%lf,%lf", &force, &omega, &re, &im, &sigma) == 5) {
        level *to;
        if (count == 0 || levels[count - 1].force != force) {
            if (count == LEVELS) break;
            levels[count].force = force;
            levels[count++].n = 0;
        }
        to = &levels[count - 1];
        if (to->n == MOST) break;
        to->omega[to->n] = omega;
        to->value[2 * to->n] = re;
        to->value[2 * to->n + 1] = im;
        to->sigma[to->n++] = sigma;
    }
    fclose(file);
    return count;
}

static hbvib_model *chain(void)
{
    const double mass[NDOF][NDOF] = {{1, 0}, {0, 0.5}};
    const double stiffness[NDOF][NDOF] = {{1.5, -0.5}, {-0.5, 0.5}};
    hbvib_matrix m, k;
    hbvib_contact joint;
    hbvib_model *model = NULL;
    CHECK(hbvib_matrix_init(&m, sizeof m));
    m.rows = m.cols = NDOF;
    k = m;
    m.values = &mass[0][0];
    k.values = &stiffness[0][0];
    CHECK(hbvib_model_new(NDOF, &model));
    CHECK(hbvib_model_set_matrix(model, HBVIB_MASS, &m));
    CHECK(hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &k));
    CHECK(hbvib_model_set_rayleigh(model, 0, 0.01));
    CHECK(hbvib_contact_init(&joint, sizeof joint));
    joint.kind = HBVIB_JENKINS;
    joint.dof_a[0] = 0;
    joint.kt = 0.5; /* guesses */
    joint.mu = 0.08;
    joint.preload = 1;
    CHECK(hbvib_model_add_contact(model, &joint, NULL));
    CHECK(hbvib_model_add_force(model, 1, 1, 1, 0));
    return model;
}

int main(int argc, char **argv)
{
    static level levels[LEVELS];
    static const char *const names[P] = {"kt", "friction limit", "damping factor", "stiffness factor"};
    const int sets = read_levels(argc > 1 ? argv[1] : "../data/joint.csv", levels);
    const int64_t measured = 1;
    const double near = 0.72;
    hbvib_model *model = chain();
    hbvib_solver_options solver;
    hbvib_response response;
    hbvib_data data[LEVELS], wanted;
    hbvib_parameter parameters[P];
    hbvib_unknown unknowns[P];
    hbvib_fit_info info;
    hbvib_fit_profile_info interval;
    double theta[P], covariance[P * P], peak[2], deviation[2], scan[SCAN];
    int i;

    CHECK(hbvib_solver_options_init(&solver, sizeof solver));
    solver.tolerance = 0; /* fixed harmonics: exactly H = 9 */
    solver.harmonics = 9;
    CHECK(hbvib_response_init(&response, sizeof response));
    response.n = 1;
    response.dofs = &measured;
    for (i = 0; i < sets; i++) {
        CHECK(hbvib_data_init(&data[i], sizeof data[i]));
        data[i].force_factor = levels[i].force;
        data[i].response = &response;
        data[i].n = levels[i].n;
        data[i].x = levels[i].omega;
        data[i].value = levels[i].value;
        data[i].sigma = levels[i].sigma;
    }
    for (i = 0; i < P; i++) {
        CHECK(hbvib_parameter_init(&parameters[i], sizeof parameters[i]));
        CHECK(hbvib_unknown_init(&unknowns[i], sizeof unknowns[i]));
    }
    parameters[0].kind = HBVIB_PARAMETER_KT;
    parameters[1].kind = HBVIB_PARAMETER_MU;
    parameters[0].contact = parameters[1].contact = 0;
    parameters[2].kind = HBVIB_PARAMETER_DAMPING;
    parameters[3].kind = HBVIB_PARAMETER_STIFFNESS;
    parameters[2].scaling = parameters[3].scaling = HBVIB_SCALING_FACTOR;
    unknowns[2].has_start = 1;
    unknowns[2].start = 2;
    CHECK(hbvib_fit_info_init(&info, sizeof info));
    CHECK(hbvib_fit(model, &solver, NULL, NULL, parameters, P, unknowns, data, sets, &info, theta, covariance, 0, NULL, NULL, NULL));
    for (i = 0; i < P; i++) printf("%-16s  %19.12E  +- %16.9E\n", names[i], theta[i], sqrt(covariance[i * P + i]));
    printf("%-16s  %19.12E  on %d\n", "chi2", info.chi2, (int)info.degrees_of_freedom);

    CHECK(hbvib_data_init(&wanted, sizeof wanted));
    wanted.kind = HBVIB_DATA_PEAK;
    wanted.force_factor = 0.1;
    wanted.response = &response;
    wanted.omega_start = 0.6;
    wanted.omega_stop = 0.9;
    wanted.n = 1;
    wanted.x = &near;
    CHECK(hbvib_predict(model, &solver, &wanted, NULL, parameters, P, theta, covariance, 2, peak, deviation, NULL));
    printf("%-16s  %19.12E  +- %16.9E\n", "peak at 0.1", peak[0], deviation[0]);

    for (i = 0; i < SCAN; i++) scan[i] = theta[1] + (0.75 * i - 3) * sqrt(covariance[P + 1]);
    CHECK(hbvib_fit_profile_info_init(&interval, sizeof interval));
    CHECK(hbvib_fit_profile(model, &solver, NULL, NULL, parameters, P, unknowns, data, sets, theta, 1, SCAN, scan, 3.841, &interval,
                            NULL, NULL));
    printf("%-16s  %16.9E .. %16.9E\n", "95 % of friction", interval.lower, interval.upper);
    CHECK(hbvib_model_free(model));
    return EXIT_SUCCESS;
}
