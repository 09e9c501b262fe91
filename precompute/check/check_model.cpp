#include "precompute/check/check_model.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>

#include "common/error.hpp"
#include "common/model/model_file.hpp"
#include "common/stability/transfer.hpp"
#include "precompute/blas.hpp"
#include "precompute/check/lines.hpp"
#include "precompute/check/static_reference.hpp"
#include "precompute/modal/elastic_statics.hpp"

namespace irdm::precompute {
namespace {

constexpr int kNodesAtOnce = 32;
constexpr int kSampledColumns = 16;

void append(Report& report, const Report& lines, const std::string& suffix = "") {
  for (const Line& line : lines) {
    report.push_back(line);
    report.back().name += suffix;
  }
}

// Analyses the nodes from `first` on; each has its own place, so that the threads change nothing.
void analyse(const Model& model, const NodeConditions& conditions,
             const std::vector<DrivingPoint>& records, int first,
             std::vector<NodeFindings>& findings) {
  const int count = static_cast<int>(records.size());
#pragma omp parallel for schedule(dynamic)
  for (int i = 0; i < count; ++i) {
    const Vector3 x = model.mesh.rest_position(first + i);
    const Matrix3 rigid = 0.5 * model.dt * model.dt * rigid_mobility(model.body, x, x);
    findings[static_cast<std::size_t>(first + i)] =
        analyse_node(records[static_cast<std::size_t>(i)], rigid, conditions);
  }
}

Report check_modes(const std::filesystem::path& path, const CheckOptions& options,
                   const HandLoop& loop, const Console& console) {
  Model model = read_model(path, ResponseKind::kModal, Checksum::kIgnore);
  auto& response = std::get<ModalResponse>(model.response);
  if (const auto* single = std::get_if<RowMatrix<float>>(&response.shapes)) {
    const RowMatrix<double> shapes = single->cast<double>();
    response.shapes = shapes;
  }
  const auto R = stored_response(model, transposed_blas_product);
  Report report{modes_line(response, model.material)};
  if (response.residual.empty()) {
    append(report, static_lines(model, *R));
  } else {
    report.push_back(residual_line(response));
    report.push_back(static_line_of_some_modes(model, *R));
  }
  report.push_back(decay_line(decay_left(response, model.dt, model.steps), false));

  const RecordLength length = record_length(response, model.dt);
  const int nodes = model.mesh.surface_node_count();
  std::vector<NodeFindings> findings(static_cast<std::size_t>(nodes));
  Progress progress(console, "nodes (modal)", nodes);
  for (int first = 0; first < nodes; first += kNodesAtOnce) {
    const int count = std::min(kNodesAtOnce, nodes - first);
    analyse(model, {loop, length.radius}, R->driving_points(first, count, length.steps), first,
            findings);
    progress.update(first + count);
  }
  append(report, node_lines(findings, loop, options.coupling));
  if (!response.residual.empty()) {
    report.push_back({"step", Verdict::kNone, "not all modes are there"});
    report.push_back({"wave speed", Verdict::kNone, "not all modes are there"});
    return report;
  }
  report.push_back(step_line(model));
  const double interval = wave_interval(model);
  report.push_back(wave_line(model, *stored_response(response, interval, transposed_blas_product),
                             interval, std::numeric_limits<int>::max()));
  return report;
}

Reciprocity sampled_reciprocity(const StoredResponse& R, const Model& model) {
  const std::vector<int> sample = fixed_sample(model.degrees_of_freedom(), kSampledColumns);
  Reciprocity reciprocity;
  for (const int a : sample) reciprocity.remember(a, R.column(a, model.steps));
  return reciprocity;
}

Report check_dense(const std::filesystem::path& path, const CheckOptions& options,
                   const HandLoop& loop, const Console& console) {
  const Model model = read_description(hdf5::File::open(path));
  const auto R = stored_response(path, model.degrees_of_freedom(), model.steps);
  Report report{chunk_checksum_line(hdf5::File::open(path))};

  Reciprocity reciprocity = sampled_reciprocity(*R, model);
  const int nodes = model.mesh.surface_node_count();
  std::vector<NodeFindings> findings(static_cast<std::size_t>(nodes));
  Progress progress(console, "nodes (dense)", nodes);
  for (int first = 0; first < nodes; first += kNodesAtOnce) {
    std::vector<DrivingPoint> records(
        static_cast<std::size_t>(std::min(kNodesAtOnce, nodes - first)),
        DrivingPoint(9, model.steps));
    for (std::size_t i = 0; i < records.size(); ++i) {
      const int node = first + static_cast<int>(i);
      for (int axis = 0; axis < 3; ++axis) {
        const RowMatrix<double> column = R->column(3 * node + axis, model.steps);
        reciprocity.add(3 * node + axis, column);
        records[i].middleRows<3>(3 * axis) = column.middleCols<3>(3 * node).transpose();
      }
    }
    analyse(model, {loop, 1.0}, records, first, findings);
    progress.update(first + static_cast<int>(records.size()));
  }
  report.push_back(reciprocity_line(reciprocity));
  append(report, static_lines(model, *R));
  double left = 0.0;
  for (const NodeFindings& node : findings) {
    if (!(node.left <= left)) left = node.left;  // also what is not a number
  }
  report.push_back(decay_line(left, true));
  append(report, node_lines(findings, loop, options.coupling));
  report.push_back(wave_line(model, *R, model.dt, model.steps));
  return report;
}

Line compression_line(const CompressionError& error) {
  char text[160];
  std::snprintf(text, sizeof text,
                "%.3g %% of displacement and %.3g %% of force at most, measured on %d columns",
                100.0 * error.displacement, 100.0 * error.force, error.measured_columns);
  const bool kept = std::max(error.displacement, error.force) <= error.requested;
  return {"compression", kept ? Verdict::kOk : Verdict::kFail, text};
}

Report check_compressed(const std::filesystem::path& path, const CheckOptions& options,
                        const HandLoop& loop, const Console& console) {
  const Model model = read_model(path, ResponseKind::kCompressed, Checksum::kIgnore);
  const auto& response = std::get<CompressedResponse>(model.response);
  const auto R = stored_response(response, transposed_blas_product);
  Report report{compression_line(read_compression_error(hdf5::File::open(path)))};
  append(report, static_lines(model, *R));

  const RecordLength length = record_length(response);
  const int nodes = model.mesh.surface_node_count();
  std::vector<NodeFindings> findings(static_cast<std::size_t>(nodes));
  Progress progress(console, "nodes (compressed)", nodes);
  for (int first = 0; first < nodes; first += kNodesAtOnce) {
    const int count = std::min(kNodesAtOnce, nodes - first);
    analyse(model, {loop, length.radius}, R->driving_points(first, count, length.steps), first,
            findings);
    progress.update(first + count);
  }
  append(report, node_lines(findings, loop, options.coupling));
  report.push_back(wave_line(model, *R, model.dt, model.steps));
  return report;
}

// A response that cannot be read is a line of the table.
template <typename Check>
void run_part(Report& report, const std::string& name, const std::string& suffix,
              const Check& check) {
  try {
    append(report, check(), suffix);
  } catch (const Error& error) {
    report.push_back({name + suffix, Verdict::kFail, error.what()});
  }
}

}  // namespace

Report check_model(const std::filesystem::path& path, const CheckOptions& options,
                   const Console& console) {
  const hdf5::File file = hdf5::File::open(path);
  check_model_format(file);
  Report report;
  run_part(report, "checksum", "", [&] { return Report{checksum_line(file)}; });
  HandLoop loop{options.hand, 0.0, 1};
  Model model;
  run_part(report, "description", "", [&] {
    model = read_description(hdf5::File::open(path));
    loop.dt = model.dt;
    Report lines = surface_lines(model);
    append(lines, region_lines(model));
    return lines;
  });
  if (failed_lines(report).find("description") != std::string::npos) return report;
  if (is_rigid(model)) {
    report.push_back({"response", Verdict::kNone, "the body is rigid"});
    return report;
  }
  run_part(report, "elements", "", [&] { return Report{elements_line(model)}; });
  loop.delay = loop_delay(options.delay < 0.0 ? loop.dt : options.delay, loop.dt);
  const bool modal = file.exists("/response/modal");
  const bool dense = file.exists("/response/dense");
  const bool compressed = file.exists(kCompressedGroup);
  if (!modal && !dense && !compressed)
    report.push_back({"response", Verdict::kFail, "the file has none"});
  const bool both = modal && dense;
  if (compressed) {
    run_part(report, "compressed response", modal || dense ? " (compressed)" : "",
             [&] { return check_compressed(path, options, loop, console); });
  }
  if (modal) {
    run_part(report, "modes", both ? " (modal)" : "",
             [&] { return check_modes(path, options, loop, console); });
  }
  if (dense) {
    run_part(report, "dense response", both ? " (dense)" : "",
             [&] { return check_dense(path, options, loop, console); });
  }
  return report;
}

}  // namespace irdm::precompute
