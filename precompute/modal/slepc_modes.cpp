#include <algorithm>
#include <cmath>
#include <string>

#include "common/error.hpp"
#include "precompute/modal/lowest_modes.hpp"
#include "precompute/modal/shared_modes.hpp"
#include "precompute/modal/shared_stiffness.hpp"
#include "precompute/parallel/shared_factors.hpp"

namespace irdm::precompute {
namespace {

constexpr double kEigenTolerance = 1e-10;
constexpr double kSolveTolerance = 1e-12;
constexpr int kMostRounds = 1000;
constexpr int kMostIterations = 2000;

class SharedSolver final : public SparseSolver {
 public:
  explicit SharedSolver(SharedFactors& factors) : factors_(factors) {}
  void factorise(const Eigen::SparseMatrix<double>& matrix) override { factors_.factorise(matrix); }
  Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& right) const override {
    return factors_.solve(right);
  }

 private:
  SharedFactors& factors_;
};

class SlepcModes final : public SharedModes {
 public:
  SlepcModes(const TetMesh& mesh, const Material& material, const Eigen::VectorXd& mass,
             const std::vector<int>& clamped, ModeSolver solver, const Ranks& ranks)
      : ranks_(ranks),
        solver_(solver),
        stiffness_(mesh, material, mass, clamped, ranks),
        factors_(ranks) {}

  ~SlepcModes() override {
    if (ranks_.rank() == 0) ranks_.first_says(0);
  }

  ElasticModes lowest(int count) override {
    ranks_.first_says(count);
    return solve(count);
  }

  std::unique_ptr<SparseSolver> solver() override {
    return std::make_unique<SharedSolver>(factors_);
  }

  // A number above 0 asks for so many modes, one below for the factors' work.
  void help() override {
    while (const int number = ranks_.first_says(0)) {
      try {
        if (number > 0) {
          solve(number);
        } else {
          factors_.help(number);
        }
      } catch (const Error&) {  // rank 0 has it too
      }
    }
  }

 private:
  // A solver is made anew for each count: a used one forgets what is deflated.
  ElasticModes solve(int count) const {
    SlepcObject<EPS, EPSDestroy> eps;
    slepc(EPSCreate(PETSC_COMM_WORLD, eps.out()));
    slepc(EPSSetOperators(eps, stiffness_.matrix(), nullptr));
    slepc(EPSSetProblemType(eps, EPS_HEP));
    slepc(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
    slepc(EPSSetTarget(eps, 0.0));
    slepc(EPSSetTolerances(eps, kEigenTolerance, kMostRounds));
    const auto elastic = stiffness_.degrees_of_freedom() - (stiffness_.free() ? 6 : 0);
    const auto basis = std::min<Eigen::Index>(2 * count + 20, elastic);
    slepc(EPSSetDimensions(eps, count, static_cast<PetscInt>(basis), PETSC_DEFAULT));
    if (stiffness_.free()) slepc(EPSSetDeflationSpace(eps, 6, stiffness_.rigid().data()));
    choose_linear_solver(eps);
    slepc(EPSSetFromOptions(eps));
    slepc(EPSSolve(eps));
    return modes_of(eps, count);
  }

  // What solves with the matrix in every step.
  void choose_linear_solver(EPS eps) const {
    ST inverse = nullptr;
    KSP linear = nullptr;
    PC inner = nullptr;
    slepc(EPSGetST(eps, &inverse));
    slepc(STSetType(inverse, STSINVERT));
    slepc(STGetKSP(inverse, &linear));
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

  // Shapes on rank 0 only.
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
    if (ranks_.rank() == 0) modes.shapes.resize(stiffness_.degrees_of_freedom(), count);
    SlepcObject<Vec, VecDestroy> vector;
    slepc(MatCreateVecs(stiffness_.matrix(), vector.out(), nullptr));
    for (int k = 0; k < count; ++k) {
      PetscScalar value = 0.0;
      slepc(EPSGetEigenpair(eps, k, &value, nullptr, vector, nullptr));
      modes.angular_frequency(k) = std::sqrt(value - stiffness_.shift());
      const Eigen::VectorXd shape = stiffness_.displacement(vector);
      if (ranks_.rank() == 0) modes.shapes.col(k) = shape;
    }
    check_lowest(modes.angular_frequency, stiffness_.largest_square());
    return modes;
  }

  const Ranks& ranks_;
  ModeSolver solver_;
  SlepcSession session_;
  SharedStiffness stiffness_;
  SharedFactors factors_;
};

}  // namespace

std::unique_ptr<SharedModes> make_shared_modes(const TetMesh& mesh, const Material& material,
                                               const Eigen::VectorXd& mass,
                                               const std::vector<int>& clamped, ModeSolver solver,
                                               const Ranks& ranks) {
  return std::make_unique<SlepcModes>(mesh, material, mass, clamped, solver, ranks);
}

}  // namespace irdm::precompute
