#include "simulation/engine/modal_gravity.hpp"
#include "simulation/state/state_archive.hpp"

namespace irdm {

ModalGravity::ModalGravity(const ModalResponse& response) : response_(response) {
  force_.assign(static_cast<std::size_t>(response.gravity.rows()), 0.0);
  if (response.gravity_rest.rows() > 0) {
    largest_rest_ = response.gravity_rest.cwiseAbs().colwise().maxCoeff();
  }
}

bool ModalGravity::set(const Vector3& gravity) noexcept {
  if (!any() || gravity == coming_) return false;
  coming_ = gravity;
  for (std::size_t i = 0; i < force_.size(); ++i) {
    force_[i] = response_.gravity.row(static_cast<Eigen::Index>(i)).dot(gravity);
  }
  return true;
}

void ModalGravity::settle(AlignedNumbers& coordinate) const noexcept {
  for (std::size_t i = 0; i < force_.size(); ++i) {
    const double omega = response_.angular_frequency(static_cast<Eigen::Index>(i));
    coordinate[i] = force_[i] / (omega * omega);
  }
}

void ModalGravity::archive(StateArchive& state) {
  state.values(force_);
  state.value(last_);
  state.value(coming_);
}

void ModalGravity::add_rest(Points& u) const noexcept {
  if (response_.gravity_rest.rows() == 0 || last_.isZero(0.0)) return;
  for (Eigen::Index node = 0; node < u.rows(); ++node) {
    u.row(node) += (response_.gravity_rest.middleRows<3>(3 * node) * last_).transpose();
  }
}

}  // namespace irdm
