// The closed forms of hertz.hpp against the half-space under a pressure and under a traction along
// its surface, integrated numerically.
#include "tests/simulation/hertz.hpp"

#include <numbers>

#include "tests/support/catch.hpp"

using namespace irdm::test;

namespace {

using std::numbers::pi;

/// A load of peak sqrt(1 - r^2/radius^2), on the surface of a half-space.
struct EllipticalLoad {
  double peak;    // [Pa]
  double radius;  // [m]
};

// The integral of a load over a ray from (x, 0) at an angle to x: Simpson's rule, with a variable
// in which the root at the rim is smooth.
double along_ray(const EllipticalLoad& load, double x, double angle) {
  const double middle = -x * std::cos(angle);
  const double half2 = load.radius * load.radius - std::pow(x * std::sin(angle), 2);
  if (half2 <= 0) return 0.0;
  const double half = std::sqrt(half2);
  if (middle + half <= 0) return 0.0;
  const double begin = std::asin(std::max(-1.0, -middle / half));
  constexpr int kIntervals = 64;
  const double step = (0.5 * pi - begin) / kIntervals;
  double sum = 0.0;
  for (int i = 0; i <= kIntervals; ++i) {
    const double s = middle + half * std::sin(begin + i * step);
    const double r2 = x * x + 2 * x * s * std::cos(angle) + s * s;
    const double value =
        load.peak * std::sqrt(std::max(0.0, 1.0 - r2 / (load.radius * load.radius)));
    const double weight = i == 0 || i == kIntervals ? 1.0 : (i % 2 == 0 ? 2.0 : 4.0);
    sum += weight * value * half * std::cos(begin + i * step);
  }
  return sum * step / 3.0;
}

// What a point load does at a distance s is a function of the angle over s; in polar coordinates
// about the point that moves, the s goes.
template <typename Kernel>
double displaced(const EllipticalLoad& load, double x, const Kernel& kernel) {
  constexpr int kRays = 2000;
  double sum = 0.0;
  for (int i = 0; i < kRays; ++i) {
    const double angle = 2 * pi * (i + 0.5) / kRays;
    sum += kernel(angle) * along_ray(load, x, angle);
  }
  return sum * 2 * pi / kRays;
}

// Boussinesq: displacement into the half-space under a pressure [m].
double sunk(const HertzBody& body, const EllipticalLoad& pressure, double x) {
  const double nu = body.poisson_ratio;
  return (1 - nu * nu) / (pi * body.youngs_modulus) *
         displaced(pressure, x, [](double) { return 1.0; });
}

// Cerruti: displacement along x, under a traction along it, at a point of a line that leads from
// the middle at `turn` to x [m].
double dragged(const HertzBody& body, const EllipticalLoad& traction, double r, double turn) {
  const double nu = body.poisson_ratio;
  return displaced(
             traction, r,
             [&](double angle) { return 1 - nu + nu * std::pow(std::cos(angle + turn), 2); }) /
         (2 * pi * body.shear_modulus());
}

// The whole of a load, in rings [N].
template <typename Load>
double total(const Load& load, double radius) {
  constexpr int kRings = 100'000;
  double sum = 0.0;
  for (int i = 0; i < kRings; ++i) {
    const double r = radius * (i + 0.5) / kRings;
    sum += 2 * pi * r * load(r) * radius / kRings;
  }
  return sum;
}

const HertzBody kSoftSphere{2000.0, 0.49, 0.06};
const HertzBody kHardSphere{9000.0, 0.3, 0.15};
const HertzBody kHalfSpace{5000.0, 0.2};
const HertzBody kRigidSphere{.radius = 0.01};
constexpr double kApproach = 0.002;

}  // namespace

TEST_CASE("hertz: moduli and radius of pairs that are known") {
  const HertzPair equal = hertz_pair(kSoftSphere, kSoftSphere);
  CHECK(equal.modulus == Approx(0.5 * 2000.0 / (1 - 0.49 * 0.49)));
  CHECK(equal.radius == Approx(0.03));
  CHECK(equal.tangential_modulus == Approx(2 * (2000.0 / 2.98) / 1.51));
  const HertzPair rigid = hertz_pair(kRigidSphere, kHalfSpace);
  CHECK(rigid.modulus == Approx(5000.0 / (1 - 0.04)));
  CHECK(rigid.radius == Approx(0.01));
  const HertzPair unequal = hertz_pair(kSoftSphere, kHardSphere);
  CHECK(1 / unequal.modulus == Approx((1 - 0.49 * 0.49) / 2000.0 + (1 - 0.09) / 9000.0));
  CHECK(1 / unequal.radius == Approx(1 / 0.06 + 1 / 0.15));
  CHECK(unequal.modulus == hertz_pair(kHardSphere, kSoftSphere).modulus);
}

TEST_CASE("hertz: under the pressure both half-spaces fill the gap, and nowhere overlap") {
  const std::pair<HertzBody, HertzBody> bodies =
      GENERATE(values<std::pair<HertzBody, HertzBody>>({{kSoftSphere, kSoftSphere},
                                                        {kSoftSphere, kHardSphere},
                                                        {kSoftSphere, kHalfSpace},
                                                        {kRigidSphere, kHalfSpace}}));
  const HertzBody& first = bodies.first;
  const HertzBody& second = bodies.second;
  const HertzPair pair = hertz_pair(first, second);
  const double a = hertz_contact_radius(pair, kApproach);
  const EllipticalLoad pressure{hertz_pressure(pair, kApproach, 0.0), a};
  const auto gap = [&](double r) {
    return sunk(first, pressure, r) + sunk(second, pressure, r) + r * r / (2 * pair.radius) -
           kApproach;
  };
  for (const double share : {0.0, 0.2, 0.5, 0.8, 0.95}) {
    CHECK(std::abs(gap(share * a)) < 1e-7 * kApproach);
  }
  for (const double share : {1.1, 1.5, 3.0}) CHECK(gap(share * a) > 1e-3 * kApproach);
  const double force = total([&](double r) { return hertz_pressure(pair, kApproach, r); }, a);
  CHECK(hertz_force(pair, kApproach) == Approx(force).epsilon(1e-6));
  CHECK(hertz_approach(pair, force) == Approx(kApproach).epsilon(1e-6));
  CHECK(hertz_pressure(pair, kApproach, 1.01 * a) == 0.0);
}

TEST_CASE("hertz: a little more approach takes 2 a E* of force") {
  const HertzPair pair = hertz_pair(kSoftSphere, kHardSphere);
  constexpr double kStep = 1e-8;
  const double stiffness =
      (hertz_force(pair, kApproach + kStep) - hertz_force(pair, kApproach - kStep)) / (2 * kStep);
  CHECK(stiffness == Approx(2 * hertz_contact_radius(pair, kApproach) * pair.modulus));
}

TEST_CASE("mindlin: what sticks moves as one, by the displacement of the closed form") {
  const std::pair<HertzBody, HertzBody> bodies = GENERATE(values<std::pair<HertzBody, HertzBody>>(
      {{kSoftSphere, kSoftSphere}, {kHardSphere, kHardSphere}, {kSoftSphere, kHardSphere}}));
  const HertzBody& first = bodies.first;
  const HertzBody& second = bodies.second;
  const double share = GENERATE(0.05, 0.5, 0.9, 0.999);
  const MindlinContact contact{hertz_pair(first, second), kApproach, 0.4};
  const double pushed = share * contact.most_force();
  const double a = hertz_contact_radius(contact.pair, kApproach);
  const double c = contact.stick_radius(pushed);
  // Sliding friction on the whole contact, less the same on the circle that sticks.
  const double most = contact.friction * hertz_pressure(contact.pair, kApproach, 0.0);
  const EllipticalLoad sliding{most, a};
  const EllipticalLoad sticking{most * c / a, c};
  const auto traction = [&](double r) {
    return sliding.peak * std::sqrt(std::max(0.0, 1 - r * r / (a * a))) -
           sticking.peak * std::sqrt(std::max(0.0, 1 - r * r / (c * c)));
  };
  CHECK(total(traction, a) == Approx(pushed).epsilon(1e-6));
  const auto moved = [&](double r, double turn) {
    double sum = 0.0;
    for (const HertzBody& body : {first, second}) {
      sum += dragged(body, sliding, r, turn) - dragged(body, sticking, r, turn);
    }
    return sum;
  };
  const double expected = contact.displacement(pushed);
  for (const double turn : {0.0, 0.7, 0.5 * pi}) {
    CHECK(moved(0.0, turn) == Approx(expected).epsilon(1e-7));
    CHECK(moved(0.5 * c, turn) == Approx(expected).epsilon(1e-6));
    CHECK(moved(0.9 * c, turn) == Approx(expected).epsilon(1e-6));
    // What slips lags behind.
    CHECK(moved(c + 0.5 * (a - c), turn) < expected);
    CHECK(moved(a, turn) < expected);
  }
}

TEST_CASE("mindlin: it begins as if nothing slipped, and slips everywhere at mu F") {
  const MindlinContact contact{hertz_pair(kSoftSphere, kSoftSphere), kApproach, 0.4};
  const double a = hertz_contact_radius(contact.pair, kApproach);
  const double most = 0.4 * hertz_force(contact.pair, kApproach);
  CHECK(contact.most_force() == most);
  const double little = 1e-6 * most;
  CHECK(contact.displacement(little) ==
        Approx(little / (2 * a * contact.pair.tangential_modulus)).epsilon(1e-5));
  CHECK(contact.stick_radius(0.0) == a);
  CHECK(contact.stick_radius(most) == 0.0);
  CHECK(contact.displacement(most) == contact.most_displacement());
  CHECK(contact.most_displacement() ==
        Approx(3 * most * (2 - kSoftSphere.poisson_ratio) / (8 * a * kSoftSphere.shear_modulus())));
  for (const double share : {0.0, 0.1, 0.5, 0.9, 1.0}) {
    CHECK(contact.force(contact.displacement(share * most)) == Approx(share * most));
  }
  CHECK(contact.force(2 * contact.most_displacement()) == most);
}
