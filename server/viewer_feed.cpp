#include "server/viewer_feed.hpp"

#include "common/realtime/clock.hpp"

namespace irdm {
namespace {

viewer::Scene viewer_scene(const SceneConfig& scene, const SimulationConfig& config,
                           bool lockstep) {
  viewer::Scene seen;
  seen.dt = config.objects.at(0).model->dt;
  seen.lockstep = lockstep;
  seen.floor = config.floor;
  seen.styluses = config.styluses;
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    const Model& model = *config.objects[i].model;
    viewer::SceneObject object;
    object.name = scene.objects.at(i).name;
    object.rest.resize(model.mesh.surface_node_count(), 3);
    for (int node = 0; node < model.mesh.surface_node_count(); ++node) {
      object.rest.row(node) = model.mesh.rest_position(node).transpose();
    }
    object.triangles = model.mesh.triangles;
    object.mass = static_cast<float>(model.body.mass);
    object.stiffness = static_cast<float>(model.material.youngs_modulus);
    seen.objects.push_back(std::move(object));
  }
  return seen;
}

viewer::Percentiles percentiles(const Histogram& histogram) {
  if (histogram.count() == 0) return {};
  const auto microseconds = [](std::int64_t ns) { return static_cast<float>(ns) / 1000.0F; };
  return {microseconds(histogram.percentile(0.5)), microseconds(histogram.percentile(0.99)),
          microseconds(histogram.maximum())};
}

/// Reads what the threads publish of themselves. Viewer's thread only.
class HealthReader {
 public:
  HealthReader(DeformationThread& deformation, ForceThread& force, const NetworkServer& network)
      : deformation_(deformation), force_(force), network_(network) {}

  viewer::Health read() {
    force_.health().receive();
    const ForceHealth& force = force_.health().front();
    const NetworkStats& network = network_.stats();
    viewer::Health health;
    health.steps = force.steps;
    health.step_time = percentiles(force.step_time);
    health.wakeup_delay = percentiles(force.wakeup_delay);
    health.missed = force.missed;
    health.unsolved = force.unsolved;
    health.resets = force.resets;
    health.lost_steps = deformation_.lost_steps();
    health.surface_rate = surface_rate();
    health.sessions = network.accepted;
    health.samples = network.samples;
    health.forces = network.forces;
    health.forces_replaced = network.forces_replaced;
    health.protocol_errors = network.protocol_errors;
    return health;
  }

 private:
  /// Over the last second or so, however often it is asked for.
  float surface_rate() {
    constexpr std::int64_t kWindowNs = 1'000'000'000;
    const std::int64_t now_ns = monotonic_ns();
    if (now_ns - since_ns_ < kWindowNs) return rate_;
    const std::uint64_t frames = deformation_.frames();
    rate_ = static_cast<float>(1e9 * static_cast<double>(frames - frames_) /
                               static_cast<double>(now_ns - since_ns_));
    frames_ = frames;
    since_ns_ = now_ns;
    return rate_;
  }

  DeformationThread& deformation_;
  ForceThread& force_;
  const NetworkServer& network_;
  std::int64_t since_ns_ = monotonic_ns();
  std::uint64_t frames_ = 0;
  float rate_ = 0;
};

}  // namespace

viewer::ViewerFeed viewer_feed(const SceneConfig& scene, const SimulationConfig& config,
                               bool lockstep, DeformationThread& deformation, ForceThread& force,
                               const NetworkServer& network) {
  return {viewer_scene(scene, config, lockstep), deformation.surfaces(),
          deformation.surface_ready(),
          [reader = HealthReader(deformation, force, network)]() mutable { return reader.read(); },
          [&force] { force.request_reset(); }};
}

viewer::ViewerSettings viewer_settings(const ViewerConfig& config) {
  viewer::ViewerSettings settings;
  settings.address = config.address;
  settings.port = static_cast<std::uint16_t>(config.port);
  settings.token = config.token;
  settings.page = viewer::PageFiles::read(viewer::page_folder());
  return settings;
}

}  // namespace irdm
