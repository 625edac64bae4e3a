function [parameters, unknowns] = fit_unknowns(given, contacts)
%FIT_UNKNOWNS  A cell array of structs as the parameters and the unknowns of C: numbers count from 0, bounds have flags.
  if isstruct(given), given = num2cell(given); end
  parameters = struct('kind', cell(1, numel(given)), 'contact', -1, 'scaling', 0);
  unknowns = struct('start', cell(1, numel(given)), 'has_start', 0, 'lower', 0, 'has_lower', 0, 'upper', 0, 'has_upper', 0, ...
                    'prior_mean', 0, 'prior_sigma', 0, 'scale', 'scale_automatic', 'tied_to', -1, 'data_set', -1);
  for k = 1:numel(given)
    unknowns(k).start = 0;
    one = given{k};
    names = fieldnames(one);
    for i = 1:numel(names)
      value = one.(names{i});
      switch names{i}
        case 'kind', parameters(k).kind = ['parameter_', value];
        case 'contact', parameters(k).contact = hbvib.internal.zero('contact', value, contacts);
        case 'scaling', parameters(k).scaling = ['scaling_', value];
        case {'start', 'lower', 'upper'}
          unknowns(k).(names{i}) = value;
          unknowns(k).(['has_', names{i}]) = 1;
        case 'prior'
          unknowns(k).prior_mean = value(1);
          unknowns(k).prior_sigma = value(2);
        case 'scale', unknowns(k).scale = ['scale_', value];
        case {'tied_to', 'data_set'}, unknowns(k).(names{i}) = value - 1;
        otherwise
          error('hbvib:input', 'unknown %d: there is no field ''%s'', needs kind, contact, scaling, start, lower, upper, prior, scale, tied_to or data_set', ...
                k, names{i});
      end
    end
  end
end
