#include "device_bridge/stylus_script.hpp"

#include <cmath>
#include <sstream>

#include "common/error.hpp"
#include "tests/fuzz/harness.hpp"

namespace irdm::fuzz {

void stylus_script(Input input) {
  std::istringstream text{std::string(text_of(input))};
  try {
    const StylusScript script = StylusScript::parse(text, "it.csv");
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
