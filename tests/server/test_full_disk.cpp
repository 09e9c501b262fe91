#include "common/error.hpp"
#include "server/threads/recorder_thread.hpp"
#include "tests/server/committed_rows.hpp"
#include "tests/server/records.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/small_disk.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

constexpr std::size_t kBatch = 512;

/// Records that many steps; what did not fit is taken all the same: the queue never stays full.
std::string record_steps(const std::filesystem::path& path, std::size_t steps) {
  StepSink sink(RecorderThread::kQueueCapacity, {1, 2});
  RecorderThread recorder(path, header(1), sink);
  recorder.start();
  for (std::size_t k = 0; k < steps; ++k) {
    REQUIRE(eventually([&] { return sink.has_room(); }));
    sink.put(record(k));
  }
  recorder.finish();
  CHECK(recorder.lost() == 0);
  return recorder.error();
}

void check_error(const std::string& error, const std::string& why) {
  CHECK_THAT(error, ContainsSubstring("trace.h5: cannot grow: " + why) &&
                        ContainsSubstring("check free space"));
  CHECK(error.find('\n') == std::string::npos);
}

void check_limited(const std::filesystem::path& path, rlim_t limit) {
  CAPTURE(limit);
  {
    const FileSizeLimit limited(limit);
    check_error(record_steps(path, 20'000), "File too large");
  }
  CHECK(check_committed(path) > 0);
  CHECK(std::filesystem::file_size(path) <= limit);
}

}  // namespace

TEST_CASE("a recording whose disk gets full can be read up to its last committed row",
          "[unsanitized]") {
  const std::string size = GENERATE(as<std::string>(), "340k", "1m", "2m");
  CAPTURE(size);
  const auto disk = small_disk("tmpfs", "size=" + size);
  if (!disk) return;
  check_error(record_steps(disk->path() / "trace.h5", 20'000), "No space left on device");
  CHECK(check_committed(disk->path() / "trace.h5") > 0);
}

TEST_CASE("a recording beyond the limit of a file can be read up to its last committed row",
          "[slow]") {
  const rlim_t limit = GENERATE(320'000, 437'211, 1'000'000, 1'500'007);
  const TemporaryFolder folder;
  check_limited(folder.path() / "trace.h5", limit);
}

TEST_CASE("the same on a file system that keeps no room free on request", "[slow]") {
  const rlim_t limit = GENERATE(320'000, 437'211, 1'000'000, 1'500'007);
  const auto disk = small_disk("ramfs");
  if (!disk) return;
  check_limited(disk->path() / "trace.h5", limit);
}

// HDF5 then splits the index of every set in place: a disk that is full in the middle of that would
// cost all of its rows.
TEST_CASE("a recording whose index is being split when the disk gets full keeps its rows",
          "[slow]") {
  const rlim_t limit = GENERATE(10'640'000, 10'690'000, 10'740'000, 10'790'000);
  constexpr std::size_t kBatches = 66;  // the 65th is the first for which the index is too small
  CAPTURE(limit);
  const TemporaryFolder folder;
  const auto path = folder.path() / "trace.h5";
  bool full = false;
  {
    TraceWriter writer(path, header(1));
    const FileSizeLimit limited(limit);
    std::vector<StepRecord> records(kBatch);
    try {
      for (std::size_t first = 0; first < kBatches * kBatch; first += kBatch) {
        for (std::size_t k = 0; k < kBatch; ++k) records[k] = record(first + k);
        writer.append(records);
        writer.flush();
      }
    } catch (const Error&) {
      full = true;
    }
    writer.close();
  }
  CHECK(full);
  CHECK(check_committed(path) >= 63 * kBatch);
}

TEST_CASE("a recording that ends in order takes no more room than it needs") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "trace.h5";
  CHECK(record_steps(path, 100) == "");
  CHECK(check_committed(path) == 100);
  const hdf5::File file = hdf5::File::open(path);
  haddr_t end = 0;
  REQUIRE(H5Fget_eoa(file.id(), &end) >= 0);
  CHECK(std::filesystem::file_size(path) == end);
}
