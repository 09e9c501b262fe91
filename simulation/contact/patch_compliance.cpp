#include "simulation/contact/patch_compliance.hpp"

#include <Eigen/Sparse>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "common/response/stored_response.hpp"

namespace irdm {
namespace {

// (3n, 3 rows): the forces on nodes that one on each patch is.
Eigen::SparseMatrix<double> spreading(const ContactSampling& sampling, int node_count) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int row = 0; row < sampling.row_count(); ++row) {
    const SurfacePatch patch = sampling.patch(row);
    for (std::size_t i = 0; i < patch.nodes.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        entries.emplace_back(3 * patch.nodes[i] + axis, 3 * row + axis, patch.weights[i]);
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(3 * node_count, 3 * sampling.row_count());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

std::vector<float> in_blocks(const Eigen::MatrixXd& matrix) {
  std::vector<float> blocks(static_cast<std::size_t>(matrix.size()));
  float* next = blocks.data();
  for (Eigen::Index to = 0; to < matrix.rows(); to += 3) {
    for (Eigen::Index from = 0; from < matrix.cols(); from += 3, next += 9) {
      Eigen::Map<Eigen::Matrix3f> block(next);
      block = matrix.block<3, 3>(to, from).cast<float>();
    }
  }
  return blocks;
}

}  // namespace

PatchCompliance::PatchCompliance(const Model& model, const ContactSampling& sampling)
    : sampling_(sampling) {
  const int nodes = model.mesh.surface_node_count();
  if (nodes > kMaxNodes) {
    throw Error("contact",
                "an object with " + std::to_string(nodes) +
                    " surface nodes is too large to touch other objects or balls of styluses",
                "use a mesh of at most " + std::to_string(kMaxNodes) +
                    " surface nodes; or set contact.between_objects and contact.self = false, and "
                    "no stylus.shape = \"ball\"");
  }
  const std::unique_ptr<StoredResponse> response = stored_response(model);
  row_count_ = static_cast<std::size_t>(sampling.row_count());
  {
    const Eigen::SparseMatrix<double> spread = spreading(sampling, nodes);
    const Eigen::MatrixXd at_nodes = response->zero_lag() * spread;
    const Eigen::MatrixXd at_patches = spread.transpose() * at_nodes;
    nodes_ = in_blocks(at_nodes);
    patches_ = in_blocks(0.5 * (at_patches + at_patches.transpose()));
  }
  if (sampling.ball_ranges().empty() || rigid()) return;
  const Eigen::MatrixXd settled = response->static_limit();
  for (const ContactSampling::BallRange& range : sampling.ball_ranges()) {
    near_.emplace_back(model, settled,
                       sampling.ball_samples().subspan(static_cast<std::size_t>(range.first),
                                                       static_cast<std::size_t>(range.count)));
  }
}

double PatchCompliance::near_field(int to, int from) const noexcept {
  const std::span<const ContactSampling::BallRange> ranges = sampling_.ball_ranges();
  for (std::size_t i = 0; i < near_.size(); ++i) {
    const int a = to - ranges[i].first;
    const int b = from - ranges[i].first;
    if (a < 0 || b < 0 || a >= ranges[i].count || b >= ranges[i].count) continue;
    return near_[i].between(a, b);
  }
  return 0.0;
}

Matrix3 PatchCompliance::between(const Place& to, const Place& from) const noexcept {
  Matrix3 sum = Matrix3::Zero();
  if (rigid()) return sum;
  for (std::size_t i = 0; i < static_cast<std::size_t>(to.count); ++i) {
    for (std::size_t j = 0; j < static_cast<std::size_t>(from.count); ++j) {
      sum += (to.weights[i] * from.weights[j]) *
             block(patches_, to.rows[i], from.rows[j]).cast<double>();
    }
  }
  if (to.ball_sample >= 0 && from.ball_sample >= 0) {
    const std::span<const BallSample> samples = sampling_.ball_samples();
    sum += near_field(to.ball_sample, from.ball_sample) *
           samples[static_cast<std::size_t>(to.ball_sample)].normal *
           samples[static_cast<std::size_t>(from.ball_sample)].normal.transpose();
  }
  return sum;
}

Matrix3 PatchCompliance::at_node(int node, const Place& from) const noexcept {
  Matrix3 sum = Matrix3::Zero();
  if (rigid()) return sum;
  for (std::size_t j = 0; j < static_cast<std::size_t>(from.count); ++j) {
    sum += from.weights[j] * block(nodes_, node, from.rows[j]).cast<double>();
  }
  return sum;
}

}  // namespace irdm
