/* Sizes of a model, and indices of callers that count from 1. */
#include "common.h"

static void sizes(void)
{
    hbvib_model *plain = NULL;
    hbvib_contact c;
    EXPECT("sizes", hbvib_model_dofs(the_model) == NDOF);
    EXPECT("sizes", hbvib_model_sectors(the_model) == 24);
    EXPECT("sizes", hbvib_model_contacts(the_model) == 1);
    WORKS("sizes", hbvib_model_new(3, &plain));
    EXPECT("sizes", hbvib_model_dofs(plain) == 3 && hbvib_model_sectors(plain) == 1 && hbvib_model_contacts(plain) == 0);
    c = ring_contact();
    c.dof_a[0] = 0;
    c.dof_b[0] = HBVIB_GROUND;
    WORKS("sizes", hbvib_model_add_contact(plain, &c, NULL));
    EXPECT("sizes", hbvib_model_contacts(plain) == 1);
    WORKS("sizes", hbvib_model_free(plain));
}

static void from_one(void)
{
    int64_t index = -7;
    const char longest[] = "a name of more than forty bytes is cut \xc3\xa9 there";
    WORKS("40", hbvib_index_from_one("dof", 1, 4, &index));
    EXPECT("40", index == 0);
    WORKS("40", hbvib_index_from_one(NULL, 4, 4, &index));
    EXPECT("40", index == 3);
    REFUSED("40", hbvib_index_from_one("dof", 0, 4, &index), HBVIB_E_INDEX, 2, "dof = 0, needs 1 .. 4");
    REFUSED("39", hbvib_index_from_one("dof", 5, 4, &index), HBVIB_E_INDEX, 2, "dof = 5, needs 1 .. 4");
    REFUSED("39", hbvib_index_from_one(NULL, INT64_MIN, 4, &index), HBVIB_E_INDEX, 2, "index = -9223372036854775808");
    REFUSED("39", hbvib_index_from_one("dof", INT64_MAX, INT64_MAX - 1, &index), HBVIB_E_INDEX, 2, "needs 1 .. 9223372036854775806");
    REFUSED("39", hbvib_index_from_one("contact", 1, 0, &index), HBVIB_E_INDEX, 2, "contact = 1, but there is none");
    REFUSED("6", hbvib_index_from_one("dof", 1, -1, &index), HBVIB_E_DIMENSION, 3, "count = -1, needs at least 0");
    REFUSED("2", hbvib_index_from_one("dof", 1, 4, NULL), HBVIB_E_NULL, 4, "from_zero");
    REFUSED("117", hbvib_index_from_one(longest, 0, 4, &index), HBVIB_E_INDEX, 2, "bytes is cut  = 0, needs 1 .. 4");
    REFUSED("117", hbvib_index_from_one("\xff\xfe", 0, 4, &index), HBVIB_E_INDEX, 2, " = 0, needs 1 .. 4");
    REFUSED("117", hbvib_index_from_one("", 0, 4, &index), HBVIB_E_INDEX, 2, " = 0, needs 1 .. 4");
    EXPECT("39", index == 3);
}

int main(void)
{
    begin();
    sizes();
    from_one();
    WORKS("free", hbvib_model_free(the_model));
    return verdict(30);
}
