#include "replay/report/axis.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace irdm::replay {
namespace {

constexpr double kTickRounding = 1e-9;

// 1, 2 or 5 times a power of ten, so that there are about five to eight of them in a range.
double round_step(double range) {
  const double power = std::pow(10.0, std::floor(std::log10(range / 5.0)));
  const double factor = range / 5.0 / power;
  return power * (factor < 2.0 ? 1.0 : factor < 5.0 ? 2.0 : 5.0);
}

std::vector<double> linear_ticks(double low, double high) {
  const double step = round_step(high - low);
  std::vector<double> ticks;
  const double first = std::ceil(low / step - kTickRounding);
  const double last = std::floor(high / step + kTickRounding);
  for (double k = first; k <= last; k += 1.0) ticks.push_back(k * step + 0.0);  // no -0
  return ticks;
}

std::vector<double> logarithmic_ticks(double low, double high) {
  const bool few = high / low < 1e3;
  std::vector<double> ticks;
  for (double power = std::floor(std::log10(low)); power <= std::log10(high); power += 1.0) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double tick = factor * std::pow(10.0, power);
      const bool within = tick >= low * (1 - kTickRounding) && tick <= high * (1 + kTickRounding);
      if (within && (few || factor == 1.0)) ticks.push_back(tick);
    }
  }
  return ticks;
}

}  // namespace

double Axis::place(double value) const {
  if (!logarithmic) return (value - low) / (high - low);
  return std::log(value / low) / std::log(high / low);
}

std::vector<double> Axis::ticks() const {
  return logarithmic ? logarithmic_ticks(low, high) : linear_ticks(low, high);
}

Axis axis_for(const std::vector<double>& values, bool logarithmic, double decades) {
  constexpr double kSpare = 0.05;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double value : values) {
    if (!std::isfinite(value) || (logarithmic && !(value > 0.0))) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (!(low <= high)) return {logarithmic ? 1.0 : 0.0, logarithmic ? 10.0 : 1.0, logarithmic};
  if (logarithmic) {
    low = std::max(low, high * std::pow(10.0, -decades));
    return {low / 1.2, high * 1.2, true};
  }
  if (low >= 0.0) low = 0.0;
  if (!(high > low)) return {low, low + 1.0, false};
  const double spare = kSpare * (high - low);
  return {low < 0.0 ? low - spare : low, high + spare, false};
}

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

}  // namespace irdm::replay
