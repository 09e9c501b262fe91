#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "common/model/model.hpp"
#include "precompute/config.hpp"
#include "precompute/dynamics/sparse_solver.hpp"
#include "precompute/mesh/tet_mesh.hpp"
#include "precompute/modal/elastic_modes.hpp"
#include "precompute/progress.hpp"

namespace irdm::precompute {

/// So many of the lowest elastic modes.
using LowestModes = std::function<ElasticModes(int count)>;

/// Where modes and static displacements come from, if not from this process alone.
struct SharedSolvers {
  LowestModes modes;                      ///< none: lowest_modes()
  std::unique_ptr<SparseSolver> statics;  ///< for one thread; null: make_sparse_solver()
};

/// The lowest modes of a mesh that may be too large for all of them, and what the others would add,
/// from sparse matrices. With how well they stand for all modes (ModeReduction). Shapes in double
/// precision. Throws Error, also when so much is asked for that all modes are the better way.
/// @param clamped into the mesh's nodes, increasing; none: the body is free
/// @param config not all()
/// @param threads > 0; the outcome does not depend on it
ModalResponse compute_reduced_modes(const TetMesh& mesh, const std::vector<int>& clamped,
                                    const Model& model, const ModesConfig& config, int threads,
                                    const Console& console, SharedSolvers shared = {});

}  // namespace irdm::precompute
