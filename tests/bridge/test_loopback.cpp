#include <atomic>
#include <chrono>
#include <limits>
#include <optional>
#include <sstream>
#include <thread>
#include <vector>

#include "device_bridge/network_client.hpp"
#include "device_bridge/servo_thread.hpp"
#include "device_bridge/virtual_stylus.hpp"
#include "server/network/network_server.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kWall = 200.0;  // [N/m]

/// A server whose force step is a soft wall at y = 0: it answers every sample.
class WallServer {
 public:
  explicit WallServer(const NetworkSettings& settings)
      : network(settings), lockstep_(settings.lockstep) {
    lockstep_ ? network.open() : network.start();
    thread_ = std::thread([this] { run(); });
  }
  ~WallServer() {
    stop_ = true;
    thread_.join();
    network.stop();
  }

  NetworkServer network;
  std::vector<double> heights;  ///< of every sample answered; read it after the end of the bridge

 private:
  void run() {
    StylusPort& port = network.port(0);
    std::uint64_t step = 0;
    while (!stop_) {
      lockstep_ ? network.serve() : std::this_thread::sleep_for(std::chrono::microseconds(200));
      if (!port.in.receive() || !port.in.front().present) continue;
      const StylusSample& sample = port.in.front().sample;
      heights.push_back(sample.tip.y());
      port.out.put({.force_step = step++,
                    .sample_sequence = sample.sequence,
                    .sample_time_ns = sample.time_ns,
                    .force = Vector3(0, std::max(0.0, -kWall * sample.tip.y()), 0)});
      if (!lockstep_) network.forces_ready().signal();
    }
  }
  const bool lockstep_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// A stylus whose last force can be read from outside.
class WatchedStylus : public VirtualStylus {
 public:
  using VirtualStylus::VirtualStylus;
  void write(const Wrench& wrench) noexcept override {
    shown = wrench.force.norm();
    VirtualStylus::write(wrench);
  }
  std::atomic<double> shown{0.0};
};

/// The bridge without its main: device, servo thread and client.
class Bridge {
 public:
  Bridge(const std::string& script, std::uint16_t port, double duration)
      : device_(parse(script), HandParameters{}),
        link_(1),
        client_(link_, {.server = {"127.0.0.1", port}, .predict = false}, done_) {
    loops_.emplace_back(device_, FilterLimits{});
    servo_.emplace(link_, loops_, ServoSettings{.duration = duration}, done_);
    client_.start();
    servo_->start();
  }
  bool wait() { return done_.wait(kDeadlineMs); }
  void stop() {
    servo_->stop();
    client_.stop(servo_->report().end == ServoEnd::kFinished);
  }
  double shown() const { return device_.shown; }
  const ServoReport& servo() const { return servo_->report(); }
  const ClientReport& client() const { return client_.report(); }
  double peak_force() const { return loops_[0].peak_force(); }

 private:
  static StylusScript parse(const std::string& rows) {
    std::istringstream text("time,x,y,z\n" + rows);
    return StylusScript::parse(text, "motion.csv");
  }
  EventFd done_;
  WatchedStylus device_;
  std::vector<ServoLoop> loops_;
  ServoLink link_;
  NetworkClient client_;
  std::optional<ServoThread> servo_;
};

const std::string kPress = "0,0,0.01,0\n0.1,0,-0.01,0\n0.3,0,-0.01,0\n0.4,0,0.01,0\n";
const std::string kHold = "0,0,-0.01,0\n";
constexpr double kForever = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("a bridge in real time feels the server's wall and ends in order") {
  WallServer server({});
  Bridge bridge(kPress, server.network.port_number(), 0.4);
  REQUIRE(bridge.wait());
  bridge.stop();
  CHECK(bridge.servo().end == ServoEnd::kFinished);
  CHECK_FALSE(bridge.servo().lockstep);
  CHECK(bridge.servo().ticks > 10);
  CHECK(bridge.client().forces > 10);
  CHECK(bridge.client().round_trip.count() > 0);
  CHECK(bridge.peak_force() > 0.5);
  CHECK(bridge.shown() == 0.0);
  CHECK(server.network.stats().goodbyes == 1);
}

TEST_CASE("two lockstep runs are the same to the bit, step for step") {
  std::vector<std::vector<double>> runs;
  double peak = 0.0;
  for (int run = 0; run < 2; ++run) {
    WallServer server({.dt = 0.002, .lockstep = true});
    Bridge bridge(kPress, server.network.port_number(), 0.4);
    REQUIRE(bridge.wait());
    bridge.stop();
    CHECK(bridge.servo().end == ServoEnd::kFinished);
    CHECK(bridge.servo().lockstep);
    CHECK(bridge.servo().ticks == 200);
    CHECK(bridge.client().forces == 200);
    CHECK(bridge.client().gaps == 0);
    CHECK(server.network.stats().goodbyes == 1);
    CHECK(server.network.stats().samples_old == 0);
    CHECK(server.network.stats().forces_replaced == 0);
    runs.push_back(server.heights);
    peak = bridge.peak_force();
  }
  REQUIRE(runs[0].size() == 200);
  CHECK(runs[0] == runs[1]);
  // The hand of 300 N/m against the wall of 200 N/m: 1 cm is shared, 1.2 N in balance.
  CHECK(peak > 1.2);
}

TEST_CASE(
    "a lockstep sample is the state at the end of its step, with the last step's force held") {
  WallServer server({.dt = 0.002, .lockstep = true});
  Bridge bridge(kPress, server.network.port_number(), 0.4);
  REQUIRE(bridge.wait());
  bridge.stop();
  REQUIRE(server.heights.size() == 200);
  VirtualHand hand(HandParameters{}, Vector3(0, 0.01, 0));
  std::istringstream text("time,x,y,z\n" + kPress);
  const StylusScript script = StylusScript::parse(text, "motion.csv");
  Vector3 force = Vector3::Zero();
  for (int k = 0; k < 200; ++k) {
    for (int tick = 1; tick <= 2; ++tick) {
      hand.advance(0.001, script.at(0.002 * k + 0.001 * tick).tip, force);
    }
    REQUIRE(std::abs(server.heights[static_cast<std::size_t>(k)] - hand.position().y()) < 1e-9);
    force.y() = std::max(0.0, -kWall * hand.position().y());
  }
}

TEST_CASE("a bridge whose server dies shows no force, and feels again when one is back") {
  std::optional<WallServer> server;
  server.emplace(NetworkSettings{});
  const std::uint16_t port = server->network.port_number();
  Bridge bridge(kHold, port, kForever);
  REQUIRE(eventually([&] { return bridge.shown() > 0.5; }));
  server.reset();
  REQUIRE(eventually([&] { return bridge.shown() == 0.0; }));
  server.emplace(NetworkSettings{.port = port});
  REQUIRE(eventually([&] { return bridge.shown() > 0.5; }));
  bridge.stop();
  CHECK(bridge.servo().end == ServoEnd::kStopped);
  CHECK(bridge.client().sessions >= 2);
  CHECK(bridge.shown() == 0.0);
}

TEST_CASE("a bridge waits for a server that comes later, at the script's first position") {
  std::uint16_t port = 0;
  {
    NetworkServer reserve({});
    port = reserve.port_number();
  }
  Bridge bridge(kPress, port, 0.4);
  WallServer server({.port = port});
  REQUIRE(bridge.wait());
  bridge.stop();
  CHECK(bridge.servo().end == ServoEnd::kFinished);
  REQUIRE_FALSE(server.heights.empty());
  CHECK(std::abs(server.heights.front() - 0.01) < 2e-3);
}

TEST_CASE("a lockstep bridge ends when its server goes") {
  std::optional<WallServer> server;
  server.emplace(NetworkSettings{.lockstep = true});
  Bridge bridge(kHold, server->network.port_number(), kForever);
  REQUIRE(eventually([&] { return server->network.stats().samples > 10; }));
  server.reset();
  REQUIRE(bridge.wait());
  bridge.stop();
  CHECK(bridge.servo().end == ServoEnd::kServerEnded);
  CHECK(bridge.client().failure.empty());
}

TEST_CASE("a lockstep run that is stopped because the server ended says that the server ended") {
  const bool server_ended = GENERATE(true, false);
  std::istringstream text("time,x,y,z\n" + kHold);
  VirtualStylus device(StylusScript::parse(text, "motion.csv"), HandParameters{});
  std::vector<ServoLoop> loops;
  loops.emplace_back(device, FilterLimits{});
  ServoLink link(1);
  EventFd done;
  ServoThread servo(link, loops, {.duration = kForever}, done);
  LinkState state{.linked = true, .sessions = 1, .lockstep = true, .dt = 0.002};
  link.state.put(state);
  servo.start();
  REQUIRE(eventually([&] { return link.styluses[0].sample.receive(); }));
  // No news: the servo sees both in the same look.
  state.linked = false;
  state.server_ended = server_ended;
  link.state.put(state);
  servo.stop();
  CHECK(servo.report().end == (server_ended ? ServoEnd::kServerEnded : ServoEnd::kLinkLost));
}
