#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "simulation/engine/response_engine.hpp"
#include "simulation/step/nodal_forces.hpp"
#include "simulation/step/simulation_config.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// The forces on all styluses in the last steps, without a gap: a display that comes by less often
/// than the force changes still sees all of it. Pure; no memory of its own is taken.
class ForceTrail {
 public:
  static constexpr int kLength = 128;

  /// Takes in a step. One that does not follow the last one begins anew.
  void follow(const StepRecord& record) noexcept {
    if (count_ > 0 && record.force_step != newest_ + 1) count_ = 0;
    newest_ = record.force_step;
    count_ = std::min(count_ + 1, kLength);
    auto& forces = forces_[slot(newest_)];
    for (std::size_t s = 0; s < forces.size(); ++s) {
      forces[s] = record.stylus[s].force.cast<float>();
    }
  }

  /// How many steps it holds, 0 to kLength; the newest of them is step newest().
  int count() const noexcept { return count_; }
  std::uint64_t newest() const noexcept { return newest_; }
  /// Force on a stylus [N], W, `back` steps before the newest, 0 <= back < count().
  const Eigen::Vector3f& force(int back, int stylus) const noexcept {
    return forces_[slot(newest_ - static_cast<std::uint64_t>(back))]
                  [static_cast<std::size_t>(stylus)];
  }

 private:
  static std::size_t slot(std::uint64_t step) noexcept { return step % kLength; }

  std::array<std::array<Eigen::Vector3f, kMaxStyluses>, kLength> forces_;
  std::uint64_t newest_ = 0;
  int count_ = 0;
};

/// One deformed object at the end of a step.
struct ObjectSurface {
  Vector3 position = Vector3::Zero();               ///< of the body [m], W
  Quaternion orientation = Quaternion::Identity();  ///< B to W
  Points displacement;                              ///< u (n, 3) [m], B

  /// x_i = c + Q (X_i + u_i) [m], W.
  Vector3 world(const ModelMesh& mesh, int node) const {
    return position +
           orientation * (mesh.rest_position(node) + Vector3(displacement.row(node).transpose()));
  }
};

/// Where a stylus touches the object that it touches.
struct StylusContact {
  /// On the surface at rest [m], B; NaN when free, and for contacts of a ball, which are among
  /// SurfaceFrame::body_contacts.
  Vector3 place = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  bool slipping = false;
};

/// @param mesh of the object that is touched
StylusContact contact_on(const ModelMesh& mesh, const ContactRecord& contact);

/// All deformed objects at the end of a step, and the styluses among them.
struct SurfaceFrame {
  std::uint64_t force_step = 0;
  double time = 0.0;  ///< [s]
  std::vector<ObjectSurface> objects;
  std::vector<StylusRecord> styluses;
  std::vector<StylusContact> contacts;  ///< of each of them, with the object that it touches
  ForceTrail trail;                     ///< up to this step
  /// Of objects with each other, scenery and balls in this step, at most kMaxBodyContacts.
  std::vector<BodyContactRecord> body_contacts;
};

/// A frame of the objects at rest, no stylus present.
SurfaceFrame rest_frame(const SimulationConfig& config);

/// Follows the force thread's steps with engines of its own. Because an engine's state depends on
/// nothing but the forces, the spin and gravity, the two always agree, and nobody has to wait for a
/// snapshot. Pure; one thread.
class Deformation {
 public:
  /// @param tolerance by how much a displacement component may be off, as a share of the object's
  /// size at rest: what is only looked at needs no more modes than can be seen, >= 0
  explicit Deformation(const SimulationConfig& config, double tolerance = 0.0);

  /// Takes in the next step. Steps that were lost on the way are taken to have had the forces and
  /// the spin of the one before them, or none if everything was reset since then;
  /// how many, is counted.
  void follow(const StepRecord& record);

  /// Displacements of all nodes after the last step taken in (OpenMP). The frame has the numbers
  /// and sizes of rest_frame().
  void compute(SurfaceFrame& frame) const;

  std::uint64_t lost_steps() const noexcept { return lost_steps_; }

 private:
  struct Follower {
    SimulationObject object;
    std::unique_ptr<ResponseEngine> engine;
    std::unique_ptr<RestSurface> surface;
    std::unique_ptr<RecordedForces> forces;
    bool has_inertial_loading;
    double tolerance = 0.0;  ///< [m]
    double material_damping = 1.0;
  };
  void follow_settings(const StepRecord& record);
  StylusContact contact(std::size_t s) const;
  void advance(const StepRecord& record);

  std::vector<Follower> objects_;
  StepRecord last_;
  ForceTrail trail_;
  bool started_ = false;
  std::uint64_t lost_steps_ = 0;
};

}  // namespace irdm
