! Aerodynamic influence: the response of a ring of its closed form, and what is refused.
program aero
   use common
   implicit none
   type(hbvib_model) :: model, plain
   type(hbvib_branch) :: branch
   type(hbvib_solver_options) :: solver
   complex(dp), allocatable :: x(:, :)
   complex(dp) :: c(2, 2, 2), z(2, 2), force(2)
   real(dp), parameter :: omega = 0.8_dp, stiffness = 3, turn = 8*atan(1._dp)
   real(dp) :: eye(2, 2)
   integer, parameter :: sectors = 5, order = 2, offsets(2) = [0, -2]

   eye = reshape([1._dp, 0._dp, 0._dp, 1._dp], [2, 2])
   c(:, :, 1) = reshape([(-0.1_dp, -0.05_dp), (0.02_dp, 0._dp), (-0.03_dp, 0.01_dp), (-0.2_dp, 0._dp)], [2, 2])
   c(:, :, 2) = reshape([(0.07_dp, 0._dp), (0._dp, 0.04_dp), (0.05_dp, 0._dp), (-0.02_dp, 0.03_dp)], [2, 2])
   call works(model%new(2, sectors), 'a ring')
   call works(model%set_matrix(HBVIB_MASS, eye), 'mass')
   call works(model%set_matrix(HBVIB_STIFFNESS, stiffness*eye), 'stiffness')
   call works(model%set_wave(order), 'wave')
   call works(model%set_aero([1, 2], c, offsets, HBVIB_AERO_DISPLACEMENT), 'influence')
   call expect('flutter is no forced response', model%forced_response(branch, omega, omega) == HBVIB_STOPPED_NO_FORCE)
   call works(model%add_force(1, 1, 1._dp), 'force')
   solver%tolerance = 0
   solver%harmonics = 1
   call works(model%forced_response(branch, omega, omega, solver), 'response')
   call works(branch%harmonics(1, x), 'harmonics')
   z = (stiffness - omega**2)*eye - c(:, :, 1) - c(:, :, 2)*exp(cmplx(0, 2*turn*order/sectors, dp))
   force = matmul(z, x(:, 1))
   call expect('balance of forces', abs(force(1) - 1) < 1e-12_dp .and. abs(force(2)) < 1e-12_dp)

   call refused(model%set_aero([3, 1], c, offsets, HBVIB_AERO_DISPLACEMENT), HBVIB_E_INDEX, 'dofs(1) = 3', 'a dof that is none')
   call refused(model%set_aero([1], c, offsets, HBVIB_AERO_DISPLACEMENT), HBVIB_E_DIMENSION, 'coefficients', 'a size')
   call refused(model%set_aero([1, 2], c, [1, -4], HBVIB_AERO_VELOCITY), HBVIB_E_ARGUMENT, 'offsets[0]', 'a sector twice')
   call works(plain%new(2), 'a plain structure')
   call refused(plain%set_aero([1, 2], c, offsets, HBVIB_AERO_VELOCITY), HBVIB_E_UNSUPPORTED, 'plain', 'no other sector')
   call works(model%set_aero([integer ::], c(:0, :0, :0), [integer ::], HBVIB_AERO_DISPLACEMENT), 'none')
   call works(branch%free(), 'free')
   call works(model%free(), 'free')
   call works(plain%free(), 'free')
   call verdict(15)
end program aero
