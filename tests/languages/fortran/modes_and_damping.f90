! Modes about the static state, structural damping given as one triangle, terms of the speed: closed forms, and misuse.
program modes_and_damping
   use common
   implicit none
   real(dp), parameter :: o = 0, e = 1, eta = 0.02_dp
   complex(dp), parameter :: i = (0._dp, 1._dp)
   type(hbvib_model) :: model
   type(hbvib_branch) :: branch
   type(solution) :: reference

   call pressed()
   call parts()
   call speed()
   call misuse()
   call verdict(150)

contains

   function close(a, b, tolerance)
      real(dp), intent(in) :: a, b, tolerance
      logical :: close
      close = abs(a - b) <= tolerance*abs(b)
   end function close

   !> m = 1 on a spring of 1.
   subroutine oscillator()
      call works(model%new(1), 'an oscillator')
      call works(model%set_matrix(HBVIB_MASS, reshape([e], [1, 1])), 'its mass')
      call works(model%set_matrix(HBVIB_STIFFNESS, reshape([e], [1, 1])), 'its stiffness')
   end subroutine oscillator

   !> A stop of stiffness 2 that presses by 1/2.
   subroutine add_stop()
      type(hbvib_contact) :: stop
      stop%kind = HBVIB_UNILATERAL
      stop%dof_a(3) = 1
      stop%kn = 2
      stop%preload = 0.5_dp
      call works(model%add_contact(stop), 'a stop')
   end subroutine add_stop

   !> A stop that presses at rest, then one that only touches; friction under a constant force.
   subroutine pressed()
      type(hbvib_mode_info) :: info
      type(hbvib_energies) :: energy
      complex(dp), allocatable :: x(:, :)
      real(dp), pointer :: view(:)
      real(dp) :: squared
      call oscillator()
      call add_stop()
      call works(model%nonlinear_mode(branch, -2*e, e, tolerance=o, harmonics=9), 'a mode')
      call works(branch%mode_info(info), 'its data')
      call expect('a pressed stop is closed at small amplitudes', close(info%omega, sqrt(3*e), 1e-12_dp))
      call expect('it lifts off', close(info%lift_off_from, log10(e/12), 1e-9_dp))
      call expect('nothing slips', info%slip_from > huge(e))
      call works(branch%harmonics(1, x), 'its motion')
      call expect('motions are total', close(real(x(1, 0), dp), e/6, 1e-12_dp))
      squared = abs(x(1, 1))**2
      call works(branch%energy(1, energy), 'its energy')
      call expect('potential energy counts from the static state', close(energy%potential_mean, 0.25_dp*squared, 1e-10_dp))
      call works(branch%field(HBVIB_ENERGY, view), 'energies')
      call expect('twice the mean kinetic energy', close(view(1), 1.5_dp*squared, 1e-10_dp))
      call works(model%set_preload(1, o), 'no preload')
      call works(model%nonlinear_mode(branch, -2*e, e, tolerance=o, harmonics=63), 'a mode')
      call works(branch%field(HBVIB_OMEGA, view), 'its frequencies')
      call expect('a touching stop has one frequency', all(abs(view*(1 + sqrt(3*e))/(2*sqrt(3*e)) - 1) < 1e-9_dp))
      call works(branch%mode_info(info), 'its data')
      call expect('it lifts off at every amplitude', info%lift_off_from < -huge(e))
      call oscillator()
      call works(model%add_jenkins([1], [e], [0.3_dp], [e]), 'friction')
      call works(model%add_force(1, 0, 0.2_dp), 'a constant force')
      call works(model%nonlinear_mode(branch, -2*e, 0.5_dp, tolerance=o, harmonics=5), 'a mode')
      call works(branch%mode_info(info), 'its data')
      call expect('a loaded slider is dragged along', abs(info%linear_up_to - log10(0.2_dp)) < 1e-8_dp)
      call expect('then it slips', abs(info%slip_from - log10(0.3_dp)) < 1e-6_dp)
      call works(branch%harmonics(1, x), 'its motion')
      call expect('about the static state', close(real(x(1, 0), dp), 0.1_dp, 1e-12_dp))
   end subroutine pressed

   !> Two masses of 1 between three springs of 1 + i eta, without their springs.
   subroutine two_masses()
      call works(model%new(2), 'two masses')
      call works(model%set_matrix(HBVIB_MASS, reshape([e, o, o, e], [2, 2])), 'their masses')
      call works(model%add_force(1, 1, e), 'a force')
   end subroutine two_masses

   subroutine has_the_response(claim)
      character(*), intent(in) :: claim
      complex(dp), allocatable :: x(:, :)
      complex(dp) :: one, other
      one = 1/(i*eta)
      other = 1/(2 + 3*i*eta)
      call works(model%forced_response(branch, e, e, tolerance=o, harmonics=1), claim)
      call works(branch%harmonics(1, x), claim)
      call expect(claim, all(abs(x(:, 1) - [one + other, one - other]/2) < 1e-12_dp/eta))
      call refused(model%time_response(e), HBVIB_E_UNSUPPORTED, 'viscous equivalent', claim//' in time')
      call refused(model%verify(branch, 1), HBVIB_E_UNSUPPORTED, 'no causal law', claim//', checked in time')
   end subroutine has_the_response

   subroutine parts()
      complex(dp) :: lossy(2, 2), lower(2, 2), upper(2, 2), eigenvalue(2)
      real(dp) :: chain(2, 2), half
      ! Nobody may read the other triangle.
      complex(dp), parameter :: garbage = (1e300_dp, -1e300_dp)
      chain = reshape([2*e, -e, -e, 2*e], [2, 2])
      lossy = chain*(1 + i*eta)
      lower = lossy
      lower(1, 2) = garbage
      upper = lossy
      upper(2, 1) = garbage
      call two_masses()
      call works(model%set_matrix(HBVIB_STIFFNESS, lossy, HBVIB_SYMMETRIC), 'a complex stiffness')
      call has_the_response('a complex symmetric stiffness')
      call two_masses()
      call works(model%set_matrix(HBVIB_STIFFNESS, lower, HBVIB_SYMMETRIC_LOWER), 'a lower triangle')
      call has_the_response('its lower triangle')
      call two_masses()
      call works(model%set_matrix(HBVIB_STIFFNESS, upper, HBVIB_SYMMETRIC_UPPER), 'an upper triangle')
      call has_the_response('its upper triangle')
      ! Refusals leave the stiffness as it is.
      call refused(model%set_matrix(HBVIB_STIFFNESS, lower, HBVIB_LOWER), HBVIB_E_NOT_HERMITIAN, 'SYMMETRIC_LOWER', 'a triangle')
      call refused(model%set_matrix(HBVIB_STIFFNESS, upper, HBVIB_UPPER), HBVIB_E_NOT_HERMITIAN, 'SYMMETRIC_UPPER', 'a triangle')
      call refused(model%set_matrix(HBVIB_STIFFNESS, lossy), HBVIB_E_NOT_HERMITIAN, 'SYMMETRIC', 'a full matrix')
      call refused(model%set_matrix(HBVIB_STIFFNESS, lossy, 7), HBVIB_E_ARGUMENT, 'part = 7', 'no part')
      call has_the_response('its upper triangle, after refusals')
      half = sin(0.5_dp*atan(eta))
      call two_masses()
      call works(model%set_matrix(HBVIB_STIFFNESS, chain), 'springs')
      call works(model%set_loss_factor(eta), 'a loss factor')
      call has_the_response('a loss factor')
      call works(model%damped_modes(eigenvalue), 'its modes')
      call expect('half the loss factor', all(abs(-real(eigenvalue)/abs(eigenvalue) - half) < 1e-14_dp))
      call works(model%set_loss_factor(o), 'no loss factor')
      call works(model%set_matrix(HBVIB_STRUCTURAL, eta*chain), 'a structural matrix')
      call has_the_response('a structural matrix')
      call works(model%damped_modes(eigenvalue), 'its modes')
      call expect('the same of a matrix', all(abs(-real(eigenvalue)/abs(eigenvalue) - half) < 1e-14_dp))
      call works(model%set_matrix(HBVIB_STRUCTURAL, o*chain), 'no structural matrix')
      call works(model%set_modal_damping([0.03_dp, 0.05_dp]), 'modal ratios')
      call works(model%damped_modes(eigenvalue), 'their modes')
      call expect('modal ratios', all(abs(-real(eigenvalue)/abs(eigenvalue) - [0.03_dp, 0.05_dp]) < 1e-14_dp))
   end subroutine parts

   !> Stiffness 1 - 0.2 Omega^2, an unbalance, and engine orders that meet it.
   subroutine speed()
      real(dp), parameter :: p = 0.5_dp, w = 0.7_dp, speeds(3) = [0.2_dp, 0.5_dp, 1._dp]
      complex(dp), allocatable :: x(:, :)
      complex(dp) :: eigenvalue(1), wanted
      real(dp) :: omega(1, 3), at(4), frequency(4)
      integer :: order, found
      call oscillator()
      call works(model%set_matrix(HBVIB_STIFFNESS_SPEED2, reshape([-0.2_dp], [1, 1])), 'softening')
      call works(model%set_speed(e), 'a speed')
      call works(model%damped_modes(eigenvalue, contacts=HBVIB_CONTACTS_FREE), 'a mode')
      call expect('a frequency at speed', close(aimag(eigenvalue(1)), sqrt(0.8_dp), 1e-13_dp))
      call works(model%campbell(speeds, omega, contacts=HBVIB_CONTACTS_FREE), 'a Campbell diagram')
      call expect('a Campbell diagram', all(abs(omega(1, :) - sqrt(1 - 0.2_dp*speeds**2)) < 1e-13_dp))
      do order = 1, 3
         call works(model%campbell_crossings(speeds, 1, order, at, frequency, found), 'crossings')
         call expect('one crossing', found == 1)
         call expect('its speed', close(at(1), sqrt(1/(order**2 + 0.2_dp)), 1e-12_dp))
         call expect('its frequency', close(frequency(1), order*at(1), 1e-12_dp))
      end do
      call works(model%set_speed_per_omega(p), 'a speed of the frequency')
      call works(model%add_force(1, 1, e), 'a force')
      call works(model%forced_response(branch, w, w, tolerance=o, harmonics=1), 'a response')
      call works(branch%harmonics(1, x), 'its motion')
      call expect('a speed of the frequency', close(real(x(1, 1), dp), 1/(1 - 0.2_dp*(p*w)**2 - w**2), 1e-12_dp))
      call refused(model%damped_modes(eigenvalue), HBVIB_E_ARGUMENT, 'fixed speed', 'modes at no one speed')
      call add_stop()
      call refused(model%nonlinear_mode(branch, -2*e, e), HBVIB_E_UNSUPPORTED, 'set a fixed speed', 'a state of no one speed')
      call works(model%set_speed(o), 'no speed')
      call works(model%damped_modes(eigenvalue, contacts=HBVIB_CONTACTS_STATIC), 'a mode about the static state')
      call expect('a closed stop', close(aimag(eigenvalue(1)), sqrt(3*e), 1e-12_dp))
      call works(model%set_preload(1, 0.5_dp, per_speed2=-0.5_dp), 'a load that falls')
      call works(model%set_speed(2*e), 'a speed')
      call works(model%damped_modes(eigenvalue, contacts=HBVIB_CONTACTS_STATIC), 'a mode about the static state')
      call expect('its load is gone at speed', close(aimag(eigenvalue(1)), sqrt(0.2_dp), 1e-12_dp))
      call refused(model%set_speed_per_omega(e), HBVIB_E_ARGUMENT, 'per_speed2 = -0.5', 'a load that falls with the frequency')
      call works(model%new(2), 'two directions')
      call works(model%set_matrix(HBVIB_MASS, reshape([e, o, o, e], [2, 2])), 'mass')
      call works(model%set_matrix(HBVIB_STIFFNESS, reshape([e, o, o, e], [2, 2])), 'stiffness')
      call works(model%add_unbalance(1, 2, 0.3_dp, phase=0.4_dp), 'an unbalance')
      call works(model%forced_response(branch, w, w, tolerance=o, harmonics=1), 'its response')
      call works(branch%harmonics(1, x), 'its motion')
      wanted = 0.3_dp*w**2/(1 - w**2)*exp(0.4_dp*i)
      call expect('an unbalance', all(abs(x(:, 1) - [wanted, -i*wanted]) < 1e-12_dp))
   end subroutine speed

   !> After a refusal the model must still give the same bits.
   subroutine bad(status, wanted, words, claim)
      integer(c_int32_t), intent(in) :: status, wanted
      character(*), intent(in) :: words, claim
      type(solution) :: again
      call refused(status, wanted, words, claim)
      call works(solve(model, again), 'a solve after: '//claim)
      call expect('the model solves to the same bits after: '//claim, same(again, reference))
   end subroutine bad

   subroutine misuse()
      real(dp) :: unit(4, 4), omega(1, 2), at(2), frequency(2)
      complex(dp) :: eigenvalue(1), shapes(3, 1), none(0)
      type(hbvib_parameter) :: parameters(2)
      type(hbvib_model) :: plain
      real(dp) :: derivatives(2)
      complex(dp) :: harmonics(4, 0:3)
      integer :: found, k
      call ring_damper(model)
      call works(solve(model, reference), 'the reference case')
      unit = 0
      do k = 1, 4
         unit(k, k) = 1
      end do
      call bad(model%set_loss_factor(-e), HBVIB_E_ARGUMENT, 'loss_factor = -1', 'a loss factor below 0')
      call bad(model%set_modal_damping([0.01_dp, -0.01_dp]), HBVIB_E_ARGUMENT, 'ratios[', 'a modal ratio below 0')
      call bad(model%set_matrix(HBVIB_GYROSCOPIC, unit), HBVIB_E_NOT_HERMITIAN, 'skew-symmetric', 'no gyroscopic matrix')
      call bad(model%set_preload(2, e, per_speed2=e), HBVIB_E_INDEX, '2', 'a load of no contact')
      call bad(model%set_preload(1, -e, per_speed2=e), HBVIB_E_ARGUMENT, 'preload = -1', 'a load below 0')
      call bad(model%add_unbalance(2, 2, e), HBVIB_E_ARGUMENT, 'both', 'an unbalance of one direction')
      call bad(model%add_unbalance(0, 2, e), HBVIB_E_INDEX, 'dof_x = 0, needs 1 .. 4', 'an unbalance on dof 0')
      call bad(model%add_unbalance(1, 5, e), HBVIB_E_INDEX, 'dof_y = 5, needs 1 .. 4', 'an unbalance on dof 5')
      call works(plain%new(1), 'a plain structure')
      call bad(plain%damped_modes(eigenvalue, diameter=13), HBVIB_E_ARGUMENT, 'diameter = 13', 'a diameter of no wheel')
      call works(plain%free(), 'free')
      call bad(model%damped_modes(none), HBVIB_E_DIMENSION, 'count = 0', 'no mode')
      call bad(model%damped_modes(eigenvalue, shapes), HBVIB_E_DIMENSION, 'shapes', 'shapes of another length')
      call bad(model%damped_modes(eigenvalue, contacts=7), HBVIB_E_ARGUMENT, 'contacts = 7', 'contacts in no state')
      call bad(model%campbell([0.5_dp, 0.2_dp], omega), HBVIB_E_ARGUMENT, 'speeds[', 'falling speeds')
      call bad(model%campbell([0.5_dp], omega), HBVIB_E_DIMENSION, 'omega', 'frequencies of another length')
      call bad(model%campbell_crossings([0.2_dp, 0.5_dp], 1, 0, at, frequency, found), HBVIB_E_ARGUMENT, 'engine_order = 0', &
               'engine order 0')
      ! The first of several faults is told, whatever is right beside it.
      call works(model%forced_response(branch, 2*pi*207, 2*pi*207, tolerance=o, harmonics=3), 'a response')
      parameters(1)%contact = 9
      parameters(2)%contact = 1
      call bad(model%sensitivity(branch, 1, parameters, derivatives), HBVIB_E_INDEX, 'contact = 9, needs 1 .. 1', 'no contact')
      call bad(model%verify(branch, 0, harmonics=harmonics), HBVIB_E_INDEX, 'point = 0', 'point 0')
   end subroutine misuse
end program modes_and_damping
