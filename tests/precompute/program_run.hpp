#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace irdm::test {

inline const std::string kBox =
    "[mesh]\nbox = { size = [0.12, 0.1, 0.08], cells = [3, 2, 2] }\norder = 1\n";
inline const std::string kProgramMaterial =
    "[material]\nyoungs_modulus = 2000\npoisson_ratio = 0.3\ndensity = 110\n";
inline const std::string kMsh =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n"
    "5 1 1 1\n$EndNodes\n$Elements\n2\n1 4 2 0 1 1 2 3 4\n2 4 2 0 1 2 3 4 5\n$EndElements\n";

inline std::string with_words(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

// Lines of the program's stderr that are no warnings.
inline std::string without_warnings(const std::string& err) {
  std::istringstream lines(err);
  std::string rest;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("irdm-precompute: warning: ")) rest += line + '\n';
  }
  return rest;
}

// Runs the real program in a folder of its own.
struct ProgramRun : TemporaryFolder {
  int status = -1;
  std::string out;
  std::string err;

  ProgramRun() { std::filesystem::create_directory(path() / "made"); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path() / name) << text;
  }
  std::filesystem::path model() const { return path() / "made" / "model.h5"; }
  // The program with these words, separated by spaces, on its way.
  ChildProcess begin(const std::string& arguments) const {
    std::vector<std::string> command{IRDM_PROGRAM};
    std::istringstream words(arguments);
    for (std::string word; words >> word;) command.push_back(word);
    return ChildProcess(command, {.folder = path()});
  }
  void start(const std::string& arguments) {
    ChildProcess process = begin(arguments);
    status = process.wait();
    out = process.out();
    err = process.err();
  }
  void check_refused(const std::string& message) {
    start("c.toml -o made/model.h5");
    CHECK(status == 1);
    const std::string error = without_warnings(err);
    CHECK(std::count(error.begin(), error.end(), '\n') == 1);
    CHECK_THAT(error, Catch::Matchers::StartsWith("irdm-precompute: error: ") &&
                          Catch::Matchers::ContainsSubstring(message));
    CHECK(std::filesystem::is_empty(path() / "made"));
  }
};

}  // namespace irdm::test
