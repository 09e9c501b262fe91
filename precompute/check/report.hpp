#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/stability/coupling_limit.hpp"
#include "precompute/check/reciprocity.hpp"

namespace irdm::precompute {

/// What the checks find at one surface node.
struct NodeFindings {
  bool clamped = false;  ///< does not move: nothing below is filled
  Passivity passivity;
  InverseStability inverse;
  double stiffness = 0.0;          ///< in the first step, with the rigid body's own answer [N/m]
  double elastic_stiffness = 0.0;  ///< of R[0] alone [N/m]
  double coupling = 0.0;           ///< largest stable virtual coupling [N/m]
  double left = 0.0;               ///< largest |R_ii| in the last tenth of the record over its peak
};

struct NodeConditions {
  HandLoop loop;
  double radius = 1.0;  ///< of the circle that counts as the unit circle, see analyse_passivity
};

NodeFindings analyse_node(const DrivingPoint& record, const Matrix3& rigid,
                          const NodeConditions& conditions);

// The table that `irdm-precompute check` prints: docs/check.md explains every line.

enum class Verdict { kOk, kWarn, kFail, kNone };  ///< kNone: could not be looked at

struct Line {
  std::string name;
  Verdict verdict = Verdict::kOk;
  std::string found;  ///< what was measured, with unit
};

using Report = std::vector<Line>;

/// kFail above `fail` or when the value is not a number, kWarn above `warn`, kOk otherwise.
Verdict judge(double value, double warn, double fail);

/// One line of text a line of the report.
std::string format_report(const Report& report);

/// Names of the lines that failed, separated by commas; empty when none did.
std::string failed_lines(const Report& report);

/// printf into a string.
[[gnu::format(printf, 1, 2)]] std::string text(const char* format, ...);

}  // namespace irdm::precompute
