! Wrong arguments are refused in the library's words, in indices from 1, and leave the model as it was.
module stopping
   use hbvib
   implicit none
contains
   !> Stops after as many points as user points to.
   function stop_at(user, progress) bind(c) result(stop)
      type(c_ptr), value :: user
      type(hbvib_progress), intent(in) :: progress
      integer(c_int32_t) :: stop
      integer, pointer :: most
      call c_f_pointer(user, most)
      stop = merge(1_c_int32_t, 0_c_int32_t, progress%point >= most)
   end function stop_at

   !> Counts the lines in user's target.
   subroutine count_lines(user, level, message) bind(c)
      type(c_ptr), value :: user
      integer(c_int32_t), value :: level
      type(c_ptr), value :: message
      integer, pointer :: lines(:)
      character(:), allocatable :: text
      call c_f_pointer(user, lines, [2])
      text = hbvib_text(message)
      lines(1) = lines(1) + 1
      if (level >= HBVIB_LOG_WARN .and. len(text) > 0) lines(2) = lines(2) + 1
   end subroutine count_lines
end module stopping

program misuse
   use common
   use stopping
   implicit none
   type(hbvib_model) :: model, copy, stale
   type(hbvib_branch) :: branch
   type(solution) :: reference
   type(hbvib_contact) :: contact

   call ring_damper(model)
   call works(solve(model, reference), 'the reference case')
   call defaults()
   call indices()
   call shapes()
   call matrices()
   call hooks()
   call results()
   call handles()
   call verdict(220)

contains

   !> After a refusal the model must still give the same bits.
   subroutine bad(status, wanted, words, claim)
      integer(c_int32_t), intent(in) :: status
      integer(c_int32_t), intent(in) :: wanted
      character(*), intent(in) :: words, claim
      type(solution) :: again
      call refused(status, wanted, words, claim)
      call works(solve(model, again), 'a solve after: '//claim)
      call expect('the model solves to the same bits after: '//claim, same(again, reference))
   end subroutine bad

   !> A struct of Fortran starts as its _init function fills it, but for indices that count from 1.
   subroutine defaults()
      type(hbvib_solver_options) :: s, s0
      type(hbvib_contact) :: c, c0
      type(hbvib_mode_options) :: m, m0
      type(hbvib_time_options) :: t, t0
      type(hbvib_synthesis_options) :: y, y0
      type(hbvib_verify_options) :: v, v0
      call works(hbvib_solver_options_init(s, c_sizeof(s)), 'init')
      call expect('solver options are ready', same_bytes(transfer(s, [0_c_int8_t]), transfer(s0, [0_c_int8_t])))
      call works(hbvib_contact_init(c, c_sizeof(c)), 'init')
      call expect('contacts are ready', same_bytes(transfer(c, [0_c_int8_t]), transfer(c0, [0_c_int8_t])))
      call works(hbvib_time_options_init(t, c_sizeof(t)), 'init')
      call expect('time options are ready', same_bytes(transfer(t, [0_c_int8_t]), transfer(t0, [0_c_int8_t])))
      call works(hbvib_synthesis_options_init(y, c_sizeof(y)), 'init')
      call expect('synthesis options are ready', same_bytes(transfer(y, [0_c_int8_t]), transfer(y0, [0_c_int8_t])))
      call works(hbvib_verify_options_init(v, c_sizeof(v)), 'init')
      call expect('options of a check are ready', same_bytes(transfer(v, [0_c_int8_t]), transfer(v0, [0_c_int8_t])))
      call works(hbvib_mode_options_init(m, c_sizeof(m)), 'init')
      m%mode_index = m%mode_index + 1
      call expect('mode options are ready', same_bytes(transfer(m, [0_c_int8_t]), transfer(m0, [0_c_int8_t])))
      call sizes()
   end subroutine defaults

   subroutine sizes()
      type(hbvib_matrix) :: a
      type(hbvib_user_force) :: u
      type(hbvib_jacobian_gap) :: j
      type(hbvib_forced_options) :: f
      type(hbvib_hooks) :: h
      type(hbvib_view) :: v
      type(hbvib_reduction) :: q
      type(hbvib_energies) :: e
      type(hbvib_contact_summary) :: c
      type(hbvib_mode_point) :: p
      type(hbvib_mode_info) :: i
      type(hbvib_time_info) :: t
      type(hbvib_verification) :: w, w0
      call works(hbvib_verification_init(w, c_sizeof(w)), 'init')
      call expect('what a check tells is ready', same_bytes(transfer(w, [0_c_int8_t]), transfer(w0, [0_c_int8_t])))
      call expect('every struct knows its size', all([a%struct_size, u%struct_size, j%struct_size, f%struct_size, h%struct_size, &
                  v%struct_size, q%struct_size, e%struct_size, c%struct_size, p%struct_size, i%struct_size, t%struct_size] == &
                  [c_sizeof(a), c_sizeof(u), c_sizeof(j), c_sizeof(f), c_sizeof(h), c_sizeof(v), c_sizeof(q), c_sizeof(e), &
                  c_sizeof(c), c_sizeof(p), c_sizeof(i), c_sizeof(t)]))
   end subroutine sizes

   pure function same_bytes(a, b)
      integer(c_int8_t), intent(in) :: a(:), b(:)
      logical :: same_bytes
      same_bytes = size(a) == size(b) .and. all(a == b)
   end function same_bytes

   subroutine indices()
      type(hbvib_solver_options) :: solver
      type(hbvib_model) :: ring
      call bad(model%add_force(0, 1, 1._dp), HBVIB_E_INDEX, 'dof = 0, needs 1 .. 4', 'a force on dof 0')
      call expect('the argument number is told', hbvib_last_error_argument() == 0) ! the solve was a success
      call refused(model%add_force(5, 1, 1._dp), HBVIB_E_INDEX, 'dof = 5, needs 1 .. 4', 'a force on dof 5')
      call expect('the argument number is told', hbvib_last_error_argument() == 2)
      call bad(model%add_force(-1, 1, 1._dp), HBVIB_E_INDEX, 'dof = -1', 'a force on the ground')
      contact = hbvib_contact(kind=HBVIB_JENKINS, kt=1._dp, mu=1._dp, preload=1._dp)
      contact%dof_a(1) = 0
      call bad(model%add_contact(contact), HBVIB_E_INDEX, 'dof_a(1) = 0, needs 1 .. 4', 'a contact on dof 0')
      contact%dof_a(1) = 4294967297_c_int64_t
      call bad(model%add_contact(contact), HBVIB_E_INDEX, 'dof_a(1) = 4294967297, needs 1 .. 4', 'a contact on dof 2**32 + 1')
      contact%dof_a(1) = 5
      call bad(model%add_contact(contact), HBVIB_E_INDEX, 'dof_a(1) = 5, needs 1 .. 4', 'a contact on dof 5')
      call bad(model%add_jenkins([1, 0], [1._dp, 1._dp], [1._dp, 1._dp], [1._dp, 1._dp]), HBVIB_E_INDEX, &
               'dof_a(2) = 0', 'a list with dof 0')
      call bad(model%fix([0]), HBVIB_E_INDEX, 'dofs(1) = 0, needs 1 .. 4', 'dof 0 that is fixed')
      call bad(model%fix([1, 5]), HBVIB_E_INDEX, 'dofs(2) = 5, needs 1 .. 4', 'dof 5 that is fixed')
      call refused(ring%from_sector(3, 10, 1, reshape([1], [1, 1]), reshape([4], [1, 1])), HBVIB_E_INDEX, &
                   'right(1) = 4, needs 1 .. 3', 'a face with dof 4')
      call refused(ring%from_sector(3, 10, 1, reshape([1], [1, 1]), reshape([2], [1, 1]), fixed=[5]), HBVIB_E_INDEX, &
                   'fixed(1) = 5, needs 1 .. 3', 'dof 5 of a sector')
      call bad(model%set_preload(0, 1._dp), HBVIB_E_INDEX, 'id = 0, needs 1 .. 1', 'contact 0')
      call bad(model%set_preload(2, 1._dp), HBVIB_E_INDEX, 'id = 2, needs 1 .. 1', 'contact 2')
      solver%tolerance = 0
      solver%response_dof = 0
      call bad(model%forced_response(branch, 1300._dp, 1320._dp, solver), HBVIB_E_INDEX, 'response_dof = 0, needs 1 .. 4', &
               'response_dof 0')
      call expect('no branch after a refusal', .not. c_associated(branch%handle))
      call bad(model%nonlinear_mode(branch, -6._dp, -5._dp, hbvib_mode_options(mode_index=0)), HBVIB_E_INDEX, &
               'mode_index = 0, needs 1 .. 4', 'mode 0')
      call bad(model%add_polynomial([1], [2], [1._dp]), HBVIB_E_INDEX, 'direction(1) = 2, needs 1 .. 1', 'a direction')
      call bad(model%add_force(1, 1, ieee_nan()), HBVIB_E_NOT_FINITE, '', 'a force that is no number')
   end subroutine indices

   function ieee_nan() result(x)
      real(dp) :: x
      x = transfer(int(z'7FF8000000000000', c_int64_t), x)
   end function ieee_nan

   subroutine shapes()
      real(dp) :: a(3, 4), omega(2), one(1)
      complex(dp) :: phi(4, 3)
      a = 0
      one = 1
      call bad(model%set_matrix(HBVIB_MASS, a), HBVIB_E_DIMENSION, '3', 'a mass of 3 x 4')
      call bad(model%set_coupling(HBVIB_STIFFNESS, a), HBVIB_E_DIMENSION, '3', 'a coupling of 3 x 4')
      call bad(model%add_jenkins([1, 2], one, [1._dp, 1._dp], [1._dp, 1._dp]), HBVIB_E_DIMENSION, 'kt = 2, needs 1 .. 1', &
               'lists of unequal length')
      call bad(model%add_table(1, 2, [0._dp, 1._dp], one), HBVIB_E_DIMENSION, 'force', 'a table of unequal length')
      call bad(model%linear_modes(omega, phi), HBVIB_E_DIMENSION, 'shapes(1, :)', 'three shapes of two modes')
      call bad(model%set_matrix(HBVIB_MASS, int([1, 2, 3, 4, 5], c_int64_t), int([1, 2, 3, 4], c_int64_t), one), &
               HBVIB_E_DIMENSION, 'values', 'sparse columns without numbers')
      call bad(model%set_matrix(HBVIB_MASS, int([1, 2, 3, 4, 5], c_int64_t), int([1, 2, 0, 4], c_int64_t), [1._dp, 1._dp, &
               1._dp, 1._dp]), HBVIB_E_INDEX, '', 'row 0 of a sparse matrix')
   end subroutine shapes

   !> One matrix in all its forms, from sections of larger arrays too, gives one model.
   subroutine matrices()
      real(dp) :: big(9, 11), stiffness(4, 4)
      complex(dp) :: z(4, 4)
      type(solution) :: again
      integer :: i, j
      integer(c_int64_t) :: rows(16), starts(5)
      stiffness = 0
      stiffness(1:2, b2) = [2e6_dp, -2e6_dp]
      stiffness(1:3, b1) = [-2e6_dp, 3e6_dp, -1e6_dp]
      stiffness(2:3, d) = [-1e6_dp, 101.6e6_dp]
      stiffness(r, r) = 4e7_dp
      big = -7
      big(3:6, 2:5) = stiffness
      call works(model%set_matrix(HBVIB_STIFFNESS, big(3:6, 2:5)), 'a section')
      call expect('a section is read by its leading dimension', solve(model, again) == HBVIB_OK .and. same(again, reference))
      big(9:1:-2, 1:9:2) = 0
      big(8:2:-2, 1:7:2) = stiffness
      call works(model%set_matrix(HBVIB_STIFFNESS, big(8:2:-2, 1:7:2), HBVIB_GENERAL), 'a section with gaps')
      call expect('a section with gaps is copied', solve(model, again) == HBVIB_OK .and. same(again, reference))
      z = stiffness
      call works(model%set_matrix(HBVIB_STIFFNESS, z), 'a complex matrix')
      call expect('a complex matrix is the real one', solve(model, again) == HBVIB_OK .and. &
                  maxval(abs(again%amplitude/reference%amplitude - 1)) < 1e-12_dp)
      rows = [((int(i, c_int64_t), i=1, 4), j=1, 4)]
      starts = [1, 5, 9, 13, 17]
      call works(model%set_matrix(HBVIB_STIFFNESS, starts, rows, reshape(stiffness, [16])), 'sparse columns')
      call expect('sparse columns are the dense ones', solve(model, again) == HBVIB_OK .and. same(again, reference))
      call waves(stiffness)
      stiffness(1, 2) = ieee_nan()
      call bad(model%set_matrix(HBVIB_STIFFNESS, stiffness), HBVIB_E_NOT_FINITE, '[1,2]', 'a matrix with NaN')
      stiffness(1, 2) = 5
      call bad(model%set_matrix(HBVIB_STIFFNESS, stiffness), HBVIB_E_NOT_HERMITIAN, '', 'a matrix without symmetry')
   end subroutine matrices

   !> A wheel given wave by wave, or with both couplings, is the wheel given by sectors.
   subroutine waves(stiffness)
      real(dp), intent(in) :: stiffness(4, 4)
      type(hbvib_model) :: wheel
      type(solution) :: again
      real(dp) :: coupling(4, 4)
      complex(dp) :: wide(5, 4)
      integer(c_int64_t), parameter :: starts(5) = [1, 1, 1, 2, 3], rows(2) = [3, 4]
      integer :: n
      coupling = 0
      coupling(d, d) = -5e7_dp
      coupling(r, r) = -2e7_dp
      call works(model%clone(wheel), 'a clone')
      call works(wheel%set_coupling(HBVIB_STIFFNESS, transpose(coupling), previous=.true.), 'the previous sector')
      call expect('the coupling to the previous sector is the transpose', &
                  solve(wheel, again) == HBVIB_OK .and. same(again, reference))
      call refused(wheel%set_coupling(HBVIB_MASS, coupling, previous=.true.), HBVIB_E_UNSUPPORTED, 'mass', &
                   'a mass coupled to the previous sector')
      call works(wheel%set_coupling(HBVIB_STIFFNESS, 2*coupling, previous=.true.), 'twice the coupling')
      call expect('another coupling is another wheel', solve(wheel, again) /= HBVIB_OK .or. .not. same(again, reference))
      call works(model%clone(wheel), 'a clone')
      call works(wheel%set_coupling(HBVIB_STIFFNESS, starts, rows, [-5e7_dp, -2e7_dp], HBVIB_GENERAL), 'a sparse coupling')
      call expect('a sparse coupling is the dense one', solve(wheel, again) == HBVIB_OK .and. same(again, reference))
      call works(wheel%new(4, 24), 'a wheel')
      call works(wheel%set_rayleigh(0._dp, 1.5e-6_dp), 'damping')
      call works(wheel%set_wave(2), 'engine order')
      call works(wheel%add_force(b2, 1, 5._dp), 'force')
      call works(wheel%add_force(b1, 1, 5._dp), 'force')
      contact = hbvib_contact(kind=HBVIB_JENKINS, kt=5e7_dp, mu=0.3_dp, preload=0.03_dp*0.165_dp*(3000*2*pi/60)**2)
      contact%dof_a(1) = d
      contact%dof_b(1) = r
      call works(wheel%add_contact(contact), 'contact')
      do n = 0, 12
         wide = 7
         wide(1:4, :) = stiffness + 2*coupling*cos(2*pi*n/24)
         call works(wheel%set_matrix(HBVIB_STIFFNESS, wide(1:4, :), diameter=n), 'the stiffness of a wave')
         call works(wheel%set_matrix(HBVIB_MASS, starts(1) + int([0, 1, 2, 3, 4], c_int64_t), int([1, 2, 3, 4], c_int64_t), &
                                     cmplx([0.2_dp, 0.3_dp, 1.2_dp, 0.03_dp], 0, dp), diameter=n), 'the mass of a wave')
      end do
      call works(solve(wheel, again), 'the wheel wave by wave')
      call expect('a wheel wave by wave has the response of its sectors', size(again%harmonics) == size(reference%harmonics) &
                  .and. maxval(abs(again%harmonics(b2, :) - reference%harmonics(b2, :))) < 1e-6_dp*abs(reference%harmonics(b2, 1)))
      call works(wheel%free(), 'free')
   end subroutine waves

   subroutine hooks()
      type(hbvib_branch) :: whole
      integer, target :: most, lines(2)
      integer(c_int32_t), target :: flag
      most = 5
      lines = 0
      flag = 1
      call works(model%forced_response(whole, 2*pi*207, 2*pi*211), 'the whole run')
      call expect('progress stops a run', model%forced_response(branch, 2*pi*207, 2*pi*211, &
                  hooks=hbvib_hooks(progress=stop_at, user=c_loc(most))) == HBVIB_STOPPED_BY_CALLER)
      call expect('the status stays with the branch', branch%status() == HBVIB_STOPPED_BY_CALLER)
      call expect('the points found are there', branch%points() == most)
      call expect('they are fewer than the whole run''s', most < whole%points())
      call works(model%forced_response(branch, 2*pi*207, 2*pi*211, hooks=hbvib_hooks(log=count_lines, &
                 log_level=HBVIB_LOG_DEBUG, user=c_loc(lines))), 'a run with a log')
      call expect('the log has lines with words', lines(1) > 0 .and. lines(1) == lines(2))
      call expect('the flag stops a run', model%forced_response(branch, 2*pi*207, 2*pi*211, &
                  hooks=hbvib_hooks(cancel=c_loc(flag))) == HBVIB_STOPPED_BY_CALLER)
      call works(whole%free(), 'free')
   end subroutine hooks

   !> Pointers lie on the library's memory, and wrong numbers of points are told from 1.
   subroutine results()
      real(dp), pointer :: x(:), again(:), slip(:, :)
      real(dp), allocatable :: omega(:), amplitude(:)
      real(dp) :: share(1), times(8), few(3)
      integer, allocatable :: point(:)
      complex(dp), allocatable :: harmonics(:, :)
      complex(dp) :: part(2, 0:9)
      type(hbvib_view) :: view
      type(hbvib_reduction) :: reduction
      type(c_ptr) :: first, second
      call works(model%forced_response(branch, 2*pi*207, 2*pi*211, hbvib_solver_options(tolerance=0._dp, response_dof=b2), &
                 at=[2*pi*208, 2*pi*209]), 'a run')
      call works(hbvib_branch_field(branch%handle, HBVIB_OMEGA, view), 'the view of C')
      call works(branch%field(HBVIB_OMEGA, x), 'a pointer')
      call works(branch%field(HBVIB_OMEGA, again), 'a second pointer')
      first = c_loc(x(1))
      second = c_loc(again(1))
      call expect('the pointer has the address that C has', c_associated(first, view%data))
      call expect('two pointers have one address', c_associated(first, second))
      call expect('the pointer is as long as the curve', size(x) == branch%points())
      call expect('the pointer is an array', maxval(x) <= 2*pi*211 .and. abs(x(1)/(2*pi*207) - 1) < 1e-15_dp .and. &
                  sum(x)/size(x) > 2*pi*207)
      call works(branch%field(HBVIB_SLIP_FRACTION, slip), 'slip')
      call works(branch%slip_fraction(branch%points(), share), 'slip of a point')
      call expect('slip is (contact, point)', all(shape(slip) == [1, size(x)]) .and. abs(slip(1, size(x)) - share(1)) <= 0)
      call bad(branch%field(HBVIB_SLIP_FRACTION, x), HBVIB_E_DIMENSION, 'shape(x) = 2, needs 1 .. 1', 'slip as a list')
      call bad(branch%field(HBVIB_ENERGY, x), HBVIB_E_ARGUMENT, '', 'energy of a forced response')
      call works(branch%peaks(omega, amplitude, point), 'peaks')
      call works(branch%harmonics(point(1), harmonics), 'harmonics')
      call expect('harmonics are (dof, 0:H)', all(lbound(harmonics) == [1, 0]) .and. all(ubound(harmonics) == [4, 9]))
      call expect('the peak is that of the response dof', abs(abs(harmonics(b2, 1))/amplitude(1) - 1) < 1e-12_dp)
      call works(branch%harmonics_into(point(1), d, part), 'harmonics of two dofs')
      call expect('a range of dofs', maxval(abs(part - harmonics(d:r, :))) <= 0)
      call works(branch%at(2, amplitude, point), 'at')
      call works(branch%harmonics(point(1), harmonics), 'harmonics at 209 Hz')
      call expect('the solution wanted', abs(abs(harmonics(b2, 1))/amplitude(1) - 1) < 1e-12_dp .and. size(point) == 1)
      call works(branch%reduction(reduction), 'reduction')
      call expect('the response dof counts from 1', reduction%response_dof == b2)
      call bad(branch%at(3, amplitude), HBVIB_E_INDEX, 'wanted = 3, needs 1 .. 2', 'a third solution')
      call bad(branch%at(0, amplitude), HBVIB_E_INDEX, 'wanted = 0, needs 1 .. 2', 'solution 0')
      call bad(branch%harmonics(0, harmonics), HBVIB_E_INDEX, 'point = 0', 'point 0')
      call works(branch%time_history(point(1), b2, times), 'the last point that is stored')
      call bad(branch%time_history(point(1) + 1, b2, times), HBVIB_E_INDEX, 'point = ', 'a point beyond the last')
      call bad(branch%time_history(1, 0, times), HBVIB_E_INDEX, 'dof = 0, needs 1 .. 4', 'the motion of dof 0')
      call bad(branch%contact_loop(1, 0, times), HBVIB_E_INDEX, 'contact = 0, needs 1 .. 1', 'the loop of contact 0')
      call bad(branch%contact_loop(1, 1, times, direction=2), HBVIB_E_INDEX, 'direction = 2, needs 1 .. 1', 'direction 2')
      call bad(branch%contact_loop(1, 1, times, few), HBVIB_E_DIMENSION, 'force', 'a loop of unequal arrays')
      call bad(branch%contact_loop(1, 1), HBVIB_E_NULL, '', 'a loop into nothing')
      call bad(branch%slip_fraction(1, few), HBVIB_E_DIMENSION, '', 'slip of three contacts')
   end subroutine results

   subroutine handles()
      type(solution) :: again
      call works(model%clone(copy), 'a clone')
      stale = copy
      call works(copy%clear_forces(), 'forces of the clone')
      call expect('a clone is a model of its own', solve(model, again) == HBVIB_OK .and. same(again, reference))
      call works(copy%free(), 'free')
      call works(copy%free(), 'freeing an empty variable')
      copy = model
      call works(model%clone(copy), 'a clone into a copy of the handle')
      call expect('it is another object', .not. c_associated(copy%handle, model%handle))
      call expect('the original is still there', solve(model, again) == HBVIB_OK .and. same(again, reference))
      call expect('and the clone solves alike', solve(copy, again) == HBVIB_OK .and. same(again, reference))
      call works(copy%free(), 'free')
      call expect('no text has no letters', hbvib_text(c_null_ptr) == '')
      call bad(stale%set_wave(1), HBVIB_E_HANDLE, '', 'a copy of a freed handle')
      call bad(stale%add_force(1, 1, 1._dp), HBVIB_E_HANDLE, '', 'a copy of a freed handle')
      call expect('a count of a freed model is a status', stale%dofs() == HBVIB_E_HANDLE)
      call bad(copy%set_wave(1), HBVIB_E_HANDLE, 'it is NULL', 'a freed model')
      call works(branch%free(), 'free')
      call expect('a freed branch has no points', branch%points() < 0)
      call expect('counts', all([model%dofs(), model%sectors(), model%contacts()] == [4, 24, 1]))
      stale%handle = branch%handle
      call bad(stale%free(), HBVIB_OK, '', 'freeing nothing')
      call works(model%free(), 'free')
   end subroutine handles

end program misuse
