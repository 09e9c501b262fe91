#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/model/model_file.hpp"
#include "precompute/dynamics/soft_body.hpp"
#include "replay/frame_steps.hpp"
#include "replay/pictures/picture_look.hpp"
#include "simulation/engine/response_engine.hpp"

namespace irdm::replay {

/// What is to be made again, and what is to be written of it.
struct ReplayOptions {
  std::filesystem::path trace;
  std::vector<std::string> models;     ///< FILE or NAME=FILE
  bool from_inputs = false;            ///< the whole step, not only what its forces do
  bool solve_bridged = false;          ///< from tips: what bridges solved, too
  std::optional<ResponseKind> engine;  ///< none: the run's own
  /// By finite elements of this kind instead of an engine.
  std::optional<precompute::Elasticity> reference;
  std::optional<double> substep;  ///< longest one of a reference [s]; none: its default
  std::optional<double> rate;     ///< frames a second [Hz]; none: every step, or 25 of pictures
  std::optional<std::filesystem::path> output;
  std::optional<std::filesystem::path> csv;
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
