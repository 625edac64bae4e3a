/* hbvib with Eigen: matrices are passed directly, dense or sparse, and results are maps over the
 * memory of the library. A chain of masses, one of them with friction against the ground; at its resonance the residual
 * of harmonic balance is computed again with Eigen's algebra.
 *
 *   cmake -S examples/cpp -B build -DCMAKE_PREFIX_PATH=<where hbvib is installed>
 *   cmake --build build && build/eigen
 */
#include "hbvib.hpp"

#include <Eigen/Dense>
#include <Eigen/Sparse>

#include <cstdio>

namespace {

using hbvib::Complex;
using hbvib::Index;
using Eigen::VectorXcd;

// One dimension: a vector over the view's memory, whatever its stride.
Eigen::Map<const Eigen::VectorXd, 0, Eigen::InnerStride<>> vector(const hbvib::View<const double>& v) {
  return {v.data(), v.shape(0), Eigen::InnerStride<>(v.stride(0))};
}

// Harmonics: harmonic h is row h.
using Harmonics = Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
Eigen::Map<const Harmonics> matrix(const hbvib::View<const Complex>& v) { return {v.data(), v.shape(0), v.shape(1)}; }

// Springs of stiffness k between neighbours, and to the ground at both ends.
Eigen::SparseMatrix<double> chain(Index n, double k) {
  Eigen::SparseMatrix<double> a(n, n);
  for (Index i = 0; i < n; i++) {
    a.insert(i, i) = 2 * k;
    if (i > 0) a.insert(i, i - 1) = a.insert(i - 1, i) = -k;
  }
  a.makeCompressed();
  return a;
}

}  // namespace

int main() try {
  const Index n = 12, rubbing = 4;
  const double force = 0.05;
  const Eigen::MatrixXd mass = Eigen::VectorXd::LinSpaced(n, 1, 2).asDiagonal();
  const Eigen::SparseMatrix<double> stiffness = chain(n, 1);
  const Eigen::MatrixXd damping = 0.01 * Eigen::MatrixXd(stiffness);

  auto model = hbvib::Model::plain(n);
  model.set_matrix(HBVIB_MASS, mass);
  model.set_matrix(HBVIB_DAMPING, damping);
  model.set_matrix(HBVIB_STIFFNESS, stiffness);
  model.add_contact(hbvib::Contact::jenkins(rubbing, HBVIB_GROUND, 0.5, 0.3, 1));
  model.add_force(0, 1, force);

  const auto modes = model.linear_modes(0, HBVIB_CONTACTS_STUCK, 1);
  const auto phi = matrix(modes.shapes);
  std::printf("lowest mode: omega %.6f, phi^H M phi - 1 = %.0e\n", modes.omega[0],
              std::abs((phi.conjugate() * mass * phi.transpose())(0, 0) - 1.0));

  hbvib::SolverOptions solver;
  solver.response_dof = rubbing;
  const auto branch = model.forced_response(solver, hbvib::ForcedOptions(0.7 * modes.omega[0], 1.3 * modes.omega[0]));
  const auto omegas = branch.field(HBVIB_OMEGA), amplitudes = branch.field(HBVIB_AMPLITUDE);
  Eigen::Index highest;
  const double largest = vector(amplitudes).maxCoeff(&highest);
  std::printf("%lld points, the highest of them: omega %.6f, amplitude %.6f\n", static_cast<long long>(branch.points()),
              vector(omegas)[highest], largest);

  const auto peak = branch.highest_peak();
  const auto memory = branch.harmonics(peak.point);
  const auto x = matrix(memory);
  Eigen::VectorXd worst(x.rows());  // residual without the row of the contact, per harmonic
  for (Eigen::Index h = 0; h < x.rows(); h++) {
    const double w = static_cast<double>(h) * peak.omega;
    VectorXcd r = (stiffness.cast<Complex>() - w * w * mass.cast<Complex>() + Complex(0, w) * damping) * x.row(h).transpose();
    if (h == 1) r[0] -= force;
    r[rubbing] = 0;
    worst[h] = r.cwiseAbs().maxCoeff();
  }
  std::printf("peak: omega %.9f, amplitude %.9f; residual off the contact %s 1e-12\n", peak.omega, peak.amplitude,
              worst.maxCoeff() < 1e-12 ? "<" : ">");
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}
