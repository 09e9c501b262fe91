#pragma once

#include <optional>
#include <vector>

#include "common/blackbox/black_box.hpp"
#include "common/blackbox/frame_log.hpp"
#include "server/blackbox/step_log.hpp"
#include "server/threads/force_thread.hpp"

namespace irdm {

/// What a server leaves when something went wrong. Not in lockstep: there is no hand to be felt
/// for.
class ServerBlackBox {
 public:
  ServerBlackBox(const BlackBoxSettings& settings, bool lockstep) {
    if (!settings.folder.empty() && !lockstep) box_.emplace(settings, "irdm-server", parts());
  }
  FrameLog* frames() noexcept { return box_ ? &frames_ : nullptr; }
  void start(ForceThread& force) {
    if (!box_) return;
    force.write_down_in(steps_);
    box_->start();
  }
  /// When force and network thread have ended.
  void finish() {
    if (box_) box_->finish();
  }

 private:
  std::vector<BlackBoxPart*> parts() { return {&steps_, &frames_}; }

  StepLog steps_;
  FrameLog frames_;
  std::optional<BlackBox> box_;
};

}  // namespace irdm
