#include "precompute/compress/pole_fit.hpp"

#include <algorithm>
#include <complex>
#include <vector>

#include "common/dense_algebra.hpp"

namespace irdm::precompute {
namespace {

constexpr Eigen::Index kLongestWindow = 128;
constexpr double kLargestPole = 0.9999;

using Complex = std::complex<double>;

// Windows of the sequence live in a space that the shift maps onto itself: its basis, most
// important direction first.
Eigen::MatrixXd window_space(const Eigen::VectorXd& y, Eigen::Index window) {
  const Eigen::Index count = y.size() - window + 1;
  Eigen::MatrixXd hankel(window, count);
  for (Eigen::Index i = 0; i < count; ++i) hankel.col(i) = y.segment(i, window);
  return symmetric_eigenpairs(Eigen::MatrixXd(hankel * hankel.transpose()))
      .vectors.rowwise()
      .reverse();
}

// One of each conjugate pair.
std::vector<Complex> poles_of(const Eigen::MatrixXd& space, Eigen::Index order) {
  const Eigen::MatrixXd upper = space.topLeftCorner(space.rows() - 1, order);
  const Eigen::MatrixXd lower = space.bottomLeftCorner(space.rows() - 1, order);
  const Eigen::MatrixXd shift = least_squares(upper, lower);
  const Eigen::VectorXcd values = eigenvalues(shift);
  std::vector<Complex> poles;
  for (Eigen::Index i = 0; i < order; ++i) {
    Complex pole = values(i);
    if (pole.imag() < 0.0) continue;
    if (std::abs(pole) > kLargestPole) pole *= kLargestPole / std::abs(pole);
    poles.push_back(pole);
  }
  return poles;
}

PoleFit fit_amplitudes(const Eigen::VectorXd& y, const std::vector<Complex>& poles) {
  Eigen::MatrixXd terms(y.size(), 0);
  std::vector<bool> has_imaginary;
  for (const Complex& pole : poles) {
    const bool complex = pole.imag() > 0.0;
    terms.conservativeResize(Eigen::NoChange, terms.cols() + (complex ? 2 : 1));
    Complex power = 1.0;
    for (Eigen::Index l = 0; l < y.size(); ++l, power *= pole) {
      terms(l, terms.cols() - (complex ? 2 : 1)) = power.real();
      if (complex) terms(l, terms.cols() - 1) = -power.imag();
    }
    has_imaginary.push_back(complex);
  }
  const Eigen::VectorXd weights = least_squares(terms, y);
  const auto count = static_cast<Eigen::Index>(poles.size());
  PoleFit fit{Eigen::VectorXcd(count), Eigen::VectorXcd(count), (y - terms * weights).norm()};
  Eigen::Index at = 0;
  for (Eigen::Index j = 0; j < count; ++j) {
    const auto index = static_cast<std::size_t>(j);
    fit.pole(j) = poles[index];
    fit.amplitude(j) = {weights(at), has_imaginary[index] ? weights(at + 1) : 0.0};
    at += has_imaginary[index] ? 2 : 1;
  }
  return fit;
}

}  // namespace

PoleFit fit_poles(const Eigen::VectorXd& y, double error) {
  PoleFit best{Eigen::VectorXcd(0), Eigen::VectorXcd(0), y.norm()};
  if (best.error <= error || y.size() < 4) return best;
  const Eigen::Index window = std::min(kLongestWindow, y.size() / 2);
  const Eigen::MatrixXd space = window_space(y, window);
  for (Eigen::Index pairs = 1; pairs <= kMostPolePairs && 2 * pairs < window; ++pairs) {
    const PoleFit fit = fit_amplitudes(y, poles_of(space, 2 * pairs));
    if (fit.error < best.error) best = fit;
    if (best.error <= error) break;
  }
  return best;
}

}  // namespace irdm::precompute
