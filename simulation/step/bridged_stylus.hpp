#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "common/contact/applied_forces.hpp"
#include "simulation/step/horizon_length.hpp"
#include "simulation/step/sample_path.hpp"
#include "simulation/step/simulation.hpp"

namespace irdm {

/// One stylus whose bridge may solve its contact: the forces that come from there go into the steps
/// that they belong to, late ones as well, and what the bridge has to know to go on comes out. From
/// its first force on the stylus is the bridge's; its tip in a step is where the bridge tells, on
/// the way of the stylus' own samples. Pure, real-time safe.
class BridgedStylus {
 public:
  /// From one contact model to the next while the tip can touch nothing soon [steps].
  static constexpr std::uint64_t kFarModelPeriod = 4;
  /// A tip that is told farther than this from the way of the samples is no hand's, and its force
  /// does not act [m]: the way of a fast hand while samples are delayed.
  static constexpr double kAgrees = 0.05;
  /// No hand that feels a force is faster [m/s]: twice what a bridge lets it be.
  static constexpr double kFastestHand = 2.0;

  /// @param s its number in the simulation
  BridgedStylus(Simulation& simulation, std::size_t s)
      : simulation_(simulation), s_(s), horizon_(simulation.dt()) {}

  /// Before each step: enters forces that were late for theirs.
  /// @param command of the newest sample
  /// @param session of the stylus' bridge; 0: of none that solves contacts
  StylusCommand next(const StylusCommand& command, std::uint64_t session,
                     const AppliedHistory& history) noexcept;

  /// After the step of next(): how the contact goes on. False: no model is due.
  /// @param budget as for Simulation::predict_horizon()
  bool predict_horizon(ContactModel& model, int& budget) noexcept;
  void predict_horizon(ContactModel& model) noexcept {
    int budget = std::numeric_limits<int>::max();
    predict_horizon(model, budget);
  }

  /// What was sent so far is not for any step to come.
  void forget(const AppliedHistory& history) noexcept;

  std::uint64_t late() const noexcept { return late_; }  ///< forces that were entered late
  /// Forces that came too late for that, or for an object that was not touched.
  std::uint64_t lost() const noexcept { return lost_; }
  /// Forces that were above SimulationStylus::max_force, and entered with that.
  std::uint64_t bounded() const noexcept { return bounded_; }
  /// Forces that did not act, as their tips were not where the stylus' samples are.
  std::uint64_t disagreed() const noexcept { return disagreed_; }
  /// Steps in contact that the bridge had no model for, so that its force had faded.
  std::uint64_t withheld() const noexcept { return withheld_; }

 private:
  AppliedForce accepted(const AppliedForce& applied, const Vector3& tip) noexcept;
  void follow(const AppliedForce& applied) noexcept;
  bool in_contact() const noexcept;
  bool touches_soon(const ContactModel& model) noexcept;
  void begin(const StylusCommand& command, const AppliedHistory& history) noexcept;
  void insert_delayed_force(const AppliedHistory& history, std::uint64_t k) noexcept;
  const AppliedForce* find(const AppliedHistory& history, std::uint64_t step) const noexcept;

  Simulation& simulation_;
  std::size_t s_;
  std::uint64_t session_ = 0;
  std::uint64_t reset_ = 0;                  ///< step of the last reset that was heeded
  std::uint64_t known_ = ~std::uint64_t{0};  ///< bit i: the force of the last step less i is in
  std::uint64_t first_ = 0;                  ///< forces of steps before it are of no use
  std::uint64_t newest_ = kNoStep;           ///< step of the newest force at the last step
  HorizonLength horizon_;
  bool bridged_ = false;
  bool there_ = false;             ///< in the last step, with a bridge
  Vector3 tip_ = Vector3::Zero();  ///< in the last step
  SamplePath path_;
  int untold_ = 0;                ///< steps since the last one that the bridge told of
  bool exerted_ = false;          ///< a force, in that one
  std::uint64_t next_model_ = 0;  ///< no model before this step
  std::optional<Vector3> gap_;    ///< from the surface to the tip, at the last model [m], W
  std::uint64_t late_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t bounded_ = 0;
  std::uint64_t disagreed_ = 0;
  std::uint64_t withheld_ = 0;
};

}  // namespace irdm
