/* Matrices of every kind say the same; fields are views of the library's memory, as long as one looks. */
#include "common.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace {

// Classes as other libraries have them, known by their members alone.
template <class Number, bool row_major>
struct Dense {
  enum { IsRowMajor = row_major };
  std::vector<Number> numbers;
  Index n, outer;
  const Number* data() const { return numbers.data(); }
  Index rows() const { return n; }
  Index cols() const { return n; }
  Index outerStride() const { return outer; }
};
struct Sparse {
  enum { IsRowMajor = 0 };
  std::vector<double> value;
  std::vector<int> outer, inner;
  Index n;
  bool packed = true;
  Index rows() const { return n; }
  Index cols() const { return n; }
  const double* valuePtr() const { return value.data(); }
  const int* outerIndexPtr() const { return outer.data(); }
  const int* innerIndexPtr() const { return inner.data(); }
  bool isCompressed() const { return packed; }
};

void matrices() {
  auto model = ring_damper();
  const auto before = bits(model);
  auto same = [&](const hbvib::Matrix& k, const char* kind) {
    model.set_matrix(HBVIB_STIFFNESS, k);
    claim(bits(model) == before, std::string("the same bits from a stiffness ") + kind);
    const double zero[4][4] = {};
    model.set_matrix(HBVIB_STIFFNESS, zero);
  };
  std::vector<double> wide(4 * 7, 1e99), lower(16, 1e99), values;
  std::vector<Complex> complex(16);
  std::vector<Index> col_ptr = {0}, row_idx;
  for (std::size_t i = 0; i < 4; i++)
    for (std::size_t j = 0; j < 4; j++) {
      wide[7 * i + j] = STIFFNESS[i][j];
      complex[4 * i + j] = STIFFNESS[i][j];
      if (i >= j) lower[i + 4 * j] = STIFFNESS[i][j];
    }
  for (std::size_t j = 0; j < 4; j++) {
    for (std::size_t i = 0; i < 4; i++)
      if (STIFFNESS[i][j] != 0) values.push_back(STIFFNESS[i][j]), row_idx.push_back(static_cast<Index>(i));
    col_ptr.push_back(static_cast<Index>(values.size()));
  }
  same(STIFFNESS, "row after row");
  same({&STIFFNESS[0][0], 4, 4}, "column after column");
  same({wide.data(), 4, 4, HBVIB_COL_MAJOR, 7}, "with a leading dimension");
  same({wide.data(), 4, 4, HBVIB_ROW_MAJOR, 7}, "with a leading dimension, row-major");
  same({complex.data(), 4, 4}, "of complex numbers");
  same(hbvib::Matrix(lower.data(), 4, 4).as(HBVIB_LOWER), "of the lower triangle");
  same(hbvib::Matrix::csc(4, 4, values.data(), col_ptr.data(), row_idx.data()), "in sparse columns");
  same(Dense<double, false>{wide, 4, 7}, "of a class");
  same(Dense<Complex, true>{complex, 4, 4}, "of a complex row-major class");
  Sparse sparse{values, {col_ptr.begin(), col_ptr.end()}, {row_idx.begin(), row_idx.end()}, 4};
  same(sparse, "of a sparse class with int indices");
  for (auto& i : sparse.outer) i++;
  for (auto& i : sparse.inner) i++;
  same(hbvib::Matrix::csc(4, 4, values.data(), sparse.outer.data(), sparse.inner.data(), 1), "in sparse columns from 1");
  sparse.packed = false;  // its indices are not looked at
  refused("a sparse matrix that is not compressed", HBVIB_E_ARGUMENT, 0, "compressed", [&] { model.set_matrix(HBVIB_STIFFNESS, sparse); });

  // Without symmetry: the residual of a general stiffness is K x, in the order in which it was written.
  const double k[2][2] = {{3, 1}, {-2, 5}};
  const std::vector<double> by_columns = {3, -2, 1, 5};
  const Dense<double, false> dense{by_columns, 2, 2};
  auto plain = Model::plain(2);
  const double m[2][2] = {{1, 0}, {0, 1}};
  plain.set_matrix(HBVIB_MASS, m);
  for (const auto& a : {hbvib::Matrix(k), hbvib::Matrix(by_columns.data(), 2, 2), hbvib::Matrix(dense)}) {
    plain.set_matrix(HBVIB_STIFFNESS, a.as(HBVIB_GENERAL));
    SolverOptions s;
    s.tolerance = 0, s.harmonics = 1;
    const double w = 1.5;
    const std::vector<Complex> x = {0, 0, {1, 2}, {3, -1}};
    const auto found = plain.forced_residual(s, w, x, true);
    claim(std::abs(found.r[2] - (3.0 * x[2] + x[3] - w * w * x[2])) < 1e-14, "the first row of a general matrix");
    claim(std::abs(found.r[3] - (-2.0 * x[2] + 5.0 * x[3] - w * w * x[3])) < 1e-14, "the second row of a general matrix");
    claim(found.jacobian(4, 6) == 1 && found.jacobian(6, 4) == -2 && found.jacobian.shape(0) == 8, "the Jacobian's rows and columns");
    claim(std::abs(found.d_omega[3] + 2 * w * x[3]) < 1e-14, "the derivative by omega");
  }
}

void views() {
  auto model = ring_damper();
  auto branch = model.forced_response(options(), range());
  hbvib_view c;
  (void)hbvib_view_init(&c, sizeof c);
  claim(hbvib_branch_field(branch.get(), HBVIB_AMPLITUDE, &c) == HBVIB_OK, "the C interface has the field");
  const auto a = branch.field(HBVIB_AMPLITUDE), b = branch.field(HBVIB_AMPLITUDE);
  claim(a.data() == c.data && b.data() == c.data, "views are where hbvib_branch_field says, without copies");
  claim(a.rank() == 1 && a.shape(0) == branch.points() && a.size() == static_cast<std::size_t>(branch.points()), "one number a point");
  claim(*std::max_element(a.begin(), a.end()) == std::accumulate(a.begin(), a.end(), 0.0, [](double x, double y) { return std::max(x, y); }) &&
            a.end() - a.begin() == branch.points() && &a.begin()[3] == &a[3] && &a(3) == a.data() + 3 * a.stride(0),
        "views work with algorithms");
  const auto slip = branch.field(HBVIB_SLIP_FRACTION);
  claim(slip.rank() == 2 && slip.shape(0) == branch.points() && slip.shape(1) == 1, "slip is points x contacts");
  for (Index i = 0; i < branch.points(); i++)
    if (!claim(slip.at(i, 0) == branch.slip_fraction(i).at(0), "the slip of a point is that of the field")) break;
  try {
    slip.begin();
    claim(false, "a view of two dimensions has no iterators");
  } catch (const std::logic_error&) {
    claim(true, "a view of two dimensions has no iterators");
  }

  // A view owns its share: of the branch, or of what was computed.
  const std::vector<double> numbers(a.begin(), a.end());
  branch = Branch();
  claim(std::equal(a.begin(), a.end(), numbers.begin()), "a view outlives its branch");
  std::size_t count = 0;
  for (const double amplitude : model.forced_response(options(), range()).field(HBVIB_AMPLITUDE)) count += amplitude == numbers.at(count);
  claim(count == numbers.size(), "a loop over a field of a temporary");

  branch = model.forced_response(options(), range());
  const auto peak = branch.highest_peak();
  const auto x = branch.harmonics(peak.point);
  claim(x.shape(0) == 10 && x.shape(1) == NDOF && x.is_packed(), "harmonics x degrees of freedom");
  near(std::abs(x(1, B2)), peak.amplitude, 1e-12, "the fundamental is the amplitude");
  std::array<Complex, 20> two;
  branch.harmonics(peak.point, D, 2, two);
  for (Index h = 0; h < 10; h++)
    claim(two[static_cast<std::size_t>(2 * h)] == x(h, D) && two[static_cast<std::size_t>(2 * h + 1)] == x(h, R), "harmonics into an array of the caller");
  const auto r = branch.harmonics(peak.point, R);
  claim(r.shape(1) == 1 && r(1, 0) == x(1, R), "harmonics of the last degree of freedom");

  // Strides other than one.
  double grid[6] = {0, 1, 2, 3, 4, 5};
  const hbvib::View<double> column(grid + 1, 1, {3, 1, 1}, {2, 1, 1});
  claim(std::accumulate(column.begin(), column.end(), 0.0) == 9 && !column.is_packed(), "a view with a stride");
  refused("a view with a stride where numbers must be packed", HBVIB_E_ARGUMENT, 0, "one after the other", [&] { hbvib::Span<double> s(column); });
  const hbvib::View<double> turned(grid, 2, {2, 3, 1}, {1, 2, 1});
  claim(turned(1, 2) == 5 && turned(0, 1) == 2 && !turned.is_packed(), "a column-major view");
}

void wanted_and_guess() {
  auto model = ring_damper();
  const std::vector<double> at = {2 * PI * 208, 2 * PI * 210};
  const auto branch = model.forced_response(options(), range().wanted(at));
  for (Index i = 0; i < 2; i++) {
    const auto found = branch.at(i);
    if (!claim(found.size() == 1, "one solution at a wanted frequency")) continue;
    const auto x = branch.harmonics(found[0].point);
    near(std::abs(x(1, B2)), found[0].amplitude, 1e-12, "the amplitude at a wanted frequency");
    auto single = ForcedOptions(at[static_cast<std::size_t>(i)], at[static_cast<std::size_t>(i)]);
    const std::vector<Complex> guess(x.data(), x.data() + x.size());
    const auto again = model.forced_response(options(), single.start_from(guess));
    near(again.field(HBVIB_AMPLITUDE)[0], found[0].amplitude, 1e-9, "a point solved again from a guess");
    const auto residual = model.forced_residual(options(), at[static_cast<std::size_t>(i)], x);
    claim(residual.jacobian.empty() && residual.d_omega.empty() &&
              std::all_of(residual.r.begin(), residual.r.end(), [](Complex r) { return std::abs(r) < 1e-6; }), "a solution has no residual");
  }
}

}  // namespace

int main() {
  return verdict(60, [] {
    matrices();
    views();
    wanted_and_guess();
  });
}
