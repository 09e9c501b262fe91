#include "server/command.hpp"

#include <CLI/CLI.hpp>
#include <memory>

#include "server/run_server.hpp"

namespace irdm {

Command add_server_command(CLI::App& app) {
  const auto options = std::make_shared<ServerOptions>();
  app.add_option("scene", options->scene, "Scene file (TOML)")->required();
  app.add_option("--port", options->port,
                 "TCP port to listen on; 0: any free one (default: the scene's)")
      ->check(CLI::Range(0, 65535));
  app.add_option("--record", options->record,
                 "Trace file (HDF5) to record the run in; must not exist");
  app.add_option("--duration", options->duration,
                 "Seconds to run, simulated ones in lockstep (default: until stopped)")
      ->check(positive_number());
  app.add_flag("--lockstep", options->lockstep,
               "Simulated clock: step k uses exactly sample k of every stylus");
  app.add_flag("--no-viewer", options->no_viewer, "Do not serve the view for browsers");
  app.add_option("--recordings", options->recordings,
                 "Folder for what is recorded from the browser (default: the scene's)");
  app.add_option("--scenes", options->scenes,
                 "Folder of scenes and models that the browser may load, and save scenes into "
                 "(default: the scene's)");
  app.add_option("--play", options->play,
                 "Trace file to show in the browser in place of a live run of the scene")
      ->excludes("--record", "--lockstep", "--no-viewer", "--duration", "--scenes");
  return [options] { return options->play ? run_playback(*options) : run_server(*options); };
}

}  // namespace irdm
