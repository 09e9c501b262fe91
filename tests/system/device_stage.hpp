#pragma once

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "common/geometry.hpp"
#include "tests/system/stage.hpp"

namespace irdm::test {

/// What the fake driver wrote down of one frame.
struct Frame {
  unsigned long tick = 0;
  bool failed = false;
  double height = 0.0;               ///< of the stylus [mm]
  double force = 0.0;                ///< asked for [N]
  Vector3 torque = Vector3::Zero();  ///< the same [N m]
  double begun = 0.0;                ///< monotonic [s]
};

/// A bridge with a device of the fake driver (tests/fake_libhd), whose hand comes down onto the
/// cube and presses for a second, again and again.
class DeviceStage {
 public:
  DeviceStage() {
    stage.write("scene.toml",
                scene_text() + "tether = { stiffness = 200, angular_stiffness = 1 }\n");
    stage.write("bridge.toml", "[[device]]\ntype = \"openhaptics\"\n");
    if (!kKeepsPace) stage.hold_forces();
    stage.write("motion.txt",
                "0 0 70 0 0\n500 0 50 0 0\n1500 0 50 0 0\n2000 0 70 0 0\n2200 0 70 0 0\n");
  }

  ChildOptions with(std::vector<std::string> environment = {}) const {
    environment.push_back("HD_LIBRARY=" IRDM_FAKE_LIBHD);
    environment.push_back("FAKE_HD_MOTION=" + stage.path("motion.txt").string());
    environment.push_back("FAKE_HD_LOG=" + stage.path("frames.txt").string());
    return {.environment = environment};
  }
  /// @param ticks with a force before it
  static std::vector<std::string> in_contact(const std::string& event, int ticks = 100) {
    return {"FAKE_HD_EVENT=" + event, "FAKE_HD_EVENT_AFTER=" + std::to_string(ticks)};
  }
  std::vector<Frame> frames() const {
    std::vector<Frame> found;
    std::istringstream text(file_content(stage.path("frames.txt")));
    double ignored = 0.0;
    Frame frame;
    Vector3 force;
    for (Vector3& t = frame.torque; text >> frame.tick >> frame.failed >> ignored >> frame.height >>
                                    ignored >> force.x() >> force.y() >> force.z() >> t.x() >>
                                    t.y() >> t.z() >> frame.begun;) {
      frame.force = force.norm();
      frame.torque *= 1e-3;
      frame.begun *= 1e-9;
      found.push_back(frame);
    }
    return found;
  }
  /// What the bridge did wrong with the driver, as the driver says.
  std::string misuses() const {
    const std::string log = file_content(stage.path("frames.txt"));
    return log.substr(std::min(log.find("misuses"), log.size()));
  }

  Stage stage;
};

}  // namespace irdm::test
