// What a simulation refuses to begin with.

#include "common/error.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/synthetic_model.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

SimulationConfig two() {
  SimulationConfig config;
  config.objects.resize(2);
  for (SimulationObject& object : config.objects) {
    object.model = std::make_shared<const Model>(synthetic_cube(2, 5, 10));
  }
  config.objects[1].position.x() = 1.0;
  return config;
}

void check_refused(const SimulationConfig& config, const std::string& words) {
  CHECK_THROWS_AS(Simulation(config), Error);
  CHECK_THROWS_WITH(Simulation(config), ContainsSubstring(words));
}

}  // namespace

TEST_CASE("a simulation refuses too many objects or styluses, and models of different dt") {
  CHECK_NOTHROW(Simulation(two()));
  SimulationConfig config = two();
  config.objects.resize(kMaxObjects + 1, config.objects[0]);
  check_refused(config, "has 17 objects");
  config.objects.clear();
  check_refused(config, "has 0 objects");
  config = two();
  config.styluses.resize(kMaxStyluses + 1);
  check_refused(config, "has 17 styluses");
  config = two();
  Model other = synthetic_cube(2, 5, 10);
  other.dt = 0.001;
  config.objects[1].model = std::make_shared<const Model>(std::move(other));
  check_refused(config, "models of different dt: object 1 0.002 s, object 2 0.001 s");
  config.objects[0].name = "cube";
  config.objects[1].name = "lid";
  check_refused(config, "models of different dt: object \"cube\" 0.002 s, object \"lid\" 0.001 s");
  config = two();
  config.objects[1].name = "lid";
  config.objects[1].damping.linear = 1e4;
  check_refused(config, "object \"lid\": has a damping that is too strong");
}

TEST_CASE("a simulation has sixteen objects and styluses, but few of them on a floor") {
  SimulationConfig config = two();
  config.objects.resize(kMaxObjects, config.objects[0]);
  config.styluses.resize(kMaxStyluses);
  for (int i = 0; i < kMaxObjects; ++i) {
    config.objects[static_cast<std::size_t>(i)].position = Vector3(0.2 * i, 0.1, 0);
  }
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  const std::vector<StylusCommand> nobody(kMaxStyluses);
  simulation.step(nobody, *record);
  CHECK(record->object_count == 16);
  CHECK(record->stylus_count == 16);
  CHECK(record->object[15].position.x() == 3.0);
  config.floor.emplace();
  check_refused(config, "floor: is for at most 4 objects that touch each other");
  config.between_objects = false;
  CHECK_NOTHROW(Simulation(config));
}

TEST_CASE("a simulation refuses damping and tethers that its step is too long for") {
  const SimulationConfig good = two();
  const Model& model = *good.objects[1].model;
  const double dt = model.dt;
  const double stiffest = model.body.mass / (dt * dt);
  const double stiffest_angular = model.body.inertia(0, 0) / (dt * dt);  // of a cube
  SimulationConfig config = good;
  config.objects[1].damping = {0.49 / dt, 0.49 / dt};
  config.objects[1].tether = {0.99 * stiffest, 0.99 * stiffest_angular};
  CHECK_NOTHROW(Simulation(config));
  config.objects[1].damping.linear = 0.51 / dt;
  check_refused(config, "object 2: has a damping that is too strong");
  config.objects[1].damping = {0.0, 0.51 / dt};
  check_refused(config, "object 2: has a damping that is too strong");
  config = good;
  config.objects[1].tether.stiffness = 1.01 * stiffest;
  check_refused(config, "object 2: has a tether that is too stiff");
  config = good;
  config.objects[1].tether.angular_stiffness = 1.01 * stiffest_angular;
  check_refused(config, "object 2: has a tether that is too stiff");
  // A fixed object does not move, whatever is said of it.
  Model fixed = model;
  fixed.body.support = Support::kFixed;
  config.objects[1].model = std::make_shared<const Model>(std::move(fixed));
  CHECK_NOTHROW(Simulation(config));
}
