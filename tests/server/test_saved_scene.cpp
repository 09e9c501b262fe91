// Settings of a run as a new scene.
#include <sys/stat.h>

#include <fstream>

#include "common/error.hpp"
#include "scene/saved_scene.hpp"
#include "server/prepared_run.hpp"
#include "tests/server/model_files.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;
namespace fs = std::filesystem;

namespace {

const std::string kText =
    "# a comment\n[server]\nport = 4711\nblack_box = \"boxes\"\n[floor]\nheight = -0.3\n"
    "[[stylus]]\nradius = 0.01\n"
    "[[object]]\nname = \"\xC3\xA4 \\\"b\\\"\"\nmodel = \"models/cube.h5\"\ndamping.linear = 0.5\n"
    "[[object]]\nname = \"second\"\nmodel = \"models/cube.h5\"\nposition = [0, 1, 0]\n"
    "[[scenery]]\nname = \"bowl\"\nmesh = { model = \"models/bowl.h5\" }\n";

/// A scene in a folder of its own, and what its settings are.
struct Original {
  Original() {
    fs::create_directories(folder.path() / "from" / "models");
    fs::create_directories(folder.path() / "to");
    source = {(folder.path() / "from" / "two.toml").string(), kText, folder.path() / "from"};
    write_cube_model(folder.path() / "from" / "models" / "cube.h5");
    const SceneConfig scene = read_scene(source);
    initial.gravity = scene.world.gravity;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
      const ObjectConfig& object = scene.objects[i];
      initial.object[i] = {object.friction, object.damping, object.tether};
    }
    settings = initial;
  }
  fs::path to() const { return folder.path() / "to"; }
  SceneSource saved(const std::string& name) const { return read_scene_source(to() / name); }

  TemporaryFolder folder;
  SceneSource source;
  Settings initial, settings;
};

std::size_t files_in(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST_CASE("saved settings come back to the bit, the rest of the scene is as it was") {
  Original original;
  original.settings.gravity = Vector3(0.1, -9.81, 1.0 / 3.0);
  original.settings.object[1] = {{0.7, 0.1 + 0.2}, {1e-3, 3.0}, {123.456, 0.1}, 2.5, true};
  const std::string name =
      save_scene(original.source, original.initial, original.settings, original.to());
  CHECK(name == "two-1.toml");
  const SceneConfig before = read_scene(original.source);
  const SceneConfig after = read_scene(original.saved(name));
  CHECK(after.world.gravity == original.settings.gravity);
  REQUIRE(after.objects.size() == 2);
  CHECK(after.objects[0].damping == before.objects[0].damping);
  CHECK(after.objects[0].name == before.objects[0].name);
  const ObjectConfig& changed = after.objects[1];
  CHECK(changed.friction == original.settings.object[1].friction);
  CHECK(changed.damping == original.settings.object[1].damping);
  CHECK(changed.tether == original.settings.object[1].tether);
  CHECK(changed.material_damping == 2.5);
  CHECK(changed.inertial_loading);
  CHECK(changed.position == Vector3(0, 1, 0));
  CHECK(after.server.port == 4711);
  CHECK(after.floor->height == -0.3);
  CHECK(after.styluses.at(0).radius == 0.01);
}

TEST_CASE("only what was changed is written") {
  Original original;
  original.settings.object[0].tether = {20.0, 0.5};
  const std::string text =
      scene_text_with(original.source, original.initial, original.settings, original.source.folder);
  CHECK_THAT(text, ContainsSubstring("tether = { angular_stiffness = 0.5, stiffness = 20.0 }"));
  CHECK_THAT(text, !ContainsSubstring("gravity") && !ContainsSubstring("friction") &&
                       !ContainsSubstring("material_damping") &&
                       !ContainsSubstring("inertial_loading"));
  CHECK_THAT(text,
             ContainsSubstring("\"models/cube.h5\"") || ContainsSubstring("'models/cube.h5'"));
}

TEST_CASE("paths of a saved scene lead to the same files from another folder") {
  const Original original;
  const std::string name =
      save_scene(original.source, original.initial, original.settings, original.to());
  const SceneConfig after = read_scene(original.saved(name));
  const fs::path from = fs::canonical(original.source.folder);
  const auto same = [](const fs::path& path) { return fs::weakly_canonical(path); };
  for (const ObjectConfig& object : after.objects) {
    CHECK(same(object.model) == from / "models/cube.h5");
    CHECK(fs::exists(object.model));
  }
  CHECK(same(after.scenery_models.at(0)) == from / "models/bowl.h5");
  CHECK(same(after.server.black_box.folder) == from / "boxes");
}

TEST_CASE("a saved scene takes the first free number, and no other file's name") {
  Original original;
  std::ofstream(original.to() / "two-1.toml") << "mine";
  fs::create_directory(original.to() / "two-2.toml");
  fs::create_symlink("nowhere", original.to() / "two-3.toml");
  const auto save = [&](const SceneSource& source) {
    return save_scene(source, original.initial, original.settings, original.to());
  };
  CHECK(save(original.source) == "two-4.toml");
  CHECK(save(original.saved("two-4.toml")) == "two-5.toml");
  CHECK(read_text(original.to() / "two-1.toml") == "mine");
  original.source.name = "scenes/of-2024.toml";
  CHECK(save(original.source) == "of-2024-1.toml");
  original.source.name = ".toml";
  CHECK(save(original.source) == "scene-1.toml");
  struct stat status {};
  REQUIRE(::stat((original.to() / "two-4.toml").c_str(), &status) == 0);
  CHECK((status.st_mode & 0777) == 0644);
}

TEST_CASE("a saved scene names the files of its tokens, from its own folder") {
  Original original;
  original.source.text +=
      "[viewer]\ntoken_file = \"irdm.token\"\nonlooker_token_file = \"watch.token\"\n";
  const std::string name =
      save_scene(original.source, original.initial, original.settings, original.to());
  const ViewerConfig viewer = read_scene(original.saved(name)).viewer;
  CHECK(fs::weakly_canonical(*viewer.token_file) ==
        fs::weakly_canonical(original.folder.path() / "from" / "irdm.token"));
  CHECK(viewer.onlooker_token_file->filename() == "watch.token");
}

TEST_CASE("a saved scene holds no token, and has the permissions that the umask leaves") {
  Original original;
  original.source.text +=
      "[viewer]\ntoken = \"0123456789abcdef\"\nonlooker_token = "
      "\"fedcba9876543210\"\nport = 8080\n";
  ::umask(027);
  const std::string name =
      save_scene(original.source, original.initial, original.settings, original.to());
  const std::string text = original.saved(name).text;
  CHECK(text.find("0123456789abcdef") == std::string::npos);
  CHECK(text.find("fedcba9876543210") == std::string::npos);
  CHECK_THAT(text, ContainsSubstring("8080"));
  struct stat status {};
  REQUIRE(::stat((original.to() / name).c_str(), &status) == 0);
  CHECK((status.st_mode & 0777) == 0640);
}

TEST_CASE("the scene in a trace has its tokens emptied, and all else to the byte") {
  Original original;
  // Escapes, a comment that looks like a key, characters of several bytes, and the other quotes.
  const std::string objects = kText.substr(0, kText.find("[[scenery]]"));
  const std::string before = objects + "[viewer]  # token = \"no value\"\nport = 8080\n";
  original.source.text = before + "token = \"0123456789abcd\\u0065f\"  # \xC3\xA4\n" +
                         "onlooker_token = 'fedcba9876543210'\n";
  const SceneConfig scene = read_scene(original.source);
  REQUIRE(scene.viewer.token == "0123456789abcdef");
  const std::string blank = without_secrets(original.source);
  CHECK(blank == before + "token = \"\"  # \xC3\xA4\nonlooker_token = \"\"\n");
  const PreparedRun run(original.source, scene, false, true);
  CHECK(run.header.scene == blank);
  original.source.text = kText;
  CHECK(without_secrets(original.source) == kText);
  original.source.text = kText + "[viewer]\n\"token\" = \"\"\"0123456789abcdef\"\"\"\n";
  CHECK(without_secrets(original.source) == kText + "[viewer]\n\"token\" = \"\"\n");
}

TEST_CASE("what cannot be saved is refused, and leaves nothing") {
  Original original;
  const auto refusal = [&](const fs::path& folder) -> std::string {
    try {
      return save_scene(original.source, original.initial, original.settings, folder);
    } catch (const Error& error) {
      return error.what();
    }
  };
  SECTION("no folder") {
    CHECK_THAT(refusal(original.folder.path() / "missing"), ContainsSubstring("takes no new file"));
  }
  SECTION("a setting that no scene may have") {
    original.settings.object[0].damping.linear = 500.0;
    CHECK_THAT(refusal(original.to()), ContainsSubstring("damping.linear is 500"));
  }
  SECTION("a scene that is none") {
    original.source.text += "[[object]]\nmodel = 3\n";
    CHECK_THAT(refusal(original.to()), ContainsSubstring("model is not text"));
  }
  CHECK(files_in(original.to()) == 0);
}

TEST_CASE("a damping of the material is read, and refused where it cannot be") {
  const TemporaryFolder folder;
  write_cube_model(folder.path() / "cube.h5");
  const auto config = [&](const std::string& more) {
    const SceneSource source{
        "s.toml", "[[object]]\nmodel = \"cube.h5\"\nmaterial_damping = 3\n" + more, folder.path()};
    return simulation_config(read_scene(source), false);
  };
  CHECK(initial_settings(config("")).object[0].material_damping == 3.0);
  CHECK_THROWS_WITH(config("[floor]\n"),
                    ContainsSubstring("cannot change the damping of its material"));
  CHECK_THROWS_WITH(
      config("[[object]]\nname = \"b\"\nmodel = \"cube.h5\"\nmaterial_damping = 11\n"),
      ContainsSubstring("material_damping is 11"));
}
