#include "scene/scene_run.hpp"

#include <cmath>

#include "common/config/range.hpp"

namespace irdm {

const char* fault_of(const StylusCommand& command) noexcept {
  constexpr double kNormTolerance = 1e-6;
  if (!command.present) return nullptr;
  for (const double component : command.tip) {
    if (!lab::kPlace.contains(component)) return "the tip is not within 1e4 m of the origin";
  }
  const bool unit = std::abs(command.orientation.norm() - 1.0) <= kNormTolerance;
  return unit ? nullptr : "the orientation is not a quaternion of length 1";
}

SceneRun::SceneRun(const TomlTable& file)
    : scene_(read_scene(file)),
      config_(simulation_config(scene_, false)),
      simulation_(std::make_unique<Simulation>(config_)),
      rows_(config_),
      record_(std::make_unique<StepRecord>()) {}

const StepRecord& SceneRun::step(std::span<const StylusCommand> commands) noexcept {
  simulation_->step(commands, *record_);
  contacts_ = rows_.of(*simulation_, *record_);
  return *record_;
}

void SceneRun::surface(int i, Points& x) const {
  const SoftObject& object = simulation_->object(i);
  object.engine().displacement(x);
  const ModelMesh& mesh = object.model().mesh;
  const Matrix3 turn = object.state().orientation.toRotationMatrix();
  for (int node = 0; node < mesh.surface_node_count(); ++node) {
    const Vector3 in_body = mesh.rest_position(node) + Vector3(x.row(node).transpose());
    x.row(node) = (object.state().position + turn * in_body).transpose();
  }
}

}  // namespace irdm
