#include "server/threads/recorder_thread.hpp"
#include "tests/server/records.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

TEST_CASE("after finish() a recording has every row, in order") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "trace.h5";
  constexpr std::size_t kRows = 20'000;  // more than its queue holds
  {
    StepSink sink(RecorderThread::kQueueCapacity, {1, 2});
    RecorderThread recorder(path, header(1), sink);
    recorder.start();
    for (std::size_t k = 0; k < kRows; ++k) {
      REQUIRE(eventually([&] { return sink.has_room(); }));
      sink.put(record(k));
    }
    recorder.finish();
    CHECK(recorder.rows() == kRows);
    CHECK(recorder.lost() == 0);
    CHECK(recorder.error().empty());
  }
  const hdf5::File file = hdf5::File::open(path);
  const auto steps = file.read<std::uint64_t>("/step/force_step", {kRows});
  for (std::size_t k = 0; k < kRows; ++k) REQUIRE(steps[k] == k);
}

TEST_CASE("a recorder that is not drained counts what does not fit") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "trace.h5";
  StepSink sink(RecorderThread::kQueueCapacity, {1, 2});
  RecorderThread recorder(path, header(1), sink);
  std::size_t taken = 0;
  for (; sink.has_room(); ++taken) sink.put(record(taken));
  for (std::size_t k = 0; k < 10; ++k) sink.put(record(taken + k));
  CHECK(recorder.lost() == 10);
  recorder.start();
  recorder.finish();
  CHECK(recorder.rows() == taken);
}

TEST_CASE("a full disk ends the recording with an error, and disturbs nobody") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "trace.h5";
  StepSink sink(RecorderThread::kQueueCapacity, {1, 2});
  RecorderThread recorder(path, header(1), sink);
  constexpr rlim_t kRoom = 200'000;
  const FileSizeLimit full(kRoom);
  SECTION("while it runs") {
    recorder.start();
    for (std::size_t k = 0; k < 20'000; ++k) {
      // What comes after the error is taken and dropped: the queue never stays full.
      REQUIRE(eventually([&] { return sink.has_room(); }));
      sink.put(record(k));
    }
  }
  SECTION("with its last rows") {
    for (std::size_t k = 0; k < 4000; ++k) sink.put(record(k));
    recorder.start();
  }
  recorder.finish();
  CHECK_THAT(recorder.error(),
             ContainsSubstring("trace.h5") && ContainsSubstring("check free space"));
  CHECK(recorder.lost() == 0);
}

TEST_CASE("a trace that is removed, cut off or replaced while it is written is noticed at once") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "in" / "trace.h5";
  std::filesystem::create_directory(folder.path() / "in");
  StepSink sink(RecorderThread::kQueueCapacity, {1, 2});
  RecorderThread recorder(path, header(1), sink);
  recorder.start();
  for (std::size_t k = 0; k < 600; ++k) {
    REQUIRE(eventually([&] { return sink.has_room(); }));
    sink.put(record(k));
  }
  REQUIRE(eventually([&] { return recorder.rows() == 600; }));
  CHECK_FALSE(recorder.failed());
  std::string message;
  SECTION("removed") {
    std::filesystem::remove(path);
    message = "trace.h5: was removed while it was written";
  }
  SECTION("its folder moved away") {
    std::filesystem::rename(folder.path() / "in", folder.path() / "out");
    message = "trace.h5: was removed while it was written";
  }
  SECTION("cut off") {
    std::filesystem::resize_file(path, 1000);
    message = "trace.h5: was cut off while it was written";
  }
  SECTION("replaced") {
    std::filesystem::copy_file(path, folder.path() / "copy.h5");
    std::filesystem::rename(folder.path() / "copy.h5", path);
    message = "trace.h5: was replaced by another file while it was written";
  }
  CHECK(eventually([&] { return recorder.failed(); }));  // without another step
  CHECK_THAT(recorder.error(), ContainsSubstring(message));
  recorder.finish();
}

TEST_CASE("a trace that cannot be begun leaves no file, and names the cause") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "trace.h5";
  const rlim_t room = GENERATE(0, 10, 3000);
  const FileSizeLimit full(room);
  CHECK_THROWS_WITH(TraceWriter(path, header(1)), ContainsSubstring("File too large"));
  CHECK_FALSE(std::filesystem::exists(path));
}
