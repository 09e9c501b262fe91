#include "simulation/engine/dense_gravity.hpp"

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

template class DenseGravity<float>;
template class DenseGravity<double>;

}  // namespace irdm
