#pragma once

#include <array>
#include <cstddef>

#include "device_bridge/commission/force_steps.hpp"
#include "device_bridge/commission/step.hpp"

namespace irdm::commission {

/// A wall below the handle, computed here in each tick, that becomes stiffer from press to press
/// until the safety filter has to act: its oscillation detector lowers the gain, or the device gave
/// more energy than it took. It changes only while it is not touched, so that it adds no energy.
class WallStep final : public Step {
 public:
  /// Of the wall [N/m].
  static constexpr std::array kStiffness{100.0, 150.0, 200.0,  300.0,  400.0, 600.0,
                                         800.0, 1e3,   1500.0, 2000.0, 3000.0};
  static constexpr double kDistance = 5e-3;   ///< below the handle at the start [m]
  static constexpr double kPressed = 0.3;     ///< for so long at each stiffness [s] ...
  static constexpr double kFelt = 0.2;        ///< ... with at least this force [N]
  static constexpr double kMostGiven = 1e-3;  ///< energy [J]
  static constexpr double kProposed = 0.5;   ///< share of the largest stiffness that stayed passive
  static constexpr double kLongest = 180.0;  ///< [s]

  WallStep();

  Demand tick(const Seen& seen) noexcept override;
  bool over() const noexcept override;
  Judgement judge(Measured& measured) const override;

 private:
  void judge_press(const Seen& seen, bool touched) noexcept;

  ForceWatch watch_;
  bool touched_ = false;             ///< in the tick before, as the next two
  Vector3 tip_ = Vector3::Zero();    ///< [m], D
  Vector3 shown_ = Vector3::Zero();  ///< [N], D
  double given_ = 0.0;               ///< by this press, less what it took [J]
  std::size_t level_ = 0;            ///< of kStiffness; its size: all are done
  double pressed_ = 0.0;             ///< at this level [s]
  bool active_ = false;              ///< the filter is
  bool oscillates_ = false;          ///< that is its detector
};

}  // namespace irdm::commission
