#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/wire/frame.hpp"

namespace irdm::test {

/// One end of a TCP connection on the loopback address that says exactly what the test scripts,
/// byte by byte if need be. Blocking, with a deadline on everything.
class RawPeer {
 public:
  /// Connects to a port of this machine. Throws when nobody listens.
  /// @param receive_buffer of the socket [bytes]; 0: the system's choice
  static RawPeer connect(std::uint16_t port, int receive_buffer = 0);
  explicit RawPeer(int descriptor) : descriptor_(descriptor) {}
  RawPeer(RawPeer&& other) noexcept;
  RawPeer& operator=(RawPeer&&) = delete;
  ~RawPeer();

  /// True when all of them were taken.
  bool send(std::span<const std::uint8_t> bytes);
  /// Encodes and sends, with the session of the last Welcome that was received.
  void send(const wire::Message& message);

  /// The next frame; nothing when the connection ends or the deadline passes.
  std::optional<wire::Frame> receive();
  /// The next message if it is a T; nothing otherwise.
  template <typename T>
  std::optional<T> receive_as() {
    const std::optional<wire::Frame> frame = receive();
    if (!frame || !std::holds_alternative<T>(frame->message)) return std::nullopt;
    return std::get<T>(frame->message);
  }
  /// Whether the other side ends the connection before the deadline; what still comes is ignored.
  bool ends();
  /// Hang up, without a word.
  void close();
  /// Says nothing more, but goes on listening.
  void end_sending();
  /// Hang up so that nothing of the connection is left: the other side sees a reset.
  void cut();
  /// Its end of the connection, as ADDRESS:PORT.
  std::string name() const;

  std::uint32_t session = 0;
  std::uint64_t sequence = 0;

 private:
  /// False at the end of the connection or at the deadline.
  bool fill();

  int descriptor_;
  wire::FrameReader reader_;
  std::vector<std::uint8_t> buffer_;
  std::span<const std::uint8_t> rest_;
};

/// Listens on a free port of the loopback address.
class RawListener {
 public:
  RawListener();
  RawListener(const RawListener&) = delete;
  RawListener& operator=(const RawListener&) = delete;
  ~RawListener();
  std::uint16_t port() const noexcept { return port_; }
  /// The next connection. Throws at the deadline.
  RawPeer accept();

 private:
  int descriptor_;
  std::uint16_t port_ = 0;
};

/// An encoded frame to spoil.
std::vector<std::uint8_t> frame_bytes(const wire::Message& message, std::uint32_t session = 0);

}  // namespace irdm::test
