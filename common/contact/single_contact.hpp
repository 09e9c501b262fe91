#pragma once

#include "common/contact/contact_problem.hpp"

namespace irdm {

/// The answer of one contact to a gap, all other forces being known.
struct SingleContact {
  Vector3 force = Vector3::Zero();  ///< on the object [N]
  ContactMode mode = ContactMode::kOpen;
  Vector3 slip = Vector3::Zero();  ///< sideways, what of the gap stays open [m]
};

/// Solves one contact exactly: with W its own compliance (3, 3) [m/N], symmetric positive definite,
/// and `gap` [m] what its own force has to close. Held: W f = gap. Touching: open when the gap
/// points outward; else sticking, if that force is inside the static cone; else slipping: the
/// normal part of the gap is closed, the force lies on the kinetic cone, and along the surface it
/// has the direction in which the point lags behind. Pure, real-time safe.
SingleContact solve_single_contact(const Matrix3& W, const Vector3& gap, ContactLaw law,
                                   const Vector3& normal, const Friction& friction) noexcept;

}  // namespace irdm
