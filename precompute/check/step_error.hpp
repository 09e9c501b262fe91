#pragma once

#include "common/model/model.hpp"

namespace irdm::precompute {

/// What the step costs in force where a node is led, by the held forces of the server's step:
/// (R_ii[0] + dt^2/2 G) f = x - r, without coupling. The node is pushed inward by a smooth 2 mm in
/// 50 ms and held for 0.25 s, so that the body bounces on it; the material's modes only, small
/// motions. All modes of the model are taken.
/// Returns the largest difference to steps of dt/16, averaged over the same times, as a share of
/// the peak force.
/// @param model with modes  @param stiffness factor on Young's modulus, > 0
double step_error(const Model& model, int node, double stiffness);

/// Factor on Young's modulus above which the error is larger than `bound`, from 1e-3 to 1e3 of the
/// model's, to 10 %.
double stiffness_for_error(const Model& model, int node, double bound);

}  // namespace irdm::precompute
