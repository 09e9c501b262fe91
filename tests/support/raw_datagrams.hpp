#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/wire/datagram_channel.hpp"
#include "common/wire/frame.hpp"

namespace irdm::test {

/// A UDP socket at a loopback address that says exactly what the test scripts. Blocking, with a
/// deadline.
class RawDatagrams {
 public:
  /// @param address its own, of this machine
  explicit RawDatagrams(const std::string& address = "127.0.0.1");
  RawDatagrams(const RawDatagrams&) = delete;
  RawDatagrams& operator=(const RawDatagrams&) = delete;
  ~RawDatagrams();

  std::uint16_t port() const noexcept { return port_; }
  /// To a port of 127.0.0.1.
  void send(std::span<const std::uint8_t> datagram, std::uint16_t port);
  /// The next one, and who sent it; nothing when the deadline passes.
  std::optional<std::vector<std::uint8_t>> receive();
  std::uint16_t sender() const noexcept { return sender_; }  ///< port of the last one received
  /// Whether one is there now.
  bool any() const;
  /// Whether no socket has this port of 127.0.0.1: who sent from it has closed its own.
  static bool is_free(std::uint16_t port);

 private:
  int descriptor_;
  std::uint16_t port_ = 0;
  std::uint16_t sender_ = 0;
};

/// The datagrams of a session, as texts and messages.
struct RawChannel {
  RawChannel(const wire::DatagramKeys& keys, wire::DatagramEnd end, std::uint32_t number)
      : channel(keys, end, number), session(number) {}

  /// A message of one part, sealed.
  std::vector<std::uint8_t> seal(const wire::Message& message, std::uint64_t sequence);
  std::vector<std::uint8_t> seal(std::span<const std::uint8_t> text);
  std::vector<std::uint8_t> probe() { return seal(wire::probe_text().view()); }
  /// What the next datagrams say: probes are left out. Nothing at the deadline.
  std::optional<wire::Frame> receive(RawDatagrams& socket);

  wire::DatagramChannel channel;
  wire::FrameAssembly assembly;
  std::uint32_t session;
};

}  // namespace irdm::test
