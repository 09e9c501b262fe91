#pragma once

#include "common/model/model.hpp"

namespace irdm::precompute {

/// G = 1/M - [at]x I_B^-1 [from]x: velocity of the point `at` (B) of the rigid body per impulse at
/// the point `from` [1/kg]; zero for a fixed body. A force of 1 N held during one step moves it by
/// dt^2 (s + 1/2) G until the end of step s.
Matrix3 rigid_mobility(const BodyProperties& body, const Vector3& at, const Vector3& from);

}  // namespace irdm::precompute
