#include "server/scene_simulation.hpp"

#include <memory>

#include "common/error.hpp"
#include "common/model/model_file.hpp"
#include "server/step/inertial_loading.hpp"

namespace irdm {
namespace {

ResponseKind response_kind(EngineKind kind) {
  if (kind == EngineKind::kDense) return ResponseKind::kDense;
  return kind == EngineKind::kCompressed ? ResponseKind::kCompressed : ResponseKind::kModal;
}

constexpr double kBytesAMebibyte = 1024.0 * 1024.0;

Model read_by_budget(const ObjectConfig& object, EngineKind kind, SceneColumns* columns) {
  if (kind != EngineKind::kDense || !object.memory_budget || columns == nullptr) {
    return read_model(object.model, response_kind(kind));
  }
  return columns->read(object.model,
                       static_cast<std::size_t>(*object.memory_budget * kBytesAMebibyte));
}

std::shared_ptr<const Model> load_model(const ObjectConfig& object, EngineKind kind,
                                        SceneColumns* columns) {
  Model model = read_by_budget(object, kind, columns);
  check_inertial_loading(model, object.inertial_loading, object.model.string());
  return std::make_shared<const Model>(std::move(model));
}

EngineKind other(EngineKind kind) {
  return kind == EngineKind::kDense ? EngineKind::kModal : EngineKind::kDense;
}

}  // namespace

bool has_viewer_stylus(const SceneConfig& scene, bool lockstep) {
  return scene.viewer.enabled && scene.viewer.mouse && !lockstep &&
         scene.styluses.size() < kMaxStyluses;
}

bool recorded_viewer_stylus(const SceneConfig& scene, int stylus_count, const std::string& trace) {
  const int more = stylus_count - static_cast<int>(scene.styluses.size());
  if (more == 0 || more == 1) return more == 1;
  throw Error(trace,
              "has " + std::to_string(stylus_count) + " styluses, the scene " +
                  std::to_string(scene.styluses.size()),
              "give the scene that it was recorded with");
}

SimulationConfig simulation_config(const SceneConfig& scene, bool viewer_stylus,
                                   SceneColumns* columns) {
  SimulationConfig config;
  config.gravity = scene.world.gravity;
  for (const ObjectConfig& object : scene.objects) {
    config.objects.push_back({load_model(object, object.engine, columns), object.position,
                              object.orientation, object.velocity, object.angular_velocity,
                              object.friction, object.damping, object.tether,
                              object.inertial_loading});
    if (object.switchable) {
      config.objects.back().other_model = load_model(object, other(object.engine), columns);
    }
  }
  config.styluses = scene.styluses;
  if (viewer_stylus) config.styluses.push_back(scene.viewer.stylus);
  config.floor = scene.floor;
  config.release_time = scene.contact.release_time;
  return config;
}

}  // namespace irdm
