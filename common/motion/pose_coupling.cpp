#include "common/motion/pose_coupling.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/dense_algebra.hpp"
#include "common/error.hpp"
#include "common/number_text.hpp"

namespace irdm {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// Of the defaults: the stiffest for a hand, and (w dt)^2.
constexpr double kDefaultStiffness = 500.0;
constexpr double kDefaultAngularStiffness = 1.0;
constexpr double kDefaultShare = 0.05;
// Accepted: (w dt)^2, and rate times dt.
constexpr double kMostStiff = 0.5;
constexpr double kMostDamped = 2.0;
// About one axis, as a share of I_i / dt^2 and of I_i / dt.
constexpr double kAxisStiffness = 0.25;
constexpr double kAxisDamping = 1.0;
// Of the default damping. Less, or a stiffer spring, and a thin body that turns far gains energy:
// with w dt = 0.9 up to 81 times what it began with, undamped with w dt = 0.5 without bound.
constexpr double kLeastDamping = 0.3;

// Velocity of the reference point and angular velocity per impulse there, B.
Matrix6 mobility_at(const BodyProperties& body, const Vector3& reference) {
  const Matrix3 inverse = body.inertia.inverse();
  const Matrix3 arm = skew(reference);
  Matrix6 mobility;
  mobility.topLeftCorner<3, 3>() = Matrix3::Identity() / body.mass - arm * inverse * arm;
  mobility.topRightCorner<3, 3>() = -arm * inverse;
  mobility.bottomLeftCorner<3, 3>() = inverse * arm;
  mobility.bottomRightCorner<3, 3>() = inverse;
  return mobility;
}

// Least mass at the reference point [kg].
double least_mass(const BodyProperties& body, const Vector3& reference) {
  const Matrix3 at_point = mobility_at(body, reference).topLeftCorner<3, 3>();
  return 1.0 / symmetric_eigenvalues(at_point)(2);
}

double largest_inertia(const BodyProperties& body) {
  return symmetric_eigenvalues(body.inertia)(2);
}

// `constant` about all axes, but about none more than `share` of its moment of inertia.
Matrix3 limited_by_inertia(double constant, double share, const Matrix3& inertia) {
  const SymmetricEigen axes = symmetric_eigenpairs(inertia);
  const Vector3 limited = (share * axes.values).cwiseMin(constant);
  if (limited.minCoeff() == constant) return constant * Matrix3::Identity();
  return axes.vectors * limited.asDiagonal() * axes.vectors.transpose();
}

// Largest eigenvalue of mobility times `constants`, both symmetric and the mobility definite.
double largest_rate(const Matrix6& mobility, const Matrix6& constants) {
  const Matrix6 root = Eigen::LLT<Matrix6>(mobility).matrixL();
  return symmetric_eigenvalues(Matrix6(root.transpose() * constants * root))(5);
}

Matrix6 both(double constant, const Matrix3& angular) {
  Matrix6 matrix = Matrix6::Zero();
  matrix.topLeftCorner<3, 3>().diagonal().setConstant(constant);
  matrix.bottomRightCorner<3, 3>() = angular;
  return matrix;
}

void check_constants(const CouplingConstants& constants, const std::string& where) {
  for (const std::optional<double>& constant :
       {constants.stiffness, constants.damping, constants.angular_stiffness,
        constants.angular_damping}) {
    if (std::isfinite(*constant) && *constant >= 0.0) continue;
    throw Error(where, "has a constant of " + std::to_string(*constant),
                "use numbers of 0 and above");
  }
}

[[noreturn]] void refuse(const std::string& where, const char* what, double most,
                         const char* unit) {
  throw Error(where, std::string("has ") + what + " that is too strong for its object and dt",
              "use at most " + number_text(most) + " " + unit);
}

void check_least(double damping, double normal, const char* what, const char* unit,
                 const std::string& where) {
  if (damping >= kLeastDamping * normal) return;
  throw Error(where, std::string("has ") + what + " that is too weak for its stiffness",
              "use at least " + std::to_string(1.001 * kLeastDamping * normal) + " " + unit);
}

// The rotation vector that takes the body to its home [rad], B.
Vector3 turn_to_home(const Quaternion& home, const Quaternion& orientation) noexcept {
  return rotation_vector(orientation.conjugate() * home);
}

// The torque that belongs to a potential of the rotation vector `turn`, by its gradient there: what
// small rotations of the body change the vector by is the inverse of the left Jacobian.
Vector3 torque_of(const Vector3& turn, const Vector3& gradient) noexcept {
  const double angle = turn.norm();
  const double half = 0.5 * angle;
  const double c =
      angle < 1e-3 ? 1.0 / 12.0 : (1.0 - half * std::cos(half) / std::sin(half)) / (angle * angle);
  const Vector3 across = turn.cross(gradient);
  return gradient + 0.5 * across + c * turn.cross(across);
}

}  // namespace

PoseCoupling::PoseCoupling(const BodyProperties& body, const Vector3& reference,
                           const CouplingConstants& constants, double dt, const std::string& where)
    : reference_(reference), dt_(dt) {
  if (body.support != Support::kFloating) {
    throw Error(where, "leads an object that is fixed", "use a model with support = \"floating\"");
  }
  constants_ = default_coupling(body, reference, dt, constants);
  check_constants(constants_, where);
  const double inertia = largest_inertia(body);
  const double stiffest = kAxisStiffness * inertia / (dt * dt);
  if (*constants_.angular_stiffness > stiffest) {
    refuse(where, "an angular_stiffness", stiffest, "N m/rad");
  }
  const double most_damped = kAxisDamping * inertia / dt;
  if (*constants_.angular_damping > most_damped) {
    refuse(where, "an angular_damping", most_damped, "N m s/rad");
  }
  angular_stiffness_ =
      limited_by_inertia(*constants_.angular_stiffness, kAxisStiffness / (dt * dt), body.inertia);
  const Matrix3 angular_damping =
      limited_by_inertia(*constants_.angular_damping, kAxisDamping / dt, body.inertia);
  const Matrix6 mobility = mobility_at(body, reference);
  const double mass = least_mass(body, reference);
  const double w2 = largest_rate(mobility, both(*constants_.stiffness, angular_stiffness_));
  if (dt * dt * w2 > kMostStiff) {
    const double left =
        kMostStiff / (dt * dt) - largest_rate(mobility, both(0, angular_stiffness_));
    refuse(where, "a stiffness", left * mass, "N/m");
  }
  const Matrix6 damping = both(*constants_.damping, angular_damping);
  if (dt * largest_rate(mobility, damping) > kMostDamped) {
    const double left = kMostDamped / dt - largest_rate(mobility, both(0, angular_damping));
    refuse(where, "a damping", left * mass, "N s/m");
  }
  const CouplingConstants normal = default_coupling(
      body, reference, dt, {constants_.stiffness, {}, constants_.angular_stiffness, {}});
  check_least(*constants_.damping, *normal.damping, "a damping", "N s/m", where);
  check_least(*constants_.angular_damping, *normal.angular_damping, "an angular_damping",
              "N m s/rad", where);
  highest_frequency_ = std::sqrt(w2);
  const double h = 0.5 * dt;
  half_step_ = (Matrix6::Identity() + 0.5 * h * damping * mobility).partialPivLu().solve(damping);
}

Wrench PoseCoupling::spring(const CouplingHome& home, const Vector3& position,
                            const Quaternion& orientation) const noexcept {
  const Vector3 turn = turn_to_home(home.orientation, orientation);
  return {*constants_.stiffness * (home.position - position - orientation * reference_),
          orientation * torque_of(turn, angular_stiffness_ * turn)};
}

double PoseCoupling::energy(const CouplingHome& home, const Vector3& position,
                            const Quaternion& orientation) const noexcept {
  const Vector3 turn = turn_to_home(home.orientation, orientation);
  const Vector3 gap = home.position - position - orientation * reference_;
  return 0.5 * (*constants_.stiffness * gap.squaredNorm() + turn.dot(angular_stiffness_ * turn));
}

Wrench PoseCoupling::damp(const CouplingHome& home, const RigidBody& body, RigidState& state,
                          double& work) const noexcept {
  const Quaternion& Q = state.orientation;
  const Vector3 w = body.angular_velocity(state);
  const Vector3 arm = Q * reference_;
  Vector6 missing;  // of the velocities of the home, B
  missing.head<3>() = Q.conjugate() * (home.velocity - state.velocity - w.cross(arm));
  missing.tail<3>() = Q.conjugate() * (home.angular_velocity - w);
  const Vector6 found = half_step_ * missing;
  const Wrench mean{Q * found.head<3>(), Q * found.tail<3>()};
  const double h = 0.5 * dt_;
  const double before = state.angular_momentum.dot(w) + body.mass() * state.velocity.squaredNorm();
  state.velocity += h / body.mass() * mean.force;
  state.angular_momentum += h * (mean.torque + arm.cross(mean.force));
  const double after = state.angular_momentum.dot(body.angular_velocity(state)) +
                       body.mass() * state.velocity.squaredNorm();
  work += 0.5 * (after - before);
  return mean;
}

CouplingConstants default_coupling(const BodyProperties& body, const Vector3& reference, double dt,
                                   const CouplingConstants& constants) {
  const double m = least_mass(body, reference);
  const double I = largest_inertia(body);
  const double k =
      constants.stiffness.value_or(std::min(kDefaultStiffness, kDefaultShare * m / (dt * dt)));
  const double k_r = constants.angular_stiffness.value_or(
      std::min(kDefaultAngularStiffness, kDefaultShare * I / (dt * dt)));
  const double d = constants.damping.value_or(std::min(2.0 * std::sqrt(k * m), m / dt));
  const double d_r = constants.angular_damping.value_or(std::min(2.0 * std::sqrt(k_r * I), I / dt));
  return {k, d, k_r, d_r};
}

}  // namespace irdm
