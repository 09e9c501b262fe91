#pragma once

#include <algorithm>
#include <cstddef>

#include "simulation/engine/force_history.hpp"
#include "simulation/engine/kernels.hpp"

namespace irdm {

/// Degrees of freedom that a thread takes at a time: of each column one piece of half a megabyte,
/// as what is fetched ahead at its end is lost; less where there were not four for each thread.
std::size_t row_block(std::size_t dof);

/// Columns of a response that all are in memory: entry (a, b) of step s at (b * dof + a) * steps +
/// s. Points to them.
template <typename Number>
struct ResidentColumns {
  using Value = Number;

  const Number* values = nullptr;  ///< null: there is no such response
  std::size_t dof = 0;
  std::size_t steps = 0;

  const Number* row(int a, int b) const noexcept {
    return values + (static_cast<std::size_t>(b) * dof + static_cast<std::size_t>(a)) * steps;
  }

  const ResidentColumns& frame() const noexcept { return *this; }
  /// All are there, always: see PinnedColumns.
  bool whole(int /*node*/) const noexcept { return true; }
  bool update(const ForceHistory& /*history*/) const noexcept { return false; }

  /// Adds sum over the history of R_i.[age + shift] f[age], i the three degrees of freedom of a
  /// node: shift 0 gives the end of the last step, 1 that of the coming one. Real-time safe.
  void convolve(const ForceHistory& history, int node, int shift, Vector3& u) const noexcept;
  /// That sum with shift 0 for all degrees of freedom, added to u (OpenMP).
  void add_all(const ForceHistory& history, Points& u) const;
};

/// What the forces on degree of freedom b alone add to that sum, times `weight`.
template <typename Columns>
void add_convolution(const Columns& columns, const ForceHistory& history, int b, double weight,
                     int node, int shift, Vector3& u) noexcept {
  const ForceHistory::Series series = history.series(b / 3, b % 3);
  const int first = series.first_age + shift;
  const std::size_t steps = columns.frame().steps;
  const int count = std::min(series.count, static_cast<int>(steps) - first);
  if (count <= 0) return;
  add_products({columns.row(3 * node, b) + first, steps, 3}, series.force,
               static_cast<std::size_t>(count), weight, u.data());
}

}  // namespace irdm
