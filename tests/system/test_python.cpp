// What docs/files.md shows of reading the files with Python, as it stands there.
#include <sstream>

#include "common/model/model_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/system/stage.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

// The program that follows a line of docs/files.md: what is indented by four.
std::string program_after(const std::string& words) {
  const std::string page = file_content(IRDM_SOURCE_DIR "/docs/files.md");
  const std::size_t at = page.find(words);
  REQUIRE(at != std::string::npos);
  std::istringstream lines(page.substr(page.find("\n    ", at) + 1));
  std::string program;
  for (std::string line; std::getline(lines, line) && (line.empty() || line.starts_with("    "));) {
    program += (line.empty() ? line : line.substr(4)) + "\n";
  }
  return program;
}

FinishedProgram run_python(const std::filesystem::path& program,
                           const std::vector<std::filesystem::path>& arguments) {
  std::vector<std::string> command{"/usr/bin/python3", program.string()};
  for (const auto& argument : arguments) command.push_back(argument.string());
  return run_to_end(command);
}

// Prints the datasets of floating-point numbers, and those of them that have no unit.
constexpr const char* kLookForUnits = R"(
import sys

import h5py

with h5py.File(sys.argv[1]) as file:
    sets = []
    file.visititems(lambda name, item: sets.append(item) if isinstance(item, h5py.Dataset) else None)
    numbers = [item for item in sets if item.dtype.kind == "f"]
    print("floating point:", len(numbers))
    print("without unit:", [item.name for item in numbers if not item.attrs.get("unit", b"").decode()])
)";

}  // namespace

TEST_CASE(
    "the programs of docs/files.md read a trace and a model, and all their numbers have units") {
  const Stage stage;
  record(stage, true);

  stage.write("plot.py", program_after("Plotting the force of a trace"));
  const FinishedProgram plotted =
      run_python(stage.path("plot.py"), {stage.path("trace.h5"), stage.path("force.png")});
  INFO(plotted.err);
  CHECK(plotted.status == 0);
  CHECK(file_content(stage.path("force.png")).starts_with("\x89PNG"));
  CHECK(std::filesystem::file_size(stage.path("force.png")) > 10'000);  // curves, not a white sheet

  stage.write("model.py", program_after("Reading a model"));
  const FinishedProgram read = run_python(stage.path("model.py"), {cube_model()});
  INFO(read.err);
  REQUIRE(read.status == 0);
  const Model model = read_model(cube_model(), ResponseKind::kModal);
  const auto& modal = std::get<ModalResponse>(model.response);
  const double lowest = modal.angular_frequency[0] / (2 * 3.14159265358979);
  CHECK(number_after(read.out, "Hz: [") == Approx(lowest).epsilon(1e-6));
  CHECK_THAT(read.out, ContainsSubstring("compliance, m/N, from 0.0"));

  stage.write("units.py", kLookForUnits);
  for (const auto& file : {stage.path("trace.h5"), cube_model()}) {
    const FinishedProgram looked = run_python(stage.path("units.py"), {file});
    INFO(looked.out << looked.err);
    CHECK(number_after(looked.out, "floating point:") >= 8);
    CHECK_THAT(looked.out, ContainsSubstring("without unit: []"));
  }
}
