#include "server/engine/running_convolution.hpp"

namespace irdm {

template <typename Number>
RunningConvolution<Number>::RunningConvolution(const ResidentColumns<Number>& columns, int sources)
    : columns_(columns),
      history_(sources, static_cast<int>(columns.steps)),
      stepped_(columns),
      foreseen_(columns) {}

// As the step to come is asked for once this one has ended, the one after next is the coming one.
template <typename Number>
void RunningConvolution<Number>::follow(int node) noexcept {
  stepped_.follow(history_, node, 2);
}

template <typename Number>
void RunningConvolution<Number>::add_coming(int node, Vector3& u) const noexcept {
  if (!stepped_.add_coming(node, 1, u)) columns_.convolve(history_, node, 1, u);
}

template <typename Number>
void RunningConvolution<Number>::foresee(int node, int n) noexcept {
  foreseen_.follow(history_, node, n);
}

template <typename Number>
void RunningConvolution<Number>::add_foreseen(int node, int n, Vector3& u) const noexcept {
  if (!foreseen_.add_coming(node, n, u)) columns_.convolve(history_, node, n, u);
}

template <typename Number>
void RunningConvolution<Number>::push(std::span<const NodalForce> forces) noexcept {
  history_.push(forces);
  stepped_.push(forces);
  foreseen_.push(forces);
}

template <typename Number>
void RunningConvolution<Number>::add_past(std::span<const NodalForce> forces, int age) noexcept {
  if (!history_.add_past(forces, age)) return;
  stepped_.add_past(forces, age);
  foreseen_.add_past(forces, age);
}

template <typename Number>
void RunningConvolution<Number>::clear() noexcept {
  history_.clear();
  stepped_.clear();
  foreseen_.clear();
}

template class RunningConvolution<Half>;
template class RunningConvolution<float>;
template class RunningConvolution<double>;

}  // namespace irdm
