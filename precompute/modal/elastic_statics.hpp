#pragma once

#include <Eigen/Dense>
#include <memory>
#include <vector>

#include "common/geometry.hpp"
#include "common/model/model.hpp"
#include "precompute/dynamics/sparse_solver.hpp"
#include "precompute/fem/assembly.hpp"
#include "precompute/modal/elastic_modes.hpp"

namespace irdm::precompute {

/// How much of R is left where it is cut off: over all surface degrees of freedom a, the largest
/// ratio of a bound of |R[s](a, a)| for all s >= T-1 to the peak of |R[s](a, a)| over s < T and
/// s < 4096. The
/// bound sums sqrt(q^2 + v^2 / omega^2) at step T-1 over the modes: the energy of a mode never
/// grows, so that its displacement never exceeds that later, whatever its phase is at T-1.
/// @param response with shapes in double precision
double decay_left(const ModalResponse& response, double dt, int steps);

/// The whole mesh under loads that stay, from one sparse Cholesky factorisation: what the modes of
/// large objects and all that they are compared with come from. N nodes.
///
/// A free body is held by six springs that balanced loads do not feel; loads are balanced by the
/// nodes' inertia, and the displacement carries no momentum. So K^+ has the six rigid motions in
/// its null space, and M^1/2 K^+ M^1/2 the eigenvalues 1 / omega^2 of the elastic modes.
class ElasticStatics {
 public:
  /// Throws Error when the stiffness is not positive definite where the body is held.
  /// @param stiffness (3N, 3N) [N/m]
  /// @param nodes (N, 3) [m]
  /// @param mass lumped (N) [kg]
  /// @param clamped into the nodes, increasing; none: the body is free
  /// @param solver of the factorisation
  ElasticStatics(SparseMatrix stiffness, const Points& nodes, const Eigen::VectorXd& mass,
                 const std::vector<int>& clamped,
                 std::unique_ptr<SparseSolver> solver = make_sparse_solver());

  Eigen::Index degrees_of_freedom() const { return root_mass_.size(); }  ///< 3N
  /// Elastic modes that there are: 3N - 6 of a free body, three less a clamped node of a fixed one.
  Eigen::Index elastic_modes() const { return elastic_modes_; }
  /// A scale of omega^2: the largest stiffness over mass of a degree of freedom [1/s^2].
  double largest_square() const { return largest_square_; }
  /// Square root of each degree of freedom's mass (3N) [kg^1/2].
  const Eigen::VectorXd& root_mass() const { return root_mass_; }

  /// K^+ f, (3N, k) [m]; clamped nodes stay at 0. Any number of threads,
  /// if that is so of the solver.
  /// @param force (3N, k) [N]
  Eigen::MatrixXd displacement(const Eigen::Ref<const Eigen::MatrixXd>& force) const;
  /// M^1/2 K^+ M^1/2 x, (3N, k): its eigenvalues are 1 / omega^2 [s^2].
  Eigen::MatrixXd flexibility(const Eigen::Ref<const Eigen::MatrixXd>& x) const;
  /// Takes rigid motion and clamped nodes out of columns in the coordinates M^1/2 u, (3N, k).
  void keep_elastic(Eigen::Ref<Eigen::MatrixXd> x) const;

 private:
  void clamp(SparseMatrix& stiffness) const;

  Eigen::VectorXd root_mass_;
  Eigen::MatrixXd rigid_;     // (3N, 6) orthonormal, coordinates M^1/2 u; none of a fixed body
  std::vector<int> clamped_;  // degrees of freedom
  Eigen::Index elastic_modes_;
  double largest_square_;
  std::unique_ptr<SparseSolver> solver_;
};

// What loads on the whole body do to its modes. They are found offline, because such a load acts
// on the nodes inside as well.

/// Of a floating body the centrifugal forces of its modes: a fixed one does not spin. Of a fixed
/// body the forces of gravity: no elastic mode of a floating one takes a uniform acceleration.
/// @param modes with their shapes at all nodes, those of `response`
void add_body_loads(const ElasticModes& modes, const Model& model, ModalResponse& response);

/// What some of the modes of a fixed body lack of its static displacement under gravity.
void add_gravity_rest(const ElasticStatics& statics, const Model& model, ModalResponse& response);

}  // namespace irdm::precompute
