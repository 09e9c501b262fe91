#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/child_process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace irdm::test {

/// The model of all these tests, made by irdm-precompute itself from cube.toml beside this file.
/// ctest makes it anew for each of its runs; a test program started by hand makes it when it is not
/// there.
std::filesystem::path cube_model();

/// Whether bridge and server can be expected to keep the pace of real time, so that a hand feels
/// forces. A sanitizer makes them ten times slower.
#ifdef IRDM_SANITIZED
inline constexpr bool kKeepsPace = false;
#else
inline constexpr bool kKeepsPace = true;
#endif
/// Why a test is left out, or a part of it, where it is not.
inline constexpr const char* kTooSlow = "a sanitizer's programs do not keep the pace of real time";

/// A server that listens.
struct Server {
  ChildProcess process;
  std::uint16_t port = 0;
};

/// A folder with a scene and a bridge configuration, and the programs started on them.
class Stage {
 public:
  Stage();

  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  void write(const std::string& name, const std::string& text) const;
  /// Has the bridge hold the server's forces, which costs bridge and server less than `predict`.
  void hold_forces() const;

  /// Starts irdm-server on scene.toml and waits until it listens.
  Server start_server(std::vector<std::string> arguments = {},
                      const ChildOptions& options = {}) const;
  /// The same on a port that was in use until now.
  Server restart_server(std::uint16_t port, std::vector<std::string> arguments) const;
  /// Starts irdm-bridge on bridge.toml, whose script is script.csv.
  ChildProcess start_bridge(const Server& server, std::vector<std::string> arguments = {},
                            const ChildOptions& options = {}) const;

 private:
  TemporaryFolder folder_;
};

/// The trace of what is on the stage, trace.h5, in lockstep or as it comes. Fails when a program
/// does.
std::filesystem::path record(const Stage& stage, bool lockstep);

/// The scene of a Stage, with `more` below it.
std::string scene_text(const std::string& more = "", const std::string& engine = "modal");

/// Script rows "time,x,y,z,button": presses on the cube from above, takes hold of its top, swings
/// it about and lets go, in kPressAndSwing.
std::string press_and_swing();
inline constexpr double kPressAndSwing = 2.1;  ///< [s]
/// Takes hold of the cube's top and moves it in a circle of kCircleRadius about the vertical line
/// through (kCircleRadius, 0, 0), at kCircleHeight.
std::string hold_and_circle(int minutes = 1);
inline constexpr double kCircleRadius = 0.03;   ///< [m]
inline constexpr double kCircleHeight = 0.055;  ///< [m]
inline constexpr double kCircleRate = 2.0;      ///< [Hz]

/// The number that follows `name` in the output of a program; fails when there is none.
double number_after(const std::string& output, const std::string& name);

}  // namespace irdm::test
