/* Batches of designs: peaks, failing designs, threads, branches, exceptions. */
#include "common.hpp"

int main() {
  return verdict(14, [] {
    const auto model = ring_damper();
    const std::vector<hbvib::Parameter> parameters = {hbvib::Parameter(HBVIB_PARAMETER_FORCE), hbvib::Parameter(HBVIB_PARAMETER_PRELOAD, 0)};
    const std::vector<double> values = {1, 300, 2, 600, 1, -1, 1, 100};
    hbvib::BatchOptions o(2 * PI * 200, 2 * PI * 215);
    o.keep = 1;
    auto batch = model.batch(options(), o, parameters, values);
    const auto peaks = batch.peaks();
    claim(batch.designs() == 4 && peaks.size() == 4, "as many peaks as designs");
    near(peaks[0].amplitude, 1.934880980e-3, 1e-7, "the amplitude of the reference");
    near(peaks[0].omega / (2 * PI), 208.0970308, 1e-8, "its frequency");
    near(peaks[1].amplitude / peaks[0].amplitude, 2, 1e-7, "force and normal load scale the motion");
    near(peaks[3].amplitude, 4.886556792e-3, 1e-7, "another reference");
    claim(peaks[2].status == HBVIB_E_ARGUMENT && std::isnan(peaks[2].amplitude), "a design that fails is told alone");
    claim(batch.sentence(2).find("preload = -1") != std::string::npos && batch.sentence(0).empty(), "with its sentence");
    o.threads = 3;
    const auto again = model.batch(options(), o, parameters, values).peaks();
    for (std::size_t i = 0; i < 2; i++) claim(again[i].amplitude == peaks[i].amplitude && again[i].omega == peaks[i].omega, "threads change no bit");
    const auto branch = batch.take_branch(0);
    claim(branch.highest_peak().amplitude == peaks[0].amplitude && branch.points() == peaks[0].points, "a branch has the peak");
    refused("a branch twice", HBVIB_E_ARGUMENT, 2, "taken before", [&] { batch.take_branch(0); });
    refused("half a design", HBVIB_E_DIMENSION, 8, "multiple", [&] { model.batch(options(), o, parameters, {1.0}); });
    refused("no range", HBVIB_E_ARGUMENT, 3, "omega_start", [&] { model.batch(options(), {}, parameters, values); });
    // The thread of the call reports what it solved; others might leave it nothing.
    o.threads = 1;
    hbvib::Hooks hooks;
    hooks.progress = [](const hbvib_progress&) { throw std::runtime_error("mine"); };
    try {
      model.batch(options(), o, parameters, values, hooks);
      claim(false, "an exception is lost");
    } catch (const std::runtime_error& e) {
      claim(std::string(e.what()) == "mine", "an exception of a hook leaves the call");
    }
  });
}
