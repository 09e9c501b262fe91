#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <thread>
#include <vector>

#include "common/hdf5/file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/system/stage.hpp"
#include "tests/system/trace.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

/// Threads that do nothing as hard as they can.
class Load {
 public:
  explicit Load(int threads) {
    for (int i = 0; i < threads; ++i) {
      threads_.emplace_back([](const std::stop_token& stop) {
        volatile std::uint64_t count = 0;
        while (!stop.stop_requested()) count = count + 1;
      });
    }
  }

 private:
  std::vector<std::jthread> threads_;
};

// One run of the whole script in lockstep, with `threads` wherever threads can be set.
// @param device more keys of it
// @param object the same
Trace play(const std::string& engine, int threads, const std::string& device = "",
           const std::string& object = "") {
  const Stage stage;
  stage.write("bridge.toml", file_content(stage.path("bridge.toml")) + device);
  const std::string count = std::to_string(threads);
  std::string scene = scene_text("[world]\ngravity = [0, -0.02, 0.01]\n", engine) + object;
  scene.replace(scene.find("threads = 1"), 11, "threads = " + count);
  stage.write("scene.toml", scene);
  const ChildOptions options{
      .environment = {"OMP_NUM_THREADS=" + count, "OPENBLAS_NUM_THREADS=" + count}};
  Server server =
      stage.start_server({"--lockstep", "--record", stage.path("trace.h5").string()}, options);
  ChildProcess bridge = stage.start_bridge(server, {}, options);
  REQUIRE(bridge.wait() == 0);
  REQUIRE(server.process.wait() == 0);  // the run is over when its bridge leaves
  CHECK_THAT(bridge.out(), ContainsSubstring("lockstep") && ContainsSubstring("sessions 1") &&
                               ContainsSubstring(" 0 gaps"));
  return read_trace(stage.path("trace.h5"));
}

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void check_same_bits(const Trace& a, const Trace& b) {
  REQUIRE(a.rows() == b.rows());
  CHECK(same_bits(a.time, b.time));
  CHECK(same_bits(a.force_step, b.force_step));
  for (const auto& [set, values] : a.numbers) {
    CAPTURE(set);
    CHECK(same_bits(values, b.numbers.at(set)));
  }
  CHECK(same_bits(a.contact, b.contact));
  CHECK(same_bits(a.contact_nodes, b.contact_nodes));
  CHECK(same_bits(a.buttons, b.buttons));
}

}  // namespace

TEST_CASE("a stylus that is armed by a button feels nothing before it is pressed") {
  // Half a second into the cube, pressed or not, and half a second more.
  const auto play_arming = [](const char* pressed) {
    const Stage stage;
    stage.write("scene.toml",
                scene_text() + "tether = { stiffness = 200, angular_stiffness = 1 }\n");
    stage.write("script.csv", "time,x,y,z,button\n0,0,0.07,0,0\n0.3,0,0.05,0,0\n0.8,0,0.05,0," +
                                  std::string(pressed) + "\n1.3,0,0.05,0," + pressed + "\n");
    stage.write("bridge.toml",
                "[bridge]\narm = \"button\"\n" + file_content(stage.path("bridge.toml")));
    Server server = stage.start_server({"--lockstep", "--record", stage.path("trace.h5").string()});
    ChildProcess bridge = stage.start_bridge(server);
    REQUIRE(bridge.wait() == 0);
    REQUIRE(server.process.wait() == 0);
    return std::pair(read_trace(stage.path("trace.h5")),
                     number_after(bridge.out(), "peak force: "));
  };
  const auto [silent, no_force] = play_arming("0");
  const auto [felt, force] = play_arming("8");
  CHECK(no_force == 0.0);
  CHECK(force > 0.1);
  REQUIRE(silent.rows() == felt.rows());
  REQUIRE(felt.contact[felt.rows() / 2] != 0);
  const auto height = [](const Trace& trace, std::size_t k) {
    return trace.vector("/stylus/0/tip", k).y();
  };
  const std::size_t before = felt.rows() / 2;
  CHECK(height(silent, before) == height(felt, before));
  CHECK(height(silent, silent.rows() - 1) == Approx(0.05).margin(1e-5));
  CHECK(height(felt, felt.rows() - 1) > 0.0505);
}

TEST_CASE("lockstep: the same script leaves the same bits with 1 or 2 threads, idle or loaded",
          "[slow]") {
  const std::string engine = GENERATE("modal", "dense");
  CAPTURE(engine);
  const Trace first = play(engine, 1);
  // The whole script, and it touched and held.
  REQUIRE(first.rows() == static_cast<std::size_t>(std::lround(kPressAndSwing / 0.002)));
  CHECK(std::count(first.contact.begin(), first.contact.end(), 1) > 50);
  CHECK(std::count(first.contact.begin(), first.contact.end(), 2) > 250);
  SECTION("again") {
    check_same_bits(first, play(engine, 1));
  }
  SECTION("2 threads") {
    check_same_bits(first, play(engine, 2));
  }
  SECTION("a loaded machine") {
    const Load load(3);
    check_same_bits(first, play(engine, 2));
  }
}

TEST_CASE("lockstep: columns of R from the disk leave the same bits as all of R in memory") {
  // 30 of 56 nodes at a time.
  check_same_bits(play("dense", 1), play("dense", 1, "", "memory_budget = 15\n"));
}

// Sanitizers write files of their own.
#ifndef IRDM_SANITIZED
TEST_CASE("lockstep: a disk that gets full changes no step and keeps what was committed") {
  const Trace whole = play("modal", 1);
  const Stage stage;
  stage.write("scene.toml", scene_text("[world]\ngravity = [0, -0.02, 0.01]\n", "modal"));
  const auto path = stage.path("trace.h5");
  Server server = stage.start_server({"--lockstep", "--record", path.string()});
  constexpr rlimit kFull{340'000, 340'000};  // room for the first 512 steps
  REQUIRE(::prlimit(server.process.pid(), RLIMIT_FSIZE, &kFull, nullptr) == 0);
  ChildProcess bridge = stage.start_bridge(server);
  REQUIRE(bridge.wait() == 0);
  CHECK(server.process.wait() == 1);
  CHECK_THAT(bridge.out(), ContainsSubstring(" 0 gaps"));
  CHECK(number_after(server.process.out(), "\nsteps: ") == static_cast<double>(whole.rows()));
  CHECK_THAT(server.process.err(), ContainsSubstring("recording ended early: " + path.string()));
  const hdf5::File file = hdf5::File::open(path);
  const hsize_t rows = file.read<std::uint64_t>("/committed", {1})[0];
  REQUIRE(rows > 0);
  REQUIRE(rows < whole.rows());
  for (const auto& [set, values] : whole.numbers) {
    CAPTURE(set);
    const hsize_t width = values.size() / whole.rows();
    hdf5::Shape count{rows};
    if (file.shape(set).size() > 1) count.push_back(width);
    std::vector<double> kept(rows * width);
    file.read_slab<double>(set, hdf5::Shape(count.size(), 0), count, kept.data());
    CHECK(std::memcmp(kept.data(), values.data(), kept.size() * sizeof(double)) == 0);
  }
}
#endif

TEST_CASE("lockstep: another script leaves other bits", "[unsanitized]") {
  // What the comparison above is worth: the least change of the input shows.
  const Trace first = play("modal", 1);
  const Stage stage;
  std::string script = press_and_swing();
  script.replace(script.find(",0.0605,"), 8, ",0.0605001,");
  stage.write("script.csv", script);
  Server server = stage.start_server({"--lockstep", "--record", stage.path("trace.h5").string()});
  ChildProcess bridge = stage.start_bridge(server);
  REQUIRE(bridge.wait() == 0);
  REQUIRE(server.process.wait() == 0);
  const Trace other = read_trace(stage.path("trace.h5"));
  CHECK(other.rows() == first.rows());
  CHECK_FALSE(same_bits(first.numbers.at("/stylus/0/force"), other.numbers.at("/stylus/0/force")));
}

TEST_CASE("lockstep: a bridge that is killed ends the run, and the trace is whole") {
  const Stage stage;
  stage.write("script.csv", hold_and_circle());
  const std::filesystem::path path = stage.path("trace.h5");
  Server server = stage.start_server({"--lockstep", "--record", path.string()});
  ChildProcess bridge = stage.start_bridge(server);
  REQUIRE(eventually([&] { return rows_so_far(path, "contact", 2) > 100; }));
  bridge.signal(SIGKILL);
  CHECK(bridge.wait() == -SIGKILL);
  CHECK(server.process.wait() == 0);
  CHECK(static_cast<double>(read_trace(path).rows()) ==
        number_after(server.process.out(), "\nsteps: "));
}

TEST_CASE("lockstep: a server that is killed ends its bridge with one line and status 1") {
  const Stage stage;
  stage.write("script.csv", hold_and_circle());
  const std::filesystem::path path = stage.path("trace.h5");
  Server server = stage.start_server({"--lockstep", "--record", path.string()});
  ChildProcess bridge = stage.start_bridge(server);
  REQUIRE(eventually([&] { return rows_so_far(path, "contact", 2) > 100; }));
  server.process.signal(SIGKILL);
  CHECK(server.process.wait() == -SIGKILL);
  CHECK(bridge.wait() == 1);
  CHECK_THAT(bridge.err(),
             ContainsSubstring("irdm-bridge: error: ") && ContainsSubstring("lost in lockstep"));
}

TEST_CASE("lockstep: a stylus with noise, encoders and motors leaves the same bits again") {
  const std::string real =
      "sensor = { resolution = 5.5e-5, noise = 1e-5 }\n"
      "motors = { max_force = 3.3, continuous_force = 0.88, watchdog = 0.032 }\n";
  const Trace first = play("modal", 1, real);
  check_same_bits(first, play("modal", 2, real));
  const Trace perfect = play("modal", 1);
  REQUIRE(perfect.rows() == first.rows());
  CHECK_FALSE(same_bits(first.numbers.at("/stylus/0/tip"), perfect.numbers.at("/stylus/0/tip")));
}
