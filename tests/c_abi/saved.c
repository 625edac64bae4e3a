/* Row 118: saved models in memory and through a file, cut at each byte, and with any bit flipped. */
#include "common.h"

static int32_t refuses(void *user, const hbvib_force_call *call)
{
    (void)user;
    (void)call;
    return -1;
}

int main(void)
{
    static solution own, other;
    hbvib_model *model = ring_damper(), *loaded = NULL;
    hbvib_user_force force;
    const int64_t dofs[1] = {0};
    unsigned char *bytes, *again;
    int64_t size = -1, second = -1;
    FILE *file = tmpfile();

    begin();
    WORKS("size", hbvib_model_save(model, 0, NULL, &size));
    EXPECT("size", size > 500 && size < 5000);
    bytes = malloc((size_t)size + 1);
    again = malloc((size_t)size);
    if (!bytes || !again || !file) return 2;
    bytes[size] = 77;
    WORKS("save", hbvib_model_save(model, size + 1, bytes, &second));
    EXPECT("save", second == size && bytes[size] == 77 && memcmp(bytes, "\x89HBVIB\r\n\1\0\0\0", 12) == 0);
    EXPECT("file", fwrite(bytes, 1, (size_t)size, file) == (size_t)size);
    rewind(file);
    EXPECT("file", fread(again, 1, (size_t)size, file) == (size_t)size);
    WORKS("load", hbvib_model_load(size, again, &loaded));
    EXPECT("load", hbvib_model_dofs(loaded) == 4 && hbvib_model_sectors(loaded) == 24 && hbvib_model_contacts(loaded) == 1);
    WORKS("solve", solve(model, &own));
    WORKS("solve", solve(loaded, &other));
    EXPECT("bits", own.points > 1 && memcmp(&own, &other, sizeof own) == 0);
    WORKS("again", hbvib_model_save(loaded, size, again, &second));
    EXPECT("again", second == size && memcmp(bytes, again, (size_t)size) == 0);
    WORKS("free", hbvib_model_free(loaded));
    loaded = NULL;

    REFUSED("room", hbvib_model_save(model, size - 1, again, &second), HBVIB_E_DIMENSION, 2, "needs");
    REFUSED("room", hbvib_model_save(model, -1, again, &second), HBVIB_E_DIMENSION, 2, "capacity = -1");
    REFUSED("null", hbvib_model_save(model, size, again, NULL), HBVIB_E_NULL, 4, "size");
    REFUSED("null", hbvib_model_load(size, NULL, &loaded), HBVIB_E_NULL, 2, "bytes");
    REFUSED("null", hbvib_model_load(size, bytes, NULL), HBVIB_E_NULL, 3, "out");
    REFUSED("none", hbvib_model_load(0, NULL, &loaded), HBVIB_E_ARGUMENT, 2, "mark");
    REFUSED("short", hbvib_model_load(size - 1, bytes, &loaded), HBVIB_E_ARGUMENT, 2, "incomplete");
    REFUSED("negative", hbvib_model_load(-1, bytes, &loaded), HBVIB_E_DIMENSION, 1, "length = -1");
    { /* 118: cut at each byte, one bit flipped at each */
        int64_t i, taken = 0;
        for (i = 0; i < size; i++) {
            taken += hbvib_model_load(i, bytes, &loaded) >= 0;
            memcpy(again, bytes, (size_t)size);
            again[i] ^= (unsigned char)(1 << i % 8);
            taken += hbvib_model_load(size, again, &loaded) >= 0;
        }
        EXPECT("118", taken == 0 && loaded == NULL);
    }
    bytes[60] ^= 4;
    REFUSED("damaged", hbvib_model_load(size, bytes, &loaded), HBVIB_E_ARGUMENT, 2, "checksum");
    bytes[8] = 9;
    REFUSED("newer", hbvib_model_load(size, bytes, &loaded), HBVIB_E_UNSUPPORTED, 2, "newer");
    EXPECT("untouched", loaded == NULL);

    WORKS("force", hbvib_user_force_init(&force, sizeof force));
    force.dofs = dofs;
    force.n = 1;
    force.force = refuses;
    WORKS("force", hbvib_model_add_user_force(model, &force, NULL));
    REFUSED("force", hbvib_model_save(model, 0, NULL, &second), HBVIB_E_UNSUPPORTED, 1, "contact 1: a force of the caller");
    WORKS("free", hbvib_model_free(model));
    fclose(file);
    free(bytes);
    free(again);
    return verdict(30);
}
