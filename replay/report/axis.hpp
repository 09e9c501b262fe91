#pragma once

#include <string>
#include <vector>

namespace irdm::replay {

/// One axis of a figure.
struct Axis {
  double low = 0.0;
  double high = 1.0;  ///< above low
  bool logarithmic = false;

  /// Where a value lies, 0 at low and 1 at high; below 0 or above 1 outside.
  double place(double value) const;
  /// Values to name, increasing, all of them within: round ones, five or so; on a logarithmic axis
  /// powers of ten, with 2 and 5 times them where there are few.
  std::vector<double> ticks() const;
};

/// The axis that has room for all values that are finite (and above 0 on a logarithmic one, where
/// at most `decades` are shown), with a little to spare; from 0 on where they are all above it and
/// the axis is linear.
Axis axis_for(const std::vector<double>& values, bool logarithmic, double decades = 6.0);

/// Of a tick or a number in a table: up to four digits.
std::string number_text(double value);

}  // namespace irdm::replay
