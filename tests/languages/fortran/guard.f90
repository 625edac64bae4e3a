! A guard frees what it keeps at the end of a procedure, whatever way leads out of it, and what was freed before does no harm.
program guard
   use common
   implicit none
   type(hbvib_model) :: kept, freed
   type(hbvib_branch) :: branch

   call procedure_with_a_guard(kept, branch, .false.)
   call expect('the model was freed', kept%dofs() == HBVIB_E_HANDLE)
   call expect('the branch was freed', branch%points() == HBVIB_E_HANDLE)
   call procedure_with_a_guard(freed, branch, .true.)
   call expect('the model that was freed inside is gone', freed%dofs() == HBVIB_E_HANDLE)
   block
      type(hbvib_guard) :: unused
      call expect('a guard that keeps nothing', storage_size(unused) > 0)
   end block
   call verdict(10)

contains

   subroutine procedure_with_a_guard(model, branch, early)
      type(hbvib_model), intent(out) :: model
      type(hbvib_branch), intent(out) :: branch
      logical, intent(in) :: early
      type(hbvib_guard) :: scope
      type(hbvib_model) :: copy
      call ring_damper(model)
      call scope%keep(model)
      call works(model%forced_response(branch, 205*6.283d0, 207*6.283d0, harmonics=3), 'a solve')
      call scope%keep(branch)
      call expect('the model lives inside', model%dofs() > 0)
      if (.not. early) return
      copy = model
      call works(copy%free(), 'free inside')
   end subroutine procedure_with_a_guard

end program guard
