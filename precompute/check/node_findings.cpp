#include "precompute/check/node_findings.hpp"

#include <cmath>
#include <limits>

namespace irdm::precompute {
namespace {

double left_at_end(const DrivingPoint& record) {
  const Eigen::Index tail = (record.cols() + 9) / 10;
  return record.rightCols(tail).cwiseAbs().maxCoeff() / record.cwiseAbs().maxCoeff();
}

}  // namespace

NodeFindings analyse_node(const DrivingPoint& record, const Matrix3& rigid,
                          const NodeConditions& conditions) {
  NodeFindings found;
  if (record.isZero(0.0)) {
    found.clamped = true;
    return found;
  }
  if (!record.allFinite()) {
    constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
    found = {false, {kNothing, 0.0}, {1, kNothing}, kNothing, kNothing, 0.0, kNothing};
    return found;
  }
  found.passivity = analyse_passivity(record, conditions.radius);
  const double radius = conditions.radius * std::exp(-kSlowestGrowth * conditions.loop.dt);
  found.inverse = analyse_inverse(record, rigid, radius);
  found.stiffness = held_stiffness(record, rigid);
  found.elastic_stiffness = held_stiffness(record, Matrix3::Zero());
  found.coupling = largest_coupling(record, rigid, conditions.loop, radius);
  found.left = left_at_end(record);
  return found;
}

}  // namespace irdm::precompute
