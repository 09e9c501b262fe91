#include "trace/trace_layout.hpp"

#include <array>
#include <string>
#include <utility>

#include "common/error.hpp"
#include "common/hdf5/file.hpp"

namespace irdm {

TraceHeader read_trace_header(const std::filesystem::path& path) {
  const hdf5::File file = hdf5::File::open(path);
  if (file.read_string_attribute("/", "format") != "irdm-trace") {
    throw Error(path.string(), "is not a trace", "give a file that irdm-server --record has made");
  }
  const std::int64_t version = file.read_integer_attribute("/", "version");
  if (version != trace::kVersion) {
    throw Error(path.string(),
                "is a trace of version " + std::to_string(version) + ", and only version " +
                    std::to_string(trace::kVersion) + " can be rerun" +
                    (version == 1 ? ": its step was of first order in time" : ""),
                "record it again");
  }
  TraceHeader header;
  header.scene = file.read_string_attribute("/", "scene");
  header.dt = trace::read_dt(file);
  header.stylus_count = 0;
  while (file.exists("/stylus/" + std::to_string(header.stylus_count))) ++header.stylus_count;
  for (int s = 0; s < header.stylus_count; ++s) {
    const std::string group = trace::stylus_path(static_cast<std::size_t>(s));
    if (file.exists(group + "/orientation")) header.tools.push_back(s);
  }
  header.bodies = file.exists(trace::kBodyContact);
  header.sleep = file.exists(trace::kAsleep);
  header.objects.push_back({"", file.read_string_attribute("/", "model_file"),
                            file.read_string_attribute("/", "model_checksum")});
  return header;
}

std::vector<TraceObject> read_trace_objects(const std::filesystem::path& path,
                                            const std::vector<std::string>& names) {
  const hdf5::File file = hdf5::File::open(path);
  std::vector<TraceObject> objects;
  for (const std::string& name : names) {
    const std::string group = names.size() > 1 ? trace::object_path(true, name) : "/";
    objects.push_back({name, file.read_string_attribute(group, "model_file"),
                       file.read_string_attribute(group, "model_checksum")});
  }
  return objects;
}

}  // namespace irdm

namespace irdm::trace {
namespace {

constexpr std::array<std::pair<const char*, const char*>, 28> kUnits{{
    {"time", "s"},
    {"body_position", "m"},
    {"body_orientation", "1"},
    {"body_velocity", "m/s"},
    {"body_angular_velocity", "rad/s"},
    {"body_angular_momentum", "kg m^2/s"},
    {"residual", "m"},
    {"tip", "m"},
    {"proxy", "m"},
    {"force", "N"},
    {"applied_force", "N"},
    {"contact_weights", "1"},
    {"arm_shift", "m"},
    {"offset", "m"},
    {"arm", "m"},
    {"share", "1"},
    {"gravity", "m/s^2"},
    {"friction", "1"},
    {"damping", "1/s"},
    {"tether", "N/m, N m/rad"},
    {"material_damping", "1"},
    {"weights", "1"},
    {"position", "m"},
    {"normal", "1"},
    {"slip", "m"},
    {"area", "m^2"},
    {"orientation", "1"},
    {"torque", "N m"},
}};

}  // namespace

std::string unit_of(const std::string& path) {
  const std::string name = path.substr(path.rfind('/') + 1);
  for (const auto& [known, unit] : kUnits) {
    if (name == known) return unit;
  }
  return "";
}

}  // namespace irdm::trace
