/* Loads the library, solves with it and unloads it, again and again: nothing stays behind. Handles that the program forgot
 * stay, because they are in use as far as the library knows. Run under LD_PRELOAD=libfailing_malloc.so as: unloading
 * <library> <times>; not linked with the library. Prints the blocks that each time left. */
#include "failing_malloc.h"

#include <dlfcn.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

typedef int32_t new_function(int64_t, void **);
typedef int32_t free_function(void *);

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
