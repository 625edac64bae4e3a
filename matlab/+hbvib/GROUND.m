function dof = GROUND()
%GROUND  The degree of freedom of the ground, which does not move.
  dof = -1;
end
