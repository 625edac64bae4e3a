! Results against what is known otherwise: closed forms, balances of work, and one law said in several ways.
module own_forces
   use hbvib
   implicit none
   real(c_double), target :: duffing(2) = [1._c_double, 0.5_c_double]
contains
   !> f = k y + k3 y**3, user's target being [k, k3].
   function cubic_spring(user, asked) bind(c) result(refusal)
      type(c_ptr), value :: user
      type(hbvib_force_call), intent(in) :: asked
      integer(c_int32_t) :: refusal
      real(c_double), pointer :: k(:)
      real(c_double), pointer, contiguous :: u(:, :), f(:, :), df_du(:, :, :), v(:, :), z0(:)
      call c_f_pointer(user, k, [2])
      call hbvib_force_arrays(asked, u, v=v, f=f, df_du=df_du, z0=z0)
      refusal = merge(-9_c_int32_t, 0_c_int32_t, associated(v) .or. associated(z0))
      f = k(1)*u + k(2)*u**3
      df_du(1, :, :) = k(1) + 3*k(2)*u**2
   end function cubic_spring

   !> f1 = u1 u2**2 + v2, f2 = u1**2.
   function lopsided(user, asked) bind(c) result(refusal)
      type(c_ptr), value :: user
      type(hbvib_force_call), intent(in) :: asked
      integer(c_int32_t) :: refusal
      real(c_double), pointer, contiguous :: u(:, :), v(:, :), f(:, :), df_du(:, :, :), df_dv(:, :, :)
      call hbvib_force_arrays(asked, u, v, f, df_du, df_dv)
      f(1, :) = u(1, :)*u(2, :)**2 + v(2, :)
      f(2, :) = u(1, :)**2
      df_du(1, 1, :) = u(2, :)**2
      df_du(2, 1, :) = 2*u(1, :)*u(2, :)
      df_du(1, 2, :) = 2*u(1, :)
      df_dv(2, 1, :) = 1
      refusal = merge(-1_c_int32_t, 0_c_int32_t, c_associated(user))
   end function lopsided

   !> A state that leaks: z_j = 0.5 z_(j-1) + u_j, f = z.
   function leaking(user, asked) bind(c) result(refusal)
      type(c_ptr), value :: user
      type(hbvib_force_call), intent(in) :: asked
      integer(c_int32_t) :: refusal
      real(c_double), pointer, contiguous :: u(:, :), f(:, :), z0(:), z(:, :), dz_dz(:, :, :), dz_du(:, :, :), df_dz(:, :, :)
      integer :: j
      call hbvib_force_arrays(asked, u, f=f, z0=z0, z=z, dz_dz=dz_dz, dz_du=dz_du, df_dz=df_dz)
      z(:, 1) = 0.5_c_double*z0 + u(:, 1)
      do j = 2, size(z, 2)
         z(:, j) = 0.5_c_double*z(:, j - 1) + u(:, j)
      end do
      f = z
      dz_dz = 0.5_c_double
      dz_du = 1
      df_dz = 1
      refusal = merge(-1_c_int32_t, 0_c_int32_t, c_associated(user))
   end function leaking

   function failing(user, asked) bind(c) result(refusal)
      type(c_ptr), value :: user
      type(hbvib_force_call), intent(in) :: asked
      integer(c_int32_t) :: refusal
      refusal = merge(-42_c_int32_t, -43_c_int32_t, asked%n == 1 .and. .not. c_associated(user))
   end function failing
end module own_forces

program physics
   use, intrinsic :: ieee_exceptions
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use common
   use own_forces
   implicit none
   type(hbvib_model) :: model
   type(hbvib_branch) :: branch
   logical :: traps(size(ieee_usual))

   call ieee_set_halting_mode(ieee_usual, .true.) ! as -ffpe-trap=invalid,zero,overflow does
   call own_force()
   call modes()
   call friction()
   call damper()
   call load_history()
   call in_time()
   call one_law_in_many_words()
   call never_slipping()
   call faces()
   call rotation()
   call ieee_get_halting_mode(ieee_usual, traps)
   call expect('the caller''s traps are as they were', all(traps))
   call works(model%free(), 'free')
   call works(branch%free(), 'free')
   call verdict(190)

contains

   pure function close(a, b, tolerance)
      real(dp), intent(in) :: a, b, tolerance
      logical :: close
      close = abs(a - b) <= tolerance*abs(b)
   end function close

   !> mass 1, stiffness k, damping c, force load.
   subroutine oscillator(k, c, load)
      real(dp), intent(in) :: k, c, load
      call works(model%new(1), 'a model')
      call works(model%set_matrix(HBVIB_MASS, reshape([1._dp], [1, 1])), 'mass')
      call works(model%set_matrix(HBVIB_DAMPING, reshape([c], [1, 1])), 'damping')
      call works(model%set_matrix(HBVIB_STIFFNESS, reshape([k], [1, 1])), 'stiffness')
      if (load > 0) call works(model%add_force(1, 1, load), 'force')
   end subroutine oscillator

   function ground(kind) result(contact)
      integer(c_int32_t), intent(in) :: kind
      type(hbvib_contact) :: contact
      contact%kind = kind
      contact%dof_a(1) = 1
   end function ground

   subroutine own_force()
      real(dp), parameter :: at(3) = [1.1_dp, 1.4_dp, 1.7_dp]
      type(hbvib_contact) :: contact
      type(hbvib_jacobian_gap) :: gap
      real(dp), allocatable :: theirs(:), ours(:)
      integer :: i, id
      contact = ground(HBVIB_CUBIC)
      contact%kt = duffing(1)
      contact%cubic = duffing(2)
      call oscillator(0.2_dp, 0.1_dp, 0.3_dp)
      call works(model%add_contact(contact), 'a cubic spring')
      call works(model%forced_response(branch, 0.8_dp, 2._dp, at=at), 'the response of HBVIB_CUBIC')
      allocate (theirs(0))
      do i = 1, size(at)
         call works(branch%at(i, ours), 'at')
         theirs = [theirs, ours]
      end do
      call oscillator(0.2_dp, 0.1_dp, 0.3_dp)
      call works(model%add_user_force(cubic_spring, [1], c_loc(duffing), is_odd=.true., id=id), 'a force of one''s own')
      call expect('contacts count from 1', id == 1)
      call works(model%check_jacobian(id, 1._dp, [1._dp], gap), 'the check of derivatives')
      call expect('derivatives are right', gap%gap < 1e-6_dp .and. gap%sample >= 1)
      call works(model%forced_response(branch, 0.8_dp, 2._dp, at=at), 'the response of one''s own spring')
      do i = 1, size(at)
         call works(branch%at(i, ours), 'at')
         call expect('a spring of one''s own is HBVIB_CUBIC', size(ours) > 0)
         call expect('a spring of one''s own is HBVIB_CUBIC', all(abs(ours/theirs(:size(ours)) - 1) < 1e-10_dp))
         theirs = theirs(size(ours) + 1:)
      end do
      call oscillator(0.2_dp, 0.1_dp, 0.3_dp)
      call works(model%add_user_force(failing, [1]), 'a failing force')
      call refused(model%forced_response(branch, 0.8_dp, 2._dp), HBVIB_E_CALLBACK, '-42', 'a force that fails')
      call oscillator(0.2_dp, 0.1_dp, 0.3_dp)
      call works(model%add_user_force(leaking, [1], states=1), 'a force with a state')
      call works(model%check_jacobian(1, 1._dp, [1._dp], gap), 'the check of derivatives')
      call expect('derivatives of a state are right', gap%gap < 1e-6_dp)
   end subroutine own_force

   subroutine modes()
      real(dp) :: omega(2)
      complex(dp) :: shapes(2, 2)
      real(dp), pointer :: w(:), log10_a(:)
      real(dp), allocatable :: w_peak(:), a_peak(:), w_mode(:), a_mode(:), curve(:)
      complex(dp), allocatable :: response(:)
      integer(c_int32_t), allocatable :: flags(:)
      type(hbvib_branch) :: forced
      type(hbvib_solver_options) :: one
      type(hbvib_mode_info) :: info
      type(hbvib_mode_point) :: point
      type(hbvib_contact) :: contact
      call works(model%new(2), 'two masses')
      call works(model%set_matrix(HBVIB_MASS, reshape([1._dp, 0._dp, 0._dp, 1._dp], [2, 2])), 'mass')
      call works(model%set_matrix(HBVIB_STIFFNESS, reshape([2._dp, -1._dp, -1._dp, 2._dp], [2, 2])), 'stiffness')
      call works(model%linear_modes(omega, shapes), 'linear modes')
      call expect('two masses have omega**2 = 1 and 3', maxval(abs(omega**2 - [1, 3])) < 1e-12_dp)
      call expect('their shapes stand in columns', abs(abs(shapes(1, 1) + shapes(2, 1)) - sqrt(2._dp)) < 1e-12_dp .and. &
                  abs(abs(shapes(1, 2) - shapes(2, 2)) - sqrt(2._dp)) < 1e-12_dp)
      contact = ground(HBVIB_CUBIC)
      contact%cubic = 0.5_dp
      call oscillator(1._dp, 0.01_dp, 0.01_dp)
      call works(model%add_contact(contact), 'a cubic spring')
      one%tolerance = 0
      one%harmonics = 1
      call works(model%nonlinear_mode(branch, -2._dp, 0.5_dp, solver=one), 'a nonlinear mode')
      call works(branch%field(HBVIB_OMEGA, w), 'omega')
      call works(branch%field(HBVIB_LOG10_AMPLITUDE, log10_a), 'amplitude')
      call expect('the backbone in one harmonic is omega**2 = k + 3/4 k3 a**2', &
                  maxval(abs(w**2/(1 + 0.375_dp*100**log10_a) - 1)) < 1e-8_dp)
      call works(branch%mode_info(info), 'info')
      call expect('modes count from 1', info%mode_index == 1 .and. info%reference_dof == 1)
      call works(branch%mode_point(branch%points(), point), 'a point')
      call expect('damping is c / (2 omega m)', close(point%damping_ratio, 0.01_dp/(2*point%omega), 1e-6_dp))
      call works(branch%synthesis_peaks(model, w_mode, a_mode, flags=flags), 'synthesised peaks')
      call works(branch%synthesis(model, curve, response), 'a synthesised response')
      call works(model%forced_response(forced, 0.8_dp, 1.6_dp, one), 'the response')
      call works(forced%peaks(w_peak, a_peak), 'peaks')
      call expect('there is one resonance either way', size(a_peak) == 1 .and. size(a_mode) == 1 .and. size(flags) == 1)
      call expect('the mode foretells the resonance', close(w_mode(1), w_peak(1), 1e-3_dp) .and. &
                  close(a_mode(1), a_peak(1), 1e-3_dp))
      call expect('the synthesised curve reaches it and no more', size(curve) == size(response) .and. &
                  maxval(abs(response)) <= a_mode(1)*(1 + 1e-6_dp) .and. maxval(abs(response)) > a_mode(1)/2)
      call works(forced%free(), 'free')
   end subroutine modes

   subroutine friction()
      integer, parameter :: n = 4096
      real(dp), parameter :: kt = 1, mu = 0.3_dp, preload = 1, load = 0.2_dp
      real(dp) :: motion(n), force(n), area, slip
      integer(c_int32_t) :: state(n)
      integer, allocatable :: point(:)
      real(dp), allocatable :: omega(:)
      complex(dp), allocatable :: x(:, :)
      complex(dp) :: r(1, 0:9)
      type(hbvib_contact_summary) :: summary
      type(hbvib_energies) :: energy
      type(hbvib_solver_options) :: one
      integer :: harmonics
      do harmonics = 1, 9, 8
         call oscillator(1._dp, 0.02_dp, load)
         call works(model%add_jenkins([1], [kt], [mu], [preload]), 'a friction contact')
         one%tolerance = 0
         one%harmonics = harmonics
         call works(model%forced_response(branch, 0.8_dp, 1.6_dp, one), 'a response')
         call works(branch%peaks(omega, point=point), 'peaks')
         call works(branch%contact_loop(point(1), 1, motion, force, state, direction=1), 'a loop')
         call works(branch%contact_summary(point(1), 1, summary), 'a summary')
         call works(branch%energy(point(1), energy), 'energies')
         call works(branch%harmonics(point(1), x), 'harmonics')
         area = sum((force + cshift(force, 1))*(cshift(motion, 1) - motion))/2
         slip = 4*mu*preload*(summary%half_range - mu*preload/kt)
         call expect('the loop closes the work of friction', close(area, summary%work, 1e-5_dp))
         call expect('the work is that of a parallelogram', close(summary%work, slip, 1e-9_dp))
         call expect('friction is the sum of its contacts', close(energy%friction_loss, summary%work, 1e-9_dp))
         call expect('the load''s work is what friction and damping take', &
                     close(-pi*load*aimag(x(1, 1)), energy%structural_loss + energy%friction_loss, 1e-8_dp))
         call expect('the force is at its limit where it slips', &
                     maxval(abs(abs(pack(force, state == HBVIB_STATE_SLIP)) - mu*preload)) < 1e-9_dp)
         call works(model%forced_residual(omega(1), x, r(:, 0:harmonics), solver=one), 'the residual')
         call expect('a point of the branch leaves no residual', maxval(abs(r(:, 0:harmonics))) < 1e-8_dp*load)
      end do
   end subroutine friction

   !> An infinite load makes infinite slip limits, which must not trip the traps of the caller.
   subroutine never_slipping()
      type(hbvib_contact) :: contact
      real(dp), allocatable :: amplitude(:)
      contact = ground(HBVIB_JENKINS)
      contact%kt = 1
      contact%mu = 0.3_dp
      contact%preload = transfer(int(z'7FF0000000000000', c_int64_t), 1._dp)
      call oscillator(1._dp, 0.1_dp, 0.2_dp)
      call works(model%add_contact(contact), 'an infinite preload')
      call works(model%forced_response(branch, 0.8_dp, 2._dp, at=[1.2_dp]), 'a response')
      call works(branch%at(1, amplitude), 'at')
      call expect('a contact that never slips is a spring', &
                  close(amplitude(1), 0.2_dp/abs(cmplx(2 - 1.2_dp**2, 0.1_dp*1.2_dp, dp)), 1e-9_dp))
      call expect('no mode without friction', model%nonlinear_mode(branch, -4._dp, 0._dp) < HBVIB_OK)
   end subroutine never_slipping

   !> A ring of equal masses from two halves of one on the faces of a sector: omega^2 = 0.5 + 6 (1 - cos(2 pi d/10)).
   subroutine faces()
      type(hbvib_model) :: ring
      real(dp) :: m(3, 3), k(3, 3), omega(1), square
      complex(dp) :: shapes(3, 1)
      integer :: d
      call works(ring%from_sector(3, 10, 1, reshape([1], [1, 1]), reshape([2], [1, 1]), frame=HBVIB_CYLINDRICAL, &
                                  coordinates=reshape([1._dp, 0._dp, 0._dp, cos(0.2_dp*acos(-1._dp)), &
                                                       sin(0.2_dp*acos(-1._dp)), 0._dp], [3, 1, 2])), 'faces')
      m = 0
      m(1, 1) = 0.5_dp
      m(2, 2) = 0.5_dp
      m(3, 3) = 1
      k = reshape([3.25_dp, -3._dp, -0.25_dp, -3._dp, 3.25_dp, -0.25_dp, -0.25_dp, -0.25_dp, 0.5_dp], [3, 3])
      call works(ring%set_matrix(HBVIB_MASS, m), 'mass of a sector')
      call works(ring%set_matrix(HBVIB_STIFFNESS, k), 'stiffness of a sector')
      call works(ring%fix([3]), 'a fixed degree of freedom')
      do d = 0, 5
         call works(ring%linear_modes(omega, shapes, diameter=d, contacts=HBVIB_CONTACTS_FREE), 'modes of a sector')
         square = 0.5_dp + 6*(1 - cos(0.2_dp*acos(-1._dp)*d))
         call expect('a ring from its faces', abs(omega(1) - sqrt(square)) < 1e-13_dp .and. abs(shapes(3, 1)) <= 0)
      end do
      call expect('one side alone is refused', ring%fix([1]) == HBVIB_E_ARGUMENT)
      call works(ring%free(), 'free')
   end subroutine faces

   !> A wedge damper between the ground and a blade, from its geometry.
   subroutine damper()
      type(hbvib_model) :: blade
      type(hbvib_branch) :: mode
      type(hbvib_damper) :: wedge
      type(hbvib_damper_face) :: sides(2)
      type(hbvib_band_info) :: bounds
      integer :: first_dof, first_contact, most
      integer, allocatable :: contact(:), direction(:), sliders(:)
      real(dp), allocatable :: place(:), slope(:), lower(:), upper(:), omega(:)
      real(dp), pointer :: counts(:), slopes(:, :, :)
      logical, allocatable :: complete(:)
      call works(blade%new(1), 'a blade')
      call works(blade%set_matrix(HBVIB_MASS, reshape([1._dp], [1, 1])), 'mass')
      call works(blade%set_matrix(HBVIB_STIFFNESS, reshape([1._dp], [1, 1])), 'stiffness')
      call works(blade%set_matrix(HBVIB_DAMPING, reshape([0.04_dp], [1, 1])), 'damping')
      wedge%mass = 0.01_dp
      wedge%radius = 0.05_dp
      wedge%length = 0.2_dp
      wedge%orbit = 25
      wedge%support = [1e-3_dp, 1e-4_dp]
      wedge%support_damping = [4e-3_dp, 1e-5_dp]
      sides%kt = 1
      sides%kn = 1.5_dp
      sides%angle = [-0.7853981633974483_dp, 0.7853981633974483_dp]
      sides%mu = [0.6_dp, 0.15_dp]
      sides(2)%dofs(1) = 2
      call refused(blade%add_damper(wedge, sides), HBVIB_E_INDEX, 'faces(2)%dofs(1) = 2', 'a platform that is not there')
      sides(2)%dofs(1) = 1
      call works(blade%add_damper(wedge, sides, first_dof, first_contact), 'a damper')
      call expect('its motions and contacts follow all others', first_dof == 2 .and. first_contact == 1 .and. blade%dofs() == 4)
      call works(blade%set_speed(2._dp), 'a speed')
      call works(blade%add_force(1, 1, 0.02_dp), 'a force')
      call works(blade%forced_response(branch, 1.25_dp, 1.25_dp, harmonics=5), 'a point with a damper')
      call works(blade%freedom(branch, 1, contact, direction, place, slope), 'freedom')
      call expect('its contact with the ground is free', size(contact) == 1 .and. contact(1) == 1 .and. direction(1) == 1 .and. &
                  size(place) == 1 .and. abs(slope(1)) > 0)
      call works(blade%forced_response(branch, 1.25_dp, 1.25_dp, hbvib_solver_options(tolerance=0._dp, harmonics=5, freedom=1)), &
                 'a point with its freedom')
      call works(branch%field(HBVIB_FREE_SLIDERS, counts), 'the number of free sliders')
      call works(branch%field(HBVIB_D_AMPLITUDE_BY_PLACE, slopes), 'the derivatives by their places')
      call expect('the branch has the freedom of its point', close(counts(1), 1._dp, 1e-14_dp) .and. &
                  all(shape(slopes) == [2, 2, 1]) .and. close(slopes(1, 1, 1), slope(1), 1e-9_dp) .and. &
                  ieee_is_nan(slopes(1, 2, 1)))
      call works(blade%band(branch, 1, bounds), 'its band')
      call works(blade%band_curve(branch, lower, upper, omega, sliders, complete), 'the curves of a band')
      call expect('the curves are its ends', close(lower(1), bounds%lower, 1e-12_dp) .and. close(upper(1), bounds%upper, 1e-12_dp) &
                  .and. sliders(1) == 1 .and. complete(1) .and. close(omega(1), 1.25_dp, 1e-14_dp))
      call works(blade%band_curve(branch, lower, upper, points=[1]), 'the curves at one point')
      call expect('they have one point', size(lower) == 1 .and. size(upper) == 1)
      call refused(blade%band_curve(branch, lower, upper, points=[0]), HBVIB_E_INDEX, 'point = 0', 'point 0')
      call works(blade%nonlinear_mode(mode, -0.6_dp, -0.5_dp, harmonics=5), 'a mode')
      call works(blade%mode_band(mode, 1, bounds, contact=contact, lower=lower, upper=upper), 'the band of its damping')
      most = int(bounds%sliders)
      call expect('its damping is a band', most > 0 .and. bounds%upper >= bounds%lower .and. size(contact) == most .and. &
                  size(upper) == most .and. size(lower) == most)
      call works(mode%free(), 'free')
      call works(blade%free(), 'free')
   end subroutine damper

   !> A slider under twice the force that it can hold, and under none: it keeps a force of the other sense.
   subroutine load_history()
      type(hbvib_model) :: mass
      real(dp), allocatable :: motion(:, :), places(:, :, :), forces(:, :, :)
      real(dp) :: one(1, 1)
      one = 1
      call works(mass%new(1), 'a mass')
      call works(mass%set_matrix(HBVIB_MASS, one), 'its mass')
      call works(mass%set_matrix(HBVIB_STIFFNESS, one), 'its stiffness')
      call works(mass%add_jenkins([1], [1._dp], [0.5_dp], [1._dp]), 'its contact')
      call works(mass%add_force(1, 0, 1._dp), 'a constant force')
      call works(mass%static_history([2._dp, 0._dp], motion=motion, places=places, forces=forces), 'a load history')
      call expect('the motion under the force, and what is left', close(motion(1, 1), 1.5_dp, 1e-12_dp) .and. &
                  close(motion(1, 2), 0.5_dp, 1e-12_dp) .and. close(forces(1, 1, 2), -0.5_dp, 1e-12_dp))
      call works(mass%set_slider(1, 1, places(1, 1, 2)), 'the place of its slider')
      call works(mass%static_history([0._dp], motion=motion), 'the state that is left')
      call expect('it is that of the slider', close(motion(1, 1), 0.5_dp, 1e-12_dp))
      call refused(mass%static_history([1._dp], [1._dp, 2._dp]), HBVIB_E_DIMENSION, 'speeds', 'more speeds than factors')
      call works(mass%free(), 'free')
   end subroutine load_history

   subroutine in_time()
      real(dp), parameter :: omega = 1.3_dp, k = 2, c = 0.3_dp, load = 0.7_dp
      complex(dp) :: x(1, 0:2), exact
      complex(dp), allocatable :: start(:, :)
      real(dp) :: y(1, 8)
      real(dp), allocatable :: amplitude(:)
      integer, allocatable :: point(:)
      type(hbvib_time_info) :: info
      type(hbvib_verification) :: check
      complex(dp) :: truth(1, 0:63)
      real(dp) :: errors(0:63)
      type(hbvib_floquet_info) :: stability
      complex(dp), allocatable :: mu(:)
      integer, allocatable :: classes(:)
      real(dp) :: derivatives(2)
      type(hbvib_branch) :: study
      type(hbvib_band_info) :: bounds
      real(dp), allocatable :: lowest(:), uppermost(:)
      integer :: j, reasons(2), onset
      exact = load/cmplx(k - omega**2, c*omega, dp)
      call oscillator(k, c, load)
      call works(model%time_response(omega, x, y, info), 'a linear response in time')
      call expect('it is F / (k - omega**2 m + i omega c)', abs(x(1, 1)/exact - 1) < 1e-9_dp .and. abs(x(1, 2)) < 1e-9_dp)
      call expect('its samples start at t = 0', maxval(abs(y(1, :) - [(real(exact*exp(cmplx(0, pi*(j - 1)/4, dp))), j=1, 8)])) &
                  < 1e-9_dp)
      call expect('its period is 2 pi / omega', close(info%period, 2*pi/omega, 1e-14_dp))
      call works(model%add_jenkins([1], [1._dp], [0.3_dp], [1._dp]), 'a friction contact')
      call works(model%forced_response(branch, omega, omega, hbvib_solver_options(tolerance=0._dp, harmonics=63), &
                 at=[omega]), 'one point')
      call works(branch%at(1, amplitude, point), 'at')
      call works(branch%harmonics(point(1), start), 'harmonics')
      call works(model%time_response(omega, x, start=start, info=info), 'the point in time')
      call expect('harmonic balance is what time integration finds', abs(x(1, 1)/start(1, 1) - 1) < 1e-5_dp)
      call expect('friction had events', info%events > 0)
      call works(model%verify(branch, point(1), check, harmonics=truth, errors=errors), 'the point checked in time')
      call expect('the check finds the motion in time', abs(truth(1, 1)/x(1, 1) - 1) < 1e-9_dp .and. &
                  abs(check%response - truth(1, 1)) < 1e-15_dp)
      call expect('its error is the distance of both', &
                  close(check%response_error, abs(start(1, 1) - x(1, 1))/abs(x(1, 1)), 1e-3_dp) .and. check%same_solution == 1)
      call expect('the harmonics make up the error', close(sqrt(sum(errors**2)), check%motion_error, 1e-12_dp))
      call works(model%floquet(branch, point(1), mu, classes, stability), 'the stability of the point')
      call expect('two multipliers and a memory', size(mu) == 3 .and. all(classes == [HBVIB_MULTIPLIER_ORDINARY, &
                  HBVIB_MULTIPLIER_ORDINARY, HBVIB_MULTIPLIER_MEMORY]))
      call expect('the point is stable', close(stability%radius, abs(mu(1)), 1e-14_dp) .and. stability%radius < 1)
      call works(model%sensitivity(branch, point(1), [hbvib_parameter(kind=HBVIB_PARAMETER_FORCE), &
                 hbvib_parameter(kind=HBVIB_PARAMETER_PRELOAD, contact=1)], derivatives, reasons=reasons, onset=onset), &
                 'derivatives')
      call expect('force and normal load scale the motion', close(sum(derivatives), abs(start(1, 1)), 1e-8_dp))
      call expect('all derivatives exist', all(reasons == HBVIB_DERIVATIVE_EXISTS) .and. onset == 0)
      call works(model%set_slider(1, 1, 0._dp), 'the place of a slider')
      call works(model%band(branch, point(1), bounds, lower=lowest, upper=uppermost), 'a band')
      call expect('a contact that slips keeps no force', bounds%sliders == 0 .and. size(lowest) == 0 .and. &
                  .not. bounds%upper > bounds%lower .and. size(uppermost) == 0)
      call refused(model%set_slider(2, 1, 0._dp), HBVIB_E_INDEX, 'id = 2, needs 1', 'the slider of contact 2')
      call refused(model%set_slider(1, 0, 0._dp), HBVIB_E_INDEX, 'direction = 0, needs 1 .. 2', 'a direction')
      call refused(model%sensitivity(branch, point(1), [hbvib_parameter(kind=HBVIB_PARAMETER_MU, contact=0)], derivatives(:1)), &
                   HBVIB_E_INDEX, 'contact = 0, needs 1', 'a derivative by contact 0')
      call works(model%parameter_response(study, hbvib_parameter(kind=HBVIB_PARAMETER_PRELOAD, contact=1), 1._dp, 1.5_dp, &
                 omega, hbvib_solver_options(tolerance=0._dp, harmonics=63), at=[1.2_dp]), 'a study')
      call works(study%at(1, amplitude), 'at')
      call expect('it has the requested value', size(amplitude) == 1)
      call works(study%optima(amplitude), 'optima')
      call works(study%higher_peaks(amplitude=amplitude), 'higher peaks')
      call works(study%turns(amplitude=amplitude), 'turns')
      call expect('no peak is followed', size(amplitude) == 0)
      call works(model%parameter_response(study, hbvib_parameter(kind=HBVIB_PARAMETER_PRELOAD, contact=1), 1._dp, 1.5_dp, &
                 omega, follow=HBVIB_FOLLOW_MODE_MAX_DAMPING), 'a study of damping')
      call works(study%free(), 'free')
      call works(branch%limit_cycles(amplitude), 'limit cycles')
      call expect('a forced response has none', size(amplitude) == 0)
      call refused(model%floquet(branch, 0), HBVIB_E_INDEX, 'point = 0, needs 1', 'the stability of point 0')
      call refused(model%verify(branch, 0), HBVIB_E_INDEX, 'point = 0, needs 1', 'a check of point 0')
      call refused(model%verify(branch, point(1), errors=errors(1:)), HBVIB_E_DIMENSION, 'harmonics + 1 = 64', 'too few errors')
      call refused(model%time_response(omega, x, start=reshape(start, [2, 32])), HBVIB_E_DIMENSION, 'start', &
                   'a start of two degrees of freedom')
      call works(model%forced_response(branch, 1.2_dp, 1.4_dp, hbvib_solver_options(tolerance=0._dp, harmonics=9, &
                 stability=HBVIB_STABILITY_WAVE)), 'a response with its stability')
      call works(branch%bifurcations(amplitude, kind=classes), 'bifurcations')
      call expect('it is stable', size(classes) == 0)
   end subroutine in_time

   !> Residual and its derivative of a structure without matrices but for masses: the contacts alone.
   subroutine laws(what, ndof, r, jac, like_r, like_jac)
      character(*), intent(in) :: what
      integer, intent(in) :: ndof
      complex(dp), allocatable, intent(inout) :: r(:, :)
      real(dp), allocatable, intent(inout) :: jac(:, :)
      complex(dp), intent(in), optional :: like_r(:, :)
      real(dp), intent(in), optional :: like_jac(:, :)
      complex(dp) :: x(ndof, 0:3)
      integer :: i, h
      do h = 0, 3
         do i = 1, ndof
            x(i, h) = cmplx(cos(1._dp + 3*i + h), merge(0._dp, sin(2._dp + i*h), h == 0), dp)/(1 + h)
         end do
      end do
      if (allocated(r)) deallocate (r, jac)
      allocate (r(ndof, 0:3), jac(8*ndof, 8*ndof))
      call works(model%forced_residual(1.1_dp, x, r, jac, solver=hbvib_solver_options(harmonics=3)), what)
      if (.not. present(like_r)) return
      call expect(what//': the same force', maxval(abs(r - like_r)) < 1e-10_dp)
      call expect(what//': the same derivative', maxval(abs(jac - like_jac)) < 1e-9_dp)
   end subroutine laws

   subroutine masses(ndof)
      integer, intent(in) :: ndof
      real(dp) :: m(ndof, ndof)
      integer :: i
      m = 0
      do i = 1, ndof
         m(i, i) = 1
      end do
      call works(model%new(ndof), 'a model')
      call works(model%set_matrix(HBVIB_MASS, m), 'mass')
   end subroutine masses

   subroutine one_law_in_many_words()
      complex(dp), allocatable :: r(:, :), like_r(:, :)
      real(dp), allocatable :: jac(:, :), like_jac(:, :)
      real(dp) :: quadratic(2, 2, 2), cubic(2, 2, 2, 2), normal(3, 1), tangent(3, 1)
      type(hbvib_contact) :: contact
      integer :: id

      ! f1 = x1 x2**2 + v2, f2 = x1**2
      call masses(2)
      call works(model%add_polynomial([1, 2], [1, 2, 1], [1._dp, 1._dp, 1._dp], reshape([1, 2, 2, 0, 0, 0], [2, 3]), &
                                      reshape([0, 0, 0, 0, 0, 1], [2, 3]), id), 'a polynomial')
      call laws('a polynomial', 2, like_r, like_jac)
      call masses(2)
      call works(model%add_user_force(lopsided, [1, 2], uses_velocity=.true.), 'a force of one''s own')
      call laws('a force of one''s own', 2, r, jac, like_r, like_jac)
      ! the same without v2
      call masses(2)
      call works(model%add_polynomial([1, 2], [1, 2], [1._dp, 1._dp], reshape([1, 2, 2, 0], [2, 2])), 'a polynomial')
      call laws('a polynomial', 2, like_r, like_jac)
      quadratic = 0
      cubic = 0
      quadratic(1, 1, 2) = 1
      cubic(1, 2, 2, 1) = 1
      call masses(2)
      call works(model%add_stiffness_tensors([1, 2], quadratic, cubic), 'tensors')
      call laws('tensors', 2, r, jac, like_r, like_jac)

      ! f = 2 (x1 - x2)
      call masses(2)
      call works(model%add_springs([1], [2._dp], [2]), 'springs')
      call laws('springs', 2, like_r, like_jac)
      call masses(2)
      call works(model%add_table(1, 2, [-9._dp, 9._dp], [-18._dp, 18._dp], id=id), 'a table')
      call laws('a straight table', 2, r, jac, like_r, like_jac)
      call masses(2)
      call works(model%add_spring_damper(2, 1, spring=[2._dp]), 'a spring')
      call laws('a spring', 2, r, jac, like_r, like_jac)

      ! elastic Coulomb friction from x1 to the ground
      contact = ground(HBVIB_JENKINS)
      contact%kt = 2
      contact%mu = 0.5_dp
      contact%preload = 0.4_dp
      call masses(3)
      call works(model%add_contact(contact, id), 'friction')
      call laws('friction', 3, like_r, like_jac)
      call masses(3)
      call works(model%add_jenkins([3, 1], [1._dp, 2._dp], [0._dp, 0.5_dp], [0._dp, 0.4_dp], first_id=id), 'a list')
      call laws('a list of friction', 3, r, jac, like_r, like_jac)
      call works(model%set_preload(id + 1, 0.8_dp), 'another preload')
      call works(model%set_preload(id + 1, 0.4_dp), 'the old preload')
      call laws('a preload set', 3, r, jac, like_r, like_jac)
      contact%kt = 4
      contact%preload = 0.8_dp
      normal(:, 1) = [0, 0, 1]
      tangent(:, 1) = [2, 0, 0]
      call masses(3)
      call works(model%add_patch(contact, reshape([1, 2, 3], [3, 1]), normal, [0.5_dp], tangent=tangent, first_id=id), 'a patch')
      call laws('a patch', 3, r, jac, like_r, like_jac)
      call expect('ids count from 1', id == 1)
      call works(model%add_iwan(1, HBVIB_GROUND, 1._dp, 2._dp, -0.5_dp, 0.1_dp, elements=20, first_id=id), 'an Iwan joint')
      call expect('an Iwan joint is as many contacts', all([id, model%contacts()] == [2, 21]))
   end subroutine one_law_in_many_words

   !> Stodola's rotor, its critical speed, unbalance, and damping by numbers.
   subroutine rotation()
      real(dp), parameter :: o = 0, e = 1
      complex(dp) :: eigenvalue(4), shapes(4, 4)
      integer(c_int64_t) :: direction(4), sense(8)
      real(dp) :: omega(4, 2), speed(8), frequency(8)
      real(dp), pointer, contiguous :: view(:)
      real(dp) :: tied
      integer :: found
      call works(model%new(4), 'a rotor')
      call works(model%set_matrix(HBVIB_MASS, reshape([e, o, o, o, o, e, o, o, o, o, 0.3_dp, o, o, o, o, 0.3_dp], [4, 4])), 'mass')
      call works(model%set_matrix(HBVIB_STIFFNESS, reshape([e, o, 0.4_dp, o, o, e, o, 0.4_dp, 0.4_dp, o, 0.8_dp, o, &
                                                            o, 0.4_dp, o, 0.8_dp], [4, 4])), 'stiffness')
      call works(model%set_matrix(HBVIB_GYROSCOPIC, reshape([o, o, o, o, o, o, o, o, o, o, o, -0.5_dp, o, o, 0.5_dp, o], &
                                                             [4, 4])), 'gyroscopic')
      call works(model%set_speed(e), 'a speed')
      call works(model%damped_modes(eigenvalue, shapes, direction), 'damped modes')
      call expect('a rotor whirls', abs(aimag(eigenvalue(2)) - 0.917055456_dp) < 1e-9_dp .and. all(direction == [-1, 1, -1, 1]))
      call works(model%campbell([0.8_dp, 1._dp], omega), 'a Campbell diagram')
      call expect('at the speed', abs(omega(2, 2) - 0.917055456_dp) < 1e-9_dp)
      call works(model%campbell_crossings([0.8_dp, 1._dp], 4, 1, speed, frequency, found, sense), 'critical speeds')
      call expect('one of them', found == 1)
      call expect('forward', sense(1) == 1 .and. abs(speed(1) - 0.9135225809938965_dp) < 1e-12_dp)
      call works(model%set_rayleigh(o, 0.02_dp), 'damping')
      call works(model%add_unbalance(1, 2, 0.1_dp, phase=0.3_dp), 'unbalance')
      call works(model%set_speed_per_omega(e), 'a speed of the frequency')
      call works(model%forced_response(branch, 0.8_dp, 0.8_dp), 'its response')
      call works(branch%field(HBVIB_AMPLITUDE, view), 'amplitude')
      tied = view(1)
      call works(model%set_speed(0.8_dp), 'that speed')
      call works(model%forced_response(branch, 0.8_dp, 0.8_dp), 'its response')
      call works(branch%field(HBVIB_AMPLITUDE, view), 'amplitude')
      call expect('is the same', close(view(1), tied, 1e-12_dp))
      call works(model%set_loss_factor(0.02_dp), 'a loss factor')
      call works(model%set_modal_damping([0.01_dp, 0.01_dp]), 'modal damping')
      call works(model%add_jenkins([1], [1._dp], [0.3_dp], [1._dp]), 'friction')
      call works(model%set_preload(1, 0.5_dp, per_speed2=0.1_dp), 'a load of the speed')
   end subroutine rotation

end program physics
