#include "device_bridge/doctor/finding.hpp"

#include <algorithm>

namespace irdm::doctor {
namespace {

const char* word(Grade grade) {
  switch (grade) {
    case Grade::kOk:
      return "ok       ";
    case Grade::kWarning:
      return "warning  ";
    case Grade::kProblem:
      break;
  }
  return "problem  ";
}

}  // namespace

std::string to_text(const Findings& findings) {
  std::string text;
  for (const auto& [grade, subject, what, remedy] : findings) {
    text += word(grade) + subject + ": " + what + (remedy.empty() ? "" : "; " + remedy) + '\n';
  }
  return text;
}

int count_problems(const Findings& findings) {
  return static_cast<int>(
      std::count_if(findings.begin(), findings.end(),
                    [](const Finding& finding) { return finding.grade == Grade::kProblem; }));
}

}  // namespace irdm::doctor
