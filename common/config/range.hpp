#pragma once

#include <limits>
#include <string>

namespace irdm {

/// Closed range of a number; the default is any finite number.
struct Range {
  double lowest = -std::numeric_limits<double>::max();
  double highest = std::numeric_limits<double>::max();
  bool lowest_included = true;
  bool highest_included = true;

  /// Never so for what is not finite.
  bool contains(double value) const noexcept;
};

constexpr Range above(double lowest) {
  return {.lowest = lowest, .lowest_included = false};
}
constexpr Range between(double lowest, double highest) {
  return {.lowest = lowest, .highest = highest};
}
/// From -largest to largest.
constexpr Range within(double largest) {
  return between(-largest, largest);
}

/// For messages: "a finite number >= 0 and <= 10".
std::string describe(const Range& range);

/// For messages: a number as a stream prints it.
std::string number_text(double value);

}  // namespace irdm
