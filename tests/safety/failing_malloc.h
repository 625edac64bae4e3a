/* Controls of failing_malloc.c. The counts are those of all threads; the peak is exact for one thread. */
#ifndef FAILING_MALLOC_H
#define FAILING_MALLOC_H

#include <stdint.h>

/* From now on requests are counted, and number n, from 1, fails: it alone, or with all later ones. 0: none fails. */
void memory_arm(int64_t n, int32_t for_good);

/* No request fails any more. Returns how many there were since memory_arm. */
int64_t memory_disarm(void);

/* Blocks that were allocated and not freed, and their bytes. */
int64_t memory_blocks(void);
int64_t memory_bytes(void);

/* Most bytes that were allocated at one time since memory_arm. */
int64_t memory_peak(void);

#endif
