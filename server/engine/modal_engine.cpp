#include "server/engine/modal_engine.hpp"

#include <algorithm>
#include <cmath>

#include "common/response/oscillator.hpp"
#include "server/engine/kernels.hpp"

namespace irdm {

namespace {

// A decaying mode would end in denormal numbers, which cost a hundred times as much to compute
// with. Far below anything that matters (the shapes are of order 1), it is put to rest.
double put_to_rest(double x) noexcept {
  constexpr double kNothing = 1e-100;
  return std::abs(x) < kNothing ? 0.0 : x;
}

}  // namespace

template <typename Scalar>
ModalEngine<Scalar>::ModalEngine(std::shared_ptr<const Model> model) : model_(std::move(model)) {
  const auto& response = std::get<ModalResponse>(model_->response);
  shapes_ = &std::get<RowMatrix<Scalar>>(response.shapes);
  modes_ = static_cast<std::size_t>(response.mode_count());
  for (auto* values : {&a11_, &a12_, &a21_, &a22_, &b1_, &b2_, &coordinate_, &velocity_,
                       &free_coordinate_, &free_velocity_, &modal_force_, &weighted_row_}) {
    values->assign(modes_, 0.0);
  }
  contact_shapes_.assign(3 * kMaxContacts * modes_, 0.0);
  for (std::size_t i = 0; i < modes_; ++i) {
    const auto index = static_cast<Eigen::Index>(i);
    const HeldForceOscillator step = held_force_oscillator(response.angular_frequency(index),
                                                           response.decay_rate(index), model_->dt);
    a11_[i] = step.a11;
    a12_[i] = step.a12;
    a21_[i] = step.a21;
    a22_[i] = step.a22;
    b1_[i] = step.b1;
    b2_[i] = step.b2;
  }
}

template <typename Scalar>
Vector3 ModalEngine<Scalar>::free_displacement(int node) const noexcept {
  Vector3 u;
  for (int axis = 0; axis < 3; ++axis) {
    u[axis] = dot(shape_row(3 * node + axis), free_coordinate_.data(), modes_);
  }
  return u;
}

template <typename Scalar>
void ModalEngine<Scalar>::predict(std::span<const SurfacePoint> points, std::span<Vector3> h,
                                  ContactMatrix& compliance) noexcept {
  const auto row = [&](std::size_t index) { return contact_shapes_.data() + index * modes_; };
  for (std::size_t a = 0; a < points.size(); ++a) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double* shape = row(3 * a + axis);
      std::fill_n(shape, modes_, 0.0);
      for (std::size_t corner = 0; corner < 3; ++corner) {
        if (points[a].weights[corner] == 0.0) continue;
        const int dof = 3 * points[a].nodes[corner] + static_cast<int>(axis);
        add_scaled(points[a].weights[corner], shape_row(dof), shape, modes_);
      }
      h[a][static_cast<Eigen::Index>(axis)] = dot(shape, free_coordinate_.data(), modes_);
    }
  }
  // R[0] = Phi diag(b1) Phi^T, symmetric.
  const auto size = static_cast<Eigen::Index>(3 * points.size());
  compliance.resize(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const double* shape = row(static_cast<std::size_t>(i));
    for (std::size_t m = 0; m < modes_; ++m) weighted_row_[m] = b1_[m] * shape[m];
    for (Eigen::Index j = 0; j <= i; ++j) {
      compliance(i, j) = dot(weighted_row_.data(), row(static_cast<std::size_t>(j)), modes_);
      compliance(j, i) = compliance(i, j);
    }
  }
}

template <typename Scalar>
void ModalEngine<Scalar>::advance(std::span<const NodalForce> forces) noexcept {
  coordinate_.swap(free_coordinate_);
  velocity_.swap(free_velocity_);
  if (!forces.empty()) {
    std::fill(modal_force_.begin(), modal_force_.end(), 0.0);
    for (const NodalForce& nodal : forces) {
      for (int axis = 0; axis < 3; ++axis) {
        add_scaled(nodal.force[axis], shape_row(3 * nodal.node + axis), modal_force_.data(),
                   modes_);
      }
    }
    for (std::size_t i = 0; i < modes_; ++i) {
      coordinate_[i] += b1_[i] * modal_force_[i];
      velocity_[i] += b2_[i] * modal_force_[i];
    }
  }
  for (std::size_t i = 0; i < modes_; ++i) {
    free_coordinate_[i] = put_to_rest(a11_[i] * coordinate_[i] + a12_[i] * velocity_[i]);
    free_velocity_[i] = put_to_rest(a21_[i] * coordinate_[i] + a22_[i] * velocity_[i]);
  }
}

template <typename Scalar>
void ModalEngine<Scalar>::displacement(Points& u) const {
  const int nodes = model_->mesh.surface_node_count();
  u.resize(nodes, 3);
#pragma omp parallel for schedule(static)
  for (int node = 0; node < nodes; ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      u(node, axis) = dot(shape_row(3 * node + axis), coordinate_.data(), modes_);
    }
  }
}

template <typename Scalar>
void ModalEngine<Scalar>::reset() noexcept {
  for (auto* values : {&coordinate_, &velocity_, &free_coordinate_, &free_velocity_}) {
    std::fill(values->begin(), values->end(), 0.0);
  }
}

template class ModalEngine<float>;
template class ModalEngine<double>;

}  // namespace irdm
