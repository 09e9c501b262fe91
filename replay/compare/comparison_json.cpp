#include "replay/compare/comparison_json.hpp"

#include "replay/compare/json_text.hpp"

namespace irdm::replay {
namespace {

JsonObject json(const Apart& apart, const char* unit) {
  return JsonObject()
      .add("unit", unit)
      .add("rms", apart.rms_over_time())
      .add("max", apart.maximum())
      .add("last", apart.last())
      .add("reference", apart.reference)
      .add("rms_over_time", apart.rms)
      .add("max_over_time", apart.largest);
}

JsonObject size_json(const SignalPair& pair, const char* unit) {
  return JsonObject().add("unit", unit).add("a", pair.size_a).add("b", pair.size_b);
}

JsonObject spectrum_json(const Spectrum& a, const Spectrum& b, const char* unit) {
  return JsonObject()
      .add("unit", unit)
      .add("frequency", a.frequency)
      .add("a", a.amplitude)
      .add("b", b.amplitude);
}

std::vector<JsonObject> json(const std::vector<Ringing>& list) {
  std::vector<JsonObject> all;
  for (const Ringing& each : list) {
    all.push_back(JsonObject()
                      .add("frequency", each.frequency)
                      .add("damping_ratio", each.damping_ratio)
                      .add("amplitude", each.amplitude));
  }
  return all;
}

// What both ring with.
std::vector<JsonObject> pairs_json(const SignalPair& pair) {
  std::vector<JsonObject> all;
  for (const auto& [a, b] : pairs_of(pair.ringing_a, pair.ringing_b)) {
    all.push_back(JsonObject()
                      .add("frequency", a.frequency)
                      .add("frequency_share", b.frequency / a.frequency - 1.0)
                      .add("damping_ratio", a.damping_ratio)
                      .add("damping_ratio_difference", b.damping_ratio - a.damping_ratio));
  }
  return all;
}

JsonObject ringing_json(const SignalPair& pair, const std::vector<double>& times) {
  JsonObject json_of_pair;
  if (pair.stretch.count == 0) {
    json_of_pair.add_null("from").add_null("to");
  } else {
    json_of_pair.add("from", times[pair.stretch.first])
        .add("to", times[pair.stretch.first + pair.stretch.count - 1]);
  }
  return json_of_pair.add("a", json(pair.ringing_a))
      .add("b", json(pair.ringing_b))
      .add("pairs", pairs_json(pair));
}

JsonObject object_json(const ObjectComparison& object, const SignalPair& node,
                       const std::vector<double>& times) {
  JsonObject all;
  all.add("name", object.name);
  if (object.same_nodes) {
    all.add("displacement", json(object.displacement, "m")).add("place", json(object.place, "m"));
  }
  all.add("centre_of_mass", json(object.centre_of_mass, "m"))
      .add("orientation", json(object.orientation, "rad"));
  if (!object.same_nodes) return all.add_null("node");
  return all.add("node", JsonObject()
                             .add("number", static_cast<std::size_t>(object.node))
                             .add("size_over_time", size_json(node, "m"))
                             .add("spectrum", spectrum_json(node.spectrum_a, node.spectrum_b, "m"))
                             .add("ringing", ringing_json(node, times)));
}

JsonObject add_verdict(JsonObject all, const std::optional<bool>& verdict) {
  return verdict ? all.add("noticeable", *verdict) : all.add_null("noticeable");
}

JsonObject force_json(const ForceDifference& force, const std::vector<double>& times) {
  return JsonObject()
      .add("limit", perception::kForceShare)
      .add("largest", force.largest)
      .add("largest_at", times[force.worst_frame])
      .add("noticeable_time", force.noticeable_time)
      .add("noticeable", force.noticeable())
      .add("share_over_time", force.share);
}

JsonObject compliance_json(const StylusMeasures& stylus) {
  JsonObject all;
  all.add("unit", "m/N").add("limit", perception::kComplianceShare);
  const auto verdict = stylus.noticeable_compliance();
  if (!verdict) return all.add_null("a").add_null("b").add_null("share").add_null("noticeable");
  return all.add("a", stylus.compliance_a.value())
      .add("b", stylus.compliance_b.value())
      .add("share", stylus.compliance_share())
      .add("noticeable", *verdict);
}

JsonObject vibration_json(const StylusMeasures& stylus, const perception::Hand& hand) {
  const Spectrum& spectrum = stylus.vibration_difference.spectrum;
  std::vector<double> threshold;
  for (const double frequency : spectrum.frequency) {
    threshold.push_back(perception::vibration_threshold(frequency));
  }
  JsonObject all;
  all.add("unit", "m")
      .add("hand", JsonObject()
                       .add("mass", hand.mass)
                       .add("damping", hand.damping)
                       .add("stiffness", hand.stiffness))
      .add("frequency", spectrum.frequency)
      .add("threshold", threshold)
      .add("a", stylus.vibration_a.spectrum.amplitude)
      .add("b", stylus.vibration_b.spectrum.amplitude)
      .add("difference", spectrum.amplitude)
      .add("level_a", stylus.vibration_a.level)
      .add("level_b", stylus.vibration_b.level)
      .add("level", stylus.vibration_difference.level)
      .add("level_at", stylus.vibration_difference.frequency);
  return add_verdict(all, stylus.vibration_difference.noticeable());
}

JsonObject onset_json(const OnsetDelays& onsets, double interval) {
  JsonObject all;
  all.add("unit", "s")
      .add("limit", perception::kOnsetDelay)
      .add("resolution", interval)
      .add("onsets", onsets.onsets)
      .add("delays", onsets.delays)
      .add("largest", onsets.largest)
      .add("alone", onsets.alone);
  return add_verdict(all, onsets.noticeable(interval));
}

JsonObject stylus_json(const Apart& force, const StylusMeasures& stylus, const Measures& measures,
                       const std::vector<double>& times) {
  return JsonObject()
      .add("force", json(force, "N"))
      .add("size_over_time", size_json(stylus.force, "N"))
      .add("spectrum", spectrum_json(stylus.force.spectrum_a, stylus.force.spectrum_b, "N"))
      .add("ringing", ringing_json(stylus.force, times))
      .add("perception", JsonObject()
                             .add("force", force_json(stylus.difference, times))
                             .add("compliance", compliance_json(stylus))
                             .add("vibration", vibration_json(stylus, measures.hand))
                             .add("onset", onset_json(stylus.onsets, measures.interval)));
}

}  // namespace

std::string comparison_json(const Comparison& comparison, const Measures& measures) {
  std::vector<JsonObject> objects;
  for (std::size_t i = 0; i < comparison.objects.size(); ++i) {
    objects.push_back(object_json(comparison.objects[i], measures.nodes[i], comparison.times));
  }
  std::vector<JsonObject> styluses;
  for (std::size_t s = 0; s < comparison.forces.size(); ++s) {
    styluses.push_back(
        stylus_json(comparison.forces[s], measures.styluses[s], measures, comparison.times));
  }
  return JsonObject()
             .add("format", "irdm-comparison")
             .add("version", std::size_t{1})
             .add("a", comparison.a)
             .add("b", comparison.b)
             .add("frames", comparison.times.size())
             .add("frames_alone", comparison.alone)
             .add("evenly_spaced", measures.evenly_spaced)
             .add("interval", measures.interval)
             .add("time", comparison.times)
             .add("objects", objects)
             .add("styluses", styluses)
             .text() +
         "\n";
}

}  // namespace irdm::replay
