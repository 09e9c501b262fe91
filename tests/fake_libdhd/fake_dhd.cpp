#include "tests/fake_libdhd/fake_dhd.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>

namespace {

struct Device {
  std::array<double, 3> position{};
  std::array<double, 3> told{};  // by the last reading
  std::array<double, 9> frame{1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<double, 3> force{};
  std::array<double, 3> torque{};
  bool active_wrist = false;
  unsigned buttons = 0;
  bool open = false;
  bool on = false;
  bool unplugged = false;
  bool refuses = false;
  bool initialised = true;
  bool gripper = false;
  bool closed = false;
  bool emulates = false;
  bool compensates = false;
  int off_cause = 0;
  int repeats = 0;
  int forces = 0;
  int turned_on = 0;
  double max_force = 0.0;
  const char* model = "omega.6";
  int type = 34;
};

constexpr std::array<int, 2> kSerials{10234, 10777};
constexpr double kMotors = 12.0;  // [N]

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

// Of one that is open the same number again.
int dhdOpenID(char index) {
  return with(index, [&](Device& device) {
    if (device.unplugged) return -1;
    device.open = true;
    return static_cast<int>(index);
  });
}

int dhdOpen() {
  for (char i = 0; i < 2; ++i) {
    if (fakedhd_is_open(i) == 0 && dhdOpenID(i) >= 0) return i;
  }
  return -1;
}

int dhdOpenSerial(int serial) {
  return serial == kSerials[0] ? dhdOpenID(0) : serial == kSerials[1] ? dhdOpenID(1) : -1;
}

int dhdClose(char id) {
  return with(id, [](Device& device) {
    device.open = false;
    return 0;
  });
}

int dhdGetSerialNumber(unsigned short* serial, char id) {
  return with_open(id, [&](Device&) {
    *serial = static_cast<unsigned short>(kSerials[static_cast<std::size_t>(id)]);
    return 0;
  });
}

const char* dhdGetSystemName(char id) {
  const std::lock_guard<std::mutex> lock(mutex);
  return devices[static_cast<std::size_t>(id)].model;
}

int dhdGetSystemType(char id) {
  return with_open(id, [](Device& device) { return device.type; });
}

int dhdGetStatus(int* status, char id) {
  return with_open(id, [&](Device& device) {
    std::fill_n(status, 16, 0);
    status[0] = status[1] = status[2] = 1;
    status[3] = device.initialised ? 1 : 0;
    status[5] = device.on ? 1 : 0;
    status[14] = device.off_cause;
    return 0;
  });
}

int dhdEnableForce(unsigned char on, char id) {
  return with_open(id, [&](Device& device) {
    device.on = on == 1;
    device.off_cause = device.on ? 0 : 4;
    device.turned_on += device.on ? 1 : 0;
    return 0;
  });
}

int dhdSetGravityCompensation(int on, char id) {
  return with_open(id, [&](Device& device) {
    device.compensates = on == 1;
    return 0;
  });
}

int dhdGetPositionAndOrientationFrame(double* x, double* y, double* z, double rows[3][3], char id) {
  return with_open(id, [&](Device& device) {
    const bool again = device.repeats > 0;
    if (again) --device.repeats;
    if (!again) device.told = device.position;
    *x = device.told[0];
    *y = device.told[1];
    *z = device.told[2];
    std::copy(device.frame.begin(), device.frame.end(), &rows[0][0]);
    return again ? 1 : 0;
  });
}

unsigned dhdGetButtonMask(char id) {
  return static_cast<unsigned>(std::max(0, with_open(id, [](Device& device) {
                                          const bool gripped = device.emulates && device.closed;
                                          return static_cast<int>(device.buttons |
                                                                  (gripped ? 1u : 0u));
                                        })));
}

bool dhdHasGripper(char id) {
  return with_open(id, [](Device& device) { return device.gripper ? 1 : 0; }) == 1;
}

int dhdEmulateButton(unsigned char on, char id) {
  return with_open(id, [&](Device& device) {
    device.emulates = on == 1;
    return device.gripper ? 0 : -1;
  });
}

bool dhdHasActiveWrist(char id) {
  return with_open(id, [](Device& device) { return device.active_wrist ? 1 : 0; }) == 1;
}

int dhdSetMaxForce(double limit, char id) {
  return with_open(id, [&](Device& device) {
    device.max_force = limit;
    return 0;
  });
}

// More than the motors give is cut off, which the result says (dhdc.h: 2). Without an active wrist
// no torque acts.
int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty,
                                        double tz, double, char id) {
  return with_open(id, [&](Device& device) {
    if (device.refuses) return -1;
    ++device.forces;
    const double share = kMotors / std::max(kMotors, std::hypot(fx, fy, fz));
    device.force = {share * fx, share * fy, share * fz};
    device.torque = {0, 0, 0};
    if (device.active_wrist) device.torque = {tx, ty, tz};
    return share < 1.0 ? 2 : 0;
  });
}

int drdAutoInit(char id) {
  return with_open(id, [](Device& device) {
    device.initialised = true;
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
void fakedhd_refuse_forces(int index, int refused) {
  with(index, [&](Device& device) {
    device.refuses = refused != 0;
    return 0;
  });
}
void fakedhd_force(int index, double* newton) {
  with(index, [&](Device& device) {
    for (std::size_t i = 0; i < 3; ++i) newton[i] = device.on ? device.force[i] : 0.0;
    return 0;
  });
}
void fakedhd_model(int index, const char* name, int type) {
  with(index, [&](Device& device) {
    device.model = name;
    device.type = type;
    return 0;
  });
}
void fakedhd_give_gripper(int index) {
  with(index, [](Device& device) {
    device.gripper = true;
    return 0;
  });
}
void fakedhd_close_gripper(int index, int closed) {
  with(index, [&](Device& device) {
    device.closed = closed != 0;
    return 0;
  });
}
void fakedhd_initialised(int index, int is) {
  with(index, [&](Device& device) {
    device.initialised = is != 0;
    return 0;
  });
}
void fakedhd_force_off(int index, int cause) {
  with(index, [&](Device& device) {
    device.on = cause == 0;
    device.off_cause = cause;
    return 0;
  });
}
void fakedhd_repeat(int index, int readings) {
  with(index, [&](Device& device) {
    device.repeats = readings;
    return 0;
  });
}
int fakedhd_forces(int index) {
  return with(index, [](Device& device) { return device.forces; });
}
int fakedhd_turned_on(int index) {
  return with(index, [](Device& device) { return device.turned_on; });
}
int fakedhd_compensates(int index) {
  return with(index, [](Device& device) { return device.compensates ? 1 : 0; });
}
double fakedhd_max_force(int index) {
  const std::lock_guard<std::mutex> lock(mutex);
  return devices[static_cast<std::size_t>(index)].max_force;
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
