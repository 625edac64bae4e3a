function index = zero(name, index, count)
%ZERO  Indices from 1 as those from 0; -1 stays. An error names the index and the range from 1 to count.
  for k = 1:numel(index)
    if index(k) ~= -1
      index(k) = hbvib_mex('index_from_one', name, index(k), count);
    end
  end
end
