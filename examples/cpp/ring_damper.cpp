/* A bladed disk with a friction ring damper, in C++: one of 24 sectors, engine order 2, friction
 * between disk and ring. Prints the resonance of the blade tip under three forces.
 *
 *   cmake -S examples/cpp -B build -DCMAKE_PREFIX_PATH=<where hbvib is installed>
 *   cmake --build build && build/ring_damper
 */
#include "hbvib.hpp"

#include <cstdio>

namespace {

enum : hbvib::Index { B2, B1, D, R, NDOF };  // blade tip, blade root, disk, ring

const double PI = 3.14159265358979323846;

hbvib::Model ring_damper(double ring_mass, double rpm) {
  const double kb2 = 2e6, kb1 = 1e6, kd = 5e7, kg = 6e5, kr = 2e7, radius = 0.165;
  const double spin = rpm * 2 * PI / 60;
  const double mass[NDOF][NDOF] = {{0.2, 0, 0, 0}, {0, 0.3, 0, 0}, {0, 0, 1.2, 0}, {0, 0, 0, ring_mass}};
  const double stiffness[NDOF][NDOF] = {
      {kb2, -kb2, 0, 0}, {-kb2, kb2 + kb1, -kb1, 0}, {0, -kb1, kb1 + kg + 2 * kd, 0}, {0, 0, 0, 2 * kr}};
  const double coupling[NDOF][NDOF] = {{}, {}, {0, 0, -kd, 0}, {0, 0, 0, -kr}};

  auto model = hbvib::Model::cyclic(NDOF, 24);
  model.set_matrix(HBVIB_MASS, mass);
  model.set_matrix(HBVIB_STIFFNESS, stiffness);
  model.set_coupling(HBVIB_STIFFNESS, coupling);
  model.set_rayleigh(0, 1.5e-6);  // C = 1.5e-6 s * K
  model.set_wave(2);              // engine order
  model.add_contact(hbvib::Contact::jenkins(D, R, 5e7, 0.3, ring_mass * radius * spin * spin));
  return model;
}

}  // namespace

int main() try {
  auto model = ring_damper(0.03, 3000);
  hbvib::SolverOptions solver;
  solver.tolerance = 0;  // fixed harmonics: exactly H = 63
  solver.harmonics = 63;
  solver.response_dof = B2;
  const hbvib::ForcedOptions range(2 * PI * 207, 2 * PI * 211);

  std::printf("   F/N              f/Hz            |X1|/m\n");
  for (const double force : {1.0, 5.0, 20.0}) {
    model.clear_forces();
    model.add_force(B2, 1, force);
    model.add_force(B1, 1, force);
    const auto peak = model.forced_response(solver, range).highest_peak();
    std::printf("%6.1f  %16.11f  %19.12E\n", force, peak.omega / (2 * PI), peak.amplitude);
  }
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
