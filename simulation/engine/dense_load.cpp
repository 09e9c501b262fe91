#include "simulation/engine/dense_load.hpp"

#include <array>
#include "simulation/state/state_archive.hpp"

namespace irdm {

template <typename Number>
DenseGravity<Number>::DenseGravity(const GravityResponse& response, int dof, int steps)
    : response_(response), changes_(response.approach, dof, steps) {
  if (any()) largest_sag_ = response.sag.cwiseAbs().colwise().maxCoeff();
}

template <typename Number>
void DenseGravity<Number>::set(const Vector3& gravity) noexcept {
  if (!any()) return;
  coming_ = gravity;
  if (begun_) {
    changes_.hold(coming_ - last_);
  } else {
    last_ = coming_;
  }
}

template <typename Number>
void DenseGravity<Number>::add_sag(int node, Vector3& u) const noexcept {
  if (!coming_.isZero(0.0)) u += response_.sag.template middleRows<3>(3 * node) * coming_;
}

template <typename Number>
void DenseGravity<Number>::add_coming(int node, Vector3& u) const noexcept {
  if (!any()) return;
  add_sag(node, u);
  changes_.add_coming(node, u);
}

template <typename Number>
void DenseGravity<Number>::add_ahead(int node, int n, Vector3& u) const noexcept {
  if (!any()) return;
  add_sag(node, u);
  changes_.add_ahead(node, n, u);
  changes_.add_held(node, n, u);
}

template <typename Number>
void DenseGravity<Number>::add_all(Points& u) const {
  if (!any()) return;
  changes_.add_all(u);
  if (last_.isZero(0.0)) return;
  for (Eigen::Index node = 0; node < u.rows(); ++node) {
    u.row(node) += (response_.sag.template middleRows<3>(3 * node) * last_).transpose();
  }
}

template <typename Number>
void DenseGravity<Number>::advance() noexcept {
  changes_.advance();
  last_ = coming_;
  begun_ = true;
}

template <typename Number>
void DenseGravity<Number>::reset() noexcept {
  changes_.reset();
  last_ = coming_;
  begun_ = false;
}

template <typename Number>
void DenseGravity<Number>::archive(StateArchive& state) {
  changes_.archive(state);
  state.value(last_);
  state.value(coming_);
  state.value(begun_);
}

template class DenseGravity<float>;
template class DenseGravity<double>;

namespace {

template <typename Number>
ResidentColumns<Number> columns_of(
    const std::variant<std::vector<float>, std::vector<double>>& values, int dof, int steps) {
  const auto* numbers = std::get_if<std::vector<Number>>(&values);
  const bool any = numbers != nullptr && !numbers->empty();
  return {any ? numbers->data() : nullptr, any ? static_cast<std::size_t>(dof) : 0,
          static_cast<std::size_t>(steps)};
}

}  // namespace

template <typename Number, int kCount>
DenseLoad<Number, kCount>::DenseLoad(const Values& values, int dof, int steps)
    : columns_(columns_of<Number>(values, dof, steps)), past_(columns_, kCount / 3) {}

template <typename Number, int kCount>
void DenseLoad<Number, kCount>::add_ahead(int node, int n, Vector3& u) const noexcept {
  if (any()) past_.add_ahead(node, n, u);
}

template <typename Number, int kCount>
void DenseLoad<Number, kCount>::cache_node(int node) noexcept {
  if (any()) past_.cache_node(node);
}

template <typename Number, int kCount>
void DenseLoad<Number, kCount>::predict_horizon(int node, int n) noexcept {
  if (any()) past_.predict_horizon(node, n);
}

template <typename Number, int kCount>
void DenseLoad<Number, kCount>::add_held(int node, int n, Vector3& u) const noexcept {
  const auto step = static_cast<std::size_t>(n - 1);
  if (!any() || step >= columns_.steps) return;
  for (int p = 0; p < kCount; ++p) {
    for (int axis = 0; axis < 3; ++axis) {
      u[axis] += static_cast<double>(columns_.row(3 * node + axis, p)[step]) * coming_[p];
    }
  }
}

template <typename Number, int kCount>
void DenseLoad<Number, kCount>::add_coming(int node, Vector3& u) const noexcept {
  if (!any()) return;
  past_.add_coming(node, u);
  add_held(node, 1, u);
}

template <typename Number, int kCount>
void DenseLoad<Number, kCount>::advance() noexcept {
  if (!any()) return;
  std::array<NodalForce, kCount / 3> numbers;
  for (int i = 0; i < kCount / 3; ++i) {
    numbers[static_cast<std::size_t>(i)] = {i, coming_.template segment<3>(3 * i)};
  }
  past_.push(coming_.isZero(0.0) ? std::span<const NodalForce>() : numbers);
  coming_.setZero();
}

template <typename Number, int kCount>
void DenseLoad<Number, kCount>::reset() noexcept {
  past_.clear();
  coming_.setZero();
}

template class DenseLoad<float, kSpinProducts>;
template class DenseLoad<double, kSpinProducts>;
template class DenseLoad<float, 3>;
template class DenseLoad<double, 3>;

}  // namespace irdm
