! A bladed disk with a friction ring damper: one of 24 sectors, engine order 2, friction between disk and ring. Prints the
! resonance of the blade tip under three forces. Build: make PREFIX=<where hbvib is installed>, in this directory.
program ring_damper
   use, intrinsic :: iso_fortran_env, only: error_unit
   use hbvib
   implicit none
   integer, parameter :: dp = c_double, b2 = 1, b1 = 2, d = 3, r = 4 ! blade tip, blade root, disk, ring
   real(dp), parameter :: pi = acos(-1._dp), force(3) = [1._dp, 5._dp, 20._dp]
   type(hbvib_model) :: model
   type(hbvib_branch) :: branch
   type(hbvib_solver_options) :: solver
   real(dp), allocatable :: omega(:), amplitude(:)
   integer :: i, best

   call build(ring_mass=0.03_dp, rpm=3000._dp)
   solver%tolerance = 0 ! fixed harmonics: exactly H = 63
   solver%harmonics = 63
   solver%response_dof = b2
   write (*, '(a)') '   F/N              f/Hz            |X1|/m'
   do i = 1, size(force)
      call check(model%clear_forces())
      call check(model%add_force(b2, harmonic=1, force=force(i)))
      call check(model%add_force(b1, harmonic=1, force=force(i)))
      call check(model%forced_response(branch, 2*pi*207, 2*pi*211, solver))
      call check(branch%peaks(omega, amplitude))
      if (size(omega) == 0) call fail('no peak between 207 and 211 Hz')
      best = maxloc(amplitude, 1)
      write (*, '(f6.1, 2x, f16.11, 2x, es19.12e2)') force(i), omega(best)/(2*pi), amplitude(best)
   end do
   call check(branch%free())
   call check(model%free())

contains

   subroutine build(ring_mass, rpm)
      real(dp), intent(in) :: ring_mass, rpm
      real(dp), parameter :: kb2 = 2e6_dp, kb1 = 1e6_dp, kd = 5e7_dp, kg = 6e5_dp, kr = 2e7_dp, radius = 0.165_dp
      real(dp) :: mass(4, 4), stiffness(4, 4), coupling(4, 4), spin
      type(hbvib_contact) :: friction
      mass = 0
      mass(b2, b2) = 0.2_dp
      mass(b1, b1) = 0.3_dp
      mass(d, d) = 1.2_dp
      mass(r, r) = ring_mass
      stiffness(:, b2) = [kb2, -kb2, 0._dp, 0._dp]
      stiffness(:, b1) = [-kb2, kb2 + kb1, -kb1, 0._dp]
      stiffness(:, d) = [0._dp, -kb1, kb1 + kg + 2*kd, 0._dp]
      stiffness(:, r) = [0._dp, 0._dp, 0._dp, 2*kr]
      coupling = 0
      coupling(d, d) = -kd
      coupling(r, r) = -kr
      call check(model%new(4, sectors=24))
      call check(model%set_matrix(HBVIB_MASS, mass))
      call check(model%set_matrix(HBVIB_STIFFNESS, stiffness))
      call check(model%set_coupling(HBVIB_STIFFNESS, coupling))
      call check(model%set_rayleigh(0._dp, 1.5e-6_dp)) ! C = 1.5e-6 s * K
      call check(model%set_wave(2))                     ! engine order

      spin = rpm*2*pi/60
      friction%kind = HBVIB_JENKINS
      friction%dof_a(1) = d
      friction%dof_b(1) = r
      friction%kt = 5e7_dp
      friction%mu = 0.3_dp
      friction%preload = ring_mass*radius*spin*spin
      call check(model%add_contact(friction))
   end subroutine build

   !> Ends the program with the error sentence of the library if a call failed.
   subroutine check(status)
      integer(c_int32_t), intent(in) :: status
      if (status /= HBVIB_OK) call fail(hbvib_text(hbvib_status_name(status))//': '//hbvib_error_text())
   end subroutine check

   subroutine fail(sentence)
      character(*), intent(in) :: sentence
      write (error_unit, '(a)') sentence
      stop 1, quiet=.true.
   end subroutine fail

end program ring_damper
