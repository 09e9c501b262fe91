#include "server/engine/dense_engine.hpp"

#include <algorithm>

#include "server/engine/kernels.hpp"

namespace irdm {

template <typename Scalar>
DenseEngine<Scalar>::DenseEngine(std::shared_ptr<const Model> model)
    : model_(std::move(model)), history_(model_->mesh.surface_node_count(), model_->steps) {
  const auto& response = std::get<DenseResponse>(model_->response);
  values_ = std::get<std::vector<Scalar>>(response.values).data();
  dof_ = static_cast<std::size_t>(response.degrees_of_freedom);
  steps_ = static_cast<std::size_t>(response.steps);
}

template <typename Scalar>
double DenseEngine<Scalar>::convolve(int a, int shift) const noexcept {
  double u = 0.0;
  for (const int node : history_.active()) {
    for (int axis = 0; axis < 3; ++axis) {
      const ForceHistory::Series series = history_.series(node, axis);
      const int first = series.first_age + shift;
      const int count = std::min(series.count, static_cast<int>(steps_) - first);
      if (count > 0) {
        u += dot(response(a, 3 * node + axis) + first, series.force,
                 static_cast<std::size_t>(count));
      }
    }
  }
  return u;
}

template <typename Scalar>
Vector3 DenseEngine<Scalar>::free_displacement(int node) const noexcept {
  return {convolve(3 * node, 1), convolve(3 * node + 1, 1), convolve(3 * node + 2, 1)};
}

template <typename Scalar>
void DenseEngine<Scalar>::predict(std::span<const SurfacePoint> points, std::span<Vector3> h,
                                  ContactMatrix& compliance) noexcept {
  const auto size = static_cast<Eigen::Index>(3 * points.size());
  compliance.setZero(size, size);
  for (std::size_t a = 0; a < points.size(); ++a) {
    h[a] = interpolate(points[a], [&](int node) { return free_displacement(node); });
    for (std::size_t b = 0; b < points.size(); ++b) {
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
          const double weight = points[a].weights[i] * points[b].weights[j];
          if (weight == 0.0) continue;
          for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) {
              const Scalar entry =
                  *response(3 * points[a].nodes[i] + row, 3 * points[b].nodes[j] + column);
              compliance(static_cast<Eigen::Index>(3 * a) + row,
                         static_cast<Eigen::Index>(3 * b) + column) +=
                  weight * static_cast<double>(entry);
            }
          }
        }
      }
    }
  }
}

template <typename Scalar>
void DenseEngine<Scalar>::advance(std::span<const NodalForce> forces) noexcept {
  history_.push(forces);
}

template <typename Scalar>
void DenseEngine<Scalar>::displacement(Points& u) const {
  const int nodes = model_->mesh.surface_node_count();
  u.resize(nodes, 3);
#pragma omp parallel for schedule(static)
  for (int node = 0; node < nodes; ++node) {
    for (int axis = 0; axis < 3; ++axis) u(node, axis) = convolve(3 * node + axis, 0);
  }
}

template <typename Scalar>
void DenseEngine<Scalar>::reset() noexcept {
  history_.clear();
}

template class DenseEngine<float>;
template class DenseEngine<double>;

}  // namespace irdm
