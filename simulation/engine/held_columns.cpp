#include "simulation/engine/held_columns.hpp"

#include <algorithm>

#include "common/model/model.hpp"
#include "simulation/engine/kernels.hpp"

namespace irdm {

template <typename Scalar>
HeldColumns<Scalar>::HeldColumns(const StreamedResponse& response, int nodes, double dt)
    : supply_(*response.columns),
      frame_{nullptr, response.scales.empty() ? nullptr : response.scales.data(),
             static_cast<std::size_t>(response.degrees_of_freedom),
             static_cast<std::size_t>(response.steps)},
      blend_step_(std::min(1.0, dt / kBlendTime)),
      columns_(static_cast<std::size_t>(nodes)) {
  followed_.reserve(columns_.size());
  borrowed_.reserve(columns_.size());
}

template <typename Scalar>
HeldColumns<Scalar>::~HeldColumns() {
  clear();
}

template <typename Scalar>
bool HeldColumns<Scalar>::take(Columns& columns, int node) noexcept {
  if (taken_ >= supply_.share()) return false;
  columns.values = static_cast<const Scalar*>(supply_.take(node));
  if (columns.values == nullptr) return false;
  ++taken_;
  return true;
}

template <typename Scalar>
void HeldColumns<Scalar>::give_back(int node) noexcept {
  Columns& columns = columns_[static_cast<std::size_t>(node)];
  if (columns.values != nullptr) {
    supply_.give_back(node);
    --taken_;
  }
  columns = Columns{};
}

template <typename Scalar>
bool HeldColumns<Scalar>::follow(const ForceHistory& history) noexcept {
  std::erase_if(followed_, [&](int node) {
    if (history.holds(node)) return false;
    give_back(node);
    return true;
  });
  bool became_whole = false;
  for (const int node : history.active()) {
    Columns& columns = columns_[static_cast<std::size_t>(node)];
    if (columns.values != nullptr) continue;
    const bool is_new = !columns.followed;
    if (is_new) followed_.push_back(node);
    columns.followed = true;
    if (take(columns, node)) {
      columns.share = is_new ? 1.0 : blend_step_;
      became_whole = became_whole || (!is_new && columns.share >= 1.0);
    } else if (is_new) {
      ++missed_;
    }
  }
  return became_whole;
}

template <typename Scalar>
bool HeldColumns<Scalar>::blend() noexcept {
  bool became_whole = false;
  for (const int node : followed_) {
    Columns& columns = columns_[static_cast<std::size_t>(node)];
    if (columns.values == nullptr || columns.share >= 1.0) continue;
    columns.share = std::min(1.0, columns.share + blend_step_);
    became_whole = became_whole || columns.share >= 1.0;
  }
  return became_whole;
}

template <typename Scalar>
void HeldColumns<Scalar>::convolve(const ForceHistory& history, int node, int shift,
                                   Vector3& u) const noexcept {
  for (const int source : history.active()) {
    if (!whole(source)) continue;
    for (int b = 3 * source; b < 3 * source + 3; ++b) {
      add_convolution(*this, history, b, frame_.scale(static_cast<std::size_t>(b)), node, shift, u);
    }
  }
}

template <typename Scalar>
void HeldColumns<Scalar>::borrow(int node) noexcept {
  Columns& columns = columns_[static_cast<std::size_t>(node)];
  if (columns.followed || columns.values != nullptr || !take(columns, node)) return;
  columns.share = 1.0;
  borrowed_.push_back(node);
}

template <typename Scalar>
void HeldColumns<Scalar>::return_borrowed() noexcept {
  for (const int node : borrowed_) give_back(node);
  borrowed_.clear();
}

template <typename Scalar>
void HeldColumns<Scalar>::clear() noexcept {
  for (const int node : followed_) give_back(node);
  followed_.clear();
}

template class HeldColumns<Half>;
template class HeldColumns<float>;
template class HeldColumns<double>;

}  // namespace irdm
