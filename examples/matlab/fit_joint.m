% Stiffness and friction of a joint from measured responses, in MATLAB and Octave: complex amplitudes of a chain of two masses under
% three forces, of which the first mass rubs on the ground. Prints the parameters with their standard deviations, the resonance
% predicted at another force, and the interval of the friction limit by the profile of the likelihood.
%
%   run('matlab/hbvib_install.m'); addpath('examples/matlab'); fit_joint('examples/data/joint.csv')
function fit_joint(path)
  rows = dlmread(path, ',', 1, 0);
  model = hbvib.Model('mass', diag([1 0.5]), 'stiffness', [1.5 -0.5; -0.5 0.5], 'rayleigh', [0 0.01]);
  model.add_contact('jenkins', 1, 'kt', 0.5, 'mu', 0.08, 'preload', 1);  % guesses
  model.add_force(2, 1);
  data = struct('x', {}, 'value', {}, 'sigma', {}, 'force', {}, 'dof', {});
  for force = unique(rows(:, 1))'
    at = rows(rows(:, 1) == force, :);
    data(end + 1) = struct('x', at(:, 2), 'value', complex(at(:, 3), at(:, 4)), 'sigma', at(:, 5), 'force', force, 'dof', 2);
  end
  unknowns = {struct('kind', 'kt', 'contact', 1), struct('kind', 'mu', 'contact', 1), ...
              struct('kind', 'damping', 'scaling', 'factor', 'start', 2), struct('kind', 'stiffness', 'scaling', 'factor')};
  fit = model.fit(unknowns, data, 'harmonics', 9);
  names = {'kt', 'friction limit', 'damping factor', 'stiffness factor'};
  for k = 1:4
    fprintf('%-16s  %19.12E  +- %16.9E\n', names{k}, fit.theta(k), fit.sd(k));
  end
  fprintf('%-16s  %19.12E  on %d\n', 'chi2', fit.chi2, fit.degrees_of_freedom);
  [peak, deviation] = model.predict(fit, struct('kind', 'peak', 'x', 0.72, 'force', 0.1, 'dof', 2, 'omega', [0.6 0.9]));
  fprintf('%-16s  %19.12E  +- %16.9E\n', 'peak at 0.1', peak(1), deviation(1));
  interval = model.fit_profile(fit, 2, fit.theta(2) + linspace(-3, 3, 9) * fit.sd(2), 3.841);
  fprintf('%-16s  %16.9E .. %16.9E\n', '95 % of friction', interval.lower, interval.upper);
end
