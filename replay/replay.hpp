#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "server/engine/response_engine.hpp"

namespace irdm::replay {

/// What is to be made again, and what is to be written of it.
struct ReplayOptions {
  std::filesystem::path trace;
  std::vector<std::string> models;   ///< FILE or NAME=FILE
  bool from_tips = false;            ///< the whole step, not only what its forces do
  bool solve_bridged = false;        ///< from tips: what bridges solved, too
  std::optional<EngineKind> engine;  ///< none: the run's own
  bool fem_reference = false;        ///< by finite elements instead of an engine
  std::optional<double> substep;     ///< longest one of a reference [s]; none: its default
  std::optional<double> rate;        ///< frames a second [Hz]; none: every step
  std::optional<std::filesystem::path> output;
  std::optional<std::filesystem::path> csv;
  std::optional<std::filesystem::path> vtk;
};

/// "modal", "dense" or "compressed".
EngineKind engine_from_word(const std::string& word);

/// Makes a run again from its trace, writes what is asked for, and says how far it is from what
/// was recorded. Returns the exit status. Throws Error.
int replay(const ReplayOptions& options);

}  // namespace irdm::replay
