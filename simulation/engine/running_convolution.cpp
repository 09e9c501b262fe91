#include "simulation/engine/running_convolution.hpp"

#include "simulation/engine/held_columns.hpp"

namespace irdm {

template <typename Columns>
RunningConvolution<Columns>::RunningConvolution(Columns& columns, int sources)
    : columns_(columns),
      history_(sources, static_cast<int>(columns.frame().steps)),
      stepped_(columns),
      foreseen_(columns) {}

// As the step to come is asked for once this one has ended, the one after next is the coming one.
template <typename Columns>
void RunningConvolution<Columns>::follow(int node) noexcept {
  stepped_.follow(history_, node, 2);
}

template <typename Columns>
void RunningConvolution<Columns>::add_coming(int node, Vector3& u) const noexcept {
  if (!stepped_.add_coming(node, 1, u)) columns_.convolve(history_, node, 1, u);
}

template <typename Columns>
void RunningConvolution<Columns>::foresee(int node, int n) noexcept {
  foreseen_.follow(history_, node, n);
}

template <typename Columns>
void RunningConvolution<Columns>::add_foreseen(int node, int n, Vector3& u) const noexcept {
  if (!foreseen_.add_coming(node, n, u)) columns_.convolve(history_, node, n, u);
}

template <typename Columns>
void RunningConvolution<Columns>::push(std::span<const NodalForce> forces) noexcept {
  history_.push(forces);
  if (columns_.follow(history_)) keep_nothing();
  stepped_.push(forces);
  foreseen_.push(forces);
}

template <typename Columns>
void RunningConvolution<Columns>::add_past(std::span<const NodalForce> forces, int age) noexcept {
  if (!history_.add_past(forces, age)) return;
  if (columns_.follow(history_)) keep_nothing();
  stepped_.add_past(forces, age);
  foreseen_.add_past(forces, age);
}

template <typename Columns>
void RunningConvolution<Columns>::clear() noexcept {
  history_.clear();
  keep_nothing();
}

template <typename Columns>
void RunningConvolution<Columns>::keep_nothing() noexcept {
  stepped_.clear();
  foreseen_.clear();
}

template class RunningConvolution<ResidentColumns<Half>>;
template class RunningConvolution<ResidentColumns<float>>;
template class RunningConvolution<ResidentColumns<double>>;
template class RunningConvolution<HeldColumns<Half>>;
template class RunningConvolution<HeldColumns<float>>;
template class RunningConvolution<HeldColumns<double>>;

}  // namespace irdm
