#include "server/engine/dense_spin.hpp"

#include <array>

namespace irdm {
namespace {

template <typename Number>
ResidentColumns<Number> columns_of(const typename DenseSpin<Number>::Values& values, int dof,
                                   int steps) {
  const auto* numbers = std::get_if<std::vector<Number>>(&values);
  const bool any = numbers != nullptr && !numbers->empty();
  return {any ? numbers->data() : nullptr, nullptr, any ? static_cast<std::size_t>(dof) : 0,
          static_cast<std::size_t>(steps)};
}

}  // namespace

template <typename Number>
DenseSpin<Number>::DenseSpin(const Values& values, int dof, int steps)
    : columns_(columns_of<Number>(values, dof, steps)), past_(columns_, kSpinProducts / 3) {}

template <typename Number>
void DenseSpin<Number>::hold(const Vector3& w) noexcept {
  if (any()) coming_ = spin_products(w);
}

template <typename Number>
void DenseSpin<Number>::add_foreseen(int node, int n, Vector3& u) const noexcept {
  if (any()) past_.add_foreseen(node, n, u);
}

template <typename Number>
void DenseSpin<Number>::follow(int node) noexcept {
  if (any()) past_.follow(node);
}

template <typename Number>
void DenseSpin<Number>::foresee(int node, int n) noexcept {
  if (any()) past_.foresee(node, n);
}

template <typename Number>
void DenseSpin<Number>::add_coming(int node, Vector3& u) const noexcept {
  if (!any()) return;
  past_.add_coming(node, u);
  for (int p = 0; p < kSpinProducts; ++p) {
    for (int axis = 0; axis < 3; ++axis) {
      u[axis] += static_cast<double>(*columns_.row(3 * node + axis, p)) * coming_[p];
    }
  }
}

template <typename Number>
void DenseSpin<Number>::advance() noexcept {
  if (!any()) return;
  const std::array<NodalForce, kSpinProducts / 3> products{NodalForce{0, coming_.head<3>()},
                                                           NodalForce{1, coming_.tail<3>()}};
  past_.push(coming_.isZero(0.0) ? std::span<const NodalForce>() : products);
  coming_.setZero();
}

template <typename Number>
void DenseSpin<Number>::reset() noexcept {
  past_.clear();
  coming_.setZero();
}

template class DenseSpin<float>;
template class DenseSpin<double>;

}  // namespace irdm
