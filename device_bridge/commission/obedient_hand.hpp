#pragma once

#include <cstdint>

#include "device_bridge/commission/step.hpp"
#include "device_bridge/virtual_stylus.hpp"

namespace irdm::commission {

/// A simulated person, who does with the handle what a step asks for. Pure, real-time safe.
class ObedientHand {
 public:
  explicit ObedientHand(const HandParameters& parameters = {})
      : hand_(parameters, Vector3::Zero()) {}

  void obey(const Order& order) noexcept;
  /// @param dt [s], >= 0  @param force on the hand, constant over it [N], D
  void advance(double dt, const Vector3& force) noexcept;

  const Vector3& tip() const noexcept { return hand_.position(); }  ///< [m], D
  std::uint32_t buttons() const noexcept;
  bool unplugs() const noexcept;  ///< has pulled the cable

 private:
  Vector3 wish() const noexcept;

  VirtualHand hand_;
  Order order_;
  double time_ = 0.0;               ///< since the order [s]
  Vector3 home_ = Vector3::Zero();  ///< where the hand wanted to be when it came [m], D
};

}  // namespace irdm::commission
