! Shared parts of the Fortran tests: checks that are counted and name the claim that failed, and the ring damper as reference case.
module common
   use, intrinsic :: iso_fortran_env, only: error_unit
   use hbvib
   implicit none
   public

   integer, parameter :: dp = c_double, b2 = 1, b1 = 2, d = 3, r = 4
   real(dp), parameter :: pi = acos(-1._dp)
   integer :: checks = 0, failures = 0

   !> The bits of a solution: frequencies, amplitudes, harmonics at the last peak, or first point.
   type :: solution
      real(dp), allocatable :: omega(:), amplitude(:)
      complex(dp), allocatable :: harmonics(:, :)
   end type solution

contains

   subroutine expect(claim, holds)
      character(*), intent(in) :: claim
      logical, intent(in) :: holds
      checks = checks + 1
      if (holds) return
      failures = failures + 1
      write (error_unit, '(4a)') 'failed: ', claim, ' -- last error: ', hbvib_error_text()
   end subroutine expect

   subroutine works(status, claim)
      integer(c_int32_t), intent(in) :: status
      character(*), intent(in) :: claim
      call expect(claim//' is done', status == HBVIB_OK)
   end subroutine works

   !> The call was refused with this status and these words.
   subroutine refused(status, wanted, words, claim)
      integer(c_int32_t), intent(in) :: status, wanted
      character(*), intent(in) :: words, claim
      character(:), allocatable :: told
      told = hbvib_error_text()
      call expect(claim//' is refused as '//hbvib_text(hbvib_status_name(wanted))//' with "'//words//'"', &
                  status == wanted .and. index(told, words) > 0)
   end subroutine refused

   subroutine verdict(least_checks)
      integer, intent(in) :: least_checks
      if (checks < least_checks) write (error_unit, '(a, i0, a)') 'failed: only ', checks, ' checks ran'
      if (failures > 0 .or. checks < least_checks) stop 1, quiet=.true.
   end subroutine verdict

   subroutine ring_damper(model)
      type(hbvib_model), intent(inout) :: model
      real(dp) :: mass(4, 4), stiffness(4, 4), coupling(4, 4)
      type(hbvib_contact) :: friction
      mass = 0
      mass(b2, b2) = 0.2_dp
      mass(b1, b1) = 0.3_dp
      mass(d, d) = 1.2_dp
      mass(r, r) = 0.03_dp
      stiffness = 0
      stiffness(1:2, b2) = [2e6_dp, -2e6_dp]
      stiffness(1:3, b1) = [-2e6_dp, 3e6_dp, -1e6_dp]
      stiffness(2:3, d) = [-1e6_dp, 101.6e6_dp]
      stiffness(r, r) = 4e7_dp
      coupling = 0
      coupling(d, d) = -5e7_dp
      coupling(r, r) = -2e7_dp
      call works(model%new(4, sectors=24), 'a cyclic model')
      call works(model%set_matrix(HBVIB_MASS, mass), 'mass')
      call works(model%set_matrix(HBVIB_STIFFNESS, stiffness), 'stiffness')
      call works(model%set_coupling(HBVIB_STIFFNESS, coupling), 'coupling')
      call works(model%set_rayleigh(0._dp, 1.5e-6_dp), 'damping')
      call works(model%set_wave(2), 'engine order')
      call works(model%add_force(b2, 1, 5._dp), 'force')
      call works(model%add_force(b1, 1, (5._dp, 0._dp)), 'complex force')
      friction%kind = HBVIB_JENKINS
      friction%dof_a(1) = d
      friction%dof_b(1) = r
      friction%kt = 5e7_dp
      friction%mu = 0.3_dp
      friction%preload = 0.03_dp*0.165_dp*(3000*2*pi/60)**2
      call works(model%add_contact(friction), 'contact')
   end subroutine ring_damper

   function solve(model, found) result(status)
      type(hbvib_model), intent(in) :: model
      type(solution), intent(inout) :: found
      integer(c_int32_t) :: status
      type(hbvib_branch) :: branch
      type(hbvib_solver_options) :: solver
      real(dp), pointer :: view(:)
      integer, allocatable :: peak(:)
      solver%tolerance = 0
      solver%response_dof = b2
      status = model%forced_response(branch, 2*pi*207, 2*pi*211, solver)
      if (status /= HBVIB_OK) return
      status = branch%field(HBVIB_OMEGA, view)
      found%omega = view
      if (status == HBVIB_OK) status = branch%field(HBVIB_AMPLITUDE, view)
      found%amplitude = view
      if (status == HBVIB_OK) status = branch%peaks(point=peak)
      if (status /= HBVIB_OK) return
      status = branch%harmonics(merge(1, maxval(peak), size(peak) == 0), found%harmonics)
      if (status == HBVIB_OK) status = branch%free()
   end function solve

   !> Bit for bit.
   pure function same(a, b)
      type(solution), intent(in) :: a, b
      logical :: same
      same = size(a%omega) == size(b%omega) .and. size(a%harmonics) == size(b%harmonics) .and. size(a%omega) > 1
      if (same) same = all(transfer(a%omega, [0_c_int64_t]) == transfer(b%omega, [0_c_int64_t])) .and. &
                       all(transfer(a%amplitude, [0_c_int64_t]) == transfer(b%amplitude, [0_c_int64_t])) .and. &
                       all(transfer(a%harmonics, [0_c_int64_t]) == transfer(b%harmonics, [0_c_int64_t]))
   end function same

end module common
