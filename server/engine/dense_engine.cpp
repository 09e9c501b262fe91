#include "server/engine/dense_engine.hpp"

#include <algorithm>
#include <array>

#include "server/engine/kernels.hpp"

namespace irdm {

template <typename Scalar>
DenseEngine<Scalar>::DenseEngine(std::shared_ptr<const Model> model)
    : model_(std::move(model)),
      history_(model_->mesh.surface_node_count(), model_->steps),
      spin_history_(kSpinProducts / 3, model_->steps) {
  const auto& response = std::get<DenseResponse>(model_->response);
  values_ = std::get<std::vector<Scalar>>(response.values).data();
  if (has_centrifugal(*model_)) {
    centrifugal_ = std::get<std::vector<Scalar>>(response.centrifugal).data();
  }
  dof_ = static_cast<std::size_t>(response.degrees_of_freedom);
  steps_ = static_cast<std::size_t>(response.steps);
}

template <typename Scalar>
double DenseEngine<Scalar>::convolve(const Scalar* values, const ForceHistory& history, int a,
                                     int shift) const noexcept {
  double u = 0.0;
  for (const int node : history.active()) {
    for (int axis = 0; axis < 3; ++axis) {
      const ForceHistory::Series series = history.series(node, axis);
      const int first = series.first_age + shift;
      const int count = std::min(series.count, static_cast<int>(steps_) - first);
      if (count > 0) {
        u += dot(response(values, a, 3 * node + axis) + first, series.force,
                 static_cast<std::size_t>(count));
      }
    }
  }
  return u;
}

template <typename Scalar>
void DenseEngine<Scalar>::hold_spin(const Vector3& w) noexcept {
  if (centrifugal_ != nullptr) coming_ = spin_products(w);
}

template <typename Scalar>
double DenseEngine<Scalar>::free_spin_displacement(int a) const noexcept {
  double u = convolve(centrifugal_, spin_history_, a, 1);
  for (int p = 0; p < kSpinProducts; ++p) {
    u += static_cast<double>(*response(centrifugal_, a, p)) * coming_[p];
  }
  return u;
}

template <typename Scalar>
Vector3 DenseEngine<Scalar>::free_displacement(int node) const noexcept {
  Vector3 u;
  for (int axis = 0; axis < 3; ++axis) {
    u[axis] = convolve(values_, history_, 3 * node + axis, 1);
    if (centrifugal_ != nullptr) u[axis] += free_spin_displacement(3 * node + axis);
  }
  return u;
}

// The answer of a to b `step` steps after the one in which b acted.
template <typename Scalar>
Matrix3 DenseEngine<Scalar>::after(std::size_t step, const ContactPatch& a,
                                   const ContactPatch& b) const noexcept {
  Matrix3 sum = Matrix3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.count); ++i) {
    for (std::size_t j = 0; j < static_cast<std::size_t>(b.count); ++j) {
      const double weight = a.weights[i] * b.weights[j];
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
          const Scalar entry =
              response(values_, 3 * a.nodes[i] + row, 3 * b.nodes[j] + column)[step];
          sum(row, column) += weight * static_cast<double>(entry);
        }
      }
    }
  }
  return sum;
}

template <typename Scalar>
void DenseEngine<Scalar>::predict(std::span<const ContactPatch> patches, std::span<Vector3> h,
                                  ContactMatrix& compliance) noexcept {
  const auto size = static_cast<Eigen::Index>(3 * patches.size());
  compliance.resize(size, size);
  for (std::size_t a = 0; a < patches.size(); ++a) {
    h[a] = mean(patches[a], [&](int node) { return free_displacement(node); });
    for (std::size_t b = 0; b < patches.size(); ++b) {
      compliance.block<3, 3>(static_cast<Eigen::Index>(3 * a), static_cast<Eigen::Index>(3 * b)) =
          after(0, patches[a], patches[b]);
    }
  }
}

template <typename Scalar>
Vector3 DenseEngine<Scalar>::after(std::size_t step, const ContactPatch& a,
                                   const NodalForce& b) const noexcept {
  Vector3 u = Vector3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.count); ++i) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        const Scalar entry = response(values_, 3 * a.nodes[i] + row, 3 * b.node + column)[step];
        u[row] += a.weights[i] * static_cast<double>(entry) * b.force[column];
      }
    }
  }
  return u;
}

template <typename Scalar>
void DenseEngine<Scalar>::foresee(const ContactPatch& patch, std::span<const NodalForce> held,
                                  std::span<Vector3> path, std::span<Matrix3> response) noexcept {
  const auto place = [&](int node, int shift) {
    Vector3 u;
    for (int axis = 0; axis < 3; ++axis) {
      u[axis] = convolve(values_, history_, 3 * node + axis, shift);
      if (centrifugal_ != nullptr) {
        u[axis] += convolve(centrifugal_, spin_history_, 3 * node + axis, shift);
      }
    }
    return u;
  };
  Vector3 by_held = Vector3::Zero();
  for (std::size_t n = 0; n < path.size(); ++n) {
    if (n < steps_) {
      for (const NodalForce& force : held) by_held += after(n, patch, force);
    }
    path[n] = by_held + mean(patch, [&](int node) { return place(node, static_cast<int>(n) + 1); });
  }
  for (std::size_t n = 0; n < response.size(); ++n) {
    response[n] = n < steps_ ? after(n, patch, patch) : Matrix3::Zero();
  }
}

template <typename Scalar>
void DenseEngine<Scalar>::add_past(std::span<const NodalForce> forces, int age) noexcept {
  if (age < kMaxHorizon) history_.add_past(forces, age);
}

template <typename Scalar>
void DenseEngine<Scalar>::advance(std::span<const NodalForce> forces) noexcept {
  history_.push(forces);
  if (centrifugal_ == nullptr) return;
  const std::array<NodalForce, kSpinProducts / 3> products{NodalForce{0, coming_.head<3>()},
                                                           NodalForce{1, coming_.tail<3>()}};
  spin_history_.push(coming_.isZero(0.0) ? std::span<const NodalForce>() : products);
  coming_.setZero();
}

template <typename Scalar>
void DenseEngine<Scalar>::displacement(Points& u) const {
  const int nodes = model_->mesh.surface_node_count();
  u.resize(nodes, 3);
#pragma omp parallel for schedule(static)
  for (int node = 0; node < nodes; ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      u(node, axis) = convolve(values_, history_, 3 * node + axis, 0);
      if (centrifugal_ == nullptr) continue;
      u(node, axis) += convolve(centrifugal_, spin_history_, 3 * node + axis, 0);
    }
  }
}

template <typename Scalar>
Eigen::MatrixXd DenseEngine<Scalar>::instant_compliance() const {
  const auto dof = static_cast<int>(dof_);
  Eigen::MatrixXd R(dof, dof);
  for (int b = 0; b < dof; ++b) {
    for (int a = 0; a < dof; ++a) R(a, b) = static_cast<double>(*response(values_, a, b));
  }
  return R;
}

template <typename Scalar>
void DenseEngine<Scalar>::reset() noexcept {
  history_.clear();
  spin_history_.clear();
  coming_.setZero();
}

template class DenseEngine<float>;
template class DenseEngine<double>;

}  // namespace irdm
