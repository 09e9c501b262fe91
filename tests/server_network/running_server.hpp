#pragma once

#include <unistd.h>

#include <cstdint>
#include <fstream>
#include <limits>

#include "server/network/network_server.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/raw_peer.hpp"

namespace irdm::test {

inline constexpr int kNever = 3'600'000;  ///< [ms]
/// Nobody has to hurry.
inline const NetworkSettings kPatient{.styluses = 1,
                                      .handshake_timeout_ms = kNever,
                                      .absent_after_ms = kNever,
                                      .yield_after_ms = kNever,
                                      .silence_timeout_ms = kNever};

/// Memory of this process [byte].
inline std::size_t resident() {
  std::ifstream file("/proc/self/statm");
  std::size_t all = 0, pages = 0;
  file >> all >> pages;
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

/// Sample k as lockstep has it, with the dt of the settings' default.
inline StylusSample lockstep_sample(std::uint64_t k) {
  return {.sequence = k, .time_ns = static_cast<std::int64_t>(k + 1) * 2'000'000};
}

/// A server on a free port, and what the tests of it do again and again.
class RunningServer {
 public:
  explicit RunningServer(const NetworkSettings& settings = {}) : server(settings) {
    server.start();
  }

  RawPeer connect() { return RawPeer::connect(server.port_number()); }
  /// Connects and shakes hands.
  RawPeer join(std::uint16_t styluses = 1) {
    RawPeer peer = connect();
    peer.send(wire::Hello{.styluses = styluses, .lockstep = true, .name = "test"});
    REQUIRE(peer.receive_as<wire::Welcome>());
    return peer;
  }
  /// Waits for the next input of a stylus.
  StylusInput next_input(int stylus = 0) {
    StylusPort& port = server.port(stylus);
    REQUIRE(eventually([&] { return port.in.receive(); }));
    return port.in.front();
  }
  void give(const StylusForce& force, int stylus = 0) {
    server.port(stylus).out.put(force);
    server.forces_ready().signal();
  }
  /// That the server still serves: a whole exchange with a new peer.
  void check_serves() {
    RawPeer peer = join();
    peer.send(wire::Goodbye{});
    CHECK(peer.ends());
  }

  NetworkServer server;
};

}  // namespace irdm::test
