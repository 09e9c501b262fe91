#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "device_bridge/servo_link.hpp"
#include "tests/bridge/milliseconds.hpp"

namespace irdm::test {

/// What goes wrong between server and bridge in a contact, as the servo loop sees it: the causes of
/// bench_fail_to_zero.
struct LinkFault {
  const char* name;
  /// Changes the last good input into that of a tick, of which this is the number since it began.
  void (*spoil)(ServoInput& input, std::int64_t now_ns, int tick);
};

namespace link_faults {

inline void lose(ServoInput& input, std::int64_t, int) {
  input.linked = false;
}
inline void add_nothing(ServoInput&, std::int64_t, int) {}
// A new session has no force yet.
inline void connect_again(ServoInput& input, std::int64_t, int tick) {
  input.linked = tick >= 10;
  input.any_force = tick < 10;
}
// The server goes on with the sample that it has.
inline void answer_the_same(ServoInput& input, std::int64_t, int tick) {
  input.force.force_step += tick % 2 == 0 ? 1 : 0;
}
inline void corrupt(ServoInput& input, std::int64_t now_ns, int) {
  input.force.force.setConstant(std::numeric_limits<double>::quiet_NaN());
  input.force.sample_time_ns = now_ns;
}
inline void reorder(ServoInput& input, std::int64_t, int tick) {
  input.force.sample_time_ns -= tick % 5 == 0 ? 3 * kMs : 0;
}
inline void be_slow(ServoInput& input, std::int64_t now_ns, int) {
  input.force.sample_time_ns = now_ns - 60 * kMs;
}

}  // namespace link_faults

inline constexpr std::array kLinkFaults{
    LinkFault{"server killed", link_faults::lose},
    LinkFault{"server stopped", link_faults::add_nothing},
    LinkFault{"force thread frozen", link_faults::add_nothing},
    LinkFault{"connection reset", link_faults::connect_again},
    LinkFault{"black hole", link_faults::add_nothing},
    LinkFault{"nothing from the server", link_faults::add_nothing},
    LinkFault{"nothing from the bridge", link_faults::answer_the_same},
    LinkFault{"corrupted", link_faults::corrupt},
    LinkFault{"reordered", link_faults::reorder},
    LinkFault{"slow reader", link_faults::be_slow},
    LinkFault{"another session's frames", link_faults::lose},
    LinkFault{"every frame twice", link_faults::answer_the_same},
};

/// Ticks of 1 ms from the last good input to the first without force; more than `most`: none.
/// @param loop has `input`, `now_ns`, `tick_as_is()` and `force()`, and shows a force
template <typename Loop>
int ticks_to_zero(Loop& loop, const LinkFault& fault, int most = 200) {
  const ServoInput good = loop.input;
  for (int tick = 0; tick < most; ++tick) {
    loop.input = good;
    fault.spoil(loop.input, loop.now_ns + kMs, tick);
    loop.tick_as_is();
    if (loop.force() == 0.0) return tick + 1;
  }
  return most + 1;
}

}  // namespace irdm::test
