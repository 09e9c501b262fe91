#pragma once

#include <algorithm>
#include <vector>

#include "common/contact/persistent_contact.hpp"
#include "common/motion/free_motion.hpp"
#include "simulation/collision/deformed_surface.hpp"
#include "simulation/state/state_archive.hpp"
#include "simulation/step/simulation_config.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// The contacts of one object's surface nodes with the floor. Each is a touching contact like that
/// of a stylus, whose "tip" is an anchor on the floor: where the node came down, moved along as far
/// as it slips. Real-time safe after construction; one thread.
class FloorContacts {
 public:
  /// Surface nodes of an object that can have a floor: R[0] between all of them is kept.
  static constexpr int kMaxNodes = 1100;

  /// Throws Error when the object has more nodes than that.
  FloorContacts(const FloorConfig& floor, const RestSurface& rest, const Model& model);

  /// Chooses this step's contacts: the nodes that would be below the floor by the end of it, and
  /// those that were pressed on it. Returns how many; at most kMaxFloorContacts, the others wait.
  /// @param displaced largest displacement that is known of any node [m]
  int find(const FreeMotion& motion, DeformedSurface& surface, double displaced) noexcept;
  /// Writes them into the problem as its first contacts.
  void pose(const FreeMotion& motion, DeformedSurface& surface, ContactProblem& problem) noexcept;
  /// Compliance between a patch and the floor contact i: displacement of the patch per force there.
  Matrix3 between(const ContactPatch& patch, int i) const noexcept;
  /// After the solution: anchors slip, forces are kept for the next start.
  void update_contacts(const FreeMotion& motion, const ContactProblem& problem) noexcept;
  void reset() noexcept;
  /// State, in or out (StateArchive).
  void archive(StateArchive& state) {
    state.values(anchors_);
    state.value(displaced_);
    if (state.reading()) count_ = posed_count_ = 0;
  }

  /// What is left of a force [N], W, that acted a while ago: against what pressed an object on it
  /// the floor held.
  Vector3 without_pressure(const Vector3& force) const noexcept {
    return count_ > 0 ? Vector3(force - std::min(0.0, force.dot(floor_.normal)) * floor_.normal)
                      : force;
  }

  int count() const noexcept { return count_; }
  int node(int i) const noexcept { return nodes_[static_cast<std::size_t>(i)]; }

 private:
  struct FloorAnchor {
    PersistentContact contact;           ///< touching: pressed on the floor in the last step
    Vector3 position = Vector3::Zero();  ///< [m], W
    Vector3 force = Vector3::Zero();     ///< of the last step [N], B
  };
  double height(const Vector3& x) const noexcept { return floor_.normal.dot(x) - floor_.height; }

  FloorConfig floor_;
  const RestSurface& rest_;
  Eigen::MatrixXd compliance_;        ///< R[0] (3n, 3n) [m/N]
  double softness_ = 0.0;             ///< of each contact besides, of a rigid body [m/N]
  std::vector<FloorAnchor> anchors_;  ///< of all nodes
  std::vector<int> nodes_;            ///< of this step's contacts
  std::vector<int> posed_;            ///< whose blocks are in the problem
  int count_ = 0;
  int posed_count_ = 0;
  double displaced_ = 0.0;  ///< how far nodes were seen away from where they are at rest [m]
};

}  // namespace irdm
