#include "replay/output/csv_output.hpp"

#include <charconv>

#include "common/error.hpp"
#include "replay/output/output_file.hpp"

namespace irdm::replay {
namespace {

/// One line of the table.
class Row {
 public:
  template <typename Number>
  void add(Number value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value);
    if (!line_.empty()) line_ += ',';
    line_.append(text, end.ptr);
  }
  void add(const Vector3& v) {
    for (const double value : v) add(value);
  }
  void add(const Quaternion& q) {
    add(q.w());
    add(Vector3(q.vec()));
  }
  std::string text() const { return line_ + "\n"; }

 private:
  std::string line_;
};

std::string vector_columns(const std::string& name, const std::string& unit) {
  std::string columns;
  for (const char* axis : {"_x", "_y", "_z"}) columns += "," + name + axis + unit;
  return columns;
}

std::string object_columns(const std::string& name) {
  std::string columns = vector_columns(name + "_position", "_m");
  for (const char* part : {"_w", "_x", "_y", "_z"}) columns += "," + name + "_orientation" + part;
  return columns + vector_columns(name + "_velocity", "_m_s") +
         vector_columns(name + "_angular_velocity", "_rad_s") +
         vector_columns(name + "_floor_force", "_N");
}

std::string stylus_columns(const std::string& name) {
  std::string columns;
  for (const char* word : {"_present", "_buttons", "_object", "_contact"}) {
    columns += "," + name + word;
  }
  return columns + vector_columns(name + "_tip", "_m") + vector_columns(name + "_proxy", "_m") +
         vector_columns(name + "_force", "_N");
}

void add_object(const ObjectRecord& object, Row& row) {
  row.add(object.position);
  row.add(object.orientation);
  row.add(object.velocity);
  row.add(object.angular_velocity);
  row.add(object.floor_force);
}

void add_stylus(const StylusRecord& stylus, Row& row) {
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
  Row row;
  row.add(record.time);
  row.add(record.force_step);
  row.add(record.reset ? 1 : 0);
  for (int i = 0; i < record.object_count; ++i) {
    add_object(record.object[static_cast<std::size_t>(i)], row);
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
