#include "scene/scene_simulation.hpp"

#include <filesystem>
#include <memory>
#include <vector>

#include "common/error.hpp"
#include "common/model/model_file.hpp"
#include "simulation/step/settings.hpp"

namespace irdm {
namespace {

constexpr double kBytesAMebibyte = 1024.0 * 1024.0;

Model read_by_budget(const ObjectConfig& object, SceneColumns* columns) {
  if (object.engine != ResponseKind::kDense || !object.memory_budget || columns == nullptr) {
    return read_model(object.model, object.engine);
  }
  return columns->read(object.model,
                       static_cast<std::size_t>(*object.memory_budget * kBytesAMebibyte));
}

/// The models of a scene's objects: those of one file and kind have the same, but where it has a
/// budget of memory, which is each object's own.
class Models {
 public:
  explicit Models(SceneColumns* columns) : columns_(columns) {}

  std::shared_ptr<const Model> of(const ObjectConfig& object) {
    std::shared_ptr<const Model> model = find(object);
    if (!model) {
      model = std::make_shared<const Model>(read_by_budget(object, columns_));
      if (!object.memory_budget) read_.push_back({object.model, object.engine, model});
    }
    check_inertial_loading(*model, object.inertial_loading, object.model.string());
    return model;
  }

 private:
  struct Read {
    std::filesystem::path file;
    ResponseKind kind;
    std::shared_ptr<const Model> model;
  };

  std::shared_ptr<const Model> find(const ObjectConfig& object) const {
    if (object.memory_budget) return nullptr;
    for (const Read& read : read_) {
      if (read.kind == object.engine && read.file == object.model) return read.model;
    }
    return nullptr;
  }

  SceneColumns* columns_;
  std::vector<Read> read_;
};

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
  Models models(columns);
  SimulationConfig config;
  config.gravity = scene.world.gravity;
  for (const ObjectConfig& object : scene.objects) {
    config.objects.push_back({models.of(object), object.position, object.orientation,
                              object.velocity, object.angular_velocity, object.friction,
                              object.damping, object.tether, object.inertial_loading});
  }
  config.styluses = scene.styluses;
  if (viewer_stylus) config.styluses.push_back(scene.viewer.stylus);
  config.floor = scene.floor;
  config.release_time = scene.contact.release_time;
  return config;
}

}  // namespace irdm
