function varargout = listed(name, inputs, hooks, arrays)
%LISTED  Arrays as long as the library says: a first call gets the count, a second one the numbers.
  more = {};
  if hooks, more = {[]}; end
  none = repmat({0}, 1, arrays);
  out = cell(1, arrays + 1);
  [out{:}] = hbvib_mex(name, inputs{:}, 0, none{:}, more{:});
  count = out{end};
  room = repmat({count}, 1, arrays);
  [out{:}] = hbvib_mex(name, inputs{:}, count, room{:}, more{:});
  varargout = out(1:arrays);
end
