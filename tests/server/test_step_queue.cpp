// The way of steps from the force thread to the others.
#include <memory>
#include <thread>

#include "server/threads/step_queue.hpp"
#include "tests/server/records.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr StepShape kShape{2, 2, true, true};

// Two objects, late forces and contacts between bodies, all numbers different.
void fill(std::size_t k, StepRecord& record) {
  copy_step(test::record(k), record);
  record.object_count = 2;
  record.object[1] = record.object[0];
  record.object[1].position.x() += 1.0;
  record.object[1].contact[1] = ContactRecord{};
  record.reset_step = k / 2;
  record.settings.object[1].material_damping = 1.0 + static_cast<double>(k);
  record.late.count = k % 3;
  for (std::size_t i = 0; i < record.late.count; ++i)
    record.late.force[i].age = static_cast<int>(k);
  record.body_contact.resize(k % 5);
  for (std::size_t i = 0; i < k % 5; ++i) {
    record.body_contact[i].sample = static_cast<int>(10 * k + i);
    record.body_contact[i].force = Vector3(1.0, static_cast<double>(k), static_cast<double>(i));
  }
}

void check_same(const StepRecord& a, const StepRecord& b) {
  REQUIRE(a.force_step == b.force_step);
  REQUIRE(a.time == b.time);
  REQUIRE(a.reset == b.reset);
  REQUIRE(a.reset_step == b.reset_step);
  REQUIRE(a.settings == b.settings);
  REQUIRE(a.object_count == b.object_count);
  REQUIRE(a.stylus_count == b.stylus_count);
  for (std::size_t i = 0; i < 2; ++i) {
    REQUIRE(a.object[i].position == b.object[i].position);
    REQUIRE(a.object[i].sweeps == b.object[i].sweeps);
    REQUIRE(a.object[i].floor_count == b.object[i].floor_count);
    for (std::size_t c = 0; c < static_cast<std::size_t>(a.object[i].floor_count); ++c) {
      REQUIRE(a.object[i].floor[c].node == b.object[i].floor[c].node);
      REQUIRE(a.object[i].floor[c].force == b.object[i].floor[c].force);
    }
    for (std::size_t s = 0; s < 2; ++s) {
      const ContactRecord& one = a.object[i].contact[s];
      const ContactRecord& two = b.object[i].contact[s];
      REQUIRE(one.state == two.state);
      if (one.state == ContactState::kFree) continue;
      REQUIRE(one.point.nodes == two.point.nodes);
      REQUIRE(one.offset == two.offset);
    }
  }
  for (std::size_t s = 0; s < 2; ++s) {
    REQUIRE(a.stylus[s].buttons == b.stylus[s].buttons);
    REQUIRE(a.stylus[s].force == b.stylus[s].force);
  }
  REQUIRE(a.late.count == b.late.count);
  for (std::size_t i = 0; i < a.late.count; ++i) {
    REQUIRE(a.late.force[i].age == b.late.force[i].age);
  }
  REQUIRE(a.body_contact.size() == b.body_contact.size());
  for (std::size_t i = 0; i < a.body_contacts().size(); ++i) {
    REQUIRE(a.body_contact[i].sample == b.body_contact[i].sample);
    REQUIRE(a.body_contact[i].force == b.body_contact[i].force);
  }
}

}  // namespace

TEST_CASE("step queue: a step comes out as it went in, whatever was there before") {
  StepQueue queue(4, kShape);
  const auto in = std::make_unique<StepRecord>();
  const auto out = std::make_unique<StepRecord>();
  const auto copy = std::make_unique<StepRecord>();
  CHECK_FALSE(queue.pop(*out));
  for (std::size_t k = 0; k < 100; ++k) {
    fill(k, *in);
    REQUIRE(queue.push(*in));
    REQUIRE(queue.pop(*out));
    check_same(*in, *out);
    copy_step(*in, *copy);
    check_same(*in, *copy);
  }
  CHECK_FALSE(queue.pop(*out));
}

TEST_CASE("step queue: what does not fit is refused whole, and the rest comes in order") {
  StepQueue queue(4, kShape);
  const auto record = std::make_unique<StepRecord>();
  fill(1, *record);
  std::size_t taken = 0;
  for (; queue.push(*record); ++taken) record->force_step = taken + 2;
  CHECK(taken == 4);
  CHECK_FALSE(queue.has_room());
  for (std::size_t k = 0; k < taken; ++k) {
    REQUIRE(queue.pop(*record));
    CHECK(record->force_step == k + 1);
    CHECK(queue.has_room() == (k + 1 == taken));  // for any step, the largest as well
  }
  // The largest steps: more than usual, so that fewer fit.
  fill(1, *record);
  record->body_contact.resize(kMaxBodyContacts);
  REQUIRE(queue.has_room());
  REQUIRE(queue.push(*record));
  CHECK_FALSE(queue.has_room());
  CHECK_FALSE(queue.push(*record));
  record->body_contact.clear();
  record->object[0].floor_count = record->object[1].floor_count = 0;
  CHECK(queue.push(*record));
}

TEST_CASE("step queue: from one thread to another no step is lost or torn") {
  StepQueue queue(16, kShape);
  constexpr std::size_t kSteps = 20'000;
  std::thread producer([&] {
    const auto record = std::make_unique<StepRecord>();
    for (std::size_t k = 0; k < kSteps; ++k) {
      fill(k, *record);
      while (!queue.push(*record)) std::this_thread::yield();
    }
  });
  const auto expected = std::make_unique<StepRecord>();
  const auto record = std::make_unique<StepRecord>();
  bool same = true;
  for (std::size_t k = 0; k < kSteps; ++k) {
    while (!queue.pop(*record)) std::this_thread::yield();
    if (k % 100 == 0) {
      fill(k, *expected);
      check_same(*expected, *record);
    }
    same = same && record->force_step == k;
  }
  producer.join();
  CHECK(same);
}
