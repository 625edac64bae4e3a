! Children of a branch: detached curves, doubled periods and localised modes of known systems; whom they belong to.
program all_solutions
   use common
   implicit none
   real(dp), parameter :: o = 0, e = 1
   type(hbvib_model) :: model
   type(hbvib_branch) :: branch
   type(hbvib_branch), allocatable :: children(:)
   type(hbvib_descent) :: descent
   type(hbvib_searched) :: searched

   call detached_curve()
   call doubled_period()
   call localised_modes()
   call lives_with_its_parent()
   call verdict(70)

contains

   !> m = 1 on a spring of 1 under a force.
   subroutine oscillator(damping, force)
      real(dp), intent(in) :: damping, force
      call works(model%new(1), 'an oscillator')
      call works(model%set_matrix(HBVIB_MASS, reshape([e], [1, 1])), 'its mass')
      call works(model%set_matrix(HBVIB_STIFFNESS, reshape([e], [1, 1])), 'its stiffness')
      call works(model%set_matrix(HBVIB_DAMPING, reshape([damping], [1, 1])), 'its damping')
      call works(model%add_force(1, 1, force), 'its force')
   end subroutine oscillator

   !> x'' + 0.05 x' - 0.05 x'**3 + 0.012 x'**5 + x = 0.015 cos(omega t). With one harmonic F = 0.05 a - 0.0375 a**3 + 0.0075 a**5 has
   !> the amplitude a at omega = 1; its maximum and its minimum are where the detached curve merges and where it is born.
   subroutine detached_curve()
      real(dp), parameter :: root = sqrt(0.1125_dp**2 - 4*0.0375_dp*0.05_dp)
      real(dp), allocatable :: upper(:), alone(:)
      integer :: k
      call oscillator(0.05_dp, 0.015_dp)
      call works(model%add_spring_damper(1, HBVIB_GROUND, damper=[o, o, -0.05_dp, o, 0.012_dp]), 'falling damping')
      call works(model%forced_response(branch, 0.9_dp, 1.1_dp, harmonics=1, branches=2, at=[e]), 'a search')
      call works(branch%at(1, alone), 'the motion of the sweep')
      call works(branch%children(children), 'its children')
      call expect('one closed curve', size(children) == 1 .and. size(alone) == 1)
      call expect('told as closed', children(1)%status() == HBVIB_STOPPED_CLOSED)
      call works(children(1)%descent(descent), 'its descent')
      call expect('it branches off nowhere', descent%kind == -1 .and. descent%bifurcation == -1 .and. descent%periods == 1)
      call expect('mode 1 leads to it', descent%mode == 1)
      call expect('its birth', abs(0.015_dp*descent%born_at_force - force((0.1125_dp + root)/0.075_dp)) < 1e-8_dp)
      call expect('its merging', abs(0.015_dp*descent%merges_at_force - force((0.1125_dp - root)/0.075_dp)) < 1e-8_dp)
      call works(children(1)%at(1, upper), 'its motions')
      call expect('two motions beside that of the sweep', size(upper) == 2)
      do k = 1, size(upper)
         call expect('each has the force', abs(force(upper(k)**2) - 0.015_dp) < 1e-9_dp)
      end do
      call expect('so has that of the sweep', abs(force(alone(1)**2) - 0.015_dp) < 1e-9_dp)
      call expect('none twice', all(upper > alone(1) + 0.1_dp) .and. abs(upper(1) - upper(size(upper))) > 0.1_dp)
      call works(branch%searched(searched), 'the search')
      call expect('the search along one mode is told', searched%modes == 1 .and. searched%incomplete_modes == 0)
      call works(branch%descent(descent), 'a descent')
      call expect('a branch that was asked for has none', descent%bifurcation == -1 .and. descent%mode == -1)
      call works(model%forced_response(branch, 0.9_dp, 1.1_dp, harmonics=1), 'no search')
      call works(branch%children(children), 'no children')
      call expect('nothing is sought unless asked', size(children) == 0)
   end subroutine detached_curve

   !> The force at the square of an amplitude.
   pure function force(squared)
      real(dp), intent(in) :: squared
      real(dp) :: force
      force = sqrt(squared)*(0.05_dp - 0.0375_dp*squared + 0.0075_dp*squared**2)
   end function force

   !> A stop that touches at rest. Harmonics 1 and 2 of half the frequency, 1.19, are those of event-driven integration.
   subroutine doubled_period()
      type(hbvib_contact) :: stop
      type(hbvib_model) :: longer
      type(hbvib_verification) :: info
      complex(dp), allocatable :: x(:, :)
      integer, allocatable :: point(:), kind(:)
      call oscillator(0.05_dp, e)
      stop%kind = HBVIB_UNILATERAL
      stop%dof_a(3) = 1
      stop%kn = 10
      call works(model%add_contact(stop), 'a stop')
      call works(model%forced_response(branch, 2.3_dp, 2.5_dp, harmonics=50, branches=1, branch_depth=1, most_branches=4, &
                                       at=[2.38_dp]), 'a search')
      call works(branch%children(children), 'its children')
      call expect('one of the double period', size(children) == 1)
      call works(children(1)%descent(descent), 'its descent')
      call works(branch%bifurcations(kind=kind), 'bifurcations of its parent')
      call expect('from the doubling of its parent', descent%periods == 2 .and. descent%bifurcation == 1 .and. &
                  descent%kind == HBVIB_BIFURCATION_PERIOD_DOUBLING .and. kind(1) == descent%kind)
      call works(children(1)%at(1, point=point), 'its motion')
      call works(children(1)%harmonics(point(1), x), 'its harmonics')
      call expect('half the frequency of the force', abs(abs(x(1, 1)) - 0.183236054604_dp) < 1e-6_dp)
      call expect('the frequency of the force', abs(abs(x(1, 2)) - 0.292415649854_dp) < 1e-6_dp)
      call works(model%longer_period(2, longer), 'the model of two periods')
      call works(longer%verify(children(1), point(1), info), 'the motion in time')
      call expect('it holds in time', info%same_solution == 1 .and. info%response_error < 1e-6_dp)
      call refused(model%longer_period(0, longer), HBVIB_E_ARGUMENT, 'periods = 0', 'no period')
      call expect('a refusal leaves the copy', longer%dofs() == 1)
      call works(longer%free(), 'free')
      call works(model%longer_period(2, model), 'a model in place of itself')
      call expect('it is there', model%contacts() == 1)
   end subroutine doubled_period

   !> Two masses on hardening springs with a weak one of c = 0.1 between: localised modes are born at a modal amplitude
   !> of sqrt(8 c/3).
   subroutine localised_modes()
      type(hbvib_mode_options) :: mode
      type(hbvib_mode_point) :: numbers
      type(hbvib_contact) :: cubic
      complex(dp), allocatable :: x(:, :)
      integer, allocatable :: point(:)
      integer :: dof
      call works(model%new(2), 'two masses')
      call works(model%set_matrix(HBVIB_MASS, reshape([e, o, o, e], [2, 2])), 'their masses')
      call works(model%set_matrix(HBVIB_STIFFNESS, reshape([1.1_dp, -0.1_dp, -0.1_dp, 1.1_dp], [2, 2])), 'their springs')
      do dof = 1, 2
         cubic = hbvib_contact()
         cubic%kind = HBVIB_CUBIC
         cubic%dof_a(1) = dof
         cubic%cubic = 1
         call works(model%add_contact(cubic), 'a hardening spring')
      end do
      mode%mode_index = 2
      mode%branches = 1
      call works(model%nonlinear_mode(branch, -e, 0.5_dp, mode, harmonics=1), 'the opposed mode')
      call works(branch%bifurcations(point=point), 'its branch points')
      call expect('one branch point', size(point) == 1)
      call works(branch%mode_point(point(1), numbers), 'its numbers')
      call expect('that of the closed form', abs(numbers%modal_amplitude - sqrt(0.8_dp/3)) < 1e-7_dp)
      call works(branch%children(children), 'localised modes')
      call expect('both of them', size(children) == 2)
      call works(children(2)%harmonics(children(2)%points(), x), 'a localised motion')
      call expect('the product of both motions', abs(real(x(1, 1)*x(2, 1), dp) + 0.4_dp/3) < 1e-8_dp)
      call works(children(1)%descent(descent), 'its descent')
      call expect('from that branch point', descent%bifurcation == 1 .and. descent%internal_resonance == 0)
   end subroutine localised_modes

   !> A guard, a free of a child, and a variable that is used again do no harm to the parent.
   subroutine lives_with_its_parent()
      type(hbvib_branch), allocatable :: none(:)
      type(hbvib_branch) :: kept
      call guarded()
      kept = children(1)
      call refused(children(1)%free(), HBVIB_E_ARGUMENT, 'parent', 'a free of a child')
      call expect('it lives', kept%points() > 1)
      call works(model%nonlinear_mode(children(2), -2*e, -e, harmonics=1), 'a mode in the variable of a child')
      call expect('the first child lives', kept%points() > 1)
      call works(children(2)%free(), 'free of that mode')
      call works(branch%free(), 'free of the parent')
      call expect('it frees its children', kept%points() == HBVIB_E_HANDLE)
      call refused(branch%children(none), HBVIB_E_HANDLE, 'NULL', 'children of no branch')
      call refused(kept%children(none), HBVIB_E_HANDLE, 'freed', 'children of a child that is gone')
      call expect('nothing is allocated', .not. allocated(none))
      call refused(kept%descent(descent), HBVIB_E_HANDLE, 'freed', 'its descent')
      call refused(kept%searched(searched), HBVIB_E_HANDLE, 'freed', 'its search')
   end subroutine lives_with_its_parent

   subroutine guarded()
      type(hbvib_guard) :: scope
      call scope%keep(children(1))
   end subroutine guarded
end program all_solutions
