#include "common/contact/contact_model.hpp"

#include <cmath>

namespace irdm {
namespace {

using Solver = Eigen::SelfAdjointEigenSolver<Matrix3>;

// Of what is symmetric but for rounding, single precision included.
constexpr double kAsymmetry = 1e-4;
// Rounding and single precision on top of the bound of a passive object.
constexpr double kGrowthMargin = 1.01;

bool all_finite(const ContactModel& model) noexcept {
  const FreeForces& forces = model.free_forces;
  bool finite = model.place.allFinite() && model.normal.allFinite() && model.series.allFinite() &&
                model.other_force.allFinite() && model.other_torque.allFinite() &&
                std::isfinite(model.energy) && forces.gravity.allFinite() &&
                forces.home_position.allFinite() && forces.home_orientation.coeffs().allFinite();
  for (const double number : {forces.damping.linear, forces.damping.angular,
                              forces.tether.stiffness, forces.tether.angular_stiffness}) {
    finite = finite && std::isfinite(number) && number >= 0.0;
  }
  for (int n = 0; n < model.horizon; ++n) {
    const auto i = static_cast<std::size_t>(n);
    finite = finite && model.path[i].allFinite() && model.response[i].allFinite();
  }
  return finite;
}

bool unit(const Quaternion& q) noexcept {
  return std::abs(q.coeffs().norm() - 1.0) <= 1e-6;
}

bool symmetric(const Matrix3& m, double scale) noexcept {
  return (m - m.transpose()).cwiseAbs().maxCoeff() <= kAsymmetry * scale;
}

// Infinity is a value of friction; not a number fails both.
bool sound(const Friction& friction) noexcept {
  return friction.kinetic >= 0.0 && friction.kinetic <= friction.static_;
}

// Not a number fails every comparison.
ContactModelFault check_body(const ContactModel& model, const ContactModelLimits& limits) noexcept {
  const BodyProperties& body = model.body;
  const RigidState& motion = model.motion;
  if (!(body.mass >= limits.lightest) || !std::isfinite(body.mass) || !body.inertia.allFinite() ||
      !symmetric(body.inertia, body.inertia.norm()) || !unit(motion.orientation) ||
      !unit(model.free_forces.home_orientation)) {
    return ContactModelFault::kBody;
  }
  const auto inertia = Solver(body.inertia, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(inertia[0] > 0.0)) return ContactModelFault::kBody;
  if (!(motion.position.norm() <= limits.farthest) || !(motion.velocity.norm() <= limits.fastest) ||
      !(motion.angular_momentum.norm() <= limits.fastest_spin * inertia[0])) {
    return ContactModelFault::kFar;
  }
  return ContactModelFault::kNone;
}

ContactModelFault check_stiffness(const ContactModel& model, const Matrix3& rigid,
                                  const ContactModelLimits& limits) noexcept {
  const Matrix3& within = model.response[0];
  const double scale = within.norm();
  if (!symmetric(within, scale) || !symmetric(model.series, model.series.norm())) {
    return ContactModelFault::kAsymmetric;
  }
  const Matrix3 own = within + rigid;
  const auto moved = Solver(own, Eigen::EigenvaluesOnly).eigenvalues();
  const auto series = Solver(model.series, Eigen::EigenvaluesOnly).eigenvalues();
  const auto whole = Solver(own + model.series, Eigen::EigenvaluesOnly).eigenvalues();
  const double rounding = kAsymmetry * scale;
  if (!(moved[0] >= -rounding) || !(series[0] >= -1e-9 * model.series.norm()) ||
      !(whole[0] * limits.stiffest >= 1.0) || !(whole[2] * limits.softest <= 1.0)) {
    return ContactModelFault::kStiffness;
  }
  for (int n = 0; n < model.horizon; ++n) {
    const auto i = static_cast<std::size_t>(n);
    if (!(model.path[i].norm() <= limits.farthest)) return ContactModelFault::kFar;
    const Matrix3& response = model.response[i];
    if (!symmetric(response, scale)) return ContactModelFault::kAsymmetric;
    const double count = 2 * n + 1;
    const auto eigenvalues = Solver(response + count * rigid, Eigen::EigenvaluesOnly).eigenvalues();
    const double most = kGrowthMargin * count * moved[2];
    if (!(eigenvalues.cwiseAbs().maxCoeff() <= most)) return ContactModelFault::kGrowing;
  }
  return ContactModelFault::kNone;
}

}  // namespace

const char* word(ContactModelFault fault) noexcept {
  switch (fault) {
    case ContactModelFault::kNone:
      return "nothing";
    case ContactModelFault::kShape:
      return "horizon, step or state";
    case ContactModelFault::kNotFinite:
      return "not finite";
    case ContactModelFault::kFar:
      return "too far or too fast";
    case ContactModelFault::kBody:
      return "mass, inertia or orientation";
    case ContactModelFault::kNormal:
      return "normal";
    case ContactModelFault::kFriction:
      return "friction";
    case ContactModelFault::kAsymmetric:
      return "compliance not symmetric";
    case ContactModelFault::kStiffness:
      return "too stiff, too soft or not positive";
    case ContactModelFault::kGrowing:
      return "more than a passive object answers";
  }
  return "unknown";
}

ContactModelFault check(const ContactModel& model, const ContactModelLimits& limits) noexcept {
  if (!model.valid) return ContactModelFault::kNone;
  if (model.horizon < 1 || model.horizon > kMaxHorizon || !(model.dt > 0.0) ||
      !(model.dt <= limits.longest_step) || (limits.dt > 0.0 && model.dt != limits.dt) ||
      model.state > ContactState::kHeld) {
    return ContactModelFault::kShape;
  }
  if (!all_finite(model)) return ContactModelFault::kNotFinite;
  if (!sound(model.friction)) return ContactModelFault::kFriction;
  const bool has_plane = model.state != ContactState::kHeld;
  if (has_plane && std::abs(model.normal.norm() - 1.0) > 1e-6) return ContactModelFault::kNormal;
  const ContactModelFault body = check_body(model, limits);
  if (body != ContactModelFault::kNone) return body;
  if (!(model.place.norm() <= limits.farthest)) return ContactModelFault::kFar;
  const Vector3 arm = model.place + model.path[0];
  const Matrix3 rigid = RigidBody(model.body, model.dt).mobility().between(arm, arm);
  return check_stiffness(model, rigid, limits);
}

}  // namespace irdm
