#include "replay/measures/ringing.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "common/dense_algebra.hpp"
#include "replay/measures/perception.hpp"

namespace irdm::replay {
namespace {

constexpr double kQuiet = 0.05;
constexpr double kTogether = 0.25;

std::size_t nearest_to(double time, const std::vector<double>& onsets) {
  const auto best = std::min_element(onsets.begin(), onsets.end(), [&](double left, double right) {
    return std::abs(left - time) < std::abs(right - time);
  });
  return static_cast<std::size_t>(best - onsets.begin());
}

}  // namespace

std::optional<bool> OnsetDelays::noticeable(double interval) const {
  if (onsets.empty() || interval > perception::kOnsetDelay) return {};
  return largest > perception::kOnsetDelay;
}

std::vector<double> onsets_of(const Points& force, const std::vector<double>& times) {
  std::vector<double> onsets;
  double last = -std::numeric_limits<double>::infinity();  // time of the last force
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (force.row(static_cast<Eigen::Index>(k)).isZero(0.0)) continue;
    if (times[k] - last > kQuiet) onsets.push_back(times[k]);
    last = times[k];
  }
  return onsets;
}

OnsetDelays onset_delays(const std::vector<double>& a, const std::vector<double>& b) {
  OnsetDelays found;
  for (std::size_t i = 0; i < a.size() && !b.empty(); ++i) {
    const std::size_t j = nearest_to(a[i], b);
    if (nearest_to(b[j], a) != i || std::abs(b[j] - a[i]) > kTogether) continue;
    found.onsets.push_back(a[i]);
    found.delays.push_back(b[j] - a[i]);
    found.largest = std::max(found.largest, std::abs(b[j] - a[i]));
  }
  found.alone = a.size() + b.size() - 2 * found.onsets.size();
  return found;
}

namespace {

constexpr Eigen::Index kFewestRows = 24;
constexpr Eigen::Index kMostRows = 512;
constexpr Eigen::Index kMostPoles = 32;
constexpr std::size_t kMostKept = 8;
constexpr double kSmallestSingular = 1e-4;  // of the largest
constexpr double kSmallestAmplitude = 0.05;
constexpr double kLargestDamping = 0.7;
constexpr double kFewestPeriods = 2.0;

// Windows of `length` rows of all components, one a column.
Eigen::MatrixXd windows(const Points& signal, Eigen::Index length) {
  const Eigen::Index count = signal.rows() - length + 1;
  Eigen::MatrixXd all(length, 3 * count);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (Eigen::Index start = 0; start < count; ++start) {
      all.col(axis * count + start) = signal.col(axis).segment(start, length);
    }
  }
  return all;
}

// z of each term z^k that the signal is the sum of.
Eigen::VectorXcd poles(const Points& signal) {
  // Left singular vectors; singular values down to 1e-4 of the largest keep eight digits squared.
  const Eigen::MatrixXd all = windows(signal, signal.rows() / 3);
  const SymmetricEigen squared = symmetric_eigenpairs(all * all.transpose());
  const double largest = squared.values.reverse()(0);
  if (!(largest > 0.0)) return {};
  const Eigen::Index above =
      (squared.values.array() > kSmallestSingular * kSmallestSingular * largest).count();
  const Eigen::Index rank = std::min({above, kMostPoles, all.rows() - 1});
  const Eigen::MatrixXd U = squared.vectors.rightCols(rank);
  const Eigen::Index rows = U.rows() - 1;
  return eigenvalues(least_squares(U.topRows(rows), U.bottomRows(rows)));
}

// Of each pole, the size of its term in the first row, over components.
Eigen::VectorXd sizes_of(const Eigen::VectorXcd& z, const Points& signal) {
  Eigen::MatrixXcd powers(signal.rows(), z.size());
  powers.row(0).setOnes();
  for (Eigen::Index k = 1; k < signal.rows(); ++k) {
    powers.row(k) = powers.row(k - 1).cwiseProduct(z.transpose());
  }
  // The complex system as a real one of twice the size.
  const Eigen::Index m = powers.rows();
  const Eigen::Index n = powers.cols();
  Eigen::MatrixXd system(2 * m, 2 * n);
  system << powers.real(), -powers.imag(), powers.imag(), powers.real();
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(2 * m, signal.cols());
  values.topRows(m) = signal;
  return least_squares(system, values).reshaped(n, 2 * signal.cols()).rowwise().norm();
}

const Ringing& nearest(const std::vector<Ringing>& list, double frequency) {
  return *std::min_element(list.begin(), list.end(), [&](const Ringing& a, const Ringing& b) {
    return std::abs(a.frequency - frequency) < std::abs(b.frequency - frequency);
  });
}

}  // namespace

std::vector<Ringing> find_ringing(const Points& signal, double dt) {
  if (signal.rows() < kFewestRows || !signal.allFinite()) return {};
  const Points looked_at = signal.topRows(std::min(signal.rows(), kMostRows));
  const Eigen::VectorXcd z = poles(looked_at);
  if (z.size() == 0) return {};
  const Eigen::VectorXd sizes = sizes_of(z, looked_at);
  const double lowest = kFewestPeriods / (static_cast<double>(looked_at.rows()) * dt);
  std::vector<Ringing> found;
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const std::complex<double> s = std::log(z[i]) / dt;
    const double frequency = s.imag() / (2.0 * std::numbers::pi);
    const double damping = -s.real() / std::abs(s);
    if (!(frequency >= lowest) || !(damping > 0.0 && damping <= kLargestDamping)) continue;
    found.push_back({frequency, damping, 2.0 * sizes[i]});
  }
  std::sort(found.begin(), found.end(),
            [](const Ringing& a, const Ringing& b) { return a.amplitude > b.amplitude; });
  const double least = found.empty() ? 0.0 : kSmallestAmplitude * found.front().amplitude;
  std::erase_if(found, [&](const Ringing& each) { return each.amplitude < least; });
  if (found.size() > kMostKept) found.resize(kMostKept);
  std::sort(found.begin(), found.end(),
            [](const Ringing& a, const Ringing& b) { return a.frequency < b.frequency; });
  return found;
}

std::vector<RingingPair> pairs_of(const std::vector<Ringing>& a, const std::vector<Ringing>& b) {
  constexpr double kWithin = 0.15;
  std::vector<RingingPair> pairs;
  if (b.empty()) return pairs;
  for (const Ringing& each : a) {
    const Ringing& other = nearest(b, each.frequency);
    const bool mutual = &nearest(a, other.frequency) == &each;
    if (!mutual || std::abs(other.frequency - each.frequency) > kWithin * each.frequency) continue;
    pairs.push_back({each, other});
  }
  return pairs;
}

}  // namespace irdm::replay
