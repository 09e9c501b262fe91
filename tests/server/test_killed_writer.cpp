#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "common/error.hpp"
#include "tests/server/committed_rows.hpp"
#include "tests/server/records.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/committed_so_far.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/temporary_folder.hpp"
#include "trace/trace_writer.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr std::size_t kRowsAtOnce = 512;
/// Chunks of a set are more then than one node of HDF5's older index has.
constexpr std::uint64_t kLongRun = 80 * kRowsAtOnce;

/// As fast as the disk takes it: chunks by the hundred, and what tells where they are with them.
[[noreturn]] void write_until_killed(const std::filesystem::path& path) {
  try {
    TraceWriter writer(path, header(1));
    std::vector<StepRecord> batch(kRowsAtOnce);
    for (std::uint64_t k = 0;; k += kRowsAtOnce) {
      for (std::size_t i = 0; i < kRowsAtOnce; ++i) batch[i] = record(k + i);
      writer.append(batch);
      writer.flush();
    }
  } catch (const Error&) {
    ::_exit(1);
  }
}

pid_t start_writer(const std::filesystem::path& path) {
  const pid_t writer = ::fork();
  if (writer == 0) write_until_killed(path);
  REQUIRE(writer > 0);
  return writer;
}

void check_killed_writers(int count) {
  const TemporaryFolder folder;
  std::minstd_rand random(1);
  for (int i = 0; i < count; ++i) {
    CAPTURE(i);
    const auto path = folder.path() / ("killed" + std::to_string(i) + ".h5");
    const pid_t writer = start_writer(path);
    const std::uint64_t begun = i % 5 == 4 ? kLongRun : 1;
    REQUIRE(eventually([&] { return committed_so_far(path) >= begun; }));
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 300'000));
    REQUIRE(::kill(writer, SIGKILL) == 0);
    int status = 0;
    REQUIRE(::waitpid(writer, &status, 0) == writer);
    REQUIRE(WIFSIGNALED(status));
    CHECK(check_committed(path) >= begun);
    std::filesystem::remove(path);
  }
}

}  // namespace

TEST_CASE("a trace whose writer is killed at any moment has every row that it says", "[slow]") {
  check_killed_writers(10);
}

TEST_CASE("a trace whose writer is killed, the same for fifty moments", "[exhaustive]") {
  check_killed_writers(50);
}
