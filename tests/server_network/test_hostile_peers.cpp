#include <algorithm>
#include <random>

#include "tests/server_network/running_server.hpp"

using namespace irdm;
using namespace irdm::test;
using irdm::wire::Goodbye;
using irdm::wire::Hello;
using irdm::wire::Refuse;
using irdm::wire::RefuseReason;
using irdm::wire::SampleMessage;
using irdm::wire::Welcome;

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes noise(std::uint32_t seed, std::size_t size) {
  std::mt19937 random(seed);
  Bytes bytes(size);
  std::generate(bytes.begin(), bytes.end(), [&] { return static_cast<std::uint8_t>(random()); });
  return bytes;
}

/// Resident memory of this process [bytes].
/// What a bridge says when it comes and moves its stylus.
Bytes whole_session(std::uint32_t session) {
  Bytes bytes = frame_bytes(Hello{.name = "replayed"});
  const wire::FrameBytes sample =
      wire::encode_frame(SampleMessage{.sample = {.sequence = 1000}}, session, 1, 0);
  bytes.insert(bytes.end(), sample.view().begin(), sample.view().end());
  return bytes;
}

/// One attempt of many to move the stylus of the session.
void attack(RawPeer& peer, int attempt, std::uint32_t session) {
  const SampleMessage sample{.sample = {.sequence = 1000, .buttons = kGrabButton}};
  switch (attempt % 4) {
    case 0:  // a second master
      peer.send(Hello{.name = "second"});
      peer.send(sample);
      break;
    case 1:  // forged: it knows the session's number
      peer.session = session;
      peer.sequence = 1000;
      peer.send(sample);
      break;
    case 2:
      peer.send(whole_session(session));
      break;
    default:
      peer.send(Hello{.name = "guesses"});
      peer.session = session + static_cast<std::uint32_t>(attempt);
      peer.send(sample);
  }
}

}  // namespace

TEST_CASE("10 000 forged, replayed and second-master attempts move no stylus", "[slow]") {
  RunningServer running(kPatient);
  RawPeer master = running.join();
  master.send(SampleMessage{.sample = {.sequence = 7}});
  CHECK(running.next_input().sample.sequence == 7);
  constexpr int kAttempts = 10'000;
  int answered = 0;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    RawPeer peer = running.connect();
    attack(peer, attempt, master.session);
    const auto frame = peer.receive();
    if (frame && (std::holds_alternative<Refuse>(frame->message) ||
                  std::holds_alternative<Goodbye>(frame->message))) {
      ++answered;
    }
    if (frame) REQUIRE_FALSE(std::holds_alternative<Welcome>(frame->message));
    REQUIRE(peer.ends());
  }
  CHECK(answered == kAttempts);
  const NetworkStats& stats = running.server.stats();
  CHECK(stats.accepted == 1);
  CHECK(stats.samples == 1);
  CHECK(stats.refused + stats.protocol_errors == kAttempts);
  CHECK_FALSE(running.server.port(0).in.receive());
  master.send(SampleMessage{.sample = {.sequence = 8}});
  CHECK(running.next_input().sample.sequence == 8);
}

TEST_CASE("what was said in one session moves no stylus in another") {
  RunningServer running(kPatient);
  std::uint32_t session = 0;
  {
    RawPeer master = running.join();
    session = master.session;
    master.send(Goodbye{});
    CHECK(master.ends());
  }
  RawPeer replay = running.connect();
  replay.send(whole_session(session));
  REQUIRE(replay.receive_as<Welcome>());
  const auto goodbye = replay.receive_as<Goodbye>();
  REQUIRE(goodbye);
  CHECK(goodbye->reason == wire::GoodbyeReason::kProtocolError);
  CHECK(running.server.stats().samples == 0);
  CHECK_FALSE(running.server.port(0).in.receive());
}

TEST_CASE("numbers of sessions are not those of another run") {
  RunningServer first(kPatient);
  RunningServer second(kPatient);
  CHECK(first.join().session != second.join().session);
}

TEST_CASE("a bridge that is silent gives way to one that asks") {
  NetworkSettings settings = kPatient;
  settings.yield_after_ms = 0;
  RunningServer running(settings);
  RawPeer silent = running.join();
  silent.send(SampleMessage{.sample = {.sequence = 7}});
  CHECK(running.next_input().present);
  RawPeer next = running.join();
  const auto goodbye = silent.receive_as<Goodbye>();
  REQUIRE(goodbye);
  CHECK(goodbye->reason == wire::GoodbyeReason::kTimeout);
  silent.send(SampleMessage{.sample = {.sequence = 8}});  // late
  CHECK(silent.ends());
  CHECK_FALSE(running.next_input().present);
  next.send(SampleMessage{.sample = {.sequence = 1}});
  CHECK(running.next_input().sample.sequence == 1);
  CHECK(running.server.stats().yielded == 1);
}

TEST_CASE("a bridge that says too much in a second is sent away") {
  NetworkSettings settings = kPatient;
  settings.max_frame_rate = 40;
  RunningServer running(settings);
  RawPeer peer = running.join();
  for (std::uint64_t i = 0; i < 1000; ++i) peer.send(SampleMessage{.sample = {.sequence = i}});
  const auto goodbye = peer.receive_as<Goodbye>();
  REQUIRE(goodbye);
  CHECK(goodbye->reason == wire::GoodbyeReason::kProtocolError);
  CHECK(running.server.stats().too_fast == 1);
  CHECK(running.server.stats().samples < 1000);
  running.check_serves();
}

#ifndef IRDM_SANITIZED  // a sanitizer keeps what was freed
TEST_CASE("100 MB of garbage adds at most 8 MiB of memory", "[slow]") {
  constexpr std::size_t kPiece = 2'000'000;
  constexpr std::size_t kAll = 100'000'000;
  constexpr std::size_t kAllowed = 8u << 20;
  const Bytes garbage = noise(5, kPiece);
  Bytes headers;  // of frames that are far too long, one after the other
  const Bytes hello = frame_bytes(Hello{});
  while (headers.size() < kPiece) {
    headers.insert(headers.end(), hello.begin(), hello.begin() + wire::kHeaderSize);
    headers[headers.size() - wire::kHeaderSize + 10] = 0x7F;
  }
  RunningServer running(kPatient);
  running.check_serves();
  const std::size_t before = resident();
  std::size_t most = before;
  std::size_t connections = 0;
  for (std::size_t thrown = 0; thrown < kAll; thrown += kPiece, ++connections) {
    RawPeer peer = running.connect();
    if (connections % 3 == 1) peer.send(Hello{});
    REQUIRE(peer.send(connections % 3 == 2 ? headers : garbage));
    most = std::max(most, resident());
  }
  running.check_serves();
  most = std::max(most, resident());
  CHECK(most - before <= kAllowed);
  CHECK(running.server.stats().protocol_errors == connections);
}
#endif
