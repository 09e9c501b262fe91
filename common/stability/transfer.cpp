#include "common/stability/transfer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace irdm {
namespace {

constexpr double kSmallChange = 0.7;  // of a value, relative to it
constexpr int kMostHalvings = 20;

// Cubic through four points (Catmull and Rom); beyond an end the circle goes on with the conjugate.
Eigen::Matrix3cd interpolated(const MatrixHalfCircle& values, double j) {
  const int last = static_cast<int>(values.size()) - 1;
  const int below = std::min(static_cast<int>(j), last - 1);
  const double t = j - below;
  if (t == 0.0) return values[static_cast<std::size_t>(below)];
  if (t == 1.0) return values.back();
  const auto get = [&](int i) -> Eigen::Matrix3cd {
    if (i < 0) return values[static_cast<std::size_t>(-i)].conjugate();
    if (i > last) return values[static_cast<std::size_t>(2 * last - i)].conjugate();
    return values[static_cast<std::size_t>(i)];
  };
  return 0.5 *
         ((-t + 2 * t * t - t * t * t) * get(below - 1) +
          (2 - 5 * t * t + 3 * t * t * t) * get(below) +
          (t + 4 * t * t - 3 * t * t * t) * get(below + 1) + (-t * t + t * t * t) * get(below + 2));
}

struct Sample {
  double j;
  std::complex<double> value;
};

// Change of the argument [rad] from one point to another. The value in the middle decides whether
// they are close enough: the ends alone would not show two zeros between them, which turn it once
// round.
/// @param left values that may still be looked at
template <typename Function>
double turn(const Function& at, const Sample& from, const Sample& to, int halvings, int& left) {
  if (--left < 0) return 0.0;
  const double j = 0.5 * (from.j + to.j);
  const Sample middle{j, at(j)};
  const double size = std::min({std::abs(from.value), std::abs(middle.value), std::abs(to.value)});
  const double change =
      std::max(std::abs(middle.value - from.value), std::abs(to.value - middle.value));
  if (!(change >= kSmallChange * size) || halvings == 0) {  // or not a number
    return std::arg(to.value * std::conj(from.value));
  }
  return turn(at, from, middle, halvings - 1, left) + turn(at, middle, to, halvings - 1, left);
}

}  // namespace

std::complex<double> circle_point(double radius, int half, double j) {
  return std::polar(radius, -std::numbers::pi * j / half);
}

MatrixHalfCircle transform(const DrivingPoint& record, double radius, int half) {
  const auto size = static_cast<std::size_t>(2 * half);
  thread_local Eigen::FFT<double> fft(Eigen::FFT<double>::impl_type(),
                                      Eigen::FFT<double>::HalfSpectrum);
  Eigen::VectorXd powers(record.cols());
  double power = 1.0;
  for (Eigen::Index s = 0; s < powers.size(); ++s, power *= radius) powers(s) = power;
  MatrixHalfCircle values(static_cast<std::size_t>(half) + 1);
  std::vector<double> sequence(size);
  std::vector<std::complex<double>> spectrum(size);
  for (Eigen::Index entry = 0; entry < 9; ++entry) {
    std::fill(sequence.begin(), sequence.end(), 0.0);
    for (Eigen::Index s = 0; s < record.cols(); ++s) {
      sequence[static_cast<std::size_t>(s) % size] += record(entry, s) * powers(s);
    }
    fft.fwd(spectrum.data(), sequence.data(), 2 * half);
    for (std::size_t j = 0; j < values.size(); ++j) values[j](entry) = spectrum[j];
  }
  return values;
}

int resolving_half_circle(Eigen::Index length) {
  int half = 1024;
  while (half < length) half *= 2;
  return half;
}

ZeroCount count_zeros(const MatrixHalfCircle& response, double radius,
                      const std::function<std::complex<double>(const Eigen::Matrix3cd&,
                                                               std::complex<double>)>& value) {
  const int half = static_cast<int>(response.size()) - 1;
  const auto at = [&](double j) {
    return value(interpolated(response, j), circle_point(radius, half, j));
  };
  double sum = 0.0;
  int left = 2 * half + kMostTurns;
  std::complex<double> before = at(0.0);
  for (int j = 1; j <= half && left >= 0; ++j) {
    const std::complex<double> after = at(j);
    sum += turn(at, {j - 1.0, before}, {static_cast<double>(j), after}, kMostHalvings, left);
    before = after;
  }
  // The points go round clockwise; the other half turns by as much.
  return {static_cast<int>(std::lround(-sum / std::numbers::pi)), left >= 0};
}

namespace {

constexpr double kNegligible = 1e-6;
constexpr double kLongestRecord = 4096;

/// @param decay of the slowest part, its logarithm a step
RecordLength length_for(double decay) {
  const double decades = -std::log(kNegligible);
  const double needed = std::ceil(decades / decay);
  if (needed <= kLongestRecord) return {static_cast<int>(std::max(needed, 2.0)), 1.0};
  return {static_cast<int>(kLongestRecord),
          std::exp(-(decades - decay * kLongestRecord) / kLongestRecord)};
}

}  // namespace

RecordLength record_length(const ModalResponse& response, double dt) {
  double slowest = std::numeric_limits<double>::infinity();  // [1/s]
  for (int i = 0; i < response.mode_count(); ++i) {
    const double omega = response.angular_frequency(i);
    const double sigma = response.decay_rate(i);
    const double rate =
        sigma < omega ? sigma : omega * omega / (sigma + std::sqrt(sigma * sigma - omega * omega));
    slowest = std::min(slowest, rate);
  }
  return length_for(slowest * dt);
}

RecordLength record_length(const CompressedResponse& response) {
  const double largest = response.pole_count() == 0 ? 0.0 : response.pole.cwiseAbs().maxCoeff();
  RecordLength length = length_for(-std::log(std::max(largest, 1e-3)));
  length.steps = std::max(length.steps, response.fir_steps + 2);
  return length;
}

}  // namespace irdm
