#include <algorithm>
#include <functional>

#include "common/realtime/clock.hpp"
#include "server/threads/force_thread.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

/// Lets every step run at once.
class NoClock final : public StepClock {
 public:
  bool wait(std::uint64_t) noexcept override { return !stopped(); }
};

}  // namespace

TEST_CASE("a reset that is asked for comes before the next step, once") {
  SimulationConfig config;
  config.gravity = Vector3(0, -9.81, 0);
  config.objects.resize(1);
  config.objects[0].model = std::make_shared<const Model>(synthetic_cube(2, 5, 10));
  Simulation simulation(config);
  StepRecord record;
  const StylusCommand nobody;
  for (int k = 0; k < 10; ++k) simulation.step({&nobody, 1}, record);
  const Vector3 fallen = record.object[0].position;

  NetworkServer network({});
  NoClock clock;
  StepSink sink(8);
  RunControl control(simulation.settings());
  ForceThread force(simulation, network, control, clock, {&sink}, 5);
  control.request_reset();
  control.request_reset();  // until it is done, it is one
  force.start(RealTimeScheduling::kIgnore);
  REQUIRE(force.finished().wait(kDeadlineMs));
  force.finish();
  CHECK(force.report().steps == 5);
  CHECK(force.report().resets == 1);
  for (std::uint64_t k = 10; k < 15; ++k) {
    REQUIRE(sink.take(record));
    CHECK(record.force_step == k);
    CHECK(record.reset == (k == 10));
    CHECK(record.reset_step == 10);
    if (k == 10) CHECK(record.object[0].position.norm() < 0.1 * fallen.norm());
  }
}

TEST_CASE("a tool follows the sample's orientation, and its torque is in the answer") {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = std::make_shared<const Model>(synthetic_cube(2, 5, 10));
  config.styluses[0].tool = ToolCoupling{0, {}};
  Simulation simulation(config);
  NetworkServer network({});
  StylusPort& port = network.port(0);
  RunControl control(simulation.settings());
  StepRecord record;
  for (const double angle : {0.0, 0.2}) {
    StylusInput input{.present = true};
    input.sample.orientation = Quaternion(Eigen::AngleAxisd(angle, Vector3::UnitX()));
    port.in.put(input);
    NoClock clock;
    StepSink sink(128);
    ForceThread force(simulation, network, control, clock, {&sink}, 100);
    force.start(RealTimeScheduling::kIgnore);
    REQUIRE(force.finished().wait(kDeadlineMs));
    force.finish();
    for (int k = 0; k < 100; ++k) REQUIRE(sink.take(record));
    CHECK(record.stylus[0].orientation.coeffs() == input.sample.orientation.coeffs());
    REQUIRE(port.out.receive());
    CHECK(port.out.front().force == record.stylus[0].force);
    CHECK(port.out.front().torque == record.stylus[0].torque);
    if (angle != 0.0) CHECK(port.out.front().torque.x() != 0.0);
  }
}

TEST_CASE("the force thread tells how it fares while it runs, about once a second") {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = std::make_shared<const Model>(synthetic_cube(2, 5, 10));
  Simulation simulation(config);
  NetworkServer network({});
  RealTimeClock clock(0.002);
  RunControl control(simulation.settings());
  ForceThread force(simulation, network, control, clock, {}, 0);
  control.request_reset();
  force.start(RealTimeScheduling::kIgnore);
  REQUIRE(eventually([&] { return force.health().receive(); }));
  const ForceHealth first = force.health().front();
  CHECK(first.steps > 0);
  CHECK(first.resets == 1);
  CHECK(first.step_time.count() == first.steps);
  CHECK(first.wakeup_delay.count() == first.steps - 1);  // the first one waits for nothing
  REQUIRE(eventually([&] { return force.health().receive(); }));
  const ForceHealth& second = force.health().front();
  CHECK(second.step_time.count() == second.steps - first.steps);  // of the last second alone
  force.finish();
}

namespace {

/// A falling cube whose force thread runs without a clock, slowly enough to be watched.
struct Fall {
  class Clock final : public StepClock {
   public:
    bool wait(std::uint64_t) noexcept override {
      sleep_until(monotonic_ns() + 100'000);
      return !stopped();
    }
  };
  Fall() {
    config.gravity = Vector3(0, -1, 0);
    config.objects.resize(1);
    config.objects[0].model = std::make_shared<const Model>(synthetic_cube(2, 5, 10));
    config.styluses.resize(2);
    simulation = std::make_unique<Simulation>(config);
    control = std::make_unique<RunControl>(simulation->settings());
    force = std::make_unique<ForceThread>(*simulation, network, *control, clock,
                                          std::vector<StepSink*>{&sink}, 0);
    force->add_viewer_stylus({0.002, 300.0, 3.3});
  }
  /// Takes steps until one is as wanted.
  template <typename ForceCommand>
  bool comes(const ForceCommand& wanted) {
    return eventually([&] {
      while (sink.take(record)) {
        if (wanted(record)) return true;
      }
      return false;
    });
  }

  SimulationConfig config;
  std::unique_ptr<Simulation> simulation;
  NetworkServer network{{.styluses = 1}};
  std::unique_ptr<RunControl> control;
  Clock clock;
  StepSink sink{1 << 10, {1, 2}};
  StepRecord record;
  std::unique_ptr<ForceThread> force;
};

}  // namespace

TEST_CASE("a paused run stands still, makes the steps that are asked for, and goes on") {
  Fall fall;
  fall.control->pause();
  fall.force->start(RealTimeScheduling::kIgnore);
  fall.control->request_steps(3);
  REQUIRE(fall.comes([](const StepRecord& record) { return record.force_step == 2; }));
  CHECK_FALSE(EventFd().wait(30));  // a moment in which nothing comes
  CHECK_FALSE(fall.sink.take(fall.record));
  fall.control->request_steps(1);
  REQUIRE(fall.comes([](const StepRecord& record) { return record.force_step == 3; }));
  fall.control->resume();
  CHECK(fall.comes([](const StepRecord& record) { return record.force_step == 100; }));
  fall.force->finish();
}

TEST_CASE("a bridge's stylus feels nothing while the run is paused, and comes anew afterwards") {
  Fall fall;
  StylusPort& port = fall.network.port(0);
  const double top = 0.06;
  std::uint64_t sequence = 0;
  const auto at = [&](double y) {
    StylusInput input;
    input.present = true;
    input.sample.sequence = ++sequence;
    input.sample.tip = Vector3(0, y, 0);
    port.in.put(input);
  };
  Settings still = fall.simulation->settings();
  still.gravity.setZero();
  fall.control->set(still);
  at(top + 0.001);
  fall.force->start(RealTimeScheduling::kIgnore);
  REQUIRE(fall.comes([](const StepRecord& record) { return record.stylus[0].present; }));
  at(top - 0.001);
  REQUIRE(fall.comes([](const StepRecord& record) { return record.stylus[0].force.norm() > 0; }));
  fall.control->pause();
  REQUIRE(eventually([&] {
    port.out.receive();
    return port.out.front().force.norm() == 0 && port.out.front().contact == ContactState::kFree;
  }));
  at(top - 0.001);
  REQUIRE(eventually([&] {
    port.out.receive();
    return port.out.front().sample_sequence == sequence;
  }));
  CHECK(port.out.front().force == Vector3::Zero());
  while (fall.sink.take(fall.record)) {
  }
  fall.control->resume();
  REQUIRE(fall.comes([](const StepRecord& record) { return !record.stylus[0].present; }));
  REQUIRE(fall.comes([](const StepRecord& record) { return record.stylus[0].present; }));
  CHECK(fall.record.stylus[0].force == Vector3::Zero());  // it is inside, where it cannot have come
  fall.force->finish();
}

TEST_CASE("the viewers' stylus and their settings reach the step") {
  Fall fall;
  fall.force->start(RealTimeScheduling::kIgnore);
  StylusInput input;
  input.present = true;
  input.sample.buttons = kGrabButton;
  input.sample.tip = Vector3(1, 2, 3);
  fall.control->stylus().put(input);
  REQUIRE(fall.comes([](const StepRecord& record) { return record.stylus[1].present; }));
  CHECK(fall.record.stylus[1].tip == Vector3(1, 2, 3));
  CHECK(fall.record.stylus[1].buttons == kGrabButton);
  CHECK_FALSE(fall.record.stylus[0].present);
  Settings settings = fall.simulation->settings();
  settings.gravity = Vector3(0, 5, 0);
  fall.control->set(settings);
  CHECK(fall.comes([](const StepRecord& record) { return record.settings.gravity.y() == 5.0; }));
  fall.control->stylus().put({});
  CHECK(fall.comes([](const StepRecord& record) { return !record.stylus[1].present; }));
  fall.force->finish();
}

namespace {

/// A cube that is pressed from above by a stylus of the network, in as many steps as are asked for.
struct Press {
  explicit Press(double max_force) {
    config.objects.resize(1);
    config.objects[0].model = std::make_shared<const Model>(synthetic_cube(2, 5, 10));
    config.styluses[0].max_force = max_force;
    simulation = std::make_unique<Simulation>(config);
    control = std::make_unique<RunControl>(simulation->settings());
  }
  class Clock final : public StepClock {
   public:
    bool wait(std::uint64_t) noexcept override {
      if (before) before();
      return !stopped();
    }
    std::function<void()> before;
  };
  /// The answer to each of `tips`, one step each.
  std::vector<StylusForce> answers(const std::vector<Vector3>& tips) {
    std::vector<StylusForce> answers;
    StylusPort& port = network.port(0);
    Clock clock;
    std::size_t next = 0;
    const auto take = [&] {
      if (port.out.receive()) answers.push_back(port.out.front());
    };
    clock.before = [&] {
      take();
      StylusInput input{.present = true};
      input.sample.sequence = next;
      input.sample.tip = tips[std::min(next++, tips.size() - 1)];
      port.in.put(input);
    };
    ForceThread force(*simulation, network, *control, clock, {}, tips.size());
    force.start(RealTimeScheduling::kIgnore);
    REQUIRE(force.finished().wait(kDeadlineMs));
    force.finish();
    take();
    outside = force.report().faults[0].outside;
    return answers;
  }

  SimulationConfig config;
  std::unique_ptr<Simulation> simulation;
  std::unique_ptr<RunControl> control;
  NetworkServer network{{.styluses = 1}};
  std::uint64_t outside = 0;
};

constexpr double kPressTop = 0.06;

}  // namespace

TEST_CASE("a force that is commanded to a stylus is at most its max_force") {
  constexpr double kMost = 0.5;
  Press press(kMost);
  std::vector<Vector3> tips{Vector3(0, kPressTop + 0.001, 0)};
  for (int k = 1; k < 20; ++k) tips.emplace_back(0, kPressTop - 0.002 * k, 0);
  double largest = 0.0;
  for (const StylusForce& answer : press.answers(tips)) {
    largest = std::max(largest, answer.force.norm());
  }
  CHECK(largest == Approx(kMost));
}

TEST_CASE("a position beyond the world's bound is not used: the force fades, and it is counted") {
  Press press(40.0);
  std::vector<Vector3> tips{Vector3(0, kPressTop + 0.001, 0), Vector3(0, kPressTop - 0.002, 0)};
  for (int k = 0; k < 30; ++k) tips.emplace_back(0, 1000.0, 0);
  tips.emplace_back(0, kPressTop + 0.001, 0);
  const std::vector<StylusForce> answers = press.answers(tips);
  REQUIRE(answers.size() == tips.size());
  const double before = answers[1].force.norm();
  REQUIRE(before > 0.0);
  const double step = before * press.simulation->dt() / ForceThread::kFade;
  for (std::size_t k = 2; k < 32; ++k) {
    const double fall = answers[k - 1].force.norm() - answers[k].force.norm();
    CHECK(fall >= 0.0);
    CHECK(fall <= step * (1 + 1e-9));
  }
  CHECK(answers[31].force == Vector3::Zero());
  CHECK(answers[32].force == Vector3::Zero());
  CHECK(press.outside == 30);
}
