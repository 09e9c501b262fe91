#include "precompute/modal/shared_stiffness.hpp"

#include <algorithm>
#include <numbers>

#include "precompute/fem/rigid_motions.hpp"
#include "precompute/parallel/bisection_order.hpp"

namespace irdm::precompute {
namespace {

// Of the square of a shear wave's frequency that is twice as long as the body.
constexpr double kShiftShare = 1e-3;

// Far below the lowest omega^2, but for the thinnest bodies; there it costs steps, no accuracy. Of
// several materials those that give the lowest shear wave speed.
double shift_of(const TetMesh& mesh, const Material& material) {
  const Points& nodes = mesh.nodes;
  const double extent = (nodes.colwise().maxCoeff() - nodes.colwise().minCoeff()).maxCoeff();
  const double wave_number = std::numbers::pi / extent;
  double softest = lame_parameters(material, 0).mu;
  double heaviest = density_of(material, 0);
  for (int e = 1; e < mesh.tet_count(); ++e) {
    softest = std::min(softest, lame_parameters(material, e).mu);
    heaviest = std::max(heaviest, density_of(material, e));
  }
  return kShiftShare * softest / heaviest * wave_number * wave_number;
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

// What a rank has of the nodes as they are shared out, and of the rows.
struct Share {
  Share(std::size_t nodes, int rank, int ranks)
      : first(static_cast<int>(static_cast<long>(nodes) * rank / ranks)),
        last(static_cast<int>(static_cast<long>(nodes) * (rank + 1) / ranks)) {}
  int row() const { return 3 * first; }
  int rows() const { return 3 * (last - first); }
  int first;
  int last;
};

}  // namespace

SharedStiffness::SharedStiffness(const TetMesh& mesh, const Material& material,
                                 const Eigen::VectorXd& mass, const std::vector<int>& clamped,
                                 const Ranks& ranks)
    : ranks_(ranks),
      order_(bisection_order(mesh.nodes)),
      clamped_(clamped),
      root_mass_(root_of(mass)),
      shift_(clamped.empty() ? shift_of(mesh, material) : 0.0) {
  const TetMesh ordered = renumbered(mesh, order_);
  const Eigen::VectorXd ordered_mass = mass(order_);
  make_matrix(own_rows(ordered, material, root_of(ordered_mass)));
  make_rigid(ordered, ordered_mass);
}

RowSparseMatrix SharedStiffness::own_rows(const TetMesh& ordered, const Material& material,
                                          const Eigen::VectorXd& root) {
  const Share own(order_.size(), ranks_.rank(), ranks_.size());
  RowSparseMatrix rows = assemble_stiffness_rows(ordered, material, own.first, own.last);
  const auto fixed = [this](Eigen::Index dof) {
    const int node = order_[static_cast<std::size_t>(dof / 3)];
    return std::binary_search(clamped_.begin(), clamped_.end(), node);
  };
  for (int i = 0; i < rows.outerSize(); ++i) {
    const Eigen::Index row = own.row() + i;
    for (RowSparseMatrix::InnerIterator entry(rows, i); entry; ++entry) {
      const Eigen::Index column = entry.col();
      entry.valueRef() /= root(row) * root(column);
      if (column == row) {
        largest_square_ = std::max(largest_square_, entry.value());
        entry.valueRef() += shift_;
      } else if (fixed(row) || fixed(column)) {
        entry.valueRef() = 0.0;
      }
    }
  }
  return rows;
}

void SharedStiffness::make_matrix(const RowSparseMatrix& rows) {
  const auto own = static_cast<PetscInt>(rows.rows());
  slepc(MatCreate(PETSC_COMM_WORLD, matrix_.out()));
  slepc(MatSetSizes(matrix_, own, own, PETSC_DETERMINE, PETSC_DETERMINE));
  slepc(MatSetBlockSize(matrix_, 3));
  slepc(MatSetType(matrix_, MATAIJ));
  // Of the next two the one that does not fit the number of ranks does nothing.
  slepc(MatSeqAIJSetPreallocationCSR(matrix_, rows.outerIndexPtr(), rows.innerIndexPtr(),
                                     rows.valuePtr()));
  slepc(MatMPIAIJSetPreallocationCSR(matrix_, rows.outerIndexPtr(), rows.innerIndexPtr(),
                                     rows.valuePtr()));
  slepc(MatSetOption(matrix_, MAT_SPD, PETSC_TRUE));
  slepc(MatSetOption(matrix_, MAT_SPD_ETERNAL, PETSC_TRUE));
  MPI_Allreduce(MPI_IN_PLACE, &largest_square_, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
}

// Multigrid wants to know them, too: a coarser grid has to be able to move so.
void SharedStiffness::make_rigid(const TetMesh& ordered, const Eigen::VectorXd& mass) {
  const Share own(order_.size(), ranks_.rank(), ranks_.size());
  const Eigen::MatrixXd motions = root_of(mass).asDiagonal() * rigid_motions(ordered.nodes, mass);
  for (int k = 0; k < 6; ++k) {
    auto& motion = rigid_[static_cast<std::size_t>(k)];
    slepc(MatCreateVecs(matrix_, motion.out(), nullptr));
    PetscScalar* values = nullptr;
    slepc(VecGetArrayWrite(motion, &values));
    Eigen::Map<Eigen::VectorXd>(values, own.rows()) = motions.col(k).segment(own.row(), own.rows());
    slepc(VecRestoreArrayWrite(motion, &values));
  }
  SlepcObject<MatNullSpace, MatNullSpaceDestroy> near;
  slepc(MatNullSpaceCreate(PETSC_COMM_WORLD, PETSC_FALSE, 6, rigid().data(), near.out()));
  slepc(MatSetNearNullSpace(matrix_, near));
}

std::array<Vec, 6> SharedStiffness::rigid() const {
  return {rigid_[0], rigid_[1], rigid_[2], rigid_[3], rigid_[4], rigid_[5]};
}

Eigen::VectorXd SharedStiffness::displacement(Vec vector) const {
  std::vector<int> rows;
  std::vector<int> starts;
  for (int rank = 0; rank < ranks_.size(); ++rank) {
    const Share share(order_.size(), rank, ranks_.size());
    rows.push_back(share.rows());
    starts.push_back(share.row());
  }
  Eigen::VectorXd all(ranks_.rank() == 0 ? root_mass_.size() : 0);
  const PetscScalar* own = nullptr;
  slepc(VecGetArrayRead(vector, &own));
  MPI_Gatherv(own, rows[static_cast<std::size_t>(ranks_.rank())], MPI_DOUBLE, all.data(),
              rows.data(), starts.data(), MPI_DOUBLE, 0, PETSC_COMM_WORLD);
  slepc(VecRestoreArrayRead(vector, &own));
  if (all.size() == 0) return all;
  Eigen::VectorXd u(all.size());
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const Eigen::Index at = 3 * static_cast<Eigen::Index>(order_[i]);
    u.segment<3>(at) =
        all.segment<3>(3 * static_cast<Eigen::Index>(i)).cwiseQuotient(root_mass_.segment<3>(at));
  }
  for (const int node : clamped_) u.segment<3>(3 * node).setZero();
  return u;
}

}  // namespace irdm::precompute
