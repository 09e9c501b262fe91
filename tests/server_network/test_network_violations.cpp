#include <functional>
#include <random>

#include "tests/server_network/running_server.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::test;
using irdm::wire::Goodbye;
using irdm::wire::GoodbyeReason;
using irdm::wire::Hello;
using irdm::wire::SampleMessage;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// That the peer is sent away for breaking the protocol, its stylus is absent, and others are
/// served.
void check_sent_away(RunningServer& running, RawPeer& peer) {
  const auto goodbye = peer.receive_as<Goodbye>();
  REQUIRE(goodbye);
  CHECK(goodbye->reason == GoodbyeReason::kProtocolError);
  CHECK(peer.ends());
  CHECK(running.server.stats().protocol_errors == 1);
  running.check_serves();
}

/// The same for a violation within a session, whose stylus was there.
void check_violation(const std::function<void(RawPeer&)>& violate) {
  RunningServer running;
  RawPeer peer = running.join();
  peer.send(SampleMessage{});
  CHECK(running.next_input().present);
  violate(peer);
  CHECK_FALSE(running.next_input().present);
  check_sent_away(running, peer);
}

}  // namespace

TEST_CASE("server sends garbage away") {
  RunningServer running;
  RawPeer peer = running.connect();
  std::mt19937 random(3);
  std::vector<std::uint8_t> garbage(5000);
  for (std::uint8_t& byte : garbage) byte = static_cast<std::uint8_t>(random());
  peer.send(garbage);
  check_sent_away(running, peer);
}

TEST_CASE("server answers a header of another version with a refusal") {
  RunningServer running;
  RawPeer peer = running.connect();
  std::vector<std::uint8_t> bytes = frame_bytes(Hello{});
  bytes[4] = 2;
  peer.send(bytes);
  const auto refuse = peer.receive_as<wire::Refuse>();
  REQUIRE(refuse);
  CHECK(refuse->reason == wire::RefuseReason::kVersion);
  CHECK(peer.ends());
}

TEST_CASE("server sends a header of another version away once a version was agreed on") {
  check_violation([](RawPeer& peer) {
    std::vector<std::uint8_t> bytes = frame_bytes(SampleMessage{}, peer.session);
    bytes[4] = 2;
    peer.send(bytes);
  });
}

TEST_CASE("the header of the welcome carries the session's number") {
  RunningServer running;
  RawPeer peer = running.connect();
  peer.send(Hello{.name = "test"});
  const auto frame = peer.receive();
  REQUIRE(frame);
  CHECK(frame->header.session == std::get<wire::Welcome>(frame->message).session);
}

TEST_CASE("server hangs up without a word on a peer that does so") {
  RunningServer running;
  RawPeer peer = running.join();
  peer.send(SampleMessage{});
  CHECK(running.next_input().present);
  peer.end_sending();
  CHECK_FALSE(running.next_input().present);
  CHECK_FALSE(peer.receive());
  CHECK(peer.ends());
  CHECK(running.server.stats().protocol_errors == 0);
}

TEST_CASE("server sends an oversized length away without waiting for it") {
  check_violation([](RawPeer& peer) {
    std::vector<std::uint8_t> bytes = frame_bytes(SampleMessage{}, peer.session);
    bytes[11] = 0x7F;
    bytes.resize(wire::kHeaderSize);
    peer.send(bytes);
  });
}

TEST_CASE("server sends a wrong checksum away") {
  check_violation([](RawPeer& peer) {
    std::vector<std::uint8_t> bytes = frame_bytes(SampleMessage{}, peer.session);
    bytes.back() = static_cast<std::uint8_t>(bytes.back() ^ 1);
    peer.send(bytes);
  });
}

TEST_CASE("server sends a tip away that is not finite") {
  check_violation([](RawPeer& peer) {
    peer.send(SampleMessage{.sample = {.sequence = 1, .tip = Vector3(0, kNan, 0)}});
  });
}

TEST_CASE("server sends an orientation away that is not finite") {
  check_violation([](RawPeer& peer) {
    peer.send(SampleMessage{.sample = {.sequence = 1, .orientation = Quaternion(1, 0, kNan, 0)}});
  });
}

TEST_CASE("server sends a sample of another's stylus away") {
  check_violation([](RawPeer& peer) { peer.send(SampleMessage{.stylus = 1}); });
}

TEST_CASE("server sends forces of another's stylus away") {
  RunningServer running;
  RawPeer peer = running.connect();
  peer.send(Hello{.capabilities = wire::kCapabilityContactModel, .name = "test"});
  REQUIRE(peer.receive_as<wire::Welcome>());
  peer.send(SampleMessage{});
  CHECK(running.next_input().present);
  wire::AppliedForcesMessage foreign;
  foreign.stylus = 1;
  foreign.applied.step = 1;
  foreign.applied.count = 1;
  peer.send(foreign);
  CHECK_FALSE(running.next_input().present);
  check_sent_away(running, peer);
  CHECK_FALSE(running.server.port(1).in.receive());
}

TEST_CASE("server sends a message of another session away") {
  check_violation([](RawPeer& peer) {
    ++peer.session;
    peer.send(SampleMessage{.sample = {.sequence = 1}});
  });
}

TEST_CASE("server sends a frame away whose number does not grow") {
  check_violation([](RawPeer& peer) {
    --peer.sequence;
    peer.send(SampleMessage{.sample = {.sequence = 1}});
  });
}

TEST_CASE("server sends a second hello away") {
  check_violation([](RawPeer& peer) { peer.send(Hello{}); });
}

TEST_CASE("server sends a message away that only a server sends") {
  check_violation([](RawPeer& peer) { peer.send(wire::ForceMessage{}); });
}

TEST_CASE("server sends a message before hello away") {
  RunningServer running;
  RawPeer peer = running.connect();
  peer.send(SampleMessage{});
  check_sent_away(running, peer);
}

TEST_CASE("server sends a frame away that is not completed in time") {
  RunningServer running({.frame_timeout_ms = 30});
  RawPeer peer = running.join();
  std::vector<std::uint8_t> bytes = frame_bytes(SampleMessage{}, peer.session);
  bytes.pop_back();
  peer.send(bytes);
  check_sent_away(running, peer);
}

TEST_CASE("server sends a peer away that does not say hello in time") {
  RunningServer running({.handshake_timeout_ms = 30});
  RawPeer peer = running.connect();
  const auto goodbye = peer.receive_as<Goodbye>();
  REQUIRE(goodbye);
  CHECK(goodbye->reason == GoodbyeReason::kTimeout);
  CHECK(peer.ends());
  CHECK(running.server.stats().timeouts == 1);
}

TEST_CASE("server in lockstep sends a sample away that skips a number, or has a wrong time") {
  NetworkSettings settings = kPatient;
  settings.lockstep = true;
  const auto check = [&](const StylusSample& wrong) {
    RunningServer running(settings);
    RawPeer peer = running.join();
    peer.send(SampleMessage{.sample = lockstep_sample(0)});
    CHECK(running.next_input().sample.sequence == 0);
    peer.send(SampleMessage{.sample = lockstep_sample(1)});
    CHECK(running.next_input().sample.sequence == 1);
    peer.send(SampleMessage{.sample = wrong});
    CHECK_FALSE(running.next_input().present);
    check_sent_away(running, peer);
  };
  check(lockstep_sample(3));
  check({.sequence = 2, .time_ns = 6'100'000});
  check({.sequence = 2, .time_ns = 0});
}
