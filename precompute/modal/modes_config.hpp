#pragma once

#include <optional>

#include "common/config/toml_reader.hpp"

namespace irdm::precompute {

/// Who finds the lowest modes.
enum class ModeSolver {
  kSpectra,         ///< Spectra in one process, with a sparse Cholesky factorisation
  kSlepc,           ///< SLEPc on any number of ranks, with a factorisation by MUMPS
  kSlepcMultigrid,  ///< SLEPc on any number of ranks, with conjugate gradients and multigrid (GAMG)
};

/// [modes]: which of the elastic modes are computed. At most one of `count`, `highest_frequency`
/// and `error`; none: all of them.
struct ModesConfig {
  std::optional<int> count;                 ///< the lowest so many, 1..20 000
  std::optional<double> highest_frequency;  ///< all up to this [Hz], > 0
  /// As few as keep the force under a fingertip within this share of that of all modes, 1e-4..0.5.
  std::optional<double> error;
  /// Of that fingertip [m], > 0. What the missing modes would add is kept for nodes up to twice as
  /// far apart.
  double contact_radius = 0.015;
  ModeSolver solver = ModeSolver::kSpectra;

  bool all() const { return !count && !highest_frequency && !error; }
};

/// Throws Error with file and line.
ModesConfig read_modes(TomlTable table);

}  // namespace irdm::precompute
