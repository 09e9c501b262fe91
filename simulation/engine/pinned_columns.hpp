#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

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

/// The columns of R that an engine has taken from a supply, out of those of a StreamedResponse. A
/// node's columns are taken when a force acts on it, and kept until its last force is T steps old,
/// so that what a force began is never broken off. Where they come later than that, a node's share
/// of R in its answer grows evenly within kBlendTime. Real-time safe after construction; one
/// thread.
template <typename Scalar>
class PinnedColumns {
 public:
  using Value = Scalar;
  static constexpr double kBlendTime = 0.05;  ///< [s]

  /// @param response must outlive it, with columns  @param nodes of the surface  @param dt [s]
  PinnedColumns(const StreamedResponse& response, int nodes, double dt);
  ~PinnedColumns();
  PinnedColumns(const PinnedColumns&) = delete;
  PinnedColumns& operator=(const PinnedColumns&) = delete;

  /// Sizes of R.
  const ResidentColumns<Scalar>& frame() const noexcept { return frame_; }
  /// As ResidentColumns'; only of a node with a share.
  const Scalar* row(int a, int b) const noexcept {
    return ResidentColumns<Scalar>{of(b / 3).values, frame_.dof, frame_.steps}.row(a, b % 3);
  }
  /// Of R in a node's answer, 0 to 1.
  double share(int node) const noexcept { return of(node).share; }
  bool whole(int node) const noexcept { return share(node) >= 1.0; }

  /// As ResidentColumns', over the nodes that are whole.
  void convolve(const ForceHistory& history, int node, int shift, Vector3& u) const noexcept;

  /// Nodes that the history has forgotten go, those that are new to it come. True where one became
  /// whole that has a past.
  bool update(const ForceHistory& history) noexcept;
  /// Nodes with a past.
  std::span<const int> pinned() const noexcept { return pinned_; }
  /// Once a step: shares grow. True as above.
  bool blend() noexcept;

  /// For a look at what a node would do, until they are returned.
  void borrow(int node) noexcept;
  void return_borrowed() noexcept;

  /// Nodes that forces began to act on while their columns were not there.
  std::uint64_t missed() const noexcept { return missed_; }
  void clear() noexcept;

 private:
  /// What there is of a node's columns.
  struct Columns {
    const Scalar* values = nullptr;  ///< null: not taken
    double share = 0.0;              ///< of R in its answer
    bool pinned = false;             ///< the history has forces on it
  };

  const Columns& of(int node) const noexcept { return columns_[static_cast<std::size_t>(node)]; }
  bool acquire(Columns& columns, int node) noexcept;
  void release(int node) noexcept;

  ColumnSupply& supply_;
  ResidentColumns<Scalar> frame_;  ///< sizes of R, no values
  double blend_step_;
  std::vector<Columns> columns_;  ///< of each node
  std::vector<int> pinned_;
  std::vector<int> borrowed_;
  int taken_ = 0;
  std::uint64_t missed_ = 0;
};

}  // namespace irdm
