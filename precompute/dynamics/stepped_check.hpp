#pragma once

#include <string>

#include "common/model/model.hpp"
#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// Throws Error where time stepping cannot do what is asked: only floating bodies of linear
/// tetrahedra, and R in dense form.
/// @param name of the configuration file
void check_time_stepping(const std::string& name, const TetMesh& mesh, const Model& model,
                         bool dense_storage);

}  // namespace irdm::precompute
