#include "tests/fake_libhd/fake_device.hpp"

#include <cmath>

namespace fake_hd {
namespace {

constexpr unsigned kWarmMotors = 0x0200;
constexpr unsigned kExceededMaxForce = 0x0201;

}  // namespace

double magnitude(const Force& force) {
  return std::sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
}

void FakeDevice::move_to(unsigned long tick) {
  if (motion.size() < 2) return;
  const double time = std::fmod(static_cast<double>(tick), motion.back().tick);
  std::size_t after = 1;
  while (motion[after].tick < time) ++after;
  const MotionRow& a = motion[after - 1];
  const MotionRow& b = motion[after];
  const double share = (time - a.tick) / (b.tick - a.tick);
  for (std::size_t i = 0; i < 3; ++i) {
    transform[12 + i] = a.position[i] + share * (b.position[i] - a.position[i]);
  }
  buttons = a.buttons;
}

std::vector<unsigned> FakeDevice::show() {
  std::vector<unsigned> errors;
  shown = force_output && plugged ? commanded : Force{};
  const double most = magnitude(shown);
  if (most > max_force * (1.0 + 1e-9)) {
    for (double& component : shown) component *= clamping ? max_force / most : 0.0;
    if (!clamping) errors.push_back(kExceededMaxForce);
  }
  const double load = magnitude(shown) / continuous_force;
  temperature += (load * load - temperature) / heating_ticks;
  if (temperature >= 1.0) errors.push_back(kWarmMotors);
  return errors;
}

}  // namespace fake_hd
