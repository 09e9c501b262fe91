#pragma once

#include <functional>
#include <vector>

#include "common/contact/applied_forces.hpp"
#include "device_bridge/link/simulated_link.hpp"
#include "device_bridge/safety/guards.hpp"
#include "device_bridge/safety/safety_filter.hpp"
#include "device_bridge/virtual_stylus.hpp"
#include "simulation/step/simulation.hpp"

namespace irdm::test {

enum class LoopMode {
  kDirect,   ///< hand and simulation in one step, nothing in between
  kHold,     ///< the server's force arrives late and is held
  kPredict,  ///< the contact is solved at the bridge
};

using LoopLink = ChannelParameters;

/// A hand, what it wants, and its button.
struct LoopHand {
  HandParameters hand = {};
  std::function<Vector3(double)> target;  ///< over time [m], W
  bool grab = false;
  /// What its bridge tells of a step in place of the truth; none: the truth. Its hand does not feel
  /// that force; its work is that of what acts, along the way on which the server has it.
  std::function<AppliedForce(const AppliedForce& truth, const ObjectRecord& object)> lie = {};
};

inline constexpr double kLinkTime = 0.25;  ///< [s]

struct LoopSetup {
  SimulationConfig config;
  std::vector<LoopHand> hands;
  int steps = 1500;
  bool filtered = false;  ///< a safety filter before each device, a tick a step
  Guards guards;          ///< of that filter
  std::int64_t hold_horizon_ns = ForceDemand::kHoldHorizonNs;  ///< of a held force, for it
  /// Of the link, for it to arm [share]; if any, all begins kLinkTime later, when it may have.
  double needed_success = 0.0;
  /// Of each server step [dt]; 0: none, and steps come as server_overruns has them.
  double server_step = 0.0;
  Overruns server_overruns;
  Overruns bridge_overruns;  ///< of each bridge; the device goes on showing its force
  std::uint64_t seed = 0;    ///< of overruns and link
};

/// What happened, per hand and step.
struct LoopRun {
  std::vector<std::vector<Vector3>> force;  ///< on the hand [N], W
  std::vector<std::vector<Vector3>> tip;    ///< [m], W
  std::vector<double> lowest_energy;        ///< that the device had taken from the hand [J]
  std::vector<double> lowest_gain;          ///< of the filter, see Oscillation
  int refused = 0;                          ///< models that check() refused
  int unknown = 0;                          ///< steps whose newest model was too old
  int late = 0;                             ///< forces that the server entered afterwards
  int lost = 0;                             ///< forces that came too late for that, or never
  int withheld = 0;                         ///< BridgedStylus::withheld(), of all hands
  int withheld_at_bridge = 0;               ///< BridgeContact::withheld(), the same
  /// Force on the object in each step of the server, delayed ones included [N], W, per hand.
  std::vector<std::vector<Vector3>> on_object;
  std::vector<std::vector<bool>> touching;  ///< the same steps
  std::vector<double> peak_asked;           ///< largest force that a bridge asked for, per hand [N]
  double peak_on_object = 0.0;              ///< largest force that is recorded or entered late [N]
  double fastest_object = 0.0;              ///< [m/s]
  double fastest_hand = 0.0;                ///< [m/s]
  /// Largest excess of the object's energy, elastic and of its weight, too, over what hands did: a
  /// lying one on the way that it went while what acted was shown [J].
  double energy_from_nowhere = 0.0;
};

/// Runs hands, bridges, link and server on one virtual clock.
LoopRun run_loop(const LoopSetup& setup, LoopMode mode, const LoopLink& link = {});

/// Largest difference of the forces on a hand, as a share of the largest force of the reference.
double largest_error(const LoopRun& run, const LoopRun& reference, std::size_t hand = 0);
/// Root mean square of the difference over all steps, as a share of that of the reference.
double rms_error(const LoopRun& run, const LoopRun& reference, std::size_t hand = 0);
double peak(const LoopRun& run, std::size_t hand = 0);

}  // namespace irdm::test
