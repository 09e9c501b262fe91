#include "replay/measures/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace irdm::replay {

Vibration vibration_of(const Points& force, double dt, const perception::Hand& hand) {
  constexpr double kSegment = 0.5;
  Vibration found;
  found.spectrum = amplitude_spectrum(force, dt, kSegment, Hold::kLargest);
  for (std::size_t i = 0; i < found.spectrum.frequency.size(); ++i) {
    const double frequency = found.spectrum.frequency[i];
    double& amplitude = found.spectrum.amplitude[i];
    amplitude *= perception::hand_compliance(hand, frequency);
    if (frequency < perception::kLowestVibration) continue;
    const double level = amplitude / perception::vibration_threshold(frequency);
    if (level <= found.level) continue;
    found.level = level;
    found.frequency = frequency;
  }
  return found;
}

std::optional<bool> Vibration::noticeable() const {
  const bool judged =
      !spectrum.frequency.empty() && spectrum.frequency.back() >= perception::kLowestVibration;
  if (!judged) return {};
  return level > 1.0;
}

namespace {

constexpr Eigen::Index kFewestSamples = 8;

Eigen::VectorXd hann(Eigen::Index n) {
  const double step = 2.0 * std::numbers::pi / static_cast<double>(n);
  return 0.5 * (1.0 - (Eigen::ArrayXd::LinSpaced(n, 0.0, static_cast<double>(n - 1)) * step).cos());
}

// Squared amplitudes of the frequencies 1, 2, ..., n / 2 over the segment's length.
Eigen::VectorXd squared_amplitudes(const Points& segment, const Eigen::VectorXd& window,
                                   Eigen::FFT<double>& fft) {
  const Eigen::Index n = segment.rows();
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(n / 2);
  for (int axis = 0; axis < 3; ++axis) {
    const double mean = segment.col(axis).mean();
    const Eigen::VectorXd values = (segment.col(axis).array() - mean) * window.array();
    Eigen::VectorXcd transform;
    fft.fwd(transform, values);
    squares += transform.segment(1, n / 2).cwiseAbs2();
  }
  squares *= std::pow(2.0 / window.sum(), 2);
  if (n % 2 == 0) squares[n / 2 - 1] /= 4.0;  // half the rate: there is no second, conjugate part
  return squares;
}

// Where segments begin; the last one ends with the signal.
std::vector<Eigen::Index> segment_starts(Eigen::Index rows, Eigen::Index length) {
  std::vector<Eigen::Index> starts;
  for (Eigen::Index start = 0; start + length < rows; start += length / 2) starts.push_back(start);
  starts.push_back(rows - length);
  return starts;
}

}  // namespace

Spectrum amplitude_spectrum(const Points& signal, double dt, double segment, Hold hold) {
  if (signal.rows() < kFewestSamples) return {};
  const auto wanted = static_cast<Eigen::Index>(std::lround(segment / dt));
  const Eigen::Index n = std::clamp(wanted, kFewestSamples, signal.rows());
  const Eigen::VectorXd window = hann(n);
  const auto starts = segment_starts(signal.rows(), n);
  Eigen::FFT<double> fft;
  Eigen::VectorXd all = Eigen::VectorXd::Zero(n / 2);
  for (const Eigen::Index start : starts) {
    const Eigen::VectorXd squares = squared_amplitudes(signal.middleRows(start, n), window, fft);
    if (hold == Hold::kMean) {
      all += squares / static_cast<double>(starts.size());
    } else {
      all = all.cwiseMax(squares);
    }
  }
  Spectrum found;
  for (Eigen::Index k = 0; k < n / 2; ++k) {
    found.frequency.push_back(static_cast<double>(k + 1) / (static_cast<double>(n) * dt));
    found.amplitude.push_back(std::sqrt(all[k]));
  }
  return found;
}

}  // namespace irdm::replay
