// Convergence of the finite elements on the cube of the paper: lowest elastic frequency of the free
// cube and compliance under a patch, for linear and quadratic tetrahedra on finer and finer meshes.
// Writes the table of docs/results.md; sparse solvers only, nothing in common with
// irdm-precompute but mesh, stiffness and mass.
//   bench_convergence [CELLS_OF_THE_REFERENCE]      14 unless given
#include <Eigen/SparseCholesky>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "precompute/fem/assembly.hpp"
#include "precompute/fem/rigid_motions.hpp"
#include "precompute/mesh/box_mesh.hpp"
#include "precompute/mesh/surface.hpp"
#include "precompute/mesh/tet_mesh.hpp"
#include "precompute/mesh/tetgen_program.hpp"

using namespace irdm;
using namespace irdm::precompute;

namespace {

const Material kMaterial{2000.0, 0.49, 110.0, 8.0, 2e-4};
constexpr double kEdge = 0.12;   // of the cube [m]
constexpr double kPatch = 0.02;  // radius of the round patch in the middle of the top [m]
// Added to the stiffness times the mass, so that it can be factorised: 1e-5 of the lowest
// eigenvalue.
constexpr double kShift = 0.03;

struct Cube {
  int order;
  int cells;
  int nodes = 0;
  int surface_nodes = 0;
  double frequency = 0.0;   // lowest elastic [Hz]
  double compliance = 0.0;  // under the patch [m/N]
};

// Shape functions of a triangle's nodes (corners, then middles of ab, bc, ca) at a point.
std::vector<double> shape_functions(int order, const Vector3& b) {
  if (order == 1) return {b(0), b(1), b(2)};
  return {b(0) * (2 * b(0) - 1), b(1) * (2 * b(1) - 1), b(2) * (2 * b(2) - 1),
          4 * b(0) * b(1),       4 * b(1) * b(2),       4 * b(2) * b(0)};
}

// The faces of the elements at the surface: three or six nodes each.
std::vector<std::vector<int>> element_faces(const TetMesh& mesh) {
  const Surface surface = extract_surface(mesh, "cube");
  const auto node = [&](Eigen::Index t, int i) {
    return surface.nodes[static_cast<std::size_t>(surface.triangles(t, i))];
  };
  std::vector<std::vector<int>> faces;
  if (mesh.order() == 1) {
    for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
      faces.push_back({node(t, 0), node(t, 1), node(t, 2)});
    }
    return faces;
  }
  for (Eigen::Index t = 0; t < surface.triangles.rows(); t += 4) {
    faces.push_back({node(t, 0), node(t + 1, 0), node(t + 2, 0), node(t + 3, 0), node(t + 3, 1),
                     node(t + 3, 2)});
  }
  return faces;
}

// Barycentric coordinates of the point above (x, y) in a face, seen along z.
Vector3 barycentric(const TetMesh& mesh, const std::vector<int>& face, double x, double y) {
  Matrix3 m;
  for (int i = 0; i < 3; ++i) {
    const Vector3 corner = mesh.position(face[static_cast<std::size_t>(i)]);
    m.col(i) = Vector3(corner.x(), corner.y(), 1.0);
  }
  return m.inverse() * Vector3(x, y, 1.0);
}

// 1 N downward, spread evenly over the patch: a grid of points, each given to the nodes of its face
// by their shape functions.
Eigen::VectorXd patch_force(const TetMesh& mesh) {
  std::vector<std::vector<int>> top;
  for (const auto& face : element_faces(mesh)) {
    const auto is_top = [&](int i) {
      return std::abs(mesh.nodes(face[static_cast<std::size_t>(i)], 2) - kEdge) < 1e-9;
    };
    if (is_top(0) && is_top(1) && is_top(2)) top.push_back(face);
  }
  constexpr int kPoints = 100;  // a side of the grid
  Eigen::VectorXd force = Eigen::VectorXd::Zero(3 * mesh.node_count());
  for (int k = 0; k < kPoints * kPoints; ++k) {
    const double dx = kPatch * ((k % kPoints + 0.5) / kPoints * 2.0 - 1.0);
    const double dy = kPatch * ((k / kPoints + 0.5) / kPoints * 2.0 - 1.0);
    if (std::hypot(dx, dy) > kPatch) continue;
    for (const auto& face : top) {
      const Vector3 b = barycentric(mesh, face, kEdge / 2 + dx, kEdge / 2 + dy);
      if (b.minCoeff() < -1e-9) continue;
      const std::vector<double> shapes = shape_functions(mesh.order(), b);
      for (std::size_t i = 0; i < shapes.size(); ++i) {
        force(3 * face[i] + 2) -= shapes[i];
      }
      break;
    }
  }
  return force / std::abs(force.sum());
}

class FreeBody {
 public:
  explicit FreeBody(const TetMesh& mesh) : stiffness_(assemble_stiffness(mesh, kMaterial)) {
    const Eigen::VectorXd mass = lumped_mass(mesh, kMaterial);
    mass_ = mass.replicate(1, 3).transpose().reshaped();
    rigid_ = rigid_motions(mesh.nodes, mass);
    SparseMatrix shifted = stiffness_;
    for (Eigen::Index i = 0; i < mass_.size(); ++i) shifted.coeffRef(i, i) += kShift * mass_(i);
    solver_.compute(shifted);
  }

  // Work of a unit force on the elastic displacement that it holds: the mean displacement under it,
  // rigid motion left out.
  double compliance(const Eigen::VectorXd& force) const {
    const Eigen::VectorXd balanced =
        force - mass_.asDiagonal() * (rigid_ * (rigid_.transpose() * force));
    const Eigen::VectorXd displacement = without_rigid(solver_.solve(balanced));
    return balanced.dot(displacement);
  }

  // By subspace iteration.
  double lowest_frequency() const {
    std::srand(1);
    Eigen::MatrixXd x = Eigen::MatrixXd::Random(mass_.size(), 12);
    double lowest = 0.0;
    for (int round = 0; round < 8; ++round) {
      x = without_rigid(solver_.solve(mass_.asDiagonal() * x));
      const Eigen::MatrixXd k = x.transpose() * (stiffness_ * x);
      const Eigen::MatrixXd m = x.transpose() * mass_.asDiagonal() * x;
      const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz(k, m);
      x = Eigen::MatrixXd(x * ritz.eigenvectors());
      lowest = ritz.eigenvalues()(0);
    }
    return std::sqrt(lowest) / (2.0 * std::numbers::pi);
  }

 private:
  Eigen::MatrixXd without_rigid(const Eigen::MatrixXd& u) const {
    return u - rigid_ * (rigid_.transpose() * (mass_.asDiagonal() * u));
  }

  SparseMatrix stiffness_;
  Eigen::VectorXd mass_;
  Eigen::MatrixXd rigid_;
  Eigen::SimplicialLDLT<SparseMatrix> solver_;
};

Cube measure(int order, int cells) {
  const TetMesh linear =
      tetrahedralise(box_surface(Vector3::Constant(kEdge), {cells, cells, cells}));
  const TetMesh mesh = order == 1 ? linear : quadratic_mesh(linear);
  Cube cube{order, cells};
  cube.nodes = mesh.node_count();
  cube.surface_nodes = static_cast<int>(extract_surface(mesh, "cube").nodes.size());
  const FreeBody body(mesh);
  cube.frequency = body.lowest_frequency();
  cube.compliance = body.compliance(patch_force(mesh));
  return cube;
}

void print_row(const Cube& c, const Cube& finest) {
  std::printf("| %d | %d | %d | %d | %.3f | %+.1f %% | %.5f | %+.1f %% |\n", c.order, c.cells,
              c.surface_nodes, c.nodes, c.frequency, 100.0 * (c.frequency / finest.frequency - 1.0),
              c.compliance, 100.0 * (c.compliance / finest.compliance - 1.0));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const int reference_cells = argc > 1 ? std::atoi(argv[1]) : 14;
  const Cube finest = measure(2, reference_cells);
  std::printf(
      "| order | cells an edge | surface nodes | nodes | lowest frequency, Hz | off | "
      "patch compliance, m/N | off |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const int cells : {6, 12, 18}) print_row(measure(1, cells), finest);
  for (const int cells : {3, 6, 9}) print_row(measure(2, cells), finest);
  print_row(finest, finest);
}
