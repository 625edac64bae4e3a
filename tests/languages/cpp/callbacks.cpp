/* Row 110: progress, log and cancellation; exceptions of callbacks arrive whole, whatever is nested in what. */
#include "common.hpp"

#include <atomic>
#include <functional>
#include <memory>
#include <stdexcept>

namespace {

/// An exception that cannot be told by its base alone, with a place of its own.
struct Own : std::runtime_error {
  Own(int n, std::shared_ptr<int> k) : std::runtime_error("mine"), number(n), kept(std::move(k)) {}
  int number;
  std::shared_ptr<int> kept;
};

/// The call throws the very Own that was made with this place.
template <class F>
void throws_own(int number, const std::shared_ptr<int>& place, const std::string& what, F&& call) {
  try {
    call();
    claim(false, what + ": nothing was thrown");
  } catch (const Own& e) {
    claim(e.number == number && e.kept == place, what);
  } catch (const std::exception& e) {
    claim(false, what + ": another exception, " + e.what());
  }
}

void progress() {
  const auto model = ring_damper();
  const auto whole = model.forced_response(options(), range());
  claim(whole.complete() && whole.sentence().empty(), "a whole branch has nothing to say");

  Index calls = 0;
  double last = 0;
  const auto told = model.forced_response(options(), range(), {[&](const hbvib_progress& p) { calls++, last = p.fraction_done; }});
  claim(calls == whole.points() && last == 1 && bits(told) == bits(whole), "a hook that returns nothing sees every point and changes none");

  const auto part = model.forced_response(options(), range(), {[](const hbvib_progress& p) { return p.point == 5; }});
  claim(part.status() == HBVIB_STOPPED_BY_CALLER && !part.complete() && !part.sentence().empty(), "a hook that returns true stops the solve");
  claim(part.points() == 5 && part.points() < whole.points(), "the points found so far are there");
  for (Index i = 0; i < 5; i++) claim(part.field(HBVIB_OMEGA)[i] == whole.field(HBVIB_OMEGA)[i], "they are those of the whole branch");

  void (*nothing)(const hbvib_progress&) = nullptr;
  const std::function<void(const hbvib_progress&)> empty;
  claim(bits(model.forced_response(options(), range(), {nothing})) == bits(whole), "an empty pointer is no hook");
  claim(bits(model.forced_response(options(), range(), {empty})) == bits(whole), "an empty function is no hook");

  int lines = 0;
  hbvib::Hooks hooks;
  hooks.log = [&](hbvib_log_level level, const char* text) { lines += level >= HBVIB_LOG_WARN && level <= HBVIB_LOG_DEBUG && *text; };
  hooks.log_level = HBVIB_LOG_DEBUG;
  (void)model.forced_response(options(), range(), hooks);
  claim(lines > 0, "log lines arrive");

  std::atomic<std::int32_t> cancel{1};
  hooks = {};
  hooks.cancel = &cancel;
  const auto none = model.forced_response(options(), range(), hooks);
  claim(none.status() == HBVIB_STOPPED_BY_CALLER && none.points() == 0 && none.field(HBVIB_OMEGA).empty(), "the flag stops the solve before it begins");
  hbvib::TimeOptions time(2 * PI * 208);
  claim(model.time_response(time, hooks).status == HBVIB_STOPPED_BY_CALLER, "the flag stops the integration in time");
}

void thrown_by_hooks() {
  const auto model = ring_damper();
  const auto before = bits(model);
  const auto place = std::make_shared<int>();
  Branch partial;
  hbvib::Hooks hooks;
  hooks.partial = &partial;
  hooks.progress = [&](const hbvib_progress& p) {
    if (p.point == 7) throw Own(7, place);
  };
  throws_own(7, place, "an exception of the progress hook", [&] { (void)model.forced_response(options(), range(), hooks); });
  claim(partial && partial.points() == 7 && partial.status() == HBVIB_STOPPED_BY_CALLER, "its points are kept");
  claim(place.use_count() == 1 && bits(model) == before, "nothing holds the exception any more, and the model is as before");
}

void thrown_by_log() {
  const auto model = ring_damper();
  const auto place = std::make_shared<int>();
  Index points = 0;
  hbvib::Hooks hooks;
  hooks.log_level = HBVIB_LOG_DEBUG;
  hooks.log = [&](hbvib_log_level, const char*) { throw Own(3, place); };
  hooks.progress = [&](const hbvib_progress&) { points++; };
  throws_own(3, place, "an exception of the log", [&] { (void)model.forced_response(options(), range(), hooks); });
  claim(points <= 1, "it ends the solve at the next point");
  claim(place.use_count() == 1, "nothing holds it any more");

  // Every line counts, the last one too, whatever the solve has to say by then.
  Index lines = 0, last = -1;
  hooks.log = [&](hbvib_log_level, const char*) {
    if (lines++ == last) throw Own(4, place);
  };
  (void)model.forced_response(options(), range(), hooks);
  last = std::exchange(lines, 0) - 1;
  throws_own(4, place, "an exception at the last line of the log", [&] { (void)model.forced_response(options(), range(), hooks); });
}

// An exception that a callback catches is its own; one that it lets go ends the calls that led there, one by one.
void nested() {
  const auto model = ring_damper();
  const auto before = bits(model);
  const auto place = std::make_shared<int>();
  bool caught = false, inner = false;
  Branch partial;
  hbvib::Hooks throwing, outer;
  throwing.progress = [&](const hbvib_progress&) { throw Own(1, place); };
  outer.partial = &partial;
  outer.progress = [&](const hbvib_progress& p) {
    if (p.point == 2) {
      try {
        (void)model.forced_response(options(), range(), throwing);
      } catch (const Own& e) {
        caught = e.kept == place;
      }
      try {
        model.linear_modes(2, HBVIB_CONTACTS_STUCK, 99);
      } catch (const Error& e) {
        caught = caught && e.status() == HBVIB_E_DIMENSION;
      }
      inner = bits(model) == before;
    }
  };
  const auto branch = model.forced_response(options(), range(), outer);
  claim(caught && inner, "a callback solves, and catches what an inner callback throws");
  claim(branch.complete() && bits(branch) == before && !partial, "the outer solve does not notice");

  outer.progress = [&](const hbvib_progress& p) {
    if (p.point == 4) (void)model.forced_response(options(), range(), throwing);
  };
  throws_own(1, place, "an exception through two solves", [&] { (void)model.forced_response(options(), range(), outer); });
  claim(partial && partial.points() == 4, "the outer points are kept");
  outer.progress = [&](const hbvib_progress&) { model.linear_modes(0, HBVIB_CONTACTS_STUCK, 0); };
  refused("an Error that a callback lets go", HBVIB_E_DIMENSION, 4, "count = 0", [&] { (void)model.forced_response(options(), range(), outer); });

  const auto solved = model.forced_response(options(), range());
  throws_own(1, place, "an exception out of a check in time", [&] { model.verify(solved, 0, hbvib::VerifyOptions(), throwing); });
  throws_own(1, place, "an exception out of the integration in time", [&] { model.time_response(hbvib::TimeOptions(2 * PI * 208), throwing); });
  throwing.partial = &partial;
  throws_own(1, place, "an exception out of a nonlinear mode", [&] { (void)model.nonlinear_mode(options(), {-5, -3}, throwing); });
  claim(partial.points() == 1, "the point of the mode is kept");
  hbvib::SolverOptions bad = options();
  bad.harmonics = -1;
  refused("an Error of the solve itself", HBVIB_E_ARGUMENT, 2, "harmonics", [&] { (void)model.forced_response(bad, range(), throwing); });
  claim(partial.points() == 1 && bits(model) == before, "it touches neither branch nor model");
}

// A callback must not change a model in use, but may drop it: the solve keeps it alive.
void intruders() {
  auto model = ring_damper();
  const auto before = bits(model);
  hbvib::Hooks hooks;
  int busy = 0;
  hooks.progress = [&](const hbvib_progress&) {
    try {
      model.add_force(0, 1, 1);
    } catch (const Error& e) {
      busy += e.status() == HBVIB_E_BUSY;
    }
  };
  const auto branch = model.forced_response(options(), range(), hooks);
  claim(busy == branch.points() && bits(model) == before, "a model in use is not changed");
  const hbvib_model* const old = model.get();
  hooks.progress = [&](const hbvib_progress& p) {
    if (p.point == 3) model = Model::plain(1);
  };
  claim(bits(model.forced_response(options(), range(), hooks)) == before, "a model that its callback replaces is solved to the end");
  claim(model.dofs() == 1 && hbvib_model_dofs(old) == HBVIB_E_HANDLE, "and replaced, the old one being freed");
}

}  // namespace

int main() {
  return verdict(34, [] {
    progress();
    thrown_by_hooks();
    thrown_by_log();
    nested();
    intruders();
  });
}
