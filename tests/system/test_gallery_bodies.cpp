// Scenes of the gallery in which bodies touch each other, or are lifted. What physics says of them,
// found in the trace.
#include <algorithm>
#include <array>

#include "tests/support/catch.hpp"
#include "tests/system/played.hpp"

using namespace irdm;
using namespace irdm::test;

TEST_CASE(
    "gallery, stack: at rest each cube carries what is above it; pushed over, two fall beside the "
    "lowest",
    "[slow]") {
  Played played("stack");
  check_penetration(played);
  const double weight = 9.81 * played.mass();
  const std::size_t rest = played.row(2.9);
  for (int i = 0; i < 3; ++i) {
    const Vector3 carried = played.body_force(rest, i, i - 1);  // the plane is -1
    CHECK(carried.y() == Approx((3 - i) * weight).epsilon(0.005));
    CHECK(Vector3(carried.x(), 0, carried.z()).norm() < 0.01 * weight);
  }
  const std::size_t end = played.rows() - 1;
  double farthest = 0.0;
  for (int i = 0; i < 3; ++i) {
    const std::string set =
        "/object/" + played.scene().objects[static_cast<std::size_t>(i)].name + "/body_position";
    CHECK(played.vector(set, end).y() == Approx(0.06).margin(1e-3));
    CHECK(played.body_force(end, i, -1).y() == Approx(weight).epsilon(0.01));
    const double x = played.vector(set, end).x();
    if (i == 0) CHECK(std::abs(x) < 0.03);
    if (i > 0) CHECK(x < farthest - 0.1);  // beside the one that was below it
    farthest = x;
  }
}

TEST_CASE("gallery, tray: led against all four walls, the cube stays inside", "[slow]") {
  // Its walls end half-way up the cube: how deep their edges press into it, docs/results.md says.
  Played played("tray");
  const double inner = 0.13 - 0.06;  // m, of the centre, if the cube were rigid
  double farthest = 0.0;
  double lowest = 1.0;
  double highest = 0.0;
  double unbalanced = 0.0;
  std::array<double, 5> largest{};  // of the base and the walls
  for (std::size_t k = 1; k < played.rows(); ++k) {
    const Vector3 place = played.position(k);
    farthest = std::max({farthest, std::abs(place.x()), std::abs(place.z())});
    lowest = std::min(lowest, place.y());
    highest = std::max(highest, place.y());
    unbalanced = std::max(unbalanced, played.unbalanced(k).norm());
    for (int i = 0; i < 5; ++i) {
      double& most = largest[static_cast<std::size_t>(i)];
      most = std::max(most, played.body_force(k, 0, -1 - i).norm());
    }
  }
  INFO("centre as far as " << farthest << " m, from " << lowest << " to " << highest
                           << " m high, forces off by " << unbalanced << " N");
  CHECK(farthest < inner + 0.01);
  CHECK(lowest > 0.05);
  CHECK(highest < 0.07);
  CHECK(unbalanced < 1e-9);
  for (const double most : largest) CHECK(most > 0.3);
  const double weight = 9.81 * played.mass();
  CHECK(played.body_force(played.rows() - 1, 0, -1).y() == Approx(weight).epsilon(0.02));
}

TEST_CASE("gallery, peg: both posts resist alike, until the cube has come between them",
          "[exhaustive]") {
  Played played("peg");
  check_penetration(played);
  const double weight = 9.81 * played.mass();
  const std::size_t pushed = played.row(3.0);
  const Vector3 front = played.body_force(pushed, 0, -2);
  const Vector3 back = played.body_force(pushed, 0, -3);
  INFO("posts " << front.transpose() << " N, " << back.transpose() << " N");
  CHECK(front.z() < -0.5);
  CHECK((front + back).z() == Approx(0.0).margin(0.05 * back.z()));
  CHECK((front - back).x() == Approx(0.0).margin(0.05 * back.x()));
  CHECK(back.x() > 0.1);  // against the push
  CHECK(played.force(pushed).x() > (front + back).x());
  double unbalanced = 0.0;
  for (std::size_t k = 1; k < played.rows(); ++k) {
    unbalanced = std::max(unbalanced, played.unbalanced(k).norm());
  }
  INFO("forces off by " << unbalanced << " N");
  CHECK(unbalanced < 1e-9);
  // It stays in the gap when the stylus is gone, squeezed by both, its weight on the table.
  const std::size_t end = played.rows() - 1;
  CHECK(played.force(end).isZero(0.0));
  CHECK(std::abs(played.position(end).x()) < 0.03);
  CHECK((played.position(end) - played.position(played.row(5.5))).norm() < 5e-4);
  const Vector3 in_front = played.body_force(end, 0, -2);
  const Vector3 behind = played.body_force(end, 0, -3);
  CHECK(behind.z() > 0.3);
  // What they differ by the friction of the table takes.
  CHECK((in_front + behind).z() == Approx(0.0).margin(0.2 * behind.z()));
  CHECK((played.body_force(end, 0, -1) + in_front + behind).y() == Approx(weight).epsilon(0.01));
}

TEST_CASE("gallery, squeeze: friction alone lifts the ball, inside the cone, and carries it",
          "[slow]") {
  Played played("squeeze");
  check_penetration(played);
  const double weight = 9.81 * played.mass();
  const Model ball = played.model();
  const double friction = played.scene().objects[0].friction.static_;
  const std::size_t begin = played.row(3.6);
  const std::size_t end = played.row(4.1);
  CHECK(played.position(begin).y() - played.position(played.row(0.9)).y() > 0.04);
  double steepest = 0.0;  // of a force, as a share of that across the surface
  double by_pressure = -weight;
  double carried_off = 0.0;
  double unbalanced = 0.0;
  for (std::size_t k = begin; k < end; ++k) {
    Vector3 pressure = Vector3::Zero();
    for (int s = 0; s < 2; ++s) {
      const Vector3 rest = played.contact_at_rest(k, s, ball);
      const Vector3 normal = (played.orientation(k) * rest).normalized();  // of a ball
      const Vector3 force = -played.force(k, s);
      const Vector3 across = force.dot(normal) * normal;
      steepest = std::max(steepest, (force - across).norm() / across.norm());
      pressure += across;
    }
    by_pressure = std::max(by_pressure, pressure.y());
    carried_off = std::max(
        carried_off, std::abs(-(played.force(k, 0) + played.force(k, 1)).y() - weight) / weight);
    unbalanced = std::max(unbalanced, played.unbalanced(k).norm());
    CHECK(played.body_force(k, 0, -1).isZero(0.0));
  }
  INFO("forces along the surface up to " << steepest << " of those across it, which lift "
                                         << by_pressure << " N of " << weight << " N");
  CHECK(steepest < friction);
  CHECK(by_pressure < 0.0);  // they hold it above its middle: pressing pushes it down
  CHECK(carried_off < 0.01);
  CHECK(unbalanced < 1e-9);
  CHECK(played.body_force(played.rows() - 1, 0, -1).y() == Approx(weight).epsilon(0.1));
}

TEST_CASE("gallery, five fingers: they press alike, and friction carries the ball", "[slow]") {
  Played played("five-fingers");
  check_penetration(played);
  const double weight = 9.81 * played.mass();
  double unbalanced = 0.0;
  double carried_off = 0.0;
  double aside = 0.0;
  double least = 1e3;
  double most = 0.0;
  for (std::size_t k = played.row(3.6); k < played.row(4.1); ++k) {
    Vector3 sum = Vector3::Zero();
    for (int s = 0; s < 5; ++s) {
      const Vector3 force = -played.force(k, s);
      sum += force;
      const double push = Vector3(force.x(), 0, force.z()).norm();
      least = std::min(least, push);
      most = std::max(most, push);
    }
    carried_off = std::max(carried_off, std::abs(sum.y() - weight) / weight);
    aside = std::max(aside, Vector3(sum.x(), 0, sum.z()).norm());
    unbalanced = std::max(unbalanced, played.unbalanced(k).norm());
    CHECK(played.body_force(k, 0, -1).isZero(0.0));
  }
  INFO("they press with " << least << " to " << most << " N, aside " << aside << " N");
  CHECK(carried_off < 0.01);
  CHECK(aside < 0.01 * weight);
  CHECK(least > 0.9 * most);
  CHECK(unbalanced < 1e-9);
  CHECK(played.position(played.row(4.0)).y() - played.position(played.row(0.9)).y() > 0.04);
  CHECK(played.body_force(played.rows() - 1, 0, -1).y() == Approx(weight).epsilon(0.1));
}

TEST_CASE("gallery, spatula: it takes the slab's weight from the rails and gives it back",
          "[exhaustive]") {
  Played played("spatula");
  check_penetration(played);
  const double weight = 9.81 * played.mass(0);
  const double tool = 9.81 * played.mass(1);
  const std::size_t lifted = played.row(7.5);
  CHECK(played.body_force(lifted, 0, 1).y() == Approx(weight).epsilon(0.005));
  CHECK(-played.force(lifted).y() == Approx(weight + tool).epsilon(0.005));
  CHECK(played.body_force(lifted, 0, -1).isZero(0.0));
  CHECK(played.body_force(lifted, 0, -2).isZero(0.0));
  for (const std::size_t k : {played.row(1.4), played.rows() - 1}) {
    const Vector3 front = played.body_force(k, 0, -1);
    const Vector3 back = played.body_force(k, 0, -2);
    CHECK((front + back).y() == Approx(weight).epsilon(0.005));
    CHECK(front.y() == Approx(back.y()).epsilon(0.02));
    CHECK((front + back).z() == Approx(0.0).margin(0.02 * weight));
    CHECK(-played.force(k).y() == Approx(tool).epsilon(0.005));
  }
  const std::string slab = "/object/slab/body_position";
  CHECK(played.vector(slab, lifted).y() - played.vector(slab, played.row(1.4)).y() > 0.03);
}

TEST_CASE("gallery, bowl: the rod stirs the cube, which stays inside", "[exhaustive]") {
  Played played("bowl");
  check_penetration(played);
  const std::string cube = "/object/cube/body_position";
  double way = 0.0;
  double farthest = 0.0;
  double pushed = 0.0;
  for (std::size_t k = 1; k < played.rows(); ++k) {
    const Vector3 place = played.vector(cube, k);
    way += (place - played.vector(cube, k - 1)).norm();
    farthest = std::max({farthest, std::abs(place.x()), std::abs(place.z())});
    pushed = std::max(pushed, played.body_force(k, 0, 1).norm());
  }
  INFO("way " << way << " m, as far as " << farthest << " m, pushed with " << pushed << " N");
  CHECK(way > 0.1);
  CHECK(farthest < 0.13 - 0.03 + 0.01);
  CHECK(pushed > 0.3);
  const std::size_t end = played.rows() - 1;
  const double weight = 9.81 * played.mass(0);
  CHECK(played.body_force(end, 0, -1).y() == Approx(weight).epsilon(0.02));
  CHECK(-played.force(end).y() == Approx(9.81 * played.mass(1)).epsilon(0.02));
}

namespace {

// A hand of two styluses in a step.
struct Pinch {
  double least = 0.0;     ///< of both forces [N]
  Vector3 sum{0, 0, 0};   ///< on the object [N], W
  double steepest = 0.0;  ///< largest share of a force along the surface in that across it
  Vector3 held{0, 0, 0};  ///< middle of both points that are held [m], W
  Vector3 tips{0, 0, 0};  ///< of both tips
};

// @param ring radius of the circle in the middle of the torus' tube, round y [m]
Pinch pinch_of_torus(Played& played, const Model& torus, std::size_t k, int first, double ring) {
  Pinch pinch;
  pinch.least = std::min(played.force(k, first).norm(), played.force(k, first + 1).norm());
  for (int s = first; s < first + 2; ++s) {
    const Vector3 rest = played.contact_at_rest(k, s, torus);
    const Vector3 middle = ring * Vector3(rest.x(), 0, rest.z()).normalized();
    const Vector3 normal = played.orientation(k) * (rest - middle).normalized();
    const Vector3 force = -played.force(k, s);
    const Vector3 across = force.dot(normal) * normal;
    pinch.steepest = std::max(pinch.steepest, (force - across).norm() / across.norm());
    pinch.sum += force;
    pinch.held += 0.5 * (played.position(k) + played.orientation(k) * rest);
    pinch.tips += 0.5 * played.tip(k, s);
  }
  return pinch;
}

}  // namespace

TEST_CASE("gallery, torus: two hands pass it by friction alone, and it is never free",
          "[exhaustive]") {
  Played played("torus");
  check_penetration(played);
  const double weight = 9.81 * played.mass();
  const Model model = played.model();
  const double friction = played.scene().objects[0].friction.static_;
  const auto pinch = [&](std::size_t k, int first) {
    return pinch_of_torus(played, model, k, first, 0.04);
  };
  // At rest in the air nothing but the fingers is there to carry it.
  struct Carried {
    int first;
    double begin, end;
  };
  for (const Carried& carried : {Carried{0, 3.9, 4.4}, Carried{2, 9.0, 10.0}}) {
    double off = 0.0;
    double aside = 0.0;
    double steepest = 0.0;
    for (std::size_t k = played.row(carried.begin); k < played.row(carried.end); ++k) {
      const Pinch hand = pinch(k, carried.first);
      off = std::max(off, std::abs(hand.sum.y() - weight) / weight);
      aside = std::max(aside, Vector3(hand.sum.x(), 0, hand.sum.z()).norm() / weight);
      steepest = std::max(steepest, hand.steepest);
      CHECK(played.force(k, 2 - carried.first).isZero(0.0));
      CHECK(played.force(k, 3 - carried.first).isZero(0.0));
    }
    INFO("weight off by " << off << ", aside " << aside << ", along the surface " << steepest);
    CHECK(off < 0.01);
    CHECK(aside < 0.01);
    CHECK(steepest < friction);
  }
  // Force passes from one hand to the other.
  const std::size_t both = played.row(5.5);
  CHECK(pinch(both, 0).least > 0.5);
  CHECK(pinch(both, 2).least > 0.5);
  double least = 1e3;  // of the hand that holds it better
  double unbalanced = 0.0;
  for (std::size_t k = played.row(1.2); k < played.rows(); ++k) {
    least = std::min(least, std::max(pinch(k, 0).least, pinch(k, 2).least));
    unbalanced = std::max(unbalanced, played.unbalanced(k).norm());
  }
  INFO("held by " << least << " N at least, forces off by " << unbalanced << " N");
  CHECK(least > 0.5);
  CHECK(unbalanced < 1e-9);
  // It is where the left hand is, and has gone the way of its tips.
  const std::size_t end = played.rows() - 1;
  const std::size_t taken = played.row(6.95);
  const Pinch at_end = pinch(end, 2);
  INFO("held " << at_end.held.transpose() << " m, tips " << at_end.tips.transpose() << " m");
  CHECK((at_end.held - at_end.tips).norm() < 2e-3);
  const Vector3 way = played.position(end) - played.position(taken);
  CHECK((way - (at_end.tips - pinch(taken, 2).tips)).norm() < 2e-3);
  CHECK(way.x() < -0.09);
  CHECK((played.position(end) - played.position(played.row(9.0))).norm() < 2e-4);
}
