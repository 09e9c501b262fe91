#include "replay/report/comparison_html.hpp"

#include <numbers>

#include "replay/compare/comparison_text.hpp"
#include "replay/report/axis.hpp"
#include "replay/report/comparison_charts.hpp"

namespace irdm::replay {
namespace {

constexpr double kMillimetres = 1e3;
constexpr double kDegrees = 180.0 / std::numbers::pi;

constexpr const char* kHead = R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Comparison of two runs</title>
<style>
body { font: 15px/1.5 system-ui, sans-serif; color: #1c2430; background: #fff; max-width: 780px; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.25rem; margin-top: 2.5rem; border-top: 1px solid #ccd3dc; padding-top: 1rem; }
table { border-collapse: collapse; margin: 1rem 0; } th, td { padding: .25rem .8rem .25rem 0; text-align: left; border-bottom: 1px solid #e3e7ec; }
td.number { text-align: right; font-variant-numeric: tabular-nums; }
figure { margin: 1.5rem 0; } figcaption { font-weight: 600; } svg { width: 100%; height: auto; font: 12px system-ui, sans-serif; }
svg text { fill: #1c2430; } .grid { stroke: #e3e7ec; } .axis { stroke: #1c2430; }
polyline { fill: none; stroke-linejoin: round; stroke-width: 1.5; } line.a, line.b, line.difference, line.limit { stroke-width: 2; }
.a { stroke: #1f6fb2; } .b { stroke: #d9622b; stroke-dasharray: 6 4; } .difference { stroke: #1c2430; } .limit { stroke: #b3261e; stroke-dasharray: 2 3; }
li.noticed::marker { content: "\25CF  "; color: #b3261e; } li.passed::marker { content: "\25CB  "; color: #2e7d32; } li.open::marker { content: "?  "; }
</style>
</head>
<body>
)";

std::string cell(double value) {
  return "<td class=\"number\">" + number_text(value) + "</td>";
}

std::string row(const std::string& what, const Apart& apart, const std::string& unit, double factor,
                const std::vector<double>& times) {
  const std::string share =
      apart.reference > 0.0 ? number_text(100.0 * apart.maximum() / apart.reference) + " %" : "";
  return "<tr><th>" + what + " (" + unit + ")</th>" + cell(factor * apart.rms_over_time()) +
         cell(factor * apart.maximum()) + cell(times[apart.worst_frame()]) +
         cell(factor * apart.last()) + "<td class=\"number\">" + share + "</td></tr>\n";
}

std::string table(const std::string& rows) {
  return "<table><tr><th></th><th>rms</th><th>largest</th><th>at (s)</th><th>last</th>"
         "<th>largest, share of A</th></tr>\n" +
         rows + "</table>\n";
}

std::string figure(const std::string& caption, const Chart& chart) {
  return "<figure><figcaption>" + escaped(caption) + "</figcaption>\n" + svg_of(chart) +
         "</figure>\n";
}

std::string ringing_row(const Ringing* a, const Ringing* b, double factor) {
  const auto cells = [&](const Ringing* ringing) {
    if (ringing == nullptr) return std::string("<td></td><td></td><td></td>");
    return cell(ringing->frequency) + cell(100.0 * ringing->damping_ratio) +
           cell(factor * ringing->amplitude);
  };
  return "<tr>" + cells(a) + cells(b) + "</tr>\n";
}

const Ringing* partner(const std::vector<RingingPair>& pairs, const Ringing& one, bool of_a) {
  for (const RingingPair& pair : pairs) {
    if (of_a && pair.a.frequency == one.frequency) return &pair.b;
    if (!of_a && pair.b.frequency == one.frequency) return &pair.a;
  }
  return nullptr;
}

std::string ringing_table(const SignalPair& pair, const std::string& unit, double factor,
                          const std::vector<double>& times) {
  if (pair.ringing_a.empty() && pair.ringing_b.empty()) return "";
  const auto pairs = pairs_of(pair.ringing_a, pair.ringing_b);
  std::string rows;
  for (const Ringing& a : pair.ringing_a) rows += ringing_row(&a, partner(pairs, a, true), factor);
  for (const Ringing& b : pair.ringing_b) {
    if (partner(pairs, b, false) == nullptr) rows += ringing_row(nullptr, &b, factor);
  }
  const std::string columns = "<th>Hz</th><th>damping (%)</th><th>amplitude (" + unit + ")</th>";
  return "<p>Rings from " + number_text(times[pair.stretch.first]) + " s to " +
         number_text(times[pair.stretch.first + pair.stretch.count - 1]) +
         " s with</p>\n<table><tr><th colspan=\"3\">A</th><th colspan=\"3\">B</th></tr>\n<tr>" +
         columns + columns + "</tr>\n" + rows + "</table>\n";
}

std::string spectrum_figure(const std::string& caption, const SignalPair& pair,
                            const std::string& unit, double factor) {
  if (pair.spectrum_a.frequency.empty()) return "";
  return figure(caption, spectrum_chart(pair, "amplitude (" + unit + ")", factor));
}

std::string node_part(const ObjectComparison& object, const SignalPair& node,
                      const std::vector<double>& times) {
  const std::string name = "surface node " + std::to_string(object.node);
  return figure("Node displacement, B from A",
                difference_chart(object.displacement, times, "apart (mm)", kMillimetres)) +
         figure("Displacement of " + name + ", which is displaced most",
                size_chart(node, times, "displacement (mm)", kMillimetres)) +
         spectrum_figure("Spectrum of the displacement of " + name, node, "mm", kMillimetres) +
         ringing_table(node, "mm", kMillimetres, times);
}

std::string object_part(const ObjectComparison& object, const SignalPair& node,
                        const std::vector<double>& times) {
  std::string rows;
  if (object.same_nodes) {
    rows += row("node displacement", object.displacement, "mm", kMillimetres, times) +
            row("node place", object.place, "mm", kMillimetres, times);
  }
  rows += row("centre of mass", object.centre_of_mass, "mm", kMillimetres, times) +
          row("orientation", object.orientation, "degrees", kDegrees, times);
  return "<h2>Object " + escaped(object.name) + "</h2>\n" + table(rows) +
         (object.same_nodes ? node_part(object, node, times)
                            : "<p>Nodes are not compared: the meshes differ.</p>\n") +
         figure("Centre of mass, B from A",
                drift_chart(object.centre_of_mass, times, "apart (mm)", kMillimetres)) +
         figure("Orientation, B from A",
                drift_chart(object.orientation, times, "angle (degrees)", kDegrees));
}

std::string finding(const std::string& text, const std::optional<bool>& noticeable) {
  const char* kind = !noticeable ? "open" : *noticeable ? "noticed" : "passed";
  return std::string("<li class=\"") + kind + "\">" + escaped(text) + "</li>\n";
}

std::string findings(const StylusMeasures& stylus, const Measures& measures,
                     const std::vector<double>& times) {
  const auto texts = perceptual_findings(stylus, measures, times);
  return "<h3>What a hand would notice</h3>\n<ul>\n" +
         finding(texts[0], stylus.difference.noticeable()) +
         finding(texts[1], stylus.noticeable_compliance()) +
         finding(texts[2], stylus.vibration_difference.noticeable()) +
         finding(texts[3], stylus.onsets.noticeable(measures.interval)) +
         "</ul>\n<p>Thresholds of people on average; sources and how far they carry are in irdm's "
         "docs/replay.md.</p>\n";
}

std::string stylus_part(std::size_t s, const Apart& force, const Measures& measures,
                        const std::vector<double>& times) {
  const StylusMeasures& stylus = measures.styluses[s];
  std::string text =
      "<h2>Stylus " + std::to_string(s) + "</h2>\n" + table(row("force", force, "N", 1.0, times)) +
      findings(stylus, measures, times) +
      figure("Force", size_chart(stylus.force, times, "force (N)", 1.0)) +
      figure("Force, B from A", drift_chart(force, times, "apart (N)", 1.0)) +
      figure("Force, as a hand would notice", force_share_chart(stylus.difference, times)) +
      spectrum_figure("Spectrum of the force", stylus.force, "N", 1.0) +
      ringing_table(stylus.force, "N", 1.0, times);
  if (stylus.vibration_difference.noticeable()) {
    text += figure("Vibration of the hand, and what it feels", vibration_chart(stylus));
  }
  return text;
}

}  // namespace

std::string comparison_html(const Comparison& comparison, const Measures& measures) {
  const std::vector<double>& times = comparison.times;
  std::string text =
      std::string(kHead) + "<h1>Comparison of two runs</h1>\n<table><tr><th>A</th><td>" +
      escaped(comparison.a) + "</td></tr>\n<tr><th>B</th><td>" + escaped(comparison.b) +
      "</td></tr></table>\n<p>" + std::to_string(times.size()) + " frames in common, from " +
      number_text(times.front()) + " s to " + number_text(times.back()) + " s; " +
      std::to_string(comparison.alone) + " of one alone.</p>\n";
  if (!measures.evenly_spaced) {
    text += "<p>The frames are not evenly spaced: no spectra, ringing and vibrations.</p>\n";
  }
  for (std::size_t s = 0; s < comparison.forces.size(); ++s) {
    text += stylus_part(s, comparison.forces[s], measures, times);
  }
  for (std::size_t i = 0; i < comparison.objects.size(); ++i) {
    text += object_part(comparison.objects[i], measures.nodes[i], times);
  }
  return text + "</body>\n</html>\n";
}

}  // namespace irdm::replay
