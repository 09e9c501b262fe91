#include "precompute/check/lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include "common/model/content_checksum.hpp"
#include "common/model/model_writer.hpp"
#include "precompute/check/static_reference.hpp"
#include "precompute/check/wave_speed.hpp"
#include "precompute/mesh/material_regions.hpp"
#include "precompute/mesh/surface.hpp"
#include "precompute/modal/element_error.hpp"
#include "precompute/modal/residual_compliance.hpp"

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

// Where the search for zeros is bounded.
std::string unresolved_text(int nodes) {
  return nodes == 0
             ? ""
             : text("; not known at %d nodes: not resolved with %d values", nodes, kMostTurns);
}

Line inverse_line(const std::vector<NodeFindings>& nodes, double dt) {
  std::size_t worst = 0;
  int unstable = 0;
  int unresolved = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].inverse.resolved) ++unresolved;
    if (!(nodes[i].inverse.largest_modulus <= nodes[worst].inverse.largest_modulus)) worst = i;
    if (nodes[i].inverse.growing > 0) ++unstable;
  }
  const double modulus = nodes[worst].inverse.largest_modulus;
  return {
      "stable force",
      unstable > 0     ? Verdict::kFail
      : unresolved > 0 ? Verdict::kWarn
                       : Verdict::kOk,
      text("%d nodes unstable when held; largest modulus of the inverse %.6f (node %zu, grows by "
           "%.2g 1/s)",
           unstable, modulus, worst, std::log(modulus) / dt) +
          unresolved_text(unresolved)};
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
  const auto unknown = static_cast<int>(std::ranges::count_if(
      nodes, [](const NodeFindings& node) { return std::isnan(node.coupling); }));
  Verdict verdict = std::isinf(limit.lowest) ? Verdict::kOk : Verdict::kWarn;
  if (wanted > 0.0) verdict = Verdict::kOk;
  if (unknown > 0) verdict = Verdict::kWarn;
  if (limit.lowest <= wanted) verdict = Verdict::kFail;
  const std::string found = std::isnan(limit.lowest) ? "not known"
                            : std::isinf(limit.lowest)
                                ? "stable without one"
                                : text("largest stable %.4g N/m at the worst node, median %.4g",
                                       limit.lowest, limit.median);
  return {"virtual coupling", verdict,
          found + unresolved_text(unknown) +
              text("; hand %.3g kg, %.3g N s/m, %.3g N/m, %d steps from position to force%s",
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

namespace {

constexpr int kStaticColumns = 12;
constexpr double kSamples = 20.0;  // while the fastest wave crosses the watched nodes
constexpr int kFewestNodes = 8;
constexpr int kFewestDistances = 5;
constexpr double kErrors = 2.0;         // standard errors by which a speed must be off its limit
constexpr double kMostDamped = 0.5;     // damping ratio of a wave as long as the watched distance
constexpr double kFewestSamples = 5.0;  // while the slowest wave crosses the watched nodes
constexpr double kWatchedCrossings = 1.25;  // of the slowest wave

}  // namespace

Line checksum_line(const hdf5::File& file) {
  const auto stored = stored_content_checksum(file);
  if (!stored) {
    return {"checksum", Verdict::kWarn, "the file has none (made by an older irdm-precompute)"};
  }
  if (content_checksum(file) != *stored) {
    return {"checksum", Verdict::kFail, "SHA-256 of the content does not match"};
  }
  return {"checksum", Verdict::kOk, "SHA-256 of the content matches"};
}

Line chunk_checksum_line(const hdf5::File& file) {
  if (!file.has_filter(kDenseR, H5Z_FILTER_FLETCHER32)) {
    return {"dense checksums", Verdict::kWarn, "/response/dense/R carries none"};
  }
  if (!file.exists(kDenseColumnChecksum)) {
    return {"dense checksums", Verdict::kWarn,
            "Fletcher32 of every chunk matches; the columns have none (made by an older "
            "irdm-precompute)"};
  }
  return {"dense checksums", Verdict::kOk, "Fletcher32 of every chunk and those of columns match"};
}

Line modes_line(const ModalResponse& response, const Material& material) {
  const Eigen::ArrayXd omega = response.angular_frequency;
  const Eigen::ArrayXd expected =
      0.5 * (material.rayleigh_alpha + material.rayleigh_beta * omega.square());
  const Eigen::ArrayXd decay = response.decay_rate;
  const double off = ((decay - expected).abs() / expected.max(1e-300)).maxCoeff();
  const double to_hertz = 0.5 / std::numbers::pi;
  return {"modes", off > 1e-6 ? Verdict::kWarn : Verdict::kOk,
          text("%d finite, %.4g .. %.4g Hz, decay rates %.3g .. %.3g 1/s%s", response.mode_count(),
               omega.minCoeff() * to_hertz, omega.maxCoeff() * to_hertz, decay.minCoeff(),
               decay.maxCoeff(), off > 1e-6 ? ", not those of the material" : "")};
}

Report region_lines(const Model& model) {
  const TetMesh mesh{model.mesh.nodes, model.mesh.tets, {}};
  Report lines;
  for (const RegionReport& region : report_regions(mesh, model.material)) {
    const bool coarse = coarseness_hint(region).has_value();
    lines.push_back(
        {name_of(region), coarse ? Verdict::kWarn : Verdict::kOk, format_region(region)});
  }
  return lines;
}

namespace {

// Each with its smallest node first, the same way round; sorted.
std::vector<std::array<int, 3>> sorted_triangles(const Triangles& triangles) {
  std::vector<std::array<int, 3>> sorted;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    std::array<int, 3> nodes{triangles(t, 0), triangles(t, 1), triangles(t, 2)};
    std::rotate(nodes.begin(), std::ranges::min_element(nodes), nodes.end());
    sorted.push_back(nodes);
  }
  std::ranges::sort(sorted);
  return sorted;
}

}  // namespace

Report surface_lines(const Model& model) {
  const Surface surface =
      extract_surface({model.mesh.nodes, model.mesh.tets, {}}, "the model's mesh");
  const auto expected = sorted_triangles(surface.triangles);
  const auto found = sorted_triangles(model.mesh.triangles);
  if (surface.nodes == model.mesh.surface_nodes && expected == found) return {};
  std::vector<std::array<int, 3>> wrong;
  std::ranges::set_difference(found, expected, std::back_inserter(wrong));
  return {
      {"surface", Verdict::kFail,
       text("%zu of %zu triangles are no outer faces of elements", wrong.size(), found.size())}};
}

Line elements_line(const Model& model) {
  const TetMesh mesh{model.mesh.nodes, model.mesh.tets, {}};
  const ElementReport elements = report_elements(mesh, model.material);
  const std::string found = elements.warning.value_or(elements.found);
  if (const auto locking = locking_hint(mesh.order(), model.material)) {
    return {"elements", Verdict::kWarn, found + "; " + *locking};
  }
  if (elements.warning) return {"elements", Verdict::kWarn, found};
  return {"elements", elements.compared ? Verdict::kOk : Verdict::kNone, found};
}

Line residual_line(const ModalResponse& response) {
  const ResidualCompliance& residual = response.residual;
  const ModeReduction& reduction = residual.reduction;
  double largest = 0.0;
  for (int i = 0; i + 1 < static_cast<int>(residual.row_start.size()); ++i) {
    largest = std::max(largest, residual.diagonal(i).trace());
  }
  const double lacking = needed_for_definiteness(residual) / largest;
  const double error = std::max(reduction.force_error, reduction.shape_error);
  return {"modes left out", lacking > 1e-3 ? Verdict::kFail : judge(error, 1e-1, 1.0),
          text("%d of %d modes; under a fingertip of %.3g m the force is off by %.2g, the shape by "
               "%.2g; no energy to be had but %.1g of a node's compliance",
               response.mode_count(), reduction.elastic_modes, reduction.contact_radius,
               reduction.force_error, reduction.shape_error, lacking)};
}

Line reciprocity_line(const Reciprocity& reciprocity) {
  const double share = reciprocity.largest_difference();
  return {"reciprocity", judge(share, 1e-3, 1e-2),
          text("R(a,b) and R(b,a) differ by %.2g at most (column %d; all columns against %d)",
               share, reciprocity.column_of_largest(), reciprocity.sample_size())};
}

namespace {

// Of a fixed body.
Line no_static_line() {
  return {"static compliance", Verdict::kNone, "the file does not say which nodes are clamped"};
}

}  // namespace

Report static_lines(const Model& model, const StoredResponse& R) {
  if (model.body.support == Support::kFixed) {
    return {{"momentum", Verdict::kNone, "a fixed body may have it"}, no_static_line()};
  }
  const StaticReference reference(model);
  const std::vector<int> sample = fixed_sample(model.degrees_of_freedom(), kStaticColumns);
  StaticComparison worst{0.0, 0.0};
  for (const int b : sample) {
    const StaticComparison one =
        compare_static(R.static_column(b), reference.displacement(b), reference.surface_rigid());
    // fmax would hide what is not a number.
    if (!(one.rigid <= worst.rigid)) worst.rigid = one.rigid;
    if (!(one.mismatch <= worst.mismatch)) worst.mismatch = one.mismatch;
  }
  const int count = static_cast<int>(sample.size());
  return {
      {"momentum", judge(worst.rigid, 1e-3, 1e-2),
       text("settled columns have %.2g of rigid motion at most (%d columns)", worst.rigid, count)},
      {"static compliance", judge(worst.mismatch, 1e-2, 1e-1),
       text("settled columns differ by %.2g at most from finite elements solved anew (%d columns)",
            worst.mismatch, count)}};
}

namespace {

// Surface nodes where the columns of a node have what modes that are left out do.
std::vector<int> complete_nodes(const Model& model, int node) {
  const ResidualCompliance& g = std::get<ModalResponse>(model.response).residual;
  return {g.nodes.begin() + g.begin_of(node), g.nodes.begin() + g.end_of(node)};
}

}  // namespace

Line static_line_of_some_modes(const Model& model, const StoredResponse& R) {
  if (model.body.support == Support::kFixed) return no_static_line();
  const StaticReference reference(model);
  const std::vector<int> sample = fixed_sample(model.degrees_of_freedom(), kStaticColumns);
  double worst = 0.0;
  for (const int b : sample) {
    const Eigen::VectorXd expected = reference.displacement(b);
    const Eigen::VectorXd difference = R.static_column(b) - expected;
    for (const int node : complete_nodes(model, b / 3)) {
      const double one = difference.segment<3>(3 * node).cwiseAbs().maxCoeff();
      if (!(one <= worst * expected.cwiseAbs().maxCoeff())) {
        worst = one / expected.cwiseAbs().maxCoeff();
      }
    }
  }
  return {"static compliance", judge(worst, 1e-2, 1e-1),
          text("near the force, settled columns differ by %.2g at most from finite elements solved "
               "anew (%d columns)",
               worst, static_cast<int>(sample.size()))};
}

Line decay_line(double left, bool cut) {
  const Verdict verdict = judge(left, 1e-2, 1e-1);
  return {"decay at T", !cut && verdict == Verdict::kFail ? Verdict::kWarn : verdict,
          text("%.2g of R is left at the last step%s", left,
               cut ? "" : " (rendering from modes does not end there)")};
}

// Of a Rayleigh wave as long as that: from 0.5 on less than 3 % of it arrive.
double damping_ratio(const Material& material, double speed, double length) {
  const double omega = 2.0 * std::numbers::pi * speed / length;
  return 0.5 * (material.rayleigh_alpha / omega + material.rayleigh_beta * omega);
}

double wave_interval(const Model& model) {
  const double reach = model.mesh.rest_position(wave_source(model) / 3).norm();
  return std::min(model.dt, reach / theoretical_speeds(model.material).dilatational / kSamples);
}

Line wave_line(const Model& model, const StoredResponse& R, double dt, int steps) {
  if (!model.material.elements.empty()) {
    return {"wave speed", Verdict::kNone, "the body has several materials"};
  }
  const WaveSpeeds theory = theoretical_speeds(model.material);
  const int b = wave_source(model);
  const double reach = model.mesh.rest_position(b / 3).norm();
  const int wanted = static_cast<int>(kWatchedCrossings * reach / theory.rayleigh / dt) + 3;
  steps = std::min(steps, wanted);
  const MeasuredWave wave = measure_wave(model, b, R.column(b, steps), dt);
  const std::string expected = text("theory: Rayleigh %.3g, shear %.3g, dilatational %.3g m/s",
                                    theory.rayleigh, theory.shear, theory.dilatational);
  if (wave.nodes < kFewestNodes)
    return {"wave speed", Verdict::kNone, "too few nodes to measure; " + expected};
  if (dt * kFewestSamples > reach / theory.rayleigh) {
    return {"wave speed", Verdict::kNone, "crosses too few samples to measure; " + expected};
  }
  if (damping_ratio(model.material, theory.rayleigh, reach) > kMostDamped) {
    return {"wave speed", Verdict::kNone, "is damped away before it has crossed; " + expected};
  }
  if (2 * wave.passed < wave.nodes) {
    const bool shortened = steps < wanted;
    return {"wave speed", shortened ? Verdict::kWarn : Verdict::kFail,
            text("no peak at %d of %d nodes within %.3g ms; ", wave.nodes - wave.passed, wave.nodes,
                 1e3 * steps * dt) +
                expected};
  }
  const std::string speeds =
      text("main wave %.3g, first peak %.3g, first arrival %.3g m/s (%d nodes, every %.2g ms)",
           wave.main.speed(), wave.peak.speed(), wave.arrival.speed(), wave.nodes, 1e3 * dt);
  const double least = 1.0 / (1.2 * theory.dilatational);
  const double most = 1.0 / (0.5 * theory.rayleigh);
  const auto surely_below = [](const FittedPassage& passage, double limit) {
    return passage.slowness + kErrors * passage.error < limit;
  };
  const auto surely_above = [](const FittedPassage& passage, double limit) {
    return passage.slowness - kErrors * passage.error > limit;
  };
  const bool many = wave.distances >= kFewestDistances;
  if (many && (surely_below(wave.main, least) || surely_below(wave.peak, least) ||
               surely_above(wave.main, most))) {
    return {"wave speed", Verdict::kFail, speeds + "; " + expected};
  }
  if (many && surely_above(wave.main, least) && surely_above(wave.peak, least) &&
      surely_below(wave.main, most)) {
    return {"wave speed", Verdict::kOk, speeds + "; " + expected};
  }
  return {"wave speed", Verdict::kNone, speeds + ": the mesh is too coarse to tell; " + expected};
}

}  // namespace irdm::precompute
