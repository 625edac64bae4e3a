function data = fit_data(given, ndof)
%FIT_DATA  Structs of data as those of C: complex numbers as pairs, degrees of freedom from 0.
  data = struct('kind', cell(1, numel(given)), 'force_factor', 1, 'mode', 0, 'omega_start', 0, 'omega_stop', 0, 'n', 0, 'x', [], ...
                'value', [], 'sigma', [], 'second_sigma', [], 'response', []);
  for k = 1:numel(given)
    one = given(k);
    data(k).kind = 'data_response';
    names = fieldnames(one);
    for i = 1:numel(names)
      value = one.(names{i});
      if isempty(value), continue, end
      switch names{i}
        case 'kind', data(k).kind = ['data_', value];
        case 'force', data(k).force_factor = value;
        case 'mode', data(k).mode = value - 1;
        case 'omega', [data(k).omega_start, data(k).omega_stop] = deal(value(1), value(2));
        case 'x', [data(k).x, data(k).n] = deal(value(:), numel(value));
        case 'value', data(k).value = reshape([real(value(:)) imag(value(:))].', [], 1);
        case 'sigma', data(k).sigma = value(:) + zeros(numel(one.x), 1);
        case 'second_sigma', data(k).second_sigma = value(:) + zeros(numel(one.x), 1);
        case 'dof', data(k).response = struct('n', 1, 'dofs', hbvib.internal.zero('dof', value, ndof));
        case 'response', data(k).response = value;
        otherwise
          error('hbvib:input', ['data %d: there is no field ''%s'', needs kind, x, value, sigma, second_sigma, force, dof, response, ', ...
                                'mode or omega'], k, names{i});
      end
    end
  end
end
