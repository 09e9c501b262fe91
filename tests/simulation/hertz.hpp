#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

/// Contact of two elastic bodies with spherical surfaces in closed form, for approaches that are
/// small against the radii. Numbers in parentheses are equations of K. L. Johnson, Contact
/// Mechanics, Cambridge University Press 1985.
namespace irdm::test {

/// One of two bodies that touch.
struct HertzBody {
  double youngs_modulus = std::numeric_limits<double>::infinity();  ///< E [Pa]; infinite: rigid
  double poisson_ratio = 0.0;                                       ///< nu
  double radius = std::numeric_limits<double>::infinity();  ///< convex [m]; infinite: a half-space

  /// G = E / (2 (1 + nu)) [Pa].
  double shear_modulus() const { return 0.5 * youngs_modulus / (1.0 + poisson_ratio); }
};

/// What both bodies together are to their contact.
struct HertzPair {
  double modulus = 0.0;             ///< E* [Pa]; a small approach more takes 2 a E* of force
  double tangential_modulus = 0.0;  ///< G* [Pa]; a small way sideways takes 2 a G* of force
  double radius = 0.0;              ///< R [m]
};

/// 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2, 1/G* = (2 - nu1)/(4 G1) + (2 - nu2)/(4 G2),
/// 1/R = 1/R1 + 1/R2 (section 4.2; G* from (7.42)). Two equal spheres: E* = E/(2 (1 - nu^2)),
/// G* = 2 G/(2 - nu), R half of their radius.
inline HertzPair hertz_pair(const HertzBody& a, const HertzBody& b) {
  const auto normal = [](const HertzBody& body) {
    return (1.0 - body.poisson_ratio * body.poisson_ratio) / body.youngs_modulus;
  };
  const auto sideways = [](const HertzBody& body) {
    return (2.0 - body.poisson_ratio) / (4.0 * body.shear_modulus());
  };
  return {1.0 / (normal(a) + normal(b)), 1.0 / (sideways(a) + sideways(b)),
          1.0 / (1.0 / a.radius + 1.0 / b.radius)};
}

/// a = sqrt(R d) [m], the radius of the contact at an approach d [m] >= 0 (4.22, 4.23).
inline double hertz_contact_radius(const HertzPair& pair, double approach) {
  return std::sqrt(pair.radius * approach);
}

/// F = 4/3 E* sqrt(R) d^1.5 [N] (4.23).
inline double hertz_force(const HertzPair& pair, double approach) {
  return 4.0 / 3.0 * pair.modulus * approach * hertz_contact_radius(pair, approach);
}

/// The same the other way round: d [m] at a force [N] >= 0.
inline double hertz_approach(const HertzPair& pair, double force) {
  return std::pow(0.75 * force / (pair.modulus * std::sqrt(pair.radius)), 2.0 / 3.0);
}

/// p = p0 sqrt(1 - r^2/a^2) [Pa] at r [m] from the middle, p0 = 2 E* a / (pi R) = 3 F / (2 pi a^2)
/// (4.24); 0 outside of the contact.
inline double hertz_pressure(const HertzPair& pair, double approach, double r) {
  const double a = hertz_contact_radius(pair, approach);
  const double most = 2.0 * pair.modulus * a / (std::numbers::pi * pair.radius);
  return most * std::sqrt(std::max(0.0, 1.0 - (r / a) * (r / a)));
}

/// Two bodies of Hertz's contact, the approach held, then pushed sideways by a force T that only
/// grows: the contact sticks within a circle and slips outside of it, by Coulomb's law with one
/// coefficient (Cattaneo and Mindlin, section 7.2). Exact, up to the sideways motion that Poisson's
/// ratio adds, where pressure makes no difference sideways: for equal materials.
struct MindlinContact {
  HertzPair pair;
  double approach = 0.0;  ///< d [m], > 0
  double friction = 0.0;  ///< mu, > 0

  /// mu F [N]: from this force on it slips everywhere.
  double most_force() const { return friction * hertz_force(pair, approach); }

  /// Relative displacement of distant points [m] at which it begins to slip everywhere,
  /// 3 mu F / (4 a G*); two equal spheres: 3 mu F (2 - nu) / (8 a G).
  double most_displacement() const {
    return 0.75 * most_force() / (hertz_contact_radius(pair, approach) * pair.tangential_modulus);
  }

  /// 3 mu F / (4 a G*) (1 - (1 - T/(mu F))^(2/3)) [m] for 0 <= T <= mu F (7.42). Without slip it
  /// would be T / (2 a G*).
  double displacement(double force) const {
    const double left = std::max(0.0, 1.0 - force / most_force());
    return most_displacement() * (1.0 - std::cbrt(left * left));
  }

  /// The same the other way round: T [N] at a displacement [m] >= 0, mu F from
  /// most_displacement() on.
  double force(double displacement) const {
    const double left = std::max(0.0, 1.0 - displacement / most_displacement());
    return most_force() * (1.0 - left * std::sqrt(left));
  }

  /// c = a (1 - T/(mu F))^(1/3) [m], the radius of the circle that sticks.
  double stick_radius(double force) const {
    return hertz_contact_radius(pair, approach) *
           std::cbrt(std::max(0.0, 1.0 - force / most_force()));
  }
};

}  // namespace irdm::test
