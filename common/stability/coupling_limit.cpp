#include "common/stability/coupling_limit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/dense_algebra.hpp"
#include "common/motion/rigid_body.hpp"
#include "common/response/modal_response.hpp"
#include "common/response/stored_response.hpp"

namespace irdm {
namespace {

// Where the zeros are looked for, as logarithms of the radius beyond the circle that counts: a mode
// of the force that grows or decays faster a step is not told apart from one at that bound.
constexpr double kInward = 7.0;
constexpr double kNearest = 1e-6;
constexpr double kOutward = 0.5;
constexpr int kPoleBisections = 12;
// Beyond it, a record that was scaled by the powers of the radius overflows when squared and cubed.
constexpr double kLargest = 1e60;

ZeroCount zeros_inside(const DrivingPoint& record, const Matrix3& rigid, double radius) {
  const bool floating = !rigid.isZero(0.0);
  const MatrixHalfCircle response = transform(record, radius, resolving_half_circle(record.cols()));
  return count_zeros(response, radius,
                     [&](const Eigen::Matrix3cd& r, const std::complex<double>& w) {
                       if (!floating) return r.determinant();
                       const Eigen::Matrix3cd c = (1.0 - w) * (1.0 - w) * r + (1.0 + w) * rigid;
                       return c.determinant();
                     });
}

}  // namespace

InverseStability analyse_inverse(const DrivingPoint& record, const Matrix3& rigid, double radius) {
  const auto [growing, resolved] = zeros_inside(record, rigid, radius);
  if (!resolved) return {0, 0.0, false};
  // Bisection for the circle that just reaches the first zero, in the logarithm of its distance:
  // most lie near the unit circle.
  const double sign = growing > 0 ? -1.0 : 1.0;
  const double widest = std::log(kLargest) / static_cast<double>(record.cols());
  double near = kNearest;
  double far = growing > 0 ? kInward : std::min(kOutward, widest);
  for (int i = 0; i < kPoleBisections; ++i) {
    const double middle = std::sqrt(near * far);
    const ZeroCount found = zeros_inside(record, rigid, radius * std::exp(sign * middle));
    if (!found.resolved) return {growing, 0.0, false};
    const bool reached = found.zeros > 0;
    (reached == (growing > 0) ? near : far) = middle;
  }
  return {growing, std::exp(-sign * std::sqrt(near * far)) / radius};
}

double held_stiffness(const DrivingPoint& record, const Matrix3& rigid) {
  const Matrix3 first = record.col(0).reshaped(3, 3);
  const Matrix3 compliance = 0.5 * (first + first.transpose()) + rigid;
  return 1.0 / symmetric_eigenvalues(compliance)(0);
}

namespace {

constexpr int kPerDecade = 6;
constexpr int kCouplingBisections = 20;

// det(C + w^delay H + Id / k), times the pole of the rigid motion.
class ClosedLoop {
 public:
  ClosedLoop(const DrivingPoint& record, const Matrix3& rigid, const HandLoop& loop, double radius)
      : rigid_(rigid),
        radius_(radius),
        response_(transform(record, radius, resolving_half_circle(record.cols()))) {
    for (std::size_t j = 0; j < response_.size(); ++j) {
      const int half = static_cast<int>(response_.size()) - 1;
      const std::complex<double> w = circle_point(radius, half, static_cast<double>(j));
      response_[j] += std::pow(w, loop.delay) * hand_transfer(loop.hand, loop.dt, w) *
                      Eigen::Matrix3cd::Identity();
    }
  }

  ZeroCount growing(double coupling) const {
    const bool floating = !rigid_.isZero(0.0);
    return count_zeros(response_, radius_,
                       [&](const Eigen::Matrix3cd& r, const std::complex<double>& w) {
                         const std::complex<double> g = floating ? (1.0 - w) * (1.0 - w) : 1.0;
                         Eigen::Matrix3cd c = g * r + (1.0 + w) * rigid_;
                         c.diagonal().array() += g / coupling;
                         return c.determinant();
                       });
  }

 private:
  Matrix3 rigid_;
  double radius_;
  MatrixHalfCircle response_;  // of object and hand in series
};

}  // namespace

int loop_delay(double one_way, double dt) {
  // A delay of whole steps must not become one more by rounding.
  return 1 + 2 * static_cast<int>(std::ceil(one_way / dt - 1e-9));
}

std::complex<double> hand_transfer(const Hand& hand, double dt, std::complex<double> w) {
  const HeldForceOscillator o = held_force_oscillator(std::sqrt(hand.stiffness / hand.mass),
                                                      0.5 * hand.damping / hand.mass, dt);
  // The two-term recursion of a linear second-order system: h[s] = trace h[s-1] - det h[s-2].
  const double trace = o.a11 + o.a22;
  const double determinant = o.a11 * o.a22 - o.a12 * o.a21;
  const double second = o.a11 * o.b1 + o.a12 * o.b2 - trace * o.b1;
  return (o.b1 + second * w) / (hand.mass * (1.0 - trace * w + determinant * w * w));
}

double largest_coupling(const DrivingPoint& record, const Matrix3& rigid, const HandLoop& loop,
                        double radius) {
  const ClosedLoop closed(record, rigid, loop, radius);
  const double factor = std::pow(10.0, 1.0 / kPerDecade);
  bool resolved = true;
  const auto grows = [&](double coupling) {
    const ZeroCount found = closed.growing(coupling);
    resolved = resolved && found.resolved;
    return found.zeros > 0;
  };
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  double stable = kSoftestCoupling;
  if (grows(stable)) return resolved ? 0.0 : kUnknown;
  double grown = stable * factor;
  while (resolved && !grows(grown)) {
    stable = grown;
    grown *= factor;
    if (!resolved) break;
    if (stable > kStiffestCoupling) return std::numeric_limits<double>::infinity();
  }
  for (int i = 0; resolved && i < kCouplingBisections; ++i) {
    const double middle = std::sqrt(stable * grown);
    (grows(middle) ? grown : stable) = middle;
  }
  return resolved ? stable : kUnknown;
}

namespace {

// Steps 0: the response is not there, or not all of it.
RecordLength length_of(const Model& model) {
  if (const auto* modal = std::get_if<ModalResponse>(&model.response)) {
    return record_length(*modal, model.dt);
  }
  if (const auto* compressed = std::get_if<CompressedResponse>(&model.response)) {
    return record_length(*compressed);
  }
  return {std::holds_alternative<DenseResponse>(model.response) ? model.steps : 0, 1.0};
}

}  // namespace

double sampled_coupling(const Model& model, int count) {
  double limit = std::numeric_limits<double>::infinity();
  const RecordLength length = length_of(model);
  if (length.steps == 0) return limit;
  const double radius = length.radius * std::exp(-kSlowestGrowth * model.dt);
  const HandLoop loop{{}, model.dt, loop_delay(model.dt, model.dt)};
  const RigidMobility mobility = RigidBody(model.body, model.dt).mobility();
  const auto R = stored_response(model);
  const int nodes = model.mesh.surface_node_count();
  for (int i = 0; i < std::min(count, nodes); ++i) {
    const int node = static_cast<int>(static_cast<long>(i) * nodes / std::min(count, nodes));
    const DrivingPoint record = R->driving_points(node, 1, length.steps).front();
    if (record.isZero(0.0)) continue;  // clamped
    const Vector3 x = model.mesh.rest_position(node);
    limit = std::min(limit, largest_coupling(record, mobility.between(x, x), loop, radius));
  }
  return limit;
}

}  // namespace irdm
