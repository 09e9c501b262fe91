#include "simulation/engine/pinned_columns.hpp"

#include <omp.h>
#include <algorithm>

#include "common/model/model.hpp"
#include "simulation/engine/force_history.hpp"
#include "simulation/engine/kernels.hpp"

namespace irdm {

std::size_t row_block(std::size_t dof) {
  const auto pieces = 4 * static_cast<std::size_t>(omp_get_max_threads());
  return std::clamp<std::size_t>(dof / pieces / 4 * 4, 64, 256);
}

template <typename Number>
void ResidentColumns<Number>::convolve(const ForceHistory& history, int node, int shift,
                                       Vector3& u) const noexcept {
  for (const int source : history.active()) {
    for (int b = 3 * source; b < 3 * source + 3; ++b) {
      add_convolution(*this, history, b, 1.0, node, shift, u);
    }
  }
}

// Column after column, as R stands in memory: a thread reads its part of each of them from one end
// to the other. Each degree of freedom gets its sums in the same order, whichever thread adds them.
template <typename Number>
void ResidentColumns<Number>::add_all(const ForceHistory& history, Points& u) const {
  const std::vector<NonzeroInterval> intervals = nonzero_intervals(history);
  const std::size_t rows_at_once = row_block(dof);
  const auto blocks = static_cast<int>((dof + rows_at_once - 1) / rows_at_once);
#pragma omp parallel for schedule(dynamic)
  for (int block = 0; block < blocks; ++block) {
    const std::size_t first = static_cast<std::size_t>(block) * rows_at_once;
    const std::size_t count = std::min(rows_at_once, dof - first);
    for (const NonzeroInterval& push : intervals) {
      const Number* rows = values + (push.column * dof + first) * steps + push.first_age;
      add_products({rows, steps, count}, push.force, push.count, 1.0, u.data() + first);
    }
  }
}

template struct ResidentColumns<float>;
template struct ResidentColumns<double>;

template <typename Scalar>
PinnedColumns<Scalar>::PinnedColumns(const StreamedResponse& response, int nodes, double dt)
    : supply_(*response.columns),
      frame_{nullptr, static_cast<std::size_t>(response.degrees_of_freedom),
             static_cast<std::size_t>(response.steps)},
      blend_step_(std::min(1.0, dt / kBlendTime)),
      columns_(static_cast<std::size_t>(nodes)) {
  pinned_.reserve(columns_.size());
  borrowed_.reserve(columns_.size());
}

template <typename Scalar>
PinnedColumns<Scalar>::~PinnedColumns() {
  clear();
}

template <typename Scalar>
bool PinnedColumns<Scalar>::acquire(Columns& columns, int node) noexcept {
  if (taken_ >= supply_.share()) return false;
  columns.values = static_cast<const Scalar*>(supply_.acquire(node));
  if (columns.values == nullptr) return false;
  ++taken_;
  return true;
}

template <typename Scalar>
void PinnedColumns<Scalar>::release(int node) noexcept {
  Columns& columns = columns_[static_cast<std::size_t>(node)];
  if (columns.values != nullptr) {
    supply_.release(node);
    --taken_;
  }
  columns = Columns{};
}

template <typename Scalar>
bool PinnedColumns<Scalar>::update(const ForceHistory& history) noexcept {
  std::erase_if(pinned_, [&](int node) {
    if (history.holds(node)) return false;
    release(node);
    return true;
  });
  bool became_whole = false;
  for (const int node : history.active()) {
    Columns& columns = columns_[static_cast<std::size_t>(node)];
    if (columns.values != nullptr) continue;
    const bool is_new = !columns.pinned;
    if (is_new) pinned_.push_back(node);
    columns.pinned = true;
    if (acquire(columns, node)) {
      columns.share = is_new ? 1.0 : blend_step_;
      became_whole = became_whole || (!is_new && columns.share >= 1.0);
    } else if (is_new) {
      ++missed_;
    }
  }
  return became_whole;
}

template <typename Scalar>
bool PinnedColumns<Scalar>::blend() noexcept {
  bool became_whole = false;
  for (const int node : pinned_) {
    Columns& columns = columns_[static_cast<std::size_t>(node)];
    if (columns.values == nullptr || columns.share >= 1.0) continue;
    columns.share = std::min(1.0, columns.share + blend_step_);
    became_whole = became_whole || columns.share >= 1.0;
  }
  return became_whole;
}

template <typename Scalar>
void PinnedColumns<Scalar>::convolve(const ForceHistory& history, int node, int shift,
                                     Vector3& u) const noexcept {
  for (const int source : history.active()) {
    if (!whole(source)) continue;
    for (int b = 3 * source; b < 3 * source + 3; ++b) {
      add_convolution(*this, history, b, 1.0, node, shift, u);
    }
  }
}

template <typename Scalar>
void PinnedColumns<Scalar>::borrow(int node) noexcept {
  Columns& columns = columns_[static_cast<std::size_t>(node)];
  if (columns.pinned || columns.values != nullptr || !acquire(columns, node)) return;
  columns.share = 1.0;
  borrowed_.push_back(node);
}

template <typename Scalar>
void PinnedColumns<Scalar>::return_borrowed() noexcept {
  for (const int node : borrowed_) release(node);
  borrowed_.clear();
}

template <typename Scalar>
void PinnedColumns<Scalar>::clear() noexcept {
  for (const int node : pinned_) release(node);
  pinned_.clear();
}

template class PinnedColumns<float>;
template class PinnedColumns<double>;

}  // namespace irdm
