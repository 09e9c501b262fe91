#include <algorithm>
#include <cmath>
#include <numbers>

#include "precompute/check/lines.hpp"

namespace irdm::precompute {
namespace {

struct Spread {
  double lowest;
  double median;
  double highest;
};

// NaN sorts to the top, where it is seen.
Spread spread(const std::vector<NodeFindings>& nodes, double NodeFindings::*value) {
  std::vector<double> values;
  for (const NodeFindings& node : nodes) {
    if (!node.clamped) values.push_back(node.*value);
  }
  std::sort(values.begin(), values.end(),
            [](double a, double b) { return std::isnan(b) ? !std::isnan(a) : a < b; });
  return {values.front(), values[values.size() / 2], values.back()};
}

Line passivity_line(const std::vector<NodeFindings>& nodes, double dt) {
  std::size_t worst = 0;
  int active = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].clamped) continue;
    const double lowest = nodes[i].passivity.lowest;
    if (nodes[worst].clamped || !(lowest >= nodes[worst].passivity.lowest)) worst = i;
    if (!(lowest >= -1e-6)) ++active;
  }
  const Passivity& passivity = nodes[worst].passivity;
  return {"passivity", judge(-passivity.lowest, 1e-6, 1e-2),
          text("%d nodes can give out energy; lowest real part %.2g of the highest (node %zu, "
               "%.3g Hz)",
               active, passivity.lowest, worst, passivity.angle / (2.0 * std::numbers::pi * dt))};
}

Line inverse_line(const std::vector<NodeFindings>& nodes, double dt) {
  std::size_t worst = 0;
  int unstable = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!(nodes[i].inverse.largest_modulus <= nodes[worst].inverse.largest_modulus)) worst = i;
    if (nodes[i].inverse.growing > 0) ++unstable;
  }
  const double modulus = nodes[worst].inverse.largest_modulus;
  return {
      "stable force", unstable > 0 ? Verdict::kFail : Verdict::kOk,
      text("%d nodes unstable when held; largest modulus of the inverse %.6f (node %zu, grows by "
           "%.2g 1/s)",
           unstable, modulus, worst, std::log(modulus) / dt)};
}

Line stiffness_line(const std::vector<NodeFindings>& nodes) {
  const Spread total = spread(nodes, &NodeFindings::stiffness);
  const Spread elastic = spread(nodes, &NodeFindings::elastic_stiffness);
  const bool sound = total.lowest > 0.0 && elastic.lowest > 0.0 && std::isfinite(total.highest) &&
                     std::isfinite(elastic.highest);
  return {
      "stiffness in a step", sound ? Verdict::kOk : Verdict::kFail,
      text("min %.4g, median %.4g, max %.4g N/m; of R[0] alone %.4g, %.4g, %.4g N/m", total.lowest,
           total.median, total.highest, elastic.lowest, elastic.median, elastic.highest)};
}

Line coupling_line(const std::vector<NodeFindings>& nodes, const HandLoop& loop, double wanted) {
  const Spread limit = spread(nodes, &NodeFindings::coupling);
  Verdict verdict = std::isinf(limit.lowest) ? Verdict::kOk : Verdict::kWarn;
  if (wanted > 0.0) verdict = Verdict::kOk;
  if (!(limit.lowest > wanted)) verdict = Verdict::kFail;
  const std::string found = std::isinf(limit.lowest)
                                ? "stable without one"
                                : text("largest stable %.4g N/m at the worst node, median %.4g",
                                       limit.lowest, limit.median);
  return {"virtual coupling", verdict,
          found + text("; hand %.3g kg, %.3g N s/m, %.3g N/m, %d steps from position to force%s",
                       loop.hand.mass, loop.hand.damping, loop.hand.stiffness, loop.delay,
                       wanted > 0.0 ? text("; wanted %.4g N/m", wanted).c_str() : "")};
}

}  // namespace

Report node_lines(const std::vector<NodeFindings>& nodes, const HandLoop& loop, double coupling) {
  if (std::all_of(nodes.begin(), nodes.end(), [](const auto& node) { return node.clamped; })) {
    return {{"nodes", Verdict::kFail, "no surface node moves"}};
  }
  return {passivity_line(nodes, loop.dt), inverse_line(nodes, loop.dt), stiffness_line(nodes),
          coupling_line(nodes, loop, coupling)};
}

}  // namespace irdm::precompute
