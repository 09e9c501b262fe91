#include "tests/support/led_brick.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <sstream>

#include "common/model/model_file.hpp"
#include "precompute/precompute.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/support/temporary_folder.hpp"

namespace irdm::test {
namespace {

const Vector3 kSize(0.10, 0.08, 0.06);
constexpr double kAbove = 1e-6;  // the surface, where a fingertip begins [m]
constexpr double kOf = 2e4;      // Young's modulus of the model that is computed [N/m^2]

Model computed_brick() {
  precompute::PrecomputeConfig config;
  config.name = "brick";
  config.mesh.source = precompute::BoxConfig{kSize, {5, 4, 3}};
  config.mesh.order = 1;
  config.material = {kOf, 0.45, 300.0, 8.0, 2e-4};
  config.response.steps = 50;
  const TemporaryFolder folder;
  std::ostringstream ignored;
  precompute::precompute_model(config, folder.path() / "brick.h5",
                               precompute::Console{ignored, false});
  return read_model(folder.path() / "brick.h5", ResponseKind::kModal);
}

// 0 before `from`, 1 after `to`, in between with three derivatives that begin and end at 0.
double smooth(double t, double from, double to) {
  const double s = std::clamp((t - from) / (to - from), 0.0, 1.0);
  return s * s * s * s * (35.0 - s * (84.0 - s * (70.0 - 20.0 * s)));
}

double duration(BrickMotion motion) {
  return motion == BrickMotion::kSwing ? 1.0 : motion == BrickMotion::kSlide ? 0.8 : 0.4;
}

// From the node or the middle of the top [m], W. A fingertip is seen outside before it comes down.
Vector3 path_of_full_size(BrickMotion motion, double t) {
  switch (motion) {
    case BrickMotion::kSwing:
      return Vector3(0.03 * std::sin(3.0 * std::numbers::pi * t) * smooth(t, 0.0, 0.4), 0.0, 0.0);
    case BrickMotion::kPush:
      return Vector3(0.0, 0.0, -0.002 * smooth(t, 0.0, 0.05));
    case BrickMotion::kTap: {
      const double down = smooth(t, 0.02, 0.05) - smooth(t, 0.05, 0.08);
      return Vector3(0.0, 0.0, kAbove - 0.002 * down);
    }
    case BrickMotion::kSlide:
      return Vector3(0.03 * smooth(t, 0.3, 0.8), 0.0, kAbove - 0.003 * smooth(t, 0.02, 0.3));
  }
  return Vector3::Zero();
}

Vector3 path(const BrickLead& lead, double t) {
  return lead.size * path_of_full_size(lead.motion, t);
}

bool holds(BrickMotion motion) {
  return motion == BrickMotion::kSwing || motion == BrickMotion::kPush;
}

// Of the top, where the stylus begins.
Vector3 first_point(const Model& model, BrickMotion motion) {
  // The centre of mass of the mesh is not quite that of the box.
  const Vector3 wanted(0.01, 0.01, model.mesh.nodes.col(2).maxCoeff());
  if (!holds(motion)) return wanted;
  int nearest = 0;
  for (int i = 0; i < model.mesh.surface_node_count(); ++i) {
    const auto away = [&](int node) { return (model.mesh.rest_position(node) - wanted).norm(); };
    if (away(i) < away(nearest)) nearest = i;
  }
  return model.mesh.rest_position(nearest);
}

}  // namespace

SimulationConfig brick_scene(const BrickLead& lead, double dt) {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = soft_brick(lead.youngs_modulus, dt);
  config.objects[0].friction = {0.3, 0.3};
  config.styluses = {{0.0, 0.0, 1e-3}};
  if (!holds(lead.motion)) config.styluses = {{0.015, 1000.0, 0.0}};
  if (lead.motion == BrickMotion::kSlide) {
    config.objects[0].tether = {500.0, 4.0};
    config.objects[0].damping = {20.0, 20.0};
  }
  return config;
}

// Frequencies go with the root of Young's modulus, shapes stay.
std::shared_ptr<const Model> soft_brick(double youngs_modulus, double dt) {
  static const Model brick = computed_brick();
  auto model = std::make_shared<Model>(brick);
  model->dt = dt;
  model->material.youngs_modulus = youngs_modulus;
  auto& response = std::get<ModalResponse>(model->response);
  response.angular_frequency *= std::sqrt(youngs_modulus / kOf);
  response.decay_rate =
      0.5 * (model->material.rayleigh_alpha +
             model->material.rayleigh_beta * response.angular_frequency.array().square());
  return model;
}

void lead_brick(const BrickLead& lead, double dt,
                const std::function<void(const StepRecord&)>& visit) {
  const SimulationConfig config = brick_scene(lead, dt);
  const Vector3 first = first_point(*config.objects[0].model, lead.motion);
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  const auto steps = static_cast<int>(std::lround(duration(lead.motion) / dt));
  for (int k = 0; k < steps; ++k) {
    const StylusCommand command{true, holds(lead.motion) ? kGrabButton : 0,
                                first + path(lead, (k + 1) * dt), std::nullopt};
    simulation.step({&command, 1}, *record);
    visit(*record);
  }
}

std::vector<Vector3> brick_forces(const BrickLead& lead, double dt) {
  std::vector<Vector3> forces;
  lead_brick(lead, dt, [&](const StepRecord& record) { forces.push_back(record.stylus[0].force); });
  return forces;
}

double brick_error(const std::vector<Vector3>& fine, const std::vector<Vector3>& coarse,
                   double dt) {
  const auto part = static_cast<std::size_t>(std::lround(dt / kFineStep));
  double peak = 0.0;
  for (const Vector3& force : fine) peak = std::max(peak, force.norm());
  double apart = 0.0;
  for (std::size_t k = 0; k < coarse.size() && (k + 1) * part <= fine.size(); ++k) {
    Vector3 mean = Vector3::Zero();
    for (std::size_t i = k * part; i < (k + 1) * part; ++i) {
      mean += fine[i] / static_cast<double>(part);
    }
    apart = std::max(apart, (coarse[k] - mean).norm());
  }
  return apart / peak;
}

}  // namespace irdm::test
