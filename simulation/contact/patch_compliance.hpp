#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstddef>
#include <vector>

#include "common/model/model.hpp"
#include "simulation/contact/contact_sampling.hpp"
#include "simulation/contact/near_field.hpp"

namespace irdm {

/// R[0] between the patches of an object's sampling, and between them and its nodes: what contacts
/// with other objects need of it within a step. Zero for a rigid object. In single precision; built
/// once for all objects of a model, read only. Between samples for balls it includes their near
/// field.
class PatchCompliance {
 public:
  /// Surface nodes of an object that can touch others: the table has some (3n)^2 numbers.
  static constexpr int kMaxNodes = 2000;

  /// Throws Error when the object has more nodes than that.
  /// @param sampling of the model's surface; must outlive this
  PatchCompliance(const Model& model, const ContactSampling& sampling);

  /// The place of a contact on one of the two bodies.
  using Place = SurfacePlace;

  bool rigid() const noexcept { return patches_.empty(); }
  /// Displacement at `to` per force at `from` [m/N], B.
  Matrix3 between(const Place& to, const Place& from) const noexcept;
  /// The same of a node to a force at `from`.
  Matrix3 at_node(int node, const Place& from) const noexcept;
  /// Returns the near field between two ball samples: the displacement along the normal of one per
  /// force along the normal of the other [m/N]. It is 0 between samples for different spacings.
  double near_field(int to, int from) const noexcept;

 private:
  using Block = Eigen::Map<const Eigen::Matrix3f>;
  Block block(const std::vector<float>& table, int to, int from) const noexcept {
    return Block(table.data() +
                 9 * (static_cast<std::size_t>(to) * row_count_ + static_cast<std::size_t>(from)));
  }

  const ContactSampling& sampling_;
  std::vector<NearField> near_;  ///< of each range of ball samples
  std::size_t row_count_ = 0;    ///< patches
  std::vector<float> patches_;   ///< blocks, one after the other: of each patch to all patches
  std::vector<float> nodes_;     ///< the same of each node to all patches
};

}  // namespace irdm
