#pragma once

#include <filesystem>
#include <optional>

namespace irdm {

/// The command line of irdm-server.
struct ServerOptions {
  std::filesystem::path scene;
  std::optional<int> port;                      ///< 0..65535; overrides the scene's
  std::optional<std::filesystem::path> record;  ///< trace file
  std::optional<double> duration;               ///< [s], > 0
  bool lockstep = false;
  bool no_viewer = false;                           ///< whatever the scene says
  std::optional<std::filesystem::path> recordings;  ///< folder; overrides the scene's
  std::optional<std::filesystem::path> scenes;      ///< folder; overrides the scene's
  std::optional<std::filesystem::path> play;        ///< trace to show in place of a live run
};

/// Runs a server until its duration is over or a signal asks it to stop. Returns the exit status.
/// Throws Error.
int run_server(const ServerOptions& options);

/// Shows the recorded run `options.play` to browsers until a signal asks it to stop. Returns the
/// exit status. Throws Error.
int run_playback(const ServerOptions& options);

}  // namespace irdm
