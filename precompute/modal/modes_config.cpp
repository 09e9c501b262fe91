#include "precompute/modal/modes_config.hpp"

#include <map>

#include "common/config/range.hpp"

namespace irdm::precompute {
namespace {

constexpr int kMostModes = 20'000;

ModeSolver solver_from_word(const std::string& word) {
  static const std::map<std::string, ModeSolver> words{
      {"spectra", ModeSolver::kSpectra},
      {"slepc", ModeSolver::kSlepc},
      {"slepc-multigrid", ModeSolver::kSlepcMultigrid}};
  return words.at(word);
}

}  // namespace

ModesConfig read_modes(TomlTable table) {
  ModesConfig modes;
  if (table.has("count") + table.has("highest_frequency") + table.has("error") > 1) {
    table.fail("", "has more than one of count, highest_frequency and error",
               "choose one, or none for all modes");
  }
  if (table.has("count")) modes.count = table.integer("count", 1, kMostModes, 1);
  if (table.has("highest_frequency")) {
    modes.highest_frequency = table.number("highest_frequency", lab::kFrequency);
  }
  if (table.has("error")) modes.error = table.number("error", between(1e-4, 0.5));
  for (const char* key : {"contact_radius", "solver"}) {
    if (table.has(key) && modes.all()) {
      table.fail(key, "is there but all modes are asked for",
                 "give one of count, highest_frequency and error, or leave it out");
    }
  }
  modes.contact_radius = table.number("contact_radius", lab::kLength, modes.contact_radius);
  modes.solver =
      solver_from_word(table.choice("solver", {"spectra", "slepc", "slepc-multigrid"}, "spectra"));
  table.finish();
  return modes;
}

}  // namespace irdm::precompute
