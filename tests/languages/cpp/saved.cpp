/* Saved models: the same bits from the bytes of a model, and what is refused. */
#include "common.hpp"

int main() {
  return verdict(8, [] {
    const auto model = ring_damper();
    auto bytes = model.save();
    const auto loaded = Model::load(bytes);
    claim(loaded.dofs() == 4 && loaded.sectors() == 24 && loaded.contacts() == 1, "the size of a loaded model");
    claim(bits(loaded) == bits(model), "a loaded model solves to the same bits");
    claim(loaded.save() == bytes, "and is saved as the same bytes");
    refused("no bytes", HBVIB_E_ARGUMENT, 2, "mark", [] { Model::load({}); });
    refused("half a model", HBVIB_E_ARGUMENT, 2, "incomplete",
            [&] { Model::load(std::vector<unsigned char>(bytes.begin(), bytes.begin() + 100)); });
    bytes[80] = static_cast<unsigned char>(~bytes[80]);
    refused("damage", HBVIB_E_ARGUMENT, 2, "checksum", [&] { Model::load(bytes); });
    bytes[8] = 9;
    refused("a newer format", HBVIB_E_UNSUPPORTED, 2, "newer", [&] { Model::load(bytes); });
    auto forced = oscillator(1, 0.02, 1, 0.1);
    forced.add_user_force({{0}, [](const hbvib::ForceCall&) {}});
    refused("a user force", HBVIB_E_UNSUPPORTED, 1, "contact 0: a force of the caller", [&] { forced.save(); });
  });
}
