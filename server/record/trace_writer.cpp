#include "server/record/trace_writer.hpp"

#include <vector>

#include "common/error.hpp"

namespace irdm {
namespace {

constexpr hsize_t kChunkRows = 512;

std::string stylus_path(std::size_t stylus) {
  return "/stylus/" + std::to_string(stylus);
}

void put(double* row, const Vector3& v) {
  Eigen::Map<Vector3>(row, 3) = v;
}

}  // namespace

TraceWriter::TraceWriter(const std::filesystem::path& path, const TraceHeader& header)
    : file_(hdf5::File::create(path)), stylus_count_(header.stylus_count) {
  try {
    write_header(header);
    create_datasets();
    file_.flush();
  } catch (const Error&) {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
    throw;
  }
}

void TraceWriter::write_header(const TraceHeader& header) {
  file_.write_attribute("/", "format", std::string("irdm-trace"));
  file_.write_attribute("/", "version", std::int64_t{1});
  file_.write_attribute("/", "created_by", std::string("irdm ") + IRDM_VERSION);
  file_.write_attribute("/", "model_file", header.model_file);
  file_.write_attribute("/", "model_checksum", header.model_checksum);
  file_.write_attribute("/", "scene", header.scene);
  file_.write_attribute("/", "dt", header.dt);
}

void TraceWriter::create_datasets() {
  file_.create_growing<double>("/step/time", {}, kChunkRows);
  file_.create_growing<std::uint64_t>("/step/force_step", {}, kChunkRows);
  file_.create_growing<double>("/step/body_position", {3}, kChunkRows);
  file_.create_growing<double>("/step/body_orientation", {4}, kChunkRows);
  file_.create_growing<double>("/step/body_velocity", {3}, kChunkRows);
  file_.create_growing<double>("/step/body_angular_velocity", {3}, kChunkRows);
  file_.create_growing<double>("/step/residual", {}, kChunkRows);
  for (std::size_t s = 0; s < static_cast<std::size_t>(stylus_count_); ++s) {
    const std::string path = stylus_path(s);
    for (const char* name : {"/tip", "/proxy", "/force", "/contact_weights", "/offset"}) {
      file_.create_growing<double>(path + name, {3}, kChunkRows);
    }
    file_.create_growing<std::uint8_t>(path + "/contact", {}, kChunkRows);
    file_.create_growing<std::int32_t>(path + "/contact_nodes", {3}, kChunkRows);
    file_.create_growing<std::int32_t>(path + "/buttons", {}, kChunkRows);
  }
}

template <typename T, typename Fill>
void TraceWriter::append_rows(const std::string& dataset, std::size_t width,
                              std::span<const StepRecord> records, const Fill& fill) {
  std::vector<T> values(records.size() * width);
  for (std::size_t k = 0; k < records.size(); ++k) fill(records[k], values.data() + k * width);
  file_.append<T>(dataset, records.size(), values.data());
}

void TraceWriter::append(std::span<const StepRecord> records) {
  if (records.empty()) return;
  append_rows<std::uint64_t>("/step/force_step", 1, records,
                             [](const StepRecord& r, std::uint64_t* row) { *row = r.force_step; });
  append_rows<double>("/step/time", 1, records,
                      [](const StepRecord& r, double* row) { *row = r.time; });
  append_rows<double>("/step/body_position", 3, records,
                      [](const StepRecord& r, double* row) { put(row, r.position); });
  append_rows<double>("/step/body_orientation", 4, records, [](const StepRecord& r, double* row) {
    row[0] = r.orientation.w();
    put(row + 1, r.orientation.vec());
  });
  append_rows<double>("/step/body_velocity", 3, records,
                      [](const StepRecord& r, double* row) { put(row, r.velocity); });
  append_rows<double>("/step/body_angular_velocity", 3, records,
                      [](const StepRecord& r, double* row) { put(row, r.angular_velocity); });
  append_rows<double>("/step/residual", 1, records,
                      [](const StepRecord& r, double* row) { *row = r.residual; });
  for (std::size_t s = 0; s < static_cast<std::size_t>(stylus_count_); ++s) {
    append_stylus(records, s);
  }
}

void TraceWriter::append_stylus(std::span<const StepRecord> records, std::size_t s) {
  const std::string path = stylus_path(s);
  const auto vectors = [&](const char* name, const auto& member) {
    append_rows<double>(path + name, 3, records,
                        [&](const StepRecord& r, double* row) { put(row, r.stylus[s].*member); });
  };
  vectors("/tip", &StylusRecord::tip);
  vectors("/proxy", &StylusRecord::proxy);
  vectors("/force", &StylusRecord::force);
  vectors("/offset", &StylusRecord::offset);
  append_rows<std::uint8_t>(path + "/contact", 1, records,
                            [&](const StepRecord& r, std::uint8_t* row) {
                              *row = static_cast<std::uint8_t>(r.stylus[s].contact);
                            });
  append_rows<double>(path + "/contact_weights", 3, records, [&](const StepRecord& r, double* row) {
    const bool free = r.stylus[s].contact == ContactState::kFree;
    for (std::size_t i = 0; i < 3; ++i) row[i] = free ? 0.0 : r.stylus[s].point.weights[i];
  });
  append_rows<std::int32_t>(path + "/contact_nodes", 3, records,
                            [&](const StepRecord& r, std::int32_t* row) {
                              const bool free = r.stylus[s].contact == ContactState::kFree;
                              for (std::size_t i = 0; i < 3; ++i)
                                row[i] = free ? -1 : r.stylus[s].point.nodes[i];
                            });
  append_rows<std::int32_t>(path + "/buttons", 1, records,
                            [&](const StepRecord& r, std::int32_t* row) {
                              *row = static_cast<std::int32_t>(r.stylus[s].buttons);
                            });
}

}  // namespace irdm
