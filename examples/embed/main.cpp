// Pushes a soft object from a program of its own: reads a model file, moves a stylus down into the
// object's highest node and prints the force on the stylus. No server, no socket: one thread, as
// fast as it goes. Status 1 if there was no contact.
//   embed MODEL.h5
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <utility>
#include <vector>

#include "common/model/model_file.hpp"
#include "simulation/step/simulation.hpp"

namespace {

constexpr double kDepth = 0.01;   // [m]
constexpr double kSpeed = 0.05;   // [m/s]
constexpr double kEnd = 0.35;     // [s]
constexpr double kAbove = 0.005;  // of the surface, where the stylus starts [m]

/// The highest node along y [m]; of equally high ones that nearest to the vertical line through the
/// centre of mass.
irdm::Vector3 top(const irdm::Model& model) {
  constexpr double kEqual = 1e-9;  // [m]
  const auto off_axis = [](const irdm::Vector3& x) { return std::hypot(x.x(), x.z()); };
  irdm::Vector3 highest = model.mesh.rest_position(0);
  for (int i = 1; i < model.mesh.surface_node_count(); ++i) {
    const irdm::Vector3 node = model.mesh.rest_position(i);
    const double higher = node.y() - highest.y();
    const bool nearer = off_axis(node) < off_axis(highest);
    if (higher > kEqual || (higher > -kEqual && nearer)) highest = node;
  }
  return highest;
}

irdm::SimulationConfig scene(std::shared_ptr<const irdm::Model> model) {
  irdm::SimulationConfig config;
  config.objects.push_back({.model = std::move(model)});  // at the origin, at rest, no gravity
  config.styluses = {{.coupling_stiffness = 2000.0}};     // [N/m]
  return config;
}

/// Whether there was contact.
bool push(const irdm::Model& model, irdm::Simulation& simulation) {
  const irdm::Vector3 start = top(model) + kAbove * irdm::Vector3::UnitY();
  auto record = std::make_unique<irdm::StepRecord>();  // large: what happened in one step
  std::vector<irdm::StylusCommand> commands(1);
  irdm::Vector3 impulse = irdm::Vector3::Zero();
  bool contact = false;
  for (double time = 0.0; time < kEnd; time += simulation.dt()) {
    const double way = std::min(kSpeed * time, kAbove + kDepth);
    commands[0] = {.present = true, .tip = start - way * irdm::Vector3::UnitY()};
    simulation.step(commands, *record);
    const irdm::Vector3& force = record->stylus[0].force;  // on the stylus [N], W
    impulse -= force * simulation.dt();
    contact = contact || !force.isZero(0.0);
    if (record->force_step % 10 == 0) std::printf("%.3f s  %8.5f N\n", record->time, force.y());
  }
  // It floats freely: what the stylus gave it is its momentum.
  const irdm::Vector3 momentum = model.body.mass * record->object[0].velocity;
  std::printf("impulse %.9f momentum %.9f N s\n", impulse.y(), momentum.y());
  return contact;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) return std::fputs("usage: embed MODEL.h5\n", stderr), 2;
  const auto model =
      std::make_shared<const irdm::Model>(irdm::read_model(argv[1], irdm::ResponseKind::kModal));
  irdm::Simulation simulation(scene(model));
  if (!push(*model, simulation)) return std::fputs("embed: no contact\n", stderr), 1;
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "embed: error: %s\n", error.what());
  return 1;
}
