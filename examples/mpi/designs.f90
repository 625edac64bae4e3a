! A study of many designs on the processes of MPI: the highest peak of a saved model against the normal load and the stiffness
! of its first contact, as in designs.c, whose files it shares: mpirun -n 4 ./designs_fortran MODEL FOLDER [MOST]
program designs
   use, intrinsic :: iso_fortran_env, only: error_unit, int8, int64
   use hbvib
   use mpi
   implicit none
   integer, parameter :: dp = c_double, loads = 12, stiffnesses = 8, chunk = 8, chunks = loads*stiffnesses/chunk
   real(dp), parameter :: pi = acos(-1._dp)
   interface
      function c_rename(from, to) bind(c, name='rename') result(failed)
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: from(*), to(*)
         integer(c_int) :: failed
      end function c_rename
   end interface
   type(hbvib_model) :: model
   integer(int8), allocatable :: bytes(:)
   integer(int8) :: mark(8)
   character(480) :: model_path, folder, text
   integer :: rank, processes, missing(chunks), count, most, length, unit, left, i, error

   call mpi_init(error)
   call mpi_comm_rank(mpi_comm_world, rank, error)
   call mpi_comm_size(mpi_comm_world, processes, error)
   call need(command_argument_count() >= 2, 'needs MODEL FOLDER [MOST]')
   call get_command_argument(1, model_path)
   call get_command_argument(2, folder)
   most = chunks
   if (command_argument_count() > 2) then
      call get_command_argument(3, text)
      read (text, *) most
   end if

   ! The first process reads the model and sends its bytes to the others.
   length = 0
   if (rank == 0) then
      inquire (file=trim(model_path), size=length)
      call need(length >= 8, 'the model cannot be read')
   end if
   call mpi_bcast(length, 1, mpi_integer, 0, mpi_comm_world, error)
   allocate (bytes(length))
   if (rank == 0) then
      open (newunit=unit, file=trim(model_path), form='unformatted', access='stream', status='old', action='read')
      read (unit) bytes
      close (unit)
   end if
   call mpi_bcast(bytes, length, mpi_byte, 0, mpi_comm_world, error)
   call check(model%load(bytes))
   mark = bytes(length - 7:)

   ! The first process looks which chunks are missing, so that all divide the same ones.
   missing = 0
   count = 0
   if (rank == 0) then
      do i = 1, chunks
         if (done(i)) cycle
         count = count + 1
         missing(count) = i
      end do
   end if
   call mpi_bcast(count, 1, mpi_integer, 0, mpi_comm_world, error)
   call mpi_bcast(missing, chunks, mpi_integer, 0, mpi_comm_world, error)
   do i = 1 + rank, count, processes
      if (most <= 0) exit
      call solve(missing(i))
      most = most - 1
   end do
   call mpi_barrier(mpi_comm_world, error)

   if (rank == 0) then
      left = 0
      do i = 1, chunks
         if (.not. done(i)) left = left + 1
      end do
      write (error_unit, '(i0, a, i0, a, i0, a)') count, ' of ', chunks, ' chunks were missing, ', left, ' are now'
      if (left == 0) call table()
   end if
   call check(model%free())
   call mpi_finalize(error)

contains

   function path(number, ending)
      integer, intent(in) :: number
      character(*), intent(in) :: ending
      character(512) :: path
      write (path, '(2a, i3.3, a)') trim(folder), '/chunk_', number - 1, ending
   end function path

   !> Normal load in N and stiffness in N/m of a design, counted from 0.
   pure function values_of(design) result(values)
      integer, intent(in) :: design
      real(dp) :: values(2)
      values = [100._dp + 100*(design/stiffnesses), 3e7_dp + 1e7_dp*mod(design, stiffnesses)]
   end function values_of

   !> Reads a chunk; .false. where it is not done yet, or belongs to another model.
   function done(number, amplitude, omega, statuses)
      integer, intent(in) :: number
      real(dp), intent(out), optional :: amplitude(chunk), omega(chunk)
      integer(int64), intent(out), optional :: statuses(chunk)
      logical :: done
      integer(int8) :: its(8)
      real(dp) :: a(chunk), w(chunk)
      integer(int64) :: s(chunk)
      integer :: unit, stat
      done = .false.
      open (newunit=unit, file=trim(path(number, '.bin')), form='unformatted', access='stream', status='old', &
            action='read', iostat=stat)
      if (stat /= 0) return
      read (unit, iostat=stat) its, a, w, s
      close (unit)
      done = stat == 0
      if (done) done = all(its == mark)
      if (present(amplitude)) amplitude = a
      if (present(omega)) omega = w
      if (present(statuses)) statuses = s
   end function done

   !> Solves a chunk and writes it under its name when it is whole.
   subroutine solve(number)
      integer, intent(in) :: number
      type(hbvib_solver_options) :: solver
      type(hbvib_parameter) :: parameters(2)
      real(dp) :: values(2, chunk), amplitude(chunk), omega(chunk)
      integer(c_int32_t) :: statuses(chunk)
      integer :: unit, i
      do i = 1, chunk
         values(:, i) = values_of((number - 1)*chunk + i - 1)
      end do
      parameters%kind = [HBVIB_PARAMETER_PRELOAD, HBVIB_PARAMETER_KT]
      parameters%contact = 1
      solver%tolerance = 0
      solver%harmonics = 9
      solver%response_dof = 1
      call check(model%batch(2*pi*205, 2*pi*213, parameters, values, amplitude, omega, statuses, solver=solver))
      open (newunit=unit, file=trim(path(number, '.part')), form='unformatted', access='stream', status='replace', action='write')
      write (unit) mark, amplitude, omega, int(statuses, int64)
      close (unit)
      call need(c_rename(trim(path(number, '.part'))//c_null_char, trim(path(number, '.bin'))//c_null_char) == 0, &
                'the folder cannot be written')
   end subroutine solve

   subroutine table()
      real(dp) :: amplitude(chunk), omega(chunk), values(2)
      integer(int64) :: statuses(chunk)
      integer :: i, k
      write (*, '(a)') '  N0/N   kt/(N/m)              f/Hz            |X1|/m  status'
      do i = 1, chunks
         call need(done(i, amplitude, omega, statuses), 'a chunk cannot be read')
         do k = 1, chunk
            values = values_of((i - 1)*chunk + k - 1)
            write (*, '(i6, 2x, es9.2e2, 2x, f16.11, 2x, es16.9e2, 2x, i6)') nint(values(1)), values(2), omega(k)/(2*pi), &
               amplitude(k), statuses(k)
         end do
      end do
   end subroutine table

   subroutine check(status)
      integer(c_int32_t), intent(in) :: status
      call need(status >= HBVIB_OK, hbvib_error_text())
   end subroutine check

   subroutine need(holds, what)
      logical, intent(in) :: holds
      character(*), intent(in) :: what
      if (holds) return
      write (error_unit, '(2a)') 'designs: ', what
      call mpi_abort(mpi_comm_world, 1, error)
   end subroutine need

end program designs
