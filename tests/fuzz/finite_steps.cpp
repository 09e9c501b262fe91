#include "tests/fuzz/finite_steps.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "replay/rerun/deviation.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/fuzz/harness.hpp"

namespace irdm::fuzz {
namespace {

constexpr int kPressedSteps = 20;

// Of its first triangle.
struct Place {
  Vector3 middle;
  Vector3 normal;
  double size;
};

Place first_triangle(const ModelMesh& mesh) {
  const auto corner = [&](int i) { return mesh.rest_position(mesh.triangles(0, i)); };
  const Vector3 a = corner(0);
  const Vector3 across = (corner(1) - a).cross(corner(2) - a);
  return {(a + corner(1) + corner(2)) / 3.0, across.normalized(), std::sqrt(across.norm())};
}

SimulationConfig scene_of(Model model) {
  SimulationConfig config;
  config.gravity = Vector3(0.0, -9.81, 0.0);
  config.styluses = {{0.0, 2000.0, 0.0}};
  const double radius = model.mesh.nodes.rowwise().norm().maxCoeff();
  if (model.body.support == Support::kFloating) config.floor = FloorConfig{.height = -radius};
  config.objects.resize(1);
  config.objects[0].angular_velocity = Vector3(0.2, 1.0, -0.3);
  config.objects[0].inertial_loading =
      has_centrifugal(model) && model.body.support == Support::kFloating;
  config.objects[0].model = std::make_shared<const Model>(std::move(model));
  return config;
}

}  // namespace

void press(Model model) {
  const Place place = first_triangle(model.mesh);
  Simulation simulation(scene_of(std::move(model)));
  StepRecord record;
  Points displacement;
  for (int k = 0; k < kPressedSteps; ++k) {
    const double depth = 0.02 * place.size * (k - 3);
    const std::array commands{
        StylusCommand{true, 0, place.middle - depth * place.normal, std::nullopt}};
    simulation.step(commands, record);
    expect(replay::is_finite(record), "the steps of a model that is read are finite");
    simulation.object(0).engine().displacement(displacement);
    expect(displacement.allFinite(), "the surface of a model that is read stays somewhere");
  }
}

}  // namespace irdm::fuzz
