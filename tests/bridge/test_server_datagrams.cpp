// A bridge's stream by datagrams: with the real server, and with one that the test speaks for.
#include <memory>
#include <optional>

#include "common/wire/secret_key.hpp"
#include "device_bridge/network_client.hpp"
#include "server/network/network_server.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/raw_datagrams.hpp"
#include "tests/support/raw_peer.hpp"

using namespace irdm;
using namespace irdm::test;
using namespace irdm::wire;

namespace {

using Bytes = std::vector<std::uint8_t>;

ClientSettings patient(std::uint16_t port) {
  return {.server = {"127.0.0.1", port}, .udp = true, .silence_timeout_ms = 60'000};
}

std::optional<SecretKey> key_of(bool keyed) {
  if (!keyed) return std::nullopt;
  SecretKey key;
  key.fill(7);
  return key;
}

/// The real ends.
class RealEnds {
 public:
  RealEnds(bool keyed, bool udp)
      : server({.absent_after_ms = 60'000,
                .silence_timeout_ms = 60'000,
                .key = key_of(keyed),
                .udp = udp}),
        link(1),
        client(link, settings(keyed), gave_up) {
    server.start();
    client.start();
  }
  /// A sample goes there and its force comes back.
  bool exchange(std::uint64_t sequence) {
    link.styluses[0].sample.put({.sequence = sequence});
    link.samples_ready.signal();
    StylusPort& port = server.port(0);
    const auto arrived = [&] {
      return port.in.receive() && port.in.front().sample.sequence == sequence;
    };
    if (!eventually(arrived)) return false;
    port.out.put({.force_step = sequence, .sample_sequence = sequence});
    server.forces_ready().signal();
    return eventually([&] {
      link.styluses[0].input.receive();
      return link.styluses[0].input.front().force.sample_sequence == sequence &&
             link.styluses[0].input.front().any_force;
    });
  }
  bool linked() {
    link.state.receive();
    return link.state.front().linked;
  }

 private:
  ClientSettings settings(bool keyed) {
    ClientSettings made = patient(server.port_number());
    made.key = key_of(keyed);
    return made;
  }

 public:
  NetworkServer server;
  ServoLink link;
  EventFd gave_up;
  NetworkClient client;
};

/// A client, and a server that the test speaks for.
class ScriptedServer {
 public:
  ScriptedServer() : link(1) {
    client.emplace(link, patient(listener.port()), gave_up);
    client->start();
  }
  /// As the server of a session, up to its offer.
  RawPeer offer(std::uint16_t port) {
    RawPeer peer = listener.accept();
    const auto hello = peer.receive_as<Hello>();
    REQUIRE(hello);
    CHECK((hello->capabilities & kCapabilityDatagrams) != 0);
    peer.session = 5;
    peer.send(Welcome{
        .capabilities = kCapabilityDatagrams | kCapabilityContactModel, .session = 5, .dt = 0.002});
    Datagrams message{.port = port};
    message.random = random_material();
    peer.send(message);
    channel = std::make_unique<RawChannel>(keys_of(message.random), DatagramEnd::kServer, 5);
    REQUIRE(eventually([&] {
      link.state.receive();
      return link.state.front().linked;
    }));
    return peer;
  }
  void give(std::uint64_t sequence) {
    link.styluses[0].sample.put({.sequence = sequence});
    link.samples_ready.signal();
  }
  const ServoInput& input() {
    link.styluses[0].input.receive();
    return link.styluses[0].input.front();
  }
  /// The client's first probe; its port is in `socket` then.
  void await_probe(RawDatagrams& socket) const {
    const std::optional<Bytes> probe = socket.receive();
    REQUIRE(probe);
    const DatagramChannel::Opened opened = channel->channel.open(*probe);
    REQUIRE(opened.verdict == DatagramVerdict::kOpened);
    CHECK(is_probe(opened.text));
    CHECK(probe->size() == kLargestDatagram);
  }
  /// Gives samples until one comes by datagram.
  SampleMessage await_sample(RawDatagrams& socket) {
    give(++given);
    const std::optional<Frame> frame = channel->receive(socket);
    REQUIRE(frame);
    REQUIRE(std::holds_alternative<SampleMessage>(frame->message));
    return std::get<SampleMessage>(frame->message);
  }

  RawListener listener;
  ServoLink link;
  EventFd gave_up;
  std::optional<NetworkClient> client;
  std::unique_ptr<RawChannel> channel;
  std::uint64_t given = 0;
};

}  // namespace

TEST_CASE("samples and forces go by datagrams, with keys from the session, in TLS or not") {
  const bool keyed = GENERATE(false, true);
  CAPTURE(keyed);
  RealEnds ends(keyed, true);
  REQUIRE(eventually([&] { return ends.linked(); }));
  const NetworkStats& stats = ends.server.stats();
  std::uint64_t sequence = 0;
  // By TCP, until datagrams are known to get through.
  REQUIRE(eventually([&] { return stats.datagrams > 0 && ends.exchange(++sequence); }));
  const std::uint64_t before = stats.datagrams;
  for (int i = 0; i < 500; ++i) REQUIRE(ends.exchange(++sequence));
  CHECK(stats.datagrams - before > 400);
  ends.client.stop(true);
  const ClientReport& report = ends.client.report();
  CHECK(report.datagram_sessions == 1);
  CHECK(report.datagrams > 400);
  CHECK(report.datagrams_dropped == 0);
  CHECK(report.protocol_errors == 0);
  CHECK(report.sessions == 1);
  CHECK(stats.protocol_errors == 0);
  CHECK(stats.datagrams_forged == 0);
}

TEST_CASE("with a server without datagrams the stream goes by TCP") {
  RealEnds ends(false, false);
  REQUIRE(eventually([&] { return ends.linked(); }));
  for (std::uint64_t sequence = 1; sequence < 100; ++sequence) REQUIRE(ends.exchange(sequence));
  ends.client.stop(true);
  CHECK(ends.client.report().datagram_sessions == 0);
  CHECK(ends.client.report().sessions == 1);
  CHECK(ends.server.stats().datagrams == 0);
}

TEST_CASE("where no datagram comes back the stream stays with TCP") {
  ScriptedServer server;
  RawDatagrams silent;
  RawPeer peer = server.offer(silent.port());
  for (int i = 0; i < 3; ++i) server.await_probe(silent);
  for (std::uint64_t sequence = 1; sequence < 10; ++sequence) {
    server.give(sequence);
    const auto sample = peer.receive_as<SampleMessage>();
    REQUIRE(sample);
    CHECK(sample->sample.sequence == sequence);
  }
  // It gives up: its socket is closed, and nobody asks any more.
  const std::uint16_t client = silent.sender();
  REQUIRE(eventually([&] { return RawDatagrams::is_free(client); }));
  while (silent.any()) {
    silent.receive();
    CHECK(silent.sender() == client);
  }
  server.give(10);
  REQUIRE(peer.receive_as<SampleMessage>());
  // What comes too late changes nothing.
  silent.send(server.channel->probe(), client);
  server.give(11);
  REQUIRE(peer.receive_as<SampleMessage>());
  server.client->stop();
  CHECK(server.client->report().datagram_sessions == 0);
}

TEST_CASE("forged, replayed and foreign datagrams tell a bridge nothing") {
  ScriptedServer server;
  RawDatagrams udp;
  RawPeer peer = server.offer(udp.port());
  server.await_probe(udp);
  const std::uint16_t client = udp.sender();
  RawDatagrams elsewhere;
  RawDatagrams far("127.0.0.2");
  RawChannel forger(keys_of(random_material()), DatagramEnd::kServer, 5);
  const auto force = [&](RawChannel& from, std::uint64_t step, std::uint64_t frame) {
    return from.seal(
        ForceMessage{
            .force = {.force_step = step, .sample_sequence = 1, .force = Vector3(0, 1, 0)}},
        frame);
  };
  udp.send(server.channel->probe(), client);
  CHECK(server.await_sample(udp).sample.sequence == 1);
  const Bytes good = force(*server.channel, 3, 10);
  udp.send(good, client);
  REQUIRE(eventually([&] { return server.input().force.force_step == 3; }));
  for (std::uint64_t i = 0; i < 20; ++i) {
    udp.send(good, client);
    udp.send(force(forger, 100, 1000), client);
    far.send(force(*server.channel, 100, 1000), client);
    elsewhere.send(force(*server.channel, 100, 1000), client);
    udp.send(Bytes(i, 1), client);
  }
  udp.send(force(*server.channel, 4, 9), client);  // late: after a newer frame
  udp.send(force(*server.channel, 5, 11), client);
  REQUIRE(eventually([&] { return server.input().force.force_step != 3; }));
  CHECK(server.input().force.force_step == 5);
  server.client->stop();
  const ClientReport& report = server.client->report();
  CHECK(report.forces == 2);
  CHECK(report.datagrams_dropped == 60);
  CHECK(report.protocol_errors == 0);
}

TEST_CASE("a datagram of the server that breaks the protocol ends the session") {
  ScriptedServer server;
  RawDatagrams udp;
  RawPeer peer = server.offer(udp.port());
  server.await_probe(udp);
  udp.send(server.channel->seal(SampleMessage{}, 1), udp.sender());  // only a bridge sends it
  CHECK(peer.receive_as<Goodbye>());
  CHECK(peer.ends());
  server.client->stop();
  CHECK(server.client->report().protocol_errors == 1);
}

TEST_CASE("an offer of datagrams that was not asked for, or a second one, is an error") {
  const bool second = GENERATE(false, true);
  ScriptedServer server;
  RawDatagrams udp;
  std::optional<RawPeer> peer(server.offer(udp.port()));
  if (!second) {
    peer.reset();
    peer.emplace(server.listener.accept());
    REQUIRE(peer->receive_as<Hello>());
    peer->send(Welcome{.session = 6, .dt = 0.002});
  }
  peer->send(Datagrams{.port = udp.port()});
  CHECK(eventually([&] {
    const std::optional<Frame> frame = peer->receive();
    return !frame || std::holds_alternative<Goodbye>(frame->message);
  }));
  server.client->stop();
  CHECK(server.client->report().protocol_errors == 1);
}

TEST_CASE("applied forces by datagram are cut to what one of them holds") {
  ScriptedServer server;
  RawDatagrams udp;
  RawPeer peer = server.offer(udp.port());
  server.await_probe(udp);
  udp.send(server.channel->probe(), udp.sender());
  server.await_sample(udp);
  OfSession<AppliedForces> forces{server.link.state.front().sessions, {}};
  forces.value.count = AppliedForces::kSteps;
  forces.value.step = 50;
  for (AppliedForce& each : forces.value.past) each.force = each.tip = each.arm = Vector3::Ones();
  server.link.styluses[0].applied.put(forces);
  server.link.samples_ready.signal();
  const std::optional<Frame> frame = server.channel->receive(udp);
  REQUIRE(frame);
  const auto* applied = std::get_if<AppliedForcesMessage>(&frame->message);
  REQUIRE(applied != nullptr);
  CHECK(applied->applied.count == kForcesInDatagram);
  CHECK(applied->applied.step == 50);
}
