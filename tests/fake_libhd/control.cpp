#include "tests/fake_libhd/control.hpp"

#include <algorithm>

#include "tests/fake_libhd/fake_driver.hpp"

using fake_hd::driver;
using fake_hd::FakeDevice;
using fake_hd::Lock;

namespace {

template <typename Action>
auto with(const char* name, Action action) {
  const Lock lock(driver().mutex);
  FakeDevice* const device = driver().find(name);
  return action(device != nullptr ? *device : driver().known(name));
}

}  // namespace

extern "C" {

void fakehd_reset() {
  driver().reset();
}
void fakehd_add(const char* name) {
  const Lock lock(driver().mutex);
  driver().known(name);
}
void fakehd_refuse(unsigned code) {
  const Lock lock(driver().mutex);
  driver().refusal = code;
}
void fakehd_refuse_names() {
  const Lock lock(driver().mutex);
  driver().refuses_names = true;
}
void fakehd_refuse_rates() {
  const Lock lock(driver().mutex);
  driver().refuses_rate = true;
}
void fakehd_drive_by_hand() {
  const Lock lock(driver().mutex);
  driver().hand_driven = true;
}
void fakehd_tick(int count) {
  for (int i = 0; i < count; ++i) driver().tick();
}
void fakehd_hang() {
  driver().hangs = true;
}
unsigned long fakehd_ticks() {
  const Lock lock(driver().mutex);
  return driver().ticks;
}
unsigned long fakehd_rate() {
  const Lock lock(driver().mutex);
  return driver().rate;
}
unsigned long fakehd_misuses() {
  const Lock lock(driver().mutex);
  return driver().misuses;
}
const char* fakehd_first_misuse() {
  const Lock lock(driver().mutex);
  return driver().first_misuse.c_str();
}

void fakehd_place(const char* name, double x, double y, double z) {
  with(name, [&](FakeDevice& device) {
    device.transform[12] = x;
    device.transform[13] = y;
    device.transform[14] = z;
  });
}
void fakehd_transform(const char* name, const double* column_by_column) {
  with(name, [&](FakeDevice& device) {
    std::copy_n(column_by_column, device.transform.size(), device.transform.begin());
  });
}
void fakehd_press(const char* name, int buttons) {
  with(name, [&](FakeDevice& device) { device.buttons = buttons; });
}
void fakehd_rate_force(const char* name, double peak, double continuous) {
  with(name, [&](FakeDevice& device) {
    device.max_force = peak;
    device.continuous_force = continuous;
  });
}
void fakehd_six_axes(const char* name, double peak, double continuous) {
  with(name, [&](FakeDevice& device) {
    device.max_torque = peak;
    device.continuous_torque = continuous;
  });
}
void fakehd_temperature(const char* name, double warmth) {
  with(name, [&](FakeDevice& device) { device.temperature = warmth; });
}
void fakehd_no_temperature(const char* name) {
  with(name, [&](FakeDevice& device) { device.tells_temperature = false; });
}
void fakehd_heating(const char* name, double time_constant) {
  with(name, [&](FakeDevice& device) { device.heating_ticks = time_constant; });
}
void fakehd_calibration(const char* name, unsigned state, int styles) {
  with(name, [&](FakeDevice& device) {
    device.calibration = state;
    device.calibration_styles = styles;
  });
}
void fakehd_calibration_fails(const char* name, int fails) {
  with(name, [&](FakeDevice& device) { device.calibration_fails = fails != 0; });
}
void fakehd_calibration_moves(const char* name, double x) {
  with(name, [&](FakeDevice& device) { device.calibration_moves = x; });
}
unsigned long fakehd_calibration_checks(const char* name) {
  return with(name, [&](FakeDevice& device) { return device.calibration_checks; });
}
unsigned fakehd_updated_style(const char* name) {
  return with(name, [&](FakeDevice& device) { return device.updated_style; });
}
void fakehd_raise_at_begin(const char* name, unsigned code) {
  with(name, [&](FakeDevice& device) { device.at_begin.push_back(code); });
}
void fakehd_raise_at_end(const char* name, unsigned code) {
  with(name, [&](FakeDevice& device) { device.at_end.push_back(code); });
}
void fakehd_unplug(const char* name) {
  with(name, [&](FakeDevice& device) { device.plugged = false; });
}
void fakehd_force_off(const char* name, int off) {
  constexpr unsigned kForceOutput = 0x4000;
  with(name, [&](FakeDevice& device) {
    device.force_output = off == 0;
    std::erase(device.limits_on, kForceOutput);
    if (off == 0) device.limits_on.push_back(kForceOutput);
  });
}
int fakehd_is_open(const char* name) {
  return with(name, [&](FakeDevice& device) { return device.open ? 1 : 0; });
}
int fakehd_is_on(const char* name, unsigned capability) {
  return with(name, [&](FakeDevice& device) {
    return std::count(device.limits_on.begin(), device.limits_on.end(), capability) > 0 ? 1 : 0;
  });
}
unsigned long fakehd_frames(const char* name) {
  return with(name, [&](FakeDevice& device) { return device.frames; });
}
void fakehd_force(const char* name, double* newton) {
  with(name, [&](FakeDevice& device) {
    std::copy(device.commanded.begin(), device.commanded.end(), newton);
  });
}
void fakehd_torque(const char* name, double* millinewton_metre) {
  with(name, [&](FakeDevice& device) {
    std::copy(device.commanded_torque.begin(), device.commanded_torque.end(), millinewton_metre);
  });
}

}  // extern "C"
