#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "common/blackbox/black_box.hpp"
#include "common/wire/frame.hpp"

namespace irdm {

/// Every frame that goes through the connections of a network thread; a peer that breaks the
/// protocol is a fault. Listening in neither waits nor allocates; what does not fit is lost and
/// counted.
class FrameLog final : public BlackBoxPart, public wire::FrameTap {
 public:
  FrameLog();

  // Network thread.
  std::uint32_t open(std::string_view peer) noexcept override;
  void see(wire::TapKind kind, std::uint32_t connection,
           std::span<const std::uint8_t> bytes) noexcept override;

  // Black box's thread.
  std::optional<Fault> take() override;
  void forget(std::int64_t now_ns) override;
  void write(hdf5::File& file, std::int64_t origin_ns) const override;

 private:
  struct Head {
    std::int64_t time_ns = 0;
    std::uint32_t connection = 0;
    std::uint32_t size = 0;
    wire::TapKind kind = wire::TapKind::kReceived;
  };
  struct Entry {
    Head head;
    std::vector<std::uint8_t> bytes;
  };
  bool pop(Entry& entry);
  void keep(Entry entry);
  void drop_oldest();

  boost::lockfree::spsc_queue<std::uint8_t> queue_;  ///< heads, each with its bytes behind it
  std::atomic<std::uint64_t> lost_{0};
  std::uint32_t connections_ = 0;
  std::optional<Head> begun_;  ///< taken from the queue, its bytes not yet
  std::deque<Entry> entries_;
  std::size_t kept_bytes_ = 0;
};

}  // namespace irdm
