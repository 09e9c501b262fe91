// A folder of scenes to choose from: what is listed, and what becomes of a name.
#include <fstream>

#include "common/error.hpp"
#include "scene/model_scene.hpp"
#include "scene/scene_folder.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/server/model_files.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

void write_text(const std::filesystem::path& path, const std::string& text = "[[object]]\n") {
  std::ofstream(path) << text;
}

using SceneNames = std::vector<std::string>;

}  // namespace

TEST_CASE("scenes and models directly in the folder are listed, sorted, and nothing else") {
  const TemporaryFolder folder;
  write_text(folder.path() / "b.toml");
  write_text(folder.path() / "a b.toml", "[world]\n\n\t[[object]] # one\n");
  write_text(folder.path() / "broken.toml", "[[object]]\nmodel = \n");
  write_text(folder.path() / "inline.toml", "object = [{ model = \"a.h5\" }]\n");
  write_text(folder.path() / "w\xC3\xBCrfel.h5", "no model, as it turns out");
  write_text(folder.path() / "bridge.toml", "[[device]]\n[[objects]]\n");
  write_text(folder.path() / "notes.txt");
  write_text(folder.path() / ".hidden.toml");
  write_text(folder.path() / "line\nbreak.toml");
  write_text(folder.path() / "caf\xE9.toml");  // ISO 8859-1
  write_text(folder.path() / (std::string(124, 'x') + ".toml"));
  std::filesystem::create_directory(folder.path() / "folder.toml");
  std::filesystem::create_directory(folder.path() / "inside");
  write_text(folder.path() / "inside" / "deeper.toml");
  CHECK(scenes_in(folder.path()) ==
        SceneNames{"a b.toml", "b.toml", "broken.toml", "inline.toml", "w\xC3\xBCrfel.h5"});
  CHECK(scenes_in(folder.path() / "missing").empty());
}

TEST_CASE("at most 200 scenes are listed") {
  const TemporaryFolder folder;
  for (int i = 1000; i < 1210; ++i) write_text(folder.path() / (std::to_string(i) + ".toml"));
  const SceneNames names = scenes_in(folder.path());
  REQUIRE(names.size() == kMostScenes);
  CHECK(names.back() == "1199.toml");
}

TEST_CASE("only a name of the list leads to a scene, whatever files there are") {
  const TemporaryFolder outside;
  write_text(outside.path() / "secret.toml");
  const std::filesystem::path folder = outside.path() / "scenes";
  std::filesystem::create_directory(folder);
  write_text(folder / "a.toml");
  CHECK(scene_in(folder, "a.toml").text == "[[object]]\n");
  CHECK(scene_in(folder, "a.toml").folder == folder);
  const std::string name =
      GENERATE("", ".", "..", "../secret.toml", "./a.toml", "a.toml/", "A.toml", "b.toml");
  CHECK_THROWS_WITH(scene_in(folder, name), ContainsSubstring("is not among the scenes any more"));
  CHECK_THROWS_AS(scene_in(folder, (outside.path() / "secret.toml").string()), Error);
}

TEST_CASE("a scene that is gone since it was listed is an error") {
  const TemporaryFolder folder;
  write_text(folder.path() / "a.toml");
  CHECK(scenes_in(folder.path()).size() == 1);
  std::filesystem::remove(folder.path() / "a.toml");
  CHECK_THROWS_AS(scene_in(folder.path(), "a.toml"), Error);
}

TEST_CASE("a model alone is a scene of one object, on a soft tether where it floats") {
  const TemporaryFolder folder;
  const Support support = GENERATE(Support::kFloating, Support::kFixed);
  write_cube_model(folder.path() / "my cube.h5", support);
  const SceneSource source = scene_in(folder.path(), "my cube.h5");
  const SceneConfig scene = read_scene(source);
  REQUIRE(scene.objects.size() == 1);
  CHECK(scene.objects[0].name == "my cube");
  CHECK(scene.objects[0].model == folder.path() / "my cube.h5");
  CHECK(scene.contact.coupling_stiffness == 300.0);
  CHECK(scene.world.gravity.isZero(0.0));
  CHECK((scene.objects[0].tether.stiffness > 0.0) == (support == Support::kFloating));
  CHECK_NOTHROW(Simulation(simulation_config(scene, false)));
}

TEST_CASE("a rigid body and a file that is no model, as scenes") {
  const TemporaryFolder folder;
  {
    ModelFileWriter writer(folder.path() / "rigid.h5");
    writer.write_description(made_rigid(synthetic_cube(2, 3, 4)));
    writer.commit();
  }
  CHECK_NOTHROW(
      Simulation(simulation_config(read_scene(model_scene(folder.path() / "rigid.h5")), false)));
  write_text(folder.path() / "text.h5", "no model");
  CHECK_THROWS_WITH(model_scene(folder.path() / "text.h5"), ContainsSubstring("text.h5"));
}

TEST_CASE("a scene of absurd size is listed without being read, and refused by its size") {
  const TemporaryFolder folder;
  write_text(folder.path() / "big.toml");
  std::filesystem::resize_file(folder.path() / "big.toml", 3'000'000'000);
  write_text(folder.path() / "zeros.toml", "");
  std::filesystem::resize_file(folder.path() / "zeros.toml", 3'000'000'000);
  CHECK(scenes_in(folder.path()) == SceneNames{"big.toml"});
  CHECK_THROWS_WITH(scene_in(folder.path(), "big.toml"),
                    ContainsSubstring("big.toml: has 3000000000 bytes"));
}
