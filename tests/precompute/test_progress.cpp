#include <sstream>

#include "precompute/progress.hpp"
#include "precompute/summary.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm::precompute;

TEST_CASE("durations are given in units that fit") {
  CHECK(format_duration(0.84) == "0.8 s");
  CHECK(format_duration(12.3) == "12 s");
  CHECK(format_duration(185) == "3 min 05 s");
  CHECK(format_duration(7830) == "2 h 10 min");
}

TEST_CASE("progress says what share is done and how long the rest takes") {
  CHECK(progress_text("work", 0.25, 30.0, false) == "work   25 %  90 s left");
  CHECK(progress_text("work", 1.0, 30.0, false) == "work  100 %  30 s");
  CHECK(progress_text("work", 0.0, 0.0, false) == "work    0 %");
  CHECK(progress_text("work", 0.5, 1.0, true) ==
        "work   50 %  [###############...............]  1.0 s left");
}

TEST_CASE("progress draws one line anew on a terminal and whole lines elsewhere") {
  std::ostringstream out;
  SECTION("terminal") {
    Progress(Console{out, true}, "work", 4).update(4);
    CHECK_THAT(out.str(),
               Catch::Matchers::StartsWith("\rwork  100 %") && Catch::Matchers::EndsWith("\n"));
  }
  SECTION("file") {
    Progress progress(Console{out, false}, "work", 4);
    for (int done = 1; done <= 4; ++done) progress.update(done);
    CHECK(out.str() == "work  100 %  0.0 s\n");
  }
}

TEST_CASE("work whose share cannot be told says how long it takes and how long it may still take") {
  CHECK(elapsed_text("modes", 12.0, 26.0) == "modes  12 s, about 14 s left");
  CHECK(elapsed_text("modes", 30.0, 26.0) == "modes  30 s");
  std::ostringstream out;
  { const ElapsedTime elapsed(Console{out, false}, "modes", 0.0); }
  CHECK(out.str() == "modes  0.0 s\n");
}

TEST_CASE("summary gives sizes and times per degree of freedom") {
  Summary summary;
  summary.free_nodes = 100;
  summary.columns = 300;
  summary.seconds = 6.0;
  summary.file_bytes = 3'000'000;
  const std::string text = format_summary(summary);
  CHECK_THAT(text, ContainsSubstring("per d.o.f.   0.02 s"));
  CHECK_THAT(text, ContainsSubstring("10.0 kB"));
  CHECK_THAT(text, ContainsSubstring("3.0 MB"));
}
