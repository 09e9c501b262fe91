#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "common/model/model_file.hpp"
#include "precompute/dynamics/soft_body.hpp"
#include "replay/pictures/drawn_page.hpp"
#include "simulation/engine/response_engine.hpp"

namespace irdm::replay {

/// While it lives, SIGINT and SIGTERM do not end the process but are remembered, so that a long
/// computation can stop in order and leave no half-written file. A handler and not a waiting
/// thread: the threads of the BLAS start before main and may be the ones that a signal is delivered
/// to. One at a time.
class Interruption {
 public:
  Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;
  ~Interruption();

  /// Whether one has come.
  bool came() const noexcept;
};

/// A part of a run, the ends included [s].
struct RunPart {
  double begin = 0.0;
  double end = std::numeric_limits<double>::infinity();
};

/// At the end of which steps of a run there is a frame: those that the times 1/rate, 2/rate, ...
/// fall into, up to the end of the run, as far as these steps end in a part of it.
class FrameSteps {
 public:
  /// @param dt of a step [s], > 0
  /// @param rate frames a second [Hz], at most 1/dt; none: every step. Throws Error.
  FrameSteps(std::size_t steps, double dt, std::optional<double> rate, const RunPart& part = {});

  bool has(std::size_t step) const noexcept;
  /// All of them.
  std::size_t count() const noexcept;
  /// Of the run, up to the end of the part: later ones need not be computed.
  std::size_t steps() const noexcept { return end_; }

 private:
  std::size_t frames_up_to(std::size_t steps) const noexcept;

  double frames_in_step_;
  std::size_t first_;  // step of the part
  std::size_t end_;    // one behind its last
};

/// What is to be rerun, and what is to be written of it.
struct ReplayOptions {
  std::filesystem::path trace;
  std::vector<std::string> models;     ///< FILE or NAME=FILE
  bool from_inputs = false;            ///< the whole step, not only what its forces do
  bool solve_bridged = false;          ///< from inputs: what bridges solved, too
  std::optional<ResponseKind> engine;  ///< none: the run's own
  /// By finite elements of this kind instead of an engine.
  std::optional<precompute::Elasticity> reference;
  std::optional<double> substep;  ///< longest one of a reference [s]; none: its default
  std::optional<double> rate;     ///< frames a second [Hz]; none: every step, or 25 of pictures
  std::optional<std::filesystem::path> output;
  std::optional<std::filesystem::path> csv;
  std::optional<std::filesystem::path> contacts;  ///< table of those between bodies
  std::optional<std::filesystem::path> vtk;
  std::optional<std::filesystem::path> frames;  ///< folder of pictures
  std::optional<std::filesystem::path> video;   ///< of them
  PictureLook look;
  RunPart part;  ///< that there are frames of
};

/// "modal", "dense" or "compressed".
ResponseKind engine_from_word(const std::string& word);

/// Makes a run again from its trace, writes what is asked for, and says how far it is from what
/// was recorded. Returns the exit status. Throws Error.
int replay(const ReplayOptions& options);

}  // namespace irdm::replay
