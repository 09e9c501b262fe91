// Recorded runs, read back and shown.

#include "common/error.hpp"
#include "server/viewer_session/player.hpp"
#include "tests/server/recorded_fall.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/sparse_dataset.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

/// Largest difference of two frames' displacements and positions [m].
double difference(const SurfaceFrame& a, const SurfaceFrame& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.objects.size(); ++i) {
    largest = std::max(
        {largest, (a.objects[i].displacement - b.objects[i].displacement).cwiseAbs().maxCoeff(),
         (a.objects[i].position - b.objects[i].position).norm()});
  }
  return largest;
}

/// Waits for a frame of this step.
const SurfaceFrame& shown(Player& player, std::uint64_t step) {
  REQUIRE(eventually([&] {
    player.surfaces().receive();
    return player.surfaces().front().force_step == step && player.surfaces().front().time > 0;
  }));
  return player.surfaces().front();
}

}  // namespace

TEST_CASE("a recording, read back, gives the surfaces of the run again") {
  const TemporaryFolder folder;
  const std::size_t objects = GENERATE(1, 2);
  const RecordedFall run(folder.path() / "trace.h5", objects);
  const Recording recording(folder.path() / "trace.h5", run.config, run.names);
  REQUIRE(recording.steps() == RecordedFall::kSteps);
  Deformation deformation(run.config);
  SurfaceFrame frame = rest_frame(run.config);
  StepRecord record;
  double largest = 0.0;
  bool touched = false;
  bool held = objects == 1;
  for (std::size_t k = 0; k < recording.steps(); ++k) {
    recording.step(k, record);
    deformation.follow(record);
    deformation.compute(frame);
    const SurfaceFrame& expected = run.frames[k];
    largest = std::max(largest, difference(frame, expected));
    for (std::size_t s = 0; s < 2; ++s) {
      REQUIRE(frame.styluses[s].present == expected.styluses[s].present);
      REQUIRE(frame.styluses[s].contact == expected.styluses[s].contact);
      REQUIRE(frame.styluses[s].object == expected.styluses[s].object);
      REQUIRE(frame.styluses[s].force == expected.styluses[s].force);
      const Vector3& place = expected.contacts[s].place;
      REQUIRE(
          (place.hasNaN() ? frame.contacts[s].place.hasNaN() : frame.contacts[s].place == place));
      touched = touched || frame.styluses[s].contact == ContactState::kTouching;
      held = held || frame.styluses[s].contact == ContactState::kHeld;
    }
  }
  CHECK(run.off_the_step == 0.0);
  CHECK(run.late > 10);
  CHECK(touched);
  CHECK(held);
  INFO("largest difference " << largest << " m");
  CHECK(largest < 1e-14);
}

TEST_CASE("a player shows the step of the time it is sent to, forwards and back") {
  const TemporaryFolder folder;
  const RecordedFall run(folder.path() / "trace.h5", 2);
  Player player(run.config, run.names, 60.0, 1);
  player.start();
  player.load(folder.path() / "trace.h5");
  player.pause();
  for (const std::uint64_t step : {100, 120, 30, 159, 0, 115}) {
    player.seek(0.002 * static_cast<double>(step + 1));
    CHECK(difference(shown(player, step), run.frames[step]) < 1e-14);
  }
  REQUIRE(eventually([&] {
    player.status().receive();
    return player.status().front().loads == 1;
  }));
  CHECK(player.status().front().length == Approx(0.32));
  CHECK_FALSE(player.status().front().playing);
  CHECK(player.status().front().error.empty());
}

TEST_CASE("a player plays to the end and stands still there, and begins anew from there") {
  const TemporaryFolder folder;
  const RecordedFall run(folder.path() / "trace.h5", 1);
  Player player(run.config, run.names, 60.0, 1);
  player.start();
  player.set_speed(10.0);
  player.load(folder.path() / "trace.h5");
  CHECK(difference(shown(player, 159), run.frames[159]) < 1e-14);
  const auto playing = [&] {
    player.status().receive();
    return player.status().front().playing;
  };
  CHECK(eventually([&] { return !playing(); }));
  player.set_speed(0.01);
  player.play();
  CHECK(eventually(playing));
  player.surfaces().receive();
  CHECK(player.surfaces().front().force_step < 100);
}

TEST_CASE("a player says why a file cannot be shown") {
  const TemporaryFolder folder;
  const RecordedFall run(folder.path() / "trace.h5", 1);
  Player player(run.config, run.names, 60.0, 1);
  player.start();
  player.load(folder.path() / "missing.h5");
  REQUIRE(eventually([&] {
    player.status().receive();
    return player.status().front().loads == 1;
  }));
  CHECK_THAT(player.status().front().error, ContainsSubstring("missing.h5"));
  CHECK(player.status().front().length == 0.0);
  player.load(folder.path() / "trace.h5");
  CHECK(difference(shown(player, 159), run.frames[159]) < 1e-14);
}

TEST_CASE("a recording of another model is refused") {
  const TemporaryFolder folder;
  RecordedFall run(folder.path() / "trace.h5", 1);
  run.config.objects[0].model = std::make_shared<const Model>(synthetic_cube(1, 5, 10));
  CHECK_THROWS_WITH(Recording(folder.path() / "trace.h5", run.config, run.names),
                    ContainsSubstring("does not have"));
}

TEST_CASE("a recording whose shapes cannot be meant is refused before there is room for it") {
  const TemporaryFolder folder;
  RecordedFall run(folder.path() / "trace.h5", 1);
  const auto replace = [&](const std::string& set, const std::vector<hsize_t>& shape) {
    make_sparse(folder.path() / "trace.h5", set, shape);
  };
  const auto read = [&] { Recording(folder.path() / "trace.h5", run.config, run.names); };
  SECTION("more steps than there is memory for") {
    replace("/step/time", {hsize_t{1} << 40});
    CHECK_THROWS_WITH(read(), ContainsSubstring("/step/time has shape") &&
                                  ContainsSubstring("but not the numbers"));
  }
  SECTION("more nodes of the floor's than there is memory for") {
    replace("/floor/node", {hsize_t{1} << 40});
    CHECK_THROWS_WITH(read(), ContainsSubstring("/floor/node has shape") &&
                                  ContainsSubstring("but not the numbers"));
  }
  SECTION("steps that are no list") {
    replace("/step/time", {4, 2});
    CHECK_THROWS_WITH(read(), ContainsSubstring("is no list"));
  }
}
