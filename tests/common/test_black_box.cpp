#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "common/blackbox/black_box.hpp"
#include "common/blackbox/black_box_file.hpp"
#include "common/blackbox/frame_log.hpp"
#include "common/blackbox/row_log.hpp"
#include "common/error.hpp"
#include "common/realtime/clock.hpp"
#include "common/wire/frame.hpp"
#include "tests/support/captured_log.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/small_disk.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace irdm;
using namespace irdm::test;
using Catch::Matchers::ContainsSubstring;
using wire::TapKind;

namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

struct Row {
  std::int64_t time_ns = 0;
  int value = 0;
};

/// A row below zero is a fault.
class Numbers final : public RowLog<Row> {
 public:
  Numbers() : RowLog(16) {}
  void write(hdf5::File& file, std::int64_t origin_ns) const override {
    std::vector<const Row*> all;
    for (const Row& row : rows()) all.push_back(&row);
    ColumnGroup<Row> columns(file, "/number", all);
    columns.time("time", origin_ns, [](const Row& row) { return row.time_ns; });
    columns.number<std::int32_t>("value", "m", [](const Row& row) { return row.value; });
    file.write_attribute("/number", "lost", static_cast<std::int64_t>(lost()));
  }

 private:
  std::optional<Fault> look(const Row& row) override {
    if (row.value >= 0) return std::nullopt;
    return Fault{row.time_ns, "below zero", std::to_string(row.value)};
  }
};

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> found;
  if (!std::filesystem::exists(folder)) return found;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// A black box of 1 MB that does not fit there.
void check_no_room(const std::filesystem::path& folder) {
  const CapturedLog log;
  FrameLog frames;
  frames.see(TapKind::kReceived, 1, std::vector<std::uint8_t>(1 << 20, 1));
  BlackBox box({.folder = folder}, "program", {&frames});
  box.start();
  box.report("a fault", "");
  box.finish();
  CHECK(log.lines() == 1);
  CHECK_THAT(log.text(),
             ContainsSubstring("a fault: no black box: ") && ContainsSubstring("; check "));
  CHECK(files_in(folder).empty());
}

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

TEST_CASE("a black box is written when a part sees a fault, with what came before and after it") {
  const TemporaryFolder folder;
  Numbers numbers;
  BlackBox box({.folder = folder.path() / "made" / "here"}, "program", {&numbers});
  box.start();
  const std::int64_t now_ns = monotonic_ns();
  numbers.put({now_ns - 1'000'000, 1});
  numbers.put({now_ns, -7});
  numbers.put({now_ns + 1'000'000, 3});
  REQUIRE(eventually([&] { return files_in(folder.path() / "made" / "here").size() == 1; }));
  box.finish();
  const auto written = files_in(folder.path() / "made" / "here");
  REQUIRE(written.size() == 1);
  CHECK_THAT(written[0].filename().string(),
             Catch::Matchers::StartsWith("program-2") && ContainsSubstring("Z-"));
  CHECK(written[0].extension() == ".h5");
  const hdf5::File file = hdf5::File::open(written[0]);
  CHECK(file.read_string_attribute("/", "format") == "irdm-blackbox");
  CHECK(file.read_string_attribute("/", "fault") == "below zero");
  CHECK(file.read_string_attribute("/", "detail") == "-7");
  CHECK(file.read_integer_attribute("/", "fault_monotonic_ns") == now_ns);
  CHECK(file.read<std::int32_t>("/number/value", {3}) == std::vector<std::int32_t>{1, -7, 3});
  const std::vector<double> time = file.read<double>("/number/time", {3});
  CHECK(time[0] == Approx(-1e-3));
  CHECK(time[1] == 0.0);
  CHECK(time[2] == Approx(1e-3));
  CHECK(file.read_string_attribute("/number/time", "unit") == "s");
  CHECK(file.read_string_attribute("/number/value", "unit") == "m");
}

TEST_CASE("a black box is written at the end when a fault was seen just before it") {
  const TemporaryFolder folder;
  Numbers numbers;
  BlackBox box({.folder = folder.path()}, "program", {&numbers});
  box.start();
  numbers.put({monotonic_ns(), -1});
  box.finish();
  CHECK(files_in(folder.path()).size() == 1);
}

TEST_CASE("a black box: one file for a kind of fault in ten seconds, none without a fault") {
  const TemporaryFolder folder;
  Numbers numbers;
  BlackBox box({.folder = folder.path()}, "program", {&numbers});
  box.start();
  numbers.put({monotonic_ns(), 1});
  box.report("another kind", "");
  REQUIRE(eventually([&] { return files_in(folder.path()).size() == 1; }));
  box.report("another kind", "");
  numbers.put({monotonic_ns(), -1});
  numbers.put({monotonic_ns() + 10 * kSecondNs, -2});
  box.finish();
  const auto written = files_in(folder.path());
  CHECK(written.size() == 2);
}

TEST_CASE("a black box that cannot be written disturbs nobody") {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "file") << "in the way";
  Numbers numbers;
  BlackBox box({.folder = folder.path() / "file"}, "program", {&numbers});
  box.start();
  numbers.put({monotonic_ns(), -1});
  box.finish();
  CHECK(files_in(folder.path()).size() == 1);
  CHECK_THROWS_WITH(write_black_box(folder.path() / "file", 1, "program", {}, {}),
                    ContainsSubstring("black_box"));
}

TEST_CASE("a black box on a full disk: one line, and nothing is left of it") {
  const auto disk = small_disk("tmpfs", "size=64k");
  if (!disk) return;
  check_no_room(disk->path());
}

TEST_CASE("a black box beyond the limit of a file's size: one line, and nothing is left of it") {
  const TemporaryFolder folder;
  const FileSizeLimit limit(GENERATE(0, 700, 10'000, 500'000));
  check_no_room(folder.path());
}

// HDF5 cannot close such a file, and must not try again at the end: ctest sees how the process
// ends.
TEST_CASE("a process whose first file of HDF5 meets a full disk ends in order") {
  const TemporaryFolder folder;
  FrameLog frames;
  frames.see(TapKind::kReceived, 1, std::vector<std::uint8_t>(1 << 20, 1));
  frames.take();
  const FileSizeLimit limit(10'000);
  CHECK_THROWS_WITH(write_black_box(folder.path(), 1, "program", {}, {&frames}),
                    ContainsSubstring("check free space"));
  CHECK(files_in(folder.path()).empty());
}

TEST_CASE("black boxes: the oldest of the same program go, and nothing else does") {
  const TemporaryFolder folder;
  const auto touch = [&](const std::string& name) { std::ofstream(folder.path() / name) << name; };
  for (int i = 0; i < 5; ++i) touch("program-2001010" + std::to_string(i) + "T000000.000Z-1.h5");
  touch("program-notes.txt");
  touch("other-20010101T000000.000Z-1.h5");
  Numbers numbers;
  const auto newest =
      write_black_box(folder.path(), 3, "program", {monotonic_ns(), "fault", ""}, {&numbers});
  std::vector<std::string> names;
  for (const auto& path : files_in(folder.path())) names.push_back(path.filename().string());
  CHECK(names == std::vector<std::string>{"other-20010101T000000.000Z-1.h5",
                                          "program-20010103T000000.000Z-1.h5",
                                          "program-20010104T000000.000Z-1.h5",
                                          newest.filename().string(), "program-notes.txt"});
}

TEST_CASE("a part of a black box keeps two seconds, and counts what did not fit") {
  const TemporaryFolder folder;
  Numbers numbers;
  for (int i = 0; i < 20; ++i) numbers.put({i * kSecondNs / 4, i});
  CHECK_FALSE(numbers.take());
  numbers.forget(100 * kSecondNs);  // nothing has come for long: the last two seconds of it stay
  const auto path = write_black_box(folder.path(), 1, "program", {0, "fault", ""}, {&numbers});
  const hdf5::File file = hdf5::File::open(path);
  CHECK(file.read<std::int32_t>("/number/value", {0}) ==
        std::vector<std::int32_t>{7, 8, 9, 10, 11, 12, 13, 14, 15});
  CHECK(file.read_integer_attribute("/number", "lost") == 4);
}

TEST_CASE("every frame is kept with its bytes, and a violation is a fault") {
  const TemporaryFolder folder;
  FrameLog log;
  CHECK_FALSE(log.take());
  const wire::FrameBytes frame = wire::encode_frame(wire::Goodbye{}, 77, 5, 0);
  const std::uint32_t first = log.open("127.0.0.1:1");
  const std::uint32_t second = log.open("127.0.0.1:2");
  CHECK(first != second);
  log.see(TapKind::kSent, first, frame.view());
  CHECK_FALSE(log.take());
  log.see(TapKind::kSpoilt, second, bytes_of("garbage"));
  log.see(TapKind::kViolation, second, bytes_of("what it did"));
  const std::optional<Fault> fault = log.take();
  REQUIRE(fault);
  CHECK(fault->kind == "protocol violation");
  CHECK(fault->detail == "what it did");
  const auto path = write_black_box(folder.path(), 1, "program", *fault, {&log});
  const hdf5::File file = hdf5::File::open(path);
  CHECK(file.read<std::uint8_t>("/frame/kind", {0}) == std::vector<std::uint8_t>{3, 3, 1, 2, 4});
  CHECK(file.read<std::int32_t>("/frame/connection", {0}) ==
        std::vector<std::int32_t>{1, 2, 1, 2, 2});
  CHECK(file.read<std::int32_t>("/frame/type", {0}) == std::vector<std::int32_t>{0, 0, 4, 0, 0});
  CHECK(file.read<std::uint64_t>("/frame/session", {0})[2] == 77);
  CHECK(file.read<std::uint64_t>("/frame/sequence", {0})[2] == 5);
  const std::vector<std::int32_t> size = file.read<std::int32_t>("/frame/size", {5});
  const std::vector<std::uint8_t> bytes = file.read<std::uint8_t>("/frame/bytes", {0});
  const std::string text(bytes.begin(), bytes.end());
  CHECK(text.substr(0, 22) == "127.0.0.1:1127.0.0.1:2");
  CHECK(size[2] == static_cast<std::int32_t>(frame.size));
  CHECK(std::equal(frame.view().begin(), frame.view().end(), bytes.begin() + 22));
  CHECK(text.substr(22 + frame.size) == "garbagewhat it did");
}

TEST_CASE("frames beyond what is kept: the oldest go, those that do not fit are counted") {
  const TemporaryFolder folder;
  FrameLog log;
  const std::vector<std::uint8_t> large(1 << 20, 1);
  for (int i = 0; i < 40; ++i) {
    log.see(TapKind::kReceived, 1, large);
    log.take();
  }
  for (int i = 0; i < 6; ++i) log.see(TapKind::kSent, 2, large);  // nobody takes them meanwhile
  log.take();
  const auto path =
      write_black_box(folder.path(), 1, "program", {monotonic_ns(), "fault", ""}, {&log});
  const hdf5::File file = hdf5::File::open(path);
  CHECK(file.shape("/frame/bytes")[0] <= 16u << 20);
  CHECK(file.shape("/frame/bytes")[0] > 14u << 20);
  CHECK(file.read<std::uint8_t>("/frame/kind", {0}).back() == 1);
  CHECK(file.read_integer_attribute("/frame", "lost") == 3);
}

TEST_CASE("the keys of a black box") {
  const auto read = [](const std::string& text) {
    TomlTable table = TomlTable::parse_text(text, "file.toml");
    const BlackBoxSettings settings = read_black_box(table);
    table.finish();
    return settings;
  };
  CHECK(read("").folder == "blackbox");
  CHECK(read("").files == 16);
  CHECK(read("black_box = \"\"").folder.empty());
  CHECK(read("black_box = \"/some/where\"").folder == "/some/where");
  CHECK(read("black_box_files = 1").files == 1);
  CHECK_THROWS_AS(read("black_box_files = 0"), Error);
  CHECK_THROWS_AS(read("black_box_files = 1001"), Error);
  CHECK_THROWS_AS(read("black_box = 1"), Error);
}
