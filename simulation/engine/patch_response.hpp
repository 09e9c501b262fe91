#pragma once

#include "simulation/contact/contact_patch.hpp"
#include "simulation/engine/response_engine.hpp"

namespace irdm {

/// sum_ij w_i w_j R_ij: how one patch answers to a force on another.
/// @param entry (a, b): displacement of degree of freedom a per force on b [m/N]
template <typename Entry>
Matrix3 patch_response(const ContactPatch& to, const ContactPatch& from, const Entry& entry) {
  Matrix3 sum = Matrix3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(to.count); ++i) {
    for (std::size_t j = 0; j < static_cast<std::size_t>(from.count); ++j) {
      const double weight = to.weights[i] * from.weights[j];
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
          sum(row, column) += weight * entry(3 * to.nodes[i] + row, 3 * from.nodes[j] + column);
        }
      }
    }
  }
  return sum;
}

/// The same of a patch to a force on one node.
template <typename Entry>
Vector3 patch_response(const ContactPatch& to, const NodalForce& from, const Entry& entry) {
  Vector3 u = Vector3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(to.count); ++i) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        u[row] += to.weights[i] * entry(3 * to.nodes[i] + row, 3 * from.node + column) *
                  from.force[column];
      }
    }
  }
  return u;
}

/// ResponseEngine::predict from where nodes will be and how they answer.
/// @param free displacement of a node without further force [m]  @param entry as above
template <typename Free, typename Entry>
void predict_patches(std::span<const ContactPatch> patches, const Free& free, const Entry& entry,
                     std::span<Vector3> h, ContactMatrix& compliance) {
  const auto size = static_cast<Eigen::Index>(3 * patches.size());
  compliance.resize(size, size);
  for (std::size_t a = 0; a < patches.size(); ++a) {
    h[a] = mean(patches[a], free);
    for (std::size_t b = 0; b < patches.size(); ++b) {
      compliance.block<3, 3>(static_cast<Eigen::Index>(3 * a), static_cast<Eigen::Index>(3 * b)) =
          patch_response(patches[a], patches[b], entry);
    }
  }
}

}  // namespace irdm
