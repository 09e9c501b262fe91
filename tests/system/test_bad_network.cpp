// Server and bridge in network namespaces of their own, and between them a path that delays, loses,
// doubles, reorders and spoils packets, or takes them all and gives nothing back. All of it is done
// by a relay of our own between two TUN devices, loss too: it needs neither tc nor nftables, and
// traffic stays in the namespaces. Left out where the kernel does not allow such namespaces.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "common/realtime/clock.hpp"
#include "tests/network_namespace/packet_relay.hpp"
#include "tests/network_namespace/two_namespaces.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/left_out.hpp"
#include "tests/system/stage.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kServerSide = 0;
constexpr std::size_t kBridgeSide = 1;
constexpr double kDeviceLimit = 3.3;  // [N], of the fake driver
constexpr std::int64_t kMillisecond = 1'000'000;

constexpr PathQuality kBadPath{
    .delay_ms = 5.0, .jitter_ms = 10.0, .loss = 0.05, .duplicates = 0.01, .corrupt = 0.01};

/// What the fake driver wrote down of one frame.
struct LinkFrame {
  std::int64_t begun_ns = 0;  ///< monotonic clock
  double force = 0.0;         ///< asked for [N]
};

/// Nothing, and the test left out, where there are no namespaces to be had.
std::optional<TwoNamespaces>& namespaces() {
  static std::optional<TwoNamespaces> both;
  if (both) return both;
  try {
    both.emplace();
  } catch (const Error& error) {
    leave_out(error.what());
  }
  return both;
}

/// A person who presses on the cube with a device of the fake driver, nine seconds at a time.
class DistantStage : public Stage {
 public:
  DistantStage(const TwoNamespaces& both, const std::string& mode, const std::string& stream)
      : both_(both) {
    write("key", std::string(64, 'a') + "\n");
    fs::permissions(path("key"), fs::perms::owner_read | fs::perms::owner_write);
    write("scene.toml", "[server]\naddress = \"" + both.address(kServerSide) +
                            "\"\nkey_file = \"key\"\n" + scene_text().substr(9) +
                            "tether = { stiffness = 200, angular_stiffness = 1 }\n");
    write("bridge.toml", "[bridge]\nkey_file = \"key\"\nmode = \"" + mode + "\"\nstream = \"" +
                             stream + "\"\n[[device]]\ntype = \"openhaptics\"\n");
    write("motion.txt", "0 0 70 0 0\n500 0 50 0 0\n9500 0 50 0 0\n10000 0 70 0 0\n");
  }
  Server start_far_server() const {
    ChildProcess process(
        both_.inside(kServerSide, {IRDM_SERVER, path("scene.toml").string(), "--no-viewer"}));
    const std::string line = process.line_with("listening on ");
    return {std::move(process),
            static_cast<std::uint16_t>(std::stoi(line.substr(line.rfind(':') + 1)))};
  }
  /// @param ticks with a force before it says "in contact"
  ChildProcess start_near_bridge(const Server& server, std::vector<std::string> more = {},
                                 int ticks = 100) const {
    std::vector<std::string> command = {
        IRDM_BRIDGE, path("bridge.toml").string(), "--server",
        both_.address(kServerSide) + ":" + std::to_string(server.port)};
    command.insert(command.end(), more.begin(), more.end());
    return ChildProcess(
        both_.inside(kBridgeSide, command),
        {.environment = {"HD_LIBRARY=" IRDM_FAKE_LIBHD,
                         "FAKE_HD_MOTION=" + path("motion.txt").string(),
                         "FAKE_HD_LOG=" + path("frames.txt").string(), "FAKE_HD_EVENT=tell",
                         "FAKE_HD_EVENT_AFTER=" + std::to_string(ticks)}});
  }
  /// Of the bridge that has ended.
  std::vector<LinkFrame> frames() const {
    std::vector<LinkFrame> found;
    std::istringstream text(file_content(path("frames.txt")));
    LinkFrame frame;
    double ignored = 0.0;
    const auto ignore = [&](int numbers) {
      for (int i = 0; i < numbers; ++i) text >> ignored;
    };
    for (double x = 0, y = 0, z = 0;;) {
      ignore(5);  // tick, whether it failed, place
      text >> x >> y >> z;
      ignore(3);  // torque
      if (!(text >> frame.begun_ns)) break;
      frame.force = std::sqrt(x * x + y * y + z * z);
      found.push_back(frame);
    }
    return found;
  }

 private:
  const TwoNamespaces& both_;
};

double largest_link_force(const std::vector<LinkFrame>& frames) {
  double largest = 0.0;
  for (const LinkFrame& frame : frames) largest = std::max(largest, frame.force);
  return largest;
}

std::size_t sessions(const ChildProcess& bridge) {
  const std::string log = bridge.err();
  std::size_t count = 0;
  for (std::size_t at = 0; (at = log.find(": session ", at)) != std::string::npos; ++at) ++count;
  return count;
}

void check_end(Server& server) {
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
  CHECK_THAT(server.process.out(), ContainsSubstring(" 0 closed for protocol errors") &&
                                       !ContainsSubstring("without the server's key"));
}

/// The time from the last that can arrive to no force [ns]: docs/protocol.md, age.
std::int64_t longest_force_ns(const std::string& mode) {
  return (mode == "hold" ? 50 : 80) * kMillisecond;
}

}  // namespace

TEST_CASE("a path that becomes a black hole: no force in time, and the session is made anew") {
  if (!namespaces()) return;
  const std::string mode = GENERATE(as<std::string>(), "hold", "predict");
  const std::string stream = GENERATE(as<std::string>(), "tcp", "udp");
  CAPTURE(mode, stream);
  if (mode == "predict" && !kKeepsPace) return leave_out(kTooSlow);
  const DistantStage stage(*namespaces(), mode, stream);
  PacketRelay path(namespaces()->devices(), {});
  Server server = stage.start_far_server();
  ChildProcess bridge = stage.start_near_bridge(server);
  bridge.line_with("in contact");
  const std::int64_t cut_ns = path.cut();
  constexpr std::int64_t kCut = 300 * kMillisecond;
  REQUIRE(eventually([&] { return monotonic_ns() > cut_ns + kCut; }));
  path.mend();
  REQUIRE(eventually([&] { return sessions(bridge) >= 2; }));
  bridge.signal(SIGTERM);
  CHECK(bridge.wait() == 0);
  CHECK_THAT(bridge.out(), ContainsSubstring("protocol errors 0"));
  CHECK((bridge.out().find("datagrams: ") != std::string::npos) == (stream == "udp"));

  const std::vector<LinkFrame> frames = stage.frames();
  CHECK(largest_link_force(frames) > 0.2);
  CHECK(largest_link_force(frames) < kDeviceLimit * (1.0 + 1e-9));
  std::size_t without = 0;
  for (const LinkFrame& frame : frames) {
    const std::int64_t since_ns = frame.begun_ns - cut_ns;
    if (since_ns <= longest_force_ns(mode) || since_ns > kCut) continue;
    REQUIRE(frame.force == 0.0);
    ++without;
  }
  CHECK(without > 0);
  check_end(server);
}

TEST_CASE("a bad path: forces within limits, or the bridge says why there are none", "[slow]") {
  if (!namespaces()) return;
  const std::string mode = GENERATE(as<std::string>(), "hold", "predict");
  const DistantStage stage(*namespaces(), mode, "tcp");
  PacketRelay path(namespaces()->devices(), kBadPath);
  Server server = stage.start_far_server();
  ChildProcess bridge = stage.start_near_bridge(server, {"--duration", "8"});
  CHECK(bridge.wait() == 0);
  CAPTURE(mode, bridge.out(), bridge.err());
  CHECK(path.corrupted() > 0);
  CHECK_THAT(bridge.out(), ContainsSubstring("protocol errors 0"));
  CHECK(number_after(bridge.out(), "forces: ") > 0);
  const double largest = largest_link_force(stage.frames());
  CHECK(largest < kDeviceLimit * (1.0 + 1e-9));
  const bool told = bridge.err().find("% of the last ticks were answered") != std::string::npos ||
                    bridge.err().find("connection lost: no answers any more") != std::string::npos;
  CHECK((largest > 0.0 || told));
  check_end(server);
  // The tether alone asks for 2 N; a silence must not end with a blow.
  CHECK(number_after(server.process.out(), "peak force: ") < 10.0);
}

TEST_CASE("a bad path by UDP: a bridge that predicts arms, and the cube is felt", "[slow]") {
  if (!kKeepsPace) return leave_out(kTooSlow);
  if (!namespaces()) return;
  const DistantStage stage(*namespaces(), "predict", "udp");
  PacketRelay path(namespaces()->devices(), kBadPath);
  Server server = stage.start_far_server();
  constexpr int kPressed = 500;
  ChildProcess bridge = stage.start_near_bridge(server, {}, kPressed);
  bridge.line_with("in contact");  // on a busy machine it arms late
  bridge.signal(SIGTERM);
  CHECK(bridge.wait() == 0);
  CAPTURE(bridge.out(), bridge.err());
  CHECK(path.corrupted() > 0);
  CHECK_THAT(bridge.out(),
             ContainsSubstring("protocol errors 0") && ContainsSubstring("datagrams: "));
  // One way takes 10 ms on average, there and back 20 ms, and a step.
  CHECK(number_after(bridge.out(), "round trip: p50 ") < 30.0);
  const double largest = largest_link_force(stage.frames());
  CHECK(largest > 0.5);
  CHECK(largest < kDeviceLimit * (1.0 + 1e-9));
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
  CHECK_THAT(server.process.out(), ContainsSubstring(" 0 closed for protocol errors") &&
                                       ContainsSubstring("came twice, dropped: "));
}
