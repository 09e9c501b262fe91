#include <cmath>
#include <limits>

#include "server/threads/viewer_stylus.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

namespace {

constexpr double kDt = 0.002;

StylusCommand at(const Vector3& tip, std::uint32_t buttons = 0) {
  return {true, buttons, tip, std::nullopt};
}

}  // namespace

TEST_CASE("viewers' stylus: begins where it is pressed and follows smoothly") {
  ViewerStylus stylus(kDt, 300.0, 3.3);
  CHECK(stylus.next(at(Vector3(1, 0, 0)), {}).tip == Vector3(1, 0, 0));
  // A step of 1 mm is taken exponentially.
  const Vector3 wanted(1.001, 0, 0);
  for (int k = 1; k <= 30; ++k) {
    const double left = 1e-3 * std::exp(-k * kDt / ViewerStylus::kSmoothing);
    CHECK(wanted.x() - stylus.next(at(wanted), {}).tip.x() == Approx(left).epsilon(1e-9));
  }
}

TEST_CASE("viewers' stylus: is never faster than 1 m/s") {
  ViewerStylus stylus(kDt, 300.0, 3.3);
  Vector3 last = stylus.next(at(Vector3::Zero()), {}).tip;
  for (int k = 0; k < 100; ++k) {
    const Vector3 tip = stylus.next(at(Vector3(0, k % 7 < 3 ? 5.0 : -5.0, 1.0)), {}).tip;
    CHECK((tip - last).norm() <= 1.0 * kDt * (1 + 1e-12));
    last = tip;
  }
}

TEST_CASE("viewers' stylus: pushes and pulls with no more than it may") {
  constexpr double kStiffness = 300.0;
  constexpr double kMost = 3.3;
  ViewerStylus stylus(kDt, kStiffness, kMost);
  StylusRecord last;
  last.tip = stylus.next(at(Vector3::Zero()), last).tip;
  // A wall at y = 0 behind a spring: F = -k y on the tip.
  for (int k = 0; k < 500; ++k) {
    const Vector3 wanted(0, k < 250 ? -0.1 : 0.1, 0);
    last.tip = stylus.next(at(wanted), last).tip;
    last.contact = ContactState::kHeld;
    last.force = Vector3(0, -kStiffness * last.tip.y(), 0);
    CHECK(last.force.norm() <= kMost * (1 + 1e-9));
    if (k % 250 == 249) CHECK(last.force.norm() == Approx(kMost));
  }
  SECTION("and without a bound with whatever comes") {
    ViewerStylus unbounded(kDt, kStiffness, 0.0);
    last = {};
    for (int k = 0; k < 500; ++k) {
      last.tip = unbounded.next(at(Vector3(0, -0.1, 0)), last).tip;
      last.force = Vector3(0, -kStiffness * last.tip.y(), 0);
    }
    CHECK(last.force.norm() == Approx(30.0));
  }
}

TEST_CASE("viewers' stylus: absent or nowhere, it is not there, and begins anew") {
  ViewerStylus stylus(kDt, 300.0, 3.3);
  stylus.next(at(Vector3::Zero()), {});
  CHECK_FALSE(stylus.next({}, {}).present);
  CHECK(stylus.next(at(Vector3(2, 0, 0), kGrabButton), {}).tip == Vector3(2, 0, 0));
  CHECK_FALSE(stylus.next(at(Vector3(0, std::numeric_limits<double>::quiet_NaN(), 0)), {}).present);
  const StylusCommand again = stylus.next(at(Vector3(3, 0, 0), kGrabButton), {});
  CHECK(again.tip == Vector3(3, 0, 0));
  CHECK(again.buttons == kGrabButton);
}
