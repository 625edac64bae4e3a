//! Constants and structs of the header.

#![allow(non_camel_case_types)]

use crate::error::Status;
use core::ffi::{c_char, c_void};

/// Outcome of a call: a value of enum hbvib_status_code.
pub type hbvib_status = i32;

/// A flag that another thread or a signal handler may set while a call runs (in C volatile).
pub type hbvib_cancel_flag = i32;

/// Values of hbvib_status. Zero: done. Negative: an error, nothing was written. Positive: stopped
/// early, the partial result was written.
#[repr(C)]
pub enum hbvib_status_code {
    /// Done.
    HBVIB_OK = 0,
    /// The progress hook or the cancel flag asked to stop.
    HBVIB_STOPPED_BY_CALLER = 1,
    /// The step fell below step_min.
    HBVIB_STOPPED_STEP_TOO_SMALL = 2,
    /// max_points was reached.
    HBVIB_STOPPED_MAX_POINTS = 3,
    /// Points need more harmonics for the tolerance than max_harmonics or than can be afforded, or their error is
    /// unknown: HBVIB_ERROR_ESTIMATE tells which. The whole range was covered; all points are there.
    HBVIB_STOPPED_MAX_HARMONICS = 4,
    /// Round-off stopped the residual above tol_residual.
    HBVIB_STOPPED_STALLED = 5,
    /// The branch turned back, left the range where it began and did not come back.
    HBVIB_STOPPED_LEFT_RANGE = 6,
    /// A force callback failed; hbvib_last_error has the code that it returned.
    HBVIB_STOPPED_CALLBACK = 7,
    /// A required pointer is NULL.
    HBVIB_E_NULL = -1,
    /// A value lies outside its range.
    HBVIB_E_ARGUMENT = -2,
    /// A count or length does not fit.
    HBVIB_E_DIMENSION = -3,
    /// A number is NaN or infinite.
    HBVIB_E_NOT_FINITE = -4,
    /// A matrix that was announced as symmetric or Hermitian is not.
    HBVIB_E_NOT_HERMITIAN = -5,
    /// A linear system has no unique solution.
    HBVIB_E_SINGULAR = -6,
    /// An iteration did not converge.
    HBVIB_E_NO_CONVERGENCE = -7,
    /// A struct was not filled by its _init function, or comes from another version.
    HBVIB_E_STRUCT_SIZE = -8,
    /// A callback failed or returned numbers that are not finite.
    HBVIB_E_CALLBACK = -9,
    /// The combination asked for is not provided.
    HBVIB_E_UNSUPPORTED = -10,
    /// Memory could not be had.
    HBVIB_E_OUT_OF_MEMORY = -11,
    /// The problem has no bounded periodic solution.
    HBVIB_E_NO_BOUNDED_SOLUTION = -12,
    /// A handle is not (or no longer) one of this library, or is of another type.
    HBVIB_E_HANDLE = -13,
    /// An object is in use by a running call.
    HBVIB_E_BUSY = -14,
    /// An index lies outside its range.
    HBVIB_E_INDEX = -15,
    /// A matrix that must be positive definite is not.
    HBVIB_E_NOT_POSITIVE_DEFINITE = -16,
    /// A defect of the library itself.
    HBVIB_E_INTERNAL = -99,
}

/// Layouts of a matrix view.
#[repr(C)]
pub enum hbvib_storage {
    /// Dense, column after column (Fortran, MATLAB).
    HBVIB_COL_MAJOR = 0,
    /// Dense, row after row (C, numpy).
    HBVIB_ROW_MAJOR = 1,
    /// Compressed sparse columns; duplicates are summed.
    HBVIB_CSC = 2,
}

/// Kinds of numbers in a view.
#[repr(C)]
pub enum hbvib_scalar {
    /// One double each.
    HBVIB_REAL = 0,
    /// Two doubles each, (re, im).
    HBVIB_COMPLEX = 1,
}

/// Which part of a matrix is given, and what is promised of it.
#[repr(C)]
pub enum hbvib_part {
    /// All of a symmetric or Hermitian matrix; the symmetry is checked.
    HBVIB_FULL = 0,
    /// The lower triangle of a symmetric or Hermitian matrix; the upper one is not read.
    HBVIB_LOWER = 1,
    /// The upper triangle of a symmetric or Hermitian matrix; the lower one is not read.
    HBVIB_UPPER = 2,
    /// All of any matrix.
    HBVIB_GENERAL = 3,
}

/// The matrices of a structure.
#[repr(C)]
pub enum hbvib_matrix_kind {
    /// M
    HBVIB_MASS = 0,
    /// C
    HBVIB_DAMPING = 1,
    /// K
    HBVIB_STIFFNESS = 2,
}

/// Special degrees of freedom.
#[repr(C)]
pub enum hbvib_special_dof {
    /// The ground, which does not move.
    HBVIB_GROUND = -1,
}

/// State of the contacts in a linear analysis.
#[repr(C)]
pub enum hbvib_contact_state {
    /// Without force.
    HBVIB_CONTACTS_FREE = 0,
    /// Linear springs, as at small motion: kt of contacts that stick and kn of those that press at
    /// rest, the slopes of tables and polynomials; HBVIB_REGULARISED has none.
    HBVIB_CONTACTS_STUCK = 1,
}

/// Results that a branch holds for each point of the curve. Energies are of one sector.
#[repr(C)]
pub enum hbvib_field {
    /// Angular frequency.
    HBVIB_OMEGA = 0,
    /// Peak amplitude of the fundamental of the response degree of freedom.
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
    /// everywhere unless a tolerance chooses the harmonics or estimate_error asks for it.
    HBVIB_ERROR_ESTIMATE = 7,
    /// Highest harmonic number carried.
    HBVIB_HARMONICS_USED = 8,
    /// Share of the period that each contact slips: points x contacts. Time that a contact is open is not
    /// slip, so that springs have 0, HBVIB_UNILATERAL among them.
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
    /// Aliasing check of laws that are sampled: relative change of their force harmonics with half the
    /// samples (twice as many where half are too few). 0 where all laws are exact, NaN where a force
    /// of the caller did not answer. It tells the size of the error by sampling and is no bound of it.
    HBVIB_SAMPLING_ERROR = 14,
    /// Nonlinear modes only: estimated error of the damping ratio, in units of it; as HBVIB_ERROR_ESTIMATE.
    HBVIB_DAMPING_ERROR_ESTIMATE = 15,
}

/// Weights of log lines.
#[repr(C)]
pub enum hbvib_log_level {
    /// No line at all.
    HBVIB_LOG_NONE = 0,
    /// What the user should look at.
    HBVIB_LOG_WARN = 1,
    /// Steps of the method.
    HBVIB_LOG_INFO = 2,
    /// Detail for debugging.
    HBVIB_LOG_DEBUG = 3,
}

/// A structure with its contacts and forces, created by hbvib_model_new or hbvib_cyclic_new.
pub struct hbvib_model(());

/// A branch of solutions, created by hbvib_forced_response or hbvib_nonlinear_mode.
pub struct hbvib_branch(());

/// A matrix of the caller, read during the call and never kept. Fill it by hbvib_matrix_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_matrix {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// HBVIB_COL_MAJOR, HBVIB_ROW_MAJOR or HBVIB_CSC.
    pub storage: i32,
    /// HBVIB_REAL or HBVIB_COMPLEX.
    pub scalar: i32,
    /// HBVIB_FULL, HBVIB_LOWER, HBVIB_UPPER or HBVIB_GENERAL.
    pub part: i32,
    /// Number of rows.
    pub rows: i64,
    /// Number of columns.
    pub cols: i64,
    /// Dense: distance of columns (rows, if row-major) in numbers; 0 = packed.
    pub ld: i64,
    /// The numbers: ld * (cols - 1) + rows of them if column-major, as many as the last of col_ptr
    /// says if sparse; each is two doubles if complex.
    pub values: *const f64,
    /// Sparse only: cols + 1 offsets, the first equal to index_base.
    pub col_ptr: *const i64,
    /// Sparse only: row of each number, counted from index_base.
    pub row_idx: *const i64,
    /// 0 or 1: base of sparse indices, and of the indices in error sentences.
    pub index_base: i32,
    /// Must be 0.
    pub reserved: i32,
}

/// Options that every analysis shares. Fill it by hbvib_solver_options_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_solver_options {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// Threads that may be used; 0 = default = 1, which starts none. Results do not depend on it.
    pub num_threads: i32,
    /// Relative error wanted, from which the harmonics of each point are chosen (default 1e-3): of the complex
    /// fundamental of the response degree of freedom; in a nonlinear mode of the frequency and of the damping
    /// ratio, the latter over the largest met so far. 0: exactly `harmonics`, whatever the error.
    pub tolerance: f64,
    /// Highest harmonic number H. Where the tolerance decides: the H to begin with.
    pub harmonics: i64,
    /// Cap on H where the tolerance decides, at least the highest harmonic that is forced. Points that would
    /// need more are kept, and the status is HBVIB_STOPPED_MAX_HARMONICS.
    pub max_harmonics: i64,
    /// 0: events of contacts are located exactly; else samples per period, at least 2H + 1; where the
    /// tolerance decides, at least 8H are taken.
    /// HBVIB_CUBIC, HBVIB_FRICTION_2D and polynomials are exact either way; HBVIB_FRICTION_3D and
    /// HBVIB_REGULARISED have samples always, 0: a number by H.
    pub samples: i64,
    /// First arc-length step in scaled unknowns; 0 = automatic.
    pub step: f64,
    /// Smallest step; 0 = automatic.
    pub step_min: f64,
    /// Largest step; 0 = automatic.
    pub step_max: f64,
    /// Relative residual of a converged point.
    pub tol_residual: f64,
    /// Cap on Newton iterations per point.
    pub max_newton: i64,
    /// Cap on the number of points.
    pub max_points: i64,
    /// Degree of freedom whose fundamental defines amplitude and peaks; -1: the forced one that
    /// moves most at the lower end of the range, contacts at their reference stiffness. In a
    /// nonlinear mode it defines the amplitude reported, no more; -1: the phase reference.
    pub response_dof: i64,
    /// 1: carry the mean and even harmonics even where symmetry makes them zero; 0: do not.
    pub keep_even_harmonics: i32,
    /// 1: estimate the error of every point, for HBVIB_ERROR_ESTIMATE, at the cost of a solution with
    /// more harmonics at each of them; 0 (default): do so only where the tolerance decides.
    pub estimate_error: i32,
}

/// Options of hbvib_forced_response. Fill it by hbvib_forced_options_init, then set the range.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_forced_options {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// Must be 0.
    pub reserved: i32,
    /// First angular frequency, > 0, rad per time unit.
    pub omega_start: f64,
    /// Last angular frequency: below the first for a downward sweep, equal to it for one point.
    pub omega_stop: f64,
    /// Angular frequencies within the range at which every solution is wanted as well, or NULL.
    pub at: *const f64,
    /// Their number.
    pub at_len: i64,
    /// Start values, complex (H + 1) x ndof, harmonic after harmonic, or NULL: the stuck solution.
    pub guess: *const f64,
    /// Complex numbers in guess.
    pub guess_len: i64,
}

/// State of a solve, handed to the progress callback.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_progress {
    /// Bytes of this struct as the library knows it.
    pub struct_size: u32,
    /// Newton iterations that the point took.
    pub newton_iterations: i32,
    /// Number of points accepted so far, this one included.
    pub point: i64,
    /// Angular frequency; in a nonlinear mode log10 of the amplitude.
    pub parameter: f64,
    /// Peak amplitude of the fundamental of the response degree of freedom.
    pub amplitude: f64,
    /// Relative residual.
    pub residual: f64,
    /// Arc length of the step that led here, in scaled unknowns.
    pub step: f64,
    /// Share of the range done, 0 to 1.
    pub fraction_done: f64,
}

/// What a caller attaches to a solve. Fill it by hbvib_hooks_init. Callbacks run on the calling
/// thread, one at a time; they may call the library, but not change or free a handle in use.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_hooks {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// HBVIB_LOG_NONE .. HBVIB_LOG_DEBUG: the finest lines that `log` wants.
    pub log_level: i32,
    /// Passed to the callbacks.
    pub user: *mut c_void,
    /// Called at each accepted point; a nonzero result stops the solve and keeps the points. May
    /// be NULL.
    pub progress: Option<unsafe extern "C-unwind" fn(user: *mut c_void, progress: *const hbvib_progress) -> i32>,
    /// Receives log lines; the text is valid during the call. May be NULL.
    pub log: Option<unsafe extern "C-unwind" fn(user: *mut c_void, level: i32, message: *const c_char)>,
    /// Looked at in each Newton iteration: nonzero stops the solve and keeps the points. It may be
    /// set by another thread or a signal handler, and is never written here. May be NULL.
    pub cancel: *const hbvib_cancel_flag,
}

/// A borrowed array of results, valid until hbvib_branch_free. Fill it by hbvib_view_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hbvib_view {
    /// Bytes of this struct as the caller knows it.
    pub struct_size: u32,
    /// HBVIB_REAL or HBVIB_COMPLEX.
    pub scalar: i32,
    /// Number of dimensions, 1 to 3.
    pub rank: i32,
    /// 0.
    pub reserved: i32,
    /// First number; NULL where there is none.
    pub data: *const f64,
    /// Length of each dimension; 1 beyond the rank.
    pub shape: [i64; 3],
    /// Distance of neighbours in each dimension, in numbers of the view's kind.
    pub stride: [i64; 3],
}

/// A status code of the header is that of the library.
macro_rules! same {
    ($($constant:ident = $status:ident),* $(,)?) => {
        $(const _: () = assert!(hbvib_status_code::$constant as i32 == Status::$status as i32);)*
    };
}

same!(
    HBVIB_OK = Ok,
    HBVIB_STOPPED_BY_CALLER = StoppedByCaller,
    HBVIB_STOPPED_STEP_TOO_SMALL = StoppedStepTooSmall,
    HBVIB_STOPPED_MAX_POINTS = StoppedMaxPoints,
    HBVIB_STOPPED_MAX_HARMONICS = StoppedMaxHarmonics,
    HBVIB_STOPPED_STALLED = StoppedStalled,
    HBVIB_STOPPED_LEFT_RANGE = StoppedLeftRange,
    HBVIB_STOPPED_CALLBACK = StoppedCallback,
    HBVIB_E_NULL = Null,
    HBVIB_E_ARGUMENT = Argument,
    HBVIB_E_DIMENSION = Dimension,
    HBVIB_E_NOT_FINITE = NotFinite,
    HBVIB_E_NOT_HERMITIAN = NotHermitian,
    HBVIB_E_SINGULAR = Singular,
    HBVIB_E_NO_CONVERGENCE = NoConvergence,
    HBVIB_E_STRUCT_SIZE = StructSize,
    HBVIB_E_CALLBACK = Callback,
    HBVIB_E_UNSUPPORTED = Unsupported,
    HBVIB_E_OUT_OF_MEMORY = OutOfMemory,
    HBVIB_E_NO_BOUNDED_SOLUTION = NoBoundedSolution,
    HBVIB_E_HANDLE = Handle,
    HBVIB_E_BUSY = Busy,
    HBVIB_E_INDEX = Index,
    HBVIB_E_NOT_POSITIVE_DEFINITE = NotPositiveDefinite,
    HBVIB_E_INTERNAL = Internal,
);
