#pragma once

#include <memory>
#include <vector>

#include "precompute/config.hpp"
#include "precompute/dynamics/sparse_solver.hpp"
#include "precompute/mesh/tet_mesh.hpp"
#include "precompute/modal/elastic_modes.hpp"
#include "precompute/parallel/ranks.hpp"

namespace irdm::precompute {

/// The lowest elastic modes, found by all ranks together: each assembles and keeps its rows of the
/// matrix and of the vectors. And a solver whose factors they share. Made and destroyed by all
/// ranks.
class SharedModes {
 public:
  virtual ~SharedModes() = default;
  /// Rank 0 only. So many of the lowest modes of the whole mesh, each eigenpair to 1e-10 of its
  /// eigenvalue; what lowest_modes() gives. Throws Error.
  virtual ElasticModes lowest(int count) = 0;
  /// Rank 0 only. A solver for any matrix that rank 0 has, for the thread that made this object,
  /// which must outlive it; one at a time.
  virtual std::unique_ptr<SparseSolver> solver() = 0;
  /// The other ranks: takes part in what rank 0 asks for until its object is gone. What fails on
  /// all ranks is told by rank 0.
  virtual void help() = 0;
};

/// SLEPc's Krylov-Schur with shift and invert, the rigid motions of a free body deflated. The
/// options of the environment variable PETSC_OPTIONS come last. On one rank the same input gives
/// the same bits; on several the last ones depend on which message comes first in MUMPS. Throws
/// Error, also where irdm was built without SLEPc (IRDM_WITH_SLEPC).
/// @param mass lumped (N) [kg]
/// @param clamped into the nodes, increasing; none: the body is free
/// @param solver not kSpectra
std::unique_ptr<SharedModes> make_shared_modes(const TetMesh& mesh, const Material& material,
                                               const Eigen::VectorXd& mass,
                                               const std::vector<int>& clamped, ModeSolver solver,
                                               const Ranks& ranks);

}  // namespace irdm::precompute
