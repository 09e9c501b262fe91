#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "common/realtime/wakeup.hpp"

namespace irdm {

/// A path to a port of this machine that can be cut and mended: bytes go through as they come, and
/// when it is cut none do, in neither direction, until it is mended; then all of them. Nobody is
/// told of it. Connections that are asked for meanwhile wait, and few of them.
class TcpRelay {
 public:
  explicit TcpRelay(std::uint16_t target);
  TcpRelay(const TcpRelay&) = delete;
  TcpRelay& operator=(const TcpRelay&) = delete;
  ~TcpRelay();

  std::uint16_t port() const noexcept { return port_; }
  void cut() noexcept;
  void mend() noexcept;

 private:
  void run();

  std::uint16_t target_;
  int listener_;
  std::uint16_t port_ = 0;
  std::atomic<bool> cut_{false};
  std::atomic<bool> stop_{false};
  Wakeup change_;
  std::thread thread_;
};

}  // namespace irdm
