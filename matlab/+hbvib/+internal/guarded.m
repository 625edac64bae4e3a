function out = guarded(progress, state)
%GUARDED  A function `progress` that may fail: its error stops the solve and is thrown, whole, after it.
%   guarded(progress) is the function to call, [] for []; guarded(progress, state) calls it; guarded() throws what it threw.
  persistent failure
  if nargin == 0
    thrown = failure;
    failure = [];
    if ~isempty(thrown), rethrow(thrown); end
  elseif nargin == 1
    failure = [];
    out = [];
    if ~isempty(progress), out = @(state) hbvib.internal.guarded(progress, state); end
  else
    try
      out = progress(state);
    catch thrown
      failure = thrown;
      out = false;
    end
  end
end
