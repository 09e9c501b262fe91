#include "replay/replay.hpp"

#include <unistd.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <iostream>
#include <limits>
#include <memory>
#include <sstream>
#include <string>

#include "common/checksum.hpp"
#include "common/error.hpp"
#include "precompute/progress.hpp"
#include "replay/output/contact_output.hpp"
#include "replay/output/csv_output.hpp"
#include "replay/output/picture_output.hpp"
#include "replay/output/run_output.hpp"
#include "replay/output/vtk_output.hpp"
#include "replay/reference/fem_reference.hpp"
#include "replay/rerun/deviation.hpp"
#include "replay/rerun/rerun.hpp"
#include "replay/traced_scene.hpp"
#include "trace/recording.hpp"

namespace irdm::replay {
namespace {

constexpr std::array<int, 2> kInterrupting{SIGINT, SIGTERM};

volatile std::sig_atomic_t interrupted = 0;

void remember(int /*signal*/) {
  interrupted = 1;
}

}  // namespace

Interruption::Interruption() {
  interrupted = 0;
  for (const int signal : kInterrupting) {
    if (std::signal(signal, remember) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

Interruption::~Interruption() {
  for (const int signal : kInterrupting) {
    if (std::signal(signal, SIG_DFL) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

bool Interruption::came() const noexcept {
  return interrupted != 0;
}

FrameSteps::FrameSteps(std::size_t steps, double dt, std::optional<double> rate,
                       const RunPart& part)
    : frames_in_step_(rate ? *rate * dt : 1.0) {
  constexpr double kRounding = 1e-9;
  if (frames_in_step_ > 1.0 + kRounding) {
    throw Error("--rate", "is above the rate of the steps",
                "use at most " + std::to_string(1.0 / dt) + " Hz, or leave it out for every step");
  }
  const double length = static_cast<double>(steps);
  first_ = static_cast<std::size_t>(
      std::clamp(std::ceil(part.begin / dt - kRounding) - 1.0, 0.0, length));
  end_ = static_cast<std::size_t>(std::min(std::floor(part.end / dt + kRounding), length));
  if (steps == 0 || first_ < end_) return;
  throw Error("--begin, --end",
              "leave out all of the run, which is " + std::to_string(length * dt) + " s long",
              "give times within it, the first below the second");
}

// Frame j = 1, 2, ... is in step k = 0, 1, ... when k < j / frames_in_step <= k + 1.
std::size_t FrameSteps::frames_up_to(std::size_t steps) const noexcept {
  constexpr double kRounding = 1e-6;
  return static_cast<std::size_t>(
      std::floor(static_cast<double>(steps) * frames_in_step_ + kRounding));
}

bool FrameSteps::has(std::size_t step) const noexcept {
  return step >= first_ && step < end_ && frames_up_to(step + 1) > frames_up_to(step);
}

std::size_t FrameSteps::count() const noexcept {
  return frames_up_to(end_) - frames_up_to(first_);
}

namespace {

using Outputs = std::vector<std::unique_ptr<FrameOutput>>;

// What is wrong with later steps is no reason to refuse those up to --end.
Recording read_steps_to_end(const TracedScene& scene, const std::string& trace,
                            const RunPart& part) {
  try {
    return {trace, scene.config, scene.names()};
  } catch (const Error& error) {
    const double steps = std::ceil(part.end / scene.dt());
    if (!(steps < static_cast<double>(std::numeric_limits<int>::max()))) throw;
    Recording recording(trace, scene.config, scene.names(), static_cast<std::size_t>(steps));
    std::cerr << "irdm-replay: warning: only the steps up to --end are read: " << error.what()
              << '\n';
    return recording;
  }
}

Recording read_recording(const TracedScene& scene, const std::string& trace, const RunPart& part) {
  Recording recording = read_steps_to_end(scene, trace, part);
  if (recording.lost_steps() == 0) return recording;
  throw Error(trace,
              "lacks " + std::to_string(recording.lost_steps()) +
                  " steps, which were lost on the way to the disk",
              "record it again on a disk that is fast enough");
}

/// All that the steps of a reference depend on.
std::string reference_key(const TracedScene& scene, const ReplayOptions& options) {
  std::ostringstream key;
  key.precision(17);
  key << "irdm " << IRDM_VERSION << " trace " << sha256_of_file(options.trace) << " substep "
      << fem_substep(scene.dt(), options.substep.value_or(kReferenceSubstep)) << " tips "
      << options.from_inputs << " elasticity " << static_cast<int>(*options.reference);
  for (const TracedObject& object : scene.objects) key << " model " << object.checksum;
  return key.str();
}

/// Of a reference: beside the first of its outputs.
std::optional<std::filesystem::path> journal_path(const ReplayOptions& options) {
  if (!options.reference) return std::nullopt;
  for (const auto& output :
       {options.output, options.csv, options.contacts, options.vtk, options.frames}) {
    if (output) return std::filesystem::path(output->string() + ".steps");
  }
  return std::nullopt;
}

std::unique_ptr<Rerun> make_rerun(const TracedScene& scene, const std::vector<DelayedForces>& late,
                                  const ReplayOptions& options, StepJournal* journal) {
  if (options.reference) {
    return fem_reference(scene, *options.reference, options.substep.value_or(kReferenceSubstep),
                         options.from_inputs, late, journal);
  }
  if (options.from_inputs) return std::make_unique<InputRerun>(scene.config, options.solve_bridged);
  return std::make_unique<ForceRerun>(scene.config);
}

std::string how(const TracedScene& scene, const ReplayOptions& options) {
  if (!options.reference) return "engine " + scene.engine_words();
  char words[64];
  std::snprintf(words, sizeof words, "%sfinite elements in sub-steps of %g s",
                options.reference == precompute::Elasticity::kNeoHookean ? "neo-Hookean " : "",
                fem_substep(scene.dt(), options.substep.value_or(kReferenceSubstep)));
  return words;
}

std::optional<double> frame_rate(const ReplayOptions& options) {
  constexpr double kOfPictures = 25.0;
  return options.rate || !options.frames ? options.rate : kOfPictures;
}

Outputs make_outputs(const ReplayOptions& options, const TracedScene& scene) {
  Outputs outputs;
  if (options.csv) outputs.push_back(std::make_unique<CsvOutput>(*options.csv, scene));
  if (options.contacts) {
    outputs.push_back(std::make_unique<ContactOutput>(*options.contacts, scene));
  }
  if (options.vtk) outputs.push_back(std::make_unique<VtkOutput>(*options.vtk, scene));
  if (options.frames) {
    outputs.push_back(std::make_unique<PictureOutput>(PicturePlaces{*options.frames, options.video},
                                                      options.look, scene, *frame_rate(options)));
  }
  if (options.output) {
    outputs.push_back(std::make_unique<RunOutput>(
        *options.output, scene,
        RunOrigin{options.trace.filename().string(), options.from_inputs ? "inputs" : "forces",
                  how(scene, options)}));
  }
  return outputs;
}

void put_frame(const Rerun& made, const StepRecord& record, std::vector<Points>& surfaces,
               Outputs& outputs, const std::string& trace) {
  bool looked_at = false;
  for (const auto& output : outputs) looked_at = looked_at || output->needs_surfaces();
  for (std::size_t i = 0; i < surfaces.size() && looked_at; ++i) made.displacement(i, surfaces[i]);
  require_finite(surfaces, trace);
  for (const auto& output : outputs) output->put({record, surfaces});
}

/// What a person waits for, and may end: SIGINT and SIGTERM stop it after a step.
class LongRun {
 public:
  /// @param shown whether it takes so long that progress is printed
  /// @param goes_on whether the next call goes on where this one ends
  LongRun(std::size_t steps, bool shown, bool goes_on) : goes_on_(goes_on) {
    if (!shown) return;
    const precompute::Console console{std::cout, ::isatty(STDOUT_FILENO) != 0};
    progress_.emplace(console, "finite elements", static_cast<int>(steps));
  }
  /// Throws Error when a signal has come.
  void done(std::size_t steps) {
    if (progress_) progress_->update(static_cast<int>(steps));
    if (!interruption_.came()) return;
    throw Error("irdm-replay", "was interrupted after " + std::to_string(steps) + " steps",
                goes_on_ ? "start it again, and it goes on there"
                         : "start it again for outputs that are whole");
  }

 private:
  bool goes_on_;
  Interruption interruption_;
  std::optional<precompute::Progress> progress_;
};

std::string taken_text(const std::optional<StepJournal>& journal, const TracedScene& scene) {
  if (!journal || journal->taken() == 0) return "";
  return std::to_string(journal->taken() / scene.objects.size()) +
         " of these steps are from a run that was interrupted\n";
}

}  // namespace

int replay(const ReplayOptions& options) {
  const TracedScene scene = read_traced_scene(options.trace, options.models, options.engine);
  for (const std::string& warning : scene.warnings) {
    std::cerr << "irdm-replay: warning: " << warning << '\n';
  }
  const Recording recording = read_recording(scene, options.trace.string(), options.part);
  const FrameSteps frames(recording.steps(), scene.dt(), frame_rate(options), options.part);
  const auto path = journal_path(options);
  LongRun run(frames.steps(), options.reference.has_value(), path.has_value());
  Outputs outputs = make_outputs(options, scene);
  std::optional<StepJournal> journal;
  if (path) journal.emplace(*path, reference_key(scene, options));
  const std::vector<DelayedForces> late =
      options.solve_bridged ? std::vector<DelayedForces>() : delayed_forces(recording);
  const auto made = make_rerun(scene, late, options, journal ? &*journal : nullptr);
  std::vector<Points> surfaces(scene.config.objects.size());
  Deviation deviation;
  const auto recorded = std::make_unique<StepRecord>();
  const auto again = std::make_unique<StepRecord>();
  for (std::size_t k = 0; k < frames.steps(); ++k) {
    recording.step(k, *recorded);
    made->step(*recorded, *again);
    require_finite(*again, options.trace.string());
    deviation.add(*recorded, *again);
    add_delayed_forces(late, k, options.reference && options.from_inputs, *again);
    if (frames.has(k)) put_frame(*made, *again, surfaces, outputs, options.trace.string());
    run.done(k + 1);
  }
  for (const auto& output : outputs) output->finish();
  if (journal) journal->remove();
  std::cout << options.trace.string() << ": " << frames.steps() << " steps of " << scene.dt()
            << " s from " << (options.from_inputs ? "inputs" : "forces") << ", "
            << how(scene, options) << "; " << frames.count() << " frames\n"
            << taken_text(journal, scene) << deviation.text() << std::flush;
  return 0;
}

}  // namespace irdm::replay
