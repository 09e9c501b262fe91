// What viewers cost the force thread and the server's memory: irdm-server in real time with a
// scripted stylus, alternately alone and with ten viewers, one of which reads one byte a second.
//   bench_viewer_load MODEL.h5 [PAIRS]      3 pairs unless given; a run takes some 12 s
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "bench/statistics.hpp"
#include "tests/support/child_process.hpp"
#include "tests/viewer/web_peer.hpp"
#include "viewer/message.hpp"

using namespace irdm;

namespace {

constexpr int kReaders = 9;  // and the slow one

/// A viewer on a thread of its own, until the server ends.
class Viewer {
 public:
  Viewer(std::uint16_t port, bool slow) {
    test::WebPeer peer(port, slow ? kSmallBuffer : 0);
    peer.open();
    peer.send_message(encode(viewer::ClientMessage(viewer::Hello{})));
    thread_ =
        std::jthread([slow, this, peer = std::move(peer)](const std::stop_token& stop) mutable {
          while (!stop.stop_requested()) {
            if (slow) {
              if (!peer.read_byte()) return;
              std::this_thread::sleep_for(std::chrono::seconds(1));
            } else {
              const auto message = peer.receive();
              if (!message || message->opcode == 8) return;
              bytes_ += static_cast<double>(message->payload.size());
            }
          }
        });
  }
  /// Waits for its end and tells how many bytes it was sent.
  double finish() {
    thread_.request_stop();
    thread_.join();
    return bytes_;
  }

 private:
  static constexpr int kSmallBuffer = 4096;
  double bytes_ = 0.0;
  std::jthread thread_;
};

/// VmRSS or VmHWM of a process [MB].
double memory(pid_t pid, const std::string& name) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/status");
  for (std::string word; file >> word;) {
    double kilobytes = 0.0;
    if (word == name + ":" && file >> kilobytes) return kilobytes / 1024.0;
  }
  return 0.0;
}

/// The three numbers after "NAME: p50 " in the server's report [us].
std::vector<double> percentiles(const std::string& report, const std::string& name) {
  std::vector<double> values(3, 0.0);
  const std::size_t at = report.find(name + ": p50");
  if (at != std::string::npos) {
    std::sscanf(report.c_str() + at + name.size(), ": p50 %lf us, p99 %lf us, max %lf us",
                &values[0], &values[1], &values[2]);
  }
  return values;
}

double number(const std::string& report, const std::string& name) {
  const std::size_t at = report.find(name + ": ");
  return at == std::string::npos ? 0.0 : std::atof(report.c_str() + at + name.size() + 2);
}

/// What one run tells, in the order of kRows.
constexpr const char* kRows[] = {"step time, median [us]",
                                 "step time, p99 [us]",
                                 "step time, max [us]",
                                 "wake-up, median [us]",
                                 "wake-up, p99 [us]",
                                 "wake-up, max [us]",
                                 "missed deadlines",
                                 "resident memory at start [MB]",
                                 "resident memory at end [MB]",
                                 "resident memory, most [MB]",
                                 "sent to a viewer [kB/s]"};
using Figures = std::vector<double>;

Figures run(const std::string& model, bool with_viewers) {
  const test::TemporaryFolder folder;
  const std::string scene = (folder.path() / "scene.toml").string();
  std::ofstream(scene) << "[contact]\ncoupling_stiffness = 2000\n[[object]]\nmodel = \"" << model
                       << "\"\n";
  test::ChildProcess server({IRDM_SERVER, scene});
  const std::string for_bridges = "listening on 127";
  const std::string for_viewers = "listening on http://127.0.0.1:";
  const std::string port = server.line_with(for_viewers).substr(for_viewers.size());
  const std::string address = server.line_with(for_bridges).substr(for_bridges.size() - 3);
  std::vector<std::unique_ptr<Viewer>> viewers;
  for (int i = 0; with_viewers && i <= kReaders; ++i) {
    const auto number = static_cast<std::uint16_t>(std::stoi(port));
    viewers.push_back(std::make_unique<Viewer>(number, i == kReaders));
  }
  std::this_thread::sleep_for(std::chrono::seconds(1));
  const double memory_before = memory(server.pid(), "VmRSS");
  const auto begin = std::chrono::steady_clock::now();
  test::ChildProcess bridge(
      {IRDM_BRIDGE, IRDM_SOURCE_DIR "/configs/bridges/demo.toml", "--server", address});
  bridge.wait();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  const double memory_after = memory(server.pid(), "VmRSS");
  const double memory_most = memory(server.pid(), "VmHWM");
  server.signal(SIGTERM);
  server.wait();
  double bytes = 0.0;
  for (const auto& viewer : viewers) bytes += viewer->finish();

  const std::string report = server.out();
  Figures figures = percentiles(report, "step time");
  const Figures wakeup = percentiles(report, "wake-up delay");
  figures.insert(figures.end(), wakeup.begin(), wakeup.end());
  figures.push_back(number(report, "missed deadlines"));
  figures.insert(figures.end(), {memory_before, memory_after, memory_most});
  figures.push_back(bytes / kReaders / (took.count() + 1.0) / 1000.0);
  return figures;
}

double median(const std::vector<Figures>& runs, std::size_t row) {
  std::vector<double> values;
  for (const Figures& each : runs) values.push_back(each[row]);
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2.0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: bench_viewer_load MODEL.h5 [PAIRS]\n", stderr);
    return 2;
  }
  const std::string model = std::filesystem::absolute(argv[1]).string();
  const int pairs = argc > 2 ? std::max(1, std::atoi(argv[2])) : 3;
  std::vector<Figures> alone;
  std::vector<Figures> watched;
  for (int i = 0; i < pairs; ++i) {
    // Now the one first, now the other: what drifts with time is on both sides.
    if (i % 2 == 0) alone.push_back(run(model, false));
    watched.push_back(run(model, true));
    if (i % 2 == 1) alone.push_back(run(model, false));
  }
  std::printf("Medians over %d pairs of runs; 10 viewers, one of which reads 1 byte a second.\n\n",
              pairs);
  std::printf("| | alone | 10 viewers | ratio |\n| --- | --- | --- | --- |\n");
  for (std::size_t row = 0; row < std::size(kRows); ++row) {
    const double a = median(alone, row);
    const double b = median(watched, row);
    std::printf("| %s | %.1f | %.1f |", kRows[row], a, b);
    if (a > 0.0) std::printf(" %.2f", b / a);
    std::printf(" |\n");
  }
  return 0;
}
