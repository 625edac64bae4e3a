/* Wear over a life: loads, events, best loads; refusals. */
#include "common.h"

enum { CYCLES = 4 };

static int32_t stop(void *user, const hbvib_progress *progress)
{
    int *calls = user;
    ++*calls;
    return progress->parameter > 5;
}

static hbvib_model *oscillator(void)
{
    const double one[1] = {1}, c[1] = {0.05};
    hbvib_model *model = NULL;
    hbvib_contact contact;
    hbvib_matrix a = matrix(1, one);
    WORKS("model", hbvib_model_new(1, &model));
    WORKS("mass", hbvib_model_set_matrix(model, HBVIB_MASS, &a));
    WORKS("stiffness", hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a));
    a = matrix(1, c);
    WORKS("damping", hbvib_model_set_matrix(model, HBVIB_DAMPING, &a));
    WORKS("init", hbvib_contact_init(&contact, sizeof contact));
    contact.kind = HBVIB_JENKINS;
    contact.dof_a[0] = 0;
    contact.kt = 1;
    contact.mu = 0.3;
    contact.preload = 0.6;
    WORKS("contact", hbvib_model_add_contact(model, &contact, NULL));
    WORKS("force", hbvib_model_add_force(model, 0, 1, 0.3, 0));
    return model;
}

int main(void)
{
    const double cycles[CYCLES] = {0, 1, 10, 40}, falling[2] = {2, 1};
    const double rate[1] = {0.05}, stiffness[1] = {1}, frequency[1] = {1.1}, area[1] = {0.5}, negative[1] = {-1};
    const int64_t contacts[1] = {0}, unknown[1] = {3};
    double depths[CYCLES], loads[CYCLES], works[CYCLES], amplitude[CYCLES], omega[CYCLES], when[4];
    int64_t kinds[4], whose[4], events = -1;
    int calls = 0;
    hbvib_model *model = oscillator();
    hbvib_solver_options s;
    hbvib_life_options o, other;
    hbvib_life_info info;
    hbvib_best_load best;
    hbvib_hooks hooks;
    WORKS("solver", hbvib_solver_options_init(&s, sizeof s));
    s.harmonics = 9;
    s.tolerance = 0;
    WORKS("options", hbvib_life_options_init(&o, sizeof o));
    WORKS("info", hbvib_life_info_init(&info, sizeof info));
    WORKS("hooks", hbvib_hooks_init(&hooks, sizeof hooks));
    EXPECT("defaults", o.follow == HBVIB_LIFE_DUTIES && o.tolerance == 1e-4 && o.most_steps == 10000 && o.limit == 0);
    o.contacts = contacts;
    o.rates = rate;
    o.contacts_len = 1;
    o.stiffness = stiffness;
    o.duty_omega = frequency;
    o.duties_len = 1;
    o.tolerance = 1e-8;
    o.limit = 1.3;
    WORKS("life", hbvib_life(model, &s, &o, NULL, CYCLES, cycles, depths, loads, works, amplitude, omega, 4, when, kinds, whose,
                             &events, &info));
    /* Stored rows of another code, H = 9. */
    EXPECT("loads", fabs(loads[1] - 0.5632174692828824) < 1e-7 && fabs(loads[3] - 0.02766582439231759) < 1e-7);
    EXPECT("amplitude", fabs(amplitude[2] - 1.324527610979838) < 1e-6 && omega[2] == 1.1);
    EXPECT("depths", fabs(0.6 - depths[2] - loads[2]) < 1e-14 && works[0] > works[3] && works[3] > 0);
    EXPECT("events", events == 1 && kinds[0] == HBVIB_LIFE_LIMIT && whose[0] == -1 && when[0] > 5 && when[0] < 10);
    EXPECT("info", info.points == CYCLES && info.reached == 40 && info.steps > 3 && info.solutions > info.steps
           && info.largest == info.amplitude_worn && info.amplitude_new == amplitude[0]);
    /* The area divides the rate. */
    o.areas = area;
    WORKS("area", hbvib_life(model, &s, &o, NULL, 1, cycles + 1, NULL, loads, NULL, NULL, NULL, 0, NULL, NULL, NULL, NULL, NULL));
    EXPECT("area", loads[0] < 0.54);
    o.areas = NULL;
    hooks.progress = stop;
    hooks.user = &calls;
    EXPECT("stopped", hbvib_life(model, &s, &o, &hooks, CYCLES, cycles, NULL, loads, NULL, NULL, NULL, 0, NULL, NULL, NULL, NULL,
                                 &info) == HBVIB_STOPPED_BY_CALLER);
    EXPECT("stopped", calls > 0 && info.points >= 2 && info.points < CYCLES && isnan(loads[3]) && loads[1] > 0);
    o.follow = HBVIB_LIFE_PEAK;
    o.omega_start = 0.8;
    o.omega_stop = 1.8;
    o.tolerance = 1e-5;
    WORKS("best init", hbvib_best_load_init(&best, sizeof best));
    WORKS("best", hbvib_best_load_for_life(model, &s, &o, 3, 0.3, 10, NULL, &best));
    EXPECT("best", best.factor > 1 && best.factor < 10 && fabs(best.amplitude_new / best.amplitude_worn - 1) < 1e-4
           && best.lives > 9);
    REFUSED("low", hbvib_best_load_for_life(model, &s, &o, 3, 0, 10, NULL, &best), HBVIB_E_ARGUMENT, 5, "factor_low = 0");
    REFUSED("high", hbvib_best_load_for_life(model, &s, &o, 3, 1, 1, NULL, &best), HBVIB_E_ARGUMENT, 6, "factor_high = 1");
    REFUSED("cycles", hbvib_best_load_for_life(model, &s, &o, 0, 1, 2, NULL, &best), HBVIB_E_ARGUMENT, 4, "cycles = 0");
    REFUSED("order", hbvib_life(model, &s, &o, NULL, 2, falling, NULL, loads, NULL, NULL, NULL, 0, NULL, NULL, NULL, NULL, NULL),
            HBVIB_E_ARGUMENT, 3, "cycles[1] = 1");
    REFUSED("overlap", hbvib_life(model, &s, &o, NULL, 2, cycles, loads, loads, NULL, NULL, NULL, 0, NULL, NULL, NULL, NULL, NULL),
            HBVIB_E_ARGUMENT, 8, "overlap");
    other = o;
    other.contacts = unknown;
    REFUSED("contact", hbvib_life(model, &s, &other, NULL, 1, cycles, NULL, loads, NULL, NULL, NULL, 0, NULL, NULL, NULL, NULL, NULL),
            HBVIB_E_INDEX, 3, "contact = 3");
    other = o;
    other.rates = negative;
    REFUSED("rate", hbvib_life(model, &s, &other, NULL, 1, cycles, NULL, loads, NULL, NULL, NULL, 0, NULL, NULL, NULL, NULL, NULL),
            HBVIB_E_ARGUMENT, 3, "rate = -1");
    other = o;
    other.follow = 2;
    REFUSED("follow", hbvib_life(model, &s, &other, NULL, 1, cycles, NULL, loads, NULL, NULL, NULL, 0, NULL, NULL, NULL, NULL, NULL),
            HBVIB_E_ARGUMENT, 3, "follow = 2");
    hbvib_model_free(model);
    return failures > 0;
}
