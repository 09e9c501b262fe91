#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <queue>
#include <random>
#include <thread>
#include <vector>

#include "common/realtime/event_fd.hpp"

namespace irdm::test {

/// What happens to the packets of a path, each way and each packet by itself.
struct PathQuality {
  double delay_ms = 0.0;   ///< of every packet
  double jitter_ms = 0.0;  ///< at most so much more; packets overtake one another by it
  double loss = 0.0;       ///< share that never arrives; and below
  double duplicates = 0.0;
  double corrupt = 0.0;  ///< one byte is another
};

/// Carries IP packets between two TUN devices, as badly as it is told to, on a thread of its own. A
/// cut path is a black hole: packets vanish, those under way too, and nobody is told of it.
class PacketRelay {
 public:
  /// @param devices descriptors of two TUN devices, which stay the caller's and do not block
  PacketRelay(std::array<int, 2> devices, const PathQuality& quality, unsigned seed = 1);
  PacketRelay(const PacketRelay&) = delete;
  PacketRelay& operator=(const PacketRelay&) = delete;
  ~PacketRelay();

  /// From here on no packet gets through; returns the time of the monotonic clock [ns].
  std::int64_t cut();
  void mend();
  /// Packets that were spoilt so far.
  std::uint64_t corrupted() const noexcept { return corrupted_; }

 private:
  struct Packet {
    std::int64_t due_ns;
    std::size_t to;  ///< device
    std::vector<std::uint8_t> bytes;
    bool operator>(const Packet& other) const { return due_ns > other.due_ns; }
  };

  void run();
  void take(std::size_t from);
  void deliver(std::int64_t now_ns);
  bool happens(double share);

  std::array<int, 2> devices_;
  PathQuality quality_;
  std::mt19937 random_;
  std::priority_queue<Packet, std::vector<Packet>, std::greater<>> under_way_;
  std::atomic<std::uint64_t> corrupted_{0};
  std::atomic<bool> cut_{false};
  std::atomic<bool> stop_{false};
  EventFd change_;
  std::atomic<std::uint64_t> rounds_{0};
  std::thread thread_;
};

}  // namespace irdm::test
