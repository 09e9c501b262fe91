#pragma once

#include <vector>

#include "common/geometry.hpp"
#include "common/model/model.hpp"

namespace irdm {

/// How far each surface node yields along a direction of its own to a force along it that lasts,
/// without rigid motion [m/N]: d^T (sum_s R_ii[s]) d. Of a dense response as far as it was
/// recorded.
/// @param directions unit vectors, one a surface node, B
std::vector<float> static_compliance(const Model& model, const std::vector<Vector3>& directions);

}  // namespace irdm
