#include "replay/replay.hpp"

#include <memory>

#include "common/error.hpp"
#include "common/program/program.hpp"
#include "replay/command/command.hpp"

namespace irdm::replay {
namespace {

void check_reference(const ReplayOptions& options, const std::string& engine) {
  if (!options.fem_reference) {
    if (!options.substep) return;
    throw Error("--substep", "is of a reference", "give --reference fem, too");
  }
  if (options.solve_bridged) {
    throw Error("--solve-bridged", "is of the force step", "leave out one of it and --reference");
  }
  if (engine.empty()) return;
  throw Error("--engine " + engine, "means nothing to a reference, which has none",
              "leave one of them out");
}

}  // namespace

Command add_replay_command(CLI::App& app) {
  auto options = std::make_shared<ReplayOptions>();
  auto from = std::make_shared<std::string>("forces");
  auto engine = std::make_shared<std::string>();
  CLI::Option* trace =
      app.add_option("trace", options->trace, "Trace file of irdm-server --record; required");
  app.add_option("--model", options->models,
                 "Model file, or NAME=FILE for one of several objects (default: that of the "
                 "trace, beside it or where its scene says)")
      ->allow_extra_args(false);
  app.add_option("--from", *from,
                 "forces: what was exerted moves the objects again; tips: the whole step is made "
                 "again from where the styluses were")
      ->check(CLI::IsMember({"forces", "tips"}))
      ->capture_default_str();
  app.add_flag("--solve-bridged", options->solve_bridged,
               "From tips: contacts that bridges solved are solved here too");
  app.add_option("--engine", *engine, "Engine to compute with (default: the run's own)")
      ->check(CLI::IsMember({"modal", "dense", "compressed"}));
  auto reference = std::make_shared<std::string>();
  app.add_option("--reference", *reference,
                 "fem: by finite elements on the model's mesh instead of an engine (slow)")
      ->check(CLI::IsMember({"fem"}));
  app.add_option("--substep", options->substep,
                 "Longest step of a reference in s (default: 0.00025)")
      ->check(positive_number());
  app.add_option("--rate", options->rate, "Frames for a second of the run (default: every step)")
      ->check(positive_number());
  app.add_option("-o,--output", options->output,
                 "Run file to write, for compare (HDF5); must not exist");
  app.add_option("--csv", options->csv, "Table of motion and forces to write; must not exist");
  app.add_option("--vtk", options->vtk,
                 "Folder for surfaces that ParaView opens (run.pvd); new or empty");
  app.parse_complete_callback([&app, trace] {
    if (app.get_subcommands().empty() && trace->empty()) throw CLI::RequiredError("trace");
  });
  return [options, from, engine, reference] {
    options->from_tips = *from == "tips";
    if (options->solve_bridged && !options->from_tips) {
      throw Error("--solve-bridged", "solves nothing from forces", "give --from tips, too");
    }
    options->fem_reference = !reference->empty();
    check_reference(*options, *engine);
    if (!engine->empty()) options->engine = engine_from_word(*engine);
    return replay(*options);
  };
}

}  // namespace irdm::replay
