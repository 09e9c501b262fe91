#include <cmath>

#include "device_bridge/safety/guards.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

TEST_CASE("thermal derating: warmth is the step response of a first-order lag of the load") {
  const ThermalLimits limits;
  CHECK(limits.time_constant == 60.0);
  for (const double tick : {1e-3, 0.1}) {  // exact, whatever the tick
    for (const double load : {0.5, 1.0, 2.0}) {
      ThermalDerating motor(limits);
      const double force = load * limits.continuous;
      const auto ticks = [tick](double seconds) { return std::lround(seconds / tick); };
      for (long i = 0; i < ticks(60.0); ++i) motor.heat(force, tick, 0.0);
      CAPTURE(tick, load);
      const double warm = load * load * (1.0 - std::exp(-1.0));
      CHECK(motor.warmth() == Approx(warm).epsilon(1e-9));
      for (long i = 0; i < ticks(30.0); ++i) motor.heat(0.0, tick, 0.0);
      CHECK(motor.warmth() == Approx(warm * std::exp(-0.5)).epsilon(1e-9));
    }
  }
}
