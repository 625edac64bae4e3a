! Options of a solve without a struct, and statuses that end the program unless stat receives them.
program statuses
   use common
   implicit none
   type(hbvib_model) :: model
   type(hbvib_branch) :: branch, again
   type(hbvib_solver_options) :: solver
   integer(c_int32_t) :: stat

   call ring_damper(model)
   call hbvib_check(model%forced_response(branch, 1300._dp, 1325._dp, harmonics=5, response_dof=1))
   solver%tolerance = 0
   solver%harmonics = 5
   solver%response_dof = 1
   call hbvib_check(model%forced_response(again, 1300._dp, 1325._dp, solver))
   call expect('harmonics alone are so many', alike(branch, again))
   call hbvib_check(model%forced_response(branch, 1300._dp, 1325._dp, tolerance=1e-2_dp, response_dof=1))
   solver = hbvib_solver_options(tolerance=1e-2_dp, response_dof=1)
   call hbvib_check(model%forced_response(again, 1300._dp, 1325._dp, solver))
   call expect('a tolerance chooses them', alike(branch, again))
   solver%response_dof = 2
   call hbvib_check(model%forced_response(again, 1300._dp, 1325._dp, solver, response_dof=1))
   call expect('an option of its own comes before that of the struct', alike(branch, again))
   call hbvib_check(model%nonlinear_mode(branch, -6._dp, -3._dp, harmonics=3))
   call expect('a mode has them too', branch%points() > 5)

   call hbvib_check(model%forced_response(branch, 1300._dp, 1325._dp, response_dof=5), stat)
   call expect('stat receives an error', stat == HBVIB_E_INDEX .and. index(hbvib_error_text(), 'response_dof = 5') > 0)
   call hbvib_check(model%clear_forces(), stat)
   call expect('and a success', stat == HBVIB_OK)
   call hbvib_check(model%forced_response(branch, 1300._dp, 1325._dp))
   call expect('a branch that stopped early does not end the program', branch%status() == HBVIB_STOPPED_NO_FORCE)
   call hbvib_check(branch%free())
   call hbvib_check(again%free())
   call hbvib_check(model%free())
   call verdict(7)

contains

   function alike(a, b) result(same)
      type(hbvib_branch), intent(in) :: a, b
      logical :: same
      real(dp), pointer :: x(:), y(:)
      call hbvib_check(a%field(HBVIB_AMPLITUDE, x))
      call hbvib_check(b%field(HBVIB_AMPLITUDE, y))
      same = size(x) == size(y)
      if (same) same = all(transfer(x, [0_c_int64_t]) == transfer(y, [0_c_int64_t]))
   end function alike
end program statuses
