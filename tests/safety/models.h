/* Small models that together have every law, every kind of matrix and every kind of structure. Each function returns the
 * status of the first call that fails, and leaves no model behind then. */
#ifndef MODELS_H
#define MODELS_H

#include "hbvib.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

/* The first failure of a row of calls; later ones are not made. */
#define STEP(call)                                                                             \
    do {                                                                                       \
        if (status >= 0) status = (call);                                                      \
    } while (0)

static hbvib_status finished(hbvib_status status, hbvib_model **model)
{
    if (status < 0 && *model != NULL) {
        if (hbvib_model_free(*model) != HBVIB_OK) return HBVIB_E_INTERNAL;
        *model = NULL;
    }
    return status;
}

static hbvib_matrix dense(int64_t n, const double *values)
{
    hbvib_matrix a;
    memset(&a, 0, sizeof a);
    hbvib_matrix_init(&a, sizeof a);
    a.rows = a.cols = n;
    a.values = values;
    return a;
}

static hbvib_contact law(int32_t kind, int64_t t1, int64_t t2, int64_t n)
{
    hbvib_contact c;
    memset(&c, 0, sizeof c);
    hbvib_contact_init(&c, sizeof c);
    c.kind = kind;
    c.dof_a[0] = t1;
    c.dof_a[1] = t2;
    c.dof_a[2] = n;
    return c;
}

/* One of some sectors with a ring damper. */
static hbvib_status ring_of(int64_t sectors, double damping, hbvib_model **model)
{
    static const double mass[16] = {0.2, 0, 0, 0, 0, 0.3, 0, 0, 0, 0, 1.2, 0, 0, 0, 0, 0.03};
    static const double stiffness[16] = {2e6, -2e6, 0, 0, -2e6, 3e6, -1e6, 0, 0, -1e6, 101.6e6, 0, 0, 0, 0, 4e7};
    static const double coupling[16] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -5e7, 0, 0, 0, 0, -2e7};
    hbvib_matrix m = dense(4, mass), k = dense(4, stiffness), next = dense(4, coupling);
    hbvib_contact c = law(HBVIB_JENKINS, 2, HBVIB_GROUND, HBVIB_GROUND);
    hbvib_status status = hbvib_cyclic_new(4, sectors, model);
    c.dof_b[0] = 3;
    c.kt = 5e7;
    c.mu = 0.3;
    c.preload = 488.5;
    STEP(hbvib_model_set_matrix(*model, HBVIB_MASS, &m));
    STEP(hbvib_model_set_matrix(*model, HBVIB_STIFFNESS, &k));
    STEP(hbvib_cyclic_set_coupling(*model, HBVIB_STIFFNESS, &next));
    STEP(hbvib_model_set_rayleigh(*model, 0, damping));
    STEP(hbvib_cyclic_set_wave(*model, 2));
    STEP(hbvib_model_add_force(*model, 0, 1, 5, 0));
    STEP(hbvib_model_add_force(*model, 1, 1, 5, 0));
    STEP(hbvib_model_add_contact(*model, &c, NULL));
    return finished(status, model);
}

static hbvib_status ring(hbvib_model **model)
{
    return ring_of(24, 1.5e-6, model);
}

static hbvib_status small_ring(hbvib_model **model)
{
    return ring_of(3, 1e-4, model);
}

/* Three masses in a row between walls, lightly damped, with a force on the first. */
static hbvib_status three(hbvib_model **model)
{
    static const double mass[9] = {1, 0, 0, 0, 1.5, 0, 0, 0, 1};
    static const double stiffness[9] = {3, -1, 0, -1, 4, -1, 0, -1, 2.5};
    static const double damping[9] = {0.06, -0.02, 0, -0.02, 0.08, -0.02, 0, -0.02, 0.05};
    hbvib_matrix m = dense(3, mass), k = dense(3, stiffness), d = dense(3, damping);
    hbvib_status status = hbvib_model_new(3, model);
    STEP(hbvib_model_set_matrix(*model, HBVIB_MASS, &m));
    STEP(hbvib_model_set_matrix(*model, HBVIB_STIFFNESS, &k));
    STEP(hbvib_model_set_matrix(*model, HBVIB_DAMPING, &d));
    STEP(hbvib_model_add_force(*model, 0, 1, 0.4, 0));
    return finished(status, model);
}

static hbvib_status with_contact(hbvib_model **model, const hbvib_contact *c)
{
    hbvib_status status = three(model);
    STEP(hbvib_model_add_contact(*model, c, NULL));
    return finished(status, model);
}

static hbvib_status friction_2d(hbvib_model **model)
{
    hbvib_contact c = law(HBVIB_FRICTION_2D, 1, HBVIB_GROUND, 2);
    c.kt = 1;
    c.kn = 0.7;
    c.mu = 0.4;
    c.preload = 0.3;
    return with_contact(model, &c);
}

static hbvib_status friction_3d(hbvib_model **model)
{
    hbvib_contact c = law(HBVIB_FRICTION_3D, 0, 1, 2);
    c.kt = 1;
    c.kn = 0.7;
    c.mu = 0.4;
    c.preload = 0.3;
    return with_contact(model, &c);
}

static hbvib_status unilateral(hbvib_model **model)
{
    hbvib_contact c = law(HBVIB_UNILATERAL, HBVIB_GROUND, HBVIB_GROUND, 1);
    hbvib_status status;
    c.kn = 2;
    c.gap = -0.05;
    status = with_contact(model, &c);
    STEP(hbvib_model_add_force(*model, 1, 0, -0.05, 0));
    return finished(status, model);
}

static hbvib_status cubic(hbvib_model **model)
{
    hbvib_contact c = law(HBVIB_CUBIC, 1, HBVIB_GROUND, HBVIB_GROUND);
    c.dof_b[0] = 2;
    c.kt = 0.1;
    c.cubic = 0.5;
    return with_contact(model, &c);
}

static hbvib_status regularised(hbvib_model **model)
{
    hbvib_contact c = law(HBVIB_REGULARISED, 1, HBVIB_GROUND, HBVIB_GROUND);
    c.mu = 0.3;
    c.preload = 0.2;
    c.velocity = 0.05;
    return with_contact(model, &c);
}

static hbvib_status iwan(hbvib_model **model)
{
    hbvib_status status = three(model);
    STEP(hbvib_model_add_iwan(*model, 1, 2, 0, 0.1, 1, -0.5, 0.2, 8, NULL));
    return finished(status, model);
}

static hbvib_status table(hbvib_model **model)
{
    static const double y[4] = {-0.2, -0.1, 0.1, 0.2}, f[4] = {-0.5, -0.1, 0.1, 0.5};
    hbvib_status status = three(model);
    STEP(hbvib_model_add_table(*model, 1, HBVIB_GROUND, 0, 4, y, f, NULL));
    return finished(status, model);
}

static hbvib_status polynomials(hbvib_model **model)
{
    static const double spring[3] = {0.1, 0, 0.3}, damper[3] = {0, 0, 0.05}, coefficient[2] = {0.2, 0.2};
    static const double quadratic[8] = {0.01, 0, 0, 0.02, 0, 0.02, 0.02, 0}, tensor[16] = {0.3};
    static const int64_t dofs[2] = {1, 2}, direction[2] = {0, 1};
    static const int32_t powers[4] = {2, 1, 1, 2};
    hbvib_status status = three(model);
    STEP(hbvib_model_add_spring_damper(*model, 0, HBVIB_GROUND, 0, 3, spring, 3, damper, NULL));
    STEP(hbvib_model_add_polynomial(*model, dofs, 2, 2, direction, coefficient, powers, NULL, NULL));
    STEP(hbvib_model_add_stiffness_tensors(*model, dofs, 2, quadratic, tensor, NULL));
    return finished(status, model);
}

/* u + u^3 and a lag of first order, dz/dt = (u - z) / 2, by the trapezoidal rule. */
static int32_t spring_and_lag(void *user, const hbvib_force_call *call)
{
    const double dt = 2 * 3.14159265358979323846 / (call->omega * (double)call->samples), a = dt / 4;
    int64_t j;
    (void)user;
    for (j = 0; j < call->samples; j++) {
        const int64_t last = j == 0 ? call->samples - 1 : j - 1;
        const double u = call->u[j], before = call->u[last], z0 = j == 0 ? call->z0[0] : call->z[j - 1];
        const double z = ((1 - a) * z0 + a * (before + u)) / (1 + a);
        call->z[j] = z;
        call->dz_dz[j] = (1 - a) / (1 + a);
        call->dz_du[j] = call->dz_du_before[j] = a / (1 + a);
        call->dz_domega[j] = -a / call->omega * ((before + u - z0) / (1 + a) - ((1 - a) * z0 + a * (before + u)) / ((1 + a) * (1 + a)));
        call->f[j] = 0.1 * u * u * u + 0.05 * (u - z);
        call->df_du[j] = 0.3 * u * u + 0.05;
        call->df_dz[j] = -0.05;
    }
    return 0;
}

static hbvib_status caller_law(hbvib_model **model)
{
    static const int64_t dofs[1] = {1};
    hbvib_user_force o;
    hbvib_status status = three(model);
    memset(&o, 0, sizeof o);
    hbvib_user_force_init(&o, sizeof o);
    o.dofs = dofs;
    o.n = o.states = 1;
    o.is_odd = 1;
    o.force = spring_and_lag;
    STEP(hbvib_model_add_user_force(*model, &o, NULL));
    return finished(status, model);
}

static hbvib_status rotor(hbvib_model **model)
{
    static const double gyroscopic[9] = {0, 0.4, 0, -0.4, 0, 0, 0, 0, 0}, soft[9] = {-0.01, 0, 0, 0, -0.01, 0, 0, 0, 0};
    static const int64_t a[1] = {0}, b[1] = {2}, fixed[1] = {2};
    static const double stiffness[1] = {0.3}, ratios[2] = {0.01, 0.02};
    hbvib_matrix g = dense(3, gyroscopic), k1 = dense(3, soft);
    hbvib_contact c = law(HBVIB_JENKINS, 1, HBVIB_GROUND, HBVIB_GROUND);
    hbvib_status status = three(model);
    c.kt = 0.5;
    c.mu = c.preload = 0.4;
    g.part = HBVIB_GENERAL;
    STEP(hbvib_model_set_matrix(*model, HBVIB_GYROSCOPIC, &g));
    STEP(hbvib_model_set_matrix(*model, HBVIB_STIFFNESS_SPEED2, &k1));
    STEP(hbvib_model_add_springs(*model, 1, a, b, NULL, stiffness));
    STEP(hbvib_model_fix(*model, 1, fixed));
    STEP(hbvib_model_set_modal_damping(*model, 2, ratios));
    STEP(hbvib_model_add_unbalance(*model, 0, 1, 0.1, 0.2));
    STEP(hbvib_model_add_contact(*model, &c, NULL));
    STEP(hbvib_model_set_preload_at_speed(*model, 0, 0.1, 0.05));
    STEP(hbvib_model_set_speed(*model, 0.6));
    return finished(status, model);
}

enum { LONG = 30 };

/* A chain of 30 masses, sparse, with two contacts. */
static hbvib_status chain(hbvib_model **model)
{
    static int64_t start[LONG + 1], row[3 * LONG], one[LONG + 1], diagonal[LONG];
    static double k[3 * LONG], m[LONG];
    static const int64_t dof_a[2] = {12, 20};
    static const int64_t dof_b[2] = {HBVIB_GROUND, 26};
    static const double kt[2] = {0.5, 0.5}, mu[2] = {0.3, 0.3}, preload[2] = {0.5, 1};
    hbvib_matrix mass = dense(LONG, m), stiffness = dense(LONG, k);
    hbvib_status status = HBVIB_OK;
    int64_t i, n = 0;
    for (i = 0; i < LONG; i++) {
        start[i] = n;
        one[i] = diagonal[i] = i;
        m[i] = 1 + 0.001 * (double)i;
        row[n] = i;
        k[n++] = 2.01;
        if (i + 1 < LONG) {
            row[n] = i + 1;
            k[n++] = -1;
        }
    }
    start[LONG] = n;
    one[LONG] = LONG;
    mass.storage = stiffness.storage = HBVIB_CSC;
    mass.part = stiffness.part = HBVIB_LOWER;
    mass.col_ptr = one;
    mass.row_idx = diagonal;
    stiffness.col_ptr = start;
    stiffness.row_idx = row;
    STEP(hbvib_model_new(LONG, model));
    STEP(hbvib_model_set_matrix(*model, HBVIB_MASS, &mass));
    STEP(hbvib_model_set_matrix(*model, HBVIB_STIFFNESS, &stiffness));
    STEP(hbvib_model_set_rayleigh(*model, 0.01, 0.01));
    STEP(hbvib_model_add_force(*model, 10, 1, 1, 0));
    STEP(hbvib_model_add_jenkins(*model, 2, dof_a, dof_b, NULL, kt, mu, preload, NULL));
    return finished(status, model);
}

/* Five sectors of nodes on their faces and one between them, with a patch to the ground. */
static hbvib_status faces(hbvib_model **model)
{
    static double mass[81], stiffness[81];
    static const int64_t left[3] = {0, 1, 2}, right[3] = {6, 7, 8}, pairs[3] = {3, 4, 5};
    static const double normal[3] = {0, 0, 1}, tangent[3] = {1, 0, 0}, area[1] = {1};
    hbvib_matrix m = dense(9, mass), k = dense(9, stiffness);
    hbvib_contact c = law(HBVIB_FRICTION_2D, HBVIB_GROUND, HBVIB_GROUND, HBVIB_GROUND);
    hbvib_sector s;
    hbvib_model *copy = NULL;
    hbvib_status status = HBVIB_OK;
    int i;
    for (i = 0; i < 9; i++) {
        mass[10 * i] = 0.5;
        stiffness[10 * i] = 1.5;
        if (i >= 3) stiffness[9 * i + i - 3] = stiffness[9 * (i - 3) + i] = -0.6;
    }
    memset(&s, 0, sizeof s);
    hbvib_sector_init(&s, sizeof s);
    s.ndof = 9;
    s.sectors = 5;
    s.engine_order = 1;
    s.left = left;
    s.right = right;
    s.left_len = s.right_len = 3;
    c.kt = c.kn = 0.5;
    c.mu = 0.3;
    c.preload = 0.4;
    STEP(hbvib_cyclic_from_sector(&s, model));
    STEP(hbvib_model_set_matrix(*model, HBVIB_MASS, &m));
    STEP(hbvib_model_set_matrix(*model, HBVIB_STIFFNESS, &k));
    STEP(hbvib_model_set_rayleigh(*model, 0.01, 0.01));
    STEP(hbvib_model_add_force(*model, 3, 1, 0.5, 0));
    STEP(hbvib_model_add_patch(*model, &c, 1, pairs, NULL, normal, tangent, area, NULL, NULL, NULL));
    /* A copy in its place. */
    STEP(hbvib_model_clone(*model, &copy));
    if (copy != NULL) {
        hbvib_status freed = hbvib_model_free(*model);
        *model = copy;
        if (freed != HBVIB_OK) status = HBVIB_E_INTERNAL;
    }
    return finished(status, model);
}

#endif
