/* Results as a value or an error, without exceptions in the caller. */
#include "common.hpp"

int main() {
  return verdict(9, [] {
    const auto model = oscillator(1, 0.02, 1, 0.1);
    auto range = ForcedOptions();
    range.omega_start = 0.8;
    range.omega_stop = 1.6;
    auto found = hbvib::attempt([&] { return model.forced_response({}, range); });
    claim(found.has_value() && found, "a solve has a value");
    claim(found->points() > 2 && (*found).points() == found.value().points(), "the value is the branch");
    range.omega_stop = -1;
    auto refused = hbvib::attempt([&] { return model.forced_response({}, range); });
    claim(!refused, "a range below zero has none");
    claim(refused.error().status() == HBVIB_E_ARGUMENT, "its error has the status");
    claim(std::string(refused.error().what()).find("omega_stop") != std::string::npos, "and the sentence");
    bool threw = false;
    try {
      refused.value();
    } catch (const Error& error) {
      threw = error.status() == HBVIB_E_ARGUMENT;
    }
    claim(threw, "value throws the error");
    auto changed = model.clone();
    claim(hbvib::attempt([&] { changed.add_force(0, 1, 1.0); }).has_value(), "a call without result has a value");
    claim(!hbvib::attempt([&] { changed.add_force(7, 1, 1.0); }), "and an error");
    claim(hbvib::attempt([&] { return changed.dofs(); }).value_or(0) == 1, "value_or");
  });
}
