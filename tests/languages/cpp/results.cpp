/* Every kind of result, against closed forms or against each other. */
#include "common.hpp"

#include <algorithm>

namespace {

// Two equal masses in a chain of three equal springs: omega^2 = 1 and 3, shapes (1, 1) and (1, -1) / sqrt 2.
void linear_modes() {
  const double m[2][2] = {{1, 0}, {0, 1}}, k[2][2] = {{2, -1}, {-1, 2}};
  auto model = Model::plain(2);
  claim(model.dofs() == 2 && model.sectors() == 1 && model.contacts() == 0, "the size of a plain model");
  model.set_matrix(HBVIB_MASS, m);
  model.set_matrix(HBVIB_STIFFNESS, k);
  const auto modes = model.linear_modes(0, HBVIB_CONTACTS_FREE, 2);
  near(modes.omega[0], 1, 1e-14, "the first frequency of the chain");
  near(modes.omega[1], std::sqrt(3.0), 1e-14, "the second frequency of the chain");
  for (Index i = 0; i < 2; i++) {
    near(std::abs(modes.shapes(i, 0)), std::sqrt(0.5), 1e-14, "a shape of unit mass");
    near((modes.shapes(i, 1) / modes.shapes(i, 0)).real(), i == 0 ? 1 : -1, 1e-13, "its symmetry");
  }

  // Springs added by the model, and contacts that stick, are stiffness.
  auto bare = Model::plain(2);
  bare.set_matrix(HBVIB_MASS, m);
  const double zero[2][2] = {};
  bare.set_matrix(HBVIB_STIFFNESS, zero);
  bare.add_springs({0, 0, 1}, {HBVIB_GROUND, 1, HBVIB_GROUND}, {}, {1.0, 1.0, 1.0});
  near(bare.linear_modes(0, HBVIB_CONTACTS_FREE, 2).omega[1], std::sqrt(3.0), 1e-13, "a chain of added springs");
  claim(bare.add_jenkins({0, 1}, {HBVIB_GROUND, HBVIB_GROUND}, {}, {1.0, 1.0}, {0.3, 0.3}, {1.0, 1.0}) == 0 && bare.contacts() == 2,
        "contacts are numbered from 0");
  near(bare.linear_modes(0, HBVIB_CONTACTS_STUCK, 1).omega[0], std::sqrt(2.0), 1e-13, "stuck contacts are springs");

  // A ring of N equal masses on springs k0, coupled by k: omega^2 = k0 + 2 k (1 - cos(2 pi d / N)).
  const double one[1][1] = {{1}}, own[1][1] = {{0.5 + 2 * 3}}, next[1][1] = {{-3}};
  auto ring = Model::cyclic(1, 10), waves = Model::cyclic(1, 10), lagged = Model::cyclic(1, 10);
  claim(ring.dofs() == 1 && ring.sectors() == 10, "the size of a cyclic model");
  for (auto* a : {&ring, &lagged}) {
    a->set_matrix(HBVIB_MASS, one);
    a->set_matrix(HBVIB_STIFFNESS, own);
    a->set_coupling(HBVIB_STIFFNESS, next);
  }
  // The same ring from two halves of a mass on the faces of a sector, the third degree of freedom fixed.
  const double halves[3][3] = {{0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 1}};
  const double springs[3][3] = {{3.25, -3, -0.25}, {-3, 3.25, -0.25}, {-0.25, -0.25, 0.5}};
  const std::vector<Index> left{0}, right{1}, still{2};
  auto faces = Model::sector(hbvib::Sector(3, 10, 1).faces(left, right, 1).cylindrical().about({0, 0, 2}));
  faces.set_matrix(HBVIB_MASS, halves);
  faces.set_matrix(HBVIB_STIFFNESS, springs);
  faces.fix(still);
  lagged.set_coupling_previous(HBVIB_STIFFNESS, next);
  // Aerodynamic forces of a symmetric influence change the stiffness of each wave; natural modes leave them out.
  auto blown = Model::cyclic(1, 10);
  blown.set_matrix(HBVIB_MASS, one);
  blown.set_matrix(HBVIB_STIFFNESS, own);
  const std::vector<Complex> influence{{-0.5, 0}, {0.1, 0}, {0.1, 0}};
  const std::vector<Index> offsets{0, 1, -1}, blade{0};
  blown.set_aero(blade, influence, offsets, HBVIB_AERO_DISPLACEMENT);
  const auto entries = blown.aero(HBVIB_AERO_DISPLACEMENT);
  claim(entries.size() == 3 && entries[2].offset == -1 && entries[1].coefficient == influence[1], "influence is read back");
  claim(blown.aero(HBVIB_AERO_VELOCITY).empty(), "the other form is not set");
  blown.set_wave(3);
  claim(blown.forced_response(SolverOptions{}, {1.0, 1.0}).status() == HBVIB_STOPPED_NO_FORCE, "flutter is no forced response");
  blown.add_force(0, 1, 1);
  SolverOptions single;
  single.tolerance = 0, single.harmonics = 1;
  const auto x = blown.forced_response(single, {1.0, 1.0}).harmonics(0);
  near(x(1, 0).real(), 1 / (6.5 - 1 + 0.5 - 0.2 * std::cos(2 * PI * 3 / 10)), 1e-12, "the response with influence");
  near(blown.linear_modes(3, HBVIB_CONTACTS_FREE, 1).omega[0], std::sqrt(6.5), 1e-13, "the natural mode without");
  refused("coefficients of another size", HBVIB_E_DIMENSION, 5, "needs offsets", [&] { blown.set_aero(blade, influence, blade, HBVIB_AERO_DISPLACEMENT); });
  for (Index d = 0; d <= 5; d++) {
    const double square = 0.5 + 6 * (1 - std::cos(2 * PI * static_cast<double>(d) / 10)), wave[1][1] = {{square}};
    waves.set_diameter(HBVIB_MASS, d, one);
    waves.set_diameter(HBVIB_STIFFNESS, d, wave);
    near(ring.linear_modes(d, HBVIB_CONTACTS_FREE, 1).omega[0], std::sqrt(square), 1e-13, "a wave of the ring");
    near(faces.linear_modes(d, HBVIB_CONTACTS_FREE, 1).omega[0], std::sqrt(square), 1e-13, "the same from its faces");
    near(lagged.linear_modes(d, HBVIB_CONTACTS_FREE, 1).omega[0], std::sqrt(square), 1e-13, "the same, both neighbours given");
    near(waves.linear_modes(d, HBVIB_CONTACTS_FREE, 1).omega[0], std::sqrt(square), 1e-13, "the same, wave by wave");
  }
}

// Jenkins' loop of amplitude A beyond the slip: work 4 limit (A - limit / kt), in time and in harmonics.
void friction() {
  const double kt = 1, mu = 0.3, preload = 1, limit = mu * preload, load = 0.4;
  auto model = oscillator(1, 0.02, 1, load);
  model.add_contact(Contact::jenkins(0, HBVIB_GROUND, kt, mu, preload));
  SolverOptions solver;
  solver.tolerance = 0, solver.harmonics = 31;
  const auto branch = model.forced_response(solver, {0.8, 1.6});
  const auto peak = branch.highest_peak();
  const auto x = branch.harmonics(peak.point);
  const auto loop = branch.contact_loop(peak.point, 0, 0, 4096);
  const auto summary = branch.contact_summary(peak.point, 0);
  const auto energy = branch.energy(peak.point);
  const auto time = branch.time_history(peak.point, 0, 4096);
  for (std::size_t j = 0; j < 4096; j += 64) near(loop.motion[j] + 1, time[j] + 1, 1e-12, "the loop's motion is that of the mass");
  double largest = 0, work = 0, slipping = 0;
  for (std::size_t j = 0; j < 4096; j++) {
    const std::size_t next = (j + 1) % 4096;
    largest = std::max(largest, std::fabs(loop.force[j]));
    work += 0.5 * (loop.force[j] + loop.force[next]) * (loop.motion[next] - loop.motion[j]);
    slipping += loop.state[j] == HBVIB_STATE_SLIP;
  }
  near(largest, limit, 1e-12, "the force is at most mu N");
  near(summary.work, 4 * limit * (summary.half_range - limit / kt), 1e-12, "the loop's area in closed form");
  near(work, summary.work, 1e-5, "the area of the loop drawn");
  near(slipping / 4096, summary.slip_share, 1e-2, "the share of slip");
  near(summary.slip_share, branch.slip_fraction(peak.point).at(0), 1e-12, "the share of slip of the point");
  near(energy.friction_loss, summary.work, 1e-12, "the loss by friction is the contact's work");
  near(-PI * load * x(1, 0).imag(), energy.friction_loss + energy.structural_loss, 1e-9, "the force's work is what is lost");
  double damped = 0, kinetic = 0;
  for (Index h = 1; h <= 31; h++) {
    const double hh = static_cast<double>(h * h), size = std::norm(x(h, 0));
    damped += PI * 0.02 * peak.omega * hh * size;
    kinetic += hh * peak.omega * peak.omega * size / 2;
  }
  near(energy.structural_loss, damped, 1e-12, "the damper's loss");
  near(energy.twice_mean_kinetic, kinetic, 1e-12, "the kinetic energy");
  const auto reduction = branch.reduction();
  claim(reduction.harmonics_asked == 31 && reduction.contacts == 1 && reduction.degrees_of_freedom == 1 && reduction.even_removed == 1,
        "what was removed");

  // The same in time, from rest and from the point; with its samples.
  hbvib::TimeOptions o(peak.omega);
  o.samples = 64;
  const auto truth = model.time_response(o);
  claim(truth.status == HBVIB_OK && truth.harmonics.shape(0) == 10 && truth.samples.shape(0) == 64, "the shape of a response in time");
  near(std::abs(truth.harmonics(1, 0)), peak.amplitude, 1e-4, "the response in time is that of harmonic balance");
  near(truth.info.period, 2 * PI / peak.omega, 1e-14, "its period");
  double sum = 0;
  for (Index j = 0; j < 64; j++) sum += truth.samples(j, 0) * std::cos(2 * PI * static_cast<double>(j) / 64) / 32;
  near(sum, truth.harmonics(1, 0).real(), 1e-3, "its samples have its fundamental");
  const std::vector<Complex> start(x.data(), x.data() + x.size());
  const auto again = model.time_response(o.start_from(start));
  near(std::abs(again.harmonics(1, 0)), std::abs(truth.harmonics(1, 0)), 1e-9, "from the point it is the same");
  claim(again.info.periods <= truth.info.periods, "and no later");
  const auto checked = model.verify(branch, peak.point);
  claim(checked.status == HBVIB_OK && checked.info.same_solution == 1 && checked.harmonics.shape(0) == 32, "the point is checked in time");
  near(std::abs(checked.response() - truth.harmonics(1, 0)) + 1, 1, 1e-9, "the check finds the motion in time");
  const double off = std::abs(x(1, 0) - truth.harmonics(1, 0)) / std::abs(truth.harmonics(1, 0));
  near(checked.info.response_error, off, 1e-3, "its error is the distance of both");
  double squares = 0;
  for (const double e : checked.errors) squares += e * e;
  near(std::sqrt(squares), checked.info.motion_error, 1e-12, "the harmonics make up the error");

  // Its stability.
  const auto stability = model.floquet(branch, peak.point);
  claim(stability.status == HBVIB_OK && stability.multipliers.size() == 3 && stability.classes.size() == 3, "the number of multipliers");
  claim(stability.info.radius < 1 && stability.info.unstable == 0 && stability.classes[2] == HBVIB_MULTIPLIER_MEMORY, "the point is stable");
  claim(branch.limit_cycles().empty(), "a forced response has no limit cycles");
  claim(branch.bifurcations().size() == branch.folds().size(), "without the option stability only folds are known");
  near(stability.info.radius, std::abs(stability.multipliers[0]), 1e-15, "the radius is that of the largest");

  // Derivatives by parameters: force and normal load together scale the motion.
  const double unit[1][1] = {{1}};
  const std::vector<hbvib::Parameter> parameters = {hbvib::Parameter(HBVIB_PARAMETER_FORCE), hbvib::Parameter(HBVIB_PARAMETER_PRELOAD, 0),
      hbvib::Parameter(HBVIB_PARAMETER_STIFFNESS, hbvib::Matrix(unit)), hbvib::Parameter::factor(HBVIB_PARAMETER_STIFFNESS)};
  const auto found = model.sensitivity(branch, peak.point, parameters, HBVIB_OF_PEAK_AMPLITUDE);
  near(found.derivatives.at(0) + preload * found.derivatives.at(1), peak.amplitude, 1e-8, "the motion scales");
  near(found.derivatives.at(2), found.derivatives.at(3), 1e-14, "a stiffness of 1");
  claim(found.reasons.at(3) == HBVIB_DERIVATIVE_EXISTS && found.onset == -1, "all derivatives exist");

  // The complex amplitude, and a fit to its values.
  const auto whole = model.response_sensitivity(branch, peak.point, parameters, 0);
  near(std::abs(whole.value), peak.amplitude, 1e-9, "the complex amplitude");
  claim(std::abs(whole.derivatives.at(0) + preload * whole.derivatives.at(1) - whole.value) < 1e-8, "the complex motion scales");
  const std::vector<double> at = {peak.omega}, deviation = {1e-3};
  const std::vector<Complex> seen = {whole.value};
  const auto fitted = model.fit(solver, {parameters[1]}, {}, {hbvib::DataSet(at, seen, deviation)});
  near(fitted.theta.at(0), preload, 1e-5 * preload, "a fit to the model itself");
  claim(fitted.info.data == 2 && fitted.covariance.at(0) > 0 && fitted.residuals.size() == 2, "numbers of a fit");
  const double sd = std::sqrt(fitted.covariance.at(0));
  const std::vector<double> scan = {fitted.theta.at(0) - 2 * sd, fitted.theta.at(0), fitted.theta.at(0) + 2 * sd};
  const auto profile = model.fit_profile(solver, {parameters[1]}, {}, {hbvib::DataSet(at, seen, deviation)}, fitted.theta, 0, scan, 1);
  near(profile.loss.at(0), 4, 0.2, "two deviations below");
  near((profile.info.upper - profile.info.lower) / (2 * sd), 1, 0.05, "the interval of a profile");
  claim(profile.theta == scan && !profile.stopped && profile.info.found == 3, "nothing is free at a value");
  hbvib::DataSet wanted;
  wanted.n = 1, wanted.x = at.data();
  const auto predicted = model.predict(solver, wanted, {parameters[1]}, fitted.theta, fitted.covariance);
  near(predicted.values.at(0), seen[0].real(), 1e-6 * std::abs(seen[0]), "the value that was fitted");
  claim(predicted.sigma.size() == 2 && predicted.shift.size() == 2 && predicted.sigma.at(0) > 0, "with its deviation");

  // The peak over the normal load.
  const auto study = model.parameter_response(
      solver, hbvib::ParameterOptions(hbvib::Parameter(HBVIB_PARAMETER_PRELOAD, 0), 1, 2, peak.omega, HBVIB_FOLLOW_PEAK));
  near(study.field(HBVIB_AMPLITUDE)(0), peak.amplitude, 1e-8, "a study begins at the peak");
  near(study.field(HBVIB_PARAMETER_VALUE)(study.points() - 1), 2, 1e-15, "and ends with its range");
  near(study.field(HBVIB_D_AMPLITUDE)(0), found.derivatives.at(1), 1e-6, "its slope is the derivative");
  claim(branch.optima().empty() && branch.turns().empty() && branch.higher_peaks().empty(), "a forced response has no optima");
  claim(study.higher_peaks().empty(), "one peak is the highest");

  // The law alone, on the motion of the point.
  std::vector<Complex> motion(x.data(), x.data() + x.size());
  const auto force = hbvib::contact_evaluate(Contact::jenkins(0, HBVIB_GROUND, kt, mu, preload), 31, 0, peak.omega, motion, true);
  Complex fundamental = 0;
  for (std::size_t j = 0; j < 4096; j++) fundamental += loop.force[j] * std::polar(1.0 / 2048, -2 * PI * static_cast<double>(j) / 4096);
  near(std::abs(force.force[1] - fundamental) + 1, 1, 1e-4, "the law's fundamental is the loop's");
  claim(force.jacobian.shape(0) == 64 && force.jacobian.shape(1) == 64, "the order of the law's Jacobian");
  const double eps = 1e-6;
  motion[1] += eps;
  const auto moved = hbvib::contact_evaluate(Contact::jenkins(0, HBVIB_GROUND, kt, mu, preload), 31, 0, peak.omega, motion);
  near((moved.force[1].imag() - force.force[1].imag()) / eps, force.jacobian(3, 2), 1e-3, "a column of it is a difference");
  std::vector<Complex> plane(64);
  std::copy(x.data(), x.data() + x.size(), plane.begin());
  const Contact::Dofs side = {0, 1, HBVIB_GROUND}, ground = {HBVIB_GROUND, HBVIB_GROUND, HBVIB_GROUND};
  const auto friction = Contact::friction(HBVIB_FRICTION_3D, side, ground, kt, 0, mu, preload);
  const auto along = hbvib::contact_evaluate(friction, 31, 4096, peak.omega, plane);
  near(std::abs(along.force[1] - force.force[1]) + 1, 1, 1e-4, "friction in a plane, moved along a line, is the same law");
  claim(std::abs(along.force[33]) < 1e-12, "and has no force across it");
  claim(moved.jacobian.empty(), "without derivatives there is no Jacobian");
}

// Contacts written in several ways are the same contacts.
void equal_contacts() {
  auto peak = [](auto&& add) {
    auto model = oscillator(1, 0.05, 1, 0.2);
    add(model);
    return model.forced_response({}, {0.7, 2.2}).highest_peak();
  };
  auto same = [&](auto&& one, auto&& other, double tolerance, const char* what) {
    const auto a = peak(one), b = peak(other);
    near(a.omega, b.omega, tolerance, what);
    near(a.amplitude, b.amplitude, tolerance, what);
  };
  const auto cubic = [](Model& m) { m.add_contact(Contact::cubic_spring(0, HBVIB_GROUND, 0.3, 0.7)); };
  same([](Model& m) { m.add_spring_damper(0, HBVIB_GROUND, 0, {0.3, 0, 0.7}); }, cubic, 1e-9, "a polynomial is the cubic spring");
  same([](Model& m) { m.add_polynomial({0}, {0, 0}, {0.3, 0.7}, {1, 3}); }, cubic, 1e-9, "terms are the cubic spring");
  same([](Model& m) { m.add_springs({0}, {HBVIB_GROUND}, {}, {0.3}), m.add_stiffness_tensors({0}, {}, {0.7}); }, cubic, 1e-9, "tensors are the cubic spring");
  const auto stop = [](Model& m) { m.add_contact(Contact::unilateral(0, HBVIB_GROUND, 0.5, 0.2)); };
  same([](Model& m) { m.add_table(0, HBVIB_GROUND, 0, {-1.2, -0.2, 1}, {-0.5, 0, 0}); }, stop, 1e-7, "a table is the one-sided spring");
  const auto jenkins = [](Model& m) { m.add_contact(Contact::jenkins(0, HBVIB_GROUND, 0.8, 0.3, 0.5)); };
  same([](Model& m) { m.set_preload(m.add_jenkins({0}, {HBVIB_GROUND}, {}, {0.8}, {0.3}, {9.0}), 0.5); }, jenkins, 1e-12, "arrays of friction, its load set later");
  same([](Model& m) { m.add_patch(Contact::jenkins(0, 0, 0.4, 0.3, 0.25), {0, HBVIB_GROUND, HBVIB_GROUND}, {}, {0.0, 0.0, 2.0}, {3.0, 0.0, 0.0}, {2.0}); },
       jenkins, 1e-9, "a patch of one pair");
  same([](Model& m) { m.add_iwan(0, HBVIB_GROUND, 0, 0.15, 0.8, -0.5, 1e9, 50); }, jenkins, 1e-3, "an Iwan joint that slips all at once");
  same([](Model& m) { m.add_contact(Contact::regularised(0, HBVIB_GROUND, 0.3, 0.1, 50)); },
       [](Model& m) { m.add_spring_damper(0, HBVIB_GROUND, 0, {}, {0.3 * 0.1 / 50}); }, 1e-4, "smoothed friction far below its velocity is a damper");
}

// Linear models: the response has the closed form F / (k - m w^2 + i c w), force by force.
void forces() {
  auto model = oscillator(2, 0.1, 3, 5);
  model.clear_forces();
  model.add_force(0, 1, {0.3, -0.4});
  const double w = 1.1;
  const auto wanted = Complex(0.3, -0.4) / Complex(3 - 2 * w * w, 0.1 * w);
  const auto x = model.forced_response({}, {w, w}).harmonics(0);
  near(std::abs(x(1, 0) - wanted) + 1, 1, 1e-14, "forces are cleared, complex forces have their phase");
  near(std::abs(model.time_response(hbvib::TimeOptions(w)).harmonics(1, 0) - wanted) + 1, 1, 1e-10, "in time as well");
}

// The mode most alike a shape is followed.
void alike() {
  const double m[2][2] = {{1, 0}, {0, 1}}, k[2][2] = {{2, -1}, {-1, 2}};
  auto model = Model::plain(2);
  model.set_matrix(HBVIB_MASS, m);
  model.set_matrix(HBVIB_STIFFNESS, k);
  model.add_contact(Contact::cubic_spring(0, HBVIB_GROUND, 0, 1));
  const std::vector<Complex> shape = {1, -0.8};
  hbvib::ModeOptions range(-3, -1);
  const auto info = model.nonlinear_mode({}, range.alike(shape)).mode_info();
  claim(info.mode_index == 1 && std::fabs(info.omega - std::sqrt(3.0)) < 1e-12, "the mode most alike a shape");
}

// A spring of y + y^3 (H = 15): the mode's frequency against the arithmetic-geometric mean of Duffing's.
void nonlinear_mode() {
  auto model = oscillator(1, 0, 1, 0.2);
  model.add_contact(Contact::cubic_spring(0, HBVIB_GROUND, 0, 1));
  const std::vector<double> at = {-1, 0, 0.2};
  hbvib::ModeOptions range(-1.5, 0.3);
  SolverOptions solver;
  solver.tolerance = 0, solver.harmonics = 15;
  const auto mode = model.nonlinear_mode(solver, range.wanted(at));
  claim(mode.complete(), "the mode is whole");
  for (Index i = 0; i < 3; i++) {
    const auto found = mode.at(i);
    if (!claim(found.size() == 1, "one solution at a wanted amplitude")) continue;
    const auto point = mode.mode_point(found[0].point);
    near(point.log10_amplitude, at[static_cast<std::size_t>(i)], 1e-12, "its amplitude");
    double a = 0;  // largest displacement: all harmonics in phase
    const auto x = mode.harmonics(found[0].point);
    for (Index h = 0; h < x.shape(0); h++) a += x(h, 0).real();
    double mean = 1, other = std::sqrt((1 + a * a / 2) / (1 + a * a));
    for (int k = 0; k < 8; k++) {
      const double next = (mean + other) / 2;
      other = std::sqrt(mean * other), mean = next;
    }
    near(point.omega, std::sqrt(1 + a * a) * mean, 1e-11, "its frequency by elliptic integrals");
    near(point.damping_ratio + 1, 1, 1e-12, "it needs no artificial damping");
  }
  const auto info = mode.mode_info();
  claim(info.mode_index == 0 && info.multiple == HBVIB_MODE_SINGLE && std::fabs(info.omega - 1) < 1e-14, "where the mode began");

  // The resonance that it foretells with damping is the one computed.
  const double c[1][1] = {{0.02}};
  model.set_matrix(HBVIB_DAMPING, c);
  hbvib::SynthesisOptions with;
  with.model_damping = 1;
  with.force_factor = 0.1;
  const auto foretold = mode.synthesis_peaks(model, with);
  auto small = oscillator(1, 0.02, 1, 0.02);
  small.add_contact(Contact::cubic_spring(0, HBVIB_GROUND, 0, 1));
  const auto peak = small.forced_response({}, {0.8, 2}).highest_peak();
  if (claim(foretold.size() == 1, "one resonance")) {
    near(foretold[0].amplitude, peak.amplitude, 2e-2, "its amplitude is foretold");
    near(foretold[0].omega, peak.omega, 5e-3, "its frequency is foretold");
  }
  const auto curve = mode.synthesis(model, with);
  claim(!curve.omega.empty() && curve.omega.size() == curve.response.size() && curve.omega.size() == curve.modal_amplitude.size(), "the foretold curve");
  double largest = 0;
  for (const auto r : curve.response) largest = std::max(largest, std::abs(r));
  claim(largest <= foretold.at(0).amplitude * (1 + 1e-9) && largest > 0.5 * foretold.at(0).amplitude, "stays below its resonance");
}

/// A run-up of a rubbing oscillator stays below its resonance, and a mission there and back passes it twice.
void run_ups() {
  auto model = oscillator(1, 0.02, 1, 0.12);
  model.add_contact(Contact::jenkins(0, HBVIB_GROUND, 0.2, 0.1, 1));
  hbvib::SolverOptions solver;
  solver.harmonics = 3;
  solver.tolerance = 0;
  const auto mode = model.nonlinear_mode(solver, {-2, 0.8});
  hbvib::RunUpOptions options;
  options.omega_start = 0.8;
  options.omega_stop = 1.3;
  options.rate = 5e-3;
  const auto up = mode.run_up(model, options);
  claim(up.time.size() == up.amplitude.size() && up.time.size() == 17, "a number for each turn");
  claim(up.factor() > 0.5 && up.factor() < 1 && up.error > 0 && up.error < 0.1, "a run-up stays below the resonance");
  const double times[3] = {0, 1e3, 2e3}, speeds[3] = {0.8, 1.3, 0.8}, edges[1] = {0.5};
  hbvib::MissionOptions mission;
  mission.times = times;
  mission.speeds = speeds;
  mission.points_len = 3;
  mission.edges = edges;
  mission.edges_len = 1;
  const auto flight = mode.mission(model, mission);
  claim(flight.passages.size() == 2 && flight.amplitude.size() == 3 && flight.cycles[1] > 0, "a mission passes twice");
  const auto truth = model.time_sweep({0.8, 1.3, 5e-3});
  claim(truth.time.size() == up.time.size() && !truth.stopped, "a sweep has the turns of the run-up");
  claim(std::abs(up.largest / truth.info.largest - 1) <= up.error && up.integrated > 0 && up.integrated <= 17, "a run-up has the largest displacement of a sweep");
  hbvib::CampbellOptions diagram;
  diagram.engine_order = 2;
  diagram.acceleration = 5e-4;
  const double factors[2] = {0.5, 1};
  const auto picture = mode.campbell_response(model, diagram, factors);
  claim(picture.speed.size() == 2 && picture.omega[1] == 2 * picture.speed[1], "a resonance for each factor");
  claim(picture.factor(1) > 0.5 && picture.factor(1) < 1 && std::abs(picture.amplitude[1] / up.steady - 1) < 0.01, "it is that of the run-up");
}

/// Wear of one contact: the stored row of ten cycles with one harmonic, and the best load.
void lives() {
  auto model = oscillator(1, 0.05, 1, 0.3);
  model.add_contact(Contact::jenkins(0, HBVIB_GROUND, 1, 0.3, 0.6));
  hbvib::SolverOptions solver;
  solver.harmonics = 1;
  solver.tolerance = 0;
  const Index contact[1] = {0};
  const double rate[1] = {0.05}, omega[1] = {1.1}, stiffness[1] = {1}, cycles[2] = {0, 10};
  hbvib::LifeOptions options(contact, rate);
  options.at(omega).coupled(stiffness).tolerance = 1e-8;
  const auto life = model.life(options, cycles, solver);
  claim(life.status == HBVIB_OK && life.loads.size() == 2 && std::abs(life.loads[1] - 0.29957673568767756) < 1e-6, "a life wears");
  claim(life.info.points == 2 && life.events.empty() && life.amplitude[1] > life.amplitude[0], "its numbers");
  const auto best = model.best_load_for_life(options.peak(0.6, 2), 8, 0.2, 3, solver);
  claim(best.factor > 0.2 && best.factor < 3 && best.lives > 9, "a best load");
}

/// Stodola's rotor, a loss factor, modal damping, a load of the speed.
void rotation() {
  const double mass[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0.3, 0}, {0, 0, 0, 0.3}};
  const double stiffness[4][4] = {{1, 0, 0.4, 0}, {0, 1, 0, 0.4}, {0.4, 0, 0.8, 0}, {0, 0.4, 0, 0.8}};
  const double gyroscopic[4][4] = {{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0.5}, {0, 0, -0.5, 0}};
  auto rotor = Model::plain(4);
  rotor.set_matrix(HBVIB_MASS, mass);
  rotor.set_matrix(HBVIB_STIFFNESS, stiffness);
  rotor.set_matrix(HBVIB_GYROSCOPIC, gyroscopic);
  rotor.set_speed(1);
  const auto modes = rotor.damped_modes(0, HBVIB_CONTACTS_FREE, 4);
  claim(std::abs(modes.omega(1) - 0.917055456) < 1e-9 && modes.direction[1] == 1, "a rotor whirls forward");
  claim(std::abs(modes.damping_ratio(0)) < 1e-12, "without damping");
  const auto diagram = rotor.campbell(std::vector<double>{0.8, 1.0}, 0, HBVIB_CONTACTS_FREE, 4, std::vector<hbvib::Index>{1});
  claim(diagram.crossings.size() == 1 && std::abs(diagram.crossings[0].speed - 0.9135225809938965) < 1e-12, "at one critical speed");
  rotor.set_rayleigh(0, 0.02);
  rotor.add_unbalance(0, 1, 0.1, 0.3);
  rotor.set_speed_per_omega(1);
  const double tied = rotor.forced_response({}, {0.8, 0.8}).field(HBVIB_AMPLITUDE)[0];
  rotor.set_speed(0.8);
  near(rotor.forced_response({}, {0.8, 0.8}).field(HBVIB_AMPLITUDE)[0], tied, 1e-12, "a speed of the frequency is that speed");
  rotor.set_loss_factor(0.02);
  claim(rotor.damped_modes(0, HBVIB_CONTACTS_FREE, 1).damping_ratio(0) > 0.01, "a loss factor damps");
  rotor.set_modal_damping(std::vector<double>{0.01, 0.01});
  const hbvib::Index contact = rotor.add_contact(hbvib::Contact::jenkins(0, HBVIB_GROUND, 1, 0.3, 1));
  rotor.set_preload(contact, 0.5, 0.1);
}

/// A wedge damper that sticks at a platform and slips at a blade.
void residual_forces() {
  auto model = hbvib::Model::plain(3);
  const double mass[3][3] = {{1, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}}, damping[3][3] = {{0.04, 0, 0}, {0, 0.004, 0}, {0, 0, 0.004}};
  const double stiffness[3][3] = {{1, 0, 0}, {0, 1e-3, 0}, {0, 0, 1e-3}};
  model.set_matrix(HBVIB_MASS, mass);
  model.set_matrix(HBVIB_DAMPING, damping);
  model.set_matrix(HBVIB_STIFFNESS, stiffness);
  for (const bool blade : {false, true}) {
    hbvib::Contact c;
    c.kind = HBVIB_FRICTION_2D;
    c.dof_a[0] = 1, c.dof_a[1] = 2;
    if (blade) c.dof_b[0] = 0;
    c.kt = 1, c.kn = 1.5, c.mu = blade ? 0.15 : 0.6;
    c.normal[0] = blade ? -1 : 1, c.normal[1] = -1;
    c.tangent[0] = 1, c.tangent[1] = blade ? -1 : 1;
    model.add_contact(c);
  }
  model.add_force(2, 0, 1);
  model.add_force(0, 1, 0.02);
  hbvib::SolverOptions s;
  s.tolerance = 0, s.harmonics = 5;
  const auto branch = model.forced_response(s, {1.25, 1.25});
  const auto free = model.freedom(branch, 0);
  claim(free.size() == 1 && free[0].contact == 0 && free[0].direction == 0, "one slider is free");
  s.freedom = 1;
  const auto with_freedom = model.forced_response(s, {1.25, 1.25});
  s.freedom = 0;
  const auto slope = with_freedom.field(HBVIB_D_AMPLITUDE_BY_PLACE);
  claim(slope.rank() == 3 && slope.shape()[1] == 2 && slope.shape()[2] == 2 && std::isnan(slope(0, 1, 0)), "points x contacts x 2");
  near(slope(0, 0, 0), free[0].derivative, 1e-9, "the branch has the freedom of its points");
  near(with_freedom.field(HBVIB_FREE_SLIDERS)[0], 1, 0, "and their number");
  const auto band = model.band(branch, 0);
  claim(band.info.sliders == 1 && band.info.upper > 1.05 * band.info.lower && band.lower_place.size() == 1, "the response is a band");
  const auto curve = model.band_curve(branch);
  claim(curve.omega.size() == 1 && curve.sliders[0] == 1 && curve.complete[0] == 1, "the curve has one point");
  near(curve.upper[0], band.info.upper, 1e-12, "with the same upper end");
  near(curve.lower[0], band.info.lower, 1e-12, "and lower end");
  model.set_slider(0, band.upper_place[0]);
  near(model.forced_response(s, {1.25, 1.25}).field(HBVIB_AMPLITUDE)[0], band.info.upper, 1e-6, "its end is a response");
}

/// A slider under twice the force that it can hold, and under none: it keeps a force of the other sense.
void load_history() {
  auto model = hbvib::Model::plain(1);
  const double one[1][1] = {{1}};
  model.set_matrix(HBVIB_MASS, one);
  model.set_matrix(HBVIB_STIFFNESS, one);
  model.add_contact(hbvib::Contact::jenkins(0, HBVIB_GROUND, 1, 0.5, 1));
  model.add_force(0, 0, 1);
  const auto history = model.static_history({2, 0});
  claim(history.steps == 2 && history.motion.size() == 2 && history.places.size() == 4, "a load history has two states");
  near(history.motion[0], 1.5, 1e-12, "the motion under the force");
  near(history.motion[1], 0.5, 1e-12, "what is left of it");
  near(history.forces[3], -0.5, 1e-12, "the force that is left");
  model.set_slider(0, history.places[2]);
  near(model.static_history({0}).motion[0], 0.5, 1e-12, "the state that is left is that of its slider");
}

/// The same wedge as a damper by one call.
void damper_under_platforms() {
  auto model = hbvib::Model::plain(1);
  const double mass[1][1] = {{1}}, damping[1][1] = {{0.04}};
  model.set_matrix(HBVIB_MASS, mass);
  model.set_matrix(HBVIB_STIFFNESS, mass);
  model.set_matrix(HBVIB_DAMPING, damping);
  hbvib::Damper damper;
  damper.mass = 0.01, damper.radius = 0.05, damper.length = 0.2, damper.orbit = 25;
  damper.support[0] = 1e-3, damper.support[1] = 1e-4, damper.support_damping[0] = 4e-3, damper.support_damping[1] = 1e-5;
  std::vector<hbvib::DamperFace> faces(2);
  for (auto& face : faces) face.kt = 1, face.kn = 1.5;
  faces[0].angle = -0.7853981633974483, faces[0].mu = 0.6;
  faces[1].angle = 0.7853981633974483, faces[1].mu = 0.15, faces[1].dofs[0] = 0;
  const auto place = model.add_damper(damper, faces);
  claim(place.dof == 1 && place.contact == 0 && model.dofs() == 4 && model.contacts() == 2, "a damper has three motions and two contacts");
  model.set_speed(2);
  model.add_force(0, 1, 0.02);
  hbvib::SolverOptions s;
  s.tolerance = 0, s.harmonics = 5;
  const auto free = model.freedom(model.forced_response(s, {1.25, 1.25}), 0);
  claim(!free.empty() && free[0].contact == 0, "its contact with the ground is free");
  const auto mode = model.nonlinear_mode(s, hbvib::ModeOptions(-0.6, -0.5));
  const auto band = model.mode_band(mode, 0);
  claim(band.info.sliders > 0 && band.info.upper >= band.info.lower && !band.upper_place.empty(), "its damping is a band");
}

}  // namespace

int main() {
  claim(hbvib::version() == (HBVIB_VERSION_MAJOR << 16 | HBVIB_VERSION_MINOR << 8 | HBVIB_VERSION_PATCH), "the library is that of the header");
  claim(std::string(hbvib::version_string()).find('.') != std::string::npos, "its version as text");
  return verdict(150, [] {
    linear_modes();
    friction();
    equal_contacts();
    forces();
    alike();
    nonlinear_mode();
    run_ups();
    lives();
    rotation();
    residual_forces();
    load_history();
  load_history();
    damper_under_platforms();
  });
}
