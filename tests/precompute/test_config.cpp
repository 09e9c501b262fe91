#include <filesystem>

#include "precompute/config.hpp"
#include "precompute/mesh/mesh_check.hpp"
#include "precompute/mesh/mesh_file.hpp"
#include "precompute/mesh/surface.hpp"
#include "precompute/mesh/tet_mesh.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::precompute;

namespace {

const std::string kMesh = "[mesh]\nbox = { size = [0.1, 0.2, 0.3], cells = [1, 2, 3] }\n";
const std::string kMaterialTable =
    "[material]\nyoungs_modulus = 2000\npoisson_ratio = 0.3\ndensity = 110\n";

PrecomputeConfig read(const std::string& text) {
  return read_config(TomlTable::parse_text(text, "c.toml"), "c.toml");
}

void check_refused(const std::string& text, const std::string& message) {
  CAPTURE(text);
  CHECK_THROWS_WITH(read(text), ContainsSubstring(message) && ContainsSubstring("c.toml"));
}

std::string material(const std::string& key, const std::string& value) {
  std::string text = kMaterialTable;
  const auto start = text.find(key);
  if (start == std::string::npos) return text + key + " = " + value + "\n";
  return text.replace(start, text.find('\n', start) - start, key + " = " + value);
}

}  // namespace

TEST_CASE("every precompute configuration in configs/ loads") {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(IRDM_SOURCE_DIR "/configs/models")) {
    if (entry.path().extension() != ".toml") continue;
    CAPTURE(entry.path());
    CHECK_NOTHROW(load_config(entry.path()));
    ++count;
  }
  CHECK(count >= 2);
}

TEST_CASE("the paper's cube has the numbers of the paper") {
  const auto config = load_config(IRDM_SOURCE_DIR "/configs/models/paper-cube.toml");
  const auto& box = std::get<BoxConfig>(config.mesh.source);
  CHECK(box.size == Vector3(0.12, 0.12, 0.12));
  CHECK(box.cells == std::array{12, 12, 12});
  CHECK(config.material.youngs_modulus == 2000.0);
  CHECK(config.material.poisson_ratio == 0.49);
  CHECK(config.material.density == 110.0);
  CHECK(config.material.rayleigh_alpha == 8.0);
  CHECK(config.material.rayleigh_beta == 2e-4);
  CHECK(config.response.dt == 0.002);
  CHECK(config.response.steps == 500);
  CHECK(config.response.storage == Storage::kModal);
}

TEST_CASE("the paper's cube of quadratic tetrahedra has half the cells an edge") {
  const auto config = load_config(IRDM_SOURCE_DIR "/configs/models/paper-cube-quadratic.toml");
  CHECK(config.mesh.order == 2);
  CHECK(std::get<BoxConfig>(config.mesh.source).cells == std::array{6, 6, 6});
  CHECK(config.material.poisson_ratio == 0.49);
}

TEST_CASE("the liver is an organ of hand size, sound, and held by a part of its surface") {
  const auto config = load_config(IRDM_SOURCE_DIR "/configs/models/liver.toml");
  const auto& path = std::get<std::filesystem::path>(config.mesh.source);
  const TetMesh linear = read_mesh_file(path);
  check_mesh(linear, path.string());
  const TetMesh mesh = quadratic_mesh(linear);
  CHECK(config.mesh.order == 2);
  CHECK(mesh.node_count() < 1500);
  const MeshReport report = report_mesh(mesh);
  CHECK(report.extent.maxCoeff() == Approx(0.15).epsilon(0.01));
  CHECK(report.worst_quality > 0.2);
  const std::vector<int> clamped = nodes_in(mesh, *config.support, "liver");
  CHECK_NOTHROW(check_clamped(mesh, clamped, extract_surface(mesh, "liver").nodes, "liver"));
  CHECK(clamped.size() > 30);
}

TEST_CASE("the tissue with an inclusion has a ball of tetrahedra under its top") {
  const auto config = load_config(IRDM_SOURCE_DIR "/configs/models/tissue-inclusion.toml");
  const auto& path = std::get<std::filesystem::path>(config.mesh.source);
  const TetMesh linear = read_mesh_file(path);
  check_mesh(linear, path.string());
  const TetMesh mesh = quadratic_mesh(linear);
  CHECK(mesh.node_count() < 2200);
  CHECK(report_mesh(mesh).worst_quality > 0.2);
  Material material = config.material;
  material.elements = element_materials(mesh, material, config.regions, false, "tissue");
  const std::vector<RegionReport> regions = report_regions(mesh, material);
  REQUIRE(regions.size() == 2);
  // A ball of 1 cm of straight edges.
  CHECK(regions[1].volume == Approx(4.19e-6).epsilon(0.2));
  CHECK(regions[1].volume + regions[0].volume == Approx(0.09 * 0.09 * 0.04).epsilon(1e-9));
  CHECK(regions[1].inner_nodes > 20);
}

TEST_CASE("configuration has defaults for damping and response") {
  const PrecomputeConfig config = read(kMesh + kMaterialTable);
  CHECK(config.mesh.order == 2);
  CHECK(read(kMesh + "order = 1\n" + kMaterialTable).mesh.order == 1);
  CHECK(read(kMesh + "[material]\nrigid = true\ndensity = 110\n").mesh.order == 1);
  CHECK(config.material.rayleigh_alpha == 8.0);
  CHECK(config.material.rayleigh_beta == 2e-4);
  CHECK(config.response.dt == 0.002);
  CHECK(config.response.steps == 500);
  CHECK(config.response.storage == Storage::kModal);
  CHECK(config.response.precision == Precision::kSingle);
}

TEST_CASE("configuration takes every documented word") {
  const auto response = [](const std::string& line) {
    return read(kMesh + kMaterialTable + "[response]\n" + line + "\n").response;
  };
  CHECK(response("storage = \"dense\"").storage == Storage::kDense);
  CHECK(response("storage = \"both\"").storage == Storage::kBoth);
  CHECK(response("precision = \"double\"").precision == Precision::kDouble);
  CHECK(response("precision = \"single\"").precision == Precision::kSingle);
  CHECK(response("method = \"time-stepping\"").method == Method::kTimeStepping);
  CHECK(response("method = \"modal\"\nsupport = \"floating\"\ndt = 0.001").dt == 0.001);
}

TEST_CASE("a mesh file is found beside its configuration") {
  const auto config = read("[mesh]\nfile = \"x/liver.msh\"\n" + kMaterialTable);
  CHECK(std::get<std::filesystem::path>(config.mesh.source) ==
        std::filesystem::current_path() / "x" / "liver.msh");
  CHECK(config.mesh.unit == 1.0);
  CHECK(read("[mesh]\nfile = \"a.msh\"\nunit = \"mm\"\n" + kMaterialTable).mesh.unit == 1e-3);
  CHECK(!config.mesh.edge_length);
  CHECK(read("[mesh]\nfile = \"a.STL\"\nedge_length = 0.01\n" + kMaterialTable).mesh.edge_length ==
        0.01);
}

TEST_CASE("configuration refuses each bad mesh entry") {
  check_refused(kMaterialTable, "mesh is missing");
  const std::string not_one = "has not exactly one of box, sphere, capsule and file";
  check_refused("[mesh]\n" + kMaterialTable, not_one);
  check_refused(kMesh + "file = \"a.msh\"\n" + kMaterialTable, not_one);
  check_refused(kMesh + "sphere = { radius = 1, cells = 2 }\n" + kMaterialTable, not_one);
  check_refused("[mesh]\nbox = 3\n" + kMaterialTable, "mesh.box is not a table");
  check_refused("[mesh]\nfile = 3\n" + kMaterialTable, "mesh.file is not text");
  check_refused("[mesh]\nbox = { size = [0.1, 0.2], cells = [1, 2, 3] }\n" + kMaterialTable,
                "has 2 entries");
  check_refused("[mesh]\nbox = { size = [0.1, 0, 0.3], cells = [1, 2, 3] }\n" + kMaterialTable,
                "size is 0");
  check_refused("[mesh]\nbox = { size = [0.1, nan, 0.3], cells = [1, 2, 3] }\n" + kMaterialTable,
                "size is nan");
  check_refused("[mesh]\nbox = { size = [1, 1, 1], cells = [1, 0, 3] }\n" + kMaterialTable,
                "cells is 0");
  check_refused("[mesh]\nbox = { size = [1, 1, 1], cells = [1, 1.5, 3] }\n" + kMaterialTable,
                "cells is not a whole number");
  check_refused("[mesh]\nbox = { size = [1, 1, 1], cells = [2.0, 1, 3] }\n" + kMaterialTable,
                "cells is not a whole number");
  check_refused("[mesh]\nbox = { size = [1, 1, 1], cells = [1, 1, 3], x = 1 }\n" + kMaterialTable,
                "mesh.box.x is not a known key");
  check_refused(kMesh + "unit = \"mm\"\n" + kMaterialTable, "unit belongs to a mesh file");
  check_refused("[mesh]\nfile = \"a.msh\"\nunit = \"inch\"\n" + kMaterialTable, "m | cm | mm");
  check_refused("[mesh]\nfile = \"a.stl\"\nedge_length = 0\n" + kMaterialTable, "edge_length is 0");
  check_refused("[mesh]\nfile = \"a.msh\"\nedge_length = 0.1\n" + kMaterialTable,
                "edge_length belongs to a surface (.stl, .obj, .ply)");
  check_refused(kMesh + "edge_length = 0.1\n" + kMaterialTable, "cells says how fine the mesh is");
  check_refused(kMesh + "order = 3\n" + kMaterialTable, "mesh.order is 3");
  check_refused(kMesh + "typo = 2\n" + kMaterialTable, "mesh.typo is not a known key");
}

TEST_CASE("a sphere and a capsule are read") {
  const auto ball = read("[mesh]\nsphere = { radius = 0.05, cells = 8 }\n" + kMaterialTable);
  CHECK(std::get<SphereConfig>(ball.mesh.source).radius == 0.05);
  CHECK(std::get<SphereConfig>(ball.mesh.source).cells == 8);
  const auto peg = read(
      "[mesh]\ncapsule = { radius = 0.01, length = 0.1, cells = 4 }\norder = 2\n" + kMaterialTable);
  CHECK(std::get<CapsuleConfig>(peg.mesh.source).radius == 0.01);
  CHECK(std::get<CapsuleConfig>(peg.mesh.source).length == 0.1);
  CHECK(std::get<CapsuleConfig>(peg.mesh.source).cells == 4);
  CHECK(peg.mesh.order == 2);
}

TEST_CASE("configuration refuses each bad entry of a sphere or capsule") {
  const auto refuse = [](const std::string& mesh, const std::string& message) {
    check_refused("[mesh]\n" + mesh + "\n" + kMaterialTable, message);
  };
  refuse("sphere = { radius = -0.05, cells = 8 }", "mesh.sphere.radius is -0.05");
  refuse("sphere = { cells = 8 }", "mesh.sphere.radius is missing");
  refuse("sphere = { radius = 0.05 }", "mesh.sphere.cells is missing");
  refuse("sphere = { radius = 0.05, cells = 1 }", "mesh.sphere.cells is 1");
  refuse("sphere = { radius = 0.05, cells = 101 }", "mesh.sphere.cells is 101");
  refuse("sphere = { radius = 0.05, cells = 8, x = 1 }", "mesh.sphere.x is not a known key");
  refuse("sphere = { radius = 0.05, cells = 8 }\nunit = \"mm\"", "unit belongs to a mesh file");
  refuse("capsule = { radius = 0, length = 0.1, cells = 4 }", "mesh.capsule.radius is 0");
  refuse("capsule = { radius = 0.01, length = -1, cells = 4 }", "mesh.capsule.length is -1");
  refuse("capsule = { radius = 0.01, length = 0.1 }", "mesh.capsule.cells is missing");
  refuse("capsule = { radius = 1e-6, length = 1, cells = 4 }", "is more than 1000 cells long");
}

TEST_CASE("a rigid body needs its density alone") {
  const auto floating = read(kMesh + "[material]\nrigid = true\ndensity = 800\n");
  CHECK(floating.rigid);
  CHECK(floating.material.density == 800.0);
  CHECK(floating.material.youngs_modulus == 0.0);
  CHECK(floating.response.dt == 0.002);
  CHECK(floating.response.steps == 1);
  CHECK(floating.response.support == Support::kFloating);
  const auto fixed = read(kMesh + "[material]\nrigid = true\ndensity = 800\n" +
                          "[response]\ndt = 0.001\nsupport = \"fixed\"\n");
  CHECK(fixed.response.dt == 0.001);
  CHECK(fixed.response.support == Support::kFixed);
  CHECK_FALSE(fixed.support);
  CHECK_FALSE(read(kMesh + kMaterialTable).rigid);
  CHECK_FALSE(read(kMesh + kMaterialTable + "rigid = false\n").rigid);
}

TEST_CASE("configuration refuses what a rigid body does not have") {
  const std::string rigid = kMesh + "[material]\nrigid = true\n";
  check_refused(rigid, "material.density is missing");
  check_refused(rigid + "density = -1\n", "material.density is -1");
  check_refused(kMesh + "[material]\nrigid = 1\ndensity = 800\n", "material.rigid");
  for (const char* key : {"youngs_modulus", "poisson_ratio", "rayleigh_alpha", "rayleigh_beta"}) {
    check_refused(rigid + "density = 800\n" + key + " = 0.3\n",
                  std::string("material.") + key + " is for soft bodies");
  }
  for (const char* line :
       {"steps = 500", "method = \"modal\"", "storage = \"modal\"", "precision = \"single\""}) {
    check_refused(rigid + "density = 800\n[response]\n" + line + "\n", "is for soft bodies");
  }
  for (const char* table : {"modes", "support", "time_stepping"}) {
    check_refused(rigid + "density = 800\n[" + table + "]\n",
                  std::string(table) + " is for soft bodies");
  }
  check_refused(rigid + "density = 800\n[response]\ntypo = 1\n", "is not a known key");
}

TEST_CASE("configuration refuses each bad material entry") {
  check_refused(kMesh, "material is missing");
  check_refused(kMesh + "[material]\npoisson_ratio = 0.3\ndensity = 1\n",
                "material.youngs_modulus is missing");
  check_refused(kMesh + material("youngs_modulus", "0"), "youngs_modulus is 0");
  check_refused(kMesh + material("youngs_modulus", "-5"), "youngs_modulus is -5");
  check_refused(kMesh + material("youngs_modulus", "inf"), "youngs_modulus is inf");
  check_refused(kMesh + material("youngs_modulus", "\"soft\""), "is not a number");
  check_refused(kMesh + material("poisson_ratio", "0.5"), "poisson_ratio is 0.5");
  check_refused(kMesh + material("poisson_ratio", "0.49999999999999"),
                "give a finite number >= -0.999999 and <= 0.499999");
  check_refused(kMesh + material("poisson_ratio", "0.6"), "poisson_ratio is 0.6");
  check_refused(kMesh + material("poisson_ratio", "-1"), "poisson_ratio is -1");
  check_refused(kMesh + material("density", "-110"), "density is -110");
  check_refused(kMesh + material("density", "0"), "density is 0");
  check_refused(kMesh + material("density", "nan"), "density is nan");
  check_refused(kMesh + material("rayleigh_alpha", "-1"), "rayleigh_alpha is -1");
  check_refused(kMesh + material("rayleigh_beta", "-1e-4"), "rayleigh_beta is -0.0001");
  check_refused(kMesh + material("youngs_modulsu", "1"), "youngs_modulsu is not a known key");
}

TEST_CASE("configuration refuses each bad response entry") {
  const auto refused = [](const std::string& line, const std::string& message) {
    check_refused(kMesh + kMaterialTable + "[response]\n" + line + "\n", message);
  };
  refused("dt = 0", "response.dt is 0");
  refused("dt = -0.002", "response.dt is -0.002");
  refused("dt = nan", "response.dt is nan");
  refused("dt = \"2 ms\"", "response.dt is not a number");
  refused("dt = 2.0", "response.dt is 2");
  refused("steps = 0", "response.steps is 0");
  refused("steps = 1.5", "response.steps is not a whole number");
  refused("method = \"magic\"", "modal | time-stepping");
  refused("storage = \"sparse\"", "modal | dense | both");
  refused("precision = \"quarter\"", "give one of: single | double");
  refused("precision = \"half\"",
          "response.precision is 'half', which there is not any more; use \"single\"; "
          "irdm-precompute compress makes dense R small");
  for (const char* key : {"compression", "compression_error"}) {
    refused(
        std::string(key) + " = \"zfp\"",
        "response." + std::string(key) +
            " is not a key any more; leave it out; irdm-precompute compress makes dense R small");
  }
  refused("support = \"fixed\"", "support is missing");
  refused("support = \"nailed\"", "floating | fixed");
  refused("typo = 1", "response.typo is not a known key");
  check_refused(kMesh + kMaterialTable + "[time_stepping]\nfirst_step = 3e-4\n",
                "c.toml:8: time_stepping.first_step does not divide response.dt");
  check_refused(kMesh + kMaterialTable + "[respnse]\n", "respnse is not a known key");
  check_refused("mesh = 3\n" + kMaterialTable, "mesh is not a table");
}

TEST_CASE("configuration takes what a laboratory may have, and nothing beyond") {
  const auto limits = [](const std::string& key, const std::vector<const char*>& good,
                         const std::vector<const char*>& bad) {
    for (const char* value : good) CHECK_NOTHROW(read(kMesh + material(key, value)));
    for (const char* value : bad) check_refused(kMesh + material(key, value), key + " is ");
  };
  limits("youngs_modulus", {"1", "1e3", "1e9", "1e13"}, {"0.9", "1e-308", "1e308"});
  limits("density", {"0.01", "1e5"}, {"1e-9", "1e308"});
  limits("rayleigh_alpha", {"0", "1e6"}, {"1e300"});
  limits("rayleigh_beta", {"0", "100"}, {"1e300"});
  const auto dt = [](const std::string& value) {
    return kMesh + kMaterialTable + "[response]\ndt = " + value + "\n";
  };
  for (const char* good : {"1e-5", "1e-4", "4e-3", "1"}) CHECK_NOTHROW(read(dt(good)));
  for (const char* bad : {"1e-20", "4e-10", "9e-6", "1.1"}) {
    check_refused(dt(bad), "response.dt is ");
  }
  const std::string modes = kMesh + kMaterialTable + "[modes]\n";
  check_refused(modes + "highest_frequency = 1e300\n", "modes.highest_frequency is 1e+300");
  check_refused(modes + "count = 9\ncontact_radius = 1e300\n", "modes.contact_radius is 1e+300");
  check_refused("[mesh]\nbox = { size = [1e300, 1, 1], cells = [1, 1, 1] }\n" + kMaterialTable,
                "size is 1e+300");
  check_refused("[mesh]\nfile = \"a.stl\"\nedge_length = 1e300\n" + kMaterialTable,
                "edge_length is 1e+300");
  check_refused(kMesh + kMaterialTable + "[time_stepping]\nforce = 1e300\n",
                "time_stepping.force is 1e+300");
  const std::string support =
      kMesh + kMaterialTable + "[response]\nsupport = \"fixed\"\n[support]\n";
  check_refused(support + "half_space = { point = [1e300, 0, 0], normal = [0, 0, 1] }\n",
                "point is 1e+300");
  check_refused(support + "half_space = { point = [0, 0, 0], normal = [0, 0, 1e300] }\n",
                "normal is 1e+300");
  check_refused(support + "box = { min = [0, 0, 0], max = [1e300, 1, 1] }\n", "max is 1e+300");
}

TEST_CASE("configuration takes all modes, or some by one of three measures") {
  const auto modes = [](const std::string& lines) {
    return read(kMesh + kMaterialTable + "[modes]\n" + lines).modes;
  };
  CHECK(read(kMesh + kMaterialTable).modes.all());
  CHECK(modes("").all());
  CHECK(!modes("").given());
  CHECK(modes("error = 0\n").all());
  CHECK(modes("error = 0\n").given());
  CHECK(modes("count = 300\n").count == 300);
  CHECK(modes("highest_frequency = 400.0\n").highest_frequency == 400.0);
  CHECK(modes("error = 0.01\ncontact_radius = 0.01\n").error == 0.01);
  CHECK(modes("error = 0.01\ncontact_radius = 0.01\n").contact_radius == 0.01);
  CHECK(modes("error = 0.01\n").contact_radius == 0.015);
  const auto refused = [](const std::string& lines, const std::string& message) {
    check_refused(kMesh + kMaterialTable + "[modes]\n" + lines, message);
  };
  CHECK(modes("error = 0.01\n").solver == ModeSolver::kSpectra);
  CHECK(modes("count = 9\nsolver = \"slepc\"\n").solver == ModeSolver::kSlepc);
  CHECK(modes("count = 9\nsolver = \"slepc-multigrid\"\n").solver == ModeSolver::kSlepcMultigrid);
  refused("count = 0\n", "modes.count is 0");
  refused("solver = \"slepc\"\n", "modes.solver is there but all modes are asked for");
  refused("count = 9\nsolver = \"arpack\"\n", "modes.solver is 'arpack'");
  refused("count = 1.5\n", "modes.count is not a whole number");
  refused("highest_frequency = 0\n", "modes.highest_frequency is 0");
  refused("error = 0.6\n", "modes.error is 0.6");
  refused("error = 1e-5\n", "modes.error is below 1e-4");
  refused("count = 3\nerror = 0.1\n", "more than one of count, highest_frequency and error");
  refused("contact_radius = 0.01\n", "modes.contact_radius is there but all modes are asked for");
  refused("error = 0.1\ncontact_radius = 0\n", "modes.contact_radius is 0");
  refused("number = 3\n", "modes.number is not a known key");
}

TEST_CASE("configuration takes each kind of support") {
  const auto support = [](const std::string& line) {
    return *read(kMesh + kMaterialTable + "[response]\nsupport = \"fixed\"\n[support]\n" + line +
                 "\n")
                .support;
  };
  CHECK(!read(kMesh + kMaterialTable).support);
  const auto half =
      std::get<HalfSpace>(support("half_space = { point = [1, 2, 3], normal = [0, 0, 2] }"));
  CHECK(half.point == Vector3(1, 2, 3));
  CHECK(half.normal == Vector3(0, 0, 2));
  const auto box = std::get<BoxRegion>(support("box = { min = [-1, 0, 0], max = [0, 1, 2] }"));
  CHECK(box.lowest == Vector3(-1, 0, 0));
  CHECK(box.highest == Vector3(0, 1, 2));
  CHECK(std::get<GroupRegion>(support("group = \"base\"")).group == "base");
}

TEST_CASE("configuration refuses each bad support") {
  const std::string fixed = kMesh + kMaterialTable + "[response]\nsupport = \"fixed\"\n";
  const auto refused = [&](const std::string& text, const std::string& message) {
    check_refused(fixed + text + "\n", message);
  };
  refused("[support]", "exactly one of half_space, box, ball and group");
  refused("[support]\ngroup = \"a\"\nbox = { min = [0, 0, 0], max = [1, 1, 1] }", "exactly one");
  refused("[support]\nhalf_space = { point = [0, 0, 0], normal = [0, 0, 0] }", "normal is zero");
  refused("[support]\nhalf_space = { point = [0, 0, 0] }", "normal is missing");
  refused("[support]\nbox = { min = [0, 0, 2], max = [1, 1, 1] }", "min is above max");
  refused("[support]\ngroup = 3", "group is not text");
  refused("[support]\ngroup = \"a\"\ntypo = 3", "support.typo is not a known key");
  check_refused(kMesh + kMaterialTable + "[support]\ngroup = \"a\"\n", "the body is floating");
}

TEST_CASE("configuration refuses files that are missing, empty or truncated") {
  CHECK_THROWS_WITH(load_config("no-such.toml"), ContainsSubstring("no-such.toml: no such file"));
  check_refused("", "mesh is missing");
  check_refused(kMesh.substr(0, 40), "c.toml:2");
}
