#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "common/realtime/event_fd.hpp"

namespace irdm {

/// What a FrameRelay does to the frames.
enum class RelayFault {
  kNone,
  kReset,         ///< closes both connections, and refuses new ones
  kBlackHole,     ///< takes nothing from either side, and no connection
  kSilentServer,  ///< takes nothing from the server
  kSilentBridge,  ///< takes nothing from the bridge
  kCorrupted,     ///< a bit of each frame from the server is wrong
  kReordered,     ///< each frame from the server changes places with the next
  kSlow,          ///< of the server's frames one passes in 40 ms, the others wait
  kOtherSession,  ///< the server's frames are of another session
  kRepeated,      ///< each frame from the server comes twice
};

/// Between a bridge and a server, without TLS: passes frames on as they come, or not.
class FrameRelay {
 public:
  /// @param waiting connections that are asked for and not taken, at most
  explicit FrameRelay(std::uint16_t target, int waiting = 4);
  FrameRelay(const FrameRelay&) = delete;
  FrameRelay& operator=(const FrameRelay&) = delete;
  ~FrameRelay();

  std::uint16_t port() const noexcept { return port_; }
  void set(RelayFault fault) noexcept;
  /// When the last whole frame of the server was passed on that says something new: a contact
  /// model, or a force for a sample of the last 20 ms.
  std::int64_t last_model_ns() const noexcept { return last_model_ns_; }
  std::int64_t last_force_ns() const noexcept { return last_force_ns_; }

 private:
  struct Pair;
  void run();
  void pass_frames(Pair& pair);

  std::uint16_t target_;
  int listener_;
  std::uint16_t port_ = 0;
  std::atomic<RelayFault> fault_{RelayFault::kNone};
  std::atomic<std::int64_t> last_model_ns_{0};
  std::atomic<std::int64_t> last_force_ns_{0};
  std::atomic<bool> stop_{false};
  EventFd change_;
  std::thread thread_;
};

}  // namespace irdm
