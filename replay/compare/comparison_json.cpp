#include "replay/compare/comparison_output.hpp"

#include <nlohmann/json.hpp>
#include <utility>

namespace irdm::replay {
namespace {

using Json = nlohmann::ordered_json;

Json json(const DifferenceSeries& series, const char* unit) {
  return {{"unit", unit},
          {"rms", series.rms_over_time()},
          {"max", series.maximum()},
          {"last", series.last()},
          {"reference", series.reference},
          {"rms_over_time", series.rms},
          {"max_over_time", series.largest}};
}

Json size_json(const SignalPair& pair, const char* unit) {
  return {{"unit", unit}, {"a", pair.size_a}, {"b", pair.size_b}};
}

Json spectrum_json(const Spectrum& a, const Spectrum& b, const char* unit) {
  return {{"unit", unit}, {"frequency", a.frequency}, {"a", a.amplitude}, {"b", b.amplitude}};
}

Json json(const std::vector<Ringing>& list) {
  Json all = Json::array();
  for (const Ringing& each : list) {
    all.push_back({{"frequency", each.frequency},
                   {"damping_ratio", each.damping_ratio},
                   {"amplitude", each.amplitude}});
  }
  return all;
}

// What both ring with.
Json pairs_json(const SignalPair& pair) {
  Json all = Json::array();
  for (const auto& [a, b] : pairs_of(pair.ringing_a, pair.ringing_b)) {
    all.push_back({{"frequency", a.frequency},
                   {"frequency_share", b.frequency / a.frequency - 1.0},
                   {"damping_ratio", a.damping_ratio},
                   {"damping_ratio_difference", b.damping_ratio - a.damping_ratio}});
  }
  return all;
}

Json ringing_json(const SignalPair& pair, const std::vector<double>& times) {
  Json from, to;  // null
  if (pair.interval.count > 0) {
    from = times[pair.interval.first];
    to = times[pair.interval.first + pair.interval.count - 1];
  }
  return {{"from", from},
          {"to", to},
          {"a", json(pair.ringing_a)},
          {"b", json(pair.ringing_b)},
          {"pairs", pairs_json(pair)}};
}

Json node_json(Eigen::Index number, const SignalPair& node, const std::vector<double>& times) {
  return {{"number", number},
          {"size_over_time", size_json(node, "m")},
          {"spectrum", spectrum_json(node.spectrum_a, node.spectrum_b, "m")},
          {"ringing", ringing_json(node, times)}};
}

Json object_json(const ObjectComparison& object, const SignalPair& node,
                 const std::vector<double>& times) {
  Json all;
  all["name"] = object.name;
  if (object.same_nodes) {
    all["displacement"] = json(object.displacement, "m");
    all["place"] = json(object.place, "m");
  }
  all["centre_of_mass"] = json(object.centre_of_mass, "m");
  all["orientation"] = json(object.orientation, "rad");
  all["node"] = object.same_nodes ? node_json(object.node, node, times) : Json();
  return all;
}

// Null where nothing is judged.
Json verdict_json(const std::optional<bool>& verdict) {
  return verdict ? Json(*verdict) : Json();
}

Json force_json(const ForceDifference& force, const std::vector<double>& times) {
  return {{"limit", perception::kForceShare},
          {"largest", force.largest},
          {"largest_at", times[force.worst_frame]},
          {"noticeable_time", force.noticeable_time},
          {"noticeable", verdict_json(force.noticeable())},
          {"share_over_time", force.share}};
}

Json compliance_json(const StylusMeasures& stylus) {
  const auto verdict = stylus.noticeable_compliance();
  const auto if_judged = [&](double value) { return verdict ? Json(value) : Json(); };
  return {{"unit", "m/N"},
          {"limit", perception::kComplianceShare},
          {"a", if_judged(stylus.compliance_a.value())},
          {"b", if_judged(stylus.compliance_b.value())},
          {"share", if_judged(stylus.compliance_share())},
          {"noticeable", verdict_json(verdict)}};
}

Json vibration_json(const StylusMeasures& stylus, const perception::Hand& hand) {
  const Spectrum& spectrum = stylus.vibration_difference.spectrum;
  std::vector<double> threshold;
  for (const double frequency : spectrum.frequency) {
    threshold.push_back(perception::vibration_threshold(frequency));
  }
  return {{"unit", "m"},
          {"hand", {{"mass", hand.mass}, {"damping", hand.damping}, {"stiffness", hand.stiffness}}},
          {"frequency", spectrum.frequency},
          {"threshold", threshold},
          {"a", stylus.vibration_a.spectrum.amplitude},
          {"b", stylus.vibration_b.spectrum.amplitude},
          {"difference", spectrum.amplitude},
          {"level_a", stylus.vibration_a.level},
          {"level_b", stylus.vibration_b.level},
          {"level", stylus.vibration_difference.level},
          {"level_at", stylus.vibration_difference.frequency},
          {"noticeable", verdict_json(stylus.vibration_difference.noticeable())}};
}

Json onset_json(const OnsetDelays& onsets, double interval) {
  return {{"unit", "s"},
          {"limit", perception::kOnsetDelay},
          {"resolution", interval},
          {"onsets", onsets.onsets},
          {"delays", onsets.delays},
          {"largest", onsets.largest},
          {"alone", onsets.alone},
          {"noticeable", verdict_json(onsets.noticeable(interval))}};
}

Json stylus_json(const DifferenceSeries& force, const StylusMeasures& stylus,
                 const Measures& measures, const std::vector<double>& times) {
  return {{"force", json(force, "N")},
          {"size_over_time", size_json(stylus.force, "N")},
          {"spectrum", spectrum_json(stylus.force.spectrum_a, stylus.force.spectrum_b, "N")},
          {"ringing", ringing_json(stylus.force, times)},
          {"perception",
           {{"force", force_json(stylus.difference, times)},
            {"compliance", compliance_json(stylus)},
            {"vibration", vibration_json(stylus, measures.hand)},
            {"onset", onset_json(stylus.onsets, measures.interval)}}}};
}

}  // namespace

std::string comparison_json(const Comparison& comparison, const Measures& measures) {
  Json objects = Json::array();
  for (std::size_t i = 0; i < comparison.objects.size(); ++i) {
    objects.push_back(object_json(comparison.objects[i], measures.nodes[i], comparison.times));
  }
  Json styluses = Json::array();
  for (std::size_t s = 0; s < comparison.forces.size(); ++s) {
    styluses.push_back(
        stylus_json(comparison.forces[s], measures.styluses[s], measures, comparison.times));
  }
  const Json all{{"format", "irdm-comparison"},
                 {"version", 1},
                 {"a", comparison.a},
                 {"b", comparison.b},
                 {"frames", comparison.times.size()},
                 {"frames_alone", comparison.alone},
                 {"evenly_spaced", measures.evenly_spaced},
                 {"interval", measures.interval},
                 {"time", comparison.times},
                 {"objects", std::move(objects)},
                 {"styluses", std::move(styluses)}};
  // A file's name may have bytes that are no UTF-8.
  return all.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace irdm::replay
