// How long a force step takes with contacts of all kinds, on the paper's cube (866 surface nodes,
// all its modes): points and fingertips, held, sticking and slipping, one, two and ten, the floor,
// a tool, balls of the scenery, and cubes on each other. With a word as argument: the lines that
// have it in them.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "bench/statistics.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/simulation/led_rod.hpp"
#include "tests/support/fem_cube.hpp"

using namespace irdm;

namespace {

constexpr double kHalfEdge = 0.06;
constexpr int kSettling = 500;
constexpr int kMeasured = 2000;

using Commands = std::function<std::vector<StylusCommand>(int k)>;

SimulationConfig scene(double radius, int styluses, const Friction& friction) {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = test::fem_cube({12});
  config.objects[0].friction = friction;
  config.objects[0].tether = {1000.0, 10.0};
  config.objects[0].damping = {20.0, 20.0};
  config.styluses.assign(static_cast<std::size_t>(styluses), {radius, 2000.0, 0.0});
  return config;
}

StylusCommand at(const Vector3& tip, bool grab = false) {
  return {true, grab ? kGrabButton : 0u, tip, std::nullopt};
}

std::string_view chosen;

void measure(std::string_view name, const SimulationConfig& config, const Commands& commands) {
  if (name.find(chosen) == std::string_view::npos) return;
  Simulation simulation(config);
  StepRecord record;
  std::vector<double> times;
  std::vector<double> sweeps;
  int down = 0;
  for (int k = 0; k < kSettling + kMeasured; ++k) {
    const std::vector<StylusCommand> now = commands(k);
    const double time = bench::seconds([&] { simulation.step(now, record); });
    if (k < kSettling) continue;
    times.push_back(1e6 * time);
    sweeps.push_back(record.object[0].sweeps);
    down = std::max(
        {down, record.object[0].floor_count, static_cast<int>(record.body_contact.size())});
  }
  std::printf("| %s | %.0f, %.0f | %.0f | %d |\n", std::string(name).c_str(),
              bench::percentile(times, 0.5), bench::percentile(times, 0.99),
              bench::percentile(sweeps, 0.5), down);
  std::fflush(stdout);
}

// Cubes one on the other on a plane.
SimulationConfig stack(int count, const Friction& friction) {
  SimulationConfig config = scene(0.0, 1, friction);
  const SimulationObject cube = config.objects[0];
  config.gravity = Vector3(0, -9.81, 0);
  config.objects.assign(static_cast<std::size_t>(count), cube);
  for (int i = 0; i < count; ++i) {
    SimulationObject& object = config.objects[static_cast<std::size_t>(i)];
    object.tether = {};
    object.damping = {1.0, 1.0};
    object.position.y() = (2 * i + 1) * kHalfEdge;
  }
  config.scenery.resize(1);
  config.scenery[0].friction = friction;
  return config;
}

// One cube presses on another, which is kept in place; gravity draws it along as well.
SimulationConfig face_on_face(const Friction& friction) {
  SimulationConfig config = stack(2, friction);
  config.scenery.clear();
  config.objects[0].tether = {5000.0, 50.0};
  config.objects[1].tether = {50.0, 5.0};  // or it would bounce, tip and fall off
  config.objects[1].damping = {20.0, 20.0};
  config.gravity = Vector3(2.5, -9.81, 0);
  return config;
}

// Five fingertips on each of two sides of a cube, which press and rub it.
SimulationConfig ten_fingertips() {
  SimulationConfig config = scene(0.015, 10, {1.0, 1.0});
  config.objects[0].model = test::fem_cube({.cells = 12, .dt = 0.001});
  return config;
}

std::vector<StylusCommand> pinch_with_ten(int k) {
  const double depth = 0.004 * std::min(1.0, k / 100.0) - 0.001;
  std::vector<StylusCommand> commands;
  for (int finger = 0; finger < 10; ++finger) {
    const double angle = 0.4 * std::numbers::pi * finger;
    const double rubbing = 0.001 * std::sin(0.01 * k + finger);
    const double x = kHalfEdge - depth;
    commands.push_back(
        at({finger < 5 ? x : -x, 0.03 * std::cos(angle) + rubbing, 0.03 * std::sin(angle)}));
  }
  return commands;
}

const Quaternion kLying(std::sqrt(0.5), 0.0, 0.0, -std::sqrt(0.5));

Vector3 above_top(double height) {
  return {0.0, kHalfEdge + 0.5 * test::kRodWidth + height, 0.003};
}

// A rod, which a stylus leads, lies across a cube.
SimulationConfig rod_on_cube() {
  SimulationConfig config = scene(0.0, 1, {0.5, 0.5});
  config.objects.emplace_back();
  config.objects[1].model = test::rod();
  config.objects[1].friction = {0.5, 0.5};
  config.objects[1].position = above_top(0.002);
  config.objects[1].orientation = kLying;
  config.styluses[0].tool = ToolCoupling{1, {}};
  return config;
}

std::vector<StylusCommand> press_with_rod(int k) {
  const double height = 0.002 - 0.008 * std::min(1.0, k / 200.0);
  const Vector3 along(0.001 * std::sin(0.01 * k) - 0.5 * test::kRodLength, 0.0, 0.0);
  return {test::lead_to(above_top(height) + along, kLying)};
}

// Returns a scene with balls of 15 mm that are pressed 5 mm into the top of a cube of quadratic
// elements within 0.2 s and then slide to and fro by up to 10 mm.
// @param modes number of modes, 0 for all
SimulationConfig balls(int count, int modes) {
  SimulationConfig config = scene(0.0, 1, {});
  config.objects[0].model = test::fem_cube({.cells = 6, .order = 2, .modes = modes});
  for (int i = 0; i < count; ++i) {
    SceneryConfig ball;
    ball.name = "ball " + std::to_string(i + 1);
    ball.shape = SphereShape{0.015};
    ball.friction = {0.3, 0.3};
    const Vector3 place(count == 1 ? 0.0 : -0.044 + 0.022 * (i % 5), 0.0,
                        count == 1 ? 0.0 : -0.03 + 0.06 * (i / 5));
    ball.position = place + Vector3(0.0, kHalfEdge + 0.017, 0.0);
    ball.motion.path = {{0.0, Vector3::Zero()}, {0.2, Vector3(0, -0.007, 0)}};
    for (int turn = 0; turn < 20; ++turn) {
      const double side = turn % 2 == 0 ? 0.01 : -0.01;
      ball.motion.path.push_back({0.5 + 0.25 * turn, Vector3(side, -0.007, 0)});
    }
    config.scenery.push_back(ball);
  }
  return config;
}

// Down on the top within 0.2 s, then to and fro.
Vector3 press(int k, double amplitude) {
  const double down = std::min(1.0, k / 100.0);
  return {amplitude * std::sin(0.01 * k), kHalfEdge + 0.002 - 0.006 * down, 0.003};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1) chosen = argv[1];
  std::printf("force step with contacts, paper's cube, modal, dt = 2 ms\n\n");
  std::printf("| contact | median, p99 [us] | sweeps, median | contacts with bodies, most |\n");
  std::printf("|---|---|---|---|\n");
  const Friction rough{1.0, 1.0};
  const Friction smooth{0.2, 0.2};
  const Vector3 near(0.003, kHalfEdge + 0.004, 0.003);
  const Commands nobody = [](int) { return std::vector<StylusCommand>{StylusCommand{}}; };
  measure("tip 4 mm above a cube at rest", scene(0.0, 1, rough),
          [&](int) { return std::vector<StylusCommand>{at(near)}; });
  measure("the same, another stylus moves the cube", scene(0.0, 2, rough), [&](int k) {
    const Vector3 below = -press(k, 0.002);
    return std::vector<StylusCommand>{at(near), at(below, k > 60)};
  });
  measure("point, held", scene(0.0, 1, rough),
          [](int k) { return std::vector<StylusCommand>{at(press(k, 0.002), k > 60)}; });
  measure("point, touching, slipping to and fro", scene(0.0, 1, smooth),
          [](int k) { return std::vector<StylusCommand>{at(press(k, 0.02))}; });
  measure("fingertip of 1.5 cm, sticking", scene(0.015, 1, rough),
          [](int k) { return std::vector<StylusCommand>{at(press(k, 0.0))}; });
  measure("fingertip of 1.5 cm, slipping to and fro", scene(0.015, 1, smooth),
          [](int k) { return std::vector<StylusCommand>{at(press(k, 0.02))}; });
  measure("two fingertips of 1.5 cm that pinch", scene(0.015, 2, rough), [](int k) {
    const double depth = 0.004 * std::min(1.0, k / 100.0) - 0.001;
    return std::vector<StylusCommand>{at({kHalfEdge - depth, 0.0, 0.0}),
                                      at({depth - kHalfEdge, 0.0, 0.0})};
  });
  measure("ten fingertips of 1.5 cm, dt = 1 ms", ten_fingertips(), pinch_with_ten);
  measure("tool: a rod lies across a cube and rubs", rod_on_cube(), press_with_rod);
  for (const int modes : {0, 400}) {
    const std::string of = modes == 0 ? ", all modes" : ", 400 modes";
    measure("a ball slides on quadratic elements" + of, balls(1, modes), nobody);
    measure("ten balls slide on quadratic elements" + of, balls(10, modes), nobody);
  }
  SimulationConfig resting = scene(0.0, 1, rough);
  resting.gravity = Vector3(0, -9.81, 0);
  resting.objects[0].tether = {};
  resting.floor = FloorConfig{Vector3(0, 1, 0), -kHalfEdge, {0.5, 0.5}};
  measure("resting on the floor", resting, nobody);
  measure("a cube on a plane of scenery", stack(1, {0.5, 0.5}), nobody);
  measure("two cubes face on face, the lower one fixed by a tether", face_on_face(rough), nobody);
  measure("the same, sliding", face_on_face(smooth), nobody);
  measure("a stack of three cubes", stack(3, {0.5, 0.5}), nobody);
  SimulationConfig asleep = stack(3, {0.5, 0.5});
  for (SimulationObject& cube : asleep.objects) cube.model = test::fem_cube({12, 1e6});
  asleep.sleep_time = 0.5;
  measure("stack of three stiff cubes, asleep", asleep, nobody);
}
