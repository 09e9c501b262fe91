#pragma once

#include <string>
#include <vector>

namespace irdm::doctor {

enum class Grade {
  kOk,
  kWarning,  ///< works, but not well
  kProblem,  ///< the bridge will not do what is asked of it
};

/// One line of what the doctor says.
struct Finding {
  Grade grade = Grade::kOk;
  std::string subject;  ///< what was looked at
  std::string what;     ///< how it is
  std::string remedy;   ///< what to do; empty where it is ok
};

using Findings = std::vector<Finding>;

/// A line each: `grade subject: what; remedy`.
std::string to_text(const Findings& findings);
int count_problems(const Findings& findings);

}  // namespace irdm::doctor
