// Heavy bodies on light ones.
#include <cmath>

#include "common/response/modal_response.hpp"
#include "tests/simulation/touching_cubes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/synthetic_model.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kRatio = 999.0;  // of masses, close to the largest

// The same body of a density so many times as large, and as much stiffer: of the same frequencies.
Model denser(Model model, double factor) {
  model.body.mass *= factor;
  model.body.inertia *= factor;
  model.mesh.node_mass *= factor;
  if (auto* response = std::get_if<ModalResponse>(&model.response)) {
    std::visit([&](auto& shapes) { shapes /= std::sqrt(factor); }, response->shapes);
  }
  return model;
}

// A heavy cube on a light one, without damping.
SimulationConfig heavy_on_light(const Model& light, Model heavy, double ratio) {
  SimulationConfig config = stacked(2, {.cells = 3}, {0.6, 0.5});
  config.objects[0].model = std::make_shared<const Model>(light);
  config.objects[1].model = std::make_shared<const Model>(denser(std::move(heavy), ratio));
  for (SimulationObject& object : config.objects) object.damping = {};
  return config;
}

struct Fall {
  bool finite = true;
  double gain = 0.0;               ///< of energy, as a share of that at the start
  std::array<double, 2> lowest{};  ///< of the centres [m]
};

Fall run(const SimulationConfig& config) {
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  const auto energy = [&] {
    double sum = 0.0;
    for (int i = 0; i < 2; ++i) {
      const SoftObject& object = simulation.object(i);
      sum += rigid_energy(object.rigid(), {}, object.state()) +
             object.rigid().mass() * kGravity * object.state().position.y();
    }
    return sum;
  };
  const double start = energy();
  Fall fall;
  fall.lowest = {1.0, 1.0};
  for (int k = 0; k < 800; ++k) {
    irdm::test::step_alone(simulation, *record);
    fall.gain = std::max(fall.gain, energy() / start - 1.0);
    for (std::size_t i = 0; i < 2; ++i) {
      const ObjectRecord& object = record->object[i];
      fall.finite = fall.finite && object.position.allFinite() && object.velocity.allFinite();
      fall.lowest[i] = std::min(fall.lowest[i], object.position.y());
    }
  }
  return fall;
}

}  // namespace

TEST_CASE("heavy bodies: on a light soft one they sink as far as it yields, and gain no energy",
          "[slow]") {
  for (const double youngs_modulus : {2e4, 2e7}) {
    const Model& light = *fem_cube({.cells = 3, .youngs_modulus = youngs_modulus});
    const double weight = kRatio * light.body.mass * kGravity;
    // Of a bar: force per area over E; loaded at once, twice as far.
    const double sinks = 2.0 * weight / (youngs_modulus * 2.0 * kHalfEdge);
    for (const bool rigid : {true, false}) {
      const Fall fall = run(heavy_on_light(light, rigid ? made_rigid(light) : light, kRatio));
      INFO("E " << youngs_modulus << ", rigid " << rigid << ": centres down to " << fall.lowest[0]
                << ", " << fall.lowest[1] << " m, energy gained " << fall.gain);
      CHECK(fall.finite);
      CHECK(fall.gain < 2e-3);
      CHECK(fall.lowest[0] > std::max(0.0, kHalfEdge - sinks));
      CHECK(fall.lowest[1] > std::max(0.9 * kHalfEdge, 3.0 * kHalfEdge - 1.5 * sinks));
    }
  }
}

TEST_CASE("heavy bodies: on a light rigid one they stay", "[slow]") {
  const Model rigid = made_rigid(*fem_cube({.cells = 3, .youngs_modulus = 2e7}));
  const Fall fall = run(heavy_on_light(rigid, rigid, 100.0));
  INFO("centres down to " << fall.lowest[0] << ", " << fall.lowest[1] << " m, energy gained "
                          << fall.gain);
  CHECK(fall.finite);
  CHECK(fall.gain < 2e-3);
  CHECK(fall.lowest[0] > kHalfEdge - 5e-4);
  CHECK(fall.lowest[1] > 3.0 * kHalfEdge - 1e-3);
}

TEST_CASE("heavy bodies: heavier ones are refused by name, wherever they are") {
  const Model soft = *fem_cube({.cells = 3, .youngs_modulus = 2e7});
  const Model rigid = made_rigid(soft);
  SimulationConfig config = heavy_on_light(soft, rigid, 1e4);
  config.objects[0].name = "cube";
  config.objects[1].name = "anvil";
  CHECK_THROWS_WITH(
      Simulation(config),
      ContainsSubstring("objects \"cube\" and \"anvil\" have masses of 1 : 10000") &&
          ContainsSubstring("at most 1 : 1000, 1 : 100 where the light one is rigid"));
  std::swap(config.objects[0].model, config.objects[1].model);
  CHECK_THROWS_WITH(Simulation(config), ContainsSubstring("have masses of 1 : 10000"));
  config.between_objects = false;
  CHECK_NOTHROW(Simulation(config));
  CHECK_THROWS_WITH(Simulation(heavy_on_light(rigid, soft, 101.0)), ContainsSubstring("1 : 101"));
  CHECK_NOTHROW(Simulation(heavy_on_light(soft, rigid, 999.0)));
  // One that does not move has no mass that counts.
  Model fixed = rigid;
  fixed.body.support = Support::kFixed;
  CHECK_NOTHROW(Simulation(heavy_on_light(soft, fixed, 1e4)));
}
