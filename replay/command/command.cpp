#include "replay/command/command.hpp"

#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>

#include "common/error.hpp"
#include "common/program/program.hpp"
#include "replay/compare/comparison_output.hpp"
#include "replay/output/output_file.hpp"
#include "replay/replay.hpp"

namespace irdm::replay {
namespace {

struct CompareOptions {
  std::filesystem::path a, b;
  std::optional<std::filesystem::path> json;
  std::vector<double> hand;  // mass, damping, stiffness; or empty
  double lag = 0.0;          ///< [s]
};

void write_text(const std::filesystem::path& path, const std::string& text) {
  PartFile file(path);
  std::ofstream stream(file.part(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw Error(file.part().string(), "cannot be written", "make room on the disk");
  file.finish();
}

perception::Hand hand_of(const CompareOptions& options) {
  if (options.hand.empty()) return {};
  return {options.hand[0], options.hand[1], options.hand[2]};
}

int compare(const CompareOptions& options) {
  const RunReader a(options.a);
  const RunReader b(options.b, options.lag);
  const Comparison comparison = compare_runs(a, b);
  const Measures measures = measure_runs(a, b, comparison, hand_of(options));
  if (options.json) write_text(*options.json, comparison_json(comparison, measures));
  std::cout << comparison_table(comparison, measures) << std::flush;
  return 0;
}

}  // namespace

Command add_compare_command(CLI::App& app) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command =
      app.add_subcommand("compare", "Says how far two runs of the same interaction are apart");
  command->add_option("a", options->a, "Run file that --output wrote")->required();
  command->add_option("b", options->b, "Another one, of the same scene")->required();
  command->add_option("--lag", options->lag,
                      "Time by which B is later, as by the way of a link (s; default: 0)");
  command->add_option("--json", options->json,
                      "File for all of it, frame by frame; must not exist");
  const auto refuse = [](const std::string&) {
    throw CLI::ValidationError("--html",
                               "was removed; use --json FILE, then scripts/plot_comparison.py");
  };
  command->add_option_function<std::string>("--html", refuse)->group("");
  command
      ->add_option("--hand", options->hand,
                   "Mass with the device's (kg), damping (N s/m) and stiffness (N/m) of the hand "
                   "that feels vibrations (default: 0.12 2 300)")
      ->expected(3)
      ->check(positive_number());
  return [options] { return compare(*options); };
}

namespace {

void check_reference(const ReplayOptions& options, const std::string& engine) {
  if (!options.reference) {
    if (!options.substep) return;
    throw Error("--substep", "is of a reference", "give --reference fem, too");
  }
  if (options.solve_bridged) {
    throw Error("--solve-bridged", "cannot be combined with --reference", "leave out one of them");
  }
  if (engine.empty()) return;
  throw Error("--engine " + shortened(engine), "means nothing to a reference, which has none",
              "leave one of them out");
}

/// What is read from words once the command line is whole.
struct PictureWords {
  std::string size;
  std::string camera;
};

void add_picture_options(CLI::App& app, ReplayOptions& options, PictureWords& words) {
  PictureLook& look = options.look;
  CLI::Option* const frames = app.add_option(
      "--frames", options.frames,
      "Folder for pictures (PNG) with the look of the viewer, drawn by chromium; new or empty");
  const std::vector<CLI::Option*> of_pictures{
      app.add_option("--video", options.video,
                     "Video of the pictures (MP4), made by ffmpeg; must not exist"),
      app.add_option("--size", words.size,
                     "WIDTHxHEIGHT of a picture in pixels (default: 1280x720)"),
      app.add_option("--camera", words.camera,
                     "AZIMUTH,ELEVATION that it is seen from, in degrees: round the vertical from "
                     "the z axis towards x, and above the horizon (default: the page's own, about "
                     "29,20)"),
      app.add_flag("--still", look.still, "The camera does not go along"),
      app.add_option("--exaggeration", look.exaggeration, "Of the deformation")
          ->check(CLI::Range(0.0, 20.0))
          ->capture_default_str(),
      app.add_flag("--rigid", look.rigid, "The rigid body as a wireframe"),
      app.add_option("--colour", look.colour, "What colours tell")
          ->check(CLI::IsMember({"none", "displacement", "velocity", "compliance"}))
          ->capture_default_str(),
      app.add_flag("--dark", look.dark, "Dark colours")};
  for (CLI::Option* const option : of_pictures) option->needs(frames);
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
                 "forces: what was exerted moves the objects again; inputs: the whole step is made "
                 "again from where the styluses were")
      ->check(CLI::IsMember({"forces", "inputs"}))
      ->capture_default_str();
  app.add_flag("--solve-bridged", options->solve_bridged,
               "From inputs: contacts that bridges solved are solved here too");
  app.add_option("--engine", *engine, "Engine to compute with (default: the run's own)")
      ->check(CLI::IsMember({"modal", "dense", "compressed"}));
  auto reference = std::make_shared<std::string>();
  app.add_option("--reference", *reference,
                 "By finite elements on the model's mesh instead of an engine (slow). fem: linear "
                 "elasticity and large rotations; fem-nonlinear: neo-Hookean, large strains")
      ->check(CLI::IsMember({"fem", "fem-nonlinear"}));
  app.add_option("--substep", options->substep,
                 "Longest step of a reference in s (default: 0.00025)")
      ->check(positive_number());
  app.add_option("--rate", options->rate,
                 "Frames for a second of the run (default: every step; with --frames 25)")
      ->check(positive_number());
  app.add_option("--begin", options->part.begin, "Time in s before which there are no frames")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--end", options->part.end, "Time in s at which to stop")
      ->check(positive_number());
  app.add_option("-o,--output", options->output,
                 "Run file to write, for compare (HDF5); must not exist");
  app.add_option("--csv", options->csv, "Table of motion and forces to write; must not exist");
  app.add_option("--contacts", options->contacts,
                 "Table of contacts between bodies to write; must not exist");
  app.add_option("--vtk", options->vtk,
                 "Folder for surfaces that ParaView opens (run.pvd); new or empty");
  auto words = std::make_shared<PictureWords>();
  add_picture_options(app, *options, *words);
  app.parse_complete_callback([&app, trace] {
    if (app.get_subcommands().empty() && trace->empty()) throw CLI::RequiredError("trace");
  });
  return [options, from, engine, reference, words] {
    if (!words->size.empty()) read_size(words->size, options->look);
    if (!words->camera.empty()) options->look.camera = read_camera(words->camera);
    options->from_inputs = *from == "inputs";
    if (options->solve_bridged && !options->from_inputs) {
      throw Error("--solve-bridged", "solves nothing from forces", "give --from inputs, too");
    }
    if (!reference->empty()) {
      options->reference = *reference == "fem" ? precompute::Elasticity::kCorotational
                                               : precompute::Elasticity::kNeoHookean;
    }
    check_reference(*options, *engine);
    if (!engine->empty()) options->engine = engine_from_word(*engine);
    return replay(*options);
  };
}

}  // namespace irdm::replay
