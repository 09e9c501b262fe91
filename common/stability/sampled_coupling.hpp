#pragma once

#include "common/model/model.hpp"

namespace irdm {

/// Largest virtual coupling [N/m] that is stable at each of `count` surface nodes, evenly numbered,
/// for the loop that `irdm-precompute check` looks at by default: its hand, held forces, one step
/// of delay each way (largest_coupling()). Infinity: stable without one, rigid, or not known.
double sampled_coupling(const Model& model, int count);

}  // namespace irdm
