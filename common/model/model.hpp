#pragma once

#include <Eigen/Dense>
#include <string>
#include <variant>
#include <vector>

#include "common/geometry.hpp"

namespace irdm {

/// Matrix whose rows are contiguous, as HDF5 stores them.
template <typename Scalar>
using RowMatrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Geometry of the object at rest. N nodes, E elements, n surface nodes, t triangles.
struct ModelMesh {
  Points nodes;                    ///< (N, 3) [m], B
  RowMatrix<int> tets;             ///< (E, 4 or 10), into nodes
  std::vector<int> surface_nodes;  ///< (n), into nodes
  Triangles triangles;             ///< (t, 3), into surface_nodes, normals outward
  Eigen::VectorXd node_mass;       ///< (N) [kg]
  Vector3 com_offset =
      Vector3::Zero();  ///< centre of mass in the coordinates of the input mesh [m]

  int surface_node_count() const { return static_cast<int>(surface_nodes.size()); }
  /// Rest position of surface node i [m], B.
  Vector3 rest_position(int i) const {
    return nodes.row(surface_nodes[static_cast<std::size_t>(i)]).transpose();
  }
};

/// Whether the object floats freely or some of its nodes are clamped.
enum class Support { kFloating, kFixed };

/// The object as a rigid body.
struct BodyProperties {
  double mass = 0.0;                  ///< M [kg]
  Matrix3 inertia = Matrix3::Zero();  ///< I_B about the centre of mass [kg m^2], B
  Support support = Support::kFloating;
};

/// Linear isotropic elasticity with Rayleigh damping C = alpha M + beta K.
struct Material {
  double youngs_modulus = 0.0;  ///< E [Pa], > 0
  double poisson_ratio = 0.0;   ///< nu, in (-1, 0.5)
  double density = 0.0;         ///< rho [kg/m^3], > 0
  double rayleigh_alpha = 0.0;  ///< [1/s], >= 0
  double rayleigh_beta = 0.0;   ///< [s], >= 0
};

/// R in modal form, R[s] = Phi diag(h_i[s]) Phi^T: r elastic modes at the surface.
struct ModalResponse {
  Eigen::VectorXd angular_frequency;  ///< omega_i (r) [rad/s]
  Eigen::VectorXd decay_rate;         ///< sigma_i (r) [1/s]
  std::variant<RowMatrix<float>, RowMatrix<double>>
      shapes;  ///< Phi (3n, r), mass-normalised [kg^-1/2]
  /// g (r, 6): force of each mode per product of angular velocity components (see SpinProducts)
  /// [kg^1/2 m]; no rows: the model has none.
  RowMatrix<double> centrifugal{};

  int mode_count() const { return static_cast<int>(angular_frequency.size()); }
};

/// R itself. In memory the step s runs fastest, so that one convolution reads consecutive numbers:
/// entry (a, b) of R[s] stands at (b * dof + a) * steps + s. [m/N]
struct DenseResponse {
  int degrees_of_freedom = 0;  ///< 3n
  int steps = 0;               ///< T
  std::variant<std::vector<float>, std::vector<double>> values;
  /// Displacement after a product of angular velocity components held during one step (see
  /// SpinProducts), numbers and order as above: entry (a, p) of step s stands at
  /// (p * dof + a) * steps + s [m s^2]. Empty: the model has none.
  std::variant<std::vector<float>, std::vector<double>> centrifugal{};
};

/// R made small (irdm-precompute compress): the first m steps as they are, and from then on r
/// shapes, each with a response of its own that decaying oscillations add up to,
///
///     R[s] = B diag(h_1[s] .. h_r[s]) B^T,   h_i[s] = Re sum_{poles j of shape i} a_j z_j^(s-m)
///
/// for s >= m. Both parts are symmetric: reciprocity holds to the bit.
struct CompressedResponse {
  int early_steps = 0;  ///< m, >= 1
  /// R[s] for s < m, of pairs of surface nodes i >= j: entry ((i (i + 1) / 2 + j) * 9 + 3 a + b) *
  /// m + s is the displacement of i along a after 1 N on j along b [m/N].
  std::vector<float> early;
  RowMatrix<float> shapes;      ///< B (3n, r), columns of length 1
  std::vector<int> pole_shape;  ///< (p) to which shape a pole belongs, not decreasing
  Eigen::VectorXcd pole;        ///< z (p), |z| < 1, those of a pair once
  Eigen::VectorXcd amplitude;   ///< a (p) [m/N]

  int shape_count() const { return static_cast<int>(shapes.cols()); }
  int pole_count() const { return static_cast<int>(pole.size()); }
};

/// What a model file holds.
struct Model {
  ModelMesh mesh;
  BodyProperties body;
  Material material;
  double dt = 0.0;  ///< response interval and force-loop period [s]
  int steps = 0;    ///< T, recorded steps
  std::variant<std::monostate, ModalResponse, DenseResponse, CompressedResponse>
      response;  ///< the one that was asked for

  int degrees_of_freedom() const { return 3 * mesh.surface_node_count(); }
};

/// Whether the model's response says what the body's own spin does to it.
bool has_centrifugal(const Model& model);

}  // namespace irdm
