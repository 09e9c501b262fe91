#include <fstream>
#include <limits>
#include <stdexcept>

#include "precompute/columns/column_file.hpp"
#include "precompute/columns/compute_columns.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::precompute;

namespace {

// Ten columns in blocks of three: entry (b, s, a) is 100 b + 10 s + a. One block may fail.
class CountedColumns final : public ColumnSource {
 public:
  explicit CountedColumns(int failing_block = -1) : failing_block_(failing_block) {}
  int columns() const override { return 10; }
  int block_size() const override { return 3; }
  Columns block(int k) const override {
    if (k == failing_block_) throw std::runtime_error("block fails");
    const ColumnRange range = block_range(k);
    RowMatrix<float> values(range.count() * 2, 10);
    for (int row = 0; row < values.rows(); ++row) {
      for (int a = 0; a < 10; ++a) {
        values(row, a) = static_cast<float>(100 * (range.begin + row / 2) + 10 * (row % 2) + a);
      }
    }
    return values;
  }

 private:
  int failing_block_;
};

class Kept final : public ColumnStore {
 public:
  void put(int b, const float* values) override {
    columns.push_back(b);
    right = right && values[0] == 100.0F * static_cast<float>(b) &&
            values[19] == 100.0F * static_cast<float>(b) + 19.0F;
  }
  void put(int /*b*/, const double* /*values*/) override { right = false; }
  void flush() override { ++flushes; }

  std::vector<int> columns;
  bool right = true;
  int flushes = 0;
};

}  // namespace

TEST_CASE("a range of columns is A:B with 0 <= A < B") {
  CHECK(column_range_from_text("0:1") == ColumnRange{0, 1});
  CHECK(column_range_from_text("12:340") == ColumnRange{12, 340});
  for (const char* bad : {"", ":", "1", "1:", ":1", "2:2", "3:2", "-1:2", "1:2:3", "1:2 ", " 1:2",
                          "1.5:2", "99999999999:2"}) {
    CAPTURE(bad);
    CHECK_THROWS_WITH(column_range_from_text(bad), ContainsSubstring("is not A:B"));
  }
}

TEST_CASE("shares of a range follow one another, begin at whole blocks and differ by one block") {
  for (const ColumnRange& range : {ColumnRange{0, 54}, ColumnRange{5, 47}, ColumnRange{8, 9}}) {
    for (const int block : {1, 8}) {
      for (const int size : {1, 2, 5, 60}) {
        int next = range.begin;
        int fewest = range.count();
        int most = 0;
        for (int rank = 0; rank < size; ++rank) {
          const ColumnRange share = share_of(range, rank, size, block);
          CHECK(share.begin == next);
          CHECK(
              (share.begin % block == 0 || share.begin == range.begin || share.begin == range.end));
          next = share.end;
          fewest = std::min(fewest, share.count());
          most = std::max(most, share.count());
        }
        CHECK(next == range.end);
        CHECK(most - fewest <= 2 * block);
      }
    }
  }
}

TEST_CASE("columns are stored in order, those that are wanted, for any number of threads") {
  for (const int threads : {1, 2, 4}) {
    for (const ColumnRange& range : {ColumnRange{0, 10}, ColumnRange{4, 5}, ColumnRange{2, 10}}) {
      Kept kept;
      compute_columns(CountedColumns(), range, threads, kept);
      CHECK(kept.right);
      REQUIRE(static_cast<int>(kept.columns.size()) == range.count());
      for (int k = 0; k < range.count(); ++k) {
        CHECK(kept.columns[static_cast<std::size_t>(k)] == range.begin + k);
      }
    }
  }
}

TEST_CASE("a block that fails ends the work with its error, and what came before it is stored") {
  for (const int threads : {1, 3}) {
    Kept kept;
    CHECK_THROWS_WITH(compute_columns(CountedColumns(2), {0, 10}, threads, kept), "block fails");
    CHECK(kept.columns == std::vector<int>{0, 1, 2, 3, 4, 5});
    CHECK(kept.flushes == 2);
  }
}

TEST_CASE("a column file that claims more than it holds is refused, without room for it") {
  const irdm::test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "part.irdm-columns";
  const auto read = [&](const std::string& content) {
    std::ofstream(path, std::ios::binary) << content;
    ColumnFileReader reader(path);
  };
  ColumnFileHeader header;
  header.range = {0, 3};
  header.degrees_of_freedom = header.steps = std::numeric_limits<int>::max();
  header.precision = Precision::kDouble;
  CHECK_THROWS_WITH(read(encode_header(header)), ContainsSubstring("has only 0 of its 3 columns"));
  header.degrees_of_freedom = header.steps = 1 << 30;
  header.precision = Precision::kSingle;
  CHECK_THROWS_WITH(read(encode_header(header)), ContainsSubstring("has only 0 of its 3 columns"));
  std::string text = encode_header(header);
  text.replace(text.find("settings 0"), 10, "settings 1000000000");
  CHECK_THROWS_WITH(read(text), ContainsSubstring("is cut off"));
}
