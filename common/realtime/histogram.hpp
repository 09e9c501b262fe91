#pragma once

#include <array>
#include <cstdint>

namespace irdm {

/// Distribution of durations with bounded memory and bounded work: about 3 % wide buckets from 1 ns
/// to minutes. Adding is real-time safe. One thread at a time; copy it to read it elsewhere.
class Histogram {
 public:
  void add(std::int64_t nanoseconds) noexcept;
  std::uint64_t count() const noexcept { return count_; }
  std::int64_t maximum() const noexcept { return maximum_; }
  /// The value that a share `fraction` in [0, 1] of the samples does not exceed [ns]; 0 when empty.
  std::int64_t percentile(double fraction) const noexcept;
  /// Share of the samples that do not exceed `limit` [ns], as finely as the buckets tell; 0 when
  /// empty.
  double share_up_to(std::int64_t limit) const noexcept;

 private:
  static constexpr int kSubBits = 5;  // 32 buckets an octave
  static constexpr int kOctaves = 40;
  static int bucket(std::uint64_t value) noexcept;
  static std::int64_t upper_bound(int bucket) noexcept;

  std::array<std::uint32_t, kOctaves << kSubBits> buckets_{};
  std::uint64_t count_ = 0;
  std::int64_t maximum_ = 0;
};

}  // namespace irdm
