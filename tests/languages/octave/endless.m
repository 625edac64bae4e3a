% A solve that takes minutes, for tests/octave.sh to stop by Ctrl-C.
n = 60;
K = spdiags([-ones(n, 1), 2.05 * ones(n, 1), -ones(n, 1)], -1:1, n, n);
model = hbvib.Model('mass', speye(n), 'stiffness', K, 'rayleigh', [0 0.001]);
for i = 1:n, model.add_contact('jenkins', i, 'kt', 1, 'mu', 0.3, 'preload', 0.1 + 0.001 * i); end
model.add_force(1, 1);
disp('solving');
fflush(stdout);
for k = 1:100, model.forced_response([0.1 3], 'harmonics', 41, 'samples', 4096); end
disp('not stopped');
