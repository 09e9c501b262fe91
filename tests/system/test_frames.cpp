// Pictures of a recorded run, as another program than ours sees them.
#include <algorithm>
#include <csignal>
#include <filesystem>

#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/left_out.hpp"
#include "tests/system/stage.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

bool can_draw() {
  const char* lacks = nullptr;
  if (run_to_end({"/bin/sh", "-c", "command -v chromium"}).status != 0) lacks = "no chromium";
  if (!IRDM_PAGE_BUILT) lacks = "the page is not built";
  if (lacks != nullptr) leave_out(lacks);
  return lacks == nullptr;
}

FinishedProgram take(const Stage& stage, const std::string& folder,
                     const std::vector<std::string>& options = {}) {
  std::vector<std::string> command{IRDM_REPLAY, stage.path("trace.h5").string(), "--frames",
                                   stage.path(folder).string()};
  command.insert(command.end(), options.begin(), options.end());
  return run_to_end(command);
}

FinishedProgram look_at(const std::filesystem::path& folder) {
  return run_to_end({"/usr/bin/python3",
                     std::string(IRDM_SOURCE_DIR) + "/tests/system/read_frames.py",
                     folder.string()});
}

}  // namespace

TEST_CASE("frames of a recorded run show the object, from frame to frame another", "[slow]") {
  if (!can_draw()) return;
  const Stage stage;
  record(stage, true);

  const std::vector<std::string> options{"--size",  "480x360", "--rate", "5",
                                         "--begin", "0.4",     "--end",  "1.2"};
  const FinishedProgram taken = take(stage, "plain", options);
  INFO(taken.err);
  REQUIRE(taken.status == 0);
  const FinishedProgram seen = look_at(stage.path("plain"));
  INFO(seen.out << seen.err);
  CHECK_THAT(taken.out, ContainsSubstring("; 5 frames"));
  CHECK(number_after(seen.out, "frames ") == 5);
  CHECK_THAT(seen.out, ContainsSubstring("480 x 360"));
  // Of all frames the least: colours of a shaded object, and how much of the picture it takes.
  CHECK(number_after(seen.out, "colours ") > 100);
  CHECK(number_after(seen.out, "object ") > 0.05);
  CHECK(number_after(seen.out, "object ") < 0.9);
  CHECK(number_after(seen.out, "alike ") == 0);

  std::vector<std::string> changed = options;
  changed.back() = "0.4";
  changed.insert(changed.end(), {"--rigid", "--camera", "80,5", "--dark"});
  REQUIRE(take(stage, "changed", changed).status == 0);
  CHECK(number_after(look_at(stage.path("changed")).out, "frames ") == 1);
  CHECK(file_content(stage.path("changed/frame_00000.png")) !=
        file_content(stage.path("plain/frame_00000.png")));

  const FinishedProgram again = take(stage, "plain", options);
  CHECK(again.status == 1);
  CHECK_THAT(again.err, ContainsSubstring("is not empty"));
}

TEST_CASE("a signal that ends irdm-replay ends its browser, too, and removes the profile",
          "[slow]") {
  if (!can_draw()) return;
  const Stage stage;
  record(stage, true);
  const std::filesystem::path temporary = stage.path("tmp");
  std::filesystem::create_directory(temporary);
  const auto profile = [&] {
    for (const auto& entry : std::filesystem::directory_iterator(temporary)) {
      if (entry.path().filename().string().starts_with("irdm-pictures")) return entry.path();
    }
    return std::filesystem::path();
  };
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    CAPTURE(signal);
    ChildProcess replay({IRDM_REPLAY, stage.path("trace.h5").string(), "--frames",
                         stage.path("pictures" + std::to_string(signal)).string()},
                        {.environment = {"TMPDIR=" + temporary.string()}});
    REQUIRE(eventually([&] { return !profile().empty() && !is_empty(profile()); },
                       ChildProcess::kDeadlineMs));
    replay.signal(signal);
    CHECK(replay.wait() == (signal == SIGHUP ? -SIGHUP : 1));
    CHECK(profile().empty());
  }
}

TEST_CASE("pictures without a browser, or a video without ffmpeg, are refused in one line") {
  const Stage stage;
  record(stage, true);
  ChildOptions nowhere;
  nowhere.environment = {"PATH=" + stage.path("").string()};
  const FinishedProgram refused = run_to_end(
      {IRDM_REPLAY, stage.path("trace.h5").string(), "--frames", stage.path("pictures").string()},
      nowhere);
  CHECK(refused.status == 1);
  CHECK_THAT(refused.err, ContainsSubstring("Debian's package chromium") ||
                              ContainsSubstring("IRDM_BUILD_PAGE"));
  CHECK(std::count(refused.err.begin(), refused.err.end(), '\n') == 1);
  stage.write("chromium", "#!/bin/sh\n");
  std::filesystem::permissions(stage.path("chromium"), std::filesystem::perms::owner_all);
  const FinishedProgram no_video =
      run_to_end({IRDM_REPLAY, stage.path("trace.h5").string(), "--frames",
                  stage.path("pictures").string(), "--video", stage.path("run.mp4").string()},
                 nowhere);
  CHECK(no_video.status == 1);
  CHECK_THAT(no_video.err,
             ContainsSubstring("Debian's package ffmpeg") || ContainsSubstring("IRDM_BUILD_PAGE"));
  CHECK_FALSE(std::filesystem::exists(stage.path("pictures")));
  const FinishedProgram wrong = take(stage, "pictures", {"--size", "10x10"});
  CHECK(wrong.status == 1);
  CHECK_THAT(wrong.err, ContainsSubstring("WIDTHxHEIGHT"));
}
