classdef Model < handle
%MODEL  A structure with its contacts and forces: M x'' + C x' + K x + f_contact(x) = f_excitation.
%
%   model = hbvib.Model('mass', M, 'stiffness', K, 'damping', C, 'rayleigh', [alpha beta])
%   model = hbvib.Model.cyclic('sectors', N, 'engine_order', EO, 'mass', M, ..., 'coupling', struct('stiffness', K1))
%   model = hbvib.Model.sector('sectors', N, 'engine_order', EO, 'mass', M, ..., 'left', dofs, 'right', dofs, ...)
%
%   Names and options are those of Python and of hbvib.h. Degrees of freedom, contacts, points and modes count from 1;
%   hbvib.GROUND is the ground. Harmonics of a motion are columns: x(dof, 1 + h). Other functions of the library are
%   called by hbvib_mex, with the handle of the model in model.id, where indices count from 0.
%
%   Example: a mass on a spring rubs against the ground.
%     model = hbvib.Model('mass', 1, 'stiffness', 1, 'rayleigh', [0 0.02]);
%     model.add_contact('jenkins', 1, 'kt', 1, 'mu', 0.3, 'preload', 1);
%     model.add_force(1, 0.2);
%     branch = model.forced_response([0.8 1.6]);
%     plot(branch.omega, branch.amplitude)
  properties (SetAccess = private)
    id = uint64(0);  % the handle of the library
    ndof = 0;        % degrees of freedom, of one sector if cyclic
    sectors = 1;     % 1 for a plain structure
  end
  properties (Dependent)
    contacts         % number of contacts
    engine_order     % of the excitation of a cyclic model
  end

  methods
    function self = Model(varargin)
      if nargin == 1 && isa(varargin{1}, 'uint64')
        self.id = varargin{1};
      else
        self.id = hbvib.Model.made(varargin, false);
      end
      self.ndof = hbvib_mex('model_dofs', self.id);
      self.sectors = hbvib_mex('model_sectors', self.id);
    end

    function delete(self)
    % At the end of a session the gateway may be gone before its objects.
      try
        self.free();
      catch
      end
    end

    function free(self)
    %FREE  Frees the model; branches solved from it stay.
      if self.id ~= 0
        hbvib_mex('model_free', self.id);
        self.id = uint64(0);
      end
    end

    function copy = clone(self)
    %CLONE  A copy; `b = a` is another name for one model.
      copy = hbvib.Model(hbvib_mex('model_clone', self.id));
    end

    function copy = longer_period(self, periods)
    %LONGER_PERIOD  A copy for motions with some periods of the forces, as those of a child whose descent.periods is above 1.
      copy = hbvib.Model(hbvib_mex('model_longer_period', self.id, periods));
    end

    function n = get.contacts(self)
      n = hbvib_mex('model_contacts', self.id);
    end

    function n = get.engine_order(self)
      n = hbvib_mex('model_wave', self.id);
    end

    function disp(self)
      if self.id == 0
        fprintf('  hbvib.Model, freed\n');
      elseif self.sectors > 1
        fprintf('  hbvib.Model: %d degrees of freedom, %d sectors, engine order %d, %d contacts\n', self.ndof, self.sectors, ...
                self.engine_order, self.contacts);
      else
        fprintf('  hbvib.Model: %d degrees of freedom, %d contacts\n', self.ndof, self.contacts);
      end
    end

    function set_matrix(self, which, matrix, part)
    %SET_MATRIX  'mass', 'damping', 'stiffness', 'structural', 'gyroscopic' or 'stiffness_speed2'.
    %   part: 'full' (symmetric or Hermitian), 'lower', 'upper', 'general', 'symmetric' (complex A = A.').
      if nargin < 4, part = 'full'; end
      hbvib_mex('model_set_matrix', self.id, which, hbvib.internal.matrix(matrix, part));
    end

    function set_coupling(self, which, to_next)
    %SET_COUPLING  Matrix of a sector (rows) to the next one (columns).
      hbvib_mex('cyclic_set_coupling', self.id, which, hbvib.internal.matrix(to_next, 'general'));
    end

    function set_rayleigh(self, alpha, beta)
    %SET_RAYLEIGH  Adds alpha M + beta K to the damping.
      hbvib_mex('model_set_rayleigh', self.id, alpha, beta);
    end

    function set_modal_damping(self, ratios)
    %SET_MODAL_DAMPING  Damping ratios of the lowest linear modes.
      hbvib_mex('model_set_modal_damping', self.id, numel(ratios), ratios);
    end

    function set_wave(self, engine_order)
    %SET_WAVE  The engine order of a cyclic model.
      hbvib_mex('cyclic_set_wave', self.id, engine_order);
    end

    function set_speed(self, speed)
    %SET_SPEED  The speed of rotation.
      hbvib_mex('model_set_speed', self.id, speed);
    end

    function fix(self, dofs)
    %FIX  Degrees of freedom that do not move.
      hbvib_mex('model_fix', self.id, numel(dofs), hbvib.internal.zero('dof', dofs(:), self.ndof));
    end

    function add_force(self, dof, force, harmonic)
    %ADD_FORCE  Adds Re(force exp(i harmonic omega t)) on a degree of freedom; harmonic 1 where left out.
      if nargin < 4, harmonic = 1; end
      dof = hbvib.internal.zero('dof', dof, self.ndof);
      hbvib_mex('model_add_force', self.id, dof, harmonic, real(force), imag(force));
    end

    function clear_forces(self)
      hbvib_mex('model_clear_forces', self.id);
    end

    function add_springs(self, a, b, stiffness)
    %ADD_SPRINGS  Linear springs between degrees of freedom, or to hbvib.GROUND.
      n = numel(a);
      hbvib_mex('model_add_springs', self.id, n, hbvib.internal.zero('a', a(:), self.ndof), ...
                hbvib.internal.zero('b', b(:) + zeros(n, 1), self.ndof), [], stiffness(:) + zeros(n, 1));
    end

    function number = add_contact(self, kind, a, varargin)
    %ADD_CONTACT  add_contact(KIND, A, 'kt', 1, ...) against the ground, add_contact(KIND, A, B, 'kt', 1, ...) between two.
    %   KIND     'jenkins', 'friction_2d', 'friction_3d', 'unilateral', 'cubic', 'regularised'.
    %   A, B     degrees of freedom in the directions in which the law acts: t of 'jenkins', [t1 n] of 'friction_2d',
    %            [t1 t2 n] of 'friction_3d', n of 'unilateral'.
    %   options  kt, kn, mu, preload, gap, cubic, velocity, normal, tangent, sector_offset.
      b = -1;
      if ~isempty(varargin) && isnumeric(varargin{1})
        b = varargin{1};
        varargin(1) = [];
      end
      [~, law] = hbvib.internal.options('add_contact', varargin, struct(), true);
      law.kind = kind;
      law.dof_a = hbvib.internal.zero('a', hbvib.Model.side(kind, a), self.ndof);
      law.dof_b = hbvib.internal.zero('b', hbvib.Model.side(kind, b), self.ndof);
      number = hbvib_mex('model_add_contact', self.id, law) + 1;
    end

    function number = add_user_force(self, dofs, law, varargin)
    %ADD_USER_FORCE  A force of your own on some degrees of freedom, each over the ground; returns its number among the contacts.
    %   law       a function handle: result = law(call). call has u and v (n x N, a column for each of the N samples of a period),
    %             omega, and z0 where there are states. result is a struct with f (n x N) and the derivatives that are not 0:
    %             df_du(i, k, j) of f(i, j) by u(k, j), df_dv; with states z (s x N), dz_dz, dz_du, dz_du_before, dz_dv,
    %             dz_dv_before, dz_domega, df_dz. [] where it cannot at this motion; an error ends the solve.
    %   options   uses_velocity, is_odd, states, samples, as in hbvib_user_force.
    %   check_jacobian compares the derivatives with difference quotients. The law is kept until the session ends.
      [~, given] = hbvib.internal.options('add_user_force', varargin, struct(), true);
      given.dofs = hbvib.internal.zero('dofs', dofs(:), self.ndof);
      if ~isa(law, 'function_handle'), error('hbvib:input', 'add_user_force: law needs a function handle'); end
      number = hbvib_mex('model_add_user_force', self.id, given, @(call) hbvib.internal.tried(law, call)) + 1;
    end

    function gap = check_jacobian(self, contact, omega, amplitude)
    %CHECK_JACOBIAN  The derivative of a force of your own that lies farthest from its difference quotient; gap.gap below 1e-6 is right.
      contact = hbvib.internal.zero('contact', contact, self.contacts);
      gap = hbvib_mex('check_jacobian', self.id, contact, omega, amplitude, numel(amplitude));
    end

    function set_preload(self, contact, preload)
    %SET_PRELOAD  Changes the normal load of a contact.
      contact = hbvib.internal.zero('contact', contact, self.contacts);
      hbvib_mex('model_set_preload', self.id, contact, preload);
    end

    function set_slider(self, contact, place, direction)
    %SET_SLIDER  The place at which the slider of a contact begins, along direction 1 (left out) or 2: its residual state.
      if nargin < 4, direction = 1; end
      contact = hbvib.internal.zero('contact', contact, self.contacts);
      hbvib_mex('model_set_slider', self.id, contact, hbvib.internal.zero('direction', direction, 2), place);
    end

    function [omega, shapes] = linear_modes(self, count, varargin)
    %LINEAR_MODES  Lowest natural frequencies and shapes (ndof x count).
    %   options  diameter (0), contacts: 'stuck', 'free' or 'static'.
      own = hbvib.internal.options('linear_modes', varargin, struct('diameter', 0, 'contacts', 'stuck'), false);
      [omega, shapes] = hbvib_mex('linear_modes_with_hooks', self.id, own.diameter, ...
                                  hbvib.Model.member('contacts_', own.contacts), count, count, count * self.ndof, []);
      shapes = reshape(shapes, self.ndof, count);
    end

    function branch = forced_response(self, omega, varargin)
    %FORCED_RESPONSE  Follows the periodic response over [start stop] in rad per time unit, or at one frequency.
    %   options  at: frequencies solved exactly. guess: ndof x (H + 1) start values. progress: f(state), false stops.
    %            branches, branch_depth, most_branches, together.
    %            Of the solver: tolerance, harmonics (fixed), max_harmonics, response_dof, step, step_max, stability ...
      own = struct('at', [], 'guess', [], 'together', [], 'branches', [], 'branch_depth', [], 'most_branches', [], 'progress', []);
      [own, rest] = hbvib.internal.options('forced_response', varargin, own, true);
      hooks = struct('progress', hbvib.internal.guarded(own.progress));
      own = rmfield(own, 'progress');
      own.omega_start = omega(1);
      own.omega_stop = omega(end);
      [id, status] = hbvib_mex('forced_response', self.id, hbvib.internal.solver(rest, self.ndof), own, hooks);
      branch = hbvib.Branch(id, status);
      hbvib.internal.guarded();
    end

    function branch = nonlinear_mode(self, log10_amplitude, varargin)
    %NONLINEAR_MODE  Follows a nonlinear mode (EPMC) over [start stop] of log10 of the modal amplitude.
    %   options  mode_index (1), near_omega, shape, diameter, damping_form: 'mass' or 'stiffness', at, reference_dof,
    %            amplitude_contact, guess, guess_omega, guess_damping, branches, branch_depth, most_branches, progress, and
    %            those of the solver.
      own = struct('at', [], 'mode_index', 1, 'near_omega', [], 'shape', [], 'diameter', [], 'damping_form', [], ...
                   'reference_dof', [], 'amplitude_contact', [], 'guess', [], 'guess_omega', [], 'guess_damping', [], ...
                   'branches', [], 'branch_depth', [], 'most_branches', [], 'progress', []);
      [own, rest] = hbvib.internal.options('nonlinear_mode', varargin, own, true);
      hooks = struct('progress', hbvib.internal.guarded(own.progress));
      own = rmfield(own, 'progress');
      own.log10_start = log10_amplitude(1);
      own.log10_stop = log10_amplitude(end);
      own.damping_form = hbvib.Model.member('damping_', own.damping_form);
      own.mode_index = hbvib.internal.zero('mode_index', own.mode_index, self.ndof);
      own.reference_dof = hbvib.internal.zero('reference_dof', own.reference_dof, self.ndof);
      own.amplitude_contact = hbvib.internal.zero('amplitude_contact', own.amplitude_contact, self.contacts);
      [id, status] = hbvib_mex('nonlinear_mode', self.id, hbvib.internal.solver(rest, self.ndof), own, hooks);
      branch = hbvib.Branch(id, status);
      hbvib.internal.guarded();
    end

    function found = fit(self, unknowns, data, varargin)
    %FIT  Fits parameters to data of tests: theta, sd, covariance, chi2, degrees_of_freedom, residuals, values, info, status.
    %   unknowns  a cell array of structs: kind ('kt', 'mu', 'stiffness' ...), contact, scaling ('factor'), start, lower, upper,
    %             prior ([mean deviation]), scale, tied_to, data_set.
    %   data      an array of structs: kind ('response', 'amplitude', 'peak', 'backbone', 'linear_mode'), x, value, sigma,
    %             second_sigma, force, dof, response, mode, omega ([start stop]); values of a pair are complex.
    %   options   huber, starts, max_iterations, end_step, scale_covariance, progress, and those of the solver.
      own = struct('huber', 0, 'starts', 1, 'max_iterations', 60, 'end_step', 1e-6, 'scale_covariance', 0, 'progress', []);
      [own, rest] = hbvib.internal.options('fit', varargin, own, true);
      hooks = struct('progress', hbvib.internal.guarded(own.progress));
      own.step = own.end_step;
      own = rmfield(own, {'progress', 'end_step'});
      [parameters, described] = hbvib.internal.fit_unknowns(unknowns, self.contacts);
      sets = hbvib.internal.fit_data(data, self.ndof);
      solver = hbvib.internal.solver(rest, self.ndof);
      [p, rows] = deal(numel(parameters), 2 * sum([sets.n]));
      [info, theta, covariance, residuals, values, id, status] = ...
          hbvib_mex('fit', self.id, solver, own, hooks, parameters, p, described, sets, numel(sets), p, p * p, rows, rows, rows);
      hbvib.internal.guarded();
      covariance = reshape(covariance, p, p);
      found = struct('theta', theta, 'sd', sqrt(diag(covariance)), 'covariance', covariance, 'chi2', info.chi2, ...
                     'degrees_of_freedom', info.degrees_of_freedom, 'residuals', reshape(residuals, 2, []).', ...
                     'values', reshape(values, 2, []).', 'info', info, 'status', status, 'parameters', parameters, ...
                     'unknowns', described, 'data', sets, 'solver', solver, 'options', own);
      if id ~= 0, hbvib_mex('model_free', id); end
    end

    function [value, sigma, shift] = predict(self, found, wanted)
    %PREDICT  Numbers of a fit of this model with their standard deviations, two columns for each x; `wanted` is data without
    %   values. shift is that of the mean by the second order.
      sets = hbvib.internal.fit_data(wanted, self.ndof);
      rows = 2 * sets.n;
      [value, sigma, shift] = hbvib_mex('predict', self.id, found.solver, sets, [], found.parameters, numel(found.theta), ...
                                        found.theta, found.covariance, rows, rows, rows, rows);
      value = reshape(value, 2, []).';
      sigma = reshape(sigma, 2, []).';
      shift = reshape(shift, 2, []).';
    end

    function [info, loss, theta] = fit_profile(self, found, number, values, rise)
    %FIT_PROFILE  Least loss of a fit of this model over values of one parameter in ascending order, all others fitted again.
    %   info has the interval `lower` .. `upper` at the rise (3.841: 95 %) in standard deviations squared; a column of theta
    %   has the parameters at a value.
      if nargin < 5, rise = 3.841; end
      [p, n] = deal(numel(found.theta), numel(values));
      number = hbvib.internal.zero('number', number, p);
      [info, loss, theta] = hbvib_mex('fit_profile', self.id, found.solver, found.options, [], found.parameters, p, ...
                                      found.unknowns, found.data, numel(found.data), found.theta, number, n, values(:), rise, ...
                                      n, n * p);
      theta = reshape(theta, p, n);
    end

    function [x, info] = time_response(self, omega, varargin)
    %TIME_RESPONSE  The periodic response at one frequency by integration in time: harmonics ndof x (H + 1), and how it went.
    %   options  harmonics (9), method: 'shooting' or 'marching', tolerance, max_periods.
      [own, rest] = hbvib.internal.options('time_response', varargin, struct('harmonics', 9), true);
      rest.omega = omega;
      rest.harmonics = own.harmonics;
      n = self.ndof * (own.harmonics + 1);
      [x, ~, info, info.status] = hbvib_mex('time_response', self.id, rest, [], n, n, 0, 0);
      x = reshape(x, self.ndof, []);
    end

    function [info, errors] = verify(self, branch, point, varargin)
    %VERIFY  How far a point of a forced response is from the motion that integration in time finds from it.
    %   options  method, tolerance, max_periods, same_within.
      [~, rest] = hbvib.internal.options('verify', varargin, struct(), true);
      if isempty(fieldnames(rest)), rest = []; end
      rows = branch.reduction.harmonics_asked + 1;
      n = rows * self.ndof;
      [~, errors, info] = hbvib_mex('verify', self.id, branch.id, branch.from_one(point), rest, [], n, n, rows, rows);
    end

    function sliders = freedom(self, branch, point)
    %FREEDOM  The sliders of a point that stick through the period and change its vibration: contact, direction, place, derivative.
    %   Each may lie anywhere within the limit of its friction; band has the ends of what follows from that. direction is 1 or 2.
      point = branch.from_one(point);
      room = 2 * self.contacts;
      [contact, direction, place, derivative, count] = ...
          hbvib_mex('branch_freedom', self.id, branch.id, point, room, room, room, room, room, []);
      sliders = struct('contact', contact(1:count) + 1, 'direction', direction(1:count) + 1, 'place', place(1:count), ...
                       'derivative', derivative(1:count));
    end

    function found = band(self, branch, point, varargin)
    %BAND  The least and the largest result at a point over all residual forces that its sticking contacts may keep.
    %   options  of: 'amplitude', 'peak_amplitude' or 'peak_omega'; contacts: whose sliders are free, all where left out; starts.
    %   found    lower, upper and their errors, omega and gains, complete; contact and direction of the free sliders with
    %            lower_place and upper_place; branches lower_branch and upper_branch, [] where there is none.
      own = struct('of', 'amplitude', 'contacts', [], 'starts', 3);
      own = hbvib.internal.options('band', varargin, own, false);
      options = struct('of', ['band_', own.of], 'starts', own.starts);
      if ~isempty(own.contacts), options.contacts = hbvib.internal.zero('contacts', own.contacts(:), self.contacts); end
      room = 2 * self.contacts;
      [found, contact, direction, lower, upper, ~, low, high] = ...
          hbvib_mex('band', self.id, branch.id, branch.from_one(point), [], options, [], room, room, room, room, room, 0, 0);
      count = 1:found.sliders;
      found.contact = contact(count) + 1;
      found.direction = direction(count) + 1;
      found.lower_place = lower(count);
      found.upper_place = upper(count);
      ends = {low, high};
      for k = 1:2
        if ends{k} ~= 0, ends{k} = hbvib.Branch(ends{k}, 0); else, ends{k} = []; end
      end
      [found.lower_branch, found.upper_branch] = ends{:};
    end

    function bytes = to_bytes(self)
    %TO_BYTES  The model as bytes, which hbvib.Model.from_bytes and the other languages read.
      [~, size] = hbvib_mex('model_save', self.id, 0, 0);
      bytes = hbvib_mex('model_save', self.id, size, size);
    end
  end

  methods (Static)
    function model = cyclic(varargin)
    %CYCLIC  A wheel of equal sectors; matrices are those of one sector.
      model = hbvib.Model(hbvib.Model.made(varargin, true));
    end

    function model = sector(varargin)
    %SECTOR  A wheel from one sector with both faces.
    %   left, right   degrees of freedom of both faces: vectors, or pairs x 3 for x, y, z in a Cartesian frame.
    %   options       fixed, frame: 'cartesian' or 'cylindrical', axis, direction.
      own = struct('mass', [], 'stiffness', [], 'damping', [], 'sectors', [], 'engine_order', 0, 'left', [], 'right', [], ...
                   'fixed', [], 'frame', 'cartesian', 'axis', [], 'direction', []);
      own = hbvib.internal.options('sector', varargin, own, false);
      matrices = {'stiffness', own.stiffness; 'mass', own.mass; 'damping', own.damping};
      ndof = size(own.stiffness, 1);
      components = 1;
      if min(size(own.left)) > 1, components = size(own.left, 2); end
      own = rmfield(own, {'mass', 'stiffness', 'damping'});
      own.ndof = ndof;
      own.components = components;
      for name = {'left', 'right', 'fixed'}
        rows = own.(name{1}).';  % pair after pair
        own.(name{1}) = hbvib.internal.zero(name{1}, rows(:), ndof);
      end
      model = hbvib.Model(hbvib_mex('cyclic_from_sector', own));
      for k = 1:3
        if ~isempty(matrices{k, 2}), model.set_matrix(matrices{k, 1}, matrices{k, 2}); end
      end
    end

    function model = from_bytes(bytes)
    %FROM_BYTES  The model that to_bytes saved.
      model = hbvib.Model(hbvib_mex('model_load', numel(bytes), bytes));
    end
  end

  methods (Static, Access = private)
    function id = made(given, cyclic)
      own = struct('ndof', [], 'mass', [], 'damping', [], 'stiffness', [], 'rayleigh', []);
      if cyclic
        own.sectors = [];
        own.engine_order = 0;
        own.coupling = struct();
      end
      own = hbvib.internal.options('Model', given, own, false);
      kinds = {'mass', 'damping', 'stiffness'};
      for k = 1:3
        if isempty(own.ndof) && ~isempty(own.(kinds{k})), own.ndof = size(own.(kinds{k}), 1); end
      end
      if isempty(own.ndof), error('hbvib:input', 'Model: needs ndof or a matrix'); end
      if cyclic
        id = hbvib_mex('cyclic_new', own.ndof, own.sectors);
      else
        id = hbvib_mex('model_new', own.ndof);
      end
      try
        for k = 1:3
          value = own.(kinds{k});
          if ~isempty(value), hbvib_mex('model_set_matrix', id, kinds{k}, hbvib.internal.matrix(value, 'full')); end
        end
        if cyclic
          for name = fieldnames(own.coupling)'
            matrix = hbvib.internal.matrix(own.coupling.(name{1}), 'general');
            hbvib_mex('cyclic_set_coupling', id, name{1}, matrix);
          end
          hbvib_mex('cyclic_set_wave', id, own.engine_order);
        end
        if ~isempty(own.rayleigh), hbvib_mex('model_set_rayleigh', id, own.rayleigh(1), own.rayleigh(2)); end
      catch failure
        hbvib_mex('model_free', id);
        rethrow(failure);
      end
    end

    function all = side(kind, dofs)
    % The three places of a side: t1, t2, n.
      all = [-1 -1 -1];
      switch lower(kind)
        case 'unilateral', places = 3;
        case 'friction_2d', places = [1 3];
        otherwise, places = 1:numel(dofs);
      end
      if isequal(dofs, -1), return, end
      if numel(dofs) == 3, places = 1:3; end
      if numel(dofs) ~= numel(places)
        error('hbvib:input', 'add_contact: %s has %d degrees of freedom on a side, needs %d', kind, numel(dofs), numel(places));
      end
      all(places) = dofs;
    end

    function value = member(prefix, value)
      if ischar(value), value = [prefix, value]; end
    end
  end
end
