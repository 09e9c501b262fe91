#include "device_bridge/contact/step_pacer.hpp"

#include <algorithm>
#include <cmath>

namespace irdm {
namespace {

// Ahead of the server at the start, before anything is known of the way [steps].
constexpr std::uint64_t kFirstLead = 2;
// A force that is there when its step is made came early enough; one step more is kept in reserve.
constexpr std::int64_t kLeast = 0;
constexpr std::int64_t kReserve = 1;
// What is borne of either while in contact.
constexpr std::int64_t kTolerance = 8;
// Ahead of a server that is slower than real time; beyond it, its contact models would not reach
// the bridge's steps much longer [s].
constexpr double kLongestLead = 0.02;
// Ahead of the server, beyond which nothing fits together any more [steps].
constexpr std::uint64_t kFarthest = 200;
// For how many steps all forces have to be early before some of that is given up.
constexpr std::uint64_t kPatience = 100;

}  // namespace

StepPacer::StepPacer(double dt, std::int64_t tick_ns) noexcept
    : dt_ns_(std::max<std::int64_t>(1, std::llround(1e9 * dt))),
      tick_ns_(tick_ns),
      longest_lead_(std::max(kLeast + kReserve + kTolerance + 1,
                             static_cast<std::int64_t>(std::llround(kLongestLead / dt)))) {}

void StepPacer::hear(std::uint64_t step, std::optional<std::uint64_t> newest, bool in_contact,
                     std::int64_t now_ns) noexcept {
  if (!running_) return begin(step, now_ns);
  // Who is behind the server knows nothing of the coming step. What ends in this tick counts: a
  // model may come in each tick.
  const std::uint64_t reached = step_ + due_count(now_ns);
  if (step >= reached || reached - step > kFarthest) return begin(step, now_ns);
  if (!newest || *newest < settled_from_ || *newest > step_) return;
  keep_pace(step, static_cast<std::int64_t>(*newest - step), in_contact);
}

void StepPacer::begin(std::uint64_t step, std::int64_t now_ns) noexcept {
  running_ = true;
  step_ = step + kFirstLead - 1;
  next_end_ns_ = now_ns + tick_ns_;
  settled_from_ = step_ + 1;
  first_heard_.reset();
}

void StepPacer::keep_pace(std::uint64_t step, std::int64_t lead, bool in_contact) noexcept {
  const std::int64_t tolerance = in_contact ? kTolerance : 0;
  least_lead_ = first_heard_ ? std::min(least_lead_, lead) : lead;
  if (!first_heard_) first_heard_ = step;
  std::int64_t change = 0;
  if (lead < kLeast - tolerance) {
    change = std::min<std::int64_t>(kLeast - lead, kMost);
  } else if (lead > longest_lead_) {
    change = kLeast + kReserve + tolerance - lead;
  } else if (step >= *first_heard_ + kPatience) {
    const std::int64_t wanted = kLeast + kReserve;
    if (least_lead_ > wanted + tolerance) change = wanted - least_lead_;
    first_heard_.reset();
  }
  if (change == 0) return;
  next_end_ns_ -= change * dt_ns_;
  settled_from_ = step_ + 1;
  if (change > 0) settled_from_ += static_cast<std::uint64_t>(change);
  first_heard_.reset();
}

std::uint64_t StepPacer::due_count(std::int64_t now_ns) const noexcept {
  const std::int64_t late_ns = now_ns + tick_ns_ / 2 - next_end_ns_;
  return late_ns < 0 ? 0 : static_cast<std::uint64_t>(late_ns / dt_ns_ + 1);
}

int StepPacer::due(std::int64_t now_ns) noexcept {
  if (!running_) return 0;
  const std::uint64_t count = due_count(now_ns);
  if (count > kMost) {  // it has slept: what it knows is of another time
    running_ = false;
    return 0;
  }
  step_ += count;
  next_end_ns_ += static_cast<std::int64_t>(count) * dt_ns_;
  return static_cast<int>(count);
}

std::int64_t StepPacer::end_of(std::uint64_t step, std::int64_t now_ns) const noexcept {
  if (step > step_) return now_ns;
  const std::uint64_t ago = std::min<std::uint64_t>(step_ - step, std::uint64_t{1} << 30);
  return std::min(now_ns, next_end_ns_ - static_cast<std::int64_t>(ago + 1) * dt_ns_);
}

}  // namespace irdm
