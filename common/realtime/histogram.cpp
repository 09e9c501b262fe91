#include "common/realtime/histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace irdm {

// Values below 2^kSubBits have a bucket each; above, every octave is divided evenly.
int Histogram::bucket(std::uint64_t value) noexcept {
  constexpr std::uint64_t kFirst = 1u << kSubBits;
  if (value < kFirst) return static_cast<int>(value);
  const int octave = std::bit_width(value) - kSubBits - 1;
  const auto within = static_cast<int>((value >> octave) - kFirst);
  return std::min(((octave + 1) << kSubBits) + within, (kOctaves << kSubBits) - 1);
}

std::int64_t Histogram::upper_bound(int bucket) noexcept {
  constexpr int kFirst = 1 << kSubBits;
  if (bucket < kFirst) return bucket;
  const int octave = (bucket >> kSubBits) - 1;
  const std::int64_t within = (bucket & (kFirst - 1)) + kFirst;
  return ((within + 1) << octave) - 1;
}

void Histogram::add(std::int64_t nanoseconds) noexcept {
  const std::int64_t value = std::max<std::int64_t>(nanoseconds, 0);
  ++buckets_[static_cast<std::size_t>(bucket(static_cast<std::uint64_t>(value)))];
  ++count_;
  maximum_ = std::max(maximum_, value);
}

double Histogram::share_up_to(std::int64_t limit) const noexcept {
  if (count_ == 0 || limit < 0) return 0.0;
  if (limit >= maximum_) return 1.0;
  const auto last = static_cast<std::size_t>(bucket(static_cast<std::uint64_t>(limit)));
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i <= last; ++i) seen += buckets_[i];
  return static_cast<double>(seen) / static_cast<double>(count_);
}

std::int64_t Histogram::percentile(double fraction) const noexcept {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(fraction * static_cast<double>(count_)));
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < buckets_.size(); ++i) {
    seen += buckets_[i];
    if (seen >= wanted && seen > 0) return std::min(upper_bound(static_cast<int>(i)), maximum_);
  }
  return maximum_;
}

}  // namespace irdm
