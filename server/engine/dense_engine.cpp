#include "server/engine/dense_engine.hpp"

#include <algorithm>
#include <array>

#include "server/engine/force_stretches.hpp"
#include "server/engine/kernels.hpp"

namespace irdm {
namespace {

// Degrees of freedom that a thread takes at a time: some 100 kB of each column.
constexpr std::size_t kBlock = 64;

double scale_of(const double* scales, std::size_t column) noexcept {
  return scales == nullptr ? 1.0 : scales[column];
}

}  // namespace

template <typename Scalar>
DenseEngine<Scalar>::DenseEngine(std::shared_ptr<const Model> model)
    : model_(std::move(model)),
      history_(model_->mesh.surface_node_count(), model_->steps),
      spin_history_(kSpinProducts / 3, model_->steps) {
  const auto& response = std::get<DenseResponse>(model_->response);
  values_ = std::get<std::vector<Scalar>>(response.values).data();
  if (!response.scales.empty()) scales_ = response.scales.data();
  if (has_centrifugal(*model_)) {
    centrifugal_ = std::get<std::vector<SpinScalar>>(response.centrifugal).data();
  }
  dof_ = static_cast<std::size_t>(response.degrees_of_freedom);
  steps_ = static_cast<std::size_t>(response.steps);
}

template <typename Scalar>
template <typename Number>
void DenseEngine<Scalar>::convolve(const Number* values, const double* scales,
                                   const ForceHistory& history, int node, int shift,
                                   Vector3& u) const noexcept {
  for (const int source : history.active()) {
    for (int axis = 0; axis < 3; ++axis) {
      const ForceHistory::Series series = history.series(source, axis);
      const int first = series.first_age + shift;
      const int count = std::min(series.count, static_cast<int>(steps_) - first);
      if (count <= 0) continue;
      const int b = 3 * source + axis;
      add_products({response(values, 3 * node, b) + first, steps_, 3}, series.force,
                   static_cast<std::size_t>(count), scale_of(scales, static_cast<std::size_t>(b)),
                   u.data());
    }
  }
}

template <typename Scalar>
void DenseEngine<Scalar>::hold_spin(const Vector3& w) noexcept {
  if (centrifugal_ != nullptr) coming_ = spin_products(w);
}

template <typename Scalar>
Vector3 DenseEngine<Scalar>::free_displacement(int node) const noexcept {
  Vector3 u = Vector3::Zero();
  convolve(values_, scales_, history_, node, 1, u);
  if (centrifugal_ == nullptr) return u;
  convolve(centrifugal_, nullptr, spin_history_, node, 1, u);
  for (int p = 0; p < kSpinProducts; ++p) {
    for (int axis = 0; axis < 3; ++axis) {
      u[axis] += static_cast<double>(*response(centrifugal_, 3 * node + axis, p)) * coming_[p];
    }
  }
  return u;
}

template <typename Scalar>
double DenseEngine<Scalar>::entry(std::size_t step, int a, int b) const noexcept {
  return scale_of(scales_, static_cast<std::size_t>(b)) * to_double(response(values_, a, b)[step]);
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
          sum(row, column) += weight * entry(step, 3 * a.nodes[i] + row, 3 * b.nodes[j] + column);
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
        u[row] +=
            a.weights[i] * entry(step, 3 * a.nodes[i] + row, 3 * b.node + column) * b.force[column];
      }
    }
  }
  return u;
}

template <typename Scalar>
void DenseEngine<Scalar>::foresee(const ContactPatch& patch, std::span<const NodalForce> held,
                                  std::span<Vector3> path, std::span<Matrix3> response) noexcept {
  const auto place = [&](int node, int shift) {
    Vector3 u = Vector3::Zero();
    convolve(values_, scales_, history_, node, shift, u);
    if (centrifugal_ != nullptr) convolve(centrifugal_, nullptr, spin_history_, node, shift, u);
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

// Column after column, as R stands in memory: a thread reads its part of each of them from one end
// to the other. Each degree of freedom gets its sums in the same order, whichever thread adds them.
template <typename Scalar>
template <typename Number>
void DenseEngine<Scalar>::add_columns(const Number* values, const double* scales,
                                      const ForceHistory& history, Points& u) const {
  const std::vector<ForceStretch> stretches = force_stretches(history);
  const auto blocks = static_cast<int>((dof_ + kBlock - 1) / kBlock);
#pragma omp parallel for schedule(dynamic)
  for (int block = 0; block < blocks; ++block) {
    const std::size_t first = static_cast<std::size_t>(block) * kBlock;
    const std::size_t count = std::min(kBlock, dof_ - first);
    for (const ForceStretch& push : stretches) {
      const Number* rows = values + (push.column * dof_ + first) * steps_ + push.first_age;
      add_products({rows, steps_, count}, push.force, push.count, scale_of(scales, push.column),
                   u.data() + first);
    }
  }
}

template <typename Scalar>
void DenseEngine<Scalar>::displacement(Points& u, double /*tolerance*/) const {
  u.setZero(model_->mesh.surface_node_count(), 3);
  add_columns(values_, scales_, history_, u);
  if (centrifugal_ != nullptr) add_columns(centrifugal_, nullptr, spin_history_, u);
}

template <typename Scalar>
Eigen::MatrixXd DenseEngine<Scalar>::instant_compliance() const {
  const auto dof = static_cast<int>(dof_);
  Eigen::MatrixXd R(dof, dof);
  for (int b = 0; b < dof; ++b) {
    for (int a = 0; a < dof; ++a) R(a, b) = entry(0, a, b);
  }
  return R;
}

template <typename Scalar>
void DenseEngine<Scalar>::reset() noexcept {
  history_.clear();
  spin_history_.clear();
  coming_.setZero();
}

template class DenseEngine<Half>;
template class DenseEngine<float>;
template class DenseEngine<double>;

}  // namespace irdm
