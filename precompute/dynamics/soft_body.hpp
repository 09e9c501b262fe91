#pragma once

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <vector>

#include "common/geometry.hpp"
#include "common/model/model.hpp"
#include "precompute/fem/material.hpp"
#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// kLinear: infinitesimal displacements and rotations. kCorotational: linear elasticity in a frame
/// that turns with each element, rotations of any size. kNeoHookean: rotations and strains of any
/// size, see neo_hookean.hpp.
enum class Elasticity { kLinear, kCorotational, kNeoHookean };

/// A field of the nodes (3N), index 3 node + axis, by nodes: (N, 3). Looks into `field`.
inline Eigen::Map<const Points> as_points(const Eigen::Ref<const Eigen::VectorXd>& field) {
  return {field.data(), field.size() / 3, 3};
}

/// Where the nodes are and how they move, both (3N), index 3 node + axis.
struct BodyState {
  Eigen::VectorXd u;  ///< displacement from rest [m], W
  Eigen::VectorXd v;  ///< velocity [m/s], W
};

/// The beginning of a time step, see SoftBody::mean_force().
struct StepStart {
  Eigen::VectorXd u;             ///< displacement (3N) [m], W
  std::vector<Matrix3> strains;  ///< S - Id at each point of a corotational SoftBody
};

/// A free-floating body of tetrahedra: masses, internal forces and energy. Const after
/// construction, for any number of threads. N nodes. Stresses are summed at points: one in a linear
/// element, where they are constant, four in a quadratic one.
///
/// Corotational: with F the deformation gradient at a point and R its polar rotation, the nodal
/// forces -R K0 (R^T x - X) are those of the stress P = R (2 mu (S - Id) + lambda tr(S - Id) Id),
/// S = R^T F, and for linear tetrahedra exactly the gradient of the energy
/// V (mu |S - Id|^2 + lambda/2 tr(S - Id)^2): they are conservative and free of resultant force and
/// torque (Etzmuss, Keckeisen, Strasser, A fast finite element solution for cloth modelling, 2003;
/// Mueller and Gross, Interactive virtual materials, 2004).
///
/// Damping: alpha resists the velocity less its rigid part (the momentum-free remainder), so that
/// free flight is not slowed. beta resists the rate of the stretch S, which is the usual
/// beta R K0 R^T v wherever the strain is small, and without torque where it is not.
class SoftBody {
 public:
  /// @param mesh tetrahedra of positive volume; moved so that the centre of mass is at 0
  SoftBody(const TetMesh& mesh, const Material& material, Elasticity elasticity);

  int node_count() const { return static_cast<int>(rest_.rows()); }
  const Points& rest() const { return rest_; }           ///< X (N, 3) [m]
  const Eigen::VectorXd& mass() const { return mass_; }  ///< (N) [kg]
  Elasticity elasticity() const { return elasticity_; }
  double rayleigh_alpha() const { return rayleigh_alpha_; }
  double rayleigh_beta() const { return rayleigh_beta_; }
  /// Volume of the rest shape [m^3].
  double volume() const;

  BodyState at_rest() const;
  /// Elastic plus damping force [N], (3N), W.
  Eigen::VectorXd internal_force(const BodyState& state) const;
  /// What mean_force() needs of the beginning of a step.
  StepStart start_of_step(const Eigen::VectorXd& u) const;
  /// Mean internal force [N] over a step of length h [s] with mean velocity w, (3N), W. Its work
  /// h w^T f is the loss of elastic energy, to rounding, less what damping takes; it has neither
  /// resultant nor torque about the middle of the step. See mean_stress() of the materials.
  Eigen::VectorXd mean_force(const StepStart& start, const Eigen::VectorXd& w, double h) const;
  double elastic_energy(const Eigen::VectorXd& u) const;   ///< [J]
  double kinetic_energy(const Eigen::VectorXd& v) const;   ///< [J]
  Vector3 momentum(const Eigen::VectorXd& v) const;        ///< [kg m/s]
  Vector3 angular_momentum(const BodyState& state) const;  ///< about the origin of W [kg m^2/s]

  /// Warped stiffness sum_e R_e K0_e R_e^T [N/m], (3N, 3N): the Jacobian of the elastic force but
  /// for the turning of the R_e, which vanishes with the strain. Symmetric, positive semidefinite,
  /// always of the same pattern. Of a neo-Hookean body the whole Jacobian, of the same pattern.
  Eigen::SparseMatrix<double> stiffness(const Eigen::VectorXd& u) const;
  /// Rigid velocity with the momentum and angular momentum of the given velocities, per node (3N);
  /// of the linear body about its rest shape.
  Eigen::VectorXd rigid_velocity(const Eigen::VectorXd& u, const Eigen::VectorXd& v) const;

 private:
  /// Where stress is looked at, the part of the body that it stands for, and how displacements of
  /// the element's nodes strain it.
  struct Point {
    Eigen::Index element;
    Lame lame;
    double volume;                                                  ///< [m^3]
    Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 10, 3> gradient{};  ///< of shape functions [1/m]
  };
  void add_element(const TetMesh& mesh, Eigen::Index element, const Lame& lame);
  Matrix3 gradient(const Point& point, const Eigen::VectorXd& field) const;
  Matrix3 stress(const Point& point, const BodyState& state) const;
  void add_force(const Point& point, const Matrix3& P, Eigen::VectorXd& force) const;
  void add_mass_damping(const BodyState& state, Eigen::VectorXd& force) const;

  Elasticity elasticity_;
  double rayleigh_alpha_;
  double rayleigh_beta_;
  Points rest_;
  Eigen::VectorXd mass_;
  RowMatrix<int> tets_;
  std::vector<Point> points_;
};

}  // namespace irdm::precompute
