! Size of every struct and size and offset of its fields, as Fortran sees them: "struct field offset size", for comparison with
! the other languages.
program layout
   use hbvib
   implicit none
   character(:), allocatable :: struct

   call matrix()
   call contact()
   call force_call()
   call user_force()
   call jacobian_gap()
   call solver_options()
   call forced_options()
   call progress()
   call hooks()
   call mode_options()
   call view()
   call reduction()
   call energy()
   call contact_summary()
   call mode_point()
   call mode_info()
   call synthesis_options()
   call time_options()
   call time_info()
   call verify_options()
   call verification()

contains

   subroutine whole(name, size)
      character(*), intent(in) :: name
      integer(c_size_t), intent(in) :: size
      struct = name
      write (*, '(a, " sizeof 0 ", i0)') struct, size
   end subroutine whole

   subroutine field(name, start, place, size)
      character(*), intent(in) :: name
      type(c_ptr), intent(in) :: start, place
      integer(c_size_t), intent(in) :: size
      write (*, '(a, 1x, a, 1x, i0, 1x, i0)') struct, name, transfer(place, 0_c_intptr_t) - transfer(start, 0_c_intptr_t), size
   end subroutine field

   subroutine matrix()
      type(hbvib_matrix), target :: s
      call whole('hbvib_matrix', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('storage', c_loc(s), c_loc(s%storage), c_sizeof(s%storage))
      call field('scalar', c_loc(s), c_loc(s%scalar), c_sizeof(s%scalar))
      call field('part', c_loc(s), c_loc(s%part), c_sizeof(s%part))
      call field('rows', c_loc(s), c_loc(s%rows), c_sizeof(s%rows))
      call field('cols', c_loc(s), c_loc(s%cols), c_sizeof(s%cols))
      call field('ld', c_loc(s), c_loc(s%ld), c_sizeof(s%ld))
      call field('values', c_loc(s), c_loc(s%values), c_sizeof(s%values))
      call field('col_ptr', c_loc(s), c_loc(s%col_ptr), c_sizeof(s%col_ptr))
      call field('row_idx', c_loc(s), c_loc(s%row_idx), c_sizeof(s%row_idx))
      call field('index_base', c_loc(s), c_loc(s%index_base), c_sizeof(s%index_base))
      call field('reserved', c_loc(s), c_loc(s%reserved), c_sizeof(s%reserved))
   end subroutine matrix

   subroutine contact()
      type(hbvib_contact), target :: s
      call whole('hbvib_contact', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('kind', c_loc(s), c_loc(s%kind), c_sizeof(s%kind))
      call field('dof_a', c_loc(s), c_loc(s%dof_a), c_sizeof(s%dof_a))
      call field('dof_b', c_loc(s), c_loc(s%dof_b), c_sizeof(s%dof_b))
      call field('sector_offset', c_loc(s), c_loc(s%sector_offset), c_sizeof(s%sector_offset))
      call field('kt', c_loc(s), c_loc(s%kt), c_sizeof(s%kt))
      call field('kn', c_loc(s), c_loc(s%kn), c_sizeof(s%kn))
      call field('mu', c_loc(s), c_loc(s%mu), c_sizeof(s%mu))
      call field('preload', c_loc(s), c_loc(s%preload), c_sizeof(s%preload))
      call field('gap', c_loc(s), c_loc(s%gap), c_sizeof(s%gap))
      call field('cubic', c_loc(s), c_loc(s%cubic), c_sizeof(s%cubic))
      call field('velocity', c_loc(s), c_loc(s%velocity), c_sizeof(s%velocity))
      call field('normal', c_loc(s), c_loc(s%normal), c_sizeof(s%normal))
      call field('tangent', c_loc(s), c_loc(s%tangent), c_sizeof(s%tangent))
   end subroutine contact

   subroutine force_call()
      type(hbvib_force_call), target :: s
      call whole('hbvib_force_call', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('reserved', c_loc(s), c_loc(s%reserved), c_sizeof(s%reserved))
      call field('omega', c_loc(s), c_loc(s%omega), c_sizeof(s%omega))
      call field('samples', c_loc(s), c_loc(s%samples), c_sizeof(s%samples))
      call field('n', c_loc(s), c_loc(s%n), c_sizeof(s%n))
      call field('states', c_loc(s), c_loc(s%states), c_sizeof(s%states))
      call field('u', c_loc(s), c_loc(s%u), c_sizeof(s%u))
      call field('v', c_loc(s), c_loc(s%v), c_sizeof(s%v))
      call field('z0', c_loc(s), c_loc(s%z0), c_sizeof(s%z0))
      call field('f', c_loc(s), c_loc(s%f), c_sizeof(s%f))
      call field('df_du', c_loc(s), c_loc(s%df_du), c_sizeof(s%df_du))
      call field('df_dv', c_loc(s), c_loc(s%df_dv), c_sizeof(s%df_dv))
      call field('z', c_loc(s), c_loc(s%z), c_sizeof(s%z))
      call field('dz_dz', c_loc(s), c_loc(s%dz_dz), c_sizeof(s%dz_dz))
      call field('dz_du_before', c_loc(s), c_loc(s%dz_du_before), c_sizeof(s%dz_du_before))
      call field('dz_du', c_loc(s), c_loc(s%dz_du), c_sizeof(s%dz_du))
      call field('dz_dv_before', c_loc(s), c_loc(s%dz_dv_before), c_sizeof(s%dz_dv_before))
      call field('dz_dv', c_loc(s), c_loc(s%dz_dv), c_sizeof(s%dz_dv))
      call field('dz_domega', c_loc(s), c_loc(s%dz_domega), c_sizeof(s%dz_domega))
      call field('df_dz', c_loc(s), c_loc(s%df_dz), c_sizeof(s%df_dz))
   end subroutine force_call

   subroutine user_force()
      type(hbvib_user_force), target :: s
      call whole('hbvib_user_force', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('uses_velocity', c_loc(s), c_loc(s%uses_velocity), c_sizeof(s%uses_velocity))
      call field('is_odd', c_loc(s), c_loc(s%is_odd), c_sizeof(s%is_odd))
      call field('reserved', c_loc(s), c_loc(s%reserved), c_sizeof(s%reserved))
      call field('dofs', c_loc(s), c_loc(s%dofs), c_sizeof(s%dofs))
      call field('n', c_loc(s), c_loc(s%n), c_sizeof(s%n))
      call field('states', c_loc(s), c_loc(s%states), c_sizeof(s%states))
      call field('samples', c_loc(s), c_loc(s%samples), c_sizeof(s%samples))
      call field('force', c_loc(s), c_loc(s%force), c_sizeof(s%force))
      call field('user', c_loc(s), c_loc(s%user), c_sizeof(s%user))
   end subroutine user_force

   subroutine jacobian_gap()
      type(hbvib_jacobian_gap), target :: s
      call whole('hbvib_jacobian_gap', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('tangent', c_loc(s), c_loc(s%tangent), c_sizeof(s%tangent))
      call field('gap', c_loc(s), c_loc(s%gap), c_sizeof(s%gap))
      call field('sample', c_loc(s), c_loc(s%sample), c_sizeof(s%sample))
      call field('row', c_loc(s), c_loc(s%row), c_sizeof(s%row))
      call field('column', c_loc(s), c_loc(s%column), c_sizeof(s%column))
      call field('given', c_loc(s), c_loc(s%given), c_sizeof(s%given))
      call field('difference', c_loc(s), c_loc(s%difference), c_sizeof(s%difference))
   end subroutine jacobian_gap

   subroutine solver_options()
      type(hbvib_solver_options), target :: s
      call whole('hbvib_solver_options', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('num_threads', c_loc(s), c_loc(s%num_threads), c_sizeof(s%num_threads))
      call field('tolerance', c_loc(s), c_loc(s%tolerance), c_sizeof(s%tolerance))
      call field('harmonics', c_loc(s), c_loc(s%harmonics), c_sizeof(s%harmonics))
      call field('max_harmonics', c_loc(s), c_loc(s%max_harmonics), c_sizeof(s%max_harmonics))
      call field('samples', c_loc(s), c_loc(s%samples), c_sizeof(s%samples))
      call field('step', c_loc(s), c_loc(s%step), c_sizeof(s%step))
      call field('step_min', c_loc(s), c_loc(s%step_min), c_sizeof(s%step_min))
      call field('step_max', c_loc(s), c_loc(s%step_max), c_sizeof(s%step_max))
      call field('tol_residual', c_loc(s), c_loc(s%tol_residual), c_sizeof(s%tol_residual))
      call field('max_newton', c_loc(s), c_loc(s%max_newton), c_sizeof(s%max_newton))
      call field('max_points', c_loc(s), c_loc(s%max_points), c_sizeof(s%max_points))
      call field('response_dof', c_loc(s), c_loc(s%response_dof), c_sizeof(s%response_dof))
      call field('keep_even_harmonics', c_loc(s), c_loc(s%keep_even_harmonics), c_sizeof(s%keep_even_harmonics))
      call field('estimate_error', c_loc(s), c_loc(s%estimate_error), c_sizeof(s%estimate_error))
   end subroutine solver_options

   subroutine forced_options()
      type(hbvib_forced_options), target :: s
      call whole('hbvib_forced_options', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('reserved', c_loc(s), c_loc(s%reserved), c_sizeof(s%reserved))
      call field('omega_start', c_loc(s), c_loc(s%omega_start), c_sizeof(s%omega_start))
      call field('omega_stop', c_loc(s), c_loc(s%omega_stop), c_sizeof(s%omega_stop))
      call field('at', c_loc(s), c_loc(s%at), c_sizeof(s%at))
      call field('at_len', c_loc(s), c_loc(s%at_len), c_sizeof(s%at_len))
      call field('guess', c_loc(s), c_loc(s%guess), c_sizeof(s%guess))
      call field('guess_len', c_loc(s), c_loc(s%guess_len), c_sizeof(s%guess_len))
   end subroutine forced_options

   subroutine progress()
      type(hbvib_progress), target :: s
      call whole('hbvib_progress', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('newton_iterations', c_loc(s), c_loc(s%newton_iterations), c_sizeof(s%newton_iterations))
      call field('point', c_loc(s), c_loc(s%point), c_sizeof(s%point))
      call field('parameter', c_loc(s), c_loc(s%parameter), c_sizeof(s%parameter))
      call field('amplitude', c_loc(s), c_loc(s%amplitude), c_sizeof(s%amplitude))
      call field('residual', c_loc(s), c_loc(s%residual), c_sizeof(s%residual))
      call field('step', c_loc(s), c_loc(s%step), c_sizeof(s%step))
      call field('fraction_done', c_loc(s), c_loc(s%fraction_done), c_sizeof(s%fraction_done))
   end subroutine progress

   subroutine hooks()
      type(hbvib_hooks), target :: s
      call whole('hbvib_hooks', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('log_level', c_loc(s), c_loc(s%log_level), c_sizeof(s%log_level))
      call field('user', c_loc(s), c_loc(s%user), c_sizeof(s%user))
      call field('progress', c_loc(s), c_loc(s%progress), c_sizeof(s%progress))
      call field('log', c_loc(s), c_loc(s%log), c_sizeof(s%log))
      call field('cancel', c_loc(s), c_loc(s%cancel), c_sizeof(s%cancel))
   end subroutine hooks

   subroutine mode_options()
      type(hbvib_mode_options), target :: s
      call whole('hbvib_mode_options', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('damping_form', c_loc(s), c_loc(s%damping_form), c_sizeof(s%damping_form))
      call field('log10_start', c_loc(s), c_loc(s%log10_start), c_sizeof(s%log10_start))
      call field('log10_stop', c_loc(s), c_loc(s%log10_stop), c_sizeof(s%log10_stop))
      call field('diameter', c_loc(s), c_loc(s%diameter), c_sizeof(s%diameter))
      call field('mode_index', c_loc(s), c_loc(s%mode_index), c_sizeof(s%mode_index))
      call field('near_omega', c_loc(s), c_loc(s%near_omega), c_sizeof(s%near_omega))
      call field('shape', c_loc(s), c_loc(s%shape), c_sizeof(s%shape))
      call field('shape_len', c_loc(s), c_loc(s%shape_len), c_sizeof(s%shape_len))
      call field('amplitude_contact', c_loc(s), c_loc(s%amplitude_contact), c_sizeof(s%amplitude_contact))
      call field('at', c_loc(s), c_loc(s%at), c_sizeof(s%at))
      call field('at_len', c_loc(s), c_loc(s%at_len), c_sizeof(s%at_len))
      call field('reference_dof', c_loc(s), c_loc(s%reference_dof), c_sizeof(s%reference_dof))
   end subroutine mode_options

   subroutine view()
      type(hbvib_view), target :: s
      call whole('hbvib_view', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('scalar', c_loc(s), c_loc(s%scalar), c_sizeof(s%scalar))
      call field('rank', c_loc(s), c_loc(s%rank), c_sizeof(s%rank))
      call field('reserved', c_loc(s), c_loc(s%reserved), c_sizeof(s%reserved))
      call field('data', c_loc(s), c_loc(s%data), c_sizeof(s%data))
      call field('shape', c_loc(s), c_loc(s%shape), c_sizeof(s%shape))
      call field('stride', c_loc(s), c_loc(s%stride), c_sizeof(s%stride))
   end subroutine view

   subroutine reduction()
      type(hbvib_reduction), target :: s
      call whole('hbvib_reduction', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('reserved', c_loc(s), c_loc(s%reserved), c_sizeof(s%reserved))
      call field('sectors', c_loc(s), c_loc(s%sectors), c_sizeof(s%sectors))
      call field('degrees_of_freedom', c_loc(s), c_loc(s%degrees_of_freedom), c_sizeof(s%degrees_of_freedom))
      call field('coordinates', c_loc(s), c_loc(s%coordinates), c_sizeof(s%coordinates))
      call field('contacts', c_loc(s), c_loc(s%contacts), c_sizeof(s%contacts))
      call field('never_slipping', c_loc(s), c_loc(s%never_slipping), c_sizeof(s%never_slipping))
      call field('inert', c_loc(s), c_loc(s%inert), c_sizeof(s%inert))
      call field('harmonics_asked', c_loc(s), c_loc(s%harmonics_asked), c_sizeof(s%harmonics_asked))
      call field('harmonics_carried', c_loc(s), c_loc(s%harmonics_carried), c_sizeof(s%harmonics_carried))
      call field('unknowns', c_loc(s), c_loc(s%unknowns), c_sizeof(s%unknowns))
      call field('response_dof', c_loc(s), c_loc(s%response_dof), c_sizeof(s%response_dof))
      call field('mean_carried', c_loc(s), c_loc(s%mean_carried), c_sizeof(s%mean_carried))
      call field('even_removed', c_loc(s), c_loc(s%even_removed), c_sizeof(s%even_removed))
      call field('held_by_contacts', c_loc(s), c_loc(s%held_by_contacts), c_sizeof(s%held_by_contacts))
   end subroutine reduction

   subroutine energy()
      type(hbvib_energies), target :: s
      call whole('hbvib_energy', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('reserved', c_loc(s), c_loc(s%reserved), c_sizeof(s%reserved))
      call field('twice_mean_kinetic', c_loc(s), c_loc(s%twice_mean_kinetic), c_sizeof(s%twice_mean_kinetic))
      call field('kinetic_mean', c_loc(s), c_loc(s%kinetic_mean), c_sizeof(s%kinetic_mean))
      call field('kinetic_peak', c_loc(s), c_loc(s%kinetic_peak), c_sizeof(s%kinetic_peak))
      call field('potential_mean', c_loc(s), c_loc(s%potential_mean), c_sizeof(s%potential_mean))
      call field('potential_peak', c_loc(s), c_loc(s%potential_peak), c_sizeof(s%potential_peak))
      call field('wheel_kinetic_mean', c_loc(s), c_loc(s%wheel_kinetic_mean), c_sizeof(s%wheel_kinetic_mean))
      call field('wheel_kinetic_peak', c_loc(s), c_loc(s%wheel_kinetic_peak), c_sizeof(s%wheel_kinetic_peak))
      call field('wheel_potential_mean', c_loc(s), c_loc(s%wheel_potential_mean), c_sizeof(s%wheel_potential_mean))
      call field('wheel_potential_peak', c_loc(s), c_loc(s%wheel_potential_peak), c_sizeof(s%wheel_potential_peak))
      call field('structural_loss', c_loc(s), c_loc(s%structural_loss), c_sizeof(s%structural_loss))
      call field('friction_loss', c_loc(s), c_loc(s%friction_loss), c_sizeof(s%friction_loss))
   end subroutine energy

   subroutine contact_summary()
      type(hbvib_contact_summary), target :: s
      call whole('hbvib_contact_summary', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('reserved', c_loc(s), c_loc(s%reserved), c_sizeof(s%reserved))
      call field('work', c_loc(s), c_loc(s%work), c_sizeof(s%work))
      call field('slip_share', c_loc(s), c_loc(s%slip_share), c_sizeof(s%slip_share))
      call field('open_share', c_loc(s), c_loc(s%open_share), c_sizeof(s%open_share))
      call field('half_range', c_loc(s), c_loc(s%half_range), c_sizeof(s%half_range))
      call field('motion_min', c_loc(s), c_loc(s%motion_min), c_sizeof(s%motion_min))
      call field('motion_max', c_loc(s), c_loc(s%motion_max), c_sizeof(s%motion_max))
      call field('load_min', c_loc(s), c_loc(s%load_min), c_sizeof(s%load_min))
      call field('load_max', c_loc(s), c_loc(s%load_max), c_sizeof(s%load_max))
      call field('directions', c_loc(s), c_loc(s%directions), c_sizeof(s%directions))
      call field('all_min', c_loc(s), c_loc(s%all_min), c_sizeof(s%all_min))
      call field('all_max', c_loc(s), c_loc(s%all_max), c_sizeof(s%all_max))
   end subroutine contact_summary

   subroutine mode_point()
      type(hbvib_mode_point), target :: s
      call whole('hbvib_mode_point', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('reserved', c_loc(s), c_loc(s%reserved), c_sizeof(s%reserved))
      call field('log10_amplitude', c_loc(s), c_loc(s%log10_amplitude), c_sizeof(s%log10_amplitude))
      call field('omega', c_loc(s), c_loc(s%omega), c_sizeof(s%omega))
      call field('damping_ratio', c_loc(s), c_loc(s%damping_ratio), c_sizeof(s%damping_ratio))
      call field('modal_amplitude', c_loc(s), c_loc(s%modal_amplitude), c_sizeof(s%modal_amplitude))
      call field('energy', c_loc(s), c_loc(s%energy), c_sizeof(s%energy))
      call field('fundamental_share', c_loc(s), c_loc(s%fundamental_share), c_sizeof(s%fundamental_share))
      call field('friction_loss', c_loc(s), c_loc(s%friction_loss), c_sizeof(s%friction_loss))
      call field('structural_loss', c_loc(s), c_loc(s%structural_loss), c_sizeof(s%structural_loss))
      call field('energy_damping_ratio', c_loc(s), c_loc(s%energy_damping_ratio), c_sizeof(s%energy_damping_ratio))
      call field('assurance', c_loc(s), c_loc(s%assurance), c_sizeof(s%assurance))
   end subroutine mode_point

   subroutine mode_info()
      type(hbvib_mode_info), target :: s
      call whole('hbvib_mode_info', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('multiple', c_loc(s), c_loc(s%multiple), c_sizeof(s%multiple))
      call field('mode_index', c_loc(s), c_loc(s%mode_index), c_sizeof(s%mode_index))
      call field('multiplicity', c_loc(s), c_loc(s%multiplicity), c_sizeof(s%multiplicity))
      call field('reference_dof', c_loc(s), c_loc(s%reference_dof), c_sizeof(s%reference_dof))
      call field('engine_order', c_loc(s), c_loc(s%engine_order), c_sizeof(s%engine_order))
      call field('amplitude_contact', c_loc(s), c_loc(s%amplitude_contact), c_sizeof(s%amplitude_contact))
      call field('omega', c_loc(s), c_loc(s%omega), c_sizeof(s%omega))
      call field('linear_up_to', c_loc(s), c_loc(s%linear_up_to), c_sizeof(s%linear_up_to))
   end subroutine mode_info

   subroutine synthesis_options()
      type(hbvib_synthesis_options), target :: s
      call whole('hbvib_synthesis_options', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('model_damping', c_loc(s), c_loc(s%model_damping), c_sizeof(s%model_damping))
      call field('force_factor', c_loc(s), c_loc(s%force_factor), c_sizeof(s%force_factor))
      call field('damping_ratio', c_loc(s), c_loc(s%damping_ratio), c_sizeof(s%damping_ratio))
   end subroutine synthesis_options

   subroutine time_options()
      type(hbvib_time_options), target :: s
      call whole('hbvib_time_options', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('method', c_loc(s), c_loc(s%method), c_sizeof(s%method))
      call field('omega', c_loc(s), c_loc(s%omega), c_sizeof(s%omega))
      call field('harmonics', c_loc(s), c_loc(s%harmonics), c_sizeof(s%harmonics))
      call field('samples', c_loc(s), c_loc(s%samples), c_sizeof(s%samples))
      call field('tolerance', c_loc(s), c_loc(s%tolerance), c_sizeof(s%tolerance))
      call field('max_periods', c_loc(s), c_loc(s%max_periods), c_sizeof(s%max_periods))
      call field('start', c_loc(s), c_loc(s%start), c_sizeof(s%start))
      call field('start_len', c_loc(s), c_loc(s%start_len), c_sizeof(s%start_len))
   end subroutine time_options

   subroutine time_info()
      type(hbvib_time_info), target :: s
      call whole('hbvib_time_info', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('reserved', c_loc(s), c_loc(s%reserved), c_sizeof(s%reserved))
      call field('period', c_loc(s), c_loc(s%period), c_sizeof(s%period))
      call field('residual', c_loc(s), c_loc(s%residual), c_sizeof(s%residual))
      call field('periods', c_loc(s), c_loc(s%periods), c_sizeof(s%periods))
      call field('events', c_loc(s), c_loc(s%events), c_sizeof(s%events))
   end subroutine time_info

   subroutine verify_options()
      type(hbvib_verify_options), target :: s
      call whole('hbvib_verify_options', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('method', c_loc(s), c_loc(s%method), c_sizeof(s%method))
      call field('tolerance', c_loc(s), c_loc(s%tolerance), c_sizeof(s%tolerance))
      call field('max_periods', c_loc(s), c_loc(s%max_periods), c_sizeof(s%max_periods))
      call field('same_within', c_loc(s), c_loc(s%same_within), c_sizeof(s%same_within))
   end subroutine verify_options

   subroutine verification()
      type(hbvib_verification), target :: s
      call whole('hbvib_verification', c_sizeof(s))
      call field('struct_size', c_loc(s), c_loc(s%struct_size), c_sizeof(s%struct_size))
      call field('same_solution', c_loc(s), c_loc(s%same_solution), c_sizeof(s%same_solution))
      call field('marched', c_loc(s), c_loc(s%marched), c_sizeof(s%marched))
      call field('reserved', c_loc(s), c_loc(s%reserved), c_sizeof(s%reserved))
      call field('harmonic', c_loc(s), c_loc(s%harmonic), c_sizeof(s%harmonic))
      call field('response', c_loc(s), c_loc(s%response), c_sizeof(s%response))
      call field('response_error', c_loc(s), c_loc(s%response_error), c_sizeof(s%response_error))
      call field('motion_error', c_loc(s), c_loc(s%motion_error), c_sizeof(s%motion_error))
      call field('above', c_loc(s), c_loc(s%above), c_sizeof(s%above))
      call field('distance', c_loc(s), c_loc(s%distance), c_sizeof(s%distance))
      call field('peak', c_loc(s), c_loc(s%peak), c_sizeof(s%peak))
      call field('peak_error', c_loc(s), c_loc(s%peak_error), c_sizeof(s%peak_error))
      call field('residual', c_loc(s), c_loc(s%residual), c_sizeof(s%residual))
      call field('periods', c_loc(s), c_loc(s%periods), c_sizeof(s%periods))
      call field('events', c_loc(s), c_loc(s%events), c_sizeof(s%events))
   end subroutine verification

end program layout
