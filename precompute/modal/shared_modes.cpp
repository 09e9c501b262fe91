#include "precompute/modal/shared_modes.hpp"

#include "common/error.hpp"

namespace irdm::precompute {

#ifndef IRDM_WITH_SLEPC  // else in slepc_modes.cpp
std::unique_ptr<SharedModes> make_shared_modes(const TetMesh&, const Material&,
                                               const Eigen::VectorXd&, const std::vector<int>&,
                                               ModeSolver, const Ranks&) {
  throw Error("[modes]", "solver asks for SLEPc, and this irdm-precompute was built without it",
              "use solver = \"spectra\", or build with -DIRDM_WITH_MPI=ON -DIRDM_WITH_SLEPC=ON");
}
#endif

}  // namespace irdm::precompute
