#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "common/contact/contact_problem.hpp"
#include "common/model/model.hpp"
#include "common/motion/free_motion.hpp"
#include "common/stylus.hpp"

namespace irdm {

/// Steps that a contact model can predict.
inline constexpr int kMaxHorizon = 50;

inline constexpr std::uint64_t kNoStep = ~std::uint64_t{0};

/// All that a bridge needs to go on by itself, for a while, with what the server computes of one
/// stylus' contact: the rigid motion and all that drives it, and the elastic part as far as this
/// contact sees it, its free path and its answer to the contact's own force. Rigid motion is in W,
/// all else in B.
struct ContactModel {
  template <typename T>
  static std::array<T, kMaxHorizon> zeros() noexcept {
    std::array<T, kMaxHorizon> all;
    all.fill(T::Zero());
    return all;
  }

  bool valid = false;         ///< false: the stylus cannot touch anything
  std::uint64_t step = 0;     ///< K, the last step that the server has done
  std::uint64_t missing = 0;  ///< bit i: the force of step K - i is not in it, and may yet come
  /// The newest step of which the bridge's force had come by then; kNoStep: none had.
  std::uint64_t newest = kNoStep;
  /// The run is paused: what is felt is to fade. Nothing else means anything then.
  bool paused = false;
  /// What the device may give from the end of newest_known() on, but for its hand's work since [J]:
  /// EnergyAccount's balance and allowance, and a part of the object's kinetic energy.
  double energy = 0.0;
  double dt = 0.0;  ///< of a step [s], > 0
  int horizon = 0;  ///< H, 1 to kMaxHorizon

  BodyProperties body;
  RigidState motion;                       ///< at the end of step K
  FreeForces free_forces;                  ///< from then on, and besides them ...
  Vector3 other_force = Vector3::Zero();   ///< ... what other contacts are taken to do [N] ...
  Vector3 other_torque = Vector3::Zero();  ///< ... and its moment about the centre of mass [N m]

  /// Free: of the surface's point nearest to the tip, where a contact would begin.
  ContactState state = ContactState::kFree;
  bool slipping = false;             ///< it slipped in step K
  Vector3 place = Vector3::Zero();   ///< where the tip feels it, object at rest [m]
  Vector3 normal = Vector3::Zero();  ///< outward, of the surface; unit; means nothing when held
  Friction friction;
  Matrix3 series = Matrix3::Zero();  ///< compliance between place and tip: coupling spring [m/N]
  /// path[n-1]: elastic displacement of the place at the end of step K + n without a further force
  /// of this stylus [m]; the first H.
  std::array<Vector3, kMaxHorizon> path = zeros<Vector3>();
  /// response[n]: its elastic displacement at the end of step i + n per force in step i [m/N]; the
  /// first H. Symmetric.
  std::array<Matrix3, kMaxHorizon> response = zeros<Matrix3>();

  /// The newest step up to K whose force is in it.
  std::uint64_t newest_known() const noexcept {
    return step - std::min<std::uint64_t>(step, static_cast<unsigned>(std::countr_one(missing)));
  }
};

/// The longest dt of a model that a bridge renders [s].
inline constexpr double kLongestForceStep = 0.02;

/// Bounds of what a bridge believes of a contact model.
struct ContactModelLimits {
  double farthest = 1000.0;      ///< of any place from the origin [m]
  double fastest = 100.0;        ///< object [m/s]
  double fastest_spin = 1000.0;  ///< [rad/s]
  double lightest = 1e-6;        ///< object [kg]
  double dt = 0.0;               ///< that a step must have [s]; 0: any
  double longest_step = kLongestForceStep;
  double stiffest = 2e5;  ///< contact within a step [N/m]
  double softest = 1.0;   ///< the same
};

/// What is wrong with a model.
enum class ContactModelFault : std::uint8_t {
  kNone,
  kShape,  ///< horizon, step or state out of range
  kNotFinite,
  kFar,       ///< away, or too fast
  kBody,      ///< mass or inertia that no body has, orientation that is none
  kNormal,    ///< not of unit length
  kFriction,  ///< negative, or kinetic above static
  kAsymmetric,
  kStiffness,  ///< within a step: not positive, too stiff or too soft
  kGrowing,    ///< answers later with more than a passive object can
};

/// For a log: what is wrong, in a few words.
const char* word(ContactModelFault fault) noexcept;

/// Looks at everything that a model says before anything is done with it. A passive linear object
/// answers a force held for one step n steps later by at most 2n + 1 times its answer within the
/// step. Real-time safe.
[[nodiscard]] ContactModelFault check(const ContactModel& model,
                                      const ContactModelLimits& limits = {}) noexcept;

}  // namespace irdm
