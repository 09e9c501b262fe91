// Scenes of the gallery (docs/configuration.md) with one object that styluses touch; where bodies
// touch: test_gallery_bodies.cpp. What physics says of them, found in the trace.
#include <algorithm>

#include "tests/support/catch.hpp"
#include "tests/system/played.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

std::size_t count(const std::vector<std::uint8_t>& values, int value) {
  return static_cast<std::size_t>(std::count(values.begin(), values.end(), value));
}

}  // namespace

TEST_CASE("gallery, press: at rest under the tip the tether carries the force, and lets it back",
          "[slow]") {
  Played played("press");
  const std::size_t pressed = played.row(2.45);
  const double stiffness = played.scene().objects[0].tether.stiffness;
  CHECK(played.force(pressed).norm() > 0.3);
  CHECK(-stiffness * played.position(pressed).y() ==
        Approx(played.force(pressed).y()).epsilon(0.02));
  // The tip goes deeper than the object gives way: it is soft.
  CHECK(0.06 - played.tip(pressed).y() > -1.5 * played.position(pressed).y());
  CHECK(played.position(played.rows() - 1).norm() < 5e-4);
}

TEST_CASE("gallery, tap: the cube drifts off with the momentum of the tap", "[slow]") {
  Played played("tap");
  const auto contact = played.flags("/stylus/0/contact");
  CHECK(count(contact, 1) > 10);
  CHECK(contact.back() == 0);
  Vector3 impulse = Vector3::Zero();
  for (std::size_t k = 0; k < played.rows(); ++k) impulse -= played.dt() * played.force(k);
  const Vector3 momentum = played.mass() * played.vector("/step/body_velocity", played.rows() - 1);
  CHECK(momentum.y() < -0.01);
  CHECK((momentum - impulse).norm() < 1e-10 * impulse.norm());
}

TEST_CASE("gallery, two cubes: the stiff one gives the larger and shorter blow", "[slow]") {
  Played played("two-cubes");
  const auto steps = [&](int stylus) {
    return count(played.flags("/stylus/" + std::to_string(stylus) + "/contact"), 1);
  };
  CHECK(played.peak_force(1) > 2.0 * played.peak_force(0));
  REQUIRE(steps(1) > 3);
  CHECK(3 * steps(1) < 2 * steps(0));
  // Each stylus touches the cube that is under it, and both cubes go down.
  for (const std::string name : {"soft", "stiff"}) {
    CHECK(played.vector("/object/" + name + "/body_position", played.rows() - 1).y() < -0.1);
  }
  CHECK(played.flags("/object/soft/stylus/1/contact") ==
        std::vector<std::uint8_t>(played.rows(), 0));
  CHECK(played.flags("/object/stiff/stylus/0/contact") ==
        std::vector<std::uint8_t>(played.rows(), 0));
}

TEST_CASE("gallery, pinch: friction lifts the cube as far as the pinched points go up", "[slow]") {
  Played played("pinch");
  check_penetration(played);
  const std::size_t below = played.row(1.55);
  const std::size_t above = played.row(3.5);
  // Of the points that the tips hold; between tip and point is the coupling spring.
  const auto held = [&](std::size_t k) {
    return 0.5 * (played.vector("/stylus/0/proxy", k) + played.vector("/stylus/1/proxy", k)).y();
  };
  const double lift = held(above) - held(below);
  CHECK(lift > 0.04);
  CHECK(played.position(above).y() - played.position(below).y() == Approx(lift).margin(2e-3));
  // In the air the two of them carry it.
  const double weight = 9.81 * played.mass();
  CHECK(-(played.force(above, 0) + played.force(above, 1)).y() == Approx(weight).epsilon(0.02));
  CHECK(played.floor_force(above).isZero(0.0));
  CHECK(played.floor_force(played.rows() - 1).y() == Approx(weight).epsilon(0.02));
  CHECK(std::abs(played.position(played.rows() - 1).y()) < 1e-3);
}

TEST_CASE("gallery, swing: the object follows the stylus that holds it", "[slow]") {
  Played played("swing");
  const auto contact = played.flags("/stylus/0/contact");
  const double stiffness = played.scene().styluses[0].coupling_stiffness;
  double farthest = 0.0;
  double off = 0.0;
  for (std::size_t k = played.row(0.75); k < played.row(5.15); ++k) {
    REQUIRE(contact[k] == 2);
    farthest = std::max(farthest, std::abs(played.position(k).x()));
    // What is held is where the coupling spring lets it be, at the offset that it was taken at.
    const Vector3 held =
        played.tip(k) - played.orientation(k) * played.vector("/stylus/0/offset", k);
    off = std::max(off, (held - played.vector("/stylus/0/proxy", k)).norm() -
                            played.force(k).norm() / stiffness);
  }
  INFO("centre of mass " << farthest << " m to the side, point off by " << off << " m");
  CHECK(farthest > 0.015);
  CHECK(off < 2e-4);
  CHECK(contact.back() == 0);
}

TEST_CASE("gallery, slide: the contact slips along the top, with kinetic friction", "[slow]") {
  Played played("slide");
  const auto slipping = played.flags("/stylus/0/slipping");
  const double friction = played.scene().objects[0].friction.kinetic;
  const std::size_t begin = played.row(1.5);
  const std::size_t end = played.row(2.5);
  double worst = 0.0;
  for (std::size_t k = begin; k < end; ++k) {
    REQUIRE(slipping[k] == 1);
    const Vector3 force = played.orientation(k - 1).conjugate() * played.force(k);
    const double along = Vector3(force.x(), 0, force.z()).norm();
    worst = std::max(worst, std::abs(along / force.y() - friction));
    CHECK(force.x() < 0.0);  // against the motion
  }
  INFO("friction off by " << worst);
  CHECK(worst < 0.01);
  CHECK((played.vector("/stylus/0/proxy", end) - played.vector("/stylus/0/proxy", begin)).x() >
        0.04);
}

TEST_CASE("gallery, rest: the floor carries the cube that has dropped on it, and pushed it slides",
          "[slow]") {
  Played played("rest");
  check_penetration(played);
  const double weight = 9.81 * played.mass();
  double mean = 0.0;
  const std::size_t begin = played.row(2.0);
  const std::size_t end = played.row(2.5);
  for (std::size_t k = begin; k < end; ++k) mean += played.floor_force(k).y() / (end - begin);
  CHECK(mean == Approx(weight).epsilon(0.002));
  CHECK((played.position(end) - played.position(begin)).norm() < 3e-4);
  const double pushed = played.position(played.rows() - 1).x() - played.position(end).x();
  CHECK(pushed < -0.015);
  // While it slides, the stylus has to overcome friction; the floor takes what it presses down.
  CHECK(played.peak_force() > played.scene().floor->friction.kinetic * weight);
  CHECK(std::abs(played.position(played.rows() - 1).y() - played.position(end).y()) < 1e-3);
}

TEST_CASE("gallery, liver: it resists on both lobes, and stays where it is fixed", "[slow]") {
  Played played("liver", "palpate");
  const std::size_t thick = played.row(2.4);
  const std::size_t thin = played.row(6.4);
  for (const std::size_t k : {thick, thin}) {
    CHECK(played.force(k).y() > 0.2);
    // At rest, the hand's spring carries it: 300 N/m from the script to the tip.
    const double scripted = k == thick ? 0.017 : 0.007;
    CHECK(played.force(k).y() == Approx(300.0 * (played.tip(k).y() - scripted)).epsilon(0.02));
  }
  CHECK(played.position(played.rows() - 1).isZero(0.0));
  CHECK(played.flags("/stylus/0/contact").back() == 0);
}
