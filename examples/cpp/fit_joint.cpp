/* Stiffness and friction of a joint from measured responses, in C++: complex amplitudes of a chain
 * of two masses under three forces, of which the first mass rubs on the ground. Prints the
 * parameters with their standard deviations, the resonance predicted at another force, and the
 * interval of the friction limit by the profile of the likelihood.
 *
 *   cmake -S examples/cpp -B build -DCMAKE_PREFIX_PATH=<where hbvib is installed>
 *   cmake --build build && build/fit_joint examples/data/joint.csv
 */
#include "hbvib.hpp"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

/// Data of a test at one force.
struct Level {
  double force;
  std::vector<double> omega, sigma;
  std::vector<hbvib::Complex> value;
};

/// Reads rows of force, omega, re, im and sigma; the force tells the level.
std::vector<Level> read_levels(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);  // names of the columns
  std::vector<Level> levels;
  while (std::getline(file, line)) {
    double force, omega, re, im, sigma;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", &force, &omega, &re, &im, &sigma) != 5) break;
    if (levels.empty() || levels.back().force != force) levels.push_back({force, {}, {}, {}});
    levels.back().omega.push_back(omega);
    levels.back().value.emplace_back(re, im);
    levels.back().sigma.push_back(sigma);
  }
  if (levels.empty()) throw std::runtime_error(path + " has no data");
  return levels;
}

hbvib::Model chain() {
  const double mass[2][2] = {{1, 0}, {0, 0.5}}, stiffness[2][2] = {{1.5, -0.5}, {-0.5, 0.5}};
  auto model = hbvib::Model::plain(2);
  model.set_matrix(HBVIB_MASS, mass);
  model.set_matrix(HBVIB_STIFFNESS, stiffness);
  model.set_rayleigh(0, 0.01);
  model.add_contact(hbvib::Contact::jenkins(0, HBVIB_GROUND, 0.5, 0.08, 1));  // guesses
  model.add_force(1, 1, 1);
  return model;
}

}  // namespace

int main(int argc, char** argv) try {
  const auto levels = read_levels(argc > 1 ? argv[1] : "../data/joint.csv");
  const auto model = chain();
  hbvib::SolverOptions solver;
  solver.tolerance = 0;  // fixed harmonics: exactly H = 9
  solver.harmonics = 9;
  solver.response_dof = 1;
  std::vector<hbvib::DataSet> data;
  for (const auto& level : levels) data.emplace_back(level.omega, level.value, level.sigma, level.force);
  const std::vector<hbvib::Parameter> parameters = {
      hbvib::Parameter(HBVIB_PARAMETER_KT, 0), hbvib::Parameter(HBVIB_PARAMETER_MU, 0),
      hbvib::Parameter::factor(HBVIB_PARAMETER_DAMPING), hbvib::Parameter::factor(HBVIB_PARAMETER_STIFFNESS)};
  std::vector<hbvib::Unknown> unknowns(4);
  unknowns[2].has_start = 1;
  unknowns[2].start = 2;

  const auto fit = model.fit(solver, parameters, unknowns, data);
  const char* const names[] = {"kt", "friction limit", "damping factor", "stiffness factor"};
  for (int i = 0; i < 4; i++) std::printf("%-16s  %19.12E  +- %16.9E\n", names[i], fit.theta[i], std::sqrt(fit.covariance[5 * i]));
  std::printf("%-16s  %19.12E  on %d\n", "chi2", fit.info.chi2, static_cast<int>(fit.info.degrees_of_freedom));

  const std::vector<double> near = {0.72};
  hbvib::DataSet wanted;
  wanted.kind = HBVIB_DATA_PEAK;
  wanted.force_factor = 0.1;
  wanted.omega_start = 0.6, wanted.omega_stop = 0.9;
  wanted.n = 1, wanted.x = near.data();
  const auto peak = model.predict(solver, wanted, parameters, fit.theta, fit.covariance);
  std::printf("%-16s  %19.12E  +- %16.9E\n", "peak at 0.1", peak.values[0], peak.sigma[0]);

  std::vector<double> scan;
  for (int i = 0; i < 9; i++) scan.push_back(fit.theta[1] + (0.75 * i - 3) * std::sqrt(fit.covariance[5]));
  const auto profile = model.fit_profile(solver, parameters, unknowns, data, fit.theta, 1, scan, 3.841);
  std::printf("%-16s  %16.9E .. %16.9E\n", "95 % of friction", profile.info.lower, profile.info.upper);
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
