/* Run-ups and missions by the slow flow of a mode, against integration in time; refusals. */
#include "common.h"

static hbvib_cancel_flag raised = 1;

int main(void)
{
    const double one[1] = {1}, c[1] = {0.02}, times[3] = {0, 1e4, 2e4}, speeds[3] = {0.8, 1.3, 0.8}, edges[2] = {0.5, 1}, stress[1] = {80};
    static double time[512], omega[512], amplitude[512], modal[512];
    double cycles[3], damage[1], at[3], passage[12], error = -1;
    int64_t turns = -1, passages = -1;
    hbvib_model *model = NULL;
    hbvib_branch *mode = NULL;
    hbvib_contact contact;
    hbvib_solver_options solver;
    hbvib_mode_options range;
    hbvib_run_up_options o;
    hbvib_run_up_info info;
    hbvib_mission_options m;
    hbvib_sweep_options truth;
    hbvib_sweep_info swept;
    hbvib_campbell_options d;
    const double factors[2] = {0.5, 1};
    double row[6][2];
    hbvib_hooks hooks;
    hbvib_matrix a = matrix(1, one);
    WORKS("model", hbvib_model_new(1, &model));
    WORKS("mass", hbvib_model_set_matrix(model, HBVIB_MASS, &a));
    WORKS("stiffness", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a));
    a = matrix(1, c);
    WORKS("damping", hbvib_model_set_matrix(model, HBVIB_DAMPING, &a));
    WORKS("init", hbvib_contact_init(&contact, sizeof contact));
    contact.kind = HBVIB_JENKINS;
    contact.dof_a[0] = 0;
    contact.kt = 0.2;
    contact.mu = 0.1;
    contact.preload = 1;
    WORKS("contact", hbvib_model_add_contact(model, &contact, NULL));
    WORKS("force", hbvib_model_add_force(model, 0, 1, 0.12, 0));
    WORKS("solver", hbvib_solver_options_init(&solver, sizeof solver));
    solver.harmonics = 5;
    solver.tolerance = 0;
    WORKS("range", hbvib_mode_options_init(&range, sizeof range));
    range.log10_start = -2;
    range.log10_stop = 0.8;
    WORKS("mode", hbvib_nonlinear_mode(model, &solver, &range, NULL, &mode));
    WORKS("options", hbvib_run_up_options_init(&o, sizeof o));
    WORKS("info", hbvib_run_up_info_init(&info, sizeof info));
    WORKS("mission", hbvib_mission_options_init(&m, sizeof m));
    WORKS("truth", hbvib_sweep_options_init(&truth, sizeof truth));
    WORKS("swept", hbvib_sweep_info_init(&swept, sizeof swept));
    WORKS("hooks", hbvib_hooks_init(&hooks, sizeof hooks));
    truth.omega_start = o.omega_start = 0.8;
    truth.omega_stop = o.omega_stop = 1.3;
    truth.rate = o.rate = 1e-3;
    WORKS("sweep", hbvib_time_sweep(model, &truth, NULL, 0, NULL, NULL, NULL, NULL, &swept));
    WORKS("up", hbvib_branch_run_up(mode, model, &o, NULL, 512, time, omega, amplitude, modal, &turns, &info));
    EXPECT("up", fabs(info.largest / swept.largest - 1) < info.error && info.error < 0.01);
    EXPECT("turns", turns == 84 && time[0] == 0 && omega[0] == 0.8 && amplitude[10] > 0 && modal[10] > 0);
    EXPECT("integrated", info.integrated > 0 && info.slow_flow > 0 && fabs(info.slow_flow / info.largest - 1) < 0.01);
    EXPECT("memory", info.without_memory != info.largest && info.steady > info.largest);
    WORKS("nothing wanted", hbvib_branch_run_up(mode, model, &o, NULL, 0, NULL, NULL, NULL, NULL, NULL, NULL));
    REFUSED("capacity", hbvib_branch_run_up(mode, model, &o, NULL, 2, time, NULL, NULL, NULL, &turns, NULL), HBVIB_E_DIMENSION, 5,
            "capacity = 2");
    hooks.cancel = &raised;
    EXPECT("stopped",
           hbvib_branch_run_up(mode, model, &o, &hooks, 512, time, NULL, NULL, NULL, &turns, NULL) == HBVIB_STOPPED_BY_CALLER);
    o.dof = 7;
    REFUSED("dof", hbvib_branch_run_up(mode, model, &o, NULL, 0, NULL, NULL, NULL, NULL, NULL, NULL), HBVIB_E_INDEX, 3, "dof = 7");
    o.dof = 0;
    o.rate = 0;
    REFUSED("rate", hbvib_branch_run_up(mode, model, &o, NULL, 0, NULL, NULL, NULL, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 3, "rate = 0");
    WORKS("diagram", hbvib_campbell_options_init(&d, sizeof d));
    d.engine_order = 2;
    d.acceleration = 5e-4;
    WORKS("resonances", hbvib_campbell_response(mode, model, &d, NULL, 2, factors, row[0], row[1], row[2], row[3], row[4], row[5]));
    EXPECT("speeds", row[1][0] == 2 * row[0][0] && row[1][1] == 2 * row[0][1]);
    /* One is the fundamental, the other the largest displacement. */
    EXPECT("amplitudes", fabs(row[2][1] / info.steady - 1) < 0.01 && row[2][0] < row[2][1] && row[4][1] < row[2][1] && row[4][1] > 0.5 * row[2][1]);
    EXPECT("damping", row[3][1] > 0 && fabs(row[5][1]) < 0.01);
    d.acceleration = -5e-4;
    WORKS("downwards", hbvib_campbell_response(mode, model, &d, NULL, 2, factors, NULL, NULL, NULL, NULL, row[5], NULL));
    EXPECT("another passage", row[5][1] > row[4][1]);
    WORKS("defaults", hbvib_campbell_response(mode, model, NULL, NULL, 1, factors + 1, row[0], NULL, NULL, NULL, row[4], NULL));
    EXPECT("no passage", row[0][0] == row[1][1] && isnan(row[4][0]));
    REFUSED("factors", hbvib_campbell_response(mode, model, &d, NULL, 0, factors, NULL, NULL, NULL, NULL, NULL, NULL), HBVIB_E_DIMENSION, 3,
            "0 factors");
    REFUSED("overlap", hbvib_campbell_response(mode, model, &d, NULL, 2, factors, row[0], row[0], NULL, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 8,
            "omega");
    d.engine_order = -1;
    REFUSED("order", hbvib_campbell_response(mode, model, &d, NULL, 2, factors, NULL, NULL, NULL, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 3,
            "engine_order = -1");
    m.times = times;
    m.speeds = speeds;
    m.points_len = 3;
    m.edges = edges;
    m.edges_len = 2;
    m.stresses = stress;
    m.stresses_len = 1;
    m.woehler_stress = 100;
    m.woehler_cycles = 2e6;
    m.woehler_slope = 5;
    WORKS("flight", hbvib_branch_mission(mode, model, &m, NULL, at, cycles, damage, 2, passage, &passages, &error));
    EXPECT("passages", passages == 2 && passage[0] > 0 && passage[6] > 1e4 && passage[3] > 1 && passage[5] > 10);
    EXPECT("cycles", fabs(cycles[0] + cycles[1] + cycles[2] - 1.05 * 2e4 / 6.283185307179586) < 1e-6);
    EXPECT("damage", damage[0] > 0 && at[0] > 0 && fabs(error) < 0.01);
    REFUSED("room", hbvib_branch_mission(mode, model, &m, NULL, NULL, NULL, NULL, 1, passage, &passages, NULL), HBVIB_E_DIMENSION, 8,
            "capacity = 1");
    m.woehler_slope = 0;
    REFUSED("line", hbvib_branch_mission(mode, model, &m, NULL, NULL, NULL, NULL, 0, NULL, NULL, NULL), HBVIB_E_ARGUMENT, 3,
            "woehler_slope = 0");
    m.points_len = 1;
    REFUSED("points", hbvib_branch_mission(mode, model, &m, NULL, NULL, NULL, NULL, 0, NULL, NULL, NULL), HBVIB_E_DIMENSION, 3, "1 times");
    WORKS("free", hbvib_branch_free(mode));
    WORKS("free", hbvib_model_free(model));
    return failures > 0;
}
