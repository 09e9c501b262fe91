// What the server adds to the bare way there and back: irdm-server in lockstep, which answers each
// sample as soon as it has it, beside a process that only gives back as many bytes. Loopback, TCP
// without delay, frames of the same sizes, one after the other in the same run; for comparison also
// what a second such process adds, which is what the placement of processes does alone.
//   bench_round_trip MODEL.h5
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "bench/echo.hpp"
#include "bench/placement.hpp"
#include "bench/report.hpp"
#include "bench/statistics.hpp"
#include "common/wire/frame.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace irdm;

namespace {

constexpr int kTrips = 4000;
constexpr int kWarmUp = 500;

std::size_t frame_size(const wire::Message& message) {
  return wire::encode_frame(message, 0, 0, 0).size;
}

/// A bridge of one stylus on a server in lockstep.
class Bridge {
 public:
  explicit Bridge(std::uint16_t port) : wire_(port), answer_(frame_size(wire::ForceMessage{})) {
    wire_.send(
        wire::encode_frame(wire::Hello{.styluses = 1, .lockstep = true, .name = "bench"}, 0, 0, 0)
            .view());
    std::vector<std::uint8_t> bytes(frame_size(wire::Welcome{}));
    if (!wire_.receive(bytes)) throw std::runtime_error("the server has hung up");
    session_ = std::get<wire::Welcome>(read(bytes).message).session;
  }

  /// From a sample to its force [s].
  double round_trip(const Vector3& tip, bool grab) {
    wire::SampleMessage message;
    message.sample.sequence = step_++;
    message.sample.tip = tip;
    message.sample.buttons = grab ? kGrabButton : 0;
    const wire::FrameBytes frame = wire::encode_frame(message, session_, ++sequence_, 0);
    const double time = bench::seconds([&] {
      wire_.send(frame.view());
      if (!wire_.receive(answer_)) throw std::runtime_error("the server has hung up");
    });
    force_ = std::get<wire::ForceMessage>(read(answer_).message).force;
    return time;
  }
  const StylusForce& force() const { return force_; }

 private:
  wire::Frame read(std::span<const std::uint8_t> bytes) { return reader_.read(bytes).value(); }

  bench::Wire wire_;
  std::vector<std::uint8_t> answer_;
  wire::FrameReader reader_;
  std::uint32_t session_ = 0;
  std::uint64_t sequence_ = 0;
  std::uint64_t step_ = 0;
  StylusForce force_;
};

bench::Echo make_echo() {
  return {frame_size(wire::SampleMessage{}), frame_size(wire::ForceMessage{})};
}

/// One row: a bare echo and what is compared with it, alternately.
/// @param other one round trip, the k-th [s]
void compare(bench::Report& report, const bench::Placement& placement, const std::string& what,
             bench::Echo& echo, const std::function<double(int k)>& other) {
  bench::run_on(placement.asking);
  std::vector<double> bare;
  std::vector<double> whole;
  for (int k = 0; k < kWarmUp + kTrips; ++k) {
    const double there_and_back = echo.round_trip();
    const double answered = other(k);
    if (k < kWarmUp) continue;
    bare.push_back(1e6 * there_and_back);
    whole.push_back(1e6 * answered);
  }
  const double b = bench::percentile(bare, 0.5);
  const double w = bench::percentile(whole, 0.5);
  report.row({what, placement.name, b, bench::percentile(bare, 0.99), w,
              bench::percentile(whole, 0.99), w - b});
}

void compare_echo(bench::Report& report, const bench::Placement& placement) {
  bench::run_on(placement.answering);
  bench::Echo echo = make_echo();
  bench::Echo second = make_echo();
  compare(report, placement, "a second echo", echo, [&](int) { return second.round_trip(); });
}

/// Server with one cube whose stylus is away from it or holds it.
void compare_server(bench::Report& report, const bench::Placement& placement,
                    const std::string& model, bool held) {
  bench::run_on(placement.answering);
  bench::Echo echo = make_echo();
  const test::TemporaryFolder folder;
  const std::string scene = (folder.path() / "scene.toml").string();
  std::ofstream(scene) << "[server]\nstyluses = 1\n[contact]\ncoupling_stiffness = 2000\n"
                          "[[object]]\nmodel = \""
                       << model << "\"\n";
  test::ChildProcess server({IRDM_SERVER, scene, "--lockstep", "--no-viewer"});
  const std::string line = server.line_with("listening on 127.0.0.1:");
  Bridge bridge(static_cast<std::uint16_t>(std::stoi(line.substr(line.rfind(':') + 1))));
  compare(report, placement, held ? "server, one point held" : "server, stylus away", echo,
          [&](int k) {
            const Vector3 tip =
                held ? Vector3(0.001, k < 2 ? 0.061 : 0.059, 0.001) : Vector3(0.0, 0.2, 0.0);
            return bridge.round_trip(tip, held);
          });
  if ((bridge.force().contact == ContactState::kHeld) != held) {
    throw std::runtime_error("the stylus has no hold; these times mean nothing");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: bench_round_trip MODEL.h5\n", stderr);
    return 2;
  }
  const std::string model = std::filesystem::absolute(argv[1]).string();
  bench::Report report("round_trip");
  report.table("round trip on loopback",
               {"what", "processes", "bare echo, median [us]", "p99 [us]", "other, median [us]",
                "p99 [us] of it", "added, median [us]"});
  for (const bench::Placement& placement : bench::placements()) {
    compare_echo(report, placement);
    for (const bool held : {false, true}) compare_server(report, placement, model, held);
  }
}
