#include "bench/frame_relay.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <deque>
#include <list>
#include <stdexcept>
#include <utility>
#include <vector>

#include "common/realtime/clock.hpp"
#include "common/wire/frame.hpp"
#include "tests/support/loopback.hpp"

namespace irdm {
namespace {

using test::loopback;

constexpr std::int64_t kSlowNs = 40'000'000;
constexpr std::int64_t kFreshNs = 20'000'000;
constexpr int kLookMs = 1;

void no_delay(int socket) {
  const int on = 1;
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

bool send_all(int socket, const std::uint8_t* bytes, std::size_t size) {
  return ::send(socket, bytes, size, MSG_NOSIGNAL) == static_cast<ssize_t>(size);
}

wire::FrameBytes bytes_of(const wire::Frame& frame, std::uint32_t session) {
  return wire::encode_frame(frame.message, session, frame.header.sequence,
                            frame.header.send_time_ns);
}

}  // namespace

struct FrameRelay::Pair {
  int bridge;
  int server;
  bool open;
  wire::FrameReader reader = {};
  std::deque<wire::Frame> frames = {};  ///< of the server, not passed on yet
  std::int64_t next_slow_ns = 0;
  std::uint32_t odd = 0;

  bool give(const wire::Frame& frame, bool wrong = false, std::uint32_t session_change = 0) {
    wire::FrameBytes bytes = bytes_of(frame, frame.header.session + session_change);
    if (wrong) bytes.storage[odd++ * 7919 % bytes.size] ^= 0x10;
    return send_all(bridge, bytes.storage.data(), bytes.size);
  }
};

FrameRelay::FrameRelay(std::uint16_t target, int waiting)
    : target_(target), listener_(::socket(AF_INET, SOCK_STREAM, 0)) {
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  if (::bind(listener_, generic, size) != 0 || ::listen(listener_, waiting) != 0 ||
      ::getsockname(listener_, generic, &size) != 0) {
    throw std::runtime_error("cannot listen");
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { run(); });
}

FrameRelay::~FrameRelay() {
  stop_ = true;
  change_.signal();
  thread_.join();
  ::close(listener_);
}

void FrameRelay::set(RelayFault fault) noexcept {
  fault_ = fault;
  change_.signal();
}

void FrameRelay::pass_frames(Pair& pair) {
  const auto passed = [this](const wire::Frame& frame) {
    const std::int64_t now_ns = monotonic_ns();
    const auto* force = std::get_if<wire::ForceMessage>(&frame.message);
    if (force != nullptr && now_ns - force->force.sample_time_ns < kFreshNs) {
      last_force_ns_ = now_ns;
    }
    if (std::holds_alternative<wire::ContactModelMessage>(frame.message)) last_model_ns_ = now_ns;
  };
  auto& frames = pair.frames;
  while (pair.open && !frames.empty()) {
    const wire::Frame& frame = frames.front();
    switch (fault_.load()) {
      case RelayFault::kCorrupted:
        pair.open = pair.give(frame, true);
        break;
      case RelayFault::kOtherSession:
        pair.open = pair.give(frame, false, 1);
        break;
      case RelayFault::kRepeated:
        pair.open = pair.give(frame) && pair.give(frame);
        break;
      case RelayFault::kReordered:
        if (frames.size() < 2) return;
        pair.open = pair.give(frames[1]) && pair.give(frames[0]);
        frames.pop_front();
        break;
      case RelayFault::kSlow:
        if (monotonic_ns() < pair.next_slow_ns) return;
        pair.next_slow_ns = monotonic_ns() + kSlowNs;
        [[fallthrough]];
      default:
        passed(frame);
        pair.open = pair.give(frame);
    }
    frames.pop_front();
  }
}

void FrameRelay::run() {
  std::list<Pair> pairs;
  std::array<std::uint8_t, 65536> bytes;
  while (!stop_) {
    const RelayFault fault = fault_;
    const bool deaf = fault == RelayFault::kBlackHole;
    std::vector<pollfd> entries{{change_.descriptor(), POLLIN, 0}};
    if (!deaf) entries.push_back({listener_, POLLIN, 0});
    for (const Pair& pair : pairs) {
      if (!deaf && fault != RelayFault::kSilentBridge) entries.push_back({pair.bridge, POLLIN, 0});
      if (!deaf && fault != RelayFault::kSilentServer) entries.push_back({pair.server, POLLIN, 0});
    }
    if (::poll(entries.data(), entries.size(), kLookMs) < 0) continue;
    if (entries[0].revents != 0) change_.consume();
    for (const pollfd& entry : entries) {
      if (entry.revents == 0 || entry.fd == change_.descriptor()) continue;
      if (entry.fd == listener_) {
        const int guest = ::accept(listener_, nullptr, nullptr);
        const int host = ::socket(AF_INET, SOCK_STREAM, 0);
        const sockaddr_in address = loopback(target_);
        const bool there =
            fault != RelayFault::kReset &&
            ::connect(host, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
        no_delay(guest);
        no_delay(host);
        pairs.push_back({guest, host, guest >= 0 && there});
        continue;
      }
      for (Pair& pair : pairs) {
        if (entry.fd != pair.bridge && entry.fd != pair.server) continue;
        const ssize_t size = ::recv(entry.fd, bytes.data(), bytes.size(), 0);
        if (size <= 0) {
          pair.open = false;
        } else if (entry.fd == pair.bridge) {
          pair.open = send_all(pair.server, bytes.data(), static_cast<std::size_t>(size));
        } else {
          std::span<const std::uint8_t> rest(bytes.data(), static_cast<std::size_t>(size));
          while (auto frame = pair.reader.read(rest)) pair.frames.push_back(std::move(*frame));
        }
      }
    }
    for (Pair& pair : pairs) {
      if (fault == RelayFault::kReset) pair.open = false;
      if (!deaf && fault != RelayFault::kSilentServer) pass_frames(pair);
    }
    pairs.remove_if([](const Pair& pair) {
      if (!pair.open) {
        ::close(pair.bridge);
        ::close(pair.server);
      }
      return !pair.open;
    });
  }
  for (const Pair& pair : pairs) {
    ::close(pair.bridge);
    ::close(pair.server);
  }
}

}  // namespace irdm
