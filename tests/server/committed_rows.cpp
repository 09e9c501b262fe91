#include "tests/server/committed_rows.hpp"

#include "common/hdf5/file.hpp"
#include "tests/server/records.hpp"
#include "tests/support/catch.hpp"

namespace irdm::test {
namespace {

// The first rows of a set, as the file has them.
template <typename T>
std::vector<T> rows_of(const hdf5::File& file, const std::string& set, hsize_t rows,
                       hsize_t width) {
  const hdf5::Shape shape = width == 1 ? hdf5::Shape{rows} : hdf5::Shape{rows, width};
  std::vector<T> values(rows * width);
  if (rows > 0) file.read_slab<T>(set, hdf5::Shape(shape.size(), 0), shape, values.data());
  return values;
}

}  // namespace

std::size_t check_committed(const std::filesystem::path& path) {
  const hdf5::File file = hdf5::File::open(path);
  const hsize_t rows = file.read<std::uint64_t>("/committed", {1})[0];
  const auto steps = rows_of<std::uint64_t>(file, "/step/force_step", rows, 1);
  const auto time = rows_of<double>(file, "/step/time", rows, 1);
  const auto position = rows_of<double>(file, "/step/body_position", rows, 3);
  const auto tip = rows_of<double>(file, "/stylus/0/tip", rows, 3);
  const auto force = rows_of<double>(file, "/stylus/0/force", rows, 3);
  const auto state = rows_of<std::uint8_t>(file, "/stylus/0/contact", rows, 1);
  const auto buttons = rows_of<std::int32_t>(file, "/stylus/0/buttons", rows, 1);
  const auto vector = [](const std::vector<double>& values, std::size_t k) {
    return Vector3(values[3 * k], values[3 * k + 1], values[3 * k + 2]);
  };
  for (std::size_t k = 0; k < rows; ++k) {
    const StepRecord wanted = record(k);
    const StylusRecord& stylus = wanted.stylus[0];
    CAPTURE(k, rows);
    REQUIRE(steps[k] == k);
    REQUIRE(time[k] == wanted.time);
    REQUIRE(vector(position, k) == wanted.object[0].position);
    REQUIRE(vector(tip, k) == stylus.tip);
    REQUIRE(vector(force, k) == stylus.force);
    REQUIRE(state[k] == static_cast<std::uint8_t>(wanted.object[0].contact[0].state));
    REQUIRE(buttons[k] == static_cast<std::int32_t>(stylus.buttons));
  }
  return rows;
}

}  // namespace irdm::test
