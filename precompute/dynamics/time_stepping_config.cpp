#include "precompute/dynamics/time_stepping_config.hpp"

#include <algorithm>
#include <cmath>

#include "common/config/range.hpp"

namespace irdm::precompute {
namespace {

constexpr double kDefaultFirstStep = 1e-4;
constexpr double kTargetStrain = 1e-4;
constexpr int kMaxStepsPerInterval = 100'000;
constexpr int kMaxHold = 1'000'000;
// What decimal numbers in a file may miss of dividing dt.
constexpr double kDivides = 1e-6;

double read_step(TomlTable& table, const std::string& key, double dt) {
  const double step = table.number(key, above(0));
  const double count = dt / step;
  if (step > dt * (1.0 + kDivides)) {
    table.fail(key, "is longer than response.dt", "make it dt over a whole number");
  }
  if (count > kMaxStepsPerInterval) {
    table.fail(key, "is too short: more than 100 000 steps in response.dt", "make it longer");
  }
  if (std::abs(count - std::round(count)) > kDivides * count) {
    table.fail(key, "does not divide response.dt", "make it dt over a whole number");
  }
  return dt / std::round(count);
}

}  // namespace

TimeSteppingConfig read_time_stepping(TomlTable table, double dt) {
  TimeSteppingConfig config;
  config.model = table.choice("model", {"corotational", "linear"}, "corotational") == "linear"
                     ? Elasticity::kLinear
                     : Elasticity::kCorotational;
  const double default_first = dt / std::ceil(dt / kDefaultFirstStep * (1.0 - kDivides));
  config.first_step = table.has("first_step") ? read_step(table, "first_step", dt) : default_first;
  config.last_step = table.has("last_step") ? read_step(table, "last_step", dt) : dt;
  if (config.last_step < config.first_step) {
    table.fail("last_step", "is shorter than first_step", "make it first_step or longer");
  }
  config.hold = table.integer("hold", 1, kMaxHold, config.hold);
  if (table.has("force")) config.force = table.number("force", lab::kProbeForce);
  config.rotation_weights = table.choice("rotation_weights", {"mass", "none"}, "mass") == "mass"
                                ? RotationWeights::kMass
                                : RotationWeights::kNone;
  table.finish();
  return config;
}

std::vector<int> step_schedule(const TimeSteppingConfig& config, double dt, int intervals) {
  const int fewest = static_cast<int>(std::lround(dt / config.last_step));
  int count = static_cast<int>(std::lround(dt / config.first_step));
  std::vector<int> schedule;
  for (int k = 0; k < intervals; ++k) {
    if (k > 0 && k % config.hold == 0) count = std::max(fewest, (count + 1) / 2);
    schedule.push_back(count);
  }
  return schedule;
}

double default_force(const SoftBody& body, double youngs_modulus) {
  return kTargetStrain * youngs_modulus * std::pow(body.volume() / body.node_count(), 2.0 / 3.0);
}

}  // namespace irdm::precompute
