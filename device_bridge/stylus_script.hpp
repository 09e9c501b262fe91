#pragma once

#include <cstdint>
#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "common/geometry.hpp"

namespace irdm {

/// Where a stylus is and what its buttons do, in the device's frame D or in W.
struct StylusPose {
  Vector3 tip = Vector3::Zero();                    ///< [m]
  Quaternion orientation = Quaternion::Identity();  ///< of the stylus in that frame, norm 1
  std::uint32_t buttons = 0;                        ///< the device's own bits
};

/// A motion written down: rows `time,x,y,z[,qw,qx,qy,qz][,button]` after a header line that names
/// them, in s and m, D; `#` starts a comment. At least one row; times increase.
class StylusScript {
 public:
  /// Throws Error with file and line for anything that does not fit.
  static StylusScript load(const std::filesystem::path& path);
  /// @param name stands for the file in messages
  static StylusScript parse(std::istream& text, const std::string& name);

  /// Between rows position is linear, orientation a spherical interpolation, and the buttons are
  /// those of the row before; before the first row and after the last it rests. Real-time safe.
  StylusPose at(double time) const noexcept;

  double start() const noexcept { return rows_.front().time; }  ///< time of the first row [s]
  double end() const noexcept { return rows_.back().time; }     ///< time of the last row [s]

 private:
  struct Row {
    double time = 0.0;
    StylusPose pose;
  };
  class Parser;
  std::vector<Row> rows_;
};

}  // namespace irdm
