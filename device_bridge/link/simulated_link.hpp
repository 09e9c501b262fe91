#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "common/realtime/clock.hpp"

namespace irdm {

/// One direction between bridge and server on the simulated clock.
struct ChannelParameters {
  double delay = 0.0;      ///< one way [s]
  double jitter = 0.0;     ///< up to so much more, each message anew [s]
  double loss = 0.0;       ///< share of messages
  double bandwidth = 0.0;  ///< [bit/s]; 0: no bound. What finds it busy waits
};

/// A side that does nothing for a while, as on a busy machine.
struct Overruns {
  double every = 0.0;     ///< on average [s]; 0: never
  double longest = 0.0;   ///< each takes up to so long [s]
  double pause_at = 0.0;  ///< the process is stopped then [s] ...
  double pause = 0.0;     ///< ... for so long [s]
};

/// Table `bridge.link`: what lies between bridge and server in lockstep.
struct SimulatedLink {
  ChannelParameters channel = {};
  Overruns server_overruns = {};
  Overruns bridge_overruns = {};  ///< of each stylus; its device goes on showing its force
  std::uint64_t seed = 1;
};

/// One direction between the two; messages may overtake one another. The same seed, the same
/// channel.
template <typename Message>
class SimulatedChannel {
 public:
  SimulatedChannel(const ChannelParameters& link, std::uint64_t seed)
      : link_(link), random_(seed) {}

  /// @param now simulated time [s]  @param bytes of the message, headers included
  void send(double now, Message message, std::size_t bytes = 0) {
    const double luck = uniform();
    const double late = link_.jitter * uniform();
    sent_ = std::max(now, sent_);
    if (link_.bandwidth > 0.0) sent_ += 8.0 * static_cast<double>(bytes) / link_.bandwidth;
    if (luck < link_.loss) return;
    under_way_.push_back({sent_ + link_.delay + late, std::move(message)});
  }
  /// Gives what has arrived by now to `receive`, in the order in which it was sent.
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

  ChannelParameters link_;
  std::mt19937_64 random_;
  std::vector<Timed> under_way_;
  double sent_ = 0.0;  ///< when the last message was on its way [s]
};

/// Whether a side is in an overrun, period by period. The same seed, the same overruns.
class SimulatedOverruns {
 public:
  SimulatedOverruns(const Overruns& overruns, std::uint64_t seed)
      : overruns_(overruns), random_(seed) {}

  /// @param now simulated time at the end of a period of dt [s]
  bool at(double now, double dt) {
    if (now >= overruns_.pause_at && now < overruns_.pause_at + overruns_.pause) return true;
    if (now < until_) return true;
    if (overruns_.every > 0.0 && uniform() < dt / overruns_.every) {
      until_ = now + overruns_.longest * uniform();
    }
    return now < until_;
  }

 private:
  double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

  Overruns overruns_;
  std::mt19937_64 random_;
  double until_ = 0.0;
};

/// The server's steps with its overruns. What an overrun of at most kCatchUp has left out is made
/// up for at its end, as RealTimeClock does.
class SimulatedSteps {
 public:
  SimulatedSteps(const Overruns& overruns, double dt, std::uint64_t seed)
      : overruns_(overruns, seed), dt_(dt) {}

  /// How many steps are made now. @param now simulated time at the end of a period of dt [s]
  int due(double now) {
    if (overruns_.at(now, dt_)) {
      ++behind_;
      return 0;
    }
    const int behind = std::exchange(behind_, 0);
    return behind * dt_ <= kCatchUp ? 1 + behind : 1;
  }

 private:
  SimulatedOverruns overruns_;
  double dt_;
  int behind_ = 0;
};

}  // namespace irdm
