#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <thread>

#include "common/model/model_file.hpp"
#include "tests/precompute/program_run.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/eventually.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using irdm::test::ChildProcess;
using irdm::test::file_content;

namespace {

const std::string kStepping =
    "[mesh]\nbox = { size = [0.12, 0.1, 0.08], cells = [2, 2, 1] }\norder = 1\n"
    "[material]\nyoungs_modulus = 2000\npoisson_ratio = 0.3\ndensity = 110\n"
    "[response]\nsteps = 40\nstorage = \"dense\"\nmethod = \"time-stepping\"\n";
constexpr int kDof = 54;

// Runs the real program in a folder of its own.
struct ColumnsRun : irdm::test::TemporaryFolder {
  int status = -1;
  std::string out;
  std::string err;

  explicit ColumnsRun(const std::string& config = kStepping) { write("c.toml", config); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path() / name) << text;
  }
  ChildProcess begin(const std::string& arguments, const std::string& launcher = "") const {
    std::vector<std::string> command;
    std::istringstream words(launcher + " " + IRDM_PROGRAM + " " + arguments);
    for (std::string word; words >> word;) command.push_back(word);
    return ChildProcess(command, {.folder = path()});
  }
  void start(const std::string& arguments, const std::string& launcher = "") {
    ChildProcess process = begin(arguments, launcher);
    status = process.wait();
    out = process.out();
    err = process.err();
  }
  void good(const std::string& arguments, const std::string& launcher = "") {
    start(arguments, launcher);
    CAPTURE(arguments, err);
    REQUIRE(status == 0);
  }
  void refused(const std::string& arguments, const std::string& message) {
    start(arguments);
    CAPTURE(arguments);
    CHECK(status == 1);
    const std::string error = irdm::test::without_warnings(err);
    CHECK(std::count(error.begin(), error.end(), '\n') == 1);
    CHECK_THAT(error, Catch::Matchers::StartsWith("irdm-precompute: error: ") &&
                          ContainsSubstring(message));
  }
  std::string content(const std::string& name) const { return file_content(path() / name); }
  bool has(const std::string& name) const { return std::filesystem::exists(path() / name); }
};

std::string modal() {
  std::string text = kStepping;
  return text.replace(text.find("time-stepping"), 13, "modal");
}

// Held by its lower face.
std::string fixed_modal() {
  return modal() +
         "support = \"fixed\"\n[support]\nhalf_space = { point = [0, 0, 0], normal = [0, 1, 0] }\n";
}

// The number before " of 54 columns" in what a run says that goes on, or 0.
int columns_kept(const std::string& out) {
  const auto at = out.find(" of " + std::to_string(kDof) + " columns: going on");
  if (at == std::string::npos) return 0;
  return std::stoi(out.substr(out.rfind(' ', at - 1)));
}

}  // namespace

TEST_CASE("slices join to the file of a whole run, bit for bit, by both methods", "[slow]") {
  for (const std::string& config : {kStepping, modal(), fixed_modal()}) {
    ColumnsRun run(config);
    const bool fixed = config == fixed_modal();
    const bool stepping = config != modal() && !fixed;
    // The modes themselves may differ in their last bits with the number of threads.
    const std::string one = stepping ? " --threads 1" : "";
    run.good("c.toml -o whole.h5");
    run.good("c.toml -o a.part --columns 0:5");
    run.good("c.toml -o b.part --columns 5:6" + one);
    run.good("c.toml -o c.part --columns 6:54");
    CHECK_THAT(run.out, ContainsSubstring("part of a model file"));
    run.good("merge c.part a.part b.part -o joined.h5");
    CHECK((run.content("joined.h5") == run.content("whole.h5")));
    const Model joined = read_model(run.path() / "joined.h5", ResponseKind::kDense);
    CHECK(joined.degrees_of_freedom() == kDof);
    CHECK(has_centrifugal(joined) == (!stepping && !fixed));
    CHECK(has_gravity(joined) == fixed);
    CHECK_FALSE(run.has("whole.h5.columns"));
    CHECK_FALSE(run.has("a.part.columns"));
  }
}

TEST_CASE("merge refuses slices that do not fit together, one by one", "[slow]") {
  ColumnsRun run;
  run.write("other.toml", std::string(kStepping).replace(kStepping.find("2000"), 4, "2001"));
  run.write("linear.toml", kStepping + "[time_stepping]\nmodel = \"linear\"\n");
  run.write("double.toml", kStepping + "precision = \"double\"\n");
  run.good("c.toml -o a.part --columns 0:20");
  run.good("c.toml -o b.part --columns 20:54");
  run.good("c.toml -o tail.part --columns 21:54");
  run.good("c.toml -o head.part --columns 0:21");
  run.good("other.toml -o stiffer.part --columns 20:54");
  run.good("linear.toml -o linear.part --columns 20:54");
  run.good("double.toml -o double.part --columns 20:54");
  run.refused("merge a.part -o m.h5", "columns 20:54 are in no part");
  run.refused("merge b.part -o m.h5", "columns 0:20 are in no part");
  run.refused("merge a.part tail.part -o m.h5", "columns 20:21 are in no part");
  run.refused("merge head.part b.part -o m.h5", "another part has too");
  run.refused("merge a.part a.part b.part -o m.h5", "another part has too");
  run.refused("merge a.part stiffer.part -o m.h5", "another mesh, material or time axis");
  run.refused("merge a.part linear.part -o m.h5", "other settings");
  run.refused("merge a.part double.part -o m.h5", "other numbers");
  run.refused("merge a.part missing.part -o m.h5", "missing.part: cannot be read");
  run.refused("merge a.part c.toml -o m.h5", "c.toml: is not a part of R");
  std::string bytes = run.content("b.part");
  run.write("cut.part", bytes.substr(0, bytes.size() - 1));
  run.refused("merge a.part cut.part -o m.h5", "has only 33 of its 34 columns");
  bytes[bytes.size() - 1000] = static_cast<char>(bytes[bytes.size() - 1000] ^ 1);
  run.write("flipped.part", bytes);
  run.refused("merge a.part flipped.part -o m.h5", "flipped.part: has a damaged column");
  CHECK_FALSE(run.has("m.h5"));
  run.good("merge a.part b.part -o m.h5");
}

TEST_CASE("option --columns takes A:B within R, of dense R only") {
  ColumnsRun run;
  for (const std::string bad : {"5", "5:", ":5", "5:5", "6:5", "-1:5", "1:2x", "a:b"}) {
    run.start("c.toml -o a.part --columns=" + bad);
    CHECK(run.status == 2);
    CHECK_THAT(run.err, ContainsSubstring("A:B"));
  }
  run.refused("c.toml -o a.part --columns 50:55", "columns 50:55 are asked for and R has 54");
  run.refused("c.toml -o a.part --columns 0:5 --method modal --storage modal", "only dense R");
  CHECK_FALSE(run.has("a.part"));
}

TEST_CASE("a work file goes on where its last whole column ends, however it was cut or damaged",
          "[slow]") {
  ColumnsRun run;
  run.good("c.toml -o whole.h5");
  run.good("c.toml -o a.part --columns 0:54");
  const std::string whole = run.content("a.part");
  // A complete column file under the name of the work file stands for one that was interrupted.
  const auto resumed = [&](std::string bytes) {
    run.write("model.h5.columns", bytes);
    std::filesystem::remove(run.path() / "model.h5");
    run.good("c.toml -o model.h5");
    CHECK((run.content("model.h5") == run.content("whole.h5")));
    CHECK_FALSE(run.has("model.h5.columns"));
    return columns_kept(run.out);
  };
  const std::size_t record = 40 * kDof * sizeof(float) + 4;
  CHECK(resumed(whole) == 54);
  CHECK(resumed(whole.substr(0, whole.size() - 1)) == 53);
  CHECK(resumed(whole.substr(0, whole.size() - 10 * record)) == 44);
  CHECK(resumed(whole.substr(0, whole.size() - 54 * record)) == 0);
  CHECK(resumed(whole.substr(0, whole.size() - 54 * record - 1)) == 0);
  CHECK(resumed(whole.substr(0, 10)) == 0);
  CHECK(resumed("") == 0);
  std::string flipped = whole;
  flipped[whole.size() - 3 * record - 100] =
      static_cast<char>(flipped[whole.size() - 3 * record - 100] ^ 4);
  CHECK(resumed(flipped) == 50);
  flipped = whole;
  flipped[200] = static_cast<char>(flipped[200] ^ 4);
  CHECK(resumed(flipped) == 0);
  CHECK_THAT(run.out, ContainsSubstring("of another configuration: starting anew"));
  CHECK(resumed(whole + "and more") == 54);
}

TEST_CASE("a work file of another configuration is given up", "[slow]") {
  ColumnsRun run;
  run.write("other.toml", std::string(kStepping).replace(kStepping.find("2000"), 4, "2001"));
  run.good("other.toml -o other.h5");
  run.good("c.toml -o a.part --columns 0:54");
  std::filesystem::rename(run.path() / "a.part", run.path() / "model.h5.columns");
  run.good("other.toml -o model.h5");
  CHECK_THAT(run.out, ContainsSubstring("starting anew") && !ContainsSubstring("going on"));
  CHECK((run.content("model.h5") == run.content("other.h5")));
}

TEST_CASE("SIGINT keeps the work file and says how to go on, and the same command goes on") {
  const std::string longer =
      std::string(kStepping).replace(kStepping.find("steps = 40"), 10, "steps = 300");
  ColumnsRun run(longer);
  ChildProcess process = run.begin("c.toml -o model.h5");
  const auto some = [&] {
    return run.has("model.h5.columns") &&
           std::filesystem::file_size(run.path() / "model.h5.columns") > 150'000;
  };
  REQUIRE(irdm::test::eventually(some, ChildProcess::kDeadlineMs));
  process.signal(SIGSTOP);
  run.refused("c.toml -o model.h5", "model.h5.columns: is being written by another run");
  process.signal(SIGCONT);
  process.signal(SIGINT);
  CHECK(process.wait() == -SIGINT);
  CHECK_THAT(process.err(), ContainsSubstring("the same command goes on from where it was"));
  CHECK_FALSE(run.has("model.h5"));
  run.good("c.toml -o model.h5");
  CHECK(columns_kept(run.out) >= 2);
}

#ifdef IRDM_MPIRUN
TEST_CASE("two ranks share the columns and one file comes out, that of a single process",
          "[slow]") {
  const std::string two = IRDM_MPIRUN " -n 2 --oversubscribe --allow-run-as-root";
  for (const std::string& config :
       {kStepping, kStepping + "[time_stepping]\nmodel = \"linear\"\n"}) {
    ColumnsRun run(config);
    run.good("c.toml -o single.h5");
    run.good("c.toml -o shared.h5 --threads 1", two);
    CHECK((run.content("shared.h5") == run.content("single.h5")));
    CHECK_FALSE(run.has("shared.h5.columns.0-of-2"));
    CHECK_FALSE(run.has("shared.h5.columns.1-of-2"));
    run.start("c.toml -o nowhere/shared.h5", two);
    CHECK(run.status != 0);
    CHECK_THAT(run.err, ContainsSubstring("nowhere/shared.h5"));
    run.start("c.toml -o a.part --columns 0:5", two);
    CHECK(run.status != 0);
    CHECK_THAT(run.err, ContainsSubstring("do not go together"));
  }
}
#endif

namespace {

// Each moment of death: while columns are computed, while the model file is written, and between.
void check_kills(int count) {
  const std::string config =
      std::string(kStepping).replace(kStepping.find("steps = 40"), 10, "steps = 1500");
  ColumnsRun undisturbed(config);
  const auto start = std::chrono::steady_clock::now();
  undisturbed.good("c.toml -o model.h5 --threads 2");
  const double whole =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string expected = undisturbed.content("model.h5");
  std::mt19937 random(2026);
  std::uniform_real_distribution<double> moment(0.0, 0.35 * whole);
  ColumnsRun run(config);
  int kills = 0;
  int had = 0;
  while (kills < count) {
    std::filesystem::remove(run.path() / "model.h5");
    ChildProcess process = run.begin("c.toml -o model.h5 --threads 2");
    std::this_thread::sleep_for(std::chrono::duration<double>(moment(random)));
    process.signal(SIGKILL);
    ++kills;
    if (process.wait() == 0) had = 0;  // it was faster
    // Absent or complete; and no work is lost but that of the two columns in flight.
    if (run.has("model.h5")) {
      CHECK((run.content("model.h5") == expected));
      had = 0;
      continue;
    }
    const int kept = columns_kept(process.out());
    CAPTURE(kills, kept, had);
    CHECK((kept == 0 || kept >= had));
    had = std::max(had, kept);
  }
  run.good("c.toml -o model.h5 --threads 2");
  CHECK(columns_kept(run.out) >= had);
  CHECK((run.content("model.h5") == expected));
  CHECK_FALSE(run.has("model.h5.columns"));
  CHECK_FALSE(run.has("model.h5.part"));
}

}  // namespace

TEST_CASE("killed at random moments, the run ends with the file of an undisturbed one", "[slow]") {
  check_kills(6);
}

TEST_CASE("killed at random moments, the same for twenty", "[exhaustive]") {
  check_kills(20);
}
