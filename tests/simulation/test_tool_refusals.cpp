// Couplings that a simulation refuses, and the most that it accepts.
#include <cmath>

#include "common/error.hpp"
#include "tests/simulation/led_rod.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

TEST_CASE("tool: a simulation refuses couplings that its step cannot bear, and tools it has not") {
  const double mass = kRodMass / 4.0;  // at the tip of a thin rod, about
  const double inertia = rod()->body.inertia(0, 0);
  const auto check_refused = [](const SimulationConfig& config, const std::string& words) {
    CHECK_THROWS_AS(Simulation(config), Error);
    CHECK_THROWS_WITH(Simulation(config), ContainsSubstring(words));
  };
  CHECK_NOTHROW(Simulation(led_rod()));
  CHECK_NOTHROW(Simulation(led_rod({0.2 * mass / 4e-6, {}, {}, {}})));
  check_refused(led_rod({1.1 * mass / 4e-6, {}, {}, {}}), "a stiffness that is too strong");
  check_refused(led_rod({{}, 2.2 * mass / 2e-3, {}, {}}), "a damping that is too strong");
  check_refused(led_rod({{}, {}, 0.26 * inertia / 4e-6, {}}), "an angular_stiffness that is too");
  check_refused(led_rod({{}, {}, {}, 1.1 * inertia / 2e-3}), "an angular_damping that is too");
  check_refused(led_rod({100.0, 0.5, {}, {}}), "a damping that is too weak");
  check_refused(led_rod({100.0, {}, 0.5, 0.001}), "an angular_damping that is too weak");
  check_refused(led_rod({-1.0, {}, {}, {}}), "has a constant of -1");
  check_refused(led_rod({{}, std::nan(""), {}, {}}), "has a constant of nan");
  SimulationConfig config = led_rod();
  config.styluses[0].tool->object = 1;
  check_refused(config, "is object 2, which is not there");
  config = led_rod();
  config.styluses.resize(2, config.styluses[0]);
  check_refused(config, "tool of stylus 2: is an object that another stylus leads");
  config = led_rod();
  Model fixed = *rod();
  fixed.body.support = Support::kFixed;
  config.objects[0].model = std::make_shared<const Model>(std::move(fixed));
  check_refused(config, "leads an object that is fixed");
}

TEST_CASE("tool: the most that a message of refusal allows is accepted") {
  const auto most = [](const CouplingConstants& constants) {
    try {
      Simulation simulation(led_rod(constants));
    } catch (const Error& error) {
      const std::string text = error.what();
      return std::stod(text.substr(text.find("use at most ") + 12));
    }
    return 0.0;
  };
  CHECK_NOTHROW(Simulation(led_rod({most({1e9, {}, {}, {}}), {}, {}, {}})));
  CHECK_NOTHROW(Simulation(led_rod({{}, most({{}, 1e9, {}, {}}), {}, {}})));
}

TEST_CASE("tool: the defaults are accepted for bodies of every size") {
  for (const double mass : {1e-4, 0.05, 20.0}) {
    for (const double size : {1e-3, 0.1, 1.0}) {
      for (const double dt : {0.0005, 0.005}) {
        BodyProperties body = rod()->body;
        body.inertia *= mass / body.mass * size * size;
        body.mass = mass;
        const Vector3 tip(0.01 * size, -0.06 * size, 0.0);
        CHECK_NOTHROW(PoseCoupling(body, tip, {}, dt, "tool"));
      }
    }
  }
}
