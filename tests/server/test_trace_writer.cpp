#include <array>

#include "common/error.hpp"
#include "tests/server/records.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"
#include "trace/trace_writer.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

/// Class (H5T_FLOAT, H5T_INTEGER), bytes and signedness of a dataset's numbers in the file.
struct NumberType {
  H5T_class_t kind;
  std::size_t bytes;
  bool is_signed;
  bool operator==(const NumberType&) const = default;
};

NumberType type_of(const hdf5::File& file, const std::string& set) {
  const hdf5::Handle dataset(H5Dopen2(file.id(), set.c_str(), H5P_DEFAULT), H5Dclose);
  REQUIRE(dataset.get() >= 0);
  const hdf5::Handle type(H5Dget_type(dataset.get()), H5Tclose);
  const H5T_class_t kind = H5Tget_class(type.get());
  return {kind, H5Tget_size(type.get()),
          kind != H5T_INTEGER || H5Tget_sign(type.get()) == H5T_SGN_2};
}

const NumberType kF64{H5T_FLOAT, 8, true};
const NumberType kF32{H5T_FLOAT, 4, true};
const NumberType kU64{H5T_INTEGER, 8, false};
const NumberType kI32{H5T_INTEGER, 4, true};
const NumberType kU8{H5T_INTEGER, 1, false};

}  // namespace

TEST_CASE("a trace has every set of the contract, in its shape and type, for each stylus") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "trace.h5";
  constexpr std::size_t kRows = 1100;  // more than two chunks
  {
    TraceWriter writer(path, header(2));
    std::vector<StepRecord> records;
    for (std::size_t k = 0; k < kRows; ++k) records.push_back(record(k));
    const std::span<const StepRecord> all(records);
    writer.append(all.first(1));
    writer.append({});
    writer.append(all.subspan(1));
    writer.close();
  }
  const hdf5::File file = hdf5::File::open(path);
  CHECK(file.read_string_attribute("/", "format") == "irdm-trace");
  CHECK(file.read_integer_attribute("/", "version") == 2);
  CHECK(file.read_string_attribute("/", "created_by") == "irdm " IRDM_VERSION);
  CHECK(file.read_string_attribute("/", "model_file") == "cube.h5");
  CHECK(file.read_string_attribute("/", "model_checksum") == "c0ffee");
  CHECK(file.read_string_attribute("/", "scene") == "[[object]]\n");
  CHECK(file.read_double_attribute("/", "dt") == 0.002);

  const auto check = [&](const std::string& set, hsize_t width, const NumberType& type) {
    CAPTURE(set);
    CHECK(file.shape(set) == (width == 1 ? hdf5::Shape{kRows} : hdf5::Shape{kRows, width}));
    CHECK(type_of(file, set) == type);
  };
  check("/step/time", 1, kF64);
  check("/step/force_step", 1, kU64);
  check("/step/reset", 1, kU8);
  check("/step/residual", 1, kF64);
  check("/step/sweeps", 1, kI32);
  check("/step/body_position", 3, kF64);
  check("/step/body_orientation", 4, kF64);
  check("/step/body_velocity", 3, kF64);
  check("/step/body_angular_velocity", 3, kF64);
  for (const std::string stylus : {"/stylus/0/", "/stylus/1/"}) {
    check(stylus + "tip", 3, kF64);
    check(stylus + "proxy", 3, kF64);
    check(stylus + "force", 3, kF64);
    check(stylus + "applied_force", 3, kF64);
    check(stylus + "contact", 1, kU8);
    check(stylus + "contact_nodes", 3, kI32);
    check(stylus + "contact_weights", 3, kF64);
    check(stylus + "offset", 3, kF64);
    check(stylus + "slipping", 1, kU8);
    check(stylus + "present", 1, kU8);
    check(stylus + "buttons", 1, kI32);
  }
  CHECK_FALSE(file.exists("/floor"));  // there is none
  CHECK_FALSE(file.exists("/stylus/2"));
}

TEST_CASE("a trace gives back every number of every row") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "trace.h5";
  constexpr std::size_t kRows = 7;
  {
    TraceWriter writer(path, header(2));
    std::vector<StepRecord> records;
    for (std::size_t k = 0; k < kRows; ++k) records.push_back(record(k));
    writer.append(records);
    writer.close();
  }
  const hdf5::File file = hdf5::File::open(path);
  const auto vector = [&](const std::string& set, std::size_t k) {
    return Vector3(file.read<double>(set, {kRows, 3}).data() + 3 * k);
  };
  for (std::size_t k = 0; k < kRows; ++k) {
    const StepRecord r = record(k);
    CHECK(file.read<double>("/step/time", {kRows})[k] == r.time);
    CHECK(file.read<std::uint64_t>("/step/force_step", {kRows})[k] == r.force_step);
    CHECK(file.read<double>("/step/residual", {kRows})[k] == r.object[0].residual);
    CHECK(file.read<std::uint8_t>("/step/reset", {kRows})[k] == (r.reset ? 1 : 0));
    CHECK(file.read<std::int32_t>("/step/sweeps", {kRows})[k] == r.object[0].sweeps);
    CHECK(vector("/step/body_position", k) == r.object[0].position);
    CHECK(vector("/step/body_velocity", k) == r.object[0].velocity);
    CHECK(vector("/step/body_angular_velocity", k) == r.object[0].angular_velocity);
    const auto wxyz = file.read<double>("/step/body_orientation", {kRows, 4});
    CHECK(Quaternion(wxyz[4 * k], wxyz[4 * k + 1], wxyz[4 * k + 2], wxyz[4 * k + 3]).coeffs() ==
          r.object[0].orientation.coeffs());
    for (std::size_t s = 0; s < 2; ++s) {
      const StylusRecord& stylus = r.stylus[s];
      const ContactRecord& contact = r.object[0].contact[s];
      const bool free = stylus.contact == ContactState::kFree;
      const std::string path_in_file = "/stylus/" + std::to_string(s) + "/";
      CHECK(vector(path_in_file + "tip", k) == stylus.tip);
      CHECK(vector(path_in_file + "proxy", k) == stylus.proxy);
      CHECK(vector(path_in_file + "force", k) == stylus.force);
      CHECK(vector(path_in_file + "offset", k) == (free ? Vector3(0, 0, 0) : contact.offset));
      CHECK(file.read<std::uint8_t>(path_in_file + "contact", {kRows})[k] ==
            static_cast<std::uint8_t>(stylus.contact));
      CHECK(file.read<std::uint8_t>(path_in_file + "present", {kRows})[k] ==
            (stylus.present ? 1 : 0));
      CHECK(file.read<std::int32_t>(path_in_file + "buttons", {kRows})[k] ==
            static_cast<std::int32_t>(stylus.buttons));
      const auto nodes = file.read<std::int32_t>(path_in_file + "contact_nodes", {kRows, 3});
      for (std::size_t i = 0; i < 3; ++i) {
        CHECK(nodes[3 * k + i] == (free ? -1 : contact.point.nodes[i]));
        CHECK(vector(path_in_file + "contact_weights", k)[static_cast<Eigen::Index>(i)] ==
              (free ? 0.0 : contact.point.weights[i]));
      }
    }
  }
}

TEST_CASE("a trace has the floor's forces of every step, one after the other, for each object",
          "[slow]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "trace.h5";
  const bool several = GENERATE(false, true);
  constexpr std::size_t kRows = 1100;
  TraceHeader with_floor = header(1);
  with_floor.floor = true;
  if (several) with_floor.objects.push_back({"other", "other.h5", "bad"});
  {
    TraceWriter writer(path, with_floor);
    std::vector<StepRecord> records;
    for (std::size_t k = 0; k < kRows; ++k) {
      records.push_back(record(k));
      records.back().object[1] = record(k + 1).object[0];
    }
    const std::span<const StepRecord> all(records);
    writer.append(all.first(1));  // without a contact
    writer.append(all.subspan(1, 600));
    writer.append(all.subspan(601));
    writer.close();
  }
  const hdf5::File file = hdf5::File::open(path);
  for (std::size_t i = 0; i < (several ? 2 : 1); ++i) {
    const std::string floor = !several ? "/floor"
                              : i == 0 ? "/object/cube/floor"
                                       : "/object/other/floor";
    CAPTURE(floor);
    const auto count = file.read<std::int32_t>(floor + "/count", {kRows});
    const auto node = file.read<std::int32_t>(floor + "/node", {0});
    const auto force = file.read<float>(floor + "/force", {node.size(), 3});
    CHECK(type_of(file, floor + "/count") == kI32);
    CHECK(type_of(file, floor + "/node") == kI32);
    CHECK(type_of(file, floor + "/force") == kF32);
    std::size_t row = 0;
    for (std::size_t k = 0; k < kRows; ++k) {
      const ObjectRecord expected = record(k + i).object[0];
      REQUIRE(count[k] == expected.floor_count);
      for (std::size_t c = 0; c < static_cast<std::size_t>(count[k]); ++c, ++row) {
        REQUIRE(node[row] == expected.floor[c].node);
        REQUIRE(Eigen::Vector3f(force.data() + 3 * row) == expected.floor[c].force);
      }
    }
    CHECK(row == node.size());
  }
}

TEST_CASE("a trace is read while it is written") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "trace.h5";
  TraceWriter writer(path, header(1));
  for (std::size_t rows = 0; rows < 5; ++rows) {
    const hdf5::File file = hdf5::File::open(path);
    CHECK(file.read<std::uint64_t>("/committed", {1})[0] == rows);
    CHECK(file.shape("/step/time") == hdf5::Shape{rows});
    const std::array<StepRecord, 1> one{record(rows)};
    writer.append(one);
    writer.flush();
  }
}

TEST_CASE("a trace without steps is complete, with no rows") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "trace.h5";
  TraceWriter(path, header(1)).close();
  const hdf5::File file = hdf5::File::open(path);
  CHECK(file.shape("/step/time") == hdf5::Shape{0});
  CHECK(file.shape("/stylus/0/tip") == hdf5::Shape{0, 3});
}

TEST_CASE("a trace that exists is not written over, one that cannot be begun leaves nothing") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "trace.h5";
  TraceWriter(path, header(1)).close();
  const auto size = std::filesystem::file_size(path);
  CHECK_THROWS_WITH(TraceWriter(path, header(1)), ContainsSubstring("trace.h5: exists already"));
  CHECK(std::filesystem::file_size(path) == size);
  CHECK_THROWS_AS(TraceWriter(folder.path() / "no" / "trace.h5", header(1)), Error);
  TraceHeader twins = header(1);
  twins.objects.push_back(twins.objects.front());  // of one name
  CHECK_THROWS_AS(TraceWriter(folder.path() / "twins.h5", twins), Error);
  CHECK_FALSE(std::filesystem::exists(folder.path() / "twins.h5"));
}

TEST_CASE("a trace keeps a scene of any length") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "trace.h5";
  TraceHeader long_scene = header(1);
  long_scene.scene = std::string(100'000, '#');  // beyond an attribute of HDF5's older format
  TraceWriter(path, long_scene).close();
  CHECK(hdf5::File::open(path).read_string_attribute("/", "scene") == long_scene.scene);
}
