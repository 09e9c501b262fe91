#include "trace/trace_check.hpp"

#include <cmath>

#include "common/error.hpp"

namespace irdm::trace {
namespace {

constexpr double kRounding = 1e-6;

}  // namespace

void TraceCheck::refuse(const std::string& set, std::size_t row, const std::string& what) const {
  throw Error(file_, set + " of step " + std::to_string(steps_[row]) + " " + what,
              "record it again");
}

void TraceCheck::number(const std::string& set, std::size_t row, double value,
                        const Range& range) const {
  if (range.contains(value)) return;
  refuse(set, row, "is " + number_text(value) + ", not " + describe(range));
}

void TraceCheck::numbers(const std::string& set, std::span<const double> values, std::size_t width,
                         const Range& range) const {
  for (std::size_t i = 0; i < values.size(); ++i) number(set, i / width, values[i], range);
}

void TraceCheck::orientations(const std::string& set, std::span<const double> values) const {
  for (std::size_t row = 0; 4 * row < values.size(); ++row) {
    double square = 0.0;
    for (const double part : values.subspan(4 * row, 4)) square += part * part;
    if (std::abs(square - 1.0) <= kRounding) continue;
    refuse(set, row, "is no quaternion of length 1");
  }
}

void TraceCheck::weights(const std::string& set, std::span<const double> values,
                         std::size_t row) const {
  double sum = 0.0;
  bool good = true;
  for (const double weight : values.subspan(3 * row, 3)) {
    good = good && between(-kRounding, 1.0 + kRounding).contains(weight);
    sum += weight;
  }
  if (!good || !(std::abs(sum - 1.0) <= kRounding)) refuse(set, row, "are no barycentric weights");
}

}  // namespace irdm::trace
