/* Misuse gives an Error with the library's sentence, and leaves the model as it was. */
#include "common.hpp"

#include <limits>

namespace {

// No number but double and std::complex<double> is taken, so that a wrong type does not compile.
static_assert(!std::is_constructible_v<hbvib::Matrix, const float*, Index, Index>, "float is no matrix");
static_assert(!std::is_constructible_v<hbvib::Matrix, const int (&)[2][2]>, "int is no matrix");
static_assert(!std::is_constructible_v<hbvib::In<double>, std::vector<float>>, "float is no array of double");
static_assert(!std::is_constructible_v<hbvib::In<Index>, std::vector<std::int32_t>>, "int32 is no array of int64");
static_assert(!std::is_constructible_v<hbvib::Span<const double>, std::vector<double>>, "options keep no temporaries");
static_assert(!std::is_constructible_v<hbvib::Span<double>, const std::vector<double>&>, "const is not written to");
static_assert(!std::is_copy_constructible_v<Model> && !std::is_copy_assignable_v<Branch>, "handles are not copied");
static_assert(std::is_nothrow_move_constructible_v<Model> && std::is_nothrow_move_assignable_v<Branch>, "handles move");
static_assert(std::is_nothrow_destructible_v<Model> && std::is_nothrow_destructible_v<Branch>, "destructors never throw");

// A dense class as Eigen has them: column-major, with strides.
struct Dense {
  enum { IsRowMajor = 0 };
  std::vector<double> numbers;
  Index n, inner, outer;
  const double* data() const { return numbers.data(); }
  Index rows() const { return n; }
  Index cols() const { return n; }
  Index size() const { return n * n; }
  Index innerStride() const { return inner; }
  Index outerStride() const { return outer; }
};

void test() {
  auto model = ring_damper();
  const auto solved = model.forced_response(options(), range());
  const auto before = bits(solved);
  const Index n = model.contacts();
  auto same = [&](const char* after) { claim(model.contacts() == n && bits(model) == before, std::string("the model is as before after ") + after); };

  const double three[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, skew[4][4] = {{1, 2}, {3, 4}, {0, 0, 1}, {0, 0, 0, 1}};
  refused("a matrix of wrong shape", HBVIB_E_DIMENSION, 3, "3", [&] { model.set_matrix(HBVIB_MASS, three); });
  same("a matrix of wrong shape");
  refused("a mass without symmetry", HBVIB_E_NOT_HERMITIAN, 3, "", [&] { model.set_matrix(HBVIB_MASS, skew); });
  same("a mass without symmetry");
  const Dense gaps{std::vector<double>(64), 4, 2, 8}, padded{std::vector<double>(64), 4, 1, 8};
  refused("a matrix with gaps", HBVIB_E_ARGUMENT, 0, "adjacent", [&] { model.set_matrix(HBVIB_MASS, gaps); });
  refused("an array with gaps", HBVIB_E_ARGUMENT, 0, "one after the other", [&] { model.add_table(0, 1, 0, padded, {1.0}); });
  same("matrices with gaps");
  const std::vector<double> nan(16, std::numeric_limits<double>::quiet_NaN());
  refused("NaN in a matrix", HBVIB_E_NOT_FINITE, 3, "", [&] { model.set_matrix(HBVIB_STIFFNESS, {nan.data(), 4, 4}); });
  same("NaN in a matrix");

  refused("a degree of freedom out of range", HBVIB_E_INDEX, 2, "dof = 4", [&] { model.add_force(4, 1, 1); });
  same("a degree of freedom out of range");
  refused("a contact out of range", HBVIB_E_INDEX, 2, "7", [&] { model.set_preload(7, 1); });
  refused("a contact on no degree of freedom", HBVIB_E_INDEX, 2, "dof_a", [&] { model.add_contact(Contact::jenkins(9, 0, 1, 1, 1)); });
  same("contacts out of range");
  refused("arrays of unlike lengths", HBVIB_E_DIMENSION, 6, "kt has 1 entries, needs 2",
          [&] { model.add_jenkins({0, 1}, {2, 3}, {}, {1.0}, {1.0, 1.0}, {1.0, 1.0}); });
  refused("a table of unlike lengths", HBVIB_E_DIMENSION, 7, "force", [&] { model.add_table(0, 1, 0, {0.0, 1.0}, {0.0}); });
  refused("a patch of unlike lengths", HBVIB_E_DIMENSION, 4, "needs 3",
          [&] { model.add_patch(Contact(HBVIB_JENKINS), {0, 1}, {}, {0.0, 0.0, 1.0}, {}, {1.0}); });
  refused("tensors of unlike lengths", HBVIB_E_DIMENSION, 5, "needs 16", [&] { model.add_stiffness_tensors({0, 1}, {}, {1.0}); });
  same("arrays of unlike lengths");
  refused("a force without a callback", HBVIB_E_NULL, 2, "force", [&] { model.add_user_force({{0}, {}}); });
  same("a force without a callback");

  SolverOptions bad = options();
  bad.harmonics = -1;
  refused("harmonics below 0", HBVIB_E_ARGUMENT, 2, "harmonics = -1", [&] { (void)model.forced_response(bad, range()); });
  const std::vector<Complex> guess(5);
  refused("a guess of wrong length", HBVIB_E_DIMENSION, 3, "guess", [&] { (void)model.forced_response(options(), range().start_from(guess)); });
  const std::vector<double> outside = {1};
  refused("a wanted frequency out of range", HBVIB_E_ARGUMENT, 3, "at", [&] { (void)model.forced_response(options(), range().wanted(outside)); });
  refused("more modes than there are", HBVIB_E_DIMENSION, 4, "count", [&] { model.linear_modes(2, HBVIB_CONTACTS_STUCK, 5); });
  refused("modes below 1", HBVIB_E_DIMENSION, 4, "count", [&] { model.linear_modes(2, HBVIB_CONTACTS_STUCK, -1); });
  hbvib::TimeOptions time(1300);
  time.harmonics = -1;
  refused("a time response of no harmonics", HBVIB_E_ARGUMENT, 2, "harmonics = -1", [&] { model.time_response(time); });
  same("options out of range");

  refused("a point out of range", HBVIB_E_INDEX, 2, "point = 100000", [&] { solved.harmonics(100000); });
  refused("degrees of freedom out of range", HBVIB_E_INDEX, 3, "first_dof = 4", [&] { solved.harmonics(0, 4); });
  refused("more degrees of freedom than there are", HBVIB_E_DIMENSION, 4, "n_dof = 5", [&] { solved.harmonics(0, 0, 5); });
  std::vector<Complex> little(3);
  refused("an array that is too short", HBVIB_E_DIMENSION, 6, "40", [&] { solved.harmonics(0, 0, NDOF, little); });
  refused("a check of a point out of range", HBVIB_E_INDEX, 3, "point = 100000", [&] { model.verify(solved, 100000); });
  hbvib::VerifyOptions check;
  check.same_within = 0;
  refused("a check of no distance", HBVIB_E_ARGUMENT, 4, "same_within = 0", [&] { model.verify(solved, 0, check); });
  refused("no times", HBVIB_E_DIMENSION, 4, "n = 0", [&] { solved.time_history(0, 0, 0); });
  refused("times below 0", HBVIB_E_DIMENSION, 5, "n = -3", [&] { solved.contact_loop(0, 0, 0, -3); });
  refused("a field of modes of a forced response", HBVIB_E_ARGUMENT, 2, "", [&] { solved.field(HBVIB_DAMPING_RATIO); });
  refused("a mode point of a forced response", HBVIB_E_UNSUPPORTED, 1, "", [&] { solved.mode_point(0); });
  refused("an index below 1 of those that count from 1", HBVIB_E_INDEX, 2, "dof = 0, needs 1 .. 4", [] { hbvib::index_from_one("dof", 0, 4); });
  claim(hbvib::index_from_one("dof", 4, 4) == 3, "an index from 1 becomes one from 0");
  claim(std::string(Error(HBVIB_E_BUSY, 0, "").status_name()) == "HBVIB_E_BUSY", "a status has its name");
  try {
    solved.field(HBVIB_OMEGA).at(solved.points());
    claim(false, "a view refuses an index out of range");
  } catch (const std::out_of_range&) {
    claim(true, "a view refuses an index out of range");
  }
  claim(bits(solved) == before, "the branch is as before");
  same("all of that");

  // Objects that were moved from say so, whatever they are asked; a new value makes them good again.
  Model other = std::move(model);
  claim(!model && other, "a moved-from model has no handle");
  refused("dofs of a moved-from model", HBVIB_E_HANDLE, 1, "model", [&] { model.dofs(); });
  refused("a clone of a moved-from model", HBVIB_E_HANDLE, 1, "model", [&] { model.clone(); });
  refused("a matrix for a moved-from model", HBVIB_E_HANDLE, 1, "model", [&] { model.set_matrix(HBVIB_MASS, MASS); });
  refused("a force of the caller on a moved-from model", HBVIB_E_HANDLE, 1, "model", [&] { model.add_user_force({{0}, [](const auto&) {}}); });
  refused("a solve of a moved-from model", HBVIB_E_HANDLE, 1, "model", [&] { (void)model.forced_response(options(), range()); });
  refused("a response in time of a moved-from model", HBVIB_E_HANDLE, 1, "model", [&] { model.time_response(time); });
  refused("modes of a moved-from model", HBVIB_E_HANDLE, 1, "model", [&] { model.linear_modes(0, HBVIB_CONTACTS_FREE, 1); });
  model = std::move(other);
  same("moving there and back");
  Branch a = model.forced_response(options(), range()), b = std::move(a);
  refused("points of a moved-from branch", HBVIB_E_HANDLE, 1, "branch", [&] { a.points(); });
  refused("a field of a moved-from branch", HBVIB_E_HANDLE, 1, "branch", [&] { a.field(HBVIB_OMEGA); });
  refused("harmonics of a moved-from branch", HBVIB_E_HANDLE, 1, "branch", [&] { a.harmonics(0); });
  refused("peaks of a moved-from branch", HBVIB_E_HANDLE, 1, "branch", [&] { a.peaks(); });
  refused("a check of a moved-from branch", HBVIB_E_HANDLE, 1, "branch", [&] { model.verify(a, 0); });
  refused("the status of a branch that never was", HBVIB_E_HANDLE, 1, "branch", [&] { (void)Branch().status(); });
  claim(bits(b) == before, "a branch that was moved has the same bits");
  const hbvib_branch* const raw = b.get();
  b = Branch();
  claim(hbvib_branch_points(raw) == HBVIB_E_HANDLE, "a branch that is dropped is freed");
  same("moved-from branches");
}

}  // namespace

int main() { return verdict(59, test); }
