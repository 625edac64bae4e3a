! The compiler must refuse this program: single precision is no force, no matrix and no range of frequency.
program wrong_kind
   use hbvib
   implicit none
   type(hbvib_model) :: model
   type(hbvib_branch) :: branch
   real, parameter :: single(1, 1) = 1.0
   integer(c_int32_t) :: status
   status = model%add_force(1, 1, 5.0)
   status = model%set_matrix(HBVIB_MASS, single)
   status = model%forced_response(branch, 0.8, 1.6)
end program wrong_kind
