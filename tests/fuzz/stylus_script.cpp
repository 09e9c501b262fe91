#include "device_bridge/stylus_script.hpp"

#include <cmath>
#include <filesystem>

#include "common/error.hpp"
#include "tests/fuzz/harness.hpp"
#include "tests/fuzz/scratch_file.hpp"

namespace irdm::fuzz {

// Without any text there is no file.
void stylus_script(Input input) {
  const std::filesystem::path path = scratch_file("it.csv", text_of(input));
  if (input.empty()) std::filesystem::remove(path);
  try {
    const StylusScript script = StylusScript::load(path);
    constexpr int kParts = 16;
    for (int i = -1; i <= kParts + 1; ++i) {
      const double share = static_cast<double>(i) / kParts;
      const StylusPose pose = script.at((1.0 - share) * script.start() + share * script.end());
      expect(pose.tip.allFinite(), "a tip is finite");
      expect(std::abs(pose.orientation.norm() - 1.0) < 1e-9, "an orientation has norm 1");
    }
  } catch (const Error&) {
  }
}

}  // namespace irdm::fuzz
