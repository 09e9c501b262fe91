#include "device_bridge/contact/bridge_contact.hpp"
#include "tests/bridge/milliseconds.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/left_out.hpp"

using namespace irdm;
using irdm::test::kMs;

namespace {

constexpr double kDt = 0.002;

/// A fixed wall at y = 0 that gives way by 1 mm per newton within a step, and not later.
ContactModel wall(std::uint64_t step) {
  ContactModel model;
  model.valid = true;
  model.step = step;
  model.newest = step;
  model.dt = kDt;
  model.horizon = 25;
  model.body = {1.0, Matrix3::Identity(), Support::kFixed};
  model.normal = Vector3(0, 1, 0);
  model.response[0] = 1e-3 * Matrix3::Identity();
  REQUIRE(check(model) == ContactModelFault::kNone);
  return model;
}

/// Ticks of 1 ms with a tip at this height, each step with a newer model if `served`.
class Bench {
 public:
  int ticks(int count, double height, bool served = true) {
    int told = 0;
    for (int i = 0; i < count; ++i, now_ns += kMs) {
      if (served && now_ns % (2 * kMs) == 0) {
        // The server has heard of the touch by then.
        ContactModel model = wall(server_step++);
        model.energy = energy;
        model.friction = friction;
        if (yields_later) model.response[1] = 0.5 * model.response[0];
        // What it does not know of is taken to be at the bridge alone.
        if (yields_later) model.missing = ~std::uint64_t{0} >> (64 - kMaxHorizon);
        if (contact.wanted().contact == ContactState::kTouching) {
          model.state = ContactState::kTouching;
        }
        contact.receive(model, now_ns);
      }
      told += contact.tick(now_ns, Vector3(0, height, 0)) ? 1 : 0;
      contact.shown(share * contact.wanted().force);
    }
    return told;
  }
  BridgeContact contact{kDt, kMs};
  std::int64_t now_ns = 0;
  std::uint64_t server_step = 100;
  double energy = 0.0;
  double share = 1.0;  ///< of the force that the device shows
  bool yields_later = false;
  Friction friction;
};

}  // namespace

TEST_CASE("contact at the bridge: nothing is asked for before the first model") {
  Bench bench;
  CHECK(bench.ticks(10, -0.001, false) == 0);
  CHECK_FALSE(bench.contact.wanted().any);
  CHECK(bench.ticks(2, 0.001) > 0);
  CHECK(bench.contact.wanted().any);
  CHECK(bench.contact.wanted().force.isZero(0.0));
}

TEST_CASE("contact at the bridge: a wall pushes by its stiffness, and the server is told of it") {
  Bench bench;
  bench.ticks(100, 0.001);
  CHECK(bench.ticks(40, -0.001) == 20);
  const BridgeContact::ForceCommand& wanted = bench.contact.wanted();
  CHECK(wanted.contact == ContactState::kTouching);
  CHECK((wanted.force - Vector3(0, 1, 0)).norm() < 1e-12);
  CHECK((wanted.normal - Vector3(0, 1, 0)).norm() < 1e-12);
  CHECK(wanted.horizon_ns == 50 * kMs);
  const AppliedForces& applied = bench.contact.applied();
  CHECK(applied.count == AppliedForces::kSteps);
  CHECK(applied.step == bench.server_step - 1 + bench.contact.lookahead());
  CHECK((applied.past[3].force - Vector3(0, -1, 0)).norm() < 1e-12);
  CHECK(applied.past[3].tip == Vector3(0, -0.001, 0));
}

TEST_CASE(
    "contact at the bridge: its device may give the model's energy and its hand's work since") {
  Bench bench;
  bench.energy = 0.01;
  bench.ticks(140, -0.001);
  CHECK(bench.contact.wanted().energy == Approx(0.01));
  bench.ticks(2, -0.0015, false);  // half a millimetre against one newton
  CHECK(bench.contact.wanted().energy == Approx(0.0105));
  bench.ticks(2, -0.0005, false);  // back by a millimetre with one and a half
  CHECK(bench.contact.wanted().energy == Approx(0.009));
}

TEST_CASE("contact at the bridge: without newer models what it asks for ages by its own clock") {
  Bench bench;
  bench.ticks(100, -0.001);
  const std::int64_t last = bench.contact.wanted().content_ns;
  CHECK(bench.now_ns - last <= 8 * kMs);
  bench.ticks(40, -0.001, false);
  CHECK(bench.contact.wanted().content_ns == last);
  CHECK(bench.contact.wanted().force.y() > 0.9);
  // Beyond the horizon nothing is solved: what the device goes on to show acts on the object.
  bench.ticks(40, -0.001, false);
  CHECK(bench.contact.wanted().content_ns == last);
  CHECK(bench.contact.applied().past[0].force == -bench.contact.wanted().force);
  bench.share = 0.25;
  bench.ticks(4, -0.001, false);
  CHECK(bench.contact.applied().past[0].force.isApprox(-0.25 * bench.contact.wanted().force));
}

TEST_CASE("contact at the bridge: a run that stands still says so, and goes on at its own number") {
  Bench bench;
  bench.ticks(100, -0.001);
  ContactModel standing;
  standing.paused = true;
  standing.step = bench.server_step - 1;
  bench.contact.receive(standing, bench.now_ns);
  CHECK(bench.contact.wanted().paused);
  CHECK(bench.ticks(500, -0.001, false) == 0);
  CHECK(bench.ticks(20, -0.001) > 5);
  CHECK_FALSE(bench.contact.wanted().paused);
  CHECK(bench.contact.lookahead() < 5);
  CHECK(bench.contact.wanted().force.y() < 0.05);
  bench.ticks(500, -0.001);
  CHECK((bench.contact.wanted().force - Vector3(0, 1, 0)).norm() < 1e-12);
}

TEST_CASE("contact at the bridge: where nothing can be touched no force is asked for") {
  Bench bench;
  bench.ticks(100, -0.001);
  ContactModel none;
  none.step = bench.server_step;
  none.dt = kDt;
  bench.contact.receive(none, bench.now_ns);
  bench.ticks(4, -0.001, false);
  CHECK(bench.contact.wanted().any);
  CHECK(bench.contact.wanted().force.isZero(0.0));
  CHECK(bench.contact.wanted().contact == ContactState::kFree);
}

TEST_CASE("contact at the bridge: a million ticks allocate nothing", "[unsanitized]") {
  if (!test::AllocationGuard::active()) return test::leave_out(test::kNotCounted);
  Bench bench;
  const ContactModel model = wall(0);
  ContactModel next = model;
  const test::AllocationGuard guard;
  for (int i = 0; i < 1'000'000; ++i) {
    const std::int64_t now_ns = i * kMs;
    if (i % 2 == 0) {
      next.step = next.newest = static_cast<std::uint64_t>(i / 2);
      bench.contact.receive(next, now_ns);
    }
    bench.contact.tick(now_ns, Vector3(0, i % 1000 < 500 ? -0.001 : 0.001, 0));
  }
  CHECK(guard.count() == 0);
  CHECK(bench.contact.wanted().any);
}

TEST_CASE("contact at the bridge: no touch begins deeper than the tip can have come") {
  Bench bench;
  bench.ticks(100, -0.05);
  CHECK(bench.contact.wanted().any);
  CHECK(bench.contact.wanted().force.isZero(0.0));
  bench.ticks(100, 0.001);
  bench.ticks(20, -0.001);
  CHECK(bench.contact.wanted().force.y() > 0.9);
}

TEST_CASE("contact at the bridge: the way of a tip counts while nothing can be touched") {
  Bench bench;
  bench.ticks(100, 0.001);
  for (int i = 0; i < 20; ++i) {
    ContactModel none;
    none.step = bench.server_step++;
    none.dt = kDt;
    bench.contact.receive(none, bench.now_ns);
    bench.ticks(2, -0.05, false);
  }
  bench.ticks(100, -0.05);
  CHECK(bench.contact.wanted().any);
  CHECK(bench.contact.wanted().force.isZero(0.0));
}

TEST_CASE("contact at the bridge: the way of a tip while the run stood still does not count") {
  Bench bench;
  bench.ticks(100, 0.05);
  ContactModel standing;
  standing.paused = true;
  standing.step = bench.server_step - 1;
  bench.contact.receive(standing, bench.now_ns);
  bench.ticks(100, -0.05, false);
  bench.contact.receive(wall(bench.server_step++), bench.now_ns);
  // The first tick is late, so that two steps are due at once.
  bench.now_ns += 4 * kMs;
  CHECK(bench.contact.tick(bench.now_ns, Vector3(0, -0.05, 0)));
  CHECK(bench.contact.lookahead() == 3);
  CHECK(bench.contact.wanted().any);
  CHECK(bench.contact.wanted().force.isZero(0.0));
}

TEST_CASE("contact at the bridge: no force is larger than a hand's") {
  Bench bench;
  bench.ticks(100, 0.001);
  for (int i = 0; i < 300; ++i) bench.ticks(1, -0.001 * i);
  CHECK(bench.contact.wanted().force.norm() == Approx(kMostAppliedForce));
  CHECK(bench.contact.applied().past[0].force.norm() == Approx(kMostAppliedForce));
}

// The wall also gives way by half as much in the step after, so that what it got before matters.
TEST_CASE("contact at the bridge: the object gets what the device shows") {
  Bench bench;
  bench.yields_later = true;
  bench.ticks(100, 0.001);
  bench.ticks(160, -0.001);
  const Vector3 full = bench.contact.wanted().force;
  CHECK((full - Vector3(0, 1.0 / 1.5, 0)).norm() < 1e-12);
  bench.share = 0.4;
  bench.ticks(160, -0.001);
  const AppliedForces& applied = bench.contact.applied();
  // What is solved knows of what was shown: x = w (f_k + share f_k-1 / 2).
  const Vector3& solved = bench.contact.wanted().force;
  CHECK((solved - Vector3(0, 1.0 / 1.2, 0)).norm() < 1e-12);
  for (std::size_t i = 0; i < 4; ++i) CHECK((applied.past[i].force + 0.4 * solved).norm() < 1e-12);
  bench.share = 0.0;
  bench.ticks(4, -0.001);
  CHECK(applied.past[0].force.isZero(0.0));
  CHECK((bench.contact.wanted().force - Vector3(0, 1, 0)).norm() < 1e-12);
}

TEST_CASE("contact at the bridge: the object gets of what is shown what a touch can exert") {
  Bench bench;
  bench.friction = {0.5, 0.4};
  bench.ticks(100, 0.001);
  bench.ticks(20, -0.001);
  const auto told = [&](const Vector3& shown) {
    while (!bench.contact.tick(bench.now_ns, Vector3(0, -0.001, 0))) bench.now_ns += kMs;
    bench.contact.shown(shown);
    return bench.contact.applied().past[0].force;
  };
  CHECK((told(Vector3(0, 0.7, 0)) - Vector3(0, -0.7, 0)).norm() < 1e-12);
  CHECK(told(Vector3(0, -0.7, 0)).isZero(0.0));  // it does not pull
  const Vector3 slant = told(Vector3(2.0, 1.0, 0));
  CHECK(slant.y() == Approx(-1.0));
  CHECK(slant.x() == Approx(-bench.friction.static_));
  CHECK(slant.z() == 0.0);
}

TEST_CASE("contact at the bridge: a touch in an overrun begins after it, and none acts in it") {
  Bench bench;
  bench.ticks(100, 0.001);
  const std::uint64_t before = bench.contact.applied().step;
  bench.now_ns += 10 * kMs;
  REQUIRE(bench.contact.tick(bench.now_ns, Vector3(0, -0.03, 0)));
  bench.contact.shown(bench.contact.wanted().force);
  const AppliedForces& applied = bench.contact.applied();
  REQUIRE(applied.step >= before + 5);
  CHECK(bench.contact.wanted().contact == ContactState::kTouching);
  CHECK((applied.past[0].force - Vector3(0, -30, 0)).norm() < 1e-12);
  for (std::size_t i = 1; i < 5; ++i) CHECK(applied.past[i].force.isZero(0.0));
}

TEST_CASE("contact at the bridge: in an overrun the device goes on showing its force") {
  Bench bench;
  bench.ticks(100, -0.001);
  bench.now_ns += 10 * kMs;
  REQUIRE(bench.contact.tick(bench.now_ns, Vector3(0, -0.002, 0)));
  const AppliedForces& applied = bench.contact.applied();
  CHECK((applied.past[0].force - Vector3(0, -2, 0)).norm() < 1e-12);
  for (std::size_t i = 1; i < 5; ++i) {
    CHECK((applied.past[i].force - Vector3(0, -1, 0)).norm() < 1e-12);
  }
}

TEST_CASE("contact at the bridge: after a silence a contact comes back as slowly as to the hand") {
  Bench bench;
  bench.ticks(100, 0.001);
  bench.ticks(10, -0.001);
  bench.ticks(200, -0.001, false);
  bench.server_step += 100;
  // Meanwhile the object came nearer; in full the wall would push with 40 N.
  const double step = 40.0 * kDt / ContactPredictor::kReturn;
  double before = 0.0;
  for (int i = 0; i < 260; ++i) {
    bench.ticks(2, -0.04);
    const double force = bench.contact.wanted().force.y();
    CHECK(force <= before + 3 * step);
    before = force;
  }
  CHECK(before == Approx(40.0));
  CHECK(bench.contact.applied().past[0].force.y() == Approx(-40.0));
}

TEST_CASE("contact at the bridge: a touch that begins after a silence is as strong as any") {
  Bench bench;
  bench.ticks(100, 0.001);
  bench.ticks(200, 0.001, false);
  bench.server_step += 100;
  bench.ticks(20, 0.001);
  bench.ticks(6, -0.001);
  CHECK((bench.contact.wanted().force - Vector3(0, 1, 0)).norm() < 1e-12);
}

TEST_CASE("contact at the bridge: who falls behind the server catches up, in contact too") {
  Bench bench;
  bench.ticks(100, 0.001);
  bench.ticks(40, -0.001);
  bench.server_step += 12;
  bench.ticks(10, -0.001);
  CHECK(bench.contact.lookahead() >= 1);
  CHECK(bench.contact.wanted().force.y() > 0.9);
  bench.server_step += 1'000'000;
  bench.ticks(10, -0.001);
  CHECK(bench.contact.lookahead() >= 1);
}

TEST_CASE("contact at the bridge: steps that are due at once share the way of the tip evenly") {
  Bench bench;
  bench.ticks(100, 0.002);
  const std::uint64_t before = bench.contact.applied().step;
  bench.now_ns += 6 * kMs;
  CHECK(bench.contact.tick(bench.now_ns, Vector3(0, -0.001, 0)));
  const AppliedForces& applied = bench.contact.applied();
  const std::uint64_t count = applied.step - before;
  REQUIRE(count >= 3);
  REQUIRE(count <= static_cast<std::uint64_t>(applied.count));
  for (std::size_t age = 0; age < count; ++age) {
    const double way = 1.0 - static_cast<double>(age) / static_cast<double>(count);
    CAPTURE(age, count);
    CHECK((applied.past[age].tip - Vector3(0, 0.002 - 0.003 * way, 0)).norm() < 1e-15);
  }
  CHECK(applied.past[count].tip == Vector3(0, 0.002, 0));
}
