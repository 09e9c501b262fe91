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

PatchCompliance::PatchCompliance(const Model& model, const ContactSampling& sampling) {
  const int nodes = model.mesh.surface_node_count();
  if (nodes > kMaxNodes) {
    throw Error("contact",
                "an object with " + std::to_string(nodes) +
                    " surface nodes is too large to touch other objects",
                "use a mesh of at most " + std::to_string(kMaxNodes) +
                    " surface nodes, or set contact.between_objects and contact.self = false");
  }
  const Eigen::SparseMatrix<double> spread = spreading(sampling, nodes);
  const Eigen::MatrixXd at_nodes = stored_response(model)->zero_lag() * spread;
  const Eigen::MatrixXd at_patches = spread.transpose() * at_nodes;
  row_count_ = static_cast<std::size_t>(sampling.row_count());
  nodes_ = in_blocks(at_nodes);
  patches_ = in_blocks(0.5 * (at_patches + at_patches.transpose()));
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
