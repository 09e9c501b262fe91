#include <sys/wait.h>
#include <unistd.h>

#include "common/error.hpp"
#include "tests/server/records.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/committed_so_far.hpp"
#include "tests/support/temporary_folder.hpp"
#include "trace/trace_writer.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr int kWritten = 0, kFailed = 1;

[[noreturn]] void write_one(const std::filesystem::path& path) {
  try {
    TraceWriter writer(path, header(1));
    writer.append(std::vector{record(0)});
    writer.close();
    ::_exit(kWritten);
  } catch (const Error&) {
    ::_exit(kFailed);
  }
}

}  // namespace

TEST_CASE("a trace is begun, however often one looks whether it is there", "[slow]") {
  const TemporaryFolder folder;
  for (int i = 0; i < 100; ++i) {
    CAPTURE(i);
    const auto path = folder.path() / ("watched" + std::to_string(i) + ".h5");
    const pid_t writer = ::fork();
    if (writer == 0) write_one(path);
    REQUIRE(writer > 0);
    int status = 0;
    while (::waitpid(writer, &status, WNOHANG) == 0) committed_so_far(path);
    REQUIRE(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == kWritten);
    CHECK(committed_so_far(path) == 1);
  }
}
