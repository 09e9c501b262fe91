#include "precompute/modal/residual_compliance.hpp"

#include <Spectra/SymEigsSolver.h>

#include <algorithm>
#include <exception>

#include "common/error.hpp"
#include "common/model/dense_file.hpp"
#include "precompute/blas.hpp"

namespace irdm::precompute {
namespace {

constexpr int kSolvedAtOnce = 16;
constexpr double kTolerance = 1e-5;  // of the vector; that of the eigenvalue is its square
constexpr double kMargin = 1e-7;

using Block = UpperBlocks::Block;
using Row = std::vector<std::pair<int, Block>>;  // of a node: those from itself on

Eigen::MatrixXd unit_loads(const ModelMesh& mesh, int first, int count) {
  Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(3 * mesh.nodes.rows(), 3 * count);
  for (int i = 0; i < count; ++i) {
    const int node = mesh.surface_nodes[static_cast<std::size_t>(first + i)];
    loads.block<3, 3>(3 * node, 3 * i).setIdentity();
  }
  return loads;
}

// Rows of the nodes first .. first+count-1.
void add_rows(const ElasticStatics& statics, const ModelMesh& mesh, const ModalResponse& modes,
              double radius, int first, int count, std::vector<Row>& rows) {
  const auto& shapes = std::get<RowMatrix<double>>(modes.shapes);
  const Eigen::MatrixXd all = statics.displacement(unit_loads(mesh, first, count));
  const Eigen::RowVectorXd settled = modes.angular_frequency.transpose().cwiseAbs2().cwiseInverse();
  for (int i = first; i < first + count; ++i) {
    const RowMatrix<double> weighted =
        shapes.middleRows<3>(3 * i).array().rowwise() * settled.array();
    const Vector3 place = mesh.rest_position(i);
    for (int j = i; j < mesh.surface_node_count(); ++j) {
      if (j != i && (mesh.rest_position(j) - place).norm() > radius) continue;
      const int node = mesh.surface_nodes[static_cast<std::size_t>(j)];
      Matrix3 block = all.block<3, 3>(3 * node, 3 * (i - first)).transpose();
      block.noalias() -= weighted * shapes.middleRows<3>(3 * j).transpose();
      if (j == i) block = 0.5 * (block + block.transpose()).eval();
      rows[static_cast<std::size_t>(i)].emplace_back(j, block.cast<float>());
    }
  }
}

UpperBlocks joined(const std::vector<Row>& rows) {
  UpperBlocks upper;
  for (const Row& row : rows) {
    for (const auto& [node, block] : row) {
      upper.nodes.push_back(node);
      upper.blocks.insert(upper.blocks.end(), block.data(), block.data() + 9);
    }
    upper.row_start.push_back(static_cast<std::int32_t>(upper.nodes.size()));
  }
  return upper;
}

void add_to_diagonal(UpperBlocks& upper, double added) {
  for (int i = 0; i < upper.rows(); ++i) {
    float* block = upper.blocks.data() +
                   9 * static_cast<std::size_t>(upper.row_start[static_cast<std::size_t>(i)]);
    if (Eigen::Map<Block>(block).isZero(0.0F)) continue;  // clamped
    Eigen::Map<Block>(block).diagonal().array() += static_cast<float>(added);
  }
}

// c Id - G, of which the largest eigenvalue is wanted.
class FromAbove {
 public:
  using Scalar = double;
  explicit FromAbove(const ResidualCompliance& g) : g_(g) {
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(rows());
    for_each_block([&](Eigen::Index row, Eigen::Index, const Matrix3& block) {
      sums.segment<3>(row) += block.cwiseAbs().rowwise().sum();
    });
    bound_ = sums.maxCoeff();
  }
  double bound() const { return bound_; }  ///< of every eigenvalue of G
  Eigen::Index rows() const { return 3 * (static_cast<Eigen::Index>(g_.row_start.size()) - 1); }
  Eigen::Index cols() const { return rows(); }
  void perform_op(const double* x, double* y) const {
    Eigen::Map<Eigen::VectorXd> result(y, rows());
    const Eigen::Map<const Eigen::VectorXd> given(x, rows());
    result = bound_ * given;
    for_each_block([&](Eigen::Index row, Eigen::Index column, const Matrix3& block) {
      result.segment<3>(row).noalias() -= block * given.segment<3>(column);
    });
  }

 private:
  template <typename Visit>
  void for_each_block(const Visit& visit) const {
    for (std::size_t i = 0; i + 1 < g_.row_start.size(); ++i) {
      for (int k = g_.row_start[i]; k < g_.row_start[i + 1]; ++k) {
        const auto place = static_cast<std::size_t>(k);
        visit(static_cast<Eigen::Index>(3 * i), 3 * g_.nodes[place],
              Eigen::Map<const Block>(g_.blocks.data() + 9 * place).cast<double>());
      }
    }
  }

  const ResidualCompliance& g_;
  double bound_ = 0.0;
};

}  // namespace

double residual_radius(const ModelMesh& mesh, double contact_radius) {
  double longest = 0.0;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      longest = std::max(longest, (mesh.rest_position(mesh.triangles(t, k)) -
                                   mesh.rest_position(mesh.triangles(t, (k + 1) % 3)))
                                      .norm());
    }
  }
  return (2.0 * contact_radius + longest) * (1.0 + 1e-9);
}

double needed_for_definiteness(const ResidualCompliance& compliance) {
  FromAbove op(compliance);
  const Eigen::Index basis = std::min<Eigen::Index>(60, op.rows());
  Spectra::SymEigsSolver<FromAbove> solver(op, 1, basis);
  solver.init();
  solver.compute(Spectra::SortRule::LargestAlge, 1000, kTolerance);
  if (solver.info() != Spectra::CompInfo::Successful) {
    throw Error("residual compliance", "its smallest eigenvalue is not found",
                "use another modes.contact_radius");
  }
  return std::max(0.0, (1.0 + kMargin) * solver.eigenvalues()(0) - op.bound());
}

ResidualCompliance residual_compliance(const ElasticStatics& statics, const ModelMesh& mesh,
                                       const ModalResponse& modes, double radius, int threads,
                                       const Console& console) {
  const int nodes = mesh.surface_node_count();
  std::vector<Row> rows(static_cast<std::size_t>(nodes));
  Progress progress(console, "residual compliance", nodes);
  const SingleThreadedBlas single;
  int done = 0;
  std::exception_ptr failure;  // an exception must not leave a parallel region
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (int first = 0; first < nodes; first += kSolvedAtOnce) {
    const int count = std::min(kSolvedAtOnce, nodes - first);
    std::exception_ptr mine;
    try {
      add_rows(statics, mesh, modes, radius, first, count, rows);
    } catch (...) {
      mine = std::current_exception();
    }
#pragma omp critical
    {
      if (mine) failure = mine;
      progress.update(done += count);
    }
  }
  if (failure) std::rethrow_exception(failure);
  UpperBlocks upper = joined(rows);
  rows.clear();
  const double added = needed_for_definiteness(both_halves(upper));
  add_to_diagonal(upper, added);
  ResidualCompliance residual = both_halves(upper);
  residual.reduction.residual_radius = radius;
  residual.reduction.added_compliance = added;
  return residual;
}

}  // namespace irdm::precompute
