// The C interface of libHD.so, as programs see it. Numbers and types are written down here a second
// time, not taken from device_bridge/openhaptics: a slip there would go unnoticed.
#include <algorithm>
#include <cstdint>

#include "tests/fake_libhd/fake_driver.hpp"

using fake_hd::driver;
using fake_hd::ErrorInfo;
using fake_hd::FakeDevice;
using fake_hd::Lock;

namespace {

constexpr unsigned kInvalidEnum = 0x0100;
constexpr unsigned kInvalidValue = 0x0101;
constexpr unsigned kDeviceFault = 0x0300;
constexpr unsigned kFrameError = 0x0402;
constexpr unsigned kForceOutput = 0x4000;
constexpr unsigned kMaxForceClamping = 0x4001;

void refuse(unsigned code) {
  driver().raise(code, driver().current);
}

void set_capability(unsigned name, bool on) {
  const Lock lock(driver().mutex);
  FakeDevice* const device = driver().current_device();
  if (device == nullptr) return;
  if (name == kForceOutput) {
    device->force_output = on;
  } else if (name == kMaxForceClamping) {
    device->clamping = on;
  }
  std::erase(device->limits_on, name);
  if (on) device->limits_on.push_back(name);
}

// The current device, where it can be asked for its calibration; nullptr and an error otherwise.
FakeDevice* calibrated_device() {
  FakeDevice* const device = driver().current_device();
  if (device == nullptr) return nullptr;
  if (device->in_frame) driver().misuse("a calibration in a frame");
  if (!device->calibration_fails) return device;
  refuse(kDeviceFault);
  return nullptr;
}

}  // namespace

extern "C" {

unsigned hdInitDevice(const char* name) {
  const Lock lock(driver().mutex);
  return driver().init(name);
}

void hdDisableDevice(unsigned handle) {
  const Lock lock(driver().mutex);
  driver().disable(handle);
}

void hdMakeCurrentDevice(unsigned handle) {
  const Lock lock(driver().mutex);
  driver().current = handle;
}

void hdBeginFrame(unsigned handle) {
  const Lock lock(driver().mutex);
  driver().begin_frame(handle);
}

void hdEndFrame(unsigned handle) {
  const Lock lock(driver().mutex);
  driver().end_frame(handle);
}

ErrorInfo hdGetError() {
  const Lock lock(driver().mutex);
  return driver().pop_error();
}

void hdEnable(unsigned name) {
  set_capability(name, true);
}

void hdDisable(unsigned name) {
  set_capability(name, false);
}

unsigned char hdIsEnabled(unsigned name) {
  const Lock lock(driver().mutex);
  const FakeDevice* const device = driver().current_device();
  if (device == nullptr) return 0;
  return std::count(device->limits_on.begin(), device->limits_on.end(), name) > 0 ? 1 : 0;
}

void hdGetIntegerv(unsigned name, std::int32_t* values) {
  const Lock lock(driver().mutex);
  const FakeDevice* const device = driver().current_device();
  if (device == nullptr) return;
  switch (name) {
    case 0x2000:
      *values = device->buttons;
      break;
    case 0x2554:
      *values = device->max_torque > 0.0 ? 6 : 3;
      break;
    case 0x2555:
      *values = device->calibration_styles;
      break;
    default:
      refuse(kInvalidEnum);
  }
}

void hdGetDoublev(unsigned name, double* values) {
  const Lock lock(driver().mutex);
  const FakeDevice* const device = driver().current_device();
  if (device == nullptr) return;
  switch (name) {
    case 0x2052:
      if (!device->in_frame) refuse(kFrameError);
      std::copy(device->transform.begin(), device->transform.end(), values);
      break;
    case 0x2603:
      *values = device->max_force;
      break;
    case 0x2604:
      *values = device->continuous_force;
      break;
    case 0x2605:
      if (!device->tells_temperature) return refuse(kInvalidEnum);
      values[0] = 0.5 * device->temperature;
      values[1] = device->temperature;
      values[2] = 0.0;
      break;
    case 0x2622:
      *values = device->max_torque;
      break;
    case 0x2623:
      *values = device->continuous_torque;
      break;
    default:
      refuse(kInvalidEnum);
  }
}

const char* hdGetString(unsigned name) {
  return name == 0x2501 ? "Touch" : name == 0x2504 ? "fake-1" : nullptr;
}

void hdSetDoublev(unsigned name, const double* values) {
  const Lock lock(driver().mutex);
  FakeDevice* const device = driver().current_device();
  if (device == nullptr) return;
  const bool torque = name == 0x2701;
  if (name != 0x2700 && !torque) return refuse(kInvalidEnum);
  if (!device->in_frame) {
    refuse(kFrameError);
    return driver().misuse("a force outside a frame");
  }
  if (torque && device->max_torque == 0.0) driver().misuse("a torque for three actuated axes");
  std::copy_n(values, 3, (torque ? device->commanded_torque : device->commanded).begin());
}

unsigned hdCheckCalibration() {
  const Lock lock(driver().mutex);
  FakeDevice* const device = calibrated_device();
  if (device == nullptr) return 0x5000;
  ++device->calibration_checks;
  return device->calibration;
}

void hdUpdateCalibration(unsigned style) {
  const Lock lock(driver().mutex);
  FakeDevice* const device = calibrated_device();
  if (device == nullptr) return;
  if (device->calibration != 0x5001) driver().misuse("a calibration that was not due");
  if (style == 1 && driver().running()) driver().misuse("encoders are reset while forces act");
  device->updated_style = style;
  device->calibration = 0x5000;
  device->transform[12] += device->calibration_moves;
}

void hdStartScheduler() {
  driver().start();
}

void hdStopScheduler() {
  driver().stop();
}

void hdSetSchedulerRate(unsigned long hertz) {
  const Lock lock(driver().mutex);
  if (driver().refuses_rate || (hertz != 500 && hertz != 1000)) return refuse(kInvalidValue);
  driver().rate = hertz;
}

unsigned long hdScheduleAsynchronous(unsigned (*callback)(void*), void* data, std::uint16_t) {
  const Lock lock(driver().mutex);
  return driver().schedule(callback, data);
}

void hdUnschedule(unsigned long number) {
  const Lock lock(driver().mutex);
  driver().unschedule(number);
}

}  // extern "C"
