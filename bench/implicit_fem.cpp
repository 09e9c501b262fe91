// Beside our force step what one would write instead: linear finite elements on the same mesh,
// stepped by the implicit midpoint rule with a matrix that CHOLMOD has factorised before. Cubes
// that stand on a plane, one point of the top held. The dense response of our step is made by that
// very rule, so that both have to give the same displacement under a force that stays; its columns
// are there for the nodes in contact only (bench/sparse_resident.hpp). The two are timed
// alternately.
//   bench_implicit_fem [PAIRS]      5 unless given
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "bench/held_step.hpp"
#include "bench/report.hpp"
#include "bench/sparse_resident.hpp"
#include "bench/statistics.hpp"
#include "precompute/blas.hpp"
#include "precompute/dynamics/sparse_solver.hpp"
#include "precompute/fem/assembly.hpp"
#include "precompute/mesh/box_mesh.hpp"
#include "precompute/mesh/tetgen_program.hpp"
#include "simulation/engine/response_engine.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;
using namespace irdm::precompute;

namespace {

constexpr int kSteps = 500;
constexpr double kDt = 0.002;
constexpr double kEdge = 0.12;
constexpr int kFemSteps = 100;
const Material kMaterial{2000.0, 0.49, 110.0, 8.0, 2e-4};

/// (2/h + alpha) M w + (h/2 + beta) K w = 2/h M v + f - K u, w the mean velocity of the step.
class ImplicitFem {
 public:
  explicit ImplicitFem(const TetMesh& mesh)
      : node_of_(static_cast<std::size_t>(mesh.node_count())) {
    int free = 0;
    for (int i = 0; i < mesh.node_count(); ++i) {
      node_of_[static_cast<std::size_t>(i)] = mesh.position(i).y() > 1e-9 ? free++ : -1;
    }
    const Eigen::VectorXd mass = lumped_mass(mesh, kMaterial);
    mass_.resize(3 * free);
    std::vector<Eigen::Triplet<double>> entries;
    const SparseMatrix all = assemble_stiffness(mesh, kMaterial);
    for (int column = 0; column < all.outerSize(); ++column) {
      for (SparseMatrix::InnerIterator entry(all, column); entry; ++entry) {
        const int i = unknown(static_cast<int>(entry.row()));
        const int j = unknown(column);
        if (i >= 0 && j >= 0) entries.emplace_back(i, j, entry.value());
      }
      if (unknown(column) >= 0) mass_(unknown(column)) = mass(column / 3);
    }
    K_.resize(3 * free, 3 * free);
    K_.setFromTriplets(entries.begin(), entries.end());
    SparseMatrix matrix = (kDt / 2 + kMaterial.rayleigh_beta) * K_;
    for (int i = 0; i < 3 * free; ++i) {
      matrix.coeffRef(i, i) += (2 / kDt + kMaterial.rayleigh_alpha) * mass_(i);
    }
    solver_ = make_sparse_solver();
    solver_->factorise(SparseMatrix(matrix.triangularView<Eigen::Lower>()));
    u_ = v_ = Eigen::VectorXd::Zero(3 * free);
  }

  int size() const { return static_cast<int>(mass_.size()); }
  /// Number of a degree of freedom of the mesh, -1 where it is clamped.
  int unknown(int dof) const {
    const int node = node_of_[static_cast<std::size_t>(dof / 3)];
    return node < 0 ? -1 : 3 * node + dof % 3;
  }

  void step(const Eigen::VectorXd& force) { step(u_, v_, force); }
  template <typename State>
  void step(State& u, State& v, const State& force) const {
    const State right = (2 / kDt) * (mass_.asDiagonal() * v) + force - K_ * u;
    const State w = solver_->solve(right);
    u += kDt * w;
    v = 2 * w - v;
  }
  const Eigen::VectorXd& displacement() const { return u_; }

 private:
  std::vector<int> node_of_;
  Eigen::VectorXd mass_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> K_;
  std::unique_ptr<SparseSolver> solver_;
  Eigen::VectorXd u_, v_;
};

/// The cube, its surface as the server knows it.
struct Cube {
  TetMesh mesh;
  Model model;
  std::vector<int> mesh_node;  ///< of each surface node
};

Cube make_cube(int cells) {
  Cube cube{tetrahedralise(box_surface(Vector3::Constant(kEdge), {cells, cells, cells})),
            test::synthetic_cube(cells, 1, kSteps),
            {}};
  cube.model.body.support = Support::kFixed;
  for (int i = 0; i < cube.model.mesh.surface_node_count(); ++i) {
    const Vector3 place = cube.model.mesh.rest_position(i) + Vector3::Constant(kEdge / 2);
    int nearest = 0;
    for (int j = 0; j < cube.mesh.node_count(); ++j) {
      if ((cube.mesh.position(j) - place).norm() < (cube.mesh.position(nearest) - place).norm()) {
        nearest = j;
      }
    }
    if ((cube.mesh.position(nearest) - place).norm() > 1e-9) {
      throw std::runtime_error("the meshes do not fit");
    }
    cube.mesh_node.push_back(nearest);
  }
  return cube;
}

/// Columns of R for these surface nodes: a force of 1 N during the first step.
DenseResponse response_of(const Cube& cube, const ImplicitFem& fem, const std::vector<int>& nodes) {
  const auto dof = static_cast<std::size_t>(cube.model.degrees_of_freedom());
  auto values = bench::sparse_numbers<float>(dof * dof * kSteps);
  const auto columns = static_cast<Eigen::Index>(3 * nodes.size());
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(fem.size(), columns);
  Eigen::MatrixXd v = u;
  Eigen::MatrixXd force = u;
  for (Eigen::Index c = 0; c < columns; ++c) {
    const int node =
        cube.mesh_node[static_cast<std::size_t>(nodes[static_cast<std::size_t>(c / 3)])];
    force(fem.unknown(3 * node + static_cast<int>(c % 3)), c) = 1.0;
  }
  for (std::size_t s = 0; s < kSteps; ++s) {
    fem.step(u, v, force);
    force.setZero();
    for (std::size_t a = 0; a < dof; ++a) {
      const int at = fem.unknown(3 * cube.mesh_node[a / 3] + static_cast<int>(a % 3));
      if (at < 0) continue;
      for (Eigen::Index c = 0; c < columns; ++c) {
        const std::size_t b = 3 * static_cast<std::size_t>(nodes[static_cast<std::size_t>(c / 3)]) +
                              static_cast<std::size_t>(c % 3);
        values.data()[(b * dof + a) * kSteps + s] = static_cast<float>(u(at, c));
      }
    }
  }
  return {static_cast<int>(dof), kSteps, std::move(values)};
}

/// By how much the two differ under a force that is held for T steps, as a share.
double difference(const Cube& cube, ImplicitFem& fem, const std::shared_ptr<const Model>& model,
                  const std::vector<int>& nodes) {
  const auto engine = make_engine(model);
  const Vector3 push(0.05, -0.1, 0.02);
  std::vector<NodalForce> forces;
  Eigen::VectorXd force = Eigen::VectorXd::Zero(fem.size());
  for (const int node : nodes) {
    forces.push_back({node, push});
    const int first = fem.unknown(3 * cube.mesh_node[static_cast<std::size_t>(node)]);
    force.segment<3>(first) = push;
  }
  for (int k = 0; k < kSteps; ++k) {
    engine->advance(forces);
    fem.step(force);
  }
  Points u;
  engine->displacement(u);
  double largest = 0.0;
  for (const int node : nodes) {
    const Vector3 theirs = fem.displacement().segment<3>(
        fem.unknown(3 * cube.mesh_node[static_cast<std::size_t>(node)]));
    const Vector3 ours = u.row(node).transpose();
    largest = std::max(largest, (ours - theirs).norm() / theirs.norm());
  }
  return largest;
}

/// Medians of a step [us].
struct FemTimes {
  double wall = INFINITY;  ///< with all threads or with one, whichever is faster
  double cpu = 0.0;        ///< processor time, one thread
};

FemTimes fem_times(ImplicitFem& fem) {
  const Eigen::VectorXd force = Eigen::VectorXd::Zero(fem.size());
  FemTimes best;
  for (const int threads : {2, 1}) {
    set_blas_threads(threads);
    std::vector<double> wall;
    std::vector<double> cpu;
    for (int k = 0; k < kFemSteps; ++k) {
      const bench::Elapsed time = bench::elapsed([&] { fem.step(force); });
      wall.push_back(1e6 * time.wall);
      cpu.push_back(1e6 * time.cpu);
    }
    best.wall = std::min(best.wall, bench::percentile(wall, 0.5));
    best.cpu = bench::percentile(cpu, 0.5);
  }
  set_blas_threads(0);
  return best;
}

void measure(bench::Report& report, int cells, int pairs) {
  Cube cube = make_cube(cells);
  ImplicitFem fem(cube.mesh);
  const std::vector<int> nodes = bench::held_nodes(cube.model, 1);
  cube.model.response = response_of(cube, fem, nodes);
  const double nodes_in_all = cube.mesh.node_count();
  const double surface_nodes = cube.model.mesh.surface_node_count();
  const auto model = std::make_shared<const Model>(std::move(cube.model));
  const double off = difference(cube, fem, model, nodes);
  std::vector<double> wall, cpu, ours, ratio, ratio_of_cpu;
  for (int i = 0; i < pairs; ++i) {
    const FemTimes theirs = fem_times(fem);
    wall.push_back(theirs.wall);
    cpu.push_back(theirs.cpu);
    ours.push_back(bench::held_steps(model, 1, 1000).median);
    ratio.push_back(theirs.wall / ours.back());
    ratio_of_cpu.push_back(theirs.cpu / ours.back());
  }
  const auto median = [](const std::vector<double>& values) {
    return bench::percentile(values, 0.5);
  };
  report.row({nodes_in_all, surface_nodes, median(wall), median(cpu), median(ours), median(ratio),
              median(ratio_of_cpu), off});
}

}  // namespace

int main(int argc, char** argv) {
  use_fast_blas_kernel(argv);
  const int pairs = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5;
  bench::Report report("implicit_fem");
  report.table(std::string("a step of implicit linear FEM (") + sparse_solver_name() +
                   ") beside our force step, dense",
               {"nodes", "surface nodes", "FEM step [us]",
                "the same, processor time of one thread [us]", "our step [us]", "times",
                "times, by processor time", "difference of the held displacement"});
  for (const int cells : {8, 12, 16, 22}) measure(report, cells, pairs);
}
