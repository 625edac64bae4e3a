! Saved models: the same bits from the bytes of a model, through memory and a file, and what is refused.
program saved
   use common
   implicit none
   type(hbvib_model) :: model, loaded
   type(solution) :: own, other
   integer(c_int8_t), allocatable :: bytes(:), again(:)
   integer :: unit, length

   call ring_damper(model)
   call works(solve(model, own), 'the model')
   call works(model%save(bytes), 'save')
   call works(loaded%load(bytes), 'load')
   call works(solve(loaded, other), 'the loaded model')
   call expect('the same bits', same(own, other))
   call works(loaded%save(again), 'save again')
   call expect('the same bytes', size(again) == size(bytes) .and. all(again == bytes))

   open (newunit=unit, file='saved.hbvib', form='unformatted', access='stream', action='readwrite', status='replace')
   write (unit) bytes
   inquire (unit, size=length)
   deallocate (again)
   allocate (again(length))
   rewind (unit)
   read (unit) again
   close (unit, status='delete')
   call works(loaded%load(again), 'load from a file')
   call works(solve(loaded, other), 'the model of a file')
   call expect('the same bits from a file', same(own, other))

   call refused(loaded%load(bytes(1:200)), HBVIB_E_ARGUMENT, 'incomplete', 'half a model')
   call expect('nothing is loaded', loaded%dofs() == HBVIB_E_HANDLE)
   bytes(100) = not(bytes(100))
   call refused(loaded%load(bytes), HBVIB_E_ARGUMENT, 'checksum', 'a damaged model')
   call refused(loaded%load(bytes(1:0)), HBVIB_E_ARGUMENT, 'mark', 'nothing')
   call works(model%free(), 'free')
   call refused(model%save(bytes), HBVIB_E_HANDLE, 'NULL', 'no model')
   call verdict(20)
end program saved
