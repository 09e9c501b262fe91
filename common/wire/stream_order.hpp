#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/wire/message.hpp"

namespace irdm::wire {

/// Whether a message is of those that replace one another and may go by datagrams: samples, forces,
/// contact models, applied forces.
bool is_of_stream(const Message& message) noexcept;

/// Lets through what is newer than all of its kind and stylus before, by the number of its frame:
/// datagrams overtake one another, and what went by TCP. Pure.
class StreamOrder {
 public:
  /// False: it is late and nobody should see it.
  bool take(const Frame& frame) noexcept;

 private:
  static constexpr std::size_t kKinds = 4;
  static constexpr std::size_t kStyluses = 64;  ///< as many slots as a server can have
  std::array<std::array<std::optional<std::uint64_t>, kStyluses>, kKinds> newest_{};  ///< numbers
};

}  // namespace irdm::wire
