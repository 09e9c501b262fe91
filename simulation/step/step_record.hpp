#pragma once

#include <array>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>
#include <span>

#include "common/contact/contact_problem.hpp"
#include "common/geometry.hpp"
#include "common/motion/rigid_body.hpp"
#include "common/stylus.hpp"
#include "simulation/step/settings.hpp"

namespace irdm {

inline constexpr int kMaxStyluses = 16;

/// A force that was decided elsewhere (by a bridge that solved the contact itself); the step
/// applies it.
struct GivenForce {
  ContactState contact = ContactState::kTouching;
  SurfacePoint point;
  Vector3 force = Vector3::Zero();  ///< on the object [N], W
  int object = 0;
};

/// A force that the bridge decided on: it acts in place of the one that the step would find. Where
/// the contact is, how it slips and when it ends is found here from the tip.
struct BridgedForce {
  Vector3 force = Vector3::Zero();  ///< on the object [N], W
  Vector3 arm = Vector3::Zero();    ///< from the centre of mass to where it acts [m], B
  int object = -1;                  ///< the only one that the stylus touches; -1: none
  /// The part of the force that acts, 0 to 1, as the step decided by the object's energy account
  /// when the run was recorded. Unset: this step decides.
  std::optional<double> share = {};
};

/// The place at which the ball of a stylus takes hold of an object.
struct BallGrip {
  int object = -1;
  int triangle = 0;                 ///< of the object's surface
  SurfacePoint point;               ///< on that triangle
  Vector3 force = Vector3::Zero();  ///< on the object, which goes on without a jump [N], B
};

/// What one stylus asks of one step.
struct StylusCommand {
  bool present = false;  ///< false: nobody is there; a contact that was there ends
  std::uint32_t buttons = 0;
  Vector3 tip =
      Vector3::Zero();  ///< at the end of the step [m], W; the step solves for the force ...
  std::optional<GivenForce> given;           ///< ... unless it is given
  std::optional<BridgedForce> bridged = {};  ///< the bridge solves the contact
  /// Of the stylus at the end of the step, in W: leads a tool.
  Quaternion orientation = Quaternion::Identity();
  /// Set by the simulation itself in the step in which the ball of the stylus takes hold.
  std::optional<BallGrip> grip = {};
};

/// What one stylus did to one object in one step.
struct ContactRecord {
  ContactState state = ContactState::kFree;
  bool slipping = false;
  SurfacePoint point;  ///< middle of the contact; this and what follows means nothing when free
  Vector3 force = Vector3::Zero();   ///< on the object [N], B
  Vector3 normal = Vector3::Zero();  ///< outward, of the surface at rest under the tip; unit, B
  Vector3 offset = Vector3::Zero();  ///< from the point to where the force acts [m], B
  /// From where the point would be at the end of the step without forces to where it is in the mean
  /// over the step: the torque's lever arm is the mean one [m], B.
  Vector3 arm_shift = Vector3::Zero();
  Vector3 proxy = Vector3::Zero();  ///< god-object: the point at the end of the step [m], W
};

/// Contacts with the floor that an object can have in one step.
inline constexpr int kMaxFloorContacts = 192;

/// Force of the floor on one surface node. Single precision, and applied as such: what is recorded
/// is what acted.
struct FloorForce {
  int node = 0;
  Eigen::Vector3f force = Eigen::Vector3f::Zero();  ///< on the object [N], B
};

/// Contacts of objects with each other and with scenery that a step can have.
inline constexpr int kMaxBodyContacts = 256;

/// What a body did to an object at one of the object's samples (ContactSampling) in one step.
struct BodyContactRecord {
  int object = 0;  ///< whose sample it is
  /// The object that it touches; -1 - i for scenery i; for the ball of stylus s ball_number().
  int other = 0;
  int sample = 0;
  bool slipping = false;
  int triangle = 0;  ///< of the other object, where its point is; this and weights not of scenery
  std::array<double, 3> weights{};     ///< barycentric, of that point
  Vector3 force = Vector3::Zero();     ///< on the object; the other has the opposite [N], W
  Vector3 position = Vector3::Zero();  ///< where both act, half-way through the step [m], W
  Vector3 normal = Vector3::Zero();    ///< outward of the other, unit, W
  Vector3 slip = Vector3::Zero();      ///< of the sample along the other in the step [m], W
  double area = 0.0;                   ///< of the sample [m^2]
};

/// What became of one object in one step, but for what touched it.
struct ObjectStep {
  RigidState start;  ///< before the step, with the late forces that were entered by then
  /// Half-way through the step, B to W: contact forces, held in B, have their direction in W by it.
  Quaternion halfway = Quaternion::Identity();
  Vector3 position = Vector3::Zero();               ///< of the body at the end of the step [m], W
  Quaternion orientation = Quaternion::Identity();  ///< B to W
  Vector3 velocity = Vector3::Zero();               ///< [m/s], W
  Vector3 angular_velocity = Vector3::Zero();       ///< [rad/s], W
  Vector3 spin = Vector3::Zero();  ///< that loaded the elastic part during the step [rad/s], B
  int floor_count = 0;
  Vector3 floor_force = Vector3::Zero();  ///< sum of the floor's forces [N], W
  double residual = 0.0;                  ///< of the contact problem [m]
  int sweeps = 0;                         ///< of its solver; 0: solved directly
  bool solved = true;  ///< false: the contact problem had no finite solution and no force acted
  /// Nothing changed in the step; the contact forces are those that the last one before had.
  bool asleep = false;
};

/// What became of one object in one step.
struct ObjectRecord : ObjectStep {
  std::array<ContactRecord, kMaxStyluses> contact;  ///< the first stylus_count
  std::array<FloorForce, kMaxFloorContacts> floor;  ///< the first floor_count
};

/// A force that a bridge has told of after its step: it was entered before this one.
struct LateForce {
  int object = 0;
  int stylus = 0;
  int age = 0;                      ///< of its step, in steps before the last one
  SurfacePoint point;               ///< middle of the contact
  Vector3 force = Vector3::Zero();  ///< on the object [N], B
  Vector3 arm = Vector3::Zero();    ///< from the centre of mass to where it acts [m], B
};

/// In the order in which they were entered.
struct LateForces {
  static constexpr std::size_t kMost = 32;  ///< that can be entered before one step

  std::size_t count = 0;
  std::array<LateForce, kMost> force;  ///< the first `count`

  std::span<const LateForce> view() const noexcept { return {force.data(), count}; }
};

/// What became of one stylus in one step.
struct StylusRecord {
  bool present = false;
  std::uint32_t buttons = 0;
  int object =
      -1;  ///< the one that it touches (the one with the largest force, if several); -1: none
  ContactState contact = ContactState::kFree;  ///< with that object
  Vector3 tip = Vector3::Zero();               ///< [m], W
  Vector3 proxy = Vector3::Zero();             ///< of that contact; free: the tip [m], W
  Vector3 force = Vector3::Zero();             ///< on the stylus, of all objects [N], W
  /// As the step was given it, with the part of it that acted.
  std::optional<BridgedForce> bridged = {};
  int tool = -1;                                    ///< the object that it leads; -1: none
  Quaternion orientation = Quaternion::Identity();  ///< as commanded, in W
  /// Of its tool on the stylus about the tip [N m], W; `force` is the tool's, too, and `proxy` the
  /// tool's reference point.
  Vector3 torque = Vector3::Zero();
};

/// What a step has whatever takes part in it.
struct StepHead {
  std::uint64_t force_step = 0;  ///< k
  double time = 0.0;             ///< (k + 1) dt, the end of the step [s]
  bool reset = false;            ///< everything was reset before this step
  std::uint64_t reset_step = 0;  ///< the last step that this was so in, this one included; 0: none
  Settings settings;             ///< that the step was made with
  std::uint32_t settings_change = 0;  ///< how often they were changed so far
  int object_count = 0;
  int stylus_count = 0;
};

/// What happened in one step: everything that the trace, the deformation and the bridges need.
/// Large; copy_step() copies what counts.
struct StepRecord : StepHead {
  std::array<ObjectRecord, kMaxObjects> object;   ///< the first object_count
  std::array<StylusRecord, kMaxStyluses> stylus;  ///< the first stylus_count
  LateForces late;                                ///< entered before the step
  /// In place; a copy of the record takes no more than there are.
  boost::container::static_vector<BodyContactRecord, kMaxBodyContacts> body_contact;

  std::span<const BodyContactRecord> body_contacts() const noexcept {
    return {body_contact.data(), body_contact.size()};
  }
};

/// Makes `to` the same of an object, contacts of the first `styluses`. Real-time safe.
void copy_object(const ObjectRecord& from, std::size_t styluses, ObjectRecord& to) noexcept;

/// Makes `to` the same step. What is beyond the counts stays as it was. Real-time safe.
void copy_step(const StepRecord& from, StepRecord& to) noexcept;

}  // namespace irdm
