#pragma once

#include <cstddef>

#include "common/half.hpp"
#include "server/engine/force_history.hpp"

namespace irdm {

/// Degrees of freedom that a thread takes at a time: some 100 kB of each column.
inline constexpr std::size_t kRowBlock = 64;

/// Columns of a response that all are in memory: entry (a, b) of step s at (b * dof + a) * steps +
/// s, times the scale of column b. Points to them.
template <typename Number>
struct ResidentColumns {
  const Number* values = nullptr;  ///< null: there is no such response
  const double* scales = nullptr;  ///< of the columns; null: all 1
  std::size_t dof = 0;
  std::size_t steps = 0;

  const Number* row(int a, int b) const noexcept {
    return values + (static_cast<std::size_t>(b) * dof + static_cast<std::size_t>(a)) * steps;
  }
  double scale(std::size_t b) const noexcept { return scales == nullptr ? 1.0 : scales[b]; }

  /// Adds sum over the history of R_i.[age + shift] f[age], i the three degrees of freedom of a
  /// node: shift 0 gives the end of the last step, 1 that of the coming one. Real-time safe.
  void convolve(const ForceHistory& history, int node, int shift, Vector3& u) const noexcept;
  /// That sum with shift 0 for all degrees of freedom, added to u (OpenMP).
  void add_all(const ForceHistory& history, Points& u) const;
};

}  // namespace irdm
