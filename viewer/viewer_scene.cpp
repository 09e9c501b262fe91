#include "viewer/viewer_scene.hpp"

#include "simulation/collision/rest_surface.hpp"
#include "simulation/engine/static_compliance.hpp"

namespace irdm {
namespace {

std::vector<float> normal_compliance(const Model& model) {
  const RestSurface surface(model.mesh);
  std::vector<Vector3> normals;
  for (int node = 0; node < model.mesh.surface_node_count(); ++node) {
    normals.push_back(surface.smooth_normal({{node, node, node}, {1.0, 0.0, 0.0}}));
  }
  return static_compliance(model, normals);
}

viewer::SceneObject viewer_object(const std::string& name, const Model& model) {
  viewer::SceneObject object;
  object.name = name;
  object.rest.resize(model.mesh.surface_node_count(), 3);
  for (int node = 0; node < model.mesh.surface_node_count(); ++node) {
    object.rest.row(node) = model.mesh.rest_position(node).transpose();
  }
  object.triangles = model.mesh.triangles;
  object.mass = static_cast<float>(model.body.mass);
  object.stiffness = static_cast<float>(model.material.youngs_modulus);
  object.compliance = normal_compliance(model);
  return object;
}

}  // namespace

viewer::Scene viewer_scene(const std::vector<std::string>& names, const SimulationConfig& config) {
  viewer::Scene seen;
  seen.dt = config.objects.at(0).model->dt;
  seen.floor = config.floor;
  seen.styluses = config.styluses;
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    seen.objects.push_back(viewer_object(names.at(i), *config.objects[i].model));
  }
  return seen;
}

viewer::ViewerSettings viewer_settings(const ViewerConfig& config) {
  viewer::ViewerSettings settings;
  settings.address = config.address;
  settings.port = static_cast<std::uint16_t>(config.port);
  settings.token = config.token;
  settings.onlooker_token = config.onlooker_token;
  settings.page = viewer::PageFiles::read(viewer::page_folder());
  return settings;
}

std::vector<SettingsChoice> settings_choices(const SimulationConfig& config) {
  std::vector<SettingsChoice> choices;
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    choices.push_back(settings_choice(config, i));
  }
  return choices;
}

}  // namespace irdm
