! Threads that solve one model at once agree bit for bit with the serial run; each sees its own error sentence.
program threads
   !$ use omp_lib, only: omp_get_num_threads
   use common
   implicit none
   integer, parameter :: runs = 32
   type(hbvib_model) :: model
   type(solution) :: serial
   type(solution) :: found(runs)
   logical :: told(runs)
   integer(c_int32_t) :: status(runs), refusal(runs)
   integer :: i, workers

   workers = 1
   call ring_damper(model)
   call works(solve(model, serial), 'the serial run')
   !$omp parallel num_threads(8)
   !$omp single
   !$ workers = omp_get_num_threads()
   !$omp end single
   !$omp do schedule(dynamic)
   do i = 1, runs
      refusal(i) = model%set_preload(i + 1, 1._dp)
      told(i) = tells(refusal(i), i + 1)
      status(i) = solve(model, found(i))
   end do
   !$omp end do
   !$omp end parallel
   call expect('several threads ran', workers > 1)
   do i = 1, runs
      call expect('a thread solves', status(i) == HBVIB_OK)
      if (status(i) == HBVIB_OK) call expect('a thread finds the bits of the serial run', same(found(i), serial))
      call expect('a thread reads its own error', told(i) .and. (refusal(i) == HBVIB_E_INDEX .or. refusal(i) == HBVIB_E_BUSY))
   end do
   call works(model%free(), 'free')
   call verdict(100)

contains

   ! Whether the sentence is that of the error.
   function tells(status, id)
      integer(c_int32_t), intent(in) :: status
      integer, intent(in) :: id
      logical :: tells
      character(:), allocatable :: sentence
      character(24) :: number
      call hbvib_read_error(sentence)
      write (number, '("id = ", i0)') id
      ! While another thread solves, the model may be in use.
      if (status == HBVIB_E_BUSY) number = 'in use'
      tells = index(sentence, trim(number)) > 0
   end function tells

end program threads
