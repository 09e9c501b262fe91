#include "replay/compare/compare_runs.hpp"

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "replay/rerun/deviation.hpp"

namespace irdm::replay {
namespace {

FramePairs common_frames(const std::vector<double>& a, const std::vector<double>& b) {
  constexpr double kSame = 1e-9;
  FramePairs pairs;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    if (std::abs(a[i] - b[j]) <= kSame) {
      pairs.emplace_back(i++, j++);
    } else {
      ++(a[i] < b[j] ? i : j);
    }
  }
  return pairs;
}

// The same rest shape within a millionth of its size.
bool same_nodes(const Points& a, const Points& b) {
  return a.rows() == b.rows() && (a - b).cwiseAbs().maxCoeff() <= 1e-6 * a.cwiseAbs().maxCoeff();
}

void add(DifferenceSeries& series, double difference) {
  series.rms.push_back(difference);
  series.largest.push_back(difference);
}

void add(DifferenceSeries& series, const Points& difference) {
  const Eigen::VectorXd squares = difference.rowwise().squaredNorm();
  series.rms.push_back(std::sqrt(squares.mean()));
  series.largest.push_back(std::sqrt(squares.maxCoeff()));
}

Points places_of(const RunPose& pose, const Points& rest, const Points& u) {
  const Matrix3 Q = pose.orientation.toRotationMatrix();
  return ((rest + u) * Q.transpose()).rowwise() + pose.position.transpose();
}

ObjectComparison compare_object(const RunReader& a, const RunReader& b, std::size_t i,
                                const FramePairs& frames) {
  ObjectComparison found;
  found.name = a.objects()[i];
  found.same_nodes = same_nodes(a.rest(i), b.rest(i));
  Points u_a;
  Points u_b;
  for (const auto& [frame_a, frame_b] : frames) {
    const RunPose pose_a = a.pose(i, frame_a);
    const RunPose pose_b = b.pose(i, frame_b);
    add(found.centre_of_mass, (pose_a.position - pose_b.position).norm());
    add(found.orientation, angle_between(pose_a.orientation, pose_b.orientation));
    if (!found.same_nodes) continue;
    a.displacement(i, frame_a, u_a);
    b.displacement(i, frame_b, u_b);
    add(found.displacement, Points(u_a - u_b));
    add(found.place, Points(places_of(pose_a, a.rest(i), u_a) - places_of(pose_b, b.rest(i), u_b)));
    Eigen::Index most = 0;
    const double largest = u_a.rowwise().norm().maxCoeff(&most);
    if (largest <= found.displacement.reference) continue;
    found.displacement.reference = largest;
    found.node = most;
  }
  return found;
}

DifferenceSeries compare_force(const RunReader& a, const RunReader& b, std::size_t s,
                               const FramePairs& frames) {
  DifferenceSeries series;
  for (const auto& [frame_a, frame_b] : frames) {
    const Vector3 force = a.force(s, frame_a);
    add(series, (force - b.force(s, frame_b)).norm());
    series.reference = std::max(series.reference, force.norm());
  }
  return series;
}

}  // namespace

double DifferenceSeries::rms_over_time() const {
  double sum = 0.0;
  for (const double each : rms) sum += each * each;
  return rms.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(rms.size()));
}

double DifferenceSeries::maximum() const {
  return largest.empty() ? 0.0 : *std::max_element(largest.begin(), largest.end());
}

std::size_t DifferenceSeries::worst_frame() const {
  return static_cast<std::size_t>(std::max_element(largest.begin(), largest.end()) -
                                  largest.begin());
}

Comparison compare_runs(const RunReader& a, const RunReader& b) {
  if (a.objects() != b.objects() || a.styluses() != b.styluses()) {
    throw Error(b.name(), "has other objects or styluses than " + a.name(),
                "compare runs of the same scene");
  }
  const FramePairs frames = common_frames(a.times(), b.times());
  if (frames.empty()) {
    throw Error(b.name(), "has no frame at a time of one of " + a.name(),
                "make both with the same --rate");
  }
  Comparison found;
  found.a = a.name();
  found.b = b.name();
  found.frames = frames;
  found.alone = a.times().size() + b.times().size() - 2 * frames.size();
  for (const auto& pair : frames) found.times.push_back(a.times()[pair.first]);
  for (std::size_t i = 0; i < a.objects().size(); ++i) {
    found.objects.push_back(compare_object(a, b, i, frames));
  }
  for (std::size_t s = 0; s < a.styluses(); ++s) {
    found.forces.push_back(compare_force(a, b, s, frames));
  }
  return found;
}

}  // namespace irdm::replay
