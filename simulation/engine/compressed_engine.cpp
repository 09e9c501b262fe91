#include "simulation/engine/compressed_engine.hpp"

#include <algorithm>
#include <array>

#include "common/response/compressed_response.hpp"
#include "simulation/engine/kernels.hpp"
#include "simulation/state/state_archive.hpp"

namespace irdm {
namespace {

constexpr std::array<std::array<std::size_t, 2>, 6> kCompressedPairs{
    {{0, 0}, {1, 0}, {1, 1}, {2, 0}, {2, 1}, {2, 2}}};

Matrix3 block(const CompressedResponse& response, int i, int j, std::size_t s) noexcept {
  Matrix3 R;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      R(a, b) = fir_response(response, i, a, j, b, static_cast<int>(s));
    }
  }
  return R;
}

Matrix3 block(const CompressedResponse& response, const ContactPatch& a, const ContactPatch& b,
              std::size_t s) noexcept {
  Matrix3 sum = Matrix3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.count); ++i) {
    for (std::size_t j = 0; j < static_cast<std::size_t>(b.count); ++j) {
      sum += a.weights[i] * b.weights[j] * block(response, a.nodes[i], b.nodes[j], s);
    }
  }
  return sum;
}

}  // namespace

CompressedEngine::CompressedEngine(std::shared_ptr<const Model> model)
    : model_(std::move(model)),
      response_(&std::get<CompressedResponse>(model_->response)),
      history_(model_->mesh.surface_node_count(), response_->fir_steps),
      tail_(*response_) {
  contact_shapes_.assign(6 * tail_.shape_count(), 0.0);
  products_.assign(9 * tail_.shape_count(), 0.0);
  held_force_.assign(tail_.shape_count(), 0.0);
}

Vector3 CompressedEngine::fir(int node, int shift) const noexcept {
  Vector3 u = Vector3::Zero();
  for (const int from : history_.active()) {
    for (int b = 0; b < 3; ++b) {
      const ForceHistory::Series series = history_.series(from, b);
      const int first = series.first_age + shift;
      const int count = std::min(series.count, response_->fir_steps - first);
      if (count <= 0) continue;
      for (int a = 0; a < 3; ++a) {
        u[a] += with_fir(*response_, node, a, from, b, [&](const auto* numbers, double scale) {
          return scale * dot(numbers + first, series.force, static_cast<std::size_t>(count));
        });
      }
    }
  }
  return u;
}

Vector3 CompressedEngine::tail(int node, const double* coordinate) const noexcept {
  Vector3 u;
  for (int axis = 0; axis < 3; ++axis) {
    u[axis] = dot(tail_.shape_row(3 * node + axis), coordinate, tail_.shape_count());
  }
  return u;
}

Vector3 CompressedEngine::free_displacement(int node) const noexcept {
  return fir(node, 1) + tail(node, tail_.coming());
}

void CompressedEngine::predict(std::span<const ContactPatch> patches, std::span<Vector3> h,
                               ContactMatrix& compliance) noexcept {
  const auto size = static_cast<Eigen::Index>(3 * patches.size());
  compliance.resize(size, size);
  for (std::size_t a = 0; a < patches.size(); ++a) {
    h[a] = mean(patches[a], [&](int node) { return free_displacement(node); });
    for (std::size_t b = 0; b <= a; ++b) {
      const auto row = static_cast<Eigen::Index>(3 * a);
      const auto column = static_cast<Eigen::Index>(3 * b);
      Matrix3 R = block(*response_, patches[a], patches[b], 0);
      if (a == b) R = 0.5 * (R + R.transpose()).eval();  // sums of the same in another order
      compliance.block<3, 3>(row, column) = R;
      compliance.block<3, 3>(column, row) = R.transpose();
    }
  }
}

void CompressedEngine::mean_shapes(const ContactPatch& patch, double* to) const noexcept {
  const std::size_t shapes = tail_.shape_count();
  std::fill_n(to, 3 * shapes, 0.0);
  for (std::size_t i = 0; i < static_cast<std::size_t>(patch.count); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float* row = tail_.shape_row(3 * patch.nodes[i] + static_cast<int>(axis));
      accumulate({patch.weights[i], 0.0, 0.0}, row, row, row, to + axis * shapes, shapes);
    }
  }
}

void CompressedEngine::predict_horizon(const ContactPatch& patch, std::span<const NodalForce> held,
                                       std::span<Vector3> path,
                                       std::span<Matrix3> response) noexcept {
  const std::size_t shapes = tail_.shape_count();
  const auto fir_steps = static_cast<std::size_t>(response_->fir_steps);
  mean_shapes(patch, contact_shapes_.data());
  tail_.collect(held, held_force_.data());
  Vector3 by_held = Vector3::Zero();
  tail_.begin_path();
  for (std::size_t n = 0; n < path.size(); ++n) {
    if (n > 0) tail_.continue_path(held_force_.data());
    if (n < fir_steps) {
      for (const NodalForce& force : held) {
        by_held += mean(patch, [&](int node) -> Vector3 {
          return block(*response_, node, force.node, n) * force.force;
        });
      }
    }
    path[n] = by_held + mean(patch, [&](int node) { return fir(node, static_cast<int>(n) + 1); });
    for (std::size_t axis = 0; axis < 3; ++axis) {
      path[n][static_cast<Eigen::Index>(axis)] +=
          dot(contact_shapes_.data() + axis * shapes, tail_.path(), shapes);
    }
  }
  for (std::size_t k = 0; k < kCompressedPairs.size(); ++k) {
    multiply(contact_shapes_.data() + kCompressedPairs[k][0] * shapes,
             contact_shapes_.data() + kCompressedPairs[k][1] * shapes,
             products_.data() + k * shapes, shapes);
  }
  for (std::size_t n = 0; n < response.size(); ++n) {
    if (n < fir_steps) {
      response[n] = block(*response_, patch, patch, n);
    } else {
      const Sums<6> r = dot_six(tail_.after(n), products_.data(), shapes);
      response[n] << r[0], r[1], r[3], r[1], r[2], r[4], r[3], r[4], r[5];
    }
  }
}

void CompressedEngine::cross_response(const ContactPatch& to, const ContactPatch& from,
                                      std::span<Matrix3> response) noexcept {
  const std::size_t shapes = tail_.shape_count();
  double* const rows = contact_shapes_.data();
  mean_shapes(to, rows);
  mean_shapes(from, rows + 3 * shapes);
  for (std::size_t k = 0; k < 9; ++k) {
    multiply(rows + k / 3 * shapes, rows + (3 + k % 3) * shapes, products_.data() + k * shapes,
             shapes);
  }
  for (std::size_t n = 0; n < response.size(); ++n) {
    if (n < static_cast<std::size_t>(response_->fir_steps)) {
      response[n] = block(*response_, to, from, n);
      continue;
    }
    for (std::size_t k = 0; k < 9; ++k) {
      response[n](static_cast<Eigen::Index>(k / 3), static_cast<Eigen::Index>(k % 3)) =
          dot(tail_.after(n), products_.data() + k * shapes, shapes);
    }
  }
}

void CompressedEngine::add_delayed_force(std::span<const NodalForce> forces, int age) noexcept {
  if (age >= kMaxHorizon) return;
  history_.add_delayed_force(forces, age);
  tail_.add_delayed_force(forces, age);
}

void CompressedEngine::advance(std::span<const NodalForce> forces) noexcept {
  history_.push(forces);
  tail_.advance(forces);
}

void CompressedEngine::displacement(Points& u, double /*tolerance*/) const {
  const int nodes = model_->mesh.surface_node_count();
  u.resize(nodes, 3);
#pragma omp parallel for schedule(static)
  for (int node = 0; node < nodes; ++node) {
    u.row(node) = (fir(node, 0) + tail(node, tail_.coordinate())).transpose();
  }
}

void CompressedEngine::archive(StateArchive& state) {
  history_.archive(state);
  tail_.archive(state);
}

void CompressedEngine::reset() noexcept {
  history_.clear();
  tail_.reset();
}

}  // namespace irdm
