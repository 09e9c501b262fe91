// Columns that come from a disk, or do not.
#include <atomic>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "common/model/model_file.hpp"
#include "scene/columns/column_store.hpp"
#include "simulation/engine/response_engine.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/left_out.hpp"
#include "tests/support/real_time_guard.hpp"
#include "tests/support/streamed_model.hpp"
#include "tests/support/synthetic_model.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

constexpr int kNodes = 20;
constexpr std::size_t kNumbers = 64;
constexpr std::size_t kSlotBytes = kNumbers * sizeof(int);

// Nodes on a line, 1 m apart; each one's columns say whose they are.
std::vector<Vector3> line_of_nodes() {
  std::vector<Vector3> places;
  for (int i = 0; i < kNodes; ++i) places.emplace_back(i, 0, 0);
  return places;
}

void write_number(int node, void* to) {
  for (std::size_t i = 0; i < kNumbers; ++i) {
    std::memcpy(static_cast<int*>(to) + i, &node, sizeof node);
  }
}

bool is_of(const void* columns, int node) {
  const auto* numbers = static_cast<const int*>(columns);
  return std::all_of(numbers, numbers + kNumbers, [node](int number) { return number == node; });
}

ColumnStore make_store(int slots, ColumnStore::Reader reader = write_number, bool waits = false) {
  return {line_of_nodes(), std::move(reader), {kSlotBytes, slots, waits}, "a file"};
}

std::vector<int> there(const ColumnStore& store) {
  std::vector<int> nodes;
  for (int i = 0; i < kNodes; ++i) {
    if (store.has(i)) nodes.push_back(i);
  }
  return nodes;
}

void expect_at(ColumnStore& store, double x) {
  const std::array<Vector3, 1> tip{Vector3(x, 0, 0)};
  store.prefetch(tip);
}

}  // namespace

TEST_CASE("a store with room for all reads all, and hands out what it read") {
  ColumnStore store = make_store(kNodes);
  CHECK(store.acquire(3) == nullptr);
  store.start();
  REQUIRE(eventually([&] { return store.loaded() == kNodes; }));
  for (int i = 0; i < kNodes; ++i) {
    const void* columns = store.acquire(i);
    REQUIRE(columns != nullptr);
    CHECK(is_of(columns, i));
    store.release(i);
  }
}

TEST_CASE(
    "what is near the tip is there, what has been taken stays, and never is there more than "
    "fits") {
  ColumnStore store = make_store(5);
  store.start();
  expect_at(store, 2.0);
  REQUIRE(eventually([&] { return there(store) == std::vector<int>{0, 1, 2, 3, 4}; }));
  REQUIRE(store.acquire(1) != nullptr);
  REQUIRE(store.acquire(2) != nullptr);
  expect_at(store, 15.1);
  REQUIRE(eventually([&] { return there(store) == std::vector<int>{1, 2, 14, 15, 16}; }));
  SECTION("given back, it makes room") {
    store.release(1);
    store.release(2);
    REQUIRE(eventually([&] { return there(store) == std::vector<int>{13, 14, 15, 16, 17}; }));
  }
  SECTION("what is asked for comes before what is near, and waits until it is taken") {
    const void* columns = nullptr;
    REQUIRE(eventually([&] { return (columns = store.acquire(9)) != nullptr; }));
    CHECK(is_of(columns, 9));
    CHECK(there(store).size() <= 5);
    CHECK(store.acquire(1) != nullptr);
    CHECK(store.acquire(2) != nullptr);
  }
}

TEST_CASE("columns that cannot be read are not there, and the others are") {
  ColumnStore store = make_store(kNodes, [](int node, void* to) {
    if (node == 7 || node == 8) throw std::runtime_error("the disk is broken");
    write_number(node, to);
  });
  store.start();
  REQUIRE(eventually([&] { return store.loaded() == kNodes - 2 && store.failed() == 2; }));
  CHECK(store.acquire(7) == nullptr);
  CHECK(store.acquire(6) != nullptr);
}

TEST_CASE("in lockstep taking waits for the disk, and each engine has its share") {
  ColumnStore store = make_store(
      6,
      [](int node, void* to) {
        std::this_thread::sleep_for(std::chrono::milliseconds(3));
        if (node == 4) throw std::runtime_error("the disk is broken");
        write_number(node, to);
      },
      true);
  CHECK(store.share() == 2);
  store.start();
  for (int i = 0; i < kNodes; ++i) {
    const void* columns = store.acquire(i);
    REQUIRE((columns != nullptr) == (i != 4));
    if (columns == nullptr) continue;
    CHECK(is_of(columns, i));
    store.release(i);
  }
  store.finish();
  CHECK(store.acquire(0) == (store.has(0) ? store.acquire(0) : nullptr));  // nobody waits any more
}

TEST_CASE("two threads take and give back while tips wander: each always has what it took") {
  ColumnStore store = make_store(8);
  store.start();
  std::atomic<bool> wrong{false};
  std::atomic<int> had{0};
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(kDeadlineMs);
  // However late the loader begins.
  const auto waits = [&] { return had == 0 && std::chrono::steady_clock::now() < deadline; };
  const auto use = [&](int seed) {
    for (int k = 0; k < 20000 || waits(); ++k) {
      const int node = (seed * 7 + k / 50) % kNodes;
      if (seed == 0 && k % 100 == 0) expect_at(store, node);
      const void* columns = store.acquire(node);
      if (columns == nullptr) continue;
      if (!is_of(columns, node)) wrong = true;
      ++had;
      store.release(node);
    }
  };
  std::thread other(use, 1);
  use(0);
  other.join();
  CHECK_FALSE(wrong);
  CHECK(had > 0);
}

TEST_CASE("taking, giving back and telling tips is real-time safe") {
  if (!AllocationGuard::active()) return leave_out(kNotCounted);
  ColumnStore store = make_store(5);
  store.start();
  REQUIRE(eventually([&] { return store.loaded() == 5; }));
  int had = 0;
  const RealTimeGuard guard;
  for (int k = 0; k < 2000; ++k) {
    const int node = k / 20 % kNodes;
    expect_at(store, node);
    if (store.acquire(node) == nullptr) continue;
    ++had;
    store.release(node);
  }
  const std::string violations = guard.violations();
  CHECK(violations.empty());
  CHECK(had > 0);
}

namespace {

constexpr std::size_t kMebibyte = 1 << 20;

// 98 nodes of 0.34 MB each.
std::filesystem::path write_cube(const TemporaryFolder& folder) {
  write_dense_model(with_dense_response<float>(synthetic_cube(4, 10, 100)), folder.path() / "R.h5");
  return folder.path() / "R.h5";
}

}  // namespace

TEST_CASE(
    "a model within its budget answers as the whole one does, and too small a one is refused") {
  const TemporaryFolder folder;
  const std::filesystem::path path = write_cube(folder);
  SceneColumns columns(true);
  CHECK_THROWS_WITH(
      columns.read(path, 2 * kMebibyte),
      ContainsSubstring("memory_budget of 2 MiB is too small") && ContainsSubstring("need 5 MiB"));
  const auto streamed = std::make_shared<const Model>(columns.read(path, 14 * kMebibyte));
  const auto whole = std::make_shared<const Model>(read_model(path, ResponseKind::kDense));
  columns.start(false);
  const auto engine = make_engine(streamed);
  const auto expected = make_engine(whole);
  Points u;
  Points expected_u;
  for (int k = 0; k < 400; ++k) {
    // Never more than 10 nodes within 100 steps.
    const std::array<NodalForce, 1> force{NodalForce{k / 12 % 98, Vector3(1, 0.1 * k, -1)}};
    engine->advance(force);
    expected->advance(force);
    if (k % 20 != 0) continue;
    engine->displacement(u);
    expected->displacement(expected_u);
    REQUIRE(u == expected_u);
  }
  CHECK(engine->capabilities().columns->cache_misses() == 0);
  CHECK(columns.loaded() >= 33);
  CHECK(columns.failed() == 0);
}

TEST_CASE(
    "a file that is cut off while it is in use is said once, and forces get the static answer") {
  const TemporaryFolder folder;
  const std::filesystem::path path = write_cube(folder);
  SceneColumns columns(true);
  const auto streamed = std::make_shared<const Model>(columns.read(path, 8 * kMebibyte));
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  columns.start(false);
  const auto engine = make_engine(streamed);
  for (int k = 0; k < 98; ++k) {
    const std::array<NodalForce, 1> force{NodalForce{97 - k, Vector3(1, 0, 0)}};
    engine->advance(force);
    CHECK(engine->free_displacement(97 - k).allFinite());
  }
  CHECK(columns.failed() > 0);
  CHECK(engine->capabilities().columns->cache_misses() > 0);
}
