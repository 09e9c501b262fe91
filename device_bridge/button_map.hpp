#pragma once

#include <cstdint>

#include "common/stylus.hpp"

namespace irdm {

/// Which button of a device does what: numbers of bits in its button field, 0 to 31; kNone: none.
struct ButtonMap {
  static constexpr int kNone = -1;
  int grab = 0;    ///< takes hold of the object
  int clutch = 1;  ///< takes the device out of W; stays at the bridge
  int reset = 2;   ///< puts every object back to the start

  bool clutched(std::uint32_t device_buttons) const noexcept {
    return down(device_buttons, clutch);
  }
  /// What the server is told: StylusSample::buttons.
  std::uint32_t to_wire(std::uint32_t device_buttons) const noexcept {
    return (down(device_buttons, grab) ? kGrabButton : 0u) |
           (down(device_buttons, reset) ? kResetButton : 0u);
  }

 private:
  static bool down(std::uint32_t buttons, int bit) noexcept {
    return bit != kNone && (buttons >> bit & 1u) != 0;
  }
};

}  // namespace irdm
