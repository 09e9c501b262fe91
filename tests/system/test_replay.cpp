// irdm-replay as a user has it, on traces of the real programs.
#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <map>
#include <sstream>

#include "replay/compare/run_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/edited_numbers.hpp"
#include "tests/support/eventually.hpp"
#include "tests/system/stage.hpp"
#include "tests/system/trace.hpp"

using Catch::Matchers::ContainsSubstring;
using Catch::Matchers::StartsWith;
using namespace irdm;
using namespace irdm::test;

namespace {

FinishedProgram run_replay(const std::filesystem::path& trace, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), IRDM_REPLAY);
  arguments.push_back(trace.string());
  return run_to_end(arguments);
}

// Two fingers that pinch a cube on a floor near its edges, slide, and put everything back.
void set_pinch(const Stage& stage) {
  stage.write("scene.toml",
              "[server]\nport = 0\nstyluses = 2\ndeformation_threads = 1\n"
              "[contact]\ncoupling_stiffness = 2000\n[world]\ngravity = [0, -2, 0]\n[floor]\n"
              "height = -0.061\n[[object]]\nname = \"a cube\"\nmodel = \"" +
                  cube_model().string() + "\"\n");
  std::string bridge;
  for (const std::string side : {"", "-"}) {
    const std::string name = "script" + std::to_string(side.size()) + ".csv";
    stage.write(name, "time,x,y,z,button\n0," + side + "0.07,0.01,0.02,0\n0.3," + side +
                          "0.07,0.01,0.02,0\n0.5," + side + "0.05,0.01,0.02,0\n0.9," + side +
                          "0.05,0.045,-0.03,0\n1.0," + side + "0.05,0.045,-0.03," +
                          (side.empty() ? "4" : "0") + "\n1.2," + side + "0.08,0.05,0,0\n");
    bridge += "[[device]]\ntype = \"virtual\"\nscript = \"" + name +
              "\"\nhand = { mass = 0.12, damping = 2.0, stiffness = 300.0 }\n";
  }
  stage.write("bridge.toml", bridge);
}

void check_near(const std::string& report) {
  INFO(report);
  CHECK(number_after(report, "force ") < 1e-9);
  CHECK(number_after(report, "position ") < 1e-9);
  CHECK(number_after(report, "orientation ") < 1e-9);
  CHECK(number_after(report, "velocity ") < 1e-9);
  CHECK_THAT(report, !ContainsSubstring("other contacts"));
}

/// A table with a head line.
class Table {
 public:
  explicit Table(const std::filesystem::path& path) {
    std::istringstream lines(file_content(path));
    std::string line;
    std::getline(lines, line);
    std::istringstream head(line);
    for (std::string name; std::getline(head, name, ',');) names_.push_back(name);
    while (std::getline(lines, line)) {
      std::istringstream cells(line);
      std::vector<double>& row = rows_.emplace_back();
      for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
      REQUIRE(row.size() == names_.size());
    }
  }
  std::size_t rows() const { return rows_.size(); }
  double at(const std::string& name, std::size_t k) const {
    const auto column = std::find(names_.begin(), names_.end(), name);
    REQUIRE(column != names_.end());
    return rows_[k][static_cast<std::size_t>(column - names_.begin())];
  }
  Vector3 vector(const std::string& name, const std::string& unit, std::size_t k) const {
    return {at(name + "_x" + unit, k), at(name + "_y" + unit, k), at(name + "_z" + unit, k)};
  }

 private:
  std::vector<std::string> names_;
  std::vector<std::vector<double>> rows_;
};

/// Every file of a folder.
std::map<std::string, std::string> contents(const std::filesystem::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    all[file.path().filename()] = file_content(file.path());
  }
  return all;
}

/// A file of a series for ParaView, as another reader than ours finds it: of each point its place,
/// and vectors (of surfaces displacement and force, of styluses force).
struct Part {
  int number = 0;
  double time = 0.0;
  int triangles = 0;
  std::vector<std::array<Vector3, 3>> rows;
};

std::vector<Part> read_series(const std::filesystem::path& folder) {
  const FinishedProgram read =
      run_to_end({"/usr/bin/python3", IRDM_SOURCE_DIR "/tests/system/read_surfaces.py",
                  folder.string(), "displacement", "force"});
  INFO(read.err);
  REQUIRE(read.status == 0);
  std::istringstream words(read.out);
  std::vector<Part> parts;
  Part part;
  for (std::size_t points = 0; words >> part.number >> part.time >> points >> part.triangles;) {
    part.rows.assign(points, {});
    for (std::array<Vector3, 3>& row : part.rows) {
      const std::size_t vectors = part.triangles > 0 ? 3 : 2;
      for (std::size_t i = 0; i < vectors; ++i) words >> row[i].x() >> row[i].y() >> row[i].z();
    }
    parts.push_back(part);
  }
  CHECK(words.eof());
  return parts;
}

// That nodes are at c + Q (X + u), and that the forces on them add up to that on the stylus.
// Returns the largest displacement.
double check_surface(const Part& surface, const replay::RunReader& run, std::size_t frame,
                     const Trace& trace, std::size_t k) {
  Points u;
  run.displacement(0, frame, u);
  REQUIRE(surface.rows.size() == static_cast<std::size_t>(u.rows()));
  const Matrix3 Q = trace.orientation(k).toRotationMatrix();
  const Vector3 middle = trace.vector("/step/body_position", k);
  Vector3 force = Vector3::Zero();
  double largest = 0.0;
  for (std::size_t i = 0; i < surface.rows.size(); ++i) {
    const auto node = static_cast<Eigen::Index>(i);
    const Vector3 displacement = Q * u.row(node).transpose();
    const Vector3 rest = Q * run.rest(0).row(node).transpose();
    REQUIRE((surface.rows[i][0] - middle - rest - displacement).norm() < 1e-12);
    REQUIRE((surface.rows[i][1] - displacement).norm() < 1e-12);
    force += surface.rows[i][2];
    largest = std::max(largest, displacement.norm());
  }
  CHECK((force + trace.vector("/stylus/0/force", k)).norm() < 1e-12);
  return largest;
}

}  // namespace

TEST_CASE("irdm-replay makes a run again, with two styluses, a floor and a reset") {
  const Stage stage;
  set_pinch(stage);
  // In real time bridges solve the contacts themselves, and what they tell may come late.
  const bool lockstep = GENERATE(true, false);
  const std::filesystem::path trace = record(stage, lockstep);
  for (const std::string from : {"inputs", "forces"}) {
    const FinishedProgram again = run_replay(trace, {"--from", from});
    REQUIRE(again.status == 0);
    CHECK(again.err.empty());
    check_near(again.out);
    if (lockstep) CHECK(number_after(again.out, "(peak ") > 0.1);
  }
}

TEST_CASE("irdm-replay makes a run in real time again, and its table has the trace's numbers") {
  const Stage stage;
  stage.write("scene.toml", scene_text("[world]\ngravity = [0.01, -0.05, 0.02]\n") +
                                "angular_velocity = [0.1, 0.4, -0.2]\ninertial_loading = true\n");
  const std::filesystem::path path = record(stage, false);
  const FinishedProgram again =
      run_replay(path, {"--from", "inputs", "--csv", stage.path("run.csv").string()});
  REQUIRE(again.status == 0);
  check_near(again.out);
  const Trace trace = read_trace(path);
  const Table table(stage.path("run.csv"));
  REQUIRE(table.rows() == trace.rows());
  for (std::size_t k = 0; k < trace.rows(); ++k) {
    REQUIRE(table.at("time_s", k) == Approx(0.002 * static_cast<double>(k + 1)));
    REQUIRE(table.vector("cube_position", "_m", k) == trace.vector("/step/body_position", k));
    REQUIRE(table.at("cube_orientation_w", k) == trace.orientation(k).w());
    REQUIRE(table.vector("cube_orientation", "", k) == trace.orientation(k).vec());
    REQUIRE(table.vector("cube_angular_velocity", "_rad_s", k) ==
            trace.vector("/step/body_angular_velocity", k));
    // Forces that came late are there in their own step.
    REQUIRE((table.vector("stylus0_force", "_N", k) - trace.vector("/stylus/0/applied_force", k))
                .norm() < 1e-12);
    REQUIRE(table.vector("stylus0_tip", "_m", k) == trace.vector("/stylus/0/tip", k));
    REQUIRE(table.at("stylus0_contact", k) == trace.contact[k]);
  }
}

TEST_CASE("irdm-replay writes surfaces that another reader finds whole and in their places") {
  const Stage stage;
  stage.write("scene.toml", scene_text("[world]\ngravity = [0.01, -0.05, 0.02]\n"));
  const std::filesystem::path path = record(stage, true);
  for (const std::string twice : {"1", "2"}) {
    const FinishedProgram again =
        run_replay(path, {"--rate", "20", "--vtk", stage.path("vtk" + twice).string(), "--output",
                          stage.path("run" + twice + ".h5").string(), "--csv",
                          stage.path("run" + twice + ".csv").string()});
    REQUIRE(again.status == 0);
    CHECK_THAT(again.out, ContainsSubstring("; 42 frames"));
  }
  CHECK(contents(stage.path("vtk1")) == contents(stage.path("vtk2")));
  CHECK(file_content(stage.path("run1.csv")) == file_content(stage.path("run2.csv")));
  CHECK(file_content(stage.path("run1.h5")) == file_content(stage.path("run2.h5")));
  CHECK(contents(stage.path("vtk1")).size() == 2 * 42 + 1);

  const Trace trace = read_trace(path);
  const replay::RunReader run(stage.path("run1.h5"));
  const std::vector<Part> parts = read_series(stage.path("vtk1"));
  REQUIRE(run.times().size() == 42);
  REQUIRE(parts.size() == 2 * 42);
  double largest = 0.0;
  for (std::size_t frame = 0; frame < 42; ++frame) {
    const Part& surface = parts[2 * frame];
    const Part& styluses = parts[2 * frame + 1];
    const auto k = static_cast<std::size_t>(std::lround(surface.time / 0.002)) - 1;
    REQUIRE(surface.number == 0);
    REQUIRE(surface.time == run.times()[frame]);
    REQUIRE(surface.triangles == 108);
    largest = std::max(largest, check_surface(surface, run, frame, trace, k));
    REQUIRE(styluses.number == 1);
    REQUIRE(styluses.rows.size() == 1);
    CHECK(styluses.rows[0][0] == trace.vector("/stylus/0/tip", k));
    CHECK((styluses.rows[0][1] - trace.vector("/stylus/0/force", k)).norm() < 1e-12);
  }
  CHECK(largest > 1e-3);
}

TEST_CASE("irdm-replay compare says how far engines are apart", "[unsanitized]") {
  const Stage stage;
  const std::filesystem::path trace = record(stage, true);
  for (const std::string engine : {"modal", "dense"}) {
    REQUIRE(run_replay(trace, {"--engine", engine, "--rate", "50", "--output",
                               stage.path(engine + ".h5").string()})
                .status == 0);
  }
  const FinishedProgram compared =
      run_to_end({IRDM_REPLAY, "compare", stage.path("modal.h5").string(),
                  stage.path("dense.h5").string(), "--json", stage.path("apart.json").string()});
  REQUIRE(compared.status == 0);
  // The dense responses of this model end after half a second, with some per cent left.
  CHECK(number_after(compared.out, "node displacement  rms") > 1e-6);
  CHECK(number_after(compared.out, "node displacement  rms") < 1e-3);
  const FinishedProgram read =
      run_to_end({"/usr/bin/python3", "-c",
                  "import json, sys\n"
                  "found = json.load(open(sys.argv[1]))\n"
                  "cube, = found['objects']\n"
                  "print(cube['name'], found['frames'], len(found['time']),\n"
                  "      len(cube['displacement']['rms_over_time']),\n"
                  "      cube['displacement']['max'] ==\n"
                  "          max(cube['displacement']['max_over_time']))\n",
                  stage.path("apart.json").string()});
  CHECK(read.out == "cube 105 105 105 True\n");
}

TEST_CASE("irdm-replay makes a run again by finite elements, and leaves no half of an output",
          "[unsanitized]") {
  const Stage stage;
  const std::filesystem::path trace = record(stage, true);
  const std::string fem = stage.path("fem.h5").string();
  const std::string modal = stage.path("modal.h5").string();
  ChildProcess interrupted(
      {IRDM_REPLAY, trace.string(), "--reference", "fem", "--substep", "1e-6", "--output", fem});
  const std::string part = fem + ".part-" + std::to_string(interrupted.pid());
  REQUIRE(eventually([&] { return std::filesystem::exists(part); }));
  interrupted.signal(SIGINT);
  CHECK(interrupted.wait() == 1);
  CHECK_THAT(interrupted.err(), ContainsSubstring("was interrupted after"));
  CHECK_FALSE(std::filesystem::exists(part));
  CHECK_FALSE(std::filesystem::exists(fem));
  // What it had found is of another sub-step than this, and given up.
  const FinishedProgram again =
      run_replay(trace, {"--reference", "fem", "--substep", "0.001", "--rate", "50", "-o", fem});
  REQUIRE(again.status == 0);
  CHECK_FALSE(std::filesystem::exists(fem + ".steps"));
  CHECK_THAT(again.out, ContainsSubstring("from forces, finite elements in sub-steps of 0.001 s"));
  REQUIRE(run_replay(trace, {"--rate", "50", "-o", modal}).status == 0);
  const FinishedProgram compared = run_to_end({IRDM_REPLAY, "compare", modal, fem});
  INFO(compared.out);
  REQUIRE(compared.status == 0);
  CHECK(number_after(compared.out, "node displacement  rms") > 1e-6);
  CHECK(number_after(compared.out, "node displacement  rms") < 1e-3);
  CHECK(number_after(compared.out, "orientation        rms") < 0.05);
}

TEST_CASE("a reference that is killed goes on where it was, to the same result bit for bit",
          "[slow]") {
  const Stage stage;
  const std::filesystem::path trace = record(stage, true);
  const std::string whole = stage.path("whole.csv").string();
  const std::string parts = stage.path("parts.csv").string();
  const std::vector<std::string> fem{"--reference", "fem", "--substep", "0.0005", "--csv"};
  const auto with_output = [&](const std::string& output) {
    std::vector<std::string> words = fem;
    words.push_back(output);
    return words;
  };
  REQUIRE(run_replay(trace, with_output(whole)).status == 0);
  CHECK_FALSE(std::filesystem::exists(whole + ".steps"));
  const std::filesystem::path journal = parts + ".steps";
  const auto size = [&] {
    std::error_code none_yet;
    const auto bytes = std::filesystem::file_size(journal, none_yet);
    return none_yet ? 0 : bytes;
  };
  ChildProcess killed(
      {IRDM_REPLAY, trace.string(), "--reference", "fem", "--substep", "0.0005", "--csv", parts});
  REQUIRE(eventually([&] { return size() > 20'000; }));
  killed.signal(SIGKILL);
  killed.wait();
  REQUIRE(size() > 20'000);
  std::filesystem::resize_file(journal, size() - 3);  // as if it had been written half
  const FinishedProgram rest = run_replay(trace, with_output(parts));
  REQUIRE(rest.status == 0);
  CHECK_THAT(rest.out, ContainsSubstring("of these steps are from a run that was interrupted"));
  CHECK(file_content(parts) == file_content(whole));
  CHECK_FALSE(std::filesystem::exists(journal));
}

TEST_CASE("irdm-replay refuses what it cannot make again, in one line") {
  const Stage stage;
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& message) {
    CAPTURE(message);
    const FinishedProgram program = run_replay(stage.path("trace.h5"), arguments);
    CHECK(program.status == 1);
    CHECK(program.out.empty());
    CHECK(std::count(program.err.begin(), program.err.end(), '\n') == 1);
    CHECK_THAT(program.err, StartsWith("irdm-replay: error: ") && ContainsSubstring(message));
  };
  refused({}, "trace.h5: no such file");
  stage.write("trace.h5", "no trace");
  refused({}, "trace.h5: ");
  std::filesystem::remove(stage.path("trace.h5"));
  std::filesystem::copy_file(cube_model(), stage.path("trace.h5"));
  refused({}, "is not a trace");
  std::filesystem::remove(stage.path("trace.h5"));
  record(stage, true);
  refused({"--engine", "compressed"}, "compressed");
  refused({"--rate", "1000"}, "above the rate of the steps");
  refused({"--reference", "fem", "--from", "inputs", "--solve-bridged"},
          "cannot be combined with --reference");
  refused({"--reference", "fem", "--engine", "modal"}, "means nothing to a reference");
  refused({"--substep", "0.001"}, "give --reference fem");
  refused({"--csv", stage.path("scene.toml").string()}, "exists already");
  refused({"--vtk", stage.path(".").string()}, "is not empty");
  refused({"--model", stage.path("scene.toml").string()}, "scene.toml");
  const std::string whole = file_content(stage.path("trace.h5"));
  stage.write("trace.h5", whole.substr(0, whole.size() / 2));
  refused({}, "trace.h5: ");
  for (const auto& [set, value] :
       {std::pair("/stylus/0/force", std::nan("")), std::pair("/stylus/0/tip", 1e300),
        std::pair("/step/body_orientation", 2.0)}) {
    stage.write("trace.h5", whole);
    set_number(stage.path("trace.h5"), set, 0, value);
    refused({"--csv", stage.path("out.csv").string()}, std::string(set) + " of step 0 is ");
    CHECK_FALSE(std::filesystem::exists(stage.path("out.csv")));
  }
  CHECK(run_to_end({IRDM_REPLAY, "compare", cube_model().string(), cube_model().string()}).err ==
        "irdm-replay: error: " + cube_model().string() +
            ": is not a run file; make one with irdm-replay TRACE.h5 --output RUN.h5\n");
  CHECK(run_to_end({IRDM_REPLAY}).status == 2);
}

TEST_CASE("irdm-replay --end: what is wrong with a later step does not refuse those before it") {
  const Stage stage;
  record(stage, true);
  const std::filesystem::path trace = stage.path("trace.h5");
  const hsize_t rows = hdf5::File::open(trace).shape("/step/time")[0];
  REQUIRE(rows > 100);
  set_number(trace, "/step/body_position", 3 * (rows - 1), std::nan(""));
  CHECK(run_replay(trace, {}).status == 1);
  const FinishedProgram part = run_replay(trace, {"--end", "0.1"});
  CHECK(part.status == 0);
  CHECK_THAT(part.err, StartsWith("irdm-replay: warning: only the steps up to --end are read: "));
  CHECK_THAT(part.out, ContainsSubstring(": 50 steps of 0.002 s"));
}
