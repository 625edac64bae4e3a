! Batches of designs: peaks, failing designs, threads, and what is refused.
program batch
   use common
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   implicit none
   type(hbvib_model) :: model
   type(hbvib_parameter) :: parameters(2)
   type(hbvib_solver_options) :: solver
   real(dp) :: values(2, 4), amplitude(4), omega(4), again(4)
   integer(c_int32_t) :: statuses(4)
   integer :: points(4)

   call ring_damper(model)
   parameters(1)%kind = HBVIB_PARAMETER_FORCE
   parameters(2)%kind = HBVIB_PARAMETER_PRELOAD
   parameters(2)%contact = 1
   solver%tolerance = 0
   solver%harmonics = 9
   solver%response_dof = b2
   values = reshape([1._dp, 300._dp, 2._dp, 600._dp, 1._dp, -1._dp, 1._dp, 100._dp], [2, 4])
   call works(model%batch(2*pi*200, 2*pi*215, parameters, values, amplitude, omega, statuses, points, solver=solver), 'a batch')
   call expect('the amplitude of the reference', abs(amplitude(1)/1.934880980e-3_dp - 1) < 1e-7_dp)
   call expect('its frequency', abs(omega(1)/(2*pi) - 208.0970308_dp) < 1e-6_dp)
   call expect('force and normal load scale the motion', abs(amplitude(2)/amplitude(1) - 2) < 1e-7_dp)
   call expect('another reference', abs(amplitude(4)/4.886556792e-3_dp - 1) < 1e-7_dp)
   call expect('a design that fails is told alone', statuses(3) == HBVIB_E_ARGUMENT .and. ieee_is_nan(amplitude(3)))
   call expect('the others are not', all(statuses([1, 2, 4]) == HBVIB_OK) .and. all(points([1, 2, 4]) > 5))
   call works(model%batch(2*pi*200, 2*pi*215, parameters, values, again, omega, threads=3, solver=solver), 'three threads')
   call expect('threads change no bit', all(transfer(again([1, 2, 4]), [0_c_int64_t]) == &
                                            transfer(amplitude([1, 2, 4]), [0_c_int64_t])))
   call refused(model%batch(2*pi*200, 2*pi*215, parameters, values(:1, :), amplitude, omega), HBVIB_E_DIMENSION, 'values', &
                'values of another width')
   call refused(model%batch(2*pi*200, 2*pi*215, parameters, values, amplitude(:3), omega), HBVIB_E_DIMENSION, 'peak_amplitude', &
                'too few results')
   call refused(model%batch(2*pi*200, 2*pi*215, parameters, values, amplitude, omega, threads=0), HBVIB_E_ARGUMENT, 'threads', &
                'no threads')
   parameters(2)%contact = 2
   call refused(model%batch(2*pi*200, 2*pi*215, parameters, values, amplitude, omega), HBVIB_E_INDEX, 'contact = 2', &
                'a contact that is not there')
   call works(model%free(), 'free')
   call verdict(23)
end program batch
