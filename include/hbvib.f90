!> hbvib from Fortran: harmonic balance of vibrating structures with friction contacts (the equations, units and errors stand in
!> hbvib.h). `use hbvib` also brings in iso_c_binding. Compile this file with your program and with its options (gfortran:
!> -std=f2018 or looser).
!>
!> A procedure called by its C name is the C function: indices count from 0, handles are type(c_ptr). What is called through a
!> type (model%..., branch%...) is Fortran: indices count from 1, those inside structs that are passed or returned included
!> (dof_a, response_dof, mode_index ...). HBVIB_GROUND and the "automatic" -1 stay -1; harmonics and diameters are numbers of
!> waves, not indices, and keep their values. Index 0 is refused with HBVIB_E_INDEX and a sentence in numbers from 1.
!>
!> status     Every function called through a type returns it, integer(c_int32_t): HBVIB_OK, negative (error), positive (stopped
!>            early, results are there). hbvib_error_text() is the sentence to it, this thread's own. Nothing stops or prints.
!>            hbvib_last_error_argument() counts the arguments of the C function that refused (hbvib_index_from_one for an
!>            index). Entries of matrices and indices are told from 1; positions within other arrays (entry 1,
!>            spring[1], row_idx[1]) and contacts named by a solve count from 0.
!> objects    hbvib_model and hbvib_branch hold a handle. Assignment copies the handle, not the object; model%clone copies a model.
!>            %free ends the object and empties the variable; copies of the handle are then refused (HBVIB_E_HANDLE). There is no
!>            finaliser, because it would free what a copy still uses. A procedure that fills a model or branch first frees what
!>            the variable held.
!> structs    are those of C, with the defaults of their _init functions already in place: type(hbvib_contact) :: c is ready, and
!>            so is hbvib_solver_options(harmonics=63). struct_size is not to be touched. hbvib_energy is called hbvib_energies,
!>            its name being the constant's HBVIB_ENERGY. Where a type-bound procedure has a keyword for an array, it replaces the
!>            pointer in the struct.
!> arrays     double precision, passed without a copy where they are contiguous. Arrays of unequal length are HBVIB_E_DIMENSION.
!>            Complex harmonics are x(dof, 0:H). Tables that C has by rows have their indices reversed here: C's [j][i] is (i, j).
module hbvib
   use, intrinsic :: iso_c_binding
   implicit none
   public

   integer, parameter, private :: dp = c_double, i32 = c_int32_t, i64 = c_int64_t

   ! hbvib_status_code
   integer(c_int32_t), parameter, public :: HBVIB_OK = 0, HBVIB_STOPPED_BY_CALLER = 1, HBVIB_STOPPED_STEP_TOO_SMALL = 2, &
      HBVIB_STOPPED_MAX_POINTS = 3, HBVIB_STOPPED_MAX_HARMONICS = 4, HBVIB_STOPPED_STALLED = 5, &
      HBVIB_STOPPED_LEFT_RANGE = 6, HBVIB_STOPPED_CALLBACK = 7, HBVIB_E_NULL = -1, HBVIB_E_ARGUMENT = -2, &
      HBVIB_E_DIMENSION = -3, HBVIB_E_NOT_FINITE = -4, HBVIB_E_NOT_HERMITIAN = -5, HBVIB_E_SINGULAR = -6, &
      HBVIB_E_NO_CONVERGENCE = -7, HBVIB_E_STRUCT_SIZE = -8, HBVIB_E_CALLBACK = -9, HBVIB_E_UNSUPPORTED = -10, &
      HBVIB_E_OUT_OF_MEMORY = -11, HBVIB_E_NO_BOUNDED_SOLUTION = -12, HBVIB_E_HANDLE = -13, HBVIB_E_BUSY = -14, &
      HBVIB_E_INDEX = -15, HBVIB_E_NOT_POSITIVE_DEFINITE = -16, HBVIB_E_INTERNAL = -99
   ! hbvib_storage
   integer(c_int32_t), parameter, public :: HBVIB_COL_MAJOR = 0, HBVIB_ROW_MAJOR = 1, HBVIB_CSC = 2
   ! hbvib_scalar
   integer(c_int32_t), parameter, public :: HBVIB_REAL = 0, HBVIB_COMPLEX = 1
   ! hbvib_part
   integer(c_int32_t), parameter, public :: HBVIB_FULL = 0, HBVIB_LOWER = 1, HBVIB_UPPER = 2, HBVIB_GENERAL = 3
   ! hbvib_matrix_kind
   integer(c_int32_t), parameter, public :: HBVIB_MASS = 0, HBVIB_DAMPING = 1, HBVIB_STIFFNESS = 2
   ! hbvib_contact_kind
   integer(c_int32_t), parameter, public :: HBVIB_JENKINS = 1, HBVIB_FRICTION_2D = 2, HBVIB_FRICTION_3D = 3, &
      HBVIB_UNILATERAL = 4, HBVIB_CUBIC = 5, HBVIB_REGULARISED = 6
   ! hbvib_special_dof
   integer(c_int32_t), parameter, public :: HBVIB_GROUND = -1
   ! hbvib_contact_state
   integer(c_int32_t), parameter, public :: HBVIB_CONTACTS_FREE = 0, HBVIB_CONTACTS_STUCK = 1
   ! hbvib_state
   integer(c_int32_t), parameter, public :: HBVIB_STATE_STICK = 0, HBVIB_STATE_SLIP = 1, HBVIB_STATE_OPEN = 2
   ! hbvib_tangent
   integer(c_int32_t), parameter, public :: HBVIB_DF_DU = 0, HBVIB_DF_DV = 1, HBVIB_DF_DZ = 2, HBVIB_DZ_DZ = 3, &
      HBVIB_DZ_DU_BEFORE = 4, HBVIB_DZ_DU = 5, HBVIB_DZ_DV_BEFORE = 6, HBVIB_DZ_DV = 7, HBVIB_DZ_DOMEGA = 8
   ! hbvib_field
   integer(c_int32_t), parameter, public :: HBVIB_OMEGA = 0, HBVIB_AMPLITUDE = 1, HBVIB_DAMPING_RATIO = 2, &
      HBVIB_ENERGY = 3, HBVIB_DISSIPATION = 4, HBVIB_RESIDUAL = 5, HBVIB_NEWTON_ITERATIONS = 6, &
      HBVIB_ERROR_ESTIMATE = 7, HBVIB_HARMONICS_USED = 8, &
      HBVIB_SLIP_FRACTION = 9, HBVIB_LOG10_AMPLITUDE = 10, HBVIB_MODAL_AMPLITUDE = 11, HBVIB_STRUCTURAL_LOSS = 12, &
      HBVIB_MODAL_ASSURANCE = 13, HBVIB_SAMPLING_ERROR = 14, &
      HBVIB_DAMPING_ERROR_ESTIMATE = 15
   ! hbvib_damping_form
   integer(c_int32_t), parameter, public :: HBVIB_DAMPING_MASS = 0, HBVIB_DAMPING_STIFFNESS = 1
   ! hbvib_mode_multiple
   integer(c_int32_t), parameter, public :: HBVIB_MODE_SINGLE = 0, HBVIB_MODE_TRAVELLING_WAVE = 1, &
      HBVIB_MODE_PROJECTED = 2, HBVIB_MODE_FIRST = 3
   ! hbvib_synthesis_flag
   integer(c_int32_t), parameter, public :: HBVIB_SYNTHESIS_VALID = 0, HBVIB_SYNTHESIS_ANOTHER_MODE = 1, &
      HBVIB_SYNTHESIS_INTERNAL_RESONANCE = 2, HBVIB_SYNTHESIS_FALLING = 4
   ! hbvib_log_level
   integer(c_int32_t), parameter, public :: HBVIB_LOG_NONE = 0, HBVIB_LOG_WARN = 1, HBVIB_LOG_INFO = 2, HBVIB_LOG_DEBUG = 3
   ! hbvib_steady_method
   integer(c_int32_t), parameter, public :: HBVIB_SHOOTING = 0, HBVIB_MARCHING = 1
   ! Version of the library that this module was written for; hbvib_version() is that of the one in use.
   integer(c_int32_t), parameter, public :: HBVIB_VERSION_MAJOR = 0, HBVIB_VERSION_MINOR = 1, HBVIB_VERSION_PATCH = 0

   !> A matrix of the caller, read during the call and never kept.
   type, bind(c) :: hbvib_matrix
      integer(c_int32_t) :: struct_size = 72, storage = 0, scalar = 0, part = 0
      integer(c_int64_t) :: rows = 0, cols = 0, ld = 0
      type(c_ptr) :: values = c_null_ptr, col_ptr = c_null_ptr, row_idx = c_null_ptr
      integer(c_int32_t) :: index_base = 1, reserved = 0
   end type hbvib_matrix

   !> A contact between two degrees of freedom, or between one and the ground.
   type, bind(c) :: hbvib_contact
      integer(c_int32_t) :: struct_size = 168, kind = 0
      integer(c_int64_t) :: dof_a(3) = HBVIB_GROUND, dof_b(3) = HBVIB_GROUND, sector_offset = 0
      real(c_double) :: kt = 0, kn = 0, mu = 0, preload = 0, gap = 0, cubic = 0, velocity = 0, normal(3) = 0, tangent(3) = 0
   end type hbvib_contact

   !> One period that a force callback is asked about.
   type, bind(c) :: hbvib_force_call
      integer(c_int32_t) :: struct_size = 152, reserved = 0
      real(c_double) :: omega = 0
      integer(c_int64_t) :: samples = 0, n = 0, states = 0
      type(c_ptr) :: u = c_null_ptr, v = c_null_ptr, z0 = c_null_ptr, f = c_null_ptr, df_du = c_null_ptr, &
         df_dv = c_null_ptr, z = c_null_ptr, dz_dz = c_null_ptr, dz_du_before = c_null_ptr, dz_du = c_null_ptr, &
         dz_dv_before = c_null_ptr, dz_dv = c_null_ptr, dz_domega = c_null_ptr, df_dz = c_null_ptr
   end type hbvib_force_call

   !> A force of the caller on some degrees of freedom.
   type, bind(c) :: hbvib_user_force
      integer(c_int32_t) :: struct_size = 64, uses_velocity = 0, is_odd = 0, reserved = 0
      type(c_ptr) :: dofs = c_null_ptr
      integer(c_int64_t) :: n = 0, states = 0, samples = 0
      type(c_funptr) :: force = c_null_funptr
      type(c_ptr) :: user = c_null_ptr
   end type hbvib_user_force

   !> The derivative that lies farthest from its difference quotient.
   type, bind(c) :: hbvib_jacobian_gap
      integer(c_int32_t) :: struct_size = 56, tangent = 0
      real(c_double) :: gap = 0
      integer(c_int64_t) :: sample = 0, row = 0, column = 0
      real(c_double) :: given = 0, difference = 0
   end type hbvib_jacobian_gap

   !> Options that every analysis shares.
   type, bind(c) :: hbvib_solver_options
      integer(c_int32_t) :: struct_size = 104, num_threads = 0
      real(c_double) :: tolerance = 1e-3_c_double
      integer(c_int64_t) :: harmonics = 9, max_harmonics = 511, samples = 0
      real(c_double) :: step = 0, step_min = 0, step_max = 0, tol_residual = 1e-10_c_double
      integer(c_int64_t) :: max_newton = 25, max_points = 20000, response_dof = -1
      integer(c_int32_t) :: keep_even_harmonics = 0, estimate_error = 0
   end type hbvib_solver_options

   !> Options of hbvib_forced_response.
   type, bind(c) :: hbvib_forced_options
      integer(c_int32_t) :: struct_size = 56, reserved = 0
      real(c_double) :: omega_start = 0, omega_stop = 0
      type(c_ptr) :: at = c_null_ptr
      integer(c_int64_t) :: at_len = 0
      type(c_ptr) :: guess = c_null_ptr
      integer(c_int64_t) :: guess_len = 0
   end type hbvib_forced_options

   !> State of a solve, handed to the progress callback.
   type, bind(c) :: hbvib_progress
      integer(c_int32_t) :: struct_size = 56, newton_iterations = 0
      integer(c_int64_t) :: point = 0
      real(c_double) :: parameter = 0, amplitude = 0, residual = 0, step = 0, fraction_done = 0
   end type hbvib_progress

   !> What a caller attaches to a solve.
   type, bind(c) :: hbvib_hooks
      integer(c_int32_t) :: struct_size = 40, log_level = 0
      type(c_ptr) :: user = c_null_ptr
      type(c_funptr) :: progress = c_null_funptr, log = c_null_funptr
      type(c_ptr) :: cancel = c_null_ptr
   end type hbvib_hooks

   !> Options of hbvib_nonlinear_mode.
   type, bind(c) :: hbvib_mode_options
      integer(c_int32_t) :: struct_size = 96, damping_form = 0
      real(c_double) :: log10_start = 0, log10_stop = 0
      integer(c_int64_t) :: diameter = -1, mode_index = 1
      real(c_double) :: near_omega = 0
      type(c_ptr) :: shape = c_null_ptr
      integer(c_int64_t) :: shape_len = 0, amplitude_contact = -1
      type(c_ptr) :: at = c_null_ptr
      integer(c_int64_t) :: at_len = 0, reference_dof = -1
   end type hbvib_mode_options

   !> A borrowed array of results, valid until hbvib_branch_free.
   type, bind(c) :: hbvib_view
      integer(c_int32_t) :: struct_size = 72, scalar = 0, rank = 0, reserved = 0
      type(c_ptr) :: data = c_null_ptr
      integer(c_int64_t) :: shape(3) = 1, stride(3) = 0
   end type hbvib_view

   !> What was removed from the problem before it was solved.
   type, bind(c) :: hbvib_reduction
      integer(c_int32_t) :: struct_size = 104, reserved = 0
      integer(c_int64_t) :: sectors = 0, degrees_of_freedom = 0, coordinates = 0, contacts = 0, never_slipping = 0, &
         inert = 0, harmonics_asked = 0, harmonics_carried = 0, unknowns = 0, response_dof = 0
      integer(c_int32_t) :: mean_carried = 0, even_removed = 0
      integer(c_int64_t) :: held_by_contacts = 0
   end type hbvib_reduction

   !> Energies and losses of one point, in the caller's units.
   type, bind(c) :: hbvib_energies
      integer(c_int32_t) :: struct_size = 96, reserved = 0
      real(c_double) :: twice_mean_kinetic = 0, kinetic_mean = 0, kinetic_peak = 0, potential_mean = 0, potential_peak = 0, &
         wheel_kinetic_mean = 0, wheel_kinetic_peak = 0, wheel_potential_mean = 0, wheel_potential_peak = 0, &
         structural_loss = 0, friction_loss = 0
   end type hbvib_energies

   !> Numbers of one contact over one period, in the caller's units.
   type, bind(c) :: hbvib_contact_summary
      integer(c_int32_t) :: struct_size = 128, reserved = 0
      real(c_double) :: work = 0, slip_share = 0, open_share = 0, half_range = 0, motion_min = 0, motion_max = 0, &
         load_min = 0, load_max = 0
      integer(c_int64_t) :: directions = 0
      real(c_double) :: all_min(3) = 0, all_max(3) = 0
   end type hbvib_contact_summary

   !> Numbers of one point of a nonlinear mode, in the caller's units; energies are of one sector.
   type, bind(c) :: hbvib_mode_point
      integer(c_int32_t) :: struct_size = 88, reserved = 0
      real(c_double) :: log10_amplitude = 0, omega = 0, damping_ratio = 0, modal_amplitude = 0, energy = 0, &
         fundamental_share = 0, friction_loss = 0, structural_loss = 0, energy_damping_ratio = 0, assurance = 0
   end type hbvib_mode_point

   !> Where a nonlinear mode started.
   type, bind(c) :: hbvib_mode_info
      integer(c_int32_t) :: struct_size = 64, multiple = 0
      integer(c_int64_t) :: mode_index = 0, multiplicity = 0, reference_dof = 0, engine_order = 0, amplitude_contact = -1
      real(c_double) :: omega = 0, linear_up_to = 0
   end type hbvib_mode_info

   !> Options of a synthesised response.
   type, bind(c) :: hbvib_synthesis_options
      integer(c_int32_t) :: struct_size = 24, model_damping = 0
      real(c_double) :: force_factor = 1, damping_ratio = 0
   end type hbvib_synthesis_options

   !> Options of hbvib_time_response.
   type, bind(c) :: hbvib_time_options
      integer(c_int32_t) :: struct_size = 64, method = 0
      real(c_double) :: omega = 0
      integer(c_int64_t) :: harmonics = 9, samples = 0
      real(c_double) :: tolerance = 1e-11_c_double
      integer(c_int64_t) :: max_periods = 10000
      type(c_ptr) :: start = c_null_ptr
      integer(c_int64_t) :: start_len = 0
   end type hbvib_time_options

   !> What is known of a periodic response in time.
   type, bind(c) :: hbvib_time_info
      integer(c_int32_t) :: struct_size = 40, reserved = 0
      real(c_double) :: period = 0, residual = 0
      integer(c_int64_t) :: periods = 0, events = 0
   end type hbvib_time_info

   !> Options of hbvib_verify.
   type, bind(c) :: hbvib_verify_options
      integer(c_int32_t) :: struct_size = 32, method = 0
      real(c_double) :: tolerance = 1e-11_c_double
      integer(c_int64_t) :: max_periods = 10000
      real(c_double) :: same_within = 0.1_c_double
   end type hbvib_verify_options

   !> How far a point is from the periodic motion that integration in time finds from it.
   type, bind(c) :: hbvib_verification
      integer(c_int32_t) :: struct_size = 112, same_solution = 0, marched = 0, reserved = 0
      integer(c_int64_t) :: harmonic = 0
      complex(c_double_complex) :: response = 0
      real(c_double) :: response_error = 0, motion_error = 0, above = 0, distance = 0, peak = 0, peak_error = 0, residual = 0
      integer(c_int64_t) :: periods = 0, events = 0
   end type hbvib_verification

   !> A structure with its contacts and forces. Calls that change it need it alone; any number of threads may solve it at once.
   type :: hbvib_model
      type(c_ptr) :: handle = c_null_ptr
   contains
      procedure :: new => model_new
      procedure :: clone => model_clone
      procedure :: free => model_free
      procedure :: dofs => model_dofs
      procedure :: sectors => model_sectors
      procedure :: contacts => model_contacts
      procedure, private :: set_real, set_complex, set_sparse_real, set_sparse_complex, set_struct
      procedure, private :: couple_real, couple_complex, couple_sparse_real, couple_sparse_complex, couple_struct
      procedure, private :: add_force_real, add_force_complex
      generic :: set_matrix => set_real, set_complex, set_sparse_real, set_sparse_complex, set_struct
      generic :: set_coupling => couple_real, couple_complex, couple_sparse_real, couple_sparse_complex, couple_struct
      generic :: add_force => add_force_real, add_force_complex
      procedure :: set_rayleigh => model_set_rayleigh
      procedure :: set_wave => model_set_wave
      procedure :: clear_forces => model_clear_forces
      procedure :: add_contact => model_add_contact
      procedure :: set_preload => model_set_preload
      procedure :: add_jenkins => model_add_jenkins
      procedure :: add_springs => model_add_springs
      procedure :: add_iwan => model_add_iwan
      procedure :: add_table => model_add_table
      procedure :: add_spring_damper => model_add_spring_damper
      procedure :: add_polynomial => model_add_polynomial
      procedure :: add_stiffness_tensors => model_add_stiffness_tensors
      procedure :: add_patch => model_add_patch
      procedure :: add_user_force => model_add_user_force
      procedure :: check_jacobian => model_check_jacobian
      procedure :: linear_modes => model_linear_modes
      procedure :: forced_response => model_forced_response
      procedure :: nonlinear_mode => model_nonlinear_mode
      procedure :: time_response => model_time_response
      procedure :: verify => model_verify
      procedure :: forced_residual => model_forced_residual
   end type hbvib_model

   !> A curve of solutions. Points 1 .. points() lie on it; peaks, folds and solutions wanted carry the numbers from there on.
   type :: hbvib_branch
      type(c_ptr) :: handle = c_null_ptr
   contains
      procedure :: free => branch_free
      procedure :: points => branch_points
      procedure :: stored => branch_stored
      procedure :: status => branch_status
      procedure, private :: field_1, field_2
      generic :: field => field_1, field_2
      procedure :: harmonics => branch_harmonics
      procedure :: harmonics_into => branch_harmonics_into
      procedure :: slip_fraction => branch_slip_fraction
      procedure :: reduction => branch_reduction
      procedure :: peaks => branch_peaks
      procedure :: folds => branch_folds
      procedure :: at => branch_at
      procedure :: energy => branch_energy
      procedure :: time_history => branch_time_history
      procedure :: contact_loop => branch_contact_loop
      procedure :: contact_summary => branch_contact_summary
      procedure :: mode_point => branch_mode_point
      procedure :: mode_info => branch_mode_info
      procedure :: synthesis => branch_synthesis
      procedure :: synthesis_peaks => branch_synthesis_peaks
   end type hbvib_branch

   !> hbvib_hooks(progress=..., log=..., log_level=..., user=c_loc(...), cancel=c_loc(flag)) from procedures.
   interface hbvib_hooks
      module procedure hooks_of
   end interface hbvib_hooks

   abstract interface
      !> Called at each accepted point; a result other than 0 stops the solve and keeps the points.
      function hbvib_progress_fn(user, progress) bind(c) result(stop)
         import
         type(c_ptr), value :: user
         type(hbvib_progress), intent(in) :: progress
         integer(c_int32_t) :: stop
      end function hbvib_progress_fn

      !> Receives a line of the log; hbvib_text(message) makes it a character string.
      subroutine hbvib_log_fn(user, level, message) bind(c)
         import
         type(c_ptr), value :: user
         integer(c_int32_t), value :: level
         type(c_ptr), value :: message
      end subroutine hbvib_log_fn

      !> A force of the caller; hbvib_force_arrays gives the arrays of asked. 0: done, above 0: not at this motion, below 0: stop.
      function hbvib_force_fn(user, asked) bind(c) result(refusal)
         import
         type(c_ptr), value :: user
         type(hbvib_force_call), intent(in) :: asked
         integer(c_int32_t) :: refusal
      end function hbvib_force_fn
   end interface

   ! The functions of hbvib.h by their C names. What may be NULL there is optional here.
   interface
      function hbvib_version() bind(c) result(answer)
         import
         integer(c_int32_t) :: answer
      end function hbvib_version

      function hbvib_version_string() bind(c) result(answer)
         import
         type(c_ptr) :: answer
      end function hbvib_version_string

      function hbvib_status_name(status) bind(c) result(answer)
         import
         integer(c_int32_t), value :: status
         type(c_ptr) :: answer
      end function hbvib_status_name

      function hbvib_last_error() bind(c) result(answer)
         import
         type(c_ptr) :: answer
      end function hbvib_last_error

      function hbvib_last_error_argument() bind(c) result(answer)
         import
         integer(c_int32_t) :: answer
      end function hbvib_last_error_argument

      function hbvib_last_error_copy(buffer, len) bind(c) result(answer)
         import
         character(kind=c_char), intent(inout), optional :: buffer(*)
         integer(c_size_t), value :: len
         integer(c_size_t) :: answer
      end function hbvib_last_error_copy

      function hbvib_matrix_init(a, size_of_a) bind(c) result(status)
         import
         type(hbvib_matrix), intent(inout) :: a
         integer(c_size_t), value :: size_of_a
         integer(c_int32_t) :: status
      end function hbvib_matrix_init

      function hbvib_model_new(ndof, out) bind(c) result(status)
         import
         integer(c_int64_t), value :: ndof
         type(c_ptr), intent(inout) :: out
         integer(c_int32_t) :: status
      end function hbvib_model_new

      function hbvib_cyclic_new(ndof_sector, sectors, out) bind(c) result(status)
         import
         integer(c_int64_t), value :: ndof_sector, sectors
         type(c_ptr), intent(inout) :: out
         integer(c_int32_t) :: status
      end function hbvib_cyclic_new

      function hbvib_model_set_matrix(model, which, a) bind(c) result(status)
         import
         type(c_ptr), value :: model
         integer(c_int32_t), value :: which
         type(hbvib_matrix), intent(in) :: a
         integer(c_int32_t) :: status
      end function hbvib_model_set_matrix

      function hbvib_model_set_rayleigh(model, alpha_mass, beta_stiffness) bind(c) result(status)
         import
         type(c_ptr), value :: model
         real(c_double), value :: alpha_mass, beta_stiffness
         integer(c_int32_t) :: status
      end function hbvib_model_set_rayleigh

      function hbvib_cyclic_set_coupling(model, which, to_next) bind(c) result(status)
         import
         type(c_ptr), value :: model
         integer(c_int32_t), value :: which
         type(hbvib_matrix), intent(in) :: to_next
         integer(c_int32_t) :: status
      end function hbvib_cyclic_set_coupling

      function hbvib_cyclic_set_coupling_previous(model, which, to_previous) bind(c) result(status)
         import
         type(c_ptr), value :: model
         integer(c_int32_t), value :: which
         type(hbvib_matrix), intent(in) :: to_previous
         integer(c_int32_t) :: status
      end function hbvib_cyclic_set_coupling_previous

      function hbvib_cyclic_set_diameter(model, which, diameter, a) bind(c) result(status)
         import
         type(c_ptr), value :: model
         integer(c_int32_t), value :: which
         integer(c_int64_t), value :: diameter
         type(hbvib_matrix), intent(in) :: a
         integer(c_int32_t) :: status
      end function hbvib_cyclic_set_diameter

      function hbvib_cyclic_set_wave(model, engine_order) bind(c) result(status)
         import
         type(c_ptr), value :: model
         integer(c_int64_t), value :: engine_order
         integer(c_int32_t) :: status
      end function hbvib_cyclic_set_wave

      function hbvib_model_clone(model, out) bind(c) result(status)
         import
         type(c_ptr), value :: model
         type(c_ptr), intent(inout) :: out
         integer(c_int32_t) :: status
      end function hbvib_model_clone

      function hbvib_model_free(model) bind(c) result(status)
         import
         type(c_ptr), value :: model
         integer(c_int32_t) :: status
      end function hbvib_model_free

      function hbvib_model_add_force(model, dof, harmonic, re, im) bind(c) result(status)
         import
         type(c_ptr), value :: model
         integer(c_int64_t), value :: dof, harmonic
         real(c_double), value :: re, im
         integer(c_int32_t) :: status
      end function hbvib_model_add_force

      function hbvib_model_clear_forces(model) bind(c) result(status)
         import
         type(c_ptr), value :: model
         integer(c_int32_t) :: status
      end function hbvib_model_clear_forces

      function hbvib_linear_modes(model, diameter, contacts, count, omega, shapes) bind(c) result(status)
         import
         type(c_ptr), value :: model
         integer(c_int64_t), value :: diameter
         integer(c_int32_t), value :: contacts
         integer(c_int64_t), value :: count
         real(c_double), intent(inout) :: omega(*)
         complex(c_double_complex), intent(inout), optional :: shapes(*)
         integer(c_int32_t) :: status
      end function hbvib_linear_modes

      function hbvib_model_dofs(model) bind(c) result(answer)
         import
         type(c_ptr), value :: model
         integer(c_int64_t) :: answer
      end function hbvib_model_dofs

      function hbvib_model_sectors(model) bind(c) result(answer)
         import
         type(c_ptr), value :: model
         integer(c_int64_t) :: answer
      end function hbvib_model_sectors

      function hbvib_model_contacts(model) bind(c) result(answer)
         import
         type(c_ptr), value :: model
         integer(c_int64_t) :: answer
      end function hbvib_model_contacts

      function hbvib_index_from_one(name, index, count, from_zero) bind(c) result(status)
         import
         character(kind=c_char), intent(in) :: name(*)
         integer(c_int64_t), value :: index, count
         integer(c_int64_t), intent(inout) :: from_zero
         integer(c_int32_t) :: status
      end function hbvib_index_from_one

      function hbvib_contact_init(c, size_of_c) bind(c) result(status)
         import
         type(hbvib_contact), intent(inout) :: c
         integer(c_size_t), value :: size_of_c
         integer(c_int32_t) :: status
      end function hbvib_contact_init

      function hbvib_model_add_contact(model, c, id) bind(c) result(status)
         import
         type(c_ptr), value :: model
         type(hbvib_contact), intent(in) :: c
         integer(c_int64_t), intent(inout), optional :: id
         integer(c_int32_t) :: status
      end function hbvib_model_add_contact

      function hbvib_model_set_preload(model, id, preload) bind(c) result(status)
         import
         type(c_ptr), value :: model
         integer(c_int64_t), value :: id
         real(c_double), value :: preload
         integer(c_int32_t) :: status
      end function hbvib_model_set_preload

      function hbvib_contact_evaluate(c, harmonics, samples, omega, motion, motion_len, force, force_len, jac, &
         jac_len) bind(c) result(status)
         import
         type(hbvib_contact), intent(in) :: c
         integer(c_int64_t), value :: harmonics, samples
         real(c_double), value :: omega
         complex(c_double_complex), intent(in) :: motion(*)
         integer(c_int64_t), value :: motion_len
         complex(c_double_complex), intent(inout) :: force(*)
         integer(c_int64_t), value :: force_len
         real(c_double), intent(inout), optional :: jac(*)
         integer(c_int64_t), value :: jac_len
         integer(c_int32_t) :: status
      end function hbvib_contact_evaluate

      function hbvib_model_add_jenkins(model, n, dof_a, dof_b, sector_offset, kt, mu, preload, first_id) bind(c) result(status)
         import
         type(c_ptr), value :: model
         integer(c_int64_t), value :: n
         integer(c_int64_t), intent(in) :: dof_a(*), dof_b(*)
         integer(c_int64_t), intent(in), optional :: sector_offset(*)
         real(c_double), intent(in) :: kt(*), mu(*), preload(*)
         integer(c_int64_t), intent(inout), optional :: first_id
         integer(c_int32_t) :: status
      end function hbvib_model_add_jenkins

      function hbvib_model_add_springs(model, n, dof_a, dof_b, sector_offset, stiffness) bind(c) result(status)
         import
         type(c_ptr), value :: model
         integer(c_int64_t), value :: n
         integer(c_int64_t), intent(in) :: dof_a(*), dof_b(*)
         integer(c_int64_t), intent(in), optional :: sector_offset(*)
         real(c_double), intent(in) :: stiffness(*)
         integer(c_int32_t) :: status
      end function hbvib_model_add_springs

      function hbvib_model_add_iwan(model, dof_a, dof_b, sector_offset, slip_force, stiffness, chi, beta, elements, &
         first_id) bind(c) result(status)
         import
         type(c_ptr), value :: model
         integer(c_int64_t), value :: dof_a, dof_b, sector_offset
         real(c_double), value :: slip_force, stiffness, chi, beta
         integer(c_int64_t), value :: elements
         integer(c_int64_t), intent(inout), optional :: first_id
         integer(c_int32_t) :: status
      end function hbvib_model_add_iwan

      function hbvib_user_force_init(o, size_of_o) bind(c) result(status)
         import
         type(hbvib_user_force), intent(inout) :: o
         integer(c_size_t), value :: size_of_o
         integer(c_int32_t) :: status
      end function hbvib_user_force_init

      function hbvib_model_add_user_force(model, o, id) bind(c) result(status)
         import
         type(c_ptr), value :: model
         type(hbvib_user_force), intent(in) :: o
         integer(c_int64_t), intent(inout), optional :: id
         integer(c_int32_t) :: status
      end function hbvib_model_add_user_force

      function hbvib_jacobian_gap_init(gap, size_of_gap) bind(c) result(status)
         import
         type(hbvib_jacobian_gap), intent(inout) :: gap
         integer(c_size_t), value :: size_of_gap
         integer(c_int32_t) :: status
      end function hbvib_jacobian_gap_init

      function hbvib_check_jacobian(model, contact, omega, amplitude, amplitude_len, out) bind(c) result(status)
         import
         type(c_ptr), value :: model
         integer(c_int64_t), value :: contact
         real(c_double), value :: omega
         real(c_double), intent(in) :: amplitude(*)
         integer(c_int64_t), value :: amplitude_len
         type(hbvib_jacobian_gap), intent(inout) :: out
         integer(c_int32_t) :: status
      end function hbvib_check_jacobian

      function hbvib_model_add_table(model, dof_a, dof_b, sector_offset, n, displacement, force, id) bind(c) result(status)
         import
         type(c_ptr), value :: model
         integer(c_int64_t), value :: dof_a, dof_b, sector_offset, n
         real(c_double), intent(in) :: displacement(*), force(*)
         integer(c_int64_t), intent(inout), optional :: id
         integer(c_int32_t) :: status
      end function hbvib_model_add_table

      function hbvib_model_add_spring_damper(model, dof_a, dof_b, sector_offset, n_spring, spring, n_damper, damper, &
         id) bind(c) result(status)
         import
         type(c_ptr), value :: model
         integer(c_int64_t), value :: dof_a, dof_b, sector_offset, n_spring
         real(c_double), intent(in), optional :: spring(*)
         integer(c_int64_t), value :: n_damper
         real(c_double), intent(in), optional :: damper(*)
         integer(c_int64_t), intent(inout), optional :: id
         integer(c_int32_t) :: status
      end function hbvib_model_add_spring_damper

      function hbvib_model_add_polynomial(model, dofs, n_dofs, n_terms, direction, coefficient, x_powers, v_powers, &
         id) bind(c) result(status)
         import
         type(c_ptr), value :: model
         integer(c_int64_t), intent(in) :: dofs(*)
         integer(c_int64_t), value :: n_dofs, n_terms
         integer(c_int64_t), intent(in) :: direction(*)
         real(c_double), intent(in) :: coefficient(*)
         integer(c_int32_t), intent(in), optional :: x_powers(*), v_powers(*)
         integer(c_int64_t), intent(inout), optional :: id
         integer(c_int32_t) :: status
      end function hbvib_model_add_polynomial

      function hbvib_model_add_stiffness_tensors(model, dofs, n, quadratic, cubic, id) bind(c) result(status)
         import
         type(c_ptr), value :: model
         integer(c_int64_t), intent(in) :: dofs(*)
         integer(c_int64_t), value :: n
         real(c_double), intent(in), optional :: quadratic(*), cubic(*)
         integer(c_int64_t), intent(inout), optional :: id
         integer(c_int32_t) :: status
      end function hbvib_model_add_stiffness_tensors

      function hbvib_model_add_patch(model, law, n, dof_a, dof_b, normal, tangent, area, pressure, gap, &
         first_id) bind(c) result(status)
         import
         type(c_ptr), value :: model
         type(hbvib_contact), intent(in) :: law
         integer(c_int64_t), value :: n
         integer(c_int64_t), intent(in) :: dof_a(*)
         integer(c_int64_t), intent(in), optional :: dof_b(*)
         real(c_double), intent(in) :: normal(*)
         real(c_double), intent(in), optional :: tangent(*)
         real(c_double), intent(in) :: area(*)
         real(c_double), intent(in), optional :: pressure(*), gap(*)
         integer(c_int64_t), intent(inout), optional :: first_id
         integer(c_int32_t) :: status
      end function hbvib_model_add_patch

      function hbvib_solver_options_init(o, size_of_o) bind(c) result(status)
         import
         type(hbvib_solver_options), intent(inout) :: o
         integer(c_size_t), value :: size_of_o
         integer(c_int32_t) :: status
      end function hbvib_solver_options_init

      function hbvib_forced_options_init(o, size_of_o) bind(c) result(status)
         import
         type(hbvib_forced_options), intent(inout) :: o
         integer(c_size_t), value :: size_of_o
         integer(c_int32_t) :: status
      end function hbvib_forced_options_init

      function hbvib_hooks_init(h, size_of_h) bind(c) result(status)
         import
         type(hbvib_hooks), intent(inout) :: h
         integer(c_size_t), value :: size_of_h
         integer(c_int32_t) :: status
      end function hbvib_hooks_init

      function hbvib_forced_response(model, solver, forced, hooks, out) bind(c) result(status)
         import
         type(c_ptr), value :: model
         type(hbvib_solver_options), intent(in), optional :: solver
         type(hbvib_forced_options), intent(in) :: forced
         type(hbvib_hooks), intent(in), optional :: hooks
         type(c_ptr), intent(inout) :: out
         integer(c_int32_t) :: status
      end function hbvib_forced_response

      function hbvib_mode_options_init(o, size_of_o) bind(c) result(status)
         import
         type(hbvib_mode_options), intent(inout) :: o
         integer(c_size_t), value :: size_of_o
         integer(c_int32_t) :: status
      end function hbvib_mode_options_init

      function hbvib_nonlinear_mode(model, solver, mode, hooks, out) bind(c) result(status)
         import
         type(c_ptr), value :: model
         type(hbvib_solver_options), intent(in), optional :: solver
         type(hbvib_mode_options), intent(in) :: mode
         type(hbvib_hooks), intent(in), optional :: hooks
         type(c_ptr), intent(inout) :: out
         integer(c_int32_t) :: status
      end function hbvib_nonlinear_mode

      function hbvib_view_init(v, size_of_v) bind(c) result(status)
         import
         type(hbvib_view), intent(inout) :: v
         integer(c_size_t), value :: size_of_v
         integer(c_int32_t) :: status
      end function hbvib_view_init

      function hbvib_reduction_init(r, size_of_r) bind(c) result(status)
         import
         type(hbvib_reduction), intent(inout) :: r
         integer(c_size_t), value :: size_of_r
         integer(c_int32_t) :: status
      end function hbvib_reduction_init

      function hbvib_branch_free(branch) bind(c) result(status)
         import
         type(c_ptr), value :: branch
         integer(c_int32_t) :: status
      end function hbvib_branch_free

      function hbvib_branch_points(branch) bind(c) result(answer)
         import
         type(c_ptr), value :: branch
         integer(c_int64_t) :: answer
      end function hbvib_branch_points

      function hbvib_branch_stored(branch) bind(c) result(answer)
         import
         type(c_ptr), value :: branch
         integer(c_int64_t) :: answer
      end function hbvib_branch_stored

      function hbvib_branch_status(branch) bind(c) result(status)
         import
         type(c_ptr), value :: branch
         integer(c_int32_t) :: status
      end function hbvib_branch_status

      function hbvib_branch_field(branch, field, out) bind(c) result(status)
         import
         type(c_ptr), value :: branch
         integer(c_int32_t), value :: field
         type(hbvib_view), intent(inout) :: out
         integer(c_int32_t) :: status
      end function hbvib_branch_field

      function hbvib_branch_harmonics(branch, point, first_dof, n_dof, x, x_len) bind(c) result(status)
         import
         type(c_ptr), value :: branch
         integer(c_int64_t), value :: point, first_dof, n_dof
         complex(c_double_complex), intent(inout) :: x(*)
         integer(c_int64_t), value :: x_len
         integer(c_int32_t) :: status
      end function hbvib_branch_harmonics

      function hbvib_branch_slip_fraction(branch, point, shares, shares_len) bind(c) result(status)
         import
         type(c_ptr), value :: branch
         integer(c_int64_t), value :: point
         real(c_double), intent(inout), optional :: shares(*)
         integer(c_int64_t), value :: shares_len
         integer(c_int32_t) :: status
      end function hbvib_branch_slip_fraction

      function hbvib_branch_reduction(branch, out) bind(c) result(status)
         import
         type(c_ptr), value :: branch
         type(hbvib_reduction), intent(inout) :: out
         integer(c_int32_t) :: status
      end function hbvib_branch_reduction

      function hbvib_branch_peaks(branch, capacity, omega, amplitude, point, count) bind(c) result(status)
         import
         type(c_ptr), value :: branch
         integer(c_int64_t), value :: capacity
         real(c_double), intent(inout), optional :: omega(*), amplitude(*)
         integer(c_int64_t), intent(inout), optional :: point(*)
         integer(c_int64_t), intent(inout) :: count
         integer(c_int32_t) :: status
      end function hbvib_branch_peaks

      function hbvib_branch_folds(branch, capacity, omega, amplitude, point, count) bind(c) result(status)
         import
         type(c_ptr), value :: branch
         integer(c_int64_t), value :: capacity
         real(c_double), intent(inout), optional :: omega(*), amplitude(*)
         integer(c_int64_t), intent(inout), optional :: point(*)
         integer(c_int64_t), intent(inout) :: count
         integer(c_int32_t) :: status
      end function hbvib_branch_folds

      function hbvib_branch_at(branch, wanted, capacity, amplitude, point, count) bind(c) result(status)
         import
         type(c_ptr), value :: branch
         integer(c_int64_t), value :: wanted, capacity
         real(c_double), intent(inout), optional :: amplitude(*)
         integer(c_int64_t), intent(inout), optional :: point(*)
         integer(c_int64_t), intent(inout) :: count
         integer(c_int32_t) :: status
      end function hbvib_branch_at

      function hbvib_energy_init(e, size_of_e) bind(c) result(status)
         import
         type(hbvib_energies), intent(inout) :: e
         integer(c_size_t), value :: size_of_e
         integer(c_int32_t) :: status
      end function hbvib_energy_init

      function hbvib_branch_energy(branch, point, out) bind(c) result(status)
         import
         type(c_ptr), value :: branch
         integer(c_int64_t), value :: point
         type(hbvib_energies), intent(inout) :: out
         integer(c_int32_t) :: status
      end function hbvib_branch_energy

      function hbvib_contact_summary_init(s, size_of_s) bind(c) result(status)
         import
         type(hbvib_contact_summary), intent(inout) :: s
         integer(c_size_t), value :: size_of_s
         integer(c_int32_t) :: status
      end function hbvib_contact_summary_init

      function hbvib_branch_time_history(branch, point, dof, n, x) bind(c) result(status)
         import
         type(c_ptr), value :: branch
         integer(c_int64_t), value :: point, dof, n
         real(c_double), intent(inout) :: x(*)
         integer(c_int32_t) :: status
      end function hbvib_branch_time_history

      function hbvib_branch_contact_loop(branch, point, contact, direction, n, motion, force, state) bind(c) result(status)
         import
         type(c_ptr), value :: branch
         integer(c_int64_t), value :: point, contact, direction, n
         real(c_double), intent(inout), optional :: motion(*), force(*)
         integer(c_int32_t), intent(inout), optional :: state(*)
         integer(c_int32_t) :: status
      end function hbvib_branch_contact_loop

      function hbvib_branch_contact_summary(branch, point, contact, out) bind(c) result(status)
         import
         type(c_ptr), value :: branch
         integer(c_int64_t), value :: point, contact
         type(hbvib_contact_summary), intent(inout) :: out
         integer(c_int32_t) :: status
      end function hbvib_branch_contact_summary

      function hbvib_mode_point_init(p, size_of_p) bind(c) result(status)
         import
         type(hbvib_mode_point), intent(inout) :: p
         integer(c_size_t), value :: size_of_p
         integer(c_int32_t) :: status
      end function hbvib_mode_point_init

      function hbvib_mode_info_init(i, size_of_i) bind(c) result(status)
         import
         type(hbvib_mode_info), intent(inout) :: i
         integer(c_size_t), value :: size_of_i
         integer(c_int32_t) :: status
      end function hbvib_mode_info_init

      function hbvib_branch_mode_point(branch, point, out) bind(c) result(status)
         import
         type(c_ptr), value :: branch
         integer(c_int64_t), value :: point
         type(hbvib_mode_point), intent(inout) :: out
         integer(c_int32_t) :: status
      end function hbvib_branch_mode_point

      function hbvib_branch_mode_info(branch, out) bind(c) result(status)
         import
         type(c_ptr), value :: branch
         type(hbvib_mode_info), intent(inout) :: out
         integer(c_int32_t) :: status
      end function hbvib_branch_mode_info

      function hbvib_synthesis_options_init(o, size_of_o) bind(c) result(status)
         import
         type(hbvib_synthesis_options), intent(inout) :: o
         integer(c_size_t), value :: size_of_o
         integer(c_int32_t) :: status
      end function hbvib_synthesis_options_init

      function hbvib_branch_synthesis(branch, model, options, capacity, omega, response, modal_amplitude, &
         count) bind(c) result(status)
         import
         type(c_ptr), value :: branch, model
         type(hbvib_synthesis_options), intent(in), optional :: options
         integer(c_int64_t), value :: capacity
         real(c_double), intent(inout), optional :: omega(*)
         complex(c_double_complex), intent(inout), optional :: response(*)
         real(c_double), intent(inout), optional :: modal_amplitude(*)
         integer(c_int64_t), intent(inout) :: count
         integer(c_int32_t) :: status
      end function hbvib_branch_synthesis

      function hbvib_branch_synthesis_peaks(branch, model, options, capacity, omega, amplitude, log10_amplitude, &
         damping_ratio, other_mode, flags, count) bind(c) result(status)
         import
         type(c_ptr), value :: branch, model
         type(hbvib_synthesis_options), intent(in), optional :: options
         integer(c_int64_t), value :: capacity
         real(c_double), intent(inout), optional :: omega(*), amplitude(*), log10_amplitude(*), damping_ratio(*), other_mode(*)
         integer(c_int32_t), intent(inout), optional :: flags(*)
         integer(c_int64_t), intent(inout) :: count
         integer(c_int32_t) :: status
      end function hbvib_branch_synthesis_peaks

      function hbvib_forced_residual(model, solver, omega, x, x_len, r, r_len, jac, jac_len, d_omega, &
         d_omega_len) bind(c) result(status)
         import
         type(c_ptr), value :: model
         type(hbvib_solver_options), intent(in), optional :: solver
         real(c_double), value :: omega
         complex(c_double_complex), intent(in) :: x(*)
         integer(c_int64_t), value :: x_len
         complex(c_double_complex), intent(inout) :: r(*)
         integer(c_int64_t), value :: r_len
         real(c_double), intent(inout), optional :: jac(*)
         integer(c_int64_t), value :: jac_len
         complex(c_double_complex), intent(inout), optional :: d_omega(*)
         integer(c_int64_t), value :: d_omega_len
         integer(c_int32_t) :: status
      end function hbvib_forced_residual

      function hbvib_time_options_init(o, size_of_o) bind(c) result(status)
         import
         type(hbvib_time_options), intent(inout) :: o
         integer(c_size_t), value :: size_of_o
         integer(c_int32_t) :: status
      end function hbvib_time_options_init

      function hbvib_time_info_init(i, size_of_i) bind(c) result(status)
         import
         type(hbvib_time_info), intent(inout) :: i
         integer(c_size_t), value :: size_of_i
         integer(c_int32_t) :: status
      end function hbvib_time_info_init

      function hbvib_time_response(model, options, hooks, harmonics, harmonics_len, samples, samples_len, &
         info) bind(c) result(status)
         import
         type(c_ptr), value :: model
         type(hbvib_time_options), intent(in) :: options
         type(hbvib_hooks), intent(in), optional :: hooks
         complex(c_double_complex), intent(inout), optional :: harmonics(*)
         integer(c_int64_t), value :: harmonics_len
         real(c_double), intent(inout), optional :: samples(*)
         integer(c_int64_t), value :: samples_len
         type(hbvib_time_info), intent(inout), optional :: info
         integer(c_int32_t) :: status
      end function hbvib_time_response

      function hbvib_verify_options_init(o, size_of_o) bind(c) result(status)
         import
         type(hbvib_verify_options), intent(inout) :: o
         integer(c_size_t), value :: size_of_o
         integer(c_int32_t) :: status
      end function hbvib_verify_options_init

      function hbvib_verification_init(v, size_of_v) bind(c) result(status)
         import
         type(hbvib_verification), intent(inout) :: v
         integer(c_size_t), value :: size_of_v
         integer(c_int32_t) :: status
      end function hbvib_verification_init

      function hbvib_verify(model, branch, point, options, hooks, harmonics, harmonics_len, errors, errors_len, &
         out) bind(c) result(status)
         import
         type(c_ptr), value :: model, branch
         integer(c_int64_t), value :: point
         type(hbvib_verify_options), intent(in), optional :: options
         type(hbvib_hooks), intent(in), optional :: hooks
         complex(c_double_complex), intent(inout), optional :: harmonics(*)
         integer(c_int64_t), value :: harmonics_len
         real(c_double), intent(inout), optional :: errors(*)
         integer(c_int64_t), value :: errors_len
         type(hbvib_verification), intent(inout), optional :: out
         integer(c_int32_t) :: status
      end function hbvib_verify
   end interface

   interface
      pure function strlen(text) bind(c) result(length)
         import
         type(c_ptr), value :: text
         integer(c_size_t) :: length
      end function strlen
   end interface

   private :: strlen, hooks_of, reach_1, reach_2, reach_3, to_zero, to_zero_all
   private :: same_length, struct_dofs, solver_from_one, made, model_new, model_clone, model_free, model_dofs
   private :: model_sectors, model_contacts, dense, address, dense_real, dense_complex, sparse, set, couple, set_real
   private :: set_sparse_real, couple_real, couple_sparse_real, set_complex, set_sparse_complex, couple_complex
   private :: couple_sparse_complex, set_struct, couple_struct, model_set_rayleigh, model_set_wave, add_force_complex
   private :: add_force_real, model_clear_forces, model_linear_modes, model_add_contact, model_set_preload
   private :: model_add_jenkins, model_add_springs, sides, model_add_iwan, model_add_table, model_add_spring_damper, side
   private :: model_add_polynomial, model_add_stiffness_tensors, all_of_length, model_add_patch, three_by
   private :: model_add_user_force, model_check_jacobian, model_forced_response, model_nonlinear_mode, model_time_response
   private :: model_forced_residual, branch_free, branch_points, branch_status, branch_stored, wanted_count, field_1, field_2
   private :: view_of, branch_harmonics, branch_harmonics_into, point_to_zero, branch_slip_fraction, branch_reduction
   private :: branch_peaks, branch_folds, branch_at, special, branch_energy, branch_time_history, branch_contact_loop
   private :: branch_contact_summary, contact_to_zero, branch_mode_point, branch_mode_info, branch_synthesis
   private :: branch_synthesis_peaks, model_verify
   real(c_double), target, save, private :: nothing_1(0), nothing_2(0, 0)

contains

   !> What is wrong, where, and what is accepted, after this thread's last call; empty after a success.
   function hbvib_error_text() result(text)
      character(:), allocatable :: text
      text = hbvib_text(hbvib_last_error())
   end function hbvib_error_text

   !> A text of C (hbvib_status_name, hbvib_version_string, a line of the log) as a character string.
   function hbvib_text(c_text) result(text)
      type(c_ptr), intent(in) :: c_text
      character(:), allocatable :: text
      character(kind=c_char), pointer :: letters(:)
      integer :: i
      text = ''
      if (.not. c_associated(c_text)) return
      call c_f_pointer(c_text, letters, [strlen(c_text)])
      text = repeat(' ', size(letters))
      do i = 1, size(letters)
         text(i:i) = letters(i)
      end do
   end function hbvib_text

   function hooks_of(progress, log, log_level, user, cancel) result(hooks)
      procedure(hbvib_progress_fn), optional :: progress
      procedure(hbvib_log_fn), optional :: log
      integer(i32), intent(in), optional :: log_level
      type(c_ptr), intent(in), optional :: user, cancel
      type(hbvib_hooks) :: hooks
      if (present(progress)) hooks%progress = c_funloc(progress)
      if (present(log)) hooks%log = c_funloc(log)
      if (present(log)) hooks%log_level = HBVIB_LOG_INFO
      if (present(log_level)) hooks%log_level = log_level
      if (present(user)) hooks%user = user
      if (present(cancel)) hooks%cancel = cancel
   end function hooks_of

   !> Arrays of a force call: u(i, j) is motion i at sample j, df_du(k, i, j) the derivative of force i by motion k there.
   !> What the call does not have (v without uses_velocity, z without states) is returned as a null pointer.
   subroutine hbvib_force_arrays(asked, u, v, f, df_du, df_dv, z0, z, df_dz, dz_dz, dz_du_before, dz_du, dz_dv_before, dz_dv, &
                                 dz_domega)
      type(hbvib_force_call), intent(in) :: asked
      real(dp), pointer, contiguous, intent(out), optional :: u(:, :), v(:, :), f(:, :), z0(:), z(:, :), dz_domega(:, :)
      real(dp), pointer, contiguous, intent(out), optional, dimension(:, :, :) :: df_du, df_dv, df_dz, dz_dz, dz_du_before, &
         dz_du, dz_dv_before, dz_dv
      associate (n => asked%n, s => asked%states, m => asked%samples)
         if (present(z0)) call reach_1(asked%z0, z0, s)
         if (present(u)) call reach_2(asked%u, u, n, m)
         if (present(v)) call reach_2(asked%v, v, n, m)
         if (present(f)) call reach_2(asked%f, f, n, m)
         if (present(z)) call reach_2(asked%z, z, s, m)
         if (present(dz_domega)) call reach_2(asked%dz_domega, dz_domega, s, m)
         if (present(df_du)) call reach_3(asked%df_du, df_du, n, n, m)
         if (present(df_dv)) call reach_3(asked%df_dv, df_dv, n, n, m)
         if (present(df_dz)) call reach_3(asked%df_dz, df_dz, s, n, m)
         if (present(dz_dz)) call reach_3(asked%dz_dz, dz_dz, s, s, m)
         if (present(dz_du_before)) call reach_3(asked%dz_du_before, dz_du_before, n, s, m)
         if (present(dz_du)) call reach_3(asked%dz_du, dz_du, n, s, m)
         if (present(dz_dv_before)) call reach_3(asked%dz_dv_before, dz_dv_before, n, s, m)
         if (present(dz_dv)) call reach_3(asked%dz_dv, dz_dv, n, s, m)
      end associate
   end subroutine hbvib_force_arrays

   subroutine reach_1(memory, x, n)
      type(c_ptr), intent(in) :: memory
      real(dp), pointer, contiguous, intent(out) :: x(:)
      integer(i64), intent(in) :: n
      nullify (x)
      if (c_associated(memory)) call c_f_pointer(memory, x, [n])
   end subroutine reach_1

   subroutine reach_2(memory, x, n, m)
      type(c_ptr), intent(in) :: memory
      real(dp), pointer, contiguous, intent(out) :: x(:, :)
      integer(i64), intent(in) :: n, m
      nullify (x)
      if (c_associated(memory)) call c_f_pointer(memory, x, [n, m])
   end subroutine reach_2

   subroutine reach_3(memory, x, n, m, l)
      type(c_ptr), intent(in) :: memory
      real(dp), pointer, contiguous, intent(out) :: x(:, :, :)
      integer(i64), intent(in) :: n, m, l
      nullify (x)
      if (c_associated(memory)) call c_f_pointer(memory, x, [n, m, l])
   end subroutine reach_3

   ! ---- Checks. Each does nothing where status tells of an earlier error, so that the first sentence is the one that stays. ----

   !> index counts from 1, zero from 0. count is that of a counting function: a negative one is its error. keep stays as it is.
   subroutine to_zero(status, name, index, count, zero, keep)
      integer(i32), intent(inout) :: status
      character(*), intent(in) :: name
      integer(i64), intent(in) :: index, count
      integer(i64), intent(inout) :: zero
      integer(i32), intent(in), optional :: keep
      if (status < HBVIB_OK) return
      if (count < 0) then
         status = int(count, i32)
         return
      end if
      if (present(keep)) then
         zero = index
         if (index == keep) return
      end if
      status = hbvib_index_from_one(name//c_null_char, index, count, zero)
   end subroutine to_zero

   subroutine to_zero_all(status, name, index, count, zero, keep)
      integer(i32), intent(inout) :: status
      character(*), intent(in) :: name
      integer, intent(in) :: index(:)
      integer(i64), intent(in) :: count
      integer(i64), allocatable, intent(out) :: zero(:)
      integer(i32), intent(in), optional :: keep
      character(24) :: entry
      integer :: i
      allocate (zero(size(index)), source=int(HBVIB_GROUND, i64))
      do i = 1, size(index)
         write (entry, '(a, i0, a)') '(', i, ')'
         call to_zero(status, name//trim(entry), int(index(i), i64), count, zero(i), keep)
      end do
   end subroutine to_zero_all

   !> Two lengths must agree; the sentence is that of the index which one of them does not have.
   subroutine same_length(status, name, given, needed)
      integer(i32), intent(inout) :: status
      character(*), intent(in) :: name
      integer(i64), intent(in) :: given, needed
      integer(i64) :: unused
      if (status < HBVIB_OK .or. given == needed) return
      if (needed < 0) then
         status = int(needed, i32)
         return
      end if
      status = hbvib_index_from_one('index of '//name//c_null_char, max(given, needed), min(given, needed), unused)
      status = HBVIB_E_DIMENSION
   end subroutine same_length

   !> Degrees of freedom of a contact description, from 1 to 0.
   subroutine struct_dofs(status, contact, ndof)
      integer(i32), intent(inout) :: status
      type(hbvib_contact), intent(inout) :: contact
      integer(i64), intent(in) :: ndof
      integer(i64) :: zero
      character(8) :: name
      integer :: side, i
      do side = 1, 2
         do i = 1, 3
            write (name, '(a, i0, a)') merge('dof_a(', 'dof_b(', side == 1), i, ')'
            if (side == 1) then
               call to_zero(status, name, contact%dof_a(i), ndof, zero, HBVIB_GROUND)
               if (status == HBVIB_OK) contact%dof_a(i) = zero
            else
               call to_zero(status, name, contact%dof_b(i), ndof, zero, HBVIB_GROUND)
               if (status == HBVIB_OK) contact%dof_b(i) = zero
            end if
         end do
      end do
   end subroutine struct_dofs

   !> Options with indices from 0; unallocated, and so absent to C, where none were given.
   subroutine solver_from_one(status, solver, ndof, asked)
      integer(i32), intent(inout) :: status
      type(hbvib_solver_options), intent(in), optional :: solver
      integer(i64), intent(in) :: ndof
      type(hbvib_solver_options), allocatable, intent(out) :: asked
      if (.not. present(solver)) return
      allocate (asked, source=solver)
      call to_zero(status, 'response_dof', solver%response_dof, ndof, asked%response_dof, -1_i32)
   end subroutine solver_from_one

   !> Status of an allocation.
   pure function made(stat) result(status)
      integer, intent(in) :: stat
      integer(i32) :: status
      status = merge(HBVIB_OK, HBVIB_E_OUT_OF_MEMORY, stat == 0)
   end function made

   ! ---- Models ----

   !> A plain structure of ndof degrees of freedom, or, with sectors, a cyclic one of ndof per sector.
   function model_new(self, ndof, sectors) result(status)
      class(hbvib_model), intent(inout) :: self
      integer, intent(in) :: ndof
      integer, intent(in), optional :: sectors
      integer(i32) :: status
      status = self%free()
      if (status == HBVIB_E_BUSY) return
      if (present(sectors)) then
         status = hbvib_cyclic_new(int(ndof, i64), int(sectors, i64), self%handle)
      else
         status = hbvib_model_new(int(ndof, i64), self%handle)
      end if
   end function model_new

   !> copy becomes a model of its own.
   function model_clone(self, copy) result(status)
      class(hbvib_model), intent(in) :: self
      type(hbvib_model), intent(inout) :: copy
      integer(i32) :: status
      type(c_ptr) :: made_now
      made_now = c_null_ptr
      status = hbvib_model_clone(self%handle, made_now)
      if (status /= HBVIB_OK) return
      if (.not. c_associated(copy%handle, self%handle)) status = copy%free()
      if (status == HBVIB_E_BUSY) then
         if (hbvib_model_free(made_now) == HBVIB_OK) status = HBVIB_E_BUSY
         return
      end if
      copy%handle = made_now
      status = HBVIB_OK
   end function model_clone

   !> Branches solved from the model stay. Freeing an empty variable is a success.
   function model_free(self) result(status)
      class(hbvib_model), intent(inout) :: self
      integer(i32) :: status
      status = hbvib_model_free(self%handle)
      if (status /= HBVIB_E_BUSY) self%handle = c_null_ptr
   end function model_free

   !> Degrees of freedom (of one sector), or a negative status.
   function model_dofs(self) result(count)
      class(hbvib_model), intent(in) :: self
      integer :: count
      count = int(hbvib_model_dofs(self%handle))
   end function model_dofs

   !> Sectors, 1 of a plain structure, or a negative status.
   function model_sectors(self) result(count)
      class(hbvib_model), intent(in) :: self
      integer :: count
      count = int(hbvib_model_sectors(self%handle))
   end function model_sectors

   !> Contacts, or a negative status.
   function model_contacts(self) result(count)
      class(hbvib_model), intent(in) :: self
      integer :: count
      count = int(hbvib_model_contacts(self%handle))
   end function model_contacts

   !> A dense description without numbers.
   pure function dense(shape, part) result(a)
      integer, intent(in) :: shape(2)
      integer(i32), intent(in), optional :: part
      type(hbvib_matrix) :: a
      a%rows = shape(1)
      a%cols = shape(2)
      if (present(part)) a%part = part
   end function dense

   pure function address(pointer) result(number)
      type(c_ptr), intent(in) :: pointer
      integer(c_intptr_t) :: number
      number = transfer(pointer, number)
   end function address

   !> The numbers where they lie, sections of a larger array included, or, where a column has gaps, a copy of them in kept.
   subroutine dense_real(values, part, kept, a)
      real(dp), intent(in), target :: values(:, :)
      integer(i32), intent(in), optional :: part
      real(dp), allocatable, target, intent(out) :: kept(:, :)
      type(hbvib_matrix), intent(out) :: a
      integer(c_intptr_t) :: width, row, column
      a = dense(shape(values), part)
      a%scalar = HBVIB_REAL
      if (size(values) == 0) return
      width = storage_size(values)/8
      row = width
      column = width*size(values, 1)
      if (size(values, 1) > 1) row = address(c_loc(values(2, 1))) - address(c_loc(values(1, 1)))
      if (size(values, 2) > 1) column = address(c_loc(values(1, 2))) - address(c_loc(values(1, 1)))
      if (row == width .and. column >= width*size(values, 1) .and. mod(column, width) == 0) then
         a%values = c_loc(values(1, 1))
         a%ld = column/width
      else
         kept = values
         a%values = c_loc(kept)
      end if
   end subroutine dense_real

   subroutine dense_complex(values, part, kept, a)
      complex(dp), intent(in), target :: values(:, :)
      integer(i32), intent(in), optional :: part
      complex(dp), allocatable, target, intent(out) :: kept(:, :)
      type(hbvib_matrix), intent(out) :: a
      integer(c_intptr_t) :: width, row, column
      a = dense(shape(values), part)
      a%scalar = HBVIB_COMPLEX
      if (size(values) == 0) return
      width = storage_size(values)/8
      row = width
      column = width*size(values, 1)
      if (size(values, 1) > 1) row = address(c_loc(values(2, 1))) - address(c_loc(values(1, 1)))
      if (size(values, 2) > 1) column = address(c_loc(values(1, 2))) - address(c_loc(values(1, 1)))
      if (row == width .and. column >= width*size(values, 1) .and. mod(column, width) == 0) then
         a%values = c_loc(values(1, 1))
         a%ld = column/width
      else
         kept = values
         a%values = c_loc(kept)
      end if
   end subroutine dense_complex

   !> Sparse square columns: col_ptr(n + 1) and row_idx count from 1.
   subroutine sparse(status, col_ptr, row_idx, values, part, a)
      integer(i32), intent(inout) :: status
      integer(i64), intent(in), contiguous, target :: col_ptr(:), row_idx(:)
      integer(i64), intent(in) :: values
      integer(i32), intent(in), optional :: part
      type(hbvib_matrix), intent(out) :: a
      integer(i64) :: unused
      a = dense([size(col_ptr) - 1, size(col_ptr) - 1], part)
      a%storage = HBVIB_CSC
      if (size(col_ptr) == 0) return
      call to_zero(status, 'col_ptr(1)', col_ptr(1), 1_i64, unused)
      call same_length(status, 'row_idx', size(row_idx, kind=i64), col_ptr(size(col_ptr)) - 1)
      call same_length(status, 'values', values, col_ptr(size(col_ptr)) - 1)
      a%col_ptr = c_loc(col_ptr)
      if (size(row_idx) > 0) a%row_idx = c_loc(row_idx)
   end subroutine sparse

   function set(self, status, which, a, diameter) result(outcome)
      class(hbvib_model), intent(inout) :: self
      integer(i32), intent(in) :: status, which
      type(hbvib_matrix), intent(in) :: a
      integer, intent(in), optional :: diameter
      integer(i32) :: outcome
      outcome = status
      if (status /= HBVIB_OK) return
      if (present(diameter)) then
         outcome = hbvib_cyclic_set_diameter(self%handle, which, int(diameter, i64), a)
      else
         outcome = hbvib_model_set_matrix(self%handle, which, a)
      end if
   end function set

   function couple(self, status, which, a, previous) result(outcome)
      class(hbvib_model), intent(inout) :: self
      integer(i32), intent(in) :: status, which
      type(hbvib_matrix), intent(in) :: a
      logical, intent(in), optional :: previous
      integer(i32) :: outcome
      logical :: backwards
      outcome = status
      if (status /= HBVIB_OK) return
      backwards = .false.
      if (present(previous)) backwards = previous
      if (backwards) then
         outcome = hbvib_cyclic_set_coupling_previous(self%handle, which, a)
      else
         outcome = hbvib_cyclic_set_coupling(self%handle, which, a)
      end if
   end function couple

   ! model%set_matrix(which, a, part, diameter) with a(ndof, ndof) real or complex, part HBVIB_FULL by default; with diameter the
   ! matrix of that wave. Sparse: model%set_matrix(which, col_ptr, row_idx, values, part, diameter), integer(c_int64_t) indices
   ! from 1. model%set_coupling likewise: the coupling of a sector (rows) to the next one (columns), or to the previous one.

   function set_real(self, which, a, part, diameter) result(status)
      class(hbvib_model), intent(inout) :: self
      integer(i32), intent(in) :: which
      real(dp), intent(in), target :: a(:, :)
      integer(i32), intent(in), optional :: part
      integer, intent(in), optional :: diameter
      integer(i32) :: status
      real(dp), allocatable, target :: kept(:, :)
      type(hbvib_matrix) :: matrix
      call dense_real(a, part, kept, matrix)
      status = set(self, HBVIB_OK, which, matrix, diameter)
   end function set_real

   function set_sparse_real(self, which, col_ptr, row_idx, values, part, diameter) result(status)
      class(hbvib_model), intent(inout) :: self
      integer(i32), intent(in) :: which
      integer(i64), intent(in), contiguous, target :: col_ptr(:), row_idx(:)
      real(dp), intent(in), contiguous, target :: values(:)
      integer(i32), intent(in), optional :: part
      integer, intent(in), optional :: diameter
      integer(i32) :: status
      type(hbvib_matrix) :: matrix
      status = HBVIB_OK
      call sparse(status, col_ptr, row_idx, size(values, kind=i64), part, matrix)
      matrix%scalar = HBVIB_REAL
      if (size(values) > 0) matrix%values = c_loc(values)
      status = set(self, status, which, matrix, diameter)
   end function set_sparse_real

   function couple_real(self, which, a, part, previous) result(status)
      class(hbvib_model), intent(inout) :: self
      integer(i32), intent(in) :: which
      real(dp), intent(in), target :: a(:, :)
      integer(i32), intent(in), optional :: part
      logical, intent(in), optional :: previous
      integer(i32) :: status
      real(dp), allocatable, target :: kept(:, :)
      type(hbvib_matrix) :: matrix
      call dense_real(a, part, kept, matrix)
      status = couple(self, HBVIB_OK, which, matrix, previous)
   end function couple_real

   function couple_sparse_real(self, which, col_ptr, row_idx, values, part, previous) result(status)
      class(hbvib_model), intent(inout) :: self
      integer(i32), intent(in) :: which
      integer(i64), intent(in), contiguous, target :: col_ptr(:), row_idx(:)
      real(dp), intent(in), contiguous, target :: values(:)
      integer(i32), intent(in), optional :: part
      logical, intent(in), optional :: previous
      integer(i32) :: status
      type(hbvib_matrix) :: matrix
      status = HBVIB_OK
      call sparse(status, col_ptr, row_idx, size(values, kind=i64), part, matrix)
      matrix%scalar = HBVIB_REAL
      if (size(values) > 0) matrix%values = c_loc(values)
      status = couple(self, status, which, matrix, previous)
   end function couple_sparse_real

   function set_complex(self, which, a, part, diameter) result(status)
      class(hbvib_model), intent(inout) :: self
      integer(i32), intent(in) :: which
      complex(dp), intent(in), target :: a(:, :)
      integer(i32), intent(in), optional :: part
      integer, intent(in), optional :: diameter
      integer(i32) :: status
      complex(dp), allocatable, target :: kept(:, :)
      type(hbvib_matrix) :: matrix
      call dense_complex(a, part, kept, matrix)
      status = set(self, HBVIB_OK, which, matrix, diameter)
   end function set_complex

   function set_sparse_complex(self, which, col_ptr, row_idx, values, part, diameter) result(status)
      class(hbvib_model), intent(inout) :: self
      integer(i32), intent(in) :: which
      integer(i64), intent(in), contiguous, target :: col_ptr(:), row_idx(:)
      complex(dp), intent(in), contiguous, target :: values(:)
      integer(i32), intent(in), optional :: part
      integer, intent(in), optional :: diameter
      integer(i32) :: status
      type(hbvib_matrix) :: matrix
      status = HBVIB_OK
      call sparse(status, col_ptr, row_idx, size(values, kind=i64), part, matrix)
      matrix%scalar = HBVIB_COMPLEX
      if (size(values) > 0) matrix%values = c_loc(values)
      status = set(self, status, which, matrix, diameter)
   end function set_sparse_complex

   function couple_complex(self, which, a, part, previous) result(status)
      class(hbvib_model), intent(inout) :: self
      integer(i32), intent(in) :: which
      complex(dp), intent(in), target :: a(:, :)
      integer(i32), intent(in), optional :: part
      logical, intent(in), optional :: previous
      integer(i32) :: status
      complex(dp), allocatable, target :: kept(:, :)
      type(hbvib_matrix) :: matrix
      call dense_complex(a, part, kept, matrix)
      status = couple(self, HBVIB_OK, which, matrix, previous)
   end function couple_complex

   function couple_sparse_complex(self, which, col_ptr, row_idx, values, part, previous) result(status)
      class(hbvib_model), intent(inout) :: self
      integer(i32), intent(in) :: which
      integer(i64), intent(in), contiguous, target :: col_ptr(:), row_idx(:)
      complex(dp), intent(in), contiguous, target :: values(:)
      integer(i32), intent(in), optional :: part
      logical, intent(in), optional :: previous
      integer(i32) :: status
      type(hbvib_matrix) :: matrix
      status = HBVIB_OK
      call sparse(status, col_ptr, row_idx, size(values, kind=i64), part, matrix)
      matrix%scalar = HBVIB_COMPLEX
      if (size(values) > 0) matrix%values = c_loc(values)
      status = couple(self, status, which, matrix, previous)
   end function couple_sparse_complex

   !> A matrix described as in C: the pointers of a must have targets.
   function set_struct(self, which, a, diameter) result(status)
      class(hbvib_model), intent(inout) :: self
      integer(i32), intent(in) :: which
      type(hbvib_matrix), intent(in) :: a
      integer, intent(in), optional :: diameter
      integer(i32) :: status
      status = set(self, HBVIB_OK, which, a, diameter)
   end function set_struct

   function couple_struct(self, which, a, previous) result(status)
      class(hbvib_model), intent(inout) :: self
      integer(i32), intent(in) :: which
      type(hbvib_matrix), intent(in) :: a
      logical, intent(in), optional :: previous
      integer(i32) :: status
      status = couple(self, HBVIB_OK, which, a, previous)
   end function couple_struct

   !> Adds alpha_mass * M + beta_stiffness * K to the damping.
   function model_set_rayleigh(self, alpha_mass, beta_stiffness) result(status)
      class(hbvib_model), intent(inout) :: self
      real(dp), intent(in) :: alpha_mass, beta_stiffness
      integer(i32) :: status
      status = hbvib_model_set_rayleigh(self%handle, alpha_mass, beta_stiffness)
   end function model_set_rayleigh

   !> Engine order of the excitation.
   function model_set_wave(self, engine_order) result(status)
      class(hbvib_model), intent(inout) :: self
      integer, intent(in) :: engine_order
      integer(i32) :: status
      status = hbvib_cyclic_set_wave(self%handle, int(engine_order, i64))
   end function model_set_wave

   !> Adds the force Re(force * exp(i harmonic omega t)), force real or complex, double precision: (5d0, 0d0).
   function add_force_complex(self, dof, harmonic, force) result(status)
      class(hbvib_model), intent(inout) :: self
      integer, intent(in) :: dof, harmonic
      complex(dp), intent(in) :: force
      integer(i32) :: status
      integer(i64) :: zero
      status = HBVIB_OK
      call to_zero(status, 'dof', int(dof, i64), hbvib_model_dofs(self%handle), zero)
      if (status == HBVIB_OK) status = hbvib_model_add_force(self%handle, zero, int(harmonic, i64), real(force), aimag(force))
   end function add_force_complex

   function add_force_real(self, dof, harmonic, force) result(status)
      class(hbvib_model), intent(inout) :: self
      integer, intent(in) :: dof, harmonic
      real(dp), intent(in) :: force
      integer(i32) :: status
      status = add_force_complex(self, dof, harmonic, cmplx(force, 0, dp))
   end function add_force_real

   function model_clear_forces(self) result(status)
      class(hbvib_model), intent(inout) :: self
      integer(i32) :: status
      status = hbvib_model_clear_forces(self%handle)
   end function model_clear_forces

   !> Undamped natural modes: the lowest size(omega) of them, shapes(ndof, size(omega)). contacts: HBVIB_CONTACTS_STUCK (default) or
   !> HBVIB_CONTACTS_FREE. diameter: default 0.
   function model_linear_modes(self, omega, shapes, diameter, contacts) result(status)
      class(hbvib_model), intent(in) :: self
      real(dp), intent(inout), contiguous :: omega(:)
      complex(dp), intent(inout), contiguous, optional :: shapes(:, :)
      integer, intent(in), optional :: diameter
      integer(i32), intent(in), optional :: contacts
      integer(i32) :: status, state
      integer(i64) :: d
      status = HBVIB_OK
      d = 0
      state = HBVIB_CONTACTS_STUCK
      if (present(diameter)) d = diameter
      if (present(contacts)) state = contacts
      if (present(shapes)) then
         call same_length(status, 'shapes(:, 1)', size(shapes, 1, i64), hbvib_model_dofs(self%handle))
         call same_length(status, 'shapes(1, :)', size(shapes, 2, i64), size(omega, kind=i64))
      end if
      if (status == HBVIB_OK) status = hbvib_linear_modes(self%handle, d, state, size(omega, kind=i64), omega, shapes)
   end function model_linear_modes

   !> id receives the number of the contact, from 1.
   function model_add_contact(self, contact, id) result(status)
      class(hbvib_model), intent(inout) :: self
      type(hbvib_contact), intent(in) :: contact
      integer, intent(inout), optional :: id
      integer(i32) :: status
      type(hbvib_contact) :: c
      integer(i64) :: zero
      status = HBVIB_OK
      c = contact
      call struct_dofs(status, c, hbvib_model_dofs(self%handle))
      if (status == HBVIB_OK) status = hbvib_model_add_contact(self%handle, c, zero)
      if (status == HBVIB_OK .and. present(id)) id = int(zero) + 1
   end function model_add_contact

   function model_set_preload(self, id, preload) result(status)
      class(hbvib_model), intent(inout) :: self
      integer, intent(in) :: id
      real(dp), intent(in) :: preload
      integer(i32) :: status
      integer(i64) :: zero
      status = HBVIB_OK
      call to_zero(status, 'id', int(id, i64), hbvib_model_contacts(self%handle), zero)
      if (status == HBVIB_OK) status = hbvib_model_set_preload(self%handle, zero, preload)
   end function model_set_preload

   !> Many Jenkins contacts, all arrays of one length. dof_b absent: the ground; sector_offset absent: 0.
   function model_add_jenkins(self, dof_a, kt, mu, preload, dof_b, sector_offset, first_id) result(status)
      class(hbvib_model), intent(inout) :: self
      integer, intent(in) :: dof_a(:)
      real(dp), intent(in), contiguous :: kt(:), mu(:), preload(:)
      integer, intent(in), optional :: dof_b(:), sector_offset(:)
      integer, intent(inout), optional :: first_id
      integer(i32) :: status
      integer(i64) :: n, first
      integer(i64), allocatable :: a(:), b(:), offset(:)
      n = size(dof_a)
      status = HBVIB_OK
      call same_length(status, 'kt', size(kt, kind=i64), n)
      call same_length(status, 'mu', size(mu, kind=i64), n)
      call same_length(status, 'preload', size(preload, kind=i64), n)
      call sides(self, status, dof_a, dof_b, sector_offset, a, b, offset)
      if (status == HBVIB_OK) status = hbvib_model_add_jenkins(self%handle, n, a, b, offset, kt, mu, preload, first)
      if (status == HBVIB_OK .and. present(first_id)) first_id = int(first) + 1
   end function model_add_jenkins

   !> Many linear springs likewise.
   function model_add_springs(self, dof_a, stiffness, dof_b, sector_offset) result(status)
      class(hbvib_model), intent(inout) :: self
      integer, intent(in) :: dof_a(:)
      real(dp), intent(in), contiguous :: stiffness(:)
      integer, intent(in), optional :: dof_b(:), sector_offset(:)
      integer(i32) :: status
      integer(i64), allocatable :: a(:), b(:), offset(:)
      status = HBVIB_OK
      call same_length(status, 'stiffness', size(stiffness, kind=i64), size(dof_a, kind=i64))
      call sides(self, status, dof_a, dof_b, sector_offset, a, b, offset)
      if (status == HBVIB_OK) &
         status = hbvib_model_add_springs(self%handle, size(a, kind=i64), a, b, offset, stiffness)
   end function model_add_springs

   !> Both sides of many contacts, from 0; offset stays unallocated, and so absent to C, where it was not given.
   subroutine sides(self, status, dof_a, dof_b, sector_offset, a, b, offset)
      class(hbvib_model), intent(in) :: self
      integer(i32), intent(inout) :: status
      integer, intent(in) :: dof_a(:)
      integer, intent(in), optional :: dof_b(:), sector_offset(:)
      integer(i64), allocatable, intent(out) :: a(:), b(:), offset(:)
      integer(i64) :: ndof
      if (present(dof_b)) call same_length(status, 'dof_b', size(dof_b, kind=i64), size(dof_a, kind=i64))
      if (present(sector_offset)) &
         call same_length(status, 'sector_offset', size(sector_offset, kind=i64), size(dof_a, kind=i64))
      if (status /= HBVIB_OK) return
      ndof = hbvib_model_dofs(self%handle)
      call to_zero_all(status, 'dof_a', dof_a, ndof, a, HBVIB_GROUND)
      allocate (b(size(a)), source=int(HBVIB_GROUND, i64))
      if (present(dof_b)) call to_zero_all(status, 'dof_b', dof_b, ndof, b, HBVIB_GROUND)
      if (present(sector_offset)) offset = int(sector_offset, i64)
   end subroutine sides

   !> An Iwan joint of `elements` Jenkins contacts; first_id is the first of them.
   function model_add_iwan(self, dof_a, dof_b, slip_force, stiffness, chi, beta, elements, sector_offset, first_id) result(status)
      class(hbvib_model), intent(inout) :: self
      integer, intent(in) :: dof_a, dof_b, elements
      real(dp), intent(in) :: slip_force, stiffness, chi, beta
      integer, intent(in), optional :: sector_offset
      integer, intent(inout), optional :: first_id
      integer(i32) :: status
      integer(i64) :: a, b, offset, first
      call side(self, status, dof_a, dof_b, sector_offset, a, b, offset)
      if (status == HBVIB_OK) status = hbvib_model_add_iwan(self%handle, a, b, offset, slip_force, stiffness, chi, beta, &
                                                            int(elements, i64), first)
      if (status == HBVIB_OK .and. present(first_id)) first_id = int(first) + 1
   end function model_add_iwan

   !> A spring straight between the points (displacement(i), force(i)).
   function model_add_table(self, dof_a, dof_b, displacement, force, sector_offset, id) result(status)
      class(hbvib_model), intent(inout) :: self
      integer, intent(in) :: dof_a, dof_b
      real(dp), intent(in), contiguous :: displacement(:), force(:)
      integer, intent(in), optional :: sector_offset
      integer, intent(inout), optional :: id
      integer(i32) :: status
      integer(i64) :: a, b, offset, zero
      call side(self, status, dof_a, dof_b, sector_offset, a, b, offset)
      call same_length(status, 'force', size(force, kind=i64), size(displacement, kind=i64))
      if (status == HBVIB_OK) &
         status = hbvib_model_add_table(self%handle, a, b, offset, size(force, kind=i64), displacement, force, zero)
      if (status == HBVIB_OK .and. present(id)) id = int(zero) + 1
   end function model_add_table

   !> f = sum spring(k) y**k + sum damper(k) v**k. Not both may be absent.
   function model_add_spring_damper(self, dof_a, dof_b, spring, damper, sector_offset, id) result(status)
      class(hbvib_model), intent(inout) :: self
      integer, intent(in) :: dof_a, dof_b
      real(dp), intent(in), contiguous, optional :: spring(:), damper(:)
      integer, intent(in), optional :: sector_offset
      integer, intent(inout), optional :: id
      integer(i32) :: status
      integer(i64) :: a, b, offset, zero, n_spring, n_damper
      n_spring = 0
      n_damper = 0
      if (present(spring)) n_spring = size(spring)
      if (present(damper)) n_damper = size(damper)
      call side(self, status, dof_a, dof_b, sector_offset, a, b, offset)
      if (status == HBVIB_OK) &
         status = hbvib_model_add_spring_damper(self%handle, a, b, offset, n_spring, spring, n_damper, damper, zero)
      if (status == HBVIB_OK .and. present(id)) id = int(zero) + 1
   end function model_add_spring_damper

   !> Both sides of one contact, from 0.
   subroutine side(self, status, dof_a, dof_b, sector_offset, a, b, offset)
      class(hbvib_model), intent(in) :: self
      integer(i32), intent(out) :: status
      integer, intent(in) :: dof_a, dof_b
      integer, intent(in), optional :: sector_offset
      integer(i64), intent(out) :: a, b, offset
      integer(i64) :: ndof
      status = HBVIB_OK
      offset = 0
      if (present(sector_offset)) offset = sector_offset
      ndof = hbvib_model_dofs(self%handle)
      call to_zero(status, 'dof_a', int(dof_a, i64), ndof, a, HBVIB_GROUND)
      call to_zero(status, 'dof_b', int(dof_b, i64), ndof, b, HBVIB_GROUND)
   end subroutine side

   !> Term t adds coefficient(t) * product of x_j**x_powers(j, t) * product of v_j**v_powers(j, t) to the force on
   !> dofs(direction(t)). Powers are (size(dofs), terms); absent: all 0.
   function model_add_polynomial(self, dofs, direction, coefficient, x_powers, v_powers, id) result(status)
      class(hbvib_model), intent(inout) :: self
      integer, intent(in) :: dofs(:), direction(:)
      real(dp), intent(in), contiguous :: coefficient(:)
      integer, intent(in), optional :: x_powers(:, :), v_powers(:, :)
      integer, intent(inout), optional :: id
      integer(i32) :: status
      integer(i64) :: zero, n, terms
      integer(i64), allocatable :: d(:), along(:)
      integer(i32), allocatable :: x(:, :), v(:, :)
      status = HBVIB_OK
      n = size(dofs)
      terms = size(direction)
      call to_zero_all(status, 'dofs', dofs, hbvib_model_dofs(self%handle), d)
      call to_zero_all(status, 'direction', direction, n, along)
      call same_length(status, 'coefficient', size(coefficient, kind=i64), terms)
      if (present(x_powers)) then
         allocate (x, source=int(x_powers, i32))
         call same_length(status, 'x_powers(:, 1)', size(x, 1, i64), n)
         call same_length(status, 'x_powers(1, :)', size(x, 2, i64), terms)
      end if
      if (present(v_powers)) then
         allocate (v, source=int(v_powers, i32))
         call same_length(status, 'v_powers(:, 1)', size(v, 1, i64), n)
         call same_length(status, 'v_powers(1, :)', size(v, 2, i64), terms)
      end if
      if (status == HBVIB_OK) &
         status = hbvib_model_add_polynomial(self%handle, d, n, terms, along, coefficient, x, v, zero)
      if (status == HBVIB_OK .and. present(id)) id = int(zero) + 1
   end function model_add_polynomial

   !> f(i) = sum quadratic(k, j, i) x_j x_k + sum cubic(l, k, j, i) x_j x_k x_l on dofs(i). Not both may be absent.
   function model_add_stiffness_tensors(self, dofs, quadratic, cubic, id) result(status)
      class(hbvib_model), intent(inout) :: self
      integer, intent(in) :: dofs(:)
      real(dp), intent(in), contiguous, optional :: quadratic(:, :, :), cubic(:, :, :, :)
      integer, intent(inout), optional :: id
      integer(i32) :: status
      integer(i64) :: zero, n
      integer(i64), allocatable :: d(:)
      status = HBVIB_OK
      n = size(dofs)
      call to_zero_all(status, 'dofs', dofs, hbvib_model_dofs(self%handle), d)
      if (present(quadratic)) call all_of_length(status, 'quadratic', shape(quadratic), n)
      if (present(cubic)) call all_of_length(status, 'cubic', shape(cubic), n)
      if (status == HBVIB_OK) status = hbvib_model_add_stiffness_tensors(self%handle, d, n, quadratic, cubic, zero)
      if (status == HBVIB_OK .and. present(id)) id = int(zero) + 1
   end function model_add_stiffness_tensors

   subroutine all_of_length(status, name, lengths, needed)
      integer(i32), intent(inout) :: status
      character(*), intent(in) :: name
      integer, intent(in) :: lengths(:)
      integer(i64), intent(in) :: needed
      integer :: i
      do i = 1, size(lengths)
         call same_length(status, name, int(lengths(i), i64), needed)
      end do
   end subroutine all_of_length

   !> Contacts of n node pairs: dof_a, dof_b, normal and tangent (3, n); area, pressure and gap (n). dof_b absent: the ground.
   function model_add_patch(self, law, dof_a, normal, area, dof_b, tangent, pressure, gap, first_id) result(status)
      class(hbvib_model), intent(inout) :: self
      type(hbvib_contact), intent(in) :: law
      integer, intent(in) :: dof_a(:, :)
      real(dp), intent(in), contiguous :: normal(:, :), area(:)
      integer, intent(in), optional :: dof_b(:, :)
      real(dp), intent(in), contiguous, optional :: tangent(:, :), pressure(:), gap(:)
      integer, intent(inout), optional :: first_id
      integer(i32) :: status
      integer(i64) :: n, ndof, first
      integer(i64), allocatable :: a(:), b(:)
      status = HBVIB_OK
      n = size(area)
      call three_by(status, 'dof_a', shape(dof_a), n)
      call three_by(status, 'normal', shape(normal), n)
      if (present(dof_b)) call three_by(status, 'dof_b', shape(dof_b), n)
      if (present(tangent)) call three_by(status, 'tangent', shape(tangent), n)
      if (present(pressure)) call same_length(status, 'pressure', size(pressure, kind=i64), n)
      if (present(gap)) call same_length(status, 'gap', size(gap, kind=i64), n)
      if (status /= HBVIB_OK) return
      ndof = hbvib_model_dofs(self%handle)
      call to_zero_all(status, 'dof_a', reshape(dof_a, [size(dof_a)]), ndof, a, HBVIB_GROUND)
      if (present(dof_b)) call to_zero_all(status, 'dof_b', reshape(dof_b, [size(dof_b)]), ndof, b, HBVIB_GROUND)
      if (status == HBVIB_OK) &
         status = hbvib_model_add_patch(self%handle, law, n, a, b, normal, tangent, area, pressure, gap, first)
      if (status == HBVIB_OK .and. present(first_id)) first_id = int(first) + 1
   end function model_add_patch

   subroutine three_by(status, name, lengths, n)
      integer(i32), intent(inout) :: status
      character(*), intent(in) :: name
      integer, intent(in) :: lengths(2)
      integer(i64), intent(in) :: n
      call same_length(status, name//'(:, 1)', int(lengths(1), i64), 3_i64)
      call same_length(status, name//'(1, :)', int(lengths(2), i64), n)
   end subroutine three_by

   !> A force of the caller on dofs. force, a module procedure, and user's target must outlive model, clones and branches.
   function model_add_user_force(self, force, dofs, user, states, samples, uses_velocity, is_odd, id) result(status)
      class(hbvib_model), intent(inout) :: self
      procedure(hbvib_force_fn) :: force
      integer, intent(in) :: dofs(:)
      type(c_ptr), intent(in), optional :: user
      integer, intent(in), optional :: states, samples
      logical, intent(in), optional :: uses_velocity, is_odd
      integer, intent(inout), optional :: id
      integer(i32) :: status
      type(hbvib_user_force) :: o
      integer(i64), allocatable, target :: d(:)
      integer(i64) :: zero
      status = HBVIB_OK
      call to_zero_all(status, 'dofs', dofs, hbvib_model_dofs(self%handle), d)
      if (status /= HBVIB_OK) return
      if (size(d) > 0) o%dofs = c_loc(d)
      o%n = size(d)
      o%force = c_funloc(force)
      if (present(user)) o%user = user
      if (present(states)) o%states = states
      if (present(samples)) o%samples = samples
      if (present(uses_velocity)) o%uses_velocity = merge(1_i32, 0_i32, uses_velocity)
      if (present(is_odd)) o%is_odd = merge(1_i32, 0_i32, is_odd)
      status = hbvib_model_add_user_force(self%handle, o, zero)
      if (status == HBVIB_OK .and. present(id)) id = int(zero) + 1
   end function model_add_user_force

   !> Worst derivative of force `contact` at motions of about amplitude(n); sample, row and column of gap count from 1.
   function model_check_jacobian(self, contact, omega, amplitude, gap) result(status)
      class(hbvib_model), intent(in) :: self
      integer, intent(in) :: contact
      real(dp), intent(in) :: omega
      real(dp), intent(in), contiguous :: amplitude(:)
      type(hbvib_jacobian_gap), intent(out) :: gap
      integer(i32) :: status
      integer(i64) :: zero
      status = HBVIB_OK
      call to_zero(status, 'contact', int(contact, i64), hbvib_model_contacts(self%handle), zero)
      if (status == HBVIB_OK) &
         status = hbvib_check_jacobian(self%handle, zero, omega, amplitude, size(amplitude, kind=i64), gap)
      if (status /= HBVIB_OK) return
      gap%sample = gap%sample + 1
      gap%row = gap%row + 1
      gap%column = gap%column + 1
   end function model_check_jacobian

   !> Periodic response over omega_start .. omega_stop. at: frequencies wanted exactly. guess(ndof, 0:H): start values.
   function model_forced_response(self, branch, omega_start, omega_stop, solver, hooks, at, guess) result(status)
      class(hbvib_model), intent(in) :: self
      type(hbvib_branch), intent(inout) :: branch
      real(dp), intent(in) :: omega_start, omega_stop
      type(hbvib_solver_options), intent(in), optional :: solver
      type(hbvib_hooks), intent(in), optional :: hooks
      real(dp), intent(in), contiguous, target, optional :: at(:)
      complex(dp), intent(in), contiguous, target, optional :: guess(:, :)
      integer(i32) :: status
      type(hbvib_forced_options) :: forced
      type(hbvib_solver_options), allocatable :: asked
      integer(i64) :: ndof
      status = branch%free()
      if (status == HBVIB_E_BUSY) return
      status = HBVIB_OK
      ndof = hbvib_model_dofs(self%handle)
      call solver_from_one(status, solver, ndof, asked)
      forced%omega_start = omega_start
      forced%omega_stop = omega_stop
      if (present(at)) then
         forced%at_len = size(at)
         if (size(at) > 0) forced%at = c_loc(at)
      end if
      if (present(guess)) then
         call same_length(status, 'guess(:, 0)', size(guess, 1, i64), ndof)
         forced%guess_len = size(guess)
         if (size(guess) > 0) forced%guess = c_loc(guess)
      end if
      if (status == HBVIB_OK) status = hbvib_forced_response(self%handle, asked, forced, hooks, branch%handle)
   end function model_forced_response

   !> Nonlinear mode over log10 amplitudes log10_start .. log10_stop. mode: the other options, whose range is not looked at.
   !> at: log10 amplitudes wanted exactly. shape(ndof): the linear mode most alike it.
   function model_nonlinear_mode(self, branch, log10_start, log10_stop, mode, solver, hooks, at, shape) result(status)
      class(hbvib_model), intent(in) :: self
      type(hbvib_branch), intent(inout) :: branch
      real(dp), intent(in) :: log10_start, log10_stop
      type(hbvib_mode_options), intent(in), optional :: mode
      type(hbvib_solver_options), intent(in), optional :: solver
      type(hbvib_hooks), intent(in), optional :: hooks
      real(dp), intent(in), contiguous, target, optional :: at(:)
      complex(dp), intent(in), contiguous, target, optional :: shape(:)
      integer(i32) :: status
      type(hbvib_mode_options) :: m
      type(hbvib_solver_options), allocatable :: asked
      integer(i64) :: ndof, contacts
      status = branch%free()
      if (status == HBVIB_E_BUSY) return
      status = HBVIB_OK
      if (present(mode)) m = mode
      contacts = hbvib_model_contacts(self%handle)
      ndof = hbvib_model_dofs(self%handle)
      call to_zero(status, 'mode_index', m%mode_index, ndof, m%mode_index)
      call to_zero(status, 'amplitude_contact', m%amplitude_contact, contacts, m%amplitude_contact, -1_i32)
      call to_zero(status, 'reference_dof', m%reference_dof, ndof, m%reference_dof, -1_i32)
      call solver_from_one(status, solver, ndof, asked)
      m%log10_start = log10_start
      m%log10_stop = log10_stop
      if (present(at)) then
         m%at_len = size(at)
         if (size(at) > 0) m%at = c_loc(at)
      end if
      if (present(shape)) then
         m%shape_len = size(shape)
         if (size(shape) > 0) m%shape = c_loc(shape)
      end if
      if (status == HBVIB_OK) status = hbvib_nonlinear_mode(self%handle, asked, m, hooks, branch%handle)
   end function model_nonlinear_mode

   !> Periodic response at omega by integration in time. harmonics(ndof, 0:H) and samples(ndof, times) receive what they have
   !> room for; start(ndof, 0:H), such as a point of a branch, is where it begins. options: method, tolerance and max_periods.
   function model_time_response(self, omega, harmonics, samples, info, options, hooks, start) result(status)
      class(hbvib_model), intent(in) :: self
      real(dp), intent(in) :: omega
      complex(dp), intent(inout), contiguous, optional :: harmonics(:, 0:)
      real(dp), intent(inout), contiguous, optional :: samples(:, :)
      type(hbvib_time_info), intent(out), optional :: info
      type(hbvib_time_options), intent(in), optional :: options
      type(hbvib_hooks), intent(in), optional :: hooks
      complex(dp), intent(in), contiguous, target, optional :: start(:, :)
      integer(i32) :: status
      type(hbvib_time_options) :: o
      integer(i64) :: ndof, n_harmonics, n_samples
      status = HBVIB_OK
      ndof = hbvib_model_dofs(self%handle)
      if (present(options)) o = options
      o%omega = omega
      n_harmonics = 0
      n_samples = 0
      o%samples = 0
      if (present(harmonics)) then
         call same_length(status, 'harmonics(:, 0)', size(harmonics, 1, i64), ndof)
         n_harmonics = size(harmonics)
         o%harmonics = size(harmonics, 2) - 1
      end if
      if (present(samples)) then
         call same_length(status, 'samples(:, 1)', size(samples, 1, i64), ndof)
         n_samples = size(samples)
         o%samples = size(samples, 2)
      end if
      if (present(start)) then
         call same_length(status, 'start(:, 0)', size(start, 1, i64), ndof)
         o%start_len = size(start)
         if (size(start) > 0) o%start = c_loc(start)
      end if
      if (status == HBVIB_OK) &
         status = hbvib_time_response(self%handle, o, hooks, harmonics, n_harmonics, samples, n_samples, info)
   end function model_time_response

   !> How far a point of a forced response of this model is from the motion that integration in time finds from it.
   !> harmonics(ndof, 0:H) receives those in time, errors(0:H) what each of them adds to info%motion_error, by squares.
   function model_verify(self, branch, point, info, options, hooks, harmonics, errors) result(status)
      class(hbvib_model), intent(in) :: self
      class(hbvib_branch), intent(in) :: branch
      integer, intent(in) :: point
      type(hbvib_verification), intent(out), optional :: info
      type(hbvib_verify_options), intent(in), optional :: options
      type(hbvib_hooks), intent(in), optional :: hooks
      complex(dp), intent(inout), contiguous, optional :: harmonics(:, :)
      real(dp), intent(inout), contiguous, optional :: errors(:)
      integer(i32) :: status
      integer(i64) :: p, n_harmonics, n_errors
      status = HBVIB_OK
      n_harmonics = 0
      n_errors = 0
      call point_to_zero(branch, status, point, p)
      if (present(harmonics)) then
         call same_length(status, 'harmonics(:, 0)', size(harmonics, 1, i64), hbvib_model_dofs(self%handle))
         n_harmonics = size(harmonics)
      end if
      if (present(errors)) n_errors = size(errors)
      if (status == HBVIB_OK) &
         status = hbvib_verify(self%handle, branch%handle, p, options, hooks, harmonics, n_harmonics, errors, n_errors, info)
   end function model_verify

   !> Residual r(ndof, 0:H) of harmonic balance at x(ndof, 0:H), derivatives jac (2 (H + 1) ndof square) and d_omega (as r).
   function model_forced_residual(self, omega, x, r, jac, d_omega, solver) result(status)
      class(hbvib_model), intent(in) :: self
      real(dp), intent(in) :: omega
      complex(dp), intent(in), contiguous :: x(:, 0:)
      complex(dp), intent(inout), contiguous :: r(:, 0:)
      real(dp), intent(inout), contiguous, optional :: jac(:, :)
      complex(dp), intent(inout), contiguous, optional :: d_omega(:, 0:)
      type(hbvib_solver_options), intent(in), optional :: solver
      integer(i32) :: status
      type(hbvib_solver_options), allocatable :: asked
      integer(i64) :: ndof, n_jac, n_omega
      status = HBVIB_OK
      ndof = hbvib_model_dofs(self%handle)
      n_jac = 0
      n_omega = 0
      call solver_from_one(status, solver, ndof, asked)
      call same_length(status, 'x(:, 0)', size(x, 1, i64), ndof)
      call same_length(status, 'r(:, 0)', size(r, 1, i64), ndof)
      if (present(jac)) then
         call same_length(status, 'jac(:, 1)', size(jac, 1, i64), size(jac, 2, i64))
         n_jac = size(jac)
      end if
      if (present(d_omega)) then
         call same_length(status, 'd_omega(:, 0)', size(d_omega, 1, i64), ndof)
         n_omega = size(d_omega)
      end if
      if (status == HBVIB_OK) status = hbvib_forced_residual(self%handle, asked, omega, x, size(x, kind=i64), r, &
                                                             size(r, kind=i64), jac, n_jac, d_omega, n_omega)
   end function model_forced_residual

   ! ---- Branches ----

   !> Ends the branch and every pointer that field gave. Freeing an empty variable is a success.
   function branch_free(self) result(status)
      class(hbvib_branch), intent(inout) :: self
      integer(i32) :: status
      status = hbvib_branch_free(self%handle)
      if (status /= HBVIB_E_BUSY) self%handle = c_null_ptr
   end function branch_free

   !> Points on the curve, or a negative status.
   function branch_points(self) result(count)
      class(hbvib_branch), intent(in) :: self
      integer :: count
      count = int(hbvib_branch_points(self%handle))
   end function branch_points

   !> The status with which the solve returned.
   function branch_status(self) result(status)
      class(hbvib_branch), intent(in) :: self
      integer(i32) :: status
      status = hbvib_branch_status(self%handle)
   end function branch_status

   !> All stored points: the curve, then peaks, folds and the solutions wanted; or a negative status.
   function branch_stored(self) result(count)
      class(hbvib_branch), intent(in) :: self
      integer :: count
      count = int(hbvib_branch_stored(self%handle))
   end function branch_stored

   !> Number of the frequencies or amplitudes that were wanted.
   function wanted_count(self) result(wanted)
      class(hbvib_branch), intent(in) :: self
      integer(i64) :: wanted, found
      wanted = 0
      do while (hbvib_branch_at(self%handle, wanted, 0_i64, count=found) == HBVIB_OK)
         wanted = wanted + 1
      end do
   end function wanted_count

   !> Pointer onto the library's numbers, one per point: valid until the branch is freed or solved into again, not to be written.
   function field_1(self, field, x) result(status)
      class(hbvib_branch), intent(in) :: self
      integer(i32), intent(in) :: field
      real(dp), pointer, intent(out) :: x(:)
      integer(i32) :: status
      type(hbvib_view) :: view
      real(dp), pointer :: memory(:)
      nullify (x)
      status = view_of(self, field, 1, view)
      if (status /= HBVIB_OK) return
      x => nothing_1
      if (view%shape(1) == 0) return
      call c_f_pointer(view%data, memory, [(view%shape(1) - 1)*view%stride(1) + 1])
      x => memory(1::view%stride(1))
   end function field_1

   !> The same of HBVIB_SLIP_FRACTION: x(contact, point).
   function field_2(self, field, x) result(status)
      class(hbvib_branch), intent(in) :: self
      integer(i32), intent(in) :: field
      real(dp), pointer, intent(out) :: x(:, :)
      integer(i32) :: status
      type(hbvib_view) :: view
      real(dp), pointer :: memory(:, :)
      nullify (x)
      status = view_of(self, field, 2, view)
      if (status /= HBVIB_OK) return
      x => nothing_2
      if (product(view%shape(1:2)) == 0) return
      call c_f_pointer(view%data, memory, [view%stride(1), view%shape(1)])
      x => memory(1:view%shape(2)*view%stride(2):view%stride(2), :)
   end function field_2

   function view_of(self, field, rank, view) result(status)
      class(hbvib_branch), intent(in) :: self
      integer(i32), intent(in) :: field
      integer, intent(in) :: rank
      type(hbvib_view), intent(out) :: view
      integer(i32) :: status
      status = hbvib_branch_field(self%handle, field, view)
      call same_length(status, 'shape(x)', int(rank, i64), int(view%rank, i64))
   end function view_of

   !> Harmonics x(ndof, 0:H) of all degrees of freedom at a stored point.
   function branch_harmonics(self, point, x) result(status)
      class(hbvib_branch), intent(in) :: self
      integer, intent(in) :: point
      complex(dp), allocatable, intent(inout) :: x(:, :)
      integer(i32) :: status
      type(hbvib_reduction) :: size_of
      complex(dp), allocatable :: found(:, :)
      integer :: stat
      status = hbvib_branch_reduction(self%handle, size_of)
      if (status /= HBVIB_OK) return
      allocate (found(size_of%degrees_of_freedom, 0:size_of%harmonics_asked), stat=stat)
      status = made(stat)
      if (status == HBVIB_OK) status = self%harmonics_into(point, 1, found)
      if (status == HBVIB_OK) call move_alloc(found, x)
   end function branch_harmonics

   !> Harmonics x(:, 0:H) of size(x, 1) degrees of freedom from first_dof on.
   function branch_harmonics_into(self, point, first_dof, x) result(status)
      class(hbvib_branch), intent(in) :: self
      integer, intent(in) :: point, first_dof
      complex(dp), intent(inout), contiguous :: x(:, 0:)
      integer(i32) :: status
      type(hbvib_reduction) :: size_of
      integer(i64) :: p, first
      status = hbvib_branch_reduction(self%handle, size_of)
      call to_zero(status, 'first_dof', int(first_dof, i64), size_of%degrees_of_freedom, first)
      call point_to_zero(self, status, point, p)
      if (status == HBVIB_OK) &
         status = hbvib_branch_harmonics(self%handle, p, first, size(x, 1, i64), x, size(x, kind=i64))
   end function branch_harmonics_into

   !> Number of a stored point, from 0.
   subroutine point_to_zero(self, status, point, zero)
      class(hbvib_branch), intent(in) :: self
      integer(i32), intent(inout) :: status
      integer, intent(in) :: point
      integer(i64), intent(out) :: zero
      integer(i64) :: count
      zero = point - 1
      if (status < HBVIB_OK) return
      count = hbvib_branch_stored(self%handle)
      call to_zero(status, 'point', int(point, i64), count, zero)
   end subroutine point_to_zero

   !> Shares of the period that each contact slips, shares(contacts).
   function branch_slip_fraction(self, point, shares) result(status)
      class(hbvib_branch), intent(in) :: self
      integer, intent(in) :: point
      real(dp), intent(inout), contiguous :: shares(:)
      integer(i32) :: status
      integer(i64) :: p
      status = HBVIB_OK
      call point_to_zero(self, status, point, p)
      if (status == HBVIB_OK) status = hbvib_branch_slip_fraction(self%handle, p, shares, size(shares, kind=i64))
   end function branch_slip_fraction

   function branch_reduction(self, reduction) result(status)
      class(hbvib_branch), intent(in) :: self
      type(hbvib_reduction), intent(out) :: reduction
      integer(i32) :: status
      status = hbvib_branch_reduction(self%handle, reduction)
      if (status == HBVIB_OK .and. reduction%response_dof >= 0) reduction%response_dof = reduction%response_dof + 1
   end function branch_reduction

   !> Peaks (of a nonlinear mode: the largest damping ratios), as many as there are: angular frequencies, amplitudes, point numbers.
   !> Arrays are untouched on error.
   function branch_peaks(self, omega, amplitude, point) result(status)
      class(hbvib_branch), intent(in) :: self
      real(dp), allocatable, intent(inout), optional :: omega(:), amplitude(:)
      integer, allocatable, intent(inout), optional :: point(:)
      integer(i32) :: status
      status = special(self, -1_i64, omega, amplitude, point)
   end function branch_peaks

   !> Turning points in frequency (of a nonlinear mode: in amplitude) likewise.
   function branch_folds(self, omega, amplitude, point) result(status)
      class(hbvib_branch), intent(in) :: self
      real(dp), allocatable, intent(inout), optional :: omega(:), amplitude(:)
      integer, allocatable, intent(inout), optional :: point(:)
      integer(i32) :: status
      status = special(self, -2_i64, omega, amplitude, point)
   end function branch_folds

   !> Solutions found at entry `wanted` of the array `at`.
   function branch_at(self, wanted, amplitude, point) result(status)
      class(hbvib_branch), intent(in) :: self
      integer, intent(in) :: wanted
      real(dp), allocatable, intent(inout), optional :: amplitude(:)
      integer, allocatable, intent(inout), optional :: point(:)
      integer(i32) :: status
      integer(i64) :: zero
      status = self%status()
      if (status < HBVIB_OK) return
      call to_zero(status, 'wanted', int(wanted, i64), wanted_count(self), zero)
      if (status >= HBVIB_OK) status = special(self, zero, amplitude=amplitude, point=point)
   end function branch_at

   !> which: -1 peaks, -2 folds, else the solutions wanted of this number from 0.
   function special(self, which, omega, amplitude, point) result(status)
      class(hbvib_branch), intent(in) :: self
      integer(i64), intent(in) :: which
      real(dp), allocatable, intent(inout), optional :: omega(:), amplitude(:)
      integer, allocatable, intent(inout), optional :: point(:)
      integer(i32) :: status
      real(dp), allocatable :: w(:), a(:)
      integer(i64), allocatable :: p(:)
      integer(i64) :: n
      integer :: stat
      n = 0
      allocate (w(0), a(0), p(0))
      do
         select case (which)
         case (-1)
            status = hbvib_branch_peaks(self%handle, size(w, kind=i64), w, a, p, n)
         case (-2)
            status = hbvib_branch_folds(self%handle, size(w, kind=i64), w, a, p, n)
         case default
            status = hbvib_branch_at(self%handle, which, size(w, kind=i64), a, p, n)
         end select
         if (status /= HBVIB_E_DIMENSION .or. size(w) >= n) exit
         deallocate (w, a, p)
         allocate (w(n), a(n), p(n), stat=stat)
         if (stat /= 0) status = HBVIB_E_OUT_OF_MEMORY
         if (stat /= 0) return
      end do
      if (status /= HBVIB_OK) return
      if (present(omega)) omega = w
      if (present(amplitude)) amplitude = a
      if (present(point)) point = int(p) + 1
   end function special

   !> Energies and losses of a stored point.
   function branch_energy(self, point, energy) result(status)
      class(hbvib_branch), intent(in) :: self
      integer, intent(in) :: point
      type(hbvib_energies), intent(out) :: energy
      integer(i32) :: status
      integer(i64) :: p
      status = HBVIB_OK
      call point_to_zero(self, status, point, p)
      if (status == HBVIB_OK) status = hbvib_branch_energy(self%handle, p, energy)
   end function branch_energy

   !> Motion of a degree of freedom over a period: x(j) at omega t = 2 pi (j - 1) / size(x).
   function branch_time_history(self, point, dof, x) result(status)
      class(hbvib_branch), intent(in) :: self
      integer, intent(in) :: point, dof
      real(dp), intent(inout), contiguous :: x(:)
      integer(i32) :: status
      type(hbvib_reduction) :: size_of
      integer(i64) :: p, d
      status = hbvib_branch_reduction(self%handle, size_of)
      call to_zero(status, 'dof', int(dof, i64), size_of%degrees_of_freedom, d)
      call point_to_zero(self, status, point, p)
      if (status == HBVIB_OK) status = hbvib_branch_time_history(self%handle, p, d, size(x, kind=i64), x)
   end function branch_time_history

   !> Hysteresis loop of a contact in direction 1 (default) .. contact_summary's directions, at as many times as the arrays, equally
   !> long, have entries. At least one of motion, force and state.
   function branch_contact_loop(self, point, contact, motion, force, state, direction) result(status)
      class(hbvib_branch), intent(in) :: self
      integer, intent(in) :: point, contact
      real(dp), intent(inout), contiguous, optional :: motion(:), force(:)
      integer(i32), intent(inout), contiguous, optional :: state(:)
      integer, intent(in), optional :: direction
      integer(i32) :: status
      type(hbvib_contact_summary) :: summary
      integer(i64) :: p, c, d, n
      call contact_to_zero(self, status, point, contact, p, c)
      d = 0
      if (present(direction)) then
         if (status == HBVIB_OK) status = hbvib_branch_contact_summary(self%handle, p, c, summary)
         call to_zero(status, 'direction', int(direction, i64), summary%directions, d)
      end if
      n = 1
      if (present(state)) n = size(state)
      if (present(force)) n = size(force)
      if (present(motion)) n = size(motion)
      if (present(force)) call same_length(status, 'force', size(force, kind=i64), n)
      if (present(state)) call same_length(status, 'state', size(state, kind=i64), n)
      if (status == HBVIB_OK) status = hbvib_branch_contact_loop(self%handle, p, c, d, n, motion, force, state)
   end function branch_contact_loop

   !> Work, shares of the period and ranges of a contact at a stored point.
   function branch_contact_summary(self, point, contact, summary) result(status)
      class(hbvib_branch), intent(in) :: self
      integer, intent(in) :: point, contact
      type(hbvib_contact_summary), intent(out) :: summary
      integer(i32) :: status
      integer(i64) :: p, c
      call contact_to_zero(self, status, point, contact, p, c)
      if (status == HBVIB_OK) status = hbvib_branch_contact_summary(self%handle, p, c, summary)
   end function branch_contact_summary

   subroutine contact_to_zero(self, status, point, contact, p, c)
      class(hbvib_branch), intent(in) :: self
      integer(i32), intent(out) :: status
      integer, intent(in) :: point, contact
      integer(i64), intent(out) :: p, c
      type(hbvib_reduction) :: size_of
      c = 0
      status = hbvib_branch_reduction(self%handle, size_of)
      call to_zero(status, 'contact', int(contact, i64), size_of%contacts, c)
      call point_to_zero(self, status, point, p)
   end subroutine contact_to_zero

   !> Numbers of a stored point of a nonlinear mode.
   function branch_mode_point(self, point, numbers) result(status)
      class(hbvib_branch), intent(in) :: self
      integer, intent(in) :: point
      type(hbvib_mode_point), intent(out) :: numbers
      integer(i32) :: status
      integer(i64) :: p
      status = HBVIB_OK
      call point_to_zero(self, status, point, p)
      if (status == HBVIB_OK) status = hbvib_branch_mode_point(self%handle, p, numbers)
   end function branch_mode_point

   !> Where a nonlinear mode started; mode_index, reference_dof and amplitude_contact count from 1.
   function branch_mode_info(self, info) result(status)
      class(hbvib_branch), intent(in) :: self
      type(hbvib_mode_info), intent(out) :: info
      integer(i32) :: status
      status = hbvib_branch_mode_info(self%handle, info)
      if (status /= HBVIB_OK) return
      info%mode_index = info%mode_index + 1
      info%reference_dof = info%reference_dof + 1
      if (info%amplitude_contact >= 0) info%amplitude_contact = info%amplitude_contact + 1
   end function branch_mode_info

   !> Response to the forces of model, synthesised from a nonlinear mode: frequencies, fundamentals, modal amplitudes.
   function branch_synthesis(self, model, omega, response, modal_amplitude, options) result(status)
      class(hbvib_branch), intent(in) :: self
      type(hbvib_model), intent(in) :: model
      real(dp), allocatable, intent(inout), optional :: omega(:), modal_amplitude(:)
      complex(dp), allocatable, intent(inout), optional :: response(:)
      type(hbvib_synthesis_options), intent(in), optional :: options
      integer(i32) :: status
      real(dp), allocatable :: w(:), a(:)
      complex(dp), allocatable :: x(:)
      integer(i64) :: n
      integer :: stat
      n = hbvib_branch_points(self%handle)
      status = int(min(n, 0_i64), i32)
      if (status /= HBVIB_OK) return
      allocate (w(2*n), a(2*n), x(2*n), stat=stat)
      status = made(stat)
      if (status == HBVIB_OK) &
         status = hbvib_branch_synthesis(self%handle, model%handle, options, 2*n, w, x, a, n)
      if (status /= HBVIB_OK) return
      if (present(omega)) omega = w(:n)
      if (present(response)) response = x(:n)
      if (present(modal_amplitude)) modal_amplitude = a(:n)
   end function branch_synthesis

   !> Resonances of the synthesised response; flags are sums of HBVIB_SYNTHESIS_ANOTHER_MODE and so on.
   function branch_synthesis_peaks(self, model, omega, amplitude, log10_amplitude, damping_ratio, other_mode, flags, options) &
      result(status)
      class(hbvib_branch), intent(in) :: self
      type(hbvib_model), intent(in) :: model
      real(dp), allocatable, intent(inout), optional :: omega(:), amplitude(:), log10_amplitude(:), damping_ratio(:), other_mode(:)
      integer(i32), allocatable, intent(inout), optional :: flags(:)
      type(hbvib_synthesis_options), intent(in), optional :: options
      integer(i32) :: status
      real(dp), allocatable :: x(:, :)
      integer(i32), allocatable :: bits(:)
      integer(i64) :: n
      integer :: stat
      n = hbvib_branch_points(self%handle)
      status = int(min(n, 0_i64), i32)
      do while (status == HBVIB_OK)
         allocate (x(n, 5), bits(n), stat=stat)
         status = made(stat)
         if (status == HBVIB_OK) status = hbvib_branch_synthesis_peaks(self%handle, model%handle, options, n, x(:, 1), x(:, 2), &
                                                                       x(:, 3), x(:, 4), x(:, 5), bits, n)
         if (status /= HBVIB_E_DIMENSION .or. n <= size(bits)) exit
         deallocate (x, bits)
         status = HBVIB_OK
      end do
      if (status /= HBVIB_OK) return
      if (present(omega)) omega = x(:n, 1)
      if (present(amplitude)) amplitude = x(:n, 2)
      if (present(log10_amplitude)) log10_amplitude = x(:n, 3)
      if (present(damping_ratio)) damping_ratio = x(:n, 4)
      if (present(other_mode)) other_mode = x(:n, 5)
      if (present(flags)) flags = bits(:n)
   end function branch_synthesis_peaks

end module hbvib
