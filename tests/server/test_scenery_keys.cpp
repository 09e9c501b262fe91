#include "common/model/model_file.hpp"
#include "tests/server/scene_text.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/synthetic_model.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using Catch::Matchers::StartsWith;
using namespace irdm;
using test::kObject;
using test::rejection;
using test::scene;

namespace {

const std::string kSphere = "sphere = { radius = 1 }\n";

std::string with_scenery(const std::string& lines) {
  return "[[scenery]]\n" + lines + kObject;
}

SceneryConfig scenery(const std::string& lines) {
  return scene(with_scenery(lines)).scenery.at(0);
}

}  // namespace

TEST_CASE("scenery: every key arrives, in the order of the file") {
  const SceneConfig read = scene(
      "[[scenery]]\nname = \"table\"\nbox = { size = [1, 0.5, 2] }\nposition = [4, 5, 6]\n"
      "orientation = [0, 3, 0, 0]\nfriction = { static = 0.4, kinetic = 0.3 }\n"
      "[[scenery]]\nname = \"ball\"\nsphere = { radius = 0.1 }\n"
      "[[scenery]]\nname = \"rod\"\ncapsule = { radius = 0.01, length = 0.3 }\n"
      "[[scenery]]\nname = \"wall\"\nplane = { normal = [3, 0, 0] }\nposition = [7, 8, 9]\n" +
      kObject);
  REQUIRE(read.scenery.size() == 4);
  const SceneryConfig& table = read.scenery[0];
  CHECK(table.name == "table");
  CHECK(std::get<BoxShape>(table.shape).size == Vector3(1, 0.5, 2));
  CHECK(table.position == Vector3(4, 5, 6));
  CHECK(table.orientation.isApprox(Quaternion(0, 1, 0, 0)));
  CHECK(table.friction == Friction{0.4, 0.3});
  CHECK(std::get<SphereShape>(read.scenery[1].shape).radius == 0.1);
  CHECK(std::get<CapsuleShape>(read.scenery[2].shape).radius == 0.01);
  CHECK(std::get<CapsuleShape>(read.scenery[2].shape).length == 0.3);
  CHECK(std::holds_alternative<PlaneShape>(read.scenery[3].shape));
  CHECK(read.scenery[3].position == Vector3(7, 8, 9));
}

TEST_CASE("scenery: it stands still, or moves as it is told") {
  CHECK_FALSE(scenery(kSphere).motion.any());
  const SceneryMotion motion = scenery(kSphere +
                                       "motion = { velocity = [1, 2, 3], "
                                       "angular_velocity = [4, 5, 6], stroke = "
                                       "[0.1, 0.2, 0.3], frequency = 2 }\n")
                                   .motion;
  CHECK(motion.velocity == Vector3(1, 2, 3));
  CHECK(motion.angular_velocity == Vector3(4, 5, 6));
  CHECK(motion.stroke == Vector3(0.1, 0.2, 0.3));
  CHECK(motion.frequency == 2.0);
  CHECK_THAT(rejection(with_scenery(kSphere + "motion = { stroke = [1, 0, 0] }\n")),
             ContainsSubstring("stroke is given without a frequency"));
  CHECK_THAT(rejection(with_scenery(kSphere + "motion = { frequency = 101 }\n")),
             ContainsSubstring("is 101; give a finite number >= 0 and <= 100"));
  CHECK_THAT(rejection(with_scenery(kSphere + "motion = { speed = 1 }\n")),
             ContainsSubstring("speed"));
}

TEST_CASE("scenery: a path has waypoints in the order of their times") {
  const auto with_path = [](const std::string& rows) {
    return kSphere + "motion = { path = [" + rows + "] }\n";
  };
  const std::string first = "{ time = 0.5 }, ";
  const std::vector<Waypoint> path =
      scenery(with_path(first + "{ time = 2, displacement = [1, 2, 3] }")).motion.path;
  REQUIRE(path.size() == 2);
  CHECK(path[0].time == 0.5);
  CHECK(path[0].displacement == Vector3::Zero());
  CHECK(path[1].time == 2.0);
  CHECK(path[1].displacement == Vector3(1, 2, 3));
  CHECK_THAT(rejection(with_scenery(with_path(first + "{ time = 0.5 }"))),
             ContainsSubstring("time is not after that of the row before"));
  CHECK_THAT(
      rejection(with_scenery(with_path(first + "{ time = 0.6, displacement = [0, 101, 0] }"))),
      ContainsSubstring("displacement is reached at 1010 m/s"));
  CHECK_THAT(rejection(with_scenery(with_path("{ time = -1 }"))), ContainsSubstring("time is -1"));
  CHECK_THAT(rejection(with_scenery(with_path("{ displacement = [0, 0, 0] }"))),
             ContainsSubstring("time is missing"));
  CHECK_THAT(rejection(with_scenery(with_path("{ time = 1, place = 2 }"))),
             ContainsSubstring("place"));
}

TEST_CASE("scenery: it is a part of what is simulated") {
  SceneConfig config;
  config.scenery.push_back(scenery(kSphere + "position = [1, 2, 3]\n"));
  const auto simulated = simulation_config(config, false).scenery;
  REQUIRE(simulated.size() == 1);
  CHECK(simulated[0].position == Vector3(1, 2, 3));
}

TEST_CASE("scenery: a scene needs none, and a shape is all that one needs") {
  CHECK(scene(kObject).scenery.empty());
  const SceneryConfig read = scenery(kSphere);
  CHECK(read.name == "scenery");
  CHECK(read.position.isZero(0.0));
  CHECK(read.orientation.isApprox(Quaternion::Identity()));
  CHECK(read.friction == Friction{0.5, 0.5});
  CHECK(scenery(kSphere + "friction = { static = 0.2 }\n").friction == Friction{0.2, 0.2});
  CHECK(closest(scenery("plane = {}\n"), {1, 2, 3}).signed_distance == 2.0);
}

TEST_CASE("scenery: the normal of a plane is the side that is free, whatever its length") {
  for (const char* normal : {"[0, 1, 0]", "[0, -1, 0]", "[1e-7, -1, 0]", "[1e-5, -1, 1e-6]",
                             "[3, 0, 0]", "[0, 0, -1e100]", "[1, 2, -3]"}) {
    const SceneryConfig plane =
        scenery(std::string("plane = { normal = ") + normal + " }\nposition = [0.1, 0.2, 0.3]\n");
    const auto floor = scene(std::string("[floor]\nnormal = ") + normal + "\n" + kObject).floor;
    const SceneryHit hit = closest(plane, plane.position + 2.0 * floor->normal);
    CAPTURE(normal);
    CHECK((hit.normal - floor->normal).norm() < 1e-15);
    CHECK(hit.signed_distance == Approx(2.0).epsilon(1e-12));
    CHECK(plane.orientation.norm() == Approx(1.0).epsilon(1e-15));
  }
}

TEST_CASE("scenery: one shape, no less and no more") {
  CHECK(rejection(with_scenery("position = [0, 0, 0]\n")) ==
        "s.toml:1: [scenery[0]] has no shape; add one of: plane | box | sphere | capsule | "
        "mesh");
  CHECK(rejection(with_scenery(kSphere + "plane = { normal = [0, 1, 0] }\n")) ==
        "s.toml:2: scenery[0].sphere is a second shape; leave it out, or give it a [[scenery]] of "
        "its own");
  CHECK(rejection(with_scenery("plane = {}\norientation = [1, 0, 0, 0]\n")) ==
        "s.toml:3: scenery[0].orientation is not for a plane; leave it out, and give plane.normal");
}

TEST_CASE("scenery: a name is nobody else's") {
  CHECK(rejection(with_scenery(kSphere) + "[[scenery]]\n" + kSphere + "name = \"b\"\n") ==
        "no error");
  CHECK(rejection(with_scenery(kSphere) + "[[scenery]]\n" + kSphere) ==
        "s.toml:5: scenery[1].name is taken: 'scenery'; give each object and each scenery a name "
        "of its own");
  CHECK(rejection(with_scenery("name = \"object\"\n" + kSphere)) ==
        "s.toml:2: scenery[0].name is taken: 'object'; give each object and each scenery a name "
        "of its own");
  CHECK_THAT(rejection(with_scenery("name = \"a/b\"\n" + kSphere)),
             StartsWith("s.toml:2: scenery[0].name cannot name a group of the trace file"));
}

TEST_CASE("scenery: up to sixteen") {
  std::string text;
  for (std::size_t i = 0; i < kMaxScenery; ++i) {
    text += "[[scenery]]\nname = \"" + std::to_string(i) + "\"\n" + kSphere;
  }
  CHECK(scene(text + kObject).scenery.size() == 16);
  CHECK(rejection(text + with_scenery(kSphere)) ==
        "s.toml:1: scenery appears too often; use at most 16");
}

TEST_CASE("scenery: each limit, the last good value and the first bad one") {
  struct Limit {
    const char* name;
    const char* good;
    const char* bad;
    const char* message;
  };
  const auto limit = GENERATE(values<Limit>({
      {"box.size", "box = { size = [1e-6, 1, 1e4] }", "box = { size = [1, 0, 1] }", "is 0"},
      {"box.size", "", "box = { size = [1, 1, 1.1e4] }", "is 11000"},
      {"box.size", "", "box = { size = [1, 1] }", "has 2 entries"},
      {"box.size", "", "box = {}", "is missing"},
      {"box.radius", "", "box = { size = [1, 1, 1], radius = 1 }", "is not a known key"},
      {"box", "", "box = [1, 1, 1]", "is not a table"},
      {"sphere.radius", "sphere = { radius = 1e-6 }", "sphere = { radius = 0 }", "is 0"},
      {"sphere.radius", "sphere = { radius = 1e4 }", "sphere = { radius = inf }", "is inf"},
      {"sphere.radius", "", "sphere = {}", "is missing"},
      {"sphere.length", "", "sphere = { radius = 1, length = 1 }", "is not a known key"},
      {"capsule.radius", "", "capsule = { radius = -1, length = 1 }", "is -1"},
      {"capsule.radius", "", "capsule = { length = 1 }", "is missing"},
      {"capsule.length", "capsule = { radius = 1, length = 1e-6 }",
       "capsule = { radius = 1, length = 0 }", "is 0"},
      {"capsule.length", "", "capsule = { radius = 1 }", "is missing"},
      {"capsule.size", "", "capsule = { radius = 1, length = 1, size = 1 }", "is not a known key"},
      {"plane.normal", "plane = { normal = [1, 1, 0] }", "plane = { normal = [0, 0, 0] }",
       "has no length"},
      {"plane.height", "", "plane = { height = 1 }", "is not a known key"},
  }));
  CAPTURE(limit.bad);
  if (*limit.good != '\0') {
    CHECK(rejection(with_scenery(std::string(limit.good) + "\n")) == "no error");
  }
  CHECK_THAT(rejection(with_scenery(std::string(limit.bad) + "\n")),
             StartsWith(std::string("s.toml:2: scenery[0].") + limit.name + " " + limit.message));
}

TEST_CASE("scenery: each bad value of what all shapes have") {
  const auto rejected = [](const char* line) {
    return rejection(with_scenery(kSphere + line + "\n"));
  };
  CHECK_THAT(rejected("position = [0, 1e5, 0]"),
             StartsWith("s.toml:3: scenery[0].position is 100000"));
  CHECK_THAT(rejected("orientation = [0, 0, 0, 0]"),
             StartsWith("s.toml:3: scenery[0].orientation has no length"));
  CHECK_THAT(rejected("friction = { static = 0.4, kinetic = 0.5 }"),
             StartsWith("s.toml:3: scenery[0].friction.kinetic is larger than static"));
  CHECK_THAT(rejected("friction = { static = 11 }"),
             StartsWith("s.toml:3: scenery[0].friction.static is 11"));
  CHECK(rejected("velocity = [0, 0, 0]") ==
        "s.toml:3: scenery[0].velocity is not a known key; remove it or correct its name");
  CHECK(rejection("[scenery]\n" + kSphere + kObject) ==
        "s.toml:1: scenery is not a list of tables; write it as [[scenery]]");
}

TEST_CASE("scenery: a mesh has the surface of a rigid body's model, read once a file") {
  const test::TemporaryFolder folder;
  const Model cube = test::synthetic_cube(2, 3, 4);
  const auto write = [&](const char* name, const Model& model) {
    ModelFileWriter writer(folder.path() / name);
    writer.write_description(model);
    if (!is_rigid(model)) writer.write_modal(std::get<ModalResponse>(model.response));
    writer.commit();
  };
  write("cube.h5", test::made_rigid(cube));
  write("soft.h5", cube);
  SceneConfig config = scene(
      "[[scenery]]\nmesh = { model = \"bowl.h5\" }\nposition = [1, 2, 3]\n"
      "orientation = [0, 1, 0, 0]\n[[scenery]]\nname = \"other\"\nmesh = { model = \"bowl.h5\" "
      "}\n" +
      kObject);
  REQUIRE(config.scenery_models.size() == 2);
  CHECK(config.scenery_models[0].filename() == "bowl.h5");
  config.objects.clear();
  config.scenery_models.assign(2, folder.path() / "cube.h5");
  const auto simulated = simulation_config(config, false).scenery;
  const auto& surface = std::get<MeshShape>(simulated.at(0).shape).surface;
  REQUIRE(surface);
  CHECK(surface->triangle_count() == cube.mesh.triangles.rows());
  CHECK(surface == std::get<MeshShape>(simulated.at(1).shape).surface);
  CHECK(closest(simulated[0], {1, 2, 13}).signed_distance == Approx(10.0 - 0.06));
  config.scenery_models[1] = folder.path() / "soft.h5";
  CHECK_THROWS_WITH(
      simulation_config(config, false),
      ContainsSubstring("soft.h5: is not of a rigid body, as scenery of a mesh is; make its "
                        "model with rigid = true"));
  config.scenery_models[1] = folder.path() / "nothing.h5";
  CHECK_THROWS_AS(simulation_config(config, false), Error);
}

TEST_CASE("scenery: each bad key of a mesh") {
  CHECK_THAT(rejection(with_scenery("mesh = {}\n")),
             StartsWith("s.toml:2: scenery[0].mesh.model is missing"));
  CHECK_THAT(rejection(with_scenery("mesh = { model = \"a.h5\", unit = \"mm\" }\n")),
             StartsWith("s.toml:2: scenery[0].mesh.unit is not a known key"));
}
