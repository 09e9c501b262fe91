#include "precompute/check/report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace irdm::precompute {

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
