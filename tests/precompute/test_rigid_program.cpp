// irdm-precompute and rigid bodies.
#include <algorithm>

#include "common/model/model_file.hpp"
#include "tests/precompute/program_run.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

TEST_CASE("a rigid box has exactly the mass and the inertia of a solid one") {
  ProgramRun run;
  const std::string rigid = "[material]\nrigid = true\ndensity = 800\n";
  run.write("c.toml", kBox + rigid + "[response]\ndt = 0.001\n");
  run.start("c.toml -o made/model.h5");
  REQUIRE(run.err.empty());
  REQUIRE(run.status == 0);
  CHECK_THAT(run.out, ContainsSubstring("mass") && !ContainsSubstring("elastic modes"));
  const Model model = read_model(run.model(), ResponseKind::kModal);
  CHECK(is_rigid(model));
  CHECK(model.dt == 0.001);
  CHECK(model.body.support == Support::kFloating);
  const double mass = 800 * 0.12 * 0.1 * 0.08;
  const Vector3 squares(0.12 * 0.12, 0.1 * 0.1, 0.08 * 0.08);
  const Vector3 moments = mass / 12.0 * (Vector3::Constant(squares.sum()) - squares);
  CHECK(model.body.mass == Approx(mass).epsilon(1e-12));
  CHECK((model.body.inertia - Matrix3(moments.asDiagonal())).norm() < 1e-12 * moments.norm());
  CHECK((model.mesh.com_offset - Vector3(0.06, 0.05, 0.04)).norm() < 1e-12);
}

TEST_CASE("scenery is rigid and fixed without clamped nodes") {
  ProgramRun run;
  run.write("c.toml",
            "[mesh]\ncapsule = { radius = 0.01, length = 0.04, cells = 3 }\norder = 2\n"
            "[material]\nrigid = true\ndensity = 800\n[response]\nsupport = \"fixed\"\n");
  run.start("c.toml -o made/model.h5");
  REQUIRE(run.err.empty());
  REQUIRE(run.status == 0);
  const Model model = read_model(run.model(), ResponseKind::kDense);
  CHECK(is_rigid(model));
  CHECK(model.body.support == Support::kFixed);
  CHECK(model.mesh.tets.cols() == 10);
  run.start("check made/model.h5");
  CHECK(run.status == 0);
  CHECK_THAT(run.out, ContainsSubstring("the body is rigid"));
  run.start("compress made/model.h5 -o made/small.h5");
  CHECK(run.status == 1);
  CHECK_THAT(run.err, ContainsSubstring("is of a rigid body, which has no response to compress"));
}

TEST_CASE("no R of a rigid body can be asked for") {
  ProgramRun run;
  run.write("c.toml", kBox + "[material]\nrigid = true\ndensity = 800\n");
  for (const char* option :
       {"--columns 0:3", "--storage dense", "--storage both", "--method time-stepping"}) {
    run.start(std::string("c.toml -o made/model.h5 ") + option);
    CHECK(run.status == 1);
    CHECK(std::count(run.err.begin(), run.err.end(), '\n') == 1);
    CHECK_THAT(run.err, ContainsSubstring("c.toml: is of a rigid body, of which no R is computed"));
    CHECK(std::filesystem::is_empty(run.path() / "made"));
  }
}

TEST_CASE("a rigid body needs a sound mesh like any other, and says so in one line") {
  ProgramRun run;
  run.write("c.toml", "[mesh]\nfile = \"m.msh\"\n[material]\nrigid = true\ndensity = 800\n");
  run.write("m.msh", with_words(kMsh, "2 4 2 0 1 2 3 4 5", "2 4 2 0 1 3 2 4 5"));
  run.check_refused("m.msh: 1 of 2 tetrahedra are inverted");
  run.write("m.msh", with_words(with_words(kMsh, "2 4 2 0 1 2 3 4 5", "2 4 2 0 1 3 2 4 5"),
                                "1 4 2 0 1 1 2 3 4", "1 4 2 0 1 2 1 3 4"));
  run.check_refused("m.msh: all 2 tetrahedra are inverted");
  // A surface is filled: an open one cannot be, one turned inside out is turned round.
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  const std::string faces = "f 1 3 2\nf 1 2 4\nf 1 4 3\n";
  run.write("c.toml", "[mesh]\nfile = \"m.obj\"\n[material]\nrigid = true\ndensity = 800\n");
  run.write("m.obj", corners + faces);
  run.check_refused("m.obj: ");
  run.write("m.obj", corners + "v 1 1 1\n" + faces + "f 2 3 5\nf 3 4 5\n");
  run.check_refused("m.obj: the surface is open at 3 edges");
  run.write("m.obj", corners + "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n");
  run.start("c.toml -o made/model.h5");
  CHECK(run.status == 0);
  CHECK(read_model(run.model(), ResponseKind::kModal).body.mass == Approx(800.0 / 6.0));
}
