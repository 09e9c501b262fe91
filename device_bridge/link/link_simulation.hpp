#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "device_bridge/link/simulated_link.hpp"
#include "device_bridge/servo_loop.hpp"

namespace irdm {

/// The servo loops of a lockstep run behind a simulated link, on the simulated clock: they run as
/// in real time, and server and bridge hear of one another when a message would have arrived. One
/// thread; not real-time safe. The same parameters and answers, the same run to the bit.
class LinkSimulation {
 public:
  /// @param loops as restarted for the session; must outlive this object
  /// @param dt of the server's step [s]  @param rate of ticks [Hz]
  LinkSimulation(std::vector<ServoLoop>& loops, const SimulatedLink& link, double dt, double rate);

  /// The ticks of dt. Returns how many steps the server makes then.
  int run_ticks();
  /// What the server knows of a stylus by now, as sample k.
  StylusSample sample(std::size_t stylus, std::uint64_t k) const;
  /// What has come of forces that were solved here since the last call; null: nothing.
  const AppliedForces* applied(std::size_t stylus);
  /// What the server answered in its step: it goes on its way now.
  /// @param model null: none
  void answer(std::size_t stylus, const ServoInput& input, const ContactModel* model);
  /// Simulated [s].
  double time() const noexcept { return time_; }

 private:
  struct Up {
    StylusSample sample;
    std::optional<AppliedForces> applied;
  };
  struct Down {
    ServoInput input;
    std::optional<ContactModel> model;
  };
  struct Stylus {
    SimulatedChannel<Up> up;
    SimulatedChannel<Down> down;
    SimulatedOverruns overruns;
    ServoInput input;       ///< at the bridge
    StylusSample sample;    ///< at the server, and the next
    AppliedForces applied;  ///< the newest
    bool any_news = false;  ///< of them
  };
  void tick(std::size_t stylus, double now);

  std::vector<ServoLoop>& loops_;
  double dt_;
  int ticks_;  ///< a step
  SimulatedSteps server_;
  bool torque_ = false;  ///< the bridge asked for it
  std::vector<Stylus> styluses_;
  double time_ = 0.0;
};

}  // namespace irdm
