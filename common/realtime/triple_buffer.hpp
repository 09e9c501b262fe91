#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace irdm {

/// A value and the session that it is of: who has another session by now leaves it aside.
template <typename T>
struct OfSession {
  std::uint64_t session = 0;
  T value;
};

/// Newest value wins: one writer thread, one reader thread, neither ever waits for the other.
///
/// Three slots: the writer fills one, the reader holds one, the third is exchanged in one atomic
/// step. Values may be large and own memory (a surface, say): all three slots are made from
/// `initial`, and writing into a slot reuses what it holds.
template <typename T>
class TripleBuffer {
 public:
  explicit TripleBuffer(const T& initial = T{}) : slots_{initial, initial, initial} {}
  TripleBuffer(const TripleBuffer&) = delete;
  TripleBuffer& operator=(const TripleBuffer&) = delete;

  /// Writer: the slot to fill before publish(). It holds an old value, not necessarily the last
  /// one.
  T& back() noexcept { return slots_[back_]; }
  /// Writer: hands back() over to the reader.
  void publish() noexcept {
    back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndex;
  }
  /// Writer: both in one.
  void put(const T& value) noexcept(noexcept(slots_[0] = value)) {
    back() = value;
    publish();
  }

  /// Reader: takes over the newest value if there is one; true when front() changed.
  bool receive() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return true;
  }
  /// Reader: the newest value that receive() took over, at first the initial one.
  const T& front() const noexcept { return slots_[front_]; }

 private:
  static constexpr std::uint32_t kIndex = 3;
  static constexpr std::uint32_t kFresh = 4;

  std::array<T, 3> slots_;
  std::uint32_t back_ = 0;
  std::atomic<std::uint32_t> middle_{1};
  std::uint32_t front_ = 2;
};

}  // namespace irdm
