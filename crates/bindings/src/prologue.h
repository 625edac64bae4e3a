/* hbvib.h - harmonic balance of vibrating structures with friction contacts.
 *
 * Generated from src/capi; do not edit.
 *
 * Example: a mass on a spring, held by a friction contact
 *
 *   #include <stdio.h>
 *   #include "hbvib.h"
 *   int main(void) {
 *     double m = 1, k = 1, omega = 0, amplitude = 0;   int64_t peaks = 0;
 *     hbvib_model *model = NULL;    hbvib_branch *branch = NULL;    hbvib_model_new(1, &model);
 *     hbvib_matrix a;   hbvib_matrix_init(&a, sizeof a);   a.rows = a.cols = 1;
 *     a.values = &m;    hbvib_model_set_matrix(model, HBVIB_MASS, &a);
 *     a.values = &k;    hbvib_model_set_matrix(model, HBVIB_STIFFNESS, &a);
 *     hbvib_contact c;  hbvib_contact_init(&c, sizeof c);  c.kind = HBVIB_JENKINS;
 *     c.dof_a[0] = 0;   c.kt = 1;   c.mu = 0.5;   c.preload = 1;
 *     hbvib_model_add_contact(model, &c, NULL);   hbvib_model_add_force(model, 0, 1, 0.3, 0);
 *     hbvib_forced_options o;   hbvib_forced_options_init(&o, sizeof o);   o.omega_start = 0.5;
 *     o.omega_stop = 2;   if (hbvib_forced_response(model, NULL, &o, NULL, &branch)) return 1;
 *     hbvib_branch_peaks(branch, 1, &omega, &amplitude, NULL, &peaks);   hbvib_branch_free(branch);
 *     printf("%g at %g\n", amplitude, omega);   return hbvib_model_free(model); }
 *
 * Conventions, for every function
 *
 *   equation  M x'' + C x' + K x + f_contact(x) = f_excitation.
 *   signal    x(t) = Re sum_{h=0..H} X_h exp(i h omega t), the mean X_0 real; amplitudes are peak
 *             values.
 *   complex   interleaved pairs (re, im) of double, the layout of double _Complex, of
 *             std::complex<double>, of complex(c_double_complex) and of numpy.complex128. Lengths
 *             of complex arrays count complex numbers.
 *   indices   int64_t and from 0. Only the indices inside a hbvib_matrix may count from 1.
 *   units     any consistent set; angular frequencies in rad per time unit.
 *   status    0: done. Negative: an error, and no result was written. Positive: stopped early, and
 *             the partial result was written. hbvib_last_error says what is wrong, where, and which
 *             values are accepted; hbvib_last_error_argument names the argument.
 *   structs   begin with struct_size and are filled by their _init function. They grow at their end
 *             only, so that an old caller works with a newer library. Reserved fields are 0.
 *   memory    Inputs are read during the call and never kept. The result of a _new or solving
 *             function is freed by its _free function, which accepts NULL; the caller frees nothing
 *             else. A handle that was freed, is of another type or was never returned is
 *             HBVIB_E_HANDLE. Pointers to double and int64_t must be aligned to 8 bytes.
 *   threads   A handle taken as const may be used by any number of calls at once. A handle that is
 *             not const belongs to one call at a time; other calls get HBVIB_E_BUSY. Each thread
 *             has its own text of the last error. The library prints nothing, touches no signal and
 *             no environment variable, and starts no thread. It runs in the default floating-point
 *             environment (no traps, rounding to nearest, no flush to zero); the environment of the
 *             caller is restored for callbacks and on return.
 *   process   A failing request for memory is HBVIB_E_OUT_OF_MEMORY; docs/memory.md tells the bytes
 *             that each call needs at most. 256 KiB of stack suffice for every function, 128 KiB
 *             for models of less than 48 degrees of freedom. After fork both processes may go on; a
 *             handle that a call of another thread used at that time stays HBVIB_E_BUSY in the
 *             child. dlclose frees all memory of the library but handles that were not freed.
 *   safety    No panic leaves the library (HBVIB_E_INTERNAL). Callbacks must not throw or longjmp.
 *             NaN in an input, or infinity anywhere but in the preload of a contact, is
 *             HBVIB_E_NOT_FINITE. The library cannot check that arrays are as long as stated and
 *             that pointers are valid: that is the duty of the caller.
 *
 * Contents
 *
 *   @CONTENTS@
 */

#ifndef HBVIB_H
#define HBVIB_H

#include <stddef.h>
#include <stdint.h>

/* Version of this header; hbvib_version() is the version of the library in use. */
#define HBVIB_VERSION_MAJOR @MAJOR@
#define HBVIB_VERSION_MINOR @MINOR@
#define HBVIB_VERSION_PATCH @PATCH@
/* The same as one number, for #if. */
#define HBVIB_VERSION_NUMBER \
  (HBVIB_VERSION_MAJOR * 65536 + HBVIB_VERSION_MINOR * 256 + HBVIB_VERSION_PATCH)

/* Marks functions that a later version removes. Define it empty to silence the warnings. */
#ifndef HBVIB_DEPRECATED
#if defined(__GNUC__) || defined(__clang__)
#define HBVIB_DEPRECATED(message) __attribute__((deprecated(message)))
#elif defined(_MSC_VER)
#define HBVIB_DEPRECATED(message) __declspec(deprecated(message))
#else
#define HBVIB_DEPRECATED(message)
#endif
#endif

/* Statuses that a caller ignores are warned of in C++17 and C23. Define it empty to silence the
 * warnings, or cast to void. */
#ifndef HBVIB_NODISCARD
#if defined(__cplusplus) && __cplusplus >= 201703L
#define HBVIB_NODISCARD [[nodiscard]]
#elif defined(__STDC_VERSION__) && __STDC_VERSION__ >= 202311L
#define HBVIB_NODISCARD [[nodiscard]]
#else
#define HBVIB_NODISCARD
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif
