#include "precompute/modal/driving_spectrum.hpp"

#include <cmath>
#include <numbers>

#include "common/dense_algebra.hpp"
#include "common/response/modal_response.hpp"

namespace irdm::precompute {
namespace {

constexpr double kFull = 0.25;  // of omega^2: up to here modes are whole

}  // namespace

double kept_share(double omega, double cut_off) {
  const double x = omega * omega / (cut_off * cut_off);
  if (x <= kFull) return 1.0;
  if (x >= 1.0) return 0.0;
  return 0.5 + 0.5 * std::cos(std::numbers::pi * (x - kFull) / (1.0 - kFull));
}

ModalResponse smoothly_cut(const ModalResponse& modes, int count) {
  const double cut_off = modes.angular_frequency(count);
  Eigen::VectorXd root(count);
  for (int i = 0; i < count; ++i) {
    root(i) = std::sqrt(kept_share(modes.angular_frequency(i), cut_off));
  }
  ModalResponse kept;
  kept.angular_frequency = modes.angular_frequency.head(count);
  kept.decay_rate = modes.decay_rate.head(count);
  kept.shapes = RowMatrix<double>(std::get<RowMatrix<double>>(modes.shapes).leftCols(count) *
                                  root.asDiagonal());
  if (modes.centrifugal.rows() > 0) {
    kept.centrifugal = root.asDiagonal() * modes.centrifugal.topRows(count);
  }
  if (modes.gravity.rows() > 0) kept.gravity = root.asDiagonal() * modes.gravity.topRows(count);
  kept.residual.reduction.cut_off = cut_off;
  return kept;
}

namespace {

constexpr double kNothing = 1e-13;  // of the first vector's image: the load has no more modes

// One load's Lanczos vectors and the tridiagonal matrix.
class Lanczos {
 public:
  Lanczos(const Eigen::VectorXd& start, int steps)
      : basis_(start.size(), steps), norm_(start.norm()) {
    basis_.col(0) = start / norm_;
  }
  bool done() const { return done_ || size() == basis_.cols(); }
  auto newest() const { return basis_.col(size()); }

  void add(Eigen::VectorXd image) {
    const Eigen::Index k = size();
    diagonal_.push_back(basis_.col(k).dot(image));
    const auto known = basis_.leftCols(k + 1);
    for (int twice = 0; twice < 2; ++twice) {
      const Eigen::VectorXd part = known.transpose() * image;
      image.noalias() -= known * part;
    }
    const double beta = image.norm();
    if (beta <= kNothing * diagonal_.front()) done_ = true;
    if (done()) return;
    off_diagonal_.push_back(beta);
    basis_.col(k + 1) = image / beta;
  }

  DrivingSpectrum spectrum() const {
    const auto m = static_cast<Eigen::Index>(diagonal_.size());
    const SymmetricEigen pairs =
        tridiagonal_eigenpairs(Eigen::Map<const Eigen::VectorXd>(diagonal_.data(), m),
                               Eigen::Map<const Eigen::VectorXd>(off_diagonal_.data(), m - 1));
    const Eigen::VectorXd& theta = pairs.values;
    Eigen::Index first = 0;  // rounding may leave one at zero or below
    while (first + 1 < m && theta(first) <= 1e-14 * theta(m - 1)) ++first;
    const Eigen::VectorXd weight = norm_ * norm_ * pairs.vectors.row(0).transpose().cwiseAbs2();
    return {theta.tail(m - first).reverse().cwiseInverse().cwiseSqrt(),
            weight.tail(m - first).reverse()};
  }

 private:
  Eigen::Index size() const { return static_cast<Eigen::Index>(diagonal_.size()); }

  Eigen::MatrixXd basis_;
  std::vector<double> diagonal_, off_diagonal_;
  double norm_;
  bool done_ = false;
};

}  // namespace

std::vector<DrivingSpectrum> driving_spectra(const ElasticStatics& statics,
                                             const Eigen::MatrixXd& loads, int steps) {
  Eigen::MatrixXd start = statics.root_mass().cwiseInverse().asDiagonal() * loads;
  statics.keep_elastic(start);
  std::vector<Lanczos> runs;
  for (Eigen::Index k = 0; k < loads.cols(); ++k) runs.emplace_back(start.col(k), steps);
  for (int step = 0; step < steps; ++step) {
    Eigen::MatrixXd vectors = Eigen::MatrixXd::Zero(start.rows(), start.cols());
    for (std::size_t k = 0; k < runs.size(); ++k) {
      if (!runs[k].done()) vectors.col(static_cast<Eigen::Index>(k)) = runs[k].newest();
    }
    const Eigen::MatrixXd images = statics.flexibility(vectors);
    for (std::size_t k = 0; k < runs.size(); ++k) {
      if (!runs[k].done()) runs[k].add(images.col(static_cast<Eigen::Index>(k)));
    }
  }
  std::vector<DrivingSpectrum> spectra;
  for (const Lanczos& run : runs) spectra.push_back(run.spectrum());
  return spectra;
}

Eigen::VectorXd driving_response(const DrivingSpectrum& spectrum, const Material& material,
                                 double dt, int steps) {
  Eigen::VectorXd response = Eigen::VectorXd::Zero(steps);
  for (Eigen::Index j = 0; j < spectrum.weight.size(); ++j) {
    const double omega = spectrum.angular_frequency(j);
    const double sigma = 0.5 * (material.rayleigh_alpha + material.rayleigh_beta * omega * omega);
    response +=
        spectrum.weight(j) * held_force_response(held_force_oscillator(omega, sigma, dt), steps);
  }
  return response;
}

}  // namespace irdm::precompute
