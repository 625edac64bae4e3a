/* Loads the library, solves with it and unloads it, again and again: nothing stays behind. Handles that the program forgot
 * stay, because they are in use as far as the library knows. Run under LD_PRELOAD=libfailing_malloc.so as: unloading
 * <library> <times>; not linked with the library. Prints the blocks that each time left. */
#include "failing_malloc.h"
#include "hbvib.h"

#include <dlfcn.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

typedef int32_t new_function(int64_t, void **);
typedef int32_t free_function(void *);
typedef hbvib_status init_function(hbvib_contact *, size_t);
typedef hbvib_status evaluate_function(const hbvib_contact *, int64_t, int64_t, double, const double *, int64_t, double *, int64_t,
                                       double *, int64_t);

/* An analysis, after which the thread keeps memory of the library. */
static void analyse(void *library)
{
    const double motion[4] = {0, 0, 2, 0};
    double force[4] = {0};
    hbvib_contact c;
    init_function *init;
    evaluate_function *evaluate;
    *(void **)&init = dlsym(library, "hbvib_contact_init");
    *(void **)&evaluate = dlsym(library, "hbvib_contact_evaluate");
    if (init(&c, sizeof c) != HBVIB_OK) exit(7);
    c.kind = HBVIB_JENKINS;
    c.kt = c.mu = c.preload = 1;
    if (evaluate(&c, 1, 0, 1, motion, 2, force, 2, NULL, 0) != HBVIB_OK || !(force[2] > 0.5)) exit(8);
}

/* One life of the library, with many handles so that its table is large. */
static void load_and_unload(const char *path)
{
    enum { MANY = 1000 };
    void *models[MANY] = {NULL}, *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    new_function *make;
    free_function *end;
    int i;
    if (library == NULL) {
        fprintf(stderr, "%s\n", dlerror());
        exit(2);
    }
    *(void **)&make = dlsym(library, "hbvib_model_new");
    *(void **)&end = dlsym(library, "hbvib_model_free");
    for (i = 0; i < MANY; i++)
        if (make(4, &models[i]) != 0) exit(3);
    analyse(library);
    for (i = 0; i < MANY; i++)
        if (end(models[i]) != 0) exit(4);
    if (dlclose(library) != 0) exit(5);
    if (dlopen(path, RTLD_NOW | RTLD_NOLOAD) != NULL) exit(6);
}

int main(int argc, char **argv)
{
    int64_t before, left;
    int i, times;
    if (argc != 3) return 2;
    times = atoi(argv[2]);
    for (i = 0; i < 10; i++) load_and_unload(argv[1]); /* what the loader keeps for good */
    before = memory_blocks();
    for (i = 0; i < times; i++) load_and_unload(argv[1]);
    left = memory_blocks() - before;
    printf("%" PRId64 " blocks after %d times\n", left, times);
    return left == 0 ? 0 : 1;
}
