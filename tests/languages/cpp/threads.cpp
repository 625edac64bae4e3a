/* Threads that solve one model at once, or ask one branch, find the bits of the serial run; each has its
 * own errors and exceptions. */
#include "common.hpp"

#include <atomic>
#include <stdexcept>
#include <thread>

namespace {

template <class F>
void at_once(int count, F&& work) {
  std::vector<std::thread> threads;
  for (int i = 0; i < count; i++) threads.emplace_back([&, i] { work(i); });
  for (auto& t : threads) t.join();
}

void test() {
  const auto model = ring_damper();
  const auto branch = model.forced_response(options(), range());
  const auto serial = bits(branch);
  std::atomic<int> same{0}, own{0}, told{0};
  at_once(8, [&](int i) {
    for (int k = 0; k < 4; k++) {
      same += bits(model) == serial;
      same += bits(branch) == serial;
      same += bits(model.clone()) == serial;
      try {
        model.linear_modes(2, HBVIB_CONTACTS_STUCK, 100 + i);
      } catch (const Error& e) {
        own += std::string(e.what()).find(std::to_string(100 + i)) != std::string::npos;
      }
      try {
        (void)model.forced_response(options(), range(), {[i](const hbvib_progress& p) {
                                if (p.point == i + 1) throw std::runtime_error(std::to_string(i));
                              }});
      } catch (const std::runtime_error& e) {
        told += e.what() == std::to_string(i);
      }
    }
  });
  claim(same == 96, "threads on one model find the bits of the serial run");
  claim(own == 32, "each thread has its own errors");
  claim(told == 32, "each thread has its own exceptions");

  // One force of the caller, asked by all of them.
  auto oscillator_ = oscillator(1, 0.05, 1, 0.2);
  std::atomic<Index> calls{0};
  oscillator_.add_user_force({{0}, [&](const hbvib::ForceCall& c) {
                                calls++;
                                for (Index j = 0; j < c.samples; j++) {
                                  c.f(j, 0) = std::pow(c.u(j, 0), 3);
                                  c.df_du(j, 0, 0) = 3 * std::pow(c.u(j, 0), 2);
                                }
                              }});
  const auto& shared = oscillator_;
  const ForcedOptions wide(0.5, 3.0);
  const auto once = bits(shared.forced_response({}, wide));
  const Index needed = calls;
  same = 0;
  at_once(8, [&](int) { same += bits(shared.forced_response({}, wide)) == once; });
  claim(same == 8 && calls == 9 * needed, "threads share a force of the caller");

  // Views and branches may be dropped by any thread.
  auto view = std::make_unique<hbvib::View<const double>>(branch.field(HBVIB_OMEGA));
  const double first = serial.front();
  std::atomic<int> seen{0};
  at_once(8, [&](int) {
    const auto copy = *view;
    seen += copy[0] == first && branch.field(HBVIB_OMEGA).data() == copy.data();
  });
  claim(seen == 8, "threads share a view");
}

}  // namespace

int main() { return verdict(5, test); }
