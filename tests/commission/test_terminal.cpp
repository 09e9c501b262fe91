#include <unistd.h>

#include <array>
#include <sstream>

#include "device_bridge/commission/commission.hpp"
#include "device_bridge/commission/reading_steps.hpp"
#include "device_bridge/commission/terminal.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::commission;

namespace {

/// A terminal whose keys a test presses.
struct Keyboard {
  Keyboard() { REQUIRE(::pipe(ends.data()) == 0); }
  ~Keyboard() {
    ::close(ends[0]);
    close();
  }
  void type(const std::string& keys) const {
    REQUIRE(::write(ends[1], keys.data(), keys.size()) == static_cast<ssize_t>(keys.size()));
  }
  void close() {
    if (ends[1] >= 0) ::close(ends[1]);
    ends[1] = -1;
  }

  std::array<int, 2> ends{};
  StopSignal signal;
  std::ostringstream output;
};

}  // namespace

TEST_CASE("commission: a line begins a step, q ends, y confirms") {
  Keyboard keyboard;
  Terminal terminal(keyboard.signal, keyboard.ends[0], keyboard.output);
  const AxisStep step(1);
  keyboard.type("\nq\ny\nn\n");
  CHECK(terminal.begins(step));
  CHECK_FALSE(terminal.begins(step));
  CHECK(terminal.confirms("Was it gone?"));
  CHECK_FALSE(terminal.confirms("Was it gone?"));
  CHECK_THAT(keyboard.output.str(), ContainsSubstring("axis up: Move the handle 5 cm up") &&
                                        ContainsSubstring("any key then stops it") &&
                                        ContainsSubstring("Was it gone? [y/n]"));
}

TEST_CASE("commission: any key stops a step, once") {
  Keyboard keyboard;
  Terminal terminal(keyboard.signal, keyboard.ends[0], keyboard.output);
  CHECK_FALSE(terminal.stops(0));
  keyboard.type("x");
  CHECK(terminal.stops(0));
  CHECK_FALSE(terminal.stops(0));
}

TEST_CASE("commission: where nothing can be read any more, no step begins and none is stopped") {
  Keyboard keyboard;
  Terminal terminal(keyboard.signal, keyboard.ends[0], keyboard.output);
  keyboard.close();
  CHECK_FALSE(terminal.stops(0));
  CHECK_FALSE(terminal.begins(AxisStep(0)));
  CHECK_FALSE(terminal.confirms("Was it gone?"));
}

TEST_CASE("commission: a key stops the virtual device's step, and the rest is not reached") {
  Keyboard keyboard;
  Terminal terminal(keyboard.signal, keyboard.ends[0], keyboard.output);
  GuidedStylus stylus({}, {}, {});
  /// Presses a key in the first step with a button.
  struct Watcher final : Person {
    Watcher(Terminal& at, GuidedStylus& held, const Keyboard& keys)
        : person(at, held), pressed(keys) {}
    void tell(const std::string& line) override { person.tell(line); }
    bool begins(const Step& step) override {
      if (step.name() == "button grab") pressed.type("x");
      return person.begins(step);
    }
    bool confirms(const std::string& question) override { return person.confirms(question); }
    bool stops(int timeout_ms) override { return person.stops(timeout_ms); }

    SimulatedPerson person;
    const Keyboard& pressed;
  } watcher(terminal, stylus, keyboard);
  BridgeConfig config;
  config.realtime = RealTimeScheduling::kIgnore;
  config.devices.push_back({.realtime = RealTimeScheduling::kIgnore,
                            .script = IRDM_SOURCE_DIR "/configs/scripts/press.csv"});
  const Report report = irdm::commission::commission(config, stylus, watcher, {});
  INFO(to_text(report));
  REQUIRE(report.steps.size() > 6);
  CHECK(report.steps[3].verdict == Verdict::kPassed);
  CHECK(report.steps[4].step == "button grab");
  CHECK(report.steps[4].verdict == Verdict::kStopped);
  CHECK(report.steps[5].verdict == Verdict::kNotReached);
  CHECK(report.steps.back().step == "wall");
  CHECK_FALSE(report.signed_off());
  CHECK_THAT(keyboard.output.str(), ContainsSubstring("stopped: by a key"));
}
