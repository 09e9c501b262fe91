// Recordings that are begun and ended while a run goes on.
#include <fstream>

#include "common/error.hpp"
#include "server/viewer_session/recordings.hpp"
#include "tests/server/records.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

StepRecord step(std::size_t k, bool reset) {
  StepRecord record = test::record(k);
  record.reset = reset;
  return record;
}

}  // namespace

TEST_CASE("a recording holds the steps from the reset to its end, and the next one its own") {
  const TemporaryFolder folder;
  Recordings recordings(folder.path() / "new" / "folder", header(2));
  recordings.sink().put(step(0, true));  // nothing is recorded yet
  recordings.begin();
  CHECK(recordings.recording());
  for (std::size_t k = 1; k < 20; ++k) recordings.sink().put(step(k, k == 5));
  recordings.end();
  recordings.begin();
  for (std::size_t k = 20; k < 30; ++k) recordings.sink().put(step(k, k == 20));
  recordings.end();
  REQUIRE(recordings.complete().size() == 2);
  const auto steps = [&](std::size_t i) {
    return hdf5::File::open(recordings.complete()[i]).read<std::uint64_t>("/step/force_step", {0});
  };
  CHECK(steps(0).size() == 15);
  CHECK(steps(0).front() == 5);
  CHECK(steps(1).size() == 10);
  CHECK(steps(1).front() == 20);
}

TEST_CASE("a recording without a step leaves no file, and says so") {
  const TemporaryFolder folder;
  Recordings recordings(folder.path(), header(2));
  recordings.begin();
  CHECK_THROWS_WITH(recordings.end(), ContainsSubstring("no step"));
  CHECK(recordings.complete().empty());
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("what cannot be recorded is refused with the reason") {
  const TemporaryFolder folder;
  Recordings nowhere(std::nullopt, header(2));
  CHECK_FALSE(nowhere.possible());
  CHECK_THROWS_WITH(nowhere.begin(), ContainsSubstring("--recordings"));
  std::ofstream(folder.path() / "file") << "no folder";
  Recordings impossible(folder.path() / "file", header(2));
  CHECK_THROWS_AS(impossible.begin(), Error);
  CHECK_FALSE(impossible.recording());
  Recordings twice(folder.path(), header(2));
  twice.begin();
  CHECK_THROWS_WITH(twice.begin(), ContainsSubstring("already"));
}

TEST_CASE("a recording that fails is known to have failed before it is ended") {
  const TemporaryFolder folder;
  Recordings recordings(folder.path(), header(2));
  recordings.begin();
  CHECK_FALSE(recordings.failed());
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    std::filesystem::remove(entry.path());
  }
  CHECK(eventually([&] { return recordings.failed(); }));
  CHECK_THROWS_WITH(recordings.end(), ContainsSubstring("was removed while it was written"));
  CHECK_FALSE(recordings.recording());
}
