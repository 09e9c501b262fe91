#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "common/wire/datagram_channel.hpp"
#include "common/wire/message.hpp"
#include "common/wire/payload.hpp"

namespace irdm::wire {

/// CRC32C (Castagnoli: polynomial 0x1EDC6F41, reflected, start and final xor all ones) of `first`
/// followed by `second`.
std::uint32_t crc32c(std::span<const std::uint8_t> first,
                     std::span<const std::uint8_t> second = {}) noexcept;

/// What a connection shows to whoever listens in.
enum class TapKind : std::uint8_t {
  kReceived = 0,   ///< a whole, checked frame
  kSent = 1,       ///< a whole frame
  kSpoilt = 2,     ///< bytes that were received and are no valid frame, as far as they were read
  kOpened = 3,     ///< a connection has begun: the peer's address
  kViolation = 4,  ///< the peer broke the protocol: how, in words
  kClosed = 5,     ///< the connection has ended: why, in words
};

/// Listens in on connections, all of one thread.
class FrameTap {
 public:
  FrameTap() = default;
  FrameTap(const FrameTap&) = delete;
  FrameTap& operator=(const FrameTap&) = delete;
  virtual ~FrameTap() = default;

  /// A connection begins; its number.
  virtual std::uint32_t open(std::string_view peer) noexcept = 0;
  /// @param bytes valid during the call
  virtual void see(TapKind kind, std::uint32_t connection,
                   std::span<const std::uint8_t> bytes) noexcept = 0;
};

/// One encoded frame: header and payload.
struct FrameBytes {
  std::array<std::uint8_t, kHeaderSize + kLargestPayload> storage;
  std::size_t size = 0;
  std::span<const std::uint8_t> view() const noexcept { return {storage.data(), size}; }
};

/// Type and payload size of the header are taken from the message.
/// @param sequence number of the frame in its direction
FrameBytes encode_frame(const Message& message, std::uint32_t session, std::uint64_t sequence,
                        std::int64_t send_time_ns);

/// Takes the bytes of a stream as they come and gives whole, checked frames back. Everything in the
/// header is checked as soon as the header is there, before any byte of the payload is stored.
/// After an error the stream cannot be trusted: close it.
class FrameReader {
 public:
  /// Takes bytes off the front of `bytes` until a frame is complete or none is left; call until it
  /// returns nothing. Throws ProtocolError (VersionMismatch for another version).
  std::optional<Frame> read(std::span<const std::uint8_t>& bytes);

  /// Whether a frame has begun and is not complete.
  bool partial() const noexcept { return filled_ > 0; }
  /// The bytes of the last frame, or, when one has begun or was not valid, what there is of it;
  /// until the next read().
  std::span<const std::uint8_t> bytes() const noexcept {
    return std::span(frame_).first(partial() ? filled_ : last_size_);
  }

 private:
  bool fill(std::span<const std::uint8_t>& bytes, std::size_t wanted) noexcept;
  void check_header();

  std::array<std::uint8_t, kHeaderSize + kLargestPayload> frame_;
  std::size_t filled_ = 0;
  std::size_t last_size_ = 0;
  Header header_;
  std::uint32_t checksum_ = 0;
};

// Frames as the text of datagrams: part u8, parts u8, reserved u16, then bytes of the frame. Zeros
// at a frame's end are not sent. Parts of one frame have successive numbers. Pure; allocates
// nothing.

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
/// Whether it is one: zeros only, and as many.
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
