using Test, Hbvib

model = Hbvib.Model(mass = [1.0;;], stiffness = [1.0;;], rayleigh = (0, 0.02))
@test Hbvib.add_contact!(model, :JENKINS, 1; kt = 1, mu = 0.3, preload = 1) == 1
Hbvib.add_force!(model, 1, 0.2)
branch = Hbvib.forced_response(model, (0.8, 1.6))
peak = Hbvib.peaks(branch)
@test isapprox(peak.omega[1], 1.23202; atol = 1e-5)
@test isapprox(abs(Hbvib.harmonics(branch, peak.point[1])[1, 2]), peak.amplitude[1]; rtol = 1e-6)
@test_throws Hbvib.Error Hbvib.add_force!(model, 2, 1.0)

# Damping that falls with the amplitude: F = 0.05 a - 0.0375 a^3 + 0.0075 a^5 has the amplitude a at omega = 1 with one harmonic.
damper = [0, 0, -0.05, 0, 0.012]
model = Hbvib.Model(mass = [1.0;;], stiffness = [1.0;;], damping = [0.05;;])
Hbvib.check(Hbvib.hbvib_model_add_spring_damper(model.handle, 0, Hbvib.GROUND, 0, 0, C_NULL, length(damper), damper, Ref{Int64}()))
Hbvib.add_force!(model, 1, 0.015)
branch = Hbvib.forced_response(model, (0.9, 1.1); harmonics = 1, branches = 2)
child = only(Hbvib.children(branch))
origin = Hbvib.descent(child)
force(squared) = sqrt(squared) * (0.05 - 0.0375 * squared + 0.0075 * squared^2)
root = sqrt(0.1125^2 - 4 * 0.0375 * 0.05)
@test child.status == Hbvib.HBVIB_STOPPED_CLOSED && origin.mode == 1 && origin.bifurcation == -1
@test isapprox(0.015 * origin.born_at_force, force((0.1125 + root) / 0.075); atol = 1e-8)
@test isapprox(0.015 * origin.merges_at_force, force((0.1125 - root) / 0.075); atol = 1e-8)
@test Hbvib.searched(branch).modes == 1
@test isempty(Hbvib.children(Hbvib.forced_response(model, (0.9, 1.1); harmonics = 1)))
@test Hbvib.ndof(Hbvib.longer_period(model, 2)) == 1
@test_throws Hbvib.Error Hbvib.longer_period(model, 0)

# Localised modes of two masses on hardening springs, born at a modal amplitude of sqrt(8 c / 3); they outlive the name of their parent.
model = Hbvib.Model(mass = [1.0 0; 0 1], stiffness = [1.1 -0.1; -0.1 1.1])
foreach(dof -> Hbvib.add_contact!(model, :CUBIC, dof; cubic = 1), 1:2)
localised = let mode = Hbvib.nonlinear_mode(model, (-1, 0.5); mode = 2, harmonics = 1, branches = 1)
    place = Hbvib.bifurcations(mode)
    @test place.kind == [Hbvib.HBVIB_BIFURCATION_BRANCH_POINT]
    Hbvib.children(mode)
end
GC.gc()
@test length(localised) == 2 && Hbvib.descent(localised[1]).bifurcation == 1
x = Hbvib.harmonics(localised[2], Hbvib.hbvib_branch_points(localised[2].handle))
@test isapprox(real(x[1, 2] * x[2, 2]), -0.4 / 3; atol = 1e-8)
