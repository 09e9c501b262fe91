#include <optional>
#include <string>

#include "common/error.hpp"
#include "device_bridge/network_client.hpp"
#include "server/network/network_server.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/raw_peer.hpp"

using namespace irdm;
using namespace irdm::test;
using Catch::Matchers::ContainsSubstring;

namespace {

wire::SecretKey key_of(std::uint8_t byte) {
  wire::SecretKey key;
  key.fill(byte);
  return key;
}

/// A server, and a client of it, each with or without a key.
class Link {
 public:
  using Key = std::optional<wire::SecretKey>;
  Link(const Key& servers, const Key& clients)
      : server({.absent_after_ms = 60'000, .silence_timeout_ms = 60'000, .key = servers}),
        link(1),
        client(link,
               {.server = {"127.0.0.1", server.port_number()},
                .silence_timeout_ms = 60'000,
                .key = clients},
               gave_up) {
    server.start();
    client.start();
  }
  bool linked() {
    link.state.receive();
    return link.state.front().linked;
  }

  NetworkServer server;
  ServoLink link;
  EventFd gave_up;
  NetworkClient client;
};

}  // namespace

TEST_CASE("with the server's key samples and forces go both ways") {
  Link both(key_of(1), key_of(1));
  REQUIRE(eventually([&] { return both.linked(); }));
  constexpr std::uint64_t kSamples = 1000;
  for (std::uint64_t sequence = 0; sequence < kSamples; ++sequence) {
    both.link.styluses[0].sample.put({.sequence = sequence, .tip = Vector3(1, 2, 3)});
    both.link.samples_ready.signal();
    StylusPort& port = both.server.port(0);
    REQUIRE(eventually(
        [&] { return port.in.receive() && port.in.front().sample.sequence == sequence; }));
    CHECK(port.in.front().sample.tip == Vector3(1, 2, 3));
    port.out.put({.force_step = sequence, .sample_sequence = sequence, .force = Vector3(4, 5, 6)});
    both.server.forces_ready().signal();
    TripleBuffer<ServoInput>& input = both.link.styluses[0].input;
    const auto answered = [&] {
      input.receive();
      return input.front().any_force && input.front().force.force_step == sequence;
    };
    while (!answered()) REQUIRE(both.link.news.wait(kDeadlineMs));
    CHECK(input.front().force.force == Vector3(4, 5, 6));
  }
  both.client.stop(true);
  CHECK(both.client.report().sessions == 1);
  CHECK(both.server.stats().goodbyes == 1);
  CHECK(both.server.stats().wrong_keys == 0);
}

TEST_CASE("a client with another key gives up, and the server counts it") {
  Link both(key_of(1), key_of(2));
  REQUIRE(both.gave_up.wait(kDeadlineMs));
  both.client.stop();
  CHECK(both.client.report().sessions == 0);
  CHECK_THAT(both.client.report().failure,
             ContainsSubstring("no TLS with this key") && ContainsSubstring("the same key file"));
  CHECK(eventually([&] { return both.server.stats().wrong_keys == 1; }));
  CHECK(both.server.stats().accepted == 0);
}

TEST_CASE("a client with a key gives up on a server without") {
  Link both(std::nullopt, key_of(1));
  REQUIRE(both.gave_up.wait(kDeadlineMs));
  both.client.stop();
  CHECK_THAT(both.client.report().failure, ContainsSubstring("the same key file"));
  CHECK(both.server.stats().accepted == 0);
  CHECK(both.server.stats().protocol_errors == 1);
}

TEST_CASE("a client without a key is not let in by a server with one") {
  Link both(key_of(1), std::nullopt);
  REQUIRE(eventually([&] { return both.server.stats().wrong_keys >= 2; }));  // it tries again
  both.client.stop();
  CHECK(both.client.report().sessions == 0);
  CHECK(both.server.stats().accepted == 0);
}

TEST_CASE("garbage and silence to a server with a key are sent away, and it serves on") {
  NetworkServer server({.handshake_timeout_ms = 50, .key = key_of(1)});
  server.start();
  {
    RawPeer noise = RawPeer::connect(server.port_number());
    noise.send(std::vector<std::uint8_t>(100'000, 0x55));
    CHECK(noise.ends());
    RawPeer silent = RawPeer::connect(server.port_number());
    CHECK(silent.ends());
  }
  CHECK(server.stats().wrong_keys == 1);
  CHECK(server.stats().timeouts == 1);
  ServoLink link(1);
  EventFd gave_up;
  NetworkClient client(link, {.server = {"127.0.0.1", server.port_number()}, .key = key_of(1)},
                       gave_up);
  client.start();
  CHECK(eventually([&] { return server.stats().accepted == 1; }));
}

TEST_CASE("beyond this machine nobody listens or connects without a key") {
  CHECK_THROWS_WITH(NetworkServer({.address = "0.0.0.0"}),
                    ContainsSubstring("can be reached from other machines") &&
                        ContainsSubstring("server.key_file"));
  CHECK_THROWS_WITH(NetworkServer({.address = "::"}), ContainsSubstring("server.key_file"));
  CHECK_NOTHROW(NetworkServer({.address = "0.0.0.0", .key = key_of(1)}));
  CHECK_NOTHROW(NetworkServer({.address = "127.0.0.2"}));
  ServoLink link(1);
  EventFd gave_up;
  ClientSettings far;
  far.server = {"192.0.2.1", 4711};
  CHECK_THROWS_WITH(NetworkClient(link, far, gave_up), ContainsSubstring("bridge.key_file"));
  ClientSettings with_key = far;
  with_key.key = key_of(1);
  CHECK_NOTHROW(NetworkClient(link, with_key, gave_up));
}
