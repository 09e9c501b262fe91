#include "replay/report/comparison_charts.hpp"

namespace irdm::replay {
namespace {

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

Chart over_time(const std::string& y_label) {
  return {"time (s)", y_label, false, false, {}};
}

// From the lowest frequency that the Pacinian channel is judged at, less an octave.
Spectrum audible(Spectrum spectrum) {
  std::size_t first = 0;
  while (first < spectrum.frequency.size() &&
         spectrum.frequency[first] < 0.5 * perception::kLowestVibration) {
    ++first;
  }
  const auto skipped = static_cast<std::ptrdiff_t>(first);
  spectrum.frequency.erase(spectrum.frequency.begin(), spectrum.frequency.begin() + skipped);
  spectrum.amplitude.erase(spectrum.amplitude.begin(), spectrum.amplitude.begin() + skipped);
  return spectrum;
}

void add(Chart& chart, const std::string& name, Stroke stroke, const Spectrum& spectrum,
         double factor) {
  chart.curves.push_back({name, stroke, spectrum.frequency, scaled(spectrum.amplitude, factor)});
}

}  // namespace

Chart difference_chart(const Apart& apart, const std::vector<double>& times,
                       const std::string& y_label, double factor) {
  Chart chart = over_time(y_label);
  chart.curves = {{"root mean square", Stroke::kDifference, times, scaled(apart.rms, factor)},
                  {"largest", Stroke::kLimit, times, scaled(apart.largest, factor)}};
  return chart;
}

Chart drift_chart(const Apart& apart, const std::vector<double>& times, const std::string& y_label,
                  double factor) {
  Chart chart = over_time(y_label);
  chart.curves = {{"B from A", Stroke::kDifference, times, scaled(apart.largest, factor)}};
  return chart;
}

Chart size_chart(const SignalPair& pair, const std::vector<double>& times,
                 const std::string& y_label, double factor) {
  Chart chart = over_time(y_label);
  chart.curves = {{"A", Stroke::kA, times, scaled(pair.size_a, factor)},
                  {"B", Stroke::kB, times, scaled(pair.size_b, factor)}};
  return chart;
}

Chart spectrum_chart(const SignalPair& pair, const std::string& y_label, double factor) {
  Chart chart{"frequency (Hz)", y_label, true, true, {}};
  add(chart, "A", Stroke::kA, pair.spectrum_a, factor);
  add(chart, "B", Stroke::kB, pair.spectrum_b, factor);
  return chart;
}

Chart force_share_chart(const ForceDifference& force, const std::vector<double>& times) {
  constexpr double kPercent = 100.0;
  Chart chart = over_time("difference (% of A)");
  const double limit = kPercent * perception::kForceShare;
  chart.curves = {
      {"force of B less A", Stroke::kDifference, times, scaled(force.share, kPercent)},
      {"noticed from here on", Stroke::kLimit, {times.front(), times.back()}, {limit, limit}}};
  return chart;
}

Chart vibration_chart(const StylusMeasures& stylus) {
  constexpr double kMicrometres = 1e6;
  Chart chart{"frequency (Hz)", "motion of the hand (\xC2\xB5m)", true, true, {}};
  add(chart, "A", Stroke::kA, audible(stylus.vibration_a.spectrum), kMicrometres);
  add(chart, "B", Stroke::kB, audible(stylus.vibration_b.spectrum), kMicrometres);
  const Spectrum difference = audible(stylus.vibration_difference.spectrum);
  add(chart, "B less A", Stroke::kDifference, difference, kMicrometres);
  Spectrum threshold = difference;
  for (std::size_t i = 0; i < threshold.frequency.size(); ++i) {
    threshold.amplitude[i] = perception::vibration_threshold(threshold.frequency[i]);
  }
  add(chart, "felt from here on", Stroke::kLimit, threshold, kMicrometres);
  return chart;
}

}  // namespace irdm::replay
