// The server's datagrams, over real sockets: who gets forces by them, and who gets nothing.
#include <algorithm>
#include <memory>
#include <random>

#include "common/error.hpp"
#include "common/wire/secret_key.hpp"
#include "tests/server_network/running_server.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/raw_datagrams.hpp"

using namespace irdm;
using namespace irdm::test;
using namespace irdm::wire;

namespace {

using Bytes = std::vector<std::uint8_t>;

/// A bridge that has asked for datagrams and got them.
class DatagramBridge {
 public:
  explicit DatagramBridge(RunningServer& running, std::uint32_t capabilities = kCapabilityDatagrams)
      : running_(running), tcp(running.connect()) {
    tcp.send(Hello{.capabilities = capabilities, .name = "test"});
    const auto welcome = tcp.receive_as<Welcome>();
    REQUIRE(welcome);
    REQUIRE(welcome->capabilities == capabilities);
    const auto offer = tcp.receive_as<Datagrams>();
    REQUIRE(offer);
    port = offer->port;
    keys = keys_of(offer->random);
    channel = std::make_unique<RawChannel>(keys, DatagramEnd::kBridge, tcp.session);
  }
  Bytes sample(std::uint64_t sequence) {
    return channel->seal(SampleMessage{.sample = {.sequence = sequence}}, ++frame_);
  }
  /// By datagram, and has it handed over.
  void say(std::uint64_t sequence) {
    udp.send(sample(sequence), port);
    REQUIRE(running_.next_input().sample.sequence == sequence);
  }
  /// Takes the server's force for this sample by datagram.
  void check_force(std::uint64_t sequence, RawDatagrams& from) {
    running_.give({.force_step = sequence, .sample_sequence = sequence});
    const std::optional<Frame> frame = channel->receive(from);
    REQUIRE(frame);
    REQUIRE(std::holds_alternative<ForceMessage>(frame->message));
    CHECK(std::get<ForceMessage>(frame->message).force.sample_sequence == sequence);
  }

 private:
  RunningServer& running_;
  std::uint64_t frame_ = 100;

 public:
  RawPeer tcp;
  RawDatagrams udp;
  std::uint16_t port = 0;
  DatagramKeys keys;
  std::unique_ptr<RawChannel> channel;
};

std::uint64_t dropped(const NetworkStats& stats) {
  return stats.datagrams_foreign + stats.datagrams_forged + stats.datagrams_replayed;
}

}  // namespace

TEST_CASE("forces go by datagrams from the first sample on that came so, and by TCP before") {
  RunningServer running(kPatient);
  DatagramBridge bridge(running);
  CHECK(bridge.port == running.server.port_number());
  // A probe comes back as large as it went, and changes nothing else.
  bridge.udp.send(bridge.channel->probe(), bridge.port);
  const auto answer = bridge.udp.receive();
  REQUIRE(answer);
  CHECK(answer->size() == kLargestDatagram);
  CHECK(bridge.udp.sender() == bridge.port);
  CHECK(is_probe(bridge.channel->channel.open(*answer).text));
  bridge.tcp.send(SampleMessage{.sample = {.sequence = 1}});
  REQUIRE(running.next_input().sample.sequence == 1);
  running.give({.force_step = 1, .sample_sequence = 1});
  REQUIRE(bridge.tcp.receive_as<ForceMessage>());

  bridge.say(2);
  bridge.check_force(2, bridge.udp);
  // The control channel stays.
  bridge.tcp.send(Goodbye{});
  CHECK(bridge.tcp.receive_as<Goodbye>());
  CHECK(bridge.tcp.ends());
  CHECK(running.server.stats().protocol_errors == 0);
  // A session that has ended has no datagrams.
  bridge.udp.send(bridge.sample(3), bridge.port);
  CHECK(eventually([&] { return running.server.stats().datagrams_foreign == 1; }));
}

TEST_CASE("a contact model comes in parts, and applied forces go in one") {
  RunningServer running(kPatient);
  DatagramBridge bridge(running, kCapabilityDatagrams | kCapabilityContactModel);
  bridge.say(1);
  const std::uint64_t session = running.server.port(0).in.front().session;
  OfSession<ContactModel> served{session, {}};
  served.value.valid = true;
  served.value.horizon = kMaxHorizon;
  served.value.step = 9;
  served.value.dt = 0.002;
  for (auto& response : served.value.response) response.setIdentity();
  running.server.port(0).model.put(served);
  running.server.forces_ready().signal();
  const std::optional<Frame> frame = bridge.channel->receive(bridge.udp);
  REQUIRE(frame);
  const auto* message = std::get_if<ContactModelMessage>(&frame->message);
  REQUIRE(message != nullptr);
  CHECK(message->model.step == 9);
  CHECK(message->model.response[kMaxHorizon - 1] == Matrix3::Identity());

  AppliedForcesMessage applied{};
  applied.applied.count = kForcesInDatagram;
  applied.applied.step = 40;
  bridge.udp.send(bridge.channel->seal(applied, 1000), bridge.port);
  CHECK(eventually([&] { return running.server.port(0).applied.receive(); }));
}

TEST_CASE("what a newer sample has overtaken is dropped, and the session goes on") {
  RunningServer running(kPatient);
  DatagramBridge bridge(running);
  const Bytes early = bridge.sample(1);
  bridge.say(2);
  bridge.udp.send(early, bridge.port);
  bridge.tcp.send(SampleMessage{.sample = {.sequence = 1}});  // by TCP, too
  bridge.say(3);
  bridge.tcp.send(Goodbye{});
  CHECK(bridge.tcp.ends());
  CHECK(running.server.stats().samples == 2);
  CHECK(eventually([&] { return running.server.stats().messages_late == 2; }));
  CHECK(running.server.stats().protocol_errors == 0);
}

TEST_CASE("datagrams that are forged, replayed or from elsewhere gain nothing, 10 000 of them") {
  RunningServer running(kPatient);
  DatagramBridge bridge(running);
  bridge.say(1);
  const Bytes old = bridge.sample(2);
  bridge.udp.send(old, bridge.port);
  REQUIRE(running.next_input().sample.sequence == 2);
  RawChannel forger(keys_of(random_material()), DatagramEnd::kBridge, bridge.tcp.session);
  RawDatagrams near;
  RawDatagrams far("127.0.0.2");
  std::mt19937 random(3);
  const SampleMessage wanted{.sample = {.sequence = 1000, .buttons = kGrabButton}};
  constexpr std::uint64_t kAttempts = 10'000;
  const NetworkStats& stats = running.server.stats();
  for (std::uint64_t attempt = 0; attempt < kAttempts; ++attempt) {
    Bytes datagram;
    RawDatagrams* from = &near;
    switch (attempt % 5) {
      case 0:  // with another key
        datagram = forger.seal(wanted, 1000);
        break;
      case 1:  // the right one, a bit of which is another
        datagram = bridge.channel->seal(wanted, 1000);
        datagram[random() % datagram.size()] ^= static_cast<std::uint8_t>(1u << (random() % 8));
        break;
      case 2:  // again, from another port
        datagram = old;
        break;
      case 3:  // the right one, caught and sent from another address
        datagram = bridge.channel->seal(wanted, 1000);
        from = &far;
        break;
      default:  // noise of any length
        datagram.resize(random() % 1500);
        std::generate(datagram.begin(), datagram.end(),
                      [&] { return static_cast<std::uint8_t>(random()); });
    }
    from->send(datagram, bridge.port);
    // The kernel keeps few of them.
    if (attempt % 50 == 49) REQUIRE(eventually([&] { return dropped(stats) == attempt + 1; }));
  }
  CHECK(stats.samples == 2);
  CHECK(stats.datagrams_replayed == kAttempts / 5);
  CHECK_FALSE(running.server.port(0).in.receive());
  CHECK_FALSE(near.any());
  CHECK_FALSE(far.any());
  // The bridge itself is not disturbed, and still the one who gets the forces.
  bridge.check_force(2, bridge.udp);
  bridge.say(3);
  bridge.check_force(3, bridge.udp);
  CHECK(stats.protocol_errors == 0);
}

TEST_CASE("forces follow a bridge whose port changes, but no older datagram") {
  RunningServer running(kPatient);
  DatagramBridge bridge(running);
  const Bytes held_back = bridge.channel->probe();
  bridge.say(1);
  RawDatagrams renewed;
  renewed.send(bridge.sample(2), bridge.port);
  REQUIRE(running.next_input().sample.sequence == 2);
  bridge.check_force(2, renewed);
  bridge.udp.send(held_back, bridge.port);
  REQUIRE(renewed.receive());  // the answer to the probe
  bridge.check_force(2, renewed);
  CHECK_FALSE(bridge.udp.any());
}

TEST_CASE("a datagram that opens and breaks the protocol ends the session") {
  const Bytes bad_part = {9, 1, 0, 0, 'I'};
  const int which = GENERATE(0, 1, 2);
  RunningServer running(kPatient);
  DatagramBridge bridge(running);
  Bytes datagram;
  if (which == 0) datagram = bridge.channel->seal(bad_part);
  if (which == 1) datagram = bridge.channel->seal(ForceMessage{}, 1);  // only a server sends it
  if (which == 2) datagram = bridge.channel->seal(SampleMessage{.stylus = 3}, 1);
  bridge.udp.send(datagram, bridge.port);
  const auto goodbye = bridge.tcp.receive_as<Goodbye>();
  REQUIRE(goodbye);
  CHECK(goodbye->reason == GoodbyeReason::kProtocolError);
  CHECK(running.server.stats().protocol_errors == 1);
  running.check_serves();
}

TEST_CASE("a bridge that sends parts of messages without end is sent away, and costs no memory") {
  NetworkSettings settings = kPatient;
  settings.max_frame_rate = 1000;
  RunningServer running(settings);
  DatagramBridge bridge(running);
  Bytes part(kPartHeaderSize + kLargestPart, 1);
  part[0] = 0;
  part[1] = 4;
  const NetworkStats& stats = running.server.stats();
  for (int i = 0; i < 10'000 && stats.too_fast == 0; ++i) {
    bridge.udp.send(bridge.channel->seal(part), bridge.port);
  }
  CHECK(eventually([&] { return stats.too_fast == 1; }));
  CHECK(bridge.tcp.ends());
}

#ifndef IRDM_SANITIZED  // a sanitizer keeps what was freed
TEST_CASE("100 MB of datagrams add at most 8 MiB of memory", "[slow]") {
  constexpr std::size_t kAll = 100'000'000;
  constexpr std::size_t kAllowed = 8u << 20;
  NetworkSettings settings = kPatient;
  settings.max_frame_rate = 1'000'000'000;
  RunningServer running(settings);
  DatagramBridge bridge(running);
  bridge.say(1);
  std::mt19937 random(4);
  Bytes garbage(1400);
  Bytes part(kPartHeaderSize + kLargestPart, 1);  // of a message that is never whole
  part[0] = 0;
  part[1] = 4;
  const NetworkStats& stats = running.server.stats();
  const std::size_t before = resident();
  std::size_t most = before;
  std::size_t turn = 0;
  for (std::size_t sent = 0; sent < kAll; sent += garbage.size(), ++turn) {
    if (turn % 2 == 0) {
      for (std::uint8_t& byte : garbage) byte = static_cast<std::uint8_t>(random());
      bridge.udp.send(garbage, bridge.port);
    } else {
      bridge.udp.send(bridge.channel->seal(part), bridge.port);
    }
    // The kernel keeps few of them.
    if (turn % 50 != 49) continue;
    REQUIRE(eventually([&] { return stats.datagrams + dropped(stats) > turn; }));
    most = std::max(most, resident());
  }
  bridge.say(2);
  most = std::max(most, resident());
  CHECK(most - before <= kAllowed);
}
#endif

TEST_CASE("datagrams are offered to those who ask, by a real-time server that has them") {
  NetworkSettings settings = kPatient;
  const bool udp = GENERATE(true, false);
  const bool lockstep = GENERATE(true, false);
  settings.udp = udp;
  settings.lockstep = lockstep;
  RunningServer running(settings);
  RawPeer peer = running.connect();
  peer.send(Hello{.capabilities = kCapabilityDatagrams, .lockstep = true});
  const auto welcome = peer.receive_as<Welcome>();
  REQUIRE(welcome);
  CHECK((welcome->capabilities == kCapabilityDatagrams) == (udp && !lockstep));
  peer.close();
  REQUIRE(eventually([&] {  // its stylus is free again
    RawPeer other = running.connect();
    other.send(Hello{.lockstep = true});
    const auto plain = other.receive_as<Welcome>();
    return plain && plain->capabilities == 0;
  }));
}

TEST_CASE("a port that another program has for UDP is said so") {
  NetworkSettings settings = kPatient;
  settings.udp = false;
  std::unique_ptr<RawDatagrams> other;
  const bool free_for_tcp = eventually([&] {  // it may be another test's
    other = std::make_unique<RawDatagrams>();
    settings.port = other->port();
    try {
      const NetworkServer without_datagrams(settings);
      return true;
    } catch (const Error&) {
      return false;
    }
  });
  REQUIRE(free_for_tcp);
  settings.udp = true;
  CHECK_THROWS_WITH(NetworkServer(settings),
                    Catch::Matchers::ContainsSubstring("cannot listen for datagrams") &&
                        Catch::Matchers::ContainsSubstring("server.udp = false"));
}

TEST_CASE("a datagram of no parts that is no probe ends the session") {
  RunningServer running(kPatient);
  DatagramBridge bridge(running);
  bridge.say(1);
  Bytes text(wire::kPartHeaderSize + 20, 0);
  text.back() = 1;
  bridge.udp.send(bridge.channel->seal(std::span<const std::uint8_t>(text)), bridge.port);
  CHECK(bridge.tcp.ends());
  CHECK(eventually([&] { return running.server.stats().protocol_errors == 1; }));
}
