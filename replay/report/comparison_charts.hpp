#pragma once

#include "replay/compare/measure_runs.hpp"
#include "replay/report/svg_chart.hpp"

namespace irdm::replay {

/// The figures of a report. Lengths in mm, vibrations in um, angles in degrees, forces in N.

/// Root mean square and largest difference over time, in `factor` times the quantity's unit.
Chart difference_chart(const Apart& apart, const std::vector<double>& times,
                       const std::string& y_label, double factor);
/// One curve: of a quantity of the whole body.
Chart drift_chart(const Apart& apart, const std::vector<double>& times, const std::string& y_label,
                  double factor);
/// Both runs on the same axes, over time and over frequency.
Chart size_chart(const SignalPair& pair, const std::vector<double>& times,
                 const std::string& y_label, double factor);
Chart spectrum_chart(const SignalPair& pair, const std::string& y_label, double factor);
/// What a hand would notice: difference of the force, and vibration, each with its limit.
Chart force_share_chart(const ForceDifference& force, const std::vector<double>& times);
Chart vibration_chart(const StylusMeasures& stylus);

}  // namespace irdm::replay
