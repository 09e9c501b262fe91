#pragma once

#include <optional>
#include <string>

#include "common/geometry.hpp"
#include "common/model/model.hpp"
#include "common/motion/rigid_body.hpp"
#include "common/motion/wrench.hpp"

namespace irdm {

/// Constants of a PoseCoupling. Those left out: default_coupling().
struct CouplingConstants {
  std::optional<double> stiffness;          ///< [N/m], >= 0
  std::optional<double> damping;            ///< [N s/m], >= 0
  std::optional<double> angular_stiffness;  ///< [N m/rad], >= 0
  std::optional<double> angular_damping;    ///< [N m s/rad], >= 0

  bool operator==(const CouplingConstants&) const = default;
};

/// Where a coupling's home is in one step, and how it moves.
struct CouplingHome {
  Vector3 position = Vector3::Zero();               ///< half-way through the step [m], W
  Quaternion orientation = Quaternion::Identity();  ///< the same, of B in W
  Vector3 velocity = Vector3::Zero();               ///< [m/s], W
  Vector3 angular_velocity = Vector3::Zero();       ///< [rad/s], W
};

/// Spring and damper of six degrees of freedom from a pose that moves, the home, to a rigid body at
/// its reference point: a virtual coupling (Colgate 1995; McNeely 1999). The spring acts as it is
/// half-way through a step, explicitly, as a tether does. The damper acts in two halves, before and
/// after what else happens in the step (Strang splitting), each by the implicit midpoint rule:
/// together of second order, and no half gives energy. For small motions the spring is stable up to
/// w dt = 2, w the highest angular frequency of the body on it. At most 0.7 is accepted: a thin
/// body that turns far needs that, and some damping.
///
/// About a principal axis with so small a moment of inertia I_i that the spring would be too fast
/// for the step, it is weaker: I_i / 4 dt^2 at most, and its damping I_i / dt. That is the twist of
/// a thin rod about itself. Pure, real-time safe after construction.
class PoseCoupling {
 public:
  /// Throws Error, naming `where`, when the body does not float, a constant is negative or not
  /// finite, the coupling is too strong for dt ((w dt)^2 > 0.5, a damping rate times dt above 2, or
  /// an angular constant that is reached about no axis), or a damping is below 0.3 of its default.
  /// @param reference point of the body at which it acts [m], B
  PoseCoupling(const BodyProperties& body, const Vector3& reference,
               const CouplingConstants& constants, double dt, const std::string& where);

  /// Of the spring on a body that stands so, at the reference point, W.
  Wrench spring(const CouplingHome& home, const Vector3& position,
                const Quaternion& orientation) const noexcept;
  /// Half a step of the damper, which changes the velocities of the state.
  /// @param work that it does on the body [J], added  @return mean over that half, W
  Wrench damp(const CouplingHome& home, const RigidBody& body, RigidState& state,
              double& work) const noexcept;
  /// Energy of the spring [J].
  double energy(const CouplingHome& home, const Vector3& position,
                const Quaternion& orientation) const noexcept;

  const Vector3& reference() const noexcept { return reference_; }  ///< [m], B
  /// The constants with which it was made, none of them left out.
  const CouplingConstants& constants() const noexcept { return constants_; }
  /// Highest angular frequency of the body on the spring, undamped [rad/s].
  double highest_frequency() const noexcept { return highest_frequency_; }

 private:
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  Vector3 reference_;
  CouplingConstants constants_;
  double dt_;
  Matrix3 angular_stiffness_;  ///< [N m/rad], B
  Matrix6 half_step_;          ///< (1 + h/2 D A)^-1 D of half a step h, A the mobility, B
  double highest_frequency_ = 0.0;
};

/// Constants that suit any body that floats, with m = 1 / (1/M + a^2/I) the least mass that the
/// reference point shows, and I the largest principal moment of inertia:
/// k = min(500 N/m, 0.05 m / dt^2), d = min(2 sqrt(k m), m / dt), and of rotation
/// k_r = min(1 N m/rad, 0.05 I / dt^2), d_r = min(2 sqrt(k_r I), I / dt).
/// @param constants those that are given stay as they are
CouplingConstants default_coupling(const BodyProperties& body, const Vector3& reference, double dt,
                                   const CouplingConstants& constants = {});

}  // namespace irdm
