#include "simulation/step/simulation.hpp"
#include "tests/simulation/pressed_cube.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;
using irdm::test::kHalfEdge;
using irdm::test::synthetic_cube;

namespace {

// The cube with its upper face clamped.
std::shared_ptr<const Model> clamped_cube() {
  Model model = synthetic_cube(4, 30, 200);
  model.body.support = Support::kFixed;
  auto& shapes = std::get<RowMatrix<double>>(std::get<ModalResponse>(model.response).shapes);
  for (int i = 0; i < model.mesh.surface_node_count(); ++i) {
    if (model.mesh.rest_position(i).y() > kHalfEdge - 1e-9) {
      shapes.middleRows<3>(3 * i).setZero();
    }
  }
  return std::make_shared<const Model>(std::move(model));
}

}  // namespace

TEST_CASE("where it is clamped a fixed object is felt as the coupling spring alone") {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = clamped_cube();
  config.styluses = {{0.0, 2000.0, 0.0}};
  Simulation simulation(config);
  StepRecord record;
  for (int k = 0; k < 100; ++k) {
    const double depth = -0.001 + 4e-5 * k;  // 1 mm above to 3 mm below
    const StylusCommand command{true, 0u, {0.013, kHalfEdge - depth, 0.008}, std::nullopt};
    simulation.step({&command, 1}, record);
    const double expected = std::max(0.0, depth) * 2000.0;
    CHECK((record.stylus[0].force - Vector3(0, expected, 0)).norm() < 1e-9);
  }
  CHECK(record.object[0].position == Vector3::Zero());
  CHECK(record.object[0].velocity == Vector3::Zero());
}
