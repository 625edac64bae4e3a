using Test, Hbvib

model = Hbvib.Model(mass = [1.0;;], stiffness = [1.0;;], rayleigh = (0, 0.02))
@test Hbvib.add_contact!(model, :JENKINS, 1; kt = 1, mu = 0.3, preload = 1) == 1
Hbvib.add_force!(model, 1, 0.2)
branch = Hbvib.forced_response(model, (0.8, 1.6))
peak = Hbvib.peaks(branch)
@test isapprox(peak.omega[1], 1.23203; atol = 1e-5)
@test isapprox(abs(Hbvib.harmonics(branch, peak.point[1])[1, 2]), peak.amplitude[1]; rtol = 1e-6)
@test_throws Hbvib.Error Hbvib.add_force!(model, 2, 1.0)
