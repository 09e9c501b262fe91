#include <spdlog/sinks/ringbuffer_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "device_bridge/network_client.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/raw_peer.hpp"

using namespace irdm;
using namespace irdm::test;
using irdm::wire::ForceMessage;
using irdm::wire::Goodbye;
using irdm::wire::Hello;
using irdm::wire::Refuse;
using irdm::wire::RefuseReason;
using irdm::wire::SampleMessage;
using irdm::wire::Welcome;

namespace {

/// A client, and a server that the test speaks for.
class ScriptedServer {
 public:
  explicit ScriptedServer(ClientSettings settings = {}) : link(1) {
    settings.server = {"127.0.0.1", listener.port()};
    client.emplace(link, settings, gave_up);
    client->start();
  }

  RawPeer accept() {
    RawPeer peer = listener.accept();
    REQUIRE(peer.receive_as<Hello>());
    return peer;
  }
  RawPeer welcome(std::uint32_t session = 1, bool lockstep = false) {
    RawPeer peer = accept();
    peer.session = session;
    peer.send(Welcome{.first_stylus = 2, .session = session, .lockstep = lockstep, .dt = 0.002});
    REQUIRE(wait_for([&] { return link.state.front().linked; }));
    return peer;
  }
  void give(const StylusSample& sample) {
    link.styluses[0].sample.put(sample);
    link.samples_ready.signal();
  }
  const ServoInput& input() {
    link.styluses[0].input.receive();
    return link.styluses[0].input.front();
  }
  /// Waits for news until the condition holds.
  template <typename Condition>
  bool wait_for(Condition condition) {
    for (;;) {
      link.state.receive();
      input();
      if (condition()) return true;
      if (!link.news.wait(kDeadlineMs)) return false;
    }
  }
  const ClientReport& end() {
    client->stop();
    return client->report();
  }

  RawListener listener;
  ServoLink link;
  EventFd gave_up;
  std::optional<NetworkClient> client;
};

}  // namespace

TEST_CASE("client says hello, sends samples of its slot and takes their forces") {
  ScriptedServer server;
  RawPeer peer = server.welcome();
  server.give({.sequence = 4, .time_ns = 9});
  const auto sample = peer.receive_as<SampleMessage>();
  REQUIRE(sample);
  CHECK(sample->stylus == 2);
  CHECK(sample->sample.sequence == 4);
  peer.send(ForceMessage{
      .stylus = 2,
      .force = {
          .force_step = 10, .sample_sequence = 4, .sample_time_ns = 9, .force = Vector3(1, 0, 0)}});
  REQUIRE(server.wait_for([&] { return server.input().any_force; }));
  CHECK(server.input().force.force == Vector3(1, 0, 0));
}

TEST_CASE("client takes torques where it asked for them and the server has them, else none") {
  for (const bool wanted : {true, false}) {
    for (const bool offered : {true, false}) {
      for (const bool sent : {true, false}) {
        CAPTURE(wanted, offered, sent);
        ScriptedServer server({.torque = wanted});
        RawPeer peer = server.listener.accept();
        const auto hello = peer.receive_as<Hello>();
        REQUIRE(hello);
        CHECK(((hello->capabilities & wire::kCapabilityTorque) != 0) == wanted);
        peer.session = 1;
        peer.send(Welcome{.first_stylus = 2,
                          .capabilities = offered ? wire::kCapabilityTorque : 0,
                          .session = 1,
                          .dt = 0.002});
        REQUIRE(server.wait_for([&] { return server.link.state.front().linked; }));
        server.give({.sequence = 4, .time_ns = 9});
        REQUIRE(peer.receive_as<SampleMessage>());
        peer.send(ForceMessage{.stylus = 2,
                               .force = {.sample_sequence = 4,
                                         .sample_time_ns = 9,
                                         .force = Vector3(1, 0, 0),
                                         .torque = Vector3(0, 0.5, 0)},
                               .with_torque = sent});
        if (sent == (wanted && offered)) {
          REQUIRE(server.wait_for([&] { return server.input().any_force; }));
          CHECK(server.input().force.torque == (sent ? Vector3(0, 0.5, 0) : Vector3(0, 0, 0)));
        } else {
          REQUIRE(server.wait_for([&] { return !server.link.state.front().linked; }));
          CHECK_FALSE(server.input().any_force);
          CHECK(server.end().protocol_errors == 1);
        }
      }
    }
  }
}

TEST_CASE("client says once a session that a force is scaled down, and why") {
  const auto kept = std::make_shared<spdlog::sinks::ringbuffer_sink_mt>(100);
  const std::shared_ptr<spdlog::logger> before = spdlog::default_logger();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("", kept));
  const auto told = [&](const std::string& words) {
    const std::vector<std::string> lines = kept->last_formatted();
    return std::count_if(lines.begin(), lines.end(), [&](const std::string& line) {
      return line.find("stylus 0: " + words) != std::string::npos;
    });
  };
  const std::string oscillates = "oscillation detected, force scaled to 30 %";
  const std::string gives = "its contact gave more energy than hands put in, force scaled to 20 %";
  ScriptedServer server;
  server.link.styluses[0].gain = 0.8;
  RawPeer peer = server.welcome();
  server.link.styluses[0].gain = 0.3;
  CHECK(eventually([&] { return told(oscillates) == 1; }));
  CHECK(told(gives) == 0);
  server.link.styluses[0].energy_share = 0.2;
  CHECK(eventually([&] { return told(gives) == 1; }));
  server.end();
  CHECK(told(oscillates) == 1);
  CHECK(told(gives) == 1);
  spdlog::set_default_logger(before);
}

TEST_CASE("client solves the contact only where it is asked to and the server can") {
  for (const bool wanted : {true, false}) {
    for (const bool offered : {true, false}) {
      CAPTURE(wanted, offered);
      ScriptedServer server({.predict = wanted});
      RawPeer peer = server.listener.accept();
      const auto hello = peer.receive_as<Hello>();
      REQUIRE(hello);
      CHECK(((hello->capabilities & wire::kCapabilityContactModel) != 0) == wanted);
      peer.session = 1;
      peer.send(Welcome{
          .capabilities = offered ? wire::kCapabilityContactModel : 0, .session = 1, .dt = 0.002});
      REQUIRE(server.wait_for([&] { return server.link.state.front().linked; }));
      CHECK(server.link.state.front().predict == (wanted && offered));
    }
  }
}

TEST_CASE("client takes answers to newer samples from a run that stands still") {
  ScriptedServer server;
  RawPeer peer = server.welcome();
  for (const std::uint64_t sequence : {4, 5}) {
    server.give({.sequence = sequence});
    REQUIRE(peer.receive_as<SampleMessage>());
    peer.send(ForceMessage{.stylus = 2, .force = {.force_step = 10, .sample_sequence = sequence}});
    REQUIRE(server.wait_for([&] { return server.input().force.sample_sequence == sequence; }));
  }
  const ClientReport& report = server.end();
  CHECK(report.forces == 2);
  CHECK(report.forces_old == 0);
  CHECK(report.gaps == 0);
}

TEST_CASE("client drops forces that are repeated or older than the session, and counts gaps") {
  ScriptedServer server;
  RawPeer peer = server.welcome();
  server.give({.sequence = 4});
  REQUIRE(peer.receive_as<SampleMessage>());
  const auto send = [&](std::uint64_t step, std::uint64_t sequence) {
    peer.send(
        ForceMessage{.stylus = 2, .force = {.force_step = step, .sample_sequence = sequence}});
  };
  send(9, 3);  // said before this session
  send(10, 4);
  send(10, 4);  // again
  send(13, 4);  // after 11 and 12
  send(20, 4);  // after 14 to 19
  REQUIRE(server.wait_for([&] { return server.input().force.force_step == 20; }));
  const ClientReport& report = server.end();
  CHECK(report.forces == 3);
  CHECK(report.forces_old == 2);
  CHECK(report.gaps == 2);
  CHECK(report.steps_missed == 8);
  CHECK(report.longest_gap == 6);
}

TEST_CASE(
    "client does not go on with a server whose forces are for samples of the future or of no "
    "time") {
  for (const std::int64_t time_ns : {std::numeric_limits<std::int64_t>::max(), std::int64_t{-1},
                                     std::numeric_limits<std::int64_t>::min()}) {
    ScriptedServer server;
    RawPeer peer = server.welcome();
    server.give({.sequence = 4});
    REQUIRE(peer.receive_as<SampleMessage>());
    peer.send(
        ForceMessage{.stylus = 2, .force = {.sample_sequence = 4, .sample_time_ns = time_ns}});
    CHECK(peer.ends());
    const ClientReport& report = server.end();
    CHECK(report.protocol_errors == 1);
    CHECK(report.forces == 0);
  }
}

TEST_CASE("client keeps what the server says of its run, first and last") {
  ScriptedServer server;
  RawPeer peer = server.welcome();
  server.give({});
  REQUIRE(peer.receive_as<SampleMessage>());
  for (const std::uint64_t steps : {7u, 8u, 9u}) peer.send(wire::Status{.steps = steps});
  peer.send(ForceMessage{.stylus = 2});
  REQUIRE(server.wait_for([&] { return server.input().any_force; }));
  const ClientReport& report = server.end();
  REQUIRE(report.server);
  CHECK(report.server_at_first->steps == 7);
  CHECK(report.server->steps == 9);
}

TEST_CASE("client says goodbye when it is stopped") {
  ScriptedServer server;
  RawPeer peer = server.welcome();
  server.give({});
  REQUIRE(peer.receive_as<SampleMessage>());
  server.client->stop(true);
  const auto goodbye = peer.receive_as<Goodbye>();
  REQUIRE(goodbye);
  CHECK(goodbye->reason == wire::GoodbyeReason::kFinished);
  CHECK(peer.ends());
}

TEST_CASE("client connects again after death, goodbye, garbage and silence of the server") {
  ScriptedServer server({.silence_timeout_ms = 100});
  { RawPeer dead = server.welcome(1); }
  REQUIRE(server.wait_for([&] { return !server.link.state.front().linked; }));
  CHECK_FALSE(server.input().linked);
  {
    RawPeer polite = server.welcome(2);
    polite.send(Goodbye{});
    CHECK(polite.ends());
  }
  {
    RawPeer mad = server.welcome(3);
    mad.send(std::vector<std::uint8_t>(100, 0x55));
    CHECK(mad.ends());
  }
  {
    RawPeer silent = server.welcome(4);
    CHECK(silent.ends());
  }
  RawPeer good = server.welcome(5);
  const ClientReport& report = server.end();
  CHECK(report.sessions == 5);
  CHECK(report.protocol_errors == 1);
  CHECK(report.failure.empty());
}

TEST_CASE("client leaves a server that does not answer or sends half a message") {
  ScriptedServer server({.answer_timeout_ms = 50});
  RawPeer mute = server.accept();
  CHECK(mute.ends());
  RawPeer late = server.welcome();
  CHECK(late.session == 1);
}

TEST_CASE("client leaves a server that breaks the protocol") {
  ScriptedServer server;
  const auto check_left = [&](const wire::Message& message) {
    RawPeer peer = server.welcome();
    peer.send(message);
    CHECK(peer.ends());
  };
  check_left(Hello{});
  check_left(SampleMessage{});
  check_left(Welcome{.session = 1, .dt = 0.002});
  check_left(Refuse{});
  check_left(ForceMessage{.stylus = 1});
  check_left(ForceMessage{.stylus = 3});
  {
    RawPeer peer = server.welcome();
    ++peer.session;
    peer.send(ForceMessage{.stylus = 2});
    CHECK(peer.ends());
  }
  CHECK(server.end().protocol_errors == 7);
}

TEST_CASE("client leaves a server that goes backward or answers what was not said") {
  ScriptedServer server;
  std::uint64_t said = 0;
  const auto check_left = [&](std::uint64_t step, std::uint64_t sequence, bool old_frame) {
    RawPeer peer = server.welcome();
    for (int i = 0; i < 2; ++i) {
      server.give({.sequence = ++said});
      REQUIRE(peer.receive_as<SampleMessage>());
    }
    peer.send(ForceMessage{.stylus = 2, .force = {.force_step = 10, .sample_sequence = said}});
    REQUIRE(server.wait_for([&] { return server.input().force.sample_sequence == said; }));
    if (old_frame) --peer.sequence;
    peer.send(ForceMessage{.stylus = 2,
                           .force = {.force_step = step, .sample_sequence = said + sequence - 2}});
    CHECK(peer.ends());
  };
  check_left(9, 2, false);
  check_left(11, 1, false);
  check_left(11, 3, false);
  check_left(11, 2, true);
  CHECK(server.end().protocol_errors == 4);
}

TEST_CASE("client gives up when the versions do not match, and names both") {
  ScriptedServer server;
  RawPeer peer = server.accept();
  peer.send(Refuse{.reason = RefuseReason::kVersion, .version_min = 3, .version_max = 4});
  REQUIRE(server.gave_up.wait(kDeadlineMs));
  CHECK_THAT(server.end().failure, Catch::Matchers::ContainsSubstring(
                                       "peer speaks protocol version 3 to 4, this program 1"));
}

TEST_CASE("client gives up on a header of another version") {
  ScriptedServer server;
  RawPeer peer = server.accept();
  std::vector<std::uint8_t> bytes = frame_bytes(Welcome{.session = 1, .dt = 0.002});
  bytes[4] = 7;
  peer.send(bytes);
  REQUIRE(server.gave_up.wait(kDeadlineMs));
  CHECK_THAT(server.end().failure, Catch::Matchers::ContainsSubstring("version 7"));
}

TEST_CASE("client gives up when it asks for too much, and tries again when that may pass") {
  ScriptedServer server;
  for (const RefuseReason passing :
       {RefuseReason::kNoFreeStylus, RefuseReason::kTooManyConnections, RefuseReason::kStopping}) {
    RawPeer peer = server.accept();
    peer.send(Refuse{.reason = passing, .text = "later"});
    CHECK(peer.ends());
  }
  RawPeer peer = server.accept();
  peer.send(Refuse{.reason = RefuseReason::kTooManyStyluses, .text = "only 0"});
  REQUIRE(server.gave_up.wait(kDeadlineMs));
  CHECK_THAT(server.end().failure, Catch::Matchers::ContainsSubstring("only 0"));
}

TEST_CASE("client gives up when a lockstep session breaks") {
  ScriptedServer server;
  { RawPeer peer = server.welcome(1, true); }
  REQUIRE(server.gave_up.wait(kDeadlineMs));
  CHECK_THAT(server.end().failure,
             Catch::Matchers::ContainsSubstring("connection lost in lockstep"));
}
