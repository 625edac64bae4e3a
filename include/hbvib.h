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
 *   Version and errors  the version in use, status codes, the sentence behind a status
 *   Matrices            views of dense and sparse matrices of the caller
 *   Model               structures, their matrices, springs and forces
 *   Cyclic structures   sectors, their faces and couplings, diameters, engine order, aerodynamics
 *   Contacts            friction, unilateral contacts, nonlinear springs and dampers, patches
 *   Laws of the caller  forces computed by a callback, and the check of their derivatives
 *   Solve               options, progress and cancellation, forced responses
 *   Results             curve, fields, harmonics, special points, energies, contacts of a branch
 *   Modes               linear and nonlinear modes, responses synthesised from them
 *   Time                integration in time, and points of a branch compared with it
 *   Stability           Floquet multipliers of points, bifurcations, limit cycles
 *   Design studies      parameters of a model, derivatives of results by them, responses over them
 *   Low level           one contact law, the residual at a given motion, indices from 1
 */

#ifndef HBVIB_H
#define HBVIB_H

#include <stddef.h>
#include <stdint.h>

/* Version of this header; hbvib_version() is the version of the library in use. */
#define HBVIB_VERSION_MAJOR 0
#define HBVIB_VERSION_MINOR 1
#define HBVIB_VERSION_PATCH 0
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

/* ==============================================================================================
 * Version and errors: the version in use, status codes, the sentence behind a status
 * ============================================================================================== */

/// Version of the library as major * 65536 + minor * 256 + patch.
///
/// Errors: none. Threads: any.
uint32_t hbvib_version(void);

/// Version of the library as text, "0.1.0": static, never to be freed.
///
/// Errors: none. Threads: any.
const char *hbvib_version_string(void);

/// Outcome of a call: a value of enum hbvib_status_code.
typedef int32_t hbvib_status;

/// Values of hbvib_status. Zero: done. Negative: an error, nothing was written. Positive: stopped
/// early, the partial result was written.
typedef enum {
  /// Done.
  HBVIB_OK = 0,
  /// The progress hook or the cancel flag asked to stop.
  HBVIB_STOPPED_BY_CALLER = 1,
  /// The step fell below step_min.
  HBVIB_STOPPED_STEP_TOO_SMALL = 2,
  /// max_points was reached.
  HBVIB_STOPPED_MAX_POINTS = 3,
  /// Some points need more harmonics for the tolerance than max_harmonics or the memory allows,
  /// or their error is unknown; HBVIB_ERROR_ESTIMATE shows which. The whole range was covered,
  /// and all points are stored.
  HBVIB_STOPPED_MAX_HARMONICS = 4,
  /// Round-off kept the residual above tol_residual.
  HBVIB_STOPPED_STALLED = 5,
  /// The branch turned back, left the range where it began and did not come back.
  HBVIB_STOPPED_LEFT_RANGE = 6,
  /// A force callback failed; hbvib_last_error has the code that it returned.
  HBVIB_STOPPED_CALLBACK = 7,
  /// An undamped resonance lies in the range, where the response has no bound; the amplitude there
  /// is what round-off makes of it. hbvib_last_error names the frequency.
  HBVIB_STOPPED_UNBOUNDED = 8,
  /// No force acts on the model: unless a law of the caller excites it by itself or a guess began
  /// at a motion of its own, the response is zero, or the static motion under preloads.
  HBVIB_STOPPED_NO_FORCE = 9,
  /// Batches only: the amplitude has no maximum within the range.
  HBVIB_STOPPED_NO_PEAK = 10,
  /// Parameter responses only: the followed peak, or maximum of damping, met a minimum and
  /// vanished.
  HBVIB_STOPPED_PEAK_VANISHED = 11,
  /// The curve is closed: it came back to its first point, or eight times to a fold that it had
  /// passed, where a step entered it. All of it within the range is kept.
  HBVIB_STOPPED_CLOSED = 12,
  /// A required pointer is NULL.
  HBVIB_E_NULL = -1,
  /// A value lies outside its range.
  HBVIB_E_ARGUMENT = -2,
  /// A count or length does not fit.
  HBVIB_E_DIMENSION = -3,
  /// A number is NaN or infinite.
  HBVIB_E_NOT_FINITE = -4,
  /// A matrix that was declared symmetric or Hermitian is not.
  HBVIB_E_NOT_HERMITIAN = -5,
  /// A linear system has no unique solution.
  HBVIB_E_SINGULAR = -6,
  /// An iteration did not converge.
  HBVIB_E_NO_CONVERGENCE = -7,
  /// A struct was not filled by its _init function, or comes from another version.
  HBVIB_E_STRUCT_SIZE = -8,
  /// A callback failed or returned numbers that are not finite.
  HBVIB_E_CALLBACK = -9,
  /// The requested combination is not provided.
  HBVIB_E_UNSUPPORTED = -10,
  /// Memory could not be allocated.
  HBVIB_E_OUT_OF_MEMORY = -11,
  /// The problem has no bounded periodic solution.
  HBVIB_E_NO_BOUNDED_SOLUTION = -12,
  /// A handle was not returned by this library, was freed, or is of another type.
  HBVIB_E_HANDLE = -13,
  /// A running call uses the object.
  HBVIB_E_BUSY = -14,
  /// An index lies outside its range.
  HBVIB_E_INDEX = -15,
  /// A matrix that must be positive definite is not.
  HBVIB_E_NOT_POSITIVE_DEFINITE = -16,
  /// A defect of the library itself.
  HBVIB_E_INTERNAL = -99,
} hbvib_status_code;

/// Name of a status, "HBVIB_E_SINGULAR": static text, never to be freed. A number that is no status
/// gives "HBVIB_UNKNOWN_STATUS".
///
/// Errors: none. Threads: any.
const char *hbvib_status_name(hbvib_status status);

/// Sentence that explains the outcome of this thread's last call that returned a status or a
/// count: what is wrong, where, and the range that is accepted. Empty after a success. UTF-8, at
/// most 255 bytes, ends with NUL, valid until the thread's next such call.
///
/// Errors: none. Threads: each has its own text and never sees that of another.
const char *hbvib_last_error(void);

/// Number of the argument that caused the last error, counted from 1 in the order of the parameters
/// of the function; 0 where no single argument caused it, and after a success.
///
/// Errors: none. Threads: each has its own.
int32_t hbvib_last_error_argument(void);

/// Copies the sentence of hbvib_last_error into a buffer of the caller.
///
/// buffer  receives the text, always NUL-terminated and cut at a whole UTF-8 character where it is
///         too long; may be NULL where only the size is needed.
/// len     size of the buffer in bytes; 0 writes nothing.
/// Returns the size of the whole text in bytes, its NUL included.
/// Errors: none. Threads: each has its own text.
size_t hbvib_last_error_copy(char *buffer, size_t len);

/* ==============================================================================================
 * Matrices: views of dense and sparse matrices of the caller
 * ============================================================================================== */

/// Layouts of a matrix view.
typedef enum {
  /// Dense, column after column (Fortran, MATLAB).
  HBVIB_COL_MAJOR = 0,
  /// Dense, row after row (C, numpy).
  HBVIB_ROW_MAJOR = 1,
  /// Compressed sparse columns; duplicates are summed.
  HBVIB_CSC = 2,
} hbvib_storage;

/// Kinds of numbers in a view.
typedef enum {
  /// One double each.
  HBVIB_REAL = 0,
  /// Two doubles each, (re, im).
  HBVIB_COMPLEX = 1,
} hbvib_scalar;

/// The part of a matrix that is given, and the symmetry that the caller promises.
typedef enum {
  /// All of a symmetric or Hermitian matrix; the symmetry is checked.
  HBVIB_FULL = 0,
  /// The lower triangle of a symmetric or Hermitian matrix; the upper one is not read.
  HBVIB_LOWER = 1,
  /// The upper triangle of a symmetric or Hermitian matrix; the lower one is not read.
  HBVIB_UPPER = 2,
  /// All of any matrix.
  HBVIB_GENERAL = 3,
  /// All of a matrix with A = A^T, real or complex; the symmetry is checked.
  HBVIB_SYMMETRIC = 4,
  /// The lower triangle of a matrix with A = A^T, real or complex; the upper one is not read.
  HBVIB_SYMMETRIC_LOWER = 5,
  /// The upper triangle of a matrix with A = A^T, real or complex; the lower one is not read.
  HBVIB_SYMMETRIC_UPPER = 6,
} hbvib_part;

/// A matrix of the caller, read during the call and never kept. Fill it by hbvib_matrix_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// HBVIB_COL_MAJOR, HBVIB_ROW_MAJOR or HBVIB_CSC.
  int32_t storage;
  /// HBVIB_REAL or HBVIB_COMPLEX.
  int32_t scalar;
  /// HBVIB_FULL .. HBVIB_SYMMETRIC_UPPER.
  int32_t part;
  /// Number of rows.
  int64_t rows;
  /// Number of columns.
  int64_t cols;
  /// Dense: distance of columns (rows, if row-major) in numbers; 0 = packed.
  int64_t ld;
  /// The numbers: ld * (cols - 1) + rows of them if column-major, the last entry of col_ptr less
  /// index_base if sparse; each is two doubles if complex.
  const double *values;
  /// Sparse only: cols + 1 offsets, the first equal to index_base.
  const int64_t *col_ptr;
  /// Sparse only: row of each number, counted from index_base.
  const int64_t *row_idx;
  /// 0 or 1: base of the sparse indices, and of the indices in error sentences.
  int32_t index_base;
  /// Must be 0.
  int32_t reserved;
} hbvib_matrix;

/// Fills a matrix description: struct_size, dense column-major, real, symmetric in full, the rest
/// zero. Set rows, cols and values at least.
///
/// a          the struct; untouched on error.
/// size_of_a  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_matrix_init(hbvib_matrix *a, size_t size_of_a);

/// The matrices of a structure.
typedef enum {
  /// M
  HBVIB_MASS = 0,
  /// C
  HBVIB_DAMPING = 1,
  /// K
  HBVIB_STIFFNESS = 2,
  /// D of the structural damping iD in harmonics above 0; positive dissipates.
  HBVIB_STRUCTURAL = 3,
  /// G of the gyroscopic forces Omega G x', skew-symmetric: G = -G^T.
  HBVIB_GYROSCOPIC = 4,
  /// K1 of the stiffness K + Omega^2 K1 at speed; that of softening is negative.
  HBVIB_STIFFNESS_SPEED2 = 5,
} hbvib_matrix_kind;

/* ==============================================================================================
 * Model: structures, their matrices, springs and forces
 * ============================================================================================== */

/// A structure with its contacts and forces, created by hbvib_model_new or hbvib_cyclic_new.
typedef struct hbvib_model hbvib_model;

/// Special degrees of freedom.
typedef enum {
  /// The ground, which does not move.
  HBVIB_GROUND = -1,
} hbvib_special_dof;

/// Creates a plain structure: all matrices zero, no contact, no force.
///
/// ndof  degrees of freedom, 1 .. 2^31.
/// out   receives the model; untouched on error. Free it by hbvib_model_free.
/// Errors: HBVIB_E_DIMENSION, HBVIB_E_NULL, HBVIB_E_OUT_OF_MEMORY. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_model_new(int64_t ndof, hbvib_model **out);

/// Copies a model.
///
/// out  receives the copy; untouched on error. Free it by hbvib_model_free.
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY (being changed), HBVIB_E_NULL, HBVIB_E_OUT_OF_MEMORY.
/// Threads: any number may copy and solve one model.
HBVIB_NODISCARD
hbvib_status hbvib_model_clone(const hbvib_model *model, hbvib_model **out);

/// Frees a model. Branches solved from it stay. NULL is accepted and does nothing.
///
/// Errors: HBVIB_E_HANDLE (freed before, for example), HBVIB_E_BUSY (a call uses the model, which
/// then stays). Threads: any, once.
hbvib_status hbvib_model_free(hbvib_model *model);

/// Number of degrees of freedom of a model, of one sector if it is cyclic; or a negative status.
///
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY (being changed). Threads: any number on one model.
int64_t hbvib_model_dofs(const hbvib_model *model);

/// Number of sectors of a model, 1 for a plain structure; or a negative status.
///
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY (being changed). Threads: any number on one model.
int64_t hbvib_model_sectors(const hbvib_model *model);

/// Number of contacts of a model, including tables, polynomials and forces of the caller; or a
/// negative status. Contacts are numbered from 0 in the order in which they were added.
///
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY (being changed). Threads: any number on one model.
int64_t hbvib_model_contacts(const hbvib_model *model);

/// Sets a matrix of a structure, or of a sector on itself.
///
/// which  HBVIB_MASS .. HBVIB_STIFFNESS_SPEED2.
/// a      ndof x ndof. M must be symmetric or Hermitian, HBVIB_GYROSCOPIC skew-symmetric (in full,
///        which is checked, or one triangle); the others may be HBVIB_GENERAL or HBVIB_SYMMETRIC.
///        Complex entries act on all harmonics above zero, the mean sees their
///        real part, and no structural damping.
/// Errors: HBVIB_E_NOT_FINITE, HBVIB_E_NOT_HERMITIAN, HBVIB_E_INDEX, each naming the entry;
/// HBVIB_E_DIMENSION, HBVIB_E_ARGUMENT, HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL, HBVIB_E_HANDLE,
/// HBVIB_E_BUSY, HBVIB_E_NOT_POSITIVE_DEFINITE (negative diagonal mass), HBVIB_E_OUT_OF_MEMORY.
/// Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_set_matrix(hbvib_model *model, int32_t which, const hbvib_matrix *a);

/// Fixes degrees of freedom: they do not move, whatever matrices, contacts and forces say, now or
/// later. All numbers of degrees of freedom stay as they are; results of fixed ones are 0. On a
/// sector with faces, a pair is fixed on both sides by the same call.
///
/// n     number of entries, >= 0.
/// dofs  degrees of freedom from 0, n numbers.
/// Errors: HBVIB_E_INDEX (dofs), HBVIB_E_ARGUMENT (a pair fixed on one side only, no degree of
/// freedom left, a contact or spring both sides of which would be fixed), HBVIB_E_DIMENSION (n),
/// HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY; the model is then unchanged.
/// Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_fix(hbvib_model *model, int64_t n, const int64_t *dofs);

/// Adds alpha_mass * M + beta_stiffness * K to the damping; a later call replaces an earlier one. K
/// is the stiffness of the structure without contacts.
///
/// alpha_mass, beta_stiffness  finite, 1 / time and time.
/// Errors: HBVIB_E_NOT_FINITE, HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_set_rayleigh(hbvib_model *model, double alpha_mass, double beta_stiffness);

/// Adds many linear springs from arrays; they take no part in Rayleigh damping. All springs are
/// checked before one is added.
///
/// n              number of springs, >= 0.
/// dof_a, dof_b   degrees of freedom of the two sides, from 0, or HBVIB_GROUND; n each.
/// sector_offset  sector of side b counted from that of side a, n numbers; NULL: all 0.
/// stiffness      force per length, of any sign; n numbers.
/// Errors: HBVIB_E_INDEX (dof_a, dof_b), HBVIB_E_ARGUMENT (both sides the same, sector_offset in a
/// plain structure), HBVIB_E_NOT_FINITE, HBVIB_E_DIMENSION (n), HBVIB_E_NULL, HBVIB_E_HANDLE,
/// HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY, naming the entry.
/// Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_add_springs(hbvib_model *model,
                                     int64_t n,
                                     const int64_t *dof_a,
                                     const int64_t *dof_b,
                                     const int64_t *sector_offset,
                                     const double *stiffness);

/// Adds the force Re((re + i im) exp(i harmonic omega t)) on a degree of freedom (of sector 1; the
/// others lag with the wave). Forces on the same degree of freedom and harmonic add up.
///
/// dof       0 .. ndof - 1.
/// harmonic  harmonic number, 0 .. 100000; 0 is a constant force.
/// re, im    finite, force, peak; im must be 0 for a constant force.
/// Errors: HBVIB_E_INDEX (dof), HBVIB_E_ARGUMENT (harmonic, im), HBVIB_E_NOT_FINITE,
/// HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_add_force(hbvib_model *model,
                                   int64_t dof,
                                   int64_t harmonic,
                                   double re,
                                   double im);

/// Removes all forces.
///
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_clear_forces(hbvib_model *model);

/// Sets the loss factor eta of structural damping i eta K in harmonics above 0; a later call
/// replaces an earlier one, 0 removes it. K is the stiffness of the structure, couplings and
/// matrices per nodal diameter included, springs and contacts not. A structure without contacts
/// has the damping ratio eta / 2 at each resonance. Structural damping has no meaning in time:
/// integration and verification refuse it.
///
/// loss_factor  at least 0.
/// Errors: HBVIB_E_NOT_FINITE, HBVIB_E_ARGUMENT, HBVIB_E_HANDLE, HBVIB_E_BUSY.
/// Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_set_loss_factor(hbvib_model *model, double loss_factor);

/// Damps the lowest natural modes of each nodal diameter by given ratios, as the viscous matrix sum
/// of 2 ratio omega (M phi)(M phi)^H; other motions are not damped. The modes are those without
/// contacts, with springs. A later call replaces an earlier one, n = 0 removes the damping. Call it
/// when mass, stiffness, springs and fixed degrees of freedom are complete.
///
/// n       number of modes, 0 .. ndof.
/// ratios  damping ratio of each mode in the order of rising frequency, at least 0; n numbers.
/// Errors: HBVIB_E_DIMENSION (n), HBVIB_E_NOT_FINITE or HBVIB_E_ARGUMENT (ratios),
/// HBVIB_E_UNSUPPORTED (more than 2000 degrees of freedom), those of hbvib_linear_modes, after all
/// of which the model is unchanged; HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY.
/// Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_set_modal_damping(hbvib_model *model, int64_t n, const double *ratios);

/// Sets a fixed speed of rotation Omega: M x'' + (C + Omega G) x' + (K + Omega^2 K1) x + f = f_ex
/// with the matrices HBVIB_GYROSCOPIC and HBVIB_STIFFNESS_SPEED2, and the loads of
/// hbvib_model_set_preload_at_speed. Rayleigh damping and the loss factor use K without K1.
///
/// speed  rad per time unit, finite, of any sign.
/// Errors: HBVIB_E_NOT_FINITE, HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_set_speed(hbvib_model *model, double speed);

/// Ties the speed of rotation to the angular frequency omega of the response: Omega = per_omega *
/// omega, along a whole sweep or mode. An excitation of engine order EO has per_omega = 1 / EO.
///
/// per_omega  finite, of any sign.
/// Errors: HBVIB_E_NOT_FINITE, HBVIB_E_ARGUMENT (a load that decreases with the speed),
/// HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_set_speed_per_omega(hbvib_model *model, double per_omega);

/// Sets the normal load of a contact to preload + per_speed2 * Omega^2; a later call, or one of
/// hbvib_model_set_preload, replaces it. A ring of mass m at the radius R has per_speed2 = m R. A
/// load below zero opens a contact with a normal stiffness, others lose their friction.
///
/// id          number from hbvib_model_add_contact or another function that adds contacts.
/// preload     force at rest, >= 0 and finite.
/// per_speed2  force times time^2, finite; at least 0 where the speed is tied to the frequency.
/// Errors: HBVIB_E_INDEX (id), HBVIB_E_ARGUMENT (no normal load, a negative number),
/// HBVIB_E_NOT_FINITE, HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_set_preload_at_speed(hbvib_model *model,
                                              int64_t id,
                                              double preload,
                                              double per_speed2);

/// Adds the constant force mass_radius * Omega^2 on a degree of freedom, the centrifugal force of a
/// mass at a radius, at the speed Omega of the model. hbvib_model_clear_forces removes it, too.
///
/// dof          0 .. ndof - 1.
/// mass_radius  mass times radius, finite, of any sign.
/// Errors: HBVIB_E_INDEX (dof), HBVIB_E_NOT_FINITE, HBVIB_E_HANDLE, HBVIB_E_BUSY,
/// HBVIB_E_OUT_OF_MEMORY. Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_add_centrifugal(hbvib_model *model, int64_t dof, double mass_radius);

/// Adds the force of an unbalance that rotates with the frequency omega of the response:
/// m_e omega^2 cos(omega t + phase) on dof_x and m_e omega^2 sin(omega t + phase) on dof_y.
/// hbvib_model_clear_forces removes it, too.
///
/// dof_x, dof_y  two degrees of freedom, 0 .. ndof - 1.
/// m_e           mass times eccentricity, finite.
/// phase         radians, finite.
/// Errors: HBVIB_E_INDEX (dof_x, dof_y), HBVIB_E_ARGUMENT (the same degree of freedom twice),
/// HBVIB_E_NOT_FINITE, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY.
/// Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_add_unbalance(hbvib_model *model,
                                       int64_t dof_x,
                                       int64_t dof_y,
                                       double m_e,
                                       double phase);

/// Blocks of a matrix, by the sectors of their columns.
typedef enum {
  /// Rows and columns of the same sector: all of a plain structure.
  HBVIB_BLOCK_OWN = 0,
  /// Columns of the next sector.
  HBVIB_BLOCK_NEXT = 1,
  /// Columns of the previous sector, where it was given: else the transpose of HBVIB_BLOCK_NEXT.
  HBVIB_BLOCK_PREVIOUS = 2,
} hbvib_block;

/// The engine order of a model, as hbvib_cyclic_set_wave takes it; 0 for a plain structure.
///
/// engine_order  receives the number; untouched on error.
/// Errors: HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_model_wave(const hbvib_model *model, int64_t *engine_order);

/// The entries of a matrix of a model, or of a block of it, each once, column after column, without
/// Rayleigh damping, springs and contacts. Rows and columns of fixed degrees of freedom are empty;
/// those of the right face of a sector are in the blocks of the left one.
///
/// which     HBVIB_MASS .. HBVIB_STIFFNESS_SPEED2.
/// block     HBVIB_BLOCK_OWN, HBVIB_BLOCK_NEXT or HBVIB_BLOCK_PREVIOUS.
/// capacity  entries that fit into each array.
/// row       receives numbers of rows, or NULL.
/// column    receives numbers of columns, or NULL.
/// value     receives complex entries, 2 * capacity doubles, or NULL.
/// count     receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_ARGUMENT (which, block), HBVIB_E_UNSUPPORTED (given per nodal diameter),
/// HBVIB_E_DIMENSION (capacity), HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY (being changed).
/// Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_model_matrix(const hbvib_model *model,
                                int32_t which,
                                int32_t block,
                                int64_t capacity,
                                int64_t *row,
                                int64_t *column,
                                double *value,
                                int64_t *count);

/// The linear springs of a model, in the order in which they were added.
///
/// capacity       numbers that fit into each array.
/// dof_a, dof_b   receive numbers of degrees of freedom or HBVIB_GROUND, or NULL.
/// sector_offset  receives numbers of sectors from side a to side b, or NULL.
/// stiffness      receives the stiffnesses, or NULL.
/// count          receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_DIMENSION (capacity), HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY.
/// Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_model_springs(const hbvib_model *model,
                                 int64_t capacity,
                                 int64_t *dof_a,
                                 int64_t *dof_b,
                                 int64_t *sector_offset,
                                 double *stiffness,
                                 int64_t *count);

/// The forces of a model, in the order in which they were added; an unbalance is two of them.
///
/// capacity    numbers that fit into each array.
/// dof         receives numbers of degrees of freedom, or NULL.
/// harmonic    receives numbers of harmonics, or NULL.
/// force       receives complex peak values, 2 * capacity doubles, or NULL; over the square of the
///             angular frequency where unbalance is 1.
/// unbalance   receives numbers: 1 for a force that grows with the square of the frequency, else 0;
///             or NULL.
/// count       receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_DIMENSION (capacity), HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY.
/// Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_model_forces(const hbvib_model *model,
                                int64_t capacity,
                                int64_t *dof,
                                int64_t *harmonic,
                                double *force,
                                int64_t *unbalance,
                                int64_t *count);

/// Saves a model as bytes: matrices, faces, contacts, springs, forces, damping and speed. The bytes
/// begin with the version of their format and end with a checksum; they are the same on all
/// machines, and a loaded model solves to the same bits. Write them to a file or send them to
/// another process as they are.
///
/// capacity  bytes that fit into `bytes`.
/// bytes     receives the model, or NULL: then only the size is returned.
/// size      receives the number of bytes that the model takes.
/// Errors: HBVIB_E_UNSUPPORTED (a force of the caller, naming its contact), HBVIB_E_DIMENSION
/// (capacity too small: bytes has no model), HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY (being
/// changed). Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_model_save(const hbvib_model *model,
                              int64_t capacity,
                              void *bytes,
                              int64_t *size);

/// Loads a model that hbvib_model_save saved.
///
/// length  number of bytes, >= 0.
/// bytes   the saved model.
/// out     receives the model; untouched on error. Free it by hbvib_model_free.
/// Errors: HBVIB_E_ARGUMENT (no saved model, or one that is incomplete or damaged),
/// HBVIB_E_UNSUPPORTED (saved by a newer library), HBVIB_E_DIMENSION (length), HBVIB_E_NULL,
/// HBVIB_E_OUT_OF_MEMORY; others where bytes that were not saved by the library describe no model.
/// Memory is taken in proportion to length at most. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_model_load(int64_t length, const void *bytes, hbvib_model **out);

/* ==============================================================================================
 * Cyclic structures: sectors, their faces and couplings, diameters, engine order, aerodynamics
 * ============================================================================================== */

/// Creates a cyclic structure, described by one of its sectors, under engine order 0: all matrices
/// zero, no contact, no force.
///
/// ndof_sector  degrees of freedom of the sector, 1 .. 2^31.
/// sectors      number of equal sectors N, 1 .. 2^20.
/// out          receives the model; untouched on error. Free it by hbvib_model_free.
/// Errors: HBVIB_E_DIMENSION (ndof_sector), HBVIB_E_ARGUMENT (sectors), HBVIB_E_NULL,
/// HBVIB_E_OUT_OF_MEMORY. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_cyclic_new(int64_t ndof_sector, int64_t sectors, hbvib_model **out);

/// Sets the coupling of a sector to the next one: rows of sector s, columns of s + 1. The coupling
/// to the previous sector is its transpose unless hbvib_cyclic_set_coupling_previous is called.
///
/// which    HBVIB_MASS .. HBVIB_STIFFNESS_SPEED2; the coupling of HBVIB_GYROSCOPIC to the previous
///          sector is minus the transpose.
/// to_next  ndof x ndof, any matrix: `part` is no promise of symmetry here; a triangle is completed
///          by its mirror image.
/// Where sector s + 1 lags by phi, harmonic p has the matrix A0 + A1 exp(-i p phi) + A1^T exp(i p
/// phi).
/// Errors: as hbvib_model_set_matrix; HBVIB_E_UNSUPPORTED for a plain structure.
/// Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_cyclic_set_coupling(hbvib_model *model,
                                       int32_t which,
                                       const hbvib_matrix *to_next);

/// Sets the coupling of a sector (rows) to the previous one (columns), for damping and stiffness
/// without symmetry.
///
/// which        any but HBVIB_MASS and HBVIB_GYROSCOPIC, which have a symmetry.
/// to_previous  ndof x ndof, any matrix.
/// Errors: as hbvib_cyclic_set_coupling; HBVIB_E_UNSUPPORTED for the mass.
/// Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_cyclic_set_coupling_previous(hbvib_model *model,
                                                int32_t which,
                                                const hbvib_matrix *to_previous);

/// Sets the matrix of the wave in which sector s + 1 lags by 2 pi diameter / N, instead of sector
/// blocks. A wave of which only the other sense was given has the conjugate of that. A solve that
/// needs a harmonic without a matrix of its nodal diameter is refused.
///
/// which     HBVIB_MASS .. HBVIB_STIFFNESS_SPEED2.
/// diameter  signed nodal diameter, modulo N: -N/2 < d <= N/2; 0 for a plain structure.
/// a         ndof x ndof, Hermitian; all but M may be HBVIB_GENERAL or HBVIB_SYMMETRIC.
/// Errors: as hbvib_model_set_matrix; HBVIB_E_ARGUMENT for a diameter of a plain structure
/// and for matrices that were given by sector blocks. Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_cyclic_set_diameter(hbvib_model *model,
                                       int32_t which,
                                       int64_t diameter,
                                       const hbvib_matrix *a);

/// A nodal diameter that is no number of waves; these are signed and count modulo N.
typedef enum {
  /// The wave that the engine order of the model excites, or that of the same call.
  HBVIB_DIAMETER_OF_ENGINE_ORDER = -2147483647,
} hbvib_special_diameter;

/// The signed nodal diameter of a number of waves per turn, as results have it: waves mod N in
/// -N/2 < d <= N/2. It is the wave that the engine order `waves` excites; in harmonic p that of
/// p waves. 0 for a plain structure.
///
/// diameter  receives it.
/// Errors: HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY (being changed). Threads: any number on one
/// model.
HBVIB_NODISCARD
hbvib_status hbvib_cyclic_signed_diameter(const hbvib_model *model,
                                          int64_t waves,
                                          int64_t *diameter);

/// Sets the engine order EO of the excitation: sector s + 1 lags behind sector s by 2 pi EO / N per
/// harmonic, so that harmonic p has the nodal diameter p EO mod N. Any sign and size; without
/// effect on a plain structure.
///
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_cyclic_set_wave(hbvib_model *model, int64_t engine_order);

/// Motion that aerodynamic forces follow.
typedef enum {
  /// Displacements: coefficients are forces per displacement.
  HBVIB_AERO_DISPLACEMENT = 0,
  /// Velocities: coefficients are forces per velocity.
  HBVIB_AERO_VELOCITY = 1,
} hbvib_aero_form;

/// Sets aerodynamic forces, which follow the motion of this and other sectors. On the right-hand
/// side f_i of sector s is the sum over k and j of c(k, i, j) x_j of sector s + offsets(k), or of
/// the velocities x_j'. In the wave in which sector s + 1 lags by 2 pi d / N the forces are A(d) x,
/// A(d) = sum c(k) exp(-i offsets(k) 2 pi d / N), per velocity i p omega A(d) x in harmonic p,
/// which belongs to d = p EO mod N. Natural modes and modal damping are those without aerodynamic
/// forces; all other analyses have them. A later call of the same form replaces an earlier one.
///
/// n_dofs        degrees of freedom that take part, >= 0; 0 removes the forces of this form.
/// dofs          their numbers, from 0, each once; n_dofs numbers. Fixed ones have no effect.
/// n_offsets     number of offsets, >= 0; 0 removes the forces of this form.
/// coefficients  complex force per displacement or velocity: for each offset a square matrix, rows
///               (forces) one after the other; 2 * n_offsets * n_dofs * n_dofs doubles, finite.
///               The mean has the real part. Imaginary parts mean nothing in time: time
///               integration, verification and stability refuse them.
/// offsets       sector of the motion counted from that of the force, 0 the same sector, each
///               sector once, -(N - 1) .. N - 1; n_offsets numbers.
/// form          HBVIB_AERO_DISPLACEMENT or HBVIB_AERO_VELOCITY.
/// Errors: HBVIB_E_UNSUPPORTED for a plain structure; HBVIB_E_INDEX (dofs), HBVIB_E_ARGUMENT (dofs
/// or offsets twice, form), HBVIB_E_NOT_FINITE (coefficients), HBVIB_E_DIMENSION (n_dofs,
/// n_offsets), after all of which the model is unchanged; HBVIB_E_NULL, HBVIB_E_HANDLE,
/// HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_cyclic_set_aero(hbvib_model *model,
                                   int64_t n_dofs,
                                   const int64_t *dofs,
                                   int64_t n_offsets,
                                   const double *coefficients,
                                   const int64_t *offsets,
                                   int32_t form);

/// The coefficients of the aerodynamic forces of a form, in the order in which they were given.
///
/// form         HBVIB_AERO_DISPLACEMENT or HBVIB_AERO_VELOCITY.
/// capacity     entries that fit into each array.
/// dof_force    receives numbers of the degrees of freedom of forces, or NULL.
/// dof_motion   receives numbers of the degrees of freedom of motions, or NULL.
/// offset       receives numbers of sectors from that of the force to that of the motion, or NULL.
/// coefficient  receives complex coefficients, 2 * capacity doubles, or NULL.
/// count        receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_ARGUMENT (form), HBVIB_E_DIMENSION (capacity), HBVIB_E_NULL, HBVIB_E_HANDLE,
/// HBVIB_E_BUSY (being changed). Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_cyclic_aero(const hbvib_model *model,
                               int32_t form,
                               int64_t capacity,
                               int64_t *dof_force,
                               int64_t *dof_motion,
                               int64_t *offset,
                               double *coefficient,
                               int64_t *count);

/// Frame of the degrees of freedom of a sector with faces.
typedef enum {
  /// x, y and z of each node, and rotations about them: the axes of both faces are equal.
  HBVIB_CARTESIAN = 0,
  /// Any frame that turns with the sector, as radius, circumference and axis at each node.
  HBVIB_CYLINDRICAL = 1,
} hbvib_sector_frame;

/// A sector with degrees of freedom on both faces, as a finite-element program writes it. The
/// right face of a sector is the left one of the next. Fill it by hbvib_sector_init, then set ndof,
/// sectors, engine_order and the faces.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// HBVIB_CARTESIAN or HBVIB_CYLINDRICAL.
  int32_t frame;
  /// Degrees of freedom of the sector, both faces and the fixed ones included, 1 .. 2^31.
  int64_t ndof;
  /// Number of equal sectors N, 2 .. 2^20.
  int64_t sectors;
  /// Engine order of the wave, see hbvib_cyclic_set_wave; its sign is the sense of the wave.
  int64_t engine_order;
  /// Degrees of freedom of a node on a face: 3 (x, y, z) or 6 (and the rotations about them) in a
  /// Cartesian frame, any number in a cylindrical one.
  int64_t components;
  /// Degrees of freedom of the left face, node after node, left_len numbers; -1 where a component
  /// is missing, which then does not move.
  const int64_t *left;
  /// Entries in left.
  int64_t left_len;
  /// Those of the right face, each the image of the entry of left at its place.
  const int64_t *right;
  /// Entries in right.
  int64_t right_len;
  /// Degrees of freedom that do not move, fixed_len numbers; or NULL.
  const int64_t *fixed;
  /// Entries in fixed.
  int64_t fixed_len;
  /// Axis of the wheel, of any length; it passes through the origin. The axis has no effect in a
  /// cylindrical frame without coordinates.
  double axis[3];
  /// 1: sector s + 1 follows at +2 pi / N about the axis; -1: at -2 pi / N. It decides about the
  /// axes of a Cartesian frame and about the check of coordinates, not about the wave.
  int32_t direction;
  /// 0.
  int32_t reserved;
  /// Cartesian positions of the nodes of the left face, three for each; NULL with that of the
  /// right one: not checked.
  const double *left_coordinates;
  /// Those of the right face.
  const double *right_coordinates;
} hbvib_sector;

/// Fills the description of a sector: a Cartesian frame with 3 components per node, the z axis,
/// direction 1; ndof, sectors, engine_order and the faces must be set.
///
/// s          the struct; untouched on error.
/// size_of_s  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_sector_init(hbvib_sector *s, size_t size_of_s);

/// Creates a cyclic structure from a sector with faces: all matrices zero, no contact, no force.
/// Its couplings follow from the matrices of the sector alone, which hbvib_model_set_matrix sets:
/// K0 = T0^T K T0 + T1^T K T1 and K1 = T0^T K T1, where u = T0 q(s) + T1 q(s + 1) is the motion of
/// sector s (Thomas 1979, doi:10.1002/nme.1620140107).
///
/// The numbering of the sector is kept for all that follows: matrices, contacts, forces, options
/// and results. Fixed degrees of freedom have results 0; those on the right face move and are
/// loaded with the phase of the next sector. In a Cartesian frame, side b of a contact in another
/// sector is turned into the axes of side a; unless all nodes have consecutive degrees of freedom
/// as those of the faces have, such a contact needs a normal, and x, y, z of both nodes.
/// Superelements (Craig-Bampton) are sectors as well: their modal degrees of freedom are on no
/// face.
///
/// sector  the description; it is copied.
/// out     receives the model; untouched on error. Free it by hbvib_model_free.
/// Errors: HBVIB_E_DIMENSION (ndof, faces of different length, components), HBVIB_E_INDEX (left,
/// right, fixed), HBVIB_E_ARGUMENT (sectors, frame, direction, axis; a degree of freedom in both
/// faces or twice in one, a pair fixed on one side only, a node on the axis, coordinates that
/// contradict direction or sectors), HBVIB_E_NOT_FINITE, naming pair and degree of freedom;
/// HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL, HBVIB_E_OUT_OF_MEMORY. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_cyclic_from_sector(const hbvib_sector *sector, hbvib_model **out);

/// Makes the whole wheel of a cyclic model as a plain model, for every analysis. Degree of freedom
/// i of sector s is s * ndof + i and contact c is s * contacts + c, with ndof degrees of freedom
/// and `contacts` contacts of a sector; sectors count from 0. The phases of the engine order are
/// in the forces. Forces of several engine orders e at one speed are those in harmonics e of a
/// model under engine order 1. A degree of freedom on the right face of a sector keeps its number;
/// the left face of the next sector moves it, each in the frame of its own sector.
///
/// cyclic  model of a sector; later changes of it have no effect on the wheel.
/// out     receives the wheel; untouched on error. Free it by hbvib_model_free.
/// Errors: HBVIB_E_UNSUPPORTED (a plain model, complex aerodynamic forces, aerodynamic forces per
/// displacement with damping by stiffness, a contact or spring with another sector in a Cartesian
/// frame), HBVIB_E_ARGUMENT (a nodal diameter without matrix), HBVIB_E_DIMENSION (too large),
/// HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: any number on one
/// model.
HBVIB_NODISCARD
hbvib_status hbvib_wheel_new(const hbvib_model *cyclic, hbvib_model **out);

/// Quantities that differ between the sectors of a wheel, by delta of each.
typedef enum {
  /// Stiffness of the blade times 1 + delta.
  HBVIB_MISTUNING_STIFFNESS = 0,
  /// Frequencies of the blade, clamped where it is attached, times 1 + delta.
  HBVIB_MISTUNING_FREQUENCY = 1,
  /// Mass of the degrees of freedom of the blade times 1 + delta.
  HBVIB_MISTUNING_MASS = 2,
  /// Damping of the blade over its attachment times 1 + delta: damping matrix, Rayleigh damping.
  HBVIB_MISTUNING_DAMPING = 3,
  /// Normal load of a contact times 1 + delta.
  HBVIB_MISTUNING_PRELOAD = 4,
  /// Forces on the sector times 1 + delta.
  HBVIB_MISTUNING_FORCE = 5,
} hbvib_mistuning;

/// Mistunes a wheel. Changes of matrices refer to the cyclic model, and several calls add up; loads
/// and forces are multiplied. A blade is given by its degrees of freedom: its stiffness is that of
/// its motion relative to the one that its attachment carries along, so that a rigid motion of a
/// free blade has none and the clamped blade has all of it. Rayleigh damping follows the matrices.
///
/// wheel      made by hbvib_wheel_new of `cyclic`; unchanged on error.
/// cyclic     the model of the sector.
/// kind       a value of enum hbvib_mistuning.
/// n_dofs     degrees of freedom of the blade of a sector, 0 with a direction and for
///            HBVIB_MISTUNING_PRELOAD and HBVIB_MISTUNING_FORCE.
/// dofs       their numbers, n_dofs numbers, each once, none on the right face.
/// direction  matrix of a sector, delta times which is added to stiffness, mass or damping, instead
///            of a blade; not with HBVIB_MISTUNING_FREQUENCY. Or NULL.
/// contact    contact of the sector for HBVIB_MISTUNING_PRELOAD, -1: all with a normal load; else
///            without effect.
/// sectors    length of delta, the number of sectors.
/// delta      of each sector, finite; with dofs at least -1.
/// Errors: HBVIB_E_ARGUMENT (kind, dofs twice or none that moves, neither dofs nor direction, or
/// both; delta with dofs; a load below 0; matrices of `cyclic` that the wheel was not made of),
/// HBVIB_E_INDEX (dofs, contact), HBVIB_E_DIMENSION (another model or number of sectors, n_dofs),
/// HBVIB_E_NOT_FINITE (delta), HBVIB_E_SINGULAR (the stiffness of the clamped blade),
/// HBVIB_E_UNSUPPORTED (a stiffness without symmetry, an attachment that is too large), those of
/// hbvib_model_set_matrix for the direction; HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY,
/// HBVIB_E_OUT_OF_MEMORY. Threads: one at a time per wheel.
HBVIB_NODISCARD
hbvib_status hbvib_wheel_mistune(hbvib_model *wheel,
                                 const hbvib_model *cyclic,
                                 int32_t kind,
                                 int64_t n_dofs,
                                 const int64_t *dofs,
                                 const hbvib_matrix *direction,
                                 int64_t contact,
                                 int64_t sectors,
                                 const double *delta);

/* ==============================================================================================
 * Contacts: friction, unilateral contacts, nonlinear springs and dampers, patches
 * ============================================================================================== */

/// Contact laws.
typedef enum {
  /// Elastic Coulomb friction with constant normal load in one direction: a spring kt in series
  /// with a slider of limit mu * preload.
  HBVIB_JENKINS = 1,
  /// Elastic Coulomb friction in one tangential direction, t1, under the normal load
  /// N = max(preload + kn * (closing - gap), 0), closing = x_b - x_a along n: a spring kt in series
  /// with a slider of limit mu * N. N pushes the sides apart; where it is 0 the contact is open.
  HBVIB_FRICTION_2D = 2,
  /// The same in the plane of t1 and t2, where slip follows the direction of the force. Without a
  /// degree of freedom along n the load is the preload.
  HBVIB_FRICTION_3D = 3,
  /// Spring along the normal that opens: it pushes the sides apart with
  /// N = max(preload + kn * (closing - gap), 0), where closing = x_b - x_a along n.
  HBVIB_UNILATERAL = 4,
  /// Spring with a cubic term in one direction: f = kt * y + cubic * y^3.
  HBVIB_CUBIC = 5,
  /// Smoothed Coulomb friction in one direction:
  /// f = mu * preload * tanh(y' / velocity).
  HBVIB_REGULARISED = 6,
  /// Read back only (hbvib_model_contact): a spring by hbvib_model_add_table.
  HBVIB_TABLE = 7,
  /// Read back only: springs and dampers by hbvib_model_add_spring_damper, _add_polynomial or
  /// _add_stiffness_tensors.
  HBVIB_POLYNOMIAL = 8,
  /// Read back only: a force of the caller, by hbvib_model_add_user_force.
  HBVIB_CALLER_LAW = 9,
} hbvib_contact_kind;

/// A contact between two degrees of freedom, or between one and the ground. Fill it by
/// hbvib_contact_init. The force acts on y = x_a - x_b, as +f on side a and -f on side b in
/// M x'' + C x' + K x + f = f_ex.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// HBVIB_JENKINS .. HBVIB_REGULARISED.
  int32_t kind;
  /// Side a: degrees of freedom from 0 in the directions t1, t2, n, or HBVIB_GROUND.
  /// HBVIB_FRICTION_2D acts along t1 and n, HBVIB_FRICTION_3D along all three, HBVIB_UNILATERAL
  /// along n, the others along t1; unused places must be HBVIB_GROUND. With `normal` all may be
  /// used.
  int64_t dof_a[3];
  /// Side b, likewise.
  int64_t dof_b[3];
  /// Cyclic models: side b lies in sector s + sector_offset, -(N - 1) .. N - 1. 0 in plain ones.
  int64_t sector_offset;
  /// Tangential stiffness of HBVIB_JENKINS, HBVIB_FRICTION_2D and HBVIB_FRICTION_3D, stiffness of
  /// HBVIB_CUBIC at small motion, force per length, >= 0; 0 for HBVIB_UNILATERAL and
  /// HBVIB_REGULARISED. Infinite: a HBVIB_JENKINS contact is rigid while it sticks, in forced
  /// responses.
  double kt;
  /// Normal stiffness, force per length, >= 0, of HBVIB_UNILATERAL; > 0 of HBVIB_FRICTION_2D and
  /// HBVIB_FRICTION_3D, but 0 under a constant load; 0 for others.
  double kn;
  /// Friction coefficient, >= 0; 0 for HBVIB_UNILATERAL and HBVIB_CUBIC.
  double mu;
  /// Normal load at rest where `gap` is 0, force, >= 0; infinite for HBVIB_JENKINS alone, a
  /// contact that never slips; 0 for HBVIB_CUBIC.
  double preload;
  /// Closing at which HBVIB_UNILATERAL, HBVIB_FRICTION_2D and HBVIB_FRICTION_3D with a varying
  /// load begin to press if they have no preload, any sign: with a negative gap they press at
  /// rest. 0 for others.
  double gap;
  /// Stiffness per length squared (force / length^3) of HBVIB_CUBIC, any sign; 0 for others.
  double cubic;
  /// Velocity at which HBVIB_REGULARISED reaches 76 % (tanh 1) of its slip limit, > 0; 0 for
  /// others.
  double velocity;
  /// Direction n in the axes of the three degrees of freedom of each side, of any length. Zero,
  /// with `tangent`: the degrees of freedom lie along t1, t2 and n themselves.
  double normal[3];
  /// Direction t1, orthogonal to `normal`, of any length; t2 is n x t1. Zero: any in the plane,
  /// for HBVIB_FRICTION_3D and HBVIB_UNILATERAL alone.
  double tangent[3];
  /// Side a is a point of a rigid body: rotations of the body about the axes of `dof_a`, which are
  /// then the translations of its centre of mass, or HBVIB_GROUND; with `normal` only.
  int64_t rotation[3];
  /// The point of the contact from the centre of mass of that body, in the axes of `dof_a`.
  double arm[3];
  /// Angle in radians by which the axes of `dof_b` are turned about the third one of `dof_a`; with
  /// `normal` only, which is in the axes of `dof_a`.
  double turn;
} hbvib_contact;

/// Fills a contact description: struct_size, every degree of freedom HBVIB_GROUND, the rest zero.
/// Then set kind, the degrees of freedom and the constants of the kind:
/// HBVIB_JENKINS      first places of dof_a and dof_b; kt, mu, preload;
/// HBVIB_FRICTION_2D  first and third places; kt, kn, mu, preload or gap;
/// HBVIB_FRICTION_3D  all places; kt, kn, mu, preload or gap; under a constant load the first and
///                    second places; kt, mu, preload;
/// HBVIB_UNILATERAL   third places; kn, gap or preload;
/// HBVIB_CUBIC        first places; kt, cubic;
/// HBVIB_REGULARISED  first places; mu, preload, velocity.
/// With normal (and tangent), whatever the kind, all places of a node that moves in three
/// directions.
///
/// c          the struct; untouched on error.
/// size_of_c  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_contact_init(hbvib_contact *c, size_t size_of_c);

/// Adds a contact. Equal contacts add up.
///
/// c   the description.
/// id  receives the number of the contact, counted from 0; may be NULL; untouched on error.
/// Errors: HBVIB_E_INDEX (dof_a, dof_b), HBVIB_E_ARGUMENT (kind, constants out of range, normal and
/// tangent that are not orthogonal directions, equal sides, a degree of freedom twice on one side,
/// sector_offset in a plain structure), HBVIB_E_NOT_FINITE, HBVIB_E_STRUCT_SIZE,
/// HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY.
/// Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_add_contact(hbvib_model *model, const hbvib_contact *c, int64_t *id);

/// Changes the normal load of a contact. HBVIB_CUBIC, tables, polynomials and forces of the caller
/// have no normal load: HBVIB_E_ARGUMENT.
///
/// id       number from hbvib_model_add_contact or another function that adds contacts.
/// preload  force, >= 0; infinite for HBVIB_JENKINS alone, which then never slips.
/// Errors: HBVIB_E_INDEX (id), HBVIB_E_ARGUMENT, HBVIB_E_NOT_FINITE, HBVIB_E_HANDLE, HBVIB_E_BUSY.
/// Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_set_preload(hbvib_model *model, int64_t id, double preload);

/// Places the slider of a friction contact before any motion: the residual state that an assembly
/// or an earlier load has left. A contact that sticks through the period has the tangential force
/// kt (x - place); a place from which its limit would drag the slider acts as the nearest one
/// within. A contact that slips or opens in every period forgets it.
///
/// id         number from hbvib_model_add_contact or another function that adds contacts.
/// direction  0 for t1; 1 for t2, of HBVIB_FRICTION_3D alone.
/// place      length, finite; 0 at first.
/// Errors: HBVIB_E_INDEX (id, direction), HBVIB_E_UNSUPPORTED (the contact has no slider there, or
/// an infinite preload), HBVIB_E_NOT_FINITE, HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: one at a time
/// per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_set_slider(hbvib_model *model,
                                    int64_t id,
                                    int64_t direction,
                                    double place);

/// Adds many Jenkins contacts from arrays; entry i of each array describes contact i. All contacts
/// are checked before one is added.
///
/// n              number of contacts, >= 0.
/// dof_a, dof_b   degrees of freedom of the two sides, from 0, or HBVIB_GROUND; n each.
/// sector_offset  sector of side b counted from that of side a, n numbers; NULL: all 0.
/// kt, mu, preload  tangential stiffness, friction coefficient, normal load; n each.
/// first_id       receives the number of the first contact, the others follow; may be NULL.
/// Errors: as hbvib_model_add_contact, naming the entry; HBVIB_E_DIMENSION (n).
/// Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_add_jenkins(hbvib_model *model,
                                     int64_t n,
                                     const int64_t *dof_a,
                                     const int64_t *dof_b,
                                     const int64_t *sector_offset,
                                     const double *kt,
                                     const double *mu,
                                     const double *preload,
                                     int64_t *first_id);

/// Adds an Iwan joint with four parameters (Segalman 2005): Jenkins contacts in parallel whose slip
/// limits are distributed so that the loss per cycle grows with the power 3 + chi of the amplitude.
///
/// dof_a, dof_b   degrees of freedom of the two sides, from 0, or HBVIB_GROUND.
/// sector_offset  sector of side b counted from that of side a; 0 in plain models.
/// slip_force     force at which the whole joint slips, > 0.
/// stiffness      tangent stiffness at rest, force per length, > 0.
/// chi            -1 < chi <= 0.
/// beta           ratio of the stiffness that slips last to the rest of the stiffness, >= 0.
/// elements       number of Jenkins contacts, 2 .. 10000; they span five decades of displacement.
/// first_id       receives the number of the first of them, the others follow; may be NULL.
/// Errors: HBVIB_E_INDEX (dof_a, dof_b), HBVIB_E_ARGUMENT and HBVIB_E_NOT_FINITE (parameters, equal
/// sides, sector_offset in a plain structure), HBVIB_E_DIMENSION (elements < 0),
/// HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY.
/// Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_add_iwan(hbvib_model *model,
                                  int64_t dof_a,
                                  int64_t dof_b,
                                  int64_t sector_offset,
                                  double slip_force,
                                  double stiffness,
                                  double chi,
                                  double beta,
                                  int64_t elements,
                                  int64_t *first_id);

/// Adds a spring whose force is given by a table, f = f(y), y = x_a - x_b: linear between the
/// points, and beyond them along the first and the last line. Its Fourier integrals are exact.
///
/// dof_a, dof_b   degrees of freedom of the two sides, from 0, or HBVIB_GROUND.
/// sector_offset  sector of side b counted from that of side a; 0 in plain models.
/// n              number of points, >= 2.
/// displacement   y of the points, strictly ascending; n numbers.
/// force          f of the points; n numbers. A table whose force at y = 0 is not 0 loads the
///                structure at rest.
/// id             receives the number of the contact, from 0; may be NULL; untouched on error.
/// Errors: HBVIB_E_INDEX (dof_a, dof_b), HBVIB_E_DIMENSION (n), HBVIB_E_ARGUMENT (points that are
/// not sorted, equal sides, sector_offset in a plain structure), HBVIB_E_NOT_FINITE, HBVIB_E_NULL,
/// HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY.
/// Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_add_table(hbvib_model *model,
                                   int64_t dof_a,
                                   int64_t dof_b,
                                   int64_t sector_offset,
                                   int64_t n,
                                   const double *displacement,
                                   const double *force,
                                   int64_t *id);

/// Adds a spring and a damper of polynomial form between two degrees of freedom: `f = sum spring[k]
/// y^(k+1) + sum damper[k] v^(k+1)`, k = 0, 1, ..., with y = x_a - x_b and v = y'. Harmonic balance
/// of it is exact.
///
/// dof_a, dof_b   degrees of freedom of the two sides, from 0, or HBVIB_GROUND.
/// sector_offset  sector of side b counted from that of side a; 0 in plain models.
/// n_spring       number of stiffness coefficients, 0 .. 15.
/// spring         coefficients of y, y^2, ..., of any sign; NULL if there are none.
/// n_damper       number of damping coefficients, 0 .. 15; not 0 if n_spring is.
/// damper         coefficients of v, v^2, ..., of any sign; NULL if there are none.
/// id             receives the number of the contact, from 0; may be NULL; untouched on error.
/// Errors: HBVIB_E_INDEX (dof_a, dof_b), HBVIB_E_DIMENSION (n_spring, n_damper), HBVIB_E_ARGUMENT
/// (equal sides, sector_offset in a plain structure), HBVIB_E_NOT_FINITE, HBVIB_E_NULL,
/// HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_add_spring_damper(hbvib_model *model,
                                           int64_t dof_a,
                                           int64_t dof_b,
                                           int64_t sector_offset,
                                           int64_t n_spring,
                                           const double *spring,
                                           int64_t n_damper,
                                           const double *damper,
                                           int64_t *id);

/// Adds springs and dampers of polynomial form over the motions x_j of several degrees of freedom
/// over the ground and their velocities v_j: term t adds `coefficient[t] * product of
/// x_j^x_powers[t][j] * product of v_j^v_powers[t][j]` to the force on degree of freedom
/// `dofs[direction[t]]`. Harmonic balance of it is exact.
///
/// dofs         degrees of freedom from 0, each once; n_dofs numbers.
/// n_dofs       their number, >= 1.
/// n_terms      number of terms, >= 1.
/// direction    place in dofs of the force that a term adds to, from 0; n_terms numbers.
/// coefficient  of any sign; n_terms numbers.
/// x_powers     exponents of the motions, 0 .. 15, n_terms x n_dofs, term after term; NULL: all 0.
/// v_powers     exponents of the velocities, likewise; NULL: all 0. No term may have exponents 0
///              alone.
/// id           receives the number of the contact, from 0; may be NULL; untouched on error.
/// Errors: HBVIB_E_INDEX (dofs, direction), HBVIB_E_DIMENSION (n_dofs, n_terms), HBVIB_E_ARGUMENT
/// (exponents, a degree of freedom twice), HBVIB_E_NOT_FINITE, HBVIB_E_NULL, HBVIB_E_HANDLE,
/// HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_add_polynomial(hbvib_model *model,
                                        const int64_t *dofs,
                                        int64_t n_dofs,
                                        int64_t n_terms,
                                        const int64_t *direction,
                                        const double *coefficient,
                                        const int32_t *x_powers,
                                        const int32_t *v_powers,
                                        int64_t *id);

/// Adds the quadratic and cubic stiffness of a reduced structure, over the motions of degrees of
/// freedom over the ground: `f_i = sum quadratic[i][j][k] x_j x_k + sum cubic[i][j][k][l] x_j x_k
/// x_l` on degree of freedom `dofs[i]`. The linear stiffness is that of the model. No symmetry of
/// the tensors is assumed. Harmonic balance of it is exact.
///
/// dofs       degrees of freedom from 0, each once; n numbers.
/// n          their number, >= 1.
/// quadratic  n^3 numbers, the last index running fastest, or NULL.
/// cubic      n^4 numbers, likewise, or NULL. Not both may be NULL.
/// id         receives the number of the contact, from 0; may be NULL; untouched on error.
/// Errors: HBVIB_E_INDEX (dofs), HBVIB_E_DIMENSION (n), HBVIB_E_ARGUMENT (a degree of freedom
/// twice), HBVIB_E_NOT_FINITE, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY.
/// Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_add_stiffness_tensors(hbvib_model *model,
                                               const int64_t *dofs,
                                               int64_t n,
                                               const double *quadratic,
                                               const double *cubic,
                                               int64_t *id);

/// Adds a contact patch as n contacts: n node pairs of two surfaces, each with its share of the
/// area. All contacts are checked before one is added.
///
/// law       the law per unit of area: kt and kn are force per length and area, cubic is force per
///           length^3 and area, preload is a pressure. Its sector_offset is that of all pairs; its
///           degrees of freedom, normal and tangent are ignored. Fill it by hbvib_contact_init.
/// n         number of pairs, >= 0.
/// dof_a     degrees of freedom of the nodes on side a along three orthogonal axes, 3 n numbers,
///           node after node; or HBVIB_GROUND.
/// dof_b     the same on side b; NULL: the ground.
/// normal    directions n in these axes, of any length, 3 n numbers. Closing is x_b - x_a along n:
///           n points from side b to side a.
/// tangent   directions t1, orthogonal to n, of any length, 3 n numbers; NULL: any in the plane,
///           for HBVIB_FRICTION_3D and HBVIB_UNILATERAL alone.
/// area      >= 0; n numbers.
/// pressure  pressure at rest, >= 0, n numbers; NULL: preload of the law.
/// gap       closing at which a pair without pressure begins to press, any sign, n numbers; NULL:
///           gap of the law.
/// first_id  receives the number of the first contact, the others follow; may be NULL; untouched on
///           error.
/// Errors: HBVIB_E_INDEX (dof_a, dof_b), HBVIB_E_DIMENSION (n), HBVIB_E_ARGUMENT (law, directions,
/// area, pressure, equal sides, a degree of freedom twice on one side), HBVIB_E_NOT_FINITE,
/// naming the entry; HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY,
/// HBVIB_E_OUT_OF_MEMORY. Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_add_patch(hbvib_model *model,
                                   const hbvib_contact *law,
                                   int64_t n,
                                   const int64_t *dof_a,
                                   const int64_t *dof_b,
                                   const double *normal,
                                   const double *tangent,
                                   const double *area,
                                   const double *pressure,
                                   const double *gap,
                                   int64_t *first_id);

/// A face of a damper on a platform. Fill it by hbvib_damper_face_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// Must be 0.
  int32_t reserved;
  /// Degrees of freedom of the platform along x, y and z of the damper, or HBVIB_GROUND.
  int64_t dofs[3];
  /// Cyclic models: the platform belongs to sector s + sector_offset.
  int64_t sector_offset;
  /// Angle between the platform and the direction along the wheel in radians: positive on the side
  /// of the next sector, negative on the other one.
  double angle;
  /// Angle in radians by which the axes of `dofs` are turned about z against those of the damper.
  double turn;
  /// Middle of the face from the centre of mass; without effect on a cylinder.
  double centre[3];
  /// Width across z, over which points are spread; without effect on a cylinder.
  double width;
  /// Points across z, >= 1; one on a cylinder.
  int64_t points_across;
  /// Points along z, >= 1; one with 3 motions.
  int64_t points_along;
  /// Tangential stiffness of the whole face, force per length, >= 0.
  double kt;
  /// Normal stiffness of the whole face, force per length, > 0.
  double kn;
  /// Friction coefficient, >= 0.
  double mu;
  /// Play along the normal, of any sign.
  double gap;
} hbvib_damper_face;

/// Fills a face: the ground, one point, the rest zero.
///
/// f          the struct; untouched on error.
/// size_of_f  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_damper_face_init(hbvib_damper_face *f, size_t size_of_f);

/// A damper under platforms, a rigid body. Its axes: x along the wheel towards the next sector, y
/// outward, z along the axis of rotation. Fill it by hbvib_damper_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// 3: motions along x and y and the roll about z; 6: translations along x, y and z and rotations
  /// about them.
  int32_t motions;
  /// Mass, > 0.
  double mass;
  /// Moments of inertia about x, y and z through the centre of mass; all zero: those of a solid
  /// cylinder of radius and length.
  double inertia[3];
  /// Radius of a cylinder, whose faces are lines; 0: faces have their centres and widths.
  double radius;
  /// Length along z, over which points are spread.
  double length;
  /// Distance of the centre of mass from the axis of rotation: the force mass * orbit * Omega^2
  /// acts outward.
  double orbit;
  /// Stiffness between the ground and each translation, and each rotation, >= 0.
  double support[2];
  /// Damping constants of the same, >= 0.
  double support_damping[2];
  /// Faces, at least one.
  const hbvib_damper_face *faces;
  /// Number of faces.
  int64_t faces_len;
} hbvib_damper;

/// Fills a damper: 3 motions, the rest zero.
///
/// d          the struct; untouched on error.
/// size_of_d  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_damper_init(hbvib_damper *d, size_t size_of_d);

/// Adds a damper under platforms: its motions are new degrees of freedom behind all others, so that
/// the model has `motions` more, and matrices that are set later have the new size. Its faces are
/// contacts HBVIB_FRICTION_2D (3 motions) or HBVIB_FRICTION_3D under the load that presses them.
/// Its mass, support and centrifugal force are added. In a cyclic model each sector has one.
/// Rayleigh damping applies to its mass and support as well.
///
/// damper         the description.
/// first_dof      receives the number of its first motion; the others follow. Or NULL.
/// first_contact  receives the number of its first contact; the others follow, face after face,
///                across z and then along it. Or NULL.
/// Errors: HBVIB_E_ARGUMENT, HBVIB_E_NOT_FINITE and HBVIB_E_INDEX (fields of the damper or of a
/// face, which is named), HBVIB_E_DIMENSION (too many degrees of freedom), HBVIB_E_STRUCT_SIZE,
/// HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY; the model is unchanged then.
/// Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_add_damper(hbvib_model *model,
                                    const hbvib_damper *damper,
                                    int64_t *first_dof,
                                    int64_t *first_contact);

/// Describes a contact of a model as hbvib_model_add_contact takes it: preload and gap as they were
/// given, whatever the speed; normal and tangent as unit vectors; contacts of an Iwan joint or a
/// patch one by one. HBVIB_TABLE, HBVIB_POLYNOMIAL and HBVIB_CALLER_LAW have no constants; those on
/// a list of degrees of freedom have no sides.
///
/// id          number from hbvib_model_add_contact or another function that adds contacts.
/// out         receives the description; fill it by hbvib_contact_init before; untouched on error.
/// per_speed2  receives the load per speed squared of hbvib_model_set_preload_at_speed, or NULL.
/// Errors: HBVIB_E_INDEX (id), HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY.
/// Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_model_contact(const hbvib_model *model,
                                 int64_t id,
                                 hbvib_contact *out,
                                 double *per_speed2);

/* ==============================================================================================
 * Laws of the caller: forces computed by a callback, and the check of their derivatives
 * ============================================================================================== */

/// One period for which a force callback computes its force. All arrays are row-major, sample after
/// sample: the entry of sample j, row i and column k of N x n x n numbers is [(j * n + i) * n + k].
///
/// Sample j lies at the time j * 2 pi / (omega * samples). The callback must write all of f, and of
/// z where there are states: they are NaN before the call. The derivatives are 0 before the call;
/// write those that are not 0. They must be the exact derivatives of the f and z written.
///
/// With states, z_j = Z(z_(j-1), motion at j - 1 and at j). z0 is the state before sample 0; the
/// motion before sample 0 is that of the last sample, because the motion is periodic. The library
/// finds the z0 that the last sample reaches again. In a first call z0 is 0, the state of a
/// structure at rest, and samples is 2: loading from rest to the begin of the period. States should
/// be of similar size, because one tolerance holds for all of them together.
typedef struct {
  /// Bytes of this struct as the library knows it.
  uint32_t struct_size;
  /// 0.
  int32_t reserved;
  /// Angular frequency of the period. States may need it as their time step 2 pi / (omega *
  /// samples); the force must not depend on it in any other way.
  double omega;
  /// Samples N over the period: the requested number or a few more, and half or twice as many
  /// where the sampling is checked (HBVIB_SAMPLING_ERROR).
  int64_t samples;
  /// Degrees of freedom n of the force.
  int64_t n;
  /// Internal states s.
  int64_t states;
  /// In: motions of these degrees of freedom, N x n.
  const double *u;
  /// In: their velocities du/dt, N x n; NULL unless uses_velocity.
  const double *v;
  /// In: states before sample 0, s numbers; NULL without states, as are all fields below whose
  /// names have a z.
  const double *z0;
  /// Out: forces f of M x'' + C x' + K x + f = f_ex, N x n.
  double *f;
  /// Out: d f / d u at the same time, at given z: N x n x n.
  double *df_du;
  /// Out: d f / d v, likewise: N x n x n; NULL unless uses_velocity.
  double *df_dv;
  /// Out: states, N x s.
  double *z;
  /// Out: d z_j / d z_(j-1), N x s x s.
  double *dz_dz;
  /// Out: d z_j / d u_(j-1), N x s x n.
  double *dz_du_before;
  /// Out: d z_j / d u_j, N x s x n.
  double *dz_du;
  /// Out: d z_j / d v_(j-1), N x s x n; NULL unless uses_velocity.
  double *dz_dv_before;
  /// Out: d z_j / d v_j, N x s x n; NULL unless uses_velocity.
  double *dz_dv;
  /// Out: d z_j / d omega, where the time step enters: N x s.
  double *dz_domega;
  /// Out: d f_j / d z_j, N x n x s.
  double *df_dz;
} hbvib_force_call;

/// A force of the caller. Returns 0 when done. A number above 0: the force cannot be computed at
/// this motion; the solver tries shorter steps, and stops at the smallest. A number below 0 stops
/// the solver at once. A branch that stops so keeps its points (HBVIB_STOPPED_CALLBACK); without
/// points the status is HBVIB_E_CALLBACK; hbvib_last_error has the number. NaN and infinity in the
/// numbers written count as a number above 0. The motions themselves are always finite.
///
/// The same motion must always give the same force. Every thread that uses the model, or a branch
/// of it, may call the function. It may call the library, but not change or free a handle in use
/// (HBVIB_E_BUSY), and must not throw or longjmp. The cancel flag is read between calls.
typedef int32_t (*hbvib_force_fn)(void *user, const hbvib_force_call *call);

/// A force of the caller on some degrees of freedom. Fill it by hbvib_user_force_init, then set
/// dofs, n and force at least.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// 1: the force depends on velocities; 0 (default): it does not.
  int32_t uses_velocity;
  /// 1: f(-u, -v) = -f(u, v), with states of opposite sign too, so that even harmonics may be
  /// left out; 0 (default): even harmonics are carried.
  int32_t is_odd;
  /// Must be 0.
  int32_t reserved;
  /// Degrees of freedom on which it acts, each against the ground.
  const int64_t *dofs;
  /// Their number, at least 1.
  int64_t n;
  /// Internal states; 0 (default): the force at a time follows from the motion at that time
  /// alone.
  int64_t states;
  /// Samples per period, more than twice the highest harmonic; 0 (default): those of the solver
  /// options, or automatic: at least 64, with states 256.
  int64_t samples;
  /// The callback.
  hbvib_force_fn force;
  /// Passed to the callback.
  void *user;
} hbvib_user_force;

/// Fills the description of a force with zeros: dofs, n and force must be set.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_user_force_init(hbvib_user_force *o, size_t size_of_o);

/// Adds a force of the caller, which counts as a contact. The callback is not called here, but by
/// every solve and every result of a branch that needs the force (hbvib_branch_harmonics, loops,
/// energies): callback and `user` must outlive the model, its copies, and all branches solved from
/// them.
///
/// Put the linear stiffness and damping of the force into K and C, where they can be separated: a
/// nonlinear mode starts from the structure without the force. A force that is not 0 at rest is a
/// constant load: a forced response and a nonlinear mode start from its static solution.
///
/// o   the description.
/// id  receives the number of the contact, counted from 0; may be NULL; untouched on error.
/// Errors: HBVIB_E_INDEX (dofs), HBVIB_E_DIMENSION (n, states, samples), HBVIB_E_ARGUMENT (flags, a
/// degree of freedom twice), HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL (force, dofs), HBVIB_E_HANDLE,
/// HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: one at a time per model.
HBVIB_NODISCARD
hbvib_status hbvib_model_add_user_force(hbvib_model *model, const hbvib_user_force *o, int64_t *id);

/// Derivatives that a force callback writes.
typedef enum {
  /// df_du
  HBVIB_DF_DU = 0,
  /// df_dv
  HBVIB_DF_DV = 1,
  /// df_dz
  HBVIB_DF_DZ = 2,
  /// dz_dz
  HBVIB_DZ_DZ = 3,
  /// dz_du_before
  HBVIB_DZ_DU_BEFORE = 4,
  /// dz_du
  HBVIB_DZ_DU = 5,
  /// dz_dv_before
  HBVIB_DZ_DV_BEFORE = 6,
  /// dz_dv
  HBVIB_DZ_DV = 7,
  /// dz_domega
  HBVIB_DZ_DOMEGA = 8,
} hbvib_tangent;

/// The derivative with the largest distance from its difference quotient. Fill it by
/// hbvib_jacobian_gap_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// HBVIB_DF_DU and so on (enum hbvib_tangent).
  int32_t tangent;
  /// |given - difference| times the size of the argument, relative to the size of the function
  /// value: below 1e-6 for right derivatives of a smooth force, 2 for a wrong sign.
  double gap;
  /// Sample of the test motion.
  int64_t sample;
  /// Row of the entry.
  int64_t row;
  /// Column of the entry; for HBVIB_DF_DZ the state that was changed before the step.
  int64_t column;
  /// Derivative that the callback wrote; for HBVIB_DF_DZ the change of force that follows from
  /// it.
  double given;
  /// Difference quotient of the callback's own f and z.
  double difference;
} hbvib_jacobian_gap;

/// Fills a gap with zeros.
///
/// gap          the struct; untouched on error.
/// size_of_gap  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_jacobian_gap_init(hbvib_jacobian_gap *gap, size_t size_of_gap);

/// Compares every derivative that a force of the caller writes with central differences of its own
/// f and z, on a built-in motion with a mean and the harmonics 1 and 3. The status is HBVIB_OK also
/// for a large gap: check its value. A solve with wrong derivatives ends in HBVIB_E_NO_CONVERGENCE
/// or needs many iterations.
///
/// contact        number from hbvib_model_add_user_force.
/// omega          angular frequency, > 0.
/// amplitude      about the largest motion of each degree of freedom of the force, > 0: the motion
///                should reach all regimes of the force.
/// amplitude_len  number of the amplitudes: one for each degree of freedom of the force.
/// out            receives the worst entry; untouched on error.
/// Errors: HBVIB_E_INDEX (contact), HBVIB_E_ARGUMENT (not a force of the caller, omega, amplitude),
/// HBVIB_E_DIMENSION (amplitude_len), HBVIB_E_CALLBACK, HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL,
/// HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_check_jacobian(const hbvib_model *model,
                                  int64_t contact,
                                  double omega,
                                  const double *amplitude,
                                  int64_t amplitude_len,
                                  hbvib_jacobian_gap *out);

/* ==============================================================================================
 * Solve: options, progress and cancellation, forced responses
 * ============================================================================================== */

/// Ways to the flexibility of the structure at its contacts.
typedef enum {
  /// A basis for large structures where it holds, factors otherwise.
  HBVIB_FLEXIBILITY_AUTOMATIC = 0,
  /// Complex LU factors of the dynamic stiffness of all degrees of freedom, at each frequency that
  /// is needed.
  HBVIB_FLEXIBILITY_DIRECT = 1,
  /// A basis of few motions per nodal diameter, from one real or Hermitian factorisation, which is
  /// kept with the model until its matrices change; hbvib_branch_reduction has its certificate.
  HBVIB_FLEXIBILITY_KRYLOV = 2,
} hbvib_flexibility;

/// Stability along the curve of a forced response.
typedef enum {
  /// None is computed.
  HBVIB_STABILITY_NONE = 0,
  /// Perturbations of the block that contains the wave itself, as HBVIB_WAVES_WAVE.
  HBVIB_STABILITY_WAVE = 1,
  /// All perturbations of the wheel, as HBVIB_WAVES_WHEEL.
  HBVIB_STABILITY_WHEEL = 2,
} hbvib_stability;

/// Options that every analysis shares. Fill it by hbvib_solver_options_init. A model without
/// contacts is linear: a tolerance other than 0, max_harmonics, samples, step, step_min,
/// tol_residual, max_newton and estimate_error have no effect on its response.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// Reserved: must be 0 or 1. A solve starts no thread.
  int32_t num_threads;
  /// Bound of the estimated relative error (default 1e-3), from which the harmonics of each point
  /// are chosen: error of the complex fundamental of the response degree of freedom; in a
  /// nonlinear mode of the frequency and of the damping ratio, the latter relative to the largest
  /// one so far. 0: exactly `harmonics`, whatever the error.
  double tolerance;
  /// Highest harmonic number H; with a tolerance it has no effect in forced and parameter
  /// responses.
  int64_t harmonics;
  /// Cap on H with a tolerance, at least the highest harmonic that is forced. Points that need
  /// more are stored, and the status is HBVIB_STOPPED_MAX_HARMONICS.
  int64_t max_harmonics;
  /// 0: events of contacts are located exactly. Else samples per period, at least 2H + 1; with a
  /// tolerance at least 8H are taken. HBVIB_CUBIC, HBVIB_FRICTION_2D, HBVIB_FRICTION_3D and
  /// polynomials are exact in both cases; HBVIB_REGULARISED is always sampled, with 0 by a number
  /// that follows from H, and from the tolerance: a run that has too few samples begins again,
  /// progress included, with more.
  int64_t samples;
  /// First arc-length step in scaled unknowns; 0 = automatic. A single frequency needs no step: the
  /// steps and max_points have no effect there.
  double step;
  /// Smallest step; 0 = automatic.
  double step_min;
  /// Largest step; 0 = automatic. Where every contact is linear, points lie at the resonances,
  /// and this is the largest share of the range between neighbours.
  double step_max;
  /// Relative residual of a converged point.
  double tol_residual;
  /// Cap on Newton iterations per point.
  int64_t max_newton;
  /// Cap on the number of points.
  int64_t max_points;
  /// Degree of freedom whose fundamental defines amplitude and peaks; -1: the forced one that
  /// moves most at the lower end of the range, contacts at their reference stiffness. In a
  /// nonlinear mode it defines the reported amplitude alone; -1: the phase reference.
  int64_t response_dof;
  /// 1: carry the mean and the even harmonics also where symmetry makes them zero; 0: do not.
  int32_t keep_even_harmonics;
  /// 1: estimate the error of every point, for HBVIB_ERROR_ESTIMATE, at the cost of a solution
  /// with more harmonics at each point; 0 (default): do so only with a tolerance.
  int32_t estimate_error;
  /// Largest number of bytes for factors and bases of the structure, for the equations of a point,
  /// and for an estimate of its error, each by itself; 0 (default): no limit. A request beyond it
  /// is refused with HBVIB_E_OUT_OF_MEMORY before it is allocated; the message has the need and
  /// the limit. Where a tolerance chooses the harmonics, fewer are used, and an estimate that
  /// needs more is an unknown error.
  int64_t memory_limit;
  /// Way to the flexibility of the structure at its contacts in a forced response: a value of
  /// enum hbvib_flexibility.
  int32_t flexibility;
  /// Perturbations whose Floquet multipliers are computed at each point of the curve of a forced
  /// response, a value of enum hbvib_stability: for HBVIB_FLOQUET_RADIUS,
  /// HBVIB_UNSTABLE_DIRECTIONS and hbvib_branch_bifurcations. A nonlinear mode refuses any but
  /// HBVIB_STABILITY_NONE, the default.
  int32_t stability;
  /// 1: the free sliders of each stored point of a forced response, as hbvib_branch_freedom has
  /// them for one point: for HBVIB_FREE_SLIDERS and HBVIB_D_AMPLITUDE_BY_PLACE. Hardly any work
  /// where nothing is free, else about that of one more Newton iteration a point. 0 (default):
  /// none. A nonlinear mode and a parameter response refuse it.
  int32_t freedom;
  /// Must be 0.
  int32_t reserved;
} hbvib_solver_options;

/// Fills solver options with their defaults: tolerance = 1e-3, from which the harmonics follow,
/// exact events, automatic steps. For a fixed number of harmonics set tolerance = 0 and harmonics.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_solver_options_init(hbvib_solver_options *o, size_t size_of_o);

/// State of a solve, passed to the progress callback.
typedef struct {
  /// Bytes of this struct as the library knows it.
  uint32_t struct_size;
  /// Newton iterations that the point took.
  int32_t newton_iterations;
  /// Number of points accepted so far, this one included.
  int64_t point;
  /// Angular frequency; in a nonlinear mode log10 of the amplitude.
  double parameter;
  /// Peak amplitude of the response degree of freedom: of the fundamental, or of the harmonic that
  /// hbvib_reduction names.
  double amplitude;
  /// Relative residual.
  double residual;
  /// Arc length of the step that led here, in scaled unknowns.
  double step;
  /// Part of the range that is done, 0 to 1.
  double fraction_done;
} hbvib_progress;

/// Levels of log lines.
typedef enum {
  /// No line at all.
  HBVIB_LOG_NONE = 0,
  /// Warnings.
  HBVIB_LOG_WARN = 1,
  /// Steps of the method.
  HBVIB_LOG_INFO = 2,
  /// Detail for debugging.
  HBVIB_LOG_DEBUG = 3,
} hbvib_log_level;

/// Phases of a running call.
typedef enum {
  /// Checks of the model and its assembly.
  HBVIB_PHASE_SETUP = 0,
  /// Natural frequencies and mode shapes.
  HBVIB_PHASE_MODES = 1,
  /// Condensation onto the contacts and tables of their flexibility.
  HBVIB_PHASE_CONDENSATION = 2,
  /// Search for the first point of a branch.
  HBVIB_PHASE_FIRST_POINT = 3,
  /// Points of a branch, one after the other.
  HBVIB_PHASE_CONTINUATION = 4,
  /// Error estimate of a point.
  HBVIB_PHASE_ESTIMATE = 5,
  /// Integration in time; the share is that of a lapse.
  HBVIB_PHASE_TIME_INTEGRATION = 6,
  /// Harmonics, energies and other results of solved motions.
  HBVIB_PHASE_RESULTS = 7,
  /// One factorisation of a sparse matrix, which cannot be stopped, begins.
  HBVIB_PHASE_FACTORISATION = 8,
} hbvib_phase;

/// Phase of a running call, passed to the phase callback.
typedef struct {
  /// Bytes of this struct as the library knows it.
  uint32_t struct_size;
  /// HBVIB_PHASE_SETUP .. HBVIB_PHASE_FACTORISATION; later versions may add others.
  int32_t phase;
  /// Part of the phase that is done, 0 to 1. It begins again with each phase.
  double share;
} hbvib_phase_report;

/// Called at the begin of a phase, whenever its share has grown by 0.01, and after some ten
/// milliseconds of work. A result other than 0 stops the call and keeps the points. Accepted points
/// have a callback of their own, because callers count its calls.
typedef int32_t (*hbvib_phase_fn)(void *user, const hbvib_phase_report *report);

/// Called at each accepted point. A result other than 0 stops the solve and keeps the points.
/// Results of what is kept, as those of the last period in hbvib_time_response, are still computed;
/// phase and cancel stop these, too.
typedef int32_t (*hbvib_progress_fn)(void *user, const hbvib_progress *progress);

/// Receives a line of the log, whose text is valid during the call.
typedef void (*hbvib_log_fn)(void *user, int32_t level, const char *message);

/// A flag that another thread or a signal handler may set while a call runs, by hbvib_cancel or by
/// an atomic store of its own: a plain store while another thread reads is a data race in C11 and
/// C++11.
typedef volatile int32_t hbvib_cancel_flag;

/// Sets a cancel flag by an atomic store, with which any running call that has it ends soon. A
/// signal handler may call it. The text of the last error stays as it is.
///
/// flag   the flag.
/// value  1: stop; 0: no longer, for the next call.
/// Errors: HBVIB_E_NULL, HBVIB_E_ARGUMENT (value, alignment). Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_cancel(hbvib_cancel_flag *flag, int32_t value);

/// Callbacks and cancel flag of a solve. Fill it by hbvib_hooks_init. Callbacks run on the calling
/// thread, one at a time; they may call the library, but not change or free a handle in use.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// HBVIB_LOG_NONE .. HBVIB_LOG_DEBUG: the finest lines that `log` receives.
  int32_t log_level;
  /// Passed to the callbacks.
  void *user;
  /// Called at each accepted point. May be NULL.
  hbvib_progress_fn progress;
  /// Called with each line of the log. May be NULL.
  hbvib_log_fn log;
  /// Read often, in every long loop: a number other than 0 stops the call and keeps the points.
  /// Another thread or a signal handler may set it by hbvib_cancel; the call never writes it.
  /// May be NULL.
  const hbvib_cancel_flag *cancel;
  /// Called with the phase of the call, from the set-up on. May be NULL.
  hbvib_phase_fn phase;
} hbvib_hooks;

/// Fills hooks with no callback and no flag.
///
/// h          the struct; untouched on error.
/// size_of_h  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_hooks_init(hbvib_hooks *h, size_t size_of_h);

/// The number that is read from a response over a period.
typedef enum {
  /// Amplitude of the fundamental: harmonic 1, or the one that hbvib_reduction names.
  HBVIB_MEASURE_FUNDAMENTAL = 0,
  /// Amplitude of one harmonic, 0 where the motion does not have it; harmonic 0 is the magnitude of
  /// the mean.
  HBVIB_MEASURE_HARMONIC = 1,
  /// Largest magnitude over the period.
  HBVIB_MEASURE_PEAK = 2,
  /// Root of the mean square over the period, mean included.
  HBVIB_MEASURE_RMS = 3,
  /// Largest value minus smallest one over the period.
  HBVIB_MEASURE_RANGE = 4,
} hbvib_measure;

/// The derivative of the motion by time that a response sees.
typedef enum {
  /// Displacement.
  HBVIB_DISPLACEMENT = 0,
  /// Velocity.
  HBVIB_VELOCITY = 1,
  /// Acceleration.
  HBVIB_ACCELERATION = 2,
} hbvib_component;

/// A response: a gauge, the weighted sum of degrees of freedom of one sector, and what is read from
/// it over a period. Fill it by hbvib_response_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// A value of enum hbvib_measure.
  int32_t measure;
  /// Number of the harmonic of HBVIB_MEASURE_HARMONIC; the others do not use it.
  int64_t harmonic;
  /// Number of degrees of freedom; 0: the response degree of freedom of the solver options.
  int64_t n;
  /// The degrees of freedom, from 0; NULL if n is 0.
  const int64_t *dofs;
  /// Their weights, n numbers; NULL: 1 each.
  const double *weights;
  /// Sector of the wheel, from 0.
  int64_t sector;
  /// A value of enum hbvib_component.
  int32_t component;
  /// Must be 0.
  int32_t reserved;
} hbvib_response;

/// Fills a response with the fundamental displacement of the response degree of freedom.
///
/// r          the struct; untouched on error.
/// size_of_r  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_response_init(hbvib_response *r, size_t size_of_r);

/// A branch of solutions, created by hbvib_forced_response or hbvib_nonlinear_mode.
typedef struct hbvib_branch hbvib_branch;

/// Options of hbvib_forced_response. Fill it by hbvib_forced_options_init, then set the range.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// 1: the tolerance holds for all responses in one norm, the root of the sum of |error|^2 over
  /// that of |response|^2; 0: for each by itself.
  int32_t together;
  /// First angular frequency, > 0, rad per time unit.
  double omega_start;
  /// Last angular frequency: below the first for a downward sweep, equal to it for one point.
  double omega_stop;
  /// Angular frequencies within the range at which every solution is computed exactly, or NULL.
  const double *at;
  /// Number of these frequencies.
  int64_t at_len;
  /// Start values, complex (H + 1) x ndof, harmonic after harmonic with an H of their own, or NULL:
  /// the stuck solution. The motion at the contacts counts; the imaginary part of the mean has
  /// no effect. Harmonics that forces and laws do not excite by themselves (a subharmonic, the
  /// mean and even harmonics of a symmetric model) are carried where the guess has them. One
  /// above harmonics, or with a tolerance above max_harmonics, is refused. hbvib_reduction tells
  /// whether the first point was found from the guess.
  const double *guess;
  /// Complex numbers in guess.
  int64_t guess_len;
  /// Array of the responses that are watched, struct_size of the first apart, or NULL: the
  /// fundamental of the response degree of freedom. The first one leads HBVIB_AMPLITUDE and
  /// hbvib_branch_peaks, and a tolerance holds for each; see hbvib_branch_response.
  const hbvib_response *responses;
  /// Number of these responses.
  int64_t responses_len;
  /// Further solutions that are sought, for hbvib_branch_children: 0 (default) none; 1 branches
  /// that branch off where the period doubles, a symmetry breaks or at simple branch points; 2
  /// detached curves, too, near the resonances that nonlinear modes predict; 3 those that peaks
  /// and folds lead to over the force, and subharmonic curves of the orders 2 and 3, too, by a net
  /// of starts; 4 those that deflation finds beside the response, too. Stability is then computed
  /// along all of them, as by HBVIB_STABILITY_WAVE where the solver option is none.
  int32_t branches;
  /// Largest number of generations of branches that branch off, up to 8; 0 (default): 3.
  int32_t branch_depth;
  /// Largest number of branches beside the response; 0 (default): 32.
  int64_t most_branches;
} hbvib_forced_options;

/// Fills the options of a forced response with zeros: the frequencies must be set.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_forced_options_init(hbvib_forced_options *o, size_t size_of_o);

/// Follows the periodic response of a model to its forces over a range of frequency, by harmonic
/// balance and arc-length continuation: folds are passed, peaks and folds refined.
///
/// solver  options; NULL: the defaults.
/// forced  range of frequency, requested exact frequencies, start values.
/// hooks   progress, log and cancellation; NULL: none.
/// out     receives the branch; untouched on error. Free it by hbvib_branch_free.
/// A positive status says why the branch ends early; the branch then has all points found, possibly
/// none. Where the amplitude grows without bound, at an undamped resonance, hbvib_last_error says
/// so.
/// Errors: HBVIB_E_ARGUMENT, HBVIB_E_DIMENSION, HBVIB_E_INDEX and HBVIB_E_NOT_FINITE for options
/// out of range, forces beyond the harmonics and missing matrices; HBVIB_E_NO_CONVERGENCE where no
/// first point was found; HBVIB_E_NO_BOUNDED_SOLUTION where none is known to exist, because the
/// force at an undamped resonance exceeds what the contacts can dissipate; HBVIB_E_SINGULAR,
/// HBVIB_E_UNSUPPORTED, HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY,
/// HBVIB_E_OUT_OF_MEMORY.
/// Threads: any number may solve one model at a time, with the same results as one alone; changing
/// or freeing it meanwhile is HBVIB_E_BUSY.
HBVIB_NODISCARD
hbvib_status hbvib_forced_response(const hbvib_model *model,
                                   const hbvib_solver_options *solver,
                                   const hbvib_forced_options *forced,
                                   const hbvib_hooks *hooks,
                                   hbvib_branch **out);

/// Number of the children of a branch: the branches that branch off from it, and the detached
/// curves beside it, as far as `branches` of hbvib_forced_options or hbvib_mode_options sought
/// them; or a negative status.
///
/// Errors: HBVIB_E_HANDLE. Threads: any number on one branch.
int64_t hbvib_branch_children(const hbvib_branch *branch);

/// A child of a branch. It is a branch as any other, with children of its own; it belongs to its
/// parent, and hbvib_branch_free of the parent frees it. Where the period doubles its frequencies
/// are those of its parent over 2, and its harmonic 2 is that of the fundamental of its parent:
/// results that need the model take that of hbvib_model_longer_period.
///
/// number  of the child, 0 .. hbvib_branch_children - 1.
/// out     receives the child, the same handle each time; untouched on error.
/// Errors: HBVIB_E_INDEX, HBVIB_E_NULL, HBVIB_E_HANDLE. Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_child(const hbvib_branch *branch, int64_t number, hbvib_branch **out);

/// Origin of a child. Fill it by hbvib_descent_init, then by hbvib_branch_descent.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// Kind of the bifurcation of its parent from which it branches off, a value of enum
  /// hbvib_bifurcation; -1 for a detached curve.
  int32_t kind;
  /// Place of that bifurcation in hbvib_branch_bifurcations of the parent; -1 for a detached
  /// curve.
  int64_t bifurcation;
  /// Periods of the parent in one of its own; its frequencies are those of the parent over that.
  int64_t periods;
  /// Frequency, its own, at which it comes back to its parent; 0 where it does not.
  double merges_at;
  /// Number of the linear mode along whose nonlinear mode a detached curve was found; -1
  /// otherwise.
  int64_t mode;
  /// Factor of all forces at which a detached curve is born, as its nonlinear mode predicts it, or
  /// as a curve over the force turns; 0 where it is not known.
  double born_at_force;
  /// The same at which it merges with the curve beneath.
  double merges_at_force;
  /// Order n of the n:1 internal resonance beyond whose tongue a curve of a nonlinear mode lies;
  /// 0 otherwise.
  int64_t internal_resonance;
} hbvib_descent;

/// Fills a descent with that of a branch that was asked for.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_descent_init(hbvib_descent *o, size_t size_of_o);

/// Origin of a branch: where a child comes from. A branch that was asked for has the values of
/// hbvib_descent_init.
///
/// out  receives it; untouched on error.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE. Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_descent(const hbvib_branch *branch, hbvib_descent *out);

/// Solutions beside a branch that were sought. The list of children is not complete: a solution
/// that none of these searches leads to is not found. Fill it by hbvib_searched_init, then by
/// hbvib_branch_searched.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// 0.
  int32_t reserved;
  /// Bifurcations of all generations from which a branch was sought.
  int64_t bifurcations;
  /// Those from which none was found.
  int64_t lost;
  /// Bifurcations from which none was sought, beyond branch_depth or most_branches.
  int64_t left;
  /// Nonlinear modes along which detached curves were sought.
  int64_t modes;
  /// Those that could not be followed through the range of amplitude.
  int64_t incomplete_modes;
  /// Resonances within the range of frequency that these modes predict.
  int64_t resonances;
  /// Those near which no solution was found.
  int64_t lost_resonances;
  /// Smallest modal amplitude to which modes were followed; 0 without modes.
  double amplitude_min;
  /// Largest one.
  double amplitude_max;
  /// Nets of starts of subharmonic curves.
  int64_t starts;
  /// Curves of peaks and folds that were followed over the force, between a tenth and ten times it.
  int64_t force_curves;
  /// Those that ended early.
  int64_t incomplete_force_curves;
  /// Solutions at the force itself on these curves, beside those that they begin at.
  int64_t crossings;
  /// Points of the response beside which deflation sought solutions.
  int64_t deflations;
  /// Curves that it found.
  int64_t deflated;
} hbvib_searched;

/// Fills a search with zeros.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_searched_init(hbvib_searched *o, size_t size_of_o);

/// The solutions that were sought beside a forced response; zeros where none were.
///
/// out  receives them; untouched on error.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE. Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_searched(const hbvib_branch *branch, hbvib_searched *out);

/// Copies a model for motions with a multiple of the period of its forces: forces in harmonic h act
/// in harmonic `periods` * h of the copy, whose frequencies are those of the model over `periods`.
/// A speed that is tied to the frequency and unbalances remain what they are.
///
/// periods  at least 1; 2 for the children of a period doubling.
/// out      receives the copy; untouched on error. Free it by hbvib_model_free.
/// Errors: HBVIB_E_ARGUMENT, HBVIB_E_UNSUPPORTED (no wave of the sectors has that period),
/// HBVIB_E_HANDLE, HBVIB_E_BUSY (being changed), HBVIB_E_NULL, HBVIB_E_OUT_OF_MEMORY.
/// Threads: any number may copy and solve one model.
HBVIB_NODISCARD
hbvib_status hbvib_model_longer_period(const hbvib_model *model,
                                       int64_t periods,
                                       hbvib_model **out);

/* ==============================================================================================
 * Results: curve, fields, harmonics, special points, energies, contacts of a branch
 * ============================================================================================== */

/// Frees a branch with its children; their views become invalid. NULL is accepted and does nothing.
///
/// Errors: HBVIB_E_HANDLE (freed before, for example), HBVIB_E_ARGUMENT (a child, which its parent
/// frees), HBVIB_E_BUSY. Threads: any, once.
hbvib_status hbvib_branch_free(hbvib_branch *branch);

/// Number of points on the curve, or a negative status. Peaks, folds and the solutions requested at
/// given frequencies or amplitudes are stored beside the curve; their point numbers follow those of
/// the curve.
///
/// Errors: HBVIB_E_HANDLE. Threads: any number on one branch.
int64_t hbvib_branch_points(const hbvib_branch *branch);

/// Number of all stored points, those beside the curve included, so that point numbers are below
/// it; or a negative status.
///
/// Errors: HBVIB_E_HANDLE. Threads: any number on one branch.
int64_t hbvib_branch_stored(const hbvib_branch *branch);

/// The status with which the solve that made the branch returned: HBVIB_OK if the whole range was
/// covered, positive if it stopped early.
///
/// Errors: HBVIB_E_HANDLE. Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_status(const hbvib_branch *branch);

/// Results that a branch holds for each point of the curve. Energies are of one sector. All are
/// finite, except for errors, stability and freedom that are unknown, or not there: those are NaN.
typedef enum {
  /// Angular frequency.
  HBVIB_OMEGA = 0,
  /// Peak amplitude of the response degree of freedom: of the fundamental, or of the harmonic that
  /// hbvib_reduction names. With responses in hbvib_forced_options the measure of the first one;
  /// where forces act in several harmonics and none in the first, the RMS of that degree of
  /// freedom.
  HBVIB_AMPLITUDE = 1,
  /// Nonlinear modes only: damping ratio D.
  HBVIB_DAMPING_RATIO = 2,
  /// Nonlinear modes only: T, sum over h > 0 of (h omega)^2 X_h^H M_h X_h / 2, which is twice the
  /// mean kinetic energy.
  HBVIB_ENERGY = 3,
  /// Nonlinear modes only: work of friction per cycle.
  HBVIB_DISSIPATION = 4,
  /// Relative residual.
  HBVIB_RESIDUAL = 5,
  /// Newton iterations.
  HBVIB_NEWTON_ITERATIONS = 6,
  /// Estimated relative error of the complex fundamental of the response degree of freedom (in a
  /// nonlinear mode: of the frequency) by the harmonics left out. NaN where it is unknown, and
  /// everywhere without a tolerance and without estimate_error.
  HBVIB_ERROR_ESTIMATE = 7,
  /// Highest harmonic number carried.
  HBVIB_HARMONICS_USED = 8,
  /// Share of the period that each contact slips: points x contacts. An open contact does not
  /// slip, so that springs have 0, HBVIB_UNILATERAL too.
  HBVIB_SLIP_FRACTION = 9,
  /// Nonlinear modes only: log10 of the amplitude, the parameter.
  HBVIB_LOG10_AMPLITUDE = 10,
  /// Nonlinear modes only: modal amplitude sqrt(X_1^H M X_1).
  HBVIB_MODAL_AMPLITUDE = 11,
  /// Nonlinear modes only: work of the structure's damping per cycle.
  HBVIB_STRUCTURAL_LOSS = 12,
  /// Nonlinear modes only: |X_1^H M Y_1|^2 / (X_1^H M X_1 Y_1^H M Y_1) with the fundamental Y_1
  /// of the point before; 1 for the first.
  HBVIB_MODAL_ASSURANCE = 13,
  /// Aliasing check of laws that are sampled: relative change of their force harmonics with half
  /// the samples (twice as many where half are too few). 0 where all laws are exact, NaN where a
  /// law failed at the other samples. It estimates the error by sampling and is no bound of it.
  HBVIB_SAMPLING_ERROR = 14,
  /// Nonlinear modes only: estimated absolute error of the damping ratio, NaN as
  /// HBVIB_ERROR_ESTIMATE.
  HBVIB_DAMPING_ERROR_ESTIMATE = 15,
  /// Forced responses with the solver option `stability` only: largest modulus of the ordinary
  /// Floquet multipliers of the motion. NaN where the motion touches an event, or its perturbations
  /// could not be followed.
  HBVIB_FLOQUET_RADIUS = 16,
  /// The same: number of ordinary multipliers outside the unit circle; 0 for a stable motion.
  HBVIB_UNSTABLE_DIRECTIONS = 17,
  /// Parameter responses only: value of the parameter.
  HBVIB_PARAMETER_VALUE = 18,
  /// Parameter responses only: total derivative of the amplitude by the parameter, NaN where there
  /// is none, and in those of a mode.
  HBVIB_D_AMPLITUDE = 19,
  /// Parameter responses of the largest damping ratio of a mode only: total derivative of that
  /// ratio by the parameter.
  HBVIB_D_DAMPING = 20,
  /// Forced responses with the solver option `freedom` only: number of free sliders, as
  /// hbvib_branch_freedom lists them; 0 where none is free nearby. NaN where it is unknown.
  HBVIB_FREE_SLIDERS = 21,
  /// The same: derivative of the amplitude by the place of each slider at a fixed frequency,
  /// points x contacts x 2 for t1 and t2. NaN where the slider is not free.
  HBVIB_D_AMPLITUDE_BY_PLACE = 22,
} hbvib_field;

/// A borrowed array of results, valid until hbvib_branch_free. Fill it by hbvib_view_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// HBVIB_REAL or HBVIB_COMPLEX.
  int32_t scalar;
  /// Number of dimensions, 1 to 3.
  int32_t rank;
  /// 0.
  int32_t reserved;
  /// First number; NULL where there is none.
  const double *data;
  /// Length of each dimension; 1 beyond the rank.
  int64_t shape[3];
  /// Distance of neighbours in each dimension, in numbers of the view's kind.
  int64_t stride[3];
} hbvib_view;

/// Fills an empty view.
///
/// v          the struct; untouched on error.
/// size_of_v  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_view_init(hbvib_view *v, size_t size_of_v);

/// Borrows the values of a field at the points of the curve, in the order in which it was followed.
///
/// field  HBVIB_OMEGA and so on (enum hbvib_field): one double per point, but HBVIB_SLIP_FRACTION
///        points x contacts, 0 for a contact that never slips, and HBVIB_D_AMPLITUDE_BY_PLACE
///        points x contacts x 2. A forced response does not have the fields of nonlinear modes, and
///        those of stability and freedom with these options only; parameter responses alone have
///        those of a parameter.
/// out    receives the view, whose memory stays valid until hbvib_branch_free; fill it by
///        hbvib_view_init before; untouched on error.
/// Errors: HBVIB_E_ARGUMENT (field), HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE.
/// Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_field(const hbvib_branch *branch, int32_t field, hbvib_view *out);

/// Borrows the values of a field at all stored points: those of the curve as hbvib_branch_field has
/// them, then those of the peaks, folds and requested solutions beside it, so that the number of a
/// point is its place.
///
/// field  as in hbvib_branch_field; the stability of points beside the curve is NaN.
/// out    receives the view, whose memory stays valid until hbvib_branch_free; fill it by
///        hbvib_view_init before; untouched on error.
/// Errors: HBVIB_E_ARGUMENT (field), HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE.
/// Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_stored_field(const hbvib_branch *branch, int32_t field, hbvib_view *out);

/// Recovers harmonics 0 .. H of a range of degrees of freedom at a stored point, in the caller's
/// unit of length. H is harmonics_asked of hbvib_branch_reduction; harmonics that are
/// not carried are zero.
///
/// point      number of a point of the curve, or of a peak, fold or requested solution.
/// first_dof  first degree of freedom of the range, from 0.
/// n_dof      number of degrees of freedom, at least 1.
/// x          receives (H + 1) x n_dof complex numbers, harmonic after harmonic; untouched on
///            error.
/// x_len      complex numbers in it.
/// Errors: HBVIB_E_INDEX (point, first_dof), HBVIB_E_DIMENSION (n_dof, x_len, with the value
/// needed), HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_OUT_OF_MEMORY. Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_harmonics(const hbvib_branch *branch,
                                    int64_t point,
                                    int64_t first_dof,
                                    int64_t n_dof,
                                    double *x,
                                    int64_t x_len);

/// The same as hbvib_branch_harmonics; a hook or the cancel flag may stop it. The status
/// is then HBVIB_STOPPED_BY_CALLER, and what it writes is untouched.
///
/// point      number of a point of the curve, or of a peak, fold or requested solution.
/// first_dof  first degree of freedom of the range, from 0.
/// n_dof      number of degrees of freedom, at least 1.
/// x          receives (H + 1) x n_dof complex numbers, harmonic after harmonic; untouched on
///            error.
/// x_len      complex numbers in it.
/// hooks      phase, log and cancellation; progress is not called. NULL: none.
/// Errors and threads: as for hbvib_branch_harmonics.
HBVIB_NODISCARD
hbvib_status hbvib_branch_harmonics_with_hooks(const hbvib_branch *branch,
                                               int64_t point,
                                               int64_t first_dof,
                                               int64_t n_dof,
                                               double *x,
                                               int64_t x_len,
                                               const hbvib_hooks *hooks);

/// Motion of a degree of freedom over one period of the fundamental at a stored point, in the
/// caller's unit of length: entry j at omega t = 2 pi j / n.
///
/// point  number of a point of the curve, or of a peak, fold or requested solution.
/// dof    degree of freedom, from 0.
/// n      number of times, 1 .. 2^24.
/// x      receives n doubles; untouched on error.
/// Errors: HBVIB_E_INDEX (point, dof), HBVIB_E_DIMENSION (n), HBVIB_E_NULL, HBVIB_E_HANDLE,
/// HBVIB_E_OUT_OF_MEMORY. Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_time_history(const hbvib_branch *branch,
                                       int64_t point,
                                       int64_t dof,
                                       int64_t n,
                                       double *x);

/// The same as hbvib_branch_time_history; a hook or the cancel flag may stop it. The status
/// is then HBVIB_STOPPED_BY_CALLER, and what it writes is untouched.
///
/// point  number of a point of the curve, or of a peak, fold or requested solution.
/// dof    degree of freedom, from 0.
/// n      number of times, 1 .. 2^24.
/// x      receives n doubles; untouched on error.
/// hooks  phase, log and cancellation; progress is not called. NULL: none.
/// Errors and threads: as for hbvib_branch_time_history.
HBVIB_NODISCARD
hbvib_status hbvib_branch_time_history_with_hooks(const hbvib_branch *branch,
                                                  int64_t point,
                                                  int64_t dof,
                                                  int64_t n,
                                                  double *x,
                                                  const hbvib_hooks *hooks);

/// Shares of the period that each contact slips at a stored point.
///
/// point       number of a point of the curve, or of a peak, fold or requested solution.
/// shares      receives one double per contact of the model, 0 for one that never slips; may be
///             NULL where there is no contact.
/// shares_len  doubles in it.
/// Errors: HBVIB_E_INDEX (point), HBVIB_E_DIMENSION (shares_len), HBVIB_E_NULL, HBVIB_E_HANDLE.
/// Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_slip_fraction(const hbvib_branch *branch,
                                        int64_t point,
                                        double *shares,
                                        int64_t shares_len);

/// Maxima of the amplitude of the response degree of freedom within the range; in a nonlinear mode
/// the points of largest damping ratio. Refined on the solution, in the order of the branch.
///
/// capacity   numbers that fit into each array.
/// omega      receives their angular frequencies, or NULL.
/// amplitude  receives their amplitudes, or NULL.
/// point      receives their point numbers for hbvib_branch_harmonics, or NULL.
/// count      receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_DIMENSION (capacity too small: the arrays are untouched), HBVIB_E_NULL,
/// HBVIB_E_HANDLE. Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_peaks(const hbvib_branch *branch,
                                int64_t capacity,
                                double *omega,
                                double *amplitude,
                                int64_t *point,
                                int64_t *count);

/// Turning points in frequency, in a nonlinear mode in amplitude, refined on the solution, in the
/// order of the branch.
///
/// Arguments, errors and threads as for hbvib_branch_peaks.
HBVIB_NODISCARD
hbvib_status hbvib_branch_folds(const hbvib_branch *branch,
                                int64_t capacity,
                                double *omega,
                                double *amplitude,
                                int64_t *point,
                                int64_t *count);

/// Every solution that was found at one of the frequencies in hbvib_forced_options.at, or of the
/// amplitudes in hbvib_mode_options.at.
///
/// wanted     index into `at`, from 0.
/// capacity   numbers that fit into each array.
/// amplitude  receives their amplitudes, or NULL.
/// point      receives their point numbers for hbvib_branch_harmonics, or NULL.
/// count      receives how many there are, as for hbvib_branch_peaks; several where the branch is
///            folded, none where it ended before.
/// Errors: HBVIB_E_INDEX (wanted), else as for hbvib_branch_peaks. Threads: any number on one
/// branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_at(const hbvib_branch *branch,
                             int64_t wanted,
                             int64_t capacity,
                             double *amplitude,
                             int64_t *point,
                             int64_t *count);

/// Results of a response at each stored point.
typedef enum {
  /// The measure.
  HBVIB_READING_VALUE = 0,
  /// Complex amplitude; NaN where the measure is none of a single harmonic.
  HBVIB_READING_COMPLEX = 1,
  /// Estimated relative error, of the complex amplitude where there is one. NaN where it is
  /// unknown, and everywhere without a tolerance and without estimate_error.
  HBVIB_READING_ERROR = 2,
  /// Phase omega t of the largest magnitude of a peak, or of the largest value of a range, in
  /// 0 .. 2 pi; NaN for other measures.
  HBVIB_READING_INSTANT = 3,
} hbvib_reading;

/// Number of the responses that were asked for in hbvib_forced_options, or a negative status.
///
/// Errors: HBVIB_E_HANDLE. Threads: any number on one branch.
int64_t hbvib_branch_responses(const hbvib_branch *branch);

/// Borrows the values of a response at all stored points: those of the curve, then those of the
/// peaks, folds and requested solutions beside it, so that the number of a point is its place.
///
/// response  number of the response, from 0.
/// reading   HBVIB_READING_VALUE and so on (enum hbvib_reading).
/// out       receives the view, whose memory stays valid until hbvib_branch_free; fill it by
///           hbvib_view_init before; untouched on error.
/// Errors: HBVIB_E_INDEX (response), HBVIB_E_ARGUMENT (reading), HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE,
/// HBVIB_E_HANDLE. Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_response(const hbvib_branch *branch,
                                   int64_t response,
                                   int32_t reading,
                                   hbvib_view *out);

/// Maxima of a response within the range, refined on the solution, in the order of the branch.
///
/// response   number of the response, from 0.
/// capacity   numbers that fit into each array.
/// omega      receives their angular frequencies, or NULL.
/// value      receives the measures there, or NULL.
/// point      receives their point numbers for hbvib_branch_harmonics, or NULL.
/// peaks      receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_INDEX (response), HBVIB_E_DIMENSION (capacity too small: the arrays are
/// untouched), HBVIB_E_NULL, HBVIB_E_HANDLE. Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_response_peaks(const hbvib_branch *branch,
                                         int64_t response,
                                         int64_t capacity,
                                         double *omega,
                                         double *value,
                                         int64_t *point,
                                         int64_t *peaks);

/// Kinks of a peak or a range, where another instant of the period takes the lead and the slope of
/// the measure jumps. Derivatives at the two points of a kink are those of its two sides.
///
/// response   number of the response, from 0.
/// capacity   numbers that fit into each array.
/// omega      receives their angular frequencies, or NULL.
/// value      receives the measures there, or NULL.
/// before     receives the numbers of the last points before them, or NULL.
/// after      receives the numbers of the first points behind them, or NULL.
/// kinks      receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_INDEX (response), HBVIB_E_DIMENSION (capacity too small: the arrays are
/// untouched), HBVIB_E_ARGUMENT (overlapping arrays), HBVIB_E_NULL, HBVIB_E_HANDLE. Threads: any
/// number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_response_kinks(const hbvib_branch *branch,
                                         int64_t response,
                                         int64_t capacity,
                                         double *omega,
                                         double *value,
                                         int64_t *before,
                                         int64_t *after,
                                         int64_t *kinks);

/// Number of the response with the largest error at a stored point, in the norm that the tolerance
/// has; HBVIB_E_INDEX where there is no such point, HBVIB_E_ARGUMENT where no error is known.
///
/// point  number of a point of the curve, or of a peak, fold or requested solution.
/// Errors: HBVIB_E_HANDLE also. Threads: any number on one branch.
int64_t hbvib_branch_leading_response(const hbvib_branch *branch, int64_t point);

/// Reads responses at all stored points of any branch, whatever it was asked for: of a nonlinear
/// mode, of a result over a parameter, or further gauges of a forced response. A hook or the cancel
/// flag may stop it: the status is then HBVIB_STOPPED_BY_CALLER, and the arrays are untouched.
///
/// responses      array of responses, struct_size of the first apart; one without degrees of
///                freedom is that of the response degree of freedom.
/// responses_len  how many.
/// values         receives the measures, responses_len x stored points; or NULL.
/// values_len     numbers in it; 0 with NULL.
/// complex        receives complex amplitudes, NaN where a measure has none; or NULL.
/// complex_len    complex numbers in it; 0 with NULL.
/// instants       receives phases as HBVIB_READING_INSTANT; or NULL.
/// instants_len   numbers in it; 0 with NULL.
/// hooks          phase, log and cancellation; progress is not called. NULL: none.
/// Errors: HBVIB_E_DIMENSION (lengths, weights), HBVIB_E_INDEX (dofs, sector), HBVIB_E_ARGUMENT
/// (fields, overlapping arrays), HBVIB_E_NOT_FINITE, HBVIB_E_SINGULAR, HBVIB_E_NULL,
/// HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE, HBVIB_E_CALLBACK, HBVIB_E_OUT_OF_MEMORY. Threads: any
/// number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_read_responses(const hbvib_branch *branch,
                                         const hbvib_response *responses,
                                         int64_t responses_len,
                                         double *values,
                                         int64_t values_len,
                                         double *complex,
                                         int64_t complex_len,
                                         double *instants,
                                         int64_t instants_len,
                                         const hbvib_hooks *hooks);

/// Reads a response from any periodic motion: of a nonlinear mode, a synthesis, an integration in
/// time. The fundamental is harmonic 1, and the sector must be 0.
///
/// r          the response; it needs degrees of freedom of its own.
/// ndof       degrees of freedom of the motion, at least 1.
/// omega      angular frequency, for velocities and accelerations.
/// x          complex harmonics 0 .. H of the motion, (H + 1) x ndof, harmonic after harmonic.
/// x_len      complex numbers in it.
/// value      receives the measure; untouched on error.
/// amplitude  receives the complex amplitude, re and im, NaN where the measure has none; or NULL.
/// instant    receives the phase omega t of the largest magnitude of a peak, or of the largest
///            value of a range, else NaN; or NULL.
/// Errors: HBVIB_E_DIMENSION (ndof, x_len, weights), HBVIB_E_INDEX (dofs, sector),
/// HBVIB_E_ARGUMENT, HBVIB_E_NOT_FINITE, HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_OUT_OF_MEMORY.
/// Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_response_of(const hbvib_response *r,
                               int64_t ndof,
                               double omega,
                               const double *x,
                               int64_t x_len,
                               double *value,
                               double *amplitude,
                               double *instant);

/// Ways to the flexibility of the contacts along a branch, told by hbvib_branch_reduction with the
/// reason.
typedef enum {
  /// Factors: at a single frequency they take the least time.
  HBVIB_FLEXIBILITY_WAY_SINGLE_FREQUENCY = 0,
  /// A sum over all modes of each wave.
  HBVIB_FLEXIBILITY_WAY_MODES = 1,
  /// A sum over all poles of each wave: damping couples the modes.
  HBVIB_FLEXIBILITY_WAY_POLES = 2,
  /// Factors at each frequency: modes lose the motion of a near-rigid contact.
  HBVIB_FLEXIBILITY_WAY_NEAR_RIGID = 3,
  /// Factors: damping couples the modes, and few degrees of freedom are factored as quickly.
  HBVIB_FLEXIBILITY_WAY_FEW = 4,
  /// Factors: damping couples the modes, and sparse matrices are factored as quickly.
  HBVIB_FLEXIBILITY_WAY_SPARSE = 5,
  /// Factors: there are too many degrees of freedom for all modes or poles.
  HBVIB_FLEXIBILITY_WAY_MANY = 6,
  /// Factors: the reference stiffness is not definite, or poles are badly conditioned; in a
  /// nonlinear mode also where damping couples the modes.
  HBVIB_FLEXIBILITY_WAY_UNSUITABLE = 7,
  /// Factors: sums did not agree with them at an end of the range.
  HBVIB_FLEXIBILITY_WAY_DISAGREEMENT = 8,
  /// Factors of the waves of a tuned wheel at each frequency, and a correction of low rank for the
  /// differences of its sectors.
  HBVIB_FLEXIBILITY_WAY_TUNED_WHEEL = 9,
} hbvib_flexibility_way;

/// Size of the problem that was solved, and the parts that were removed from it before. Fill it by
/// hbvib_reduction_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// 0.
  int32_t reserved;
  /// Sectors of the wheel; all but one are removed.
  int64_t sectors;
  /// Degrees of freedom of one sector.
  int64_t degrees_of_freedom;
  /// Relative contact coordinates that remain of them.
  int64_t coordinates;
  /// Contacts in the model.
  int64_t contacts;
  /// Contacts that became linear springs (infinite slip limit, no cubic term).
  int64_t never_slipping;
  /// Contacts without force (no stiffness, or no slip limit).
  int64_t inert;
  /// Highest harmonic number H of the results: the requested one or, with a tolerance, the
  /// highest one that a point carries.
  int64_t harmonics_asked;
  /// Number of harmonics carried, the largest of all points.
  int64_t harmonics_carried;
  /// Real unknowns of the nonlinear problem, the largest number of all points.
  int64_t unknowns;
  /// Degree of freedom whose amplitude was followed.
  int64_t response_dof;
  /// 1 if the mean is carried, else 0.
  int32_t mean_carried;
  /// 1 if even harmonics were left out because law and forcing are odd, else 0.
  int32_t even_removed;
  /// Rigid-body modes of the mean motion that contacts alone hold; 0 where the mean is not
  /// carried.
  int64_t held_by_contacts;
  /// Coordinates of each harmonic to which the structure was reduced, the largest number of all
  /// points; 0 where all its degrees of freedom were kept.
  int64_t basis;
  /// Estimated relative error of the motion of the structure on its basis, under unit forces at
  /// the contacts, the excitation and the response over the frequencies of the call, the largest
  /// of all points; 0 without a basis.
  double certificate;
  /// Harmonic whose amplitude is that of the response: the lowest one in which a vibrating force
  /// acts that is at least a thousandth of the largest; of a nonlinear mode 1.
  int64_t response_harmonic;
  /// 1: the first point was found from the given guess. 0: there was a guess, and no solution was
  /// found from it; another way found the first point. -1: no guess was given.
  int32_t guess_used;
  /// How the flexibility of the contacts is made along the branch, and why so: see
  /// hbvib_flexibility_way.
  int32_t flexibility_way;
} hbvib_reduction;

/// Fills a reduction with zeros.
///
/// r          the struct; untouched on error.
/// size_of_r  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_reduction_init(hbvib_reduction *r, size_t size_of_r);

/// Size of the problem that was solved, the parts that were removed from it, and the degree of
/// freedom that was followed.
///
/// out  receives the numbers; fill it by hbvib_reduction_init before; untouched on error.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE. Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_reduction(const hbvib_branch *branch, hbvib_reduction *out);

/// Energies and losses of one point, in the units of the caller. Fill it by hbvib_energy_init. In a
/// plain model the sector is the whole structure. Kinetic energy is v'Mv/2. Potential energy is
/// x'Kx/2 of the linear structure, with springs and contacts that never slip (infinite limit);
/// contacts that may slip are left out. The energy of a coupling is shared evenly by its two
/// sectors.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// 0.
  int32_t reserved;
  /// Sum over h > 0 of (h omega)^2 X_h^H M_h X_h / 2 of a sector: twice its mean kinetic energy.
  double twice_mean_kinetic;
  /// Kinetic energy of a sector, mean over the period.
  double kinetic_mean;
  /// Kinetic energy of a sector, largest over the period.
  double kinetic_peak;
  /// Potential energy of a sector, mean over the period.
  double potential_mean;
  /// Potential energy of a sector, largest over the period.
  double potential_peak;
  /// Kinetic energy of the wheel, mean over the period.
  double wheel_kinetic_mean;
  /// Kinetic energy of the wheel, largest over the period.
  double wheel_kinetic_peak;
  /// Potential energy of the wheel, mean over the period.
  double wheel_potential_mean;
  /// Potential energy of the wheel, largest over the period.
  double wheel_potential_peak;
  /// Work per cycle and sector that damping, and stiffness without symmetry, take from the
  /// motion.
  double structural_loss;
  /// Work per cycle and sector of the contacts that may slip. In a forced response both losses
  /// together are the work of the forces.
  double friction_loss;
} hbvib_energy;

/// Fills an energy with zeros.
///
/// e          the struct; untouched on error.
/// size_of_e  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_energy_init(hbvib_energy *e, size_t size_of_e);

/// Energies and losses of a stored point.
///
/// point  number of a point of the curve, or of a peak, fold or requested solution.
/// out    receives the numbers; fill it by hbvib_energy_init before; untouched on error.
/// Errors: HBVIB_E_INDEX (point), HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE,
/// HBVIB_E_OUT_OF_MEMORY. Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_energy(const hbvib_branch *branch, int64_t point, hbvib_energy *out);

/// The same as hbvib_branch_energy; a hook or the cancel flag may stop it. The status
/// is then HBVIB_STOPPED_BY_CALLER, and out is untouched.
///
/// point  number of a point of the curve, or of a peak, fold or requested solution.
/// out    receives the numbers; fill it by hbvib_energy_init before; untouched on error.
/// hooks  phase, log and cancellation; progress is not called. NULL: none.
/// Errors and threads: as for hbvib_branch_energy.
HBVIB_NODISCARD
hbvib_status hbvib_branch_energy_with_hooks(const hbvib_branch *branch,
                                            int64_t point,
                                            hbvib_energy *out,
                                            const hbvib_hooks *hooks);

/// State of a contact at one time.
typedef enum {
  /// It sticks, or presses. Contacts that never slip, contacts without force and laws without
  /// states (springs except HBVIB_UNILATERAL) are always in this state.
  HBVIB_STATE_STICK = 0,
  /// It slips: the force is at the slip limit.
  HBVIB_STATE_SLIP = 1,
  /// It is open, without force.
  HBVIB_STATE_OPEN = 2,
} hbvib_state;

/// Hysteresis loop of a contact in one of its directions over one period of the fundamental at a
/// stored point: entry j at omega t = 2 pi j / n. The force is that of this contact alone and not
/// truncated at harmonic H: the law at the motion of the point. Events of HBVIB_JENKINS and
/// HBVIB_UNILATERAL are located exactly, also where the branch was solved with samples; friction in
/// a plane is followed exactly, and a law of the caller is called with the n times, up to 16384 at
/// once; with states it is marched over them. In a cyclic model the contact is that of sector 0. A
/// contact that is linear at any motion has its linear force and sticks; the motion of the whole
/// structure is recovered for it.
///
/// point      number of a point of the curve, or of a peak, fold or requested solution.
/// contact    number from hbvib_model_add_contact.
/// direction  one of the directions of the contact from 0, in the order t1, t2, n of those in which
///            it acts: 0 for laws of one direction. hbvib_contact_summary has their number.
/// n          number of times, 1 .. 2^24.
/// motion     receives n relative motions, side a minus side b, or NULL.
/// force      receives n forces f, which act on side a as + f and on side b as - f in
///            M x'' + C x' + K x + f = f_ex; or NULL. Along the normal f is minus the normal load.
/// state      receives n states of the contact, HBVIB_STATE_STICK and so on, the same for all its
///            directions, or NULL. Not all three may be NULL.
/// Errors, with all arrays untouched: HBVIB_E_INDEX (point, contact, direction), HBVIB_E_DIMENSION
/// (n), HBVIB_E_NULL, HBVIB_E_ARGUMENT (overlapping arrays), HBVIB_E_HANDLE, HBVIB_E_OUT_OF_MEMORY,
/// HBVIB_E_CALLBACK, HBVIB_E_NO_CONVERGENCE.
/// Memory: 16 n bytes and n, and a law of the caller with states some hundred n: a march above
/// 500 MB is refused with the n that it needs (HBVIB_E_OUT_OF_MEMORY).
/// Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_contact_loop(const hbvib_branch *branch,
                                       int64_t point,
                                       int64_t contact,
                                       int64_t direction,
                                       int64_t n,
                                       double *motion,
                                       double *force,
                                       int32_t *state);

/// The same as hbvib_branch_contact_loop; a hook or the cancel flag may stop it. The status
/// is then HBVIB_STOPPED_BY_CALLER, and what it writes is untouched.
///
/// point      number of a point of the curve, or of a peak, fold or requested solution.
/// contact    number from hbvib_model_add_contact.
/// direction  one of the directions of the contact from 0, in the order t1, t2, n of those in which
///            it acts: 0 for laws of one direction. hbvib_contact_summary has their number.
/// n          number of times, 1 .. 2^24.
/// motion     receives n relative motions, side a minus side b, or NULL.
/// force      receives n forces f, which act on side a as + f and on side b as - f in
///            M x'' + C x' + K x + f = f_ex; or NULL. Along the normal f is minus the normal load.
/// state      receives n states of the contact, HBVIB_STATE_STICK and so on, the same for all its
///            directions, or NULL. Not all three may be NULL.
/// hooks      phase, log and cancellation; progress is not called. NULL: none.
/// Errors and threads: as for hbvib_branch_contact_loop.
HBVIB_NODISCARD
hbvib_status hbvib_branch_contact_loop_with_hooks(const hbvib_branch *branch,
                                                  int64_t point,
                                                  int64_t contact,
                                                  int64_t direction,
                                                  int64_t n,
                                                  double *motion,
                                                  double *force,
                                                  int32_t *state,
                                                  const hbvib_hooks *hooks);

/// Numbers of one contact over one period, in the units of the caller. Ranges are exact for the
/// motion of the point, and so are all numbers of HBVIB_JENKINS, HBVIB_CUBIC and HBVIB_UNILATERAL;
/// shares and work of laws that are sampled have the accuracy of the samples of the branch. Fill it
/// by hbvib_contact_summary_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// 0.
  int32_t reserved;
  /// Work per cycle that the contact takes from the motion in all its directions; exactly 0 for
  /// friction that does not slip and for springs of one motion. The sum over all contacts is the
  /// friction_loss of hbvib_energy, up to the error by sampling where the branch was solved with
  /// samples.
  double work;
  /// Share of the period that it slips, 0 to 1, open time not included.
  double slip_share;
  /// Share of the period that it is open, 0 to 1.
  double open_share;
  /// Half the range of the relative motion in the first direction, (max - min) / 2.
  double half_range;
  /// Smallest relative motion in the first direction, side a minus side b.
  double motion_min;
  /// Largest relative motion in the first direction.
  double motion_max;
  /// Smallest normal load. A constant load is reported as it is, also the infinite preload of
  /// HBVIB_JENKINS. Springs that cannot open have no load: 0.
  double load_min;
  /// Largest normal load.
  double load_max;
  /// Number of directions of the contact, in the order t1, t2, n of those in which it acts.
  int64_t directions;
  /// Smallest relative motions, direction by direction, of up to three; 0 beyond `directions`.
  double all_min[3];
  /// Largest relative motions likewise.
  double all_max[3];
} hbvib_contact_summary;

/// Fills the summary of a contact with zeros.
///
/// s          the struct; untouched on error.
/// size_of_s  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_contact_summary_init(hbvib_contact_summary *s, size_t size_of_s);

/// Work, shares of the period and ranges of a contact at a stored point.
///
/// point    number of a point of the curve, or of a peak, fold or requested solution.
/// contact  number from hbvib_model_add_contact.
/// out      receives the numbers; fill it by hbvib_contact_summary_init before; untouched on error.
/// Errors: HBVIB_E_INDEX (point, contact), HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE,
/// HBVIB_E_OUT_OF_MEMORY, HBVIB_E_CALLBACK, HBVIB_E_NO_CONVERGENCE. Threads: any number on one
/// branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_contact_summary(const hbvib_branch *branch,
                                          int64_t point,
                                          int64_t contact,
                                          hbvib_contact_summary *out);

/// The same as hbvib_branch_contact_summary; a hook or the cancel flag may stop it. The status
/// is then HBVIB_STOPPED_BY_CALLER, and out is untouched.
///
/// point    number of a point of the curve, or of a peak, fold or requested solution.
/// contact  number from hbvib_model_add_contact.
/// out      receives the numbers; fill it by hbvib_contact_summary_init before; untouched on error.
/// hooks    phase, log and cancellation; progress is not called. NULL: none.
/// Errors and threads: as for hbvib_branch_contact_summary.
HBVIB_NODISCARD
hbvib_status hbvib_branch_contact_summary_with_hooks(const hbvib_branch *branch,
                                                     int64_t point,
                                                     int64_t contact,
                                                     hbvib_contact_summary *out,
                                                     const hbvib_hooks *hooks);

/* ==============================================================================================
 * Modes: linear and nonlinear modes, responses synthesised from them
 * ============================================================================================== */

/// State of the contacts in a linear analysis.
typedef enum {
  /// Without force.
  HBVIB_CONTACTS_FREE = 0,
  /// Linear springs, as at small motion: kt of contacts that stick and kn of contacts that press
  /// at rest, the slopes of tables and polynomials; HBVIB_REGULARISED has none.
  HBVIB_CONTACTS_STUCK = 1,
  /// Linear springs of their tangent stiffness at the static state under constant forces and
  /// preload; as stuck where nothing loads the model.
  HBVIB_CONTACTS_STATIC = 2,
} hbvib_contact_state;

/// Undamped natural modes, in ascending order of frequency. A singular mass matrix has fewer modes
/// than degrees of freedom. Where the stiffness is negative in some direction, a motion grows: its
/// omega is negative, minus the rate of growth, -sqrt(-lambda) of the eigenvalue lambda = omega^2.
/// Degrees of freedom whose diagonal of the stiffness exceeds all beside it by 1/epsilon, as 1e36,
/// are fixed: they have no mode.
///
/// diameter  signed nodal diameter d, modulo N: sector s + 1 lags by 2 pi d / N; 0 for a plain
///           structure. HBVIB_DIAMETER_OF_ENGINE_ORDER: that of the model's engine order.
/// contacts  HBVIB_CONTACTS_FREE, _STUCK (linear springs kt) or _STATIC (about the static state).
/// count     number of requested modes, at least 1.
/// omega     receives `count` natural angular frequencies; below zero: minus a rate of growth.
/// shapes    receives `count` complex shapes of ndof numbers each, one after the other, with
///           phi^H M phi = 1 over one sector; or NULL.
/// Errors: HBVIB_E_ARGUMENT (diameter, contacts), HBVIB_E_DIMENSION (more modes requested than
/// exist), HBVIB_E_NOT_HERMITIAN, HBVIB_E_NOT_POSITIVE_DEFINITE, HBVIB_E_SINGULAR,
/// HBVIB_E_NO_CONVERGENCE, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY.
/// Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_linear_modes(const hbvib_model *model,
                                int64_t diameter,
                                int32_t contacts,
                                int64_t count,
                                double *omega,
                                double *shapes);

/// The same as hbvib_linear_modes; a hook or the cancel flag may stop it. The status
/// is then HBVIB_STOPPED_BY_CALLER, and what it writes is untouched.
///
/// diameter  signed nodal diameter d, modulo N: sector s + 1 lags by 2 pi d / N; 0 for a plain
///           structure. HBVIB_DIAMETER_OF_ENGINE_ORDER: that of the model's engine order.
/// contacts  HBVIB_CONTACTS_FREE, _STUCK (linear springs kt) or _STATIC (about the static state).
/// count     number of requested modes, at least 1.
/// omega     receives `count` natural angular frequencies; below zero: minus a rate of growth.
/// shapes    receives `count` complex shapes of ndof numbers each, one after the other, with
///           phi^H M phi = 1 over one sector; or NULL.
/// hooks     phase, log and cancellation; progress is not called. NULL: none.
/// Errors and threads: as for hbvib_linear_modes.
HBVIB_NODISCARD
hbvib_status hbvib_linear_modes_with_hooks(const hbvib_model *model,
                                           int64_t diameter,
                                           int32_t contacts,
                                           int64_t count,
                                           double *omega,
                                           double *shapes,
                                           const hbvib_hooks *hooks);

/// Damped natural modes at the speed of the model, in the order of rising frequency: eigenvalues
/// lambda in the upper half plane of lambda^2 M + lambda (C + Omega G) + K + Omega^2 K1 + i D.
/// Motions that do not oscillate are not counted unless they grow: their eigenvalue is real, above
/// zero, and they come first. A mode that grows is told to the log. Degrees of freedom whose
/// diagonal of the stiffness exceeds all beside it by 1/epsilon, as 1e36, are fixed.
///
/// diameter    signed nodal diameter d, modulo N: sector s + 1 lags by 2 pi d / N; 0 for a plain
///             structure. HBVIB_DIAMETER_OF_ENGINE_ORDER: that of the model's engine order.
/// contacts    HBVIB_CONTACTS_FREE, _STUCK or _STATIC.
/// count       number of requested modes, 1 .. ndof.
/// eigenvalue  receives `count` complex numbers: the damped angular frequency is the imaginary
///             part, the damping ratio minus the real part over the modulus.
/// shapes      receives `count` complex shapes of ndof numbers each, one after the other, with
///             phi^H M phi = 1 over one sector; or NULL.
/// direction   receives `count` numbers: 1 (forward) where the frequency rises with the speed at
///             fixed K1, -1 (backward) where it falls, 0 where neither; or NULL.
/// hooks       phase, log and cancellation; progress is not called. NULL: none.
/// Errors: HBVIB_E_ARGUMENT (diameter, contacts, a speed tied to the frequency), HBVIB_E_DIMENSION
/// (more modes than oscillate), HBVIB_E_NOT_POSITIVE_DEFINITE, HBVIB_E_SINGULAR,
/// HBVIB_E_NO_CONVERGENCE, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY.
/// Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_damped_modes(const hbvib_model *model,
                                int64_t diameter,
                                int32_t contacts,
                                int64_t count,
                                double *eigenvalue,
                                double *shapes,
                                int64_t *direction,
                                const hbvib_hooks *hooks);

/// Campbell diagram: the lowest damped modes at each of some speeds of rotation. The speed of the
/// model has no effect.
///
/// n              number of speeds, at least 1.
/// speeds         rising speeds, rad per time unit; n numbers.
/// diameter       signed nodal diameter, as hbvib_damped_modes.
/// contacts       HBVIB_CONTACTS_FREE, _STUCK or _STATIC.
/// count          number of modes at each speed, 1 .. ndof.
/// omega          receives n * count damped angular frequencies, those of one speed rising, one
///                speed after the other; NaN where fewer motions oscillate.
/// damping_ratio  receives n * count damping ratios likewise; or NULL.
/// direction      receives n * count numbers likewise, as hbvib_damped_modes; or NULL.
/// hooks          phase and cancellation; progress is not called. NULL: none.
/// Errors: HBVIB_E_DIMENSION (n, count), HBVIB_E_NOT_FINITE or HBVIB_E_ARGUMENT (speeds), and those
/// of hbvib_damped_modes. Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_campbell(const hbvib_model *model,
                            int64_t n,
                            const double *speeds,
                            int64_t diameter,
                            int32_t contacts,
                            int64_t count,
                            double *omega,
                            double *damping_ratio,
                            int64_t *direction,
                            const hbvib_hooks *hooks);

/// The speeds at which an engine order meets a mode of the wave that it excites, omega =
/// engine_order * Omega, found between neighbours of the given speeds and then to rounding. The
/// wave has the signed nodal diameter engine_order mod N: engine order 9 of 10 sectors meets the
/// modes of -1.
///
/// n             number of speeds, at least 1.
/// speeds        rising speeds, rad per time unit; n numbers.
/// diameter      nodal diameter of the diagram, of either sense: an engine order that excites
///               another one meets no mode of it. HBVIB_DIAMETER_OF_ENGINE_ORDER: its own.
/// contacts      HBVIB_CONTACTS_FREE, _STUCK or _STATIC.
/// count         number of modes at each speed, 1 .. ndof.
/// engine_order  at least 1.
/// capacity      room of each of the arrays, >= 0; n * count is enough.
/// speed         receives the speeds, rising, `found` numbers; or NULL if capacity = 0.
/// omega         receives the angular frequencies, `found` numbers; or NULL if capacity = 0.
/// direction     receives the directions, as hbvib_damped_modes, `found` numbers; or NULL.
/// found         receives the number of crossings; if it is above the capacity, no array is filled.
/// hooks         phase and cancellation; progress is not called. NULL: none.
/// Errors: HBVIB_E_DIMENSION (n, count, capacity), HBVIB_E_NOT_FINITE (speeds), HBVIB_E_ARGUMENT
/// (speeds, engine_order), and those of hbvib_damped_modes. Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_campbell_crossings(const hbvib_model *model,
                                      int64_t n,
                                      const double *speeds,
                                      int64_t diameter,
                                      int32_t contacts,
                                      int64_t count,
                                      int64_t engine_order,
                                      int64_t capacity,
                                      double *speed,
                                      double *omega,
                                      int64_t *direction,
                                      int64_t *found,
                                      const hbvib_hooks *hooks);

/// Interference (SAFE) diagram: the lowest damped modes of all N waves of a wheel at the speed of
/// the model, as hbvib_damped_modes. Together they are the modes of the wheel, each once. Both
/// senses of a diameter are computed where they differ: with gyroscopic or aerodynamic forces and
/// with unsymmetric matrices. The waves that grow are told to the log.
///
/// contacts       HBVIB_CONTACTS_FREE, _STUCK or _STATIC.
/// count          number of modes of each wave, 1 .. ndof.
/// capacity       room of the arrays in waves, at least N.
/// diameter       receives N numbers: signed nodal diameters -N/2 < d <= N/2, rising.
/// omega          receives N * count damped angular frequencies, those of one wave rising, one wave
///                after the other; NaN where fewer motions oscillate.
/// damping_ratio  receives N * count damping ratios likewise, negative where the motion grows; or
///                NULL.
/// direction      receives N * count numbers likewise, as hbvib_damped_modes; or NULL.
/// equal_senses   receives 1 where both senses of each diameter have the same frequencies and
///                damping ratios, else 0; or NULL.
/// hooks          phase, log and cancellation; progress is not called. NULL: none.
/// Errors: HBVIB_E_UNSUPPORTED for a plain structure; HBVIB_E_DIMENSION (count, capacity), and
/// those of hbvib_damped_modes. Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_interference(const hbvib_model *model,
                                int32_t contacts,
                                int64_t count,
                                int64_t capacity,
                                int64_t *diameter,
                                double *omega,
                                double *damping_ratio,
                                int64_t *direction,
                                int64_t *equal_senses,
                                const hbvib_hooks *hooks);

/// Artificial damping that makes the motion of a damped structure periodic; D is its damping ratio.
typedef enum {
  /// The term -2 D omega M x'.
  HBVIB_DAMPING_MASS = 0,
  /// The term -zeta K x', D = zeta omega / 2, K the structure's own stiffness without springs and
  /// contacts.
  HBVIB_DAMPING_STIFFNESS = 1,
} hbvib_damping_form;

/// Options of hbvib_nonlinear_mode. Fill it by hbvib_mode_options_init, then set the range.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// HBVIB_DAMPING_MASS (default) or HBVIB_DAMPING_STIFFNESS.
  int32_t damping_form;
  /// log10 of the first amplitude.
  double log10_start;
  /// log10 of the last amplitude, above the first.
  double log10_stop;
  /// HBVIB_DIAMETER_OF_ENGINE_ORDER (default): the wave of the model's engine order. Else a signed
  /// nodal diameter d, modulo N: the wave in which sector s + 1 lags by 2 pi d / N.
  int64_t diameter;
  /// Number of the linear mode, contacts stuck, from 0 (default) by rising frequency.
  int64_t mode_index;
  /// Above 0: the linear mode nearest to this angular frequency; mode_index must then be 0.
  /// 0: not used.
  double near_omega;
  /// The linear mode most similar to this shape, ndof complex numbers of one sector and of any
  /// size. NULL: not used. mode_index and near_omega must then be 0.
  const double *shape;
  /// Complex numbers in shape.
  int64_t shape_len;
  /// Measure of the amplitude. -1 (default): sqrt(X_1^H M X_1) over one sector, length times
  /// square root of mass. Else a contact: |Y_1| of its relative motion, a peak length.
  int64_t amplitude_contact;
  /// log10 of amplitudes within the range at which every solution is computed exactly, or NULL.
  const double *at;
  /// Number of these amplitudes.
  int64_t at_len;
  /// Degree of freedom whose fundamental is real; -1 (default): the one that moves most in the
  /// linear mode.
  int64_t reference_dof;
  /// Motion near the first point, complex (H + 1) x ndof, harmonic after harmonic with an H of
  /// its own, at least 1, or NULL: the linear mode, from small amplitudes on. Its amplitude and
  /// phase are made those of the first point. Harmonics that laws do not excite by themselves are
  /// carried where the guess has them. hbvib_reduction tells whether the first point was found
  /// from it.
  const double *guess;
  /// Complex numbers in guess.
  int64_t guess_len;
  /// Angular frequency of the guess, > 0; 0 without one.
  double guess_omega;
  /// Damping ratio of the guess; 0 without one.
  double guess_damping;
  /// Further curves that are sought, for hbvib_branch_children: 0 (default) none; 1 those of its
  /// branch points, listed by hbvib_branch_bifurcations, with even harmonics carried along, and
  /// the one beyond a tongue of internal resonance.
  int32_t branches;
  /// Largest number of generations of these curves, up to 8; 0 (default): 3.
  int32_t branch_depth;
  /// Largest number of these curves; 0 (default): 32.
  int64_t most_branches;
} hbvib_mode_options;

/// Fills the options of a nonlinear mode with their defaults: the lowest mode of the model's wave,
/// modal amplitude, damping of mass form. The range is empty and must be set.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_mode_options_init(hbvib_mode_options *o, size_t size_of_o);

/// Follows a nonlinear mode over a range of amplitude, from contacts that stick to contacts that
/// slide, by the extended periodic motion concept (EPMC, Krack 2015) and arc-length continuation:
/// artificial damping balances the loss in friction and structure, and its damping ratio D belongs
/// to the result. The mode vibrates about the static state under the constant forces of the model
/// and the preload of its contacts; amplitude and potential energy count from it. Vibrating forces
/// have no effect. Turns in amplitude are passed, largest damping ratios refined.
///
/// solver  options; NULL: the defaults. harmonics must be at least 1.
/// mode    the linear mode to start from, the measure of the amplitude, its range.
/// hooks   progress, log and cancellation; NULL: none.
/// out     receives the branch; untouched on error. Free it by hbvib_branch_free.
/// A positive status says why the branch ends early; the branch then has all points found, possibly
/// none.
/// Errors: HBVIB_E_ARGUMENT, HBVIB_E_DIMENSION, HBVIB_E_INDEX and HBVIB_E_NOT_FINITE for options
/// out of range, a mode that moves no contact, a mode of frequency 0, and a reference at a node of
/// the mode; HBVIB_E_NOT_POSITIVE_DEFINITE and HBVIB_E_NOT_HERMITIAN for matrices, also missing
/// ones; HBVIB_E_NO_CONVERGENCE where no static state or no first point was found;
/// HBVIB_E_SINGULAR, HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY,
/// HBVIB_E_OUT_OF_MEMORY.
/// Threads: any number may solve one model at a time, with the same results as one alone; changing
/// or freeing it meanwhile is HBVIB_E_BUSY.
HBVIB_NODISCARD
hbvib_status hbvib_nonlinear_mode(const hbvib_model *model,
                                  const hbvib_solver_options *solver,
                                  const hbvib_mode_options *mode,
                                  const hbvib_hooks *hooks,
                                  hbvib_branch **out);

/// Numbers of one point of a nonlinear mode, in the units of the caller; energies are of one
/// sector. Fill it by hbvib_mode_point_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// 0.
  int32_t reserved;
  /// log10 of the amplitude, the parameter.
  double log10_amplitude;
  /// Angular frequency.
  double omega;
  /// Damping ratio D.
  double damping_ratio;
  /// Modal amplitude sqrt(X_1^H M X_1), whichever measure the parameter has.
  double modal_amplitude;
  /// T, sum over h > 0 of (h omega)^2 X_h^H M_h X_h / 2, which is twice the mean kinetic energy.
  double energy;
  /// Share of the fundamental in this energy, 0 to 1.
  double fundamental_share;
  /// Work of friction per cycle.
  double friction_loss;
  /// Work of the structure's damping per cycle.
  double structural_loss;
  /// (friction_loss + structural_loss) / (4 pi energy). With HBVIB_DAMPING_MASS it equals
  /// damping_ratio by the balance of work, which checks both.
  double energy_damping_ratio;
  /// |X_1^H M Y_1|^2 / (X_1^H M X_1 Y_1^H M Y_1) with the fundamental Y_1 of the point before; 1
  /// for the first.
  double assurance;
} hbvib_mode_point;

/// Fills a point of a mode with zeros.
///
/// p          the struct; untouched on error.
/// size_of_p  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_mode_point_init(hbvib_mode_point *p, size_t size_of_p);

/// Numbers of a stored point of a nonlinear mode.
///
/// point  number of a point of the curve, or of a peak, fold or requested solution.
/// out    receives the numbers; fill it by hbvib_mode_point_init before; untouched on error.
/// Errors: HBVIB_E_UNSUPPORTED (the branch of a forced response), HBVIB_E_INDEX (point),
/// HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE. Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_mode_point(const hbvib_branch *branch,
                                     int64_t point,
                                     hbvib_mode_point *out);

/// How the linear mode was chosen among those of one frequency.
typedef enum {
  /// The frequency is simple: there was nothing to choose.
  HBVIB_MODE_SINGLE = 0,
  /// Two real modes make a travelling wave (phi_1 + i phi_2) / sqrt(2), or the wave in the
  /// opposite direction.
  HBVIB_MODE_TRAVELLING_WAVE = 1,
  /// The mass-weighted projection of the given shape.
  HBVIB_MODE_PROJECTED = 2,
  /// The first mode found; another machine may find another one.
  HBVIB_MODE_FIRST = 3,
} hbvib_mode_multiple;

/// Start of a nonlinear mode. Fill it by hbvib_mode_info_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// How one of several modes of the same frequency was chosen: HBVIB_MODE_SINGLE and so on.
  int32_t multiple;
  /// Number of the linear mode, contacts stuck, from 0 by rising frequency.
  int64_t mode_index;
  /// Number of modes of this frequency.
  int64_t multiplicity;
  /// Degree of freedom whose fundamental is real.
  int64_t reference_dof;
  /// Engine order of the wave: waves of the fundamental per turn, with the sign of their
  /// direction.
  int64_t engine_order;
  /// -1: the parameter measures the modal amplitude; else the motion of this contact.
  int64_t amplitude_contact;
  /// Angular frequency of the linear mode without damping.
  double omega;
  /// log10 of the largest amplitude at which all contacts stick, or keep their state at rest;
  /// minus infinity where a law is never linear, or the call was stopped before this was known.
  double linear_up_to;
  /// log10 of the amplitude at which the first contact begins to slip. Infinity: none slips on
  /// this branch. Minus infinity: one slips at the first point already, and it is not known from
  /// which amplitude on, or at every amplitude.
  double slip_from;
  /// The same for the first contact that presses at rest and lifts off.
  double lift_off_from;
} hbvib_mode_info;

/// Fills the description of a mode with zeros, amplitude_contact with -1.
///
/// i          the struct; untouched on error.
/// size_of_i  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_mode_info_init(hbvib_mode_info *i, size_t size_of_i);

/// Start of a nonlinear mode, and how the linear mode was chosen.
///
/// out  receives the description; fill it by hbvib_mode_info_init before; untouched on error.
/// Errors: HBVIB_E_UNSUPPORTED (the branch of a forced response), HBVIB_E_NULL,
/// HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE. Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_mode_info(const hbvib_branch *branch, hbvib_mode_info *out);

/// Options of a synthesised response. Fill it by hbvib_synthesis_options_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// 1: add the damping of the model's C, for a mode that was computed without it; 0: do not.
  int32_t model_damping;
  /// Factor on all forces of the model, > 0.
  double force_factor;
  /// Damping ratio that is added to the mode's, between -1 and 1.
  double damping_ratio;
} hbvib_synthesis_options;

/// Fills the options of a synthesis with their defaults: the forces and the damping as they are.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_synthesis_options_init(hbvib_synthesis_options *o, size_t size_of_o);

/// Response to the forces of a model in the fundamental, synthesised from a nonlinear mode: near
/// resonance the structure moves like one oscillator whose frequency and damping depend on the
/// amplitude. Points are ordered by rising amplitude below the resonance, then by falling amplitude
/// above it, two for each point of the branch at whose amplitude the force balances the damping.
///
/// branch           a nonlinear mode.
/// model            the model of the mode, or one with other forces or damping; forces in other
///                  harmonics have no effect.
/// options          NULL: the defaults.
/// capacity         numbers that fit into each array; twice the points of the branch suffice.
/// omega            receives the angular frequencies of the force, or NULL.
/// response         receives the fundamentals of the branch's response degree of freedom, complex,
///                  in phase with the force where real; or NULL.
/// modal_amplitude  receives the modal amplitudes, or NULL.
/// count            receives how many points there are, also when `capacity` is too small.
/// Errors: HBVIB_E_UNSUPPORTED (branch is no mode), HBVIB_E_DIMENSION (capacity too small, a model
/// of another size), HBVIB_E_ARGUMENT (options, a model whose forces excite another wave or none,
/// overlapping arrays), HBVIB_E_NOT_FINITE, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_STRUCT_SIZE,
/// HBVIB_E_OUT_OF_MEMORY. Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_synthesis(const hbvib_branch *branch,
                                    const hbvib_model *model,
                                    const hbvib_synthesis_options *options,
                                    int64_t capacity,
                                    double *omega,
                                    double *response,
                                    double *modal_amplitude,
                                    int64_t *count);

/// The same as hbvib_branch_synthesis; a hook or the cancel flag may stop it. The status
/// is then HBVIB_STOPPED_BY_CALLER, and what it writes is untouched.
///
/// branch           a nonlinear mode.
/// model            the model of the mode, or one with other forces or damping; forces in other
///                  harmonics have no effect.
/// options          NULL: the defaults.
/// capacity         numbers that fit into each array; twice the points of the branch suffice.
/// omega            receives the angular frequencies of the force, or NULL.
/// response         receives the fundamentals of the branch's response degree of freedom, complex,
///                  in phase with the force where real; or NULL.
/// modal_amplitude  receives the modal amplitudes, or NULL.
/// count            receives how many points there are, also when `capacity` is too small.
/// hooks            phase, log and cancellation; progress is not called. NULL: none.
/// Errors and threads: as for hbvib_branch_synthesis.
HBVIB_NODISCARD
hbvib_status hbvib_branch_synthesis_with_hooks(const hbvib_branch *branch,
                                               const hbvib_model *model,
                                               const hbvib_synthesis_options *options,
                                               int64_t capacity,
                                               double *omega,
                                               double *response,
                                               double *modal_amplitude,
                                               int64_t *count,
                                               const hbvib_hooks *hooks);

/// Reasons to doubt a synthesised resonance: bits of a sum.
typedef enum {
  /// No reason for doubt was found, and the computed resonance has the same amplitude within 1 %.
  HBVIB_SYNTHESIS_VALID = 0,
  /// Another mode lies within the half-power bandwidth, or shares the frequency of the linear
  /// mode.
  HBVIB_SYNTHESIS_ANOTHER_MODE = 1,
  /// Higher harmonics hold more than 1 % of the kinetic energy, or the point lies where the
  /// amplitude falls along the branch, beyond a fold.
  HBVIB_SYNTHESIS_INTERNAL_RESONANCE = 2,
  /// The amplitude falls as the force rises: a detached response begins here.
  HBVIB_SYNTHESIS_FALLING = 4,
  /// The amplitude differs by 1 % or more from that of the computed resonance next to it, or no
  /// such resonance was found.
  HBVIB_SYNTHESIS_INACCURATE = 8,
} hbvib_synthesis_flag;

/// Resonances of a synthesised response, refined on the equations of the mode, in the order of the
/// branch; none where the force is too small or too large for its amplitudes.
///
/// branch, model           as for hbvib_branch_synthesis.
/// options                 NULL: the defaults.
/// capacity                numbers that fit into each array.
/// omega                   receives their angular frequencies, or NULL.
/// amplitude               receives the amplitudes |X_1| of the response degree of freedom, or
///                         NULL.
/// log10_amplitude         receives the amplitudes as the branch measures them, log10, or NULL.
/// damping_ratio           receives the total damping ratios there, or NULL.
/// other_mode              receives the distance to the nearest other natural frequency of the wave
///                         over the half-power bandwidth, infinite where none is known; or NULL.
/// error                   receives the amplitudes over those of the computed resonances next to
///                         them, minus 1, NaN where none was found; or NULL.
/// flags                   receives reasons for doubt, sums of hbvib_synthesis_flag; or NULL.
/// count                   receives how many there are, also when `capacity` is too small.
/// Errors and threads: as for hbvib_branch_synthesis.
HBVIB_NODISCARD
hbvib_status hbvib_branch_synthesis_peaks(const hbvib_branch *branch,
                                          const hbvib_model *model,
                                          const hbvib_synthesis_options *options,
                                          int64_t capacity,
                                          double *omega,
                                          double *amplitude,
                                          double *log10_amplitude,
                                          double *damping_ratio,
                                          double *other_mode,
                                          double *error,
                                          int32_t *flags,
                                          int64_t *count);

/// The same as hbvib_branch_synthesis_peaks; a hook or the cancel flag may stop it. The status
/// is then HBVIB_STOPPED_BY_CALLER, and what it writes is untouched.
///
/// branch, model           as for hbvib_branch_synthesis.
/// options                 NULL: the defaults.
/// capacity                numbers that fit into each array.
/// omega                   receives their angular frequencies, or NULL.
/// amplitude               receives the amplitudes |X_1| of the response degree of freedom, or
///                         NULL.
/// log10_amplitude         receives the amplitudes as the branch measures them, log10, or NULL.
/// damping_ratio           receives the total damping ratios there, or NULL.
/// other_mode              receives the distance to the nearest other natural frequency of the wave
///                         over the half-power bandwidth, infinite where none is known; or NULL.
/// error                   receives the amplitudes over those of the computed resonances next to
///                         them, minus 1, NaN where none was found; or NULL.
/// flags                   receives reasons for doubt, sums of hbvib_synthesis_flag; or NULL.
/// count                   receives how many there are, also when `capacity` is too small.
/// hooks                   phase, log and cancellation; progress is not called. NULL: none.
/// Errors and threads: as for hbvib_branch_synthesis_peaks.
HBVIB_NODISCARD
hbvib_status hbvib_branch_synthesis_peaks_with_hooks(const hbvib_branch *branch,
                                                     const hbvib_model *model,
                                                     const hbvib_synthesis_options *options,
                                                     int64_t capacity,
                                                     double *omega,
                                                     double *amplitude,
                                                     double *log10_amplitude,
                                                     double *damping_ratio,
                                                     double *other_mode,
                                                     double *error,
                                                     int32_t *flags,
                                                     int64_t *count,
                                                     const hbvib_hooks *hooks);

/* ==============================================================================================
 * Time: integration in time, and points of a branch compared with it
 * ============================================================================================== */

/// Ways of finding a steady state in time.
typedef enum {
  /// Newton's method on the map over a period, with marching where it fails. Where several
  /// solutions coexist it may find an unstable one.
  HBVIB_SHOOTING = 0,
  /// Period after period until the motion repeats.
  HBVIB_MARCHING = 1,
} hbvib_steady_method;

/// Options of hbvib_time_response. Fill it by hbvib_time_options_init, then set omega.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// HBVIB_SHOOTING or HBVIB_MARCHING.
  int32_t method;
  /// Angular frequency of harmonic 1, > 0, rad per time unit.
  double omega;
  /// Highest harmonic of the results; it has no effect on the accuracy of the others.
  int64_t harmonics;
  /// Equidistant times per period at which the motion is returned; 0: none.
  int64_t samples;
  /// Largest change over a period, relative to the largest displacement and velocity, of a steady
  /// state; also the local error of a step where a law is smooth (HBVIB_CUBIC).
  double tolerance;
  /// Cap on the periods that are integrated.
  int64_t max_periods;
  /// Motion to start from, complex (H + 1) x ndof of any H, harmonic after harmonic, such as a
  /// point of a branch; or NULL: rest.
  const double *start;
  /// Complex numbers in start.
  int64_t start_len;
  /// Receives the place of the slider along t1 of each contact at the end, the residual state for
  /// hbvib_model_set_slider, 0 for contacts without slider; or NULL.
  double *places;
  /// Doubles in places: the number of contacts; 0 with NULL.
  int64_t places_len;
} hbvib_time_options;

/// Fills the options of a response in time with their defaults: shooting from rest, harmonics = 9,
/// tolerance = 1e-11; omega must be set.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_time_options_init(hbvib_time_options *o, size_t size_of_o);

/// Numbers of a periodic response in time. Fill it by hbvib_time_info_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// 0.
  int32_t reserved;
  /// 2 pi / omega.
  double period;
  /// Largest change over a period, relative to the largest displacement and velocity; infinite
  /// where the caller stopped before the end of the first period.
  double residual;
  /// Number of periods that were integrated.
  int64_t periods;
  /// Number of changes between stick, slip, open and closed, or between the lines of a table, in
  /// one period, all contacts of the model (of one sector) together.
  int64_t events;
} hbvib_time_info;

/// Fills the numbers of a response in time with zeros.
///
/// i          the struct; untouched on error.
/// size_of_i  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_time_info_init(hbvib_time_info *i, size_t size_of_i);

/// Finds the periodic response of a model to its forces at one angular frequency by integration in
/// time from event to event: exact to rounding where contacts are linear between events, by
/// adaptive implicit steps where a law is smooth. Nothing is truncated: harmonic balance tends to
/// this response as the number of its harmonics grows, so that it checks any point of a branch. A
/// cyclic model moves in the wave of its engine order. The progress hook is called after each
/// integrated period (in a wave after each part of it), with the largest displacement as amplitude.
/// A force callback is called for one time at once: samples is 1.
///
/// options        set omega; a point of a branch as start checks this solution.
/// hooks          progress, log and cancellation; NULL: none.
/// harmonics      receives (harmonics + 1) x ndof complex numbers, harmonic after harmonic; or
///                NULL.
/// harmonics_len  complex numbers in it; 0 with NULL.
/// samples        receives samples x ndof displacements, time after time from t = 0; or NULL.
/// samples_len    doubles in it; 0 with NULL.
/// info           receives numbers of the response; fill it by hbvib_time_info_init before; or
///                NULL.
/// HBVIB_STOPPED_BY_CALLER: the results are those of the last period, which is not steady.
/// Errors: HBVIB_E_ARGUMENT and HBVIB_E_NOT_FINITE (options, overlapping arrays), HBVIB_E_DIMENSION
/// (a length, with the one needed), HBVIB_E_UNSUPPORTED (a degree of freedom without mass, complex
/// matrices, HBVIB_FRICTION_3D, a force of the caller with states), HBVIB_E_NO_CONVERGENCE (no
/// steady state found), HBVIB_E_NO_BOUNDED_SOLUTION (the motion grows without bound),
/// HBVIB_E_CALLBACK (a force callback failed), HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE,
/// HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_time_response(const hbvib_model *model,
                                 const hbvib_time_options *options,
                                 const hbvib_hooks *hooks,
                                 double *harmonics,
                                 int64_t harmonics_len,
                                 double *samples,
                                 int64_t samples_len,
                                 hbvib_time_info *info);

/// Options of hbvib_time_sweep. Fill it by hbvib_sweep_options_init, then set frequencies and rate.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// Must be 0.
  int32_t reserved;
  /// First angular frequency of harmonic 1, > 0, rad per time unit.
  double omega_start;
  /// Last one, > 0; below the first for a run-down.
  double omega_stop;
  /// Change of the angular frequency per time, > 0 in both senses.
  double rate;
  /// Degree of freedom whose displacement is observed; default 0.
  int64_t dof;
  /// As of hbvib_time_options, for the first periodic motion and the steps of smooth laws.
  double tolerance;
  /// Cap on the periods that the first periodic motion takes.
  int64_t max_periods;
  /// Motion to find the first periodic one from, complex (H + 1) x ndof, as in
  /// hbvib_time_options; or NULL: rest.
  const double *start;
  /// Complex numbers in start.
  int64_t start_len;
} hbvib_sweep_options;

/// Fills the options of a sweep in time: degree of freedom 0, tolerance = 1e-11.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_sweep_options_init(hbvib_sweep_options *o, size_t size_of_o);

/// Numbers of a sweep in time. Fill it by hbvib_sweep_info_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// 0.
  int32_t reserved;
  /// Largest displacement of the sweep.
  double largest;
  /// Angular frequency at its time.
  double largest_omega;
  /// Its time, from the begin of the sweep.
  double largest_time;
  /// Changes between stick, slip, open and closed, or between the lines of a table, of all
  /// contacts.
  int64_t events;
} hbvib_sweep_info;

/// Fills the numbers of a sweep in time with zeros.
///
/// i          the struct; untouched on error.
/// size_of_i  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_sweep_info_init(hbvib_sweep_info *i, size_t size_of_i);

/// Integrates the motion in time while the frequency of the forces changes at a constant rate, as
/// in a run-up: the phase of harmonic 1 is omega_start t +- rate t^2 / 2, from the periodic motion
/// at omega_start on, at phase 0. Exact events as in hbvib_time_response, and its models, plain
/// ones alone.
///
/// model      a plain model; a wheel from hbvib_wheel_new is one.
/// options    frequencies, rate, observed degree of freedom.
/// hooks      progress, called after each turn with its frequency in `parameter`; log, phase and
///            cancellation. NULL: none.
/// capacity   turns of the phase by 2 pi that fit into each array.
/// time       receives the times at which turns begin, from 0; or NULL.
/// omega      receives the angular frequencies there; or NULL.
/// amplitude  receives the largest displacements within turns; or NULL.
/// count      receives the number of turns, also when `capacity` is too small; or NULL.
/// info       receives the largest displacement; fill it by hbvib_sweep_info_init before; or NULL.
/// HBVIB_STOPPED_BY_CALLER: the turns so far.
/// Errors: HBVIB_E_ARGUMENT, HBVIB_E_NOT_FINITE, HBVIB_E_INDEX (options), HBVIB_E_DIMENSION (start,
/// capacity: the arrays are untouched), HBVIB_E_UNSUPPORTED (a cyclic model, an unbalance, a speed
/// tied to the frequency, what hbvib_time_response refuses), HBVIB_E_NO_CONVERGENCE,
/// HBVIB_E_NO_BOUNDED_SOLUTION, HBVIB_E_CALLBACK, HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE,
/// HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_time_sweep(const hbvib_model *model,
                              const hbvib_sweep_options *options,
                              const hbvib_hooks *hooks,
                              int64_t capacity,
                              double *time,
                              double *omega,
                              double *amplitude,
                              int64_t *count,
                              hbvib_sweep_info *info);

/// Options of hbvib_branch_run_up. Fill it by hbvib_run_up_options_init, then set frequencies and
/// rate.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// As of hbvib_synthesis_options; default 0.
  int32_t model_damping;
  /// First angular frequency of the forces, > 0, rad per time unit.
  double omega_start;
  /// Last one, > 0; below the first for a run-down.
  double omega_stop;
  /// Change of the angular frequency per time, > 0 in both senses.
  double rate;
  /// Degree of freedom whose displacement is observed; default -1: that of the mode.
  int64_t dof;
  /// Factor on all forces of the model, > 0; default 1.
  double force_factor;
  /// Damping ratio that is added to the mode's; default 0. With one, nothing is integrated.
  double damping_ratio;
  /// Most turns that are integrated in time around the largest displacement, which corrects it and
  /// tells its error; default 10000; 0: none.
  int64_t integrated_turns;
} hbvib_run_up_options;

/// Fills the options of a run-up: the degree of freedom of the mode, forces and damping as they
/// are.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_run_up_options_init(hbvib_run_up_options *o, size_t size_of_o);

/// Numbers of a run-up. Fill it by hbvib_run_up_info_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// 0.
  int32_t reserved;
  /// Largest displacement.
  double largest;
  /// Angular frequency of the forces then.
  double largest_omega;
  /// That time, from the begin of the run-up.
  double largest_time;
  /// Relative error of the largest displacement: by how much three leads of the integration in time
  /// change it. Where `integrated` is 0 it is an estimate that may be too small; NaN where no
  /// steady resonance of the mode under these forces was found to compare with.
  double error;
  /// The largest displacement without the memory of sliders.
  double without_memory;
  /// Largest displacement of the highest steady resonance at the degree of freedom, with the mean
  /// and all harmonics as `largest` has it; NaN without one.
  double steady;
  /// The largest displacement by the slow flow alone.
  double slow_flow;
  /// Turns that were integrated in time; 0: none, and `largest` is that of the slow flow.
  int64_t integrated;
} hbvib_run_up_info;

/// Fills the numbers of a run-up with zeros.
///
/// i          the struct; untouched on error.
/// size_of_i  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_run_up_info_init(hbvib_run_up_info *i, size_t size_of_i);

/// The amplitude while the frequency of the forces changes at a constant rate, from the steady
/// motion at the first frequency on, by the slow flow of a nonlinear mode with the memory of
/// sliders. Turns around the largest displacement are integrated in time, which corrects it and
/// tells its error. hbvib_time_sweep integrates the whole motion.
///
/// branch           a nonlinear mode.
/// model            a plain model as for hbvib_branch_synthesis; forces in other harmonics act in
///                  the turns that are integrated alone.
/// options          frequencies and rate.
/// hooks            phase and cancellation; NULL: none.
/// capacity         numbers that fit into each array.
/// time             receives the time at the begin of each turn of the forces, or NULL.
/// omega            receives the angular frequency there, or NULL.
/// amplitude        receives the largest displacement in each turn, or NULL.
/// modal_amplitude  receives the modal amplitude at its begin, or NULL.
/// count            receives the number of turns, also when `capacity` is too small; or NULL.
/// info             receives the numbers; fill it by hbvib_run_up_info_init before; or NULL.
/// Errors: HBVIB_E_ARGUMENT (options; the amplitude leaves those of the mode), HBVIB_E_INDEX (dof),
/// HBVIB_E_UNSUPPORTED (a cyclic model, an unbalance, a law that is not integrated in time),
/// HBVIB_E_DIMENSION (capacity), those of hbvib_branch_synthesis. HBVIB_STOPPED_BY_CALLER: nothing
/// is written. Threads: any number on one model and branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_run_up(const hbvib_branch *branch,
                                 const hbvib_model *model,
                                 const hbvib_run_up_options *options,
                                 const hbvib_hooks *hooks,
                                 int64_t capacity,
                                 double *time,
                                 double *omega,
                                 double *amplitude,
                                 double *modal_amplitude,
                                 int64_t *count,
                                 hbvib_run_up_info *info);

/// A mission of hbvib_branch_mission. Fill it by hbvib_mission_options_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// As of hbvib_synthesis_options; default 0.
  int32_t model_damping;
  /// Rising times, points_len numbers.
  const double *times;
  /// Speeds of rotation at the times, > 0, points_len numbers; straight between them.
  const double *speeds;
  /// Number of times, >= 2.
  int64_t points_len;
  /// Angular frequency of the forces over the speed, > 0; default 1.
  double engine_order;
  /// Degree of freedom whose amplitude is read; default -1: that of the mode.
  int64_t dof;
  /// Rising amplitudes between which cycles are counted, edges_len numbers; or NULL.
  const double *edges;
  /// Number of edges.
  int64_t edges_len;
  /// Stress amplitude per modal amplitude of each place, >= 0, stresses_len numbers; or NULL.
  const double *stresses;
  /// Number of stresses.
  int64_t stresses_len;
  /// Stress amplitude of the knee of the Woehler line, > 0; needed with stresses.
  double woehler_stress;
  /// Cycles to failure at the knee, > 0.
  double woehler_cycles;
  /// Slope k above the knee, N ~ stress^-k, > 0.
  double woehler_slope;
  /// Slope below the knee; default 0: stresses below do no damage.
  double woehler_slope_below;
  /// Factor on all forces of the model, > 0; default 1.
  double force_factor;
  /// Damping ratio that is added to the mode's; default 0.
  double damping_ratio;
} hbvib_mission_options;

/// Fills the options of a mission: no point, engine order 1.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_mission_options_init(hbvib_mission_options *o, size_t size_of_o);

/// One resonance over a mission, speed against time, by the slow flow of its nonlinear mode without
/// the memory of sliders: amplitudes, cycles of each amplitude, and the sum of Miner. Several
/// resonances are as many calls, whose sums add. No error of the damage is told: in quick passages
/// it is too small (docs/life.md has figures); sum turns of hbvib_time_sweep where they count.
///
/// branch        a nonlinear mode.
/// model         as for hbvib_branch_synthesis; its own speed has no effect.
/// options       the mission.
/// hooks         phase and cancellation; NULL: none.
/// amplitude     receives the amplitude at each time, in the fundamental, points_len numbers; or
///               NULL.
/// cycles        receives the cycles below the first edge, between edges, and above the last one,
///               edges_len + 1 numbers; or NULL.
/// damage        receives the sum of Miner of each stress, stresses_len numbers; or NULL.
/// capacity      passages that fit into the arrays that follow.
/// crossing      receives for each passage through the resonance the time of its largest amplitude,
///               the angular frequency, its change per time, and the largest amplitude, then the
///               steady one (NaN if unknown), and the cycles with at least 1/sqrt(2) of the largest
///               amplitude: six numbers each; or NULL.
/// count         receives the number of passages, also when `capacity` is too small; or NULL.
/// error         receives the amplitude of the highest steady resonance of the mode over that of
///               the computed one, minus 1; NaN if unknown; or NULL.
/// Errors: HBVIB_E_ARGUMENT (options; the amplitude leaves those of the mode), HBVIB_E_INDEX (dof),
/// HBVIB_E_UNSUPPORTED (an unbalance), HBVIB_E_DIMENSION (lengths, capacity), those of
/// hbvib_branch_synthesis. HBVIB_STOPPED_BY_CALLER: nothing is written. Threads: any number on one
/// model and branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_mission(const hbvib_branch *branch,
                                  const hbvib_model *model,
                                  const hbvib_mission_options *options,
                                  const hbvib_hooks *hooks,
                                  double *amplitude,
                                  double *cycles,
                                  double *damage,
                                  int64_t capacity,
                                  double *crossing,
                                  int64_t *count,
                                  double *error);

/// Options of hbvib_campbell_response. Fill it by hbvib_campbell_options_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// As of hbvib_synthesis_options; default 0.
  int32_t model_damping;
  /// Angular frequency of the forces over the speed of rotation, > 0; default 1.
  double engine_order;
  /// Change of the speed per time in a passage, either sign; default 0: no passage.
  double acceleration;
  /// Damping ratio that is added to the mode's; default 0.
  double damping_ratio;
} hbvib_campbell_options;

/// Fills the options of resonances in a Campbell diagram: engine order 1, no passage.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_campbell_options_init(hbvib_campbell_options *o, size_t size_of_o);

/// The highest resonance of a nonlinear mode where an engine order meets it, under each of several
/// factors on the forces, and how much of it a passage reaches: the numbers of a Campbell diagram
/// coloured by amplitude. A passage is that of hbvib_branch_mission. Several modes and engine
/// orders are as many calls.
///
/// branch         a nonlinear mode.
/// model          as for hbvib_branch_synthesis; its own speed has no effect.
/// options        engine order, acceleration, damping; NULL: the defaults.
/// hooks          phase and cancellation; NULL: none.
/// n              number of factors, >= 1.
/// force_factors  factors on all forces of the model, > 0, n numbers.
/// speed          receives the speed of rotation of each resonance, n numbers, or NULL.
/// omega          receives its angular frequency, n numbers, or NULL.
/// amplitude      receives the steady amplitude of the degree of freedom of the mode, in the
///                fundamental, n numbers, or NULL.
/// damping_ratio  receives the damping ratio there, n numbers, or NULL.
/// passed         receives the largest amplitude of the passage, n numbers, or NULL; NaN without
///                acceleration.
/// error          receives the steady amplitude over the computed one, minus 1, n numbers, or NULL;
///                NaN where it was not computed.
/// All numbers of a factor are NaN where the mode has no resonance under it within its amplitudes.
/// Errors: HBVIB_E_ARGUMENT, HBVIB_E_NOT_FINITE, HBVIB_E_DIMENSION (options, factors, overlapping
/// arrays; a passage that leaves the amplitudes of the mode), HBVIB_E_UNSUPPORTED (an unbalance
/// with a passage), those of hbvib_branch_synthesis. HBVIB_STOPPED_BY_CALLER: nothing is written.
/// Threads: any number on one model and branch.
HBVIB_NODISCARD
hbvib_status hbvib_campbell_response(const hbvib_branch *branch,
                                     const hbvib_model *model,
                                     const hbvib_campbell_options *options,
                                     const hbvib_hooks *hooks,
                                     int64_t n,
                                     const double *force_factors,
                                     double *speed,
                                     double *omega,
                                     double *amplitude,
                                     double *damping_ratio,
                                     double *passed,
                                     double *error);

/// Options of hbvib_verify. Fill it by hbvib_verify_options_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// HBVIB_SHOOTING, which finds the solution of the point also where it is unstable, or
  /// HBVIB_MARCHING.
  int32_t method;
  /// As in hbvib_time_options.
  double tolerance;
  /// Cap on the periods that are integrated.
  int64_t max_periods;
  /// Largest distance from the motion in time, relative to that motion, at which the point counts
  /// as the same solution.
  double same_within;
} hbvib_verify_options;

/// Fills the options of a check in time with their defaults: shooting, tolerance = 1e-11,
/// same_within = 0.1.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_verify_options_init(hbvib_verify_options *o, size_t size_of_o);

/// Distance of a point from the periodic motion that integration in time finds from it. Norms are
/// root mean squares over the period and all degrees of freedom. Fill it by
/// hbvib_verification_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// 1 if the distance is at most same_within, else 0: the integration went to another solution,
  /// or the point has too few harmonics; a point with more harmonics decides which.
  int32_t same_solution;
  /// 1 if Newton's method did not converge from the point and periods were marched, which departs
  /// from an unstable solution, else 0; always 1 with HBVIB_MARCHING.
  int32_t marched;
  /// 0.
  int32_t reserved;
  /// The harmonic h in which the response is compared: the lowest above the mean in which the
  /// point moves.
  int64_t harmonic;
  /// X_h of the response degree of freedom in time, (re, im).
  double response[2];
  /// |X_h of the point - X_h in time| / |X_h in time|, the error that HBVIB_ERROR_ESTIMATE
  /// estimates.
  double response_error;
  /// Distance of the harmonics 0 .. H of all degrees of freedom, relative to the motion in time.
  double motion_error;
  /// Share of the motion in time above H.
  double above;
  /// Distance of the whole motions, relative to the motion in time; its square is the sum of the
  /// squares of motion_error and above.
  double distance;
  /// Largest displacement of the response degree of freedom over the period in time.
  double peak;
  /// Difference of the largest displacement of the point from it, relative to it.
  double peak_error;
  /// Largest change over a period of the motion in time, relative to its largest displacement and
  /// velocity: the size of the errors of the integration.
  double residual;
  /// Number of periods that were integrated.
  int64_t periods;
  /// Number of changes of the contacts in one period, as in hbvib_time_info.
  int64_t events;
  /// Number of the response of the branch with the largest error, from 0; -1 where it has none.
  int64_t worst_response;
  /// Its error: the distance of the measure of the point from that in time, relative to it; of
  /// complex amplitudes where the measure has one. NaN where the branch has no responses.
  double worst_response_error;
} hbvib_verification;

/// Fills the result of a check in time with zeros.
///
/// v          the struct; untouched on error.
/// size_of_v  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_verification_init(hbvib_verification *v, size_t size_of_v);

/// Checks a stored point of a forced response against integration in time, which starts from the
/// motion of the point and finds a periodic motion at its frequency (see hbvib_time_response):
/// their difference is the error of the point. The branch is not changed. Where several solutions
/// coexist the integration may end in another one: see same_solution, distance and marched.
///
/// model          the model of which the branch is a result.
/// point          number of a point of the curve, or of a peak, fold or requested solution.
/// options        NULL: the defaults.
/// hooks          progress, log and cancellation as in hbvib_time_response; NULL: none.
/// harmonics      receives the harmonics in time, (H + 1) x ndof complex numbers as
///                hbvib_branch_harmonics gives those of the point; or NULL.
/// harmonics_len  complex numbers in it; 0 with NULL.
/// errors         receives the parts of motion_error in each harmonic 0 .. H, whose squares add up;
///                or NULL.
/// errors_len     doubles in it; 0 with NULL.
/// out            receives the distances; fill it by hbvib_verification_init before; or NULL.
/// HBVIB_STOPPED_BY_CALLER: the results compare with the last period, which is not steady.
/// Errors: HBVIB_E_INDEX (point), HBVIB_E_UNSUPPORTED (branch is a nonlinear mode; a model that
/// hbvib_time_response refuses), HBVIB_E_ARGUMENT (another model, options, overlapping arrays),
/// HBVIB_E_NOT_FINITE (options), HBVIB_E_DIMENSION (a length, with the one needed),
/// HBVIB_E_NO_CONVERGENCE (no steady state found), HBVIB_E_NO_BOUNDED_SOLUTION (the motion grows
/// without bound), HBVIB_E_CALLBACK (a force callback failed), HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE,
/// HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: any number on one model and
/// branch.
HBVIB_NODISCARD
hbvib_status hbvib_verify(const hbvib_model *model,
                          const hbvib_branch *branch,
                          int64_t point,
                          const hbvib_verify_options *options,
                          const hbvib_hooks *hooks,
                          double *harmonics,
                          int64_t harmonics_len,
                          double *errors,
                          int64_t errors_len,
                          hbvib_verification *out);

/* ==============================================================================================
 * Stability: Floquet multipliers of points, bifurcations, limit cycles
 * ============================================================================================== */

/// Perturbations whose multipliers are computed.
typedef enum {
  /// The block of perturbations that contains the wave itself.
  HBVIB_WAVES_WAVE = 0,
  /// All perturbations of the wheel.
  HBVIB_WAVES_WHEEL = 1,
} hbvib_waves;

/// Reasons of multipliers.
typedef enum {
  /// Decides about stability.
  HBVIB_MULTIPLIER_ORDINARY = 0,
  /// Zero: a slider that slips forgets its place.
  HBVIB_MULTIPLIER_MEMORY = 1,
  /// One: the slider of a contact that always sticks stays where it is put.
  HBVIB_MULTIPLIER_NEUTRAL_STUCK = 2,
  /// One: a rigid motion takes all sliders along.
  HBVIB_MULTIPLIER_NEUTRAL_RIGID = 3,
  /// One: a motion that no force drives may begin at any time.
  HBVIB_MULTIPLIER_TRIVIAL = 4,
} hbvib_multiplier_class;

/// Events that a motion touches without passing them.
typedef enum {
  /// None.
  HBVIB_GRAZING_NONE = 0,
  /// The force of friction touches its limit.
  HBVIB_GRAZING_SLIP_LIMIT = 1,
  /// The contact closes without normal speed.
  HBVIB_GRAZING_LANDING = 2,
} hbvib_grazing;

/// Options of hbvib_floquet. Fill it by hbvib_floquet_options_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// HBVIB_WAVES_WAVE or HBVIB_WAVES_WHEEL, which have the same effect on a plain structure.
  int32_t waves;
  /// 1: move the point to the periodic motion in time by shooting first; 0: take it as it is.
  int32_t refine;
  /// Modes of each nodal diameter, with contacts stuck, on which a large structure is computed, and
  /// with half as many once more; 0: on all degrees of freedom; -1: on all unless that counts more
  /// than 1e11 operations, then on as many modes as agreement needs.
  int32_t modes;
  /// As in hbvib_time_options.
  double tolerance;
  /// Cap on the periods that shooting integrates. With refine = 0 it has no effect, as tolerance.
  int64_t max_periods;
} hbvib_floquet_options;

/// Fills the options of Floquet multipliers with their defaults: those of the wave, refine = 1,
/// tolerance = 1e-11, modes = -1.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_floquet_options_init(hbvib_floquet_options *o, size_t size_of_o);

/// Numbers of the stability of a point. Fill it by hbvib_floquet_info_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// Event that the motion touches, HBVIB_GRAZING_NONE and so on. Derivatives then differ on its
  /// two sides: ordinary multipliers and radius are NaN.
  int32_t grazing;
  /// Angular frequency of the motion: that of the point, unless no force drives it.
  double omega;
  /// Largest modulus of the ordinary multipliers; the motion is unstable if it is above 1.
  double radius;
  /// Number of multipliers.
  int64_t count;
  /// Number of ordinary multipliers outside the unit circle.
  int64_t unstable;
  /// Number of multipliers that are 1 by construction, a trivial one not among them.
  int64_t neutral;
  /// Contact that touches the event; -1: none.
  int64_t grazing_contact;
  /// Distance of the motion in time from that of the point, relative to it; 0 with refine = 0.
  double orbit_change;
  /// Largest change over a period of the motion in time, relative to its largest displacement and
  /// velocity; NaN with refine = 0.
  double residual;
  /// Modes of each nodal diameter on which the motion was computed; 0: on all degrees of freedom.
  int64_t modes;
  /// Largest change of a multiplier above half the radius from half as many modes; NaN where
  /// orbit_change is above 0.2.
  double modes_change;
  /// Estimate of the error of the radius that the other modes make, from the changes of those
  /// multipliers that reach as far from zero; 0 on all degrees of freedom, NaN as modes_change.
  double radius_error;
} hbvib_floquet_info;

/// Fills the numbers of a stability with zeros, grazing_contact with -1.
///
/// i          the struct; untouched on error.
/// size_of_i  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_floquet_info_init(hbvib_floquet_info *i, size_t size_of_i);

/// Computes the Floquet multipliers of a stored point: the factors by which small perturbations of
/// its motion grow in one period. The equations of perturbations are integrated along the exact
/// path in time from event to event, sliders included, so that the multipliers are those of the
/// motion, not of its harmonics. The motion is unstable where an ordinary multiplier lies outside
/// the unit circle. A cyclic model has one block of perturbations that contains the wave itself,
/// and others: HBVIB_WAVES_WHEEL computes all of them. A point of a nonlinear mode must be a limit
/// cycle, damping ratio zero, and its motion is one without forces. A large structure is computed
/// on the degrees of freedom of its contacts and on modes; numbers of modes whose verdicts differ
/// are HBVIB_E_NO_CONVERGENCE.
///
/// model            the model of which the branch is a result.
/// point            number of a point of the curve, or of a peak, fold or requested solution.
/// options          NULL: the defaults.
/// hooks            progress, log and cancellation as in hbvib_time_response; NULL: none.
/// multipliers      receives the largest multipliers, complex, by falling modulus, as many as it
///                  holds; or NULL.
/// multipliers_len  complex numbers in it; 0 with NULL. Each sector of the wheel has at most 2 ndof
///                  multipliers and one per contact.
/// classes          receives the reasons of the same multipliers, numbers of
///                  hbvib_multiplier_class; or NULL.
/// classes_len      numbers in it; 0 with NULL.
/// out              receives numbers of the stability; fill it by hbvib_floquet_info_init before;
///                  or NULL.
/// HBVIB_STOPPED_BY_CALLER: there are no multipliers, and the radius is NaN.
/// Errors: HBVIB_E_INDEX (point), HBVIB_E_UNSUPPORTED (a point of a nonlinear mode that is no limit
/// cycle; a model that hbvib_time_response refuses), HBVIB_E_ARGUMENT (another model, options,
/// overlapping arrays), HBVIB_E_DIMENSION (a length), HBVIB_E_NO_CONVERGENCE (shooting did not
/// converge from the point), HBVIB_E_NO_BOUNDED_SOLUTION, HBVIB_E_CALLBACK (a force callback
/// failed), HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE, HBVIB_E_BUSY,
/// HBVIB_E_OUT_OF_MEMORY. Threads: any number on one model and branch.
HBVIB_NODISCARD
hbvib_status hbvib_floquet(const hbvib_model *model,
                           const hbvib_branch *branch,
                           int64_t point,
                           const hbvib_floquet_options *options,
                           const hbvib_hooks *hooks,
                           double *multipliers,
                           int64_t multipliers_len,
                           int64_t *classes,
                           int64_t classes_len,
                           hbvib_floquet_info *out);

/// The smallest kick that was found. Fill it by hbvib_kick_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// 1: integration in time with a tight tolerance confirmed that `impulse` leads to another motion
  /// and `returning` does not; 0: the estimate is all that is known.
  int32_t verified;
  /// Impulse that leads to another motion, with its sign; NaN where none was found.
  double impulse;
  /// Impulse at the same phase after which the motion comes back.
  double returning;
  /// Phase of the forces at which it acts: omega t, 0 .. 2 pi.
  double phase;
  /// Smallest impulse to first order, from the left eigenvector of the saddle.
  double estimate;
  /// Its phase.
  double estimate_phase;
  /// Velocity that the impulse gives the degree of freedom.
  double velocity;
  /// Multiplier of the saddle in its unstable direction.
  double multiplier;
} hbvib_kick;

/// Fills the numbers of a kick with zeros.
///
/// k          the struct; untouched on error.
/// size_of_k  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_kick_init(hbvib_kick *k, size_t size_of_k);

/// Searches for the smallest impulse at one degree of freedom that leads from a stable point of a
/// forced response to another motion. Between the two lies an unstable one, a saddle: the left
/// eigenvector of its period map gives an estimate at each of `phases` times of the period, and
/// integration in time brackets the impulse to a thousandth, there and around the best of them.
/// Smaller kicks at other times, and in other directions, may exist.
///
/// model          the model of which both branches are results, not a cyclic one.
/// point          number of the stable point: of the curve, or a requested solution.
/// saddle_branch  the branch of the saddle, the same or another one.
/// saddle         number of an unstable point at the same frequency with one unstable direction.
/// dof            degree of freedom of the impulse.
/// phases         times of a period, 1 .. 10000; 16 are a good number.
/// hooks          progress, log and cancellation as in hbvib_time_response; NULL: none.
/// out            receives the kick; fill it by hbvib_kick_init before.
/// HBVIB_STOPPED_BY_CALLER: the kick found so far, not verified.
/// Errors: HBVIB_E_INDEX (point, saddle, dof), HBVIB_E_ARGUMENT (another model, two frequencies, a
/// saddle without one unstable direction, phases), HBVIB_E_UNSUPPORTED (a cyclic model, a nonlinear
/// mode; a model that hbvib_time_response refuses), HBVIB_E_NO_CONVERGENCE (shooting did not
/// converge from a point), HBVIB_E_NO_BOUNDED_SOLUTION, HBVIB_E_CALLBACK (a force callback
/// failed), HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE, HBVIB_E_BUSY,
/// HBVIB_E_OUT_OF_MEMORY. Threads: any number on one model and branch.
HBVIB_NODISCARD
hbvib_status hbvib_smallest_kick(const hbvib_model *model,
                                 const hbvib_branch *branch,
                                 int64_t point,
                                 const hbvib_branch *saddle_branch,
                                 int64_t saddle,
                                 int64_t dof,
                                 int64_t phases,
                                 const hbvib_hooks *hooks,
                                 hbvib_kick *out);

/// Kinds of bifurcations.
typedef enum {
  /// The branch turns in frequency; a multiplier passes 1.
  HBVIB_BIFURCATION_FOLD = 0,
  /// A multiplier passes -1: a motion of twice the period branches off.
  HBVIB_BIFURCATION_PERIOD_DOUBLING = 1,
  /// A pair of conjugate multipliers passes the unit circle: a motion with a second frequency
  /// branches off.
  HBVIB_BIFURCATION_NEIMARK_SACKER = 2,
  /// A multiplier passes 1 where the branch does not turn: another motion of the same period
  /// branches off.
  HBVIB_BIFURCATION_BRANCH_POINT = 3,
} hbvib_bifurcation;

/// Bifurcations of a forced response in the order of the branch: its folds and, with the solver
/// option `stability`, the points where a Floquet multiplier passes the unit circle, located on the
/// branch. A multiplier that jumps over the circle, as where slip sets in, is none of these kinds:
/// HBVIB_UNSTABLE_DIRECTIONS then changes without a bifurcation. A nonlinear mode has the branch
/// points of its curve, with the option `branches` of hbvib_mode_options.
///
/// capacity         numbers that fit into each array.
/// omega            receives their angular frequencies, or NULL.
/// amplitude        receives their amplitudes, or NULL.
/// kind             receives their kinds, numbers of hbvib_bifurcation, or NULL.
/// point            receives their point numbers for hbvib_floquet and others, numbers, or NULL.
/// unstable_before  receives the numbers of unstable directions before them along the branch, -1
///                  where unknown, numbers, or NULL.
/// unstable_after   receives the numbers after them, or NULL.
/// count            receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_DIMENSION (capacity too small: the arrays are untouched), HBVIB_E_NULL,
/// HBVIB_E_HANDLE, HBVIB_E_OUT_OF_MEMORY. Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_bifurcations(const hbvib_branch *branch,
                                       int64_t capacity,
                                       double *omega,
                                       double *amplitude,
                                       int64_t *kind,
                                       int64_t *point,
                                       int64_t *unstable_before,
                                       int64_t *unstable_after,
                                       int64_t *count);

/// Limit cycles on a nonlinear mode, where its damping ratio is zero: periodic motions of the model
/// without forces. Refined on the solution, in the order of the branch. hbvib_floquet tells whether
/// one is stable; with a negative slope it is not.
///
/// capacity         numbers that fit into each array.
/// omega            receives their angular frequencies, or NULL.
/// log10_amplitude  receives log10 of their amplitudes, the parameter of the mode, or NULL.
/// slope            receives the derivatives of the damping ratio by log10 of the amplitude, or
///                  NULL.
/// point            receives their point numbers for hbvib_floquet and others, numbers, or NULL.
/// count            receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned. A forced response has none.
/// Errors: HBVIB_E_DIMENSION (capacity too small: the arrays are untouched), HBVIB_E_NULL,
/// HBVIB_E_HANDLE, HBVIB_E_OUT_OF_MEMORY. Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_limit_cycles(const hbvib_branch *branch,
                                       int64_t capacity,
                                       double *omega,
                                       double *log10_amplitude,
                                       double *slope,
                                       int64_t *point,
                                       int64_t *count);

/* ==============================================================================================
 * Design studies: parameters of a model, derivatives of results by them, responses over them
 * ============================================================================================== */

/// Kinds of parameters.
typedef enum {
  /// A factor on all forces, 1 at present.
  HBVIB_PARAMETER_FORCE = 0,
  /// Normal load of a contact at rest.
  HBVIB_PARAMETER_PRELOAD = 1,
  /// Friction coefficient of a contact.
  HBVIB_PARAMETER_MU = 2,
  /// Stiffness kt of a contact.
  HBVIB_PARAMETER_KT = 3,
  /// Normal stiffness of a contact.
  HBVIB_PARAMETER_KN = 4,
  /// Gap of a contact.
  HBVIB_PARAMETER_GAP = 5,
  /// The mass matrix.
  HBVIB_PARAMETER_MASS = 6,
  /// The damping matrix.
  HBVIB_PARAMETER_DAMPING = 7,
  /// The stiffness matrix of the structure, without springs and contacts.
  HBVIB_PARAMETER_STIFFNESS = 8,
  /// The fixed speed of rotation Omega.
  HBVIB_PARAMETER_SPEED = 9,
  /// Place of the slider of a contact before any motion, along t1.
  HBVIB_PARAMETER_SLIDER_T1 = 10,
  /// The same along t2, of friction in a plane.
  HBVIB_PARAMETER_SLIDER_T2 = 11,
} hbvib_parameter_kind;

/// How a parameter changes a matrix.
typedef enum {
  /// The coefficient, 0 at present, of a direction that is added to the matrix; in a cyclic model
  /// to the block of the sector itself.
  HBVIB_SCALING_ADDITIVE = 0,
  /// A factor, 1 at present, on the whole matrix with its couplings.
  HBVIB_SCALING_FACTOR = 1,
} hbvib_scaling;

/// A parameter of a model. Fill it by hbvib_parameter_init. Rayleigh damping and the loss factor
/// follow the mass and stiffness matrices, as where a matrix is set anew; the factor of the damping
/// acts on Rayleigh and modal damping as well. Where a list has a factor s and a direction E of one
/// matrix A, the values make s A + d E of it, in any order of the list.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// HBVIB_PARAMETER_FORCE and so on.
  int32_t kind;
  /// Constants of contacts: number of the contact, or -1: the constant of all contacts that have
  /// it, changed together. Other kinds: -1.
  int64_t contact;
  /// Matrices, additive: the direction, ndof x ndof. Otherwise NULL.
  const hbvib_matrix *direction;
  /// Matrices: HBVIB_SCALING_ADDITIVE or HBVIB_SCALING_FACTOR. Otherwise 0.
  int32_t scaling;
  /// Must be 0.
  int32_t reserved;
} hbvib_parameter;

/// Fills a parameter: a factor on all forces.
///
/// p          the struct; untouched on error.
/// size_of_p  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_parameter_init(hbvib_parameter *p, size_t size_of_p);

/// Results that may be differentiated.
typedef enum {
  /// Amplitude of a forced response at a fixed frequency.
  HBVIB_OF_AMPLITUDE = 0,
  /// Amplitude of a peak, which moves with the parameter.
  HBVIB_OF_PEAK_AMPLITUDE = 1,
  /// Angular frequency of a peak.
  HBVIB_OF_PEAK_OMEGA = 2,
  /// Angular frequency of a nonlinear mode at a fixed amplitude.
  HBVIB_OF_MODE_OMEGA = 3,
  /// Damping ratio of a nonlinear mode at a fixed amplitude; at its maximum also the derivative of
  /// the largest damping ratio.
  HBVIB_OF_MODE_DAMPING = 4,
  /// Plus the number of a response of hbvib_forced_options: that response, at a fixed frequency or
  /// at a peak of it, which moves with the parameter.
  HBVIB_OF_RESPONSE = 1000000,
  /// Plus the number of a response: angular frequency of a peak of it.
  HBVIB_OF_RESPONSE_PEAK_OMEGA = 2000000,
} hbvib_quantity;

/// Reasons of derivatives.
typedef enum {
  /// The derivative exists.
  HBVIB_DERIVATIVE_EXISTS = 0,
  /// NaN: a contact is at the onset of slip, where the derivatives on the two sides differ.
  HBVIB_DERIVATIVE_ONSET_OF_SLIP = 1,
  /// NaN: the constant is 0 and may not fall, so that a derivative exists on one side only.
  HBVIB_DERIVATIVE_ONE_SIDED = 2,
  /// NaN: the point is a fold, where the result changes infinitely fast.
  HBVIB_DERIVATIVE_FOLD = 3,
} hbvib_derivative;

/// Derivatives of a result at a stored point by parameters of the model, exact for the harmonics of
/// the point: dA/dp = A_p - lambda^T R_p with the adjoint lambda of the equations R = 0, which is
/// solved once for all parameters (for the frequency of a peak five times). The derivatives of
/// contact forces follow from their exact events. By the preload and mu of a contact that sticks
/// they are exactly 0.
///
/// model           the model of which the branch is a result, unchanged since.
/// point           number of a point of the curve, or of a peak, fold or requested solution.
/// of              HBVIB_OF_AMPLITUDE and so on; those of a peak need the number of a peak.
/// parameters      array of parameters, struct_size of the first apart.
/// count           how many, >= 1.
/// derivatives     receives the derivatives, NaN where there is none.
/// derivatives_len numbers in it: count.
/// reasons         receives numbers of hbvib_derivative, count of them; or NULL.
/// onset           receives the contact that is at the onset of slip, or -1; or NULL.
/// hooks           phase, log and cancellation; progress is not called. NULL: none.
/// HBVIB_STOPPED_BY_CALLER: the arrays are untouched.
/// Errors: HBVIB_E_INDEX (point, contact), HBVIB_E_UNSUPPORTED (a constant that the law of a
/// contact does not have, or of a law of the caller; mass and stiffness under modal damping; a
/// speed that is tied to the frequency), HBVIB_E_ARGUMENT (another model, a result that the point
/// does not have, fields of a parameter, overlapping arrays), HBVIB_E_DIMENSION (count,
/// derivatives_len, a direction), HBVIB_E_CALLBACK (a force callback failed), HBVIB_E_NULL,
/// HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: any number on
/// one model and branch.
HBVIB_NODISCARD
hbvib_status hbvib_sensitivity(const hbvib_model *model,
                               const hbvib_branch *branch,
                               int64_t point,
                               int32_t of,
                               const hbvib_parameter *parameters,
                               int64_t count,
                               double *derivatives,
                               int64_t derivatives_len,
                               int64_t *reasons,
                               int64_t *onset,
                               const hbvib_hooks *hooks);

/// Derivatives of the complex amplitude of a response at a stored point of a forced response by
/// parameters of the model, at a fixed frequency, exact for the harmonics of the point: the
/// real and the imaginary part have one adjoint each, from one factorised matrix. The branch
/// need not have watched the response.
///
/// model            the model of which the branch is a result, unchanged since.
/// branch           a forced response.
/// point            number of a stored point.
/// response         a fundamental or a harmonic; NULL: the fundamental of the response degree of
///                  freedom.
/// parameters       array of parameters, struct_size of the first apart.
/// count            how many, >= 1.
/// derivatives      receives the complex derivatives, re and im, 2 count doubles; NaN where
///                  there is none.
/// derivatives_len  complex numbers in it: count.
/// reasons          receives numbers of hbvib_derivative, count of them; or NULL.
/// onset            receives the contact that is at the onset of slip, or -1; or NULL.
/// value            receives the amplitude, re and im; or NULL.
/// by_omega         receives its derivative by the angular frequency along the branch, re and
///                  im, NaN in a fold; or NULL.
/// hooks            phase, log and cancellation; progress is not called. NULL: none.
/// HBVIB_STOPPED_BY_CALLER: the arrays are untouched.
/// Errors: HBVIB_E_INDEX (point, contact), HBVIB_E_UNSUPPORTED (a nonlinear mode, near-rigid
/// contacts, parameters as in hbvib_sensitivity), HBVIB_E_ARGUMENT (another model, a measure
/// without phase, overlapping arrays), HBVIB_E_DIMENSION, HBVIB_E_CALLBACK, HBVIB_E_NULL,
/// HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: any
/// number on one model and branch.
HBVIB_NODISCARD
hbvib_status hbvib_response_sensitivity(const hbvib_model *model,
                                        const hbvib_branch *branch,
                                        int64_t point,
                                        const hbvib_response *response,
                                        const hbvib_parameter *parameters,
                                        int64_t count,
                                        double *derivatives,
                                        int64_t derivatives_len,
                                        int64_t *reasons,
                                        int64_t *onset,
                                        double *value,
                                        double *by_omega,
                                        const hbvib_hooks *hooks);

/// Result that a parameter response follows.
typedef enum {
  /// The response at a fixed frequency.
  HBVIB_FOLLOW_OMEGA = 0,
  /// A peak of the response.
  HBVIB_FOLLOW_PEAK = 1,
  /// A fold of the response over the frequency.
  HBVIB_FOLLOW_FOLD = 2,
  /// The largest damping ratio along a nonlinear mode.
  HBVIB_FOLLOW_MODE_MAX_DAMPING = 3,
  /// A peak, which is also followed where it turns into the minimum that it meets.
  HBVIB_FOLLOW_PEAK_THROUGH_FOLDS = 4,
} hbvib_follow;

/// Range of a parameter response. Fill it by hbvib_parameter_options_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// A value of enum hbvib_follow.
  int32_t follow;
  /// The parameter: must be set.
  const hbvib_parameter *parameter;
  /// First value: of a constant or the speed the value itself, of a factor 1 as at present, of a
  /// direction its coefficient.
  double start;
  /// Last value; below the first for a downward response.
  double stop;
  /// Angular frequency: the fixed one, or one within a tenth of which the peak or fold next to it
  /// is sought at the first value. With HBVIB_FOLLOW_MODE_MAX_DAMPING the mode is the one whose
  /// linear mode with stuck contacts is next to it.
  double omega;
  /// Values at which every solution is computed exactly, or NULL.
  const double *at;
  /// Number of these values.
  int64_t at_len;
  /// HBVIB_FOLLOW_MODE_MAX_DAMPING only, 0 for others: log10 of the modal amplitude from which
  /// the maximum of damping is sought at the first value. Equal to log10_stop, as 0 and 0: from
  /// the onset of slip to a thousand times its amplitude.
  double log10_start;
  /// The same up to which it is sought.
  double log10_stop;
  /// The response that is followed, not with HBVIB_FOLLOW_MODE_MAX_DAMPING; NULL: the amplitude
  /// of the response degree of freedom.
  const hbvib_response *response;
} hbvib_parameter_options;

/// Fills the options of a parameter response with zeros: parameter, range and omega must be set.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_parameter_options_init(hbvib_parameter_options *o, size_t size_of_o);

/// Follows a result over a parameter by arc-length continuation: the amplitude of a forced
/// response, or the response of the options, at a fixed frequency, in a peak or in a fold, or the
/// largest damping ratio of a nonlinear mode. Folds over the parameter are passed
/// (hbvib_branch_turns), minima and maxima refined (hbvib_branch_optima). The harmonics are
/// chosen at each point by the tolerance of the solver, or the same at all points with a
/// tolerance of 0. The branch has the fields HBVIB_PARAMETER_VALUE and HBVIB_D_AMPLITUDE, of a
/// mode HBVIB_D_DAMPING and those of a mode; its points belong to different models, so that
/// functions of a model and a branch refuse it.
///
/// solver   options of the solver; NULL: the defaults.
/// options  parameter, range, and the result to follow.
/// hooks    progress, log and cancellation; NULL: none.
/// out      receives the branch; untouched on error. Free it by hbvib_branch_free.
/// A positive status says why the branch ends early: HBVIB_STOPPED_PEAK_VANISHED where a peak or
/// a maximum of damping met a minimum (HBVIB_FOLLOW_PEAK_THROUGH_FOLDS goes on there). Two folds
/// that meet in a cusp are one curve, which comes back: HBVIB_STOPPED_LEFT_RANGE. A peak that is
/// no longer the highest is told by hbvib_branch_higher_peaks.
/// Errors: those of hbvib_forced_response, hbvib_nonlinear_mode and of the parameters of
/// hbvib_sensitivity; HBVIB_E_NO_CONVERGENCE also where there is no peak, fold or maximum of
/// damping near the frequency. Threads: as for hbvib_forced_response.
HBVIB_NODISCARD
hbvib_status hbvib_parameter_response(const hbvib_model *model,
                                      const hbvib_solver_options *solver,
                                      const hbvib_parameter_options *options,
                                      const hbvib_hooks *hooks,
                                      hbvib_branch **out);

/// Minima and maxima of the result over the parameter, refined on the solution, in the order of
/// the branch. Other branches have none.
///
/// capacity   numbers that fit into each array.
/// parameter  receives the values of the parameter, or NULL.
/// amplitude  receives the amplitudes, of a mode the damping ratios, or NULL.
/// maximum    receives numbers: 1 for a maximum, 0 for a minimum; or NULL.
/// point      receives their point numbers for hbvib_branch_harmonics, numbers, or NULL.
/// count      receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_DIMENSION (capacity too small: the arrays are untouched), HBVIB_E_NULL,
/// HBVIB_E_HANDLE. Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_optima(const hbvib_branch *branch,
                                 int64_t capacity,
                                 double *parameter,
                                 double *amplitude,
                                 int64_t *maximum,
                                 int64_t *point,
                                 int64_t *count);

/// Points at which a branch over a parameter turns, refined: beyond their values the result does
/// not exist. Over the force those with HBVIB_FOLLOW_PEAK_THROUGH_FOLDS are the forces at which a
/// detached curve is born (a minimum) or merges with another one (a maximum). A fold turns there,
/// too, and in a cusp. Other branches have none.
///
/// capacity   numbers that fit into each array.
/// parameter  receives the values of the parameter, or NULL.
/// omega      receives the angular frequencies, or NULL.
/// amplitude  receives the amplitudes, or NULL.
/// maximum    receives numbers: 1 where the parameter is largest, 0 where smallest; or NULL.
/// point      receives their point numbers for hbvib_branch_harmonics, numbers, or NULL.
/// count      receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_DIMENSION (capacity too small: the arrays are untouched), HBVIB_E_NULL,
/// HBVIB_E_HANDLE. Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_turns(const hbvib_branch *branch,
                                int64_t capacity,
                                double *parameter,
                                double *omega,
                                double *amplitude,
                                int64_t *maximum,
                                int64_t *point,
                                int64_t *count);

/// Peaks that are higher than the followed one. At the first and the last point of the curve and
/// at the optima the response is swept over a tenth of the frequency below and above the followed
/// peak; a sweep that fails shows none. Other branches have none.
///
/// capacity   numbers that fit into each array.
/// parameter  receives the values of the parameter, or NULL.
/// omega      receives the angular frequencies of the higher peaks, or NULL.
/// amplitude  receives their amplitudes, or NULL.
/// point      receives the point numbers of the followed peak, or NULL.
/// count      receives how many there are, also when `capacity` is too small.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_DIMENSION (capacity too small: the arrays are untouched), HBVIB_E_NULL,
/// HBVIB_E_HANDLE. Threads: any number on one branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_higher_peaks(const hbvib_branch *branch,
                                       int64_t capacity,
                                       double *parameter,
                                       double *omega,
                                       double *amplitude,
                                       int64_t *point,
                                       int64_t *count);

/// The peaks of many designs, created by hbvib_batch_solve.
typedef struct hbvib_batch hbvib_batch;

/// Options of hbvib_batch_solve. Fill it by hbvib_batch_options_init, then set the range.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// Threads, the calling one included, 1 .. 1024; default 1. Their number changes no bit of a
  /// result.
  int32_t threads;
  /// First angular frequency of each response, > 0, rad per time unit.
  double omega_start;
  /// Last angular frequency: below the first for downward sweeps.
  double omega_stop;
  /// 1: the branch of each design is kept, for hbvib_batch_branch; 0 (default): it is not, and the
  /// solver options estimate_error, stability and freedom have no effect.
  int32_t keep;
  /// Must be 0.
  int32_t reserved;
  /// Array of the responses that are watched, struct_size of the first apart, or NULL: the
  /// amplitude of the response degree of freedom. The first leads the peak of a design, and each
  /// has its own: hbvib_batch_response_peaks.
  const hbvib_response *responses;
  /// Number of responses.
  int64_t responses_len;
} hbvib_batch_options;

/// Fills the options of a batch: one thread, no branch kept. The frequencies must be set.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_batch_options_init(hbvib_batch_options *o, size_t size_of_o);

/// Finds the highest peak of the response of each design within a range of frequency. A design is
/// the model with values of its parameters: constants of contacts and the speed are set, factors
/// multiply, and directions are added times the value, after the factors wherever they stand in the
/// list. Each design is solved by itself, so that its result depends on no other, on their order or
/// on the number of threads. Designs that change constants of contacts and forces alone share the
/// structure of the model.
///
/// model       stays as it is.
/// solver      options; NULL: the defaults. A fixed response_dof makes peaks comparable.
/// options     range of frequency, threads.
/// hooks       progress, called after each design that the calling thread has solved, with the
///             number of designs done in `point` and the peak in `parameter` and `amplitude`; phase
///             and cancellation. All callbacks run on the calling thread. NULL: none.
/// parameters  array of parameters, struct_size of the first apart.
/// count       how many, >= 1.
/// designs     number of designs, >= 0.
/// values      values of the parameters, designs x count, design after design.
/// out         receives the batch; untouched on error. Free it by hbvib_batch_free.
/// A design that fails has a status of its own and NaN for its peak; the others are solved.
/// HBVIB_STOPPED_BY_CALLER: designs that were not solved have that status.
/// Errors: HBVIB_E_INDEX, HBVIB_E_UNSUPPORTED (a parameter that the model does not have; several
/// threads for a model with a force of the caller), HBVIB_E_ARGUMENT, HBVIB_E_NOT_FINITE (options),
/// HBVIB_E_DIMENSION, HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE, HBVIB_E_BUSY,
/// HBVIB_E_OUT_OF_MEMORY. Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_batch_solve(const hbvib_model *model,
                               const hbvib_solver_options *solver,
                               const hbvib_batch_options *options,
                               const hbvib_hooks *hooks,
                               const hbvib_parameter *parameters,
                               int64_t count,
                               int64_t designs,
                               const double *values,
                               hbvib_batch **out);

/// Frees a batch; branches that were taken from it stay. NULL is accepted and does nothing.
///
/// Errors: HBVIB_E_HANDLE (freed before, for example), HBVIB_E_BUSY. Threads: any, once.
hbvib_status hbvib_batch_free(hbvib_batch *batch);

/// Number of designs of a batch; or a negative status.
///
/// Errors: HBVIB_E_HANDLE, HBVIB_E_BUSY (a branch is being taken). Threads: any number on a batch.
int64_t hbvib_batch_designs(const hbvib_batch *batch);

/// The highest peak of each design, in the order of their values.
///
/// capacity        numbers that fit into each array: at least the number of designs.
/// peak_amplitude  receives amplitudes, NaN without a maximum; or NULL.
/// peak_omega      receives angular frequencies, NaN without a maximum; or NULL.
/// statuses        receives numbers of hbvib_status, as of hbvib_batch_status; or NULL.
/// points          receives numbers of points of each curve; or NULL.
/// Errors: HBVIB_E_DIMENSION (capacity: the arrays are untouched), HBVIB_E_ARGUMENT (overlapping
/// arrays), HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: any number on one batch.
HBVIB_NODISCARD
hbvib_status hbvib_batch_peaks(const hbvib_batch *batch,
                               int64_t capacity,
                               double *peak_amplitude,
                               double *peak_omega,
                               int64_t *statuses,
                               int64_t *points);

/// The highest peak of a response of each design, in the order of their values.
///
/// response   number of the response of hbvib_batch_options, from 0.
/// capacity   numbers that fit into each array: at least the number of designs.
/// amplitude  receives measures, NaN without a maximum or where the design failed; or NULL.
/// omega      receives angular frequencies; or NULL.
/// Errors: HBVIB_E_INDEX (response), HBVIB_E_DIMENSION (capacity: the arrays are untouched),
/// HBVIB_E_ARGUMENT (overlapping arrays), HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: any
/// number on one batch.
HBVIB_NODISCARD
hbvib_status hbvib_batch_response_peaks(const hbvib_batch *batch,
                                        int64_t response,
                                        int64_t capacity,
                                        double *amplitude,
                                        double *omega);

/// The larger value of a response of each design at the two ends of the range, in the order of
/// their values. Where it is above the highest peak of hbvib_batch_response_peaks, or there is
/// none, the highest peak lies beyond that end.
///
/// response   number of the response of hbvib_batch_options, from 0.
/// capacity   numbers that fit into each array: at least the number of designs.
/// amplitude  receives measures, NaN where the design failed; or NULL.
/// omega      receives the angular frequency of the end; or NULL.
/// Errors: HBVIB_E_INDEX (response), HBVIB_E_DIMENSION (capacity: the arrays are untouched),
/// HBVIB_E_ARGUMENT (overlapping arrays), HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: any
/// number on one batch.
HBVIB_NODISCARD
hbvib_status hbvib_batch_response_ends(const hbvib_batch *batch,
                                       int64_t response,
                                       int64_t capacity,
                                       double *amplitude,
                                       double *omega);

/// The status of a design, whose sentence hbvib_last_error then has: HBVIB_OK;
/// HBVIB_STOPPED_NO_PEAK without a maximum; another positive number where the branch ended early
/// and may have higher maxima beyond; HBVIB_STOPPED_BY_CALLER where it was not solved; negative
/// where it failed.
///
/// design  number from 0, in the order of the values.
/// Errors: HBVIB_E_INDEX, HBVIB_E_HANDLE, HBVIB_E_BUSY. Threads: any number on one batch.
HBVIB_NODISCARD
hbvib_status hbvib_batch_status(const hbvib_batch *batch, int64_t design);

/// Takes the branch of a design out of the batch, which must have been solved with keep = 1.
///
/// design  number from 0, in the order of the values.
/// out     receives the branch; untouched on error. Free it by hbvib_branch_free.
/// Errors: HBVIB_E_ARGUMENT (branches were not kept, this one was taken before, or the design has
/// none because it failed), HBVIB_E_INDEX, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY,
/// HBVIB_E_OUT_OF_MEMORY. Threads: one at a time per batch.
HBVIB_NODISCARD
hbvib_status hbvib_batch_branch(hbvib_batch *batch, int64_t design, hbvib_branch **out);

/// Numbers of the peaks of a wheel. Fill it by hbvib_wheel_info_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// 0.
  int32_t reserved;
  /// Blade with the highest peak, from 0; -1 without any.
  int64_t blade;
  /// That peak; NaN without one.
  double largest;
  /// Peak of the tuned wheel; NaN without one within the range.
  double tuned;
  /// Angular frequency of the peak of the tuned wheel.
  double tuned_omega;
  /// Amplification factor: largest over tuned; NaN where one of both lies beyond an end of the
  /// range.
  double amplification;
  /// Blades whose response is larger at an end of the range than at each of their peaks.
  int64_t beyond;
  /// Largest response of a blade at an end of the range: above `largest`, the highest peak of the
  /// wheel lies beyond that end.
  double end_amplitude;
  /// Angular frequency of that end.
  double end_omega;
} hbvib_wheel_info;

/// Fills the numbers of the peaks of a wheel with zeros.
///
/// i          the struct; untouched on error.
/// size_of_i  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_wheel_info_init(hbvib_wheel_info *i, size_t size_of_i);

/// The highest peak of each blade of a wheel within a range of frequency, and the amplification
/// against the tuned wheel. All blades are watched in one response, so that a tolerance holds for
/// each of them; the tuned wheel is the wave of its sector.
///
/// wheel        made by hbvib_wheel_new of `cyclic`, mistuned or not.
/// cyclic       the model of the sector.
/// blade        response of a sector that is watched, in degrees of freedom of the sector; NULL:
///              the fundamental of the response degree of freedom of the solver.
/// solver       options, the response degree of freedom is one of the sector; NULL: the defaults.
/// omega_start  first angular frequency of the range, > 0.
/// omega_stop   last one.
/// hooks        progress, log, phase and cancellation; NULL: none.
/// capacity     numbers that fit into each array: at least the number of sectors.
/// amplitude    receives the peaks, NaN where a blade has none; or NULL.
/// omega        receives their angular frequencies, or NULL.
/// error        receives their estimated relative errors, NaN where no tolerance asked for them; or
///              NULL.
/// count        receives the number of sectors, also when `capacity` is too small.
/// info         receives the numbers of the largest one; fill it by hbvib_wheel_info_init before;
///              or NULL.
/// out          receives the response of the wheel, whose response s is that of blade s; or NULL.
/// HBVIB_STOPPED_NO_PEAK: the highest peak of the wheel, or of the tuned one, lies beyond an end of
/// the range, as a blade is larger there than at each peak within; everything is written, and the
/// amplification is NaN. Other positive statuses are those of hbvib_forced_response, of the
/// response of the wheel.
/// Errors: HBVIB_E_DIMENSION (the wheel of another model, capacity), HBVIB_E_INDEX (blade),
/// HBVIB_E_ARGUMENT (range; the wheel of another model), those of hbvib_forced_response. Threads:
/// any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_wheel_peaks(const hbvib_model *wheel,
                               const hbvib_model *cyclic,
                               const hbvib_response *blade,
                               const hbvib_solver_options *solver,
                               double omega_start,
                               double omega_stop,
                               const hbvib_hooks *hooks,
                               int64_t capacity,
                               double *amplitude,
                               double *omega,
                               double *error,
                               int64_t *count,
                               hbvib_wheel_info *info,
                               hbvib_branch **out);

/// The pattern of a mistuned wheel from measured modes, with its covariance: that of the greatest
/// likelihood under normal noise of frequencies and shapes. Modes without damping of the wheel are
/// sought in the space of the tuned ones (component mode mistuning); families + 1 instead of
/// families shows what that leaves out.
///
/// cyclic       the model of the tuned sector.
/// kind         HBVIB_MISTUNING_STIFFNESS, _FREQUENCY or _MASS.
/// n_dofs       degrees of freedom of the blade of a sector, 0 with a direction.
/// dofs         their numbers, n_dofs numbers, each once.
/// direction    matrix of a sector instead of a blade, as for hbvib_wheel_mistune; or NULL.
/// contacts     their state in the measurement: HBVIB_CONTACTS_FREE, _STUCK or _STATIC.
/// families     tuned modes of each nodal diameter, from the lowest, that span those of the wheel:
///              up to the measured ones, and some more.
/// n_points     degrees of freedom of each sector that were measured, at least 1.
/// points       their numbers in the sector.
/// n_modes      number of measured modes, at least 1.
/// omega        their angular frequencies, n_modes numbers above 0.
/// sigma_omega  standard deviations of these, above 0.
/// shapes       complex numbers (real part, imaginary part) of the shapes, of any scale and phase:
///              mode after mode, sector after sector, point after point.
/// sigma_shape  standard deviation of each part of a number of a shape, in its scale: one for each
///              mode, above 0.
/// hooks        phase, log and cancellation; progress is not called. NULL: none.
/// sectors      number of sectors: length of delta.
/// delta        receives delta of each sector, as hbvib_wheel_mistune takes it.
/// covariance   receives sectors * sectors numbers, or NULL.
/// chi2         receives the sum of the squares of residuals over standard deviations, or NULL:
///              about the number that degrees receives where noise is all that is left.
/// degrees      receives the number of data less that of unknowns, or NULL.
/// Errors: HBVIB_E_ARGUMENT (kind, families, a standard deviation, a shape that is zero, a fixed
/// point), HBVIB_E_INDEX (dofs, points), HBVIB_E_DIMENSION (numbers), HBVIB_E_NOT_FINITE,
/// HBVIB_E_SINGULAR (the modes do not tell the pattern), HBVIB_E_NO_CONVERGENCE,
/// HBVIB_E_UNSUPPORTED (a plain model, gyroscopic forces, complex matrices, damping), those of
/// hbvib_linear_modes and hbvib_wheel_mistune. Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_wheel_identify(const hbvib_model *cyclic,
                                  int32_t kind,
                                  int64_t n_dofs,
                                  const int64_t *dofs,
                                  const hbvib_matrix *direction,
                                  int32_t contacts,
                                  int64_t families,
                                  int64_t n_points,
                                  const int64_t *points,
                                  int64_t n_modes,
                                  const double *omega,
                                  const double *sigma_omega,
                                  const double *shapes,
                                  const double *sigma_shape,
                                  const hbvib_hooks *hooks,
                                  int64_t sectors,
                                  double *delta,
                                  double *covariance,
                                  double *chi2,
                                  int64_t *degrees);

/// Makes a sector whose blade moves in its lowest cantilever modes, with everything else held, and
/// as the rest carries it along (Craig and Bampton): 10 to 20 modes of a finite-element blade. In
/// the wheel of it a pattern of the modes (hbvib_wheel_mistune with their numbers as dofs) is
/// exactly one of the stiffness of the blade, of a rank of modes a blade. The new sector has the
/// degrees of freedom that are left, in their order, then the modes; right faces and fixed degrees
/// of freedom have no number there. Contacts, springs, damping, wave and speed are taken over, and
/// forces on the blade act on the modes.
///
/// cyclic       the model of the sector; stays as it is.
/// n_dofs       number of degrees of freedom of the blade.
/// dofs         all of them but those of its root and those with contacts and springs.
/// modes        number of modes, 1 .. n_dofs - 1.
/// families     tuned modes of each nodal diameter whose error is told, at least 1.
/// hooks        phase and cancellation; NULL: none.
/// n_points     number of degrees of freedom whose motion is asked for, 0 with points NULL.
/// points       their numbers in `cyclic`, for responses as the tip of a blade.
/// weights_len  numbers that fit into weights, at least n_points times the degrees of freedom of
///              the new sector: for each point ndof - n_dofs + modes are enough.
/// weights      receives the weights of these that make the motion of each point, point after
///              point; or NULL.
/// ndof         degrees of freedom of `cyclic`: length of numbers.
/// numbers      receives the new number of each, -1 where it has none; or NULL.
/// first        receives the number of the first mode, or NULL.
/// left_out     receives the largest relative error of a frequency of the tuned modes by the modes
///              of the blade that are left out, as estimated, with all contacts stuck and with all
///              of them free; infinity where one lies above the first of these; NaN, unknown, where
///              matrices of a speed act: compare natural frequencies of both sectors; or NULL.
/// out          receives the new sector; untouched on error. Free it by hbvib_model_free.
/// Errors: HBVIB_E_ARGUMENT (modes, families; dofs twice, fixed, on the right face, with a contact
/// or spring, or coupled to another sector), HBVIB_E_INDEX, HBVIB_E_DIMENSION (lengths),
/// HBVIB_E_SINGULAR (a blade that is not held), HBVIB_E_UNSUPPORTED (matrices of single diameters,
/// modal damping, aerodynamic forces, a stiffness without symmetry), those of hbvib_linear_modes;
/// HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: any number on one
/// model.
HBVIB_NODISCARD
hbvib_status hbvib_wheel_blade_modes(const hbvib_model *cyclic,
                                     int64_t n_dofs,
                                     const int64_t *dofs,
                                     int64_t modes,
                                     int64_t families,
                                     const hbvib_hooks *hooks,
                                     int64_t n_points,
                                     const int64_t *points,
                                     int64_t weights_len,
                                     double *weights,
                                     int64_t ndof,
                                     int64_t *numbers,
                                     int64_t *first,
                                     double *left_out,
                                     hbvib_model **out);

/// The sliders of a stored point of a forced response that stick through the period and change its
/// vibration: each may lie anywhere within the limit of its friction, and every such state is a
/// solution. None where no contact sticks all the time, or none of the others slips or opens.
///
/// model       the model of which the branch is a result, unchanged since.
/// point       number of a point of the curve, or of a peak, fold or requested solution.
/// capacity    numbers that fit into each array.
/// contact     receives the numbers of their contacts, numbers, or NULL.
/// direction   receives their directions, numbers, 0 for t1 and 1 for t2, or NULL.
/// place       receives their places in the solution, or NULL.
/// derivative  receives the derivatives of the amplitude by the places at a fixed frequency, while
///             the contacts stick; or NULL.
/// count       receives how many there are, also when `capacity` is too small.
/// hooks       phase, log and cancellation; progress is not called. NULL: none.
/// Without arrays only the count is returned.
/// Errors: HBVIB_E_INDEX (point), HBVIB_E_ARGUMENT (another model), HBVIB_E_UNSUPPORTED (a
/// nonlinear mode), HBVIB_E_DIMENSION (capacity too small: the arrays are untouched),
/// HBVIB_E_CALLBACK, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads:
/// any number on one model and branch.
HBVIB_NODISCARD
hbvib_status hbvib_branch_freedom(const hbvib_model *model,
                                  const hbvib_branch *branch,
                                  int64_t point,
                                  int64_t capacity,
                                  int64_t *contact,
                                  int64_t *direction,
                                  double *place,
                                  double *derivative,
                                  int64_t *count,
                                  const hbvib_hooks *hooks);

/// Results that a band bounds.
typedef enum {
  /// The amplitude at the frequency of the point.
  HBVIB_BAND_AMPLITUDE = 0,
  /// The amplitude of a peak, which moves with the places of the sliders.
  HBVIB_BAND_PEAK_AMPLITUDE = 1,
  /// The angular frequency of a peak.
  HBVIB_BAND_PEAK_OMEGA = 2,
} hbvib_band_of;

/// Options of hbvib_band. Fill it by hbvib_band_options_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// A value of enum hbvib_band_of; default HBVIB_BAND_AMPLITUDE.
  int32_t of;
  /// Contacts whose sliders are free, or NULL: all of hbvib_branch_freedom.
  const int64_t *contacts;
  /// Number of these contacts.
  int64_t contacts_len;
  /// Starts of the search with several free sliders, 1 .. 1000; default 3. With one it has no
  /// effect.
  int64_t starts;
} hbvib_band_options;

/// Fills the options of a band: the amplitude, all free sliders.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_band_options_init(hbvib_band_options *o, size_t size_of_o);

/// Numbers of a band. Fill it by hbvib_band_info_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// 1 if one slider was followed to both of its limits, or each search of several ended at an
  /// extremum; else 0. 0, too, where every contact is linear at the point and some stick: then
  /// states far from it were sampled.
  int32_t complete;
  /// Number of free sliders, those of the point and then those that stick at an end; 0: the
  /// response has no band, and both ends are the point itself.
  int64_t sliders;
  /// Number of states that were followed with one free slider at the point; else 0.
  int64_t states;
  /// Number of solutions that were computed.
  int64_t solved;
  /// The least result found.
  double lower;
  /// The largest result found.
  double upper;
  /// Angular frequency of the least result.
  double lower_omega;
  /// Angular frequency of the largest one.
  double upper_omega;
  /// Relative change of the least result that the linearised problem still foretells within a
  /// tenth of the distances over which the sliders can be dragged; 0 with one slider, NaN for a
  /// motion without a free slider.
  double lower_gain;
  /// The same of the largest one.
  double upper_gain;
  /// Contacts that are at the limit of their friction in the least result.
  int64_t lower_at_limit;
  /// The same in the largest one.
  int64_t upper_at_limit;
  /// Relative change of the least result by the last doubling of its harmonics, which bounds its
  /// error; NaN where it is unknown, as with fixed harmonics.
  double lower_error;
  /// The same of the largest one.
  double upper_error;
} hbvib_band_info;

/// Fills the numbers of a band with zeros.
///
/// i          the struct; untouched on error.
/// size_of_i  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_band_info_init(hbvib_band_info *i, size_t size_of_i);

/// The band of a stored point of a forced response: the least and the largest result over all
/// places of the sliders that stick through the period, and the states that attain them. With one
/// free slider all states that are joined to that of the point, from one limit of its friction to
/// the other, are followed, with every extremum between. With several, a search from each start
/// goes to an extremum; the bounds are attained ones, beyond which others may lie. Where every
/// contact is linear at the point, states with sliders at the corners of their limits are tried, at
/// which others may slip or open.
/// The harmonics are those of the point. Where a tolerance has chosen these, the ends and the
/// limits of one free slider are searched again with twice as many, until their results change by
/// less than the tolerance of `solver`.
///
/// model            the model of which the branch is a result, unchanged since.
/// point            number of a stored point; of a peak where the band is one of a peak.
/// solver           options; NULL: the defaults. `harmonics` has no effect; `tolerance` is that of
///                  the ends of a point whose harmonics a tolerance has chosen.
/// options          the result and what is free; NULL: the defaults.
/// hooks            log, phase and cancellation; NULL: none.
/// info             receives the numbers of the band.
/// capacity         numbers that fit into each array of sliders: at least twice as many as the
///                  model has contacts, unless all four are NULL.
/// contact          receives the contacts of the free sliders, numbers, or NULL.
/// direction        receives their directions, numbers, or NULL.
/// lower_place      receives their places in the least result, for hbvib_model_set_slider; or NULL.
/// upper_place      receives those in the largest result; or NULL.
/// states_capacity  states that fit into the next array.
/// states           receives place, result, its derivative by the place and angular frequency of
///                  each state of one free slider, four numbers a state, as many states as fit;
///                  or NULL.
/// lower            receives the least state, a branch of one point on the model with its places;
///                  a null handle where there is no band; or NULL. Free it by hbvib_branch_free.
/// upper            receives the largest one in the same way; or NULL.
/// Errors: HBVIB_E_INDEX (point, contacts), HBVIB_E_ARGUMENT (another model, options out of their
/// range, a point that is no peak, overlapping arrays), HBVIB_E_UNSUPPORTED (a nonlinear mode),
/// HBVIB_E_DIMENSION (capacity), HBVIB_E_NO_CONVERGENCE, HBVIB_E_CALLBACK, HBVIB_E_NULL,
/// HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY; nothing is written
/// then. HBVIB_STOPPED_BY_CALLER likewise. Threads: any number on one model and branch.
HBVIB_NODISCARD
hbvib_status hbvib_band(const hbvib_model *model,
                        const hbvib_branch *branch,
                        int64_t point,
                        const hbvib_solver_options *solver,
                        const hbvib_band_options *options,
                        const hbvib_hooks *hooks,
                        hbvib_band_info *info,
                        int64_t capacity,
                        int64_t *contact,
                        int64_t *direction,
                        double *lower_place,
                        double *upper_place,
                        int64_t states_capacity,
                        double *states,
                        hbvib_branch **lower,
                        hbvib_branch **upper);

/// The lower and the upper curve of a forced response: the band of the amplitude (hbvib_band) at
/// points of a branch, in their order.
///
/// model       the model of which the branch is a result, unchanged since.
/// points_len  number of points; 0: all points of the curve.
/// points      numbers of points of the curve, or of peaks, folds or requested solutions; NULL with
///             0.
/// solver      options; NULL: the defaults. Harmonics and tolerance have no effect.
/// options     the amplitude and what is free; NULL: the defaults.
/// hooks       log, phase and cancellation; NULL: none.
/// capacity    numbers that fit into each array: at least points_len, or all points of the curve.
/// omega       receives the angular frequencies, or NULL.
/// lower       receives the least amplitudes found, or NULL.
/// upper       receives the largest ones, or NULL.
/// sliders     receives numbers of free sliders, 0 where there is no band; or NULL.
/// complete    receives numbers, 1 where one slider was followed to both of its limits, or each
///             search ended at an extremum, else 0; or NULL.
/// count       receives how many points there are, also when `capacity` is too small.
/// Errors: those of hbvib_band, naming the point; HBVIB_E_DIMENSION (capacity too small: the arrays
/// are untouched). HBVIB_STOPPED_BY_CALLER: nothing is written. Threads: any number on one model
/// and branch.
HBVIB_NODISCARD
hbvib_status hbvib_band_curve(const hbvib_model *model,
                              const hbvib_branch *branch,
                              int64_t points_len,
                              const int64_t *points,
                              const hbvib_solver_options *solver,
                              const hbvib_band_options *options,
                              const hbvib_hooks *hooks,
                              int64_t capacity,
                              double *omega,
                              double *lower,
                              double *upper,
                              int64_t *sliders,
                              int64_t *complete,
                              int64_t *count);

/// Results of a nonlinear mode that a band bounds.
typedef enum {
  /// The damping ratio at the amplitude of the point.
  HBVIB_MODE_BAND_DAMPING = 0,
  /// The angular frequency there.
  HBVIB_MODE_BAND_OMEGA = 1,
} hbvib_mode_band_of;

/// The band of a stored point of a nonlinear mode: the least and the largest damping ratio or
/// frequency at its amplitude over all places of the sliders that stick through its period, and the
/// states that attain them. With one slider all of its places are scanned and each end is refined;
/// with several one after another is, until nothing is gained: the bounds are attained ones, beyond
/// which others may lie. A mode of the model with hbvib_model_set_slider of the places has them.
///
/// model            the model of which the branch is a result, unchanged since.
/// branch           a nonlinear mode.
/// point            number of a stored point.
/// solver           options; NULL: the defaults. Harmonics and tolerance have no effect.
/// mode             options of the mode, whose amplitudes have no effect; NULL: the defaults.
/// of               a value of enum hbvib_mode_band_of.
/// contacts_len     number of contacts whose sliders are free; 0: all that stick.
/// contacts         their numbers, or NULL with 0.
/// hooks            log, phase and cancellation; NULL: none.
/// info             receives the numbers of the band.
/// capacity         numbers that fit into contact and direction, at least twice as many as the
///                  model has
///                  contacts, unless these and the states are NULL.
/// contact          receives the contacts of the free sliders, numbers, or NULL.
/// direction        receives their directions, numbers, or NULL.
/// ends             receives for the least result, then the largest, the places of the sliders,
///                  angular
///                  frequency and damping ratio, 2 * (capacity + 2) doubles, each place at the
///                  number of
///                  its slider, the results behind `capacity` places; or NULL.
/// states_capacity  states that fit into the next array.
/// states           receives place, angular frequency and damping ratio of each state of one
///                  slider that
///                  was scanned, three numbers a state, as many as fit; or NULL.
/// Errors: HBVIB_E_INDEX (point, contacts), HBVIB_E_ARGUMENT (another model, of),
/// HBVIB_E_UNSUPPORTED (a forced response), HBVIB_E_DIMENSION (capacity), those of
/// hbvib_nonlinear_mode; nothing is written then. HBVIB_STOPPED_BY_CALLER likewise. Threads: any
/// number on one model and branch.
HBVIB_NODISCARD
hbvib_status hbvib_mode_band(const hbvib_model *model,
                             const hbvib_branch *branch,
                             int64_t point,
                             const hbvib_solver_options *solver,
                             const hbvib_mode_options *mode,
                             int32_t of,
                             int64_t contacts_len,
                             const int64_t *contacts,
                             const hbvib_hooks *hooks,
                             hbvib_band_info *info,
                             int64_t capacity,
                             int64_t *contact,
                             int64_t *direction,
                             double *ends,
                             int64_t states_capacity,
                             double *states);

/// Static states of a model along a load history, with friction: constant forces and speeds that
/// rise and fall, between straight steps. Sliders begin at the places of hbvib_model_set_slider and
/// are dragged along; the places of a step are the residual state that the history has left there,
/// for hbvib_model_set_slider. The first load is reached at once. Vibrating forces have no effect.
///
/// solver     options; NULL: the defaults.
/// steps      number of loads, >= 1.
/// factors    factors of the constant forces, one for each step, or NULL: 1.
/// speeds     fixed speeds of rotation, one for each step, or NULL: that of the model.
/// hooks      phase, log and cancellation; progress is not called. NULL: none.
/// motion     receives the displacements, steps x ndof, step after step; or NULL.
/// motion_len numbers in it: steps x ndof.
/// places     receives the places of the sliders along t1 and t2, steps x contacts x 2; or NULL.
/// places_len numbers in it: steps x contacts x 2.
/// forces     receives the forces of the contacts along t1, t2 and n, steps x contacts x 3, in the
///            sense in which they act against the relative motion, so that the one along n is minus
///            the normal load; or NULL.
/// forces_len numbers in it: steps x contacts x 3.
/// Errors: HBVIB_E_DIMENSION (steps, lengths), HBVIB_E_NOT_FINITE, HBVIB_E_UNSUPPORTED (a speed
/// that is tied to the frequency, and loads that follow it), HBVIB_E_NO_CONVERGENCE or
/// HBVIB_E_SINGULAR where there is no equilibrium, HBVIB_E_ARGUMENT (overlapping arrays),
/// HBVIB_E_CALLBACK,
/// HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY; the
/// arrays are untouched then. HBVIB_STOPPED_BY_CALLER likewise. Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_static_history(const hbvib_model *model,
                                  const hbvib_solver_options *solver,
                                  int64_t steps,
                                  const double *factors,
                                  const double *speeds,
                                  const hbvib_hooks *hooks,
                                  double *motion,
                                  int64_t motion_len,
                                  double *places,
                                  int64_t places_len,
                                  double *forces,
                                  int64_t forces_len);

/// Vibration that wears contacts.
typedef enum {
  /// Steady states of given frequencies, forces and shares of the time.
  HBVIB_LIFE_DUTIES = 0,
  /// The peak of the response, as it moves.
  HBVIB_LIFE_PEAK = 1,
} hbvib_life_follow;

/// Events of a life.
typedef enum {
  /// A contact begins to slip.
  HBVIB_LIFE_SLIPS = 0,
  /// A contact ends to slip.
  HBVIB_LIFE_STICKS = 1,
  /// A contact loses its load.
  HBVIB_LIFE_LOST = 2,
  /// A contact gets load again.
  HBVIB_LIFE_PRESSED = 3,
  /// The amplitude passes the limit.
  HBVIB_LIFE_LIMIT = 4,
  /// The motion that was followed ends, as at a fold, or its peak does: the amplitude jumps.
  HBVIB_LIFE_JUMPS = 5,
} hbvib_life_event;

/// Options of hbvib_life. Fill it by hbvib_life_options_init, then set contacts and vibration.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// A value of enum hbvib_life_follow; default HBVIB_LIFE_DUTIES.
  int32_t follow;
  /// Contacts that wear, contacts_len numbers; their laws have a normal load.
  const int64_t *contacts;
  /// Worn volume per work of friction of each of them, >= 0.
  const double *rates;
  /// Area of each of them, > 0, or NULL: 1.
  const double *areas;
  /// Number of contacts that wear, 1 .. 2000.
  int64_t contacts_len;
  /// Static stiffness between their normals, force per depth, contacts_len x contacts_len,
  /// symmetric; NULL: the normal stiffness of each contact by itself, which its law then has.
  const double *stiffness;
  /// Depths that are worn at the beginning, contacts_len numbers >= 0; NULL: none.
  const double *worn;
  /// Angular frequencies of the duties, > 0, duties_len numbers; NULL with HBVIB_LIFE_PEAK.
  const double *duty_omega;
  /// Factors on the forces in each duty, >= 0; NULL: 1.
  const double *duty_force;
  /// Shares of the time of each duty, >= 0, relative to their sum; NULL: equal ones.
  const double *duty_share;
  /// Number of duties.
  int64_t duties_len;
  /// First angular frequency of the range of HBVIB_LIFE_PEAK, > 0.
  double omega_start;
  /// Last one.
  double omega_stop;
  /// Error allowed of the loads, relative to the largest one at the beginning, and of the
  /// amplitude: 1e-12 .. 0.1; default 1e-4.
  double tolerance;
  /// Amplitude whose crossing is an event; default 0: none.
  double limit;
  /// Largest number of steps, >= 1; default 10000.
  int64_t most_steps;
} hbvib_life_options;

/// Fills the options of a life: no contact, no duty, a tolerance of 1e-4.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_life_options_init(hbvib_life_options *o, size_t size_of_o);

/// Numbers of a life. Fill it by hbvib_life_info_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// 0.
  int32_t reserved;
  /// Steps that were taken.
  int64_t steps;
  /// Steady vibrations that were solved.
  int64_t solutions;
  /// Wanted cycles that were reached.
  int64_t points;
  /// Cycles that were reached.
  double reached;
  /// Largest amplitude over the life.
  double largest;
  /// Cycles at which it occurs.
  double largest_at;
  /// Amplitude at the beginning.
  double amplitude_new;
  /// Amplitude at the cycles that were reached.
  double amplitude_worn;
} hbvib_life_info;

/// Fills the numbers of a life with zeros.
///
/// i          the struct; untouched on error.
/// size_of_i  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_life_info_init(hbvib_life_info *i, size_t size_of_i);

/// Follows the wear of contacts over the cycles of a life. The depth that a contact has worn grows
/// per cycle by its rate times the work of friction of a cycle over its area, and the loads are
/// those of the model less stiffness times depths. Rates are those of the steady vibration under
/// the loads of the time. Steps keep the tolerance, and end where a contact begins or ends to slip
/// or loses its load. Where the motion ends, as at a fold, the life tells that and goes on with the
/// one that is found there.
///
/// model           stays as it is: it has the loads without wear.
/// solver          options, tolerance 0 or not; NULL: the defaults.
/// options         contacts, vibration, tolerance.
/// hooks           progress, called at each step with its cycles in `parameter`; phase and
///                 cancellation. NULL: none.
/// n               number of wanted cycles, >= 1.
/// cycles          wanted cycles, >= 0, in ascending order; the last is the end of the life.
/// depths          receives the worn depths, n x contacts_len, or NULL.
/// loads           receives the loads, n x contacts_len, or NULL.
/// works           receives the works of a cycle, n x contacts_len, or NULL.
/// amplitude       receives the amplitudes, n numbers, or NULL; the largest of several duties.
/// omega           receives their angular frequencies, n numbers, or NULL.
/// capacity        events that fit into each of the next arrays.
/// event_cycles    receives the cycles of the first events, or NULL.
/// event_kind      receives numbers of enum hbvib_life_event, or NULL.
/// event_contact   receives numbers of contacts, -1 for the amplitude; or NULL.
/// events          receives the number of events; or NULL.
/// info            receives the numbers of the life; fill it by hbvib_life_info_init before; or
///                 NULL.
/// A life that ends early has a positive status: HBVIB_STOPPED_STEP_TOO_SMALL where no vibration is
/// found beyond, HBVIB_STOPPED_MAX_POINTS, HBVIB_STOPPED_BY_CALLER; states beyond are NaN.
/// Errors: HBVIB_E_INDEX (contacts), HBVIB_E_ARGUMENT, HBVIB_E_DIMENSION, HBVIB_E_NOT_FINITE
/// (options, cycles, overlapping arrays), HBVIB_E_UNSUPPORTED (a contact without load, a load that
/// follows a speed tied to the frequency, a law of the caller), those of hbvib_forced_response for
/// the first vibration, HBVIB_STOPPED_NO_PEAK where that has no peak. Threads: any number on one
/// model.
HBVIB_NODISCARD
hbvib_status hbvib_life(const hbvib_model *model,
                        const hbvib_solver_options *solver,
                        const hbvib_life_options *options,
                        const hbvib_hooks *hooks,
                        int64_t n,
                        const double *cycles,
                        double *depths,
                        double *loads,
                        double *works,
                        double *amplitude,
                        double *omega,
                        int64_t capacity,
                        double *event_cycles,
                        int64_t *event_kind,
                        int64_t *event_contact,
                        int64_t *events,
                        hbvib_life_info *info);

/// Loads with which the largest amplitude over a life is least. Fill it by hbvib_best_load_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// 0.
  int32_t reserved;
  /// Factor on the loads of the contacts that wear.
  double factor;
  /// Largest amplitude over the life with it.
  double amplitude;
  /// Amplitude of the new machine.
  double amplitude_new;
  /// Amplitude at the end of the life.
  double amplitude_worn;
  /// Lives that were followed.
  int64_t lives;
} hbvib_best_load;

/// Fills the best loads with zeros.
///
/// b          the struct; untouched on error.
/// size_of_b  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_best_load_init(hbvib_best_load *b, size_t size_of_b);

/// Searches for the factor on the loads of the contacts that wear, as the model has them, with
/// which the largest amplitude over the life is least: as a rule that with which the new and the
/// worn machine vibrate alike. It is the lowest of the minima that nine lives over the range of
/// factors show.
///
/// model        the model with the loads of which factors are sought.
/// solver       options; NULL: the defaults.
/// options      contacts, vibration, tolerance: as of hbvib_life.
/// cycles       end of the life, > 0.
/// factor_low   least factor, > 0.
/// factor_high  largest factor.
/// hooks        progress, called after each life with its factor in `parameter`; cancellation.
///              NULL: none.
/// out          receives the factor; fill it by hbvib_best_load_init before.
/// Errors: as of hbvib_life; HBVIB_E_ARGUMENT (factors, cycles); HBVIB_E_NO_CONVERGENCE (a life
/// without a peak at its start, or one that ends early: the sentence tells the factor and why);
/// HBVIB_STOPPED_BY_CALLER. Nothing is written then. Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_best_load_for_life(const hbvib_model *model,
                                      const hbvib_solver_options *solver,
                                      const hbvib_life_options *options,
                                      double cycles,
                                      double factor_low,
                                      double factor_high,
                                      const hbvib_hooks *hooks,
                                      hbvib_best_load *out);

/// Kinds of data.
typedef enum {
  /// Complex amplitude of a response at angular frequencies.
  HBVIB_DATA_RESPONSE = 0,
  /// Measure of a response at angular frequencies.
  HBVIB_DATA_AMPLITUDE = 1,
  /// Measure of a response at the peak nearest to an angular frequency, and where it is.
  HBVIB_DATA_PEAK = 2,
  /// Angular frequency and damping ratio of a nonlinear mode at log10 of its modal amplitude.
  HBVIB_DATA_BACKBONE = 3,
  /// Angular frequency and damping ratio of the mode in which all contacts stick.
  HBVIB_DATA_LINEAR_MODE = 4,
} hbvib_data_kind;

/// Data of one kind at one level of the force. Fill it by hbvib_data_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// A value of enum hbvib_data_kind.
  int32_t kind;
  /// Factor on all forces of the model; default 1.
  double force_factor;
  /// The response of the first three kinds; NULL: the fundamental of the response degree of
  /// freedom.
  const hbvib_response *response;
  /// Number of the linear mode with stuck contacts, from 0, of the other kinds.
  int64_t mode;
  /// First angular frequency that is followed; 0 with omega_stop 0: as far as the data need.
  double omega_start;
  /// Last one.
  double omega_stop;
  /// Number of data points.
  int64_t n;
  /// Angular frequencies, or log10 of modal amplitudes, n numbers. A linear mode does not use them.
  const double *x;
  /// Complex amplitudes, re and im, 2 n doubles; of other kinds re is the measure, or the angular
  /// frequency of a mode, and im the angular frequency of a peak, or the damping ratio. NULL in
  /// hbvib_predict.
  const double *value;
  /// Standard deviations, n numbers: of |X|, which is sqrt(2) times that of each part; of the
  /// measure or the angular frequency of a mode. NULL in hbvib_predict.
  const double *sigma;
  /// Standard deviations of angular frequencies of peaks, or of damping ratios, n numbers; NULL:
  /// these are not data.
  const double *second_sigma;
} hbvib_data;

/// Fills a data set: complex amplitudes at the forces of the model, without points.
///
/// d          the struct; untouched on error.
/// size_of_d  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_data_init(hbvib_data *d, size_t size_of_d);

/// Scale in which an unknown of a fit is changed.
typedef enum {
  /// Logarithm for stiffnesses, friction, loads and factors that start above 0, else the value.
  HBVIB_SCALE_AUTOMATIC = 0,
  /// The value itself.
  HBVIB_SCALE_LINEAR = 1,
  /// Its logarithm: it stays above 0.
  HBVIB_SCALE_LOG = 2,
} hbvib_scale;

/// Units that data of a fit may have.
typedef enum {
  /// Nothing is suspected.
  HBVIB_SUSPICION_NONE = 0,
  /// The responses of the data are a power of ten times those of the model.
  HBVIB_SUSPICION_RESPONSE = 1,
  /// The angular frequencies of the data are too small, or too large, by 2 pi.
  HBVIB_SUSPICION_FREQUENCY = 2,
} hbvib_suspicion;

/// A parameter as an unknown of a fit. Fill it by hbvib_unknown_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// A value of enum hbvib_scale.
  int32_t scale;
  /// First value, if has_start is 1; otherwise that of the model.
  double start;
  /// Smallest value, if has_lower is 1; equal to the largest one the parameter is fixed.
  double lower;
  /// Largest value, if has_upper is 1.
  double upper;
  /// Mean of what is known of it beside the data.
  double prior_mean;
  /// Its standard deviation; 0: nothing is known.
  double prior_sigma;
  /// Number of an earlier parameter whose value it follows, in the ratio of their starts; -1: none.
  int64_t tied_to;
  /// 1: start is given; 0: it is not.
  int32_t has_start;
  /// 1: lower is given; 0: it is not.
  int32_t has_lower;
  /// 1: upper is given; 0: it is not.
  int32_t has_upper;
  /// Must be 0.
  int32_t reserved;
  /// Number of the data set that alone has it, as each test its residual state; -1: all have it.
  int64_t data_set;
} hbvib_unknown;

/// Fills an unknown that starts at the value of the model, without bounds and prior.
///
/// u          the struct; untouched on error.
/// size_of_u  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_unknown_init(hbvib_unknown *u, size_t size_of_u);

/// Options of a fit. Fill it by hbvib_fit_options_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// 1: the covariance is multiplied by chi2 over the degrees of freedom, where standard deviations
  /// are known up to a factor; 0 (default): it is not.
  int32_t scale_covariance;
  /// Standard deviations beyond which a residual counts by its magnitude instead of its square
  /// (Huber), 1.345 for example; 0 (default): all count by their squares.
  double huber;
  /// Points from which the search begins, 1 .. 1000; default 1: the given one, and others where
  /// that fits poorly.
  int64_t starts;
  /// Largest number of iterations from each, 1 .. 10000; default 60.
  int64_t max_iterations;
  /// Step in standard deviations at which the search ends; default 1e-6. With 200 numbers of
  /// data and more, as 100 complex points have, it ends at an estimated error of 1e-5, unless
  /// this is smaller than the default.
  double step;
} hbvib_fit_options;

/// Fills the options of a fit with their defaults.
///
/// o          the struct; untouched on error.
/// size_of_o  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_fit_options_init(hbvib_fit_options *o, size_t size_of_o);

/// Numbers of a fit. Fill it by hbvib_fit_info_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// A value of enum hbvib_suspicion.
  int32_t suspicion;
  /// Sum of the squares of the residuals of data and priors, in standard deviations.
  double chi2;
  /// The loss that was minimised: chi2 unless it is robust.
  double loss;
  /// Number of data and priors minus the number of free unknowns.
  int64_t degrees_of_freedom;
  /// Number of data, two for a complex amplitude.
  int64_t data;
  /// Number of free unknowns.
  int64_t free;
  /// Iterations from the start that led to the result.
  int64_t iterations;
  /// Starts from which was searched.
  int64_t starts;
  /// Number of parameters at a bound, whose variance is 0.
  int64_t at_bound;
  /// Number of contacts that slip at any point of the data.
  int64_t slipping;
  /// Criterion of Akaike, chi2 + 2 free.
  double aic;
  /// Criterion of Schwarz, chi2 + free ln data.
  double bic;
  /// Largest over smallest eigenvalue of the matrix of the fit with unit diagonal.
  double condition;
  /// Largest estimated error by harmonics over the standard deviation of its datum; NaN where none
  /// was estimated.
  double harmonic_error;
  /// Responses of the data over those of the model, or the factor that the angular frequencies of
  /// the data need; 1 where nothing is suspected.
  double suspected_factor;
} hbvib_fit_info;

/// Fills the numbers of a fit with zeros, and the factor with 1.
///
/// i          the struct; untouched on error.
/// size_of_i  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_fit_info_init(hbvib_fit_info *i, size_t size_of_i);

/// Fits parameters of a model to data of tests: the values of least loss, and their covariance.
/// The derivatives of the data by the parameters are exact. Where a set of data is followed
/// through folds, the solution nearest to each datum counts. With a tolerance of the solver it
/// is lowered where errors by harmonics would exceed a third of the standard deviations.
///
/// model          stays as it is.
/// solver         options; NULL: the defaults.
/// options        loss, starts; NULL: the defaults.
/// hooks          progress, called at each iteration with its number in `point`, the loss in
///                `parameter` and the first parameter in `amplitude`; log, phase and
///                cancellation. NULL: none.
/// parameters     array of parameters, struct_size of the first apart. Constants and the speed
///                are values, factors multiply those of the model.
/// count          how many, >= 1.
/// unknowns       array of as many unknowns, struct_size of the first apart; or NULL: the
///                defaults.
/// data           array of data sets, struct_size of the first apart.
/// data_len       how many, >= 1.
/// info           receives the numbers of the fit; fill it by hbvib_fit_info_init before.
/// theta          receives the values of the parameters, count numbers.
/// covariance     receives their covariance, count x count numbers; or NULL.
/// residuals_len  numbers in the next two arrays: twice the number of data points of all sets;
///                0 where both are NULL.
/// residuals      receives the residuals in standard deviations, two for each point, set after
///                set, 0 for a number that is no datum; or NULL.
/// values         receives the numbers of the model, likewise; or NULL.
/// out            receives the model with the values that all data sets have; or NULL. Free it by
///                hbvib_model_free.
/// HBVIB_STOPPED_MAX_POINTS: the iterations did not suffice; HBVIB_STOPPED_STALLED: no step
/// lowers the loss any more; HBVIB_STOPPED_BY_CALLER: by progress, with the best values so far;
/// by other hooks nothing is written. Many data are searched by a share of them first: a fit that
/// is stopped there has the numbers of that share, and residuals and values NaN elsewhere.
/// Errors: HBVIB_E_SINGULAR (the data do not tell the unknowns; the sentence says which and why),
/// HBVIB_E_NO_CONVERGENCE (no solution for all data at the start), HBVIB_E_ARGUMENT,
/// HBVIB_E_NOT_FINITE, HBVIB_E_DIMENSION, HBVIB_E_INDEX, HBVIB_E_UNSUPPORTED (options,
/// unknowns, data, parameters), HBVIB_E_CALLBACK, HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE,
/// HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY. Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_fit(const hbvib_model *model,
                       const hbvib_solver_options *solver,
                       const hbvib_fit_options *options,
                       const hbvib_hooks *hooks,
                       const hbvib_parameter *parameters,
                       int64_t count,
                       const hbvib_unknown *unknowns,
                       const hbvib_data *data,
                       int64_t data_len,
                       hbvib_fit_info *info,
                       double *theta,
                       double *covariance,
                       int64_t residuals_len,
                       double *residuals,
                       double *values,
                       hbvib_model **out);

/// Predicts numbers of a fitted model with their standard deviations, by the exact derivatives
/// and the covariance of the parameters (delta method).
///
/// model       the model that was fitted, not the fitted one: factors multiply its matrices.
/// solver      options; NULL: the defaults.
/// wanted      a data set without values and sigmas: the kind, x, response, force and range.
/// hooks       log, phase and cancellation; NULL: none.
/// parameters  array of parameters, struct_size of the first apart.
/// count       how many, >= 1.
/// theta       their values, count numbers.
/// covariance  their covariance, count x count numbers.
/// capacity    numbers in the next arrays: twice the number of x.
/// values      receives two numbers for each x, as the value of a data set has them.
/// sigma       receives their standard deviations; or NULL.
/// shift       receives the shift of their means by the second order: where it is not small
///             against sigma, the delta method is not enough; NaN where one standard deviation
///             aside there is no solution; or NULL.
/// Errors: HBVIB_E_NO_CONVERGENCE (no solution at each x), HBVIB_E_DIMENSION, HBVIB_E_ARGUMENT,
/// HBVIB_E_NOT_FINITE, HBVIB_E_INDEX, HBVIB_E_UNSUPPORTED, HBVIB_E_CALLBACK, HBVIB_E_NULL,
/// HBVIB_E_STRUCT_SIZE, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY; nothing is written
/// then. HBVIB_STOPPED_BY_CALLER likewise. Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_predict(const hbvib_model *model,
                           const hbvib_solver_options *solver,
                           const hbvib_data *wanted,
                           const hbvib_hooks *hooks,
                           const hbvib_parameter *parameters,
                           int64_t count,
                           const double *theta,
                           const double *covariance,
                           int64_t capacity,
                           double *values,
                           double *sigma,
                           double *shift);

/// Numbers of a profile. Fill it by hbvib_fit_profile_info_init.
typedef struct {
  /// Bytes of this struct as the caller knows it.
  uint32_t struct_size;
  /// Must be 0.
  int32_t reserved;
  /// Loss of the fit; chi2 unless it is robust.
  double best;
  /// Rise of the loss that is one standard deviation: 1, or chi2 over the degrees of freedom with
  /// scale_covariance.
  double unit;
  /// Lower end of the interval; -infinity where the values do not reach it.
  double lower;
  /// Upper end; infinity where the values do not reach it.
  double upper;
  /// Number of values at which a fit was found.
  int64_t found;
} hbvib_fit_profile_info;

/// Fills the numbers of a profile with zeros, and the unit with 1.
///
/// i          the struct; untouched on error.
/// size_of_i  sizeof of it.
/// Errors: HBVIB_E_NULL, HBVIB_E_STRUCT_SIZE. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_fit_profile_info_init(hbvib_fit_profile_info *i, size_t size_of_i);

/// Least loss of a fit over the values of one parameter, all others fitted again, and the interval
/// that it gives: it holds where the data depend on the parameters so strongly curved that the
/// covariance does not.
///
/// model       the model that was fitted, not the fitted one.
/// solver      options of the fit; NULL: the defaults.
/// options     options of the fit; NULL: the defaults.
/// hooks       as those of a fit, for each value anew; NULL: none. A loss below that of the fit is
///             told by a warning of the log.
/// parameters  array of the parameters of the fit, struct_size of the first apart.
/// count       how many, >= 1.
/// unknowns    array of as many unknowns of the fit, struct_size of the first apart; starts are not
///             used. NULL: the defaults.
/// data        array of the data sets of the fit, struct_size of the first apart.
/// data_len    how many, >= 1.
/// theta       the fitted values, count numbers.
/// number      number of the scanned parameter; those that are tied to it go with it.
/// values_len  how many values, >= 1.
/// values      values of the parameter in ascending order.
/// rise        rise of the loss at the ends of the interval, in units of one standard deviation:
///             3.841 for 95 %, 1 for one deviation; > 0. Between two values the root of the loss
///             is taken for a line.
/// info        receives loss, unit and interval; fill it by hbvib_fit_profile_info_init before.
/// loss        receives the least loss at each value, priors included, values_len numbers; NaN
///             where no fit was found; or NULL.
/// profiled    receives the values of all parameters at each, values_len x count numbers, row after
///             row; NaN where no fit was found; or NULL.
/// HBVIB_STOPPED_BY_CALLER: by progress, with the values so far; by other hooks nothing is written.
/// Errors: HBVIB_E_NO_CONVERGENCE (no solution for all data at theta), and those of hbvib_fit.
/// Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_fit_profile(const hbvib_model *model,
                               const hbvib_solver_options *solver,
                               const hbvib_fit_options *options,
                               const hbvib_hooks *hooks,
                               const hbvib_parameter *parameters,
                               int64_t count,
                               const hbvib_unknown *unknowns,
                               const hbvib_data *data,
                               int64_t data_len,
                               const double *theta,
                               int64_t number,
                               int64_t values_len,
                               const double *values,
                               double rise,
                               hbvib_fit_profile_info *info,
                               double *loss,
                               double *profiled);

/* ==============================================================================================
 * Low level: one contact law, the residual at a given motion, indices from 1
 * ============================================================================================== */

/// Force of one contact law on prescribed relative motions y(t) = Re sum Y_h exp(i h omega t),
/// once it has become periodic, and its Jacobian. Degrees of freedom, sector_offset and directions
/// in the description are ignored. The law has d motions, side a minus side b: t1 and n of
/// HBVIB_FRICTION_2D, d = 2; t1, t2 and n of HBVIB_FRICTION_3D, d = 3, but t1 and t2 under a
/// constant load (kn = 0), d = 2; n of HBVIB_UNILATERAL and t1 of the others, d = 1. The force
/// along n is -N.
///
/// c           the law and its constants.
/// harmonics   highest harmonic number H, 0 .. 100000.
/// samples     0: events are located exactly where the law has them; else samples per period, at
///             least 2H + 1. HBVIB_CUBIC, HBVIB_FRICTION_2D and HBVIB_FRICTION_3D are exact in both
///             cases; HBVIB_REGULARISED is always sampled, with 0 by a number that follows from H.
/// omega       angular frequency, >= 0; has an effect on laws that depend on velocities.
/// motion      d (H + 1) complex numbers, Y_0 .. Y_H of one motion after the other; the imaginary
///             part of Y_0 has no effect.
/// motion_len  complex numbers in it, d (H + 1).
/// force       receives d (H + 1) complex numbers, F_0 .. F_H of one direction after the other.
/// force_len   complex numbers in it, d (H + 1).
/// jac         receives d F / d Y over the pairs (re, im), real, column-major of order 2 d (H + 1);
///             or NULL.
/// jac_len     doubles in it, (2 d (H + 1))^2; 0 with NULL.
/// Memory with jac: at most 8 (1 + d) (2 d (H + 1))^2 bytes, 250 bytes for each of the samples or
/// of 128 (H + 1), whichever are more, and 1 MiB, with d > 1 another 2 MiB (H + 1) or
/// 256 MiB + 64 KiB (H + 1), whichever are fewer. Without jac no Jacobian is formed:
/// 2.5 KiB d (H + 1), 250 bytes for each of the samples, of which HBVIB_REGULARISED takes
/// 128 (H + 1) by itself, and 1 MiB, for HBVIB_FRICTION_3D another term as above. Where the latter
/// is more than 500 MiB, or the former more than 16 GiB, nothing is requested, and the error is
/// HBVIB_E_OUT_OF_MEMORY.
/// Errors: HBVIB_E_ARGUMENT (kind, constants, harmonics, samples, omega, overlapping arrays),
/// HBVIB_E_DIMENSION (lengths), HBVIB_E_NOT_FINITE, HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL,
/// HBVIB_E_OUT_OF_MEMORY. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_contact_evaluate(const hbvib_contact *c,
                                    int64_t harmonics,
                                    int64_t samples,
                                    double omega,
                                    const double *motion,
                                    int64_t motion_len,
                                    double *force,
                                    int64_t force_len,
                                    double *jac,
                                    int64_t jac_len);

/// The same as hbvib_contact_evaluate; a hook or the cancel flag may stop it. The status
/// is then HBVIB_STOPPED_BY_CALLER, and what it writes is untouched.
///
/// c           the law and its constants.
/// harmonics   highest harmonic number H, 0 .. 100000.
/// samples     0: events are located exactly where the law has them; else samples per period, at
///             least 2H + 1. HBVIB_CUBIC, HBVIB_FRICTION_2D and HBVIB_FRICTION_3D are exact in both
///             cases; HBVIB_REGULARISED is always sampled, with 0 by a number that follows from H.
/// omega       angular frequency, >= 0; has an effect on laws that depend on velocities.
/// motion      d (H + 1) complex numbers, Y_0 .. Y_H of one motion after the other; the imaginary
///             part of Y_0 has no effect.
/// motion_len  complex numbers in it, d (H + 1).
/// force       receives d (H + 1) complex numbers, F_0 .. F_H of one direction after the other.
/// force_len   complex numbers in it, d (H + 1).
/// jac         receives d F / d Y over the pairs (re, im), real, column-major of order 2 d (H + 1);
///             or NULL.
/// jac_len     doubles in it, (2 d (H + 1))^2; 0 with NULL.
/// hooks       phase, log and cancellation; progress is not called. NULL: none.
/// Errors and threads: as for hbvib_contact_evaluate.
HBVIB_NODISCARD
hbvib_status hbvib_contact_evaluate_with_hooks(const hbvib_contact *c,
                                               int64_t harmonics,
                                               int64_t samples,
                                               double omega,
                                               const double *motion,
                                               int64_t motion_len,
                                               double *force,
                                               int64_t force_len,
                                               double *jac,
                                               int64_t jac_len,
                                               const hbvib_hooks *hooks);

/// Residual R_h = (K - h^2 omega^2 M + i h omega C) X_h + f_h - F_h of harmonic balance at a motion
/// of the caller, for continuation methods of the caller and for tests. Nothing is removed:
/// harmonics 0 .. H of all degrees of freedom, harmonic after harmonic.
///
/// solver       options, of which harmonics, samples and memory_limit are used; NULL: the defaults.
/// omega        angular frequency, >= 0.
/// x            (H + 1) x ndof complex numbers; the imaginary part of the mean is no unknown.
/// x_len        complex numbers in it.
/// r            receives as many complex numbers; the imaginary part of the rows of the mean is
///              that of x.
/// r_len        complex numbers in it.
/// jac          receives d R / d X over the pairs (re, im), real, column-major of order
///              2 (H + 1) ndof; or NULL.
/// jac_len      doubles in it; 0 with NULL.
/// d_omega      receives d R / d omega, complex like r; or NULL.
/// d_omega_len  complex numbers in it; 0 with NULL.
/// Memory: that of hbvib_contact_evaluate for each contact, and 96 (H + 1) bytes for each entry of
/// the matrices; a memory_limit below that is refused with HBVIB_E_OUT_OF_MEMORY.
/// Errors: HBVIB_E_DIMENSION (a length, with the one needed), HBVIB_E_NOT_FINITE,
/// HBVIB_E_ARGUMENT (options, omega, overlapping arrays, a force beyond the harmonics),
/// HBVIB_E_STRUCT_SIZE, HBVIB_E_NULL, HBVIB_E_HANDLE, HBVIB_E_BUSY, HBVIB_E_OUT_OF_MEMORY.
/// Threads: any number on one model.
HBVIB_NODISCARD
hbvib_status hbvib_forced_residual(const hbvib_model *model,
                                   const hbvib_solver_options *solver,
                                   double omega,
                                   const double *x,
                                   int64_t x_len,
                                   double *r,
                                   int64_t r_len,
                                   double *jac,
                                   int64_t jac_len,
                                   double *d_omega,
                                   int64_t d_omega_len);

/// The same as hbvib_forced_residual; a hook or the cancel flag may stop it. The status
/// is then HBVIB_STOPPED_BY_CALLER, and the arrays are untouched or hold NaN.
///
/// solver       options, of which harmonics, samples and memory_limit are used; NULL: the defaults.
/// omega        angular frequency, >= 0.
/// x            (H + 1) x ndof complex numbers; the imaginary part of the mean is no unknown.
/// x_len        complex numbers in it.
/// r            receives as many complex numbers; the imaginary part of the rows of the mean is
///              that of x.
/// r_len        complex numbers in it.
/// jac          receives d R / d X over the pairs (re, im), real, column-major of order
///              2 (H + 1) ndof; or NULL.
/// jac_len      doubles in it; 0 with NULL.
/// d_omega      receives d R / d omega, complex like r; or NULL.
/// d_omega_len  complex numbers in it; 0 with NULL.
/// hooks        phase, log and cancellation; progress is not called. NULL: none.
/// Errors and threads: as for hbvib_forced_residual.
HBVIB_NODISCARD
hbvib_status hbvib_forced_residual_with_hooks(const hbvib_model *model,
                                              const hbvib_solver_options *solver,
                                              double omega,
                                              const double *x,
                                              int64_t x_len,
                                              double *r,
                                              int64_t r_len,
                                              double *jac,
                                              int64_t jac_len,
                                              double *d_omega,
                                              int64_t d_omega_len,
                                              const hbvib_hooks *hooks);

/// Turns an index of a language that counts from 1 into one that counts from 0, and refuses an
/// index outside with a sentence in numbers from 1: "dof = 0, needs 1 .. 4".
///
/// name       name of the index, ends with NUL; of more than 40 bytes the first 40 are used.
///            NULL: "index".
/// index      1 .. count.
/// count      number of valid indices, >= 0.
/// from_zero  receives index - 1; untouched on error.
/// Errors: HBVIB_E_INDEX, HBVIB_E_DIMENSION (count), HBVIB_E_NULL. Threads: any.
HBVIB_NODISCARD
hbvib_status hbvib_index_from_one(const char *name,
                                  int64_t index,
                                  int64_t count,
                                  int64_t *from_zero);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* HBVIB_H */
