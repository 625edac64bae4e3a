% The classes of MATLAB and Octave give the numbers of Python, to the bit; errors have identifiers; objects are freed.
% Usage: check(FILE), FILE as reference.py wrote it.
function check(file)
  wanted = jsondecode(fileread(file));

  r = wanted.readme;
  model = hbvib.Model('mass', 1, 'stiffness', 1, 'rayleigh', [0 0.02]);
  assert(model.add_contact('jenkins', 1, 'kt', 1, 'mu', 0.3, 'preload', 1) == 1);
  model.add_force(1, 0.2);
  branch = model.forced_response([0.8 1.6], 'at', [1.0 1.2]);
  same(branch.omega, r.omega);
  same(branch.amplitude, r.amplitude);
  peak = branch.peaks();
  same(peak.omega, r.peak);
  same(peak.point - 1, r.point);
  motion(branch.harmonics(peak.point), r.motion);
  same(branch.slip(peak.point), r.slip);
  same(branch.at(2).amplitude, r.at);
  same(branch.summary(peak.point, 1).work, r.work);
  same(branch.energy(peak.point).structural_loss, r.loss);
  same(model.verify(branch, peak.point).response_error, r.error);
  motion(model.time_response(1.0), r.time);
  [way, force] = branch.loop(peak.point, 1, 64);
  assert(numel(way) == 64 && abs(max(force) - 0.3) < 1e-12);
  reloaded = hbvib.Model.from_bytes(model.to_bytes());
  same(reloaded.forced_response([0.8 1.6], 'at', [1.0 1.2]).amplitude, r.amplitude);

  r = wanted.mode;
  M = diag([1 1 0.5]);
  K = sparse([2000 -1000 0; -1000 2000 -1000; 0 -1000 1000]);
  model = hbvib.Model('mass', M, 'stiffness', full(K), 'rayleigh', [0 2e-4]);
  model.add_contact('jenkins', 2, 'kt', 500, 'mu', 0.3, 'preload', 10);
  model.add_contact('jenkins', 3, 2, 'kt', 300, 'mu', 0.3, 'preload', 5);
  model.add_force(1, 2.0);
  mode = model.nonlinear_mode([-3 0], 'mode_index', 1);
  same(mode.omega, r.omega);
  same(mode.damping_ratio, r.damping);
  same(mode.log10_amplitude, r.log10_amplitude);
  same(mode.synthesis_peaks(model).omega, r.predicted);
  same(model.linear_modes(3, 'contacts', 'free'), r.free);
  model.set_matrix('stiffness', K);  % sparse
  near(model.linear_modes(3, 'contacts', 'free'), r.free);

  r = wanted.sector;
  K = [2 -1 0; -1 3 -1; 0 -1 1];
  sector = hbvib.Model.sector('stiffness', K, 'mass', diag([0.5 1 0.5]), 'sectors', 8, 'engine_order', 2, 'left', 1, ...
                              'right', 3, 'frame', 'cylindrical');
  sector.set_rayleigh(0, 0.01);
  sector.add_contact('jenkins', 2, 'kt', 0.5, 'mu', 0.3, 'preload', 1);
  sector.add_force(2, 0.1 + 0.05i);
  assert(sector.engine_order == 2 && sector.sectors == 8);
  response = sector.forced_response([0.8 2.2], 'response_dof', 2);
  same(response.omega, r.omega);
  same(response.amplitude, r.amplitude);
  same(sector.linear_modes(2, 'diameter', 2), r.modes);
  motion(response.harmonics(response.peaks().point(1)), r.motion);

  r = wanted.wheel;
  wheel = hbvib.Model.cyclic('sectors', 6, 'engine_order', 1, 'mass', eye(2), 'stiffness', [3 -1; -1 2], 'coupling', ...
                             struct('stiffness', [-0.5 0; 0 0]), 'rayleigh', [0 0.01]);
  wheel.add_contact('friction_2d', [1 2], 'kt', 1, 'kn', 2, 'mu', 0.3, 'preload', 0.2);
  wheel.add_force(1, 0.1);
  turned = wheel.forced_response([0.9 2.0], 'harmonics', 5);
  same(turned.omega, r.omega);
  same(turned.amplitude, r.amplitude);

  % Free sliders and their band.
  r = wanted.wedge;
  wedge = hbvib.Model('mass', diag([1 0.01 0.01]), 'damping', diag([0.04 0.004 0.004]), 'stiffness', diag([1 1e-3 1e-3]));
  wedge.add_contact('friction_2d', [2 3 -1], [-1 -1 -1], 'kt', 1, 'kn', 1.5, 'mu', 0.6, 'normal', [1 -1 0], 'tangent', [1 1 0]);
  wedge.add_contact('friction_2d', [2 3 -1], [1 -1 -1], 'kt', 1, 'kn', 1.5, 'mu', 0.15, 'normal', [-1 -1 0], 'tangent', [-1 1 0]);
  wedge.add_force(3, 1, 0);
  wedge.add_force(1, 0.02);
  sweep = wedge.forced_response([1.2 1.3], 'harmonics', 7);
  point = sweep.peaks().point(1);
  sliders = wedge.freedom(sweep, point);
  assert(numel(sliders.contact) > 0);
  same(sliders.contact - 1, r.contact);
  same(sliders.place, r.place);
  same(sliders.derivative, r.derivative);
  found = wedge.band(sweep, point);
  same([found.lower; found.upper], r.ends);
  same(found.lower_place, r.lower);
  assert(found.lower < found.upper && found.complete == 1);
  same(found.lower_branch.amplitude, r.low);
  wedge.set_slider(found.contact(1), found.lower_place(1), found.direction(1));
  throws(@() wedge.set_slider(3, 0), 'hbvib:E_INDEX', '');
  throws(@() wedge.band(sweep, point, 'off', 'amplitude'), 'hbvib:input', 'needs one of');

  % Children: a detached curve, and motions of the double period; they keep their parent and are freed by it.
  r = wanted.children;
  isolated = hbvib.Model('mass', 1, 'stiffness', 1, 'damping', 0.05);
  hbvib_mex('model_add_spring_damper', isolated.id, 0, -1, 0, 0, [], 5, [0 0 -0.05 0 0.012]);
  isolated.add_force(1, 0.015);
  sweep = isolated.forced_response([0.9 1.1], 'harmonics', 3, 'branches', 2);
  child = sweep.children{1};
  assert(numel(sweep.children) == 1 && isempty(child.children));
  assert(child.status == 12 && strcmp(child.message, 'HBVIB_STOPPED_CLOSED'));
  assert(child.descent.kind == -1 && child.descent.bifurcation == -1 && child.descent.mode == 1 && sweep.descent.mode == -1);
  same([child.descent.born_at_force; child.descent.merges_at_force], r.forces);
  same(sweep.searched.modes, r.modes);
  clear sweep
  same(child.omega, r.omega);
  same(child.amplitude, r.amplitude);
  assert(isempty(isolated.forced_response([0.9 1.1], 'harmonics', 3).children));
  stop = hbvib.Model('mass', 1, 'stiffness', 1, 'damping', 0.05);
  stop.add_contact('unilateral', 1, 'kn', 10);
  stop.add_force(1, 1);
  above = stop.forced_response([2.3 2.5], 'harmonics', 10, 'branches', 1, 'at', 2.38);
  doubled = above.children{1};
  found = above.bifurcations();
  same(found.omega, r.bifurcations);
  same(found.point - 1, r.points);
  same(found.unstable_before, r.before);
  assert(doubled.descent.periods == 2 && doubled.descent.bifurcation == 1 && doubled.descent.kind == 1 && found.kind(1) == 1);
  same(doubled.omega, r.doubled);
  point = doubled.at(1).point;
  motion(doubled.harmonics(point), r.motion);
  same(stop.longer_period(2).verify(doubled, point).response_error, r.error);
  throws(@() stop.longer_period(0), 'hbvib:E_ARGUMENT', 'periods = 0');
  other = above.children{1};
  other.free();
  same(doubled.omega, r.doubled);
  above.free();
  throws(@() doubled.omega, 'hbvib:E_HANDLE', '');

  % Laws of the caller: numbers of Python, derivatives, errors that come out as they are, models and branches that outlive the handle.
  r = wanted.own;
  own = hbvib.Model('mass', eye(2), 'stiffness', [2 -1; -1 2], 'rayleigh', [0 0.02]);
  number = own.add_user_force(1, @(call) struct('f', 0.5 * call.v .* abs(call.v), 'df_dv', abs(call.v)), 'uses_velocity', 1, 'is_odd', 1);
  assert(number == 1);
  number = own.add_user_force([1 2], @cubic_between, 'is_odd', 1);
  own.add_force(1, 0.2);
  assert(own.check_jacobian(number, 1, [0.3 0.2]).gap < 1e-6);
  solved = own.forced_response([0.8 1.2], 'harmonics', 5);
  near(solved.omega, r.omega);
  near(solved.amplitude, r.amplitude);
  own.free();
  near(solved.summary(solved.peaks().point(1), 1).work, r.work);
  own = hbvib.Model('mass', 1, 'stiffness', 1, 'damping', 0.1);
  own.add_force(1, 0.2);
  wrong = own.clone();
  wrong.add_user_force(1, @(call) struct('f', 2 * call.u, 'df_du', ones(size(call.u))));
  assert(wrong.check_jacobian(1, 1, 0.3).gap > 0.1);
  failing = own.clone();
  failing.add_user_force(1, @(call) error('user:law', 'of the law'));
  throws(@() failing.forced_response([0.8 1.2]), 'user:law', 'of the law');
  bad = own.clone();
  bad.add_user_force(1, @(call) struct('f', [1 2 3]));
  throws(@() bad.forced_response([0.8 1.2]), 'hbvib:input', 'f has another shape');
  refusing = own.clone();
  refusing.add_user_force(1, @(call) []);
  throws(@() refusing.forced_response([0.8 1.2]), 'hbvib:E_CALLBACK', '');
  nested = own.clone();
  nested.add_user_force(1, @(call) calls_the_library(call, own));
  throws(@() nested.forced_response([0.8 1.2]), 'user:nested', 'after a call within');
  throws(@() own.add_user_force(2, @(call) []), 'hbvib:E_INDEX', '');
  throws(@() own.add_user_force(1, 'f'), 'hbvib:input', 'function handle');
  throws(@() own.add_user_force(1, @(call) [], 'odd', 1), 'hbvib:input', 'needs dofs');

  % Errors: identifier and sentence, with indices from 1; an error of a callback comes out as it is.
  throws(@() model.add_force(4, 1), 'hbvib:E_INDEX', 'dof = 4, needs 1 .. 3');
  throws(@() model.add_force(0, 1), 'hbvib:E_INDEX', 'dof = 0, needs 1 .. 3');
  throws(@() model.forced_response([1 NaN]), 'hbvib:E_NOT_FINITE', 'omega_stop');
  throws(@() model.forced_response([1 2], 'tolerances', 1), 'hbvib:input', 'needs one of');
  throws(@() hbvib.Model('mass', [1 2; 3 4]), 'hbvib:E_NOT_HERMITIAN', '');
  throws(@() hbvib_mex('model_new'), 'hbvib:input', 'has 0 inputs, needs 1');
  throws(@() hbvib_mex('no_such'), 'hbvib:input', 'there is no function');
  throws(@() hbvib_mex('model_dofs', uint64(77)), 'hbvib:E_HANDLE', '');
  throws(@() model.forced_response([5 70], 'progress', @(state) error('user:own', 'of the user')), 'user:own', 'of the user');

  % A callback that returns false stops and keeps the points; freed objects are refused.
  stopped = model.forced_response([5 70], 'progress', @(state) state.point < 5);
  assert(stopped.status == 1 && numel(stopped.omega) > 2 && numel(stopped.omega) < 10);
  id = stopped.id;
  clear stopped
  throws(@() hbvib_mex('branch_points', id), 'hbvib:E_HANDLE', '');
  copy = model.clone();
  model.free();
  assert(copy.contacts == 2);
  throws(@() model.linear_modes(1), 'hbvib:E_HANDLE', '');
  disp('check passed');
end

% A cubic spring between two degrees of freedom.
function result = cubic_between(call)
  d = call.u(1, :) - call.u(2, :);
  result.f = [d .^ 3; -d .^ 3];
  slope = reshape(3 * d .^ 2, 1, 1, []);
  result.df_du = [slope, -slope; -slope, slope];
end

% A law that solves a linear model, catches an error of the library, and then fails.
function result = calls_the_library(~, model)
  model.linear_modes(1);
  try
    model.add_force(9, 1);
  catch
  end
  error('user:nested', 'after a call within');
end

% Numbers from the hexadecimal digits of their bits.
function numbers = of_bits(text)
  if ~iscell(text), text = {text}; end
  numbers = hex2num(char(text));
end

function same(have, want)
  want = of_bits(want);
  assert(isequal(size(have(:)), size(want(:))), 'sizes differ');
  assert(all(have(:) == want(:)), 'numbers differ by %g', max(abs(have(:) - want(:))));
end

function near(have, want)
  want = of_bits(want);
  assert(max(abs(have(:) - want(:))) <= 1e-12 * max(abs(want(:))));
end

% pairs: real and imaginary parts, harmonic after harmonic.
function motion(have, pairs)
  same(real(have), pairs{1});
  same(imag(have), pairs{2});
end

function throws(action, id, part)
  try
    action();
  catch failure
    assert(strcmp(failure.identifier, id), 'identifier %s: %s', failure.identifier, failure.message);
    assert(isempty(part) || ~isempty(strfind(failure.message, part)), '%s', failure.message);
    return
  end
  error('check:none', 'no error %s', id);
end
