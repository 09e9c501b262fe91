#include "tests/system/trace.hpp"

#include <algorithm>
#include <cstdlib>

#include "common/error.hpp"
#include "common/hdf5/file.hpp"

namespace irdm::test {
namespace {

// Before the library is used for the first time: the reader must not mind the writer's lock.
[[maybe_unused]] const int no_lock = ::setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);

}  // namespace

Vector3 Trace::vector(const std::string& set, std::size_t k) const {
  return Vector3(numbers.at(set).data() + 3 * k);
}

Quaternion Trace::orientation(std::size_t k) const {
  const double* wxyz = numbers.at("/step/body_orientation").data() + 4 * k;
  return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
}

Trace read_trace(const std::filesystem::path& path, int styluses) {
  const hdf5::File file = hdf5::File::open(path);
  Trace trace;
  trace.model_file = file.read_string_attribute("/", "model_file");
  trace.model_checksum = file.read_string_attribute("/", "model_checksum");
  trace.scene = file.read_string_attribute("/", "scene");
  trace.time = file.read<double>("/step/time", {0});
  const hsize_t rows = trace.time.size();
  const auto read_rows = [&]<typename T>(const std::string& set, hsize_t width, T) {
    if (file.shape(set)[0] != rows) {  // 0 rows stand for any number in read()
      throw Error(path.string(), set + " has another number of rows", "");
    }
    return file.read<T>(set, width == 1 ? hdf5::Shape{rows} : hdf5::Shape{rows, width});
  };
  trace.force_step = read_rows("/step/force_step", 1, std::uint64_t{});
  trace.numbers["/step/body_orientation"] = read_rows("/step/body_orientation", 4, double{});
  for (const char* set :
       {"/step/body_position", "/step/body_velocity", "/step/body_angular_velocity"}) {
    trace.numbers[set] = read_rows(set, 3, double{});
  }
  for (int s = 0; s < styluses; ++s) {
    for (const char* name : {"/tip", "/proxy", "/force", "/applied_force", "/contact_weights",
                             "/offset", "/arm_shift"}) {
      const std::string set = "/stylus/" + std::to_string(s) + name;
      trace.numbers[set] = read_rows(set, 3, double{});
    }
  }
  trace.reset = read_rows("/step/reset", 1, std::uint8_t{});
  trace.contact = read_rows("/stylus/0/contact", 1, std::uint8_t{});
  trace.slipping = read_rows("/stylus/0/slipping", 1, std::uint8_t{});
  trace.contact_nodes = read_rows("/stylus/0/contact_nodes", 3, std::int32_t{});
  trace.present = read_rows("/stylus/0/present", 1, std::uint8_t{});
  trace.buttons = read_rows("/stylus/0/buttons", 1, std::int32_t{});
  return trace;
}

std::size_t rows_so_far(const std::filesystem::path& path, const std::string& set, int value) {
  try {
    const auto values = hdf5::File::open(path).read<std::int32_t>("/stylus/0/" + set, {0});
    return static_cast<std::size_t>(std::count(values.begin(), values.end(), value));
  } catch (const Error&) {
    return 0;
  }
}

std::optional<Vector3> tip_so_far(const std::filesystem::path& path) {
  try {
    const auto tips = hdf5::File::open(path).read<double>("/stylus/0/tip", {0, 3});
    if (tips.size() < 3) return std::nullopt;
    return Vector3(tips.data() + tips.size() - 3);
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace irdm::test
