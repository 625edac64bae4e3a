function solver = solver(given, ndof)
%SOLVER  Options of the solver as C has them: harmonics without tolerance are fixed, response_dof counts from 0.
  solver = given;
  if isfield(solver, 'harmonics') && ~isfield(solver, 'tolerance'), solver.tolerance = 0; end
  if isfield(solver, 'response_dof')
    solver.response_dof = hbvib.internal.zero('response_dof', solver.response_dof, ndof);
  end
  for name = {'flexibility', 'stability'}
    key = name{1};
    if isfield(solver, key) && ischar(solver.(key)), solver.(key) = [key, '_', solver.(key)]; end
  end
  if isempty(fieldnames(solver)), solver = []; end
end
