// Scenes that are prepared and saved beside a run.
#include <fstream>
#include <optional>

#include "common/error.hpp"
#include "server/scene_loader.hpp"
#include "server/viewer_session/scene_choice.hpp"
#include "tests/server/model_files.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

/// A folder with a scene that is good, one that is not, and a run of the first.
struct Desk {
  Desk() {
    write_cube_model(folder.path() / "cube.h5");
    std::ofstream(path("good.toml")) << "[[object]]\nmodel = \"cube.h5\"\n";
    std::ofstream(path("bad.toml")) << "[[object]]\nmodel = \"missing.h5\"\n";
    run = prepare(read_scene_source(path("good.toml")));
    run->name = "good.toml";
    loader_.emplace(folder.path(), prepare);
  }
  SceneLoader& loader() { return *loader_; }
  std::filesystem::path path(const std::string& name) const { return folder.path() / name; }
  static std::unique_ptr<PreparedRun> prepare(const SceneSource& source) {
    return std::make_unique<PreparedRun>(source, read_scene(source), false, false);
  }

  TemporaryFolder folder;
  std::unique_ptr<PreparedRun> run;
  std::optional<SceneLoader> loader_;  ///< when the files are there
};

viewer::State state_of(SceneChoice& choice, std::string& notice) {
  viewer::State state;
  choice.report(state, notice);
  return state;
}

}  // namespace

TEST_CASE("a scene that is chosen is prepared once, and taken") {
  Desk desk;
  SceneLoader& loader = desk.loader();
  loader.start();
  CHECK(loader.take() == nullptr);
  SceneChoice choice(loader, *desk.run, "");
  std::string notice;
  CHECK(state_of(choice, notice).scenes ==
        std::vector<std::string>{"bad.toml", "cube.h5", "good.toml"});
  CHECK(state_of(choice, notice).scene == 2);
  choice.load("cube.h5");
  CHECK(choice.preparing());
  CHECK_THROWS_WITH(choice.load("good.toml"), ContainsSubstring("busy"));
  REQUIRE(loader.ready().wait(kDeadlineMs));
  CHECK(choice.preparing());
  const auto prepared = loader.take();
  REQUIRE(prepared);
  CHECK(prepared->name == "cube.h5");
  CHECK(prepared->greeting == "loaded: cube.h5");
  CHECK(prepared->scene.objects.at(0).name == "cube");
  CHECK(loader.take() == nullptr);
  CHECK(eventually([&] { return !choice.preparing(); }));
  CHECK(notice.empty());
}

TEST_CASE("a scene that cannot be loaded is one notice, and the loader goes on") {
  Desk desk;
  desk.loader().start();
  SceneChoice choice(desk.loader(), *desk.run, "");
  std::string notice;
  choice.load("bad.toml");
  CHECK(eventually([&] { return !state_of(choice, notice).preparing; }));
  CHECK_THAT(notice, ContainsSubstring("missing.h5"));
  CHECK(desk.loader().take() == nullptr);
  notice.clear();
  state_of(choice, notice);
  CHECK(notice.empty());
  choice.load("good.toml");
  CHECK(desk.loader().ready().wait(kDeadlineMs));
}

TEST_CASE("settings are saved beside the scenes and listed") {
  Desk desk;
  desk.loader().start();
  SceneChoice choice(desk.loader(), *desk.run, "");
  Settings settings = initial_settings(desk.run->config);
  settings.object[0].tether.stiffness = 12.5;
  choice.save(settings);
  std::string notice;
  CHECK(eventually([&] { return !state_of(choice, notice).preparing; }));
  CHECK(notice == "saved: good-1.toml");
  const std::vector<std::string> names = state_of(choice, notice).scenes;
  CHECK(std::find(names.begin(), names.end(), "good-1.toml") != names.end());
  CHECK(read_scene(read_scene_source(desk.path("good-1.toml"))).objects[0].tether.stiffness ==
        12.5);
}

TEST_CASE("a server saves at most 100 scenes, whichever run asks") {
  Desk desk;
  desk.loader().start();
  const Settings settings = initial_settings(desk.run->config);
  std::string notice;
  for (std::size_t i = 0; i < viewer::kMaxSaves; ++i) {
    SceneChoice choice(desk.loader(), *desk.run, "");
    choice.save(settings);
    REQUIRE(eventually([&] { return !state_of(choice, notice).preparing; }));
    REQUIRE(notice == "saved: good-" + std::to_string(i + 1) + ".toml");
  }
  SceneChoice choice(desk.loader(), *desk.run, "");
  CHECK_THROWS_WITH(choice.save(settings), ContainsSubstring("saved 100 times already"));
  CHECK_FALSE(std::filesystem::exists(desk.path("good-101.toml")));
}

TEST_CASE("a file that comes while the server runs is listed") {
  Desk desk;
  desk.loader().start();
  std::ofstream(desk.path("new.toml")) << "[[object]]\n";
  CHECK(eventually([&] { return desk.loader().status().names.size() == 4; }));
}

TEST_CASE("what cannot be asked for is refused with the reason") {
  Desk desk;
  SceneChoice choice(desk.loader(), *desk.run, "this run is in lockstep");
  CHECK_THROWS_WITH(choice.load("good.toml"), ContainsSubstring("lockstep"));
  std::string notice;
  CHECK_FALSE(state_of(choice, notice).can_load);
  SceneChoice free(desk.loader(), *desk.run, "");
  CHECK_THROWS_WITH(free.load("../good.toml"), ContainsSubstring("is not among the scenes"));
  SceneLoader without(std::nullopt, Desk::prepare);
  SceneChoice none(without, *desk.run, "");
  CHECK_THROWS_WITH(none.load("good.toml"), ContainsSubstring("--scenes"));
  CHECK_THROWS_WITH(none.save({}), ContainsSubstring("--scenes"));
  CHECK_FALSE(state_of(none, notice).has_scenes);
}
