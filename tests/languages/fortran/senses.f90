! Both senses of a nodal diameter: crossings of a rotating wheel, its waves, and flutter of one sense.
program senses
   use common
   implicit none
   integer, parameter :: sectors = 10, points = 181
   type(hbvib_model) :: model
   type(hbvib_mode_options) :: options
   real(dp) :: speeds(points), speed(4), omega(4), curves(2, points), all_omega(2, sectors), ratio(2, sectors), own(2)
   complex(dp) :: eigenvalue(2)
   integer(c_int64_t) :: diameters(sectors), waves(24)
   real(dp) :: flutter_omega(1, 24), flutter_ratio(1, 24)
   integer :: found, wave, k
   logical :: equal
   real(dp), parameter :: z = 0, e = 1

   call works(model%new(2, sectors), 'a wheel')
   call works(model%set_matrix(HBVIB_MASS, reshape([e, z, z, e], [2, 2])), 'mass')
   call works(model%set_matrix(HBVIB_STIFFNESS, reshape([1500*e, z, z, 1900*e], [2, 2])), 'stiffness')
   call works(model%set_coupling(HBVIB_STIFFNESS, reshape([-200*e, -250*e, 250*e, -350*e], [2, 2])), 'coupling')
   call works(model%set_matrix(HBVIB_GYROSCOPIC, reshape([z, 2*e, -2*e, z], [2, 2])), 'Coriolis forces')
   call works(model%set_wave(1), 'wave')
   do k = 1, points
      speeds(k) = 0.2_dp + (45 - 0.2_dp)*(k - 1)/(points - 1)
   end do
   call works(model%campbell_crossings(speeds, 2, 9, speed, omega, found), 'crossings')
   call expect('engine order 9', found == 2 .and. all(near(speed(:2), [3.7995179098748477_dp, 4.05780386908863_dp])))
   call works(model%campbell_crossings(speeds, 2, 19, speed, omega, found, diameter=1), 'crossings')
   call expect('engine order 19', found == 2 .and. all(near(speed(:2), [1.710413476178725_dp, 1.9829812203464108_dp])))
   call works(model%campbell_crossings(speeds, 2, 9, speed, omega, found, diameter=2), 'crossings')
   call expect('an order of another diameter', found == 0)
   wave = 0
   call works(model%signed_diameter(9, wave), 'a wave')
   call expect('its sense', wave == -1)
   call expect('the default of a mode', options%diameter == HBVIB_DIAMETER_OF_ENGINE_ORDER)

   call works(model%set_speed(5*e), 'a speed')
   call works(model%interference(diameters, all_omega, ratio, equal_senses=equal), 'all waves')
   call expect('signed diameters', all(diameters == [(k, k=-4, 5)]) .and. .not. equal)
   do k = 1, sectors
      call works(model%damped_modes(eigenvalue, diameter=int(diameters(k)) + 20), 'a damped wave')
      call works(model%linear_modes(own, diameter=int(diameters(k)) - 10), 'an undamped wave')
      call expect('the same frequencies', all(near(aimag(eigenvalue), all_omega(:, k))) .and. all(near(own, all_omega(:, k))))
   end do
   call works(model%campbell([5*e], curves(:, :1), diameter=-1), 'curves')
   call expect('the curves of a sense', all(near(curves(:, 1), all_omega(:, 4))))
   call works(model%set_speed(z), 'rest')
   call works(model%interference(diameters, all_omega, equal_senses=equal), 'all waves')
   call expect('at rest the senses are equal', equal)
   call works(model%free(), 'free')

   call works(model%new(1, 24), 'a ring')
   call works(model%set_matrix(HBVIB_MASS, reshape([e], [1, 1])), 'mass')
   call works(model%set_matrix(HBVIB_STIFFNESS, reshape([e], [1, 1])), 'stiffness')
   call works(model%set_matrix(HBVIB_DAMPING, reshape([0.005_dp], [1, 1])), 'damping')
   call works(model%set_coupling(HBVIB_STIFFNESS, reshape([-0.1_dp], [1, 1])), 'coupling')
   call works(model%set_aero([1], reshape([0.01_dp, -0.01_dp]*(1._dp, 0._dp), [1, 1, 2]), [1, -1], HBVIB_AERO_DISPLACEMENT), &
              'a flow')
   call works(model%interference(waves, flutter_omega, flutter_ratio), 'flutter')
   call expect('unstable waves', count(flutter_ratio < 0) == 10 .and. all(pack(waves, flutter_ratio(1, :) < 0) < 0))
   call expect('least damping', abs(minval(flutter_ratio) + 0.007618136725428_dp) < 1e-12_dp)
   call works(model%free(), 'free')
   call verdict(53)

contains

   elemental logical function near(found, wanted)
      real(dp), intent(in) :: found, wanted
      near = abs(found/wanted - 1) < 1e-11_dp
   end function near
end program senses
