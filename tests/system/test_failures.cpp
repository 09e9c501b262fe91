#include <chrono>
#include <csignal>

#include <algorithm>
#include <random>
#include <thread>

#include "common/error.hpp"
#include "common/hdf5/file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/committed_so_far.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/raw_peer.hpp"
#include "tests/system/one_session.hpp"
#include "tests/system/stage.hpp"
#include "tests/system/trace.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

constexpr std::uint8_t kFree = 0;
constexpr std::uint8_t kHeld = 2;

/// The row after the last one that is held.
std::size_t end_of_hold(const Trace& trace) {
  const auto last = std::find(trace.contact.rbegin(), trace.contact.rend(), kHeld);
  return static_cast<std::size_t>(trace.contact.rend() - last);
}

/// Horizontal distance of a tip from the axis that hold_and_circle() goes round [m].
double radius(const Vector3& tip) {
  return std::hypot(tip.x() - kCircleRadius, tip.z());
}

std::vector<std::uint8_t> noise(unsigned seed, std::size_t size) {
  std::mt19937 random(seed);
  std::vector<std::uint8_t> bytes(size);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

}  // namespace

TEST_CASE("a bridge is killed: its contact ends, the server goes on and takes the next one") {
  const Stage stage;
  if (!kKeepsPace) stage.hold_forces();
  stage.write("script.csv", hold_and_circle());
  const std::filesystem::path path = stage.path("trace.h5");
  Server server = stage.start_server({"--record", path.string()});
  ChildProcess bridge = stage.start_bridge(server);
  REQUIRE(eventually([&] { return rows_so_far(path, "contact", kHeld) > 100; }));
  bridge.signal(SIGKILL);
  CHECK(bridge.wait() == -SIGKILL);

  // The next one stays away from the cube.
  constexpr double kAway = 1.0;
  stage.write("script.csv", "time,x,y,z\n0,1.0,0,0\n0.3,1.0,0,0\n");
  ChildProcess next = stage.start_bridge(server);
  CHECK(next.wait() == 0);
  check_one_session(next.out());
  CHECK(number_after(next.out(), "forces: ") > 0);
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
  const double accepted = 2 + number_after(next.out(), ", stalls ");
  CHECK(number_after(server.process.out(), "sessions: ") == accepted);
  CHECK_THAT(server.process.out(), ContainsSubstring(" accepted, 0 refused, 0 closed"));

  const Trace trace = read_trace(path);
  const std::size_t end = end_of_hold(trace);
  REQUIRE(end > 100);
  REQUIRE(end < trace.rows());
  bool next_seen = false;
  for (std::size_t k = end; k < trace.rows(); ++k) {
    REQUIRE(trace.contact[k] == kFree);
    REQUIRE(trace.vector("/stylus/0/force", k).isZero(0.0));
    next_seen = next_seen || std::abs(trace.vector("/stylus/0/tip", k).x() - kAway) < 1e-3;
  }
  CHECK(next_seen);
}

TEST_CASE("a server is killed: the bridge shows no force meanwhile and finds the next one",
          "[slow]") {
  const Stage stage;
  stage.write("script.csv", hold_and_circle());
  // A hand that forgets within a few hundredths of a second, so that the place where it is when the
  // next server comes tells whether it felt something meanwhile.
  stage.write("bridge.toml",
              "[[device]]\nscript = \"script.csv\"\n"
              "hand = { mass = 0.02, damping = 10.0, stiffness = 300.0 }\n");
  Server first = stage.start_server({"--record", stage.path("first.h5").string()});
  ChildProcess bridge = stage.start_bridge(first);
  // Held, the cube pulls the hand outward.
  constexpr double kPulled = 0.0015;
  REQUIRE(eventually([&] { return rows_so_far(stage.path("first.h5"), "contact", kHeld) > 250; }));
  REQUIRE(eventually([&] {
    const auto tip = tip_so_far(stage.path("first.h5"));
    return tip && radius(*tip) > kCircleRadius + kPulled;
  }));
  first.process.signal(SIGKILL);
  CHECK(first.process.wait() == -SIGKILL);
  CHECK_THAT(bridge.line_with("connection lost", true), ContainsSubstring("trying again"));
  // Not to wait for anything: this is how long there is no server.
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  Server second = stage.restart_server(first.port, {"--record", stage.path("second.h5").string()});
  REQUIRE(eventually([&] { return rows_so_far(stage.path("second.h5"), "buttons", 1) > 0; }));
  bridge.signal(SIGTERM);
  CHECK(bridge.wait() == 0);
  second.process.signal(SIGTERM);
  CHECK(second.process.wait() == 0);
  CHECK_THAT(bridge.out(), ContainsSubstring("sessions 2, reconnects 1, protocol errors 0"));

  const Trace trace = read_trace(stage.path("second.h5"));
  const auto arrived = std::find(trace.buttons.begin(), trace.buttons.end(), 1);
  REQUIRE(arrived != trace.buttons.end());
  const auto k = static_cast<std::size_t>(arrived - trace.buttons.begin());
  CHECK(std::abs(radius(trace.vector("/stylus/0/tip", k)) - kCircleRadius) < 0.5 * kPulled);
}

TEST_CASE("a server that is killed while it records loses no step that it has committed",
          "[slow]") {
  const Stage stage;
  std::minstd_rand random(1);
  for (int i = 0; i < 12; ++i) {
    const auto path = stage.path("killed" + std::to_string(i) + ".h5");
    Server server = stage.start_server({"--record", path.string()});
    REQUIRE(eventually([&] { return committed_so_far(path) > 0; }));
    // Not to wait for anything: a kill comes at any moment.
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 100'000));
    server.process.signal(SIGKILL);
    CHECK(server.process.wait() == -SIGKILL);
    const hdf5::File file = hdf5::File::open(path);
    const std::uint64_t rows = file.read<std::uint64_t>("/committed", {1})[0];
    CHECK(rows > 0);
    REQUIRE(file.shape("/step/force_step")[0] >= rows);
    REQUIRE(file.shape("/stylus/0/buttons")[0] >= rows);
    std::vector<std::uint64_t> steps(rows);
    std::vector<double> orientations(4 * rows);
    file.read_slab<std::uint64_t>("/step/force_step", {0}, {rows}, steps.data());
    file.read_slab<double>("/step/body_orientation", {0, 0}, {rows, 4}, orientations.data());
    for (std::size_t k = 0; k < rows; ++k) {
      REQUIRE(steps[k] == k);
      REQUIRE(Eigen::Vector4d(orientations.data() + 4 * k).norm() == Approx(1.0));
    }
  }
}

TEST_CASE("a peer of another version is refused with a reason and both versions") {
  const Stage stage;
  Server server = stage.start_server();
  RawPeer peer = RawPeer::connect(server.port);
  peer.send(wire::Hello{.version_min = 7, .version_max = 9, .name = "from the future"});
  const auto refuse = peer.receive_as<wire::Refuse>();
  REQUIRE(refuse);
  CHECK(refuse->reason == wire::RefuseReason::kVersion);
  CHECK(refuse->version_min == wire::kOldestProtocolVersion);
  CHECK(refuse->version_max == wire::kProtocolVersion);
  CHECK_THAT(refuse->text,
             ContainsSubstring("7") && ContainsSubstring("9") && ContainsSubstring("1"));
  CHECK(peer.ends());
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
  CHECK_THAT(server.process.out(), ContainsSubstring("sessions: 0 accepted, 1 refused"));
}

TEST_CASE("a bridge that is refused for its version says both and ends with status 1") {
  const Stage stage;
  RawListener listener;
  ChildProcess bridge({IRDM_BRIDGE, stage.path("bridge.toml").string(), "--server",
                       "127.0.0.1:" + std::to_string(listener.port())});
  RawPeer peer = listener.accept();
  REQUIRE(peer.receive_as<wire::Hello>());
  peer.send(wire::Refuse{.reason = wire::RefuseReason::kVersion,
                         .version_min = 7,
                         .version_max = 9,
                         .text = "too old"});
  peer.close();
  CHECK(bridge.wait() == 1);
  CHECK_THAT(bridge.err(), ContainsSubstring("irdm-bridge: error: ") &&
                               ContainsSubstring("7 to 9") &&
                               ContainsSubstring("install matching versions"));
  CHECK(bridge.out().empty());
}

TEST_CASE("garbage to the server disturbs neither it nor the bridge that plays") {
  const Stage stage;
  stage.write("script.csv", hold_and_circle(10));
  const std::filesystem::path path = stage.path("trace.h5");
  // In lockstep, since on a busy machine a contact may end for want of samples.
  Server server = stage.start_server({"--lockstep", "--record", path.string()});
  ChildProcess bridge = stage.start_bridge(server);
  REQUIRE(eventually([&] { return rows_so_far(path, "contact", kHeld) > 50; }));

  constexpr unsigned kPeers = 8;
  for (unsigned seed = 0; seed < kPeers; ++seed) {
    RawPeer peer = RawPeer::connect(server.port);
    peer.send(noise(seed, 100'000));
    CHECK(peer.ends());
  }
  {
    // A frame that looks like a guest's until its checksum, and one that stops half-way.
    RawPeer peer = RawPeer::connect(server.port);
    std::vector<std::uint8_t> spoilt = frame_bytes(wire::Hello{.name = "spoilt"});
    spoilt.back() ^= 1;
    peer.send(spoilt);
    CHECK(peer.ends());
    RawPeer half = RawPeer::connect(server.port);
    half.send(std::span<const std::uint8_t>(spoilt).first(20));
    half.close();
  }
  const std::size_t held = rows_so_far(path, "contact", kHeld);
  REQUIRE(eventually([&] { return rows_so_far(path, "contact", kHeld) > held + 50; }));

  bridge.signal(SIGINT);
  CHECK(bridge.wait() == 0);
  CHECK(server.process.wait() == 0);  // the run is over when its bridge leaves
  check_one_session(bridge.out());
  CHECK(number_after(server.process.out(), "sessions: ") ==
        number_after(bridge.out(), "sessions "));
  CHECK_THAT(server.process.out(),
             ContainsSubstring(" accepted, 0 refused, 9 closed for protocol errors"));
  const Trace trace = read_trace(path);
  const auto held_from = std::find(trace.contact.begin(), trace.contact.end(), kHeld);
  CHECK(std::all_of(held_from, trace.contact.begin() + static_cast<long>(end_of_hold(trace)),
                    [](std::uint8_t contact) { return contact == kHeld; }));
}

TEST_CASE("a disk that gets full while a server records: it says so, and ends in order") {
  const Stage stage;
  const std::filesystem::path path = stage.path("trace.h5");
  ChildProcess process(told_of_full_disk({IRDM_SERVER, stage.path("scene.toml").string(),
                                          "--no-viewer", "--lockstep", "--record", path.string()}));
  const std::string line = process.line_with("listening on ");
  Server server{std::move(process),
                static_cast<std::uint16_t>(std::stoi(line.substr(line.rfind(':') + 1)))};
  limit_file_size(server.process.pid(), 320'000);
  ChildProcess bridge = stage.start_bridge(server);
  CHECK(bridge.wait() == 0);
  CHECK(server.process.wait() == 1);
  CHECK_THAT(server.process.err(),
             ContainsSubstring("irdm-server: error: recording ended early: ") &&
                 ContainsSubstring("check free space"));
  CHECK(committed_so_far(path) > 0);
}

TEST_CASE("a trace whose folder is removed while it is recorded: said at once, status 1") {
  const Stage stage;
  std::filesystem::create_directory(stage.path("in"));
  const std::filesystem::path path = stage.path("in") / "trace.h5";
  Server server = stage.start_server({"--record", path.string()});
  std::filesystem::remove_all(stage.path("in"));
  CHECK_THAT(server.process.line_with("recording ended early", true),
             ContainsSubstring("trace.h5: was removed while it was written"));
  CHECK(server.process.running());
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 1);
}

#ifndef IRDM_THREAD_SANITIZED  // ThreadSanitizer has a file of its own, which has no room either
TEST_CASE("a disk without room for a trace: one error, and no trace") {
  const Stage stage;
  const FinishedProgram ended = run_to_end(
      on_full_disk(15'000, {IRDM_SERVER, stage.path("scene.toml").string(), "--no-viewer",
                            "--record", stage.path("trace.h5").string()}));
  CHECK(ended.status == 1);
  CHECK(std::count(ended.err.begin(), ended.err.end(), '\n') == 1);
  CHECK_THAT(ended.err,
             ContainsSubstring("irdm-server: error: ") && ContainsSubstring("check free space"));
  CHECK_FALSE(std::filesystem::exists(stage.path("trace.h5")));
}
#endif
