// What the server's surface was, without quantisation: plays the tips and buttons of a lockstep
// trace to a simulation of its own, which gives the same bits, and prints as JSON the displacements
// of the first object after a step: expected_surface SCENE.toml TRACE.h5 STEP
#include <cstdlib>
#include <iomanip>
#include <iostream>

#include "scene/scene.hpp"
#include "simulation/deformation/deformation.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/system/trace.hpp"

using namespace irdm;
using namespace irdm::test;

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const SceneConfig scene = read_scene(TomlTable::parse_file(argv[1]));
  const Trace trace = read_trace(argv[2]);
  const auto last = static_cast<std::size_t>(std::strtoull(argv[3], nullptr, 10));
  if (last >= trace.rows()) return 2;
  const SimulationConfig config = simulation_config(scene, false);
  Simulation simulation(config);
  Deformation deformation(config);
  StepRecord record;
  for (std::size_t k = 0; k <= last; ++k) {
    StylusCommand command;
    command.present = trace.present[k] != 0;
    command.buttons = static_cast<std::uint32_t>(trace.buttons[k]);
    command.tip = trace.vector("/stylus/0/tip", k);
    simulation.step({&command, 1}, record, trace.reset[k] != 0);
    deformation.follow(record);
  }
  SurfaceFrame frame = rest_frame(config);
  deformation.compute(frame);
  const Points& u = frame.objects[0].displacement;
  std::cout << std::setprecision(17) << '[';
  for (Eigen::Index i = 0; i < u.size(); ++i) std::cout << (i > 0 ? "," : "") << u.data()[i];
  std::cout << "]\n";
  return 0;
}
