/* A malloc that fails when told, and counts. Preloaded into a program (LD_PRELOAD), it replaces that of libc for all
 * libraries of the process; failing_malloc.h declares the controls. */
#define _GNU_SOURCE
#include "failing_malloc.h"

#include <errno.h>
#include <malloc.h>
#include <stddef.h>

/* The allocator of glibc under its own names. */
extern void *__libc_malloc(size_t);
extern void *__libc_calloc(size_t, size_t);
extern void *__libc_realloc(void *, size_t);
extern void *__libc_memalign(size_t, size_t);
extern void __libc_free(void *);

static int64_t asked, fail_at, live_blocks, live_bytes, peak_bytes;
static int armed, permanent;

void memory_arm(int64_t n, int32_t for_good)
{
    asked = 0;
    fail_at = n;
    permanent = for_good;
    peak_bytes = live_bytes;
    armed = 1;
}

int64_t memory_disarm(void)
{
    armed = 0;
    return asked;
}

int64_t memory_blocks(void)
{
    return live_blocks;
}

int64_t memory_bytes(void)
{
    return live_bytes;
}

int64_t memory_peak(void)
{
    return peak_bytes;
}

static int fails(void)
{
    int64_t number;
    if (!armed) return 0;
    number = __atomic_add_fetch(&asked, 1, __ATOMIC_RELAXED);
    if (fail_at == 0 || number < fail_at || (!permanent && number > fail_at)) return 0;
    errno = ENOMEM;
    return 1;
}

static void *counted(void *block)
{
    if (block != NULL) {
        int64_t bytes;
        __atomic_add_fetch(&live_blocks, 1, __ATOMIC_RELAXED);
        bytes = __atomic_add_fetch(&live_bytes, (int64_t)malloc_usable_size(block), __ATOMIC_RELAXED);
        if (bytes > peak_bytes) peak_bytes = bytes;
    }
    return block;
}

static void uncounted(size_t bytes)
{
    __atomic_sub_fetch(&live_blocks, 1, __ATOMIC_RELAXED);
    __atomic_sub_fetch(&live_bytes, (int64_t)bytes, __ATOMIC_RELAXED);
}

void *malloc(size_t size)
{
    return fails() ? NULL : counted(__libc_malloc(size));
}

void *calloc(size_t n, size_t size)
{
    return fails() ? NULL : counted(__libc_calloc(n, size));
}

void free(void *block)
{
    if (block == NULL) return;
    uncounted(malloc_usable_size(block));
    __libc_free(block);
}

void *realloc(void *block, size_t size)
{
    size_t before = block == NULL ? 0 : malloc_usable_size(block);
    void *moved;
    if (fails()) return NULL;
    moved = __libc_realloc(block, size);
    if (moved == NULL) return NULL;
    if (block != NULL) uncounted(before);
    return counted(moved);
}

void *memalign(size_t alignment, size_t size)
{
    return fails() ? NULL : counted(__libc_memalign(alignment, size));
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return memalign(alignment, size);
}

int posix_memalign(void **out, size_t alignment, size_t size)
{
    void *block = memalign(alignment, size);
    if (block == NULL) return ENOMEM;
    *out = block;
    return 0;
}
