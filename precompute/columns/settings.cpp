#include "precompute/columns/settings.hpp"

#include <sstream>

namespace irdm::precompute {

std::string settings_text(const PrecomputeConfig& config, const std::vector<int>& clamped) {
  std::ostringstream text;
  text.precision(17);
  const bool stepping = config.response.method == Method::kTimeStepping;
  text << "method " << (stepping ? "time-stepping" : "modal") << "\nclamped";
  for (const int node : clamped) text << ' ' << node;
  text << '\n';
  if (!stepping) return text.str();
  const TimeSteppingConfig& steps = config.time_stepping;
  text << "model " << (steps.model == Elasticity::kLinear ? "linear" : "corotational")
       << "\nfirst_step " << steps.first_step << "\nlast_step " << steps.last_step << "\nhold "
       << steps.hold << "\nforce " << steps.force << "\nrotation_weights "
       << (steps.rotation_weights == RotationWeights::kMass ? "mass" : "none") << '\n';
  return text.str();
}

}  // namespace irdm::precompute
