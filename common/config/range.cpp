#include "common/config/range.hpp"

#include <cmath>
#include <cstdio>

namespace irdm {

bool Range::contains(double value) const noexcept {
  if (!std::isfinite(value)) return false;
  const bool low = lowest_included ? value >= lowest : value > lowest;
  const bool high = highest_included ? value <= highest : value < highest;
  return low && high;
}

std::string describe(const Range& range) {
  const bool low = range.lowest > std::numeric_limits<double>::lowest();
  const bool high = range.highest < std::numeric_limits<double>::max();
  std::string text = "a finite number";
  if (low) text += (range.lowest_included ? " >= " : " > ") + number_text(range.lowest);
  if (high) {
    text += low ? " and" : "";
    text += (range.highest_included ? " <= " : " < ") + number_text(range.highest);
  }
  return text;
}

std::string exact_text(const Range& range, double value) {
  const std::string text = number_text(value);
  if (text != number_text(range.lowest) && text != number_text(range.highest)) return text;
  if (value == range.lowest || value == range.highest) return text;
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.17g", value);
  return digits;
}

std::string outside_text(const Range& range, double value) {
  return "is " + exact_text(range, value) + ", not " + describe(range);
}

}  // namespace irdm
