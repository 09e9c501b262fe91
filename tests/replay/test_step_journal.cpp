#include <fstream>

#include "common/error.hpp"
#include "replay/reference/step_journal.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::replay;

namespace {

using Numbers = std::vector<double>;

const std::vector<Numbers> kRecords{{1.0, -0.0, 1e-300}, {}, {2.0}, {3.0, 4.0}};

void keep_all(const std::filesystem::path& path, const std::string& key) {
  StepJournal journal(path, key);
  Numbers numbers;
  while (journal.take(numbers)) {
  }
  for (const Numbers& record : kRecords) journal.keep(record);
}

std::vector<Numbers> taken(StepJournal& journal) {
  std::vector<Numbers> all;
  for (Numbers numbers; journal.take(numbers);) all.push_back(numbers);
  return all;
}

}  // namespace

TEST_CASE("a journal gives back what was kept, in its order, and takes more") {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "steps";
  keep_all(path, "key");
  {
    StepJournal journal(path, "key");
    CHECK(taken(journal) == kRecords);
    CHECK(journal.taken() == kRecords.size());
    journal.keep({5.0});
  }
  StepJournal journal(path, "key");
  CHECK(taken(journal).back() == Numbers{5.0});
  journal.remove();
  CHECK_FALSE(std::filesystem::exists(path));
}

TEST_CASE("a journal of something else is given up") {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "steps";
  keep_all(path, "key");
  StepJournal journal(path, "kez");
  CHECK(taken(journal).empty());
  journal.keep({1.0});
  StepJournal again(path, "kez");
  CHECK(taken(again).size() == 1);
}

TEST_CASE("of a journal that was cut off or damaged, all up to there counts") {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "steps";
  keep_all(path, "key");
  const auto whole = std::filesystem::file_size(path);
  const std::size_t lost = GENERATE(1, 12, 27, 29, 30, 41, 60, 90, 200);
  CAPTURE(lost, whole);
  std::filesystem::resize_file(path, lost < whole ? whole - lost : 0);
  {
    StepJournal journal(path, "key");
    const std::vector<Numbers> before = taken(journal);
    REQUIRE(before.size() < kRecords.size());
    CHECK(std::equal(before.begin(), before.end(), kRecords.begin()));
    journal.keep({7.0});
  }
  StepJournal journal(path, "key");
  CHECK(taken(journal).back() == Numbers{7.0});
}

TEST_CASE("a journal with a wrong bit ends there") {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "steps";
  keep_all(path, "key");
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(-20, std::ios::end);
  file.put('\x55');
  file.close();
  StepJournal journal(path, "key");
  CHECK(taken(journal).size() == kRecords.size() - 1);
}

TEST_CASE("a journal that cannot be written says where") {
  const test::TemporaryFolder folder;
  CHECK_THROWS_WITH(StepJournal(folder.path() / "no" / "steps", "key"),
                    ContainsSubstring("steps: cannot be written"));
}
