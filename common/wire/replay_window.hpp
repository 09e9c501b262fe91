#pragma once

#include <algorithm>
#include <bitset>
#include <cstdint>
#include <optional>

namespace irdm::wire {

/// Which numbers have come, so that none counts twice: those up to kWidth below the newest may come
/// late, what is older counts as seen. Pure; allocates nothing.
class ReplayWindow {
 public:
  /// Four styluses with a model a step make 10000 datagrams a second: a tenth of one second.
  static constexpr std::uint64_t kWidth = 1024;

  /// Whether the number has not been taken and is not too old to tell.
  bool fresh(std::uint64_t number) const noexcept {
    if (!newest_ || number > *newest_) return true;
    return *newest_ - number < kWidth && !seen_[number % kWidth];
  }
  /// Takes a number that is fresh. True when it is the newest.
  bool take(std::uint64_t number) noexcept {
    const bool newest = !newest_ || number > *newest_;
    if (newest) advance(number);
    seen_[number % kWidth] = true;
    return newest;
  }

 private:
  void advance(std::uint64_t number) noexcept {
    const std::uint64_t count = newest_ ? std::min(number - *newest_, kWidth) : kWidth;
    for (std::uint64_t i = 0; i < count; ++i) seen_[(number - i) % kWidth] = false;
    newest_ = number;
  }

  std::optional<std::uint64_t> newest_;
  std::bitset<kWidth> seen_;
};

}  // namespace irdm::wire
