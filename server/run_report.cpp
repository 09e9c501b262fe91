#include "server/run_report.hpp"

#include <cstdio>
#include <iostream>
#include <string>

#include "server/threads/status_thread.hpp"

namespace irdm {
namespace {

std::string microseconds(const Histogram& histogram) {
  const auto value = [](std::int64_t ns) { return static_cast<double>(ns) / 1000.0; };
  char text[128];
  std::snprintf(text, sizeof text, "p50 %.1f us, p99 %.1f us, max %.1f us",
                value(histogram.percentile(0.5)), value(histogram.percentile(0.99)),
                value(histogram.maximum()));
  return text;
}

}  // namespace

// Each line in one piece, so that no other thread's line comes between.
void say_where(const std::vector<std::string>& places) {
  for (const std::string& place : places) std::cout << "listening on " + place + "\n" << std::flush;
}

int print_report(const FinishedRun& run) {
  const ForceThreadReport& force = run.force.report();
  std::cout << "steps: " << force.steps << '\n';
  if (run.clock != nullptr) {
    std::cout << "real-time scheduling: " << run.force.scheduling() << ", memory " << run.memory
              << '\n'
              << "missed deadlines: " << run.clock->missed() << ", made up for "
              << run.clock->made_up() << '\n'
              << "wake-up delay: " << microseconds(run.clock->wakeup_delay()) << '\n';
  }
  char peak[32];
  std::snprintf(peak, sizeof peak, "%.3f", force.peak_force);
  std::cout << "step time: " << microseconds(force.step_time) << '\n';
  if (force.prediction_time.count() > 0) {
    std::cout << "of which prediction: " << microseconds(force.prediction_time) << '\n';
  }
  std::cout << "peak force: " << peak << " N\n"
            << "reset: " << force.resets << " times\n"
            << "steps without a finite solution: " << force.unsolved << '\n'
            << "surfaces: " << run.deformation.frames() << ", each "
            << microseconds(run.deformation.compute_time()) << '\n'
            << "sessions: " << run.network.stats().accepted << " accepted, "
            << run.network.stats().refused << " refused, " << run.network.stats().protocol_errors
            << " closed for protocol errors\n";
  const auto faults = [](const char* what, std::uint64_t count) {
    if (count > 0) std::cout << what << ": " << count << '\n';
  };
  faults("forces that were not finite, sent as zero", run.network.stats().forces_not_finite);
  faults("connections cut before their Hello, for another", run.network.stats().displaced);
  faults("connections without the server's key", run.network.stats().wrong_keys);
  faults("connections closed for being silent", run.network.stats().timeouts);
  faults("connections closed for too many messages", run.network.stats().too_fast);
  faults("datagrams that were spoilt, foreign or came twice, dropped",
         run.network.stats().datagrams_foreign + run.network.stats().datagrams_forged +
             run.network.stats().datagrams_replayed);
  faults("messages that a newer one had overtaken, dropped", run.network.stats().messages_late);
  faults("lines about bridges that were not logged", run.network.stats().unlogged);
  faults("lines about viewers that were not logged", run.viewers_unlogged);
  faults("errors inside the network thread", run.network.stats().internal_errors);
  faults("forces of bridges that came late, entered at their own step", force.late);
  faults("forces of bridges that were lost", force.lost);
  faults("forces of bridges above their stylus' max_force, lowered to it", force.bounded);
  if (force.withheld > 0) std::cout << withheld_line(force.withheld) << '\n';
  for (std::size_t s = 0; s < force.faults.size(); ++s) {
    for (const std::string& line : fault_lines(s, {}, force.faults[s])) std::cout << line << '\n';
  }
  faults("forces of bridges reduced, since they would put in more energy than hands gave",
         force.limited);
  if (run.columns.any()) {
    std::cout << "nodes whose columns were read: " << run.columns.loaded()
              << ", cache misses: " << force.cache_misses << '\n';
  }
  faults("nodes whose columns cannot be read", run.columns.failed());
  faults("steps that the deformation did not see", run.deformation.lost_steps());
  if (run.recorder == nullptr) return 0;
  if (!run.recorder->error().empty()) return 1;  // logged when it happened
  std::cout << "recorded: " << run.recorder->rows() << " steps in " << run.trace << std::endl;
  if (const std::uint64_t lost = run.recorder->lost()) {
    std::cerr << "irdm-server: error: " << lost << " steps are missing in the trace: "
              << "the disk was too slow; record to a faster one\n";
    return 1;
  }
  return 0;
}

}  // namespace irdm
