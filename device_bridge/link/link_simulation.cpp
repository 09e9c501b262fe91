#include "device_bridge/link/link_simulation.hpp"

#include <algorithm>
#include <cmath>

#include "common/wire/payload.hpp"

namespace irdm {
namespace {

// Of a message with its header.
std::size_t bytes_of(wire::MessageType type) {
  return wire::kHeaderSize + wire::payload_size(type).value();
}

// Of a force, which is longer where torque comes with it.
std::size_t bytes_of_force(bool with_torque) {
  return wire::kHeaderSize + wire::payload_size(wire::ForceMessage{.with_torque = with_torque});
}

std::int64_t simulated_ns(double seconds) {
  return std::llround(1e9 * seconds);
}

}  // namespace

LinkSimulation::LinkSimulation(std::vector<ServoLoop>& loops, const SimulatedLink& link, double dt,
                               double rate)
    : loops_(loops),
      dt_(dt),
      ticks_(std::max(1, static_cast<int>(std::lround(dt * rate)))),
      server_(link.server_overruns, dt, 4 * link.seed) {
  for (std::size_t i = 0; i < loops.size(); ++i) {
    torque_ = torque_ || loops[i].limits().max_torque > 0.0;
    const std::uint64_t seed = 4 * (link.seed + 1000 * i);
    styluses_.push_back({{link.channel, seed + 1},
                         {link.channel, seed + 2},
                         {link.bridge_overruns, seed + 3},
                         {},
                         {},
                         {}});
    styluses_[i].input.linked = true;
    loops[i].read(0.0);
    styluses_[i].sample = loops[i].take_sample(0);
  }
}

int LinkSimulation::run_ticks() {
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    for (int t = 1; t <= ticks_; ++t) tick(i, time_ + t * dt_ / ticks_);
  }
  time_ += dt_;
  for (Stylus& stylus : styluses_) {
    stylus.up.deliver(time_, [&](const Up& message) {
      if (message.sample.sequence > stylus.sample.sequence) stylus.sample = message.sample;
      if (!message.applied) return;
      if (stylus.applied.count > 0 && message.applied->step <= stylus.applied.step) return;
      stylus.applied = *message.applied;
      stylus.any_news = true;
    });
  }
  return server_.due(time_);
}

// As ServoThread::render_tick().
void LinkSimulation::tick(std::size_t i, double now) {
  Stylus& stylus = styluses_[i];
  ServoLoop& loop = loops_[i];
  if (stylus.overruns.at(now, dt_ / ticks_)) return;
  const std::int64_t now_ns = simulated_ns(now);
  loop.read(now);
  Up message{loop.take_sample(now_ns), std::nullopt};
  stylus.down.deliver(now, [&](const Down& answer) {
    if (answer.model) loop.receive(*answer.model, now_ns);
    const bool newer =
        !stylus.input.any_force || answer.input.force.force_step > stylus.input.force.force_step;
    if (newer) stylus.input = answer.input;
  });
  loop.end_steps(now_ns);
  loop.apply(now_ns, stylus.input);
  std::size_t bytes = bytes_of(wire::MessageType::kSample);
  if (const AppliedForces* applied = loop.applied()) {
    message.applied = *applied;
    bytes += bytes_of(wire::MessageType::kAppliedForces);
  }
  stylus.up.send(now, message, bytes);
}

StylusSample LinkSimulation::sample(std::size_t stylus, std::uint64_t k) const {
  StylusSample sample = styluses_[stylus].sample;
  sample.sequence = k;
  return sample;
}

const AppliedForces* LinkSimulation::applied(std::size_t stylus) {
  return std::exchange(styluses_[stylus].any_news, false) ? &styluses_[stylus].applied : nullptr;
}

void LinkSimulation::answer(std::size_t stylus, const ServoInput& input,
                            const ContactModel* model) {
  std::size_t bytes = bytes_of_force(torque_);
  if (model != nullptr) bytes += bytes_of(wire::MessageType::kContactModel);
  styluses_[stylus].down.send(time_, {input, model ? std::optional(*model) : std::nullopt}, bytes);
}

}  // namespace irdm
