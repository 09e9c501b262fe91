#pragma once

#include <Eigen/Dense>
#include <array>
#include <span>

#include "common/geometry.hpp"

namespace irdm {

/// Contacts that one step can solve together.
inline constexpr int kMaxContacts = 8;

/// Square matrix or vector over the contacts of one step: 3 rows a contact, no memory taken.
using ContactMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3 * kMaxContacts, 3 * kMaxContacts>;
using ContactVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3 * kMaxContacts, 1>;

/// How a contact may push on the object.
enum class ContactLaw {
  kHeld,      ///< in any direction
  kTouching,  ///< sticks to its point as long as it pushes; lets go rather than pull
};

/// The contact problem of one step: find forces on the object f [N] with W f = gap, every component
/// in one frame (B at the server).
struct ContactProblem {
  int count = 0;      ///< m contacts, 0..kMaxContacts
  ContactMatrix W;    ///< (3m, 3m) compliance within the step [m/N], symmetric positive definite
  ContactVector gap;  ///< (3m) p - r: from where each point would be to where the tip wants it [m]
  std::array<ContactLaw, kMaxContacts> law{};
  std::array<Vector3, kMaxContacts> normal{};  ///< outward unit normal of the surface
};

struct ContactSolution {
  ContactVector force;  ///< (3m) on the object [N]; zero where a contact let go
  std::array<bool, kMaxContacts> active{};
  double residual = 0.0;  ///< largest |W f - gap| over the active contacts [m]
  bool finite = true;     ///< false: the input was not solvable and all forces are zero
};

/// Solves all contacts together. Touching contacts that would have to pull let go one after the
/// other, the strongest pull first, so that at most m + 1 systems are solved. Real-time safe, no
/// exceptions.
ContactSolution solve_contacts(const ContactProblem& problem) noexcept;

}  // namespace irdm
