#include "replay/output/contact_output.hpp"

#include <string>

#include "common/error.hpp"
#include "replay/output/csv_row.hpp"

namespace irdm::replay {

ContactOutput::ContactOutput(const std::filesystem::path& path, const TracedScene& scene)
    : file_(path), stream_(file_.part(), std::ios::binary), objects_(plain_names(scene)) {
  for (const SceneryConfig& scenery : scene.config.scenery) {
    scenery_.push_back(plain_name(scenery.name));
  }
  for (std::size_t s = 1; s <= scene.config.styluses.size(); ++s) {
    scenery_.push_back("stylus " + std::to_string(s));
  }
  stream_ << "time_s,object,other,slipping" << vector_columns("position", "_m")
          << vector_columns("normal", "") << vector_columns("force", "_N")
          << vector_columns("slip", "_m") << ",area_m2,pressure_Pa\n";
}

const std::string& ContactOutput::name(int body) const {
  return body >= 0 ? objects_[static_cast<std::size_t>(body)]
                   : scenery_[static_cast<std::size_t>(-1 - body)];
}

void ContactOutput::put(const ReplayFrame& frame) {
  for (const BodyContactRecord& contact : frame.record.body_contacts()) {
    CsvRow row;
    row.add(frame.record.time);
    row.add_text(name(contact.object));
    row.add_text(name(contact.other));
    row.add(contact.slipping ? 1 : 0);
    row.add(contact.position);
    row.add(contact.normal);
    row.add(contact.force);
    row.add(contact.slip);
    row.add(contact.area);
    row.add(contact.force.dot(contact.normal) / contact.area);
    stream_ << row.text();
  }
}

void ContactOutput::finish() {
  stream_.close();
  if (!stream_) throw Error(file_.part().string(), "cannot be written", "make room on the disk");
  file_.finish();
}

}  // namespace irdm::replay
