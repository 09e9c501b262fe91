#include "device_bridge/commission/kill_step.hpp"

#include "common/error.hpp"
#include "common/process/child_program.hpp"
#include "common/realtime/clock.hpp"
#include "device_bridge/commission/step.hpp"

namespace irdm::commission {

namespace {

constexpr double kMoment = 0.2;  // that a process which is about to end is given [s]

}  // namespace

StepRecord run_kill_step(const std::vector<std::string>& pushing, Person& person,
                         Measured& measured) {
  const std::string name = kKillStep;
  const auto failed = [&](const std::string& words) {
    return StepRecord{name, Verdict::kFailed, words};
  };
  try {
    ChildProgram other(pushing, {.own_group = true});
    const bool felt = person.confirms(
        name +
        ": Plug the device in and hold the handle. Another irdm-bridge pushes it up with 0.5 N. "
        "Is the force there? After y it is killed.");
    if (other.ends_within(kMoment)) {
      return failed("the other irdm-bridge ended by itself; plug the device in, and run it again");
    }
    other.kill();
    const std::int64_t killed_ns = monotonic_ns();
    if (!felt) return failed("told by the person: there was no force; run it again");
    if (!person.confirms(name + ": It was killed. Is the force gone?")) {
      return failed(
          "told by the person: the force went on; use the device with a hand on its power switch "
          "only");
    }
    measured.stop_kill = kNanosecond * static_cast<double>(monotonic_ns() - killed_ns);
  } catch (const Error& error) {
    return failed(error.what());
  }
  return {name, Verdict::kPassed,
          "told by the person: no force after " + in_unit(*measured.stop_kill, "s") +
              ", the time to answer included"};
}

}  // namespace irdm::commission
