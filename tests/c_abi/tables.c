/* Many contacts and springs in one call: the same bits as one by one, and refusals name the entry. */
#include "common.h"

static double amplitude(hbvib_model *model)
{
    hbvib_solver_options s = solver_options();
    hbvib_forced_options o = frequencies(210, 210);
    hbvib_branch *branch = NULL;
    hbvib_view view;
    double found;
    WORKS("solve", hbvib_forced_response(model, &s, &o, NULL, &branch));
    WORKS("solve", hbvib_view_init(&view, sizeof view));
    WORKS("solve", hbvib_branch_field(branch, HBVIB_AMPLITUDE, &view));
    found = view.data[0];
    WORKS("solve", hbvib_branch_free(branch));
    return found;
}

/* One call makes the contacts of a joint; a bad parameter is named and nothing is added. */
static void iwan(void)
{
    hbvib_model *model = NULL;
    int64_t first = -1;
    hbvib_contact c = ring_contact();
    int64_t id = -1;
    WORKS("iwan", hbvib_model_clone(the_model, &model));
    WORKS("iwan", hbvib_model_add_iwan(model, 2, HBVIB_GROUND, 0, 4, 1e3, -0.4, 0.3, 20, &first));
    EXPECT("iwan", first == 1);
    WORKS("iwan", hbvib_model_add_contact(model, &c, &id));
    EXPECT("iwan", id == 21);
    REFUSED("iwan", hbvib_model_add_iwan(NULL, 2, HBVIB_GROUND, 0, 4, 1e3, -0.4, 0.3, 20, &first), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("iwan", hbvib_model_add_iwan(model, NDOF, HBVIB_GROUND, 0, 4, 1e3, -0.4, 0.3, 20, &first), HBVIB_E_INDEX, 2, "dof_a = 4");
    REFUSED("iwan", hbvib_model_add_iwan(model, 2, -2, 0, 4, 1e3, -0.4, 0.3, 20, &first), HBVIB_E_INDEX, 3, "dof_b = -2");
    REFUSED("iwan", hbvib_model_add_iwan(model, 2, 2, 0, 4, 1e3, -0.4, 0.3, 20, &first), HBVIB_E_ARGUMENT, 2, "dof_a");
    REFUSED("iwan", hbvib_model_add_iwan(model, 2, 3, 0, 0, 1e3, -0.4, 0.3, 20, &first), HBVIB_E_ARGUMENT, 5, "slip_force = 0");
    REFUSED("iwan", hbvib_model_add_iwan(model, 2, 3, 0, 4, NAN, -0.4, 0.3, 20, &first), HBVIB_E_NOT_FINITE, 6, "stiffness");
    REFUSED("iwan", hbvib_model_add_iwan(model, 2, 3, 0, 4, 1e3, 0.1, 0.3, 20, &first), HBVIB_E_ARGUMENT, 7, "chi = 0.1");
    REFUSED("iwan", hbvib_model_add_iwan(model, 2, 3, 0, 4, 1e3, -0.4, -1, 20, &first), HBVIB_E_ARGUMENT, 8, "beta = -1");
    REFUSED("iwan", hbvib_model_add_iwan(model, 2, 3, 0, 4, 1e3, -0.4, 0.3, 1, &first), HBVIB_E_ARGUMENT, 9, "elements = 1");
    REFUSED("iwan", hbvib_model_add_iwan(model, 2, 3, 0, 4, 1e3, -0.4, 0.3, -1, &first), HBVIB_E_DIMENSION, 9, "elements");
    EXPECT("iwan", first == 1);
    WORKS("iwan", hbvib_model_add_contact(model, &c, &id));
    EXPECT("iwan", id == 22);
    WORKS("iwan", hbvib_model_free(model));
}

int main(void)
{
    hbvib_model *model, *more = NULL;
    int64_t a[2] = {2, 0}, b[2] = {3, HBVIB_GROUND}, first = -7;
    const int64_t offsets[2] = {0, 0};
    double kt[2] = {1e7, 2e6}, mu[2] = {0.3, 0.2}, load[2] = {10, 20}, k[2] = {1e5, -1e3};
    hbvib_contact c;
    double before, one_by_one;
    int i;

    begin();
    model = the_model;
    before = amplitude(model);
    WORKS("clone", hbvib_model_clone(model, &more));
    for (i = 0; i < 2; i++) {
        WORKS("init", hbvib_contact_init(&c, sizeof c));
        c.kind = HBVIB_JENKINS;
        c.dof_a[0] = a[i];
        c.dof_b[0] = b[i];
        c.kt = kt[i];
        c.mu = mu[i];
        c.preload = load[i];
        WORKS("one by one", hbvib_model_add_contact(more, &c, NULL));
    }
    one_by_one = amplitude(more);
    iwan();
    WORKS("free", hbvib_model_free(more));
    more = NULL;
    WORKS("clone", hbvib_model_clone(model, &more));
    WORKS("at once", hbvib_model_add_jenkins(more, 2, a, b, offsets, kt, mu, load, &first));
    EXPECT("at once", first == 1);
    EXPECT("at once", amplitude(more) == one_by_one && one_by_one != before);
    WORKS("springs", hbvib_model_add_springs(more, 2, a, b, NULL, k));
    EXPECT("springs", amplitude(more) != one_by_one);
    WORKS("none", hbvib_model_add_jenkins(more, 0, NULL, NULL, NULL, NULL, NULL, NULL, NULL));
    WORKS("none", hbvib_model_add_springs(more, 0, NULL, NULL, NULL, NULL));
    WORKS("free", hbvib_model_free(more));

    first = -7;
    REFUSED("4", hbvib_model_add_jenkins(NULL, 2, a, b, NULL, kt, mu, load, &first), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("6", hbvib_model_add_jenkins(model, -1, a, b, NULL, kt, mu, load, &first), HBVIB_E_DIMENSION, 2, "n = -1");
    REFUSED("7", hbvib_model_add_jenkins(model, INT64_MAX, a, b, NULL, kt, mu, load, &first), HBVIB_E_DIMENSION, 3, "dof_a");
    REFUSED("1", hbvib_model_add_jenkins(model, 2, NULL, b, NULL, kt, mu, load, &first), HBVIB_E_NULL, 3, "dof_a");
    REFUSED("1", hbvib_model_add_jenkins(model, 2, a, NULL, NULL, kt, mu, load, &first), HBVIB_E_NULL, 4, "dof_b");
    REFUSED("1", hbvib_model_add_jenkins(model, 2, a, b, NULL, NULL, mu, load, &first), HBVIB_E_NULL, 6, "kt");
    REFUSED("1", hbvib_model_add_jenkins(model, 2, a, b, NULL, kt, NULL, load, &first), HBVIB_E_NULL, 7, "mu");
    REFUSED("1", hbvib_model_add_jenkins(model, 2, a, b, NULL, kt, mu, NULL, &first), HBVIB_E_NULL, 8, "preload");
    REFUSED("1", hbvib_model_add_springs(model, 2, a, b, NULL, NULL), HBVIB_E_NULL, 6, "stiffness");
    a[1] = 4;
    REFUSED("39", hbvib_model_add_jenkins(model, 2, a, b, NULL, kt, mu, load, &first), HBVIB_E_INDEX, 3, "dof_a[1] = 4");
    REFUSED("39", hbvib_model_add_springs(model, 2, a, b, NULL, k), HBVIB_E_INDEX, 3, "dof_a[1] = 4");
    a[1] = HBVIB_GROUND;
    REFUSED("41", hbvib_model_add_jenkins(model, 2, a, b, NULL, kt, mu, load, &first), HBVIB_E_ARGUMENT, 3, "entry 1");
    a[1] = 0;
    kt[1] = -1;
    REFUSED("43", hbvib_model_add_jenkins(model, 2, a, b, NULL, kt, mu, load, &first), HBVIB_E_ARGUMENT, 6, "entry 1");
    kt[1] = 1;
    mu[0] = NAN;
    REFUSED("44", hbvib_model_add_jenkins(model, 2, a, b, NULL, kt, mu, load, &first), HBVIB_E_NOT_FINITE, 7, "entry 0");
    k[1] = INFINITY;
    REFUSED("24", hbvib_model_add_springs(model, 2, a, b, NULL, k), HBVIB_E_NOT_FINITE, 6, "entry 1");
    EXPECT("untouched", first == -7 && amplitude(model) == before);
    WORKS("free", hbvib_model_free(model));
    return verdict(40);
}
