#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace irdm::bench {

/// A TCP connection on the loopback address, blocking and without delay.
class Wire {
 public:
  explicit Wire(std::uint16_t port);
  explicit Wire(int descriptor);
  Wire(const Wire&) = delete;
  Wire& operator=(const Wire&) = delete;
  ~Wire();

  void send(std::span<const std::uint8_t> bytes);
  /// All of them; false when the other side has hung up.
  bool receive(std::span<std::uint8_t> bytes);
  /// What is there, at least one byte.
  std::size_t receive_some(std::span<std::uint8_t> bytes);

 private:
  int descriptor_;
};

/// The least that an answer over TCP costs: a process of its own that takes `asked` bytes and gives
/// back `answered` ones.
class Echo {
 public:
  /// Forks: before the process has threads.
  Echo(std::size_t asked, std::size_t answered);
  Echo(const Echo&) = delete;
  Echo& operator=(const Echo&) = delete;
  ~Echo();

  double round_trip();  ///< [s]

 private:
  std::vector<std::uint8_t> question_;
  std::vector<std::uint8_t> answer_;
  pid_t child_ = -1;
  std::unique_ptr<Wire> wire_;
};

}  // namespace irdm::bench
