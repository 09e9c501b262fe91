// What a person does wrongly in the first hours: the exit status, one line, and what to do.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/system/stage.hpp"

using Catch::Matchers::ContainsSubstring;
using Catch::Matchers::StartsWith;
using namespace irdm;
using namespace irdm::test;

namespace {

/// One change of a file that is right, or another command line.
struct Mistake {
  std::string file;                     ///< that is changed; empty: none
  std::string right;                    ///< in it; empty: it is replaced whole
  std::string wrong;                    ///< in its place
  std::string complaint;                ///< of the program
  std::string remedy;                   ///< that it names
  std::vector<std::string> words = {};  ///< in place of the usual command line
};

const std::string kModelConfig =
    "[mesh]\nfile = \"part.obj\"\nunit = \"mm\"\nedge_length = 0.04\n[material]\n"
    "youngs_modulus = 2000\npoisson_ratio = 0.3\ndensity = 110\nrayleigh_alpha = 0\n"
    "rayleigh_beta = 1e-3\n[response]\ndt = 0.002\nsteps = 100\n";
const std::string kPart =
    "v 0 0 0\nv 0 0 120\nv 0 120 0\nv 0 120 120\nv 120 0 0\nv 120 0 120\nv 120 120 0\n"
    "v 120 120 120\nf 1 2 4\nf 1 4 3\nf 5 7 8\nf 5 8 6\nf 1 5 6\nf 1 6 2\nf 3 4 8\nf 3 8 7\n"
    "f 1 3 7\nf 1 7 5\nf 2 6 8\nf 2 8 4\n";

/// A folder in which all is right, as a person would have it.
class Desk {
 public:
  Desk() {
    stage_.write("model.toml", kModelConfig);
    stage_.write("part.obj", kPart);
    stage_.write("note.txt", "not a model");
    std::filesystem::create_directory(path("folder"));
    std::filesystem::copy_file(cube_model(), path("cube.h5"));
    stage_.write("scene.toml",
                 "[server]\nport = 0\n[contact]\ncoupling_stiffness = 2000\n[[stylus]]\n"
                 "radius = 0.01\n[[object]]\nname = \"cube\"\nmodel = \"cube.h5\"\n");
  }

  std::string path(const std::string& name) const { return stage_.path(name).string(); }

  FinishedProgram make(const std::string& program, const Mistake& mistake) const {
    if (!mistake.file.empty()) {
      std::string text = mistake.wrong;
      if (!mistake.right.empty()) {
        text = file_content(stage_.path(mistake.file));
        const std::size_t at = text.find(mistake.right);
        REQUIRE(at != std::string::npos);
        text.replace(at, mistake.right.size(), mistake.wrong);
      }
      stage_.write(mistake.file, text);
    }
    std::vector<std::string> words = mistake.words.empty() ? usual(program) : mistake.words;
    // A word with @ before it is a path on the desk.
    for (std::string& word : words) {
      if (word.starts_with('@')) word = path(word.substr(1));
    }
    words.insert(words.begin(), program);
    return run_to_end(words);
  }

 private:
  static std::vector<std::string> usual(const std::string& program) {
    if (program == IRDM_PRECOMPUTE) return {"@model.toml", "-o", "@model.h5"};
    if (program == IRDM_SERVER) return {"@scene.toml", "--no-viewer", "--duration", "0.1"};
    if (program == IRDM_BRIDGE) return {"@bridge.toml", "--server", "127.0.0.1:1"};
    return {"@trace.h5", "--csv", "@run.csv"};
  }

  Stage stage_;
};

void check(const std::string& program, const std::vector<Mistake>& mistakes) {
  for (const Mistake& mistake : mistakes) {
    const Desk desk;
    const FinishedProgram ended = desk.make(program, mistake);
    CAPTURE(mistake.file, mistake.wrong, mistake.words, ended.out);
    CHECK(ended.status == 1);
    CHECK(std::count(ended.err.begin(), ended.err.end(), '\n') == 1);
    CHECK_THAT(ended.err,
               StartsWith(std::filesystem::path(program).filename().string() + ": error: ") &&
                   ContainsSubstring(mistake.complaint) && ContainsSubstring("; ") &&
                   ContainsSubstring(mistake.remedy));
    CHECK_FALSE(std::filesystem::exists(desk.path("model.h5")));
  }
}

}  // namespace

TEST_CASE("mistakes: a model") {
  check(
      IRDM_PRECOMPUTE,
      {{"", "", "", "mdoel.toml: no such file", "check the path", {"@mdoel.toml", "-o", "@m.h5"}},
       {"", "", "", "folder: is a folder", "give the path of a file", {"@folder", "-o", "@m.h5"}},
       {"",
        "",
        "",
        "cannot be created",
        "check that the folder",
        {"@model.toml", "-o", "@no/m.h5"}},
       {"model.toml", "[material]", "[material", "model.toml:5: ", "correct the TOML syntax"},
       {"model.toml", "youngs_modulus", "young_modulus", "material.youngs_modulus is missing",
        "is it 'young_modulus'?"},
       {"model.toml", "steps", "step", "response.step is not a known key", "did you mean 'steps'?"},
       {"model.toml", "[material]", "[materials]", "material is missing", "is it 'materials'?"},
       {"model.toml", "2000", "\"2 kPa\"", "youngs_modulus is not a number",
        "give a finite number"},
       {"model.toml", "0.3", "0.5", "poisson_ratio is 0.5", "<= 0.499999"},
       {"model.toml", "110", "-110", "density is -110", "give a finite number >="},
       {"model.toml", "dt = 0.002", "dt = 2", "response.dt is 2", "<= 1"},
       {"model.toml", "unit = \"mm\"", "unit = \"inch\"", "mesh.unit is 'inch'", "give one of: "},
       {"model.toml", "unit = \"mm\"\n", "", "mesh.edge_length is 0.000192", "mesh.unit"},
       {"model.toml", "part.obj", "prat.obj", "prat.obj: no such file", "check the path"},
       {"part.obj", "", "", "part.obj: is empty", "write the mesh again"},
       {"part.obj", "f 2 8 4\n", "", "part.obj: ", "close"},
       {"part.obj", "f 2 8 4", "f 2 8 44", "part.obj:21: vertex '44'", ""},
       {"model.toml", "steps = 100", "support = \"fixed\"", "support is missing", "add"},
       {"", "", "", "mesh is missing", "add it", {"@scene.toml", "-o", "@m.h5"}},
       {"", "", "", "note.txt: is not a complete HDF5 file", "make it", {"check", "@note.txt"}},
       {"",
        "",
        "",
        "is the input itself",
        "another name",
        {"compress", "@cube.h5", "-o", "@cube.h5"}},
       {"", "", "", "is the input itself", "another name", {"@model.toml", "-o", "@model.toml"}},
       {"", "", "", "is the input itself", "another name", {"@model.toml", "-o", "@part.obj"}},
       {"", "", "", "folder: is a folder", "name of a file", {"@model.toml", "-o", "@folder"}},
       {"",
        "",
        "",
        "cannot be created",
        "check that the folder",
        {"compress", "@cube.h5", "-o", "@no/c.h5"}},
       {"",
        "",
        "",
        "cube.h5: is not a part of R",
        "--columns",
        {"merge", "@cube.h5", "-o", "@m.h5"}}});
}

TEST_CASE("mistakes: a scene") {
  check(IRDM_SERVER,
        {{"", "", "", "secne.toml: no such file", "check the path", {"@secne.toml"}},
         {"", "", "", "folder: is a folder", "give the path of a file", {"@folder"}},
         {"", "", "", "cube.h5: has ", "give a text file", {"@cube.h5"}},
         {"scene.toml", "model =", "modle =", "object[0].model is missing", "is it 'modle'?"},
         {"scene.toml", "radius", "raduis", "stylus[0].raduis is not a known key",
          "did you mean 'radius'?"},
         {"scene.toml", "cube.h5", "cub.h5", "cub.h5: no such file", "check the path"},
         {"scene.toml", "cube.h5", "folder", "folder: is a folder", "give the path of a file"},
         {"scene.toml", "cube.h5", "note.txt", "note.txt: is not a complete HDF5 file", "make it"},
         {"scene.toml", "\"cube.h5\"", "\"cube.h5\"\nengine = \"dens\"", "engine is 'dens'",
          "give one of: "},
         {"scene.toml", "2000", "-2000", "coupling_stiffness is -2000", "give a finite number"},
         {"scene.toml", "port = 0", "port = 70000", "server.port is 70000", "0 to 65535"},
         {"scene.toml", "[[object]]", "[object]", "is not a list of tables", "[[object]]"},
         {"",
          "",
          "",
          "cannot be created",
          "check that the folder exists",
          {"@scene.toml", "--record", "@no/trace.h5", "--duration", "0.1"}},
         {"", "", "", "exists already", "another name", {"@scene.toml", "--record", "@note.txt"}},
         {"", "", "", "cube.h5: is not a trace", "--record", {"@scene.toml", "--play", "@cube.h5"}},
         {"", "", "", "object is missing", "add [[object]]", {"@bridge.toml"}},
         {"scene.toml", "\"cube\"", "\"a/b\"", "name cannot name a group", "without '/'"},
         {"scene.toml", "0.01", "0.5", "is too large for an object", "a coarser mesh"},
         {"scene.toml", "port = 0", "address = \"0.0.0.0\"", "from other machines", "key_file"},
         {"scene.toml", "port = 0", "key_file = \"no.key\"", "there is no such file",
          "make one with"},
         {"scene.toml", "[server]", "[viewer]\ntoken = \"1\"\n[server]",
          "viewer.token is not 16 to", "openssl rand"}});
}

TEST_CASE("mistakes: two objects") {
  // Beside the cube of scene.toml.
  const auto second = [](const std::string& rest) {
    return "[[object]]\n" + rest + "\n[[object]]\nname = \"cube\"";
  };
  const std::string first = "[[object]]\nname = \"cube\"";
  const TemporaryFolder folder("irdm-mistakes");
  const std::string config = (folder.path() / "fast.toml").string();
  const std::string model = (folder.path() / "fast.h5").string();
  std::string text = file_content(IRDM_SOURCE_DIR "/tests/system/cube.toml");
  text.replace(text.find("dt = 0.002"), 10, "dt = 0.001");
  std::ofstream(config) << text;
  REQUIRE(run_to_end({IRDM_PRECOMPUTE, config, "-o", model}).status == 0);
  check(IRDM_SERVER,
        {{"scene.toml", first, second("model = \"" + model + "\"\nposition = [1, 0, 0]"),
          "models of different dt", "the same response.dt"},
         {"scene.toml", first, second("name = \"cube\"\nmodel = \"cube.h5\""), "appears twice",
          "a name of its own"},
         {"scene.toml", first, second("model = \"cube.h5\"\nposition = [0.1, 0, 0]"),
          "inside one another", "move them apart"}});
}

TEST_CASE("mistakes: a trace") {
  const Stage stage;
  const std::string trace = record(stage, true).string();
  const std::string object = "[[object]]\nname = \"cube\"";
  const std::vector<std::string> play{"@scene.toml", "--play", trace};
  const std::string recorded = "was recorded with another scene: 1 object (cube) and 1 stylus; ";
  const std::string remedy = "give the scene that it was recorded with";
  check(
      IRDM_SERVER,
      {{"scene.toml", object,
        "[[object]]\nname = \"ball\"\nmodel = \"cube.h5\"\nposition = [1, 0, 0]\n" + object,
        recorded, "has 2 objects (ball, cube) and 1 stylus; " + remedy, play},
       {"scene.toml", "\"cube\"", "\"ball\"", recorded, "has 1 object (ball) and 1 stylus; ", play},
       {"scene.toml", object, "[[stylus]]\nradius = 0.01\n" + object, recorded,
        "has 1 object (cube) and 2 styluses; " + remedy, play}});
  check(IRDM_PRECOMPUTE, {{"",
                           "",
                           "",
                           "is not a model file: it is a trace",
                           "that irdm-precompute has made",
                           {"check", trace}}});
}

TEST_CASE("mistakes: commands and options") {
  struct Misspelt {
    std::vector<std::string> words;
    std::string meant;
  };
  const std::vector<Misspelt> commands{
      {{IRDM_PRECOMPUTE, "chek", "cube.h5"}, "did you mean check in place of chek?"},
      {{IRDM_PRECOMPUTE, "chek"}, "did you mean check in place of chek?"},
      {{IRDM_PRECOMPUTE, "check", "cube.h5", "--hand-mas", "1"},
       "did you mean --hand-mass in place of --hand-mas?"},
      {{IRDM_PRECOMPUTE, "cube.toml", "--outptu=cube.h5"},
       "did you mean --output in place of --outptu?"},
      {{IRDM_SERVER, "scene.toml", "--recrod", "trace.h5"},
       "did you mean --record in place of --recrod?"},
      {{IRDM_BRIDGE, "doctr"}, "did you mean doctor in place of doctr?"},
      {{IRDM_BRIDGE, "bridge.toml", "--sevrer", "localhost:1"},
       "did you mean --server in place of --sevrer?"},
      {{IRDM_REPLAY, "compar", "a.h5", "b.h5"}, "did you mean compare in place of compar?"}};
  for (const Misspelt& misspelt : commands) {
    const FinishedProgram ended = run_to_end(misspelt.words);
    CAPTURE(misspelt.words);
    CHECK(ended.status == 2);
    CHECK_THAT(ended.err, ContainsSubstring(misspelt.meant + "\n"));
  }
  CHECK_THAT(run_to_end({IRDM_SERVER, "scene.toml", "--frobnicate"}).err,
             !ContainsSubstring("did you mean"));
}

TEST_CASE("mistakes: a bridge") {
  check(IRDM_BRIDGE,
        {{"", "", "", "bridge.tml: no such file", "check the path", {"@bridge.tml"}},
         {"", "", "", "folder: is a folder", "give the path of a file", {"@folder"}},
         {"", "", "", "no server is named", "--server HOST:PORT", {"@bridge.toml"}},
         {"",
          "",
          "",
          "'localhost' has no port",
          "HOST:PORT",
          {"@bridge.toml", "--server", "localhost"}},
         {"bridge.toml", "virtual", "vrtual", "type is 'vrtual'", "give one of: "},
         {"bridge.toml", "script.csv", "scirpt.csv", "scirpt.csv: no such stylus script", ""},
         {"bridge.toml", "mass", "maas", "hand.maas is not a known key", "did you mean 'mass'?"},
         {"bridge.toml", "0.12", "0", "mass is 0", "give a finite number >= 0.001"},
         {"script.csv", "time,", "t,", "script.csv:1: ", "time,x,y,z"},
         {"script.csv", "0.1,", "9,", "does not come after the row before", "sort the rows"},
         {"script.csv", "0,0.01,", "0;0.01;", "script.csv:2: has ", "as the header says"},
         {"bridge.toml", "script = \"script.csv\"", "", "has no script", "--script FILE.csv"},
         {"",
          "",
          "",
          "is not a known key",
          "correct its name",
          {"@scene.toml", "--server", "localhost:1"}},
         {"",
          "",
          "",
          "is the address of a page",
          "HOST:PORT for bridges",
          {"@bridge.toml", "--server", "http://127.0.0.1:1"}},
         {"",
          "",
          "",
          "is not a server",
          "1 to 65535",
          {"@bridge.toml", "--server", "localhost:99999"}},
         {"",
          "",
          "",
          "there is no key",
          "key_file",
          {"@bridge.toml", "--server", "192.0.2.1:4000"}}});
}

TEST_CASE("mistakes: a replay") {
  check(
      IRDM_REPLAY,
      {{"", "", "", "trace.h5: no such file", "check the path"},
       {"", "", "", "folder: is a folder", "give the path of a file", {"@folder"}},
       {"", "", "", "cube.h5: is not a trace", "", {"@cube.h5"}},
       {"", "", "", "note.txt: is not a complete HDF5 file", "make it again", {"@note.txt"}},
       {"", "", "", "is not a run file", "--output RUN.h5", {"compare", "@cube.h5", "@cube.h5"}}});
}
