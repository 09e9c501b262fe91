#include "precompute/check/record_length.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace irdm::precompute {
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

}  // namespace irdm::precompute
