#include "trace/trace_header.hpp"

#include <string>

#include "common/error.hpp"
#include "common/hdf5/file.hpp"
#include "trace/trace_paths.hpp"
#include "trace/trace_sets.hpp"

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
                    std::to_string(trace::kVersion) + " can be made again" +
                    (version == 1 ? ": its step was of first order in time" : ""),
                "record it again");
  }
  TraceHeader header;
  header.scene = file.read_string_attribute("/", "scene");
  header.dt = trace::read_dt(file);
  header.stylus_count = 0;
  while (file.exists("/stylus/" + std::to_string(header.stylus_count))) ++header.stylus_count;
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
