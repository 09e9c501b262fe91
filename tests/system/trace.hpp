#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry.hpp"

namespace irdm::test {

/// A trace of one object, read back; K rows. Which sets there must be, and in what shape, is
/// checked: K rows in each.
struct Trace {
  std::string model_file = {};
  std::string model_checksum = {};
  std::string scene = {};
  std::vector<double> time = {};
  std::vector<std::uint64_t> force_step = {};
  std::map<std::string, std::vector<double>> numbers = {};  ///< by path: "/stylus/0/force", ...
  std::vector<std::uint8_t> reset = {};
  // Of stylus 0.
  std::vector<std::uint8_t> contact = {};
  std::vector<std::uint8_t> slipping = {};
  std::vector<std::int32_t> contact_nodes = {};  ///< (K, 3)
  std::vector<std::uint8_t> present = {};
  std::vector<std::int32_t> buttons = {};

  std::size_t rows() const { return time.size(); }
  /// Row k of a set with three numbers a row.
  Vector3 vector(const std::string& set, std::size_t k) const;
  Quaternion orientation(std::size_t k) const;
};

/// Reads a complete trace, with the vectors of as many styluses. Throws Error.
Trace read_trace(const std::filesystem::path& path, int styluses = 1);

// A trace that is being written. What is read meanwhile may be torn: good to wait for, never to
// judge by. As long as it cannot be read there are no rows.

/// How many rows so far have this value of /stylus/0/`set` (contact or buttons).
std::size_t rows_so_far(const std::filesystem::path& path, const std::string& set, int value);
/// The tip of the newest row so far.
std::optional<Vector3> tip_so_far(const std::filesystem::path& path);

}  // namespace irdm::test
