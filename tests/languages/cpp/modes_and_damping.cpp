/* Modes about the static state, structural damping given as one triangle, terms of the speed: closed forms, and misuse. */
#include "common.hpp"

#include <limits>

namespace {

const double ETA = 0.02, INF = std::numeric_limits<double>::infinity();

hbvib::SolverOptions harmonics(Index h) {
  hbvib::SolverOptions s;
  s.tolerance = 0, s.harmonics = h;
  return s;
}

/// A stop that presses at rest, then one that only touches; friction under a constant force.
void pressed() {
  auto model = oscillator(1, 0, 1, 0);
  const Index stop = model.add_contact(Contact::unilateral(0, HBVIB_GROUND, 2, 0, 0.5));
  const auto mode = model.nonlinear_mode(harmonics(9), {-2, 1});
  const auto info = mode.mode_info();
  near(info.omega, std::sqrt(3), 1e-12, "a pressed stop is closed at small amplitudes");
  near(info.lift_off_from, std::log10(1. / 12), 1e-9, "it lifts off");
  claim(info.slip_from == INF, "nothing slips");
  const auto x = mode.harmonics(0);
  near(x(0, 0).real(), 1. / 6, 1e-12, "motions are total");
  const double squared = std::norm(x(1, 0));
  near(mode.energy(0).potential_mean, 0.25 * squared, 1e-10, "potential energy counts from the static state");
  near(mode.field(HBVIB_ENERGY)[0], 1.5 * squared, 1e-10, "twice the mean kinetic energy");
  model.set_preload(stop, 0);
  const auto touching = model.nonlinear_mode(harmonics(63), {-2, 1});
  for (const double omega : touching.field(HBVIB_OMEGA)) near(omega, 2 * std::sqrt(3) / (1 + std::sqrt(3)), 1e-9, "a touching stop has one frequency");
  claim(touching.mode_info().lift_off_from == -INF, "it lifts off at every amplitude");

  auto rubbing = oscillator(1, 0, 1, 0);
  rubbing.add_contact(Contact::jenkins(0, HBVIB_GROUND, 1, 0.3, 1));
  rubbing.add_force(0, 0, 0.2);
  const auto loaded = rubbing.nonlinear_mode(harmonics(5), {-2, 0.5});
  claim(std::fabs(loaded.mode_info().linear_up_to - std::log10(0.2)) < 1e-8, "a loaded slider is dragged along");
  claim(std::fabs(loaded.mode_info().slip_from - std::log10(0.3)) < 1e-6, "then it slips");
  near(loaded.harmonics(0)(0, 0).real(), 0.1, 1e-12, "about the static state");
}

/// Two masses on hardening springs with a weak one between: beside the opposed mode are two localised ones.
void branches() {
  const double mass[2][2] = {{1, 0}, {0, 1}}, stiffness[2][2] = {{1.1, -0.1}, {-0.1, 1.1}};
  auto model = Model::plain(2);
  model.set_matrix(HBVIB_MASS, mass);
  model.set_matrix(HBVIB_STIFFNESS, stiffness);
  for (const Index dof : {0, 1}) model.add_contact(Contact::cubic_spring(dof, HBVIB_GROUND, 0, 1));
  hbvib::ModeOptions o(-1, 0.5);
  o.mode_index = 1, o.branches = 1;
  std::vector<hbvib::Branch> children;
  {
    const auto mode = model.nonlinear_mode(harmonics(1), o);
    claim(mode.bifurcations().size() == 1 && mode.bifurcations()[0].kind == HBVIB_BIFURCATION_BRANCH_POINT, "one branch point");
    near(mode.mode_point(mode.bifurcations()[0].point).modal_amplitude, std::sqrt(0.8 / 3), 1e-7, "that of the closed form");
    claim(mode.searched().bifurcations == 1 && mode.descent().bifurcation == -1, "sought from there");
    children = mode.children();
  }
  claim(children.size() == 2 && children[0].descent().bifurcation == 0, "children keep their parent alive");
  const auto x = children[1].harmonics(children[1].points() - 1);
  near((x(1, 0) * x(1, 1)).real(), -0.4 / 3, 1e-8, "the product of both motions is that of the closed form");
  claim(children[0].children().empty(), "no further ones");
}

/// A stop that touches at rest. Harmonics 1 and 2 of half the frequency, 1.19, are those of event-driven integration.
void doubled_period() {
  auto model = oscillator(1, 0.05, 1, 1);
  model.add_contact(Contact::unilateral(0, HBVIB_GROUND, 10, 0));
  const double at[] = {2.38};
  auto range = hbvib::ForcedOptions(2.3, 2.5);
  range.branches = 1;
  const auto branch = model.forced_response(harmonics(50), range.wanted(at));
  const auto children = branch.children();
  claim(children.size() == 1 && children[0].descent().periods == 2, "a child of the double period");
  const Index point = children[0].at(0).at(0).point;
  const auto x = children[0].harmonics(point);
  near(std::abs(x(1, 0)), 0.183236054604, 1e-5, "half the frequency of the force");
  near(std::abs(x(2, 0)), 0.292415649854, 1e-5, "the frequency of the force");
  const auto info = model.longer_period(2).verify(children[0], point).info;
  claim(info.same_solution == 1 && info.response_error < 1e-6, "it holds in time");
  refused("no period", HBVIB_E_ARGUMENT, 2, "periods = 0", [&] { model.longer_period(0); });
}

/// Two masses of 1 between three springs of 1 + i eta.
void parts() {
  const double n = std::numeric_limits<double>::quiet_NaN();
  const Complex loss(1, ETA), nan(n, n), k = 2. * loss, c = -loss;
  const double mass[2][2] = {{1, 0}, {0, 1}}, real[2][2] = {{2, -1}, {-1, 2}}, structural[2][2] = {{2 * ETA, -ETA}, {-ETA, 2 * ETA}};
  // Arrays of C are row-major.
  const Complex full[2][2] = {{k, c}, {c, k}}, lower[2][2] = {{k, nan}, {c, k}}, upper[2][2] = {{k, c}, {nan, k}};
  const Complex one = 1. / Complex(0, ETA), other = 1. / Complex(2, 3 * ETA);
  auto plain = Model::plain(2);
  plain.set_matrix(HBVIB_MASS, mass);
  plain.add_force(0, 1, 1);
  auto has_the_response = [&](Model model, const char* what) {
    const auto branch = model.forced_response(harmonics(1), {1, 1});
    const auto x = branch.harmonics(0);
    claim(std::abs(x(1, 0) - 0.5 * (one + other)) < 1e-12 / ETA && std::abs(x(1, 1) - 0.5 * (one - other)) < 1e-12 / ETA, what);
    refused("no response in time", HBVIB_E_UNSUPPORTED, 0, "viscous equivalent", [&] { model.time_response(hbvib::TimeOptions(1)); });
    refused("no check in time", HBVIB_E_UNSUPPORTED, 0, "no causal law", [&] { model.verify(branch, 0); });
  };
  auto with = [&](hbvib_part part, const Complex (&a)[2][2]) {
    auto model = plain.clone();
    model.set_matrix(HBVIB_STIFFNESS, hbvib::Matrix(a).as(part));
    return model;
  };
  has_the_response(with(HBVIB_SYMMETRIC, full), "a complex symmetric stiffness");
  has_the_response(with(HBVIB_SYMMETRIC_LOWER, lower), "its lower triangle");
  has_the_response(with(HBVIB_SYMMETRIC_UPPER, upper), "its upper triangle");
  auto factor = plain.clone(), matrix = plain.clone();
  for (auto* model : {&factor, &matrix}) model->set_matrix(HBVIB_STIFFNESS, real);
  factor.set_loss_factor(ETA);
  matrix.set_matrix(HBVIB_STRUCTURAL, structural);
  const double half = std::sin(0.5 * std::atan(ETA));
  near(factor.damped_modes(0, HBVIB_CONTACTS_FREE, 1).damping_ratio(0), half, 1e-12, "half the loss factor");
  near(matrix.damped_modes(0, HBVIB_CONTACTS_FREE, 1).damping_ratio(0), half, 1e-12, "the same of a matrix");
  has_the_response(factor.clone(), "a loss factor");
  has_the_response(matrix.clone(), "a structural matrix");
  const double ratio[1] = {0.03}, none[2][2] = {};
  matrix.set_matrix(HBVIB_STRUCTURAL, none);
  matrix.set_modal_damping(ratio);
  near(matrix.damped_modes(0, HBVIB_CONTACTS_FREE, 1).damping_ratio(0), 0.03, 1e-12, "a modal ratio");

  refused("a lower triangle with a complex diagonal", HBVIB_E_NOT_HERMITIAN, 3, "SYMMETRIC_LOWER", [&] { with(HBVIB_LOWER, lower); });
  refused("an upper triangle with a complex diagonal", HBVIB_E_NOT_HERMITIAN, 3, "SYMMETRIC_UPPER", [&] { with(HBVIB_UPPER, upper); });
  refused("a stiffness that is not Hermitian", HBVIB_E_NOT_HERMITIAN, 3, "SYMMETRIC", [&] { with(HBVIB_FULL, full); });
  refused("the wrong triangle", HBVIB_E_NOT_FINITE, 3, "stiffness[0,1]", [&] { with(HBVIB_SYMMETRIC_UPPER, lower); });
  refused("a loss factor below 0", HBVIB_E_ARGUMENT, 2, "loss_factor = -1", [&] { factor.set_loss_factor(-1); });
  const double bad[2] = {0.01, -0.01};
  refused("a modal ratio below 0", HBVIB_E_ARGUMENT, 3, "ratios[1] = -0.01", [&] { factor.set_modal_damping(bad); });
  refused("a gyroscopic matrix without its symmetry", HBVIB_E_NOT_HERMITIAN, 3, "skew-symmetric", [&] { factor.set_matrix(HBVIB_GYROSCOPIC, real); });
  has_the_response(std::move(factor), "a loss factor after refusals");
}

/// Stiffness 1 - 0.2 Omega^2, an unbalance, and engine orders that meet it.
void speed() {
  const double softening[1][1] = {{-0.2}}, p = 0.5, w = 0.7;
  auto model = oscillator(1, 0, 1, 1);
  model.set_matrix(HBVIB_STIFFNESS_SPEED2, softening);
  model.set_speed(1);
  near(model.damped_modes(0, HBVIB_CONTACTS_FREE, 1).omega(0), std::sqrt(0.8), 1e-13, "a frequency at speed");
  const std::vector<double> speeds = {0.2, 0.5, 1};
  const auto diagram = model.campbell(speeds, 0, HBVIB_CONTACTS_FREE, 1, std::vector<Index>{1, 2, 3});
  near(diagram.omega[1], std::sqrt(0.95), 1e-13, "a point of a Campbell diagram");
  if (claim(diagram.crossings.size() == 3, "three crossings"))
    for (const auto& c : diagram.crossings) {
      const double order = static_cast<double>(c.engine_order), at = std::sqrt(1 / (order * order + 0.2));
      near(c.speed, at, 1e-12, "a crossing");
      near(c.omega, order * at, 1e-12, "its frequency");
    }
  model.set_speed_per_omega(p);
  near(model.forced_response(harmonics(1), {w, w}).harmonics(0)(1, 0).real(), 1 / (1 - 0.2 * p * p * w * w - w * w), 1e-12, "a speed of the frequency");
  refused("modes at no one speed", HBVIB_E_ARGUMENT, 0, "fixed speed", [&] { model.damped_modes(0, HBVIB_CONTACTS_FREE, 1); });
  const Index stop = model.add_contact(Contact::unilateral(0, HBVIB_GROUND, 2, 0, 0.5));
  refused("a static state of no one speed", HBVIB_E_UNSUPPORTED, 0, "set a fixed speed", [&] { (void)model.nonlinear_mode(harmonics(5), {-2, 1}); });
  model.set_speed(0);
  near(model.damped_modes(0, HBVIB_CONTACTS_STATIC, 1).omega(0), std::sqrt(3), 1e-12, "a closed stop");
  model.set_preload(stop, 0.5, -0.5);
  model.set_speed(2);
  near(model.damped_modes(0, HBVIB_CONTACTS_STATIC, 1).omega(0), std::sqrt(0.2), 1e-12, "its load is gone at speed");
  refused("a load that falls with the frequency", HBVIB_E_ARGUMENT, 2, "per_speed2 = -0.5", [&] { model.set_speed_per_omega(1); });
  refused("a load of no number", HBVIB_E_NOT_FINITE, 4, "per_speed2 = NaN", [&] { model.set_preload(stop, 0.5, std::nan("")); });
  refused("no speed", HBVIB_E_NOT_FINITE, 2, "speed = NaN", [&] { model.set_speed(std::nan("")); });
  refused("no mode", HBVIB_E_DIMENSION, 4, "count = 0", [&] { model.damped_modes(0, HBVIB_CONTACTS_FREE, 0); });
  refused("a diameter of no wheel", HBVIB_E_ARGUMENT, 2, "diameter = 1", [&] { model.damped_modes(1, HBVIB_CONTACTS_FREE, 1); });
  const std::vector<double> falling = {0.5, 0.2}, none;
  refused("falling speeds", HBVIB_E_ARGUMENT, 3, "speeds[1] = 0.2", [&] { model.campbell(falling, 0, HBVIB_CONTACTS_FREE, 1, std::vector<Index>{1}); });
  refused("no speeds", HBVIB_E_DIMENSION, 3, "no speeds", [&] { model.campbell(none, 0, HBVIB_CONTACTS_FREE, 1, std::vector<Index>{1}); });
  refused("engine order 0", HBVIB_E_ARGUMENT, 7, "engine_order = 0", [&] { model.campbell(speeds, 0, HBVIB_CONTACTS_FREE, 1, std::vector<Index>{0}); });

  const double unit[2][2] = {{1, 0}, {0, 1}};
  auto rotor = Model::plain(2);
  rotor.set_matrix(HBVIB_MASS, unit);
  rotor.set_matrix(HBVIB_STIFFNESS, unit);
  rotor.add_unbalance(0, 1, 0.3, 0.4);
  refused("an unbalance of one direction", HBVIB_E_ARGUMENT, 3, "both 1", [&] { rotor.add_unbalance(1, 1, 1); });
  refused("an unbalance beside the structure", HBVIB_E_INDEX, 2, "dof_x = 4", [&] { rotor.add_unbalance(4, 1, 1); });
  const auto branch = rotor.forced_response(harmonics(1), {w, w});
  const Complex wanted = std::polar(0.3 * w * w / (1 - w * w), 0.4);
  claim(std::abs(branch.harmonics(0)(1, 0) - wanted) < 1e-12 && std::abs(branch.harmonics(0)(1, 1) + Complex(0, 1) * wanted) < 1e-12, "an unbalance");
}

/// Ten masses that move radially and along the circumference, with Coriolis forces: both senses of a nodal diameter.
void senses() {
  const double mass[2][2] = {{1, 0}, {0, 1}}, stiffness[2][2] = {{1500, 0}, {0, 1900}};
  const double next[2][2] = {{-200, 250}, {-250, -350}}, coriolis[2][2] = {{0, -2}, {2, 0}};
  auto wheel = Model::cyclic(2, 10);
  wheel.set_matrix(HBVIB_MASS, mass);
  wheel.set_matrix(HBVIB_STIFFNESS, stiffness);
  wheel.set_coupling(HBVIB_STIFFNESS, next);
  wheel.set_matrix(HBVIB_GYROSCOPIC, coriolis);
  std::vector<double> speeds(181);
  for (std::size_t i = 0; i < speeds.size(); i++) speeds[i] = 0.2 + (45 - 0.2) * static_cast<double>(i) / 180;
  const double known[4] = {3.7995179098748477, 4.05780386908863, 1.710413476178725, 1.9829812203464108};
  const auto diagram = wheel.campbell(speeds, 1, HBVIB_CONTACTS_STUCK, 2, std::vector<Index>{9, 19, 2});
  if (claim(diagram.crossings.size() == 4, "the crossings of the other sense, none of another diameter"))
    for (std::size_t i = 0; i < 4; i++) {
      near(diagram.crossings[i].speed, known[i], 1e-11, "a crossing");
      claim(diagram.crossings[i].diameter == -1, "its wave");
    }
  claim(wheel.signed_diameter(9) == -1 && wheel.signed_diameter(-5) == 5, "signed diameters");
  wheel.set_speed(5);
  const auto all = wheel.interference(HBVIB_CONTACTS_STUCK, 2);
  claim(!all.equal_senses && all.diameters.front() == -4 && all.diameters.back() == 5, "both senses");
  for (std::size_t i = 0; i < all.diameters.size(); i++) {
    near(wheel.damped_modes(all.diameters[i], HBVIB_CONTACTS_STUCK, 2).omega(1), all.omega[2 * i + 1], 1e-12, "a damped wave");
    near(wheel.linear_modes(all.diameters[i] - 30, HBVIB_CONTACTS_STUCK, 2).omega[0], all.omega[2 * i], 1e-12, "an undamped wave");
  }
  wheel.set_speed(0);
  claim(wheel.interference(HBVIB_CONTACTS_STUCK, 2).equal_senses, "equal senses at rest");
}

/// The pattern of a mistuned wheel from its own modes.
void patterns() {
  auto sector = Model::cyclic(1, 8);
  const double mass[1][1] = {{1}}, stiffness[1][1] = {{3}}, next[1][1] = {{-0.1}};
  sector.set_matrix(HBVIB_MASS, mass);
  sector.set_matrix(HBVIB_STIFFNESS, stiffness);
  sector.set_coupling(HBVIB_STIFFNESS, next);
  const std::vector<double> delta{0.01, -0.02, 0.005, 0, 0.015, -0.01, 0.02, -0.005};
  const std::vector<Index> blade{0};
  auto wheel = sector.wheel();
  wheel.mistune(sector, HBVIB_MISTUNING_MASS, delta, blade);
  const auto modes = wheel.linear_modes(0, HBVIB_CONTACTS_STUCK, 8);
  std::vector<Complex> shapes;
  for (Index k = 0; k < 8; k++)
    for (Index s = 0; s < 8; s++) shapes.push_back(modes.shapes(k, s));
  const std::vector<double> sigma(8, 1e-3);
  const auto found = sector.identify_pattern(HBVIB_MISTUNING_MASS, blade, HBVIB_CONTACTS_STUCK, 1, blade, modes.omega, sigma, shapes, sigma);
  for (std::size_t s = 0; s < 8; s++) claim(std::fabs(found.delta[s] - delta[s]) < 1e-10 && found.covariance[9 * s] > 0, "a pattern");
  claim(found.degrees == 56 && found.chi2 < 1e-10, "nothing is left");
  shapes.pop_back();
  refused("too few numbers", HBVIB_E_DIMENSION, 13, "63 numbers",
          [&] { sector.identify_pattern(HBVIB_MISTUNING_MASS, blade, HBVIB_CONTACTS_STUCK, 1, blade, modes.omega, sigma, shapes, sigma); });
}

}  // namespace

int main() {
  return verdict(120, [] {
    pressed();
    branches();
    doubled_period();
    parts();
    speed();
    senses();
    patterns();
  });
}
