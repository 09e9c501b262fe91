#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "common/config/lab_ranges.hpp"

namespace irdm::trace {

/// Refuses rows with numbers that no run has. All of these throw Error, which names the set and the
/// step.
class TraceCheck {
 public:
  /// @param file its name, for the message
  /// @param steps the force step of each row
  TraceCheck(std::string file, std::span<const std::uint64_t> steps)
      : file_(std::move(file)), steps_(steps) {}

  /// Every number, `width` of them a row.
  void numbers(const std::string& set, std::span<const double> values, std::size_t width,
               const Range& range = lab::kRecorded) const;
  void number(const std::string& set, std::size_t row, double value,
              const Range& range = lab::kRecorded) const;
  /// Quaternions of length 1.
  void orientations(const std::string& set, std::span<const double> values) const;
  /// Three barycentric weights.
  void weights(const std::string& set, std::span<const double> values, std::size_t row) const;

  [[noreturn]] void refuse(const std::string& set, std::size_t row, const std::string& what) const;

 private:
  std::string file_;
  std::span<const std::uint64_t> steps_;
};

}  // namespace irdm::trace
