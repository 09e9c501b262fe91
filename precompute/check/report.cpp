#include "precompute/check/report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
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

Verdict judge(double value, double warn, double fail) {
  if (std::isnan(value) || value > fail) return Verdict::kFail;
  return value > warn ? Verdict::kWarn : Verdict::kOk;
}

std::string format_report(const Report& report) {
  std::size_t width = 0;
  for (const Line& line : report) width = std::max(width, line.name.size());
  std::string table;
  for (const Line& line : report) {
    const char* const words[] = {"ok  ", "warn", "FAIL", "none"};
    table += "  " + line.name + std::string(width - line.name.size() + 2, ' ') +
             words[static_cast<int>(line.verdict)] + "  " + line.found + "\n";
  }
  return table;
}

std::string failed_lines(const Report& report) {
  std::string names;
  for (const Line& line : report) {
    if (line.verdict == Verdict::kFail) names += (names.empty() ? "" : ", ") + line.name;
  }
  return names;
}

std::string text(const char* format, ...) {
  char buffer[512];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer, sizeof buffer, format, arguments);
  va_end(arguments);
  return buffer;
}

}  // namespace irdm::precompute
