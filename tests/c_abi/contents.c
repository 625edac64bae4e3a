/* What a model holds is read back: contacts, matrices, springs, forces and the engine order. */
#include "common.h"

static void contacts(hbvib_model *model)
{
    hbvib_contact c;
    double slope = 7;
    const double y[2] = {-1, 1}, f[2] = {-1, 2};
    const double spin = 3000 * 2 * PI / 60;
    WORKS("contact", hbvib_contact_init(&c, sizeof c));
    WORKS("contact", hbvib_model_contact(model, 0, &c, &slope));
    EXPECT("contact", c.kind == HBVIB_JENKINS && c.dof_a[0] == 2 && c.dof_b[0] == 3 && c.dof_a[2] == HBVIB_GROUND);
    EXPECT("contact", c.kt == 5e7 && c.mu == 0.3 && c.preload == 0.03 * 0.165 * spin * spin && slope == 0);
    WORKS("speed", hbvib_model_set_preload_at_speed(model, 0, 3, 2));
    WORKS("speed", hbvib_model_set_speed(model, 10));
    WORKS("speed", hbvib_model_contact(model, 0, &c, &slope));
    EXPECT("speed", c.preload == 3 && slope == 2);
    WORKS("table", hbvib_model_add_table(model, 0, HBVIB_GROUND, 0, 2, y, f, NULL));
    WORKS("table", hbvib_model_contact(model, 1, &c, NULL));
    EXPECT("table", c.kind == HBVIB_TABLE && c.kt == 0 && c.dof_a[0] == 0);
    REFUSED("kind", hbvib_model_add_contact(model, &c, NULL), HBVIB_E_ARGUMENT, 2, "kind = 7");
    REFUSED("id", hbvib_model_contact(model, 2, &c, NULL), HBVIB_E_INDEX, 2, "id = 2");
    REFUSED("null", hbvib_model_contact(model, 0, NULL, NULL), HBVIB_E_NULL, 3, "NULL");
    c.struct_size = 3;
    REFUSED("size", hbvib_model_contact(model, 0, &c, NULL), HBVIB_E_STRUCT_SIZE, 3, "");
    REFUSED("handle", hbvib_model_contact(NULL, 0, &c, NULL), HBVIB_E_HANDLE, 1, "NULL");
}

static void matrices(const hbvib_model *model)
{
    int64_t row[16], column[16], count = -1, k;
    double value[32], dense[16] = {0};
    WORKS("count", hbvib_model_matrix(model, HBVIB_STIFFNESS, HBVIB_BLOCK_OWN, 0, NULL, NULL, NULL, &count));
    EXPECT("count", count == 8);
    REFUSED("capacity", hbvib_model_matrix(model, HBVIB_STIFFNESS, HBVIB_BLOCK_OWN, 7, row, column, value, &count),
            HBVIB_E_DIMENSION, 4, "needs 8");
    WORKS("matrix", hbvib_model_matrix(model, HBVIB_STIFFNESS, HBVIB_BLOCK_OWN, 16, row, column, value, &count));
    for (k = 0; k < count; k++) {
        dense[4 * row[k] + column[k]] = value[2 * k];
        EXPECT("matrix", value[2 * k + 1] == 0 && (k == 0 || column[k] >= column[k - 1]));
    }
    EXPECT("matrix", memcmp(dense, STIFFNESS, sizeof dense) == 0);
    WORKS("next", hbvib_model_matrix(model, HBVIB_STIFFNESS, HBVIB_BLOCK_NEXT, 16, row, column, value, &count));
    EXPECT("next", count == 2 && row[1] == 3 && column[1] == 3 && value[2] == -2e7);
    WORKS("none", hbvib_model_matrix(model, HBVIB_MASS, HBVIB_BLOCK_PREVIOUS, 16, row, column, value, &count));
    EXPECT("none", count == 0);
    REFUSED("block", hbvib_model_matrix(model, HBVIB_MASS, 3, 0, NULL, NULL, NULL, &count), HBVIB_E_ARGUMENT, 3,
            "block = 3");
    REFUSED("which", hbvib_model_matrix(model, 9, 0, 0, NULL, NULL, NULL, &count), HBVIB_E_ARGUMENT, 2, "which = 9");
    REFUSED("null", hbvib_model_matrix(model, 0, 0, 16, row, column, value, NULL), HBVIB_E_NULL, 8, "count");
}

static void loads(hbvib_model *model)
{
    int64_t dof[4], harmonic[4], kind[4], count, a[2], b[2], offset[2], order;
    double force[8], stiffness[2];
    const int64_t at[1] = {1}, ground[1] = {HBVIB_GROUND};
    const double k[1] = {-5};
    WORKS("unbalance", hbvib_model_add_unbalance(model, 0, 1, 0.5, 0));
    WORKS("forces", hbvib_model_forces(model, 4, dof, harmonic, force, kind, &count));
    EXPECT("forces", count == 4 && dof[0] == 0 && dof[1] == 1 && harmonic[0] == 1 && force[1] == 0);
    EXPECT("forces", force[4] == 0.5 && force[6] == 0 && force[7] == -0.5 && kind[1] == 0 && kind[2] == 1);
    REFUSED("forces", hbvib_model_forces(model, 3, dof, NULL, NULL, NULL, &count), HBVIB_E_DIMENSION, 2, "needs 4");
    WORKS("springs", hbvib_model_add_springs(model, 1, at, ground, NULL, k));
    WORKS("springs", hbvib_model_springs(model, 2, a, b, offset, stiffness, &count));
    EXPECT("springs", count == 1 && a[0] == 1 && b[0] == HBVIB_GROUND && offset[0] == 0 && stiffness[0] == -5);
    REFUSED("springs", hbvib_model_springs(model, -1, NULL, NULL, NULL, NULL, &count), HBVIB_E_DIMENSION, 2, "");
    WORKS("wave", hbvib_model_wave(model, &order));
    EXPECT("wave", order == 2);
    REFUSED("wave", hbvib_model_wave(model, NULL), HBVIB_E_NULL, 2, "");
}

int main(void)
{
    hbvib_model *model = ring_damper();
    contacts(model);
    matrices(model);
    loads(model);
    WORKS("free", hbvib_model_free(model));
    return verdict(50);
}
