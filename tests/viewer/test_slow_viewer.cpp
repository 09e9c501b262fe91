// What a viewer that hardly reads costs the server: what the kernel holds for it, one message that
// is being written, and one of each kind that waits.

#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/viewer/example_run.hpp"
#include "tests/viewer/web_peer.hpp"
#include "viewer/viewer_server.hpp"

using namespace irdm;
using namespace irdm::test;
using namespace irdm::viewer;

namespace {

constexpr int kFrame = 2;
constexpr int kHealth = 3;
/// Steps of frames that are offered when the slow viewer's connection is full for certain.
constexpr std::uint64_t kLate = 1'000'000;

class SlowShow {
 public:
  SlowShow() : server_({.health_period_ms = 1}, run_) { server_.start(); }

  WebPeer watch(int receive_buffer = 0) const {
    WebPeer peer(server_.port(), receive_buffer);
    peer.open();
    peer.send_message(encode(ClientMessage(Hello{})));
    return peer;
  }
  void publish(std::uint64_t step) {
    run_.surfaces.back() = frame_;
    run_.surfaces.back().force_step = step;
    run_.surfaces.publish();
    run_.ready.signal();
  }
  /// Steps from here on are reported as made by Health.
  void set_steps(std::uint64_t steps) { run_.steps = steps; }
  SurfaceFrame decode(const WebPeer::Message& message) const {
    return decode_frame(message.payload, node_counts(run_.scene_));
  }
  /// Until a viewer that reads everything has seen this step.
  void wait_for(WebPeer& alive, std::uint64_t step) const {
    for (;;) {
      const auto message = alive.receive();
      REQUIRE(message);
      if (message->payload.at(6) == kFrame && decode(*message).force_step == step) return;
    }
  }

 private:
  ExampleRun run_;
  SurfaceFrame frame_ = example_frame(run_.scene_, 0.01);
  ViewerServer server_;
};

}  // namespace

TEST_CASE("a viewer that reads a byte now and then has one message of each kind waiting") {
  constexpr std::uint64_t kFill = 3000;  // frames of 1.4 kB: more than any of its buffers
  constexpr std::uint64_t kWaiting = 500;
  constexpr std::uint64_t kBetweenBytes = 100;
  SlowShow show;
  WebPeer slow = show.watch(4096);
  WebPeer alive = show.watch();
  const auto play = [&](std::uint64_t first, std::uint64_t count) {
    for (std::uint64_t step = first; step < first + count; ++step) {
      show.publish(step);
      if (step % kBetweenBytes == 0) REQUIRE(slow.read_byte());
      show.wait_for(alive, step);
    }
  };
  play(1, kFill);
  show.set_steps(kLate);
  play(kLate, kWaiting);
  show.set_steps(2 * kLate);

  // All that it missed is gone: of the late messages it is sent the newest of each kind alone.
  int late_health = 0;
  std::uint64_t early_frames = 0;
  for (;;) {
    const auto message = slow.receive();
    REQUIRE(message);
    if (message->payload.at(6) == kHealth && decode_health(message->payload).steps == kLate) {
      ++late_health;
    }
    if (message->payload.at(6) != kFrame) continue;
    const std::uint64_t step = show.decode(*message).force_step;
    if (step < kLate) {
      ++early_frames;
      continue;
    }
    CHECK(step == kLate + kWaiting - 1);
    break;
  }
  CHECK(late_health <= 1);
  CHECK(early_frames < kFill);
}
