#include "precompute/dynamics/stepped_check.hpp"

#include "common/error.hpp"

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

}  // namespace irdm::precompute
