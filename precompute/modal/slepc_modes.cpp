#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "common/error.hpp"
#include "precompute/fem/rigid_motions.hpp"
#include "precompute/modal/lowest_modes.hpp"
#include "precompute/modal/shared_modes.hpp"
#include "precompute/parallel/bisection_order.hpp"
#include "precompute/parallel/slepc_session.hpp"

namespace irdm::precompute {
namespace {

constexpr double kEigenTolerance = 1e-10;
constexpr double kSolveTolerance = 1e-12;
constexpr int kMostRounds = 1000;
constexpr int kMostIterations = 2000;
// Of the square of a shear wave's frequency, half a wave long as the body.
constexpr double kShiftShare = 1e-3;

// What makes the matrix of a free body definite; far below its lowest omega^2 as a rule.
double shift_of(const Points& nodes, const Material& material) {
  const double extent = (nodes.colwise().maxCoeff() - nodes.colwise().minCoeff()).maxCoeff();
  const double wave_number = std::numbers::pi / extent;
  return kShiftShare * lame_parameters(material).mu / material.density * wave_number * wave_number;
}

// The mesh with its nodes in another order; no groups.
TetMesh renumbered(const TetMesh& mesh, const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
  }
  const auto placed = [&](int node) { return place[static_cast<std::size_t>(node)]; };
  return {mesh.nodes(order, Eigen::all), mesh.tets.unaryExpr(placed), {}};
}

Eigen::VectorXd root_of(const Eigen::VectorXd& mass) {
  return mass.replicate(1, 3).transpose().reshaped().cwiseSqrt();
}

// The nodes of a rank, in the order that they are shared out in.
struct Share {
  Share(Eigen::Index nodes, int rank, int ranks)
      : first(nodes * rank / ranks), last(nodes * (rank + 1) / ranks) {}
  int row() const { return static_cast<int>(3 * first); }
  int rows() const { return static_cast<int>(3 * (last - first)); }
  Eigen::Index first;
  Eigen::Index last;
};

// Eigenvalues of M^-1/2 K M^-1/2 + shift; of clamped rows and columns only the diagonal.
class SlepcModes final : public SharedModes {
 public:
  SlepcModes(const TetMesh& mesh, const Material& material, const Eigen::VectorXd& mass,
             const std::vector<int>& clamped, ModeSolver solver, const Ranks& ranks)
      : ranks_(ranks),
        order_(bisection_order(mesh.nodes)),
        clamped_(clamped),
        solver_(solver),
        root_mass_(root_of(mass)),
        share_(mesh.nodes.rows(), ranks.rank(), ranks.size()),
        shift_(clamped.empty() ? shift_of(mesh.nodes, material) : 0.0) {
    const TetMesh ordered = renumbered(mesh, order_);
    const Eigen::VectorXd ordered_mass = mass(order_);
    make_matrix(ordered, lame_parameters(material), root_of(ordered_mass));
    make_rigid(ordered.nodes, ordered_mass);
  }

  ~SlepcModes() override {
    if (ranks_.rank() == 0) ranks_.first_says(0);
  }

  ElasticModes lowest(int count) override {
    ranks_.first_says(count);
    return solve(count);
  }

  void help() override {
    while (const int count = ranks_.first_says(0)) {
      try {
        solve(count);
      } catch (const Error&) {
      }
    }
  }

 private:
  void make_matrix(const TetMesh& ordered, const Lame& lame, const Eigen::VectorXd& root_mass) {
    RowSparseMatrix rows = assemble_stiffness_rows(ordered, lame, static_cast<int>(share_.first),
                                                   static_cast<int>(share_.last));
    std::vector<bool> fixed(order_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) {
      fixed[i] = std::binary_search(clamped_.begin(), clamped_.end(), order_[i]);
    }
    for (int row = 0; row < rows.outerSize(); ++row) {
      const int global = share_.row() + row;
      for (RowSparseMatrix::InnerIterator entry(rows, row); entry; ++entry) {
        const auto column = static_cast<int>(entry.col());
        const bool diagonal = column == global;
        const bool free = !fixed[static_cast<std::size_t>(global / 3)] &&
                          !fixed[static_cast<std::size_t>(column / 3)];
        double& value = entry.valueRef();
        value = free || diagonal ? value / (root_mass(global) * root_mass(column)) : 0.0;
        if (!diagonal) continue;
        largest_square_ = std::max(largest_square_, value);
        value += shift_;
      }
    }
    rows.makeCompressed();
    const PetscInt own = share_.rows();
    slepc(MatCreate(PETSC_COMM_WORLD, matrix_.out()));
    slepc(MatSetSizes(matrix_, own, own, PETSC_DETERMINE, PETSC_DETERMINE));
    slepc(MatSetBlockSize(matrix_, 3));
    slepc(MatSetType(matrix_, MATAIJ));
    slepc(MatSeqAIJSetPreallocationCSR(matrix_, rows.outerIndexPtr(), rows.innerIndexPtr(),
                                       rows.valuePtr()));
    slepc(MatMPIAIJSetPreallocationCSR(matrix_, rows.outerIndexPtr(), rows.innerIndexPtr(),
                                       rows.valuePtr()));
    slepc(MatSetOption(matrix_, MAT_SPD, PETSC_TRUE));
    slepc(MatSetOption(matrix_, MAT_SPD_ETERNAL, PETSC_TRUE));
    MPI_Allreduce(MPI_IN_PLACE, &largest_square_, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
  }

  // Orthonormal in these coordinates: to be deflated, and what a coarser grid must be able to do.
  void make_rigid(const Points& nodes, const Eigen::VectorXd& mass) {
    const Eigen::MatrixXd motions = root_of(mass).asDiagonal() * rigid_motions(nodes, mass);
    for (int k = 0; k < 6; ++k) {
      slepc(MatCreateVecs(matrix_, rigid_[k].out(), nullptr));
      PetscScalar* values = nullptr;
      slepc(VecGetArrayWrite(rigid_[k], &values));
      Eigen::Map<Eigen::VectorXd>(values, share_.rows()) =
          motions.col(k).segment(share_.row(), share_.rows());
      slepc(VecRestoreArrayWrite(rigid_[k], &values));
    }
    std::array<Vec, 6> all = rigid();
    SlepcObject<MatNullSpace, MatNullSpaceDestroy> near;
    slepc(MatNullSpaceCreate(PETSC_COMM_WORLD, PETSC_FALSE, 6, all.data(), near.out()));
    slepc(MatSetNearNullSpace(matrix_, near));
  }

  std::array<Vec, 6> rigid() const {
    return {rigid_[0], rigid_[1], rigid_[2], rigid_[3], rigid_[4], rigid_[5]};
  }

  // What SLEPc asks in every step.
  void choose_linear_solver(EPS eps) const {
    ST transformation = nullptr;
    KSP linear = nullptr;
    PC inner = nullptr;
    slepc(EPSGetST(eps, &transformation));
    slepc(STSetType(transformation, STSINVERT));
    slepc(STGetKSP(transformation, &linear));
    slepc(KSPGetPC(linear, &inner));
    if (solver_ == ModeSolver::kSlepc) {
      slepc(KSPSetType(linear, KSPPREONLY));
      slepc(PCSetType(inner, PCCHOLESKY));
      slepc(PCFactorSetMatSolverType(inner, MATSOLVERMUMPS));
      return;
    }
    slepc(KSPSetType(linear, KSPCG));
    slepc(KSPSetTolerances(linear, kSolveTolerance, PETSC_DEFAULT, PETSC_DEFAULT, kMostIterations));
    slepc(PCSetType(inner, PCGAMG));
  }

  // On all ranks; only rank 0 gets the shapes.
  ElasticModes solve(int count) {
    SlepcObject<EPS, EPSDestroy> eps;
    slepc(EPSCreate(PETSC_COMM_WORLD, eps.out()));
    slepc(EPSSetOperators(eps, matrix_, nullptr));
    slepc(EPSSetProblemType(eps, EPS_HEP));
    slepc(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
    slepc(EPSSetTarget(eps, 0.0));
    slepc(EPSSetTolerances(eps, kEigenTolerance, kMostRounds));
    const auto elastic = root_mass_.size() - (clamped_.empty() ? 6 : 0);
    const auto basis = std::min<Eigen::Index>(2 * count + 20, elastic);
    slepc(EPSSetDimensions(eps, count, static_cast<PetscInt>(basis), PETSC_DEFAULT));
    choose_linear_solver(eps);
    if (clamped_.empty()) slepc(EPSSetDeflationSpace(eps, 6, rigid().data()));
    slepc(EPSSetFromOptions(eps));
    slepc(EPSSolve(eps));
    return modes_of(eps, count);
  }

  ElasticModes modes_of(EPS eps, int count) const {
    PetscInt found = 0;
    slepc(EPSGetConverged(eps, &found));
    if (found < count) {
      throw Error(
          "SLEPc",
          "only " + std::to_string(found) + " of " + std::to_string(count) + " modes converge",
          "ask for fewer modes, or check the mesh for extremely distorted elements");
    }
    ElasticModes modes{Eigen::VectorXd(count), {}};
    if (ranks_.rank() == 0) modes.shapes.resize(root_mass_.size(), count);
    SlepcObject<Vec, VecDestroy> vector;
    slepc(MatCreateVecs(matrix_, vector.out(), nullptr));
    for (int k = 0; k < count; ++k) {
      PetscScalar value = 0.0;
      slepc(EPSGetEigenpair(eps, k, &value, nullptr, vector, nullptr));
      modes.angular_frequency(k) = std::sqrt(value - shift_);
      const Eigen::VectorXd shape = gathered(vector);
      if (ranks_.rank() == 0) modes.shapes.col(k) = shape;
    }
    check_lowest(modes.angular_frequency, largest_square_);
    return modes;
  }

  // A vector's shape, in the mesh's own order of nodes, on rank 0; nothing on the others.
  Eigen::VectorXd gathered(Vec vector) const {
    std::vector<int> rows;
    std::vector<int> starts;
    const auto nodes = static_cast<Eigen::Index>(order_.size());
    for (int rank = 0; rank < ranks_.size(); ++rank) {
      const Share share(nodes, rank, ranks_.size());
      rows.push_back(share.rows());
      starts.push_back(share.row());
    }
    Eigen::VectorXd all(ranks_.rank() == 0 ? root_mass_.size() : 0);
    const PetscScalar* own = nullptr;
    slepc(VecGetArrayRead(vector, &own));
    MPI_Gatherv(own, share_.rows(), MPI_DOUBLE, all.data(), rows.data(), starts.data(), MPI_DOUBLE,
                0, PETSC_COMM_WORLD);
    slepc(VecRestoreArrayRead(vector, &own));
    if (all.size() == 0) return all;
    Eigen::VectorXd shape(all.size());
    for (Eigen::Index i = 0; i < nodes; ++i) {
      const Eigen::Index node = order_[static_cast<std::size_t>(i)];
      shape.segment<3>(3 * node) =
          all.segment<3>(3 * i).cwiseQuotient(root_mass_.segment<3>(3 * node));
    }
    for (const int node : clamped_) shape.segment<3>(3 * node).setZero();
    return shape;
  }

  const Ranks& ranks_;
  std::vector<int> order_;    // nodes of the mesh, in the order that they are shared out in
  std::vector<int> clamped_;  // nodes of the mesh
  ModeSolver solver_;
  Eigen::VectorXd root_mass_;  // in the mesh's order
  Share share_;
  double shift_;
  double largest_square_ = 0.0;
  SlepcSession session_;
  SlepcObject<Mat, MatDestroy> matrix_;
  std::array<SlepcObject<Vec, VecDestroy>, 6> rigid_;
};

}  // namespace

std::unique_ptr<SharedModes> make_shared_modes(const TetMesh& mesh, const Material& material,
                                               const Eigen::VectorXd& mass,
                                               const std::vector<int>& clamped, ModeSolver solver,
                                               const Ranks& ranks) {
  return std::make_unique<SlepcModes>(mesh, material, mass, clamped, solver, ranks);
}

}  // namespace irdm::precompute
