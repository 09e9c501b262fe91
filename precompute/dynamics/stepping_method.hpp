#pragma once

#include <memory>
#include <string>

#include "precompute/columns/column_source.hpp"
#include "precompute/config.hpp"
#include "precompute/mesh/tet_mesh.hpp"
#include "precompute/progress.hpp"

/// Method "time-stepping": R by simulating the free-floating mesh, column by column.
namespace irdm::precompute {

/// Throws Error where time stepping cannot do what is asked: only floating bodies of linear
/// tetrahedra, and R in dense form.
/// @param name of the configuration file
void check_time_stepping(const std::string& name, const TetMesh& mesh, const Model& model,
                         bool dense_storage);

/// The columns, ready to be computed; says on the console how.
/// @param threads that will compute them
std::unique_ptr<ColumnSource> stepped_columns(const PrecomputeConfig& config, const TetMesh& mesh,
                                              const Model& model, int threads,
                                              const Console& console);

}  // namespace irdm::precompute
