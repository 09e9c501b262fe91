#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "common/geometry.hpp"
#include "common/stylus.hpp"

namespace irdm {

inline constexpr int kMaxStyluses = 4;

/// A force that was decided elsewhere (by a bridge that solved the contact itself); the step
/// applies it.
struct GivenForce {
  ContactState contact = ContactState::kTouching;
  SurfacePoint point;
  Vector3 force = Vector3::Zero();  ///< on the object [N], W
};

/// What one stylus asks of one step.
struct StylusCommand {
  bool present = false;  ///< false: nobody is there; a contact that was there ends
  std::uint32_t buttons = 0;
  Vector3 tip =
      Vector3::Zero();  ///< at the end of the step [m], W; the step solves for the force ...
  std::optional<GivenForce> given;  ///< ... unless it is given
};

/// What became of one stylus in one step.
struct StylusRecord {
  bool present = false;
  ContactState contact = ContactState::kFree;
  std::uint32_t buttons = 0;
  Vector3 tip = Vector3::Zero();  ///< [m], W
  Vector3 proxy =
      Vector3::Zero();  ///< god-object: the contact's point of the surface, free: the tip [m], W
  Vector3 force = Vector3::Zero();            ///< on the stylus [N], W
  Vector3 force_on_object = Vector3::Zero();  ///< [N], B
  SurfacePoint point;                         ///< of the contact; means nothing when free
  Vector3 offset = Vector3::Zero();           ///< from the held point to the tip [m], B
};

/// What happened in one step: everything that the trace, the deformation and the bridges need.
struct StepRecord {
  std::uint64_t force_step = 0;                     ///< k
  double time = 0.0;                                ///< (k + 1) dt, the end of the step [s]
  Vector3 position = Vector3::Zero();               ///< of the body at the end of the step [m], W
  Quaternion orientation = Quaternion::Identity();  ///< B to W
  Vector3 velocity = Vector3::Zero();               ///< [m/s], W
  Vector3 angular_velocity = Vector3::Zero();       ///< [rad/s], W
  int stylus_count = 0;
  std::array<StylusRecord, kMaxStyluses> stylus;
  double residual = 0.0;  ///< of the contact problem [m]
  bool solved = true;     ///< false: the contact problem had no finite solution and no force acted
};

}  // namespace irdm
