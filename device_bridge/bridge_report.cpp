#include "device_bridge/bridge_report.hpp"

#include <iomanip>
#include <sstream>

#include "common/realtime/clock.hpp"

namespace irdm {
namespace {

std::string percentiles_text(const Histogram& histogram) {
  if (histogram.count() == 0) return "none";
  const auto ms = [](std::int64_t ns) {
    return static_cast<double>(ns) / static_cast<double>(kNanosecondsPerMillisecond);
  };
  std::ostringstream text;
  text << std::fixed << std::setprecision(3) << "p50 " << ms(histogram.percentile(0.5)) << ", p90 "
       << ms(histogram.percentile(0.9)) << ", p99 " << ms(histogram.percentile(0.99)) << ", max "
       << ms(histogram.maximum()) << " ms";
  return text.str();
}

}  // namespace

std::string to_text(const BridgeReport& report) {
  const auto& [servo, client, scheduling, styluses, peak_force, filter] = report;
  const std::uint64_t reconnects = client.sessions > 0 ? client.sessions - 1 : 0;
  std::ostringstream text;
  text << std::fixed << std::setprecision(3);
  text << "session: " << servo.session_time << " s " << (servo.lockstep ? "lockstep" : "real time")
       << ", styluses " << styluses << ", sessions " << client.sessions << ", reconnects "
       << reconnects << ", protocol errors " << client.protocol_errors << ", stalls "
       << client.stalls << '\n';
  text << "samples: " << client.samples << " sent\n";
  text << "forces: " << client.forces << " received, " << client.gaps << " gaps, "
       << client.steps_missed << " steps missed, longest gap " << client.longest_gap << ", "
       << client.forces_old << " dropped\n";
  if (client.models + client.models_refused > 0) {
    text << "contact models: " << client.models << " used, " << client.models_refused
         << " invalid\n";
  }
  if (client.datagram_sessions > 0) {
    text << "datagrams: " << client.datagrams << " received in " << client.datagram_sessions
         << " sessions, " << client.datagrams_dropped << " dropped\n";
  }
  text << "round trip: " << percentiles_text(servo.lockstep ? servo.round_trip : client.round_trip)
       << '\n';
  if (servo.lockstep) {
    text << "servo: " << servo.ticks << " steps\n";
  } else {
    text << "servo: " << servo.ticks << " ticks, " << servo.missed << " missed, wake-up "
         << percentiles_text(servo.wakeup) << ", scheduling " << scheduling << '\n';
  }
  text << "peak force: " << peak_force << " N; safety filter: " << filter.demands << " forces and "
       << filter.readings << " readings not used, force dropped " << filter.trips
       << " times, faults " << filter.faults << '\n';
  return text.str();
}

}  // namespace irdm
