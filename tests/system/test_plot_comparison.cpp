// Figures of a comparison, from traces of the real programs.
#include <algorithm>

#include "tests/support/catch.hpp"
#include "tests/system/stage.hpp"

using Catch::Matchers::ContainsSubstring;
using Catch::Matchers::StartsWith;
using namespace irdm;
using namespace irdm::test;

TEST_CASE("plot_comparison.py draws what irdm-replay compare found, and refuses what is none",
          "[slow]") {
  const Stage stage;
  const std::filesystem::path trace = record(stage, true);
  const auto compare = [&](const std::string& rate) {
    std::vector<std::string> command{IRDM_REPLAY, "compare"};
    for (const std::string engine : {"modal", "dense"}) {
      command.push_back(stage.path(engine + rate + ".h5").string());
      REQUIRE(run_to_end({IRDM_REPLAY, trace.string(), "--engine", engine, "--rate", rate,
                          "--output", command.back()})
                  .status == 0);
    }
    command.insert(command.end(), {"--json", stage.path(rate + ".json").string()});
    REQUIRE(run_to_end(command).status == 0);
  };
  const auto plot = [&](const std::string& comparison, const std::string& picture) {
    return run_to_end({"/usr/bin/python3", IRDM_SOURCE_DIR "/scripts/plot_comparison.py",
                       stage.path(comparison).string(), stage.path(picture).string()});
  };
  const auto drawn = [&](const std::string& comparison, const std::string& picture) {
    const FinishedProgram plotted = plot(comparison, picture);
    CHECK(plotted.err.empty());
    REQUIRE(plotted.status == 0);
    CHECK(plotted.out.empty());
    return file_content(stage.path(picture));
  };
  compare("50");
  compare("100");
  CHECK_THAT(drawn("50.json", "50.png"), StartsWith("\x89PNG"));
  CHECK(std::filesystem::file_size(stage.path("50.png")) > 30'000);  // curves, not a white sheet
  CHECK_THAT(drawn("50.json", "50.pdf"), StartsWith("%PDF"));
  const std::string few = drawn("50.json", "50.svg");
  // A figure has its words as comments.
  CHECK_THAT(few, ContainsSubstring("<svg") && ContainsSubstring("<!-- stylus 0: force -->") &&
                      ContainsSubstring("<!-- stylus 0: spectrum of the force -->") &&
                      ContainsSubstring("<!-- cube: nodes, B from A -->") &&
                      ContainsSubstring("<!-- cube: orientation, B from A -->"));
  const std::string vibration = "<!-- stylus 0: vibration of the hand -->";
  CHECK_THAT(few, !ContainsSubstring(vibration));  // 50 frames a second tell nothing of them
  CHECK_THAT(drawn("100.json", "100.svg"), ContainsSubstring(vibration) &&
                                               ContainsSubstring("id=\"axes_10\"") &&
                                               !ContainsSubstring("id=\"axes_11\""));

  const auto refused = [&](const std::string& comparison, const std::string& picture,
                           const std::string& message) {
    CAPTURE(comparison, picture);
    const FinishedProgram plotted = plot(comparison, picture);
    CHECK(plotted.status == 1);
    CHECK(plotted.out.empty());
    CHECK(std::count(plotted.err.begin(), plotted.err.end(), '\n') == 1);
    CHECK_THAT(plotted.err, ContainsSubstring(message));
    CHECK_FALSE(std::filesystem::exists(stage.path(picture)));
  };
  refused("none.json", "none.png", "none.json: cannot be read: No such file");
  refused("trace.h5", "none.png", "trace.h5: is not a comparison; make one with");
  stage.write("other.json", "{\"format\": \"another\", \"version\": 1}");
  refused("other.json", "none.png", "other.json: is not a comparison");
  const std::string whole = file_content(stage.path("50.json"));
  stage.write("half.json", whole.substr(0, whole.size() / 2));
  refused("half.json", "none.png", "half.json: is not a comparison");
  stage.write("empty.json", "{\"format\": \"irdm-comparison\", \"version\": 1}");
  refused("empty.json", "none.png", "empty.json: is damaged");
  refused("50.json", "none.txt", "none.txt: is no picture; give a name that ends in");
  refused("50.json", "none/none.png", "none.png: cannot be written");
}

TEST_CASE("irdm-replay compare names the script that draws to who asks for a page") {
  const FinishedProgram old = run_to_end({IRDM_REPLAY, "compare", "a.h5", "b.h5", "--html", "c"});
  CHECK(old.status == 2);
  CHECK_THAT(old.err, StartsWith("--html: was removed; use --json FILE") &&
                          ContainsSubstring("scripts/plot_comparison.py"));
}
