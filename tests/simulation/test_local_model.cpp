#include <cmath>

#include "simulation/step/simulation.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"

// A live run predicts for its bridges and finds where late forces acted. One that is rerun
// does neither, and has to come out the same.

using namespace irdm;
using namespace irdm::test;

namespace {

bool same(const StepRecord& a, const StepRecord& b) {
  const auto& x = a.object[0];
  const auto& y = b.object[0];
  return a.stylus[0].force == b.stylus[0].force && x.position == y.position &&
         x.velocity == y.velocity && x.contact[0].force == y.contact[0].force &&
         x.contact[0].proxy == y.contact[0].proxy;
}

}  // namespace

TEST_CASE("predictions and late forces leave a run that is rerun the same to the bit", "[slow]") {
  const ResponseKind kind =
      GENERATE(ResponseKind::kModal, ResponseKind::kDense, ResponseKind::kCompressed);
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = fem_cube({3, 2000.0, 8.0, 0.002, 200}, kind);
  config.objects[0].friction = {0.6, 0.5};
  config.objects[0].tether = {200.0, 2.0};
  config.styluses = {{0.0, 1000.0, 0.005}};
  Simulation live(config);
  Simulation again(config);
  StepRecord record;
  StepRecord repeated;
  ContactModel model;
  int touching = 0;
  int late = 0;
  int same_bits = 0;
  constexpr int kSteps = 800;
  for (int k = 0; k < kSteps; ++k) {
    const double t = 0.002 * k;
    const Vector3 tip(0.02 * std::sin(3.0 * t), 0.061 - 0.004 * std::sin(12.0 * t), 0.0);
    const std::array<StylusCommand, 1> commands{StylusCommand{true, 0u, tip, {}}};
    live.step(commands, record);
    for (std::size_t i = 0; i < record.late.count; ++i) {
      late += again.insert_delayed_force(record.late.force[i]) ? 1 : 0;
    }
    again.step(commands, repeated);
    same_bits += same(record, repeated) ? 1 : 0;
    touching += record.stylus[0].contact == ContactState::kTouching ? 1 : 0;
    live.predict_horizon(0, tip, kMaxHorizon, model);
    if (k % 7 == 0) live.insert_delayed_force(0, {Vector3(0.01, -0.05, 0.0), tip, {}}, k % 5);
  }
  CHECK(same_bits == kSteps);
  CHECK(touching > 200);
  CHECK(late > 50);
}
