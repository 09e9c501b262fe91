#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "common/geometry.hpp"
#include "common/model/display_mesh.hpp"

namespace irdm {

/// Where an engine gets columns of R that are not all in memory. The columns of a surface node are
/// those of the forces on it, three of them: entry (a, 3 node + axis) of R[s] stands at
/// (axis * 3n + a) * T + s, in the numbers of R.
///
/// Several engines, each in its own thread, may share one. Real-time safe where a run in real time
/// asks.
class ColumnSupply {
 public:
  virtual ~ColumnSupply() = default;

  /// The columns of a node, which stay where they are until they are given back as often as they
  /// were taken. Null: they are not there, or not yet; whoever goes on asking gets them before
  /// others.
  virtual const void* acquire(int node) noexcept = 0;
  virtual void release(int node) noexcept = 0;
  /// Of how many nodes an engine may have the columns at a time.
  virtual int share() const noexcept = 0;
  /// Where tips are: what is near them is wanted next. Of one engine's thread only.
  /// @param tips [m], B
  virtual void prefetch(std::span<const Vector3> tips) noexcept = 0;
};

/// Matrix whose rows are contiguous, as HDF5 stores them.
template <typename Scalar>
using RowMatrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A column for each axis.
using AxisColumns = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

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

/// What each tetrahedron of a body is made of, where that is not the same everywhere. E elements.
struct ElementMaterials {
  std::vector<double> youngs_modulus{};  ///< (E) [Pa], > 0; none: the body is rigid
  std::vector<double> poisson_ratio{};   ///< (E), in (-1, 0.5); none: the body is rigid
  std::vector<double> density{};         ///< (E) [kg/m^3], > 0
  /// (E) number of the last [[region]] that the element lies in, from 1; 0: in none.
  std::vector<std::int32_t> region{};

  bool empty() const { return region.empty(); }
};

/// Linear isotropic elasticity with Rayleigh damping C = alpha M + beta K, alpha and beta the same
/// everywhere.
struct Material {
  double youngs_modulus = 0.0;  ///< E [Pa], > 0
  double poisson_ratio = 0.0;   ///< nu, in (-1, 0.5)
  double density = 0.0;         ///< rho [kg/m^3], > 0
  double rayleigh_alpha = 0.0;  ///< [1/s], >= 0
  double rayleigh_beta = 0.0;   ///< [s], >= 0
  /// Empty: E, nu and rho are those above everywhere. Else they are those of what is in no region.
  ElementMaterials elements{};
};

/// How well a part of the modes stands for all of them, found when they were computed. The errors
/// are those under a fingertip: of its force while it is pressed in within `press_time`, as a share
/// of the largest; and of the displacement of any surface node under a force that stays, as a share
/// of the largest displacement.
struct ModeReduction {
  int elastic_modes = 0;          ///< that the body has
  double cut_off = 0.0;           ///< where the modes end, see below [rad/s]
  double contact_radius = 0.0;    ///< of the fingertip [m]
  double residual_radius = 0.0;   ///< nodes nearer than this answer each other exactly [m]
  double press_time = 0.0;        ///< [s]
  double force_error = 0.0;       ///< largest of the samples
  double shape_error = 0.0;       ///< largest of the samples
  int samples = 0;                ///< places on the surface where the two were found
  double added_compliance = 0.0;  ///< on every diagonal, so that what is stored stays passive [m/N]
};

/// What modes that are left out would add, as a compliance without delay: the static flexibility
/// that the modes lack, K^+ - Phi diag(1 / omega^2) Phi^T, between surface nodes that are near each
/// other. It belongs to R[0] alone. Blocks of 3 x 3 by rows, symmetric as a whole, positive
/// semidefinite. With it goes that the modes end smoothly: their shapes are those of
/// mass-normalised modes times sqrt(c), c falling from 1 at half of `cut_off` to 0 there.
struct ResidualCompliance {
  std::vector<int>
      row_start;           ///< (n + 1): where each surface node's blocks begin; none: no residual
  std::vector<int> nodes;  ///< surface node of each block, increasing within a row
  std::vector<float> blocks;  ///< 9 a block, rows first: displacement per force on `nodes` [m/N]
  ModeReduction reduction;

  using Block = Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>;

  bool empty() const { return row_start.empty(); }
  /// The blocks of a surface node's row are those from begin_of() up to end_of().
  int begin_of(int node) const noexcept { return row_start[static_cast<std::size_t>(node)]; }
  int end_of(int node) const noexcept { return row_start[static_cast<std::size_t>(node) + 1]; }
  Block block(int k) const noexcept {
    return Block(blocks.data() + 9 * static_cast<std::size_t>(k));
  }
  /// The block of a node with itself [m/N].
  Matrix3 diagonal(int node) const;
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
  /// Of modes that are left out, added to R[0]; empty where all are there.
  ResidualCompliance residual{};
  /// g (r, 3): force of each mode of a fixed body per acceleration of all of it along each axis of
  /// B [kg^1/2]; no rows: the model has none.
  AxisColumns gravity{};
  /// What modes that are left out add to the displacement (3n, 3), per such an acceleration and
  /// without delay [s^2]; no rows: nothing.
  AxisColumns gravity_rest{};

  int mode_count() const { return static_cast<int>(angular_frequency.size()); }
};

/// What gravity does to a fixed body whose response is dense, by what happens after a uniform
/// acceleration of 1 m/s^2 along an axis p of B sets in and stays.
struct GravityResponse {
  /// Where it ends (3n, 3), as far as it was recorded [s^2]; no rows: the model has none.
  AxisColumns sag{};
  /// The displacement at time (s+1) dt less `sag`, numbers and order as in DenseResponse: entry (a,
  /// p) of step s stands at (p * dof + a) * steps + s [s^2]. The last step's are 0.
  std::variant<std::vector<float>, std::vector<double>> approach{};

  bool empty() const { return sag.rows() == 0; }
};

/// @param displacement with acceleration p from the start on, in that order and not yet less `sag`
template <typename Number>
GravityResponse gravity_response(std::vector<Number> displacement, int degrees_of_freedom,
                                 int steps);

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
  GravityResponse gravity{};
};

/// R of which only some columns are in memory at a time: what is always there, and where the
/// columns come from. b is the degree of freedom of the force, a that of the displacement.
struct StreamedResponse {
  int degrees_of_freedom = 0;  ///< 3n
  int steps = 0;               ///< T
  /// R[0](a, b) at b * dof + a, in the numbers of R.
  std::variant<std::vector<float>, std::vector<double>> first;
  /// sum_{s>=1} R[s](a, b) at b * dof + a: what a lasting force still adds after its first step
  /// [m/N].
  std::vector<float> rest;
  /// How that comes about without the column (T): settling_profile().
  std::vector<double> settling;
  std::variant<std::vector<float>, std::vector<double>> centrifugal{};  ///< as in DenseResponse
  std::vector<std::uint64_t> fingerprints{};  ///< of the columns as they are in the file (3n)
  std::shared_ptr<ColumnSupply> columns{};    ///< never null where there is an engine
  GravityResponse gravity{};
};

/// R made small (irdm-precompute compress): the first m steps as they are, and from then on r
/// shapes, each with a response of its own that decaying oscillations add up to,
///
///     R[s] = B diag(h_1[s] .. h_r[s]) B^T,   h_i[s] = Re sum_{poles j of shape i} a_j z_j^(s-m)
///
/// for s >= m. Both parts are symmetric: reciprocity holds to the bit.
struct CompressedResponse {
  int fir_steps = 0;  ///< m, >= 1
  /// R[s] for s < m, of pairs of surface nodes i >= j: entry ((i (i + 1) / 2 + j) * 9 + 3 a + b) *
  /// m + s is the displacement of i along a after 1 N on j along b [m/N].
  /// Of 16 bits: times the entry's scale, which is not there for single precision.
  std::variant<std::vector<float>, std::vector<std::int16_t>> fir;
  std::vector<float> fir_scale;  ///< m numbers each have one [m/N]
  RowMatrix<float> shapes;       ///< B (3n, r), columns of length 1
  std::vector<int> pole_shape;   ///< (p) to which shape a pole belongs, not decreasing
  Eigen::VectorXcd pole;         ///< z (p), |z| < 1, those of a pair once
  Eigen::VectorXcd amplitude;    ///< a (p) [m/N]

  int shape_count() const { return static_cast<int>(shapes.cols()); }
  int pole_count() const { return static_cast<int>(pole.size()); }
};

/// Of a body that does not deform: R is zero. Mass, inertia and surface are all that it has.
struct RigidResponse {};

/// What a model file holds.
struct Model {
  ModelMesh mesh;
  BodyProperties body;
  Material material;
  double dt = 0.0;  ///< response interval and force-loop period [s]
  int steps = 0;    ///< T, recorded steps
  DisplayMesh display{};
  std::variant<std::monostate, ModalResponse, DenseResponse, CompressedResponse, StreamedResponse,
               RigidResponse>
      response;  ///< the one that was asked for; RigidResponse of every rigid body

  int degrees_of_freedom() const { return 3 * mesh.surface_node_count(); }
};

/// Whether the body does not deform. Of its material only the density counts, the rest is 0.
bool is_rigid(const Model& model);

/// Whether the model's response says what the body's own spin does to it.
bool has_centrifugal(const Model& model);

/// Whether it says what gravity does to it: of fixed bodies only.
bool has_gravity(const Model& model);

}  // namespace irdm
