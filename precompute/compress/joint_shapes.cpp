#include "precompute/compress/joint_shapes.hpp"

#include <lapacke.h>
#include <algorithm>
#include <cmath>
#include <random>

#include "common/dense_algebra.hpp"
#include "common/error.hpp"
#include "precompute/blas.hpp"

namespace irdm::precompute {
namespace {

constexpr int kMostRounds = 80;
constexpr double kStep = 0.6;  // of the way to the new shapes: all of it may swing
constexpr Eigen::Index kSettled = 32;

// Displacements of random forces: rows [l], columns [direction][force].
RowMatrix<double> random_answers(const Core& core, Eigen::Index forces) {
  const Eigen::Index r = core.rank();
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  RowMatrix<float> W(r, forces);
  std::generate_n(W.data(), W.size(), [&] { return normal(random); });
  RowMatrix<float> answers;
  product(core.matrices, Of::kItself, W, Of::kItself, answers);  // (K r, forces)
  const RowMatrix<double> by_time =
      Eigen::Map<const RowMatrix<float>>(answers.data(), core.times(), r * forces).cast<double>();
  RowMatrix<double> y;
  product(core.time, Of::kItself, by_time, Of::kItself, y);
  return y;
}

// Eigenvectors of a real matrix; of a complex pair the real and the imaginary part.
Eigen::MatrixXd eigenvectors(Eigen::MatrixXd matrix) {
  const auto n = static_cast<lapack_int>(matrix.rows());
  Eigen::MatrixXd vectors(n, n);
  Eigen::VectorXd real(n), imaginary(n);
  double length = 0.0;
  lapack_int info = 0;
  lapack_int query = -1;
  const lapack_int one = 1;
  LAPACK_dgeev("N", "V", &n, matrix.data(), &n, real.data(), imaginary.data(), nullptr, &one,
               vectors.data(), &n, &length, &query, &info);
  std::vector<double> work(static_cast<std::size_t>(length));
  query = static_cast<lapack_int>(work.size());
  LAPACK_dgeev("N", "V", &n, matrix.data(), &n, real.data(), imaginary.data(), nullptr, &one,
               vectors.data(), &n, work.data(), &query, &info);
  if (info != 0) {
    throw Error("eigensolver", "dgeev reports " + std::to_string(info), "check R for noise");
  }
  return vectors;
}

// The matrix A of y[l+1] = A y[l] - D y[l-1], in directions of equal weight.
Eigen::MatrixXd recursion(const Core& core) {
  const Eigen::Index r = core.rank();
  const Eigen::Index start = std::min(kSettled, core.time.rows() / 4);
  const Eigen::Index steps = core.time.rows() - start - 2;
  const Eigen::Index forces =
      std::clamp<Eigen::Index>(6 * r / std::max<Eigen::Index>(1, steps), 32, 64);
  const RowMatrix<double> y = random_answers(core, forces);
  RowMatrix<double> before(2 * r, steps * forces);
  RowMatrix<double> next(r, steps * forces);
  for (Eigen::Index l = 0; l < steps; ++l) {
    const auto at = [&](Eigen::Index step) {
      return core.weight.cwiseMax(1e-12).cwiseInverse().asDiagonal() *
             Eigen::Map<const RowMatrix<double>>(y.data() + (start + step) * y.cols(), r, forces);
    };
    before.block(0, l * forces, r, forces) = at(l + 1);
    before.block(r, l * forces, r, forces) = at(l);
    next.block(0, l * forces, r, forces) = at(l + 2);
  }
  RowMatrix<double> normal, right;
  product(before, Of::kItself, before, Of::kTransposed, normal);
  product(before, Of::kItself, next, Of::kTransposed, right);
  normal.diagonal().array() += 1e-10 * normal.trace() / static_cast<double>(2 * r);
  const Eigen::MatrixXd solution = solve_symmetric(normal, right);
  return solution.topRows(r).transpose();
}

RowMatrix<double> first_shapes(const Core& core) {
  const Eigen::MatrixXd B = core.weight.asDiagonal() * eigenvectors(recursion(core));
  return B.colwise().normalized();
}

RowMatrix<double> solve_from_right(const RowMatrix<double>& right, Eigen::MatrixXd matrix,
                                   double ridge) {
  matrix.diagonal().array() += ridge * matrix.trace() / static_cast<double>(matrix.rows());
  return solve_symmetric(matrix, right.transpose()).transpose();
}

class Improvement {
 public:
  explicit Improvement(const Core& core)
      : core_(core), energy_(core.matrices.cast<double>().squaredNorm()) {
    result_.shapes = first_shapes(core);
  }

  // Responses that fit the shapes best, and what is left then.
  void fit_responses() {
    const Eigen::Index r = core_.rank();
    const RowMatrix<float> B = result_.shapes.cast<float>();
    product(core_.matrices, Of::kItself, B, Of::kItself, turned_);
    product(result_.shapes, Of::kTransposed, result_.shapes, Of::kItself, products_);
    RowMatrix<double> along(core_.times(), r);
#pragma omp parallel for schedule(static)
    for (Eigen::Index k = 0; k < core_.times(); ++k) {
      along.row(k) =
          turned_.middleRows(k * r, r).cast<double>().cwiseProduct(result_.shapes).colwise().sum();
    }
    result_.responses = solve_from_right(along, products_.cwiseAbs2(), 1e-10);
    const double fitted = along.cwiseProduct(result_.responses).sum();
    result_.error = std::sqrt(std::max(0.0, 1.0 - fitted / energy_));
  }

  void improve_shapes() {
    const Eigen::Index r = core_.rank();
    const auto& h = result_.responses;
    RowMatrix<double> right = RowMatrix<double>::Zero(r, r);
#pragma omp parallel for schedule(static)
    for (Eigen::Index a = 0; a < r; ++a) {
      for (Eigen::Index k = 0; k < core_.times(); ++k) {
        right.row(a) += turned_.row(k * r + a).cast<double>().cwiseProduct(h.row(k));
      }
    }
    RowMatrix<double> squares;
    product(h, Of::kTransposed, h, Of::kItself, squares);
    RowMatrix<double> better = solve_from_right(right, products_.cwiseProduct(squares), 1e-9);
    for (Eigen::Index i = 0; i < r; ++i) {
      const double length = better.col(i).norm();
      if (!(length > 0.0)) continue;
      const double sign = better.col(i).dot(result_.shapes.col(i)) < 0.0 ? -1.0 : 1.0;
      const Eigen::VectorXd moved =
          result_.shapes.col(i) * (1.0 - kStep) + better.col(i) * (kStep * sign / length);
      result_.shapes.col(i) = moved.normalized();
    }
  }

  JointShapes& result() {
    return result_;
  }

 private:
  const Core& core_;
  double energy_;
  JointShapes result_;
  RowMatrix<float> turned_;     // (K r, r): M_k B
  RowMatrix<double> products_;  // B^T B
};

}  // namespace

JointShapes joint_shapes(const Core& core, double target, const Console& console) {
  Improvement improvement(core);
  improvement.fit_responses();
  JointShapes best = improvement.result();
  Progress progress(console, "shapes", kMostRounds);
  for (int round = 0; round < kMostRounds && best.error > target; ++round) {
    improvement.improve_shapes();
    improvement.fit_responses();
    if (improvement.result().error < best.error) best = improvement.result();
    progress.update(round + 1);
  }
  progress.update(kMostRounds);
  return best;
}

}  // namespace irdm::precompute
