// Where the models of a trace are found.
#include <fstream>

#include "common/checksum.hpp"
#include "common/error.hpp"
#include "common/model/model_file.hpp"
#include "replay/traced_scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/synthetic_model.hpp"
#include "tests/support/temporary_folder.hpp"
#include "trace/trace_writer.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::replay;
using namespace irdm::test;

namespace {

/// A folder with a model, and one with a trace of as many objects of it.
struct Folders {
  explicit Folders(std::size_t objects = 1) {
    std::filesystem::create_directories(models);
    std::filesystem::create_directories(trace.parent_path());
    write_model(models / "cube.h5", 1);
    TraceHeader header{{}, "", 0.002, 1, false};
    for (std::size_t i = 0; i < objects; ++i) {
      const std::string name = "cube" + std::to_string(i);
      header.scene += "[[object]]\nname = \"" + name + "\"\nmodel = \"" +
                      (models / "cube.h5").string() + "\"\nposition = [" + std::to_string(i) +
                      ", 0, 0]\n";
      header.objects.push_back({name, "cube.h5", sha256_of_file(models / "cube.h5")});
    }
    TraceWriter(trace, header).close();
  }
  static void write_model(const std::filesystem::path& path, unsigned seed, double dt = 0.002) {
    Model model = synthetic_cube(2, 6, 10, 0.12, seed);
    model.dt = dt;
    ModelFileWriter writer(path);
    writer.write_description(model);
    writer.write_modal(std::get<ModalResponse>(model.response));
    writer.commit();
  }
  TracedScene read(const std::vector<std::string>& given = {},
                   std::optional<ResponseKind> engine = std::nullopt) const {
    return read_traced_scene(trace, given, engine);
  }

  TemporaryFolder folder;
  std::filesystem::path models = folder.path() / "models";
  std::filesystem::path trace = folder.path() / "traces" / "trace.h5";
  std::filesystem::path beside = folder.path() / "traces" / "cube.h5";
};

}  // namespace

TEST_CASE("the model of a trace is found where its scene says, and beside the trace") {
  const Folders folders;
  CHECK(folders.read().objects.at(0).model == folders.models / "cube.h5");
  std::filesystem::copy_file(folders.models / "cube.h5", folders.beside);
  CHECK(folders.read().objects.at(0).model == folders.beside);
  CHECK(folders.read().warnings.empty());
  // One of that name that is another model is passed over, as long as the right one is there.
  std::filesystem::remove(folders.beside);
  Folders::write_model(folders.beside, 7);
  CHECK(folders.read().objects.at(0).model == folders.models / "cube.h5");
  std::filesystem::remove(folders.models / "cube.h5");
  CHECK_THROWS_WITH(folders.read(),
                    ContainsSubstring("is not the model that") && ContainsSubstring("--model"));
  std::filesystem::remove(folders.beside);
  CHECK_THROWS_WITH(folders.read(), ContainsSubstring("recorded with cube.h5, which is not there"));
}

TEST_CASE("a model that is given may be another one, with a warning, but not of another dt") {
  const Folders folders;
  const std::filesystem::path other = folders.folder.path() / "other.h5";
  Folders::write_model(other, 7);
  const TracedScene scene = folders.read({other.string()});
  CHECK(scene.objects.at(0).checksum == sha256_of_file(other));
  REQUIRE(scene.warnings.size() == 1);
  CHECK_THAT(scene.warnings[0], ContainsSubstring("other.h5 is not the model"));
  CHECK(folders.read({(folders.models / "cube.h5").string()}).warnings.empty());
  Folders::write_model(folders.folder.path() / "fast.h5", 1, 0.001);
  CHECK_THROWS_WITH(folders.read({(folders.folder.path() / "fast.h5").string()}),
                    ContainsSubstring("has steps of 0.001"));
}

TEST_CASE("with several objects a given model names its own") {
  const Folders folders(2);
  const std::filesystem::path other = folders.folder.path() / "other.h5";
  Folders::write_model(other, 7);
  const TracedScene scene = folders.read({"cube1=" + other.string()});
  CHECK(scene.objects.at(0).model == folders.models / "cube.h5");
  CHECK(scene.objects.at(1).model == other);
  CHECK_THROWS_WITH(folders.read({other.string()}),
                    ContainsSubstring("names none of the 2 objects"));
  CHECK_THROWS_WITH(folders.read({"ball=" + other.string()}), ContainsSubstring("cube0="));
}

TEST_CASE("an engine that the model has no response for is refused") {
  const Folders folders;
  CHECK_THROWS_AS(folders.read({}, ResponseKind::kDense), Error);
  CHECK(folders.read({}, ResponseKind::kModal).engine_words() == "modal");
}
