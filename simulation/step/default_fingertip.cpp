#include "simulation/step/default_fingertip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "common/response/stored_response.hpp"
#include "simulation/collision/rest_surface.hpp"
#include "simulation/contact/fingertip_loads.hpp"
#include "simulation/contact/pressure_mask.hpp"

namespace irdm {
namespace {

constexpr double kOfThickness = 1.65;

// By the divergence theorem, from the faces' cones to the origin.
double volume_by_surface(const RestSurface& surface) {
  double volume = 0.0;
  double area = 0.0;
  for (int t = 0; t < surface.triangle_count(); ++t) {
    const TriangleCorners corners = surface.corners(t);
    const Vector3 normal = area_normal(corners);
    volume += corners[0].dot(normal) / 6.0;
    area += 0.5 * normal.norm();
  }
  return volume / area;
}

}  // namespace

double default_fingertip(const SimulationConfig& config) {
  double radius = std::numeric_limits<double>::infinity();
  double edge = 0.0;
  double largest = radius;
  for (const SimulationObject& object : config.objects) {
    const RestSurface surface(object.model->mesh);
    largest = std::min(largest, PressureMask::largest_radius(surface));
    if (is_rigid(*object.model)) continue;
    radius = std::min(radius, kOfThickness * volume_by_surface(surface));
    edge = std::max(edge, surface.mean_edge());
  }
  return edge > 0 ? std::min(std::max(radius, edge), largest) : 0.0;
}

double default_ball_radius(const SimulationConfig& config) {
  constexpr double kLeast = 3e-3;  // [m]
  constexpr double kEdges = 2.0;   // of the surface's triangles
  constexpr double kOfDiameter = 0.1;
  constexpr double kDiameter = 6.0;  // of a ball, times V / S
  double edge = 0.0;
  double diameter = std::numeric_limits<double>::infinity();
  for (const SimulationObject& object : config.objects) {
    const RestSurface surface(object.model->mesh);
    edge = std::max(edge, surface.mean_edge());
    diameter = std::min(diameter, kDiameter * volume_by_surface(surface));
  }
  return std::min(std::max(kEdges * edge, kLeast), kOfDiameter * diameter);
}

double mesh_dependence_of_points(const Model& model, double radius) {
  const RestSurface surface(model.mesh);
  const Eigen::ArrayXd ratio = static_compliance(model, fingertip_loads(surface, 0.0)).array() /
                               static_compliance(model, fingertip_loads(surface, radius)).array();
  std::vector<double> factors;
  for (int t = 0; t < surface.triangle_count(); ++t) {
    const std::array<int, 3>& corners = surface.topology().corners(t);
    for (std::size_t i = 0; i < 3; ++i) {
      const double factor = ratio(corners[i]) / ratio(corners[(i + 1) % 3]);
      // Clamped nodes do not yield.
      if (std::isfinite(factor) && factor > 0) factors.push_back(std::max(factor, 1 / factor));
    }
  }
  if (factors.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = factors.begin() + static_cast<std::ptrdiff_t>(factors.size() / 2);
  std::nth_element(factors.begin(), middle, factors.end());
  return *middle;
}

}  // namespace irdm
