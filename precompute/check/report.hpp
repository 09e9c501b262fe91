#pragma once

#include <string>
#include <vector>

/// The table that `irdm-precompute check` prints: docs/check.md explains every line.
namespace irdm::precompute {

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
