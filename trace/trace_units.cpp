#include "trace/trace_units.hpp"

#include <array>
#include <utility>

namespace irdm::trace {
namespace {

constexpr std::array<std::pair<const char*, const char*>, 20> kUnits{{
    {"time", "s"},
    {"body_position", "m"},
    {"body_orientation", "1"},
    {"body_velocity", "m/s"},
    {"body_angular_velocity", "rad/s"},
    {"body_angular_momentum", "kg m^2/s"},
    {"residual", "m"},
    {"tip", "m"},
    {"proxy", "m"},
    {"force", "N"},
    {"applied_force", "N"},
    {"contact_weights", "1"},
    {"arm_shift", "m"},
    {"offset", "m"},
    {"arm", "m"},
    {"gravity", "m/s^2"},
    {"friction", "1"},
    {"damping", "1/s"},
    {"tether", "N/m, N m/rad"},
    {"material_damping", "1"},
}};

}  // namespace

std::string unit_of(const std::string& path) {
  const std::string name = path.substr(path.rfind('/') + 1);
  for (const auto& [known, unit] : kUnits) {
    if (name == known) return unit;
  }
  return "";
}

}  // namespace irdm::trace
