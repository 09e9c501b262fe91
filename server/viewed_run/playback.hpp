#pragma once

#include <string>

#include "server/viewed_run/player.hpp"
#include "viewer/message.hpp"

namespace irdm {

/// What viewers see and ask of a player. Viewer's thread.
class Playback {
 public:
  explicit Playback(Player& player) : player_(player) {}

  /// Whether a recording is shown, or about to be.
  bool on() const noexcept { return on_; }
  void show(const std::filesystem::path& path, std::uint16_t number);
  void leave();
  /// True when it is a command for a recorded run; it is then carried out.
  bool carry_out(const viewer::Command& command);

  /// Fills in what a State says of the recorded run. A recording that cannot be shown ends it, and
  /// `notice` says why.
  void report(viewer::State& state, std::string& notice);

 private:
  Player& player_;
  bool on_ = false;
  std::uint16_t number_ = viewer::State::kNone;
  std::uint64_t loads_ = 0;
};

}  // namespace irdm
