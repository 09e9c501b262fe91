#include "tests/fake_libdhd/fake_dhd.hpp"

#include <algorithm>
#include <array>
#include <mutex>

namespace {

struct Device {
  std::array<double, 3> position{};
  std::array<double, 9> frame{1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<double, 3> force{};
  std::array<double, 3> torque{};
  bool active_wrist = false;
  unsigned buttons = 0;
  bool open = false;
  bool on = false;
  bool unplugged = false;
};

std::mutex mutex;
std::array<Device, 2> devices;

// What a device answers: -1 where it cannot.
template <typename Action>
int with(int index, Action action) {
  const std::lock_guard<std::mutex> lock(mutex);
  if (index < 0 || index >= static_cast<int>(devices.size())) return -1;
  return action(devices[static_cast<std::size_t>(index)]);
}

template <typename Action>
int with_open(int index, Action action) {
  return with(index, [&](Device& device) {
    return device.open && !device.unplugged ? action(device) : -1;
  });
}

}  // namespace

extern "C" {

int dhdOpenID(char index) {
  return with(index, [&](Device& device) {
    if (device.open || device.unplugged) return -1;
    device.open = true;
    return static_cast<int>(index);
  });
}

int dhdOpen() {
  const int first = dhdOpenID(0);
  return first >= 0 ? first : dhdOpenID(1);
}

int dhdClose(char id) {
  return with(id, [](Device& device) {
    device.open = false;
    return 0;
  });
}

int dhdEnableForce(unsigned char on, char id) {
  return with_open(id, [&](Device& device) {
    device.on = on == 1;
    return 0;
  });
}

const char* dhdGetSystemName(char) {
  return "omega.6";
}

// 1 (too soon after the last call) is no failure.
int dhdGetPosition(double* x, double* y, double* z, char id) {
  return with_open(id, [&](Device& device) {
    *x = device.position[0];
    *y = device.position[1];
    *z = device.position[2];
    return 1;
  });
}

int dhdGetOrientationFrame(double rows[3][3], char id) {
  return with_open(id, [&](Device& device) {
    std::copy(device.frame.begin(), device.frame.end(), &rows[0][0]);
    return 0;
  });
}

unsigned dhdGetButtonMask(char id) {
  return static_cast<unsigned>(
      std::max(0, with_open(id, [](Device& device) { return static_cast<int>(device.buttons); })));
}

bool dhdHasActiveWrist(char id) {
  return with_open(id, [](Device& device) { return device.active_wrist ? 1 : 0; }) == 1;
}

// As the driver has it, the torque that was set before is off.
int dhdSetForce(double x, double y, double z, char id) {
  return with_open(id, [&](Device& device) {
    device.force = {x, y, z};
    device.torque = {};
    return 0;
  });
}

int dhdSetForceAndTorque(double fx, double fy, double fz, double tx, double ty, double tz,
                         char id) {
  return with_open(id, [&](Device& device) {
    if (!device.active_wrist) return -1;
    device.force = {fx, fy, fz};
    device.torque = {tx, ty, tz};
    return 0;
  });
}

const char* dhdErrorGetLastStr() {
  return "no device found";
}

void fakedhd_reset() {
  const std::lock_guard<std::mutex> lock(mutex);
  devices = {};
}
void fakedhd_place(int index, double x, double y, double z) {
  with(index, [&](Device& device) {
    device.position = {x, y, z};
    return 0;
  });
}
void fakedhd_turn(int index, const double* row_by_row) {
  with(index, [&](Device& device) {
    std::copy_n(row_by_row, 9, device.frame.begin());
    return 0;
  });
}
void fakedhd_press(int index, unsigned buttons) {
  with(index, [&](Device& device) {
    device.buttons = buttons;
    return 0;
  });
}
void fakedhd_unplug(int index, int unplugged) {
  with(index, [&](Device& device) {
    device.unplugged = unplugged != 0;
    return 0;
  });
}
void fakedhd_force(int index, double* newton) {
  with(index, [&](Device& device) {
    std::copy(device.force.begin(), device.force.end(), newton);
    return 0;
  });
}
void fakedhd_activate_wrist(int index) {
  with(index, [](Device& device) {
    device.active_wrist = true;
    return 0;
  });
}
void fakedhd_torque(int index, double* newton_metre) {
  with(index, [&](Device& device) {
    std::copy(device.torque.begin(), device.torque.end(), newton_metre);
    return 0;
  });
}
int fakedhd_force_is_on(int index) {
  return with(index, [](Device& device) { return device.on ? 1 : 0; });
}
int fakedhd_is_open(int index) {
  return with(index, [](Device& device) { return device.open ? 1 : 0; });
}

}  // extern "C"
