#include <cmath>
#include <future>
#include <string>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "tests/server_network/running_server.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::test;
using irdm::wire::Goodbye;
using irdm::wire::GoodbyeReason;
using irdm::wire::Hello;
using irdm::wire::Refuse;
using irdm::wire::RefuseReason;
using irdm::wire::SampleMessage;
using irdm::wire::Welcome;

TEST_CASE("server welcomes a bridge and says what it runs") {
  RunningServer running({.dt = 0.004});
  CHECK(running.server.endpoints() ==
        std::vector<std::string>{"127.0.0.1:" + std::to_string(running.server.port_number())});
  RawPeer peer = running.connect();
  peer.send(Hello{.version_min = 1, .version_max = 9, .styluses = 2, .name = "test"});
  const auto welcome = peer.receive_as<Welcome>();
  REQUIRE(welcome);
  CHECK(welcome->version == 1);
  CHECK(welcome->first_stylus == 0);
  CHECK(welcome->dt == 0.004);
  CHECK_FALSE(welcome->lockstep);
  CHECK(running.server.stats().accepted == 1);
}

TEST_CASE("a sample reaches the force thread and its force comes back with its name") {
  RunningServer running;
  RawPeer peer = running.join();
  peer.send(SampleMessage{.sample = {.sequence = 3, .time_ns = 77, .tip = Vector3(1, 2, 3)}});
  const StylusInput input = running.next_input();
  CHECK(input.present);
  CHECK(input.sample.sequence == 3);
  CHECK(input.sample.tip == Vector3(1, 2, 3));
  running.give(
      {.force_step = 12, .sample_sequence = 3, .sample_time_ns = 77, .force = Vector3(0, 1, 0)});
  const auto force = peer.receive_as<wire::ForceMessage>();
  REQUIRE(force);
  CHECK(force->force.force_step == 12);
  CHECK(force->force.sample_sequence == 3);
  CHECK(force->force.sample_time_ns == 77);
  CHECK(force->force.force == Vector3(0, 1, 0));
}

TEST_CASE(
    "a server without a thread does its work in serve(), and sends the last forces when stopped") {
  NetworkServer server({.lockstep = true, .styluses = 1});
  server.open();
  RawPeer peer = RawPeer::connect(server.port_number());
  peer.send(Hello{.lockstep = true, .name = "test"});
  const auto served_until = [&](const auto& done) {
    return eventually([&] {
      server.serve();
      return done();
    });
  };
  REQUIRE(served_until([&] { return server.stats().accepted == 1; }));
  REQUIRE(peer.receive_as<Welcome>());
  StylusPort& port = server.port(0);
  const auto answer = [&](std::uint64_t step) {
    peer.send(SampleMessage{.sample = lockstep_sample(step)});
    REQUIRE(
        served_until([&] { return port.in.receive() && port.in.front().sample.sequence == step; }));
    port.out.put({.force_step = step,
                  .sample_sequence = step,
                  .sample_time_ns = lockstep_sample(step).time_ns});
  };
  answer(0);
  server.serve();
  const auto force = peer.receive_as<wire::ForceMessage>();
  REQUIRE(force);
  CHECK(force->force.force_step == 0);

  answer(1);
  auto rest = std::async(std::launch::async, [&] {
    const auto last = peer.receive_as<wire::ForceMessage>();
    const auto goodbye = peer.receive_as<Goodbye>();
    peer.close();
    return std::pair(last, goodbye);
  });
  server.stop();
  const auto [last, goodbye] = rest.get();
  REQUIRE(last);
  CHECK(last->force.force_step == 1);
  REQUIRE(goodbye);
  CHECK(goodbye->reason == GoodbyeReason::kStopping);
  CHECK(port.in.receive());
  CHECK_FALSE(port.in.front().present);
  server.stop();
}

TEST_CASE("a torque goes to those bridges that want it, a finite one") {
  const Vector3 torque(0.1, -0.2, 0.3);
  for (const std::uint32_t wanted : {0U, wire::kCapabilityTorque}) {
    for (const bool lockstep : {false, true}) {
      CAPTURE(wanted, lockstep);
      RunningServer running({.lockstep = lockstep});
      RawPeer peer = running.connect();
      peer.send(Hello{.capabilities = wanted, .lockstep = true, .name = "test"});
      const auto welcome = peer.receive_as<Welcome>();
      REQUIRE(welcome);
      CHECK(welcome->capabilities == wanted);
      const auto answer = [&](std::uint64_t step, const Vector3& given) {
        peer.send(SampleMessage{.sample = lockstep_sample(step)});
        running.next_input();
        running.give({.force_step = step,
                      .sample_sequence = step,
                      .sample_time_ns = lockstep_sample(step).time_ns,
                      .force = Vector3(0, 1, 0),
                      .torque = given});
        const auto force = peer.receive_as<wire::ForceMessage>();
        REQUIRE(force);
        CHECK(force->force.force_step == step);
        CHECK(force->with_torque == (wanted != 0));
        return force->force;
      };
      const Vector3 shown = wanted != 0 ? torque : Vector3(Vector3::Zero());
      CHECK(answer(0, torque).torque == shown);
      const StylusForce spoilt = answer(1, Vector3(0, std::nan(""), 0));
      CHECK(spoilt.torque.isZero(0.0));
      CHECK(spoilt.force.isZero(0.0));
      CHECK(running.server.stats().forces_not_finite == 1);
    }
  }
}

TEST_CASE("a bridge's report is there for who watches, until the bridge goes") {
  RunningServer running;
  RawPeer peer = running.connect();
  peer.send(Hello{.capabilities = wire::kCapabilityReport, .lockstep = true, .name = "test"});
  const auto welcome = peer.receive_as<Welcome>();
  REQUIRE(welcome);
  CHECK(welcome->capabilities == wire::kCapabilityReport);
  peer.send(wire::Report{.round_trip = {1.0F, 2.0F, 3.0F}});
  TripleBuffer<LinkReport>& link = running.server.port(0).link;
  REQUIRE(eventually([&] { return link.receive(); }));
  CHECK(link.front().reported);
  CHECK(link.front().report.round_trip.maximum == 3.0F);
  peer.send(Goodbye{});
  REQUIRE(eventually([&] { return link.receive(); }));
  CHECK_FALSE(link.front().reported);
}

TEST_CASE("a status goes to those bridges that want it, not in lockstep") {
  for (const bool lockstep : {false, true}) {
    RunningServer running({.lockstep = lockstep});
    RawPeer indifferent = running.join();
    RawPeer curious = running.connect();
    curious.send(
        Hello{.capabilities = wire::kCapabilityStatus | wire::kCapabilityReport, .lockstep = true});
    const auto welcome = curious.receive_as<Welcome>();
    REQUIRE(welcome);
    CHECK(welcome->capabilities ==
          (wire::kCapabilityReport | (lockstep ? 0 : wire::kCapabilityStatus)));
    running.server.status().put({.steps = 7, .surface_rate = 60.0F});
    if (!lockstep) {
      const auto status = curious.receive_as<wire::Status>();
      REQUIRE(status);
      CHECK(status->steps == 7);
      CHECK(status->surface_rate == 60.0F);
    }
    for (RawPeer* peer : {&indifferent, &curious}) {
      peer->send(Goodbye{});
      CHECK(peer->receive_as<Goodbye>());  // and nothing else before it
    }
  }
}

TEST_CASE("a force that is not finite goes out as zero") {
  RunningServer running;
  RawPeer peer = running.join();
  peer.send(SampleMessage{});
  running.next_input();
  running.give({.force = Vector3(0, std::numeric_limits<double>::quiet_NaN(), 1)});
  const auto force = peer.receive_as<wire::ForceMessage>();
  REQUIRE(force);
  CHECK(force->force.force == Vector3::Zero());
  CHECK(running.server.stats().forces_not_finite == 1);
}

TEST_CASE("two bridges have their own styluses and get their own forces") {
  RunningServer running;
  RawPeer first = running.join(1);
  RawPeer second = running.join(2);
  second.send(SampleMessage{.stylus = 2, .sample = {.sequence = 8}});
  CHECK(running.next_input(2).sample.sequence == 8);
  running.give({.force_step = 1, .sample_sequence = 8}, 2);
  const auto force = second.receive_as<wire::ForceMessage>();
  REQUIRE(force);
  CHECK(force->stylus == 2);
  first.send(Goodbye{});
  CHECK(first.receive_as<Goodbye>());  // and no force before it
}

TEST_CASE("an older or repeated sample ends its session and is counted") {
  RunningServer running;
  for (const std::uint64_t sequence : {4u, 5u}) {
    RawPeer peer = running.join();
    peer.send(SampleMessage{.sample = {.sequence = 5}});
    CHECK(running.next_input().sample.sequence == 5);
    peer.send(SampleMessage{.sample = {.sequence = sequence}});
    CHECK_FALSE(running.next_input().present);
    const auto goodbye = peer.receive_as<Goodbye>();
    REQUIRE(goodbye);
    CHECK(goodbye->reason == GoodbyeReason::kProtocolError);
  }
  CHECK(running.server.stats().samples == 2);
  CHECK(running.server.stats().samples_old == 2);
  CHECK(running.server.stats().protocol_errors == 2);
}

TEST_CASE("a goodbye is counted, and the stylus is absent after it") {
  RunningServer running;
  RawPeer peer = running.join();
  peer.send(SampleMessage{});
  CHECK(running.next_input().present);
  peer.send(Goodbye{});
  CHECK_FALSE(running.next_input().present);
  CHECK(running.server.stats().goodbyes == 1);
  CHECK(peer.ends());
}

TEST_CASE("a bridge that dies leaves its stylus absent and its slot free") {
  RunningServer running({.styluses = 1});
  {
    RawPeer peer = running.join();
    peer.send(SampleMessage{});
    CHECK(running.next_input().present);
  }
  CHECK_FALSE(running.next_input().present);
  CHECK(running.server.stats().goodbyes == 0);
  running.check_serves();
}

TEST_CASE("a bridge that has died before it is accepted still has its name") {
  class Names final : public wire::FrameTap {
   public:
    std::uint32_t open(std::string_view peer) noexcept override {
      peer_.assign(peer.substr(0, peer_.capacity()));
      return 1;
    }
    void see(wire::TapKind, std::uint32_t, std::span<const std::uint8_t>) noexcept override {}
    const std::string& peer() const { return peer_; }

   private:
    std::string peer_ = std::string(60, ' ');
  } names;
  NetworkServer server({.lockstep = true, .tap = &names});
  std::string name;
  {
    RawPeer peer = RawPeer::connect(server.port_number());
    name = peer.name();
    peer.cut();
  }
  server.open();
  CHECK(eventually([&] {
    server.serve();
    return names.peer().find_first_not_of(' ') != std::string::npos;
  }));
  CHECK(names.peer() == name);
}

TEST_CASE("in real time a silent stylus is absent until its next sample") {
  RunningServer running({.absent_after_ms = 20});
  RawPeer peer = running.join();
  peer.send(SampleMessage{.sample = {.sequence = 0}});
  CHECK(running.next_input().present);
  CHECK_FALSE(running.next_input().present);
  peer.send(SampleMessage{.sample = {.sequence = 1}});
  CHECK(running.next_input().present);
}

TEST_CASE("in real time a bridge that is silent for long is sent away") {
  RunningServer running({.silence_timeout_ms = 50});
  RawPeer peer = running.join();
  const auto goodbye = peer.receive_as<Goodbye>();
  REQUIRE(goodbye);
  CHECK(goodbye->reason == GoodbyeReason::kTimeout);
  CHECK(peer.ends());
  CHECK(running.server.stats().timeouts == 1);
}

TEST_CASE("in lockstep a silent stylus stays") {
  RunningServer running({.lockstep = true,
                         .handshake_timeout_ms = 50,
                         .absent_after_ms = 5,
                         .silence_timeout_ms = 5});
  RawPeer peer = running.join();
  peer.send(SampleMessage{.sample = lockstep_sample(0)});
  CHECK(running.next_input().present);
  // The server has looked at its clock for long when two that say nothing, not even Hello, are sent
  // away one after the other.
  constexpr int kMute = 2;
  for (int i = 0; i < kMute; ++i) CHECK(running.connect().ends());
  CHECK_FALSE(running.server.port(0).in.receive());
  CHECK(running.server.stats().timeouts == kMute);
}

TEST_CASE("server refuses a bridge that has no version in common, and names its own") {
  RunningServer running;
  RawPeer peer = running.connect();
  peer.send(Hello{.version_min = 5, .version_max = 9});
  const auto refuse = peer.receive_as<Refuse>();
  REQUIRE(refuse);
  CHECK(refuse->reason == RefuseReason::kVersion);
  CHECK(refuse->version_min == 1);
  CHECK(refuse->version_max == 1);
  CHECK(peer.ends());
}

TEST_CASE("server refuses a bridge when no stylus is free, until one is") {
  RunningServer running({.styluses = 1, .yield_after_ms = 60'000, .silence_timeout_ms = 60'000});
  RawPeer first = running.join();
  RawPeer second = running.connect();
  second.send(Hello{});
  const auto refuse = second.receive_as<Refuse>();
  REQUIRE(refuse);
  CHECK(refuse->reason == RefuseReason::kNoFreeStylus);
  CHECK(refuse->text == "no free stylus: another bridge has it");
  first.send(Goodbye{});
  CHECK(first.ends());
  running.check_serves();
}

TEST_CASE("server refuses a bridge that wants more styluses than there are") {
  RunningServer running({.styluses = 1});
  RawPeer peer = running.connect();
  peer.send(Hello{.styluses = 2});
  const auto refuse = peer.receive_as<Refuse>();
  REQUIRE(refuse);
  CHECK(refuse->reason == RefuseReason::kTooManyStyluses);
  CHECK(refuse->text == "the server has 1 stylus");
}

TEST_CASE("server in lockstep refuses a bridge that cannot") {
  RunningServer running({.lockstep = true});
  RawPeer peer = running.connect();
  peer.send(Hello{.lockstep = false});
  const auto refuse = peer.receive_as<Refuse>();
  REQUIRE(refuse);
  CHECK(refuse->reason == RefuseReason::kLockstep);
}

TEST_CASE("server refuses more connections than its limit") {
  RunningServer running({.max_connections = 2});
  RawPeer first = running.join();
  RawPeer second = running.join();
  RawPeer third = running.connect();
  const auto refuse = third.receive_as<Refuse>();
  REQUIRE(refuse);
  CHECK(refuse->reason == RefuseReason::kTooManyConnections);
  CHECK(third.ends());
}

TEST_CASE("peers that say nothing keep no bridge away") {
  RunningServer running({.max_connections = 3, .handshake_timeout_ms = 60'000});
  RawPeer bridge = running.join();
  RawPeer silent = running.connect();
  RawPeer other = running.connect();
  RawPeer late = running.join();
  CHECK(silent.ends());
  CHECK(running.server.stats().displaced == 1);
  CHECK(running.server.stats().refused == 0);
}

TEST_CASE("peers that do not hang up once their session has ended keep no bridge away") {
  RunningServer running({.max_connections = 2});
  std::vector<RawPeer> refused;
  for (int i = 0; i < 10; ++i) {
    RawPeer& peer = refused.emplace_back(running.connect());
    peer.send(Hello{.styluses = 60});
    REQUIRE(peer.receive_as<Refuse>());
  }
  running.join();
}

TEST_CASE("a bridge that does not read gets the newest forces when it does") {
  RunningServer running({.absent_after_ms = 60'000, .silence_timeout_ms = 60'000});
  RawPeer peer = RawPeer::connect(running.server.port_number(), 4096);
  peer.send(Hello{});
  REQUIRE(peer.receive_as<Welcome>());
  peer.send(SampleMessage{});
  running.next_input();
  const NetworkStats& stats = running.server.stats();
  std::uint64_t step = 0;
  while (stats.forces_replaced == 0) {
    const std::uint64_t before = stats.forces;
    running.give({.force_step = ++step});
    REQUIRE(eventually([&] { return stats.forces > before; }));
  }
  std::uint64_t newest = 0;
  while (newest < step) {
    const auto force = peer.receive_as<wire::ForceMessage>();
    REQUIRE(force);
    REQUIRE(force->force.force_step > newest);
    newest = force->force.force_step;
  }
  CHECK(newest == step);
  // What lay in buffers on the way: no more than the peer's small one and a few frames of ours.
  CHECK(step < 200);
}

TEST_CASE("a server that stops says goodbye, and its port can be used again") {
  std::uint16_t port = 0;
  {
    RunningServer running;
    port = running.server.port_number();
    RawPeer peer = running.join();
    peer.send(SampleMessage{});
    CHECK(running.next_input().present);
    running.server.stop();
    const auto goodbye = peer.receive_as<Goodbye>();
    REQUIRE(goodbye);
    CHECK(goodbye->reason == GoodbyeReason::kStopping);
    CHECK(peer.ends());
    CHECK_FALSE(running.next_input().present);
  }
  RunningServer again({.port = port});
  CHECK(again.server.port_number() == port);
  again.check_serves();
}

TEST_CASE("server says where it cannot listen") {
  RunningServer running;
  CHECK_THROWS_AS(NetworkServer({.port = running.server.port_number()}), Error);
  CHECK_THROWS_AS(NetworkServer({.address = "nowhere"}), Error);
  CHECK_THROWS_AS(NetworkServer({.address = "192.0.2.1"}), Error);
  CHECK_THROWS_AS(NetworkServer({.dt = 0.0}), Error);
  CHECK_THROWS_AS(NetworkServer({.styluses = 0}), Error);
}
