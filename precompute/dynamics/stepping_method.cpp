#include "precompute/dynamics/stepping_method.hpp"

#include <cstdio>

#include "common/error.hpp"
#include "precompute/dynamics/stepped_columns.hpp"

namespace irdm::precompute {

void check_time_stepping(const std::string& name, const TetMesh& mesh, const Model& model,
                         bool dense_storage) {
  if (!dense_storage) {
    throw Error(name, "method time-stepping gives R in dense form only",
                "set response.storage = \"dense\" (or --storage dense)");
  }
  if (mesh.tets.cols() != 4) {
    throw Error(name, "method time-stepping takes linear tetrahedra only",
                "set mesh.order = 1 or response.method = \"modal\"");
  }
  if (model.body.support != Support::kFloating) {
    throw Error(name, "method time-stepping takes floating bodies only",
                "set response.support = \"floating\" or response.method = \"modal\"");
  }
}

std::unique_ptr<ColumnSource> stepped_columns(const PrecomputeConfig& config, const TetMesh& mesh,
                                              const Model& model, int threads,
                                              const Console& console) {
  auto columns = std::make_unique<SteppedColumns>(mesh, model.material, config.time_stepping,
                                                  model.mesh.surface_nodes, model.dt, model.steps,
                                                  config.response.precision);
  char text[128];
  std::snprintf(text, sizeof text,
                "time stepping: %d steps a column, force %.3g N, %d threads, solver %s",
                columns->step_count(), columns->force(), threads, sparse_solver_name());
  console.line(text);
  return columns;
}

}  // namespace irdm::precompute
