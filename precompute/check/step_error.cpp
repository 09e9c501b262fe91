#include "precompute/check/step_error.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/response/modal_response.hpp"
#include "precompute/check/lines.hpp"
#include "precompute/check/static_reference.hpp"

namespace irdm::precompute {
namespace {

constexpr double kNoticeable = 0.1;  // of force, by a finger

}  // namespace

Line step_line(const Model& model) {
  const auto distance = [&](int node) { return model.mesh.rest_position(node).norm(); };
  int nearest = -1;
  int farthest = -1;
  const auto& response = std::get<ModalResponse>(model.response);
  for (int i = 0; i < model.mesh.surface_node_count(); ++i) {
    const bool moves =
        std::visit([&](const auto& shapes) { return !shapes.middleRows(3 * i, 3).isZero(0.0); },
                   response.shapes);
    if (!moves) continue;
    if (nearest < 0 || distance(i) < distance(nearest)) nearest = i;
    if (farthest < 0 || distance(i) > distance(farthest)) farthest = i;
  }
  if (nearest < 0) return {"step", Verdict::kNone, "no node moves"};
  const double error = std::max(step_error(model, nearest, 1.0), step_error(model, farthest, 1.0));
  const double factor = std::min(stiffness_for_error(model, nearest, kNoticeable),
                                 stiffness_for_error(model, farthest, kNoticeable));
  const bool several = !model.material.elements.empty();
  return {"step", error < kNoticeable ? Verdict::kOk : Verdict::kWarn,
          text("a node that is pushed and held is felt within %.2g %% of what short steps give; "
               "10 %% from %s %.2g %s on",
               100.0 * error, several ? "Young's moduli" : "a Young's modulus of",
               several ? factor : factor * model.material.youngs_modulus,
               several ? "times these" : "N/m^2")};
}

namespace {

constexpr double kPush = 2e-3;        // [m]
constexpr double kPushTime = 0.05;    // [s]
constexpr double kWhole = 0.3;        // [s]
constexpr int kFiner = 16;            // steps of the reference in one
constexpr double kWidest = 1e3;       // factor on Young's modulus
constexpr double kCloseEnough = 1.1;  // of two factors

// 0 to 1, with three derivatives that begin and end at 0.
double smooth(double s) {
  s = std::clamp(s, 0.0, 1.0);
  return s * s * s * s * (35.0 - s * (84.0 - s * (70.0 - 20.0 * s)));
}

// The node's own rows of all modes, and its rigid mobility.
struct LedNode {
  Eigen::Matrix3Xd shapes;  // (3, r)
  Matrix3 mobility;         // G [1/kg]
  Vector3 inward;           // unit
  Eigen::ArrayXd frequency, decay;

  LedNode(const Model& model, int node, double stiffness) {
    const auto& response = std::get<ModalResponse>(model.response);
    shapes = std::visit(
        [&](const auto& all) -> Eigen::Matrix3Xd {
          return all.middleRows(3 * node, 3).template cast<double>();
        },
        response.shapes);
    const Vector3 x = model.mesh.rest_position(node);
    mobility = rigid_mobility(model.body, x, x);
    inward = -x.normalized();
    frequency = std::sqrt(stiffness) * response.angular_frequency.array();
    // Rayleigh damping: alpha stays, beta omega^2 goes with the stiffness.
    const Material& material = model.material;
    decay = 0.5 * (material.rayleigh_alpha + material.rayleigh_beta * frequency.square());
  }
};

// Forces of all steps [N], each the mean over its step.
std::vector<Vector3> forces(const LedNode& led, double dt) {
  const Eigen::Index modes = led.frequency.size();
  Eigen::ArrayXd a11(modes), a12(modes), a21(modes), a22(modes), b1(modes), b2(modes);
  for (Eigen::Index i = 0; i < modes; ++i) {
    const HeldForceOscillator step = held_force_oscillator(led.frequency(i), led.decay(i), dt);
    a11(i) = step.a11;
    a12(i) = step.a12;
    a21(i) = step.a21;
    a22(i) = step.a22;
    b1(i) = step.b1;
    b2(i) = step.b2;
  }
  const Matrix3 W =
      led.shapes * b1.matrix().asDiagonal() * led.shapes.transpose() + 0.5 * dt * dt * led.mobility;
  const Eigen::LDLT<Matrix3> solver(W);
  Eigen::ArrayXd q = Eigen::ArrayXd::Zero(modes);
  Eigen::ArrayXd v = q;
  Vector3 place = Vector3::Zero();
  Vector3 velocity = Vector3::Zero();
  std::vector<Vector3> result;
  for (int k = 1; k * dt <= kWhole * (1.0 + 1e-9); ++k) {
    const Eigen::ArrayXd free = a11 * q + a12 * v;
    v = a21 * q + a22 * v;
    const Vector3 rest = led.shapes * free.matrix() + place + dt * velocity;
    const Vector3 f = solver.solve(kPush * smooth(k * dt / kPushTime) * led.inward - rest);
    const Eigen::ArrayXd modal = (led.shapes.transpose() * f).array();
    q = free + b1 * modal;
    v += b2 * modal;
    place += dt * velocity + 0.5 * dt * dt * led.mobility * f;
    velocity += dt * led.mobility * f;
    result.push_back(f);
  }
  return result;
}

}  // namespace

double step_error(const Model& model, int node, double stiffness) {
  const LedNode led(model, node, stiffness);
  const std::vector<Vector3> coarse = forces(led, model.dt);
  const std::vector<Vector3> fine = forces(led, model.dt / kFiner);
  double peak = 0.0;
  for (const Vector3& force : fine) peak = std::max(peak, force.norm());
  double apart = 0.0;
  for (std::size_t k = 0; k < coarse.size() && (k + 1) * kFiner <= fine.size(); ++k) {
    Vector3 mean = Vector3::Zero();
    for (std::size_t i = k * kFiner; i < (k + 1) * kFiner; ++i) mean += fine[i] / kFiner;
    apart = std::max(apart, (coarse[k] - mean).norm());
  }
  return apart / peak;
}

double stiffness_for_error(const Model& model, int node, double bound) {
  double low = 1.0 / kWidest;
  double high = kWidest;
  if (!(step_error(model, node, low) < bound)) return low;
  if (step_error(model, node, high) < bound) return high;
  while (high > kCloseEnough * low) {
    const double middle = std::sqrt(low * high);
    (step_error(model, node, middle) < bound ? low : high) = middle;
  }
  return low;
}

}  // namespace irdm::precompute
