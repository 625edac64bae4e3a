function description = matrix(value, part)
%MATRIX  Description of a full or sparse matrix for the gateway.
  description = struct('rows', size(value, 1), 'cols', size(value, 2), 'scalar', double(~isreal(value)), 'part', part);
  if issparse(value)
    [row, column, numbers] = find(value);
    ends = cumsum(accumarray(column(:), 1, [size(value, 2), 1]));
    description.storage = 'csc';
    description.col_ptr = [0; ends(:)];
    description.row_idx = row(:) - 1;
  else
    numbers = double(value(:));
    description.storage = 'col_major';
  end
  if isreal(value)
    description.values = full(numbers(:));
  else
    pairs = [real(numbers(:)), imag(numbers(:))].';
    description.values = pairs(:);
  end
end
