/* Forces of the caller: equal to the library's own, shared by all that need them, and free to throw. */
#include "common.hpp"

#include <memory>
#include <stdexcept>

namespace {

const double KT = 0.3, K3 = 0.7;

/// f = KT y + K3 y^3; what it counts, and when it fails, is held outside.
struct Told {
  Index calls = 0, throw_at = -1, give_up_at = -1;
};
hbvib::UserForce duffing(const std::shared_ptr<Told>& told) {
  hbvib::UserForce force{{0}, [told](const hbvib::ForceCall& c) -> std::int32_t {
                           const Index call = told->calls++;
                           if (call == told->throw_at) throw std::out_of_range("the spring broke");
                           if (call == told->give_up_at) return -42;
                           for (Index j = 0; j < c.samples; j++) {
                             const double y = c.u(j, 0);
                             c.f(j, 0) = KT * y + K3 * y * y * y;
                             c.df_du(j, 0, 0) = KT + 3 * K3 * y * y;
                           }
                           return 0;
                         }};
  force.is_odd = true;
  return force;
}

Model duffing_model(const std::shared_ptr<Told>& told) {
  auto model = oscillator(1, 0.05, 1, 0.2);
  model.add_user_force(duffing(told));
  return model;
}

const ForcedOptions RANGE(0.8, 2.2);
SolverOptions seven() {
  SolverOptions s;
  s.tolerance = 0, s.harmonics = 7;
  return s;
}

template <class F>
void broke(const std::string& what, F&& call) {
  try {
    call();
    claim(false, what + ": nothing was thrown");
  } catch (const std::out_of_range& e) {
    claim(std::string(e.what()) == "the spring broke", what);
  } catch (const std::exception& e) {
    claim(false, what + ": another exception, " + e.what());
  }
}

void same_as_cubic() {
  auto told = std::make_shared<Told>();
  auto own = duffing_model(told), library = oscillator(1, 0.05, 1, 0.2);
  library.add_contact(Contact::cubic_spring(0, HBVIB_GROUND, KT, K3));
  claim(told->calls == 0, "a force is not called before it is needed");
  claim(own.check_jacobian(0, 1.2, {0.8}).gap < 1e-6, "its derivatives are right");
  std::vector<double> at;
  for (double omega = 0.9; omega < 2.2; omega += 0.1) at.push_back(omega);
  auto range = RANGE;
  const auto a = own.forced_response(seven(), range.wanted(at)), b = library.forced_response(seven(), range);
  claim(a.complete() && b.complete() && told->calls > 20, "both branches are whole");
  claim(a.peaks().size() == 1 && b.peaks().size() == 1, "both have one peak");
  near(a.highest_peak().omega, b.highest_peak().omega, 1e-10, "the peak's frequency is HBVIB_CUBIC's");
  near(a.highest_peak().amplitude, b.highest_peak().amplitude, 1e-10, "the peak's amplitude is HBVIB_CUBIC's");
  Index several = 0;
  for (Index i = 0; i < static_cast<Index>(at.size()); i++) {
    const auto x = a.at(i), y = b.at(i);
    several += x.size() > 1;
    if (!claim(x.size() == y.size() && !x.empty(), "as many solutions as with HBVIB_CUBIC")) continue;
    for (std::size_t k = 0; k < x.size(); k++) near(x[k].amplitude, y[k].amplitude, 1e-10, "the response is HBVIB_CUBIC's");
  }
  claim(several > 0, "the response bends over");
  const auto folds = a.folds(), others = b.folds();
  if (claim(folds.size() == 2 && others.size() == 2, "it has two folds"))
    for (std::size_t k = 0; k < 2; k++) near(folds[k].omega, others[k].omega, 1e-9, "the folds are HBVIB_CUBIC's");
}

// The force lives as long as any model, copy or branch that may call it, and not longer.
void ownership() {
  auto told = std::make_shared<Told>();
  std::weak_ptr<Told> alive = told;
  Branch branch;
  {
    auto model = duffing_model(told);
    told.reset();
    const Model copy = model.clone();
    model = Model::plain(1);
    if (claim(!alive.expired(), "a clone has the force of a model that is gone")) branch = copy.forced_response(seven(), RANGE);
  }
  claim(!alive.expired(), "a branch keeps its force");
  const Index calls = alive.lock()->calls;
  const auto x = branch.harmonics(0);
  claim(alive.lock()->calls > calls && std::abs(x(1, 0)) > 0, "and calls it again for its results");
  branch = Branch();
  claim(alive.expired(), "the last of them lets it go");
  told = std::make_shared<Told>();
  alive = told;
  const auto force = duffing(std::exchange(told, nullptr));
  auto model = oscillator(1, 0.05, 1, 0.2);
  auto elsewhere = force;
  elsewhere.dofs = {5};
  refused("a force on no degree of freedom", HBVIB_E_INDEX, 2, "5", [&] { model.add_user_force(elsewhere); });
  elsewhere = {};
  claim(alive.use_count() == 1 && model.contacts() == 0, "a force that was refused is not kept");
}

void failures_of_it() {
  auto told = std::make_shared<Told>();
  const auto model = duffing_model(told);
  const auto whole = model.forced_response(seven(), RANGE);
  const Index all = told->calls;
  hbvib::Hooks hooks;
  Branch partial;
  hooks.partial = &partial;

  *told = {0, 0};
  broke("an exception at the first call", [&] { (void)model.forced_response(seven(), RANGE, hooks); });
  claim(!partial && told->calls == 1, "leaves no branch, and ends the solve at once");
  *told = {0, all / 2};
  broke("an exception half the way", [&] { (void)model.forced_response(seven(), RANGE, hooks); });
  claim(told->calls == all / 2 + 1, "ends the solve at once");
  if (claim(static_cast<bool>(partial), "leaves the points found"))
    claim(partial.status() == HBVIB_STOPPED_CALLBACK && partial.points() > 0 && partial.points() < whole.points(), "fewer than all of them");

  // Wherever the force is called the first exception comes out, in the checks of sampling too.
  Index out = 0, step = std::max<Index>(all / 40, 1), tries = 0;
  for (Index at = 0; at < all; at += step) {
    *told = {0, at};
    tries++;
    try {
      (void)model.forced_response(seven(), RANGE);
    } catch (const std::out_of_range&) {
      out++;
    }
  }
  claim(out == tries && tries >= 40, "an exception at any call comes out");

  *told = {0, -1, all / 2};
  const auto stopped = model.forced_response(seven(), RANGE);
  claim(stopped.status() == HBVIB_STOPPED_CALLBACK && stopped.sentence().find("-42") != std::string::npos, "a code stops the solve, and is told");
  *told = {0, -1, 0};
  refused("a code at the first call", HBVIB_E_CALLBACK, 0, "-42", [&] { (void)model.forced_response(seven(), RANGE); });

  auto fails_next = [&](const char* what, auto&& call) {
    *told = {0, 0};
    broke(what, call);
    *told = {};
    call();
  };
  fails_next("harmonics", [&] { whole.harmonics(3); });
  fails_next("a time history", [&] { whole.time_history(3, 0, 32); });
  fails_next("a contact loop", [&] { whole.contact_loop(3, 0, 0, 32); });
  fails_next("a residual", [&] { model.forced_residual(seven(), 1, std::vector<Complex>(8)); });
  fails_next("a check of derivatives", [&] { model.check_jacobian(0, 1, {1.0}); });
  fails_next("a response in time", [&] { model.time_response(hbvib::TimeOptions(1.0)); });
  claim(bits(model.forced_response(seven(), RANGE)) == bits(whole), "the model solves to the same bits after all that");

  // A force may call the library, and what that throws goes through both.
  auto busy = oscillator(1, 0.05, 1, 0.2);
  busy.add_user_force({{0}, [&](const hbvib::ForceCall&) { (void)model.forced_response(seven(), RANGE); }});
  *told = {0, 10};
  broke("an exception of a force within a force", [&] { (void)busy.forced_response(seven(), RANGE); });

  // Through the C interface an exception goes nowhere, but the force has failed.
  *told = {0, 0};
  hbvib_branch* branch = nullptr;
  claim(hbvib_forced_response(model.get(), nullptr, &RANGE, nullptr, &branch) == HBVIB_E_CALLBACK, "a plain C call sees HBVIB_E_CALLBACK");
  hbvib_status inner = HBVIB_OK;
  const auto calls_c = [&](const hbvib_progress&) { *told = {0, 0}, inner = hbvib_forced_response(model.get(), nullptr, &RANGE, nullptr, &branch); };
  auto other = Model::plain(1);
  const double one[1][1] = {{1}};
  other.set_matrix(HBVIB_MASS, one);
  other.set_matrix(HBVIB_STIFFNESS, one);
  other.set_rayleigh(0, 0.1);
  other.add_force(0, 1, 1);
  claim(other.forced_response({}, RANGE, {calls_c}).complete() && inner == HBVIB_E_CALLBACK, "so does one within a callback, which goes on");
}

// A force with a state: Jenkins' element marched from sample to sample, against the library's.
void with_states() {
  const double kt = 1, limit = 0.3;
  auto own = oscillator(1, 0.02, 1, 0.3), library = oscillator(1, 0.02, 1, 0.3);
  bool broken = false;
  hbvib::UserForce force{{0}, [&broken, kt, limit](const hbvib::ForceCall& c) {
                           if (broken) throw std::out_of_range("the spring broke");
                           for (Index j = 0; j < c.samples; j++) {
                             const double before = j ? c.z(j - 1, 0) : c.z0(0), from = c.u(j ? j - 1 : c.samples - 1, 0);
                             const double trial = before + kt * (c.u(j, 0) - from);
                             const bool sticks = std::fabs(trial) <= limit;
                             c.z(j, 0) = sticks ? trial : std::copysign(limit, trial);
                             c.dz_dz(j, 0, 0) = sticks;
                             c.dz_du(j, 0, 0) = sticks ? kt : 0;
                             c.dz_du_before(j, 0, 0) = sticks ? -kt : 0;
                             c.f(j, 0) = c.z(j, 0);
                             c.df_dz(j, 0, 0) = 1;
                           }
                         }};
  force.states = 1;
  force.samples = 4096;
  own.add_user_force(force);
  library.add_contact(Contact::jenkins(0, HBVIB_GROUND, kt, 0.3, 1));
  const ForcedOptions range(0.9, 1.6);
  const auto branch = own.forced_response(seven(), range);
  const auto a = branch.highest_peak(), b = library.forced_response(seven(), range).highest_peak();
  near(a.amplitude, b.amplitude, 1e-4, "a friction element with 4096 samples moves as HBVIB_JENKINS does");
  near(branch.contact_summary(a.point, 0).work, branch.energy(a.point).friction_loss, 1e-6, "its work is the loss by friction");
  broken = true;
  broke("a summary", [&] { branch.contact_summary(a.point, 0); });
  broke("an energy", [&] { branch.energy(a.point); });
}

}  // namespace

int main() {
  return verdict(65, [] {
    same_as_cubic();
    ownership();
    failures_of_it();
    with_states();
  });
}
