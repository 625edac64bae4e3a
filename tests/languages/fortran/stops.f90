! Ends at its first error, with the sentence of the library and status 1.
program stops
   use hbvib
   implicit none
   type(hbvib_model) :: model
   call hbvib_check(model%new(2))
   call hbvib_check(model%add_force(3, harmonic=1, force=1._c_double))
   print '(a)', 'not reached'
end program stops
