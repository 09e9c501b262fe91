#include "replay/compare/comparison_output.hpp"

#include <array>
#include <cstdio>

namespace irdm::replay {
namespace {

std::string line(const std::string& what, const DifferenceSeries& apart, const char* unit,
                 const std::vector<double>& times) {
  char text[256];
  std::snprintf(text, sizeof text, "  %-18s rms %10.3g %-3s  largest %10.3g %-3s at %.6g s",
                what.c_str(), apart.rms_over_time(), unit, apart.maximum(), unit,
                times[apart.worst_frame()]);
  std::string all = text;
  if (apart.reference > 0) {
    std::snprintf(text, sizeof text, ", %.3g %% of %.3g %s",
                  100.0 * apart.maximum() / apart.reference, apart.reference, unit);
    all += text;
  }
  return all + "\n";
}

// Four digits.
std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string percent(double share) {
  return digits(100.0 * share) + " %";
}

std::string verdict(const std::optional<bool>& noticeable, const std::string& why_not) {
  if (!noticeable) return "not judged: " + why_not;
  return *noticeable ? "noticeable" : "not noticeable";
}

std::string ringing_line(const SignalPair& pair) {
  std::string text;
  for (const auto& [a, b] : pairs_of(pair.ringing_a, pair.ringing_b)) {
    text += (text.empty() ? "" : "; ") + digits(a.frequency) + " Hz, damping " +
            percent(a.damping_ratio) + " (B " + digits(b.frequency) + " Hz, " +
            percent(b.damping_ratio) + ")";
  }
  return text.empty() ? "" : "  both ring with     " + text + "\n";
}

std::string row_of(const std::array<std::string, 4>& cells) {
  char text[256];
  std::snprintf(text, sizeof text, "  %-16s%-20s%-20s%s\n", cells[0].c_str(), cells[1].c_str(),
                cells[2].c_str(), cells[3].c_str());
  return text;
}

// Each column has what it is averaged over, and the smallest force that shares refer to.
std::string force_columns(const DifferenceSeries& apart, const ForceDifference& felt,
                          const std::vector<double>& times) {
  const auto share = [&](double difference) {
    return apart.reference > 0 ? percent(difference / apart.reference) : std::string("-");
  };
  return row_of({"force, B - A", "rms", "largest", "as felt"}) +
         row_of({"  size", digits(apart.rms_over_time()) + " N", digits(apart.maximum()) + " N",
                 "-"}) +
         row_of({"  share of A", share(apart.rms_over_time()), share(apart.maximum()),
                 percent(felt.largest)}) +
         row_of({"  refers to", "peak " + digits(apart.reference) + " N",
                 "peak " + digits(apart.reference) + " N", "force at that time"}) +
         row_of({"  at", "-", digits(times[apart.worst_frame()]) + " s",
                 digits(times[felt.worst_frame]) + " s"}) +
         row_of({"  window", "all frames", "one frame", digits(perception::kForceTime) + " s"}) +
         row_of({"  floor", "none", "none", digits(perception::kSmallForce) + " N"});
}

std::string force_finding(const ForceDifference& force) {
  return "force as felt: apart by up to " + percent(force.largest) + " (limit " +
         percent(perception::kForceShare) + "), above that in " + percent(force.noticeable_time) +
         " of the contact: " + verdict(force.noticeable(), "no contact");
}

std::string compliance_finding(const StylusMeasures& stylus) {
  return "compliance: " + digits(1e3 * stylus.compliance_a.value()) + " and " +
         digits(1e3 * stylus.compliance_b.value()) + " mm/N, apart by " +
         percent(stylus.compliance_share()) + " (limit " + percent(perception::kComplianceShare) +
         "): " + verdict(stylus.noticeable_compliance(), "no contact in both");
}

std::string vibration_finding(const Vibration& difference, bool evenly_spaced) {
  return "vibration: the difference is " + digits(difference.level) +
         " times the least that is felt, at " + digits(difference.frequency) + " Hz: " +
         verdict(difference.noticeable(),
                 evenly_spaced ? "too few frames a second" : "the frames are not evenly spaced");
}

std::string onset_finding(const OnsetDelays& onsets, double interval) {
  return "onset: " + std::to_string(onsets.onsets.size()) + " in both, apart by up to " +
         digits(1e3 * onsets.largest) + " ms (limit " + digits(1e3 * perception::kOnsetDelay) +
         " ms), " + std::to_string(onsets.alone) + " in one alone: " +
         verdict(onsets.noticeable(interval),
                 onsets.onsets.empty() ? "none in both" : "the frames are too far apart");
}

std::vector<std::string> perceptual_findings(const StylusMeasures& stylus,
                                             const Measures& measures) {
  return {force_finding(stylus.difference), compliance_finding(stylus),
          vibration_finding(stylus.vibration_difference, measures.evenly_spaced),
          onset_finding(stylus.onsets, measures.interval)};
}

// Nothing is judged without contact; an absent stylus has none.
std::string stylus_section(std::size_t s, const Comparison& comparison, const Measures& measures) {
  const StylusMeasures& stylus = measures.styluses[s];
  std::string text = "stylus " + std::to_string(s);
  if (!stylus.difference.contact) return text + ": no contact in A or B, not judged\n";
  text += "\n" + force_columns(comparison.forces[s], stylus.difference, comparison.times) +
          ringing_line(stylus.force);
  for (const std::string& each : perceptual_findings(stylus, measures)) text += "  " + each + "\n";
  return text;
}

}  // namespace

std::string comparison_table(const Comparison& comparison, const Measures& measures) {
  std::string text = comparison.a + " and " + comparison.b + ": " +
                     std::to_string(comparison.times.size()) + " frames in common, " +
                     std::to_string(comparison.alone) + " of one alone\n";
  for (std::size_t i = 0; i < comparison.objects.size(); ++i) {
    const ObjectComparison& object = comparison.objects[i];
    text += "object " + object.name + "\n";
    if (object.same_nodes) {
      text += line("node displacement", object.displacement, "m", comparison.times) +
              line("node place", object.place, "m", comparison.times);
    } else {
      text += "  nodes              not compared: the meshes differ\n";
    }
    text += line("centre of mass", object.centre_of_mass, "m", comparison.times) +
            line("orientation", object.orientation, "rad", comparison.times) +
            ringing_line(measures.nodes[i]);
  }
  for (std::size_t s = 0; s < comparison.forces.size(); ++s) {
    text += stylus_section(s, comparison, measures);
  }
  return text;
}

}  // namespace irdm::replay
