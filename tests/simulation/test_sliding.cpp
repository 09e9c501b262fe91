// Fingertips that slide round a cube, over its faces, edges and corners.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/simulation/pressed_cube.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

// A tour round a rectangle of half-widths a and b with its corners rounded [m], from the middle of
// its top towards +x, after a way s: place in the plane.
Eigen::Vector2d rounded_rectangle(double s, double a, double b, double radius) {
  const double across = a - radius;
  const double up = b - radius;
  const double arc = 0.5 * std::numbers::pi * radius;
  s = std::fmod(s, 4.0 * (across + up + arc));
  const auto side = [](double length, double at) { return std::min(length, at); };
  Eigen::Vector2d place(0.0, b);
  double heading = 0.0;
  const std::array<double, 5> lengths{across, 2 * up, 2 * across, 2 * up, across};
  for (const double length : lengths) {
    const Eigen::Vector2d ahead(std::cos(heading), std::sin(heading));
    place += side(length, s) * ahead;
    s -= length;
    if (s <= 0) return place;
    const double turned = side(arc, s) / radius;
    const Eigen::Vector2d right(ahead.y(), -ahead.x());
    place += radius * (std::sin(turned) * ahead + (1.0 - std::cos(turned)) * right);
    s -= arc;
    if (s <= 0) return place;
    heading -= 0.5 * std::numbers::pi;
  }
  return place;
}

struct Tour {
  double peak = 0.0;
  double largest_step = 0.0;  // of |force| from one step to the next
  int lost = 0;               // steps without contact
  double off_surface = 0.0;   // of the proxy's material point
};

// Once round the cube and a little more, in the upright plane at an angle to the x axis, the tip a
// depth inside its faces; turns have the radius of 1 cm that a hand can follow.
Tour tour(const SimulationConfig& config, double angle, double speed, double depth) {
  constexpr double kTurn = 0.01;
  const Vector3 across(std::cos(angle), 0.0, std::sin(angle));
  const Vector3 beside = angle == 0.0 ? Vector3(0.0, 0.0, 0.0077) : Vector3::Zero();
  const double b = kHalfEdge - depth;
  const double a = b / std::cos(angle);
  const double once = 4.0 * (a + b - 2.0 * kTurn) + 2.0 * std::numbers::pi * kTurn;
  Simulation simulation(config);
  const RestSurface& surface = simulation.object().surface();
  StepRecord record;
  Tour result;
  double last = 0.0;
  constexpr int kDown = 250;
  const int steps = static_cast<int>(1.1 * once / speed / 0.002);
  for (int k = -kDown; k < steps; ++k) {
    const double t = 0.002 * k;
    const double s = t < 0 ? 0.0 : t < 0.1 ? 5.0 * speed * t * t : speed * (t - 0.05);
    const double above = k < 0 ? 1.0 - (k + kDown) / static_cast<double>(kDown) : 0.0;
    const Eigen::Vector2d at = rounded_rectangle(s, a, b, kTurn);
    const Vector3 tip = at.x() * across + Vector3(0.0, at.y() + 0.006 * above, 0.0) + beside;
    const StylusCommand command = at_tip(tip);
    simulation.step({&command, 1}, record);
    const double now = record.stylus[0].force.norm();
    if (k > 0) {
      if (record.stylus[0].contact == ContactState::kFree) ++result.lost;
      result.peak = std::max(result.peak, now);
      result.largest_step = std::max(result.largest_step, std::abs(now - last));
      const SurfacePoint& point = record.object[0].contact[0].point;
      const Vector3 at_rest = interpolate(point, [&](int i) { return surface.node(i); });
      result.off_surface =
          std::max(result.off_surface, (surface.closest(at_rest).position - at_rest).norm());
    }
    last = now;
  }
  return result;
}

}  // namespace

TEST_CASE("sliding: over faces and edges is smooth, and the proxy stays on the surface", "[slow]") {
  const double speed = GENERATE(0.02, 0.04, 0.08, 0.2);
  const double degrees = GENERATE(0.0, 20.0);
  const double angle = degrees * std::numbers::pi / 180.0;
  const Tour result = tour(tethered({8}, 0.015, {0.2, 0.2}), angle, speed, 0.004);
  INFO(degrees << " degrees, " << speed << " m/s: peak " << result.peak << " N, largest step "
               << result.largest_step << " N, lost " << result.lost);
  CHECK(result.lost == 0);
  CHECK(result.off_surface < 1e-6);
  CHECK(result.largest_step < 0.05 * result.peak);
}

TEST_CASE("sliding: over corners and along edges is smooth", "[slow]") {
  const double speed = GENERATE(0.01, 0.02, 0.04, 0.08, 0.2);
  const Tour result = tour(tethered({8}, 0.015, {0.2, 0.2}), 0.25 * std::numbers::pi, speed, 0.004);
  INFO(speed << " m/s: peak " << result.peak << " N, largest step " << result.largest_step
             << " N, lost " << result.lost);
  CHECK(result.lost == 0);
  CHECK(result.off_surface < 1e-6);
  CHECK(result.largest_step < 0.05 * result.peak);
}
