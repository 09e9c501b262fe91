#pragma once

#include <array>
#include <optional>

#include "device_bridge/commission/step.hpp"

// Steps with force: each begins at zero, ramps, and gives up when the handle runs away.
namespace irdm::commission {

/// What every step with force watches.
class ForceWatch {
 public:
  static constexpr double kFarthest = 0.1;  ///< that a force may move the handle [m]

  void look(const Seen& seen) noexcept;
  double time() const noexcept { return time_; }  ///< since the first tick [s]
  const Vector3& start() const noexcept { return start_; }
  /// Why the step cannot go on; null: it can.
  const char* trouble() const noexcept { return trouble_; }

 private:
  bool begun_ = false;
  double time_ = 0.0;
  Vector3 start_ = Vector3::Zero();
  const char* trouble_ = nullptr;
};

/// Whether a small force along an axis of D moves the handle that way: by the differences between
/// the places under the force and under its opposite, of two turns that have to agree.
class ForceSignStep final : public Step {
 public:
  static constexpr double kForce = 0.2;      ///< [N]
  static constexpr double kLeastWay = 1e-4;  ///< that the handle moves [m]

  /// @param axis of D, 0 to 2
  explicit ForceSignStep(int axis);

  Demand tick(const Seen& seen) noexcept override;
  bool over() const noexcept override;
  Judgement judge(Measured& measured) const override;

 private:
  /// Mean over the last part of a phase.
  struct Place {
    Vector3 sum = Vector3::Zero();
    double shown = 0.0;  ///< force along the axis, added up [N]
    int count = 0;
  };
  void add(Place& place, const Seen& seen) const noexcept;

  int axis_;
  ForceWatch watch_;
  std::array<Place, 4> places_;  ///< under the force, its opposite, and both once more
};

/// Slowly up to the largest force, which the handle is pushed up with.
class RampStep final : public Step {
 public:
  static constexpr double kRise = 4.0, kHold = 0.3, kFall = 1.0;  ///< [s]

  /// @param limit largest force [N]
  explicit RampStep(double limit);

  Demand tick(const Seen& seen) noexcept override;
  bool over() const noexcept override;
  Judgement judge(Measured& measured) const override;

 private:
  double limit_;
  ForceWatch watch_;
  double shown_ = 0.0;  ///< largest so far [N]
};

/// Takes away the force by one way of an emergency stop, and how long it takes until none is left.
class StopStep final : public Step {
 public:
  enum class Event {
    kButton,  ///< clutch, or a button of the device's own that turns its force off
    kLink,    ///< the server is lost
    kCable,   ///< the device is lost
  };
  static constexpr double kForce = 0.5;    ///< [N], up
  static constexpr double kLongest = 0.1;  ///< until it is gone [s]

  /// @param clutch its button's bit; -1: none
  StopStep(Event event, int clutch);

  Demand tick(const Seen& seen) noexcept override;
  bool over() const noexcept override;
  Judgement judge(Measured& measured) const override;

 private:
  bool happens(const Seen& seen) const noexcept;

  Event event_;
  int clutch_;
  ForceWatch watch_;
  bool felt_ = false;            ///< the whole force was shown
  double felt_for_ = 0.0;        ///< [s]
  std::optional<double> since_;  ///< the event [s]
  bool gone_ = false;            ///< no force is left
};

}  // namespace irdm::commission
