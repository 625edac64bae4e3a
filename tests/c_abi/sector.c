/* A sector from its faces: a ring of masses whose frequencies are known, and refusals that leave nothing behind. */
#include "common.h"

static const int64_t LEFT[1] = {0}, RIGHT[1] = {1}, CLAMPED[1] = {2};

/* Two halves of a mass on springs to a clamped node and on a spring between them. */
static hbvib_sector ring(void)
{
    hbvib_sector s;
    if (hbvib_sector_init(&s, sizeof s) != HBVIB_OK) abort();
    s.frame = HBVIB_CYLINDRICAL;
    s.ndof = 3;
    s.sectors = 10;
    s.components = 1;
    s.left = LEFT;
    s.left_len = 1;
    s.right = RIGHT;
    s.right_len = 1;
    s.fixed = CLAMPED;
    s.fixed_len = 1;
    return s;
}

static void set(hbvib_model *model, int32_t which, const double *values)
{
    hbvib_matrix a;
    WORKS("matrix", hbvib_matrix_init(&a, sizeof a));
    a.rows = a.cols = 3;
    a.values = values;
    WORKS("matrix", hbvib_model_set_matrix(model, which, &a));
}

static void frequencies_of_the_ring(void)
{
    const double m[9] = {0.5, 0, 0, 0, 0.5, 0, 0, 0, 7};
    const double k[9] = {0.25 + 3, -3, -0.25, -3, 0.25 + 3, -0.25, -0.25, -0.25, 0.5};
    hbvib_sector s = ring();
    hbvib_model *model = NULL;
    double omega, shape[6];
    int64_t d;
    WORKS("sector", hbvib_cyclic_from_sector(&s, &model));
    EXPECT("size", hbvib_model_dofs(model) == 3 && hbvib_model_sectors(model) == 10);
    set(model, HBVIB_MASS, m);
    set(model, HBVIB_STIFFNESS, k);
    for (d = 0; d <= 5; d++) {
        double phi = 2 * acos(-1) * (double)d / 10, square = 0.5 + 6 * (1 - cos(phi));
        WORKS("modes", hbvib_linear_modes(model, d, HBVIB_CONTACTS_FREE, 1, &omega, shape));
        EXPECT("frequency", fabs(omega - sqrt(square)) < 1e-13);
        EXPECT("phase", hypot(shape[2] - (shape[0] * cos(phi) + shape[1] * sin(phi)),
                              shape[3] - (shape[1] * cos(phi) - shape[0] * sin(phi))) < 1e-13);
        EXPECT("fixed", shape[4] == 0 && shape[5] == 0);
    }
    REFUSED("39", hbvib_linear_modes(model, 0, HBVIB_CONTACTS_FREE, 2, &omega, shape), HBVIB_E_DIMENSION, 4, "only 1");
    WORKS("fix", hbvib_model_fix(model, 0, NULL));
    REFUSED("1", hbvib_model_fix(model, 1, NULL), HBVIB_E_NULL, 3, "dofs");
    REFUSED("6", hbvib_model_fix(model, -1, LEFT), HBVIB_E_DIMENSION, 2, "n = -1");
    REFUSED("4", hbvib_model_fix(NULL, 1, LEFT), HBVIB_E_HANDLE, 1, "NULL");
    REFUSED("fix", hbvib_model_fix(model, 1, LEFT), HBVIB_E_ARGUMENT, 3, "pair 0 is fixed on one side only");
    s.fixed_len = 0;
    WORKS("free", hbvib_model_free(model));
}

static void bad_sectors(void)
{
    const double here[3] = {1, 0, 0}, there[3] = {0.5, 0, 0};
    const int64_t same[1] = {0}, beyond[1] = {3}, below[1] = {-2};
    hbvib_model *kept = (hbvib_model *)8, *model = kept;
    hbvib_sector s = ring();
#define BAD(row, change, status, words)                                             \
    do {                                                                            \
        s = ring();                                                                 \
        change;                                                                     \
        REFUSED(row, hbvib_cyclic_from_sector(&s, &model), status, 1, words);       \
        EXPECT(row, model == kept);                                                 \
    } while (0)
    REFUSED("1", hbvib_sector_init(NULL, sizeof s), HBVIB_E_NULL, 1, "hbvib_sector");
    REFUSED("66", hbvib_sector_init(&s, 8), HBVIB_E_STRUCT_SIZE, 2, "sizeof");
    REFUSED("1", hbvib_cyclic_from_sector(NULL, &model), HBVIB_E_NULL, 1, "hbvib_sector");
    REFUSED("2", hbvib_cyclic_from_sector(&s, NULL), HBVIB_E_NULL, 2, "out");
    BAD("66", s.struct_size = 0, HBVIB_E_STRUCT_SIZE, "hbvib_sector_init");
    BAD("68", s.reserved = 1, HBVIB_E_ARGUMENT, "reserved = 1");
    BAD("5", s.ndof = 0, HBVIB_E_DIMENSION, "ndof = 0");
    BAD("7", s.ndof = INT64_MAX, HBVIB_E_DIMENSION, "ndof");
    BAD("62", s.sectors = 1, HBVIB_E_ARGUMENT, "sectors = 1");
    BAD("62", s.sectors = -3, HBVIB_E_ARGUMENT, "sectors = -3");
    BAD("54", s.frame = 9, HBVIB_E_ARGUMENT, "frame = 9");
    BAD("direction", s.direction = 0, HBVIB_E_ARGUMENT, "direction = 0");
    BAD("components", s.components = 0, HBVIB_E_DIMENSION, "0 components");
    BAD("components", s.frame = HBVIB_CARTESIAN, HBVIB_E_DIMENSION, "1 components");
    BAD("1", s.left = NULL, HBVIB_E_NULL, "left");
    BAD("6", s.right_len = -1, HBVIB_E_DIMENSION, "right_len");
    BAD("12", s.right_len = 0, HBVIB_E_DIMENSION, "the right one 0");
    BAD("39", s.right = beyond, HBVIB_E_INDEX, "right[0] = 3");
    BAD("39", s.left = below, HBVIB_E_INDEX, "left[0] = -2");
    BAD("39", s.fixed = beyond, HBVIB_E_INDEX, "fixed[0] = 3");
    BAD("twice", s.right = same, HBVIB_E_ARGUMENT, "in both faces");
    BAD("one side", s.fixed = LEFT, HBVIB_E_ARGUMENT, "fixed on one side only");
    BAD("48", s.axis[2] = 0, HBVIB_E_ARGUMENT, "axis is zero");
    BAD("24", s.axis[0] = NAN, HBVIB_E_NOT_FINITE, "axis[0]");
    BAD("1", s.left_coordinates = here, HBVIB_E_NULL, "right_coordinates");
    BAD("angle", (s.left_coordinates = here, s.right_coordinates = there), HBVIB_E_ARGUMENT, "degrees about the axis");
}

int main(void)
{
    frequencies_of_the_ring();
    bad_sectors();
    return verdict(20);
}
