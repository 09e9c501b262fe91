#pragma once

#include <span>
#include <vector>

#include "common/geometry.hpp"
#include "common/model/model.hpp"
#include "simulation/contact/contact_patch.hpp"
#include "simulation/engine/response_engine.hpp"

namespace irdm {

/// What modes that a model leaves out would add: a compliance without delay, so that it belongs to
/// R[0] alone and to the forces of the last step. Costs what the nodes in contact and their
/// neighbours are, whatever the size of the object. One thread; real-time safe after construction.
class ResidualPart {
 public:
  /// @param compliance must outlive this object; empty: nothing is added anywhere
  /// @param surface_nodes n
  ResidualPart(const ResidualCompliance& compliance, int surface_nodes);

  /// Adds the blocks sum_ij w_i w_j G_ij between the contacts to a (3m, 3m) matrix [m/N].
  void add_compliance(std::span<const ContactPatch> patches, ContactMatrix& compliance) noexcept;
  /// The same block of a single contact, and of one per force on another [m/N].
  Matrix3 compliance(const ContactPatch& patch) noexcept;
  Matrix3 compliance(const ContactPatch& to, const ContactPatch& from) noexcept;
  /// Mean displacement of a contact under forces [m].
  Vector3 displacement(const ContactPatch& patch, std::span<const NodalForce> forces) noexcept;

  /// The forces of a step that ends now, in place of those of the step before; then more of them.
  void hold(std::span<const NodalForce> forces) noexcept;
  void hold_more(std::span<const NodalForce> forces) noexcept;
  void release() noexcept;
  /// Adds what these forces do to the nodes' displacements, (n, 3) [m].
  void add_displacement(Points& u) const noexcept;
  /// Elastic energy of them, 1/2 f^T G f [J].
  double energy() const noexcept;
  /// State, in or out (StateArchive).
  void archive(StateArchive& state);

 private:
  int neighbour(int place) const noexcept { return compliance_.nodes[index(place)]; }
  static std::size_t index(int i) noexcept { return static_cast<std::size_t>(i); }

  void spread(const ContactPatch& patch) noexcept;
  void clear(const ContactPatch& patch) noexcept;

  const ResidualCompliance& compliance_;
  std::vector<Matrix3> field_;  ///< sum_i w_i G_ij of a contact at each node j; else zero
  std::vector<Vector3> force_;  ///< on each node in the last step [N]
  std::vector<int> loaded_;     ///< the nodes with such a force
  std::vector<char> is_loaded_;
};

}  // namespace irdm
