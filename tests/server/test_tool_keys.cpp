#include "tests/server/scene_text.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using Catch::Matchers::StartsWith;
using namespace irdm;
using test::kObject;
using test::rejection;
using test::scene;

namespace {

std::string with_tool(const std::string& tool, const std::string& more = "") {
  return "[[stylus]]\ntool = { " + tool + " }\n" + more + kObject +
         "[[object]]\nname = \"rod\"\nmodel = \"rod.h5\"\n";
}

}  // namespace

TEST_CASE("tool: every key arrives, and the object by its name") {
  const SceneConfig read =
      scene(with_tool("object = \"rod\", stiffness = 200, damping = 2, angular_stiffness = 0.5, "
                      "angular_damping = 0.01",
                      "max_force = 3\n[[stylus]]\nradius = 0.01\n"));
  REQUIRE(read.styluses.size() == 2);
  REQUIRE(read.styluses[0].tool);
  CHECK(read.styluses[0].tool->object == 1);
  CHECK(read.styluses[0].tool->constants == CouplingConstants{200.0, 2.0, 0.5, 0.01});
  CHECK_FALSE(read.styluses[1].tool);
}

TEST_CASE("tool: constants that are left out are left to the coupling") {
  const SceneConfig read = scene(with_tool("object = \"rod\", stiffness = 200"));
  CHECK(read.styluses[0].tool->constants == CouplingConstants{200.0, {}, {}, {}});
}

TEST_CASE("tool: every mistake is refused with its line") {
  CHECK_THAT(rejection(with_tool("stiffness = 200")), ContainsSubstring("object"));
  CHECK_THAT(rejection(with_tool("object = \"bar\"")),
             StartsWith("s.toml:2: ") && ContainsSubstring("is no object of the scene: 'bar'"));
  CHECK_THAT(rejection(with_tool("object = \"rod\", stiffness = -1")),
             ContainsSubstring("stiffness"));
  CHECK_THAT(rejection(with_tool("object = \"rod\", mass = 1")),
             ContainsSubstring("is not a known key"));
  CHECK_THAT(rejection(with_tool("object = \"rod\"", "reach = 0.01\n")),
             ContainsSubstring("is nothing to a stylus that leads a tool"));
  CHECK_THAT(rejection(with_tool("object = \"rod\"", "radius = 0.01\n")),
             ContainsSubstring("is nothing to a stylus that leads a tool"));
  CHECK_THAT(rejection(with_tool("object = \"rod\"", "coupling_stiffness = 300\n")),
             ContainsSubstring("is nothing to a stylus that leads a tool"));
  CHECK_THAT(rejection(with_tool("object = \"rod\"", "[[stylus]]\ntool = { object = \"rod\" }\n")),
             StartsWith("s.toml:4: ") && ContainsSubstring("is led by another stylus: 'rod'"));
}
