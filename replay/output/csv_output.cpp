#include "replay/output/csv_output.hpp"

#include "common/error.hpp"
#include "replay/output/csv_row.hpp"
#include "replay/output/output_file.hpp"

namespace irdm::replay {
namespace {

std::string object_columns(const std::string& name) {
  std::string columns = vector_columns(name + "_position", "_m");
  for (const char* part : {"_w", "_x", "_y", "_z"}) columns += "," + name + "_orientation" + part;
  return columns + vector_columns(name + "_velocity", "_m_s") +
         vector_columns(name + "_angular_velocity", "_rad_s") +
         vector_columns(name + "_floor_force", "_N") + vector_columns(name + "_body_force", "_N") +
         "," + name + "_body_contacts";
}

std::string stylus_columns(const std::string& name) {
  std::string columns;
  for (const char* word : {"_present", "_buttons", "_object", "_contact"}) {
    columns += "," + name + word;
  }
  return columns + vector_columns(name + "_tip", "_m") + vector_columns(name + "_proxy", "_m") +
         vector_columns(name + "_force", "_N");
}

void add_object(const ObjectRecord& object, CsvRow& row) {
  row.add(object.position);
  row.add(object.orientation);
  row.add(object.velocity);
  row.add(object.angular_velocity);
  row.add(object.floor_force);
}

// What other objects and scenery did to object i: the sum of the forces [N], W, and their number.
void add_body_contacts(const StepRecord& record, int i, CsvRow& row) {
  Vector3 sum = Vector3::Zero();
  int count = 0;
  for (const BodyContactRecord& contact : record.body_contacts()) {
    if (contact.object != i && contact.other != i) continue;
    if (contact.object == i) sum += contact.force;
    if (contact.other == i) sum -= contact.force;
    ++count;
  }
  row.add(sum);
  row.add(count);
}

void add_stylus(const StylusRecord& stylus, CsvRow& row) {
  row.add(stylus.present ? 1 : 0);
  row.add(stylus.buttons);
  row.add(stylus.object);
  row.add(static_cast<int>(stylus.contact));
  row.add(stylus.tip);
  row.add(stylus.proxy);
  row.add(stylus.force);
}

}  // namespace

CsvOutput::CsvOutput(const std::filesystem::path& path, const TracedScene& scene)
    : file_(path), stream_(file_.part(), std::ios::binary) {
  stream_ << "time_s,force_step,reset";
  for (const std::string& name : plain_names(scene)) stream_ << object_columns(name);
  for (std::size_t s = 0; s < scene.config.styluses.size(); ++s) {
    stream_ << stylus_columns("stylus" + std::to_string(s));
  }
  stream_ << '\n';
}

void CsvOutput::put(const ReplayFrame& frame) {
  const StepRecord& record = frame.record;
  CsvRow row;
  row.add(record.time);
  row.add(record.force_step);
  row.add(record.reset ? 1 : 0);
  for (int i = 0; i < record.object_count; ++i) {
    add_object(record.object[static_cast<std::size_t>(i)], row);
    add_body_contacts(record, i, row);
  }
  for (int s = 0; s < record.stylus_count; ++s) {
    add_stylus(record.stylus[static_cast<std::size_t>(s)], row);
  }
  stream_ << row.text();
}

void CsvOutput::finish() {
  stream_.close();
  if (!stream_) throw Error(file_.part().string(), "cannot be written", "make room on the disk");
  file_.finish();
}

}  // namespace irdm::replay
