#include "tests/prediction/delayed_loop.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "common/realtime/clock.hpp"
#include "device_bridge/contact/bridge_contact.hpp"
#include "device_bridge/safety/safety_filter.hpp"
#include "server/threads/prediction_throttle.hpp"
#include "simulation/step/bridged_stylus.hpp"
#include "simulation/step/prediction_turns.hpp"

namespace irdm::test {
namespace {

constexpr std::uint64_t kSession = 1;
// When buttons go down [s].
constexpr double kGrabTime = 0.05;

struct Up {
  std::uint64_t sequence = 0;
  double time = 0.0;  ///< [s]
  std::uint32_t buttons = 0;
  Vector3 tip = Vector3::Zero();
  AppliedForces applied;
};

struct Down {
  int step = 0;
  double sample_time = 0.0;  ///< of the newest sample that it contains [s]
  Vector3 force = Vector3::Zero();
  ContactState contact = ContactState::kFree;
  ContactModel model;
};

/// One stylus: its hand and device, the way to the server and back, and what is known at either
/// end.
struct Stylus {
  Stylus(const LoopHand& loop_hand, const LoopLink& link, std::uint64_t seed, double dt,
         const LoopSetup& setup)
      : hand(loop_hand.hand, loop_hand.target(0.0)),
        up(link, 100 + seed + 1000 * setup.seed),
        down(link, 200 + seed + 1000 * setup.seed),
        contact(dt, std::llround(1e9 * dt)),
        busy(setup.bridge_overruns, 300 + seed + 1000 * setup.seed),
        filter({.needed_success = setup.needed_success}, setup.guards) {
    filter.arm();
  }

  VirtualHand hand;
  SimulatedChannel<Up> up;
  SimulatedChannel<Down> down;
  BridgeContact contact;
  SimulatedOverruns busy;
  SafetyFilter filter;
  ForceDemand asked;
  Vector3 shown = Vector3::Zero();
  int newest_down = -1;
  double energy = 0.0;
  AppliedHistory lies;
  // At the server:
  AppliedHistory history{kSession};
  std::uint64_t newest_up = 0;
  double sample_time = 0.0;
  StylusCommand command;
};

/// The server's steps when each takes longer than nothing, by the schedule of RealTimeClock.
class TimedSteps {
 public:
  TimedSteps(double dt, double length)
      : length_ns_(std::llround(1e9 * length * dt)),
        schedule_(0, std::llround(1e9 * dt), std::llround(kCatchUp / dt)) {}

  /// Makes the steps that begin by now. @param step double(double end, bool behind)
  template <typename Step>
  void run(std::int64_t now_ns, const Step& step) {
    while (begin_ns_ <= now_ns) {
      const std::int64_t end_ns = begin_ns_ + length_ns_;
      step(1e-9 * static_cast<double>(end_ns), schedule_.behind());
      begin_ns_ = std::max(schedule_.next(end_ns), end_ns);
    }
  }

 private:
  std::int64_t length_ns_;
  PeriodicSchedule schedule_;
  std::int64_t begin_ns_ = 0;
};

class Loop {
 public:
  Loop(const LoopSetup& setup, LoopMode mode, const LoopLink& link)
      : setup_(setup),
        mode_(mode),
        simulation_(setup.config),
        dt_(simulation_.dt()),
        turns_(dt_),
        timed_(dt_, setup.server_step),
        server_(setup.server_overruns, dt_, 400 + 1000 * setup.seed) {
    if (setup.needed_success > 0.0) lead_ = static_cast<int>(std::lround(kLinkTime / dt_));
    const std::size_t count = setup.hands.size();
    for (std::size_t s = 0; s < count; ++s) {
      styluses_.push_back(std::make_unique<Stylus>(setup.hands[s], link, s, dt_, setup));
      bridged_.emplace_back(simulation_, s);
    }
    commands_.resize(count);
    run_.force.resize(count);
    run_.on_object.resize(count);
    told_tips_.resize(count);
    run_.touching.resize(count);
    run_.tip.resize(count);
    run_.peak_asked.assign(count, 0.0);
    run_.lowest_energy.assign(count, 0.0);
    run_.lowest_gain.assign(count, 1.0);
  }

  LoopRun run() {
    for (int t = 0; t < lead_ + setup_.steps; ++t) {
      const double now = (t + 1) * dt_;
      for (std::size_t s = 0; s < styluses_.size(); ++s) bridge(s, t, now);
      if (setup_.server_step > 0.0) {
        timed_.run(to_ns(now), [&](double end, bool behind) { serve(t, now, end, behind); });
      } else {
        for (int due = server_.due(now); due > 0; --due) serve(t, now, now, due > 1);
      }
      for (std::size_t s = 0; s < styluses_.size(); ++s) {
        styluses_[s]->down.deliver(now, [&](const Down& message) { take(s, message, now); });
        if (setup_.filtered && mode_ != LoopMode::kPredict) filter(s, now);
        run_.force[s].push_back(styluses_[s]->shown);
      }
    }
    judge_lies();
    for (const BridgedStylus& stylus : bridged_) {
      run_.late += static_cast<int>(stylus.late());
      run_.lost += static_cast<int>(stylus.lost());
      run_.withheld += static_cast<int>(stylus.withheld());
    }
    for (const auto& stylus : styluses_) {
      run_.withheld_at_bridge += static_cast<int>(stylus->contact.withheld());
    }
    for (auto* course : {&run_.force, &run_.tip}) {
      for (auto& of_hand : *course) of_hand.erase(of_hand.begin(), of_hand.begin() + lead_);
    }
    return std::move(run_);
  }

 private:
  static std::int64_t to_ns(double seconds) { return std::llround(1e9 * seconds); }

  void bridge(std::size_t s, int t, double now) {
    Stylus& stylus = *styluses_[s];
    const Vector3 before = stylus.hand.position();
    const double script_time = now - lead_ * dt_;
    const LoopHand& hand = setup_.hands[s];
    stylus.hand.advance(dt_, hand.target(std::max(0.0, script_time)),
                        hand.lie ? Vector3::Zero() : stylus.shown);
    const Vector3 tip = stylus.hand.position();
    if (!hand.lie) stylus.energy -= stylus.shown.dot(tip - before);
    run_.lowest_energy[s] = std::min(run_.lowest_energy[s], stylus.energy);
    run_.tip[s].push_back(tip);
    run_.fastest_hand = std::max(run_.fastest_hand, (tip - before).norm() / dt_);
    if (!hand.lie && stylus.busy.at(now, dt_)) return;
    const bool grab = hand.grab && script_time > kGrabTime;
    Up message{static_cast<std::uint64_t>(t), now, grab ? kGrabButton : 0, tip, {}};
    if (mode_ == LoopMode::kPredict) {
      const bool news = stylus.contact.tick(to_ns(now), tip);
      want(s, now);
      if (setup_.filtered) filter(s, now);
      stylus.contact.shown(stylus.shown);
      if (news) message.applied = stylus.contact.applied();
      if (news && hand.lie) lie(s, tip, message.applied);
    }
    stylus.up.send(now, message);
  }

  // Of each step once.
  void lie(std::size_t s, const Vector3& tip, AppliedForces& applied) {
    Stylus& stylus = *styluses_[s];
    const LoopHand& hand = setup_.hands[s];
    AppliedForces lies = applied;
    for (int i = lies.count - 1; i >= 0; --i) {
      const std::uint64_t step = lies.step - static_cast<std::uint64_t>(i);
      AppliedForce& one = lies.past[static_cast<std::size_t>(i)];
      if (const AppliedForce* before = stylus.lies.find(step)) {
        one = *before;
      } else {
        one = hand.lie(one, record_.object[0]);
      }
    }
    std::vector<std::optional<Vector3>>& tips = told_tips_[s];
    if (lies.count > 0) {
      tips.resize(std::max<std::size_t>(tips.size(), lies.step + 1));
      tips[lies.step] = tip;
    }
    stylus.lies.take(lies);
    applied = lies;
  }

  // Without a filter, what is too old is shown no more.
  void want(std::size_t s, double now) {
    Stylus& stylus = *styluses_[s];
    const BridgeContact::ForceCommand& wanted = stylus.contact.wanted();
    const bool old = wanted.any && to_ns(now) - wanted.content_ns > wanted.horizon_ns;
    run_.unknown += old ? 1 : 0;
    stylus.asked = {.any = wanted.any,
                    .sample_time_ns = wanted.content_ns,
                    .horizon_ns = wanted.horizon_ns,
                    .solved_here = true,
                    .solved_ns = wanted.solved_ns,
                    .energy = wanted.energy,
                    .contact = wanted.contact,
                    .force = wanted.force,
                    .normal = wanted.normal};
    run_.peak_asked[s] = std::max(run_.peak_asked[s], wanted.force.norm());
    stylus.shown = old ? Vector3::Zero() : wanted.force;
  }

  void filter(std::size_t s, double now) {
    Stylus& stylus = *styluses_[s];
    stylus.asked.linked = true;
    if (mode_ != LoopMode::kPredict) {
      stylus.asked.any = true;
      stylus.asked.horizon_ns = setup_.hold_horizon_ns;
    }
    const DeviceReading reading{.tip = run_.tip[s].back()};
    stylus.shown = stylus.filter.step(to_ns(now), reading, stylus.asked).force;
    run_.lowest_gain[s] = std::min(run_.lowest_gain[s], stylus.filter.gain());
  }

  void take(std::size_t s, const Down& message, double now) {
    Stylus& stylus = *styluses_[s];
    if (mode_ == LoopMode::kPredict) {
      const bool good = check(message.model) == ContactModelFault::kNone;
      run_.refused += good ? 0 : 1;
      if (good) stylus.contact.receive(message.model, to_ns(now));
    } else if (message.step > stylus.newest_down) {
      stylus.newest_down = message.step;
      stylus.asked.force = stylus.shown = message.force;
      stylus.asked.contact = message.contact;
      stylus.asked.sample_time_ns = to_ns(message.sample_time);
    }
  }

  void receive(Stylus& stylus, double now) {
    stylus.up.deliver(now, [&](const Up& message) {
      stylus.history.take(message.applied);
      if (stylus.command.present && message.sequence <= stylus.newest_up) return;
      stylus.command.present = true;
      stylus.command.tip = message.tip;
      stylus.command.buttons = message.buttons;
      stylus.newest_up = message.sequence;
      stylus.sample_time = message.time;
    });
  }

  // Messages that have come by `now` count, and its own leave at `end`.
  void serve(int t, double now, double end, bool behind) {
    for (std::size_t s = 0; s < styluses_.size(); ++s) {
      Stylus& stylus = *styluses_[s];
      receive(stylus, now);
      commands_[s] = bridged_[s].next(stylus.command, mode_ == LoopMode::kPredict ? kSession : 0,
                                      stylus.history);
    }
    simulation_.step(commands_, record_);
    judge();
    if (mode_ != LoopMode::kPredict) {
      for (std::size_t s = 0; s < styluses_.size(); ++s) answer(s, t, now);
      return;
    }
    follow_throttle(end);
    if (!throttle_.due(behind)) return;
    turns_.step(styluses_.size(), [&](std::size_t s, int& budget) {
      Down message;
      if (!styluses_[s]->command.present) return false;
      if (!bridged_[s].predict_horizon(message.model, budget)) return false;
      styluses_[s]->down.send(end, message);
      return true;
    });
  }

  // As ForceThread: once a second it is judged how many steps took longer than dt.
  void follow_throttle(double end) {
    ++steps_;
    if (end < second_) return;
    throttle_.update(steps_, setup_.server_step > 1.0 ? steps_ : 0);
    steps_ = 0;
    second_ = end + 1.0;
  }

  void judge() {
    for (std::size_t s = 0; s < styluses_.size(); ++s) {
      run_.peak_on_object = std::max(run_.peak_on_object, record_.stylus[s].force.norm());
    }
    for (std::size_t s = 0; s < styluses_.size(); ++s) {
      run_.on_object[s].push_back(-record_.stylus[s].force);
      run_.touching[s].push_back(record_.stylus[s].contact != ContactState::kFree);
    }
    for (const LateForce& late : record_.late.view()) {
      const auto s = static_cast<std::size_t>(late.stylus);
      const std::size_t steps = run_.on_object[s].size();
      const auto ago = static_cast<std::size_t>(late.age) + 2;  // the list has this step, too
      if (ago <= steps)
        run_.on_object[s][steps - ago] += record_.object[0].orientation * late.force;
      run_.peak_on_object = std::max(run_.peak_on_object, late.force.norm());
    }
    run_.fastest_object = std::max(run_.fastest_object, record_.object[0].velocity.norm());
    double excess = simulation_.object(0).energy();
    for (std::size_t s = 0; s < styluses_.size(); ++s) {
      if (!setup_.hands[s].lie) excess -= styluses_[s]->energy;
    }
    excess_.push_back(excess);
  }

  // Work of what acted, late or not, on the way that the hand went while its device showed it.
  void judge_lies() {
    for (std::size_t s = 0; s < styluses_.size(); ++s) {
      if (!setup_.hands[s].lie) continue;
      const std::vector<std::optional<Vector3>>& tips = told_tips_[s];
      double work = 0.0;
      for (std::size_t k = 1; k < excess_.size(); ++k) {
        if (k < tips.size() && tips[k] && tips[k - 1]) {
          const Vector3 way = *tips[k] - *tips[k - 1];
          work += run_.on_object[s][k - 1].dot(way);
        }
        excess_[k] -= work;
      }
    }
    for (double excess : excess_) {
      run_.energy_from_nowhere = std::max(run_.energy_from_nowhere, excess - excess_[0]);
    }
  }

  void answer(std::size_t s, int t, double now) {
    Stylus& stylus = *styluses_[s];
    Down message;
    message.step = t;
    message.sample_time = stylus.sample_time;
    message.force = record_.stylus[s].force;
    message.contact = record_.stylus[s].contact;
    if (mode_ == LoopMode::kDirect) {
      stylus.asked.force = stylus.shown = message.force;
      stylus.asked.contact = message.contact;
      stylus.asked.sample_time_ns = to_ns(now);
      return;
    }
    stylus.down.send(now, message);
  }

  const LoopSetup& setup_;
  LoopMode mode_;
  Simulation simulation_;
  double dt_;
  PredictionTurns turns_;
  TimedSteps timed_;
  SimulatedSteps server_;
  PredictionThrottle throttle_;
  std::uint64_t steps_ = 0;  ///< since the throttle was told
  double second_ = 1.0;      ///< when it is told next [s]
  int lead_ = 0;             ///< steps before all begins
  std::vector<std::unique_ptr<Stylus>> styluses_;
  std::vector<BridgedStylus> bridged_;
  std::vector<StylusCommand> commands_;
  /// Where lying hands are in the steps that their bridges tell of [m], W.
  std::vector<std::vector<std::optional<Vector3>>> told_tips_;
  std::vector<double> excess_;  ///< of the energy over what hands did [J]
  StepRecord record_;
  LoopRun run_;
};

}  // namespace

// Without delay the direct loop is the link's: what is sent arrives at once.
LoopRun run_loop(const LoopSetup& setup, LoopMode mode, const LoopLink& link) {
  return Loop(setup, mode, mode == LoopMode::kDirect ? LoopLink{} : link).run();
}

double peak(const LoopRun& run, std::size_t hand) {
  double largest = 0.0;
  for (const Vector3& force : run.force[hand]) largest = std::max(largest, force.norm());
  return largest;
}

double largest_error(const LoopRun& run, const LoopRun& reference, std::size_t hand) {
  double largest = 0.0;
  for (std::size_t k = 0; k < reference.force[hand].size(); ++k) {
    largest = std::max(largest, (run.force[hand][k] - reference.force[hand][k]).norm());
  }
  return largest / peak(reference, hand);
}

double rms_error(const LoopRun& run, const LoopRun& reference, std::size_t hand) {
  double difference = 0.0;
  double whole = 0.0;
  for (std::size_t k = 0; k < reference.force[hand].size(); ++k) {
    difference += (run.force[hand][k] - reference.force[hand][k]).squaredNorm();
    whole += reference.force[hand][k].squaredNorm();
  }
  return std::sqrt(difference / whole);
}

}  // namespace irdm::test
