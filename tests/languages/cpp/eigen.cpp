/* Eigen's matrices go in as they are and results are mapped where they lie. Needs Eigen 3. */
#include "common.hpp"

#include <Eigen/Dense>
#include <Eigen/Sparse>

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

void matrices() {
  auto model = ring_damper();
  const auto before = bits(model);
  auto same = [&](const hbvib::Matrix& k, const char* kind) {
    model.set_matrix(HBVIB_STIFFNESS, k);
    claim(bits(model) == before, std::string("the same bits from a stiffness that is ") + kind);
    model.set_matrix(HBVIB_STIFFNESS, Eigen::MatrixXd(Eigen::MatrixXd::Zero(NDOF, NDOF)));
  };
  const Eigen::MatrixXd k = Eigen::Map<const RowMajor>(&STIFFNESS[0][0], NDOF, NDOF);
  const RowMajor by_rows = k;
  const Eigen::MatrixXcd complex = k.cast<Complex>();
  Eigen::MatrixXd large = Eigen::MatrixXd::Constant(9, 9, 1e99);
  large.block(2, 3, NDOF, NDOF) = k;
  const Eigen::SparseMatrix<double> sparse = k.sparseView();
  const Eigen::SparseMatrix<double, Eigen::ColMajor, std::int64_t> wide = k.sparseView();
  const Eigen::Ref<const Eigen::MatrixXd> ref = k;
  same(k, "dense");
  same(by_rows, "dense and row-major");
  same(complex, "complex");
  same(Eigen::Matrix4d(k), "of fixed size");
  same(large.block(2, 3, NDOF, NDOF), "a block of a larger one");
  same(k.transpose(), "transposed");
  same(ref, "a reference");
  same(Eigen::Map<const Eigen::MatrixXd>(&STIFFNESS[0][0], NDOF, NDOF), "a map");
  same(sparse, "sparse");
  same(wide, "sparse with wide indices");
  const Eigen::SparseMatrix<double, Eigen::RowMajor> rows = k.sparseView();
  const Eigen::SparseMatrix<Complex, Eigen::RowMajor, std::int64_t> wide_rows = complex.sparseView();
  same(rows, "sparse and row-major");
  same(wide_rows, "complex, sparse and row-major with wide indices");
  const int starts[] = {1, 2, 3}, columns[] = {1, 3};
  const double ones[] = {1, 1};
  refused("a column out of range", HBVIB_E_INDEX, 0, "col_idx[1] = 3, needs 1 .. 2", [&] { hbvib::Matrix::csr(2, 2, ones, starts, columns, 1); });

  Eigen::MatrixXd general = k;
  general(0, 3) = 7;
  refused("a matrix without symmetry", HBVIB_E_NOT_HERMITIAN, 3, "", [&] { model.set_matrix(HBVIB_STIFFNESS, general); });
  auto plain = Model::plain(NDOF);
  plain.set_matrix(HBVIB_MASS, Eigen::MatrixXd(Eigen::MatrixXd::Identity(NDOF, NDOF)));
  for (const bool turned : {false, true}) {
    if (turned)
      plain.set_matrix(HBVIB_STIFFNESS, hbvib::Matrix(general.transpose()).as(HBVIB_GENERAL));
    else
      plain.set_matrix(HBVIB_STIFFNESS, hbvib::Matrix(general).as(HBVIB_GENERAL));
    SolverOptions s;
    s.tolerance = 0, s.harmonics = 1;
    Eigen::VectorXcd x = Eigen::VectorXcd::Zero(2 * NDOF);
    x.tail(NDOF) = Eigen::VectorXcd::Random(NDOF);
    const auto residual = plain.forced_residual(s, 0, x);
    const Eigen::VectorXcd wanted = (turned ? Eigen::MatrixXd(general.transpose()) : general).cast<Complex>() * x.tail(NDOF);
    const Eigen::Map<const Eigen::VectorXcd> all(residual.r.data(), 2 * NDOF);
    claim((all.tail(NDOF) - wanted).norm() < 1e-14 * wanted.norm(), "the residual is Eigen's product, for the matrix and its transpose");
  }
  const Eigen::Map<const Eigen::MatrixXd, 0, Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>> loose(large.data(), 2, 2, {18, 2});
  refused("a map with an inner stride", HBVIB_E_ARGUMENT, 0, "adjacent", [&] { Model::plain(2).set_matrix(HBVIB_MASS, loose); });
}

void vectors() {
  auto model = ring_damper();
  const Eigen::Vector2d at(2 * PI * 208, 2 * PI * 210);
  auto wanted = range();
  const auto branch = model.forced_response(options(), wanted.wanted(at));
  claim(branch.at(0).size() == 1 && branch.at(1).size() == 1, "frequencies wanted in an Eigen vector");

  const auto field = branch.field(HBVIB_AMPLITUDE);
  hbvib_view c;
  (void)hbvib_view_init(&c, sizeof c);
  (void)hbvib_branch_field(branch.get(), HBVIB_AMPLITUDE, &c);
  const Eigen::Map<const Eigen::VectorXd, 0, Eigen::InnerStride<>> map(field.data(), field.shape(0), Eigen::InnerStride<>(field.stride(0)));
  Eigen::Index highest;
  const double largest = map.maxCoeff(&highest);
  claim(map.data() == c.data && map.data() + highest * map.innerStride() == &field[highest] && largest == field[highest], "Eigen looks at the library's own memory");

  Eigen::Matrix<Complex, 10, NDOF, Eigen::RowMajor> x;
  const auto peak = branch.highest_peak();
  branch.harmonics(peak.point, 0, NDOF, x);
  near(std::abs(x(1, B2)), peak.amplitude, 1e-12, "harmonics go straight into Eigen's memory");

  Eigen::MatrixXd table(3, 2);
  table << -1, -2, 0, 0, 1, 2;
  claim(model.add_table(0, 1, 0, table.col(0), table.col(1)) == 1, "columns are arrays");
  refused("a row of a column-major matrix", HBVIB_E_ARGUMENT, 0, "one after the other", [&] { model.add_table(0, 1, 0, table.row(0), table.row(1)); });
  refused("a block with gaps", HBVIB_E_ARGUMENT, 0, "one after the other", [&] { model.add_table(0, 1, 0, table.topRows(2), table.topRows(2)); });
  refused("a block of one row with gaps", HBVIB_E_ARGUMENT, 0, "one after the other", [&] { model.add_table(0, 1, 0, table.block(0, 0, 1, 2), table.block(0, 0, 1, 2)); });
  const Eigen::RowVector3d displacement(-1, 0, 1);
  claim(model.add_table(0, 1, 0, displacement, displacement) == 2, "row vectors are arrays");
}

}  // namespace

int main() {
  return verdict(25, [] {
    matrices();
    vectors();
  });
}
