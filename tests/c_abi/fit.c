/* Fits, predictions and derivatives of complex amplitudes in C, and what is refused. */
#include "common.h"

enum { N = 5, P = 2 };

static hbvib_parameter parameter(int32_t kind)
{
    hbvib_parameter p;
    if (hbvib_parameter_init(&p, sizeof p) != HBVIB_OK) abort();
    p.kind = kind;
    p.contact = 0;
    return p;
}

int main(void)
{
    const double mass = 1, stiffness = 1, damping = 0.05;
    const double omega[N] = {1.1, 1.15, 1.2, 1.25, 1.3};
    const double sigma[N] = {0.01, 0.01, 0.01, 0.01, 0.01};
    hbvib_matrix m = matrix(1, &mass), k = matrix(1, &stiffness), c = matrix(1, &damping);
    hbvib_model *model = NULL, *fitted = NULL;
    hbvib_branch *branch = NULL;
    hbvib_contact contact;
    hbvib_solver_options solver;
    hbvib_forced_options range;
    hbvib_parameter p[P];
    hbvib_unknown u[P];
    hbvib_data data, wanted;
    hbvib_fit_options options;
    hbvib_fit_info info;
    hbvib_fit_profile_info interval;
    double value[2 * N], derivatives[2 * P], by_omega[2], theta[P], covariance[P * P], residuals[2 * N], values[2 * N];
    double told[2], deviation[2], shift[2], scan[3], loss[3], profiled[3 * P];
    int64_t reasons[P], onset = 7;
    int i;

    WORKS("model", hbvib_model_new(1, &model));
    WORKS("mass", hbvib_model_set_matrix(model, HBVIB_MASS, &m));
    WORKS("stiffness", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &k));
    WORKS("damping", hbvib_model_set_matrix(model, HBVIB_DAMPING, &c));
    WORKS("contact", hbvib_contact_init(&contact, sizeof contact));
    contact.kind = HBVIB_JENKINS;
    contact.dof_a[0] = 0;
    contact.kt = 1;
    contact.mu = 0.3;
    contact.preload = 1;
    WORKS("contact", hbvib_model_add_contact(model, &contact, NULL));
    WORKS("force", hbvib_model_add_force(model, 0, 1, 0.2, 0));
    WORKS("options", hbvib_solver_options_init(&solver, sizeof solver));
    WORKS("options", hbvib_forced_options_init(&range, sizeof range));
    solver.tolerance = 0;
    p[0] = parameter(HBVIB_PARAMETER_KT);
    p[1] = parameter(HBVIB_PARAMETER_MU);
    for (i = 0; i < N; i++) {
        range.omega_start = range.omega_stop = omega[i];
        WORKS("solve", hbvib_forced_response(model, &solver, &range, NULL, &branch));
        WORKS("derivatives", hbvib_response_sensitivity(model, branch, 0, NULL, p, P, derivatives, P, reasons, &onset, &value[2 * i], by_omega,
                                                        NULL));
        EXPECT("derivatives", derivatives[0] != 0 && reasons[0] == HBVIB_DERIVATIVE_EXISTS && onset == -1 && by_omega[0] != 0);
        REFUSED("count", hbvib_response_sensitivity(model, branch, 0, NULL, p, 0, derivatives, 0, NULL, NULL, NULL, NULL, NULL),
                HBVIB_E_DIMENSION, 6, "count = 0");
        REFUSED("length", hbvib_response_sensitivity(model, branch, 0, NULL, p, P, derivatives, 3, NULL, NULL, NULL, NULL, NULL),
                HBVIB_E_DIMENSION, 8, "needs count = 2");
        REFUSED("point", hbvib_response_sensitivity(model, branch, 99, NULL, p, P, derivatives, P, NULL, NULL, NULL, NULL, NULL),
                HBVIB_E_INDEX, 3, "point");
        WORKS("free", hbvib_branch_free(branch));
    }
    for (i = 0; i < P; i++) {
        WORKS("unknown", hbvib_unknown_init(&u[i], sizeof u[i]));
        u[i].has_start = 1;
        u[i].start = i == 0 ? 0.8 : 0.4;
    }
    WORKS("data", hbvib_data_init(&data, sizeof data));
    WORKS("options", hbvib_fit_options_init(&options, sizeof options));
    WORKS("info", hbvib_fit_info_init(&info, sizeof info));
    data.n = N;
    data.x = omega;
    data.value = value;
    data.sigma = sigma;
    WORKS("fit", hbvib_fit(model, &solver, &options, NULL, p, P, u, &data, 1, &info, theta, covariance, 2 * N, residuals, values, &fitted));
    EXPECT("theta", fabs(theta[0] - 1) < 1e-7 && fabs(theta[1] - 0.3) < 1e-7);
    EXPECT("numbers", info.chi2 < 1e-8 && info.data == 2 * N && info.free == P && info.degrees_of_freedom == 2 * N - P);
    EXPECT("covariance", covariance[0] > 0 && covariance[3] > 0 && fabs(covariance[1] - covariance[2]) < 1e-12);
    EXPECT("values", fabs(values[0] - value[0]) < 1e-6 && fabs(residuals[2 * N - 1]) < 1e-4);
    EXPECT("suspicion", info.suspicion == HBVIB_SUSPICION_NONE && info.suspected_factor == 1 && info.slipping == 1);

    WORKS("wanted", hbvib_data_init(&wanted, sizeof wanted));
    wanted.kind = HBVIB_DATA_PEAK;
    wanted.n = 1;
    wanted.x = &omega[2];
    wanted.omega_start = 0.9;
    wanted.omega_stop = 1.5;
    WORKS("predict", hbvib_predict(model, &solver, &wanted, NULL, p, P, theta, covariance, 2, told, deviation, shift));
    EXPECT("peak", told[0] > 0.4 && told[1] > 1.1 && told[1] < 1.4 && deviation[0] > 0 && shift[0] == shift[0]);
    WORKS("free", hbvib_model_free(fitted));

    for (i = 0; i < 3; i++) scan[i] = theta[1] + (i - 1) * 3 * sqrt(covariance[3]);
    WORKS("info", hbvib_fit_profile_info_init(&interval, sizeof interval));
    EXPECT("defaults", interval.unit == 1 && interval.found == 0 && interval.lower == 0);
    WORKS("profile", hbvib_fit_profile(model, &solver, &options, NULL, p, P, u, &data, 1, theta, 1, 3, scan, 1, &interval, loss, profiled));
    EXPECT("loss", loss[0] > 4 && loss[1] < 1e-7 && loss[2] > 4 && interval.found == 3 && interval.best < 1e-8);
    EXPECT("interval", fabs((interval.upper - interval.lower) / (2 * sqrt(covariance[3])) - 1) < 0.1);
    EXPECT("profiled", profiled[1] == scan[0] && profiled[5] == scan[2] && fabs(profiled[2] - 1) < 1e-6);
    REFUSED("number", hbvib_fit_profile(model, &solver, NULL, NULL, p, P, u, &data, 1, theta, 2, 3, scan, 1, &interval, loss, NULL),
            HBVIB_E_INDEX, 11, "number = 2");
    REFUSED("rise", hbvib_fit_profile(model, &solver, NULL, NULL, p, P, u, &data, 1, theta, 1, 3, scan, 0, &interval, loss, NULL),
            HBVIB_E_ARGUMENT, 14, "rise = 0");
    REFUSED("no values", hbvib_fit_profile(model, &solver, NULL, NULL, p, P, u, &data, 1, theta, 1, 0, scan, 1, &interval, loss, NULL),
            HBVIB_E_DIMENSION, 12, "values_len = 0");
    REFUSED("one room", hbvib_fit_profile(model, &solver, NULL, NULL, p, P, u, &data, 1, theta, 1, 3, scan, 1, &interval, loss, loss),
            HBVIB_E_ARGUMENT, 17, "overlap");

    REFUSED("capacity", hbvib_predict(model, &solver, &wanted, NULL, p, P, theta, covariance, 1, told, NULL, NULL), HBVIB_E_DIMENSION, 9,
            "needs capacity = 2");
    data.kind = 5;
    REFUSED("kind", hbvib_fit(model, &solver, NULL, NULL, p, P, u, &data, 1, &info, theta, NULL, 0, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 8,
            "kind = 5");
    data.kind = HBVIB_DATA_RESPONSE;
    REFUSED("residuals", hbvib_fit(model, &solver, NULL, NULL, p, P, u, &data, 1, &info, theta, NULL, 3, residuals, NULL, NULL),
            HBVIB_E_DIMENSION, 13, "needs residuals_len = 10");
    u[1].scale = 3;
    REFUSED("scale", hbvib_fit(model, &solver, NULL, NULL, p, P, u, &data, 1, &info, theta, NULL, 0, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 7,
            "scale = 3");
    u[1].scale = HBVIB_SCALE_LOG;
    u[1].tied_to = 1;
    REFUSED("tied", hbvib_fit(model, &solver, NULL, NULL, p, P, u, &data, 1, &info, theta, NULL, 0, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 0,
            "tied_to = 1");
    options.starts = 0;
    REFUSED("starts", hbvib_fit(model, &solver, &options, NULL, p, P, u, &data, 1, &info, theta, NULL, 0, NULL, NULL, NULL),
            HBVIB_E_ARGUMENT, 3, "starts = 0");
    REFUSED("sets", hbvib_fit(model, &solver, NULL, NULL, p, P, u, &data, 0, &info, theta, NULL, 0, NULL, NULL, NULL), HBVIB_E_DIMENSION, 9,
            "data_len = 0");
    REFUSED("NULL", hbvib_fit(model, &solver, NULL, NULL, p, P, NULL, NULL, 1, &info, theta, NULL, 0, NULL, NULL, NULL), HBVIB_E_NULL, 8,
            "data");
    WORKS("free", hbvib_model_free(model));
    return failures > 0;
}
