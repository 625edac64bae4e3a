/* A run through a resonance in time, against stored runs of another code; refusals. */
#include "common.h"

static int32_t stop(void *user, const hbvib_progress *progress)
{
    (void)user;
    return progress->point >= 3;
}

int main(void)
{
    const double one[1] = {1}, c[1] = {0.02}, start[4] = {0, 0, 0.05, 0};
    double time[64], omega[64], amplitude[64];
    int64_t turns = -1;
    hbvib_model *model = NULL;
    hbvib_contact contact;
    hbvib_sweep_options o;
    hbvib_sweep_info info;
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
    WORKS("force", hbvib_model_add_force(model, 0, 1, 0.05, 0));
    WORKS("options", hbvib_sweep_options_init(&o, sizeof o));
    WORKS("info", hbvib_sweep_info_init(&info, sizeof info));
    WORKS("hooks", hbvib_hooks_init(&hooks, sizeof hooks));
    o.omega_start = 0.85;
    o.omega_stop = 1.3;
    o.rate = 1e-2;
    WORKS("up", hbvib_time_sweep(model, &o, NULL, 64, time, omega, amplitude, &turns, &info));
    EXPECT("up", fabs(info.largest - 0.5435859808169721) < 1e-9 && info.events == 6);
    EXPECT("turns", turns == 8 && time[0] == 0 && omega[0] == 0.85 && omega[7] < 1.3 && amplitude[7] <= info.largest);
    o.start = start;
    o.start_len = 2;
    WORKS("start", hbvib_time_sweep(model, &o, NULL, 0, NULL, NULL, NULL, NULL, &info));
    EXPECT("start", fabs(info.largest - 0.5435859808169721) < 1e-9);
    o.omega_start = 1.3;
    o.omega_stop = 0.85;
    WORKS("down", hbvib_time_sweep(model, &o, NULL, 64, NULL, NULL, amplitude, NULL, &info));
    EXPECT("down", fabs(info.largest - 0.5509535611974636) < 1e-9 && info.events == 8);
    hooks.progress = stop;
    EXPECT("stopped", hbvib_time_sweep(model, &o, &hooks, 64, time, NULL, NULL, &turns, NULL) == HBVIB_STOPPED_BY_CALLER && turns == 3);
    REFUSED("capacity", hbvib_time_sweep(model, &o, NULL, 2, time, NULL, NULL, &turns, NULL), HBVIB_E_DIMENSION, 4, "capacity = 2");
    o.rate = 0;
    REFUSED("rate", hbvib_time_sweep(model, &o, NULL, 64, time, NULL, NULL, &turns, NULL), HBVIB_E_ARGUMENT, 2, "rate = 0");
    o.rate = 1;
    o.dof = 4;
    REFUSED("dof", hbvib_time_sweep(model, &o, NULL, 64, time, NULL, NULL, &turns, NULL), HBVIB_E_INDEX, 2, "dof = 4");
    WORKS("free", hbvib_model_free(model));
    return failures > 0;
}
