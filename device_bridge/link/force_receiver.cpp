#include "device_bridge/link/force_receiver.hpp"

#include <algorithm>
#include <cstdlib>

#include "common/wire/protocol_error.hpp"

namespace irdm {
namespace {

wire::Quantiles quantiles(const Histogram& histogram) {
  const auto microseconds = [](std::int64_t ns) {
    return static_cast<float>(std::max<std::int64_t>(ns, 0)) / 1000.0F;
  };
  return {microseconds(histogram.percentile(0.5)), microseconds(histogram.percentile(0.99)),
          microseconds(histogram.maximum())};
}

}  // namespace

void ForceReceiver::sent(const StylusSample& sample) noexcept {
  if (!first_sample_) first_sample_ = sample.sequence;
  newest_sample_ = sample.sequence;
}

bool ForceReceiver::take(const StylusForce& force, std::int64_t now_ns, ClientReport& report) {
  check_order(force);
  check_time(force, now_ns);
  if (!news(force)) {
    ++report.forces_old;
    return false;
  }
  ++report.forces;
  count_gap(force.force_step, report);
  force_step_ = force.force_step;
  // Several steps may answer the same sample; only the first of them is its round trip.
  if (!lockstep_ && (!answered_ || force.sample_sequence > *answered_)) {
    measure(now_ns - force.sample_time_ns, report);
  }
  if (input_.any_force) age_.add(now_ns - input_.force.sample_time_ns);
  answered_ = force.sample_sequence;
  input_.any_force = true;
  input_.force = force;
  return true;
}

void ForceReceiver::check_order(const StylusForce& force) const {
  const bool said = first_sample_ && force.sample_sequence <= newest_sample_;
  if (!said) {
    throw wire::ProtocolError(wire::ProtocolFault::kUnexpected,
                              "a force for a sample that was not sent");
  }
  if (force_step_ && (force.force_step < *force_step_ || force.sample_sequence < *answered_)) {
    throw wire::ProtocolError(wire::ProtocolFault::kBackward,
                              "a force that is older than the last");
  }
}

// It decides how old the force is. In lockstep the time is that of the simulation.
void ForceReceiver::check_time(const StylusForce& force, std::int64_t now_ns) const {
  if (force.sample_time_ns >= 0 && (lockstep_ || force.sample_time_ns <= now_ns)) return;
  throw wire::ProtocolError(wire::ProtocolFault::kUnexpected,
                            "a force for a sample of the future, or of no time");
}

// A run that is paused answers newer samples in the step where it stands.
bool ForceReceiver::news(const StylusForce& force) const noexcept {
  const bool ours = force.sample_sequence >= *first_sample_;
  return ours &&
         (!force_step_ || force.force_step > *force_step_ || force.sample_sequence > *answered_);
}

void ForceReceiver::measure(std::int64_t round_trip_ns, ClientReport& report) noexcept {
  report.round_trip.add(round_trip_ns);
  round_trip_.add(round_trip_ns);
  if (last_round_trip_ns_) report.jitter.add(std::abs(round_trip_ns - *last_round_trip_ns_));
  last_round_trip_ns_ = round_trip_ns;
}

void ForceReceiver::count_gap(std::uint64_t step, ClientReport& report) noexcept {
  if (!force_step_ || step <= *force_step_ + 1) return;
  const std::uint64_t gap = step - *force_step_ - 1;
  ++report.gaps;
  report.steps_missed += gap;
  report.longest_gap = std::max(report.longest_gap, gap);
}

std::optional<wire::Report> ForceReceiver::report(std::uint16_t slot) noexcept {
  if (round_trip_.count() == 0) return std::nullopt;
  const wire::Report report{slot, quantiles(round_trip_), quantiles(age_)};
  round_trip_ = Histogram{};
  age_ = Histogram{};
  return report;
}

}  // namespace irdm
