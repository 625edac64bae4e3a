function [own, rest] = options(caller, given, defaults, open)
%OPTIONS  Options 'name', value, ... as a struct: those of `defaults`, and in `rest` all others where `open` is true.
  own = defaults;
  rest = struct();
  if numel(given) == 1 && isstruct(given{1})
    names = fieldnames(given{1});
    values = struct2cell(given{1});
  else
    if mod(numel(given), 2) ~= 0
      error('hbvib:input', '%s: options are pairs of a name and a value', caller);
    end
    names = given(1:2:end);
    values = given(2:2:end);
  end
  for k = 1:numel(names)
    name = char(names{k});
    if isfield(defaults, name)
      own.(name) = values{k};
    elseif open
      rest.(name) = values{k};
    else
      error('hbvib:input', '%s: there is no option ''%s'', needs one of %s', caller, name, ...
            strjoin(fieldnames(defaults)', ', '));
    end
  end
end
