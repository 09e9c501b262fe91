#include "precompute/modal/modes_config.hpp"

namespace irdm::precompute {
namespace {

constexpr int kMostModes = 20'000;

}  // namespace

ModesConfig read_modes(TomlTable table) {
  ModesConfig modes;
  if (table.has("count") + table.has("highest_frequency") + table.has("error") > 1) {
    table.fail("", "has more than one of count, highest_frequency and error",
               "choose one, or none for all modes");
  }
  if (table.has("count")) modes.count = table.integer("count", 1, kMostModes, 1);
  if (table.has("highest_frequency")) {
    modes.highest_frequency = table.number("highest_frequency", above(0));
  }
  if (table.has("error")) modes.error = table.number("error", between(1e-4, 0.5));
  if (table.has("contact_radius") && modes.all()) {
    table.fail("contact_radius", "is there but all modes are asked for",
               "give one of count, highest_frequency and error, or leave it out");
  }
  modes.contact_radius = table.number("contact_radius", above(0), modes.contact_radius);
  table.finish();
  return modes;
}

}  // namespace irdm::precompute
