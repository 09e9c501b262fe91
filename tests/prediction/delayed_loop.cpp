#include "tests/prediction/delayed_loop.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "device_bridge/contact/contact_predictor.hpp"
#include "device_bridge/safety/safety_filter.hpp"

namespace irdm::test {
namespace {

/// From one side to the other; messages may overtake one another.
template <typename Message>
class Way {
 public:
  Way(const LoopLink& link, std::uint64_t seed) : link_(link), random_(seed) {}

  void send(double now, Message message) {
    const double luck = uniform();
    const double late = link_.jitter * uniform();
    if (luck < link_.loss) return;
    under_way_.push_back({now + link_.delay + late, std::move(message)});
  }
  template <typename Receive>
  void deliver(double now, const Receive& receive) {
    constexpr double kRounding = 1e-9;
    for (std::size_t i = 0; i < under_way_.size();) {
      if (under_way_[i].time > now + kRounding) {
        ++i;
        continue;
      }
      receive(under_way_[i].message);
      under_way_.erase(under_way_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

 private:
  struct Timed {
    double time;
    Message message;
  };
  double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

  LoopLink link_;
  std::mt19937_64 random_;
  std::vector<Timed> under_way_;
};

struct Up {
  int step = 0;
  Vector3 tip = Vector3::Zero();
  std::vector<Vector3> forces;  ///< of this step and those before it
};

struct Down {
  int step = 0;
  Vector3 force = Vector3::Zero();
  ContactState contact = ContactState::kFree;
  ContactModel model;
};

/// What the server knows of one stylus, step by step.
struct Known {
  std::vector<std::optional<Vector3>> tip;
  std::vector<std::optional<Vector3>> force;
  int newest = -1;
  Vector3 newest_tip = Vector3::Zero();
};

class Loop {
 public:
  Loop(const LoopSetup& setup, LoopMode mode, const LoopLink& link)
      : setup_(setup), mode_(mode), simulation_(setup.config), dt_(simulation_.dt()) {
    const double longest = link.delay + link.jitter + link.slack;
    if (mode == LoopMode::kPredict) behind_ = static_cast<int>(std::ceil(longest / dt_ - 1e-9));
    horizon_ = std::min(2 * behind_ + 4, kMaxHorizon);
    const std::size_t count = setup.hands.size();
    for (std::size_t s = 0; s < count; ++s) {
      hands_.emplace_back(setup.hands[s].hand, setup.hands[s].target(0.0));
      up_.emplace_back(link, 100 + s);
      down_.emplace_back(link, 200 + s);
    }
    const auto steps = static_cast<std::size_t>(setup.steps);
    known_.assign(count, {std::vector<std::optional<Vector3>>(steps),
                          std::vector<std::optional<Vector3>>(steps)});
    predictors_.resize(count);
    shown_.assign(count, Vector3::Zero());
    asked_.resize(count);
    filters_.assign(count, SafetyFilter({}));
    for (SafetyFilter& each : filters_) each.arm();
    newest_down_.assign(count, -1);
    energy_.assign(count, 0.0);
    commands_.resize(count);
    run_.force.resize(count);
    run_.tip.resize(count);
    run_.lowest_energy.assign(count, 0.0);
  }

  LoopRun run() {
    for (int t = 0; t < setup_.steps; ++t) {
      const double now = (t + 1) * dt_;
      for (std::size_t s = 0; s < hands_.size(); ++s) bridge(s, t, now);
      for (std::size_t s = 0; s < hands_.size(); ++s) receive(s, t - behind_, now);
      if (t >= behind_) serve(t - behind_, now);
      for (std::size_t s = 0; s < hands_.size(); ++s) {
        down_[s].deliver(now, [&](const Down& message) { take(s, message); });
        if (setup_.filtered) filter(s, now);
        run_.force[s].push_back(shown_[s]);
      }
    }
    for (const Known& known : known_) {
      if (mode_ != LoopMode::kPredict) break;
      for (int k = 0; k < setup_.steps - 2 * behind_ - 10; ++k) {
        run_.lost += known.force[static_cast<std::size_t>(k)] ? 0 : 1;
      }
    }
    return std::move(run_);
  }

 private:
  void bridge(std::size_t s, int t, double now) {
    const Vector3 before = hands_[s].position();
    hands_[s].advance(dt_, setup_.hands[s].target(now), shown_[s]);
    const Vector3 tip = hands_[s].position();
    energy_[s] -= shown_[s].dot(tip - before);
    run_.lowest_energy[s] = std::min(run_.lowest_energy[s], energy_[s]);
    Up message{t, tip, {}};
    if (mode_ == LoopMode::kPredict) {
      const auto answer = predictors_[s].solve(static_cast<std::uint64_t>(t), tip);
      run_.unknown += answer.known ? 0 : 1;
      asked_[s].force = -answer.force;
      asked_[s].contact = answer.state;
      asked_[s].normal = answer.normal;
      shown_[s] = asked_[s].force;
      for (int i = 0; i < setup_.repeats && i <= t; ++i) {
        message.forces.push_back(predictors_[s].applied(static_cast<std::uint64_t>(t - i)));
      }
    }
    run_.tip[s].push_back(tip);
    up_[s].send(now, message);
  }

  // The age of what a demand contains is none of this loop's business.
  void filter(std::size_t s, double now) {
    const auto now_ns = std::llround(1e9 * now);
    asked_[s].linked = asked_[s].any = true;
    asked_[s].sample_time_ns = now_ns;
    shown_[s] = filters_[s].step(now_ns, {.tip = run_.tip[s].back()}, asked_[s]);
  }

  void take(std::size_t s, const Down& message) {
    if (mode_ == LoopMode::kPredict) {
      const bool good = check(message.model) == ContactModelFault::kNone;
      run_.refused += good ? 0 : 1;
      if (good) predictors_[s].receive(message.model);
    } else if (message.step > newest_down_[s]) {
      newest_down_[s] = message.step;
      asked_[s].force = shown_[s] = message.force;
      asked_[s].contact = message.contact;
    }
  }

  void receive(std::size_t s, int coming, double now) {
    Known& known = known_[s];
    up_[s].deliver(now, [&](const Up& message) {
      if (message.step > known.newest) {
        known.newest = message.step;
        known.newest_tip = message.tip;
      }
      known.tip[static_cast<std::size_t>(message.step)] = message.tip;
      for (int i = 0; i < static_cast<int>(message.forces.size()); ++i) {
        auto& force = known.force[static_cast<std::size_t>(message.step - i)];
        if (force) continue;
        const int age = coming - 1 - (message.step - i);
        if (age >= kMaxHorizon) continue;
        force = message.forces[static_cast<std::size_t>(i)];
        if (age < 0 || force->isZero(0.0)) continue;
        simulation_.enter_late(s, *force, age);
        ++run_.late;
      }
    });
  }

  void serve(int k, double now) {
    const auto step = static_cast<std::size_t>(k);
    for (std::size_t s = 0; s < hands_.size(); ++s) {
      Known& known = known_[s];
      StylusCommand& command = commands_[s];
      command.present = known.newest >= 0;
      command.buttons = setup_.hands[s].grab ? kGrabButton : 0;
      if (mode_ == LoopMode::kPredict) {
        command.tip = known.tip[step].value_or(command.tip);
        command.bridged = known.force[step].value_or(Vector3::Zero());
      } else {
        command.tip = known.newest_tip;
      }
    }
    simulation_.step(commands_, record_);
    for (std::size_t s = 0; s < hands_.size(); ++s) {
      Down message;
      message.step = k;
      message.force = record_.stylus[s].force;
      message.contact = record_.stylus[s].contact;
      if (mode_ == LoopMode::kDirect) {
        asked_[s].force = shown_[s] = message.force;
        asked_[s].contact = message.contact;
        continue;
      }
      if (mode_ == LoopMode::kHold) {
        down_[s].send(now, message);
        continue;
      }
      simulation_.foresee(s, commands_[s].tip, horizon_, message.model);
      for (int i = 0; i < 64 && i <= k; ++i) {
        if (!known_[s].force[step - static_cast<std::size_t>(i)]) {
          message.model.missing |= std::uint64_t{1} << i;
        }
      }
      down_[s].send(now, message);
    }
  }

  const LoopSetup& setup_;
  LoopMode mode_;
  Simulation simulation_;
  double dt_;
  int behind_ = 0;
  int horizon_ = 0;
  std::vector<VirtualHand> hands_;
  std::vector<Way<Up>> up_;
  std::vector<Way<Down>> down_;
  std::vector<Known> known_;
  std::vector<ContactPredictor> predictors_;
  std::vector<Vector3> shown_;
  std::vector<ForceDemand> asked_;
  std::vector<SafetyFilter> filters_;
  std::vector<int> newest_down_;
  std::vector<double> energy_;
  std::vector<StylusCommand> commands_;
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

}  // namespace irdm::test
