#include <catch2/catch.hpp>
#include <limits>

#include "device_bridge/force_guard.hpp"

using irdm::ForceGuard;
using irdm::GuardLimits;
using irdm::ServoInput;
using irdm::Vector3;

namespace {

constexpr std::int64_t kMs = 1'000'000;

ServoInput force_of(std::int64_t sample_ms, const Vector3& force = Vector3(0, 1, 0)) {
  return {.linked = true,
          .any_force = true,
          .force = {.sample_time_ns = sample_ms * kMs, .force = force}};
}

double shown(ForceGuard& guard, std::int64_t now_ms, const ServoInput& input) {
  return guard.apply(now_ms * kMs, input).y();
}

}  // namespace

TEST_CASE("guard shows a force in full until it is 50 ms old and none after 80 ms") {
  ForceGuard guard{GuardLimits{}};
  const ServoInput input = force_of(0);
  CHECK(shown(guard, 1, input) == 1.0);
  CHECK(shown(guard, 50, input) == 1.0);
  CHECK(shown(guard, 65, input) == Approx(0.5));
  CHECK(shown(guard, 80, input) == 0.0);
  CHECK(shown(guard, 1000, input) == 0.0);
}

TEST_CASE(
    "guard fades at once when the link is lost, and a new link does not bring the force back") {
  ForceGuard guard{GuardLimits{}};
  ServoInput input = force_of(100);
  CHECK(shown(guard, 101, input) == 1.0);
  input.linked = false;
  CHECK(shown(guard, 102, input) == 1.0);
  CHECK(shown(guard, 117, input) == Approx(0.5));
  input = {.linked = true};  // a new session without a force
  CHECK(shown(guard, 120, input) == Approx(0.4));
  CHECK(shown(guard, 132, input) == 0.0);
  CHECK(shown(guard, 140, input) == 0.0);
}

TEST_CASE("guard lets a force come back over the fade time only") {
  ForceGuard guard{GuardLimits{}};
  CHECK(shown(guard, 0, force_of(0)) == 1.0);
  CHECK(shown(guard, 200, force_of(0)) == 0.0);
  CHECK(shown(guard, 201, force_of(200)) == Approx(1.0 / 30.0));
  CHECK(shown(guard, 216, force_of(215)) == Approx(16.0 / 30.0));
  CHECK(shown(guard, 231, force_of(230)) == 1.0);
}

TEST_CASE("guard shortens what is too large and keeps its direction") {
  ForceGuard guard{GuardLimits{.max_force = 2.0}};
  const Vector3 force = guard.apply(0, force_of(0, Vector3(30, -40, 0)));
  CHECK(force.isApprox(Vector3(1.2, -1.6, 0)));
  CHECK(guard.apply(0, force_of(0, Vector3(1e300, 0, 0))).isApprox(Vector3(2, 0, 0)));
  CHECK(guard.apply(0, force_of(0, Vector3(0, 0, 2))) == Vector3(0, 0, 2));
}

TEST_CASE("guard makes zero of each component that is not finite") {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (int axis = 0; axis < 3; ++axis) {
      ForceGuard guard{GuardLimits{}};
      Vector3 force(1, 1, 1);
      force[axis] = bad;
      CHECK(guard.apply(0, force_of(0, force)) == Vector3::Zero());
      CHECK(guard.faults() == 1);
    }
  }
}

TEST_CASE("guard shows nothing for a sample of the future, and nothing before the first force") {
  ForceGuard future{GuardLimits{}};
  CHECK(shown(future, 0, force_of(1)) == 0.0);
  ForceGuard early{GuardLimits{}};
  CHECK(shown(early, 5, {.linked = true}) == 0.0);
  CHECK(shown(early, 6, {}) == 0.0);
}
