#include "tests/network_namespace/packet_relay.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "common/realtime/clock.hpp"

namespace irdm::test {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::size_t kLargestPacket = 65536;

std::int64_t nanoseconds(double milliseconds) {
  return static_cast<std::int64_t>(1e6 * milliseconds);
}

}  // namespace

PacketRelay::PacketRelay(std::array<int, 2> devices, const PathQuality& quality, unsigned seed)
    : devices_(devices), quality_(quality), random_(seed), thread_([this] { run(); }) {}

PacketRelay::~PacketRelay() {
  stop_ = true;
  change_.signal();
  thread_.join();
}

// Waits until a packet that was about to be delivered has been.
std::int64_t PacketRelay::cut() {
  cut_ = true;
  const std::uint64_t round = rounds_;
  change_.signal();
  while (rounds_ == round) std::this_thread::yield();
  return monotonic_ns();
}

void PacketRelay::mend() {
  cut_ = false;
  change_.signal();
}

void PacketRelay::run() {
  while (!stop_) {
    ++rounds_;
    const std::int64_t now_ns = monotonic_ns();
    deliver(now_ns);
    const std::int64_t wait_ns =
        under_way_.empty() ? kSecond : std::max<std::int64_t>(0, under_way_.top().due_ns - now_ns);
    const timespec wait{wait_ns / kSecond, wait_ns % kSecond};
    std::array<pollfd, 3> entries{
        {{change_.descriptor(), POLLIN, 0}, {devices_[0], POLLIN, 0}, {devices_[1], POLLIN, 0}}};
    if (::ppoll(entries.data(), entries.size(), &wait, nullptr) <= 0) continue;
    if (entries[0].revents != 0) change_.consume();
    for (std::size_t i = 0; i < 2; ++i) {
      if (entries[i + 1].revents != 0) take(i);
    }
  }
}

void PacketRelay::take(std::size_t from) {
  std::vector<std::uint8_t> bytes(kLargestPacket);
  const ssize_t size = ::read(devices_[from], bytes.data(), bytes.size());
  if (size <= 0 || cut_ || happens(quality_.loss)) return;
  bytes.resize(static_cast<std::size_t>(size));
  if (happens(quality_.corrupt)) {
    bytes[random_() % bytes.size()] ^= static_cast<std::uint8_t>(1 + random_() % 255);
    ++corrupted_;
  }
  std::uniform_real_distribution<double> jitter(0.0, quality_.jitter_ms);
  for (int copies = happens(quality_.duplicates) ? 2 : 1; copies > 0; --copies) {
    const double late_ms = quality_.delay_ms + (quality_.jitter_ms > 0.0 ? jitter(random_) : 0.0);
    under_way_.push({monotonic_ns() + nanoseconds(late_ms), 1 - from, bytes});
  }
}

void PacketRelay::deliver(std::int64_t now_ns) {
  if (cut_) under_way_ = {};
  while (!under_way_.empty() && under_way_.top().due_ns <= now_ns) {
    const Packet& packet = under_way_.top();
    [[maybe_unused]] const ssize_t written =
        ::write(devices_[packet.to], packet.bytes.data(), packet.bytes.size());
    under_way_.pop();
  }
}

bool PacketRelay::happens(double share) {
  return std::uniform_real_distribution<double>(0.0, 1.0)(random_) < share;
}

}  // namespace irdm::test
