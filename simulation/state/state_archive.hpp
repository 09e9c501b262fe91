#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace irdm {

/// The state of a simulation as bytes: all that a step depends on but its commands. Each class with
/// state has one function archive(StateArchive&), which goes through its values in one order and
/// serves both directions. Caches that change no bit of a step are not in it; reading empties them.
/// Takes memory; not real-time safe. One thread.
class StateArchive {
 public:
  /// Writes.
  StateArchive() = default;
  /// Reads. @param bytes must outlive this
  explicit StateArchive(std::span<const std::byte> bytes) : left_(bytes), reading_(true) {}

  bool reading() const noexcept { return reading_; }
  std::vector<std::byte> take() noexcept { return std::move(written_); }
  /// Throws Error where bytes are left over.
  void end() const;

  /// One that has no pointers.
  template <typename T>
  void value(T& one) {
    numbers(&one, 1);
  }
  /// As many as the scene has. Throws Error where there were others.
  template <typename T, typename Memory>
  void values(std::vector<T, Memory>& all) {
    same(all.size());
    numbers(all.data(), all.size());
  }
  /// So many of them, at most its capacity, beyond which there is no memory in a step.
  template <typename T>
  void list(std::vector<T>& some) {
    some.resize(size(some.size(), some.capacity()));
    numbers(some.data(), some.size());
  }
  template <typename T>
  void numbers(T* first, std::size_t count) {
    static_assert(std::is_trivially_destructible_v<T> && !std::is_pointer_v<T>);
    bytes(reinterpret_cast<std::byte*>(first), count * sizeof(T));
  }
  /// How many follow. Throws Error above `most`. @param now written, or not looked at
  std::size_t size(std::size_t now, std::size_t most);
  /// What the scene decides on. Throws Error where it was another.
  void same(std::uint64_t number);

 private:
  void bytes(std::byte* first, std::size_t count);

  std::vector<std::byte> written_;
  std::span<const std::byte> left_;
  bool reading_ = false;
};

}  // namespace irdm
