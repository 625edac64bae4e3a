/* Bytes that a call may take at one time, as docs/memory.md tells them. */
#ifndef PREDICTED_NEED_H
#define PREDICTED_NEED_H

#include "models.h"

static const double KIB = 1024, MIB = 1048576;

/* Sizes of a model from which the need of a call follows. */
typedef struct sizes {
    int64_t dofs;    /* n */
    int64_t wheel;   /* n times the number of sectors */
    int64_t saved;   /* bytes of the saved model */
    double squares;  /* sum of d^2 over the contacts */
    double motions;  /* m, the sum of d */
    double most;     /* the largest d */
    int sampled;     /* whether a law is sampled by itself */
} sizes;

static int64_t directions(const hbvib_contact *c)
{
    switch (c->kind) {
    case HBVIB_FRICTION_2D: return c->kn == 0 ? 1 : 2;
    case HBVIB_FRICTION_3D: return c->kn == 0 ? 2 : 3;
    case HBVIB_POLYNOMIAL: return 2; /* those of models.h, and one by random_calls.c */
    default: return 1;
    }
}

/* Of no model where the handle is not that of one. */
static sizes sizes_of(const hbvib_model *model)
{
    sizes s = {0, 0, 0, 0, 0, 0, 0};
    const int64_t contacts = hbvib_model_contacts(model);
    int64_t i;
    hbvib_contact c;
    if (contacts < 0) return s;
    s.dofs = hbvib_model_dofs(model);
    s.wheel = s.dofs * hbvib_model_sectors(model);
    if (hbvib_model_save(model, 0, NULL, &s.saved) != HBVIB_OK) s.saved = 64 * s.dofs * s.dofs + 1024 * (contacts + 8);
    for (i = 0; i < contacts; i++) {
        double d;
        memset(&c, 0, sizeof c);
        if (hbvib_contact_init(&c, sizeof c) != HBVIB_OK || hbvib_model_contact(model, i, &c, NULL) < 0) continue;
        d = (double)directions(&c);
        s.sampled |= c.kind == HBVIB_REGULARISED || c.kind == HBVIB_POLYNOMIAL || c.kind == HBVIB_CALLER_LAW;
        s.squares += d * d;
        s.motions += d;
        if (d > s.most) s.most = d;
    }
    return s;
}

static double larger(double a, double b) { return a > b ? a : b; }
static double smaller(double a, double b) { return a < b ? a : b; }

/* Highest harmonic and samples that a solve may use; options beyond the ranges are refused. */
static double within(int64_t value, double most) { return smaller(larger((double)value, 0), most); }
static double highest(const hbvib_solver_options *o) { return within(o->tolerance > 0 ? o->max_harmonics : o->harmonics, 1e5); }
static double most_samples(const hbvib_solver_options *o) { return within(o->samples, 1 << 24); }

/* The same for results of points: with a tolerance the samples of laws that have their own are refined up to 64 times. */
static double samples_of_results(const sizes *s, const hbvib_solver_options *o)
{
    if (o->tolerance > 0 && o->samples == 0 && s->sampled) return 64 * 128 * (highest(o) + 1);
    return most_samples(o);
}

/* Of the path of friction in a plane. */
static double need_of_a_path(double h) { return smaller(2 * MIB * (h + 1), 256 * MIB + 64 * KIB * (h + 1)); }

/* Of a law with d motions, as the header tells for hbvib_contact_evaluate. */
static double need_of_a_law(double d, double h, double samples)
{
    const double law = 8 * (1 + d) * 4 * d * d * (h + 1) * (h + 1) + 250 * larger(samples, 128 * (h + 1)) + MIB;
    return d > 1 ? law + need_of_a_path(h) : law;
}

/* The same without a Jacobian. */
static double need_of_a_force(const hbvib_contact *c, double h, double samples)
{
    const double own = c->kind == HBVIB_REGULARISED ? 128 * (h + 1) : 0, d = (double)directions(c);
    return 2560 * d * (h + 1) + 250 * larger(samples, own) + MIB + (c->kind == HBVIB_FRICTION_3D ? need_of_a_path(h) : 0);
}

/* Of the equations of a point, which memory_limit bounds. */
static double need_of_equations(const sizes *s, double h, double samples)
{
    const double p = 2 * h + 1, n = s->motions * p, times = s->sampled ? larger(2 * samples, 128 * (h + 1)) : samples;
    return 16 * n * n + 24 * p * p * s->squares + 8 * (1 + s->most) * s->most * s->most * p * p +
           (16 * p + 300) * s->most * times;
}

/* Of the structure without a basis; most of it counts for memory_limit, too. */
static double need_of_structure(const sizes *s, double h)
{
    const double n = (double)s->dofs;
    return (h + 1) * (96 * n * n + 128 * (n + s->motions) + 2 * KIB) + 400 * n * n;
}

static double need_of_linear_modes(const sizes *s)
{
    return 400 * (double)s->dofs * (double)s->dofs + 512 * KIB + 800 * s->squares;
}

/* Of the static state, about which modes may be asked for. */
static double need_at_rest(const sizes *s) { return 6 * KIB * s->motions; }

/* Of building, changing, copying, saving and loading a model. */
static double need_of_a_change(const sizes *s) { return 16 * KIB + 8 * (double)s->saved; }

/* Of a result of a point. */
static double need_of_a_result(const sizes *s, double h, double samples)
{
    return need_of_a_law(s->most, h, samples) + 64 * (h + 1) * ((double)s->dofs + s->motions);
}

/* Of the equations of a stored point and of its structure, for derivatives at it. */
static double need_of_a_branch_point(const sizes *s, double h, double samples)
{
    return 4 * need_of_equations(s, h, samples) + 4 * need_of_structure(s, h) + 16 * MIB;
}

/* Numbers that describe the state of the whole wheel with its contacts, and some. */
static double states_of(const sizes *s)
{
    const double sectors = s->dofs > 0 ? (double)s->wheel / (double)s->dofs : 1;
    return 2 * (double)s->wheel + 4 * s->motions * sectors + 8;
}

/* Of integration in time over the whole wheel. */
static double need_in_time(const sizes *s, double h)
{
    const double states = states_of(s);
    return 80 * states * states + 64 * (h + 1) * (double)s->wheel + MIB;
}

/* Of Floquet multipliers. */
static double need_of_multipliers(const sizes *s, double h)
{
    const double states = states_of(s);
    return need_in_time(s, h) + 160 * states * states;
}

/* Of a forced response or a nonlinear mode with at most so many points. Stability along a response is that of its points, each
 * after the other: shooting has matrices of the whole wheel, whatever the size of a sector. */
static double need_of_a_branch(const sizes *s, const hbvib_solver_options *o, double points)
{
    const int automatic = o->tolerance > 0;
    const double h = highest(o), samples = most_samples(o);
    const double limit = o->memory_limit > 0 ? (double)o->memory_limit : HUGE_VAL;
    const double equations = smaller(limit, need_of_equations(s, h, samples));
    const double estimate = automatic || o->estimate_error ? smaller(limit, 100e6 + 4 * equations) : 0;
    const double pieces = s->most > 1 ? need_of_a_path(h) : 0;
    const double stability = o->stability != HBVIB_STABILITY_NONE ? need_of_multipliers(s, h) : 0;
    return need_of_structure(s, h) + (automatic ? 4 : 2) * equations + estimate + pieces + stability +
           points * (48 * (h + 1) * ((double)s->dofs + s->motions) + 512) + need_of_linear_modes(s) + 2 * MIB;
}

#endif
