#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace irdm::test {

/// A browser's end of a connection to the viewer, which says exactly what the test wants, be it
/// HTTP or not. Blocking, with a deadline on everything.
class WebPeer {
 public:
  using Bytes = std::vector<std::uint8_t>;
  /// What came over the WebSocket.
  struct Message {
    int opcode = 0;  ///< 2: binary, 8: close
    Bytes payload;
    int close_code() const { return payload.size() < 2 ? 0 : payload[0] * 256 + payload[1]; }
  };

  /// @param receive_buffer of the socket [bytes]; 0: the system's choice
  explicit WebPeer(std::uint16_t port, int receive_buffer = 0);
  WebPeer(WebPeer&& other) noexcept;
  WebPeer& operator=(WebPeer&&) = delete;
  ~WebPeer();

  void send(const std::string& text);
  /// Says that nothing more is coming.
  void finish();
  /// Everything until the server closes; nothing when it does not.
  std::optional<std::string> rest();
  /// One answer's header, up to and with the empty line.
  std::string header();

  /// Asks for a WebSocket and returns the answer's header.
  std::string upgrade(const std::string& origin, const std::string& host);
  /// The same as a browser on this machine does; fails when it is refused.
  void open();
  /// One message, masked as a browser does. @param opcode 1: text, 2: binary
  void send_message(std::span<const std::uint8_t> payload, int opcode = 2);
  /// The next message that is no ping; nothing at the end of the connection or at the deadline.
  std::optional<Message> receive();
  /// Reads one byte of what is coming and no more; false at the end of the connection or at the
  /// deadline.
  bool read_byte();
  std::uint16_t port() const noexcept { return port_; }

 private:
  bool fill();
  bool have(std::size_t count);

  int descriptor_ = -1;
  std::uint16_t port_;
  std::string buffer_;
};

}  // namespace irdm::test
