// The programs as a ROS user has them, and a node of ROS 2 in two stacks of DDS.
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "common/model/model_file.hpp"
#include "ros_bridge/dds.hpp"
#include "ros_bridge/messages.hpp"
#include "tests/ros_bridge/ros_peer.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/system/trace.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kTop = 0.12;       // of the cube on its table [m]
constexpr double kPressed = 0.115;  // 5 mm below

/// A server with a cube on a table, and a bridge beside it whose topics no other test has.
class Programs {
 public:
  Programs() {
    std::ofstream(path("bridge.toml")) << "[bridge]\nmode = \"hold\"\n";
    start_server("0", "0");
    bridge_.emplace(std::vector<std::string>{
        IRDM_ROS_BRIDGE, "--server", "127.0.0.1:" + port_, "--viewer", "127.0.0.1:" + viewer_port_,
        "--config", path("bridge.toml"), "--domain", std::to_string(domain()), "--namespace",
        name_space()});
  }

  /// Kills the server and starts another one in its place.
  void restart_server() {
    server_->signal(SIGKILL);
    server_->wait();
    std::filesystem::remove(trace());
    start_server(port_, viewer_port_);
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string trace() const { return path("trace.h5"); }
  ChildProcess& server() { return *server_; }
  ChildProcess& bridge() { return *bridge_; }
  /// Of those whose ports are below the ones that the system gives away.
  static std::uint32_t domain() { return 1 + static_cast<std::uint32_t>(::getpid()) % 100; }
  static std::string name_space() { return "irdm_" + std::to_string(::getpid()); }

 private:
  void start_server(const std::string& port, const std::string& viewer_port) {
    std::ofstream(path("scene.toml"))
        << "server.port = " << port << "\nviewer.port = " << viewer_port
        << "\nserver.black_box = \"\"\n"
           "[[object]]\nmodel = \"" IRDM_SYSTEM_MODEL
           "\"\nposition = [0, 0.06, 0]\n"
           "[[scenery]]\nplane = {}\n"
           "[[stylus]]\ncoupling_stiffness = 500\n";
    server_.emplace(std::vector<std::string>{IRDM_SERVER, path("scene.toml"), "--record", trace()});
    const auto port_in = [](const std::string& line) {
      const std::size_t colon = line.rfind(':') + 1;
      return line.substr(colon, line.find_first_not_of("0123456789", colon) - colon);
    };
    viewer_port_ = port_in(server_->line_with("listening on http://"));
    port_ = port_in(server_->line_with("listening on 127"));
  }

  TemporaryFolder folder_;
  std::string port_;
  std::string viewer_port_;
  std::optional<ChildProcess> server_;
  std::optional<ChildProcess> bridge_;
};

RosPose above(double height, const std::string& frame = "irdm") {
  return {{0.0, 0.0, height}, {0.0, 0.0, 0.0, 1.0}, frame};
}

Vector3 vector(const Numbers3& numbers) {
  return Vector3(numbers.data());
}

// The node leads the tip down onto the cube, holds it there, and takes the forces.
std::vector<Vector3> press(RosPeer& peer, double& height) {
  std::vector<Vector3> forces;
  REQUIRE(eventually([&] {
    while (const auto wrench = peer.wrench()) {
      CHECK(wrench->frame_id == "irdm");
      if (wrench->force[2] > 0.01) forces.push_back(vector(wrench->force));
    }
    peer.send_pose(above(height));
    height = std::max(kPressed, height - 1e-4);
    return forces.size() > 1000;
  }));
  return forces;
}

// The last forces are those that the server's steps found, in other axes.
void compare(const std::vector<Vector3>& forces, const std::string& path) {
  const Trace trace = read_trace(path);
  for (std::size_t i = forces.size() - 200; i < forces.size(); ++i) {
    double nearest = 1.0;
    for (std::size_t k = 0; k < trace.rows(); ++k) {
      const Vector3 force = ros::ros_to_world().conjugate() * trace.vector("/stylus/0/force", k);
      nearest = std::min(nearest, (force - forces[i]).norm());
    }
    CHECK(nearest < 1e-12);
  }
}

bool at_rest(const RosCloud& cloud, const ModelMesh& mesh) {
  for (int i = 0; i < mesh.surface_node_count(); ++i) {
    Eigen::Vector3f point;
    std::memcpy(point.data(), cloud.data.data() + 12 * i, 12);
    const Vector3 x = mesh.rest_position(i);  // right, up, back
    const Vector3 expected(-x.z(), -x.x(), x.y() + kTop / 2);
    if ((point.cast<double>() - expected).norm() > 1e-5) return false;
  }
  return true;
}

// The surface of the cube at rest.
void check_points(RosPeer& peer) {
  const ModelMesh mesh = read_model(IRDM_SYSTEM_MODEL, ResponseKind::kModal).mesh;
  const auto count = static_cast<std::uint32_t>(mesh.surface_node_count());
  REQUIRE(eventually([&] {
    const std::optional<RosCloud> cloud = peer.points();
    if (!cloud) return false;
    CHECK(cloud->fields == std::vector<std::string>{"x", "y", "z"});
    REQUIRE(cloud->width == count);
    REQUIRE(cloud->height * cloud->point_step == 12);
    REQUIRE(cloud->data.size() == 12 * count);
    return at_rest(*cloud, mesh);
  }));
  REQUIRE(eventually([&] {
    const std::optional<RosPose> body = peer.body();
    return body && (vector(body->position) - Vector3(0, 0, kTop / 2)).norm() < 1e-5;
  }));
}

void play(std::unique_ptr<RosPeer> (*make)(std::uint32_t, const std::string&)) {
  Programs programs;
  const auto peer = make(Programs::domain(), Programs::name_space());
  check_points(*peer);

  double height = 0.15;
  const std::vector<Vector3> forces = press(*peer, height);
  REQUIRE(height == kPressed);
  CHECK(forces.back().head<2>().norm() < 0.2 * forces.back().z());

  // It is shown where the surface holds it: above where it was led to.
  REQUIRE(eventually([&] {
    peer->send_pose(above(height));
    const auto tip = peer->tip();
    return tip && tip->position[2] > kPressed + 1e-4 && tip->position[2] < kTop;
  }));

  // The grab button: now it pulls, too.
  peer->send_grab(true);
  REQUIRE(eventually([&] {
    height = std::min(kTop + 0.02, height + 1e-4);
    peer->send_pose(above(height));
    const auto wrench = peer->wrench();
    return wrench && wrench->force[2] < -0.01;
  }));

  // Poses that are none, or in another frame, do not count, and without new ones there is no force.
  REQUIRE(eventually([&] {
    peer->send_pose(above(std::numeric_limits<double>::quiet_NaN()));
    return programs.bridge().err().find("the tip is not within") != std::string::npos;
  }));
  REQUIRE(eventually([&] {
    peer->send_pose(above(height, "map"));
    std::optional<RosWrench> newest;
    while (const auto wrench = peer->wrench()) newest = wrench;
    return newest && vector(newest->force).isZero(0.0);
  }));
  CHECK_THAT(programs.bridge().line_with("its frame", true),
             ContainsSubstring("stylus_0: a pose is ignored: its frame is 'map', not 'irdm'"));

  programs.bridge().signal(SIGTERM);
  CHECK(programs.bridge().wait() == 0);
  programs.server().signal(SIGTERM);
  CHECK(programs.server().wait() == 0);
  compare(forces, programs.trace());
}

}  // namespace

TEST_CASE("ROS bridge: a node of ROS 2 is a stylus and sees the surface, Cyclone DDS") {
  play(make_cyclone_peer);
}

TEST_CASE("ROS bridge: what is for this machine has no socket that hears others") {
  const std::uint32_t domain = 101 + static_cast<std::uint32_t>(::getpid()) % 100;
  const ros::Participant participant(domain, "irdm", ros::Reach::kThisMachine);
  std::size_t sockets = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    const int descriptor = std::stoi(entry.path().filename().string());
    sockaddr_in address{};
    socklen_t size = sizeof address;
    if (::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size) != 0) continue;
    if (address.sin_family != AF_INET) continue;
    ++sockets;
    char bound_to[IFNAMSIZ] = "";
    size = sizeof bound_to;
    REQUIRE(::getsockopt(descriptor, SOL_SOCKET, SO_BINDTODEVICE, bound_to, &size) == 0);
    CHECK((std::string(bound_to) == "lo" || address.sin_addr.s_addr == htonl(INADDR_LOOPBACK)));
  }
  CHECK(sockets >= 2);
}

#ifdef IRDM_WITH_FAST_DDS
TEST_CASE("ROS bridge: a node of ROS 2 is a stylus and sees the surface, Fast DDS") {
  play(make_fast_peer);
}
#endif

TEST_CASE("ROS bridge: after a killed server the next one takes its place") {
  Programs programs;
  const auto peer = make_cyclone_peer(Programs::domain(), Programs::name_space());
  double height = 0.15;
  press(*peer, height);
  programs.restart_server();
  REQUIRE(eventually([&] {
    std::optional<RosWrench> newest;
    while (const auto wrench = peer->wrench()) newest = wrench;
    return newest && vector(newest->force).isZero(0.0);
  }));
  check_points(*peer);
  height = 0.15;
  press(*peer, height);
}

TEST_CASE("ROS bridge: wrong use is refused in one line", "[slow]") {
  const auto run = [](const std::vector<std::string>& arguments) {
    std::vector<std::string> command{IRDM_ROS_BRIDGE};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return run_to_end(command);
  };
  CHECK(run({}).status == 2);
  CHECK(run({"--viewer", "127.0.0.1:1", "--stylus", "0"}).status == 2);
  CHECK(run({"--viewer", "127.0.0.1:1", "--domain", "233"}).status == 2);
  for (const char* seconds : {"nan", "0", "10.1"}) {
    CHECK(run({"--server", "127.0.0.1:1", "--stale-after", seconds}).status == 2);
  }
  CHECK(run({"--server", "127.0.0.1:1", "--tip", "0", "0", "nan"}).status == 2);
  for (const char* name : {"", "/a", "a/", "a//b", "1a", "a b"}) {
    CAPTURE(name);
    CHECK(run({"--viewer", "127.0.0.1:1", "--namespace", name}).status == 2);
  }
  const FinishedProgram token = run({"--viewer", "127.0.0.1:1", "--token", "secret of sixteen"});
  CHECK(token.status == 2);
  CHECK_THAT(token.err, ContainsSubstring("give --token-file FILE or set IRDM_TOKEN") &&
                            !ContainsSubstring("secret of"));
  const FinishedProgram no_file =
      run({"--viewer", "127.0.0.1:1", "--token-file", "/nowhere/token"});
  CHECK(no_file.status == 1);
  CHECK_THAT(no_file.err, ContainsSubstring("cannot read the token: there is no such file"));
  const FinishedProgram both = run_to_end({IRDM_ROS_BRIDGE, "--viewer", "127.0.0.1:1", "--network"},
                                          {.environment = {"ROS_LOCALHOST_ONLY=1"}});
  CHECK(both.status == 1);
  CHECK_THAT(both.err, ContainsSubstring("--network: contradicts ROS_LOCALHOST_ONLY=1"));
  const FinishedProgram address = run({"--viewer", "localhost"});
  CHECK(address.status == 1);
  CHECK_THAT(address.err, ContainsSubstring("irdm-ros-bridge: error: --viewer: "));
  const FinishedProgram alone = run({"--server", "127.0.0.1:1"});
  CHECK(alone.status == 1);
  CHECK_THAT(alone.err, ContainsSubstring("irdm-ros-bridge: error: 127.0.0.1:1: "));
}
