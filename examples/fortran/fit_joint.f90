! Stiffness and friction of a joint from measured responses: complex amplitudes of a chain of two masses under three forces, of
! which the first mass rubs on the ground. Prints the parameters with their standard deviations, the resonance predicted at another
! force, and the interval of the friction limit by the profile of the likelihood.
! Build: make PREFIX=<where hbvib is installed>, in this directory; ./fit_joint ../data/joint.csv
program fit_joint
   use, intrinsic :: iso_fortran_env, only: error_unit
   use hbvib
   implicit none
   integer, parameter :: dp = c_double, p = 4, scan = 9
   character(*), parameter :: names(p) = [character(16) :: 'kt', 'friction limit', 'damping factor', 'stiffness factor']
   ! Data of all levels of the force one after the other, re and im in two rows; they are borrowed by the data sets.
   real(dp), allocatable, target :: omega(:), value(:, :), sigma(:)
   integer(c_int64_t), target :: measured(1) = [1_c_int64_t] ! the second mass; functions of C count from 0
   real(dp), target :: near(1) = [0.72_dp]
   type(hbvib_model) :: model
   type(hbvib_solver_options) :: solver
   type(hbvib_response), target :: response
   type(hbvib_data), allocatable :: sets(:)
   type(hbvib_data) :: wanted
   type(hbvib_parameter) :: parameters(p)
   type(hbvib_unknown) :: unknowns(p)
   type(hbvib_fit_info) :: info
   type(hbvib_fit_profile_info) :: interval
   type(c_ptr) :: fitted
   real(dp) :: theta(p), covariance(p, p), peak(2), deviation(2), values(scan)
   integer :: i

   response%n = 1
   response%dofs = c_loc(measured)
   call read_levels()
   call build()
   solver%tolerance = 0 ! fixed harmonics: exactly H = 9
   solver%harmonics = 9
   parameters(1)%kind = HBVIB_PARAMETER_KT
   parameters(2)%kind = HBVIB_PARAMETER_MU
   parameters(1:2)%contact = 0
   parameters(3)%kind = HBVIB_PARAMETER_DAMPING
   parameters(4)%kind = HBVIB_PARAMETER_STIFFNESS
   parameters(3:4)%scaling = HBVIB_SCALING_FACTOR
   unknowns(3)%has_start = 1
   unknowns(3)%start = 2
   call check(hbvib_fit(model%handle, solver, parameters=parameters, count=int(p, c_int64_t), unknowns=unknowns, data=sets, &
                        data_len=size(sets, kind=c_int64_t), info=info, theta=theta, covariance=covariance, &
                        residuals_len=0_c_int64_t, out=fitted))
   call check(hbvib_model_free(fitted))
   do i = 1, p
      write (*, '(a16, 2x, es19.12e2, a, es16.9e2)') names(i), theta(i), '  +- ', sqrt(covariance(i, i))
   end do
   write (*, '(a16, 2x, es19.12e2, a, i0)') 'chi2            ', info%chi2, '  on ', info%degrees_of_freedom

   wanted%kind = HBVIB_DATA_PEAK
   wanted%force_factor = 0.1_dp
   wanted%response = c_loc(response)
   wanted%omega_start = 0.6_dp
   wanted%omega_stop = 0.9_dp
   wanted%n = 1
   wanted%x = c_loc(near)
   call check(hbvib_predict(model%handle, solver, wanted, parameters=parameters, count=int(p, c_int64_t), theta=theta, &
                            covariance=covariance, capacity=2_c_int64_t, values=peak, sigma=deviation))
   write (*, '(a16, 2x, es19.12e2, a, es16.9e2)') 'peak at 0.1     ', peak(1), '  +- ', deviation(1)

   values = [(theta(2) + (0.75_dp*(i - 1) - 3)*sqrt(covariance(2, 2)), i=1, scan)]
   call check(hbvib_fit_profile(model%handle, solver, parameters=parameters, count=int(p, c_int64_t), unknowns=unknowns, &
                                data=sets, data_len=size(sets, kind=c_int64_t), theta=theta, number=1_c_int64_t, &
                                values_len=int(scan, c_int64_t), values=values, rise=3.841_dp, info=interval))
   write (*, '(a16, 2x, es16.9e2, a, es16.9e2)') '95 % of friction', interval%lower, ' .. ', interval%upper
   call check(model%free())

contains

   subroutine build()
      real(dp), parameter :: mass(2, 2) = reshape([1._dp, 0._dp, 0._dp, 0.5_dp], [2, 2])
      real(dp), parameter :: stiffness(2, 2) = reshape([1.5_dp, -0.5_dp, -0.5_dp, 0.5_dp], [2, 2])
      type(hbvib_contact) :: joint
      call check(model%new(2))
      call check(model%set_matrix(HBVIB_MASS, mass))
      call check(model%set_matrix(HBVIB_STIFFNESS, stiffness))
      call check(model%set_rayleigh(0._dp, 0.01_dp))
      joint%kind = HBVIB_JENKINS
      joint%dof_a(1) = 1
      joint%kt = 0.5_dp ! guesses
      joint%mu = 0.08_dp
      joint%preload = 1
      call check(model%add_contact(joint))
      call check(model%add_force(2, harmonic=1, force=1._dp))
   end subroutine build

   !> Rows of force, omega, re, im and sigma; a data set for each force.
   subroutine read_levels()
      character(500) :: path
      real(dp), allocatable :: rows(:, :)
      real(dp) :: row(5)
      integer :: unit, status, first, last
      path = '../data/joint.csv'
      if (command_argument_count() > 0) call get_command_argument(1, path)
      open (newunit=unit, file=trim(path), action='read', status='old', iostat=status)
      if (status /= 0) call fail(trim(path)//' cannot be read')
      allocate (rows(5, 0))
      read (unit, *) ! names of the columns
      do
         read (unit, *, iostat=status) row
         if (status /= 0) exit
         rows = reshape([rows, row], [5, size(rows, 2) + 1])
      end do
      close (unit)
      allocate (omega, source=rows(2, :))
      allocate (value, source=rows(3:4, :))
      allocate (sigma, source=rows(5, :))
      allocate (sets(0))
      first = 1
      do last = 1, size(omega)
         if (last < size(omega)) then
            if (.not. rows(1, last + 1) > rows(1, last)) cycle
         end if
         sets = [sets, hbvib_data(force_factor=rows(1, first), response=c_loc(response), n=last - first + 1, &
                                  x=c_loc(omega(first)), value=c_loc(value(1, first)), sigma=c_loc(sigma(first)))]
         first = last + 1
      end do
   end subroutine read_levels

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

end program fit_joint
