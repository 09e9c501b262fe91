#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/wire/datagram_channel.hpp"
#include "common/wire/frame.hpp"

/// Frames as the text of datagrams: part u8, parts u8, reserved u16, then bytes of the frame. Zeros
/// at a frame's end are not sent. Parts of one frame have successive numbers. Pure; allocates
/// nothing.
namespace irdm::wire {

inline constexpr std::size_t kPartHeaderSize = 4;
inline constexpr std::size_t kLargestPart = kLargestText - kPartHeaderSize;
inline constexpr std::size_t kMostParts =
    (kHeaderSize + kLargestPayload + kLargestPart - 1) / kLargestPart;
/// So many steps' forces fit into one datagram.
inline constexpr int kForcesInDatagram = 15;
static_assert(kHeaderSize + 24 + 72 * kForcesInDatagram <= kLargestPart);

/// The text of one datagram.
struct PartText {
  std::array<std::uint8_t, kLargestText> storage;
  std::size_t size = 0;
  std::span<const std::uint8_t> view() const noexcept { return {storage.data(), size}; }
};

/// How many datagrams a frame takes.
std::size_t part_count(std::span<const std::uint8_t> frame) noexcept;
/// @param part below part_count()
PartText part_text(std::span<const std::uint8_t> frame, std::size_t part) noexcept;
/// Asks the other end for one of these: no part of a frame, and as large as a datagram can be, so
/// that a path which lets through only smaller ones is found out.
PartText probe_text() noexcept;
bool is_probe(std::span<const std::uint8_t> text) noexcept;

/// Puts frames together from texts that come in any order, and perhaps not all. So many frames may
/// be incomplete at a time; the oldest make room.
class FrameAssembly {
 public:
  static constexpr std::size_t kFrames = 16;

  /// A whole, checked frame when the text completes one. Throws ProtocolError for what is no part
  /// of a frame, and no probe.
  /// @param number of the text's datagram; none twice
  std::optional<Frame> take(std::uint64_t number, std::span<const std::uint8_t> text);
  /// The bytes of the last frame; until the next take().
  std::span<const std::uint8_t> bytes() const noexcept { return reader_.bytes(); }

 private:
  struct Incomplete {
    bool used = false;
    std::uint64_t first = 0;  ///< number of its first part
    std::size_t parts = 0;
    std::size_t missing = 0;
    std::size_t size = 0;  ///< of all parts; known with the last
    std::array<std::uint8_t, kMostParts * kLargestPart> bytes;
  };
  Incomplete* find(std::uint64_t first, std::size_t parts);
  Frame read(std::span<const std::uint8_t> bytes);

  std::array<Incomplete, kFrames> incomplete_{};
  FrameReader reader_;
};

}  // namespace irdm::wire
