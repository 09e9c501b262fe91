#include <unistd.h>

#include <fstream>
#include <string>

#include "common/process/temporary_files.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/child_process.hpp"

using namespace irdm;

namespace {

// Of a process that has ended.
std::string gone() {
  test::ChildProcess child({"/bin/true"});
  const std::string number = std::to_string(child.pid());
  child.wait();
  return number;
}

}  // namespace

TEST_CASE("what ended processes have left of a file is removed by the next that writes it") {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "model.h5";
  const auto make = [&](const std::string& name) {
    std::ofstream(folder.path() / name) << "x";
    return folder.path() / name;
  };
  test::ChildProcess living({"/bin/sleep", "1000"});
  const std::string own = std::to_string(::getpid());

  const auto left = make("model.h5.part-" + gone());
  const auto of_our_number = make("model.h5.part-" + own);  // of an earlier process
  const std::vector<std::filesystem::path> others{
      make("model.h5.part-" + std::to_string(living.pid())),
      make("other.h5.part-" + gone()),
      make("model.h5.part-" + gone() + "x"),
      make("model.h5.part-"),
      make("model.h5.part--" + gone()),
      make("model.h5.part"),
      make("model.h5"),
  };
  CHECK(fresh_part_name(path) == folder.path() / ("model.h5.part-" + own));
  CHECK_FALSE(std::filesystem::exists(left));
  CHECK_FALSE(std::filesystem::exists(of_our_number));
  for (const auto& other : others) {
    INFO(other);
    CHECK(std::filesystem::exists(other));
  }
}

TEST_CASE("a part of a file without a folder is named beside it, and a folder need not be there") {
  CHECK(fresh_part_name("model.h5") == "model.h5.part-" + std::to_string(::getpid()));
  CHECK(fresh_part_name("/no/such/model.h5") ==
        "/no/such/model.h5.part-" + std::to_string(::getpid()));
}
