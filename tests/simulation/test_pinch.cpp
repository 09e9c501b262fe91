// Two fingers that pinch a cube, lift it, hold it and let it slip.
#include <algorithm>
#include <array>
#include <cmath>

#include "simulation/step/simulation.hpp"
#include "tests/simulation/pressed_cube.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kFriction = 0.5;

// The paper's cube on a floor, and two fingers beside it, without springs in between.
SimulationConfig on_the_floor(double radius) {
  SimulationConfig config;
  config.gravity = Vector3(0, -kGravity, 0);
  config.objects.resize(1);
  config.objects[0].model = fem_cube({});
  config.objects[0].friction = {kFriction, kFriction};
  // What hangs between two fingers bounces for many seconds by its material's damping alone.
  config.objects[0].damping = {4.0, 4.0};
  config.floor = FloorConfig{Vector3(0, 1, 0), -kHalfEdge, {0.5, 0.5}};
  config.styluses = {{radius, 0.0, 0.0}, {radius, 0.0, 0.0}};
  return config;
}

double ramp(double t, double from, double to) {
  const double s = std::clamp((t - from) / (to - from), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

class Pinch {
 public:
  explicit Pinch(double radius) : simulation_(on_the_floor(radius)) {}

  // One step with both tips `depth` inside the faces and `up` above the middle [m].
  void step(double depth, double up) {
    const auto at = [&](double side) {
      return StylusCommand{true, 0u, Vector3(side * (kHalfEdge - depth), up, 0.0), std::nullopt};
    };
    const std::array<StylusCommand, 2> commands{at(1.0), at(-1.0)};
    simulation_.step(commands, record_);
  }
  // Pinches, and lifts by 3 cm.
  void lift(double depth) {
    for (int k = 0; k < 1500; ++k) {
      const double t = 0.002 * k;
      step(-0.002 + (depth + 0.002) * ramp(t, 0.0, 1.0), 0.03 * ramp(t, 1.2, 2.2));
    }
  }
  double squeeze() const {
    return 0.5 * (record_.stylus[0].force.x() - record_.stylus[1].force.x());
  }
  // The fingers' forces on the object [N], W.
  Vector3 carried() const { return -(record_.stylus[0].force + record_.stylus[1].force); }
  double height() const { return record_.object[0].position.y(); }
  double weight() const { return kGravity * simulation_.object().model().body.mass; }

 private:
  Simulation simulation_;
  StepRecord record_;
};

}  // namespace

TEST_CASE("pinch: two fingers lift a cube and hold its weight", "[slow]") {
  const double radius = GENERATE(0.0, 0.01);
  Pinch pinch(radius);
  pinch.lift(0.02);
  for (int k = 0; k < 2000; ++k) pinch.step(0.02, 0.03);
  const double held = pinch.height();
  CHECK(held > 0.0185);  // the surface gives under the weight
  INFO("squeeze " << pinch.squeeze() << " N, weight " << pinch.weight() << " N");
  for (int k = 0; k < 1000; ++k) {
    pinch.step(0.02, 0.03);
    REQUIRE((pinch.carried() - Vector3(0, pinch.weight(), 0)).norm() < 1e-3 * pinch.weight());
  }
  CHECK(std::abs(pinch.height() - held) < 1e-5);
}

TEST_CASE("pinch: the cube slips when friction carries less than its weight, and not before",
          "[slow]") {
  const double radius = GENERATE(0.0, 0.01);
  Pinch pinch(radius);
  pinch.lift(0.02);
  const double threshold = pinch.weight() / (2.0 * kFriction);
  REQUIRE(pinch.squeeze() > 1.1 * threshold);
  // The fingers open by 0.5 mm a second.
  double depth = 0.02;
  double last = pinch.height();
  double squeeze = pinch.squeeze();
  for (int k = 0; k < 40000 && depth > 0.0; ++k) {
    last = pinch.height();
    squeeze = pinch.squeeze();
    depth -= 1e-6;
    pinch.step(depth, 0.03);
    if (pinch.height() < last - 1e-5) break;  // 5 mm/s
  }
  INFO("slips at " << squeeze << " N, " << squeeze / threshold << " of the threshold");
  CHECK(squeeze == Approx(threshold).epsilon(0.02));
}
