/* What the C++ tests share: claims that are counted, and the ring damper as reference case. Silent on
 * success; else a line for each claim that failed, and exit code 1. */
#ifndef COMMON_HPP
#define COMMON_HPP

#include "hbvib.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

using hbvib::Branch;
using hbvib::Complex;
using hbvib::Contact;
using hbvib::Error;
using hbvib::ForcedOptions;
using hbvib::Index;
using hbvib::Model;
using hbvib::SolverOptions;

const double PI = 3.14159265358979323846;
enum : Index { B2, B1, D, R, NDOF };

inline int checks = 0, failures = 0;

inline bool claim(bool holds, const std::string& what) {
  checks++;
  if (!holds) failures++, std::fprintf(stderr, "failed: %s\n", what.c_str());
  return holds;
}

inline void near(double got, double wanted, double tolerance, const std::string& what) {
  if (!claim(std::fabs(got - wanted) <= tolerance * std::fabs(wanted), what))
    std::fprintf(stderr, "  got %.17g, needs %.17g within %g\n", got, wanted, tolerance);
}

/// The call throws Error with this status and argument, and a sentence with these words in it.
template <class F>
void refused(const std::string& what, hbvib_status status, std::int32_t argument, const char* words, F&& call) {
  try {
    call();
    claim(false, what + ": nothing was thrown");
  } catch (const Error& e) {
    if (!claim(e.status() == status && e.argument() == argument && std::strstr(e.what(), words), what))
      std::fprintf(stderr, "  got %s, argument %d: \"%s\"\n", e.status_name(), static_cast<int>(e.argument()), e.what());
  } catch (const std::exception& e) {
    claim(false, what + ": another exception, " + e.what());
  }
}

const double MASS[4][4] = {{0.2, 0, 0, 0}, {0, 0.3, 0, 0}, {0, 0, 1.2, 0}, {0, 0, 0, 0.03}};
const double STIFFNESS[4][4] = {{2e6, -2e6, 0, 0}, {-2e6, 3e6, -1e6, 0}, {0, -1e6, 101.6e6, 0}, {0, 0, 0, 4e7}};
const double COUPLING[4][4] = {{}, {}, {0, 0, -5e7, 0}, {0, 0, 0, -2e7}};
const double PRELOAD = 0.03 * 0.165 * (100 * PI) * (100 * PI);

/// One of 24 sectors: blade tip, blade root, disk, ring; 5 N on the blade.
inline Model ring_damper() {
  auto model = Model::cyclic(NDOF, 24);
  model.set_matrix(HBVIB_MASS, MASS);
  model.set_matrix(HBVIB_STIFFNESS, STIFFNESS);
  model.set_coupling(HBVIB_STIFFNESS, COUPLING);
  model.set_rayleigh(0, 1.5e-6);
  model.set_wave(2);
  model.add_force(B2, 1, 5);
  model.add_force(B1, 1, 5);
  model.add_contact(Contact::jenkins(D, R, 5e7, 0.3, PRELOAD));
  return model;
}

inline SolverOptions options(Index harmonics = 9) {
  SolverOptions s;
  s.tolerance = 0, s.harmonics = harmonics;
  s.response_dof = B2;
  return s;
}

inline ForcedOptions range() { return {2 * PI * 207, 2 * PI * 211}; }

/// The curve and the harmonics at the peak: the bits of a solution.
inline std::vector<double> bits(const Branch& branch) {
  std::vector<double> all;
  for (const auto which : {HBVIB_OMEGA, HBVIB_AMPLITUDE})
    for (const double number : branch.field(which)) all.push_back(number);
  const auto x = branch.harmonics(branch.highest_peak().point);
  for (Index h = 0; h < x.shape(0); h++)
    for (Index i = 0; i < x.shape(1); i++) all.push_back(x(h, i).real()), all.push_back(x(h, i).imag());
  return all;
}
inline std::vector<double> bits(const Model& model) { return bits(model.forced_response(options(), range())); }

/// An oscillator of mass, stiffness and damping with a load on its first harmonic.
inline Model oscillator(double mass, double damping, double stiffness, double load) {
  const double m[1][1] = {{mass}}, c[1][1] = {{damping}}, k[1][1] = {{stiffness}};
  auto model = Model::plain(1);
  model.set_matrix(HBVIB_MASS, m);
  model.set_matrix(HBVIB_DAMPING, c);
  model.set_matrix(HBVIB_STIFFNESS, k);
  model.add_force(0, 1, load);
  return model;
}

/// Runs a test and counts what it claimed.
template <class F>
int verdict(int least, F&& test) try {
  test();
  if (checks < least) return std::fprintf(stderr, "failed: only %d checks ran, needs %d\n", checks, least), 1;
  return failures == 0 ? 0 : 1;
} catch (const std::exception& e) {
  return std::fprintf(stderr, "failed: an exception that nobody wanted: %s\n", e.what()), 1;
}

#endif
