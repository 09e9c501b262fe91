// How long after the path is back a bridge feels the server again: the time from then to the first
// force that answers a sample taken after it. 1000 samples a second; on the loopback address, and,
// where network namespaces are to be had, between two of them, with TLS: there a cut path is a
// black hole, which takes all packets and says nothing.
//   bench_reconnect [CUTS]      200 of each kind unless given
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "bench/frame_relay.hpp"
#include "common/error.hpp"
#include "common/program/stop_signal.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/histogram.hpp"
#include "device_bridge/network_client.hpp"
#include "server/network/network_server.hpp"
#include "tests/network_namespace/packet_relay.hpp"
#include "tests/network_namespace/two_namespaces.hpp"
#include "tests/support/child_process.hpp"

using namespace irdm;

namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kLookNs = 50'000;  // how often the server looks for a sample
const std::string kLoopback = "127.0.0.1";

constexpr wire::SecretKey kKey = {1, 2, 3};  // beyond the loopback address

/// A server that answers every sample at once, until it is killed.
int serve(std::uint16_t port, const std::string& address) {
  NetworkSettings settings{.address = address, .port = port, .styluses = 1};
  if (address != kLoopback) settings.key = kKey;
  NetworkServer server(settings);
  server.start();
  std::cout << "listening on " << server.port_number() << std::endl;
  std::uint64_t step = 0;
  for (;;) {
    StylusPort& stylus = server.port(0);
    sleep_until(monotonic_ns() + kLookNs);
    if (!stylus.in.receive() || !stylus.in.front().present) continue;
    const StylusSample& sample = stylus.in.front().sample;
    stylus.out.put({.force_step = step++,
                    .sample_sequence = sample.sequence,
                    .sample_time_ns = sample.time_ns});
    server.forces_ready().signal();
  }
}

/// A bridge whose stylus stands still.
class Bridge {
 public:
  explicit Bridge(std::uint16_t port, const std::string& address = kLoopback)
      : link_(1), client_(link_, settings(port, address), gave_up_) {
    client_.start();
  }
  void tick() {
    sleep_until(schedule_.next(monotonic_ns()));
    link_.styluses[0].sample.put({.sequence = sequence_++, .time_ns = monotonic_ns()});
    link_.samples_ready.signal();
    link_.styluses[0].input.receive();
  }
  void run_until(std::int64_t end_ns) {
    while (monotonic_ns() < end_ns) tick();
  }
  /// Until a force answers a sample of `since_ns` or later; returns when it did [ns].
  std::int64_t feel(std::int64_t since_ns) {
    for (;;) {
      tick();
      const ServoInput& input = link_.styluses[0].input.front();
      if (input.linked && input.any_force && input.force.sample_time_ns >= since_ns) {
        return monotonic_ns();
      }
    }
  }

 private:
  static ClientSettings settings(std::uint16_t port, const std::string& address) {
    ClientSettings settings{.server = {address, port}};
    if (address != kLoopback) settings.key = kKey;
    return settings;
  }

  ServoLink link_;
  EventFd gave_up_;
  NetworkClient client_;
  PeriodicSchedule schedule_{monotonic_ns(), kMillisecond};
  std::uint64_t sequence_ = 0;
};

std::vector<std::string> serve_command(const char* self, std::uint16_t port,
                                       const std::string& address = kLoopback) {
  return {self, "serve", std::to_string(port), address};
}

test::ChildProcess start_server(const std::vector<std::string>& command, std::uint16_t& listens) {
  test::ChildProcess server(command);
  const std::string line = server.line_with("listening on ");
  listens = static_cast<std::uint16_t>(std::stoi(line.substr(line.rfind(' '))));
  return server;
}

void print(const char* what, const Histogram& times) {
  const auto ms = [](std::int64_t ns) {
    return static_cast<double>(ns) / static_cast<double>(kMillisecond);
  };
  std::printf("| %s | %llu | %.1f | %.1f | %.1f |\n", what,
              static_cast<unsigned long long>(times.count()), ms(times.percentile(0.5)),
              ms(times.percentile(0.95)), ms(times.maximum()));
}

/// @param longest that the path is cut [ms]; at least a tenth of it
template <typename Path>
Histogram cut_and_mend(Bridge& bridge, Path& relay, int cuts, int longest) {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::int64_t> length(longest / 10, longest);
  Histogram times;
  for (int i = 0; i < cuts; ++i) {
    bridge.run_until(bridge.feel(monotonic_ns()) + 50 * kMillisecond);
    relay.cut();
    bridge.run_until(monotonic_ns() + length(random) * kMillisecond);
    relay.mend();
    const std::int64_t back_ns = monotonic_ns();
    times.add(bridge.feel(back_ns) - back_ns);
  }
  return times;
}

/// Takes nothing while it is cut; bytes wait until it is mended.
class CutPath {
 public:
  explicit CutPath(std::uint16_t port) : relay_(port, 0) {}
  std::uint16_t port() const noexcept { return relay_.port(); }
  void cut() noexcept { relay_.set(RelayFault::kBlackHole); }
  void mend() noexcept { relay_.set(RelayFault::kNone); }

 private:
  FrameRelay relay_;
};

Histogram cut_path(const char* self, int cuts, int longest) {
  std::uint16_t port = 0;
  const test::ChildProcess server = start_server(serve_command(self, 0), port);
  CutPath relay(port);
  Bridge bridge(relay.port());
  return cut_and_mend(bridge, relay, cuts, longest);
}

/// Packets are gone.
Histogram black_hole(const test::TwoNamespaces& both, const char* self, int cuts, int longest) {
  test::PacketRelay relay(both.devices(), {});
  std::uint16_t port = 0;
  const test::ChildProcess server =
      start_server(both.inside(0, serve_command(self, 0, both.address(0))), port);
  Bridge bridge(port, both.address(0));
  return cut_and_mend(bridge, relay, cuts, longest);
}

void print_black_holes(const char* self, int count) {
  const test::TwoNamespaces both;
  both.enter(1);
  print("black hole of 10 to 100 ms", black_hole(both, self, count, 100));
  print("black hole of 0.1 to 1 s", black_hole(both, self, count, 1000));
}

Histogram kill_server(const char* self, int kills) {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::int64_t> length(10, 500);
  std::uint16_t port = 0;
  std::optional<test::ChildProcess> server(start_server(serve_command(self, 0), port));
  Bridge bridge(port);
  Histogram times;
  for (int i = 0; i < kills; ++i) {
    bridge.run_until(bridge.feel(monotonic_ns()) + 50 * kMillisecond);
    server->signal(SIGKILL);
    server->wait();
    server.reset();
    bridge.run_until(monotonic_ns() + length(random) * kMillisecond);
    server.emplace(start_server(serve_command(self, port), port));
    const std::int64_t back_ns = monotonic_ns();
    times.add(bridge.feel(back_ns) - back_ns);
  }
  return times;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 4 && std::string(argv[1]) == "serve") {
    return serve(static_cast<std::uint16_t>(std::atoi(argv[2])), argv[3]);
  }
  const StopSignal ignores_pipes;
  const int count = argc > 1 ? std::atoi(argv[1]) : 200;
  std::printf(
      "| what | times | median [ms] | 95 %% | longest |\n| --- | --- | --- | --- | --- |\n");
  print("server killed and started again", kill_server(argv[0], count));
  print("path cut for 10 to 100 ms", cut_path(argv[0], count, 100));
  print("path cut for 0.1 to 1 s", cut_path(argv[0], count, 1000));
  try {
    print_black_holes(argv[0], count);
  } catch (const Error& error) {
    std::printf("black holes left out: %s\n", error.what());
  }
  return 0;
}
