#pragma once

#include <string>
#include <vector>

#include "device_bridge/link/link_probe.hpp"

namespace irdm {

enum class LinkGrade {
  kGood,      ///< fit for a hand
  kPassable,  ///< a stylus arms, and its force will fade now and then
  kBad,       ///< a stylus does not arm
};

struct LinkVerdict {
  LinkGrade grade = LinkGrade::kBad;
  std::vector<std::string> advice = {};  ///< what to do about it, a sentence each
};

/// Pure.
LinkVerdict judge(const LinkMeasurement& link);

/// A few lines for a person: what was measured, the verdict, advice.
std::string to_text(const LinkMeasurement& link);

}  // namespace irdm
