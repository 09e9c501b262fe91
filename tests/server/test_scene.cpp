#include "common/error.hpp"
#include "common/model/model_file.hpp"
#include "scene/columns/column_store.hpp"
#include "scene/scene.hpp"
#include "tests/server/scene_text.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/streamed_model.hpp"
#include "tests/support/synthetic_model.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::Equals;
using Catch::Matchers::StartsWith;
using namespace irdm;
using test::kObject;
using test::rejection;
using test::scene;

TEST_CASE("every key of a scene arrives where it belongs") {
  const SceneConfig read = scene(
      "[server]\naddress = \"127.0.0.2\"\nport = 4711\nstyluses = 3\ndeformation_rate = 30\n"
      "deformation_threads = 2\nkey_file = \"/k/irdm.key\"\nstatus_period = 5\nudp = "
      "false\n[world]\ngravity = "
      "[1, 2, 3]\n"
      "[contact]\ncoupling_stiffness = 1500\nrelease_time = 0.2\nbetween_objects = false\nself = "
      "true\n"
      "samples = 500\nsleep_time = 2.5\n"
      "[floor]\nheight = -0.5\nnormal = [0, 0, 2]\nfriction = { static = 0.9, kinetic = 0.7 }\n"
      "[[stylus]]\nradius = 0.01\ncoupling_stiffness = 800\nreach = 0.02\n[[stylus]]\n"
      "[[object]]\nname = \"liver\"\nmodel = \"/models/liver.h5\"\nengine = \"dense\"\n"
      "memory_budget = 1500.5\n"
      "position = [4, 5, 6]\norientation = [0, 3, 0, 0]\nvelocity = [7, 8, 9]\n"
      "angular_velocity = [10, 11, 12]\ninertial_loading = true\nfriction = { static = 0.4, "
      "kinetic = 0.3 }\n"
      "damping = { linear = 0.1, angular = 0.2 }\n"
      "tether = { stiffness = 20, angular_stiffness = 0.3 }\n");
  CHECK(read.server.address == "127.0.0.2");
  CHECK(read.server.port == 4711);
  CHECK(read.server.styluses == 3);
  CHECK(read.server.deformation_rate == 30.0);
  CHECK(read.server.deformation_threads == 2);
  CHECK(read.server.key_file == "/k/irdm.key");
  CHECK(read.server.status_period == 5.0);
  CHECK_FALSE(read.server.udp);
  CHECK(read.world.gravity == Vector3(1, 2, 3));
  CHECK(read.contact.coupling_stiffness == 1500.0);
  REQUIRE(read.objects.size() == 1);
  const ObjectConfig& object = read.objects[0];
  CHECK(object.name == "liver");
  CHECK(object.model == "/models/liver.h5");
  CHECK(object.engine == ResponseKind::kDense);
  CHECK(object.memory_budget == 1500.5);
  CHECK(object.position == Vector3(4, 5, 6));
  CHECK(object.orientation.isApprox(Quaternion(0, 1, 0, 0)));
  CHECK(object.velocity == Vector3(7, 8, 9));
  CHECK(object.angular_velocity == Vector3(10, 11, 12));
  CHECK(object.inertial_loading);
  CHECK(object.friction.static_ == 0.4);
  CHECK(object.friction.kinetic == 0.3);
  CHECK(object.damping.linear == 0.1);
  CHECK(object.damping.angular == 0.2);
  CHECK(object.tether.stiffness == 20.0);
  CHECK(object.tether.angular_stiffness == 0.3);
  CHECK(read.contact.release_time == 0.2);
  CHECK_FALSE(read.contact.between_objects);
  CHECK(read.contact.self);
  CHECK(read.contact.samples == 500);
  CHECK(read.contact.sleep_time == 2.5);
  REQUIRE(read.floor);
  CHECK(read.floor->height == -0.5);
  CHECK(read.floor->normal == Vector3(0, 0, 1));
  CHECK(read.floor->friction.static_ == 0.9);
  CHECK(read.floor->friction.kinetic == 0.7);
  REQUIRE(read.styluses.size() == 3);
  CHECK(read.styluses[0].radius == 0.01);
  CHECK(read.styluses[0].coupling_stiffness == 800.0);
  CHECK(read.styluses[0].reach == 0.02);
  CHECK(read.default_radius == std::vector<std::size_t>{1, 2});
  for (std::size_t s = 1; s < 3; ++s) {  // described by an empty table, and not at all
    CHECK(read.styluses[s].coupling_stiffness == 1500.0);
    CHECK(read.styluses[s].reach == 0.0);
  }
}

TEST_CASE("a scene needs only a model, the rest has defaults") {
  const SceneConfig read = scene(kObject);
  CHECK(read.server.address == "127.0.0.1");
  CHECK(read.server.port == 0);
  CHECK(read.server.styluses == 1);
  CHECK(read.server.deformation_rate == 60.0);
  CHECK(read.server.deformation_threads == 0);
  CHECK_FALSE(read.server.key_file);
  CHECK(read.server.status_period == 10.0);
  CHECK(read.server.udp);
  CHECK(read.world.gravity.isZero(0.0));
  CHECK(read.contact.coupling_stiffness == 0.0);
  const ObjectConfig& object = read.objects.at(0);
  CHECK(object.model == std::filesystem::current_path() / "cube.h5");
  CHECK(object.engine == ResponseKind::kModal);
  CHECK(object.position.isZero(0.0));
  CHECK(object.orientation.isApprox(Quaternion::Identity()));
  CHECK(object.velocity.isZero(0.0));
  CHECK(object.angular_velocity.isZero(0.0));
  CHECK_FALSE(object.inertial_loading);
  CHECK_THAT(rejection(kObject + "inertial_loading = 1\n"),
             StartsWith("s.toml:3: object[0].inertial_loading is not true or false"));
  CHECK(object.friction.static_ == 0.6);
  CHECK(object.friction.kinetic == 0.5);
  CHECK(object.damping.linear == 0.0);
  CHECK(object.damping.angular == 0.0);
  CHECK(object.tether.stiffness == 0.0);
  CHECK(object.tether.angular_stiffness == 0.0);
  CHECK(read.contact.release_time == 0.03);
  CHECK(read.contact.between_objects);
  CHECK_FALSE(read.contact.self);
  CHECK(read.contact.samples == 384);
  CHECK(read.contact.sleep_time == 0.5);
  CHECK_FALSE(read.floor);
  REQUIRE(read.styluses.size() == 1);
  CHECK(read.default_radius == std::vector<std::size_t>{0});
  CHECK(read.styluses[0].reach == 0.0);
}

TEST_CASE("an orientation and a floor's normal may have any length whose square is a number") {
  const auto turned = scene(kObject + "orientation = [0, 0, 0, -1e100]\n").objects.at(0);
  CHECK(turned.orientation.isApprox(Quaternion(0, 0, 0, -1)));
  CHECK(scene("[floor]\nnormal = [0, 0, 1e100]\n" + kObject).floor->normal == Vector3(0, 0, 1));
  CHECK_THAT(rejection(kObject + "orientation = [0, 0, 0, 1e200]\n"),
             StartsWith("s.toml:3: object[0].orientation is 1e+200; give a finite number"));
  CHECK_THAT(rejection("[floor]\nnormal = [0, 0, 1e200]\n" + kObject),
             StartsWith("s.toml:2: floor.normal is 1e+200; give a finite number"));
}

TEST_CASE("a floor needs no key, and one friction value goes a long way") {
  const SceneConfig read = scene("[floor]\n" + kObject);
  REQUIRE(read.floor);
  CHECK(read.floor->height == 0.0);
  CHECK(read.floor->normal == Vector3(0, 1, 0));
  CHECK(read.floor->friction.static_ == 0.5);
  CHECK(read.floor->friction.kinetic == 0.5);
  // Kinetic friction is never above static: its default gives way.
  CHECK(scene(kObject + "friction = { static = 0.2 }\n").objects.at(0).friction.kinetic == 0.2);
}

TEST_CASE("a scene has up to sixteen objects and sixteen styluses") {
  const auto object = [](int i) {
    return "[[object]]\nname = \"" + std::to_string(i) + "\"\nmodel = \"cube.h5\"\n";
  };
  std::string objects;
  std::string styluses;
  for (int i = 0; i < 16; ++i) {
    objects += object(i);
    styluses += "[[stylus]]\n";
  }
  CHECK(scene(objects).objects.size() == 16);
  CHECK(rejection(objects + object(16)) == "s.toml:1: object appears too often; use at most 16");
  CHECK(scene(styluses + kObject).styluses.size() == 16);
  CHECK(scene(styluses + kObject).server.styluses == 16);
  CHECK(rejection(styluses + "[[stylus]]\n" + kObject) ==
        "s.toml:1: stylus appears too often; use at most 16");
  CHECK_THAT(rejection("[server]\nstyluses = 15\n" + styluses + kObject),
             Equals("s.toml:1: server has fewer styluses than there are [[stylus]] tables; raise "
                    "server.styluses or leave it out"));
}

TEST_CASE("the viewer of a scene: defaults, keys, and what is no token") {
  const ViewerConfig usual = scene(kObject).viewer;
  CHECK(usual.enabled);
  CHECK(usual.address == "127.0.0.1");
  CHECK(usual.port == 0);
  CHECK(usual.token.empty());
  CHECK_FALSE(usual.scenes);
  const ViewerConfig viewer = scene(
                                  "[viewer]\nenabled = false\naddress = \"0.0.0.0\"\nport = 8080\n"
                                  "token = \"0123456789abcdef\"\nscenes = \"/s\"\n" +
                                  kObject)
                                  .viewer;
  CHECK_FALSE(viewer.enabled);
  CHECK(viewer.address == "0.0.0.0");
  CHECK(viewer.port == 8080);
  CHECK(viewer.token == "0123456789abcdef");
  CHECK(viewer.scenes == "/s");
  const auto with_token = [](const std::string& token) {
    return rejection("[viewer]\ntoken = \"" + token + "\"\n" + kObject);
  };
  CHECK(with_token(std::string(128, 'x')) == "no error");
  for (const std::string& bad :
       {std::string(15, 'x'), std::string(129, 'x'), std::string("sixteen or more x")}) {
    CHECK_THAT(with_token(bad), StartsWith("s.toml:2: viewer.token is not 16 to 128 printable"));
  }
  const ViewerConfig by_file = scene(
                                   "[viewer]\ntoken_file = \"/t/irdm.token\"\n"
                                   "onlooker_token_file = \"watch.token\"\n" +
                                   kObject)
                                   .viewer;
  CHECK(by_file.token_file == "/t/irdm.token");
  CHECK(by_file.onlooker_token_file->filename() == "watch.token");
  CHECK_THAT(rejection("[viewer]\ntoken = \"0123456789abcdef\"\ntoken_file = \"t\"\n" + kObject),
             StartsWith("s.toml:3: viewer.token_file is given beside the token itself"));
  CHECK_THAT(rejection("[viewer]\nonlooker_token_file = \"t\"\n" + kObject),
             StartsWith("s.toml:2: viewer.onlooker_token_file is set without viewer.token_file"));
  CHECK_THAT(rejection("[viewer]\nport = 65536\n" + kObject), StartsWith("s.toml:2: viewer.port"));
  CHECK_THAT(rejection("[viewer]\nsize = 1\n" + kObject), StartsWith("s.toml:2: viewer.size"));
}

TEST_CASE("an object's name must do for a group of the trace file") {
  for (const char* good : {"cube", "left lobe", "Würfel", "..", "a.b", "0"}) {
    CHECK(rejection(kObject + "name = \"" + good + "\"\n") == "no error");
  }
  for (const char* bad : {"", "/", "a/b", ".", "a\\nb", "\\u0000", "\\u007F"}) {
    CHECK(rejection(kObject + "name = \"" + bad + "\"\n") ==
          "s.toml:3: object[0].name cannot name a group of the trace file; use one or more "
          "letters, without '/' and control characters, and not \".\" alone");
  }
  CHECK(rejection(kObject + "name = \"" + std::string(100, 'n') + "\"\n") == "no error");
  CHECK(rejection(kObject + "name = \"" + std::string(1 << 20, 'n') + "\"\n") ==
        "s.toml:3: object[0].name has 1048576 bytes; give at most 4096");
  CHECK(rejection(kObject + "name = \"" + std::string(101, 'n') + "\"\n") ==
        "s.toml:3: object[0].name has 101 bytes; give at most 100");
  const std::string twice = kObject + "name = \"a\"\n" + kObject + "name = \"a\"\n";
  CHECK(rejection(twice) ==
        "s.toml:1: object appears twice with the name 'a'; give each object a name of its own");
}

TEST_CASE("each limit of a scene: the last good value passes, the first bad one is told") {
  struct Limit {
    const char* table;
    const char* key;
    const char* good;
    const char* bad;
    const char* message;
  };
  const auto limit = GENERATE(values<Limit>({
      {"server", "port", "65535", "65536", "is 65536; give a whole number from 0 to 65535"},
      {"server", "port", "0", "-1", "is -1; give a whole number from 0 to 65535"},
      {"server", "styluses", "1", "0", "is 0; give a whole number from 1 to 16"},
      {"server", "styluses", "16", "17", "is 17; give a whole number from 1 to 16"},
      {"server", "deformation_rate", "1", "0.9", "is 0.9; give a finite number >= 1 and <= 1000"},
      {"server", "deformation_rate", "1000", "1001",
       "is 1001; give a finite number >= 1 and <= 1000"},
      {"server", "deformation_threads", "0", "-1", "is -1; give a whole number from 0 to 64"},
      {"server", "deformation_threads", "64", "65", "is 65; give a whole number from 0 to 64"},
      {"contact", "coupling_stiffness", "0", "-0.1",
       "is -0.1; give a finite number >= 0 and <= 1e+09"},
      {"contact", "coupling_stiffness", "1e9", "1.1e9",
       "is 1.1e+09; give a finite number >= 0 and <= 1e+09"},
      {"contact", "release_time", "0.001", "0", "is 0; give a finite number >= 0.001 and <= 1"},
      {"contact", "release_time", "1", "1.1", "is 1.1; give a finite number >= 0.001 and <= 1"},
      {"contact", "between_objects", "true", "1", "is not true or false; give true or false"},
      {"contact", "samples", "16", "15", "is 15; give a whole number from 16 to 4096"},
      {"contact", "samples", "4096", "4097", "is 4097; give a whole number from 16 to 4096"},
      {"contact", "sleep_time", "0", "-0.1", "is -0.1; give a finite number >= 0 and <= 60"},
      {"contact", "sleep_time", "60", "61", "is 61; give a finite number >= 0 and <= 60"},
  }));
  const auto text = [&](const char* value) {
    return std::string("[") + limit.table + "]\n" + limit.key + " = " + value + "\n" + kObject;
  };
  CHECK(rejection(text(limit.good)) == "no error");
  CHECK_THAT(rejection(text(limit.bad)), Equals(std::string("s.toml:2: ") + limit.table + "." +
                                                limit.key + " " + limit.message));
}

TEST_CASE("each limit of styluses, floor and objects: the last good value, the first bad one") {
  struct Limit {
    const char* table;  // as written, and as told
    const char* name;
    const char* good;
    const char* bad;
    const char* message;
  };
  const auto limit = GENERATE(values<Limit>({
      {"[[stylus]]", "stylus[0].radius", "radius = 0", "radius = -1", "is -1"},
      {"[[stylus]]", "stylus[0].radius", "radius = 1", "radius = 1.1", "is 1.1"},
      {"[[stylus]]", "stylus[0].reach", "reach = 0", "reach = -1", "is -1"},
      {"[[stylus]]", "stylus[0].reach", "reach = 1", "reach = 1.1", "is 1.1"},
      {"[[stylus]]", "stylus[0].shape", "shape = 'ball'", "shape = 'cube'", "is 'cube'"},
      {"[[stylus]]", "stylus[0].reach", "shape = 'ball'", "reach = 0.01\nshape = 'ball'",
       "is not for a ball"},
      {"[[stylus]]", "stylus[0].radius", "radius = 0.001\nshape = 'ball'",
       "radius = 0\nshape = 'ball'", "of a ball is 0"},
      {"[[stylus]]", "stylus[0].coupling_stiffness", "coupling_stiffness = 0",
       "coupling_stiffness = -1", "is -1"},
      {"[[stylus]]", "stylus[0].coupling_stiffness", "coupling_stiffness = 1e9",
       "coupling_stiffness = 1e300", "is 1e+300"},
      {"[[stylus]]", "stylus[0].mass", "", "mass = 1", "is not a known key"},
      {"[floor]", "floor.height", "height = -3", "height = nan", "is nan"},
      {"[floor]", "floor.height", "height = 1e4", "height = 1e308", "is 1e+308"},
      {"[floor]", "floor.normal", "normal = [1, 1, 0]", "normal = [0, 0, 0]", "has no length"},
      {"[floor]", "floor.normal", "", "normal = [0, 1]", "has 2 entries"},
      {"[floor]", "floor.friction.static", "friction = { static = 10 }",
       "friction = { static = 11 }", "is 11"},
      {"[floor]", "floor.friction.kinetic", "friction = { static = 0.4, kinetic = 0.4 }",
       "friction = { static = 0.4, kinetic = 0.5 }", "is larger than static"},
      {"[floor]", "floor.friction.rolling", "", "friction = { rolling = 1 }", "is not a known key"},
      {"[floor]", "floor.colour", "", "colour = 1", "is not a known key"},
      {"[[object]]", "object[0].friction.static", "friction = { static = 0 }",
       "friction = { static = -1 }", "is -1"},
      {"[[object]]", "object[0].friction.kinetic", "friction = { static = 1, kinetic = 1 }",
       "friction = { static = 1, kinetic = 2 }", "is larger than static"},
      {"[[object]]", "object[0].friction.x", "", "friction = { x = 1 }", "is not a known key"},
      {"[[object]]", "object[0].friction", "", "friction = 1", "is not a table"},
      {"[[object]]", "object[0].damping.linear", "damping = { linear = 100 }",
       "damping = { linear = 101 }", "is 101"},
      {"[[object]]", "object[0].damping.angular", "damping = { angular = 0 }",
       "damping = { angular = -1 }", "is -1"},
      {"[[object]]", "object[0].damping.x", "", "damping = { x = 1 }", "is not a known key"},
      {"[[object]]", "object[0].tether.stiffness", "tether = { stiffness = 0 }",
       "tether = { stiffness = -1 }", "is -1"},
      {"[[object]]", "object[0].tether.angular_stiffness", "tether = { angular_stiffness = 1 }",
       "tether = { angular_stiffness = inf }", "is inf"},
      {"[[object]]", "object[0].tether.stiffness", "tether = { stiffness = 1e9 }",
       "tether = { stiffness = 1e300 }", "is 1e+300"},
      {"[[object]]", "object[0].position", "position = [1e4, 0, -1e4]", "position = [0, 1e308, 0]",
       "is 1e+308"},
      {"[[object]]", "object[0].velocity", "velocity = [1e3, 0, -1e3]", "velocity = [0, 0, 1e300]",
       "is 1e+300"},
      {"[[object]]", "object[0].angular_velocity", "angular_velocity = [1e3, 0, 0]",
       "angular_velocity = [-1e300, 0, 0]", "is -1e+300"},
      {"[world]", "world.bound", "bound = 1000", "bound = 0", "is 0"},
      {"[world]", "world.gravity", "gravity = [0, -100, 100]", "gravity = [0, -1e300, 0]",
       "is -1e+300"},
      {"[[object]]", "object[0].tether.x", "", "tether = { x = 1 }", "is not a known key"},
  }));
  const bool of_object = std::string(limit.table) == "[[object]]";
  const auto text = [&](const char* line) {
    return std::string(limit.table) + "\n" + line + "\n" +
           (of_object ? "model = \"cube.h5\"\n" : kObject);
  };
  CAPTURE(limit.bad);
  CHECK(rejection(text(limit.good)) == "no error");
  CHECK_THAT(rejection(text(limit.bad)),
             StartsWith(std::string("s.toml:2: ") + limit.name + " " + limit.message));
}

TEST_CASE("each wrong type or value in a scene is told with file, line, key and remedy") {
  CHECK(rejection("") == "s.toml:1: object is missing; add [[object]] with a model");
  CHECK(rejection(kObject + kObject) ==
        "s.toml:1: object appears twice with the name 'object'; give each object a name of its "
        "own");
  CHECK(rejection("[[object]]\nname = \"x\"\n") == "s.toml:1: object[0].model is missing; add it");
  CHECK(rejection("[[object]]\nmodel = \"\"\n") ==
        "s.toml:2: object[0].model is empty; give a path");
  CHECK(rejection("[[object]]\nmodel = 3\n") ==
        "s.toml:2: object[0].model is not text; give text in quotes");
  CHECK(rejection("[object]\nmodel = \"x\"\n") ==
        "s.toml:1: object is not a list of tables; write it as [[object]]");
  CHECK(rejection(kObject + "engine = \"steam\"\n") ==
        "s.toml:3: object[0].engine is 'steam'; give one of: modal | dense | compressed");
  CHECK(rejection(kObject + "memory_budget = 100\n") ==
        "s.toml:3: object[0].memory_budget is for the engine \"dense\"; leave it out, or set "
        "engine = \"dense\"");
  CHECK_THAT(rejection(kObject + "engine = \"dense\"\nmemory_budget = 0\n"),
             StartsWith("s.toml:4: object[0].memory_budget is 0"));
  CHECK(rejection(kObject + "switchable = false\n") ==
        "s.toml:3: object[0].switchable is not a key any more; leave it out; irdm-replay --engine "
        "compares the engines on a recorded run");
  CHECK(rejection(kObject + "name = 1\n") ==
        "s.toml:3: object[0].name is not text; give text in quotes");
  CHECK(rejection("server = 1\n" + kObject) ==
        "s.toml:1: server is not a table; write it as [server]");
  CHECK(rejection("[server]\naddress = 1\n" + kObject) ==
        "s.toml:2: server.address is not text; give text in quotes");
  CHECK(rejection("[server]\nport = 1.5\n" + kObject) ==
        "s.toml:2: server.port is not a whole number; give a whole number from 0 to 65535");
  CHECK(rejection("[contact]\ncoupling_stiffness = \"stiff\"\n" + kObject) ==
        "s.toml:2: contact.coupling_stiffness is not a number; give a finite number >= 0 and <= "
        "1e+09");
}

TEST_CASE("each vector of a scene must have its numbers, all finite") {
  using KeyAndRange = std::pair<std::string, std::string>;
  for (const auto& each : {KeyAndRange("position", ">= -10000 and <= 10000"),
                           KeyAndRange("velocity", ">= -1000 and <= 1000"),
                           KeyAndRange("angular_velocity", ">= -1000 and <= 1000")}) {
    const std::string& key = each.first;
    const std::string finite = "give a finite number " + each.second;
    const std::string start = "s.toml:3: object[0]." + key + " ";
    const auto with = [&](const char* value) {
      return rejection(kObject + key + " = " + value + "\n");
    };
    CHECK(with("[1, 2]") == start + "has 2 entries; give a list of 3 numbers");
    CHECK(with("[1, 2, 3, 4]") == start + "has 4 entries; give a list of 3 numbers");
    CHECK(with("1") == start + "is not a list; give a list of 3 numbers");
    CHECK(with("[1, \"2\", 3]") == start + "is not a number; " + finite);
    CHECK(with("[1, nan, 3]") == start + "is nan; " + finite);
    CHECK(with("[1, 2, -inf]") == start + "is -inf; " + finite);
  }
  CHECK(rejection("[world]\ngravity = [0, inf, 0]\n" + kObject) ==
        "s.toml:2: world.gravity is inf; give a finite number >= -100 and <= 100");
  CHECK(rejection(kObject + "orientation = [1, 0, 0]\n") ==
        "s.toml:3: object[0].orientation has 3 entries; give a list of 4 numbers");
  CHECK(rejection(kObject + "orientation = [0, 0, 0, 0]\n") ==
        "s.toml:3: object[0].orientation has no length; give a quaternion w, x, y, z, for "
        "instance [1, 0, 0, 0]");
  CHECK(rejection(kObject + "orientation = [1, nan, 0, 0]\n") ==
        "s.toml:3: object[0].orientation is nan; give a finite number >= -1e+100 and <= 1e+100");
}

TEST_CASE("a key that no table of a scene knows is an error") {
  const auto unknown = [](const std::string& name) {
    return name + " is not a known key; remove it or correct its name";
  };
  CHECK(rejection("colour = 1\n" + kObject) == "s.toml:1: " + unknown("colour"));
  CHECK(rejection("[server]\nprot = 1\n" + kObject) ==
        "s.toml:2: server.prot is not a known key; did you mean 'port'?");
  CHECK(rejection("[world]\nwind = 1\n" + kObject) == "s.toml:2: " + unknown("world.wind"));
  CHECK(rejection("[contact]\nk = 1\n" + kObject) == "s.toml:2: " + unknown("contact.k"));
  CHECK(rejection(kObject + "mesh = 1\n") == "s.toml:3: " + unknown("object[0].mesh"));
}

TEST_CASE("every scene in configs is a scene, and its models have configurations") {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(IRDM_SOURCE_DIR "/configs/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    CAPTURE(entry.path());
    const SceneConfig read = read_scene(TomlTable::parse_file(entry.path()));
    for (const ObjectConfig& object : read.objects) {  // scripts/play.sh makes it from there
      const auto config = object.model.filename().replace_extension(".toml");
      CHECK(std::filesystem::exists(std::filesystem::path(IRDM_SOURCE_DIR "/configs/models") /
                                    config));
    }
    ++scenes;
  }
  CHECK(scenes >= 10);
}

TEST_CASE("a file that cannot be read is told") {
  CHECK_THROWS_WITH(read_text("/nowhere/at/all"), "/nowhere/at/all: no such file; check the path");
}

TEST_CASE("objects of one file have one model, but where each has its own budget") {
  const test::TemporaryFolder folder;
  const Model cube = test::with_dense_response<float>(test::synthetic_cube(2, 3, 4));
  SceneConfig config;
  for (const char* name : {"a.h5", "b.h5", "a.h5", "a.h5", "a.h5"}) {
    test::write_dense_model(cube, folder.path() / name);
    ObjectConfig object;
    object.model = folder.path() / name;
    object.engine = ResponseKind::kDense;
    if (config.objects.size() > 2) object.memory_budget = 10.0;
    config.objects.push_back(object);
  }
  const auto objects = simulation_config(config, false).objects;
  CHECK(objects[0].model == objects[2].model);
  CHECK(objects[0].model != objects[1].model);
  CHECK(objects[0].model != objects[3].model);
  CHECK(objects[3].model != objects[4].model);
}

TEST_CASE("names of objects and keys of their contacts are a part of what is simulated") {
  const test::TemporaryFolder folder;
  SceneConfig config;
  config.objects.resize(2);
  config.objects[0].name = "cube";
  config.objects[1].name = "lid";
  for (ObjectConfig& object : config.objects) {
    object.model = folder.path() / "cube.h5";
  }
  {
    ModelFileWriter writer(config.objects[0].model);
    writer.write_description(test::made_rigid(test::synthetic_cube(2, 3, 4)));
    writer.commit();
  }
  SimulationConfig simulated = simulation_config(config, false);
  CHECK(simulated.objects[0].name == "cube");
  CHECK(simulated.objects[1].name == "lid");
  CHECK(simulated.between_objects);
  CHECK(simulated.contact_samples == 384);
  CHECK_FALSE(simulated.self_contact);
  CHECK(simulated.sleep_time == 0.5);
  config.contact.between_objects = false;
  config.contact.self = true;
  config.contact.samples = 16;
  config.contact.sleep_time = 0.0;
  simulated = simulation_config(config, false);
  CHECK_FALSE(simulated.between_objects);
  CHECK(simulated.self_contact);
  CHECK(simulated.contact_samples == 16);
  CHECK(simulated.sleep_time == 0.0);
}

TEST_CASE("a rigid body is taken whatever the engine, but not with inertial loading") {
  const test::TemporaryFolder folder;
  ObjectConfig object;
  object.model = folder.path() / "cube.h5";
  {
    ModelFileWriter writer(object.model);
    writer.write_description(test::made_rigid(test::synthetic_cube(2, 3, 4)));
    writer.commit();
  }
  SceneConfig config;
  for (const ResponseKind engine :
       {ResponseKind::kModal, ResponseKind::kDense, ResponseKind::kCompressed}) {
    object.engine = engine;
    config.objects.push_back(object);
  }
  config.objects[1].memory_budget = 10.0;
  SceneColumns columns(false);
  for (const SimulationObject& each : simulation_config(config, false, &columns).objects) {
    CHECK(is_rigid(*each.model));
  }
  config.objects[0].inertial_loading = true;
  CHECK_THROWS_WITH(simulation_config(config, false),
                    Catch::Matchers::ContainsSubstring("cube.h5: is of a rigid body"));
}
