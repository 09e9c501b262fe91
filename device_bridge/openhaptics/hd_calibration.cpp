#include "device_bridge/openhaptics/hd_calibration.hpp"

namespace irdm::hd {

void Calibration::choose_style() noexcept {
  std::int32_t styles = 0;
  api_.get_integerv(kCalibrationStyles, &styles);
  for (const Name style : {kEncoderReset, kInkwell, kAuto}) {  // best last
    if ((static_cast<Name>(styles) & style) != 0) style_ = style;
  }
}

void Calibration::look() noexcept {
  left_ns_ = kPeriodNs;
  const Name found = api_.check_calibration();
  const bool updates = style_ == kAuto || style_ == kInkwell;
  if (found == kCalibrationNeedsUpdate && updates) api_.update_calibration(style_);
  found_.store(found, std::memory_order_relaxed);
}

bool Calibration::good() const noexcept {
  const Name found = found_.load(std::memory_order_relaxed);
  return found == kCalibrationOk || (found == kCalibrationNeedsUpdate && style_ == kAuto);
}

std::string Calibration::trouble() const {
  if (good()) return {};
  if (found_.load(std::memory_order_relaxed) == kFailed) {
    return "no force: its calibration fails; use the vendor's Touch_Diagnostic";
  }
  const std::string what = "no force until it is calibrated; ";
  switch (style_) {
    case kAuto:
      return what + "move the arm through its whole range";
    case kInkwell:
      return what + "put the stylus into its inkwell";
    default:
      return what +
             "end irdm-bridge, put the arm into its reset pose, calibrate it with the vendor's "
             "Touch_Diagnostic, and start irdm-bridge again";
  }
}

}  // namespace irdm::hd
