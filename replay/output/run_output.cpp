#include "replay/output/run_output.hpp"

#include <algorithm>

namespace irdm::replay {
namespace {

// Some 100 kB in a chunk.
hsize_t chunk_rows(const hdf5::Shape& row) {
  hsize_t numbers = 1;
  for (const hsize_t extent : row) numbers *= extent;
  return std::clamp<hsize_t>(12'500 / std::max<hsize_t>(numbers, 1), 1, 512);
}

}  // namespace

RunOutput::RunOutput(const std::filesystem::path& path, const TracedScene& scene,
                     const RunOrigin& origin)
    : part_(path), file_(hdf5::File::create(part_.part())), names_(scene.names()) {
  create(scene, origin);
}

void RunOutput::create_set(const std::string& path, const hdf5::Shape& row,
                           const std::string& unit) {
  file_.create_growing<double>(path, row, chunk_rows(row));
  file_.write_attribute(path, "unit", unit);
}

void RunOutput::create(const TracedScene& scene, const RunOrigin& origin) {
  file_.write_attribute("/", "format", std::string(run::kFormat));
  file_.write_attribute("/", "version", std::int64_t{run::kVersion});
  file_.write_attribute("/", "created_by", std::string("irdm ") + IRDM_VERSION);
  file_.write_attribute("/", "trace", origin.trace);
  file_.write_attribute("/", "from", origin.from);
  file_.write_attribute("/", "by", origin.by);
  file_.write_attribute("/", "objects", static_cast<std::int64_t>(names_.size()));
  file_.write_attribute("/", "styluses", static_cast<std::int64_t>(scene.config.styluses.size()));
  create_set("/time", {}, "s");
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const std::string group = run::object_path(i);
    const ModelMesh& mesh = scene.config.objects[i].model->mesh;
    const auto nodes = static_cast<hsize_t>(mesh.surface_node_count());
    create_set(group + "/position", {3}, "m");
    create_set(group + "/orientation", {4}, "1");
    create_set(group + "/displacement", {nodes, 3}, "m");
    Points rest(mesh.surface_node_count(), 3);
    for (int node = 0; node < mesh.surface_node_count(); ++node) {
      rest.row(node) = mesh.rest_position(node);
    }
    file_.write<double>(group + "/rest", {nodes, 3}, rest.data());
    file_.write_attribute(group + "/rest", "unit", std::string("m"));
    file_.write_attribute(group, "name", names_[i]);
    file_.write_attribute(group, "model_file", scene.objects[i].model.filename().string());
    file_.write_attribute(group, "model_checksum", scene.objects[i].checksum);
  }
  for (std::size_t s = 0; s < scene.config.styluses.size(); ++s) {
    create_set(run::stylus_path(s) + "/tip", {3}, "m");
    create_set(run::stylus_path(s) + "/force", {3}, "N");
  }
}

void RunOutput::put(const ReplayFrame& frame) {
  const StepRecord& record = frame.record;
  append("/time", &record.time);
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const std::string group = run::object_path(i);
    const ObjectRecord& object = record.object[i];
    const Quaternion& Q = object.orientation;
    const std::array<double, 4> wxyz{Q.w(), Q.x(), Q.y(), Q.z()};
    append(group + "/position", object.position.data());
    append(group + "/orientation", wxyz.data());
    append(group + "/displacement", frame.displacement[i].data());
  }
  for (std::size_t s = 0; s < static_cast<std::size_t>(record.stylus_count); ++s) {
    append(run::stylus_path(s) + "/tip", record.stylus[s].tip.data());
    append(run::stylus_path(s) + "/force", record.stylus[s].force.data());
  }
}

void RunOutput::finish() {
  file_.close();
  part_.finish();
}

}  // namespace irdm::replay
