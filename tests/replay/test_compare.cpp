// Differences of two runs that are known.
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/error.hpp"
#include "replay/compare/comparison_output.hpp"
#include "replay/output/run_output.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/synthetic_model.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::replay;
using namespace irdm::test;

namespace {

constexpr int kNode = 5;

TracedScene one_cube(int cells = 2) {
  TracedScene scene;
  scene.objects = {{"the \"cube\"", "folder/cube.h5", "sum", ResponseKind::kModal}};
  scene.config.objects.resize(1);
  scene.config.objects[0].model = std::make_shared<const Model>(synthetic_cube(cells, 5, 10));
  scene.config.styluses.resize(1);
  return scene;
}

/// Frames 0.1, 0.2, ... s of a cube that moves; and how another run of it is off in every frame.
struct Off {
  Vector3 position = Vector3::Zero();
  Vector3 rotation = Vector3::Zero();      ///< after the orientation
  Vector3 displacement = Vector3::Zero();  ///< of kNode
  Vector3 force = Vector3::Zero();
};

void write_run(const std::filesystem::path& path, const TracedScene& scene, const Off& off = {},
               int first = 1) {
  RunOutput output(path, scene, {"trace.h5", "inputs"});
  const int nodes = scene.config.objects[0].model->mesh.surface_node_count();
  for (int k = first; k < first + 4; ++k) {
    StepRecord record;
    record.object_count = record.stylus_count = 1;
    record.time = 0.1 * k;
    ObjectRecord& object = record.object[0];
    object.position = Vector3(k, 2.0 * k, 0.5) + off.position;
    object.orientation =
        rotation_from_vector(off.rotation) * rotation_from_vector(Vector3(0.1 * k, -0.2, 0.05 * k));
    record.stylus[0].force = Vector3(0.0, k, 0.0) + off.force;
    std::vector<Points> u(1, Points::Zero(nodes, 3));
    u[0].row(0) = Vector3(0.0, 0.003, 0.004).transpose() * k;
    u[0].row(kNode) += off.displacement.transpose();
    output.put({record, u});
  }
  output.finish();
}

struct TwoRuns {
  explicit TwoRuns(const Off& off = {}, int first = 1) {
    write_run(a, one_cube());
    write_run(b, one_cube(), off, first);
  }
  Comparison compared() const { return compare_runs(RunReader(a), RunReader(b)); }
  Measures measured() const { return measure_runs(RunReader(a), RunReader(b), compared()); }

  TemporaryFolder folder;
  std::filesystem::path a = folder.path() / "a.h5";
  std::filesystem::path b = folder.path() / "b.h5";
};

}  // namespace

TEST_CASE("a run is not apart from itself") {
  const TwoRuns runs;
  const Comparison found = runs.compared();
  REQUIRE(found.times.size() == 4);
  CHECK(found.alone == 0);
  const ObjectComparison& cube = found.objects.at(0);
  REQUIRE(cube.same_nodes);
  CHECK(cube.displacement.maximum() == 0.0);
  CHECK(cube.displacement.reference == Approx(0.02));  // 4 times 5 mm
  CHECK(cube.place.maximum() == 0.0);
  CHECK(cube.orientation.maximum() < 1e-15);
  CHECK(found.forces.at(0).maximum() == 0.0);
  CHECK(found.forces.at(0).reference == 4.0);
}

TEST_CASE("differences of two runs come out as they were put in") {
  const TwoRuns runs({.position = {0.003, 0.0, -0.004},
                      .rotation = {0.0, 0.02, 0.0},
                      .displacement = {0.0, 0.006, 0.008},
                      .force = {0.3, 0.0, 0.4}});
  const Comparison found = runs.compared();
  const ObjectComparison& cube = found.objects.at(0);
  CHECK(cube.centre_of_mass.rms_over_time() == Approx(0.005));
  CHECK(cube.orientation.maximum() == Approx(0.02));
  const double nodes = one_cube().config.objects[0].model->mesh.surface_node_count();
  CHECK(cube.displacement.maximum() == Approx(0.01));
  CHECK(cube.displacement.rms_over_time() == Approx(0.01 / std::sqrt(nodes)));
  CHECK(found.forces.at(0).rms_over_time() == Approx(0.5));
  CHECK(cube.place.maximum() > 0.005);
}

TEST_CASE("a node's place moves with its body") {
  const TwoRuns moved({.position = {0.003, 0.0, -0.004}});
  CHECK(moved.compared().objects.at(0).place.rms_over_time() == Approx(0.005));
  // Turned about its middle, a node at r from the axis moves by 2 r sin(angle / 2).
  const TwoRuns turned({.rotation = {0.0, 0.3, 0.0}});
  const DifferenceSeries place = turned.compared().objects.at(0).place;
  CHECK(place.maximum() <= 2 * (0.06 * std::sqrt(3.0) + 0.02) * std::sin(0.15));
  CHECK(place.maximum() >= 2 * 0.06 * std::sin(0.15));
}

TEST_CASE("frames are compared that both runs have") {
  const TwoRuns runs({}, 3);
  const Comparison found = runs.compared();
  CHECK(found.times == std::vector<double>{0.1 * 3, 0.1 * 4});
  CHECK(found.alone == 4);
  CHECK_THROWS_WITH(TwoRuns({}, 11).compared(), ContainsSubstring("no frame at a time"));
}

TEST_CASE("a run that is later is compared with what it lags behind") {
  const TwoRuns runs;
  const Comparison found = compare_runs(RunReader(runs.a), RunReader(runs.b, 0.1));
  CHECK(found.times.size() == 3);
  CHECK(found.alone == 2);
  CHECK(found.forces.at(0).maximum() == Approx(1.0));
}

TEST_CASE("runs with other meshes are compared as bodies, with other objects not at all") {
  const TwoRuns runs;
  write_run(runs.folder.path() / "fine.h5", one_cube(3));
  const Comparison found =
      compare_runs(RunReader(runs.a), RunReader(runs.folder.path() / "fine.h5"));
  CHECK_FALSE(found.objects.at(0).same_nodes);
  CHECK(found.objects.at(0).centre_of_mass.maximum() == 0.0);
  const Measures measures =
      measure_runs(RunReader(runs.a), RunReader(runs.folder.path() / "fine.h5"), found);
  CHECK(measures.nodes.at(0).spectrum_a.frequency.empty());
  CHECK_THAT(comparison_table(found, measures), ContainsSubstring("the meshes differ"));
  TracedScene other = one_cube();
  other.objects[0].name = "ball";
  write_run(runs.folder.path() / "ball.h5", other);
  CHECK_THROWS_WITH(compare_runs(RunReader(runs.a), RunReader(runs.folder.path() / "ball.h5")),
                    ContainsSubstring("other objects"));
}

TEST_CASE("a comparison as JSON has its numbers to the bit, its words and its keys in order") {
  const TwoRuns runs({.force = {0.3, 0.0, 0.4}});
  Comparison compared = runs.compared();
  const Measures measured = runs.measured();
  const auto json = nlohmann::ordered_json::parse(comparison_json(compared, measured));
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  CHECK(keys == std::vector<std::string>{"format", "version", "a", "b", "frames", "frames_alone",
                                         "evenly_spaced", "interval", "time", "objects",
                                         "styluses"});
  CHECK(json["frames"] == 4);
  CHECK(json["time"].get<std::vector<double>>() == compared.times);
  REQUIRE(json["objects"].size() == 1);
  CHECK(json["objects"][0]["name"] == "the \"cube\"");
  CHECK(json["objects"][0]["orientation"]["unit"] == "rad");
  CHECK(json["objects"][0]["node"]["number"].is_number_integer());
  REQUIRE(json["styluses"].size() == 1);
  const auto& force = json["styluses"][0]["force"];
  CHECK(force["rms_over_time"].get<std::vector<double>>() == compared.forces[0].rms);
  CHECK(force["rms"].get<double>() == compared.forces[0].rms_over_time());

  compared.a = "\xff.h5";  // no UTF-8
  compared.forces[0].reference = std::nan("");
  const auto odd = nlohmann::json::parse(comparison_json(compared, measured));
  CHECK(odd["a"] == "\xEF\xBF\xBD.h5");
  CHECK(odd["styluses"][0]["force"]["reference"].is_null());
}

TEST_CASE("an output is not written over, and one that is not finished leaves nothing") {
  const TwoRuns runs;
  CHECK_THROWS_WITH(write_run(runs.a, one_cube()), ContainsSubstring("exists already"));
  { RunOutput unfinished(runs.folder.path() / "c.h5", one_cube(), {"trace.h5", "inputs"}); }
  CHECK(std::distance(std::filesystem::directory_iterator(runs.folder.path()), {}) == 2);
}
