! Wear over a life, sweeps in time, run-ups, missions and Campbell diagrams by amplitude: stored values, each other, and misuse.
program wear_and_passages
   use common
   implicit none
   real(dp), parameter :: e = 1
   type(hbvib_model) :: model
   type(hbvib_branch) :: mode

   call lives()
   call passages()
   call verdict(45)

contains

   !> m = 1 on a spring of 1, damping, a slider and a force.
   subroutine oscillator(damping, kt, mu, load, force)
      real(dp), intent(in) :: damping, kt, mu, load, force
      type(hbvib_contact) :: friction
      call works(model%new(1), 'an oscillator')
      call works(model%set_matrix(HBVIB_MASS, reshape([e], [1, 1])), 'its mass')
      call works(model%set_matrix(HBVIB_STIFFNESS, reshape([e], [1, 1])), 'its stiffness')
      call works(model%set_matrix(HBVIB_DAMPING, reshape([damping], [1, 1])), 'its damping')
      friction%kind = HBVIB_JENKINS
      friction%dof_a(1) = 1
      friction%kt = kt
      friction%mu = mu
      friction%preload = load
      call works(model%add_contact(friction), 'a slider')
      call works(model%add_force(1, 1, force), 'a force')
   end subroutine oscillator

   !> The stored row of ten cycles with one harmonic.
   subroutine lives()
      real(dp), allocatable :: loads(:, :), depths(:, :), works_of(:, :), amplitude(:), omega_at(:), event_cycles(:)
      integer, allocatable :: event_kind(:), event_contact(:)
      real(dp) :: limit
      type(hbvib_life_info) :: info
      type(hbvib_best_load) :: best
      integer(c_int32_t) :: status
      call oscillator(0.05_dp, e, 0.3_dp, 0.6_dp, 0.3_dp)
      call works(model%life([1], [0.05_dp], [0*e, 10*e], loads, info, omega=[1.1_dp], depths=depths, works=works_of, &
                            amplitude=amplitude, omega_at=omega_at, stiffness=reshape([e], [1, 1]), accuracy=1e-8_dp, &
                            harmonics=1), 'a life')
      call expect('loads are those of the stored row', abs(loads(1, 2) - 0.29957673568767756_dp) < 1e-6_dp)
      call expect('they fall by stiffness times depth', abs(loads(1, 1) - loads(1, 2) - depths(1, 2)) < 1e-12_dp)
      call expect('works and amplitudes are told', works_of(1, 1) > 0 .and. amplitude(2) > amplitude(1))
      call expect('frequencies and numbers are told', all(abs(omega_at - 1.1_dp) < 1e-14_dp) .and. info%points == 2)
      limit = 0.5_dp*sum(amplitude)
      call works(model%life([1], [0.05_dp], [10*e], loads, omega=[1.1_dp], event_cycles=event_cycles, event_kind=event_kind, &
                            event_contact=event_contact, stiffness=reshape([e], [1, 1]), limit=limit, harmonics=1), 'a limit')
      call expect('its crossing is an event', size(event_kind) == 1 .and. all(event_kind == HBVIB_LIFE_LIMIT))
      call expect('of no contact', all(event_contact == 0) .and. all(event_cycles > 0 .and. event_cycles < 10))
      call works(model%life([1], [0.05_dp], [2*e], loads, peak=[0.6_dp, 2*e], stiffness=reshape([e], [1, 1]), harmonics=1), &
                 'a life in the peak')
      call expect('its load falls', loads(1, 1) < 0.6_dp .and. loads(1, 1) > 0)
      call works(model%best_load_for_life([1], [0.05_dp], 8*e, 0.2_dp, 3*e, best, peak=[0.6_dp, 2*e], &
                                          stiffness=reshape([e], [1, 1]), harmonics=1), 'a best load')
      call expect('it lies between the factors', best%factor > 0.2_dp .and. best%factor < 3 .and. best%lives > 9)
      status = model%life([2], [0.05_dp], [2*e], loads, omega=[1.1_dp], harmonics=1)
      call refused(status, HBVIB_E_INDEX, 'contact(1) = 2', 'a contact that is not there')
      status = model%life([1], [0.05_dp, e], [2*e], loads, omega=[1.1_dp], harmonics=1)
      call refused(status, HBVIB_E_DIMENSION, 'rate', 'a rate too many')
      call works(model%free(), 'free')
   end subroutine lives

   subroutine passages()
      type(hbvib_sweep_info) :: swept
      type(hbvib_run_up_info) :: up
      real(dp), allocatable :: time(:), omega(:), amplitude(:), modal(:), begin(:), cycles(:), damage(:), rows(:, :)
      real(dp), allocatable :: speed(:), steady(:), damping_ratio(:), passed(:), relative(:), fundamental(:)
      real(dp) :: error
      integer(c_int32_t) :: status
      call oscillator(0.02_dp, 0.2_dp, 0.1_dp, e, 0.12_dp)
      call works(model%nonlinear_mode(mode, -2*e, 0.8_dp, tolerance=0*e, harmonics=5), 'a mode')
      call works(model%time_sweep(0.8_dp, 1.3_dp, 1e-3_dp, swept, dof=1, time=begin, amplitude=amplitude), 'a sweep')
      call expect('it has the stored largest displacement', abs(swept%largest - 1.2906469169955745_dp) < 1e-9_dp)
      call expect('it is that of a turn', abs(maxval(amplitude) - swept%largest) < 1e-14_dp .and. size(begin) == 84)
      call works(mode%run_up(model, 0.8_dp, 1.3_dp, 1e-3_dp, up, time=time, omega=omega, amplitude=amplitude, &
                             modal_amplitude=modal), 'a run-up')
      call expect('it is that of the sweep', abs(up%largest/swept%largest - 1) <= up%error .and. up%error < 1e-3_dp)
      call expect('it has as many turns', size(time) == size(begin) .and. all(modal > 0) .and. abs(omega(1) - 0.8_dp) < 1e-14_dp)
      call expect('turns were integrated', up%integrated > 0)
      call works(mode%run_up(model, 0.8_dp, 1.3_dp, 1e-3_dp, up, integrated_turns=0), 'the slow flow alone')
      call expect('it tells so', up%integrated == 0 .and. abs(up%slow_flow - up%largest) < 1e-15_dp)
      call works(mode%mission(model, [0*e, 1e4_dp, 2e4_dp], [0.8_dp, 1.3_dp, 0.8_dp], amplitude, edges=[0.5_dp, e], cycles=cycles, &
                              stresses=[80*e], woehler=[100*e, 2e6_dp, 5*e, 0*e], damage=damage, passages=rows, error=error), &
                 'a mission')
      call expect('it passes twice', size(rows, 2) == 2 .and. size(amplitude) == 3 .and. size(cycles) == 3)
      call expect('it does damage', damage(1) > 0 .and. abs(error) < 0.01_dp)
      call works(mode%campbell_response(model, speed, omega, steady, damping_ratio, passed, relative, engine_order=2*e, &
                                        acceleration=5e-4_dp, force_factors=[0.5_dp, e]), 'a diagram')
      call expect('a resonance for each factor', size(speed) == 2 .and. all(abs(omega - 2*speed) < 1e-14_dp))
      call works(mode%synthesis_peaks(model, amplitude=fundamental), 'resonances')
      call expect('it is the highest resonance', abs(steady(2) - maxval(fundamental)) < 1e-12_dp .and. all(damping_ratio > 0))
      ! That of a run-up has all harmonics.
      call expect('it is about that of the run-up', abs(steady(2)/up%steady - 1) < 0.02_dp)
      call expect('a passage stays below', all(passed < steady) .and. all(abs(relative) < 0.01_dp))
      status = mode%run_up(model, 0.8_dp, 1.3_dp, 0*e, up)
      call refused(status, HBVIB_E_ARGUMENT, 'rate = 0', 'no rate')
      status = mode%run_up(model, 0.8_dp, 1.3_dp, e, up, dof=2)
      call refused(status, HBVIB_E_INDEX, 'dof = 2', 'a degree of freedom that is not there')
      status = mode%campbell_response(model, speed, engine_order=0*e)
      call refused(status, HBVIB_E_ARGUMENT, 'engine_order = 0', 'no engine order')
      call works(mode%free(), 'free')
      call works(model%free(), 'free')
   end subroutine passages
end program wear_and_passages
